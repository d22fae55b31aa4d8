//! Every setting that a flight had, whether its file gave it or a default filled it in.

use fspid_page::number::significant;
use fspid_page::page::{Cell, PageTable};
use fspid_scenario::file::{DerivedGains, Setting};

/// Tables whose settings stand in a table of their own.
const CONTROLLERS: &str = "controller";

/// The settings of everything but the controllers.
pub fn of_flight(settings: &[Setting]) -> PageTable {
    let settings = settings.iter().filter(|setting| !is_of_controller(setting));
    table("Aircraft, servo, samples, command, disturbances and requirements.", "", settings)
}

/// The settings of each controller.
pub fn of_controllers(settings: &[Setting]) -> Vec<PageTable> {
    let settings: Vec<&Setting> = settings.iter().filter(|s| is_of_controller(s)).collect();
    let one = |settings: &[&Setting]| {
        let name = settings.first().map_or("", |setting| setting.table.as_str());
        table(name, name, settings.iter().copied())
    };
    settings.chunk_by(|a, b| a.table == b.table).map(one).collect()
}

/// The gains that fly where no setting states them; none without such a controller.
pub fn derived(gains: &[DerivedGains]) -> Option<PageTable> {
    let caption = "Gains that fly, where a schedule or a design makes them.";
    let head = ["controller", "kp", "ki [1/s]", "kd [s]", "rate gain [s]", "from"];
    let mut table = PageTable::new(caption, &head).in_cards();
    for DerivedGains { controller, gains, rate_gain_s, source } in gains {
        let mut row = vec![Cell::text(controller)];
        let numbers = [gains.kp, gains.ki, gains.kd, *rate_gain_s];
        row.extend(numbers.map(|number| Cell::number(significant(number, 6))));
        row.push(Cell::text(source.to_string()));
        table.push(row);
    }
    (!gains.is_empty()).then_some(table)
}

fn is_of_controller(setting: &Setting) -> bool {
    // In a path, the name of a list ends at a dot or a bracket.
    setting.table.split(['.', '[']).next() == Some(CONTROLLERS)
}

/// Settings as rows, their paths relative to the table that they share.
fn table<'a>(
    caption: &str,
    shared: &str,
    settings: impl Iterator<Item = &'a Setting>,
) -> PageTable {
    let mut table = PageTable::new(caption, &["setting", "value", "unit", "from"]).in_cards();
    for Setting { path, value, unit, given, .. } in settings {
        let path = path.strip_prefix(shared).unwrap_or(path).trim_start_matches('.');
        let from = if *given {
            Cell::text("given")
        } else {
            Cell { class: "absent", ..Cell::text("default") }
        };
        table.push(vec![Cell::text(path), Cell::text(value), Cell::text(*unit), from]);
    }
    table
}

/// Settings of a disturbance that say where it enters and how large it is, not which form it has.
const NOT_FORM: [&str; 3] = ["enters_at", "amplitude_deg", "standard_deviation_deg"];

/// What disturbs, in words: "pulse (at 1 s, width 1 s)".
pub fn disturbance_forms(settings: &[Setting]) -> Vec<String> {
    let disturbs = |setting: &&Setting| setting.table.starts_with("disturbance[");
    let settings: Vec<&Setting> = settings.iter().filter(disturbs).collect();
    settings.chunk_by(|a, b| a.table == b.table).map(form).collect()
}

fn form(settings: &[&Setting]) -> String {
    let (mut kind, mut details) = (String::new(), Vec::new());
    for Setting { path, value, unit, .. } in settings {
        let key = path.rsplit('.').next().unwrap_or(path);
        let value = value.trim_matches('"').trim_end_matches(".0");
        if key == "kind" {
            value.clone_into(&mut kind);
        } else if !NOT_FORM.contains(&key) {
            let ending = format!("_{}", unit.to_lowercase());
            let name = key.strip_suffix(ending.as_str()).unwrap_or(key).replace('_', " ");
            details.push(format!("{name} {value} {unit}").trim_end().to_owned());
        }
    }
    format!("{kind} ({})", details.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_scenario::file;

    fn settings(text: &str) -> Vec<Setting> {
        file::parse(text, "test.toml", None, &[]).expect("the scenario is right").settings
    }

    fn rows(table: &PageTable) -> Vec<String> {
        let text = |row: &fspid_page::page::TableRow| {
            let cells: Vec<&str> = row.cells.iter().map(|cell| cell.text.as_str()).collect();
            cells.join(" | ")
        };
        table.rows.iter().map(text).collect()
    }

    #[test]
    fn every_setting_is_in_one_table_with_its_unit_and_where_it_is_from() {
        let settings = settings(file::starter());
        let flight = rows(&of_flight(&settings));
        assert!(flight.contains(&"setpoint.amplitude_deg | 5.0 | deg | given".to_owned()));
        assert!(flight.contains(&"actuator.delay_samples | 0 |  | default".to_owned()));
        let controllers = of_controllers(&settings);
        let captions: Vec<&str> = controllers.iter().map(|table| table.caption.as_str()).collect();
        assert_eq!(captions, ["controller.PID", "controller.FSPID"]);
        let tuned = rows(&controllers[1]);
        assert!(tuned.contains(&"sample_guard_deg | 1e9 | deg | default".to_owned()));
        assert!(tuned.contains(&"supervisor.out_of_range | \"clamp\" |  | default".to_owned()));
        assert!(tuned.contains(&"supervisor.error_scale | 1.0 | 1/deg | given".to_owned()));
        let count = flight.len() + controllers.iter().map(|table| table.rows.len()).sum::<usize>();
        assert_eq!(count, settings.len());
    }

    #[test]
    fn a_disturbance_is_described_by_its_shape_and_times() {
        let text = file::starter().to_owned()
            + "\n[[disturbance]]\nkind = \"pulse\"\nenters_at = \"elevator\"\namplitude_deg = 2.0\nat_s = 10.0\nwidth_s = 0.5\n\
               [[disturbance]]\nkind = \"sine\"\nenters_at = \"servo\"\namplitude_deg = 2.0\nfrequency_hz = 2.0\n";
        assert_eq!(
            disturbance_forms(&settings(&text)),
            ["step (at 4 s)", "pulse (at 10 s, width 0.5 s)", "sine (at 0 s, frequency 2 Hz)"]
        );
    }
}

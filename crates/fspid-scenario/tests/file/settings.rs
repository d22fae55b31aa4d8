//! The list of all settings: complete, in the words of the file, and true.

use std::collections::{BTreeMap, BTreeSet};

use fspid_scenario::file::{self, Setting};
use toml::{Table, Value};

use crate::file::bad_values::texts;
use crate::file::shipped;

fn settings(text: &str, set: &[String]) -> Vec<Setting> {
    let study = file::parse(text, "test.toml", None, set);
    study.unwrap_or_else(|problems| panic!("{problems}\n{text}")).settings
}

/// Every file of the repository that is a scenario.
fn scenarios() -> Vec<String> {
    let shipped = shipped().into_iter().map(|(_, text)| text);
    [file::starter().to_owned()].into_iter().chain(texts()).chain(shipped).collect()
}

/// Every key of a text that holds no table, with its path and value.
fn keys(text: &str) -> BTreeMap<String, Value> {
    let mut keys = BTreeMap::new();
    walk(&text.parse::<Table>().expect("it is TOML"), "", &mut keys);
    keys
}

fn walk(table: &Table, path: &str, keys: &mut BTreeMap<String, Value>) {
    let join = |name: &str| match path {
        "" => name.to_owned(),
        path => format!("{path}.{name}"),
    };
    for (name, value) in table {
        match value {
            // A mark flies as its start.
            Value::Table(mark) if mark.contains_key("tune") => {
                keys.insert(join(name), mark["start"].clone());
            }
            Value::Table(table) => walk(table, &join(name), keys),
            Value::Array(items) if items.iter().any(|item| item.get("tune").is_some()) => {
                let start = |item: &Value| item.get("start").unwrap_or(item).clone();
                keys.insert(join(name), items.iter().map(start).collect::<Vec<_>>().into());
            }
            Value::Array(items) if !items.is_empty() && items.iter().all(Value::is_table) => {
                for (index, table) in items.iter().filter_map(Value::as_table).enumerate() {
                    let step = match table.get("name").and_then(Value::as_str) {
                        Some(name) if name.contains([' ', '/']) => format!(".\"{name}\""),
                        Some(name) => format!(".{name}"),
                        None => format!("[{index}]"),
                    };
                    walk(table, &format!("{}{step}", join(name)), keys);
                }
            }
            value => {
                keys.insert(join(name), value.clone());
            }
        }
    }
}

/// True for what a preset says, which stands in no scenario.
fn is_of_preset(setting: &Setting) -> bool {
    [".preset.", ".name."].iter().any(|key| setting.path.contains(key))
}

#[test]
fn every_key_of_a_file_is_a_setting_with_its_value() {
    for text in scenarios() {
        let settings = settings(&text, &[]);
        let listed: BTreeMap<&str, &Setting> =
            settings.iter().map(|setting| (setting.path.as_str(), setting)).collect();
        assert_eq!(listed.len(), settings.len(), "a path is there twice");
        for (path, value) in keys(&text) {
            let setting =
                listed.get(path.as_str()).unwrap_or_else(|| panic!("{path}: {listed:#?}"));
            assert!(setting.given, "{path}");
            let read: Table = format!("x = {}", setting.value).parse().expect("it is TOML");
            let number = |value: &Value| value.as_integer().map(|integer| integer as f64);
            let same = read["x"] == value || number(&value) == read["x"].as_float();
            assert!(same, "{path}: {} for {value}", setting.value);
        }
    }
}

#[test]
fn what_a_file_does_not_give_is_marked_as_a_default() {
    for text in scenarios() {
        let given = keys(&text);
        for setting in settings(&text, &[]).iter().filter(|setting| !is_of_preset(setting)) {
            assert_eq!(setting.given, given.contains_key(&setting.path), "{setting:?}");
        }
    }
}

#[test]
fn the_defaults_of_a_table_that_is_left_out_are_listed() {
    let text = file::starter().replace("time_constant_s = 0.1", "").replace("[actuator]", "");
    let settings = settings(&text, &[]);
    let value = |path: &str| {
        let setting = settings.iter().find(|setting| setting.path == path)?;
        (!setting.given).then_some(setting.value.as_str())
    };
    assert_eq!(value("actuator.time_constant_s"), Some("0.0"));
    assert_eq!(value("controller.PID.setpoint_weights.proportional"), Some("1.0"));
    assert_eq!(value("controller.PID.derivative_on"), Some("\"error\""));
    // Its default depends on `derivative_on`.
    assert_eq!(value("controller.PID.setpoint_weights.derivative"), None);
}

/// Writing every setting out, defaults too, changes nothing of the flight.
#[test]
fn every_setting_can_be_set_to_what_it_is() {
    for text in scenarios() {
        let study = file::parse(&text, "test.toml", None, &[]).expect("no problems");
        let set: Vec<String> = study
            .settings
            .iter()
            .filter(|setting| !is_of_preset(setting))
            // Its default goes with a weight of 0 that a file may give.
            .filter(|setting| setting.given || !setting.path.ends_with("derivative_on"))
            .map(|setting| format!("{}={}", setting.path, setting.value))
            .collect();
        let again = file::parse(&text, "test.toml", None, &set);
        let again = again.unwrap_or_else(|problems| panic!("{problems}"));
        assert_eq!(again.scenario, study.scenario);
        assert_eq!(again.requirements, study.requirements);
        let lines = |settings: &[Setting]| -> BTreeSet<(String, String)> {
            settings.iter().map(|setting| (setting.path.clone(), setting.value.clone())).collect()
        };
        assert_eq!(lines(&again.settings), lines(&study.settings));
        assert!(again.settings.iter().all(|s| s.given || s.path.ends_with("derivative_on")));
    }
}

#[test]
fn a_changed_value_changes_its_setting_alone() {
    let before = settings(file::starter(), &[]);
    for (path, value) in [
        ("loop.sample_period_s", "0.005"),
        ("controller.FSPID.supervisor.range", "7.25"),
        ("controller.FSPID.sample_guard_deg", "1e8"),
        ("controller.PID.integral", "\"literal\""),
    ] {
        let after = settings(file::starter(), &[format!("{path}={value}")]);
        let changed: Vec<&Setting> = after.iter().filter(|now| !before.contains(now)).collect();
        let [setting] = changed.as_slice() else { panic!("{path}: {changed:?}") };
        assert_eq!((setting.path.as_str(), setting.value.as_str()), (path, value));
        assert!(setting.given);
        assert_eq!(after.len(), before.len());
    }
}

#[test]
fn a_preset_shows_its_coefficients_and_their_source() {
    let settings = settings(file::starter(), &[]);
    let value = |key: &str| {
        let path = format!("plant.preset.{key}");
        settings.iter().find(|setting| setting.path == path).map(|setting| setting.value.as_str())
    };
    assert_eq!(value("numerator"), Some("[11.7304, 22.578]"));
    assert_eq!(value("denominator"), Some("[1.0, 4.9676, 12.941, 0.0]"));
    assert_eq!(value("elevator_sign"), Some("\"nose-up-positive\""));
    assert!(value("source").is_some_and(|source| source.contains("arXiv")));
}

#[test]
fn a_plant_file_shows_its_coefficients_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let plant = crate::file::text("data/plants/ctms-pitch.toml");
    std::fs::write(folder.path().join("mine.toml"), plant).expect("written");
    let text = file::starter().replace("preset = \"navion-paper\"", "file = \"mine.toml\"");
    let study = file::parse(&text, "test.toml", Some(folder.path()), &[]).expect("no problems");
    let paths: Vec<&str> = study.settings.iter().map(|setting| setting.path.as_str()).collect();
    assert!(paths.contains(&"plant.file.denominator"), "{paths:?}");
}

#[test]
fn rules_in_the_file_and_long_tables_stay_one_line() {
    let rules = crate::file::text("data/rule-tables/printed.toml");
    let grids: Vec<&str> = rules.split("\"\"\"").collect();
    let table = ["delta_kp", "delta_ki", "delta_kd"];
    let grid = |n: usize| format!("{} = \"\"\"{}\"\"\"\n", table[n], grids[2 * n + 1]);
    let own = format!("[controller.supervisor.table]\n{}{}{}", grid(0), grid(1), grid(2));
    let times: Vec<String> = (0..500).map(|k| format!("{k}e-2")).collect();
    let times = times.join(", ");
    let text = file::starter()
        .replace("table = \"mirrored\"", "")
        .replace("[controller.gain_limits]", &format!("{own}[controller.gain_limits]"))
        .replacen("kind = \"step\"", "kind = \"table\"", 1)
        .replace(
            "amplitude_deg = 5.0\nat_s = 0.0",
            &format!("time_s = [{times}]\nvalue_deg = [{times}]"),
        );
    let settings = settings(&text, &[]);
    let value = |path: &str| {
        let setting = settings.iter().find(|setting| setting.path == path);
        setting.unwrap_or_else(|| panic!("{path}")).value.as_str()
    };
    let rows: Vec<&str> = grids[5].lines().map(str::trim).filter(|row| !row.is_empty()).collect();
    let expected = format!("\"{}\"", rows.join("\\n"));
    assert_eq!(value("controller.FSPID.supervisor.table.delta_kd"), expected);
    assert_eq!(value("setpoint.time_s"), "[0.0, 0.01, 0.02, 0.03, …, 4.99] (500 numbers)");
    assert!(settings.iter().all(|setting| !setting.value.contains('\n')));
}

#[test]
fn a_hostile_name_stays_one_line_and_cannot_pass_for_another_path() {
    for name in [
        r"two\nlines\r\u2028three",
        r#"kp = 1\" , \"x"#,
        r"\u202Eright to left",
        r"\u001B[31mred",
        "<script>alert('x')</script>",
        &"long ".repeat(10_000),
    ] {
        let text = file::starter().replace("name = \"FSPID\"", &format!("name = \"{name}\""));
        let settings = settings(&text, &[]);
        let hostile: Vec<&Setting> = settings
            .iter()
            .filter(|s| s.table.starts_with("controller") && s.table != "controller.PID")
            .collect();
        assert!(hostile.len() > 20, "{hostile:?}");
        for setting in hostile {
            for line in [&setting.table, &setting.path, &setting.value] {
                assert!(line.chars().count() < 700, "{line}");
                let seen = |c: char| !c.is_control() && !('\u{2028}'..='\u{202e}').contains(&c);
                assert!(line.chars().all(seen), "{line:?}");
            }
            let set = format!("{}=1", setting.path);
            let problems = file::parse(&text, "test.toml", None, &[set]).err();
            let found = problems.is_none_or(|problems| !problems.to_string().contains("no entry"));
            assert!(found, "{}", setting.path);
        }
    }
}

//! What an autopilot around the loop holds and when, to be drawn beside what the aircraft did.

use fspid_plot::{Series, SeriesStyle};
use fspid_sim::aircraft::DEPLOYMENT_COLUMNS;
use fspid_sim::autopilot::{Autopilot, Mode, Moves, Quantity};
use fspid_sim::{AircraftPlant, Timing, Trace};

use fspid_page::number::significant;
use fspid_scenario::units::degrees;

/// A panel of the motion: its label, and the column that it shows.
pub(super) struct Panel {
    pub(super) label: &'static str,
    pub(super) column: &'static str,
    /// The column of what it is to be.
    target: Option<&'static str>,
    /// Whose target that is: a quantity, or else the bank.
    held: Option<Quantity>,
    /// When it is drawn.
    pub(super) shown: Shown,
}

/// When a panel is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shown {
    /// In every flight that has the column.
    Always,
    /// In flights in which it is not the same throughout.
    WhereItMoves,
    /// In flights in which a mode holds it.
    WhereHeld,
}

/// The panels of an aircraft's motion, from above.
pub(super) const PANELS: [Panel; 11] = {
    use Quantity::{Airspeed, Altitude, FlightPath, GlideSlope, Heading, VerticalSpeed};
    use Shown::{Always, WhereHeld, WhereItMoves};
    [
        held("airspeed [m/s]", ["airspeed_m_s", "airspeed_target_m_s"], Airspeed, Always),
        held("altitude [m]", ["altitude_m", "altitude_target_m"], Altitude, Always),
        held(
            "vertical speed [m/s]",
            ["climb_m_s", "vertical_speed_target_m_s"],
            VerticalSpeed,
            WhereHeld,
        ),
        held(
            "flight path above the horizon [deg]",
            ["flight_path_rad", "flight_path_target_rad"],
            FlightPath,
            Always,
        ),
        Panel {
            label: "height above the glide slope [m]",
            column: "above_glide_slope_m",
            target: None,
            held: Some(GlideSlope),
            shown: WhereHeld,
        },
        held("heading [deg]", ["heading_rad", "heading_target_rad"], Heading, WhereHeld),
        Panel {
            label: "bank [deg]",
            column: "bank_rad",
            target: Some("bank_command_rad"),
            held: None,
            shown: WhereHeld,
        },
        plain("air, downward [m/s]", "air_down_m_s", Always),
        plain("throttle", "throttle", WhereItMoves),
        plain(
            "share of the drag due to lift that the ground leaves",
            "ground_effect",
            WhereItMoves,
        ),
        plain("fuel [kg]", "fuel_kg", Always),
    ]
};

const fn held(
    label: &'static str,
    [column, target]: [&'static str; 2],
    quantity: Quantity,
    shown: Shown,
) -> Panel {
    Panel { label, column, target: Some(target), held: Some(quantity), shown }
}

const fn plain(label: &'static str, column: &'static str, shown: Shown) -> Panel {
    Panel { label, column, target: None, held: None, shown }
}

impl Panel {
    /// True where a mode of the autopilot holds what it shows.
    pub(super) fn is_held(&self, autopilot: &Autopilot) -> bool {
        autopilot.modes().iter().any(|mode| self.is_held_in(autopilot, mode))
    }

    fn is_held_in(&self, autopilot: &Autopilot, mode: &Mode) -> bool {
        let mut engaged = mode.engaged.iter().filter_map(|&number| autopilot.loops().get(number));
        match (self.held, self.target) {
            (Some(quantity), _) => {
                let together = matches!(quantity, Quantity::Altitude | Quantity::Airspeed);
                mode.total_energy && together || engaged.any(|outer| outer.holds == quantity)
            }
            (None, Some(_)) => {
                mode.bank_rad.abs() > 0.0 || engaged.any(|outer| outer.moves == Moves::Bank)
            }
            (None, None) => false,
        }
    }

    /// What it is to be in a flight of that name, where the mode of the sample holds it.
    pub(super) fn target(
        &self,
        autopilot: &Autopilot,
        (name, trace): (&str, &Trace),
    ) -> Option<Series> {
        let (column, modes) = (trace.column(self.target?)?, trace.column("mode")?);
        let value = |value: f64| if self.is_in_degrees() { degrees(value) } else { value };
        let y: Vec<f64> = column
            .iter()
            .zip(modes)
            .map(|(target, mode)| match mode_at(autopilot, *mode) {
                Some(mode) if self.is_held_in(autopilot, mode) => value(*target),
                _ => f64::NAN,
            })
            .collect();
        y.iter().any(|value| value.is_finite()).then(|| Series {
            name: format!("target{name}"),
            style: SeriesStyle::Setpoint,
            x: trace.time_s.clone(),
            y,
            stairs: true,
        })
    }

    pub(super) fn is_in_degrees(&self) -> bool {
        self.column.ends_with("_rad")
    }
}

/// How far each configuration is out that moves in the flight.
pub(super) fn deployments(plant: &AircraftPlant, trace: &Trace) -> Vec<Series> {
    let model = plant.aircraft().model().varied();
    let names = model.iter().flat_map(|model| model.deployed());
    let names = names.map(|deployed| deployed.configuration.name.clone());
    let columns = DEPLOYMENT_COLUMNS.into_iter().map(|column| trace.column(column));
    let moving = names.zip(columns).filter_map(|(name, column)| {
        let column = column.filter(|values| moves(values))?;
        Some((name, column.to_vec()))
    });
    let series = |(index, (name, y)): (usize, (String, Vec<f64>))| Series {
        name,
        style: SeriesStyle::Numbered(index),
        x: trace.time_s.clone(),
        y,
        stairs: false,
    };
    moving.enumerate().map(series).collect()
}

/// True for values that are not all the same one.
pub(super) fn moves(values: &[f64]) -> bool {
    values.windows(2).any(|pair| matches!(pair, [one, next] if one.to_bits() != next.to_bits()))
}

/// The mode of a number of a trace, which counts from 1.
fn mode_at(autopilot: &Autopilot, number: f64) -> Option<&Mode> {
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a small whole number, and the cast saturates"
    )]
    let index = (number as usize).checked_sub(1)?;
    autopilot.modes().get(index)
}

/// Each mode that began in a flight: when, s, and its name.
pub(super) fn beginnings<'a>(
    autopilot: &'a Autopilot,
    timing: Timing,
    trace: &Trace,
) -> Vec<(f64, &'a str)> {
    let modes = trace.column("mode").unwrap_or_default();
    let mut before = 0.0;
    let mut found = Vec::new();
    for (k, &mode) in modes.iter().enumerate() {
        if mode > before {
            found.extend(mode_at(autopilot, mode).map(|it| (timing.time_s(k), it.name.as_str())));
            before = mode;
        }
    }
    found
}

/// A sentence for the caption: when which mode began.
pub(super) fn in_words(whose: &str, beginnings: &[(f64, &str)]) -> String {
    let began = |(at_s, name): &(f64, &str)| format!("{name} at {} s", significant(*at_s, 3));
    let all: Vec<String> = beginnings.iter().map(began).collect();
    match all.as_slice() {
        [] | [_] => String::new(),
        all => format!(" Upright lines are beginnings of modes{whose}: {}.", all.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAPTURE: &str = include_str!("../../../../scenarios/gallery/altitude-capture.toml");

    #[test]
    fn targets_are_drawn_where_a_mode_holds_them_and_modes_begin_where_the_trace_says_so() {
        let study = fspid_scenario::file::parse(CAPTURE, "a.toml", None, &[]).expect("a scenario");
        let (autopilot, timing) =
            (study.scenario.autopilot.as_ref().expect("there"), study.scenario.timing);
        let trace = fspid_sim::simulate(&study.scenario).expect("it flies").traces.remove(0);
        let began = beginnings(autopilot, timing, &trace);
        let names: Vec<&str> = began.iter().map(|(_, name)| *name).collect();
        assert_eq!(names, ["level", "climb", "capture"]);
        assert_eq!((began[0].0, began[1].0), (0.0, 5.0));
        let drawn = |column: &str| {
            let panel = PANELS.iter().find(|panel| panel.column == column).expect("there");
            panel.is_held(autopilot).then(|| panel.target(autopilot, ("", &trace))).flatten()
        };
        let altitude = drawn("altitude_m").expect("held in the first mode and the last");
        for (time_s, target_m) in altitude.x.iter().zip(&altitude.y) {
            // The climb holds no altitude, and the capture 1300 ft.
            let climbs = (5.0..began[2].0).contains(time_s);
            assert_eq!(target_m.is_nan(), climbs, "{time_s}");
            assert!(*time_s < began[2].0 || (target_m - 396.24).abs() < 1e-9, "{target_m}");
        }
        assert!(drawn("climb_m_s").is_some() && drawn("airspeed_m_s").is_some());
        for column in ["heading_rad", "bank_rad", "above_glide_slope_m", "flight_path_rad"] {
            assert!(drawn(column).is_none(), "{column}");
        }
        let words = in_words(" of PID", &began);
        assert!(
            words.contains("modes of PID: level at 0 s, climb at 5.00 s, capture at "),
            "{words}"
        );
        assert_eq!(in_words("", &began[..1]), "");
    }
}

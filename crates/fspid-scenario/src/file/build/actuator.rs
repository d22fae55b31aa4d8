//! What moves the elevator.

use fspid_sim::SimError;
use fspid_sim::actuator::{Actuator, Lag, Preset};

use super::{judged, rad};
use crate::file::section::Section;
use fspid_diagnostics::Report;

/// What a number, in rad or rad/s, makes of an actuator.
type Change = fn(Actuator, f64) -> Result<Actuator, SimError>;

/// The keys with one angle, which a preset's may be replaced by.
const ANGLES: [(&str, Change); 5] = [
    ("position_limit_deg", Actuator::with_position_limit),
    ("rate_limit_deg_s", Actuator::with_rate_limit),
    ("deadband_deg", Actuator::with_deadband),
    ("backlash_deg", Actuator::with_play),
    ("bias_deg", Actuator::with_bias),
];

/// The preset or an ideal actuator, with everything that is given beside it.
pub(super) fn actuator(report: &mut Report, section: &Section) -> Option<Actuator> {
    let preset = section.text("preset").and_then(Preset::from_name);
    let base = preset.map_or_else(|| Ok(Actuator::ideal()), |preset| preset.actuator());
    let mut actuator = judged(report, (section, "preset"), base)?;
    if let Some(lag) = lag(report, section)? {
        actuator = actuator.with_lag(lag);
    }
    if let Some((least, most)) = section.interval("travel_deg") {
        let stopped = actuator.with_travel(rad(least), rad(most));
        actuator = judged(report, (section, "travel_deg"), stopped)?;
    }
    for (key, with) in ANGLES {
        if let Some(value) = section.number(key) {
            actuator = judged(report, (section, key), with(actuator, rad(value)))?;
        }
    }
    let delay = usize::try_from(section.integer("delay_samples")?).unwrap_or(usize::MAX);
    judged(report, (section, "delay_samples"), actuator.with_delay(delay))
}

/// The lag that is given; `Some(None)` for none.
#[allow(clippy::option_option, reason = "no lag is one thing, a wrong one another")]
fn lag(report: &mut Report, section: &Section) -> Option<Option<Lag>> {
    let time_constant_s = section.number("time_constant_s").filter(|value| *value > 0.0);
    let second = (section.number("natural_frequency_rad_s"), section.number("damping"));
    let lag = match (time_constant_s, second) {
        (None, (None, None)) => return Some(None),
        (Some(time_constant_s), (None, None)) if !(1.0 / time_constant_s).is_finite() => {
            return too_short(report, section);
        }
        (Some(time_constant_s), (None, None)) => Lag::first_order(time_constant_s),
        (None, (Some(frequency_rad_s), Some(damping))) => {
            Lag::second_order(frequency_rad_s, damping)
        }
        (Some(_), _) => return two_lags(report, section),
        (None, (frequency_rad_s, _)) => return half_a_lag(report, section, frequency_rad_s),
    };
    judged(report, (section, "time_constant_s"), lag).map(Some)
}

fn too_short<T>(report: &mut Report, section: &Section) -> Option<T> {
    let (key, allowed) = ("time_constant_s", "0 for none, or 1e-300 s or more");
    let message = "so short that its rate is infinite";
    report.value(section.at(key), &section.path(key), message, allowed);
    None
}

fn two_lags<T>(report: &mut Report, section: &Section) -> Option<T> {
    let key = if section.given("damping") { "damping" } else { "natural_frequency_rad_s" };
    let allowed = "a lag of first order or one of second order";
    report.value(
        section.at(key),
        &section.path(key),
        "not together with `time_constant_s`",
        allowed,
    );
    None
}

fn half_a_lag<T>(report: &mut Report, section: &Section, frequency: Option<f64>) -> Option<T> {
    let (key, other) = match frequency {
        Some(_) => ("damping", "natural_frequency_rad_s"),
        None => ("natural_frequency_rad_s", "damping"),
    };
    let message = format!("missing key; it goes with `{other}`");
    report.missing(section.place, &section.path(key), message, "a finite number above 0");
    None
}

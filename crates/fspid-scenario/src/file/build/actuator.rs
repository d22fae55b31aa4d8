//! The servo, or the actuator in its place.

use fspid_sim::actuator::{Actuator, Lag, Preset};
use fspid_sim::{Servo, SimError};

use super::{judged, rad};
use crate::file::section::Section;
use fspid_diagnostics::Report;

/// Keys that a plain servo does not have.
const MORE: [&str; 7] = [
    "preset",
    "natural_frequency_rad_s",
    "damping",
    "travel_deg",
    "deadband_deg",
    "backlash_deg",
    "bias_deg",
];

/// What moves the elevator.
#[derive(Clone, Copy)]
pub(super) struct Drive {
    pub(super) servo: Servo,
    /// In place of the servo.
    pub(super) actuator: Option<Actuator>,
}

impl Drive {
    pub(super) fn ideal() -> Self {
        Self { servo: Servo::ideal(), actuator: None }
    }
}

/// The servo of the paper for its four keys, so that its bits stay; an actuator for more.
pub(super) fn drive(report: &mut Report, section: &Section) -> Option<Drive> {
    if !MORE.iter().any(|key| section.given(key)) {
        return Some(Drive { servo: servo(report, section)?, actuator: None });
    }
    let lag = lag(report, section)?;
    let actuator = Some(judged(report, (section, given(section)), actuator(section, lag))?);
    Some(Drive { servo: Servo::ideal(), actuator })
}

/// The first key that only actuators have.
fn given(section: &Section) -> &'static str {
    MORE.into_iter().find(|key| section.given(key)).unwrap_or("preset")
}

fn servo(report: &mut Report, section: &Section) -> Option<Servo> {
    let delay = usize::try_from(section.integer("delay_samples")?).unwrap_or(usize::MAX);
    let lag = Servo::first_order(section.number("time_constant_s")?);
    let lag = judged(report, (section, "time_constant_s"), lag)?;
    let time_constant_s = section.number("time_constant_s")?;
    if time_constant_s > 0.0 && !(1.0 / time_constant_s).is_finite() {
        let path = section.path("time_constant_s");
        let allowed = "0 for none, or 1e-300 s or more";
        report.value(
            section.at("time_constant_s"),
            &path,
            "so short that its rate is infinite",
            allowed,
        );
        return None;
    }
    let servo =
        lag.with_delay(delay).and_then(|servo| match section.number("position_limit_deg") {
            Some(limit_deg) => servo.with_position_limit(rad(limit_deg)),
            None => Ok(servo),
        });
    let servo = servo.and_then(|servo| match section.number("rate_limit_deg_s") {
        Some(limit_deg_s) => servo.with_rate_limit(rad(limit_deg_s)),
        None => Ok::<_, SimError>(servo),
    });
    judged(report, (section, "delay_samples"), servo)
}

/// The lag that is given; `Some(None)` for none.
#[allow(clippy::option_option, reason = "no lag is one thing, a wrong one another")]
fn lag(report: &mut Report, section: &Section) -> Option<Option<Lag>> {
    let time_constant_s = section.number("time_constant_s").filter(|value| *value > 0.0);
    let second = (section.number("natural_frequency_rad_s"), section.number("damping"));
    let lag = match (time_constant_s, second) {
        (None, (None, None)) => return Some(None),
        (Some(time_constant_s), (None, None)) => Lag::first_order(time_constant_s),
        (None, (Some(frequency_rad_s), Some(damping))) => {
            Lag::second_order(frequency_rad_s, damping)
        }
        (Some(_), _) => return two_lags(report, section),
        (None, (frequency_rad_s, _)) => return half_a_lag(report, section, frequency_rad_s),
    };
    judged(report, (section, "time_constant_s"), lag).map(Some)
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

/// What a number, in rad or rad/s, makes of an actuator.
type Change = fn(Actuator, f64) -> Result<Actuator, SimError>;

fn actuator(section: &Section, lag: Option<Lag>) -> Result<Actuator, SimError> {
    let preset = section.text("preset").and_then(Preset::from_name);
    let mut actuator = match preset {
        Some(preset) => preset.actuator()?,
        None => Actuator::new(Lag::NONE),
    };
    if let Some(lag) = lag {
        actuator = actuator.with_lag(lag);
    }
    if let Some((least, most)) = section.interval("travel_deg") {
        actuator = actuator.with_travel(rad(least), rad(most))?;
    }
    let numbers: [(&str, Change); 5] = [
        ("position_limit_deg", |it, limit| it.with_command_limits(-limit, limit)),
        ("rate_limit_deg_s", Actuator::with_rate_limit),
        ("deadband_deg", Actuator::with_deadband),
        ("backlash_deg", Actuator::with_play),
        ("bias_deg", Actuator::with_bias),
    ];
    for (key, with) in numbers {
        if let Some(value) = section.number(key) {
            actuator = with(actuator, rad(value))?;
        }
    }
    let delay = section.integer("delay_samples").unwrap_or(0);
    actuator.with_delay(usize::try_from(delay).unwrap_or(usize::MAX))
}

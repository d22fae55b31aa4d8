//! The servo, or the actuator in its place.

use fspid_sim::actuator::{Actuator, Lag, Preset};
use fspid_sim::{Servo, SimError};

use super::{judged, rad};
use crate::file::spec::actuator as keys;
use crate::keyed::{Key, KeyName, Section};
use fspid_diagnostics::Report;

/// Keys that a plain servo does not have.
const MORE: [KeyName; 7] = [
    keys::PRESET.name,
    keys::NATURAL_FREQUENCY_RAD_S.name,
    keys::DAMPING.name,
    keys::TRAVEL_DEG.name,
    keys::DEADBAND_DEG.name,
    keys::BACKLASH_DEG.name,
    keys::BIAS_DEG.name,
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
    let Some(given) = MORE.into_iter().find(|key| section.given(*key)) else {
        return Some(Drive { servo: servo(report, section)?, actuator: None });
    };
    let lag = lag(report, section)?;
    let actuator = Some(judged(report, (section, given), actuator(section, lag))?);
    Some(Drive { servo: Servo::ideal(), actuator })
}

fn servo(report: &mut Report, section: &Section) -> Option<Servo> {
    let delay = usize::try_from(section.get(keys::DELAY_SAMPLES)?).unwrap_or(usize::MAX);
    let lag = Servo::first_order(section.get(keys::TIME_CONSTANT_S)?);
    let lag = judged(report, (section, keys::TIME_CONSTANT_S), lag)?;
    let time_constant_s = section.get(keys::TIME_CONSTANT_S)?;
    if time_constant_s > 0.0 && !(1.0 / time_constant_s).is_finite() {
        let path = section.path(keys::TIME_CONSTANT_S);
        let allowed = "0 for none, or 1e-300 s or more";
        report.value(
            section.at(keys::TIME_CONSTANT_S),
            &path,
            "so short that its rate is infinite",
            allowed,
        );
        return None;
    }
    let servo =
        lag.with_delay(delay).and_then(|servo| match section.get(keys::POSITION_LIMIT_DEG) {
            Some(limit_deg) => servo.with_position_limit(rad(limit_deg)),
            None => Ok(servo),
        });
    let servo = servo.and_then(|servo| match section.get(keys::RATE_LIMIT_DEG_S) {
        Some(limit_deg_s) => servo.with_rate_limit(rad(limit_deg_s)),
        None => Ok::<_, SimError>(servo),
    });
    judged(report, (section, keys::DELAY_SAMPLES), servo)
}

/// The lag that is given; `Some(None)` for none.
#[allow(clippy::option_option, reason = "no lag is one thing, a wrong one another")]
fn lag(report: &mut Report, section: &Section) -> Option<Option<Lag>> {
    let time_constant_s = section.get(keys::TIME_CONSTANT_S).filter(|value| *value > 0.0);
    let second = (section.get(keys::NATURAL_FREQUENCY_RAD_S), section.get(keys::DAMPING));
    let lag = match (time_constant_s, second) {
        (None, (None, None)) => return Some(None),
        (Some(time_constant_s), (None, None)) => Lag::first_order(time_constant_s),
        (None, (Some(frequency_rad_s), Some(damping))) => {
            Lag::second_order(frequency_rad_s, damping)
        }
        (Some(_), _) => return two_lags(report, section),
        (None, (frequency_rad_s, _)) => return half_a_lag(report, section, frequency_rad_s),
    };
    judged(report, (section, keys::TIME_CONSTANT_S), lag).map(Some)
}

fn two_lags<T>(report: &mut Report, section: &Section) -> Option<T> {
    let [second, damping] = [keys::NATURAL_FREQUENCY_RAD_S, keys::DAMPING];
    let key = if section.given(damping) { damping } else { second };
    let allowed = "a lag of first order or one of second order";
    section.wrong(report, key, "not together with `time_constant_s`", allowed);
    None
}

fn half_a_lag<T>(report: &mut Report, section: &Section, frequency: Option<f64>) -> Option<T> {
    let (key, other) = match frequency {
        Some(_) => (keys::DAMPING, keys::NATURAL_FREQUENCY_RAD_S),
        None => (keys::NATURAL_FREQUENCY_RAD_S, keys::DAMPING),
    };
    let message = format!("missing key; it goes with `{}`", other.name);
    section.problem(report, key, message, "a finite number above 0");
    None
}

/// What a number, in rad or rad/s, makes of an actuator.
type Change = fn(Actuator, f64) -> Result<Actuator, SimError>;

fn actuator(section: &Section, lag: Option<Lag>) -> Result<Actuator, SimError> {
    let preset = section.get(keys::PRESET).and_then(Preset::from_name);
    let mut actuator = match preset {
        Some(preset) => preset.actuator()?,
        None => Actuator::new(Lag::NONE),
    };
    if let Some(lag) = lag {
        actuator = actuator.with_lag(lag);
    }
    if let Some((least, most)) = section.get(keys::TRAVEL_DEG) {
        actuator = actuator.with_travel(rad(least), rad(most))?;
    }
    let numbers: [(Key<f64>, Change); 5] = [
        (keys::POSITION_LIMIT_DEG, |it, limit| it.with_command_limits(-limit, limit)),
        (keys::RATE_LIMIT_DEG_S, Actuator::with_rate_limit),
        (keys::DEADBAND_DEG, Actuator::with_deadband),
        (keys::BACKLASH_DEG, Actuator::with_play),
        (keys::BIAS_DEG, Actuator::with_bias),
    ];
    for (key, with) in numbers {
        if let Some(value) = section.get(key) {
            actuator = with(actuator, rad(value))?;
        }
    }
    let delay = section.get(keys::DELAY_SAMPLES).unwrap_or(0);
    actuator.with_delay(usize::try_from(delay).unwrap_or(usize::MAX))
}

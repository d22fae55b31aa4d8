//! What moves the elevator.

use fspid_sim::SimError;
use fspid_sim::actuator::{Actuator, Lag, Preset};

use super::{judged, rad};
use crate::file::spec::actuator as keys;
use crate::keyed::{Key, Section};
use fspid_diagnostics::Report;

/// What a number, in rad or rad/s, makes of an actuator.
type Change = fn(Actuator, f64) -> Result<Actuator, SimError>;

/// The keys with one angle, which a preset's may be replaced by.
const ANGLES: [(Key<f64>, Change); 5] = [
    (keys::POSITION_LIMIT_DEG, Actuator::with_position_limit),
    (keys::RATE_LIMIT_DEG_S, Actuator::with_rate_limit),
    (keys::DEADBAND_DEG, Actuator::with_deadband),
    (keys::BACKLASH_DEG, Actuator::with_play),
    (keys::BIAS_DEG, Actuator::with_bias),
];

/// The preset or an ideal actuator, with everything that is given beside it.
pub(super) fn actuator(report: &mut Report, section: &Section) -> Option<Actuator> {
    let preset = section.get(keys::PRESET).and_then(Preset::from_name);
    let base = preset.map_or_else(|| Ok(Actuator::ideal()), |preset| preset.actuator());
    let mut actuator = judged(report, (section, keys::PRESET), base)?;
    if let Some(lag) = lag(report, section)? {
        actuator = actuator.with_lag(lag);
    }
    if let Some((least, most)) = section.get(keys::TRAVEL_DEG) {
        let stopped = actuator.with_travel(rad(least), rad(most));
        actuator = judged(report, (section, keys::TRAVEL_DEG), stopped)?;
    }
    for (key, with) in ANGLES {
        if let Some(value) = section.get(key) {
            actuator = judged(report, (section, key), with(actuator, rad(value)))?;
        }
    }
    let delay = usize::try_from(section.get(keys::DELAY_SAMPLES)?).unwrap_or(usize::MAX);
    judged(report, (section, keys::DELAY_SAMPLES), actuator.with_delay(delay))
}

/// The lag that is given; `Some(None)` for none.
#[allow(clippy::option_option, reason = "no lag is one thing, a wrong one another")]
fn lag(report: &mut Report, section: &Section) -> Option<Option<Lag>> {
    let time_constant_s = section.get(keys::TIME_CONSTANT_S).filter(|value| *value > 0.0);
    let second = (section.get(keys::NATURAL_FREQUENCY_RAD_S), section.get(keys::DAMPING));
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
    judged(report, (section, keys::TIME_CONSTANT_S), lag).map(Some)
}

fn too_short<T>(report: &mut Report, section: &Section) -> Option<T> {
    let message = "so short that its rate is infinite";
    section.wrong(report, keys::TIME_CONSTANT_S, message, "0 for none, or 1e-300 s or more");
    None
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

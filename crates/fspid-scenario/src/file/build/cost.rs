//! What could be built and would not be answered: refused at its key, with the reason and the cost.
//!
//! Costs are of one core of a machine of 2024, for the starter's flight of 1001 samples with two controllers
//! (`fspid simulate` with `--set`).

use fspid_sim::actuator::Actuator;
use fspid_sim::sensor::Sensor;
use fspid_sim::{Scenario, Timing};

use super::judged;
use crate::file::spec::scenario as keys;
use crate::file::spec::{actuator, sensor};
use crate::keyed::{Key, Section};
use fspid_diagnostics::Report;

/// Most samples that a command and its answer are on their way. The loop at rest has a state for each, and its cost
/// grows with their cube: 200 take 0.5 s, 500 take 5 s, 1000 take 37 s.
const MOST_ON_THEIR_WAY: f64 = 400.0;
/// Most looks of a sensor within a sample of the loop; each costs some 20 ns: 1000 take 0.05 s, 10^10 years.
const MOST_LOOKS: f64 = 10_000.0;
/// Most pieces in which a sample of an actuator of second order is searched for an event: 1600 take 0.7 s, 16 000 take
/// 13 s.
const MOST_PIECES: u32 = 1600;

/// Says what costs too much.
pub(super) fn check(report: &mut Report, section: &Section, scenario: &Scenario) {
    let Scenario { timing, actuator, surroundings, .. } = scenario;
    if let Some(part) = section.get(keys::ACTUATOR) {
        check_pieces(report, part, *actuator, *timing);
    }
    let channels = [
        (sensor::PITCH, surroundings.pitch_sensor.as_ref()),
        (sensor::RATE, surroundings.rate_sensor.as_ref()),
    ];
    let mut longest_s = 0.0_f64;
    for (key, channel) in channels {
        if let (Some(part), Some(channel)) = (section.get(keys::SENSOR), channel) {
            check_sensor(report, (part, key), channel, *timing);
            longest_s = longest_s.max(channel.model().delay_s);
        }
    }
    // A nonlinear aircraft has no loop at rest, and waits without cost.
    let samples = actuator.delay_samples() as f64 + (longest_s / timing.dt_s()).ceil();
    if scenario.plant.linear().is_some() && samples > MOST_ON_THEIR_WAY && report.count() == 0 {
        too_late(report, section, samples, *timing);
    }
}

fn check_pieces(report: &mut Report, part: &Section, actuator: Actuator, timing: Timing) {
    let pieces = actuator.lag().pieces(timing.dt_s());
    if pieces > MOST_PIECES {
        let message = "so fast beside the sample period that a flight would not end";
        let allowed = format!(
            "2·damping·natural_frequency_rad_s, and that frequency itself, up to {} times 1/sample_period_s; or no lag, which is the same to the eye",
            MOST_PIECES / 16
        );
        part.wrong(report, actuator::NATURAL_FREQUENCY_RAD_S, message, allowed);
    }
}

fn check_sensor(
    report: &mut Report,
    (part, channel): (&Section, Key<Section>),
    sensor: &Sensor,
    timing: Timing,
) {
    let (own, dt_s) = (part.get(channel), timing.dt_s());
    let period_s = sensor.model().period_s;
    if period_s > 0.0 && dt_s / period_s > MOST_LOOKS {
        let message =
            "so short that a flight would not end: the sensor looks more often than it is asked";
        let allowed =
            format!("0, or at least {:e} s: {MOST_LOOKS} looks a sample", dt_s / MOST_LOOKS);
        match own {
            Some(own) => own.wrong(report, sensor::PERIOD_S, message, allowed),
            None => part.wrong(report, sensor::PRESET, message, allowed),
        }
    }
    let memory = sensor.memory_samples(dt_s);
    match own {
        Some(own) if own.given(sensor::DELAY_S) => {
            judged(report, (own, sensor::DELAY_S), memory);
        }
        Some(own) => {
            judged(report, (own, sensor::PERIOD_S), memory);
        }
        None => {
            judged(report, (part, sensor::PRESET), memory);
        }
    }
}

/// Told at the key that is asked for the longest wait.
fn too_late(report: &mut Report, section: &Section, samples: f64, timing: Timing) {
    let message = format!(
        "{samples} samples of {:?} s on their way around the loop: the loop at rest has a state for each, and its cost grows with their cube (1000 take half a minute)",
        timing.dt_s()
    );
    let allowed =
        format!("up to {MOST_ON_THEIR_WAY} samples: a longer sample period or a shorter delay");
    let delay =
        section.get(keys::ACTUATOR).filter(|part| part.get(actuator::DELAY_SAMPLES) > Some(0));
    let sensor = section.get(keys::SENSOR);
    let channels = [sensor::PITCH, sensor::RATE].into_iter();
    let late = channels.filter_map(|key| sensor?.get(key)).find(|it| it.given(sensor::DELAY_S));
    match (delay, late, sensor) {
        (Some(part), None, _) => part.wrong(report, actuator::DELAY_SAMPLES, message, allowed),
        (_, Some(part), _) => part.wrong(report, sensor::DELAY_S, message, allowed),
        (None, None, Some(part)) => part.wrong(report, sensor::PRESET, message, allowed),
        (None, None, None) => {}
    }
}

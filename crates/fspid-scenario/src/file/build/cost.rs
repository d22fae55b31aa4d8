//! What could be built and would not be answered: refused at its key, with the reason and the cost.
//!
//! Costs are of one core of a machine of 2024, for the starter's flight of 1001 samples with two controllers
//! (`fspid simulate` with `--set`).

use fspid_sim::actuator::Actuator;
use fspid_sim::loop_model::{MOST_AS_STATES, Sensing};
use fspid_sim::sensor::Sensor;
use fspid_sim::{Scenario, Timing};

use super::judged;
use crate::file::spec::scenario as keys;
use crate::file::spec::{actuator, sensor};
use crate::keyed::{Key, KeyName, Section};
use fspid_diagnostics::Report;

/// Most samples that a command and its answer are on their way. Whether the loop holds is asked along a circle, in steps that
/// grow with them: 10 000 take 0.1 s. With outer loops each is a state of every mode's matrix, [`MOST_AS_STATES`] at most.
const MOST_ON_THEIR_WAY: usize = 20_000;
/// Most looks of a sensor within a sample of the loop; each costs some 20 ns: 1000 take 0.05 s, 10^10 years.
const MOST_LOOKS: f64 = 10_000.0;
/// Most pieces in which a sample of an actuator of second order is searched for an event: 1600 take 0.7 s, 16 000 take
/// 13 s.
const MOST_PIECES: u32 = 1600;

/// Says what costs too much.
pub(super) fn check(report: &mut Report, section: &Section, scenario: &Scenario) {
    let Scenario { timing, actuator, .. } = scenario;
    if let Some(part) = section.get(keys::ACTUATOR) {
        check_pieces(report, part, *actuator, *timing);
    }
    for (key, channel) in channels(scenario) {
        if let (Some(part), Some(channel)) = (section.get(keys::SENSOR), channel) {
            check_sensor(report, (part, key), channel, *timing);
        }
    }
    if report.count() == 0 {
        check_way(report, section, scenario);
    }
}

/// What measures pitch and pitch rate, by the keys of their channels.
fn channels(scenario: &Scenario) -> [(Key<Section>, Option<&Sensor>); 2] {
    let around = &scenario.surroundings;
    [(sensor::PITCH, around.pitch_sensor.as_ref()), (sensor::RATE, around.rate_sensor.as_ref())]
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
    let own = part.get(channel);
    let keys: [KeyName; 2] = match own {
        Some(own) if own.given(sensor::DELAY_S) => {
            [sensor::PERIOD_S.into(), sensor::DELAY_S.into()]
        }
        Some(_) => [sensor::PERIOD_S.into(); 2],
        None => [sensor::PRESET.into(); 2],
    };
    check_times(report, (own.unwrap_or(part), keys), sensor, timing.dt_s());
}

/// How often a sensor looks, told at the first key, and how long it remembers, told at the second.
pub(super) fn check_times(
    report: &mut Report,
    (part, [looks, memory]): (&Section, [KeyName; 2]),
    sensor: &Sensor,
    dt_s: f64,
) {
    let period_s = sensor.model().period_s;
    if period_s > 0.0 && dt_s / period_s > MOST_LOOKS {
        let message =
            "so short that a flight would not end: the sensor looks more often than it is asked";
        let allowed =
            format!("0, or at least {:e} s: {MOST_LOOKS} looks a sample", dt_s / MOST_LOOKS);
        part.wrong(report, looks, message, allowed);
    }
    judged(report, (part, memory), sensor.memory_samples(dt_s));
}

/// Refuses what waits too long on its way around the loop, at the key that has most of it wait.
fn check_way(report: &mut Report, section: &Section, scenario: &Scenario) {
    let delay = section.get(keys::ACTUATOR).map(|part| {
        let key = KeyName::from(actuator::DELAY_SAMPLES);
        (scenario.actuator.delay_samples(), part, key)
    });
    let remembered = channels(scenario).into_iter().filter_map(|(key, channel)| {
        let samples = Sensing::through(channel, scenario.timing.dt_s()).samples;
        let (part, key) = place_of(section.get(keys::SENSOR)?, key, channel?);
        Some((samples, part, key))
    });
    let ways: Vec<(usize, &Section, KeyName)> = delay.into_iter().chain(remembered).collect();
    let samples = ways.iter().fold(0_usize, |sum, way| sum.saturating_add(way.0));
    let Some((_, part, key)) = ways.into_iter().max_by_key(|way| way.0) else { return };
    let (most, cost) = match scenario.autopilot {
        Some(_) => (
            MOST_AS_STATES,
            "with outer loops each mode has a state for each, and its cost grows with their cube",
        ),
        None => (MOST_ON_THEIR_WAY, "whether it holds is asked in steps that grow with them"),
    };
    if samples > most {
        let message = format!(
            "{samples} samples of {:?} s on their way around the loop: {cost}",
            scenario.timing.dt_s()
        );
        let allowed = format!(
            "up to {most} samples: a longer sample period, or a shorter delay or sampling time"
        );
        part.wrong(report, key, message, allowed);
    }
}

/// The key that says how old a channel's values are: its delay or its sampling time, whichever is longer, or the preset.
fn place_of<'a>(
    sensors: &'a Section,
    channel: Key<Section>,
    sensor: &Sensor,
) -> (&'a Section, KeyName) {
    let model = sensor.model();
    let key = match model.delay_s >= model.period_s {
        true => KeyName::from(sensor::DELAY_S),
        false => KeyName::from(sensor::PERIOD_S),
    };
    match sensors.get(channel).filter(|own| own.given(key)) {
        Some(own) => (own, key),
        None => (sensors, sensor::PRESET.into()),
    }
}

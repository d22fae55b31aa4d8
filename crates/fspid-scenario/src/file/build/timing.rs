//! Samples, and what depends on when they are taken.

use fspid_sim::actuator::Actuator;
use fspid_sim::signal::{Profile, Shape};
use fspid_sim::{LinearPlant, Plant, PlantChange, Scenario, SimError, Timing};

use super::{data, elevator_sign, judged, order_differs};
use crate::file::files::Files;
use crate::file::spec::configuration::CONFIGURATION_CHANGE;
use crate::file::spec::flight;
use crate::file::spec::scenario as keys;
use crate::file::spec::signal::{FREQUENCY_HZ, PULSE_WIDTH_S, SignalKind};
use crate::file::spec::simulator;
use crate::keyed::{KeyName, Section};
use fspid_diagnostics::Report;
use fspid_diagnostics::digits::to_digits;

/// Most samples that ramps of the plant may take, each with a discretisation of its own.
const MOST_RAMP_SAMPLES: f64 = 100_000.0;

/// Below this damping ratio, of which a step is overshot by 16 %, a servo is told to swing: a choice of this project.
const SWINGS_BELOW: f64 = 0.5;

pub(super) fn timing(report: &mut Report, section: &Section) -> Option<Timing> {
    let dt_s = section.get(keys::SAMPLE_PERIOD_S)?;
    let duration_s = section.get(keys::DURATION_S)?;
    match Timing::new(dt_s, duration_s) {
        Err(SimError::TooManySamples { found, most }) => {
            let many = match found.is_finite() {
                true => format!("{found:.1e}"),
                false => "endlessly many".to_owned(),
            };
            let message = format!("{many} samples of {dt_s:?} s are too many");
            let allowed =
                format!("up to {most} samples: a shorter flight or a longer sample period");
            section.wrong(report, keys::DURATION_S, message, allowed);
            None
        }
        Err(SimError::Number { .. }) if duration_s < dt_s => {
            let allowed = format!(
                "at least one sample period of {dt_s:?} s, or a sample period of at most {duration_s:?} s"
            );
            section.wrong(report, keys::DURATION_S, "shorter than a sample", allowed);
            None
        }
        other => {
            let timing = judged(report, (section, keys::DURATION_S), other)?;
            warn_of_one_sample(report, section, (duration_s, timing));
            Some(timing)
        }
    }
}

/// Warns of a sample that takes longer than the flight: half of it and more is rounded up to the whole.
fn warn_of_one_sample(report: &mut Report, section: &Section, (duration_s, timing): (f64, Timing)) {
    let dt_s = timing.dt_s();
    if duration_s < dt_s {
        let path = section.path(keys::SAMPLE_PERIOD_S);
        report.warn(format!(
            "{path} is {dt_s:?} s, longer than the flight of {duration_s:?} s: one sample period is flown, and the flight ends at {:?} s",
            timing.end_s()
        ));
    }
}

/// Most rows of all traces together; nine columns of this length take 1.4 GB.
const MOST_ROWS: usize = 2 * fspid_sim::MAX_ROWS;

/// Refuses a comparison whose traces would not fit into memory.
pub(super) fn check_memory(report: &mut Report, section: &Section, timing: Option<Timing>) {
    let Some(timing) = timing else { return };
    let controllers = section.sections(keys::CONTROLLER).len();
    if timing.rows() * controllers <= MOST_ROWS {
        return;
    }
    if let Some(part) = section.get(keys::LOOP) {
        let message = format!("{controllers} traces of {} samples are too many", timing.rows());
        let allowed = format!("up to {MOST_ROWS} samples in all traces together");
        part.wrong(report, keys::DURATION_S, message, allowed);
    }
}

/// When samples are taken, and of what moves the plant.
#[derive(Clone, Copy)]
pub(super) struct Sampling {
    pub(super) timing: Timing,
    pub(super) actuator: Actuator,
}

/// Finds out whether the plant can be sampled at all: its coefficients may be too far apart.
fn can_be_sampled(plant: &LinearPlant, sampling: Sampling) -> Result<(), SimError> {
    let dt_s = sampling.timing.dt_s();
    let still = Profile::new(0.0, Shape::Step { at_s: 0.0 })?;
    let mut scenario = Scenario::new("", plant.clone(), Timing::new(dt_s, dt_s)?, still);
    scenario.actuator = sampling.actuator;
    scenario.prepare().map(|_| ())
}

pub(super) fn check_plant(
    report: &mut Report,
    section: &Section,
    plant: &LinearPlant,
    sampling: Sampling,
) {
    if let Some(place) = place_of_plant(section) {
        judged(report, place, can_be_sampled(plant, sampling));
    }
}

/// Where the scenario says what flies.
pub(super) fn place_of_plant(section: &Section) -> Option<(&Section, KeyName)> {
    if let Some(part) = section.get(keys::PLANT) {
        return Some((part, key_of(part)));
    }
    if let Some(part) = section.get(keys::SIMULATOR) {
        let key = match part.variant() {
            Some(simulator::SimulatorKind::Fmu) => simulator::FILE,
            Some(simulator::SimulatorKind::Jsbsim) | None => simulator::AIRCRAFT,
        };
        return Some((part, key.into()));
    }
    let part = section.get(keys::AIRCRAFT)?;
    let key = if part.given(flight::FILE) { flight::FILE } else { flight::NAME };
    Some((part, key.into()))
}

/// The key that gave a plant.
fn key_of(part: &Section) -> KeyName {
    let named = [keys::PRESET, keys::FILE].into_iter().find(|key| part.given(*key));
    named.map_or(keys::DENOMINATOR.name, |key| key.name)
}

/// The changes of the plant, in order of time; what is wrong with one is reported.
pub(super) fn plant_changes(
    report: &mut Report,
    files: &mut Files<'_>,
    parts: &[Section],
    plant: Option<&Plant>,
    sampling: Option<Sampling>,
) -> Vec<PlantChange> {
    if let Some(Plant::Aircraft(_) | Plant::External(_)) = plant {
        parts.iter().for_each(|part| refuse_change(report, part));
        return Vec::new();
    }
    let plant = plant.and_then(Plant::linear);
    let mut changes = Vec::new();
    let mut before_s = f64::NEG_INFINITY;
    for part in parts.iter().filter(|part| part.sound) {
        let Some(at_s) = part.get(keys::AT_S) else {
            continue;
        };
        // Written so that NaN fails.
        if !(at_s > before_s) {
            let allowed = format!("after the change before it, at {before_s:?} s");
            part.wrong(report, keys::AT_S, "not in order of time", allowed);
        }
        before_s = at_s;
        let sign = plant.map(LinearPlant::elevator_sign);
        let Some(target) = changed(report, files, part, sign) else {
            continue;
        };
        if let Some(plant) = plant
            && order_differs(plant, &target)
        {
            let key = key_of(part);
            let message = format!(
                "the plant would change from order {} to order {}",
                plant.order(),
                target.order()
            );
            let allowed = "a denominator of the same length";
            part.problem(report, key, message, allowed);
            continue;
        }
        if let Some(sampling) = sampling {
            let sampled = can_be_sampled(&target, sampling);
            judged(report, (part, key_of(part)), sampled);
            check_ramp(report, part, sampling.timing);
        }
        let change = PlantChange::new(at_s, part.get(keys::RAMP_S).unwrap_or(0.0), target);
        changes.extend(judged(report, (part, keys::AT_S), change));
    }
    changes
}

fn refuse_change(report: &mut Report, part: &Section) {
    let message = "an aircraft that is not linear cannot be changed in flight";
    report.value(part.place, &part.path, message, "changes of a `plant`");
}

fn changed(
    report: &mut Report,
    files: &mut Files<'_>,
    part: &Section,
    sign: Option<fspid_sim::ElevatorSign>,
) -> Option<LinearPlant> {
    if part.given(keys::NUMERATOR) {
        // Where the plant itself is wrong its sign is unknown; the coefficients are judged anyhow.
        let sign = elevator_sign(part).or(sign);
        let sign = sign.unwrap_or(fspid_sim::ElevatorSign::NoseDownPositive);
        return data::coefficients(report, part, sign);
    }
    data::plant(report, files, part)
}

/// Warns of a pulse between two samples, which acts at none.
fn warn_of_brief(report: &mut Report, part: &Section, timing: Timing) {
    if part.variant() != Some(SignalKind::Pulse) {
        return;
    }
    let Some(width_s) = part.get(PULSE_WIDTH_S) else { return };
    let at_s = part.get(keys::AT_S).unwrap_or(0.0);
    let ends = [at_s, at_s + width_s].map(|end_s| timing.first_sample_at(end_s));
    if ends[0] == ends[1] && at_s <= timing.end_s() {
        let path = part.path(PULSE_WIDTH_S);
        let dt_s = timing.dt_s();
        report.warn(format!(
            "{path} is {width_s:?} s from {at_s:?} s on, and no sample lies within: it does not act; samples are {dt_s:?} s apart"
        ));
    }
}

/// Warns of a servo that swings between samples, where nothing of it is seen.
fn warn_of_swinging(report: &mut Report, scenario: &Scenario) {
    let lag = scenario.actuator.lag();
    let Some((natural_frequency_rad_s, damping)) = lag.second_order_parameters() else { return };
    let most_rad_s = core::f64::consts::PI / scenario.timing.dt_s();
    if natural_frequency_rad_s > most_rad_s && damping < SWINGS_BELOW {
        report.warn(format!(
            "the actuator swings at {natural_frequency_rad_s:?} rad/s between samples, which show up to {} rad/s: travel and rate of the elevator are of what samples show",
            to_digits(most_rad_s, 4)
        ));
    }
}

fn check_ramp(report: &mut Report, part: &Section, timing: Timing) {
    let ramp_s = part.get(keys::RAMP_S).unwrap_or(0.0);
    let start_s = part.get(keys::AT_S).unwrap_or(0.0).min(timing.end_s());
    let samples = ramp_s.min(timing.end_s() - start_s) / timing.dt_s();
    // Written so that NaN fails.
    if !(samples <= MOST_RAMP_SAMPLES) {
        let allowed = format!("up to {MOST_RAMP_SAMPLES} samples in a ramp");
        part.wrong(report, keys::RAMP_S, "too long a ramp", allowed);
    }
}

/// What can only be judged of the flight as a whole, and what is probably not meant.
pub(super) fn check_flight(report: &mut Report, section: &Section, scenario: &Scenario) {
    let end_s = scenario.timing.end_s();
    let late = |report: &mut Report, part: &Section| {
        let at_s = part.get(keys::AT_S).unwrap_or(0.0);
        if at_s > end_s {
            let path = part.path(keys::AT_S);
            report.warn(format!("{path} is {at_s:?} s, after the flight's end at {end_s:?} s"));
        }
    };
    let disturbances = section.sections(keys::DISTURBANCE);
    for part in section.get(keys::SETPOINT).into_iter().chain(disturbances) {
        late(report, part);
        warn_of_brief(report, part, scenario.timing);
        let nyquist_hz = 0.5 / scenario.timing.dt_s();
        let frequency_hz = part.get(FREQUENCY_HZ).unwrap_or(0.0);
        if frequency_hz > nyquist_hz {
            let path = part.path(FREQUENCY_HZ);
            report.warn(format!(
                "{path} is {frequency_hz:?} Hz, but samples show at most {nyquist_hz:?} Hz"
            ));
        }
    }
    warn_of_swinging(report, scenario);
    let others = [keys::GUST, CONFIGURATION_CHANGE].into_iter();
    others.flat_map(|key| section.sections(key)).for_each(|part| late(report, part));
    check_plant_changes(report, section.sections(keys::PLANT_CHANGE), scenario);
}

/// Ramps that cannot be flown, and plants that a flight does not come to, which its loop at rest is judged with.
fn check_plant_changes(report: &mut Report, changes: &[Section], scenario: &Scenario) {
    let end_s = scenario.timing.end_s();
    for part in changes {
        let at_s = part.get(keys::AT_S).unwrap_or(0.0);
        let reached_s = at_s + part.get(keys::RAMP_S).unwrap_or(0.0);
        // The same allowance for rounding as for samples.
        if reached_s > end_s + 1e-6 * scenario.timing.dt_s() {
            let path = part.path(if at_s > end_s { keys::AT_S } else { keys::RAMP_S });
            report.warn(format!(
                "{path}: the plant that it leads to is reached at {reached_s:?} s, after the flight's end at {end_s:?} s; the loop at rest is judged with that plant too"
            ));
        }
    }
    if report.count() > 0 {
        return;
    }
    if let Some((number, at_s)) = scenario.ramp_without_effect() {
        if let Some(ramp) = changes.get(number) {
            let refused: Result<(), _> = Err(SimError::RampWithoutEffect { at_s });
            judged(report, (ramp, keys::RAMP_S), refused);
        }
        return;
    }
    let mut ramps = changes.iter().filter(|part| part.get(keys::RAMP_S) > Some(0.0));
    if let Some(ramp) = ramps.next_back() {
        judged(report, (ramp, keys::RAMP_S), scenario.prepare());
    }
}

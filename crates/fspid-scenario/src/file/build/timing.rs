//! Samples, and what depends on when they are taken.

use fspid_sim::actuator::Actuator;
use fspid_sim::signal::{Profile, Shape};
use fspid_sim::{LinearPlant, Plant, PlantChange, Scenario, SimError, Timing};

use super::{data, elevator_sign, judged, order_differs};
use crate::file::files::Files;
use crate::file::section::Section;
use fspid_diagnostics::Report;

/// Most samples that ramps of the plant may take, each with a discretisation of its own.
const MOST_RAMP_SAMPLES: f64 = 100_000.0;

pub(super) fn timing(report: &mut Report, section: &Section) -> Option<Timing> {
    let dt_s = section.number("sample_period_s")?;
    let duration_s = section.number("duration_s")?;
    match Timing::new(dt_s, duration_s) {
        Err(SimError::TooManySamples { found, most }) => {
            let message = format!("{found:.1e} samples of {dt_s:?} s are too many");
            let allowed =
                format!("up to {most} samples: a shorter flight or a longer sample period");
            let (place, path) = (section.at("duration_s"), section.path("duration_s"));
            report.value(place, &path, message, allowed);
            None
        }
        Err(SimError::Number { .. }) if duration_s < dt_s => {
            let (place, path) = (section.at("duration_s"), section.path("duration_s"));
            let allowed = format!("at least one sample period of {dt_s:?} s");
            report.value(place, &path, "shorter than a sample", allowed);
            None
        }
        other => judged(report, (section, "duration_s"), other),
    }
}

/// Most rows of all traces together; nine columns of this length take 1.4 GB.
const MOST_ROWS: usize = 2 * fspid_sim::MAX_ROWS;

/// Refuses a comparison whose traces would not fit into memory.
pub(super) fn check_memory(report: &mut Report, section: &Section, timing: Timing) {
    let controllers = section.sections("controller").len();
    if timing.rows() * controllers <= MOST_ROWS {
        return;
    }
    if let Some(part) = section.section("loop") {
        let message = format!("{controllers} traces of {} samples are too many", timing.rows());
        let allowed = format!("up to {MOST_ROWS} samples in all traces together");
        report.value(part.at("duration_s"), &part.path("duration_s"), message, allowed);
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
    let parts = ["plant", "aircraft"].map(|name| section.section(name));
    if let Some(part) = parts.into_iter().flatten().next() {
        let key = key_of(part);
        judged(report, (part, key), can_be_sampled(plant, sampling));
    }
}

/// The key that gave a plant.
fn key_of(part: &Section) -> &'static str {
    let keys = ["preset", "file", "name", "denominator"];
    keys.into_iter().find(|key| part.given(key)).unwrap_or("denominator")
}

/// The changes of the plant, in order of time; what is wrong with one is reported.
pub(super) fn plant_changes(
    report: &mut Report,
    files: &mut Files<'_>,
    parts: &[Section],
    plant: Option<&Plant>,
    sampling: Option<Sampling>,
) -> Vec<PlantChange> {
    if let Some(Plant::Aircraft(_)) = plant {
        parts.iter().for_each(|part| refuse_change(report, part));
        return Vec::new();
    }
    let plant = plant.and_then(Plant::linear);
    let mut changes = Vec::new();
    let mut before_s = f64::NEG_INFINITY;
    for part in parts.iter().filter(|part| part.sound) {
        let Some(at_s) = part.number("at_s") else {
            continue;
        };
        // Written so that NaN fails.
        if !(at_s > before_s) {
            let allowed = format!("after the change before it, at {before_s:?} s");
            report.value(part.at("at_s"), &part.path("at_s"), "not in order of time", allowed);
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
            report.missing(part.at(key), &part.path(key), message, allowed);
            continue;
        }
        if let Some(sampling) = sampling {
            let sampled = can_be_sampled(&target, sampling);
            judged(report, (part, key_of(part)), sampled);
            check_ramp(report, part, sampling.timing);
        }
        let change = PlantChange::new(at_s, part.number("ramp_s").unwrap_or(0.0), target);
        changes.extend(judged(report, (part, "at_s"), change));
    }
    changes
}

fn refuse_change(report: &mut Report, part: &Section) {
    let message = "a nonlinear aircraft cannot be changed in flight";
    report.value(part.place, &part.path, message, "changes of a `plant`");
}

fn changed(
    report: &mut Report,
    files: &mut Files<'_>,
    part: &Section,
    sign: Option<fspid_sim::ElevatorSign>,
) -> Option<LinearPlant> {
    if part.given("numerator") {
        // Where the plant itself is wrong its sign is unknown; the coefficients are judged anyhow.
        let sign = elevator_sign(part).or(sign);
        let sign = sign.unwrap_or(fspid_sim::ElevatorSign::NoseDownPositive);
        return data::coefficients(report, part, sign);
    }
    data::plant(report, files, part)
}

fn check_ramp(report: &mut Report, part: &Section, timing: Timing) {
    let ramp_s = part.number("ramp_s").unwrap_or(0.0);
    let start_s = part.number("at_s").unwrap_or(0.0).min(timing.end_s());
    let samples = ramp_s.min(timing.end_s() - start_s) / timing.dt_s();
    // Written so that NaN fails.
    if !(samples <= MOST_RAMP_SAMPLES) {
        let allowed = format!("up to {MOST_RAMP_SAMPLES} samples in a ramp");
        report.value(part.at("ramp_s"), &part.path("ramp_s"), "too long a ramp", allowed);
    }
}

/// What can only be judged of the flight as a whole, and what is probably not meant.
pub(super) fn check_flight(report: &mut Report, section: &Section, scenario: &Scenario) {
    let end_s = scenario.timing.end_s();
    let parts =
        ["disturbance", "gust", "plant_change"].into_iter().flat_map(|key| section.sections(key));
    for part in section.section("setpoint").into_iter().chain(parts) {
        let at_s = part.number("at_s").unwrap_or(0.0);
        if at_s > end_s {
            let path = part.path("at_s");
            report.warn(format!("{path} is {at_s:?} s, after the flight's end at {end_s:?} s"));
        }
        let nyquist_hz = 0.5 / scenario.timing.dt_s();
        let frequency_hz = part.number("frequency_hz").unwrap_or(0.0);
        if frequency_hz > nyquist_hz {
            let path = part.path("frequency_hz");
            report.warn(format!(
                "{path} is {frequency_hz:?} Hz, but samples show at most {nyquist_hz:?} Hz"
            ));
        }
    }
    let mut ramps =
        section.sections("plant_change").iter().filter(|part| part.number("ramp_s") > Some(0.0));
    if let Some(ramp) = ramps.next_back()
        && report.count() == 0
    {
        judged(report, (ramp, "ramp_s"), scenario.prepare());
    }
}

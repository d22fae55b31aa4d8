//! Loops that nobody could judge: refused where they are read, as each of their flights would be.
//!
//! Asked once of a scenario that is read, and of the ends of what is dispersed; not of each flight of a campaign, which
//! says it itself.

use std::fmt::Display;

use fspid_core::Gains;
use fspid_sim::loop_model::SampledPlant;
use fspid_sim::stability::can_be_judged;
use fspid_sim::{AircraftPlant, Controller, LinearPlant, NamedController, Scenario, SimError};

use super::judged;
use super::timing::place_of_plant;
use crate::file::spec::controller as keys;
use crate::file::spec::scenario::CONTROLLER;
use crate::keyed::{KeyName, Section};
use fspid_diagnostics::Report;

/// Gains up to here are none that make a loop leave the range of numbers: its plant does.
const LARGE_GAIN: f64 = 1e20;

/// Asks of every loop what its flight asks before it begins.
pub(in crate::file) fn check(report: &mut Report, section: &Section, scenario: &Scenario) {
    // Loops around another simulator are not asked at rest.
    if scenario.plant.external().is_some() {
        return;
    }
    let trimmed = scenario.plant.aircraft().map(AircraftPlant::linear).transpose();
    let sampled = trimmed.and_then(|trimmed| {
        let plant = trimmed.as_ref().map(|plant| SampledPlant::of(scenario, plant));
        plant.transpose().map(|_| trimmed)
    });
    let trimmed = match sampled {
        Ok(trimmed) => trimmed,
        Err(error) => {
            let error = match error {
                SimError::NotLinear => NO_MODEL.to_owned(),
                error => format!("the linear model at the trim cannot be sampled: {error}"),
            };
            return of_plant(report, section, error);
        }
    };
    let lasting = scenario.lasting_plants().into_iter().map(|(_, plant)| plant);
    let plants: Vec<&LinearPlant> = trimmed.iter().chain(lasting).collect();
    for named in &scenario.controllers {
        let asked = |plant: &&LinearPlant| can_be_judged(scenario, plant, &named.controller);
        if let Err(error) = plants.iter().try_for_each(asked) {
            of_loop(report, section, named, &error);
        }
    }
}

/// What is wrong with an aircraft around whose trim no loop can be judged.
const NO_MODEL: &str = "there is no linear model at its trim, so that no loop around it can be judged; allowed are coefficients of an aircraft that answers its elevator with finite numbers";

fn of_plant(report: &mut Report, section: &Section, error: impl Display) {
    if let Some(place) = place_of_plant(section) {
        judged(report, place, Err::<(), _>(error));
    }
}

/// A loop that leaves the range of numbers, by its largest gain, or by the plant where no gain is large.
fn of_loop(report: &mut Report, section: &Section, named: &NamedController, error: &SimError) {
    let (key, size) = largest(&named.controller);
    let mut parts = section.sections(CONTROLLER).iter();
    let part = parts.find(|part| part.get(keys::NAME) == Some(named.name.as_str()));
    let name = &named.name;
    if let (Some(part), true) = (part, size <= LARGE_GAIN && has_large_scale(&named.controller)) {
        let message = "with its scales the sampled loop at rest leaves the range of 64-bit numbers";
        return part.problem(report, keys::SUPERVISOR, message, "smaller scales");
    }
    let Some(part) = part.filter(|_| size > LARGE_GAIN) else {
        let said = format!(
            "the sampled loop of {name} cannot be judged in 64-bit numbers ({error}); allowed are smaller coefficients"
        );
        return of_plant(report, section, said);
    };
    let part = part.get(keys::NOMINAL).filter(|nominal| nominal.given(key)).unwrap_or(part);
    let message = "with it the sampled loop leaves the range of 64-bit numbers";
    part.wrong(report, key, message, "a smaller one");
}

/// The key of the gain that is farthest out, and its size.
fn largest(controller: &Controller) -> (KeyName, f64) {
    let Gains { kp, ki, kd } = controller.nominal();
    let gains: [(KeyName, f64); 4] = [
        (keys::KP.into(), kp.abs()),
        (keys::KI.into(), ki.abs()),
        (keys::KD.into(), kd.abs()),
        (keys::RATE_GAIN.into(), controller.config().rate_gain_s.abs()),
    ];
    let [first, rest @ ..] = gains;
    rest.into_iter().fold(first, |one, other| if other.1 > one.1 { other } else { one })
}

/// True for a supervisor that sees or gives far more than a gain may be.
fn has_large_scale(controller: &Controller) -> bool {
    let Controller::SelfTuning(fspid) = controller else { return false };
    let settings = fspid.tuner().settings();
    let (input, output) = (settings.input_scale, settings.output_scale);
    let scales = [input.error_per_rad, input.change_per_rad, output.kp, output.ki, output.kd];
    scales.iter().any(|scale| scale.abs() > LARGE_GAIN)
}

//! Reachable sets of step responses from rest with saturation: affine arithmetic until no limit can act any more.
//!
//! An ellipsoid in which no limit acts is small: a step of a degree leaves it at once. But the loop that is at rest when its
//! set-point steps has one state alone, and all flights of a range of steps differ in two numbers, set-point and load. They
//! are flown together, box by box, in affine arithmetic: limits, rates and anti-windup as the simulator has them, gains
//! anywhere between their bounds over the cells that the supervisor may see. Where all flights of a box are in an ellipsoid
//! around their rest in which no limit acts, the linear proof takes over.
//!
//! [`Steps`] is about a step at any time, [`Commanded`] about whatever a scenario commands, each at the time it does.

mod affine;
mod ball;
mod commanded;
mod commands;
mod crew;
mod cut;
mod flights;
mod flown;
mod from_rest;
mod gains;
mod joined;
mod near;
mod sample;
mod servo;
mod sweep;
mod terminal;
#[cfg(test)]
mod tests;
mod tuned;
mod wide;
mod work;

use fspid_core::{Fspid, IntegralForm, Law, SelfTuner};
use fspid_fuzzy::Output;
use fspid_fuzzy::system::System;
use fspid_numeric::scalar::Interval;
use fspid_sim::Controller;
use fspid_sim::loop_model::LoopModel;

use crate::certificate::Certificate;
use crate::description::LoopDescription;
use crate::gain_set::GainSet;
use crate::limits;
use crate::rest::Rest;
use near::system;
use sample::Stop;
use terminal::NearRest;
use tuned::Tuner;

pub(crate) use near::{corners_within, system_of};

pub use commanded::{Commanded, Ended, Group, Leg};
pub use commands::{Commands, Shares};
pub use from_rest::{Stepped, Steps};
pub use terminal::{NearGains, Terminal};

/// A proved loop with its form near rest, whose flights are looked for.
pub(crate) struct Search<'a> {
    certificate: &'a Certificate,
    model: &'a LoopModel<Interval>,
    set: &'a GainSet,
    terminal: Terminal,
    system: Option<System>,
    stops: fn() -> bool,
}

impl<'a> Search<'a> {
    /// Nothing for a loop that is not flown in sets, without limits, or whose form near rest is not found.
    pub(crate) fn of(
        certificate: &'a Certificate,
        model: &'a LoopModel<Interval>,
        [set, held]: [&'a GainSet; 2],
        stops: fn() -> bool,
    ) -> Option<Self> {
        let description = &certificate.description;
        if not_covered(description).is_some() || description.limits().is_empty() {
            return None;
        }
        let rest = Rest::of(description, set, certificate.range).ok()?;
        if is_elsewhere(description, &rest) {
            return None;
        }
        let near = NearRest { certificate, enclosed: model, held, rest: &rest };
        let terminal = near.found(stops)?;
        let system = system(description);
        Some(Self { certificate, model, set, terminal, system, stops })
    }
}

/// A certificate with what its flights are checked against.
#[derive(Clone, Copy)]
pub(crate) struct Checked<'a> {
    pub(crate) certificate: &'a Certificate,
    pub(crate) model: &'a LoopModel<Interval>,
    pub(crate) set: &'a GainSet,
    pub(crate) stops: fn() -> bool,
}

impl Checked<'_> {
    /// Whether flights of the loop are flown in sets, with loads at the elevator up to so much.
    fn allowed(&self, at_elevator_rad: f64) -> Result<(), &'static str> {
        let Self { certificate, model, set, stops: _ } = self;
        let description = &certificate.description;
        if let Some(what) = not_covered(description) {
            return Err(what);
        }
        if certificate.output_factor.to_bits() != 1.0_f64.to_bits() {
            return Err("flights in sets: of a loop at another output scale");
        }
        if sees_loads_at_once(model, at_elevator_rad) {
            return Err("flights in sets: the pitch rate shows a load at once");
        }
        let rest = Rest::of(description, set, certificate.range);
        if !rest.is_ok_and(|rest| !is_elsewhere(description, &rest)) {
            return Err(
                "flights in sets: where the gains move and an error stays, rest is not known",
            );
        }
        Ok(())
    }
}

/// What a set that was given up means for a claim.
fn given_up(stop: Stop) -> &'static str {
    match stop {
        Stop::Guard => "flights in sets: a flight may meet the sample guard",
        Stop::Travel => "flights in sets: a flight may meet an end of the actuator's travel",
        Stop::Lost => "flights in sets: a set of flights is not shown to end near its rest",
        Stop::Work => "flights in sets: more samples than a check may fly",
    }
}

impl Terminal {
    /// The certificate with the level within which no limit acts near rest.
    pub(crate) fn near_rest(&self, certificate: &Certificate) -> Certificate {
        Certificate { level: Some(self.level), ..certificate.clone() }
    }
}

/// Why nothing is claimed of steps.
pub(crate) fn not_covered(description: &LoopDescription) -> Option<&'static str> {
    if let Some(what) = limits::not_covered(description) {
        return Some(what);
    }
    if description.resolves_in_steps() {
        return Some("a sensor that resolves in steps is not flown in sets");
    }
    if description.controller.config().integral == IntegralForm::Literal {
        return Some("the literal integral is not flown in sets");
    }
    if let Controller::SelfTuning(fspid) = &description.controller {
        return not_flown(fspid);
    }
    None
}

/// What of a self-tuner is not flown in sets.
fn not_flown(fspid: &Fspid<f64>) -> Option<&'static str> {
    let tuner = fspid.tuner();
    if tuner.settings().law == Law::Memoryless {
        return (!tuner.is_plain()).then_some(
            "gains that jump by a supervisor that is a network or whose rules conclude numbers, that sees something else than error and change, through sets that are not even, or whose gains something follows are not flown in sets",
        );
    }
    if Tuner::of(fspid).is_none() {
        return Some(
            "gains that remember are flown in sets where they leak, by rules that conclude numbers or a network, refuse no input and have no dead zone, and see the change of the error or the error of a model",
        );
    }
    // Rest then depends on the gains, which come to theirs as late as they like.
    let weight = fspid.config().setpoint_weights.proportional;
    let holds = weight.to_bits() != 1.0_f64.to_bits()
        || tuner.settings().gain_coupling.setpoint_weight != 0.0;
    holds.then_some(
        "gains that remember and move what holds a set-point, by a set-point weight that is not 1, are not flown in sets; `feedforward` holds it beside them",
    )
}

/// True for a self-tuner whose gains remember.
pub(crate) fn remembers(description: &LoopDescription) -> bool {
    let Controller::SelfTuning(fspid) = &description.controller else { return false };
    fspid.tuner().settings().law != Law::Memoryless
}

/// True where a load moves the pitch rate at once, and the controller sees it: it is not said whether before or after.
fn sees_loads_at_once(model: &LoopModel<Interval>, load_rad: f64) -> bool {
    let at_once = model.plant().rate.iter().skip(2).any(|entry| entry.magnitude() > 0.0);
    load_rad > 0.0 && model.settings().uses_rate() && at_once
}

/// Where an error stays, gains that move are not those at the origin, and rest is elsewhere.
fn is_elsewhere(description: &LoopDescription, rest: &Rest) -> bool {
    matches!(description.controller, Controller::SelfTuning(_)) && !(rest.error_rad <= 0.0)
}

/// True where a flight to the other side is the mirror image: then one side is flown.
fn is_odd(description: &LoopDescription) -> bool {
    let config = description.controller.config();
    if let Controller::SelfTuning(fspid) = &description.controller
        && !answers_evenly(fspid.tuner())
    {
        return false;
    }
    let even =
        |ends: Option<(f64, f64)>| ends.is_none_or(|(least, most)| (least + most).abs() <= 0.0);
    let clamps = match &config.anti_windup {
        fspid_core::AntiWindup::Clamping(limits) => Some((limits.lower(), limits.upper())),
        _ => None,
    };
    let output = config.limits.as_ref().map(|limits| (limits.lower(), limits.upper()));
    let actuator = &description.actuator;
    [clamps, output, actuator.command_limits_rad(), actuator.travel_rad()].into_iter().all(even)
}

/// True for a supervisor that answers the same to inputs of the other sign: a network by its form, and rules whose numbers
/// are so.
fn answers_evenly(tuner: &SelfTuner<f64>) -> bool {
    if tuner.supervisor().network().is_some() {
        return true;
    }
    let Some(table) = tuner.supervisor().numbers() else { return false };
    Output::ALL.into_iter().all(|output| {
        let numbers: Vec<u64> =
            table.grid(output).iter().flatten().map(|number| (number + 0.0).to_bits()).collect();
        numbers.iter().eq(numbers.iter().rev())
    })
}

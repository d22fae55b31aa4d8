//! A loop whose plant, actuator and sensors are known between bounds: one proof for all of them.
//!
//! What differs are numbers (a mass, a coefficient, a time constant, a sensor's scale), each anywhere between two ends and
//! standing still.
//! The box of all of them is divided into parts; of each part the plant is enclosed, every entry between bounds, and a form
//! of its own decreases for every matrix inside and every gain of the controller. A member lies in one part, and that
//! part's form is its proof.
//!
//! Claimed is the return to rest around the trim of each member, with the set-point there, without a load and without
//! limits; where one form does for all scales of the sensors, of scales that change in flight too, and where patches overlap
//! and their forms go over into each other, of numbers that move at a pace. The claim for the loop as it is may say more.
//! What sensors that resolve in steps leave is bounded sample by sample for one loop alone, so that a family of such loops
//! is refused. That the enclosures are those of what a user calls a mass is no part of a certificate: who has the scenario
//! encloses them anew and compares.

mod cover;
mod moves;
mod pace;
mod patches;
mod scales;
mod search;

use fspid_numeric::scalar::Interval;
use fspid_sim::loop_model::{LoopModel, SampledPlant};

use crate::caps::{MOST_PARAMETERS, MOST_PARTS};
use crate::certificate::{Certificate, Claim};
use crate::check::{NotProved, PlantSet, from_middle};
use crate::description::LoopDescription;
use crate::gain_set::{GainSet, KnownSlopes};
use crate::recheck::{Recheck, RecheckError, Rechecked};
use crate::scope::Range;

use moves::Off;
pub use pace::{Pace, Patch};
pub use scales::ScaledSensor;
pub use search::{FamilyVerdict, Uncertain, prove_family};

/// A number that differs.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// What it is called.
    pub name: String,
    /// Where it stands in a scenario; several places get the same.
    pub paths: Vec<String>,
    /// True for a factor on what stands there.
    pub relative: bool,
    /// True where plants are made of one over it, in which they are nearly linear, such as of a time constant.
    pub inverse: bool,
    /// Sensors whose scale error, %, it is; none for a number of plant and actuator.
    pub sensors: Vec<ScaledSensor>,
    /// From where to where it goes, in the units of the scenario.
    pub ends: [f64; 2],
}

impl Parameter {
    /// True for a number of plant and actuator.
    #[must_use]
    pub fn is_of_plant(&self) -> bool {
        self.sensors.is_empty()
    }

    /// What plants are made of where the parameter lies between two ends.
    #[must_use]
    pub fn number(&self, [from, to]: [f64; 2]) -> Interval {
        let between = Interval::between(from, to);
        if self.inverse { Interval::ONE / between } else { between }
    }
}

/// What plants of a box are made of: those parameters that are no sensor's.
#[must_use]
pub fn numbers(parameters: &[Parameter], ends: &[[f64; 2]]) -> Vec<Interval> {
    let of_plant = parameters.iter().zip(ends).filter(|(one, _)| one.is_of_plant());
    of_plant.map(|(one, &ends)| one.number(ends)).collect()
}

/// A part of the box with its proof.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// From where to where each parameter goes.
    pub ends: Vec<[f64; 2]>,
    /// Plants and actuators there.
    pub plants: PlantSet,
    /// What is claimed of it; of stability.
    pub claim: Claim,
}

/// All members of a loop, in parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Family {
    /// What differs.
    pub parameters: Vec<Parameter>,
    /// Parts that cover the box.
    pub parts: Vec<Part>,
    /// How fast its numbers may move in flight, where that is claimed.
    pub pace: Option<Pace>,
}

/// Result of a family's re-check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CheckedFamily {
    /// Parts.
    pub parts: usize,
}

/// Why a family is not believed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FamilyError {
    /// The parts do not fit together.
    #[error("the family: {what}")]
    Malformed {
        /// What is wrong.
        what: &'static str,
    },
    /// A part is not proved.
    #[error("part {part} of the family: {reason}")]
    Part {
        /// Which, from 0.
        part: usize,
        /// Why.
        reason: Box<RecheckError>,
    },
}

impl Part {
    /// True if its plants are told for parameters as far from their middle as its ends are.
    fn reaches(&self, parameters: &[Parameter]) -> bool {
        let numbers = numbers(parameters, &self.ends);
        numbers.iter().zip(&self.plants.reach).all(|(it, reach)| from_middle(*it) <= *reach)
    }

    /// The claim as a certificate of its own, about the return to rest.
    fn alone(&self, certificate: &Certificate) -> Certificate {
        Certificate {
            range: Range::REST,
            claim: self.claim.clone(),
            level: None,
            steps: None,
            commanded: None,
            family: None,
            disturbances: Vec::new(),
            nonlinear: None,
            ..certificate.clone()
        }
    }
}

impl Family {
    /// True if the scales of sensors may change in flight as well, from sample to sample, each by itself, in any way and as
    /// fast as it likes, while all other numbers stand still.
    ///
    /// The matrix of a sample is that of its scales $s_k$, so that where one form falls by all of them,
    /// $V(z_{k+1}) \le \rho^2 V(z_k)$ whatever they were before. A sensor that shows $\varphi(y)$ of y at rest at 0 is one
    /// of them as long as $\varphi(y) / y$ stays between the ends of its scale: it lies in that sector.
    #[must_use]
    pub fn scales_may_change(&self) -> bool {
        let parts = self.parts.iter().map(|part| (part.ends.as_slice(), &part.claim));
        scales::may_change(&self.parameters, &parts.collect::<Vec<_>>())
    }

    /// How many forms its parts have between them, each counted once.
    #[must_use]
    pub fn forms(&self) -> usize {
        let mut known: Vec<&Claim> = Vec::new();
        for part in &self.parts {
            if !known.contains(&&part.claim) {
                known.push(&part.claim);
            }
        }
        known.len()
    }

    /// What a re-check finds of a family that was just proved.
    #[must_use]
    pub fn checked(&self) -> CheckedFamily {
        CheckedFamily { parts: self.parts.len() }
    }

    /// Proves anew that the parts cover the box and that each part's form decreases.
    pub(crate) fn check(
        &self,
        certificate: &Certificate,
        set: &GainSet,
        stops: fn() -> bool,
    ) -> Result<CheckedFamily, FamilyError> {
        let malformed = |what| FamilyError::Malformed { what };
        self.is_whole().map_err(malformed)?;
        if certificate.description.resolves_in_steps() {
            return Err(malformed("its loops have a sensor that resolves in steps"));
        }
        let off = self.off(&certificate.description)?;
        let known = KnownSlopes::default();
        for (place, part) in self.parts.iter().enumerate() {
            let alone = part.alone(certificate);
            let proved = || -> Result<(), RecheckError> {
                let seen = (self.parameters.as_slice(), part.ends.as_slice());
                let off = off.as_ref().filter(|_| self.moves_with(&part.claim));
                let of = (&certificate.description, off);
                for model in models(&part.plants, seen, of)? {
                    let rechecked = Recheck::of_rest(&alone, &model, set, (&known, stops))?;
                    if !bears(&alone.claim, &rechecked) {
                        let what = "the law is not shown to keep to the rate that is claimed";
                        return Err(RecheckError::Malformed { what });
                    }
                }
                Ok(())
            };
            let reason = |reason| FamilyError::Part { part: place, reason: Box::new(reason) };
            proved().map_err(reason)?;
        }
        Ok(self.checked())
    }

    /// True if flights whose numbers move count on a claim.
    fn moves_with(&self, claim: &Claim) -> bool {
        self.pace.as_ref().is_some_and(|pace| pace.patches.iter().any(|it| it.claim == *claim))
    }

    /// What its plants are off as its numbers move within a sample; none where they stand still.
    fn off(&self, description: &LoopDescription) -> Result<Option<Off>, FamilyError> {
        let Some(pace) = &self.pace else { return Ok(None) };
        pace.check(self, description).map_err(|what| FamilyError::Malformed { what })?;
        let off = Off::of(pace, (&self.parameters, &self.parts), description);
        let reason =
            |reason: NotProved| FamilyError::Part { part: 0, reason: Box::new(reason.into()) };
        off.map(Some).map_err(reason)
    }

    /// True if it is one: sizes, ends in order, claims of stability, and parts that leave nothing out.
    fn is_whole(&self) -> Result<(), &'static str> {
        if !(1..=MOST_PARAMETERS).contains(&self.parameters.len()) {
            return Err("allowed are 1 to 8 parameters");
        }
        if !(1..=MOST_PARTS).contains(&self.parts.len()) {
            return Err("allowed are 1 to 4096 parts");
        }
        if scales::is_twofold(&self.parameters) {
            return Err("two parameters are the scale of one sensor");
        }
        let of_plant = self.parameters.iter().filter(|one| one.is_of_plant()).count();
        let states = |part: &Part| part.plants.middle.len();
        for part in &self.parts {
            if part.ends.len() != self.parameters.len() {
                return Err("a part has other parameters");
            }
            if !part.claim.is_of_stability() {
                return Err("a part does not claim stability");
            }
            if states(part) != states(&self.parts[0]) || !part.plants.fits(of_plant) {
                return Err("the plants of its parts have different states");
            }
            if !covers_scales(&part.claim, &self.parameters) {
                return Err("a part's gains are tied to what a sensor shows whose scale differs");
            }
        }
        if !self.parts.iter().all(|part| part.reaches(&self.parameters)) {
            return Err("a part's plants do not reach its ends");
        }
        let whole: Vec<[f64; 2]> = self.parameters.iter().map(|one| one.ends).collect();
        let all = self.parts.iter().map(|part| &part.ends).chain([&whole]).flatten();
        // Written so that NaN is not in order.
        if !all.clone().all(|[from, to]| from <= to && from.is_finite() && to.is_finite()) {
            return Err("ends are not in order");
        }
        let parts: Vec<&[[f64; 2]]> = self.parts.iter().map(|part| part.ends.as_slice()).collect();
        cover::covers(&whole, &parts).then_some(()).ok_or("its parts leave a part of it out")
    }
}

/// True if a proved claim bears on the flights of a loop: one about gains of bounded rate says something only of laws that
/// keep to it everywhere.
fn bears(claim: &Claim, rechecked: &Rechecked) -> bool {
    !matches!(claim, Claim::BoundedRate(_)) || rechecked.keeps_to_the_rate
}

/// True if a claim about each of some loops is one about those between them, as far as sensors are concerned: what cells of
/// gains are tied to is what the pitch sensor shows, and products of that do not lie between those of its ends.
fn covers_scales(claim: &Claim, parameters: &[Parameter]) -> bool {
    let differs = parameters.iter().any(|one| one.sensors.contains(&ScaledSensor::Pitch));
    !(differs && matches!(claim, Claim::SProcedure { .. }))
}

/// Loops between which those of plants and of what sensors show of them lie. A loop's matrix is affine in what its plant
/// makes of a sample, and in the scale of each sensor, and $M^T P M$ is convex in M, so that what holds at each of them
/// holds between. What they are off is added to each.
fn models(
    plants: &PlantSet,
    (parameters, ends): (&[Parameter], &[[f64; 2]]),
    (description, off): (&LoopDescription, Option<&Off>),
) -> Result<Vec<LoopModel<Interval>>, NotProved> {
    let dt_s = description.controller.config().dt_s;
    let mut sampled = plants.sampled_within(dt_s, off.map_or(&[], |off| &off.entries))?;
    if let Some(off) = off {
        sampled.iter_mut().for_each(|plant| plant.rate.clone_from(&off.pitch_rate));
    }
    let seen = scales::corners(parameters, ends, description);
    let with = |plant: &SampledPlant<Interval>| {
        seen.iter().map(|settings| LoopModel::new(plant.clone(), settings.clone())).collect()
    };
    Ok(sampled.iter().flat_map(|plant| -> Vec<_> { with(plant) }).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_core::{Gains, Pid, PidConfig};
    use fspid_lti::Matrix;
    use fspid_sim::actuator::{Actuator, Lag};
    use fspid_sim::loop_model::Sensing;
    use fspid_sim::{Controller, ElevatorSign};

    /// A PID at ten samples a second.
    pub(super) fn fixed_loop() -> LoopDescription {
        let gains = Gains { kp: 2.0, ki: 0.5, kd: 1.0 };
        let pid = Pid::new(gains, PidConfig::sampled_every(0.1)).expect("allowed");
        LoopDescription {
            numerator: vec![1.0],
            denominator: vec![1.0, 1.0, 0.0],
            elevator_sign: ElevatorSign::NoseUpPositive,
            actuator: Actuator::new(Lag::first_order(0.1).expect("allowed")),
            pitch: Sensing::DIRECT,
            rate: Sensing::DIRECT,
            controller: Controller::Fixed(pid),
        }
    }

    fn differing(sensors: &[ScaledSensor]) -> [Parameter; 1] {
        let (name, paths) = (String::new(), Vec::new());
        let (relative, inverse, sensors) = (false, false, sensors.to_vec());
        [Parameter { name, paths, relative, inverse, sensors, ends: [0.0, 1.0] }]
    }

    #[test]
    fn gains_that_are_tied_to_what_the_pitch_sensor_shows_cover_no_scale_of_it() {
        let form = Matrix::identity(2);
        let tied = Claim::SProcedure { form: form.clone(), rate: 0.9, multipliers: vec![1.0] };
        let for_all = Claim::CommonQuadratic { form, rate: 0.9 };
        let covers = |claim, sensors: &[ScaledSensor]| covers_scales(claim, &differing(sensors));
        assert!(!covers(&tied, &[ScaledSensor::Pitch]));
        assert!(!covers(&tied, &[ScaledSensor::Rate, ScaledSensor::Pitch]));
        assert!(covers(&tied, &[ScaledSensor::Rate]) && covers(&tied, &[]));
        assert!(covers(&for_all, &[ScaledSensor::Pitch, ScaledSensor::Rate]));
    }
}

//! A loop whose plant and actuator are known between bounds: one proof for all of them.
//!
//! What differs are numbers (a mass, a coefficient, a time constant), each anywhere between two ends and standing still.
//! The box of all of them is divided into parts; of each part the plant is enclosed, every entry between bounds, and a form
//! of its own decreases for every matrix inside and every gain of the controller. A member lies in one part, and that
//! part's form is its proof.
//!
//! Claimed is the return to rest around the trim of each member, without limits; the claim for the loop as it is may say
//! more. That the enclosures are those of what a user calls a mass is no part of a certificate: who has the scenario
//! encloses them anew and compares.

mod cover;
mod search;

use fspid_numeric::scalar::Interval;
use fspid_sim::loop_model::LoopModel;

use crate::certificate::{Certificate, Claim};
use crate::check::{EnclosedPlant, NotProved};
use crate::gain_set::{GainSet, KnownSlopes};
use crate::recheck::{Recheck, RecheckError, Rechecked};
use crate::scope::Range;

pub use search::{FamilyVerdict, Uncertain, prove_family};

/// Most numbers that differ.
pub const MOST_PARAMETERS: usize = 8;
/// Most parts of a family.
pub const MOST_PARTS: usize = 4096;

/// A number that differs.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// What it is called.
    pub name: String,
    /// Where it stands in a scenario; several places get the same.
    pub paths: Vec<String>,
    /// True for a factor on what stands there.
    pub relative: bool,
    /// From where to where it goes, in the units of the scenario.
    pub ends: [f64; 2],
}

/// A part of the box with its proof.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// From where to where each parameter goes.
    pub ends: Vec<[f64; 2]>,
    /// Plant and actuator there.
    pub plant: EnclosedPlant,
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
}

/// What was re-checked of a family.
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
    /// The loop over this part, with the settings of a certificate's own.
    pub(crate) fn model(
        &self,
        certificate: &Certificate,
    ) -> Result<LoopModel<Interval>, NotProved> {
        let dt_s = certificate.description.controller.config().dt_s;
        Ok(LoopModel::new(self.plant.sampled(dt_s)?, certificate.description.settings()))
    }

    /// The claim as a certificate of its own, about the return to rest.
    fn alone(&self, certificate: &Certificate) -> Certificate {
        Certificate {
            range: Range::REST,
            claim: self.claim.clone(),
            level: None,
            steps: None,
            family: None,
            ..certificate.clone()
        }
    }
}

impl Family {
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
        self.is_whole().map_err(|what| FamilyError::Malformed { what })?;
        let known = KnownSlopes::default();
        for (place, part) in self.parts.iter().enumerate() {
            let alone = part.alone(certificate);
            let proved = || -> Result<Rechecked, RecheckError> {
                let model = part.model(certificate)?;
                let recheck = Recheck::with(&alone, model, set.clone(), &known)?.until(stops);
                recheck.run()
            };
            let reason = |reason| FamilyError::Part { part: place, reason: Box::new(reason) };
            proved().map_err(reason)?;
        }
        Ok(self.checked())
    }

    /// True if it is one: sizes, ends in order, claims of stability, and parts that leave nothing out.
    fn is_whole(&self) -> Result<(), &'static str> {
        if !(1..=MOST_PARAMETERS).contains(&self.parameters.len()) {
            return Err("allowed are 1 to 8 parameters");
        }
        if !(1..=MOST_PARTS).contains(&self.parts.len()) {
            return Err("allowed are 1 to 4096 parts");
        }
        let states = |part: &Part| part.plant.by_states.len();
        for part in &self.parts {
            if part.ends.len() != self.parameters.len() {
                return Err("a part has other parameters");
            }
            if !part.claim.is_of_stability() {
                return Err("a part does not claim stability");
            }
            if states(part) != states(&self.parts[0]) || !part.plant.is_square() {
                return Err("the plants of its parts have different states");
            }
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

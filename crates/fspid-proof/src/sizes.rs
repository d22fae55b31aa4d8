//! How large a certificate may be, asked before anything is enclosed: a short text can name much.
//!
//! A delay of ten thousand samples is a loop of ten thousand states, whose one-sample matrix would fill
//! 1.6 GB, and a thousand cells along each input are a million boxes of gains. Both used to be computed
//! before the form was looked at.

use fspid_core::Law;
use fspid_lti::Matrix;
use fspid_sim::Controller;
use fspid_sim::loop_model::{LoopModel, SampledPlant};

use crate::caps::MOST_BOUNDS;
use crate::certificate::{BoundedRate, Certificate, Claim};
use crate::description::LoopDescription;
use crate::gain_set::MOST_CORNERS;
use crate::scope::Range;
use crate::steps::{Commanded, Commands};

pub use crate::caps::{
    MOST_CHANGES, MOST_CONES, MOST_DIVISIONS, MOST_LEG_PARTS, MOST_LEG_SETS, MOST_LEGS, MOST_LOADS,
    MOST_PIECES, MOST_SAMPLES, MOST_STATES, MOST_STATES_FIXED, MOST_STATES_SEARCHED, MOST_WORK,
    WrongSize, WrongSizes,
};

/// Coefficients of a cell's decrease in which the form moves with all gains.
const BERNSTEIN: u64 = 64;

impl LoopDescription {
    /// How many states the loop has, without computing any.
    #[must_use]
    pub fn states(&self) -> usize {
        let order = self.denominator.len().saturating_sub(1);
        // Without a lag the last command is a state.
        let states = order + self.actuator.lag().order().max(1);
        let plant = SampledPlant { states, rows: Vec::new(), rate: Vec::new() };
        LoopModel::<f64>::new(plant, self.settings()).size()
    }

    /// The loop's size, where it is larger than a proof may speak of.
    pub(crate) fn too_large(&self) -> Option<WrongSize> {
        let found = self.states() as u64;
        let most = MOST_STATES as u64;
        let what = "states (plant, actuator, samples on their way, memory of the controller)";
        (found > most).then_some(WrongSize { path: "loop", what, found, least: 0, most })
    }

    /// The same for a loop of which a proof is to be found and not checked again.
    pub(crate) fn too_large_to_search(&self) -> Option<WrongSize> {
        let found = self.states() as u64;
        let (most, what) = match self.controller {
            Controller::SelfTuning(_) => (
                MOST_STATES_SEARCHED,
                "states (plant, actuator, samples on their way, memory of the controller), and with gains that move 28 take over 280 s where 23 take 12 s",
            ),
            Controller::Fixed(_) => (
                MOST_STATES_FIXED,
                "states (plant, actuator, samples on their way, memory of the controller), and with fixed gains 66 take over 100 s where 26 take 2 s",
            ),
        };
        let most = most as u64;
        (found > most).then_some(WrongSize { path: "loop", what, found, least: 0, most })
    }
}

/// What is wrong with the sizes of a certificate; nothing is enclosed for that.
pub(crate) fn check(certificate: &Certificate) -> Result<(), WrongSizes> {
    let mut wrong = Sizes::default();
    let description = &certificate.description;
    let states = description.states();
    wrong.found.extend(description.too_large());
    let divisions = ("divisions", "cells along an input");
    wrong.within(divisions, certificate.divisions, [1, MOST_DIVISIONS]);
    let more = match &certificate.claim {
        Claim::CommonQuadratic { .. } => description.remembered_states(certificate.range),
        _ => 0,
    };
    let states = states + more;
    wrong.of_claim(&certificate.claim, states);
    if let Some(steps) = &certificate.steps {
        wrong.within(("steps.ends", "ends of boxes"), steps.ends.len(), [2, MOST_PIECES + 1]);
        wrong.within(("steps.loads", "parts of the loads"), steps.loads, [1, MOST_LOADS]);
        wrong.of_form("steps.near_rest.form", &steps.terminal.form, states);
    }
    if let Some(commanded) = &certificate.commanded {
        wrong.of_commanded(commanded, states);
    }
    let bounds = certificate.disturbances.len();
    wrong.within(("disturbances", "bounds"), bounds, [0, MOST_BOUNDS]);
    for bound in &certificate.disturbances {
        for form in bound.forms() {
            wrong.of_form("disturbances.form", form, states);
        }
    }
    if let Some(claim) = &certificate.nonlinear {
        wrong.of_form("nonlinear.form", &claim.form, description.states());
    }
    let family = certificate.family.iter().flat_map(|family| &family.parts);
    let claims = family.map(|part| (&part.claim, Range::REST));
    let inequalities = claims
        .chain([(&certificate.claim, certificate.range)])
        .map(|(claim, range)| most_inequalities(certificate, claim, range))
        .fold(0, u64::saturating_add);
    let again = most_inequalities(certificate, &certificate.claim, certificate.range);
    let inequalities = inequalities.saturating_add(again.saturating_mul(bounds as u64));
    // Each corner of the nonlinear motion is asked as a loop of its own.
    let corners = if certificate.nonlinear.is_some() { NONLINEAR_CORNERS } else { 0 };
    let inequalities = inequalities.saturating_add(inequalities.saturating_mul(corners));
    let work = inequalities.saturating_mul((states as u64).saturating_pow(3));
    wrong.push(("claim", "products of the re-check"), work, [0, MOST_WORK]);
    if wrong.found.is_empty() { Ok(()) } else { Err(WrongSizes(wrong.found)) }
}

/// No fewer inequalities, or products of matrices, than the re-check of a claim looks at.
fn most_inequalities(certificate: &Certificate, claim: &Claim, range: Range) -> u64 {
    let divisions = certificate.divisions as u64;
    let cells = match &certificate.description.controller {
        Controller::Fixed(_) => 1,
        Controller::SelfTuning(fspid) => {
            let settings = fspid.tuner().settings();
            let along = |scale: f64| if scale == 0.0 { 1 } else { divisions };
            match settings.law {
                // The corners of the body of gains that are reached.
                Law::Accumulating { .. } => MOST_CORNERS,
                Law::Memoryless => along(settings.input_scale.error_per_rad)
                    .saturating_mul(along(settings.input_scale.change_per_rad))
                    .saturating_add(4),
            }
        }
    };
    // Eight of a box, each with what is held either way.
    let remembered = certificate.description.remembered_states(range) > 0;
    let corners = cells.saturating_mul(if remembered { 72 } else { 16 });
    match claim {
        Claim::CommonQuadratic { .. } => corners,
        Claim::SProcedure { multipliers, .. } => {
            corners.saturating_mul(1 + multipliers.len() as u64)
        }
        Claim::BoundedRate(_) => BERNSTEIN.saturating_mul(8).saturating_add(corners),
        Claim::FrozenGrowth { .. } => 1,
        Claim::SequenceGrowth { inputs, .. } => inputs.len() as u64 + 1,
    }
}

/// Corners of the nonlinear motion at most.
const NONLINEAR_CORNERS: u64 = 1 << (fspid_aircraft::enclosure::MOTION + 1);

#[derive(Default)]
struct Sizes {
    found: Vec<WrongSize>,
}

impl Sizes {
    fn push(
        &mut self,
        (path, what): (&'static str, &'static str),
        found: u64,
        [least, most]: [u64; 2],
    ) {
        if !(least..=most).contains(&found) {
            self.found.push(WrongSize { path, what, found, least, most });
        }
    }

    fn within(
        &mut self,
        place: (&'static str, &'static str),
        found: usize,
        [least, most]: [usize; 2],
    ) {
        self.push(place, found as u64, [least as u64, most as u64]);
    }

    fn of_claim(&mut self, claim: &Claim, states: usize) {
        match claim {
            Claim::CommonQuadratic { form, .. } => self.of_form("claim.form", form, states),
            Claim::SProcedure { form, multipliers, .. } => {
                self.of_form("claim.form", form, states);
                let place = ("claim.multipliers", "double cones");
                self.within(place, multipliers.len(), [1, MOST_CONES]);
            }
            Claim::BoundedRate(BoundedRate { forms, .. }) => {
                let paths =
                    ["claim.forms[0]", "claim.forms[1]", "claim.forms[2]", "claim.forms[3]"];
                for (path, form) in paths.into_iter().zip(forms) {
                    self.of_form(path, form, states);
                }
            }
            Claim::FrozenGrowth { form, direction, .. } => {
                self.of_form("claim.form", form, states);
                self.within(("claim.direction", "numbers"), direction.len(), [states, states]);
            }
            Claim::SequenceGrowth { inputs, form, direction, .. } => {
                self.of_form("claim.form", form, states);
                self.within(("claim.direction", "numbers"), direction.len(), [states, states]);
                self.within(("claim.inputs", "samples"), inputs.len(), [1, MOST_SAMPLES]);
            }
        }
    }

    fn of_commanded(&mut self, commanded: &Commanded, states: usize) {
        let Commanded { commands, terminal, legs } = commanded;
        let Commands { setpoint, at_servo, at_elevator, .. } = commands;
        for (path, shares) in [
            ("commanded.setpoint", setpoint),
            ("commanded.at_servo", at_servo),
            ("commanded.at_elevator", at_elevator),
        ] {
            self.within((path, "changes"), shares.0.len(), [0, MOST_CHANGES]);
        }
        self.within(("commanded.legs", "legs"), legs.len(), [1, MOST_LEGS]);
        for leg in legs {
            self.within(("commanded.legs.groups", "groups"), leg.groups.len(), [1, MOST_LEG_PARTS]);
            self.within(("commanded.legs", "sets of a leg"), leg.sets(), [1, MOST_LEG_SETS]);
        }
        for group in legs.iter().flat_map(|leg| &leg.groups) {
            let most = MOST_LEG_PARTS + 1;
            let ends = "ends of parts";
            self.within(
                ("commanded.legs.groups.setpoints_rad", ends),
                group.setpoints_rad.len(),
                [2, most],
            );
            self.within(
                ("commanded.legs.groups.loads_rad", ends),
                group.loads_rad.len(),
                [2, most],
            );
        }
        self.of_form("commanded.near_rest.form", &terminal.form, states);
    }

    fn of_form(&mut self, path: &'static str, form: &Matrix, states: usize) {
        self.within((path, "rows"), form.rows(), [states, states]);
        self.within((path, "columns"), form.columns(), [states, states]);
    }
}

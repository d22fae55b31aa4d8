//! From a loop to one of three answers: proved, refuted, open.

mod bounded;
mod largest;
mod region;
mod stable;
mod unstable;

use fspid_core::Fspid;
use fspid_fuzzy::scalar::Interval;
use fspid_lti::{Matrix, spectral_radius};
use fspid_sim::Controller;
use fspid_sim::loop_model::LoopModel;

use crate::certificate::{Certificate, Claim};
use crate::description::{LoopDescription, NotProvable};
use crate::gain_set::{GainSet, HeldGains, IncrementMap, KnownSlopes, NoSlopes};
use crate::limits;
use crate::recheck::{Kept, Recheck, Rechecked};
use crate::rest::{NoRest, Rest};
use crate::scope::{Asked, Range};

/// How hard to try. Nothing depends on a clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Cells along each of the supervisor's inputs.
    pub divisions: usize,
    /// Double cones that the plane of the supervisor's inputs is divided into; 0 for no proof with cones.
    pub cones: usize,
    /// Halvings of the interval of the largest output scale.
    pub halvings: u32,
    /// Output scales beyond this are not asked for.
    pub largest_factor: f64,
    /// Points along each input at which frozen gains are looked at.
    pub frozen_points: usize,
    /// Changes of gains in a sample, in half widths of their box, largest first: those that a proof for
    /// gains of bounded rate is tried with.
    pub changes: &'static [f64],
}

impl Default for Effort {
    fn default() -> Self {
        Self {
            divisions: 24,
            cones: 8,
            halvings: 6,
            largest_factor: 64.0,
            frozen_points: 33,
            changes: &[0.1, 0.03, 0.01, 0.003, 0.001, 0.0003],
        }
    }
}

/// What came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The answer, for the whole range of set-points and loads that was asked for.
    pub verdict: Verdict,
    /// What was asked for.
    pub asked: Range,
    /// Where the answer is neither for the range that was asked for: what is proved of a smaller one, the
    /// largest that was found.
    pub instead: Option<(Certificate, Rechecked)>,
    /// Bounds of every gain that the controller can have.
    pub bounds: [Interval; 3],
    /// The largest output scale that was proved, as a factor on the loop's own.
    pub largest: Largest,
    /// Largest offset of the pitch angle from rest for which no limit acts, rad.
    pub pitch_within_rad: Option<f64>,
    /// Why limits are left out of the proof.
    pub limits_left_out: Option<&'static str>,
}

/// The answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// Stable, with the certificate that says so and what its re-check did.
    Proved(Certificate, Rechecked),
    /// Unstable for frozen gains or for a sequence of gains, with the certificate that says so.
    Refuted(Certificate, Rechecked),
    /// Neither.
    Open,
}

/// The largest output scale that was proved.
#[derive(Clone, Debug, PartialEq)]
pub struct Largest {
    /// Proved for this factor; 0 if for none.
    pub proved: f64,
    /// Not proved for this one; none if everything that was asked for was proved.
    pub not_proved: Option<f64>,
    /// The certificate at `proved`, where it is not that of the verdict.
    pub certificate: Option<Certificate>,
}

/// Proves or refutes a loop.
///
/// # Errors
/// [`NotProvable`] for a loop that a proof cannot speak of.
pub fn certify(
    description: &LoopDescription,
    asked: &Asked,
    effort: &Effort,
) -> Result<Outcome, NotProvable> {
    let prover = Prover::new(description, asked, effort)?;
    let set = prover.set(1.0);
    let (verdict, instead) = prover.verdict(&set);
    let largest = prover.largest(&verdict);
    let (pitch_within_rad, limits_left_out) = prover.limits(&verdict);
    Ok(Outcome {
        verdict,
        asked: asked.range,
        instead,
        bounds: set.bounds(),
        largest,
        pitch_within_rad,
        limits_left_out,
    })
}

/// Halvings in which the largest part of a range is looked for.
const SHARES: u32 = 4;

struct Prover<'a> {
    description: &'a LoopDescription,
    asked: &'a Asked,
    effort: &'a Effort,
    /// Set-points and loads for which something is to be proved.
    range: Range,
    enclosed: LoopModel<Interval>,
    /// The same in ordinary arithmetic.
    model: LoopModel<f64>,
    increments: Option<IncrementMap>,
    /// Found where they are asked for.
    slopes: KnownSlopes,
}

impl<'a> Prover<'a> {
    fn new(
        description: &'a LoopDescription,
        asked: &'a Asked,
        effort: &'a Effort,
    ) -> Result<Self, NotProvable> {
        description.clone().provable()?;
        let enclosed = description.enclosed()?;
        let model = enclosed.midpoint();
        let increments = match &description.controller {
            Controller::Fixed(_) => None,
            Controller::SelfTuning(fspid) => {
                Some(IncrementMap::of(fspid.tuner(), effort.divisions)?)
            }
        };
        Ok(Self {
            description,
            asked,
            effort,
            range: asked.range,
            enclosed,
            model,
            increments,
            slopes: KnownSlopes::default(),
        })
    }

    fn set(&self, factor: f64) -> GainSet {
        match &self.increments {
            Some(increments) => increments.gains(factor),
            None => GainSet::fixed(self.description.controller.nominal()),
        }
    }

    fn tuned(&self) -> Option<&Fspid<f64>> {
        match &self.description.controller {
            Controller::Fixed(_) => None,
            Controller::SelfTuning(fspid) => Some(fspid),
        }
    }

    /// The answer, and what is proved for less where it is neither.
    fn verdict(&self, set: &GainSet) -> (Verdict, Option<(Certificate, Rechecked)>) {
        if let Some(found) = self.frozen_growth() {
            return (found, None);
        }
        if let Some((certificate, rechecked)) = self.stable(set) {
            return (Verdict::Proved(certificate, rechecked), None);
        }
        match self.smaller(set) {
            None => (self.sequence_growth().unwrap_or(Verdict::Open), None),
            smaller => (Verdict::Open, smaller),
        }
    }

    /// A proof for the range, if there is one.
    fn stable(&self, set: &GainSet) -> Option<(Certificate, Rechecked)> {
        if let Some(found) = self.proved(set, 1.0, true) {
            return Some(found);
        }
        // A claim about gains of bounded rate is one about this loop only if its law keeps to the rate.
        let bounded = set.rate_per_s.and_then(|_| self.bounded(set, 1.0));
        bounded.filter(|(_, rechecked)| rechecked.kept == Some(Kept::Everywhere))
    }

    /// What can be proved for less than the range that is asked for: the largest part of it, by halving, down
    /// to the return to rest alone.
    fn smaller(&self, set: &GainSet) -> Option<(Certificate, Rechecked)> {
        if self.range == Range::REST {
            return None;
        }
        let proved = |share: f64| self.within(self.range.scaled(share)).stable(set);
        // Found once, for all parts of the range.
        let _ = self.rest(set).map(|rest| self.held(set, 1.0, &rest).is_ok());
        let mut best = proved(0.0)?;
        let (mut within, mut beyond) = (0.0, 1.0);
        for _ in 0..self.effort.halvings.min(SHARES) {
            let share = 0.5 * (within + beyond);
            match proved(share) {
                Some(found) => (best, within) = (found, share),
                None => beyond = share,
            }
        }
        Some(best)
    }

    /// A certificate of stability at an output scale, re-checked; with the best rate if that is asked for.
    fn proved(
        &self,
        set: &GainSet,
        factor: f64,
        best_rate: bool,
    ) -> Option<(Certificate, Rechecked)> {
        if let Some(found) = self.any_speed(set, factor, best_rate) {
            return Some(found);
        }
        self.tied(set, factor, best_rate)
    }

    /// The prover of the same loop for another range of set-points and loads.
    fn within(&self, range: Range) -> Self {
        Self {
            enclosed: self.enclosed.clone(),
            model: self.model.clone(),
            increments: self.increments.clone(),
            slopes: self.slopes.clone(),
            range,
            ..*self
        }
    }

    /// Rest for the range of set-points and loads.
    fn rest(&self, set: &GainSet) -> Result<Rest, NoRest> {
        Rest::of(self.description, set, self.range)
    }

    /// A set with what its gains make of the command that is held at rest.
    fn held(&self, set: &GainSet, factor: f64, rest: &Rest) -> Result<GainSet, NoSlopes> {
        match self.tuned() {
            None => Ok(set.clone()),
            Some(fspid) => {
                set.holding(fspid, factor, rest.held, &self.slopes).map(|(held, _)| held)
            }
        }
    }

    fn level(&self, corners: &[HeldGains], of: (&Matrix, &Rest)) -> Option<f64> {
        limits::level(self.description, &self.model, corners, of)
    }

    /// Closed loops at some gains, if each of them is stable on its own.
    fn matrices(&self, gains: &[HeldGains]) -> Option<Vec<Matrix>> {
        let closed = gains.iter().map(|held| {
            self.model.with_change_gain(held.change_gain).closed_matrix(held.gains).ok()
        });
        let matrices: Vec<Matrix> = closed.collect::<Option<_>>()?;
        let holds = |matrix: &Matrix| spectral_radius(matrix).is_ok_and(|radius| radius < 1.0);
        matrices.iter().all(holds).then_some(matrices)
    }

    fn covers_limits(&self) -> bool {
        limits::not_covered(self.description).is_none()
    }

    fn rechecked(
        &self,
        claim: Claim,
        factor: f64,
        level: Option<f64>,
    ) -> Option<(Certificate, Rechecked)> {
        let certificate = Certificate {
            description: self.description.clone(),
            output_factor: factor,
            divisions: self.effort.divisions,
            range: self.range,
            left_out: self.asked.left_out.clone(),
            claim,
            level,
        };
        let set = self.set(factor);
        let recheck = Recheck::with(&certificate, self.enclosed.clone(), set, &self.slopes).ok()?;
        let rechecked = recheck.run().ok()?;
        Some((certificate, rechecked))
    }

    fn limits(&self, verdict: &Verdict) -> (Option<f64>, Option<&'static str>) {
        if self.description.limits().is_empty() {
            return (None, None);
        }
        if let Some(reason) = limits::not_covered(self.description) {
            return (None, Some(reason));
        }
        let Verdict::Proved(certificate, _) = verdict else { return (None, None) };
        let form = match &certificate.claim {
            Claim::AnySpeed { form, .. } | Claim::Tied { form, .. } => form,
            _ => return (None, Some("the proof for gains of bounded rate leaves limits out")),
        };
        match certificate.level.and_then(|level| limits::pitch_within(&self.enclosed, form, level))
        {
            Some(pitch_rad) => (Some(pitch_rad), None),
            None => (None, Some("rest itself lies at a limit")),
        }
    }
}

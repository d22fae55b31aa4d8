//! From a loop to one of three answers: proved, refuted, open.

mod bounded;
mod disturbed;
mod disturbed_moving;
mod largest;
mod stable;
mod unstable;

pub use disturbed::{Unbounded, bound_disturbances};

use core::cell::RefCell;

use fspid_core::{Fspid, Gains};
use fspid_lti::{Matrix, spectral_radius};
use fspid_numeric::scalar::Interval;
use fspid_sim::Controller;
use fspid_sim::loop_model::LoopModel;

use crate::certificate::{Certificate, Claim};
use crate::description::{LoopDescription, NotProvable};
use crate::family::Family;
use crate::gain_set::{GainSet, HeldGains, IncrementMap, KnownSlopes, NoSlopes};
use crate::limits;
use crate::recheck::{Recheck, RecheckError, Rechecked};
use crate::rest::{NoRest, Rest};
use crate::scope::{Asked, Range};
use crate::sizes;
use crate::solve::{self, never};
use crate::steps::{self, Commanded, Steps};

/// How hard to try. Nothing depends on a clock.
#[derive(Clone, Copy, Debug)]
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
    /// Whether the sets of flights that take long are flown, a minute or two: steps with limits of gains that remember, and
    /// the flights that the scenario commands.
    pub long_flights: bool,
    /// Asked between the steps of the work; once it says yes, [`certify`] gives up with [`NotProvable::Stopped`]. It may not
    /// say no again.
    pub stops: fn() -> bool,
}

impl Default for Effort {
    fn default() -> Self {
        Self {
            divisions: 24,
            cones: 8,
            halvings: 6,
            largest_factor: 64.0,
            frozen_points: 33,
            long_flights: true,
            stops: never,
        }
    }
}

/// Outcome of a proof attempt.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The answer, for the whole range of set-points and loads that was asked for.
    pub verdict: Verdict,
    /// What was asked for.
    pub asked: Range,
    /// Where the answer is neither for the range that was asked for: what is proved of a smaller one, the
    /// largest that was found.
    pub instead: Option<(Certificate, Rechecked)>,
    /// Why the answer is neither, where that is known.
    pub open_because: Option<RecheckError>,
    /// Bounds of every gain that the controller can have.
    pub bounds: [Interval; 3],
    /// The largest output scale that was proved, as a factor on the loop's own.
    pub largest: Largest,
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
/// [`NotProvable`] for a loop that a proof cannot speak of, and where the effort was stopped.
pub fn certify(
    description: &LoopDescription,
    asked: &Asked,
    effort: &Effort,
) -> Result<Outcome, NotProvable> {
    let unless_stopped = || match (effort.stops)() {
        true => Err(NotProvable::Stopped),
        false => Ok(()),
    };
    unless_stopped()?;
    let prover = Prover::new(description, asked, effort)?;
    let set = prover.set(1.0);
    let (verdict, instead) = prover.verdict(&set);
    let verdict = prover.with_steps(verdict, &set);
    let open_because = match verdict {
        Verdict::Open => prover.doubt(&set),
        Verdict::Proved(..) | Verdict::Refuted(..) => None,
    };
    let largest = prover.largest(&verdict);
    // What was found of a search that was stopped says nothing.
    unless_stopped()?;
    Ok(Outcome {
        verdict,
        asked: asked.range,
        instead,
        open_because,
        bounds: set.bounds(),
        largest,
    })
}

/// Whether a loop is proved stable while its gains move, for all that is asked: the first half of [`certify`] alone,
/// which looks for no smaller range and no larger output scale.
///
/// What is necessary is asked first, and ends most searches at once: that the loop is stable at rest, and at the
/// gains that span all that the controller can have, each standing still. Only then a form is looked for.
///
/// # Errors
/// As [`certify`].
pub fn is_proved(
    description: &LoopDescription,
    asked: &Asked,
    effort: &Effort,
) -> Result<bool, NotProvable> {
    let prover = Prover::new(description, asked, effort)?;
    let set = prover.set(1.0);
    let proved = prover.frozen_growth().is_none() && prover.stable(&set).is_some();
    if (effort.stops)() { Err(NotProvable::Stopped) } else { Ok(proved) }
}

/// Halvings in which the largest part of a range is looked for.
const SHARES: u32 = 4;
/// Halvings in which the largest part is looked for at which rest is within all limits: within 0.4 % of it, so
/// that some room is left for motions.
const SHARES_AT_REST: u32 = 8;

/// What is known of a loop, and how hard to try.
pub(crate) struct Prover<'a> {
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
    /// The least remainder of a proof that was given up because too much remains.
    too_much: RefCell<Option<RecheckError>>,
}

impl<'a> Prover<'a> {
    pub(crate) fn new(
        description: &'a LoopDescription,
        asked: &'a Asked,
        effort: &'a Effort,
    ) -> Result<Self, NotProvable> {
        description.clone().provable()?;
        if let Some(wrong) = description.too_large_to_search() {
            return Err(NotProvable::TooLarge(wrong));
        }
        let enclosed = description.enclosed()?;
        let model = enclosed.midpoint();
        let increments = match &description.controller {
            Controller::Fixed(_) => None,
            Controller::SelfTuning(fspid) => {
                let map = IncrementMap::until(fspid.tuner(), effort.divisions, effort.stops)?;
                let map = map.ok_or(NotProvable::Stopped)?;
                Some(map.sampled_every(fspid.config().dt_s))
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
            too_much: RefCell::default(),
        })
    }

    pub(crate) fn set(&self, factor: f64) -> GainSet {
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

    /// The verdict with what is proved of steps from rest.
    fn with_steps(&self, verdict: Verdict, set: &GainSet) -> Verdict {
        let Verdict::Proved(certificate, rechecked) = verdict else { return verdict };
        if steps::remembers(&certificate.description) && !self.effort.long_flights {
            return Verdict::Proved(certificate, rechecked);
        }
        let Some((steps, commanded)) = self.flights(&certificate, set) else {
            return Verdict::Proved(certificate, rechecked);
        };
        let again = |certificate: &Certificate| {
            let recheck =
                Recheck::with(certificate, self.enclosed.clone(), set.clone(), &self.slopes);
            recheck.ok()?.until(self.effort.stops).run().ok()
        };
        let with = |steps: &Option<Steps>, commanded: &Option<Commanded>| {
            let (steps, commanded) = (steps.clone(), commanded.clone());
            Certificate { steps, commanded, ..certificate.clone() }
        };
        // One that is not believed is not to take the other with it.
        let tried = [(&steps, &commanded), (&steps, &None), (&None, &commanded)];
        let all = tried.into_iter().map(|(steps, commanded)| with(steps, commanded));
        let some = all.filter(|it| it.steps.is_some() || it.commanded.is_some());
        let found = some.filter_map(|it| again(&it).map(|rechecked| (it, rechecked))).next();
        let (certificate, rechecked) = found.unwrap_or((certificate, rechecked));
        Verdict::Proved(certificate, rechecked)
    }

    /// Steps from rest and the flights that the scenario commands, as far as they are found.
    fn flights(
        &self,
        certificate: &Certificate,
        set: &GainSet,
    ) -> Option<(Option<Steps>, Option<Commanded>)> {
        let held = self.rest(set).ok().and_then(|rest| self.held(set, 1.0, &rest).ok())?;
        let sets = [set, &held];
        let search = steps::Search::of(certificate, &self.enclosed, sets, self.effort.stops)?;
        let commands = self.asked.commands.as_ref().ok().and_then(Option::as_ref);
        let commands = commands.filter(|_| self.effort.long_flights);
        Some((search.steps(), commands.and_then(|commands| search.commanded(commands))))
    }

    /// A proof for the range, if there is one.
    pub(crate) fn stable(&self, set: &GainSet) -> Option<(Certificate, Rechecked)> {
        if let Some(found) = self.proved(set, 1.0, true) {
            return Some(found);
        }
        // A claim about gains of bounded rate is one about this loop only if its law keeps to the rate.
        let bounded = set.rate_per_s.and_then(|_| self.bounded(set, 1.0));
        bounded.filter(|(_, rechecked)| rechecked.keeps_to_the_rate)
    }

    /// What can be proved for less than the range that is asked for: the largest part of it, by halving, down
    /// to the return to rest alone.
    fn smaller(&self, set: &GainSet) -> Option<(Certificate, Rechecked)> {
        if self.range == Range::REST {
            return None;
        }
        let proved = |share: f64| self.within(self.range.scaled(share)).stable(set);
        let (mut within, mut beyond) = (0.0, self.share_at_rest(set));
        // First: of a larger range more may remain, so that it may be proved where a smaller one is not.
        if beyond < 1.0
            && let Some(found) = proved(beyond)
        {
            return Some(found);
        }
        let mut best = proved(0.0)?;
        for _ in 0..self.effort.halvings.min(SHARES) {
            let share = 0.5 * (within + beyond);
            match proved(share) {
                Some(found) => (best, within) = (found, share),
                None => beyond = share,
            }
        }
        Some(best)
    }

    /// The largest share of the range at which rest is known and within all limits, from below.
    fn share_at_rest(&self, set: &GainSet) -> f64 {
        let known = |share: f64| self.within(self.range.scaled(share)).rest(set).is_ok();
        if known(1.0) {
            return 1.0;
        }
        let (mut within, mut beyond) = (0.0, 1.0);
        for _ in 0..SHARES_AT_REST {
            let share = 0.5 * (within + beyond);
            if known(share) { within = share } else { beyond = share }
        }
        within
    }

    /// Why nothing is proved of the range, where that is known.
    fn doubt(&self, set: &GainSet) -> Option<RecheckError> {
        let rest = self.rest(set).err().map(RecheckError::Rest);
        let too_much = || self.too_much.borrow().clone();
        rest.or_else(too_much).or_else(|| self.grows(set))
    }

    /// The corner of the set at which the loop grows most, standing still.
    fn grows(&self, set: &GainSet) -> Option<RecheckError> {
        let radius = |gains: Gains<f64>| {
            let matrix = self.model.closed_matrix(gains).ok()?;
            Some((spectral_radius(&matrix).ok()?, gains))
        };
        let all = set.hull().into_iter().filter_map(radius);
        let (radius, gains) = all.max_by(|one, other| one.0.total_cmp(&other.0))?;
        (radius > 1.0).then_some(RecheckError::Grows { gains })
    }

    /// Keeps the doubt that too much remains in the loop as it is, over the whole range.
    fn note(&self, factor: f64, doubt: &RecheckError) {
        let RecheckError::Remains(remains) = doubt else { return };
        let whole = factor.to_bits() == 1.0_f64.to_bits() && self.range == self.asked.range;
        let mut least = self.too_much.borrow_mut();
        let better = match &*least {
            Some(RecheckError::Remains(known)) => remains.remains_rad < known.remains_rad,
            _ => true,
        };
        if whole && better {
            *least = Some(doubt.clone());
        }
    }

    /// A certificate of stability at an output scale, re-checked; with the best rate if that is asked for.
    fn proved(
        &self,
        set: &GainSet,
        factor: f64,
        best_rate: bool,
    ) -> Option<(Certificate, Rechecked)> {
        if let Some(found) = self.common_quadratic(set, factor, best_rate) {
            return Some(found);
        }
        self.s_procedure(set, factor, best_rate)
    }

    /// The prover of the same loop for another range of set-points and loads.
    fn within(&self, range: Range) -> Self {
        Self {
            enclosed: self.enclosed.clone(),
            model: self.model.clone(),
            increments: self.increments.clone(),
            slopes: self.slopes.clone(),
            too_much: RefCell::default(),
            range,
            ..*self
        }
    }

    /// The prover of the same controller around another plant.
    pub(crate) fn of(&self, enclosed: LoopModel<Interval>) -> Self {
        Self { model: enclosed.midpoint(), enclosed, ..self.within(self.range) }
    }

    /// The same with another plant in ordinary arithmetic, where nothing is proved.
    fn around(&self, model: LoopModel<f64>) -> Self {
        Self { model, ..self.within(self.range) }
    }

    pub(crate) const fn description(&self) -> &LoopDescription {
        self.description
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

    fn level(&self, corners: &[HeldGains], form: &Matrix, rest: &Rest) -> Option<f64> {
        // Of gains that remember what is held no level is claimed.
        if corners.iter().any(|held| held.remembered.is_some()) {
            return None;
        }
        let rows = |held| limits::rows_held(self.description, &self.model, held, rest);
        limits::level(corners.iter().map(|held| (form, rows(held))))
    }

    /// Closed loops at some gains, if each of them is stable on its own.
    fn matrices(&self, gains: &[HeldGains]) -> Option<Vec<Matrix>> {
        let closed = gains.iter().map(|held| {
            let model = self.model.with_change_gain(held.change_gain);
            match (held.remembered, self.tuned()) {
                (Some(corner), Some(fspid)) => {
                    Matrix::from_rows(&corner.closed(&model, fspid, held.gains)).ok()
                }
                _ => model.closed_matrix(held.gains).ok(),
            }
        });
        let matrices: Vec<Matrix> = closed.collect::<Option<_>>()?;
        let holds = |matrix: &Matrix| spectral_radius(matrix).is_ok_and(|radius| radius < 1.0);
        matrices.iter().all(holds).then_some(matrices)
    }

    /// How hard a single search tries.
    fn search(&self) -> solve::Effort {
        solve::Effort { stops: self.effort.stops, ..solve::Effort::default() }
    }

    fn covers_limits(&self) -> bool {
        limits::not_covered(self.description).is_none()
    }

    pub(crate) fn rechecked(
        &self,
        claim: Claim,
        factor: f64,
        level: Option<f64>,
    ) -> Option<(Certificate, Rechecked)> {
        if (self.effort.stops)() {
            return None;
        }
        let certificate = self.certificate(claim, factor, level);
        let set = self.set(factor);
        let recheck = Recheck::with(&certificate, self.enclosed.clone(), set, &self.slopes).ok()?;
        let rechecked = recheck
            .until(self.effort.stops)
            .run()
            .map_err(|doubt| self.note(factor, &doubt))
            .ok()?;
        Some((certificate, rechecked))
    }

    /// The claim with all that it is about.
    fn certificate(&self, claim: Claim, factor: f64, level: Option<f64>) -> Certificate {
        Certificate {
            description: self.description.clone(),
            output_factor: factor,
            divisions: self.effort.divisions,
            range: self.range,
            left_out: self.asked.left_out.clone(),
            claim,
            level,
            steps: None,
            commanded: None,
            family: None,
            disturbances: Vec::new(),
            nonlinear: None,
        }
    }

    /// True if the work of a re-check that a family makes is allowed.
    pub(crate) fn may_be_checked(&self, claim: &Claim, family: &Family) -> bool {
        let alone = self.certificate(claim.clone(), 1.0, None);
        sizes::check(&Certificate { family: Some(family.clone()), ..alone }).is_ok()
    }

    /// What a re-check finds of the return to rest, of some gains.
    pub(crate) fn rest_rechecked(&self, claim: Claim, set: &GainSet) -> Option<Rechecked> {
        let certificate = self.certificate(claim, 1.0, None);
        let how = (&self.slopes, self.effort.stops);
        Recheck::of_rest(&certificate, &self.enclosed, set, how).ok()
    }
}

//! Forms that decrease however fast the gains move, and forms that decrease as the error ties the gains.

use fspid_core::{Fspid, Law, SecondInput};
use fspid_lti::Matrix;
use fspid_sim::loop_model::LoopModel;

use super::Prover;
use crate::certificate::{Certificate, Claim};
use crate::gain_set::GainSet;
use crate::limits;
use crate::recheck::{Rechecked, cone_form};
use crate::solve::{self, Condition, LyapunovProblem};

/// Corners may lie outside of those that are solved for by this share of half the set's extent: the form
/// found lies inside of the set of forms, and the re-check asks all corners.
const THINNED: f64 = 0.03;

impl Prover<'_> {
    pub(super) fn common_quadratic(
        &self,
        set: &GainSet,
        factor: f64,
        best_rate: bool,
    ) -> Option<(Certificate, Rechecked)> {
        let rest = self.rest(set).ok()?;
        let corners = self.held(set, factor, &rest).ok()?.held_hull(THINNED);
        let matrices = self.matrices(&corners)?;
        let conditions: Vec<Condition<'_>> =
            matrices.iter().map(|matrix| Condition { matrix, cone: None }).collect();
        let problem = LyapunovProblem { conditions: &conditions, cones: &[], rate: 1.0 };
        self.settled(&problem, factor, best_rate, |solution, rate| {
            let form = solution.p;
            let level = self.level(&corners, &form, &rest);
            (Claim::CommonQuadratic { form, rate }, level)
        })
    }

    /// A claim of one form for several loops that differ in their plants alone, in ordinary arithmetic: what is to be asked
    /// of everything between them.
    pub(crate) fn common_of(&self, loops: &[LoopModel<f64>], set: &GainSet) -> Option<Claim> {
        let form = self.common_at(&self.matrices_of(loops, set)?, 1.0)?;
        Some(Claim::CommonQuadratic { form, rate: 1.0 })
    }

    /// One form that falls at a rate under some loops.
    pub(crate) fn common_at(&self, matrices: &[Matrix], rate: f64) -> Option<Matrix> {
        solve::common_form(matrices, rate, &self.search())
    }

    /// A form that falls fast under some loops; none where none falls.
    pub(crate) fn fast_at(&self, matrices: &[Matrix]) -> Option<Matrix> {
        solve::fast_form(matrices, &self.search())
    }

    /// Closed loops of several plants at the gains that span the set, if each of them is stable on its own.
    pub(crate) fn matrices_of(
        &self,
        loops: &[LoopModel<f64>],
        set: &GainSet,
    ) -> Option<Vec<Matrix>> {
        let rest = self.rest(set).ok()?;
        let corners = self.held(set, 1.0, &rest).ok()?.held_hull(THINNED);
        let closed = loops.iter().map(|model| self.around(model.clone()).matrices(&corners));
        Some(closed.collect::<Option<Vec<_>>>()?.concat())
    }

    /// Rows from the state to everything that is limited, each over its limit, at the gains that span the set.
    pub(crate) fn limited(&self, set: &GainSet) -> Option<Vec<Vec<f64>>> {
        let rest = self.rest(set).ok()?;
        let corners = self.held(set, 1.0, &rest).ok()?.held_hull(THINNED);
        let rows = |held| limits::rows_held(self.description, &self.model, held, &rest);
        let rows = corners.iter().flat_map(rows);
        let over = |(row, limit): (Vec<f64>, f64)| {
            (limit > 0.0).then(|| row.iter().map(|it| it / limit).collect())
        };
        rows.map(over).collect()
    }

    /// True where something of bounded size may never cease.
    fn needs_a_rate(&self) -> bool {
        let blurred = self.description.resolves_in_steps();
        blurred || self.rest(&self.set(1.0)).is_ok_and(|rest| !rest.held.is_none())
    }

    /// True for a law that remembers.
    fn remembers(&self) -> bool {
        self.tuned().is_some_and(|fspid| fspid.tuner().settings().law != Law::Memoryless)
    }

    /// As the memoryless law ties the gains to the error; not for gains that remember.
    pub(super) fn s_procedure(
        &self,
        set: &GainSet,
        factor: f64,
        best_rate: bool,
    ) -> Option<(Certificate, Rechecked)> {
        let tied = |fspid: &&Fspid<f64>| {
            let settings = fspid.tuner().settings();
            settings.law == Law::Memoryless && settings.second_input == SecondInput::Change
        };
        let fspid = self.tuned().filter(tied).filter(|_| self.effort.cones > 0)?;
        let rest = self.rest(set).ok()?;
        // With a steady error, or one that is seen in steps, gains are tied to something else.
        if rest.error_rad > 0.0 || self.description.resolves_in_steps() {
            return None;
        }
        let held = self.held(set, factor, &rest).ok()?;
        let cones = set.cones(self.effort.cones);
        let forms = cones.iter().map(|cone| cone_form(&self.enclosed, fspid, cone));
        let forms: Vec<Matrix> = forms.map(|form| form.midpoint()).collect();
        let mut matrices = Vec::new();
        let mut corners = Vec::new();
        for (number, cone) in cones.iter().enumerate() {
            let gains = held.of_cells(&cone.cells).held_hull(THINNED);
            matrices.extend(self.matrices(&gains)?.into_iter().map(|matrix| (number, matrix)));
            corners.extend(gains);
        }
        let conditions: Vec<Condition<'_>> =
            matrices.iter().map(|(cone, matrix)| Condition { matrix, cone: Some(*cone) }).collect();
        let problem = LyapunovProblem { conditions: &conditions, cones: &forms, rate: 1.0 };
        self.settled(&problem, factor, best_rate, |solution, rate| {
            let solve::Solution { p: form, multipliers, .. } = solution;
            let level = self.level(&corners, &form, &rest);
            (Claim::SProcedure { form, rate, multipliers }, level)
        })
    }

    /// Solves, and re-checks what was found: at the best rate first, then for stability alone.
    pub(super) fn settled(
        &self,
        problem: &LyapunovProblem<'_>,
        factor: f64,
        best_rate: bool,
        claim: impl Fn(solve::Solution, f64) -> (Claim, Option<f64>),
    ) -> Option<(Certificate, Rechecked)> {
        let effort = self.search();
        let plain = || match solve::common_lyapunov(problem, &effort) {
            solve::Verdict::Found(solution) => Some((solution, 1.0)),
            solve::Verdict::NotFound { .. } => None,
        };
        let best = || {
            let found = solve::best_rate(problem, &effort).filter(|found| found.rate < 1.0)?;
            Some((found.solution, found.rate))
        };
        let rechecked = |(solution, rate): (solve::Solution, f64)| {
            let (claim, level) = claim(solution, rate);
            self.rechecked(claim, factor, level.filter(|_| self.covers_limits()))
        };
        // What remains of a motion is known where there is a rate; nothing is known without of gains that remember.
        let needs_a_rate = self.needs_a_rate();
        let at_best = if best_rate || needs_a_rate { best().and_then(rechecked) } else { None };
        if needs_a_rate && self.remembers() {
            return at_best;
        }
        at_best.or_else(|| plain().and_then(rechecked))
    }
}

//! From a loop to one of three answers: proved, refuted, open.

use std::collections::BTreeSet;

use fspid_core::{Fspid, Gains, Law};
use fspid_fuzzy::scalar::Interval;
use fspid_lti::{Matrix, spectral_radius};
use fspid_sim::Controller;
use fspid_sim::loop_model::LoopModel;

use crate::certificate::{Certificate, Claim};
use crate::description::{LoopDescription, NotProvable};
use crate::gain_set::{GainSet, IncrementMap};
use crate::limits;
use crate::recheck::{Recheck, Rechecked, cone_form, produced};
use crate::solve::{self, Condition, Problem};

/// Corners may lie outside of those that are solved for by this share of half the set's extent: the form
/// found lies inside of the set of forms, and the re-check asks all corners.
const THINNED: f64 = 0.03;

/// How hard to try. Nothing depends on a clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Cells along each of the supervisor's inputs.
    pub divisions: usize,
    /// Double cones that the plane of the supervisor's inputs is divided into.
    pub cones: usize,
    /// Halvings of the interval of the largest output scale.
    pub halvings: u32,
    /// Output scales beyond this are not asked for.
    pub largest_factor: f64,
    /// Points along each input at which frozen gains are looked at.
    pub frozen_points: usize,
}

impl Default for Effort {
    fn default() -> Self {
        Self { divisions: 24, cones: 8, halvings: 6, largest_factor: 64.0, frozen_points: 33 }
    }
}

/// What came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The answer.
    pub verdict: Verdict,
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
pub fn certify(description: &LoopDescription, effort: &Effort) -> Result<Outcome, NotProvable> {
    let prover = Prover::new(description, effort)?;
    let set = prover.set(1.0);
    let verdict = prover.verdict(&set);
    let largest = prover.largest(&verdict);
    let (pitch_within_rad, limits_left_out) = prover.limits(&verdict);
    Ok(Outcome { verdict, bounds: set.bounds(), largest, pitch_within_rad, limits_left_out })
}

struct Prover<'a> {
    description: &'a LoopDescription,
    effort: &'a Effort,
    enclosed: LoopModel<Interval>,
    /// The same in ordinary arithmetic.
    model: LoopModel<f64>,
    increments: Option<IncrementMap>,
}

impl<'a> Prover<'a> {
    fn new(description: &'a LoopDescription, effort: &'a Effort) -> Result<Self, NotProvable> {
        let enclosed = description.enclosed()?;
        let model = enclosed.midpoint();
        let increments = match &description.controller {
            Controller::Fixed(_) => None,
            Controller::SelfTuning(fspid) => {
                Some(IncrementMap::of(fspid.tuner(), effort.divisions)?)
            }
        };
        Ok(Self { description, effort, enclosed, model, increments })
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

    fn verdict(&self, set: &GainSet) -> Verdict {
        if let Some(found) = self.frozen_growth() {
            return found;
        }
        if let Some((certificate, rechecked)) = self.proved(set, 1.0, true) {
            return Verdict::Proved(certificate, rechecked);
        }
        self.sequence_growth().unwrap_or(Verdict::Open)
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

    /// Closed loops at some gains, if each of them is stable on its own.
    fn matrices(&self, gains: &[Gains<f64>]) -> Option<Vec<Matrix>> {
        let closed = gains.iter().map(|gains| self.model.closed_matrix(*gains).ok());
        let matrices: Vec<Matrix> = closed.collect::<Option<_>>()?;
        let holds = |matrix: &Matrix| spectral_radius(matrix).is_ok_and(|radius| radius < 1.0);
        matrices.iter().all(holds).then_some(matrices)
    }

    fn any_speed(
        &self,
        set: &GainSet,
        factor: f64,
        best_rate: bool,
    ) -> Option<(Certificate, Rechecked)> {
        let corners = set.hull_within(THINNED);
        let matrices = self.matrices(&corners)?;
        let conditions: Vec<Condition<'_>> =
            matrices.iter().map(|matrix| Condition { matrix, cone: None }).collect();
        let problem = Problem { conditions: &conditions, cones: &[], rate: 1.0 };
        self.settled(&problem, factor, best_rate, |solution, rate| {
            let form = solution.p;
            let level = limits::level(self.description, &self.model, &corners, &form);
            (Claim::AnySpeed { form, rate }, level)
        })
    }

    /// As the memoryless law ties the gains to the error; not for gains that remember.
    fn tied(
        &self,
        set: &GainSet,
        factor: f64,
        best_rate: bool,
    ) -> Option<(Certificate, Rechecked)> {
        let fspid = self.tuned().filter(|fspid| fspid.tuner().settings().law == Law::Memoryless)?;
        let cones = set.cones(self.effort.cones);
        let forms = cones.iter().map(|cone| cone_form(&self.enclosed, fspid, cone));
        let forms: Vec<Matrix> = forms.map(|form| form.midpoint()).collect();
        let mut matrices = Vec::new();
        let mut corners = Vec::new();
        for (number, cone) in cones.iter().enumerate() {
            let gains = set.of_cells(&cone.cells).hull_within(THINNED);
            matrices.extend(self.matrices(&gains)?.into_iter().map(|matrix| (number, matrix)));
            corners.extend(gains);
        }
        let conditions: Vec<Condition<'_>> =
            matrices.iter().map(|(cone, matrix)| Condition { matrix, cone: Some(*cone) }).collect();
        let problem = Problem { conditions: &conditions, cones: &forms, rate: 1.0 };
        self.settled(&problem, factor, best_rate, |solution, rate| {
            let solve::Solution { p: form, multipliers, .. } = solution;
            let level = limits::level(self.description, &self.model, &corners, &form);
            (Claim::Tied { form, rate, multipliers }, level)
        })
    }

    /// Solves, and re-checks what was found: at the best rate first, then for stability alone.
    fn settled(
        &self,
        problem: &Problem<'_>,
        factor: f64,
        best_rate: bool,
        claim: impl Fn(solve::Solution, f64) -> (Claim, Option<f64>),
    ) -> Option<(Certificate, Rechecked)> {
        let effort = solve::Effort::default();
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
        let at_best = if best_rate { best().and_then(rechecked) } else { None };
        at_best.or_else(|| plain().and_then(rechecked))
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
            claim,
            level,
        };
        let recheck = Recheck::with(&certificate, self.enclosed.clone(), self.set(factor));
        let rechecked = recheck.run().ok()?;
        Some((certificate, rechecked))
    }

    /// Gains that the loop really has, standing still, under which it grows.
    fn frozen_growth(&self) -> Option<Verdict> {
        let worst = self.frozen().into_iter().max_by(|one, other| one.1.total_cmp(&other.1))?;
        let (input, radius, matrix) = worst;
        if !(radius > 1.0) {
            return None;
        }
        let solve::InstabilityForm { p: form, direction, factor, .. } =
            solve::instability_form(&matrix)?;
        let claim = Claim::FrozenGrowth { input, factor, form, direction };
        let (certificate, rechecked) = self.rechecked(claim, 1.0, None)?;
        Some(Verdict::Refuted(certificate, rechecked))
    }

    /// Inputs of the supervisor, the loop with the gains that it produces there, and its spectral radius.
    fn frozen(&self) -> Vec<([f64; 2], f64, Matrix)> {
        let found = |input: [f64; 2]| {
            let matrix =
                self.model.closed_matrix(produced(&self.description.controller, input)).ok()?;
            let radius = spectral_radius(&matrix).ok()?;
            Some((input, radius, matrix))
        };
        self.inputs().into_iter().filter_map(found).collect()
    }

    /// A grid over the supervisor's inputs; for fixed gains, and for gains that remember, rest alone.
    fn inputs(&self) -> Vec<[f64; 2]> {
        let memoryless = self.tuned().filter(|f| f.tuner().settings().law == Law::Memoryless);
        let Some(fspid) = memoryless else {
            return vec![[0.0; 2]];
        };
        let (range, side) = (fspid.tuner().supervisor().range(), self.effort.frozen_points.max(2));
        let place = |index: usize| range * (2.0 * index as f64 / (side - 1) as f64 - 1.0);
        let pairs = (0..side).flat_map(|row| (0..side).map(move |column| (row, column)));
        pairs.map(|(row, column)| [place(row), place(column)]).collect()
    }

    /// Gains that the supervisor produces, in an order of our own, under which the loop grows.
    fn sequence_growth(&self) -> Option<Verdict> {
        let frozen = self.frozen();
        if frozen.len() < 2 {
            return None;
        }
        let chosen = self.extreme(&frozen);
        let matrices: Vec<Matrix> =
            chosen.iter().filter_map(|&index| Some(frozen.get(index)?.2.clone())).collect();
        let growth = solve::growing_sequence(&matrices, &solve::Effort::default())?;
        let mut product = Matrix::identity(self.model.size());
        let mut inputs = Vec::with_capacity(growth.sequence.len());
        for &place in &growth.sequence {
            inputs.push(frozen.get(*chosen.get(place)?)?.0);
            product = matrices.get(place)?.product(&product).ok()?;
        }
        let solve::InstabilityForm { p: form, direction, factor, .. } =
            solve::instability_form(&product)?;
        let claim = Claim::SequenceGrowth { inputs, factor, form, direction };
        let (certificate, rechecked) = self.rechecked(claim, 1.0, None)?;
        Some(Verdict::Refuted(certificate, rechecked))
    }

    /// Places of the gains that are largest in some direction: few, and at the corners of them all.
    fn extreme(&self, frozen: &[([f64; 2], f64, Matrix)]) -> Vec<usize> {
        let gains: Vec<[f64; 3]> = frozen
            .iter()
            .map(|(input, ..)| {
                let Gains { kp, ki, kd } = produced(&self.description.controller, *input);
                [kp, ki, kd]
            })
            .collect();
        let directions = (-1..=1_i32).flat_map(|kp| {
            (-1..=1_i32).flat_map(move |ki| (-1..=1_i32).map(move |kd| [kp, ki, kd]))
        });
        let spread: [f64; 3] = std::array::from_fn(|gain| {
            let values = gains.iter().map(|triple| triple[gain]);
            let (least, most) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), value| {
                (a.min(value), b.max(value))
            });
            if most > least { most - least } else { 1.0 }
        });
        let mut chosen = BTreeSet::new();
        for direction in directions {
            let along = |triple: &[f64; 3]| -> f64 {
                (0..3).map(|gain| f64::from(direction[gain]) * triple[gain] / spread[gain]).sum()
            };
            let best = gains.iter().enumerate();
            let best = best.max_by(|one, other| along(one.1).total_cmp(&along(other.1)));
            chosen.extend(best.map(|(index, _)| index));
        }
        chosen.into_iter().collect()
    }

    /// The largest output scale that can be proved, by halving.
    fn largest(&self, verdict: &Verdict) -> Largest {
        let tied = !matches!(
            verdict,
            Verdict::Proved(Certificate { claim: Claim::AnySpeed { .. }, .. }, _)
        );
        let mut largest = Largest { proved: 0.0, not_proved: None, certificate: None };
        if self.tuned().is_none() {
            largest.proved = if matches!(verdict, Verdict::Proved(..)) { 1.0 } else { 0.0 };
            return largest;
        }
        let mut next = 1.0;
        if matches!(verdict, Verdict::Proved(..)) {
            largest.proved = 1.0;
            next = 2.0;
        } else {
            largest.not_proved = Some(1.0);
        }
        while largest.not_proved.is_none() && next <= self.effort.largest_factor {
            self.ask(&mut largest, next, tied);
            next *= 2.0;
        }
        for _ in 0..self.effort.halvings {
            let Some(above) = largest.not_proved else { break };
            let middle = 0.5 * (largest.proved + above);
            self.ask(&mut largest, middle, tied);
        }
        largest
    }

    fn ask(&self, largest: &mut Largest, factor: f64, tied: bool) {
        let set = self.set(factor);
        let at_any_speed = self.any_speed(&set, factor, false);
        let found =
            at_any_speed.or_else(|| if tied { self.tied(&set, factor, false) } else { None });
        match found {
            Some((certificate, _)) => {
                largest.proved = factor;
                largest.certificate = Some(certificate);
            }
            None => largest.not_proved = Some(factor),
        }
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

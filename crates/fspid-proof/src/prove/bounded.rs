//! Forms that move with the gains, for gains of bounded rate.

use fspid_core::Gains;
use fspid_lti::Matrix;
use fspid_numeric::scalar::Interval;

use super::Prover;
use crate::certificate::{BoundedRate, Certificate, Claim};
use crate::check::Ends;
use crate::gain_set::GainSet;
use crate::limits;
use crate::recheck::{Recheck, Rechecked, part_in};
use crate::solve::{self, GainFamily, MovingProblem, MovingVerdict};

/// Corners of the set may lie outside of those that are begun with by this share of half its extent.
const THINNED: f64 = 0.1;
/// A gain whose range is a smaller share of it stands still.
const STILL: f64 = 1e-9;
/// A law whose rate is known is granted so much more, for rounding.
const GRANTED: f64 = 1.0 + 1e-9;

/// The box around a set, as the solver sees it.
pub(super) struct Sides {
    ends: [[f64; 2]; 3],
    /// Numbers of the gains that move.
    pub(super) moving: Vec<usize>,
}

impl Sides {
    pub(super) fn of(set: &GainSet) -> Self {
        let ends = set.bounds().map(|bounds| [bounds.lower(), bounds.upper()]);
        let moves = |gain: &usize| {
            let [lower, upper] = ends[*gain];
            upper - lower > STILL * (lower.abs() + upper.abs())
        };
        Self { ends, moving: (0..3).filter(moves).collect() }
    }

    fn centre_and_half(&self, gain: usize) -> (f64, f64) {
        let [lower, upper] = self.ends[gain];
        (0.5 * (lower + upper), 0.5 * (upper - lower))
    }

    /// Gains in half widths of those that move.
    fn counted(&self, gains: [f64; 3]) -> Vec<f64> {
        let along = |&gain: &usize| {
            let (centre, half) = self.centre_and_half(gain);
            (gains[gain] - centre) / half
        };
        self.moving.iter().map(along).collect()
    }

    /// The same of gains by name.
    pub(super) fn of_gains(&self, Gains { kp, ki, kd }: Gains<f64>) -> Vec<f64> {
        self.counted([kp, ki, kd])
    }

    /// A cell of gains in half widths.
    fn cell(&self, gains: [Interval; 3]) -> Ends {
        let [lower, upper] = [gains.map(Interval::lower), gains.map(Interval::upper)];
        let ends = self.counted(lower).into_iter().zip(self.counted(upper));
        ends.map(|(lower, upper)| [lower, upper]).collect()
    }

    /// Of a cell what an accumulating law reaches.
    pub(super) fn part(&self, set: &GainSet, cell: Ends) -> Option<Ends> {
        let Some(reached) = &set.reached else { return Some(cell) };
        let mut gains = self.ends.map(|[lower, upper]| Interval::between(lower, upper));
        for (&gain, &[lower, upper]) in self.moving.iter().zip(&cell) {
            let (centre, half) = self.centre_and_half(gain);
            gains[gain] = Interval::between(centre + lower * half, centre + upper * half);
        }
        let kept = self.cell(reached.part(gains)?);
        let sides = kept.into_iter().zip(cell);
        let within = sides.map(|([from, to], [lower, upper])| {
            let [least, most] = [from.max(lower), to.min(upper)];
            if least <= most { [least, most] } else { [lower, upper] }
        });
        Some(within.collect())
    }

    /// Gains that are counted in half widths.
    pub(super) fn gains(&self, counted: &[f64]) -> Gains<f64> {
        let mut gains = [0, 1, 2].map(|gain| self.centre_and_half(gain).0);
        for (&gain, count) in self.moving.iter().zip(counted) {
            let (centre, half) = self.centre_and_half(gain);
            gains[gain] = centre + count * half;
        }
        let [kp, ki, kd] = gains;
        Gains { kp, ki, kd }
    }
}

impl Prover<'_> {
    /// A certificate for gains that move as fast as their law makes them; none of a law that lets them jump.
    pub(super) fn bounded(&self, set: &GainSet, factor: f64) -> Option<(Certificate, Rechecked)> {
        let claim = self.moving_form(set, self.changes_of_law(set)?)?;
        let (alone, rechecked) = self.rechecked(Claim::BoundedRate(claim.clone()), factor, None)?;
        let within_limits = self.level_within_limits(set, &alone, &claim);
        let found = within_limits
            .and_then(|level| self.rechecked(Claim::BoundedRate(claim), factor, Some(level)));
        Some(found.unwrap_or((alone, rechecked)))
    }

    /// What a law that remembers can change each gain by in a sample, in half widths.
    fn changes_of_law(&self, set: &GainSet) -> Option<[f64; 3]> {
        let rates = set.rate_per_s?;
        let sides = Sides::of(set);
        let dt_s = self.description.controller.config().dt_s;
        Some([0, 1, 2].map(|gain: usize| {
            let (_, half) = sides.centre_and_half(gain);
            if sides.moving.contains(&gain) { GRANTED * dt_s * rates[gain] / half } else { 0.0 }
        }))
    }

    /// The largest level of a claim, with its certificate, within which no limit acts.
    fn level_within_limits(
        &self,
        set: &GainSet,
        certificate: &Certificate,
        claim: &BoundedRate,
    ) -> Option<f64> {
        if !self.covers_limits() || self.description.limits().is_empty() {
            return None;
        }
        let recheck =
            Recheck::with(certificate, self.enclosed.clone(), set.clone(), &self.slopes).ok()?;
        let rest = self.rest(set).ok()?;
        let corners = recheck.moving_decrease(claim).ok()?.corners(claim).ok()?;
        limits::level(corners.iter().map(|corner| {
            let gains = corner.gains_middle();
            (corner.form.midpoint(), limits::rows(self.description, &self.model, gains, &rest))
        }))
    }

    /// A form that moves with the gains, not proved.
    fn moving_form(&self, set: &GainSet, changes: [f64; 3]) -> Option<BoundedRate> {
        let verdict = self.moving_problem(set, changes, |problem| {
            solve::moving_form_over(problem, &self.search())
        })?;
        let MovingVerdict::Found(found) = verdict else { return None };
        let sides = Sides::of(set);
        let size = self.model.size();
        let mut forms = [0; 4].map(|_| Matrix::zeros(size, size));
        let places = core::iter::once(0).chain(sides.moving.iter().map(|gain| gain + 1));
        for (place, form) in places.zip(found.forms) {
            forms[place] = form;
        }
        Some(BoundedRate { ends: sides.ends, changes, forms, rate: 1.0 })
    }

    /// What is asked of a form that moves with the gains, for somebody who answers it.
    pub(super) fn moving_problem<T>(
        &self,
        set: &GainSet,
        changes: [f64; 3],
        answer: impl FnOnce(&MovingProblem<'_>) -> T,
    ) -> Option<T> {
        let sides = Sides::of(set);
        let gains = sides.moving.len();
        let corners = (0..1_usize << gains).map(|corner| {
            let signs = (0..gains).map(|gain| if corner >> gain & 1 == 1 { 1.0 } else { -1.0 });
            self.model.closed_matrix(sides.gains(&signs.collect::<Vec<f64>>())).ok()
        });
        let family = GainFamily::from_corners(&corners.collect::<Option<Vec<Matrix>>>()?)?;
        let points = set.hull_within(THINNED).into_iter();
        let points: Vec<Vec<f64>> = points.map(|it| sides.of_gains(it)).collect();
        let cells: Vec<Ends> = set.cells.iter().map(|cell| sides.cell(cell.gains)).collect();
        let moved: Vec<f64> = sides.moving.iter().map(|&gain| changes[gain]).collect();
        Some(answer(&MovingProblem {
            family: &family,
            changes: &moved,
            rate: 1.0,
            points: &points,
            part: &|cell| sides.part(set, part_in(&cells, cell)?),
        }))
    }
}

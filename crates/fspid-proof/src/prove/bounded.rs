//! Forms that move with the gains, for gains of bounded rate.

use fspid_core::Gains;
use fspid_fuzzy::scalar::Interval;
use fspid_lti::Matrix;

use super::Prover;
use crate::certificate::{BoundedRate, Certificate, Claim};
use crate::check::Ends;
use crate::gain_set::GainSet;
use crate::recheck::{Rechecked, part_in};
use crate::solve::{self, GainFamily, MovingProblem, MovingVerdict};

/// Corners of the set may lie outside of those that are begun with by this share of half its extent.
const THINNED: f64 = 0.1;
/// A gain whose range is a smaller share of it stands still.
const STILL: f64 = 1e-9;

/// The box around a set, as the solver sees it.
struct Sides {
    ends: [[f64; 2]; 3],
    /// Numbers of the gains that move.
    moving: Vec<usize>,
}

impl Sides {
    fn of(set: &GainSet) -> Self {
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

    /// A cell of gains in half widths.
    fn cell(&self, gains: [Interval; 3]) -> Ends {
        let [lower, upper] = [gains.map(Interval::lower), gains.map(Interval::upper)];
        let ends = self.counted(lower).into_iter().zip(self.counted(upper));
        ends.map(|(lower, upper)| [lower, upper]).collect()
    }

    /// Gains that are counted in half widths.
    fn gains(&self, counted: &[f64]) -> Gains<f64> {
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
    /// A certificate for gains none of which changes by more than `change` half widths in a sample.
    pub(super) fn bounded(
        &self,
        set: &GainSet,
        factor: f64,
        change: f64,
    ) -> Option<(Certificate, Rechecked)> {
        let sides = Sides::of(set);
        let gains = sides.moving.len();
        let corners = (0..1_usize << gains).map(|corner| {
            let signs = (0..gains).map(|gain| if corner >> gain & 1 == 1 { 1.0 } else { -1.0 });
            self.model.closed_matrix(sides.gains(&signs.collect::<Vec<f64>>())).ok()
        });
        let family = GainFamily::from_corners(&corners.collect::<Option<Vec<Matrix>>>()?)?;
        let points: Vec<Vec<f64>> = set
            .hull_within(THINNED)
            .into_iter()
            .map(|Gains { kp, ki, kd }| sides.counted([kp, ki, kd]))
            .collect();
        let cells: Vec<Ends> = set.cells.iter().map(|cell| sides.cell(cell.gains)).collect();
        let changes = vec![change; gains];
        let problem = MovingProblem {
            family: &family,
            changes: &changes,
            rate: 1.0,
            points: &points,
            part: &|cell| part_in(&cells, cell),
        };
        let effort = solve::Effort::default();
        let MovingVerdict::Found(found) = solve::moving_form_over(&problem, &effort) else {
            return None;
        };
        let size = self.model.size();
        let mut forms = [0; 4].map(|_| Matrix::zeros(size, size));
        let places = core::iter::once(0).chain(sides.moving.iter().map(|gain| gain + 1));
        for (place, form) in places.zip(found.forms) {
            forms[place] = form;
        }
        let claim = BoundedRate { ends: sides.ends, changes: [change; 3], forms, rate: 1.0 };
        self.rechecked(Claim::BoundedRate(claim), factor, None)
    }
}

//! The re-check of a form that moves with the gains.

use fspid_core::Gains;
use fspid_fuzzy::scalar::Interval;
use fspid_lti::Matrix;

use super::{Doubt, Recheck, allowed_rate, malformed};
use crate::certificate::BoundedRate;
use crate::check::{Ends, IntervalMatrix, Moving, NotProved, NotProvedAt, falls_while_moving};
use crate::gain_set::GainSet;

/// The box of gains of a claim, in half widths of which gains are counted there.
#[derive(Clone, Debug)]
pub(crate) struct GainBox {
    ends: [Interval; 3],
    /// Numbers of the gains that move; the others are anywhere between their ends.
    pub(crate) moving: Vec<usize>,
}

impl GainBox {
    /// The box of a claim if it holds every gain of a set.
    fn of(claim: &BoundedRate, set: &GainSet) -> Result<Self, Doubt> {
        let side =
            |[lower, upper]: [f64; 2]| Interval::new(lower, upper).filter(|s| s.is_bounded());
        let [Some(kp), Some(ki), Some(kd)] = claim.ends.map(side) else {
            return Err(malformed("the ends of a gain are not two finite numbers in order"));
        };
        let ends = [kp, ki, kd];
        if !ends.iter().zip(set.bounds()).all(|(own, bounds)| own.encloses(bounds)) {
            return Err(malformed("the box does not hold every gain that the tuner can produce"));
        }
        Ok(Self::moving_as(ends, &claim.forms))
    }

    /// The gains that the form moves with.
    pub(crate) fn moving_as(ends: [Interval; 3], forms: &[Matrix; 4]) -> Self {
        let moves = |gain: &usize| {
            let follows = forms[gain + 1].data().iter().any(|value| value.abs() > 0.0);
            follows && ends[*gain].lower() < ends[*gain].upper()
        };
        Self { ends, moving: (0..3).filter(moves).collect() }
    }

    fn half_width(&self, gain: usize) -> Interval {
        let [lower, upper] = [self.ends[gain].lower(), self.ends[gain].upper()];
        Interval::point(0.5) * (Interval::point(upper) - Interval::point(lower))
    }

    fn centre(&self, gain: usize) -> Interval {
        let [lower, upper] = [self.ends[gain].lower(), self.ends[gain].upper()];
        Interval::point(0.5) * (Interval::point(upper) + Interval::point(lower))
    }

    /// The cells of a set, in half widths and rounded outward.
    fn counted(&self, set: &GainSet) -> Vec<Ends> {
        let side = |gains: &[Interval; 3], gain: usize| {
            let counted = (gains[gain] - self.centre(gain)) / self.half_width(gain);
            // All of the set lies in the box, so that beyond it is nothing but rounding.
            [counted.lower().clamp(-1.0, 1.0), counted.upper().clamp(-1.0, 1.0)]
        };
        let cell =
            |gains: &[Interval; 3]| self.moving.iter().map(|&gain| side(gains, gain)).collect();
        set.cells.iter().map(|found| cell(&found.gains)).collect()
    }

    /// The gains of a cell whose sides are in half widths.
    fn gains(&self, sides: &[[f64; 2]]) -> [Interval; 3] {
        let mut gains = self.ends;
        for (&gain, &[lower, upper]) in self.moving.iter().zip(sides) {
            gains[gain] =
                self.centre(gain) + self.half_width(gain) * Interval::between(lower, upper);
        }
        gains
    }

    /// The loop at the centre of the gains that move, with all others between their ends; then what a half
    /// width of each gain that moves adds.
    fn loops(&self, closed: &Closed<'_>) -> Result<Vec<IntervalMatrix>, Doubt> {
        let mut centre = self.ends;
        let mut unit = [Interval::ZERO; 3];
        for &gain in &self.moving {
            centre[gain] = self.centre(gain);
        }
        let still = closed(unit)?;
        let mut loops = vec![closed(centre)?];
        for &gain in &self.moving {
            unit = [Interval::ZERO; 3];
            unit[gain] = Interval::ONE;
            let by_gain = closed(unit)?.difference(&still).map_err(NotProved::from)?;
            loops.push(by_gain.scaled(self.half_width(gain)));
        }
        Ok(loops)
    }
}

type Closed<'a> = dyn Fn([Interval; 3]) -> Result<IntervalMatrix, Doubt> + 'a;

impl Recheck<'_> {
    /// Proves the fall for every gain of the set and every motion that is as slow as claimed.
    pub(super) fn bounded_rate(&self, claim: &BoundedRate) -> Result<usize, Doubt> {
        allowed_rate(claim.rate)?;
        let size = self.model.size();
        if claim.forms.iter().any(|form| (form.rows(), form.columns()) != (size, size)) {
            return Err(malformed("a form has another size than the loop's state"));
        }
        let gain_box = GainBox::of(claim, &self.set)?;
        let closed = |[kp, ki, kd]: [Interval; 3]| self.closed(Gains { kp, ki, kd });
        let loops = gain_box.loops(&closed)?;
        let forms: Vec<Matrix> = core::iter::once(0)
            .chain(gain_box.moving.iter().map(|gain| gain + 1))
            .map(|part| claim.forms[part].clone())
            .collect();
        let changes: Vec<f64> = gain_box.moving.iter().map(|&gain| claim.changes[gain]).collect();
        let moving = Moving { loops: &loops, forms: &forms, changes: &changes, rate: claim.rate };
        let cells = gain_box.counted(&self.set);
        let proof = falls_while_moving(&moving, |cell| part_in(&cells, cell))
            .map_err(|failed| doubt(&gain_box, failed))?;
        Ok(proof.inequalities)
    }
}

/// The smallest cell that holds all that some cells have in common with one.
pub(crate) fn part_in(cells: &[Ends], cell: &Ends) -> Option<Ends> {
    let common = |other: &Ends| -> Option<Ends> {
        let sides = cell.iter().zip(other);
        sides
            .map(|(one, other)| {
                let [lower, upper] = [one[0].max(other[0]), one[1].min(other[1])];
                (lower <= upper).then_some([lower, upper])
            })
            .collect()
    };
    let hull = |one: Ends, other: Ends| -> Ends {
        let sides = one.into_iter().zip(other);
        sides.map(|(one, other)| [one[0].min(other[0]), one[1].max(other[1])]).collect()
    };
    cells.iter().filter_map(common).reduce(hull)
}

fn doubt(gain_box: &GainBox, failed: NotProvedAt) -> Doubt {
    let NotProvedAt { gains, reason } = failed;
    if gains.is_empty() {
        return reason.into();
    }
    let sides: Vec<[f64; 2]> = gains.iter().map(|&gain| [gain, gain]).collect();
    let [kp, ki, kd] = gain_box.gains(&sides).map(|gain| gain.midpoint());
    Doubt::Inequality { gains: Some(Gains { kp, ki, kd }), reason }
}

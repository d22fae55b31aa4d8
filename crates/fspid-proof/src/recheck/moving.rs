//! The re-check of a form that moves with the gains.

use core::cmp::Ordering;

use fspid_core::Gains;
use fspid_lti::Matrix;
use fspid_numeric::scalar::Interval;

use super::{Proved, Recheck, RecheckError, allowed_rate, malformed};
use crate::certificate::BoundedRate;
use crate::check::{
    Ends, IntervalMatrix, Moving, MovingDrive, MovingProof, NotProved, NotProvedAt,
    falls_while_moving, grows_no_faster_while_moving, inside_limits,
};
use crate::gain_set::GainSet;
use crate::limits;

/// Rounding of the tuner's last sums and products, as a share of the gain.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// The box of gains of a claim, in half widths of which gains are counted there.
#[derive(Clone, Debug)]
pub(crate) struct GainBox {
    ends: [Interval; 3],
    /// Numbers of the gains that move; the others are anywhere between their ends.
    pub(crate) moving: Vec<usize>,
}

impl GainBox {
    /// The box of a claim if it holds every gain of a set.
    fn of(claim: &BoundedRate, set: &GainSet) -> Result<Self, RecheckError> {
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

    /// Of a cell what an accumulating law reaches: a cell that holds all of it, or nothing.
    fn part(&self, set: &GainSet, cell: Ends) -> Option<Ends> {
        let Some(reached) = &set.reached else { return Some(cell) };
        let kept = reached.part(self.gains(&cell))?;
        let sides = self.moving.iter().zip(cell);
        let narrowed = sides.map(|(&gain, [lower, upper])| {
            let counted = (kept[gain] - self.centre(gain)) / self.half_width(gain);
            let [least, most] = [counted.lower().max(lower), counted.upper().min(upper)];
            // What is left of a cell is in it, but for rounding.
            if least <= most { [least, most] } else { [lower, upper] }
        });
        Some(narrowed.collect())
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
    fn loops(&self, closed: &Closed<'_>) -> Result<Vec<IntervalMatrix>, RecheckError> {
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

/// What a claim asks of a loop, in half widths of its box.
struct Motion {
    gain_box: GainBox,
    loops: Vec<IntervalMatrix>,
    forms: Vec<Matrix>,
    changes: Vec<f64>,
    cells: Vec<Ends>,
}

impl Motion {
    fn moving(&self, rate: f64) -> Moving<'_> {
        Moving { loops: &self.loops, forms: &self.forms, changes: &self.changes, rate }
    }

    /// What of a cell is asked for.
    fn part(&self, set: &GainSet, cell: &Ends) -> Option<Ends> {
        self.gain_box.part(set, part_in(&self.cells, cell)?)
    }
}

/// A row of one matrix that is affine in the gains.
pub(crate) type RowAt<'a> = Closed<'a>;

type Closed<'a> = dyn Fn([Interval; 3]) -> Result<IntervalMatrix, RecheckError> + 'a;

/// A moving form that was proved to decrease.
pub(crate) struct Decrease {
    gain_box: GainBox,
    proof: MovingProof,
}

/// The form at gains that are a corner of a cell.
pub(crate) struct Corner {
    pub(crate) gains: Gains<Interval>,
    pub(crate) form: IntervalMatrix,
}

impl Corner {
    pub(crate) fn gains_middle(&self) -> Gains<f64> {
        middles(self.gains)
    }
}

impl Decrease {
    /// The corners of all cells: what is affine in the gains and holds there holds for the whole set.
    pub(crate) fn corners(&self, claim: &BoundedRate) -> Result<Vec<Corner>, RecheckError> {
        let moving = &self.gain_box.moving;
        let mut places: Vec<Vec<f64>> = Vec::new();
        for cell in &self.proof.cells {
            places.extend((0..1_usize << moving.len()).map(|corner| {
                let sides = cell.iter().enumerate();
                sides.map(|(gain, side)| side[corner >> gain & 1]).collect()
            }));
        }
        places.sort_by(|one, other| {
            let pairs = one.iter().zip(other).map(|(one, other)| one.total_cmp(other));
            pairs.fold(Ordering::Equal, Ordering::then)
        });
        places.dedup();
        places.iter().map(|place| self.corner(claim, place)).collect()
    }

    fn corner(&self, claim: &BoundedRate, place: &[f64]) -> Result<Corner, RecheckError> {
        let mut form = IntervalMatrix::from(&claim.forms[0]);
        for (&gain, &count) in self.gain_box.moving.iter().zip(place) {
            let by_gain = IntervalMatrix::from(&claim.forms[gain + 1]);
            let moved = form.sum(&by_gain.scaled(Interval::point(count)));
            form = moved.map_err(NotProved::from)?;
        }
        let sides: Vec<[f64; 2]> = place.iter().map(|&count| [count, count]).collect();
        let [kp, ki, kd] = self.gain_box.gains(&sides);
        Ok(Corner { gains: Gains { kp, ki, kd }, form })
    }

    /// Numbers of the gains whose rate counts, each with the most that it may change by in a sample.
    pub(crate) fn allowed(&self, claim: &BoundedRate) -> Vec<(usize, Interval)> {
        let moving = self.gain_box.moving.iter().copied();
        let bounded = moving.filter(|&gain| claim.changes[gain] < 1.0);
        let allowed = |gain: usize| {
            Interval::point(claim.changes[gain]) * self.gain_box.half_width(gain)
                - Interval::point(ROUNDING * self.gain_box.ends[gain].magnitude())
        };
        bounded.map(|gain| (gain, allowed(gain))).collect()
    }
}

impl Recheck<'_> {
    /// Proves a claim with all that comes with it.
    pub(super) fn bounded_rate(&self, claim: &BoundedRate) -> Result<Proved, RecheckError> {
        // With an error that stays, bounds of the inputs around zero are none around rest.
        if !self.rest.held.is_none() || self.rest.error_rad > 0.0 {
            return Err(malformed(
                "a claim about gains of bounded rate covers no command that gains move while it is held",
            ));
        }
        if self.is_blurred() {
            return Err(malformed("a claim about gains of bounded rate covers no resolution"));
        }
        let decrease = self.moving_decrease(claim)?;
        let mut proved = Proved { inequalities: decrease.proof.inequalities, ..Proved::default() };
        proved.keeps_to_the_rate = self.keeps_everywhere(claim, &decrease);
        let Some(level) = self.certificate.level else { return Ok(proved) };
        if !proved.keeps_to_the_rate {
            return Err(malformed("a level of a law that is not shown to keep to the rate"));
        }
        let corners = decrease.corners(claim)?;
        proved.inequalities += self.limits_at(&corners, level)?;
        let forms = corners.iter().map(|corner| &corner.form);
        proved.pitch_within_rad = limits::pitch_within_all(&self.model, forms, level);
        Ok(proved)
    }

    /// Proves the decrease for every gain of the set and every motion that is as slow as claimed.
    pub(crate) fn moving_decrease(&self, claim: &BoundedRate) -> Result<Decrease, RecheckError> {
        allowed_rate(claim.rate)?;
        let motion = self.motion(claim)?;
        let moving = motion.moving(claim.rate);
        let part = |cell: &Ends| motion.part(&self.set, cell);
        let proof = falls_while_moving(&moving, part);
        let proof = proof.map_err(|failed| doubt(&motion.gain_box, failed))?;
        Ok(Decrease { gain_box: motion.gain_box, proof })
    }

    /// Proves that a form lets a disturbance do no more than is said, for every gain of the set and every motion that is
    /// as slow as claimed.
    pub(crate) fn moving_driven(
        &self,
        claim: &BoundedRate,
        drive: &MovingDrive<'_>,
        seen: Option<&RowAt<'_>>,
    ) -> Result<Decrease, RecheckError> {
        let motion = self.motion(claim)?;
        let rows = seen.map(|row| motion.gain_box.loops(row)).transpose()?;
        let drive = MovingDrive { seen: rows.as_deref(), ..*drive };
        let part = |cell: &Ends| motion.part(&self.set, cell);
        let proof = grows_no_faster_while_moving(&motion.moving(claim.rate), &drive, part);
        let proof = proof.map_err(|failed| doubt(&motion.gain_box, failed))?;
        Ok(Decrease { gain_box: motion.gain_box, proof })
    }

    /// The loop and the forms of a claim in half widths of its box.
    fn motion(&self, claim: &BoundedRate) -> Result<Motion, RecheckError> {
        let size = self.model.size();
        if claim.forms.iter().any(|form| (form.rows(), form.columns()) != (size, size)) {
            return Err(malformed("a form has another size than the loop's state"));
        }
        let gain_box = GainBox::of(claim, &self.set)?;
        let closed = |[kp, ki, kd]: [Interval; 3]| self.closed(Gains { kp, ki, kd });
        let loops = gain_box.loops(&closed)?;
        let parts = core::iter::once(0).chain(gain_box.moving.iter().map(|gain| gain + 1));
        let forms: Vec<Matrix> = parts.map(|part| claim.forms[part].clone()).collect();
        let changes: Vec<f64> = gain_box.moving.iter().map(|&gain| claim.changes[gain]).collect();
        let cells = gain_box.counted(&self.set);
        Ok(Motion { gain_box, loops, forms, changes, cells })
    }

    /// Whether the law itself keeps the gains to the rate, whatever the flight.
    pub(crate) fn keeps_everywhere(&self, claim: &BoundedRate, decrease: &Decrease) -> bool {
        let allowed = decrease.allowed(claim);
        let dt_s = Interval::point(self.model.settings().config.dt_s);
        let Some(rates) = self.set.rate_per_s else { return allowed.is_empty() };
        let keeps = |&(gain, most): &(usize, Interval)| {
            (dt_s * Interval::point(rates[gain])).upper() <= most.lower()
        };
        allowed.iter().all(keeps)
    }

    /// Proves that no limit acts within a level.
    fn limits_at(&self, corners: &[Corner], level: f64) -> Result<usize, RecheckError> {
        let mut proved = 0;
        for corner in corners {
            let rows =
                limits::rows(&self.certificate.description, &self.model, corner.gains, &self.rest);
            proved += rows.len();
            let gains = Some(middles(corner.gains));
            inside_limits(&corner.form, level, &rows)
                .map_err(|reason| RecheckError::Inequality { gains, reason })?;
        }
        Ok(proved)
    }
}

fn middles(gains: Gains<Interval>) -> Gains<f64> {
    let Gains { kp, ki, kd } = gains;
    Gains { kp: kp.midpoint(), ki: ki.midpoint(), kd: kd.midpoint() }
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

fn doubt(gain_box: &GainBox, failed: NotProvedAt) -> RecheckError {
    let NotProvedAt { gains, reason } = failed;
    if gains.is_empty() {
        return reason.into();
    }
    let sides: Vec<[f64; 2]> = gains.iter().map(|&gain| [gain, gain]).collect();
    let [kp, ki, kd] = gain_box.gains(&sides).map(|gain| gain.midpoint());
    RecheckError::Inequality { gains: Some(Gains { kp, ki, kd }), reason }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn diagonal(entries: [f64; 2]) -> Matrix {
        Matrix::from_rows(&[[entries[0], 0.0], [0.0, entries[1]]]).expect("square")
    }

    /// kp from 1 to 3, ki a point, kd from 2 to 6; the form moves with all of them.
    fn claim() -> BoundedRate {
        let forms = [[4.0, 8.0], [0.5, 0.0], [1.0, 1.0], [0.0, 0.25]].map(diagonal);
        let ends = [[1.0, 3.0], [0.5, 0.5], [2.0, 6.0]];
        BoundedRate { ends, changes: [0.01, 2.0, 0.5], forms, rate: 1.0 }
    }

    fn set() -> GainSet {
        GainSet::fixed(Gains { kp: 2.5, ki: 0.5, kd: 3.0 })
    }

    fn gain_box() -> GainBox {
        GainBox::of(&claim(), &set()).expect("it holds the gains")
    }

    fn is_near(found: [f64; 2], sides: [f64; 2]) -> bool {
        found.iter().zip(sides).all(|(one, other)| (one - other).abs() <= 1e-12)
    }

    #[test]
    fn a_form_moves_with_gains_that_it_follows_and_that_move() {
        assert_eq!(gain_box().moving, [0, 2], "ki stands still");
        let mut still = claim();
        still.forms[3] = diagonal([0.0, 0.0]);
        assert_eq!(GainBox::of(&still, &set()).expect("it holds").moving, [0]);
        still.forms[1] = diagonal([0.0, 0.0]);
        assert_eq!(GainBox::of(&still, &set()).expect("it holds").moving, [0_usize; 0]);
    }

    #[test]
    fn gains_are_counted_in_half_widths_from_the_centre_and_back() {
        let gain_box = gain_box();
        let cells = gain_box.counted(&set());
        assert_eq!(cells.len(), 1);
        assert!(
            is_near(cells[0][0], [0.5, 0.5]) && is_near(cells[0][1], [-0.5, -0.5]),
            "{cells:?}"
        );
        // Outward, so that the gains themselves are within.
        assert!(cells[0].iter().all(|[lower, upper]| lower <= upper));
        let [kp, ki, kd] = gain_box.gains(&[[-1.0, 0.5], [0.0, 1.0]]);
        assert!(is_near([kp.lower(), kp.upper()], [1.0, 2.5]), "{kp:?}");
        assert!(is_near([ki.lower(), ki.upper()], [0.5, 0.5]), "{ki:?}");
        assert!(is_near([kd.lower(), kd.upper()], [4.0, 6.0]), "{kd:?}");
        let cell = vec![[-0.5, 0.25], [0.0, 1.0]];
        assert_eq!(gain_box.part(&set(), cell.clone()), Some(cell), "nothing is known to be left");
    }

    #[test]
    fn a_cell_is_narrowed_to_what_it_has_in_common_with_others() {
        let cells = vec![vec![[-1.0, 0.0]], vec![[0.5, 1.0]]];
        assert_eq!(part_in(&cells, &vec![[-0.25, 0.75]]), Some(vec![[-0.25, 0.75]]));
        assert_eq!(part_in(&cells, &vec![[-0.25, 0.25]]), Some(vec![[-0.25, 0.0]]));
        assert_eq!(part_in(&cells, &vec![[0.125, 0.375]]), None);
        assert_eq!(part_in(&cells, &vec![[0.0, 0.25]]), Some(vec![[0.0, 0.0]]), "a border");
        let square = vec![vec![[-1.0, 0.0], [-1.0, 1.0]]];
        assert_eq!(
            part_in(&square, &vec![[-0.5, 0.5], [0.5, 2.0]]),
            Some(vec![[-0.5, 0.0], [0.5, 1.0]])
        );
        assert_eq!(part_in(&square, &vec![[-0.5, 0.5], [1.5, 2.0]]), None, "apart along one side");
    }

    #[test]
    fn corners_of_cells_are_each_asked_once_with_the_form_there() {
        let cells = vec![vec![[-1.0, 0.0], [0.0, 1.0]], vec![[0.0, 1.0], [0.0, 1.0]]];
        let proof = MovingProof { inequalities: 0, cells };
        let decrease = Decrease { gain_box: gain_box(), proof };
        let corners = decrease.corners(&claim()).expect("corners");
        let found: Vec<[f64; 4]> = corners
            .iter()
            .map(|corner| {
                let Gains { kp, kd, .. } = corner.gains_middle();
                let form = corner.form.midpoint();
                [kp, kd, form.data()[0], form.data()[3]]
            })
            .collect();
        // The form is 4 and half of kp, 8 and a quarter of kd, in half widths.
        let expected = [
            [1.0, 4.0, 3.5, 8.0],
            [1.0, 6.0, 3.5, 8.25],
            [2.0, 4.0, 4.0, 8.0],
            [2.0, 6.0, 4.0, 8.25],
            [3.0, 4.0, 4.5, 8.0],
            [3.0, 6.0, 4.5, 8.25],
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn a_gain_may_change_by_its_share_of_a_half_width_less_rounding() {
        let proof = MovingProof { inequalities: 0, cells: Vec::new() };
        let decrease = Decrease { gain_box: gain_box(), proof };
        let allowed = decrease.allowed(&claim());
        assert_eq!(allowed.iter().map(|(gain, _)| *gain).collect::<Vec<_>>(), [0, 2]);
        for ((_, most), expected) in allowed.iter().zip([0.01, 1.0]) {
            let found = most.lower();
            assert!(found < expected && found > expected - 1e-12, "{found} {expected}");
        }
        let anyhow = BoundedRate { changes: [1.0, 2.0, 0.5], ..claim() };
        let allowed = decrease.allowed(&anyhow);
        assert_eq!(allowed.iter().map(|(gain, _)| *gain).collect::<Vec<_>>(), [2], "1 is any rate");
    }
}

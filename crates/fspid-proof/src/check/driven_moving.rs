//! Conditions on what a disturbance may do to a sampled loop whose gains move, by a form that moves with them.
//!
//! With loop, form and what is seen affine in gains κ that are counted in half widths of a box, as in
//! [`super::moving`], and a disturbance that enters alike at all gains, $z^+ = M(\kappa) z + E u$:
//!
//! $$ F(\kappa, \kappa^+) = \begin{pmatrix} \alpha P(\kappa) - c(\kappa)^T c(\kappa) & 0 \cr 0 & \beta I \end{pmatrix} -
//!    \begin{pmatrix} M(\kappa) & E \end{pmatrix}^T P(\kappa^+) \begin{pmatrix} M(\kappa) & E \end{pmatrix} $$
//!
//! is affine in $\kappa^+$ for given κ, and of degree 3 in each gain, as the decrease without a disturbance is: the same
//! Bernstein coefficients carry it, over the state and u.

use fspid_lti::Matrix;
use fspid_numeric::Scalar;
use fspid_numeric::scalar::Interval;

use super::disturbed::{beside, corner_and};
use super::error::{NotProved, positive};
use super::exponential::require_bounded;
use super::matrix::IntervalMatrix;
use super::moving::{
    Ends, Moving, MovingProof, NotProvedAt, Parts, Turned, basis_at_centre, most_cells,
    symmetric_forms, turned_by,
};
use crate::caps::MOST_BOUNDS;

/// A disturbance of a loop whose gains move, and what is seen.
#[derive(Clone, Copy, Debug)]
pub struct MovingDrive<'a> {
    /// α, above 0, at most 1.
    pub decay: f64,
    /// β, above 0.
    pub gain: f64,
    /// E.
    pub entry: &'a IntervalMatrix,
    /// A row that is affine in the gains, times the root of the sample period: at the centre of the box, then what each
    /// half width adds; none where nothing is asked at every sample.
    pub seen: Option<&'a [IntervalMatrix]>,
}

/// Proves that for all gains of a set, every motion within it in which no gain changes by more than is allowed, and
/// whatever u is,
///
/// $$ V^+ \le \alpha V + \beta |u|^2 - (c(\kappa) z)^2, \quad V = z^T P(\kappa) z, \quad P(\kappa) \succ 0 $$
///
/// for all matrices inside `moving`, `entry` and `seen`. The set is told by `part` as in
/// [`falls_while_moving`](super::moving::falls_while_moving); the rate that `moving` has is not asked.
///
/// # Errors
/// [`NotProvedAt`] where shapes do not fit, an entry is not finite, a number is not allowed, or it could not be shown.
pub fn grows_no_faster_while_moving(
    moving: &Moving<'_>,
    drive: &MovingDrive<'_>,
    part: impl Fn(&Ends) -> Option<Ends>,
) -> Result<MovingProof, NotProvedAt> {
    let forms = symmetric_forms(moving)?;
    let (size, inputs) = (moving.forms.first().map_or(0, Matrix::rows), drive.entry.columns());
    let whole = size + inputs;
    let root = allowed(moving, drive, size)?;
    let Turned { own, loops } = Turned::of(moving.loops, &forms)?;
    let decay = Interval::point(drive.decay);
    let bordered = |part: usize, matrix: &IntervalMatrix| {
        let of_input = if part == 0 { Interval::ONE } else { Interval::ZERO };
        corner_and(&matrix.scaled(decay), whole, of_input)
    };
    let kept: Vec<IntervalMatrix> =
        own.iter().enumerate().map(|(part, own)| bordered(part, own)).collect();
    // The disturbance enters alike whatever the gains are: with the part that does not move.
    let entry = drive.entry.scaled(Interval::ONE / root);
    let none = IntervalMatrix::zeros(size, inputs);
    let with = |part: usize| if part == 0 { &entry } else { &none };
    let driven: Vec<IntervalMatrix> =
        loops.iter().enumerate().map(|(part, own)| beside(own, with(part))).collect();
    let mut parts = Parts::assembled(&own, &kept, &driven, (&forms, moving.changes))?;
    if let Some(seen) = drive.seen {
        let turned = turned_by(&basis_at_centre(&forms)?, seen)?;
        let none = IntervalMatrix::zeros(1, inputs);
        let rows: Vec<IntervalMatrix> = turned.iter().map(|row| beside(row, &none)).collect();
        parts.less_square(&rows)?;
    }
    // A certificate has many bounds; together they take no more than one claim may.
    let most = most_cells(moving.changes.len(), whole) / MOST_BOUNDS as u64;
    parts.prove(most.max(1), part)
}

/// The root of β, if shapes and numbers are allowed.
fn allowed(
    moving: &Moving<'_>,
    drive: &MovingDrive<'_>,
    size: usize,
) -> Result<Interval, NotProved> {
    let MovingDrive { decay, gain, entry, seen } = *drive;
    entry.require_shape("entry of the disturbance", size, entry.columns())?;
    require_bounded("entry of the disturbance", entry)?;
    if !(decay > 0.0 && decay <= 1.0) {
        return Err(NotProved::Number { what: "decay", found: decay, allowed: "above 0, up to 1" });
    }
    for row in seen.unwrap_or_default() {
        row.require_shape("row of what is seen", 1, size)?;
        require_bounded("row of what is seen", row)?;
    }
    if seen.is_some_and(|rows| rows.len() != moving.loops.len()) {
        let found = seen.map_or(0.0, |rows| rows.len() as f64);
        let what = "parts of what is seen";
        return Err(NotProved::Number { what, found, allowed: "as many as of the loop" });
    }
    Ok(Interval::point(positive("gain of the disturbance", gain)?).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scalars(values: &[f64]) -> Vec<Matrix> {
        values.iter().map(|&value| Matrix::identity(1).scaled(value)).collect()
    }

    fn points(values: &[f64]) -> Vec<IntervalMatrix> {
        scalars(values).iter().map(IntervalMatrix::from).collect()
    }

    /// Whether a scalar loop that is disturbed by u itself is bounded, loop, form and row affine in one gain.
    fn is_bounded(
        [loops, forms, seen]: [[f64; 2]; 3],
        change: f64,
        [decay, gain]: [f64; 2],
    ) -> bool {
        let (loops, forms, seen) = (points(&loops), scalars(&forms), points(&seen));
        let entry = IntervalMatrix::identity(1);
        let moving = Moving { loops: &loops, forms: &forms, changes: &[change], rate: 1.0 };
        let drive = MovingDrive { decay, gain, entry: &entry, seen: Some(&seen) };
        grows_no_faster_while_moving(&moving, &drive, |cell| Some(cell.clone())).is_ok()
    }

    #[test]
    fn a_scalar_loop_has_the_gain_of_its_frequency_response_at_zero_and_no_less() {
        // 1 / (1 - 0.5) is 2, with 2 as the form that shows it, however fast the pole moves below 0.5.
        let parts = [[0.25, 0.25], [2.0, 0.0], [1.0, 0.0]];
        assert!(is_bounded(parts, 2.0, [1.0, 4.01]));
        assert!(!is_bounded(parts, 2.0, [1.0, 3.99]));
        // Half as much again is seen at one end: 3, by a form of 4.5.
        let parts = [[0.5, 0.0], [4.5, 0.0], [1.0, 0.5]];
        assert!(is_bounded(parts, 2.0, [1.0, 9.05]));
        assert!(!is_bounded(parts, 2.0, [1.0, 8.95]));
    }

    #[test]
    fn a_form_follows_what_is_seen_as_far_as_gains_are_slow() {
        // From 0.9 to 1.1 is seen: 2.2 at most where gains stand still, with a form that is near twice the square.
        let parts = [[0.5, 0.0], [2.02, 0.4], [1.0, 0.1]];
        assert!(is_bounded(parts, 0.0, [1.0, 4.9]));
        assert!(is_bounded(parts, 1e-3, [1.0, 4.9]));
        assert!(!is_bounded(parts, 2.0, [1.0, 4.9]));
    }

    #[test]
    fn a_peak_asks_for_less_than_what_decays() {
        // 0.25 P + what comes through is below 0.5 P: 2 P by u.
        let parts = [[0.5, 0.0], [1.0, 0.0], [0.0, 0.0]];
        assert!(is_bounded(parts, 2.0, [0.5, 2.01]));
        assert!(!is_bounded(parts, 2.0, [0.5, 1.99]));
        assert!(!is_bounded(parts, 2.0, [0.2, 1e6]));
    }

    #[test]
    fn a_disturbance_enters_alike_at_all_gains() {
        // Of the box only its middle is asked for, from −1/8 to 1/8; there, too, the disturbance is u itself: 4, as of
        // a loop that stands still.
        let (loops, forms, seen) = (points(&[0.5, 0.0]), scalars(&[2.0, 0.0]), points(&[1.0, 0.0]));
        let entry = IntervalMatrix::identity(1);
        let moving = Moving { loops: &loops, forms: &forms, changes: &[2.0], rate: 1.0 };
        let bounded = |gain: f64| {
            let drive = MovingDrive { decay: 1.0, gain, entry: &entry, seen: Some(&seen) };
            let middle = |cell: &Ends| {
                let [lower, upper] = cell[0];
                let part = [lower.max(-0.125), upper.min(0.125)];
                (part[0] <= part[1]).then(|| vec![part])
            };
            grows_no_faster_while_moving(&moving, &drive, middle).is_ok()
        };
        assert!(bounded(4.01));
        assert!(!bounded(3.99));
    }

    #[test]
    fn what_is_no_bound_is_refused_by_name() {
        let (loops, forms) = (points(&[0.5, 0.0]), scalars(&[2.0, 0.0]));
        let entry = IntervalMatrix::identity(1);
        let moving = Moving { loops: &loops, forms: &forms, changes: &[2.0], rate: 1.0 };
        for (decay, gain, name) in [(0.0, 5.0, "decay"), (1.0, 0.0, "gain of the disturbance")] {
            let drive = MovingDrive { decay, gain, entry: &entry, seen: None };
            let found = grows_no_faster_while_moving(&moving, &drive, |cell| Some(cell.clone()));
            let reason = found.expect_err("refused").reason;
            assert!(matches!(reason, NotProved::Number { what, .. } if what == name), "{reason:?}");
        }
    }

    #[test]
    fn what_is_no_bound_is_refused() {
        let parts = [[0.25, 0.25], [2.0, 0.0], [1.0, 0.0]];
        for [decay, gain] in [[1.1, 5.0], [0.0, 5.0], [f64::NAN, 5.0], [1.0, 0.0], [1.0, -1.0]] {
            assert!(!is_bounded(parts, 2.0, [decay, gain]), "{decay} {gain}");
        }
        assert!(!is_bounded(parts, 2.0, [1.0, f64::INFINITY]));
        assert!(!is_bounded([[0.25, 0.25], [-2.0, 0.0], [1.0, 0.0]], 2.0, [1.0, 5.0]));
        assert!(!is_bounded([[0.25, 0.25], [2.0, 0.0], [f64::NAN, 0.0]], 2.0, [1.0, 5.0]));
    }
}

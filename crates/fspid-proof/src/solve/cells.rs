//! Whether a moving form decreases everywhere in a box of gains, from finitely many matrices.
//!
//! In a cell $\kappa = c + \sum_j s_j h_j e_j$, $s \in [-1, 1]^g$, the difference is a polynomial of degree 3 in
//! each $s_j$,
//!
//! $$ F(s) = \rho^2 P(s) - M(s)^T P^+(s) M(s) = \sum_m C_m s^m = \sum_b B_b \beta_b(s) $$
//!
//! and Bernstein's polynomials $\beta_b$ are not negative and sum up to 1: where all matrices $B_b$ are
//! positive definite, F is so in the whole cell. A cell where they are not is halved.
//!
//! # Source
//! J. Garloff, The Bernstein algorithm, Interval Computations 2 (1993) 154.

use super::dense::Dense;
use super::gain_family::{GainFamily, combination, corner_gains};

/// Coefficients of each gain: powers 0 to 3.
const POWERS: usize = 4;
/// Row b: what the powers of s contribute to the coefficient of the Bernstein polynomial b of degree 3 on [-1, 1].
const FROM_POWERS: [[f64; POWERS]; POWERS] = [
    [1.0, -1.0, 1.0, -1.0],
    [1.0, -1.0 / 3.0, -1.0 / 3.0, 1.0],
    [1.0, 1.0 / 3.0, -1.0 / 3.0, -1.0],
    [1.0, 1.0, 1.0, 1.0],
];
/// A cell that is no wider, in half widths of the box, counts as one where the form does not decrease.
const NARROWEST: f64 = 1.0 / 16.0;
/// Cells looked at before giving up.
const CELLS_MAX: usize = 3000;
/// Places reported where the form does not decrease.
const FAILURES_MAX: usize = 32;

/// Where the gains may be one sample later.
///
/// Gain by gain $\kappa_j^+ = f_j \kappa_j + o_j$: with $f_j = 1$ and $o_j = \pm d_j$ for a gain that moves by $d_j$ at
/// most, with $f_j = 0$ and $o_j = \pm 1$ for one that may jump.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Motion {
    follow: Vec<f64>,
    offset: Vec<f64>,
}

impl Motion {
    /// The extreme motions; what lies between is a mean of them. A change of 1 or more, or one that is not
    /// a number, counts as a jump.
    pub(super) fn extremes(changes: &[f64]) -> Vec<Self> {
        let jumps: Vec<bool> = changes.iter().map(|&change| !(change < 1.0)).collect();
        let follow: Vec<f64> = jumps.iter().map(|&jump| if jump { 0.0 } else { 1.0 }).collect();
        let steps: Vec<f64> = changes
            .iter()
            .zip(&jumps)
            .map(|(&d, &jump)| if jump { 1.0 } else { d.max(0.0) })
            .collect();
        let mut motions: Vec<Self> = Vec::new();
        for corner in 0..1 << changes.len() {
            let signs = corner_gains(corner, changes.len());
            // A gain that rests has one extreme, not two.
            let offset = signs.iter().zip(&steps).map(|(sign, step)| sign * step + 0.0).collect();
            let motion = Self { follow: follow.clone(), offset };
            if !motions.contains(&motion) {
                motions.push(motion);
            }
        }
        motions
    }

    pub(super) fn next(&self, gains: &[f64]) -> Vec<f64> {
        let parts = gains.iter().zip(&self.follow).zip(&self.offset);
        parts.map(|((gain, follow), offset)| follow * gain + offset).collect()
    }
}

/// What came of looking at all cells.
pub(super) struct Survey {
    /// Cells that were needed, or looked at.
    pub(super) cells: usize,
    /// Gains and motions where the form does not decrease, or may not; empty when it decreases everywhere.
    pub(super) failures: Vec<(Vec<f64>, Motion)>,
}

/// Answers for a cell the smallest one that holds all the gains in it that are asked for, if there are any;
/// cells are told by lower and upper end of each gain.
pub type Part<'a> = dyn Fn(&Vec<[f64; 2]>) -> Option<Vec<[f64; 2]>> + 'a;

/// Looks at all cells of the box in which there are gains that are asked for, halving where needed.
pub(super) fn survey(
    family: &GainFamily,
    forms: &[Dense],
    motions: &[Motion],
    level: f64,
    part: &Part<'_>,
) -> Survey {
    let mut open = vec![vec![[-1.0, 1.0]; family.gains()]];
    let mut survey = Survey { cells: 0, failures: vec![] };
    while let Some(ends) = open.pop() {
        let Some(ends) = part(&ends) else { continue };
        let cell = Cell::between(&ends);
        let products = Products::of(family, forms, &cell);
        survey.cells += 1;
        let failing = || motions.iter().find(|motion| !products.decreases(motion, level));
        let motion = if products.is_positive() { failing() } else { motions.first() };
        let Some(motion) = motion else { continue };
        let point = cell.centre.iter().map(|&gain| [gain, gain]).collect();
        let lost = part(&point).is_some() && !products.falls_at_centre(motion, level);
        match halves(&ends).filter(|_| !lost && survey.cells < CELLS_MAX) {
            Some(halves) => open.extend(halves),
            None => survey.failures.push((cell.centre, motion.clone())),
        }
        if survey.failures.len() >= FAILURES_MAX || survey.cells >= CELLS_MAX {
            break;
        }
    }
    survey
}

struct Cell {
    centre: Vec<f64>,
    half: Vec<f64>,
}

impl Cell {
    fn between(ends: &[[f64; 2]]) -> Self {
        Self {
            centre: ends.iter().map(|[lower, upper]| 0.5 * (lower + upper)).collect(),
            half: ends.iter().map(|[lower, upper]| 0.5 * (upper - lower)).collect(),
        }
    }
}

/// Two halves, across the widest side; nothing for a cell that is narrow.
fn halves(ends: &[[f64; 2]]) -> Option<[Vec<[f64; 2]>; 2]> {
    let widths = ends.iter().map(|[lower, upper]| upper - lower).enumerate();
    let (gain, width) = widths.max_by(|one, other| one.1.total_cmp(&other.1))?;
    let [lower, upper] = *ends.get(gain).filter(|_| width > NARROWEST)?;
    let middle = 0.5 * (lower + upper);
    Some([[lower, middle], [middle, upper]].map(|side| {
        let mut half = ends.to_vec();
        half[gain] = side;
        half
    }))
}

/// The parts of the difference in one cell that all motions share.
struct Products<'a> {
    cell: &'a Cell,
    forms: &'a [Dense],
    /// Loop at the centre, then its change over the half width of each gain.
    size: usize,
    /// $A_a^T P_j A_c$, made symmetric, by a, c and j.
    triples: Vec<Vec<Vec<Dense>>>,
}

impl<'a> Products<'a> {
    fn of(family: &GainFamily, forms: &'a [Dense], cell: &'a Cell) -> Self {
        let loops = in_cell(&family.parts, cell);
        let triple = |left: &Dense, right: &Dense, form: &Dense| {
            left.transpose_times(&form.times(right)).symmetric()
        };
        let triples = loops
            .iter()
            .map(|left| {
                let with = |right| forms.iter().map(|form| triple(left, right, form)).collect();
                loops.iter().map(with).collect()
            })
            .collect();
        Self { cell, forms, size: family.size(), triples }
    }

    fn gains(&self) -> usize {
        self.cell.half.len()
    }

    /// Whether the form is positive definite at the corners of the cell.
    fn is_positive(&self) -> bool {
        let at = |number: usize| -> Vec<f64> {
            let signs = corner_gains(number, self.gains());
            let sides = self.cell.centre.iter().zip(&self.cell.half).zip(signs);
            sides.map(|((centre, half), sign)| centre + sign * half).collect()
        };
        (0..1 << self.gains())
            .all(|number| combination(self.forms, &at(number)).cholesky().is_some())
    }

    /// Whether the difference is positive definite at the centre of the cell.
    fn falls_at_centre(&self, motion: &Motion, level: f64) -> bool {
        let mut decrease = combination(self.forms, &self.cell.centre).scaled(level);
        let after = combination(&self.triples[0][0], &motion.next(&self.cell.centre));
        decrease.add(-1.0, &after);
        decrease.cholesky().is_some()
    }

    /// Whether all Bernstein coefficients of the difference are positive definite.
    fn decreases(&self, motion: &Motion, level: f64) -> bool {
        let mut coefficients = self.powers(motion, level);
        for gain in 0..self.gains() {
            to_bernstein(&mut coefficients, POWERS.pow(gain as u32));
        }
        coefficients.iter().all(|coefficient| coefficient.cholesky().is_some())
    }

    /// Coefficients of the powers of s; the power of gain j counts $4^j$ in the number of a coefficient.
    fn powers(&self, motion: &Motion, level: f64) -> Vec<Dense> {
        let gains = self.gains();
        let mut sum = vec![Dense::zeros(self.size, self.size); POWERS.pow(gains as u32)];
        // A part is the constant or one gain; its number says which power it raises.
        let place = |part: usize| part.checked_sub(1).map_or(0, |gain| POWERS.pow(gain as u32));
        for (part, form) in in_cell(self.forms, self.cell).iter().enumerate() {
            sum[place(part)].add(level, form);
        }
        for (a, row) in self.triples.iter().enumerate() {
            for (c, triple) in row.iter().enumerate() {
                let centre = combination(triple, &motion.next(&self.cell.centre));
                sum[place(a) + place(c)].add(-1.0, &centre);
                for gain in 0..gains {
                    let scale = motion.follow[gain] * self.cell.half[gain];
                    sum[place(a) + place(c) + place(gain + 1)].add(-scale, &triple[gain + 1]);
                }
            }
        }
        sum
    }
}

/// An affine family in a cell: its value at the centre, then its change over each half width.
fn in_cell(parts: &[Dense], cell: &Cell) -> Vec<Dense> {
    let changes = parts[1..].iter().zip(&cell.half).map(|(part, half)| part.scaled(*half));
    core::iter::once(combination(parts, &cell.centre)).chain(changes).collect()
}

/// Turns coefficients of powers of one variable, which are `stride` apart, to Bernstein's.
fn to_bernstein(coefficients: &mut [Dense], stride: usize) {
    for start in 0..coefficients.len() {
        if !(start / stride).is_multiple_of(POWERS) {
            continue;
        }
        let powers: Vec<Dense> =
            (0..POWERS).map(|power| coefficients[start + power * stride].clone()).collect();
        for (number, row) in FROM_POWERS.iter().enumerate() {
            let mut sum = powers[0].scaled(row[0]);
            for (power, factor) in powers.iter().zip(row).skip(1) {
                sum.add(*factor, power);
            }
            coefficients[start + number * stride] = sum;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_lti::Matrix;

    fn scalars(values: &[f64]) -> Vec<Dense> {
        values.iter().map(|&value| Dense::identity(1).scaled(value)).collect()
    }

    fn family(low: f64, high: f64) -> GainFamily {
        let corner = |value: f64| Matrix::from_rows(&[[value]]).unwrap();
        GainFamily::from_corners(&[corner(low), corner(high)]).unwrap()
    }

    #[test]
    fn bernstein_coefficients_have_the_polynomial_as_their_mean() {
        // 2 - 3 s + 0.5 s² + s³ at s = 0.2: weights of the binomial law with t = 0.6.
        let mut coefficients = scalars(&[2.0, -3.0, 0.5, 1.0]);
        to_bernstein(&mut coefficients, 1);
        let weights = [0.064, 0.288, 0.432, 0.216];
        let mean: f64 =
            coefficients.iter().zip(weights).map(|(b, weight)| b[(0, 0)] * weight).sum();
        assert!((mean - (2.0 - 0.6 + 0.02 + 0.008)).abs() < 1e-14, "{mean}");
    }

    #[test]
    fn a_scalar_loop_falls_where_its_modulus_is_below_one() {
        let motions = Motion::extremes(&[2.0]);
        let one = scalars(&[1.0, 0.0]);
        assert!(
            survey(&family(-0.9, 0.99), &one, &motions, 1.0, &|cell| Some(cell.clone()))
                .failures
                .is_empty()
        );
        let failing =
            survey(&family(-0.9, 1.01), &one, &motions, 1.0, &|cell| Some(cell.clone())).failures;
        assert!(failing.iter().any(|(gains, _)| gains[0] > 0.9), "{failing:?}");
    }

    /// The loop exchanges two states with the factors 1.05 (1 ± 0.9 κ): its radius is 0.46 at both ends, 1.05 between.
    #[test]
    fn a_loop_that_is_unstable_only_between_the_ends_is_seen() {
        let end = |sign: f64| {
            Matrix::from_rows(&[[0.0, 1.05 + sign * 0.945], [1.05 - sign * 0.945, 0.0]]).unwrap()
        };
        let family = GainFamily::from_corners(&[end(-1.0), end(1.0)]).unwrap();
        let diagonal = |a: f64, b: f64| {
            Dense::from_function(2, 2, |i, j| {
                if i != j {
                    0.0
                } else if i == 0 {
                    a
                } else {
                    b
                }
            })
        };
        let forms = [diagonal(8.5, 8.5), diagonal(-7.5, 7.5)];
        let still = Motion::extremes(&[0.0]);
        assert_eq!(still.len(), 1);
        for end in [-1.0, 1.0] {
            let after = combination(&forms, &[end]).congruence(&family.at(&[end]));
            assert!(combination(&forms, &[end]).plus(-1.0, &after).cholesky().is_some());
        }
        let failures = survey(&family, &forms, &still, 1.0, &|cell| Some(cell.clone())).failures;
        assert!(failures.iter().any(|(gains, _)| gains[0].abs() < 0.1), "{failures:?}");
    }

    #[test]
    fn a_form_that_moves_too_much_for_the_motion_does_not_fall() {
        // A loop that keeps 0.97 of its state; 1 + 0.9 κ grows from 0.1 to 0.37 when κ leaves -1 by 0.3.
        let moving = scalars(&[1.0, 0.9]);
        let decreases = |change: f64| {
            let motions = Motion::extremes(&[change]);
            survey(&family(0.97, 0.97), &moving, &motions, 1.0, &|cell| Some(cell.clone()))
                .failures
                .is_empty()
        };
        assert!(decreases(0.0) && !decreases(0.3));
    }

    #[test]
    fn gains_move_by_their_change_or_jump() {
        let motions = Motion::extremes(&[0.1, 5.0, f64::NAN]);
        assert_eq!(motions.len(), 8);
        let next = motions[0].next(&[0.5, 0.5, 0.5]);
        assert!(
            (next[0] - 0.4).abs() < 1e-15
                && (next[1] + 1.0).abs() < 1e-15
                && (next[2] + 1.0).abs() < 1e-15
        );
    }
}

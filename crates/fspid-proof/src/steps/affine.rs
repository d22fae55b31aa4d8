//! Numbers that depend on shared unknowns, each between -1 and 1: affine arithmetic with an account of its rounding.
//!
//! $$ x = c + \sum_j p_j \xi_j + \omega \eta + \beta \zeta, \qquad |\xi_j|, |\eta|, |\zeta| \le 1 $$
//!
//! The ξ are shared by all numbers of a flight, so that what two of them have in common is not forgotten. ω is what rounding
//! and the width of coefficients leave, β what a ball around the state adds; both belong to the number alone.
//!
//! # Source
//! L. H. de Figueiredo and J. Stolfi, *Affine arithmetic: concepts and applications*, Numerical Algorithms 37 (2004) 147.

use std::cell::RefCell;

use fspid_numeric::scalar::Interval;
use fspid_numeric::sums::{combine, magnitudes};

/// Twice the relative error of an operation.
const ROUNDING: f64 = f64::EPSILON;

/// A number over the unknowns of a flight.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Affine {
    pub(super) centre: f64,
    pub(super) parts: Parts,
    /// What rounding may be off, ω.
    pub(super) off: f64,
    /// What the ball adds, β.
    pub(super) of_ball: f64,
}

/// What moves with each unknown, and the sum of its magnitudes, which is asked for wherever the number stands.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Parts {
    /// By each unknown; those that are not there are 0.
    by: Vec<f64>,
    /// At least the true sum.
    spread: f64,
}

/// What is less belongs to the number alone, as rounding does. Bounds are raised by the smallest normal number, so that what
/// is nothing at all is still more than zero; as an unknown it would be denormal a sample later, and a processor takes a
/// hundred times as long to multiply that.
const SMALLEST: f64 = 1e-150;

/// Unknowns that a sample adds, about.
const NEWER: usize = 16;
/// So many vectors are kept for the next numbers: those of a sample.
const SPARE: usize = 64;

thread_local! {
    /// Vectors of numbers that are gone. Each sample makes new numbers of the size of the old ones: to ask for their memory
    /// anew, and to clear it, was a fifth of a re-check.
    static VECTORS: RefCell<Vec<Vec<f64>>> = const { RefCell::new(Vec::new()) };
}

/// A vector whose numbers are whatever they were.
fn vector(size: usize) -> Vec<f64> {
    let spare = VECTORS.try_with(|vectors| vectors.borrow_mut().pop());
    // Unknowns that are new in this sample are told apart next.
    let mut vector = spare.ok().flatten().unwrap_or_else(|| Vec::with_capacity(size + NEWER));
    vector.resize(size, 0.0);
    vector
}

impl Drop for Parts {
    fn drop(&mut self) {
        let by = std::mem::take(&mut self.by);
        if by.capacity() > 0 {
            let _ = VECTORS.try_with(|vectors| {
                let mut vectors = vectors.borrow_mut();
                if vectors.len() < SPARE {
                    vectors.push(by);
                }
            });
        }
    }
}

impl Clone for Parts {
    fn clone(&self) -> Self {
        let mut by = vector(self.by.len());
        by.copy_from_slice(&self.by);
        Self { by, spread: self.spread }
    }
}

impl From<Vec<f64>> for Parts {
    fn from(by: Vec<f64>) -> Self {
        let spread = raised(magnitudes(&by), by.len());
        Self { by, spread }
    }
}

impl FromIterator<f64> for Parts {
    fn from_iter<T: IntoIterator<Item = f64>>(parts: T) -> Self {
        parts.into_iter().collect::<Vec<f64>>().into()
    }
}

impl Parts {
    /// What moves with an unknown.
    pub(super) fn of(&self, symbol: usize) -> f64 {
        self.by.get(symbol).copied().unwrap_or(0.0)
    }

    /// By each unknown.
    pub(super) fn each(&self) -> &[f64] {
        &self.by
    }
}

/// $\sum_i a_i p_i$ of the parts of terms.
fn combined(terms: &[(f64, &[f64])]) -> Parts {
    let size = terms.iter().map(|(_, parts)| parts.len()).max().unwrap_or(0);
    let mut by = vector(size);
    let spread = raised(combine(terms, &mut by), size);
    Parts { by, spread }
}

/// A sum of so many terms that are not negative, and then some: at least the true one. What is added at the end is more than
/// $2^{52}$ products that underflow can lose.
pub(super) fn raised(sum: f64, terms: usize) -> f64 {
    sum * (1.0 + 2.0 * (terms as f64 + 4.0) * ROUNDING) + f64::MIN_POSITIVE
}

impl Affine {
    /// A number that is enclosed.
    pub(super) fn constant(value: Interval) -> Self {
        let centre = value.midpoint();
        // Not half the width: the middle is rounded.
        let off = (value - Interval::point(centre)).magnitude();
        Self { centre, off, ..Self::default() }
    }

    /// An unknown between two ends, as the unknown of a number.
    pub(super) fn unknown([lower, upper]: [f64; 2], symbol: usize) -> Self {
        let whole = Interval::between(lower, upper);
        let mut parts = vec![0.0; symbol + 1];
        // Rounded up by what the middle may be off.
        let radius = raised(whole.radius(), 4) + ROUNDING * whole.magnitude();
        if let Some(part) = parts.last_mut() {
            *part = if whole.is_point() { 0.0 } else { radius };
        }
        Self { centre: whole.midpoint(), parts: parts.into(), off: 0.0, of_ball: 0.0 }
    }

    /// The number with an unknown of its own, which `symbol` gives where one is worth it.
    pub(super) fn and_noise(mut self, radius: f64, symbol: &mut dyn FnMut() -> usize) -> Self {
        if radius < SMALLEST {
            return self.and_off(radius);
        }
        let symbol = symbol();
        let Parts { by, spread } = &mut self.parts;
        if by.len() <= symbol {
            by.resize(symbol + 1, 0.0);
        }
        by[symbol] += radius;
        self.off += 2.0 * ROUNDING * by[symbol].abs();
        *spread = raised(*spread + radius, 2);
        self
    }

    /// The number with another one in place of an unknown.
    pub(super) fn with(&self, symbol: usize, unknown: &Self) -> Self {
        let by = self.parts.of(symbol);
        if by == 0.0 {
            return self.clone();
        }
        let mut parts = self.parts.by.clone();
        parts[symbol] = 0.0;
        let others = Self { parts: parts.into(), ..self.clone() };
        Self::sum([(Interval::ONE, &others), (Interval::point(by), unknown)])
    }

    /// The number with more that is its own.
    pub(super) fn and_off(mut self, off: f64) -> Self {
        self.off = raised(self.off + off, 2);
        self
    }

    /// Sum of the magnitudes of all parts.
    pub(super) fn spread(&self) -> f64 {
        self.parts.spread
    }

    /// How far from its middle it may be.
    pub(super) fn radius(&self) -> f64 {
        raised(self.spread() + self.off + self.of_ball, 3)
    }

    /// The largest magnitude.
    pub(super) fn magnitude(&self) -> f64 {
        raised(self.centre.abs() + self.radius(), 2)
    }

    /// Everything that it may be.
    pub(super) fn range(&self) -> Interval {
        let radius = self.radius();
        let radius = raised(radius, 2) + ROUNDING * self.centre.abs();
        Interval::new(self.centre - radius, self.centre + radius).unwrap_or(Interval::ENTIRE)
    }

    /// $\sum_j a_j x_j$.
    pub(super) fn sum<'a>(terms: impl IntoIterator<Item = (Interval, &'a Self)>) -> Self {
        let mut sum = Self::default();
        let mut parts: Vec<(f64, &[f64])> = Vec::new();
        // Of products and of what coefficients may be off.
        let (mut sizes, mut count) = (0.0, 0_usize);
        for (factor, term) in terms {
            let middle = factor.midpoint();
            let radius = if factor.is_point() { 0.0 } else { raised(factor.radius(), 4) };
            if middle == 0.0 && radius == 0.0 {
                continue;
            }
            sum.centre += middle * term.centre;
            parts.push((middle, term.parts.each()));
            let known = raised(term.centre.abs() + term.spread(), 2);
            sum.off += middle.abs() * term.off + radius * raised(known + term.off, 2);
            sum.of_ball += (middle.abs() + radius) * term.of_ball;
            sizes += middle.abs() * known;
            count += 1;
        }
        let rounding = (count as f64 + 2.0) * ROUNDING * sizes;
        sum.parts = combined(&parts);
        sum.off = raised(sum.off + raised(rounding, count), 2 * count + 4);
        sum.of_ball = if sum.of_ball > 0.0 { raised(sum.of_ball, 2 * count + 4) } else { 0.0 };
        sum
    }

    /// $x - y$.
    pub(super) fn less(&self, other: &Self) -> Self {
        Self::sum([(Interval::ONE, self), (-Interval::ONE, other)])
    }

    /// $x + y$.
    pub(super) fn plus(&self, other: &Self) -> Self {
        Self::sum([(Interval::ONE, self), (Interval::ONE, other)])
    }

    /// The linear part of $x y$, and how far the product may be from it.
    ///
    /// With $x = c + \sum p_j \xi_j$ and $y = d + \sum q_j \xi_j$ the linear part is $c d + \sum (c q_j + d p_j) \xi_j$, and
    /// what is left at most $\sum |p_j| \sum |q_j|$. What the ball adds to y is multiplied by everything that x may be; x has
    /// none of its own.
    pub(super) fn product(&self, other: &Self) -> (Self, f64) {
        let [of_self, of_other] = [self.spread(), other.spread()];
        let mut linear = Self { centre: self.centre * other.centre, ..Self::default() };
        let [own, theirs] = [self.centre.abs(), other.centre.abs()];
        let sizes = raised(own * theirs + own * of_other + theirs * of_self, 6);
        linear.parts =
            combined(&[(self.centre, other.parts.each()), (other.centre, self.parts.each())]);
        let off = raised(own + of_self + self.off, 3) * other.off
            + raised(theirs + of_other, 2) * self.off
            + 4.0 * ROUNDING * sizes;
        linear.off = raised(off, 6);
        let most = raised(own + of_self + self.off, 3);
        linear.of_ball = if other.of_ball > 0.0 { raised(most * other.of_ball, 2) } else { 0.0 };
        (linear, raised(of_self * of_other, 2))
    }

    /// The same with what the ball adds as its own.
    pub(super) fn owned(mut self) -> Self {
        self.off = raised(self.off + self.of_ball, 2);
        self.of_ball = 0.0;
        self
    }

    /// $a x$.
    pub(super) fn times(&self, factor: Interval) -> Self {
        Self::sum([(factor, self)])
    }
}

#[cfg(test)]
mod tests;

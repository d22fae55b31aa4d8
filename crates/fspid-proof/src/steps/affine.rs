//! Numbers that depend on shared unknowns, each between -1 and 1: affine arithmetic with an account of its rounding.
//!
//! $$ x = c + \sum_j p_j \xi_j + \omega \eta + \beta \zeta, \qquad |\xi_j|, |\eta|, |\zeta| \le 1 $$
//!
//! The ξ are shared by all numbers of a flight, so that what two of them have in common is not forgotten. ω is what rounding
//! and the width of coefficients leave, β what a ball around the state adds; both belong to the number alone.
//!
//! # Source
//! L. H. de Figueiredo and J. Stolfi, *Affine arithmetic: concepts and applications*, Numerical Algorithms 37 (2004) 147.

use fspid_numeric::scalar::Interval;

/// Twice the relative error of an operation.
const ROUNDING: f64 = f64::EPSILON;

/// A number over the unknowns of a flight.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Affine {
    pub(super) centre: f64,
    /// By each unknown; those that are not there are 0.
    pub(super) parts: Vec<f64>,
    /// What rounding may be off, ω.
    pub(super) off: f64,
    /// What the ball adds, β.
    pub(super) of_ball: f64,
}

/// A sum of so many terms that are not negative, and then some: at least the true one.
pub(super) fn raised(sum: f64, terms: usize) -> f64 {
    sum * (1.0 + 2.0 * (terms as f64 + 4.0) * ROUNDING) + f64::MIN_POSITIVE
}

impl Affine {
    /// A number that is enclosed.
    pub(super) fn constant(value: Interval) -> Self {
        Self { centre: value.midpoint(), off: value.radius(), ..Self::default() }
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
        Self { centre: whole.midpoint(), parts, off: 0.0, of_ball: 0.0 }
    }

    /// The number with an unknown of its own.
    pub(super) fn and_noise(mut self, radius: f64, symbol: usize) -> Self {
        if radius > 0.0 {
            if self.parts.len() <= symbol {
                self.parts.resize(symbol + 1, 0.0);
            }
            self.parts[symbol] += radius;
            self.off += 2.0 * ROUNDING * self.parts[symbol].abs();
        }
        self
    }

    /// The number with more that is its own.
    pub(super) fn and_off(mut self, off: f64) -> Self {
        self.off = raised(self.off + off, 2);
        self
    }

    /// Sum of the magnitudes of all parts.
    pub(super) fn spread(&self) -> f64 {
        raised(self.parts.iter().map(|part| part.abs()).sum(), self.parts.len())
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
        // Of products and of what coefficients may be off.
        let (mut sizes, mut count) = (0.0, 0_usize);
        for (factor, term) in terms {
            let middle = factor.midpoint();
            let radius = if factor.is_point() { 0.0 } else { raised(factor.radius(), 4) };
            if middle == 0.0 && radius == 0.0 {
                continue;
            }
            sum.centre += middle * term.centre;
            if sum.parts.len() < term.parts.len() {
                sum.parts.resize(term.parts.len(), 0.0);
            }
            for (part, of_term) in sum.parts.iter_mut().zip(&term.parts) {
                *part += middle * of_term;
            }
            let known = raised(term.centre.abs() + term.spread(), 2);
            sum.off += middle.abs() * term.off + radius * raised(known + term.off, 2);
            sum.of_ball += (middle.abs() + radius) * term.of_ball;
            sizes += middle.abs() * known;
            count += 1;
        }
        let rounding = (count as f64 + 2.0) * ROUNDING * sizes;
        // Products that underflow.
        let tiny = f64::MIN_POSITIVE * (sum.parts.len() as f64 + 1.0) * count as f64;
        sum.off = raised(sum.off + raised(rounding, count) + tiny, 2 * count + 4);
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
        linear.parts.resize(self.parts.len().max(other.parts.len()), 0.0);
        for (place, part) in linear.parts.iter_mut().enumerate() {
            let at = |parts: &[f64]| parts.get(place).copied().unwrap_or(0.0);
            *part = self.centre * at(&other.parts) + other.centre * at(&self.parts);
        }
        let [own, theirs] = [self.centre.abs(), other.centre.abs()];
        let sizes = raised(own * theirs + own * of_other + theirs * of_self, 6);
        let tiny = f64::MIN_POSITIVE * (linear.parts.len() as f64 + 1.0);
        let off = raised(own + of_self + self.off, 3) * other.off
            + raised(theirs + of_other, 2) * self.off
            + 4.0 * ROUNDING * sizes;
        linear.off = raised(off + tiny, 6);
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

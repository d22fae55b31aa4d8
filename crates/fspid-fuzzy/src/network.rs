//! A small neural network in the place of rules: eight hidden units, silent at rest, the same for a mirrored flight.

use crate::error::FuzzyError;
use crate::rule_table::Output;
use fspid_numeric::Real;
use fspid_numeric::lanes::{Lanes, One};

/// Hidden units of a network.
pub const UNITS: usize = 8;
/// Largest magnitude of a weight: a hidden unit then turns within a millionth of the range. Sums of larger ones could
/// overflow with numbers of 32 bits.
pub const LARGEST_WEIGHT: f64 = 1e6;

/// A number for each hidden unit.
pub type NetworkRow<R> = [R; UNITS];

/// The weights of a network that answers increments of the gains.
///
/// With the inputs $x$ (the error) and $y$ (what is seen beside it) in parts of the range, each from -1 to 1, the hidden
/// unit i sees $u_i = a_i x + b_i y$ and answers
///
/// $$ h_i = \varphi(c_i + u_i) + \varphi(c_i - u_i) - 2 \varphi(c_i), \qquad \varphi(z) = \frac{z}{1 + |z|} $$
///
/// and with the range r the increment of a gain is
///
/// $$ \Delta k = r \ \varphi\Big( \sum_i v_i h_i \Big) $$
///
/// - $\varphi$ is the softsign: one division and no exponential, so that it has the same bits everywhere; it rises
///   everywhere, and its slope $1 / (1 + |z|)^2$ falls with $|z|$, so that an interval is enclosed by its ends.
/// - **Both inputs turned, the answer is the same**, to the last bit: a unit sees $u$ and $-u$ alike. An aircraft that is
///   flown around its trim has no up and down that a supervisor of gains could tell apart.
/// - **At rest the answer is 0**, to the last bit: the nominal gains are those at rest.
/// - **The answer lies within the range**, whatever the weights are, as that of rules does: factors behind the supervisor
///   mean the same.
///
/// The rows are $a$, $b$, $c$ and the $v$ of kp, ki and kd, as [`ROWS`](Self::ROWS) names them: 48 numbers, 384 bytes in
/// 64 bits and 192 in 32.
///
/// # Source
/// Softsign: D. L. Elliott, A better activation function for artificial neural networks, Institute for Systems Research,
/// University of Maryland, T.R. 93-8 (1993). That a network of one hidden layer comes near to every continuous function: G.
/// Cybenko, Approximation by superpositions of a sigmoidal function, Mathematics of Control, Signals, and Systems 2 (1989)
/// 303; its even part is of the form above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Network<R> {
    rows: [NetworkRow<R>; 6],
}

/// The softsign, from -1 to 1.
#[inline(always)]
fn softsign<L: Lanes>(x: L) -> L {
    let (zero, one) = (x.same(L::Number::ZERO), x.same(L::Number::ONE));
    x / (one + x.larger(zero - x))
}

impl<R: Real> Network<R> {
    /// Names of the rows, in files as here.
    pub const ROWS: [&'static str; 6] =
        ["error", "change", "offset", "delta_kp", "delta_ki", "delta_kd"];

    /// The network of six rows, in the order of [`ROWS`](Self::ROWS).
    ///
    /// # Errors
    /// [`FuzzyError::Weight`] for the first weight that is not a number of at most [`LARGEST_WEIGHT`].
    pub fn new(rows: [NetworkRow<R>; 6]) -> Result<Self, FuzzyError> {
        for (row, weights) in Self::ROWS.into_iter().zip(&rows) {
            for (weight, unit) in weights.iter().zip(1..) {
                let found = weight.to_f64();
                if !(found.abs() <= LARGEST_WEIGHT) {
                    return Err(FuzzyError::Weight { row, unit, found, allowed: LARGEST_WEIGHT });
                }
            }
        }
        Ok(Self { rows })
    }

    /// The network of the rows of one that was built, as a constant; nothing is checked.
    #[must_use]
    pub const fn new_unchecked(rows: [NetworkRow<R>; 6]) -> Self {
        Self { rows }
    }

    /// The six rows, in the order of [`ROWS`](Self::ROWS).
    #[must_use]
    pub const fn rows(&self) -> &[NetworkRow<R>; 6] {
        &self.rows
    }

    /// Weights $a$ of the error, $b$ of what is seen beside it, and offsets $c$, unit by unit.
    pub fn hidden(&self) -> impl Iterator<Item = [R; 3]> + '_ {
        let [by_error, by_change, offset, ..] = &self.rows;
        by_error.iter().zip(by_change).zip(offset).map(|((a, b), c)| [*a, *b, *c])
    }

    /// Weights $v$ of the hidden units in an output.
    #[must_use]
    pub const fn output(&self, output: Output) -> &NetworkRow<R> {
        let [_, _, _, kp, ki, kd] = &self.rows;
        match output {
            Output::DeltaKp => kp,
            Output::DeltaKi => ki,
            Output::DeltaKd => kd,
        }
    }

    /// Answers in parts of the range for inputs in parts of the range.
    #[inline(always)]
    pub(crate) fn answers<L: Lanes<Number = R>>(&self, error: L, change: L) -> [L; 3] {
        let [by_error, by_change, offset, kp, ki, kd] = &self.rows;
        let mut sums = [error.same(R::ZERO); 3];
        let [sum_kp, sum_ki, sum_kd] = &mut sums;
        let hidden = by_error.iter().zip(by_change).zip(offset);
        let outputs = kp.iter().zip(ki).zip(kd);
        for (((a, b), c), ((kp, ki), kd)) in hidden.zip(outputs) {
            let seen = error.same(*a) * error + error.same(*b) * change;
            let offset = error.same(*c);
            let rest = softsign(offset);
            // Turned inputs change the places of both brackets, and at rest both are zero.
            let unit = (softsign(offset + seen) - rest) + (softsign(offset - seen) - rest);
            *sum_kp = *sum_kp + error.same(*kp) * unit;
            *sum_ki = *sum_ki + error.same(*ki) * unit;
            *sum_kd = *sum_kd + error.same(*kd) * unit;
        }
        sums.map(softsign)
    }

    /// Increments within `range`, for inputs within it, in each lane.
    #[inline(always)]
    pub(crate) fn increments_in_lanes<L: Lanes<Number = R>>(
        &self,
        range: R,
        [error, change]: [L; 2],
    ) -> [L; 3] {
        let range = error.same(range);
        self.answers(error / range, change / range).map(|answer| range * answer)
    }

    /// Increments within `range`, for inputs within it.
    #[inline]
    pub(crate) fn increments(&self, range: R, [error, change]: [R; 2]) -> [R; 3] {
        self.increments_in_lanes(range, [One(error), One(change)]).map(|One(increment)| increment)
    }
}

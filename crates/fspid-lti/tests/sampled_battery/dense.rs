//! What a dense grid, local refinement and powers of matrices know about a loop: no eigenvalues, no state-space response.

use core::f64::consts::{PI, TAU};

use crate::sampled_battery::factored::{Factored, Value};
use fspid_lti::{Complex, Matrix, modulus, quotient};

/// Angles of the grid, half of them evenly, half evenly in the logarithm.
const POINTS: usize = 2400;
/// Squarings of a matrix: the 2^46th power tells a spectral radius to 10^-12 even where transients grow to 10^30.
const SQUARINGS: i32 = 46;

/// Spectral radius from the growth of the norms of powers.
pub(crate) fn growth(matrix: &Matrix) -> f64 {
    let (mut power, mut logarithm, mut weight) = (matrix.clone(), 0.0, 1.0);
    for _ in 0..SQUARINGS {
        let norm = power.norm_one();
        if norm == 0.0 {
            return 0.0;
        }
        logarithm += weight * libm::log(norm);
        power = power.scaled(1.0 / norm);
        power = power.product(&power).expect("square");
        weight *= 0.5;
    }
    libm::exp(logarithm + weight * libm::log(power.norm_one().max(f64::MIN_POSITIVE)))
}

/// Matrix of the loop closed with a factor on the gain.
pub(crate) fn closed_matrix(open: &Factored, factor: f64) -> Matrix {
    Factored { gain: factor * open.gain, ..open.clone() }.realised().closed_matrix()
}

/// A loop on the grid.
pub(crate) struct Dense<'a> {
    open: &'a Factored,
    angles: Vec<f64>,
    values: Vec<Value>,
}

impl<'a> Dense<'a> {
    pub(crate) fn new(open: &'a Factored) -> Self {
        let half = POINTS / 2;
        let even = (1..=half).map(|k| PI * k as f64 / half as f64);
        let fine = (0..half).map(|k| PI * libm::exp(-14.0 * k as f64 / half as f64));
        let mut angles: Vec<f64> = even.chain(fine).collect();
        angles.sort_by(f64::total_cmp);
        angles.dedup();
        let values = angles.iter().map(|&angle| open.at_angle(angle)).collect();
        Self { open, angles, values }
    }

    /// Places between which a quantity changes its sign, refined by halving.
    fn sign_changes(&self, quantity: impl Fn(Value) -> f64) -> Vec<f64> {
        let mut found = Vec::new();
        for (angles, values) in self.angles.windows(2).zip(self.values.windows(2)) {
            let (first, last) = (quantity(values[0]), quantity(values[1]));
            if first * last < 0.0 {
                let (mut low, mut high) = (angles[0], angles[1]);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    let same = quantity(self.open.at_angle(middle)) * first > 0.0;
                    if same { low = middle } else { high = middle }
                }
                found.push(0.5 * (low + high));
            }
        }
        found
    }

    /// Angles at which |L| = 1, with the distance of the phase from ±π.
    pub(crate) fn crossovers(&self) -> Vec<(f64, f64)> {
        let excess = |value: Value| value.over.norm_sqr() - value.under.norm_sqr();
        let margin = |angle: f64| {
            let value = quotient_of(self.open.at_angle(angle));
            (angle, libm::remainder(libm::atan2(value.im, value.re) + PI, TAU))
        };
        self.sign_changes(excess).into_iter().map(margin).collect()
    }

    /// Positive factors −1/L where L crosses the negative real axis; at 0 and π it does so with its mirror image.
    pub(crate) fn factors(&self) -> Vec<f64> {
        let across = |value: Value| (value.over * value.under.conj()).im;
        let mut angles = self.sign_changes(across);
        angles.extend([0.0, PI]);
        let factor = |angle: f64| {
            let value = self.open.at_angle(angle);
            -quotient(value.under, value.over)
        };
        // A change of sign through infinity, at a pole, is no crossing.
        let real = |factor: &Complex| factor.im.abs() < 1e-6 * factor.re.abs();
        let found = angles.into_iter().map(factor).filter(real).map(|factor| factor.re);
        found.filter(|&factor| factor > 1e-5 && factor < 1e5).collect()
    }

    /// Largest |T − t0| by golden section about the best point of the grid; a lower bound of the true one.
    pub(crate) fn peak(&self, centre: f64) -> f64 {
        let height = |value: Value| distance(value, centre);
        let heights = self.values.iter().map(|&value| height(value));
        let best = heights.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |best| best.0);
        let (mut low, mut high) = (
            self.angles[best.saturating_sub(1)],
            self.angles[(best + 1).min(self.angles.len() - 1)],
        );
        let mut top = height(self.values[best]).max(height(self.open.at_angle(0.0)));
        for _ in 0..50 {
            let step = 0.381_966_011_250_105 * (high - low);
            let (left, right) = (low + step, high - step);
            let [left_height, right_height] =
                [left, right].map(|angle| height(self.open.at_angle(angle)));
            top = top.max(left_height).max(right_height);
            if left_height > right_height { high = right } else { low = left }
        }
        top
    }
}

/// |T − t0|.
pub(crate) fn distance(value: Value, centre: f64) -> f64 {
    let sum = value.over + value.under;
    modulus(value.over - sum * centre) / modulus(sum)
}

pub(crate) fn quotient_of(value: Value) -> Complex {
    quotient(value.over, value.under)
}

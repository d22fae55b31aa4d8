//! Sampled PID loops around plants with slow modes, as numbers that an oracle can read.

use crate::support::Random;
use fspid_lti::{
    FineMatrix, LtiError, Matrix, SampledLoop, TransferFunction, held_change, zero_order_hold,
};

/// A plant, a PID controller that sums errors and filters their difference, and a dead time of whole samples.
#[derive(Debug, Clone)]
pub(crate) struct Slow {
    pub(crate) numerator: Vec<f64>,
    pub(crate) denominator: Vec<f64>,
    /// kp, ki, kd.
    pub(crate) gains: [f64; 3],
    pub(crate) filter_s: f64,
    pub(crate) delay: usize,
    pub(crate) dt_s: f64,
}

/// Which part of a loop is put together.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    Whole,
    Change,
    Rest,
}

impl Slow {
    /// The loop as a state matrix, with the digits that its ones take away.
    pub(crate) fn open(&self) -> Result<SampledLoop, LtiError> {
        let transfer = TransferFunction::new(&self.numerator, &self.denominator)?;
        let (model, rest) = (transfer.to_state_space(), transfer.state_space_rest());
        let a = FineMatrix::new(model.a().clone(), rest.a().clone())?;
        let b = FineMatrix::new(model.b().clone(), rest.b().clone())?;
        let (change, input) = held_change(&a, &b, self.dt_s)?;
        let (high, high_input) = self.assembled([change.high(), input.high()], Part::Change)?;
        let (low, low_input) = self.assembled([change.low(), input.low()], Part::Rest)?;
        let column = |values: &[f64]| {
            let rows: Vec<[f64; 1]> = values.iter().map(|&value| [value]).collect();
            Matrix::from_rows(&rows)
        };
        let input = FineMatrix::new(column(&high_input)?, column(&low_input)?)?;
        self.open_without_digits()?.with_change(FineMatrix::new(high, low)?, input)
    }

    /// The same from the state matrix alone.
    pub(crate) fn open_without_digits(&self) -> Result<SampledLoop, LtiError> {
        let model = TransferFunction::new(&self.numerator, &self.denominator)?.to_state_space();
        let (plant, input) = zero_order_hold(model.a(), model.b(), self.dt_s)?;
        let (a, b) = self.assembled([&plant, &input], Part::Whole)?;
        let ([kp, ki, kd], time_s, order) = (self.gains, self.filter_s + self.dt_s, b.len());
        let mut c = vec![0.0; order];
        c[0] = kp + ki * self.dt_s + kd / time_s;
        c[order - 3..].copy_from_slice(&[1.0, kd * self.filter_s / time_s, -kd / time_s]);
        SampledLoop::new(a, b, c, self.dt_s)
    }

    /// State matrix, or what it changes, or the rest of that, and its input: plant, dead time, sum, filtered difference,
    /// last sample.
    fn assembled(
        &self,
        [plant, input]: [&Matrix; 2],
        part: Part,
    ) -> Result<(Matrix, Vec<f64>), LtiError> {
        let (n, order) = (plant.rows(), plant.rows() + self.delay + 3);
        let mut rows = vec![vec![0.0; order]; order];
        let mut b = vec![0.0; order];
        #[allow(clippy::needless_range_loop, reason = "rows and columns of two matrices at once")]
        for row in 0..n {
            for column in 0..n {
                rows[row][column] = plant.get(row, column).unwrap_or(0.0);
            }
            let entry = input.get(row, 0).unwrap_or(0.0);
            if self.delay == 0 { b[row] = entry } else { rows[row][n] = entry }
        }
        if part != Part::Rest {
            self.place_controller(&mut rows, &mut b, n);
        }
        if part == Part::Change {
            for (place, row) in rows.iter_mut().enumerate().skip(n) {
                row[place] -= 1.0;
            }
            rows[order - 2][order - 2] = -self.dt_s / (self.filter_s + self.dt_s);
        }
        Ok((Matrix::from_rows(&rows)?, b))
    }

    fn place_controller(&self, rows: &mut [Vec<f64>], b: &mut [f64], n: usize) {
        let order = b.len();
        for place in n..n + self.delay {
            if place + 1 < n + self.delay { rows[place][place + 1] = 1.0 } else { b[place] = 1.0 }
        }
        let (sum, filtered, last) = (order - 3, order - 2, order - 1);
        let time_s = self.filter_s + self.dt_s;
        (rows[sum][0], rows[sum][sum]) = (self.gains[1] * self.dt_s, 1.0);
        rows[filtered][0] = 1.0 / time_s;
        rows[filtered][filtered] = self.filter_s / time_s;
        rows[filtered][last] = -1.0 / time_s;
        rows[last][0] = 1.0;
    }

    /// A random loop: short period, phugoid, perhaps an integrator and a servo, gains around a crossover.
    pub(crate) fn random(random: &mut Random) -> Self {
        let spread = |random: &mut Random, low: f64, high: f64| {
            low * libm::exp(random.uniform(0.0, libm::log(high / low)))
        };
        let chance = |random: &mut Random, share: f64| random.uniform(0.0, 1.0) < share;
        let dt_s = [1e-4, 1e-3, 5e-3, 1e-2, 2e-2, 0.1][random.uniform(0.0, 6.0) as usize];
        let pair = |omega: f64, damping: f64| vec![1.0, 2.0 * damping * omega, omega * omega];
        let short = spread(random, 0.3, 10.0);
        let slow = spread(random, 1e-3, 0.3);
        let mut denominator =
            times(&pair(short, random.uniform(0.05, 1.2)), &pair(slow, spread(random, 3e-3, 0.9)));
        let zeros = [spread(random, 0.1, 3.0), slow * spread(random, 0.03, 30.0)];
        let mut numerator = times(&[1.0, zeros[0]], &[1.0, zeros[1]]);
        if chance(random, 0.3) {
            numerator = times(
                &[1.0, zeros[0]],
                &pair(slow * random.uniform(0.5, 2.0), random.uniform(0.02, 0.9)),
            );
        }
        if chance(random, 0.4) {
            denominator.push(0.0);
        }
        if chance(random, 0.5) {
            let servo = spread(random, 3.0, 60.0);
            denominator = times(&denominator, &[1.0, servo]);
            numerator.iter_mut().for_each(|value| *value *= servo);
        }
        let omega = spread(random, slow, 3.0 * short);
        let gain = size(&denominator, omega) / size(&numerator, omega);
        let kp = gain * spread(random, 0.05, 2.0) * if chance(random, 0.03) { -1.0 } else { 1.0 };
        let ki = if chance(random, 0.8) { kp * spread(random, 1e-5, 1.0) } else { kp * 1e-6 };
        let kd = if chance(random, 0.5) { kp * spread(random, 1e-3, 1.0) } else { 0.0 };
        let filter_s = if chance(random, 0.5) { spread(random, 0.01, 0.2) } else { 0.0 };
        let delay = if chance(random, 0.4) { random.uniform(0.0, 5.0) as usize } else { 0 };
        Self { numerator, denominator, gains: [kp, ki, kd], filter_s, delay, dt_s }
    }
}

fn times(left: &[f64], right: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; left.len() + right.len() - 1];
    for (i, left) in left.iter().enumerate() {
        for (j, right) in right.iter().enumerate() {
            product[i + j] += left * right;
        }
    }
    product
}

/// Size of a polynomial at jω.
fn size(polynomial: &[f64], omega: f64) -> f64 {
    let (mut re, mut im) = (0.0, 0.0);
    for coefficient in polynomial {
        (re, im) = (coefficient - im * omega, re * omega);
    }
    libm::hypot(re, im)
}

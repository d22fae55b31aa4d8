//! Sampled loops of the paper's two plants, built from first principles.
#![allow(dead_code, reason = "each test uses its part")]
#![allow(clippy::unwrap_used, reason = "a test")]

use fspid_lti::{Matrix, TransferFunction, zero_order_hold};

/// Sample period, s.
pub(crate) const DT_S: f64 = 0.01;
/// Time constant of the derivative filter, s.
pub(crate) const FILTER_S: f64 = 0.05;

/// A plant behind its servo, sampled, with one input and one output.
pub(crate) struct Plant {
    a: Matrix,
    b: Matrix,
    c: Matrix,
}

impl Plant {
    fn new(numerator: &[f64], denominator: &[f64]) -> Self {
        // Behind the servo 10/(s + 10).
        let numerator: Vec<f64> = numerator.iter().map(|value| 10.0 * value).collect();
        let mut product = vec![0.0; denominator.len() + 1];
        for (i, value) in denominator.iter().enumerate() {
            product[i] += value;
            product[i + 1] += 10.0 * value;
        }
        let model = TransferFunction::new(&numerator, &product).unwrap().to_state_space();
        let (a, b) = zero_order_hold(model.a(), model.b(), DT_S).unwrap();
        Self { a, b, c: model.c().clone() }
    }

    /// Pitch of the Boeing 747 over its elevator, with the sign of the elevator reversed; the paper's plant.
    pub(crate) fn boeing_747() -> Self {
        Self::new(&[1.69144, 0.84341, 0.0099096], &[1.0, 1.17103, 1.55405, 0.012538, 0.0072771])
    }

    /// Pitch of the Navion over its elevator, short-period approximation; the paper's plant.
    pub(crate) fn navion() -> Self {
        Self::new(&[11.7304, 22.578], &[1.0, 4.9676, 12.941, 0.0])
    }

    /// One sample of the loop with a PID controller that differentiates the measurement behind a filter.
    ///
    /// States: plant, integral term, filtered derivative, minus the last measurement.
    pub(crate) fn closed(&self, [kp, ki, kd]: [f64; 3]) -> Matrix {
        let n = self.a.rows();
        let mut m = Matrix::zeros(n + 3, n + 3);
        let c = |j: usize| self.c.get(0, j).unwrap();
        let share = 1.0 / (FILTER_S + DT_S);
        let mut u: Vec<f64> = (0..n).map(|j| -(kp + ki * DT_S + kd * share) * c(j)).collect();
        u.extend([1.0, kd * FILTER_S * share, -kd * share]);
        for j in 0..n {
            m.set(n, j, -ki * DT_S * c(j)).unwrap();
            m.set(n + 1, j, -share * c(j)).unwrap();
            m.set(n + 2, j, -c(j)).unwrap();
        }
        m.set(n, n, 1.0).unwrap();
        m.set(n + 1, n + 1, FILTER_S * share).unwrap();
        m.set(n + 1, n + 2, -share).unwrap();
        for i in 0..n {
            for (j, u) in u.iter().enumerate() {
                let own = self.a.get(i, j).unwrap_or(0.0);
                m.set(i, j, own + self.b.get(i, 0).unwrap() * u).unwrap();
            }
        }
        m
    }

    /// Loops at the corners of the gains that differ by at most this part from the centre.
    pub(crate) fn corners(&self, centre: [f64; 3], part: f64) -> Vec<Matrix> {
        (0..8)
            .map(|corner| {
                let gain = |i: usize| {
                    centre[i] * if corner >> i & 1 == 0 { 1.0 - part } else { 1.0 + part }
                };
                self.closed([gain(0), gain(1), gain(2)])
            })
            .collect()
    }
}

/// Gains of the two designs: kp, ki in 1/s, kd in s.
pub(crate) const GAINS_747: [f64; 3] = [1.33, 0.3, 1.22];
pub(crate) const GAINS_NAVION: [f64; 3] = [0.82, 0.43, 0.165];

/// $s P - M^T R M$, as it is written.
pub(crate) fn difference(level: f64, p: &Matrix, m: &Matrix, r: &Matrix) -> Matrix {
    let after = m.transpose().product(&r.product(m).unwrap()).unwrap();
    p.scaled(level).sum(&after.scaled(-1.0)).unwrap()
}

/// Whether elimination without pivoting meets positive pivots only.
pub(crate) fn is_positive_definite(matrix: &Matrix) -> bool {
    let n = matrix.rows();
    let mut rows: Vec<Vec<f64>> =
        (0..n).map(|i| (0..n).map(|j| matrix.get(i, j).unwrap()).collect()).collect();
    while let Some(pivot_row) = rows.first().cloned() {
        if !(pivot_row[0] > 0.0) {
            return false;
        }
        rows = rows[1..]
            .iter()
            .map(|row| {
                let factor = row[0] / pivot_row[0];
                row.iter().zip(&pivot_row).skip(1).map(|(a, pivot)| a - factor * pivot).collect()
            })
            .collect();
    }
    true
}

pub(crate) fn matrix<const N: usize>(rows: &[[f64; N]]) -> Matrix {
    Matrix::from_rows(rows).unwrap()
}

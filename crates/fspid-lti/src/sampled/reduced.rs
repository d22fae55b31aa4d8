//! Similarity transformation of a sampled loop for fast and accurate frequency responses.

use super::quick::hessenberg;
use crate::balance::balance;
use crate::complex::Complex;
use crate::matrix::Matrix;

/// Rows up to this length are kept without an allocation.
const SHORT: usize = 25;

/// Loop in the variable $\zeta = z - 1$, balanced, with a Hessenberg matrix and one output coefficient.
///
/// $$ L = \gamma e_n^T (\zeta I - H)^{-1} b, \quad H \sim A - I $$
///
/// In $\zeta$ the slow poles of a quickly sampled loop lie near the origin, where floating point numbers are dense,
/// instead of near 1, where they are not. With the output coefficients turned into the last unit vector, elimination
/// needs neither the whole matrix nor back substitution, and a feedback of the output changes the last column only.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reduced {
    h: Matrix,
    b: Vec<f64>,
    gamma: f64,
}

/// A response as a quotient whose parts have a common factor of no meaning; the lower part is 0 at a pole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Response {
    pub(super) over: Complex,
    pub(super) under: Complex,
}

/// A response with the slopes of its two parts over $\zeta$.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Slope {
    pub(super) value: Response,
    pub(super) over: Complex,
    pub(super) under: Complex,
}

impl Reduced {
    /// From matrices whose shapes agree.
    pub(super) fn new(a: &Matrix, b: &[f64], c: &[f64]) -> Self {
        let order = a.rows();
        let mut system = Matrix::from_function(order + 1, order + 1, |row, column| {
            match (row < order, column < order) {
                (true, true) if row == column => a.at(row, column) - 1.0,
                (true, true) => a.at(row, column),
                (true, false) => b[row],
                (false, true) => c[column],
                (false, false) => 0.0,
            }
        });
        balance(&mut system);
        let system = flip(&hessenberg(&flip(&system)));
        Self {
            h: Matrix::from_function(order, order, |row, column| system.at(row, column)),
            b: (0..order).map(|row| system.at(row, order)).collect(),
            gamma: system.at(order, order - 1),
        }
    }

    /// Number of states.
    pub(super) fn order(&self) -> usize {
        self.b.len()
    }

    /// The input vector.
    pub(super) fn b(&self) -> &[f64] {
        &self.b
    }

    /// The only output coefficient that is not 0, the last one.
    pub(super) fn gamma(&self) -> f64 {
        self.gamma
    }

    /// The same loop with a factor on its gain.
    pub(super) fn scaled(&self, factor: f64) -> Self {
        Self { gamma: factor * self.gamma, ..self.clone() }
    }

    /// Matrix of the loop closed with a factor on its gain, less the identity; a Hessenberg matrix.
    pub(super) fn closed(&self, factor: f64) -> Matrix {
        let last = self.order() - 1;
        Matrix::from_function(self.order(), self.order(), |row, column| {
            let open = self.h.at(row, column);
            if column == last { open - factor * self.gamma * self.b[row] } else { open }
        })
    }

    /// The response at a place.
    ///
    /// Elimination with exchange of neighbouring rows; only the row that is being passed down is kept.
    pub(super) fn at(&self, zeta: Complex) -> Response {
        let order = self.order();
        let (mut short, mut long) = ([Complex::new(0.0, 0.0); SHORT], Vec::new());
        let row = if order < SHORT {
            &mut short[..=order]
        } else {
            long.resize(order + 1, Complex::new(0.0, 0.0));
            long.as_mut_slice()
        };
        self.first_row(zeta, row);
        for k in 0..order - 1 {
            let below = self.h.row(k + 1);
            let (head, lead) = (row[k], -below[k]);
            if head.norm_sqr() >= lead * lead {
                let factor = if lead == 0.0 { Complex::new(0.0, 0.0) } else { lead / head };
                for j in k + 1..order {
                    row[j] = -below[j] - factor * row[j];
                }
                row[order] = self.b[k + 1] - factor * row[order];
                row[k + 1] += zeta;
            } else {
                let factor = head / lead;
                for j in k + 1..order {
                    row[j] += factor * below[j];
                }
                row[order] -= factor * self.b[k + 1];
                row[k + 1] -= factor * zeta;
            }
        }
        Response { over: row[order] * self.gamma, under: row[order - 1] }
    }

    /// First row of the equations and their right side.
    fn first_row(&self, zeta: Complex, row: &mut [Complex]) {
        for (place, entry) in row.iter_mut().zip(self.h.row(0)) {
            *place = Complex::new(-entry, 0.0);
        }
        row[0] += zeta;
        row[self.order()] = Complex::new(self.b[0], 0.0);
    }

    /// The response and the slopes of its parts, by differentiating every step of [`Reduced::at`].
    pub(super) fn slope_at(&self, zeta: Complex) -> Slope {
        let (order, zero, one) = (self.order(), Complex::new(0.0, 0.0), Complex::new(1.0, 0.0));
        let (mut row, mut slope) = (vec![zero; order + 1], vec![zero; order + 1]);
        self.first_row(zeta, &mut row);
        slope[0] = one;
        for k in 0..order - 1 {
            let below = self.h.row(k + 1);
            let (head, lead) = (row[k], -below[k]);
            let entry = |j: usize| if j == order { self.b[k + 1] } else { -below[j] };
            if head.norm_sqr() >= lead * lead {
                let factor = if lead == 0.0 { zero } else { lead / head };
                let change = if lead == 0.0 { zero } else { -factor * slope[k] / head };
                for j in k + 1..=order {
                    slope[j] = -change * row[j] - factor * slope[j];
                    row[j] = entry(j) - factor * row[j];
                }
                row[k + 1] += zeta;
                slope[k + 1] += one;
            } else {
                let (factor, change) = (head / lead, slope[k] / lead);
                for j in k + 1..=order {
                    row[j] -= factor * entry(j);
                    slope[j] -= change * entry(j);
                }
                row[k + 1] -= factor * zeta;
                slope[k + 1] -= change * zeta + factor;
            }
        }
        let value = Response { over: row[order] * self.gamma, under: row[order - 1] };
        Slope { value, over: slope[order] * self.gamma, under: slope[order - 1] }
    }
}

impl Response {
    /// L; infinite or NaN at a pole.
    pub(super) fn open(self) -> Complex {
        crate::complex::quotient(self.over, self.under)
    }

    /// T = L/(1 + L), 1 at a pole of L.
    pub(super) fn closed(self) -> Complex {
        crate::complex::quotient(self.over, self.over + self.under)
    }

    /// T less a real number, without the rounding of T: for 1 it is −S, 0 at a pole of L.
    pub(super) fn closed_less(self, centre: f64) -> Complex {
        let sum = self.over + self.under;
        crate::complex::quotient(self.over - sum * centre, sum)
    }
}

impl Slope {
    /// Slope of T over $\zeta$; that of S is its negative.
    pub(super) fn closed(self) -> Complex {
        let Response { over, under } = self.value;
        let sum = over + under;
        let cross = self.over * under - over * self.under;
        crate::complex::quotient(crate::complex::quotient(cross, sum), sum)
    }
}

/// Transposed about the other diagonal, which keeps a Hessenberg matrix one.
fn flip(matrix: &Matrix) -> Matrix {
    let size = matrix.rows();
    Matrix::from_function(size, size, |row, column| matrix.at(size - 1 - column, size - 1 - row))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::complex::modulus;

    /// $1 / (z (z - 1/2)(z - 1))$ with states of very different size, and a dead state that nothing reads.
    fn reduced() -> Reduced {
        let a = Matrix::from_rows(&[
            [0.0, 1e6, 0.0, 0.0],
            [0.0, 0.5, 1e-9, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0, 0.25],
        ])
        .expect("a matrix");
        Reduced::new(&a, &[0.0, 0.0, 1e3, 0.0], &[1.0, 0.0, 0.0, 0.0])
    }

    fn closed_form(zeta: Complex) -> Complex {
        let z = zeta + 1.0;
        crate::complex::reciprocal(z * (z - 0.5) * zeta)
    }

    #[test]
    fn the_response_is_that_of_the_matrices_before_their_reduction() {
        for zeta in [(0.1, 0.2), (-1e-9, 1e-7), (-2.0, 1e-8), (-1.0, 1.0), (3.0, -4.0)] {
            let zeta = Complex::new(zeta.0, zeta.1);
            let (found, expected) = (reduced().at(zeta).open(), closed_form(zeta));
            assert!(modulus(found - expected) < 1e-13 * modulus(expected), "{found} {expected}");
        }
    }

    #[test]
    fn slopes_are_those_of_neighbouring_values() {
        for zeta in [(0.1, 0.2), (-0.3, 0.7), (-1.9, 0.1)] {
            let zeta = Complex::new(zeta.0, zeta.1);
            let step = Complex::new(1e-6, 0.0);
            let [before, after] = [zeta - step, zeta + step].map(|at| reduced().at(at).closed());
            let slope = reduced().slope_at(zeta);
            assert_eq!(slope.value, reduced().at(zeta));
            let expected = (after - before) / (2.0 * step);
            assert!(modulus(slope.closed() - expected) < 1e-8 * modulus(expected), "{zeta}");
        }
    }

    #[test]
    fn at_a_pole_the_closed_loop_follows_and_feels_nothing() {
        let response = reduced().at(Complex::new(0.0, 0.0));
        assert!(modulus(response.closed() - 1.0) < 1e-14);
        assert!(modulus(response.closed_less(1.0)) < 1e-14);
        assert!(!(modulus(response.open()) < 1e14));
    }

    #[test]
    fn long_rows_are_treated_as_short_ones() {
        let order = SHORT + 5;
        let chain = Matrix::from_function(
            order,
            order,
            |row, column| {
                if column == row + 1 { 1.0 } else { 0.0 }
            },
        );
        let (mut b, mut c) = (vec![0.0; order], vec![0.0; order]);
        (b[order - 1], c[0]) = (1.0, 1.0);
        let z = Complex::new(0.6, 0.8);
        let found = Reduced::new(&chain, &b, &c).at(z - 1.0).open();
        let expected = (0..order).fold(Complex::new(1.0, 0.0), |power, _| power * z.conj());
        assert!(modulus(found - expected) < 1e-13, "{found} {expected}");
    }
}

//! Eigenvalues that only have to separate things, in a third of the time of [`eigenvalues`](crate::eigenvalues()).
//!
//! The same iteration with less care: norms without protection from overflow, which balancing makes unnecessary, and a
//! Hessenberg form by elimination. For candidates of frequencies, which are tried anyway, and for poles beside a limit.

use fspid_numeric::matrix::balance;

use crate::complex::Complex;
use crate::eigenvalues::{eigenvalues, two_by_two};
use crate::error::LtiError;
use crate::matrix::Matrix;

/// Steps for one eigenvalue or pair before the careful iteration takes over.
const STEPS_PER_EIGENVALUE: usize = 30;
/// After so many steps without success the shifts are replaced by arbitrary ones.
const EXCEPTIONAL_EVERY: usize = 10;
/// Sweeps of balancing; more change little.
const SWEEPS: usize = 4;

/// All eigenvalues, in no order.
///
/// # Errors
/// As [`eigenvalues`].
pub(super) fn quick_eigenvalues(matrix: &Matrix) -> Result<Vec<Complex>, LtiError> {
    let mut work = Work { h: matrix.data().to_vec(), size: matrix.rows() };
    work.balance();
    work.eliminate();
    match work.iterate() {
        Some(values) if values.iter().all(|value| value.is_finite()) => Ok(values),
        _ => eigenvalues(matrix),
    }
}

/// All eigenvalues of a Hessenberg matrix, in no order; `None` if they do not come.
pub(super) fn hessenberg_eigenvalues(matrix: Matrix) -> Option<Vec<Complex>> {
    let size = matrix.rows();
    let mut work = Work { h: matrix.into_data(), size };
    work.balance();
    let values = work.iterate()?;
    values.iter().all(|value| value.is_finite()).then_some(values)
}

/// Similar matrix with zeros below the first subdiagonal, by elimination with exchange of rows and columns.
///
/// The first row and column take part, but the first unit vector stays what it is. Unlike reflections, which spread the
/// rounding of the largest entries over all, elimination leaves zeros and small entries alone: a fast dead time does
/// not blur a slow mode.
///
/// # Source
/// R. S. Martin, J. H. Wilkinson, Similarity reduction of a general matrix to Hessenberg form, Numer. Math. 12 (1968)
/// 349.
pub(super) fn hessenberg(matrix: &Matrix) -> Matrix {
    let mut work = Work { h: matrix.data().to_vec(), size: matrix.rows() };
    work.eliminate();
    Matrix::from_function(work.size, work.size, |row, column| work.at(row, column))
}

/// A square matrix row after row, being worn down.
struct Work {
    h: Vec<f64>,
    size: usize,
}

impl Work {
    fn at(&self, row: usize, column: usize) -> f64 {
        self.h[row * self.size + column]
    }

    /// Makes rows and columns of similar size by powers of two.
    fn balance(&mut self) {
        balance(self.size, SWEEPS, |i| self.improve(i));
    }

    /// As of the careful iteration, but with sums for norms and without calls of a library: a third of the time.
    fn improve(&mut self, i: usize) -> bool {
        let n = self.size;
        let (mut column, mut row) = (0.0, 0.0);
        for k in (0..n).filter(|&k| k != i) {
            column += self.at(k, i).abs();
            row += self.at(i, k).abs();
        }
        if !(column > 0.0 && row > 0.0) {
            return false;
        }
        let factor = power_of_two(row / column);
        let worthwhile = (column * factor + row / factor) < 0.95 * (column + row);
        if worthwhile {
            for k in 0..n {
                self.h[k * n + i] *= factor;
            }
            for value in &mut self.h[i * n..(i + 1) * n] {
                *value /= factor;
            }
        }
        worthwhile
    }

    /// As [`hessenberg`].
    fn eliminate(&mut self) {
        let n = self.size;
        for column in 0..n.saturating_sub(2) {
            let target = column + 1;
            let mut pivot = target;
            for row in target + 1..n {
                if self.at(row, column).abs() > self.at(pivot, column).abs() {
                    pivot = row;
                }
            }
            let head = self.at(pivot, column);
            if head == 0.0 {
                continue;
            }
            if pivot != target {
                for k in 0..n {
                    self.h.swap(pivot * n + k, target * n + k);
                }
                for k in 0..n {
                    self.h.swap(k * n + pivot, k * n + target);
                }
            }
            for row in target + 1..n {
                let factor = self.at(row, column) / head;
                if factor != 0.0 {
                    self.h[row * n + column] = 0.0;
                    let (above, below) = self.h.split_at_mut(row * n);
                    let source = &above[target * n + column + 1..(target + 1) * n];
                    for (value, source) in below[column + 1..n].iter_mut().zip(source) {
                        *value -= factor * source;
                    }
                    for k in 0..n {
                        self.h[k * n + target] += factor * self.h[k * n + row];
                    }
                }
            }
        }
    }

    /// Splits off eigenvalues from the bottom; `None` if one does not come.
    fn iterate(&mut self) -> Option<Vec<Complex>> {
        let mut values = Vec::with_capacity(self.size);
        let (mut end, mut steps) = (self.size, 0);
        while end > 0 {
            let start = self.start_of_block(end);
            match end - start {
                1 => values.push(Complex::new(self.at(start, start), 0.0)),
                2 => values.extend(two_by_two(
                    self.at(start, start),
                    self.at(start, start + 1),
                    self.at(start + 1, start),
                    self.at(start + 1, start + 1),
                )),
                _ if steps < STEPS_PER_EIGENVALUE => {
                    steps += 1;
                    self.step(start, end, steps.is_multiple_of(EXCEPTIONAL_EVERY));
                    continue;
                }
                _ => return None,
            }
            (end, steps) = (start, 0);
        }
        Some(values)
    }

    fn start_of_block(&self, end: usize) -> usize {
        for row in (1..end).rev() {
            let neighbours = self.at(row, row).abs() + self.at(row - 1, row - 1).abs();
            if self.at(row, row - 1).abs() <= f64::EPSILON * neighbours {
                return row;
            }
        }
        0
    }

    /// One double-shift step on the block of rows `start..end`, which has at least three.
    fn step(&mut self, start: usize, end: usize, exceptional: bool) {
        let mut v = self.first_column(start, end, exceptional);
        for k in start..end - 1 {
            let height = (end - k).min(3);
            if height < 3 {
                v[2] = 0.0;
            }
            let norm = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
            if norm > 0.0 {
                let signed = if v[0] < 0.0 { -norm } else { norm };
                let pivot = v[0] + signed;
                let (second, third, tau) = (v[1] / pivot, v[2] / pivot, pivot / signed);
                if k > start {
                    self.h[k * self.size + k - 1] = -signed;
                    for below in 1..height {
                        self.h[(k + below) * self.size + k - 1] = 0.0;
                    }
                }
                if height == 3 {
                    self.reflect_three(k, (start, end), [second, third, tau]);
                } else {
                    self.reflect_two(k, (start, end), second, tau);
                }
            }
            if k + 2 < end {
                let next = |below: usize| if k + below < end { self.at(k + below, k) } else { 0.0 };
                v = [next(1), next(2), next(3)];
            }
        }
    }

    /// First column of (H − s₁ I)(H − s₂ I), scaled.
    fn first_column(&self, start: usize, end: usize, exceptional: bool) -> [f64; 3] {
        let last = end - 1;
        let (mut x, mut y) = (self.at(last - 1, last - 1), self.at(last, last));
        let mut w = self.at(last, last - 1) * self.at(last - 1, last);
        if exceptional {
            let size = self.at(last, last - 1).abs() + self.at(last - 1, last - 2).abs();
            x = 0.75 * size + y;
            y = x;
            w = -0.4375 * size * size;
        }
        let (corner, below) = (self.at(start, start), self.at(start + 1, start));
        let (x, y) = (x - corner, y - corner);
        let v = [
            (x * y - w) / below + self.at(start, start + 1),
            self.at(start + 1, start + 1) - corner - x - y,
            self.at(start + 2, start + 1),
        ];
        let size = v[0].abs() + v[1].abs() + v[2].abs();
        if size > 0.0 { v.map(|value| value / size) } else { v }
    }

    /// I − τ v vᵀ with v = (1, second, third) from both sides.
    fn reflect_three(&mut self, k: usize, (start, end): (usize, usize), v: [f64; 3]) {
        let (n, [second, third, tau]) = (self.size, v);
        let (_, rest) = self.h.split_at_mut(k * n);
        let (first_row, rest) = rest.split_at_mut(n);
        let (second_row, third_row) = rest.split_at_mut(n);
        let rows = first_row[k..end].iter_mut().zip(&mut second_row[k..end]);
        for ((a, b), c) in rows.zip(&mut third_row[k..end]) {
            let dot = tau * (*a + second * *b + third * *c);
            *a -= dot;
            *b -= dot * second;
            *c -= dot * third;
        }
        for row in start..end.min(k + 4) {
            if let [a, b, c] = &mut self.h[row * n + k..row * n + k + 3] {
                let dot = tau * (*a + second * *b + third * *c);
                *a -= dot;
                *b -= dot * second;
                *c -= dot * third;
            }
        }
    }

    /// The same for the last two rows.
    fn reflect_two(&mut self, k: usize, (start, end): (usize, usize), second: f64, tau: f64) {
        let n = self.size;
        for column in k..end {
            let (a, b) = (self.at(k, column), self.at(k + 1, column));
            let dot = tau * (a + second * b);
            self.h[k * n + column] = a - dot;
            self.h[(k + 1) * n + column] = b - dot * second;
        }
        for row in start..end {
            let (a, b) = (self.at(row, k), self.at(row, k + 1));
            let dot = tau * (a + second * b);
            self.h[row * n + k] = a - dot;
            self.h[row * n + k + 1] = b - dot * second;
        }
    }
}

/// The power of two nearest to the root of a positive number, within a factor of two.
fn power_of_two(ratio: f64) -> f64 {
    // The exponent's bits, halved; without a library call.
    let exponent = ((ratio.to_bits() >> 52) & 0x7ff) as i64 - 1023;
    f64::from_bits(((exponent.div_euclid(2) + 1023) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::complex::{modulus, sort};

    /// Random entries by a short recurrence; matrices of Hamiltonian size, scaled unevenly.
    fn matrix(size: usize, seed: u64) -> Matrix {
        let mut state = seed;
        let mut next = move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / 9_007_199_254_740_992.0 - 0.5
        };
        let entries: Vec<f64> = (0..size * size).map(|_| next()).collect();
        Matrix::from_function(size, size, |row, column| {
            libm::scalbn(
                entries[row * size + column],
                (row % 5) as i32 * 3 - (column % 5) as i32 * 3,
            )
        })
    }

    #[test]
    fn quick_eigenvalues_are_those_of_the_careful_iteration() {
        for size in 1..24 {
            for seed in 0..8 {
                let matrix = matrix(size, 31 * seed + size as u64);
                let mut quick = quick_eigenvalues(&matrix).expect("converges");
                let careful = eigenvalues(&matrix).expect("converges");
                sort(&mut quick);
                for (quick, careful) in quick.iter().zip(&careful) {
                    let off = modulus(quick - careful);
                    assert!(off < 1e-10 * matrix.norm_one(), "{size} {seed}: {quick} {careful}");
                }
            }
        }
    }

    #[test]
    fn matrices_without_rows_or_with_zeros_only_are_no_trouble() {
        assert_eq!(quick_eigenvalues(&Matrix::zeros(0, 0)), Ok(vec![]));
        assert_eq!(quick_eigenvalues(&Matrix::zeros(4, 4)), Ok(vec![Complex::new(0.0, 0.0); 4]));
    }
}

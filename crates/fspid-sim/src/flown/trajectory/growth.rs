//! Growth of small perturbations over a flight: in a norm in which the loop at rest contracts.

use core::convert::Infallible;

use fspid_lti::{LtiError, Matrix, eigenvalues, spectral_radius};
use fspid_numeric::matrix::{cholesky, identity};

use super::SmallSignal;

/// Places of the flight, evenly spread, from which growth is followed.
const STARTS: usize = 16;
/// How often growth is looked at from each of them.
const LOOKS: usize = 200;
/// Most samples that a kick of the command is followed for the sizes of the states.
const KICK_SAMPLES: usize = 10_000;
/// A kicked state beyond this is on its way to overflow.
const LARGEST: f64 = 1e6;
/// A loop at rest whose radius is closer to 1 than this is measured as if it were smaller.
const NEAR_ONE: f64 = 1e-6;
/// By so much.
const ROOM: f64 = 1e-4;
/// Doublings of the sum that makes the norm: 2^40 samples.
const DOUBLINGS: usize = 40;

/// Growth of a small disturbance of the loop's state along a flight.
///
/// It is counted in a norm in which the loop at rest shrinks from sample to sample (one at rest that
/// is not stable grows by its radius), so that a growth above 1 is what gains that move, limits and
/// changes of the plant make of it:
///
/// $$ \lVert z \rVert^2 = z^T P z, \qquad
/// P = \sum_k (M^T)^k Q M^k, \quad Q = \operatorname{diag}(1 / s_i^2) $$
///
/// with M at the gains of rest and $s_i$ the largest value of a state after a kick of the command there.
/// The growth from one sample to another is the largest that any small disturbance of the loop can have,
/// $\lVert J \cdots J \rVert_P$. What it does to gains that accumulate comes back into the loop, but
/// gains are neither disturbed nor measured. The first sample, which has no last one, is left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growth {
    /// Largest growth from any of 16 starts to any of 200 later samples, both evenly spread over the
    /// flight; infinite where it overflows.
    pub largest: f64,
    /// From when, s.
    pub from_s: f64,
    /// Till when, s.
    pub to_s: f64,
    /// Growth over the whole flight.
    pub whole: f64,
    /// Exponent of the growth over the whole flight, $\ln(\text{whole}) / t$, 1/s: negative for what
    /// dies out.
    pub exponent_1_s: f64,
}

/// A product of matrices, kept within range.
struct Product {
    from_s: f64,
    rows: Vec<Vec<f64>>,
    /// Logarithm of what the rows are to be multiplied with.
    log: f64,
}

/// Follows growth along a flight.
pub(super) struct Follower {
    rows: usize,
    dt_s: f64,
    norm: Option<Norm>,
    products: Vec<Product>,
    /// Logarithm of the largest growth, from and till when.
    largest: (f64, f64, f64),
    whole_log: f64,
    seen_s: f64,
}

impl Follower {
    /// For a flight of so many rows.
    pub(super) fn new(rows: usize, dt_s: f64) -> Self {
        Self {
            rows,
            dt_s,
            norm: None,
            products: Vec::new(),
            largest: (f64::NEG_INFINITY, 0.0, 0.0),
            whole_log: 0.0,
            seen_s: 0.0,
        }
    }

    /// Takes in a sample of a loop that at rest is `rest`.
    pub(super) fn add(&mut self, small: &SmallSignal, rest: &[Vec<f64>]) -> Result<(), LtiError> {
        if small.k == 0 {
            return Ok(());
        }
        let norm = match self.norm.take() {
            Some(norm) => norm,
            None => Norm::of(small, rest)?,
        };
        // The first of the samples that fall into one of so many parts of the flight.
        let begins = |parts: usize| {
            let part = |k: usize| k * parts / self.rows;
            small.k == 1 || part(small.k) != part(small.k - 1)
        };
        if begins(STARTS) {
            self.products.push(Product::identity(small.matrix.len(), small.time_s));
        }
        let looks = begins(LOOKS) || small.k + 1 == self.rows;
        let end_s = small.time_s + self.dt_s;
        for (number, product) in self.products.iter_mut().enumerate() {
            product.multiply(&small.matrix);
            if !looks {
                continue;
            }
            let log = norm.of_product(product)?;
            if log > self.largest.0 {
                self.largest = (log, product.from_s, end_s);
            }
            if number == 0 {
                (self.whole_log, self.seen_s) = (log, end_s);
            }
        }
        self.norm = Some(norm);
        Ok(())
    }

    /// What was seen.
    pub(super) fn growth(&self) -> Growth {
        let (log, from_s, to_s) = self.largest;
        Growth {
            largest: libm::exp(log),
            from_s,
            to_s,
            whole: libm::exp(self.whole_log),
            exponent_1_s: self.whole_log / (self.seen_s - self.dt_s),
        }
    }
}

impl Product {
    fn identity(size: usize, from_s: f64) -> Self {
        let entries: Vec<f64> = identity(size).collect();
        Self { from_s, rows: entries.chunks(size.max(1)).map(<[f64]>::to_vec).collect(), log: 0.0 }
    }

    fn multiply(&mut self, matrix: &[Vec<f64>]) {
        self.rows = product(matrix, &self.rows);
        let largest = self.rows.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
        // Powers of two, so that nothing is rounded.
        let (_, exponent) = libm::frexp(largest);
        if exponent.abs() > 100 && largest > 0.0 {
            for entry in self.rows.iter_mut().flatten() {
                *entry = libm::scalbn(*entry, -exponent);
            }
            self.log += f64::from(exponent) * std::f64::consts::LN_2;
        }
    }
}

/// $\lVert z \rVert = |R z|$ with $P = R^T R$.
struct Norm {
    root: Vec<Vec<f64>>,
    inverse: Matrix,
}

impl Norm {
    fn of(small: &SmallSignal, rest: &[Vec<f64>]) -> Result<Self, LtiError> {
        let scale = scale(&small.by_command, rest);
        let radius = spectral_radius(&Matrix::from_rows(rest)?)?;
        let shrink = if radius < 1.0 - NEAR_ONE { 1.0 } else { 1.0 / (radius * (1.0 + ROOM)) };
        // In states that are counted in their own sizes.
        let mut power: Vec<Vec<f64>> = rest.to_vec();
        for (row, own) in power.iter_mut().zip(&scale) {
            for (entry, other) in row.iter_mut().zip(&scale) {
                *entry *= shrink * other / own;
            }
        }
        let mut gram = Product::identity(rest.len(), 0.0).rows;
        for _ in 0..DOUBLINGS {
            let more = product(&transposed(&power), &product(&gram, &power));
            for (entry, more) in gram.iter_mut().flatten().zip(more.iter().flatten()) {
                *entry += more;
            }
            power = product(&power, &power);
        }
        let mut root = root_of(&gram);
        for row in &mut root {
            for (entry, size) in row.iter_mut().zip(&scale) {
                *entry /= size;
            }
        }
        // The last command, where it is a state, counts as it is.
        let all = small.frozen.len();
        root.iter_mut().for_each(|row| row.resize(all, 0.0));
        root.extend(Product::identity(all, 0.0).rows.into_iter().skip(rest.len()));
        let inverse = Matrix::from_rows(&root)?.solve(&Matrix::identity(all))?;
        Ok(Self { root, inverse })
    }

    /// Logarithm of $\lVert R \Phi R^{-1} \rVert_2$.
    fn of_product(&self, product: &Product) -> Result<f64, LtiError> {
        let all = self.root.len();
        let loops: Vec<&[f64]> = product.rows.iter().take(all).map(|row| &row[..all]).collect();
        let left = Matrix::from_rows(&self.root)?.product(&Matrix::from_rows(&loops)?)?;
        let inside = left.product(&self.inverse)?;
        let square = inside.transpose().product(&inside)?;
        let largest = eigenvalues(&square)?.iter().map(|value| value.re).fold(0.0, f64::max);
        Ok(0.5 * libm::log(largest) + product.log)
    }
}

/// Largest value of each state after a kick of the command.
fn scale(by_command: &[f64], rest: &[Vec<f64>]) -> Vec<f64> {
    let mut state = by_command[..rest.len()].to_vec();
    let mut largest = vec![0.0_f64; rest.len()];
    for _ in 0..KICK_SAMPLES {
        for (most, value) in largest.iter_mut().zip(&state) {
            *most = most.max(value.abs());
        }
        if !largest.iter().all(|most| *most < LARGEST) {
            break;
        }
        let next = |row: &Vec<f64>| row.iter().zip(&state).map(|(a, x)| a * x).sum();
        state = rest.iter().map(next).collect();
    }
    // What does not move at all counts as it is.
    largest.into_iter().map(|most| if most > 0.0 { most } else { 1.0 }).collect()
}

fn product(left: &[Vec<f64>], right: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let width = right.first().map_or(0, Vec::len);
    let row = |left: &Vec<f64>| {
        let mut sums = vec![0.0; width];
        for (factor, right) in left.iter().zip(right) {
            if *factor != 0.0 {
                for (sum, entry) in sums.iter_mut().zip(right) {
                    *sum += factor * entry;
                }
            }
        }
        sums
    };
    left.iter().map(row).collect()
}

fn transposed(matrix: &[Vec<f64>]) -> Vec<Vec<f64>> {
    (0..matrix.len()).map(|column| matrix.iter().map(|row| row[column]).collect()).collect()
}

/// Upper triangle R with $R^T R$ a positive definite matrix, by Cholesky.
fn root_of(gram: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let size = gram.len();
    let mut lower = vec![0.0; size * size];
    let upper_half = |row: usize, column: usize| gram[column][row];
    let Ok(()) = cholesky(&mut lower, size, upper_half, |entry| {
        let rest = entry.rest();
        // The identity is part of the sum: nothing on the diagonal is below 1 but for rounding.
        let on_diagonal = || rest.max(f64::EPSILON).sqrt();
        Ok::<_, Infallible>(entry.diagonal.map_or_else(on_diagonal, |diagonal| rest / diagonal))
    });
    (0..size).map(|row| (0..size).map(|column| lower[column * size + row]).collect()).collect()
}

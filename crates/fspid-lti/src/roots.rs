//! All roots of a real polynomial at once, by the iteration of Aberth and Ehrlich.
//!
//! Not by the eigenvalues of the companion matrix: those lose the small roots of polynomials whose roots lie decades
//! apart. Two passes: plain arithmetic until the residual is rounding noise, then residuals of twice the precision.

use core::f64::consts::TAU;

use crate::complex::{Complex, modulus, quotient, reciprocal, sort};
use crate::doubled::DoubledComplex;
use crate::error::LtiError;

/// Sweeps over all roots before the plain pass gives up; degree 100 needs some dozens.
const PLAIN_SWEEPS: usize = 500;
/// Sweeps of the refinement. Simple roots need two or three; multiple ones gain about a bit per sweep.
const REFINING_SWEEPS: usize = 60;
/// Binary exponent that the largest coefficient is scaled to: room above for sums, below for small coefficients.
const EXPONENT: i32 = 400;
/// Turns the starting points out of the symmetry about the real axis, which the iteration could never leave.
const FIRST_ANGLE_RAD: f64 = 0.7;
/// Relative size of a step after which a root has settled: the next one would be lost in rounding.
const LAST_STEP: f64 = 4.0 * f64::EPSILON;
/// Rounding of one term of a residual in twice the working precision, with room for the error bounds.
const DOUBLED_EPSILON: f64 = 1e-31;

const WHAT: &str = "root of the polynomial";

/// Roots for coefficients from the highest power down, of which the first is not zero and all are finite.
pub(crate) fn roots(coefficients: &[f64]) -> Result<Vec<Complex>, LtiError> {
    let at_origin = coefficients.iter().rev().take_while(|&&value| value == 0.0).count();
    let polynomial = TwoSided::new(&coefficients[..coefficients.len() - at_origin])?;
    let mut roots = starting_points(&polynomial.inner)?;
    if !polynomial.iterate(&mut roots, horner, PLAIN_SWEEPS) {
        return Err(LtiError::NotConverged { what: WHAT, iterations: PLAIN_SWEEPS });
    }
    // Whatever the refinement reaches within its sweeps is at least as good, so its verdict does not matter.
    polynomial.iterate(&mut roots, horner_doubled, REFINING_SWEEPS);
    let mut roots: Vec<Complex> =
        conjugated(roots).into_iter().map(|root| polynomial.restored(root)).collect();
    if !roots.iter().all(|root| modulus(*root).is_normal()) {
        return Err(LtiError::OutOfRange { what: WHAT });
    }
    roots.extend(core::iter::repeat_n(Complex::new(0.0, 0.0), at_origin));
    sort(&mut roots);
    Ok(roots)
}

/// A polynomial and its reversal, so that no power of a number above 1 is ever formed.
///
/// The variable is in units of a power of two near the geometric mean of the roots, so first and last coefficient
/// are of similar size; all scaling is exact.
struct TwoSided {
    /// Binary exponent of the unit of the variable.
    unit: i32,
    /// Highest power first: for points in the unit disk.
    inner: Vec<f64>,
    /// Lowest power first: for the reciprocals of points outside.
    outer: Vec<f64>,
}

/// A polynomial and its derivative at one point.
struct Value {
    value: Complex,
    derivative: Complex,
    /// Bound for the rounding error of the value: below it, it cannot be told from zero.
    noise: f64,
}

type Evaluate = fn(&[f64], Complex) -> Value;

impl TwoSided {
    fn new(coefficients: &[f64]) -> Result<Self, LtiError> {
        let degree = coefficients.len() as i32 - 1;
        let exponent = |i: usize| libm::frexp(coefficients[i]).1;
        let unit = if degree == 0 { 0 } else { (exponent(degree as usize) - exponent(0)) / degree };
        let terms = || (0_i32..).zip(coefficients).filter(|(_, value)| **value != 0.0);
        let largest = terms().map(|(i, value)| libm::frexp(*value).1 - i * unit).max().unwrap_or(0);
        let scaled = |(i, &value)| libm::scalbn(value, EXPONENT - largest - i * unit);
        let inner: Vec<f64> = (0..).zip(coefficients).map(scaled).collect();
        if !(inner[0].is_normal() && inner[degree as usize].is_normal()) {
            return Err(LtiError::OutOfRange { what: WHAT });
        }
        let outer = inner.iter().rev().copied().collect();
        Ok(Self { unit, inner, outer })
    }

    /// Root in the units of the coefficients as given.
    fn restored(&self, root: Complex) -> Complex {
        Complex::new(libm::scalbn(root.re, self.unit), libm::scalbn(root.im, self.unit))
    }

    /// Improves all roots in turn; true when each has settled within the sweeps.
    fn iterate(&self, roots: &mut [Complex], evaluate: Evaluate, sweeps: usize) -> bool {
        let mut settled = vec![false; roots.len()];
        for _ in 0..sweeps {
            for (i, settled) in settled.iter_mut().enumerate() {
                *settled = *settled || self.improve(roots, i, evaluate);
            }
            if settled.iter().all(|&settled| settled) {
                return true;
            }
        }
        roots.is_empty()
    }

    /// One step of Aberth for root `i`; true when it need not be moved any more.
    ///
    /// $$ z_i \leftarrow z_i - \left[ \frac{p'(z_i)}{p(z_i)} - \sum_{j \neq i} \frac{1}{z_i - z_j} \right]^{-1} $$
    fn improve(&self, roots: &mut [Complex], i: usize, evaluate: Evaluate) -> bool {
        let Some(slope) = self.logarithmic_derivative(roots[i], evaluate) else {
            return true;
        };
        let step = reciprocal(slope - repulsion(roots, i));
        if step.is_finite() {
            roots[i] -= step;
        } else {
            // The two terms cancelled: leave the stationary point by an arbitrary small turn.
            roots[i] *= Complex::new(0.99, 0.02);
        }
        modulus(step) <= LAST_STEP * modulus(roots[i])
    }

    /// p'(z) / p(z); `None` where p(z) cannot be told from zero.
    ///
    /// Outside the unit disk, with w = 1/z and the reversed polynomial r of degree n: w (n - w r'(w) / r(w)).
    fn logarithmic_derivative(&self, z: Complex, evaluate: Evaluate) -> Option<Complex> {
        if modulus(z) <= 1.0 {
            return evaluate(&self.inner, z).logarithmic_derivative();
        }
        let degree = (self.inner.len() - 1) as f64;
        let w = reciprocal(z);
        let slope = evaluate(&self.outer, w).logarithmic_derivative()?;
        Some(w * (Complex::new(degree, 0.0) - w * slope))
    }
}

impl Value {
    fn logarithmic_derivative(&self) -> Option<Complex> {
        (modulus(self.value) > self.noise).then(|| quotient(self.derivative, self.value))
    }
}

fn repulsion(roots: &[Complex], i: usize) -> Complex {
    let others = roots.iter().enumerate().filter(|&(j, other)| j != i && *other != roots[i]);
    others.fold(Complex::new(0.0, 0.0), |sum, (_, &other)| sum + reciprocal(roots[i] - other))
}

/// Horner's rule in working precision.
fn horner(coefficients: &[f64], z: Complex) -> Value {
    let mut value = Complex::new(0.0, 0.0);
    let mut derivative = value;
    for &coefficient in coefficients {
        derivative = derivative * z + value;
        value = value * z + coefficient;
    }
    let noise = f64::EPSILON * rounding(coefficients, z);
    Value { value, derivative, noise }
}

/// Horner's rule in twice the working precision, rounded at the end.
fn horner_doubled(coefficients: &[f64], z: Complex) -> Value {
    let mut value = DoubledComplex::ZERO;
    let mut derivative = value;
    for &coefficient in coefficients {
        derivative = derivative.times(z).plus(value);
        value = value.times(z).plus_real(coefficient);
    }
    let noise = DOUBLED_EPSILON * rounding(coefficients, z);
    Value { value: value.rounded(), derivative: derivative.rounded(), noise }
}

/// Bound for the rounding error of Horner's rule in a complex point, as a multiple of the working precision.
///
/// # Source
/// N. J. Higham, Accuracy and Stability of Numerical Algorithms, 2nd edition, section 5.1, with 2 sqrt(2) for complex
/// products.
fn rounding(coefficients: &[f64], z: Complex) -> f64 {
    let size = modulus(z);
    let sum = coefficients.iter().fold(0.0, |sum, coefficient| sum * size + coefficient.abs());
    3.0 * coefficients.len() as f64 * sum
}

/// One starting point per root, on circles whose radii follow from the upper hull of ln |coefficient| over power.
fn starting_points(coefficients: &[f64]) -> Result<Vec<Complex>, LtiError> {
    let degree = coefficients.len() - 1;
    let mut points = Vec::with_capacity(degree);
    for edge in newton_polygon(coefficients).windows(2) {
        let (Corner { power, log2: low }, next) = (edge[0], edge[1]);
        let count = next.power - power;
        let radius = libm::exp2((low - next.log2) / count as f64);
        if !radius.is_normal() {
            return Err(LtiError::OutOfRange { what: WHAT });
        }
        for i in 0..count {
            let turns = i as f64 / count as f64 + power as f64 / degree as f64;
            let angle_rad = TAU * turns + FIRST_ANGLE_RAD;
            points.push(Complex::new(radius * libm::cos(angle_rad), radius * libm::sin(angle_rad)));
        }
    }
    Ok(points)
}

/// A term of a polynomial.
#[derive(Clone, Copy)]
struct Corner {
    power: usize,
    /// Of the coefficient's magnitude.
    log2: f64,
}

/// Corners of the upper convex hull, by rising power.
fn newton_polygon(coefficients: &[f64]) -> Vec<Corner> {
    let mut hull: Vec<Corner> = Vec::new();
    let terms = coefficients.iter().rev().enumerate().filter(|(_, value)| **value != 0.0);
    for point in terms.map(|(power, value)| Corner { power, log2: libm::log2(value.abs()) }) {
        while hull.len() >= 2 && !turns_down(hull[hull.len() - 2], hull[hull.len() - 1], point) {
            hull.pop();
        }
        hull.push(point);
    }
    hull
}

fn turns_down(first: Corner, middle: Corner, last: Corner) -> bool {
    let before = (middle.log2 - first.log2) * (last.power - middle.power) as f64;
    before > (last.log2 - middle.log2) * (middle.power - first.power) as f64
}

/// Makes real what is its own mirror image and exactly conjugate what has a partner.
///
/// From the largest imaginary part down: a root is paired when another one is nearer to its conjugate than itself.
fn conjugated(mut rest: Vec<Complex>) -> Vec<Complex> {
    let mut done = Vec::with_capacity(rest.len());
    rest.sort_by(|left, right| right.im.abs().total_cmp(&left.im.abs()));
    while !rest.is_empty() {
        let root = rest.remove(0);
        match mirror_image(root, &rest) {
            Some(j) => {
                let partner = rest.remove(j);
                let (re, im) =
                    (0.5 * (root.re + partner.re), 0.5 * (root.im.abs() + partner.im.abs()));
                done.extend([Complex::new(re, -im), Complex::new(re, im)]);
            }
            None => done.push(Complex::new(root.re, 0.0)),
        }
    }
    done
}

fn mirror_image(root: Complex, others: &[Complex]) -> Option<usize> {
    let mut best = (None, 2.0 * root.im.abs());
    for (j, &other) in others.iter().enumerate() {
        let distance = modulus(other - root.conj());
        if distance < best.1 {
            best = (Some(j), distance);
        }
    }
    best.0
}

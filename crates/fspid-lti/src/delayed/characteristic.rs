//! The characteristic function of a loop with dead times, with bounds of all that is rounded.

use super::DelayedPath;
use crate::balance::balance;
use crate::ball::Ball;
use crate::complex::{Complex, modulus};
use crate::doubled::Doubled;
use crate::error::LtiError;
use crate::matrix::Matrix;

/// Rounding of one step of a sum of complex products, with room.
const STEP: f64 = 8.0 * f64::EPSILON;

/// A polynomial in $\zeta = z - 1$, lowest power first, and how far each coefficient may be off.
///
/// In $\zeta$ slow modes of a loop that is sampled fast keep their digits.
#[derive(Clone, Debug)]
struct Proved {
    values: Vec<f64>,
    radii: Vec<f64>,
}

/// F, by its parts.
#[derive(Clone, Debug)]
pub(super) struct Characteristic {
    under: Proved,
    /// What each dead time multiplies, by its samples.
    over: Vec<(usize, Proved)>,
}

/// A polynomial around a place: its value, and how far values within a distance may be from it.
struct Around {
    value: Complex,
    spread: f64,
}

/// F at the middle of an arc, and how far F on the arc may be from what was computed there.
pub(super) struct OnArc {
    pub(super) value: Complex,
    pub(super) spread: f64,
}

impl Proved {
    fn new(balls: &[Ball]) -> Self {
        Self {
            values: balls.iter().map(|ball| ball.rounded()).collect(),
            radii: balls.iter().map(|ball| ball.radius()).collect(),
        }
    }

    /// Around a place, within a distance: Taylor's coefficients by repeated synthetic division.
    fn around(&self, zeta: Complex, distance: f64, shifted: &mut Vec<Complex>) -> Around {
        shifted.clear();
        shifted.extend(self.values.iter().map(|&value| Complex::new(value, 0.0)));
        let count = shifted.len();
        for from in 0..count {
            for place in (from..count - 1).rev() {
                let carried = shifted[place + 1] * zeta;
                shifted[place] += carried;
            }
        }
        let higher = shifted.iter().skip(1).rev();
        let moved = higher.fold(0.0, |sum, term| (sum + modulus(*term)) * distance);
        let reach = modulus(zeta) + distance;
        let rounded = STEP * (count as f64 + 2.0);
        let pairs = self.values.iter().zip(&self.radii).rev();
        let lost = pairs.fold(0.0, |sum, (value, radius)| {
            sum * reach + value.abs() * rounded + radius * (1.0 + rounded)
        });
        let value = shifted.first().copied().unwrap_or_default();
        Around { value, spread: (moved + lost) * (1.0 + rounded) }
    }

    /// Value and slope, as they are computed.
    fn slope(&self, zeta: Complex) -> [Complex; 2] {
        let zero = Complex::new(0.0, 0.0);
        self.values.iter().rev().fold([zero, zero], |[value, slope], &coefficient| {
            [value * zeta + coefficient, slope * zeta + value]
        })
    }
}

impl Characteristic {
    /// Of matrices whose shapes agree, by the method of Faddeev and Leverrier in numbers of 106 bits with bounds.
    ///
    /// $$ M_1 = I, \quad d_{m-k} = -\frac{\operatorname{tr} (E M_k)}{k}, \quad M_{k+1} = E M_k + d_{m-k} I, \quad
    /// \operatorname{adj}(\zeta I - E) = \sum_k M_k \zeta^{m-k}, \quad E = A - I $$
    ///
    /// # Source
    /// D. K. Faddeev, V. N. Faddeeva, Computational Methods of Linear Algebra, Freeman 1963, section 47.
    pub(super) fn new(a: &Matrix, b: &[f64], paths: &[DelayedPath]) -> Result<Self, LtiError> {
        let order = a.rows();
        let Balanced { change, input, rows } = Balanced::of(a, b, paths);
        let mut power = vec![Ball::ZERO; order * order];
        for place in 0..order {
            power[place * order + place] = Ball::from(1.0);
        }
        let mut under = vec![Ball::from(1.0)];
        let mut over = vec![Vec::new(); paths.len()];
        for k in 1..=order {
            let answered = product(&power, &input);
            for (over, row) in over.iter_mut().zip(&rows) {
                over.push(dot(row, answered.iter()));
            }
            power = multiplied(&change, &power, order);
            let trace = (0..order).map(|place| power[place * order + place]);
            let trace = trace.fold(Ball::ZERO, Ball::plus).negative();
            let Some(coefficient) = trace.over(Ball::from(k as f64)) else { break };
            under.push(coefficient);
            for place in 0..order {
                let entry = &mut power[place * order + place];
                *entry = entry.plus(coefficient);
            }
        }
        let proved = |balls: &mut Vec<Ball>| {
            balls.reverse();
            Proved::new(balls)
        };
        let under = proved(&mut under);
        let over = paths.iter().zip(&mut over).map(|(path, it)| (path.samples, proved(it)));
        let found = Self { under, over: over.collect() };
        for proved in found.over.iter().map(|(_, it)| it).chain([&found.under]) {
            LtiError::unless_finite("characteristic polynomial", &proved.values)?;
            LtiError::unless_finite("characteristic polynomial", &proved.radii)?;
        }
        Ok(found)
    }

    /// Number of poles of F outside every circle that holds those inside: its power of z at infinity.
    pub(super) fn order(&self) -> usize {
        self.under.values.len() - 1
    }

    /// Longest dead time, samples.
    pub(super) fn samples(&self) -> usize {
        self.over.iter().map(|(samples, _)| *samples).max().unwrap_or(0)
    }

    /// F around $\rho e^{j \theta}$, for angles within a half width.
    ///
    /// On an arc $z^{-n}$ keeps its size and turns by n times the angle, so that it moves what it multiplies by at most
    /// that, and never by more than twice its size.
    pub(super) fn on_arc(
        &self,
        (radius, angle_rad): (f64, f64),
        half_rad: f64,
        shifted: &mut Vec<Complex>,
    ) -> OnArc {
        let (sin, cos) = libm::sincos(0.5 * angle_rad);
        let unit = Complex::new(-2.0 * sin * sin, 2.0 * sin * cos);
        let zeta = unit * radius + (radius - 1.0);
        // Rounding of the place itself is a distance, too.
        let distance = half_rad * radius + STEP * (modulus(unit) * radius + (radius - 1.0).abs());
        let Around { mut value, mut spread } = self.under.around(zeta, distance, shifted);
        for (samples, over) in &self.over {
            let at = over.around(zeta, distance, shifted);
            let samples = *samples as f64;
            let turn_rad = samples * angle_rad;
            let size = libm::pow(radius, -samples);
            let (sin, cos) = libm::sincos(turn_rad);
            let turned = (samples * half_rad).min(2.0);
            let rounded = STEP * (turn_rad.abs() + samples + 2.0);
            value -= at.value * Complex::new(size * cos, -size * sin);
            spread += size * (at.spread + modulus(at.value) * (turned + rounded));
        }
        OnArc { value, spread: spread + STEP * modulus(value) }
    }

    /// One step of Newton's method towards a zero of F from a place; it promises nothing.
    pub(super) fn nearer(&self, z: Complex) -> Complex {
        let zeta = z - 1.0;
        let [mut value, mut slope] = self.under.slope(zeta);
        for (samples, over) in &self.over {
            let [over, over_slope] = over.slope(zeta);
            let samples = *samples as f64;
            let (size, turn_rad) = (modulus(z), libm::atan2(z.im, z.re) * samples);
            let (sin, cos) = libm::sincos(turn_rad);
            let power = Complex::new(cos, -sin) * libm::pow(size, -samples);
            value -= power * over;
            slope -= power * (over_slope - over * samples / z);
        }
        z - crate::complex::quotient(value, slope)
    }
}

/// The loop in units in which its numbers are of similar size, without rounding.
struct Balanced {
    /// $A - I$, row after row.
    change: Vec<Ball>,
    input: Vec<Ball>,
    rows: Vec<Vec<Ball>>,
}

impl Balanced {
    fn of(a: &Matrix, b: &[f64], paths: &[DelayedPath]) -> Self {
        let order = a.rows();
        let largest = |column: usize| {
            paths.iter().fold(0.0, |size, path| f64::max(size, path.row[column].abs()))
        };
        let mut bordered = Matrix::from_function(order + 1, order + 1, |row, column| {
            match (row < order, column < order) {
                (true, true) if row == column => a.at(row, column) - 1.0,
                (true, true) => a.at(row, column),
                (true, false) => b[row],
                (false, true) => largest(column),
                (false, false) => 0.0,
            }
        });
        let exponents = balance(&mut bordered);
        let by = |row: usize, column: usize| exponents[column] - exponents[row];
        let entry = |row: usize, column: usize| {
            let one = if row == column { -1.0 } else { 0.0 };
            let ball = Ball::new(Doubled::exact_sum(a.at(row, column), one), 0.0);
            ball.scaled(by(row, column))
        };
        let places = (0..order).flat_map(|row| (0..order).map(move |column| (row, column)));
        let row = |path: &DelayedPath| {
            let entries = path.row.iter().enumerate();
            entries.map(|(column, &value)| Ball::from(value).scaled(by(order, column))).collect()
        };
        Self {
            change: places.map(|(row, column)| entry(row, column)).collect(),
            input: (0..order).map(|row| Ball::from(b[row]).scaled(by(row, order))).collect(),
            rows: paths.iter().map(row).collect(),
        }
    }
}

fn dot<'a>(row: &[Ball], column: impl Iterator<Item = &'a Ball>) -> Ball {
    let terms = row.iter().zip(column).filter(|(left, right)| !left.is_zero() && !right.is_zero());
    terms.fold(Ball::ZERO, |sum, (left, right)| sum.plus(left.times(*right)))
}

fn product(matrix: &[Ball], column: &[Ball]) -> Vec<Ball> {
    matrix.chunks_exact(column.len()).map(|row| dot(row, column.iter())).collect()
}

fn multiplied(left: &[Ball], right: &[Ball], order: usize) -> Vec<Ball> {
    let rows = left.chunks_exact(order);
    let entries = rows.flat_map(|row| {
        (0..order).map(move |column| dot(row, right[column..].iter().step_by(order)))
    });
    entries.collect()
}

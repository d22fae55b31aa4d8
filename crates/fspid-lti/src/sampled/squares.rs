//! Gain and phase crossover frequencies of a sampled loop as eigenvalue problems of the loop's own order.

use super::quick::quick_eigenvalues;
use super::reduced::Reduced;
use crate::complex::{Complex, modulus, quotient, reciprocal};
use crate::error::LtiError;
use crate::matrix::Matrix;

/// Places on the real axis are looked for between these, in units of $\tan (\omega T / 2)$.
const BAND: (f64, f64) = (1e-9, 10.0);
/// A pole is far enough from the unit circle if its distance in the z plane is about this.
const CLEAR: f64 = 1e-3;
/// Steps from the size that is asked for to places that may be farther from all poles.
const STEPS: [f64; 8] = [1.0, 1.7, 0.6, 2.6, 0.37, 4.1, 0.23, 7.3];

/// $T_f = L / (1 + f L)$ with f of 1 or −1, split into its even and odd part.
///
/// In $s = (z - 1)/(z + 1) = j \tan (\omega T/2)$ the even part is the real one on the unit circle, and the odd part j
/// times the imaginary one. $|L| = 1$ where $\operatorname{Re} T_f = f/2$, and L is real where $\operatorname{Im} T_f = 0$.
/// Both parts are functions of $w = s^2$, of the order of the loop, and their zeros eigenvalues in $p = 1/(w - s_0^2)$.
/// With $E = A - f b c - I$:
///
/// $$ N = ((1 - s_0) E - 2 s_0 I)((1 + s_0) E + 2 s_0 I), \quad K = N^{-1} (2 I + E), \quad M = K (2 I + E) $$
///
/// $$ p \in \operatorname{eig}\left(M - \frac{K b c K}{c N^{-1} b}\right) \iff \operatorname{Im} T_f = 0, \quad
/// p \in \operatorname{eig}\left(M + \frac{2 K b c N^{-1} E}{G}\right) \iff \operatorname{Re} T_f = \frac{f}{2}, \quad
/// G = \frac{T_f(s_0) + T_f(-s_0) - f}{2} $$
///
/// Nothing here is singular at $z = \pm 1$, where loops have integrators and dead times leave their mark; $s_0$ only
/// has to keep clear of real poles.
pub(super) struct Squares<'a> {
    reduced: &'a Reduced,
    factor: f64,
    e: Matrix,
    /// Poles of $T_f$ in the s plane; the one at infinity, $z = -1$, left out.
    poles: Vec<Complex>,
    /// From a place near the slow poles and from one near the fast ones: far from the place zeros are not found well.
    shifted: Vec<Shifted>,
}

/// What both questions need of one place $s_0$.
struct Shifted {
    centre: f64,
    m: Matrix,
    /// $K b$.
    input: Vec<f64>,
    /// Last rows of $K$ and of $N^{-1}$.
    k: Vec<f64>,
    n: Vec<f64>,
}

impl<'a> Squares<'a> {
    /// Of the two factors the one whose poles keep farther from the unit circle.
    pub(super) fn new(reduced: &'a Reduced) -> Result<Self, LtiError> {
        let clearance = |square: &Self| {
            let sizes = square.poles.iter().map(|s| s.re.abs() / (1.0 + s.norm_sqr()));
            sizes.fold(f64::INFINITY, f64::min)
        };
        let mut best = Self::with_factor(reduced, 1.0)?;
        if !(clearance(&best) > CLEAR) {
            let other = Self::with_factor(reduced, -1.0)?;
            best = if clearance(&other) > clearance(&best) { other } else { best };
        }
        let sizes = || best.poles.iter().map(|&s| modulus(s)).filter(|&size| size > 0.0);
        let slow = sizes().fold(BAND.1, f64::min).max(BAND.0);
        let fast = sizes().fold(slow, f64::max).min(BAND.1);
        for size in [slow, fast] {
            best.shifted.push(best.shifted(best.clear_of_poles(size))?);
        }
        Ok(best)
    }

    fn with_factor(reduced: &'a Reduced, factor: f64) -> Result<Self, LtiError> {
        let e = reduced.closed(factor);
        let poles = quick_eigenvalues(&e)?.into_iter().map(|zeta| quotient(zeta, zeta + 2.0));
        let poles = poles.filter(|s| s.is_finite()).collect();
        Ok(Self { reduced, factor, e, poles, shifted: Vec::new() })
    }

    /// Angles near which L is real, and others; without 0 and π.
    pub(super) fn angles_of_real_values(&self) -> Result<Vec<f64>, LtiError> {
        self.angles(|shifted| {
            let value = dot(&shifted.n, self.reduced.b());
            (shifted.k.clone(), -1.0 / value)
        })
    }

    /// Angles near which $|L| = 1$, and others.
    pub(super) fn angles_of_unit_gain(&self) -> Result<Vec<f64>, LtiError> {
        self.angles(|shifted| {
            let row = |column: usize| {
                let own = (0..shifted.n.len()).map(|k| shifted.n[k] * self.e.at(k, column));
                own.fold(0.0, |sum, term| sum + term)
            };
            let s = shifted.centre.sqrt();
            let value = 0.5 * (self.closed_at(s) + self.closed_at(-s) - self.factor);
            ((0..shifted.n.len()).map(row).collect(), 2.0 * self.reduced.gamma() / value)
        })
    }

    /// $T_f$ at a real place.
    fn closed_at(&self, s: f64) -> f64 {
        let value = self.reduced.at(Complex::new(2.0 * s / (1.0 - s), 0.0));
        quotient(value.over, value.under + value.over * self.factor).re
    }

    /// Zeros of one part, given by the output and the factor of a feedback.
    fn angles(&self, part: impl Fn(&Shifted) -> (Vec<f64>, f64)) -> Result<Vec<f64>, LtiError> {
        let mut angles = Vec::new();
        for shifted in &self.shifted {
            let (output, factor) = part(shifted);
            if factor.is_finite() {
                angles.extend(shifted.zeros(&output, factor)?);
            }
        }
        Ok(angles)
    }

    /// A place of about this size that is far from all poles and from their mirror images.
    fn clear_of_poles(&self, size: f64) -> f64 {
        let distance = |place: f64| {
            let distances = self.poles.iter().map(|pole| {
                modulus(pole - place).min(modulus(pole + place)) / place.max(modulus(*pole))
            });
            // At s = 1 the place in the z plane is at infinity.
            distances.fold((1.0 - place).abs(), f64::min)
        };
        let places = STEPS.map(|step| step * size).into_iter();
        places.max_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or(size)
    }

    fn shifted(&self, s: f64) -> Result<Shifted, LtiError> {
        let order = self.reduced.order();
        let with_diagonal = |scale: f64, diagonal: f64| {
            Matrix::from_function(order, order, |row, column| {
                scale * self.e.at(row, column) + if row == column { diagonal } else { 0.0 }
            })
        };
        let twice = with_diagonal(1.0, 2.0);
        let joined = Matrix::from_function(order, 2 * order, |row, column| {
            match column.checked_sub(order) {
                None => twice.at(row, column),
                Some(column) => {
                    if row == column {
                        1.0
                    } else {
                        0.0
                    }
                }
            }
        });
        let half = with_diagonal(1.0 - s, -2.0 * s).solve(&joined)?;
        let both = with_diagonal(1.0 + s, 2.0 * s).solve(&half)?;
        let k = Matrix::from_function(order, order, |row, column| both.at(row, column));
        let mut input = vec![0.0; order];
        k.apply(self.reduced.b(), &mut input)?;
        let last = both.row(order - 1);
        Ok(Shifted {
            centre: s * s,
            m: k.product(&twice)?,
            input,
            k: last[..order].to_vec(),
            n: last[order..].to_vec(),
        })
    }
}

impl Shifted {
    /// Angles of the eigenvalues of M with a feedback.
    fn zeros(&self, output: &[f64], factor: f64) -> Result<Vec<f64>, LtiError> {
        let order = self.input.len();
        let closed = Matrix::from_function(order, order, |row, column| {
            self.m.at(row, column) + factor * self.input[row] * output[column]
        });
        let squares = quick_eigenvalues(&closed)?.into_iter().map(|p| reciprocal(p) + self.centre);
        // Exact ones are negative, w = −tan²; the others do no harm.
        let s = squares.map(|w| (0.5 * (modulus(w) - w.re)).sqrt());
        Ok(s.filter(|&s| s > 0.0).map(|s| 2.0 * libm::atan(s)).collect())
    }
}

fn dot(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).fold(0.0, |sum, (left, right)| sum + left * right)
}

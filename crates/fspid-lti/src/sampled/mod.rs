//! Loops that run in samples: response, poles, crossings, margins, peaks.
//!
//! For a controller in a computer and whatever lies between its output and its input, as one exact difference
//! equation. Nothing is read off a grid of frequencies: crossings and peaks are separated by eigenvalues and then
//! located to the last digits, and a loop that is not stable has no margins. Dead times of whole samples are states
//! and may make the state matrix singular. Not for loops that pass their input on at once.

mod bracket;
mod crossings;
mod disk;
mod family;
mod gain_limits;
mod late;
mod level_set;
mod margins;
mod peak;
mod poles;
mod quick;
mod reduced;
mod rounding;
mod scan;
mod squares;
mod zeros;

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::complex::{Complex, modulus};
use crate::error::LtiError;
use crate::fine::FineMatrix;
use crate::matrix::Matrix;
use bracket::Proof;
use reduced::{Reduced, Response};

pub use bracket::Bracket;
pub use disk::DiskMargin;
pub use family::{LoopFamily, SeriesControl};
pub use gain_limits::GainLimit;
pub use margins::{Proved, SampledCrossover, SampledMargins, Stability};
pub use peak::Peak;

/// How far entries of A − I and b may be from those that were given first, over the largest entry: rounding, with room.
const SAME_ENTRY: f64 = 1e-10;
/// Halvings of a step between two frequencies while its phase is being followed.
const HALVINGS_MAX: u32 = 20;

/// A sampled loop of one input and one output, to be closed with negative feedback.
///
/// $$ L(z) = c (z I - A)^{-1} b, \quad z = e^{j \omega T} $$
///
/// # Example
/// An integrator with a delay of one sample is stable up to a gain of 1 per sample:
/// ```
/// use fspid_lti::{LtiError, Matrix, SampledLoop, Stability};
///
/// # fn main() -> Result<(), LtiError> {
/// let a = Matrix::from_rows(&[[1.0, 1.0], [0.0, 0.0]])?;
/// let open = SampledLoop::new(a, vec![0.0, 1.0], vec![0.25, 0.0], 0.02)?;
/// let Stability::Stable(margins) = open.margins()? else { unreachable!("a gain of 1/4") };
/// assert!((margins.gain_high.unwrap().factor - 4.0).abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct SampledLoop {
    a: Matrix,
    b: Vec<f64>,
    c: Vec<f64>,
    dt_s: f64,
    reduced: Reduced,
    /// $A - I$ and b with the digits that they have lost, if they are known.
    change: Option<[FineMatrix; 2]>,
}

impl SampledLoop {
    /// Loop of a state matrix, an input vector, an output vector and a sample period.
    ///
    /// # Errors
    /// No states, a matrix that is not square, vectors of another length, an entry that is not finite, a sample
    /// period that is not above zero and finite.
    pub fn new(a: Matrix, b: Vec<f64>, c: Vec<f64>, dt_s: f64) -> Result<Self, LtiError> {
        Self::require(&a, &b, &c, dt_s)?;
        let reduced = Reduced::new(&a, &b, &c);
        Ok(Self { a, b, c, dt_s, reduced, change: None })
    }

    /// The same loop with $A - I$, whose small entries near the diagonal have digits that A has not, and b with all of
    /// its own.
    ///
    /// Slow modes of a loop that is sampled fast live in these: rounding A alone moves what a loop does below a
    /// thousandth of Nyquist's frequency by 10⁻⁸ and more. Peaks and crossings are proved for the loop given here.
    ///
    /// # Errors
    /// A matrix of another shape, or an entry that is not that of A or b to its rounding.
    pub fn with_change(self, change: FineMatrix, input: FineMatrix) -> Result<Self, LtiError> {
        let order = self.order();
        change.high().require_shape("change of the states", order, order)?;
        input.high().require_shape("input matrix", order, 1)?;
        let one = |index: usize| if index.is_multiple_of(order + 1) { 1.0 } else { 0.0 };
        let size = |values: &[f64]| values.iter().fold(0.0, |size, v| f64::max(size, v.abs()));
        let (largest, largest_input) = (size(self.a.data()).max(1.0), size(&self.b));
        let states = change.high().data().iter().zip(self.a.data()).enumerate();
        let states = states.map(|(index, (&given, &a))| (index, given, a - one(index), largest));
        let inputs = input.high().data().iter().zip(&self.b).enumerate();
        let inputs = inputs.map(|(index, (&given, &b))| (index, given, b, largest_input));
        for (index, given, expected, size) in states.chain(inputs) {
            if !((given - expected).abs() <= SAME_ENTRY * size) {
                return Err(LtiError::OtherLoop { index, given, expected });
            }
        }
        Ok(Self { change: Some([change, input]), ..self })
    }

    /// What is proved of the loop; `None` if nothing is.
    fn proof(&self) -> Option<Proof> {
        self.proof_scaled(1.0)
    }

    /// The same with a factor on its gain.
    fn proof_scaled(&self, factor: f64) -> Option<Proof> {
        let [change, b]: [Vec<[f64; 2]>; 2] = match &self.change {
            Some(parts) => parts.each_ref().map(|part| {
                part.high().data().iter().zip(part.low().data()).map(|(&h, &l)| [h, l]).collect()
            }),
            None => {
                let one =
                    |index: usize| if index.is_multiple_of(self.order() + 1) { 1.0 } else { 0.0 };
                let entries = self.a.data().iter().enumerate();
                let less_one = entries.map(|(index, &entry)| [entry, -one(index)]).collect();
                [less_one, self.b.iter().map(|&b| [b, 0.0]).collect()]
            }
        };
        let c: Vec<f64> = self.c.iter().map(|c| factor * c).collect();
        Proof::new(&change, &b, &c)
    }

    /// `Ok` when a loop can be made of these.
    fn require(a: &Matrix, b: &[f64], c: &[f64], dt_s: f64) -> Result<(), LtiError> {
        a.require_square_and_finite("state matrix")?;
        let order = a.rows();
        if order == 0 {
            return Err(LtiError::Empty { what: "state matrix" });
        }
        for (what, vector) in [("input vector", b), ("output vector", c)] {
            if vector.len() != order {
                let found = (vector.len(), 1);
                return Err(LtiError::Shape { what, found, allowed: (order, 1) });
            }
            LtiError::unless_finite(what, vector)?;
        }
        if !(dt_s > 0.0 && dt_s.is_finite()) {
            return Err(LtiError::NotPositive { what: "sample period in seconds", value: dt_s });
        }
        Ok(())
    }

    /// Sample period.
    #[must_use]
    pub fn dt_s(&self) -> f64 {
        self.dt_s
    }

    /// Number of states.
    #[must_use]
    pub fn order(&self) -> usize {
        self.b.len()
    }

    /// Half the sampling frequency, $\pi / T$.
    #[must_use]
    pub fn nyquist_rad_s(&self) -> f64 {
        PI / self.dt_s
    }

    /// State matrix of the loop closed with negative feedback, $A - b c$.
    #[must_use]
    pub fn closed_matrix(&self) -> Matrix {
        Matrix::from_function(self.order(), self.order(), |row, column| {
            self.a.at(row, column) - self.b[row] * self.c[column]
        })
    }

    /// The response at an angle $\omega T$.
    fn response(&self, angle_rad: f64) -> Response {
        self.reduced.at(zeta(angle_rad))
    }

    /// The same, proved where that is possible.
    fn proved_response(&self, angle_rad: f64, proof: Option<&Proof>) -> Response {
        let computed = self.response(angle_rad);
        proof.map_or(computed, |proof| proof.response(angle_rad, computed))
    }

    /// Value at a frequency; infinite or NaN at a pole.
    #[must_use]
    pub fn at(&self, omega_rad_s: f64) -> Complex {
        self.response(omega_rad_s * self.dt_s).open()
    }

    /// Value at any place of the z-plane, on the unit circle or off it; infinite or NaN at a pole.
    #[must_use]
    pub fn at_z(&self, z: Complex) -> Complex {
        self.reduced.at(z - 1.0).open()
    }

    /// Gain at a frequency.
    #[must_use]
    pub fn gain(&self, omega_rad_s: f64) -> f64 {
        modulus(self.at(omega_rad_s))
    }

    /// Phase at a frequency, between −3π/2 and π/2: two integrators lag by π.
    ///
    /// For a phase without jumps over many frequencies see [`SampledLoop::bode`].
    #[must_use]
    pub fn phase_rad(&self, omega_rad_s: f64) -> f64 {
        phase_rad(self.at(omega_rad_s))
    }

    /// Gain and phase at each of some frequencies, the phase without jumps from one to the next.
    ///
    /// The first phase is that of [`SampledLoop::phase_rad`]. Between two neighbours the phase is followed in smaller
    /// steps where it turns far; exactly on an undamped pole or zero it jumps.
    #[must_use]
    pub fn bode(&self, omegas_rad_s: &[f64]) -> Vec<(f64, f64)> {
        let mut last: Option<(f64, f64)> = None;
        let mut found = Vec::with_capacity(omegas_rad_s.len());
        for &omega in omegas_rad_s {
            let phase = match last {
                Some((from, phase)) => phase + self.turn_rad((from, omega), HALVINGS_MAX),
                None => self.phase_rad(omega),
            };
            last = Some((omega, phase));
            found.push((self.gain(omega), phase));
        }
        found
    }

    /// Change of the phase between two frequencies.
    fn turn_rad(&self, (from, to): (f64, f64), halvings: u32) -> f64 {
        let middle = 0.5 * (from + to);
        let [first, centre, last] = [from, middle, to].map(|omega| self.phase_rad(omega));
        let (early, late) =
            (libm::remainder(centre - first, TAU), libm::remainder(last - centre, TAU));
        // A half that turns by more than a radian may have turned by a whole circle more.
        let followed = early.abs() < 1.0 && late.abs() < 1.0;
        if followed || halvings == 0 || !(early + late).is_finite() {
            return early + late;
        }
        self.turn_rad((from, middle), halvings - 1) + self.turn_rad((middle, to), halvings - 1)
    }
}

/// Phase of a value, between −3π/2 and π/2.
fn phase_rad(value: Complex) -> f64 {
    let phase = libm::atan2(value.im, value.re);
    if phase > FRAC_PI_2 { phase - TAU } else { phase }
}

/// $e^{j \theta} - 1$, with all digits for small angles.
fn zeta(angle_rad: f64) -> Complex {
    let (sin, cos) = libm::sincos(0.5 * angle_rad);
    Complex::new(-2.0 * sin * sin, 2.0 * sin * cos)
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "the same bits are asked for")]
mod tests {
    use super::*;

    #[test]
    fn a_phase_of_a_quarter_turn_ahead_stays_one() {
        assert_eq!(phase_rad(Complex::new(0.0, 2.0)), FRAC_PI_2);
        assert!(phase_rad(Complex::new(-1e-9, 2.0)) < -PI);
    }
}

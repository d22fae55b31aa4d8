//! The pitch of an aircraft as a transfer function, and what lies between the pilot and the elevator.

use fspid_lti::{FrequencyResponse, TransferFunction};

use super::absent::Absent;
use crate::error::AircraftError;
use crate::linearise::Linearisation;
use crate::modes::{AircraftMode, ModeName, modes_of_poles};

/// Pitch over elevator at a flight condition.
#[derive(Debug, Clone, PartialEq)]
pub struct PitchModel {
    /// Pitch over elevator in the sign that raises the nose.
    plant: TransferFunction,
    /// True airspeed.
    pub airspeed_m_s: f64,
    /// Gravity.
    pub gravity_m_s2: f64,
    /// What the command passes before it moves the elevator.
    pub path: CommandPath,
}

/// What lies between a command and the elevator.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CommandPath {
    /// Servo, with a gain of 1 at rest; none is at once.
    pub servo: Option<TransferFunction>,
    /// Dead time of computers and data paths.
    pub delay_s: f64,
}

impl PitchModel {
    /// Model of a transfer function, of whatever sign: it is turned so that the command raises the nose at first.
    ///
    /// # Errors
    /// An airspeed or gravity that is not above zero and finite.
    pub fn new(
        theta_over_elevator: TransferFunction,
        airspeed_m_s: f64,
        gravity_m_s2: f64,
    ) -> Result<Self, AircraftError> {
        AircraftError::unless_positive("airspeed in m/s", airspeed_m_s)?;
        AircraftError::unless_positive("gravity in m/s²", gravity_m_s2)?;
        let (numerator, denominator) = (
            theta_over_elevator.numerator().leading(),
            theta_over_elevator.denominator().leading(),
        );
        let raises = (numerator > 0.0) == (denominator > 0.0);
        let plant = if raises { theta_over_elevator } else { theta_over_elevator.negated() };
        Ok(Self { plant, airspeed_m_s, gravity_m_s2, path: CommandPath::default() })
    }

    /// Model of an aircraft around a trim.
    ///
    /// # Errors
    /// As [`Linearisation::theta_over_elevator`].
    pub fn of(linear: &Linearisation, gravity_m_s2: f64) -> Result<Self, AircraftError> {
        Self::new(linear.theta_over_elevator()?, linear.trim.target.airspeed_m_s, gravity_m_s2)
    }

    /// The same behind a servo and a dead time.
    #[must_use]
    pub fn behind(self, path: CommandPath) -> Self {
        Self { path, ..self }
    }

    /// Pitch over elevator, nose up positive.
    #[must_use]
    pub fn plant(&self) -> &TransferFunction {
        &self.plant
    }

    /// Response of the pitch to a command.
    ///
    /// # Errors
    /// A dead time that is negative or not finite; roots that cannot be found.
    pub fn response(&self) -> Result<FrequencyResponse, Absent> {
        let servo = self.path.servo.as_ref();
        let system = servo.map_or(Ok(self.plant.clone()), |servo| self.plant.series(servo))?;
        Ok(FrequencyResponse::new(system, self.path.delay_s)?)
    }

    /// Modes, the fastest first; with three poles the slowest of them is left out, as the integral of the pitch rate.
    ///
    /// # Errors
    /// A plant with another number of poles than three or four; roots that cannot be found.
    pub fn modes(&self) -> Result<Vec<AircraftMode>, Absent> {
        let poles = self.plant.poles()?;
        match poles.len() {
            4 => Ok(modes_of_poles(&poles)?),
            3 => {
                let slowest =
                    poles.iter().map(|pole| pole.norm_sqr()).fold(f64::INFINITY, f64::min);
                // A pair that is slower than the real pole is neither the integral nor left out.
                if poles.iter().any(|pole| pole.norm_sqr() <= slowest && pole.im != 0.0) {
                    return Err(Absent::SlowPair);
                }
                let fast = poles.iter().filter(|pole| pole.norm_sqr() > slowest && pole.im >= 0.0);
                Ok(fast.map(|&pole| AircraftMode { name: ModeName::ShortPeriod, pole }).collect())
            }
            found => Err(Absent::OtherModel { found }),
        }
    }

    /// Zero of the lift in rad/s, as a positive number: $1 / T_{\theta_2}$, the faster of the real zeros.
    ///
    /// # Errors
    /// No real zero on the left; roots that cannot be found.
    pub fn lift_zero_rad_s(&self) -> Result<f64, Absent> {
        let zeros = self.plant.zeros()?;
        let real = zeros.iter().filter(|zero| zero.im == 0.0).map(|zero| -zero.re);
        let fastest = real.fold(0.0, f64::max);
        if fastest > 0.0 { Ok(fastest) } else { Err(Absent::NoLiftZero) }
    }
}

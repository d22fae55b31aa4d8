//! Signals of a flight at a sample, before the command is computed.

use fspid_core::Sample;

/// Signals available at a sample before the command is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Index of the sample.
    pub k: usize,
    /// Commanded pitch, rad.
    pub setpoint_rad: f64,
    /// Pitch angle, rad; of an aircraft its change from the trim.
    pub theta_rad: f64,
    /// Pitch rate, rad/s.
    pub q_rad_s: f64,
    /// Pitch angle, rad, and pitch rate, rad/s, as a controller sees them.
    pub measured: [f64; 2],
}

impl Seen {
    /// What a controller is asked with.
    #[inline]
    #[must_use]
    pub fn sample(&self) -> Sample<f64> {
        let [measurement_rad, rate_rad_s] = self.measured;
        Sample { setpoint_rad: self.setpoint_rad, measurement_rad, rate_rad_s }
    }
}

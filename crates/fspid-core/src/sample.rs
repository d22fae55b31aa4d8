//! The inputs of one controller step: set-point, measured pitch and measured pitch rate.

/// Inputs of a controller at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<R> {
    /// Commanded pitch, rad.
    pub setpoint_rad: R,
    /// Measured pitch, rad.
    pub measurement_rad: R,
    /// Measured pitch rate, rad/s; ignored by a controller without a rate loop.
    pub rate_rad_s: R,
}

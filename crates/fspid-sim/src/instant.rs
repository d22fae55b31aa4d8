//! Everything observable of a loop at one sample: set-point, motion, measurement, gains, command.

use fspid_core::Step;

use crate::aircraft::AircraftSample;
use crate::autopilot::AutopilotSample;

/// Everything observable at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    /// Index of the sample.
    pub k: usize,
    /// Commanded pitch, rad.
    pub setpoint_rad: f64,
    /// Pitch angle, rad; of an aircraft its change from the trim.
    pub theta_rad: f64,
    /// Pitch rate, rad/s.
    pub q_rad_s: f64,
    /// Elevator in the plant's own sign, rad.
    pub elevator_rad: f64,
    /// Pitch angle, rad, and pitch rate, rad/s, as the controller saw them.
    pub measured: [f64; 2],
    /// What an aircraft shows beyond pitch.
    pub aircraft: Option<AircraftSample>,
    /// What the autopilot around the loop does.
    pub autopilot: Option<AutopilotSample>,
    /// What the controller answered.
    pub step: Step<f64>,
}

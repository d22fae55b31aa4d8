//! What happened: the columns of a flight.

use fspid_core::{Faults, Gains};

/// How a flight ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// All samples were flown.
    Completed,
    /// The pitch angle left ± 10⁶ degrees or was not finite; the trace ends before.
    Diverged {
        /// Time of the first such sample, s.
        at_s: f64,
    },
}

/// The columns of one controller's flight, one entry a sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// Time, s.
    pub time_s: Vec<f64>,
    /// Commanded pitch, rad.
    pub setpoint_rad: Vec<f64>,
    /// Pitch angle, rad (the true one, without disturbance of the measurement).
    pub theta_rad: Vec<f64>,
    /// Pitch rate, rad/s.
    pub q_rad_s: Vec<f64>,
    /// Command of the controller, nose up positive, rad.
    pub command_rad: Vec<f64>,
    /// Elevator in the plant's own sign, rad.
    pub elevator_rad: Vec<f64>,
    /// Gains used.
    pub gains: Vec<Gains<f64>>,
    /// How the flight ended.
    pub outcome: Outcome,
    /// Samples whose command was cut by the controller's own limits.
    pub saturated_samples: usize,
    /// Faults latched by the controller.
    pub faults: Faults,
}

impl Trace {
    /// An empty trace with room for `rows`.
    pub(crate) fn with_capacity(rows: usize) -> Self {
        let column = || Vec::with_capacity(rows);
        Self {
            time_s: column(),
            setpoint_rad: column(),
            theta_rad: column(),
            q_rad_s: column(),
            command_rad: column(),
            elevator_rad: column(),
            gains: Vec::with_capacity(rows),
            outcome: Outcome::Completed,
            saturated_samples: 0,
            faults: Faults::NONE,
        }
    }

    /// Number of samples flown.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.time_s.len()
    }
}

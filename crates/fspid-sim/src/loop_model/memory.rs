//! Which of a controller's internal states belong to the linear loop model: integral, derivative filter, previous sample.

use fspid_core::{Gains, PidConfig};

/// Which parts of a controller's memory the loop has. A part that no gain lets out is left away: the
/// pole of an integral without a gain stays at 1, and is not the loop's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// The integral.
    pub integral: bool,
    /// The filtered derivative.
    pub derivative: bool,
    /// The last sample.
    pub previous: bool,
}

impl Memory {
    /// What fixed gains let out.
    #[must_use]
    pub fn of_gains(gains: Gains<f64>, config: &PidConfig<f64>) -> Self {
        Self::of_terms(gains.ki != 0.0, gains.kd != 0.0, config)
    }

    /// Everything that gains may let out which are not always zero: for gains that move.
    #[must_use]
    pub fn of_terms(integral: bool, derivative: bool, config: &PidConfig<f64>) -> Self {
        let filtered = config.derivative.filter_s > 0.0;
        Self { integral, derivative: derivative && filtered, previous: derivative }
    }

    /// The same, and the last sample, from which the change of the error is taken.
    #[must_use]
    pub fn with_previous(self) -> Self {
        Self { previous: true, ..self }
    }
}

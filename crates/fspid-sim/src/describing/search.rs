//! Where limit cycles are looked for.

use crate::error::{SimError, positive};

/// Of half the sampling rate: up to where cycles are looked for unless told otherwise.
const NEAR_NYQUIST: f64 = 0.98;

/// Amplitudes and frequencies that are searched, least and most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Search {
    /// Amplitude of the controller's command before any limit, rad.
    pub amplitude_rad: (f64, f64),
    /// Frequency, rad/s.
    pub frequency_rad_s: (f64, f64),
}

impl Search {
    /// Commands from 10⁻⁴ to 10 rad, frequencies from 0.05 rad/s to nearly half the sampling rate.
    #[must_use]
    pub fn sampled_every(dt_s: f64) -> Self {
        let most_rad_s = NEAR_NYQUIST * std::f64::consts::PI / dt_s;
        Self {
            amplitude_rad: (1e-4, 10.0),
            frequency_rad_s: (0.05_f64.min(1e-3 * most_rad_s), most_rad_s),
        }
    }

    pub(super) fn checked(self) -> Result<Self, SimError> {
        for (what, (least, most)) in
            [("amplitude, rad", self.amplitude_rad), ("frequency, rad/s", self.frequency_rad_s)]
        {
            positive(what, least)?;
            if !(most > least && most.is_finite()) {
                let allowed = "a finite number above the least";
                return Err(SimError::Number { what, found: most, allowed });
            }
        }
        Ok(self)
    }
}

//! Gains as the rules give them: $u = K (e + \frac{1}{T_i} \int e \ dt + T_d \dot e)$.

use fspid_core::{ConfigError, Gains};
use serde::Serialize;

/// Gains in the standard form.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Isa {
    /// Gain K, command per error.
    pub gain: f64,
    /// Integral time, s; infinite without an integral.
    pub ti_s: f64,
    /// Derivative time, s; 0 without a derivative.
    pub td_s: f64,
}

impl Isa {
    /// A proportional gain.
    #[must_use]
    pub fn proportional(gain: f64) -> Self {
        Self { gain, ti_s: f64::INFINITY, td_s: 0.0 }
    }

    /// From the series form $K (1 + \frac{1}{T_i s})(1 + T_d s)$, with $f = 1 + T_d / T_i$:
    /// $K f$, $T_i f$, $T_d / f$.
    #[must_use]
    pub fn from_series(gain: f64, ti_s: f64, td_s: f64) -> Self {
        let factor = 1.0 + td_s / ti_s;
        Self { gain: gain * factor, ti_s: ti_s * factor, td_s: td_s / factor }
    }

    /// In the project's parallel form.
    ///
    /// # Errors
    /// Numbers that are not finite, an integral time that is not positive, a negative derivative time.
    pub fn gains(&self) -> Result<Gains<f64>, ConfigError> {
        Gains::from_isa(self.gain, self.ti_s, self.td_s)
    }
}

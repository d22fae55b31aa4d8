//! The poles of an autopilot's modes: everything around the pitch loop, one mode after another.

use fspid_core::Gains;
use fspid_diagnostics::digits::{to_digits, to_six_decimals};
use fspid_lti::Complex;
use fspid_sim::stability::MODE_RADIUS;
use fspid_sim::{Controller, ModePoles, Scenario, SimError, mode_poles};
use serde_json::{Value, json};

use super::Stability;

/// A mode with a controller.
#[derive(Clone, Debug, PartialEq)]
pub struct AnalysedMode {
    /// Its name.
    pub name: String,
    /// Its poles around the trim.
    pub poles: ModePoles,
}

impl AnalysedMode {
    /// Every mode of a scenario's autopilot with a controller at its gains at rest; none without an autopilot.
    ///
    /// # Errors
    /// As [`mode_poles`].
    pub(crate) fn all(
        scenario: &Scenario,
        controller: &Controller,
        gains: Gains<f64>,
    ) -> Result<Vec<Self>, SimError> {
        let modes =
            scenario.autopilot.as_ref().map(|autopilot| autopilot.modes()).unwrap_or_default();
        let found = mode_poles(scenario, controller, gains)?.into_iter();
        let named = found.filter_map(|poles| {
            let mode = modes.get(poles.mode)?;
            let name = match poles.from_s > mode.entry.at_s {
                true => {
                    format!(
                        "{}, with the aircraft from {} s on",
                        mode.name,
                        to_six_decimals(poles.from_s)
                    )
                }
                false => mode.name.clone(),
            };
            Some(Self { name, poles })
        });
        Ok(named.collect())
    }

    /// Whether everything decays.
    #[must_use]
    pub fn stability(&self) -> Stability {
        if self.poles.doubt.is_some() {
            Stability::Undecided
        // Written so that NaN is unstable.
        } else if self.poles.spectral_radius <= MODE_RADIUS {
            Stability::Stable
        } else {
            Stability::Unstable
        }
    }

    /// The pole that decays least.
    #[must_use]
    pub fn slowest(&self) -> Option<Complex> {
        self.poles.poles.iter().copied().max_by(|a, b| a.re.total_cmp(&b.re))
    }

    /// Damping ratio and natural frequency, rad/s, of the least damped pair; none where nothing oscillates.
    #[must_use]
    pub fn least_damped(&self) -> Option<[f64; 2]> {
        let pairs = self.poles.poles.iter().filter(|pole| pole.im > 0.0);
        let damped = pairs.map(|pole| {
            let frequency_rad_s = libm::hypot(pole.re, pole.im);
            [-pole.re / frequency_rad_s, frequency_rad_s]
        });
        damped.min_by(|[one, _], [other, _]| one.total_cmp(other))
    }

    /// "climb: stable, slowest pole -0.17 1/s, least damped 0.84 at 0.15 rad/s".
    #[must_use]
    pub fn in_words(&self) -> String {
        let slowest = self.slowest().map_or(String::new(), |pole| {
            let time = if pole.re < 0.0 {
                format!(", a time constant of {} s", to_digits(-1.0 / pole.re, 3))
            } else {
                String::new()
            };
            format!(", slowest pole {} 1/s{time}", to_digits(pole.re, 3))
        });
        let damped = self.least_damped().map_or(String::new(), |[damping, frequency_rad_s]| {
            format!(
                ", least damped {} at {} rad/s",
                to_digits(damping, 3),
                to_six_decimals(frequency_rad_s)
            )
        });
        let word = match self.stability() {
            Stability::Stable => "stable",
            Stability::Unstable => "UNSTABLE",
            Stability::Undecided => "UNDECIDED",
        };
        format!("{}: {word} with its outer loops{slowest}{damped}", self.name)
    }

    pub(super) fn json(&self) -> Value {
        let pole = |pole: Complex| json!({ "re_1_s": pole.re, "im_1_s": pole.im });
        let least_damped = self.least_damped().map(|[damping, frequency_rad_s]| {
            json!({ "damping": damping, "frequency_rad_s": frequency_rad_s })
        });
        json!({
            "name": self.name,
            "stable": self.stability().known(),
            "slowest_pole": self.slowest().map(pole),
            "least_damped": least_damped,
        })
    }
}

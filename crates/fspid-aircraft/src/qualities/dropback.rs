//! Dropback: how far the nose falls back, or goes on, when the pilot lets go.

use fspid_lti::Mode;

use super::absent::Absent;
use super::model::PitchModel;
use super::short_period::short_period_mode;

/// Response to a command that is held and then released, with the speed held.
///
/// No level: the edges of Gibson's chart were not at hand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dropback {
    /// Fall of the attitude after the release over the pitch rate before it; negative where the nose goes on.
    pub dropback_s: f64,
    /// Highest pitch rate over the steady one.
    pub pitch_rate_overshoot: f64,
}

impl Dropback {
    /// Dropback of a model's short period, servo and dead time left out.
    ///
    /// $$ \frac{\Delta\theta}{q_{ss}} = T_{\theta_2} - \frac{2 \zeta}{\omega_n}, \quad
    ///    \frac{q_{max}}{q_{ss}} = 1 + e^{-\sigma t} \sqrt{1 - 2 \sigma T + \omega_n^2 T^2} $$
    ///
    /// with $T = T_{\theta_2}$, $\sigma = \zeta \omega_n$ and t the time of the peak,
    /// $\tan \omega_d t = \omega_d T / (\sigma T - 1)$.
    ///
    /// # Source
    /// J. C. Gibson, Piloted handling qualities design criteria for high order flight control systems,
    /// AGARD CP-333 (1982), paper 4.
    ///
    /// # Errors
    /// A model without a short period that swings, or without the zero of the lift.
    pub fn of(model: &PitchModel) -> Result<Self, Absent> {
        let mode = short_period_mode(&model.modes()?)?;
        let lag_s = 1.0 / model.lift_zero_rad_s()?;
        if !(mode.damping_ratio < 1.0) {
            return Err(Absent::ShortPeriodDoesNotSwing);
        }
        let dropback_s = lag_s - 2.0 * mode.damping_ratio / mode.natural_frequency_rad_s;
        Ok(Self { dropback_s, pitch_rate_overshoot: overshoot(mode, lag_s) })
    }
}

fn overshoot(mode: Mode, lag_s: f64) -> f64 {
    let Mode { natural_frequency_rad_s: omega, damping_ratio } = mode;
    let (sigma, swing) =
        (damping_ratio * omega, omega * (1.0 - damping_ratio * damping_ratio).sqrt());
    let peak_s = libm::atan2(swing * lag_s, sigma * lag_s - 1.0) / swing;
    let size = 1.0 - 2.0 * sigma * lag_s + omega * omega * lag_s * lag_s;
    1.0 + libm::exp(-sigma * peak_s) * size.sqrt()
}

//! C*: load factor and pitch rate as a pilot feels them together.

use fspid_lti::TransferFunction;

use super::absent::Absent;
use super::model::PitchModel;
use super::short_period::short_period_mode;

/// Speed in m/s at which pitch rate and load are felt alike: 400 ft/s.
pub const CROSSOVER_SPEED_M_S: f64 = 121.92;

/// C* over command of the short period, 1 at rest; servo and dead time left out.
///
/// $$ C^\ast = n_z + \frac{V_{co}}{g} q, \quad
///    \frac{C^\ast}{C^\ast_{ss}} = \frac{\omega_n^2 \left( V + V_{co} (1 + T_{\theta_2} s) + l s (1 + T_{\theta_2} s) \right)}
///    {(V + V_{co}) (s^2 + 2 \zeta \omega_n s + \omega_n^2)} $$
///
/// with the pilot l ahead of the centre of gravity. The lift of the elevator is left out. No level: the edges of the
/// chart were not at hand.
///
/// # Source
/// H. N. Tobie, E. M. Elliott, L. G. Malcom, A new longitudinal handling qualities criterion, National Aerospace
/// Electronics Conference (1966).
///
/// # Errors
/// A model without a stable short period, or without the zero of the lift.
pub fn c_star(model: &PitchModel, pilot_ahead_m: f64) -> Result<TransferFunction, Absent> {
    let mode = short_period_mode(&model.modes()?)?;
    let (lag_s, omega) = (1.0 / model.lift_zero_rad_s()?, mode.natural_frequency_rad_s);
    let at_rest = model.airspeed_m_s + CROSSOVER_SPEED_M_S;
    let scale = omega * omega / at_rest;
    let numerator = [
        scale * pilot_ahead_m * lag_s,
        scale * (CROSSOVER_SPEED_M_S * lag_s + pilot_ahead_m),
        scale * at_rest,
    ];
    let first = numerator.iter().take_while(|&&value| value == 0.0).count();
    let denominator = [1.0, 2.0 * mode.damping_ratio * omega, omega * omega];
    Ok(TransferFunction::new(&numerator[first..], &denominator)?)
}

//! What keeps the wings level while the controller of the study looks after pitch.

use fspid_aircraft::{AirMotion, Aircraft, Controls, ForceModel, RigidState, Trim, Vector3};

/// How fast the wings return to level, s.
pub const LEVELLING_TIME_S: f64 = 2.0;

/// A wing leveller: aileron against bank.
///
/// $$ \delta_a = -k_\phi \phi, \qquad k_\phi = \frac{-L_p}{L_{\delta_a} T}, \quad T = 2 \text{ s} $$
///
/// With the roll rate quasi-steady, $p = -L_{\delta_a} \delta_a / L_p$, the bank then falls as
/// $\dot \phi = -\phi / T$. $L_p$ and $L_{\delta_a}$ are what roll rate and aileron add to the roll
/// acceleration at the trim, so that the sign of the aileron is that of the aircraft's own data. The
/// aileron stays within its travel, its drive is ideal, and the rudder does not move. An aircraft
/// without aileron or without roll damping has no leveller.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WingLeveller {
    /// $k_\phi$: aileron per bank.
    pub gain: f64,
}

/// Half the width of the differences: 0.01 rad/s of roll rate, 0.01 rad of aileron.
const DIFFERENCE: f64 = 0.01;

impl WingLeveller {
    /// The leveller of an aircraft at its trim.
    #[must_use]
    pub fn of<M: ForceModel>(aircraft: &Aircraft<M>, trim: &Trim) -> Self {
        let damping = slope(|roll_rad_s| {
            let rates_rad_s = Vector3::new(roll_rad_s, 0.0, 0.0);
            roll_acceleration(aircraft, &RigidState { rates_rad_s, ..trim.state }, &trim.controls)
        });
        let power = slope(|aileron_rad| {
            let controls = Controls { aileron_rad, ..trim.controls };
            roll_acceleration(aircraft, &trim.state, &controls)
        });
        let gain = -damping / (power * LEVELLING_TIME_S);
        Self { gain: if gain.is_finite() && damping < 0.0 { gain } else { 0.0 } }
    }

    /// Aileron at a bank, before its stops.
    #[must_use]
    pub fn aileron_rad(&self, bank_rad: f64) -> f64 {
        -self.gain * bank_rad
    }
}

fn slope(function: impl Fn(f64) -> f64) -> f64 {
    (function(DIFFERENCE) - function(-DIFFERENCE)) / (2.0 * DIFFERENCE)
}

fn roll_acceleration<M: ForceModel>(
    aircraft: &Aircraft<M>,
    state: &RigidState,
    controls: &Controls,
) -> f64 {
    aircraft.instant(state, controls, &AirMotion::STILL).accelerations.angular_rad_s2.x
}

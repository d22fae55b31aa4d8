//! Altitude and airspeed together.

use fspid_aircraft::atmosphere::STANDARD_GRAVITY_M_S2;

use super::quantity::Observed;
use crate::controller::Controller;

/// Total-energy control: the throttle holds the rate of the total energy, pitch its distribution between height and speed.
///
/// $$ \gamma_c = \frac{k_h (h_c - h)}{V}, \quad \frac{\dot V_c}{g} = \frac{k_V (V_c - V)}{g}, \qquad
///    \dot E = \gamma + \frac{\dot V}{g}, \quad \dot L = \gamma - \frac{\dot V}{g} $$
///
/// each of the two commands within its limit; the throttle's controller answers $\dot E_c - \dot E$, that of pitch
/// $\dot L_c - \dot L$.
///
/// # Source
/// A. A. Lambregts, *Vertical flight path and speed control autopilot design using total energy principles*, AIAA 83-2239.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TotalEnergy {
    /// $k_h$, 1/s.
    pub altitude_gain_1_s: f64,
    /// $k_V$, 1/s.
    pub airspeed_gain_1_s: f64,
    /// Largest size of $\gamma_c$, rad.
    pub most_path_rad: f64,
    /// Largest size of $\dot V_c / g$.
    pub most_acceleration_g: f64,
    /// From the rate of the energy to the throttle.
    pub energy: Controller,
    /// From the rate of its distribution to pitch, rad.
    pub distribution: Controller,
}

/// Slower than this no path is commanded any more: the angle would have no end.
const LEAST_SPEED_M_S: f64 = 1.0;

/// Commanded and found, of energy and of its distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rates {
    pub(super) commanded: f64,
    pub(super) found: f64,
}

impl TotalEnergy {
    /// Flight path, rad, and acceleration, g, that altitude and airspeed ask for, without their limits.
    fn wanted(&self, observed: &Observed, [altitude_m, airspeed_m_s]: [f64; 2]) -> [f64; 2] {
        let climb_m_s = self.altitude_gain_1_s * (altitude_m - observed.altitude_m);
        let speed_m_s = observed.airspeed_m_s.max(LEAST_SPEED_M_S);
        let wanted_m_s2 = self.airspeed_gain_1_s * (airspeed_m_s - observed.airspeed_m_s);
        [climb_m_s / speed_m_s, wanted_m_s2 / STANDARD_GRAVITY_M_S2]
    }

    /// True where one of the two commands is at its limit.
    pub(super) fn is_limited(&self, observed: &Observed, held: [f64; 2]) -> bool {
        let [path, speeding] = self.wanted(observed, held);
        path.abs() >= self.most_path_rad || speeding.abs() >= self.most_acceleration_g
    }

    /// The rates of energy and of its distribution.
    pub(super) fn rates(&self, observed: &Observed, held: [f64; 2]) -> [Rates; 2] {
        let [path, speeding] = self.wanted(observed, held);
        let path = path.clamp(-self.most_path_rad, self.most_path_rad);
        let speeding = speeding.clamp(-self.most_acceleration_g, self.most_acceleration_g);
        let (path_found, speeding_found) =
            (observed.path_rad, observed.path_acceleration_m_s2 / STANDARD_GRAVITY_M_S2);
        [
            Rates { commanded: path + speeding, found: path_found + speeding_found },
            Rates { commanded: path - speeding, found: path_found - speeding_found },
        ]
    }
}

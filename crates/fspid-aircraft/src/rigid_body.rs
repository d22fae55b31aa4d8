//! The state of a rigid body over a flat Earth that does not turn, and how it changes.

use crate::mass::MassProperties;
use crate::quaternion::{EulerAngles, Quaternion};
use crate::vector::Vector3;

/// How many numbers a [`RigidState`] is.
pub const RIGID_STATES: usize = 13;

/// Where a body is, how it lies and how it moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidState {
    /// Position from a point on the ground: north, east, down; altitude is minus the third.
    pub position_ned_m: Vector3,
    /// Velocity over the ground in body axes: u, v, w.
    pub velocity_body_m_s: Vector3,
    /// Attitude.
    pub attitude: Quaternion,
    /// Body rates p, q, r: roll right, pitch up, yaw right positive.
    pub rates_rad_s: Vector3,
}

impl RigidState {
    /// Level at rest over the origin.
    pub const AT_REST: Self = Self {
        position_ned_m: Vector3::ZERO,
        velocity_body_m_s: Vector3::ZERO,
        attitude: Quaternion::LEVEL,
        rates_rad_s: Vector3::ZERO,
    };

    /// Position, velocity, attitude (scalar first), rates: the order of a flight's state vector.
    #[inline(always)]
    #[must_use]
    pub fn to_array(&self) -> [f64; RIGID_STATES] {
        let [north, east, down] = self.position_ned_m.to_array();
        let [u, v, w] = self.velocity_body_m_s.to_array();
        let [qw, qx, qy, qz] = self.attitude.to_array();
        let [p, q, r] = self.rates_rad_s.to_array();
        [north, east, down, u, v, w, qw, qx, qy, qz, p, q, r]
    }

    /// The inverse of [`RigidState::to_array`].
    #[inline(always)]
    #[must_use]
    pub fn from_array(values: &[f64; RIGID_STATES]) -> Self {
        let [north, east, down, u, v, w, qw, qx, qy, qz, p, q, r] = *values;
        Self {
            position_ned_m: Vector3::new(north, east, down),
            velocity_body_m_s: Vector3::new(u, v, w),
            attitude: Quaternion { w: qw, x: qx, y: qy, z: qz },
            rates_rad_s: Vector3::new(p, q, r),
        }
    }

    /// Altitude over the origin.
    #[inline(always)]
    #[must_use]
    pub fn altitude_m(&self) -> f64 {
        -self.position_ned_m.z
    }

    /// Bank, pitch and heading.
    #[must_use]
    pub fn euler(&self) -> EulerAngles {
        self.attitude.to_euler()
    }

    /// Velocity over the ground: north, east, down.
    #[inline(always)]
    #[must_use]
    pub fn velocity_ned_m_s(&self) -> Vector3 {
        self.attitude.to_ned(self.velocity_body_m_s)
    }

    /// Rate of change of the state vector from the accelerations.
    ///
    /// `velocity_rate_body_m_s2` is the rate of change of the components u, v, w, not the acceleration in space.
    ///
    /// $$ \dot x_{NED} = R v, \quad \dot q = \tfrac{1}{2} q \otimes (0, \omega) $$
    #[inline(always)]
    #[must_use]
    pub fn rate(&self, accelerations: &Accelerations) -> [f64; RIGID_STATES] {
        Self {
            position_ned_m: self.velocity_ned_m_s(),
            velocity_body_m_s: accelerations.velocity_rate_body_m_s2,
            attitude: self.attitude.rate(self.rates_rad_s),
            rates_rad_s: accelerations.angular_rad_s2,
        }
        .to_array()
    }

    /// Rates of change of u, v, w and p, q, r under a force and a moment in body axes and under gravity.
    ///
    /// $$ \dot v = \frac{F}{m} + g - \omega \times v, \quad I \dot\omega = M - \omega \times H $$
    ///
    /// # Source
    /// Paper, Table 2, with r p in the pitching moment.
    #[inline(always)]
    #[must_use]
    pub fn accelerations(
        &self,
        mass: &MassProperties,
        gravity_m_s2: f64,
        force_n: Vector3,
        moment_n_m: Vector3,
    ) -> Accelerations {
        let weight = self.attitude.to_body(Vector3::new(0.0, 0.0, gravity_m_s2));
        let turning = self.rates_rad_s.cross(self.velocity_body_m_s);
        Accelerations {
            velocity_rate_body_m_s2: (1.0 / mass.mass_kg) * force_n + weight - turning,
            angular_rad_s2: mass.angular_acceleration(self.rates_rad_s, moment_n_m),
        }
    }

    /// Kinetic energy of motion and rotation in J, without the engine's rotor.
    #[must_use]
    pub fn kinetic_energy_j(&self, mass: &MassProperties) -> f64 {
        let square = self.velocity_body_m_s.dot(self.velocity_body_m_s);
        0.5 * mass.mass_kg * square + mass.rotational_energy_j(self.rates_rad_s)
    }

    /// Angular momentum about the centre of gravity in north, east, down.
    #[must_use]
    pub fn angular_momentum_ned(&self, mass: &MassProperties) -> Vector3 {
        self.attitude.to_ned(mass.angular_momentum(self.rates_rad_s))
    }
}

/// What a force and a moment do to a body at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accelerations {
    /// Rates of change of the components u, v, w.
    pub velocity_rate_body_m_s2: Vector3,
    /// Rates of change of p, q, r.
    pub angular_rad_s2: Vector3,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_survives_the_way_to_numbers_and_back() {
        let state = RigidState {
            position_ned_m: Vector3::new(1.0, 2.0, -3.0),
            velocity_body_m_s: Vector3::new(4.0, 5.0, 6.0),
            attitude: Quaternion { w: 0.5, x: -0.5, y: 0.5, z: 0.5 },
            rates_rad_s: Vector3::new(7.0, 8.0, 9.0),
        };
        assert_eq!(RigidState::from_array(&state.to_array()), state);
        assert_eq!(state.altitude_m().to_bits(), 3.0_f64.to_bits());
    }
}

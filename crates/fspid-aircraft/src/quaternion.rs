//! Attitude without a singularity.

use crate::vector::Vector3;

/// Turns body axes (forward, right, down) into north, east, down; scalar part first.
///
/// Every operation divides by the square of the length, so a quaternion that rounding has made longer or shorter than
/// one still is a pure rotation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quaternion {
    /// Scalar part.
    pub w: f64,
    /// Vector part along x.
    pub x: f64,
    /// Vector part along y.
    pub y: f64,
    /// Vector part along z.
    pub z: f64,
}

/// Bank, pitch and heading: the body is turned by heading about down, then pitch about right, then bank about forward.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EulerAngles {
    /// Bank, right wing down positive.
    pub phi_rad: f64,
    /// Pitch, nose up positive.
    pub theta_rad: f64,
    /// Heading, from north over east.
    pub psi_rad: f64,
}

impl Quaternion {
    /// Level, heading north.
    pub const LEVEL: Self = Self { w: 1.0, x: 0.0, y: 0.0, z: 0.0 };

    /// Attitude of three Euler angles.
    ///
    /// $$ q = q_\psi \otimes q_\theta \otimes q_\phi $$
    #[must_use]
    pub fn from_euler(angles: EulerAngles) -> Self {
        let (sin_phi, cos_phi) = libm::sincos(0.5 * angles.phi_rad);
        let (sin_theta, cos_theta) = libm::sincos(0.5 * angles.theta_rad);
        let (sin_psi, cos_psi) = libm::sincos(0.5 * angles.psi_rad);
        Self {
            w: cos_phi * cos_theta * cos_psi + sin_phi * sin_theta * sin_psi,
            x: sin_phi * cos_theta * cos_psi - cos_phi * sin_theta * sin_psi,
            y: cos_phi * sin_theta * cos_psi + sin_phi * cos_theta * sin_psi,
            z: cos_phi * cos_theta * sin_psi - sin_phi * sin_theta * cos_psi,
        }
    }

    /// Euler angles: pitch within ±90°, bank and heading within ±180°.
    ///
    /// Straight up or down, bank and heading are the same turn; then their split is arbitrary but finite.
    #[must_use]
    pub fn to_euler(self) -> EulerAngles {
        let [bank_y, bank_x, sin_theta, _, forward_east, forward_north] = self.angle_sides();
        let cos_theta = libm::hypot(forward_north, forward_east);
        EulerAngles {
            phi_rad: libm::atan2(bank_y, bank_x),
            theta_rad: libm::atan2(sin_theta, cos_theta),
            psi_rad: libm::atan2(forward_east, forward_north),
        }
    }

    /// What the angles of bank, pitch and heading are the arc tangents of: above, below. The cosine of the pitch is left open;
    /// it is the length of the last two.
    #[inline(always)]
    pub(crate) fn angle_sides(self) -> [f64; 6] {
        let Self { w, x, y, z } = self.normalised();
        // sin θ and cos θ apart: an arc sine alone loses half the digits near ±90°.
        let forward_north = 1.0 - 2.0 * (y * y + z * z);
        let forward_east = 2.0 * (x * y + w * z);
        let sin_theta = 2.0 * (w * y - x * z);
        let (bank_y, bank_x) = (2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y));
        [bank_y, bank_x, sin_theta, 0.0, forward_east, forward_north]
    }

    /// The same rotation with length one.
    #[inline(always)]
    #[must_use]
    pub fn normalised(self) -> Self {
        let scale = 1.0 / self.norm_squared().sqrt();
        Self { w: self.w * scale, x: self.x * scale, y: self.y * scale, z: self.z * scale }
    }

    /// Square of the length: 1 but for rounding.
    #[inline(always)]
    #[must_use]
    pub fn norm_squared(self) -> f64 {
        self.w * self.w + self.x * self.x + self.y * self.y + self.z * self.z
    }

    /// A vector of body axes in north, east, down.
    #[inline(always)]
    #[must_use]
    pub fn to_ned(self, body: Vector3) -> Vector3 {
        self.rotate(self.axis(), body)
    }

    /// A vector of north, east, down in body axes.
    #[inline(always)]
    #[must_use]
    pub fn to_body(self, ned: Vector3) -> Vector3 {
        self.rotate(-self.axis(), ned)
    }

    #[inline(always)]
    fn axis(self) -> Vector3 {
        Vector3::new(self.x, self.y, self.z)
    }

    /// $$ v' = v + \frac{2}{|q|^2} \left( w a \times v + a \times (a \times v) \right) $$
    #[inline(always)]
    fn rotate(self, axis: Vector3, vector: Vector3) -> Vector3 {
        let turned = axis.cross(vector);
        let scale = 2.0 / self.norm_squared();
        vector + scale * (self.w * turned + axis.cross(turned))
    }

    /// Rate of change at body rates in rad/s; its length is kept by it.
    ///
    /// $$ \dot q = \tfrac{1}{2} q \otimes (0, p, q, r) $$
    #[inline(always)]
    #[must_use]
    pub fn rate(self, rates_rad_s: Vector3) -> Self {
        let Vector3 { x: roll, y: pitch, z: yaw } = 0.5 * rates_rad_s;
        Self {
            w: -self.x * roll - self.y * pitch - self.z * yaw,
            x: self.w * roll + self.y * yaw - self.z * pitch,
            y: self.w * pitch + self.z * roll - self.x * yaw,
            z: self.w * yaw + self.x * pitch - self.y * roll,
        }
    }

    /// The components, scalar first.
    #[must_use]
    pub const fn to_array(self) -> [f64; 4] {
        [self.w, self.x, self.y, self.z]
    }
}

impl EulerAngles {
    /// Rate of change of the three angles at body rates in rad/s; singular at a pitch of ±90°.
    ///
    /// $$ \dot\phi = p + (q \sin\phi + r \cos\phi) \tan\theta, \quad
    ///    \dot\theta = q \cos\phi - r \sin\phi, \quad
    ///    \dot\psi = (q \sin\phi + r \cos\phi) / \cos\theta $$
    ///
    /// # Source
    /// Paper, Table 2.
    #[must_use]
    pub fn rate(self, rates_rad_s: Vector3) -> Vector3 {
        let (sin_phi, cos_phi) = libm::sincos(self.phi_rad);
        let (sin_theta, cos_theta) = libm::sincos(self.theta_rad);
        let sideways = rates_rad_s.y * sin_phi + rates_rad_s.z * cos_phi;
        Vector3::new(
            rates_rad_s.x + sideways * sin_theta / cos_theta,
            rates_rad_s.y * cos_phi - rates_rad_s.z * sin_phi,
            sideways / cos_theta,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const QUARTER: f64 = core::f64::consts::FRAC_PI_2;

    fn attitude(phi_rad: f64, theta_rad: f64, psi_rad: f64) -> Quaternion {
        Quaternion::from_euler(EulerAngles { phi_rad, theta_rad, psi_rad })
    }

    fn assert_near(found: Vector3, expected: Vector3, tolerance: f64) {
        assert!((found - expected).norm() < tolerance, "{found:?} is not {expected:?}");
    }

    #[test]
    fn nose_up_points_forward_up_and_right_bank_points_right_down() {
        let forward = Vector3::new(1.0, 0.0, 0.0);
        let right = Vector3::new(0.0, 1.0, 0.0);
        let (up, down) = (Vector3::new(0.0, 0.0, -1.0), Vector3::new(0.0, 0.0, 1.0));
        assert_near(attitude(0.0, QUARTER, 0.0).to_ned(forward), up, 1e-15);
        assert_near(attitude(QUARTER, 0.0, 0.0).to_ned(right), down, 1e-15);
        assert_near(attitude(0.0, 0.0, QUARTER).to_ned(forward), right, 1e-15);
    }

    #[test]
    fn straight_up_the_angles_stay_finite() {
        let angles = attitude(0.3, QUARTER, 1.0).to_euler();
        assert!((angles.theta_rad - QUARTER).abs() < 1e-7);
        assert!(angles.phi_rad.is_finite() && angles.psi_rad.is_finite());
    }

    proptest! {
        #[test]
        fn angles_come_back(phi in -3.1..3.1, theta in -1.57..1.57, psi in -3.1..3.1) {
            let back = attitude(phi, theta, psi).to_euler();
            let near = |found: f64, asked: f64| (found - asked).abs() < 1e-12;
            prop_assert!(near(back.theta_rad, theta));
            prop_assert!((back.phi_rad - phi).abs() < 1e-12 / libm::cos(theta));
            prop_assert!((back.psi_rad - psi).abs() < 1e-12 / libm::cos(theta));
        }

        #[test]
        fn turning_there_and_back_changes_nothing_whatever_the_length(
            phi in -3.1..3.1, theta in -1.5..1.5, length in 0.5..2.0, x in -9.0..9.0, y in -9.0..9.0,
        ) {
            let Quaternion { w, x: qx, y: qy, z } = attitude(phi, theta, 0.7);
            let stretched = Quaternion { w: w * length, x: qx * length, y: qy * length, z: z * length };
            let vector = Vector3::new(x, y, 1.0);
            prop_assert!((stretched.to_body(stretched.to_ned(vector)) - vector).norm() < 1e-13);
            prop_assert!((stretched.to_ned(vector).norm() - vector.norm()).abs() < 1e-13);
        }

        #[test]
        fn rates_of_the_angles_and_of_the_quaternion_agree(
            phi in -3.0..3.0, theta in -1.2..1.2, p in -1.0..1.0, q in -1.0..1.0, r in -1.0..1.0,
        ) {
            let angles = EulerAngles { phi_rad: phi, theta_rad: theta, psi_rad: 0.4 };
            let rates = Vector3::new(p, q, r);
            let step = 1e-6;
            let moved = |sign: f64| {
                let start = Quaternion::from_euler(angles);
                let rate = start.rate(rates);
                let [w, x, y, z] = start.to_array();
                let dt = sign * step;
                let [dw, dx, dy, dz] = rate.to_array().map(|value| value * dt);
                Quaternion { w: w + dw, x: x + dx, y: y + dy, z: z + dz }.to_euler()
            };
            let (ahead, behind) = (moved(1.0), moved(-1.0));
            let difference = Vector3::new(
                ahead.phi_rad - behind.phi_rad,
                ahead.theta_rad - behind.theta_rad,
                ahead.psi_rad - behind.psi_rad,
            );
            prop_assert!(((0.5 / step) * difference - angles.rate(rates)).norm() < 1e-8);
        }
    }
}

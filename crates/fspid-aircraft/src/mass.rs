//! Mass and moments of inertia.

use crate::error::AircraftError;
use crate::vector::Vector3;

/// Mass properties of a rigid body whose xz plane is a plane of symmetry, about its centre of gravity in body axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MassProperties {
    /// Mass.
    pub mass_kg: f64,
    /// Moment of inertia about the forward axis.
    pub ix_kg_m2: f64,
    /// Moment of inertia about the right axis.
    pub iy_kg_m2: f64,
    /// Moment of inertia about the downward axis.
    pub iz_kg_m2: f64,
    /// Product of inertia $\int x z\ dm$: positive with the mass ahead low and the mass behind high.
    pub ixz_kg_m2: f64,
    /// Angular momentum of the engine's rotor along the forward axis.
    pub engine_kg_m2_s: f64,
}

impl MassProperties {
    /// Checks that a body can have these properties.
    ///
    /// # Errors
    /// A mass or moment of inertia that is not above zero, a product of inertia that is too large.
    pub fn validate(&self) -> Result<(), AircraftError> {
        AircraftError::unless_positive("mass in kg", self.mass_kg)?;
        AircraftError::unless_positive("moment of inertia Ix in kg m²", self.ix_kg_m2)?;
        AircraftError::unless_positive("moment of inertia Iy in kg m²", self.iy_kg_m2)?;
        AircraftError::unless_positive("moment of inertia Iz in kg m²", self.iz_kg_m2)?;
        AircraftError::unless_finite("engine momentum in kg m²/s", self.engine_kg_m2_s)?;
        if self.determinant() > 0.0 { Ok(()) } else { Err(self.impossible()) }
    }

    fn impossible(&self) -> AircraftError {
        AircraftError::ImpossibleInertia {
            ix_kg_m2: self.ix_kg_m2,
            iz_kg_m2: self.iz_kg_m2,
            ixz_kg_m2: self.ixz_kg_m2,
        }
    }

    /// $\Gamma = I_x I_z - I_{xz}^2$.
    #[inline(always)]
    fn determinant(&self) -> f64 {
        self.ix_kg_m2 * self.iz_kg_m2 - self.ixz_kg_m2 * self.ixz_kg_m2
    }

    /// The same body in axes turned nose up by an angle about the right axis.
    ///
    /// From body axes to the stability axes of a flight at an angle of attack the turn is nose down by that angle.
    ///
    /// $$ I_x' = I_x \cos^2\epsilon + I_z \sin^2\epsilon + I_{xz} \sin 2\epsilon, \quad
    ///    I_{xz}' = \tfrac{1}{2} (I_z - I_x) \sin 2\epsilon + I_{xz} \cos 2\epsilon $$
    /// with the angle nose up $\epsilon$; the engine's momentum stays along the forward axis, which is exact for none
    /// and good to $1 - \cos\epsilon$ otherwise.
    #[must_use]
    pub fn turned_nose_up(&self, angle_rad: f64) -> Self {
        let (sin, cos) = libm::sincos(angle_rad);
        let (ix, iz, ixz) = (self.ix_kg_m2, self.iz_kg_m2, self.ixz_kg_m2);
        let both = 2.0 * sin * cos;
        Self {
            ix_kg_m2: ix * cos * cos + iz * sin * sin + ixz * both,
            iz_kg_m2: ix * sin * sin + iz * cos * cos - ixz * both,
            ixz_kg_m2: 0.5 * (iz - ix) * both + ixz * (cos * cos - sin * sin),
            ..*self
        }
    }

    /// Angular momentum in kg m²/s at body rates, with the engine's.
    ///
    /// $$ H = (I_x p - I_{xz} r + h_E,\ I_y q,\ I_z r - I_{xz} p) $$
    #[inline(always)]
    #[must_use]
    pub fn angular_momentum(&self, rates_rad_s: Vector3) -> Vector3 {
        let Vector3 { x: p, y: q, z: r } = rates_rad_s;
        Vector3::new(
            self.ix_kg_m2 * p - self.ixz_kg_m2 * r + self.engine_kg_m2_s,
            self.iy_kg_m2 * q,
            self.iz_kg_m2 * r - self.ixz_kg_m2 * p,
        )
    }

    /// Angular acceleration in rad/s² at body rates under a moment in N m about the centre of gravity.
    ///
    /// $$ I \dot\omega = M - \omega \times H $$
    /// which written out is
    /// $$ M = I_y \dot q + r p (I_x - I_z) + I_{xz}(p^2 - r^2) + r h_E $$
    /// in pitch.
    ///
    /// # Source
    /// Paper, Table 2. The paper prints r q for r p in pitch; with it a body gains energy out of nothing.
    #[inline(always)]
    #[must_use]
    pub fn angular_acceleration(&self, rates_rad_s: Vector3, moment_n_m: Vector3) -> Vector3 {
        let turning = rates_rad_s.cross(self.angular_momentum(rates_rad_s));
        let Vector3 { x: l, y: m, z: n } = moment_n_m - turning;
        let scale = 1.0 / self.determinant();
        Vector3::new(
            scale * (self.iz_kg_m2 * l + self.ixz_kg_m2 * n),
            m / self.iy_kg_m2,
            scale * (self.ixz_kg_m2 * l + self.ix_kg_m2 * n),
        )
    }

    /// Energy of rotation in J, without the engine's rotor.
    ///
    /// $$ T = \tfrac{1}{2} \omega \cdot I \omega $$
    #[must_use]
    pub fn rotational_energy_j(&self, rates_rad_s: Vector3) -> f64 {
        let engine = Vector3::new(self.engine_kg_m2_s, 0.0, 0.0);
        0.5 * rates_rad_s.dot(self.angular_momentum(rates_rad_s) - engine)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn body() -> MassProperties {
        MassProperties {
            mass_kg: 9_000.0,
            ix_kg_m2: 12_875.0,
            iy_kg_m2: 75_674.0,
            iz_kg_m2: 85_552.0,
            ixz_kg_m2: 1_331.0,
            engine_kg_m2_s: 217.0,
        }
    }

    /// The equations of the paper's Table 2 with r p, solved for the derivatives, as textbooks print them.
    fn printed(body: &MassProperties, rates: Vector3, moment: Vector3) -> Vector3 {
        let MassProperties { ix_kg_m2: ix, iy_kg_m2: iy, iz_kg_m2: iz, .. } = *body;
        let (ixz, engine) = (body.ixz_kg_m2, body.engine_kg_m2_s);
        let (Vector3 { x: p, y: q, z: r }, Vector3 { x: l, y: m, z: n }) = (rates, moment);
        let gamma = ix * iz - ixz * ixz;
        let roll = ixz * (ix - iy + iz) * p * q - (iz * (iz - iy) + ixz * ixz) * q * r + iz * l;
        let yaw = ((ix - iy) * ix + ixz * ixz) * p * q - ixz * (ix - iy + iz) * q * r + ixz * l;
        Vector3::new(
            (roll + ixz * n + ixz * q * engine) / gamma,
            ((iz - ix) * p * r - ixz * (p * p - r * r) + m - r * engine) / iy,
            (yaw + ix * n + ix * q * engine) / gamma,
        )
    }

    proptest! {
        #[test]
        fn accelerations_are_those_of_the_solved_equations(
            p in -2.0..2.0, q in -2.0..2.0, r in -2.0..2.0, l in -1e4..1e4, m in -1e4..1e4, n in -1e4..1e4,
        ) {
            let (rates, moment) = (Vector3::new(p, q, r), Vector3::new(l, m, n));
            let found = body().angular_acceleration(rates, moment);
            prop_assert!((found - printed(&body(), rates, moment)).norm() < 1e-13 * (1.0 + found.norm()));
        }

        #[test]
        fn turning_the_axes_keeps_the_energy(angle in -1.0..1.0, p in -2.0..2.0, q in -2.0..2.0, r in -2.0..2.0) {
            let body = MassProperties { engine_kg_m2_s: 0.0, ..body() };
            let (sin, cos) = libm::sincos(angle);
            // Nose-up axes see the forward axis tilted: x' = x cos − z sin.
            let turned = Vector3::new(p * cos - r * sin, q, p * sin + r * cos);
            let before = body.rotational_energy_j(Vector3::new(p, q, r));
            let after = body.turned_nose_up(angle).rotational_energy_j(turned);
            prop_assert!((after - before).abs() < 1e-12 * (1.0 + before));
        }
    }

    #[test]
    fn bodies_that_cannot_be_are_refused() {
        let flat = MassProperties { ixz_kg_m2: 1e6, ..body() };
        assert!(matches!(flat.validate(), Err(AircraftError::ImpossibleInertia { .. })));
        let light = MassProperties { mass_kg: 0.0, ..body() };
        assert!(matches!(light.validate(), Err(AircraftError::NotPositive { .. })));
        let broken = MassProperties { ixz_kg_m2: f64::NAN, ..body() };
        assert!(broken.validate().is_err());
        assert_eq!(body().validate(), Ok(()));
    }
}

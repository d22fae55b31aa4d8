//! Fuel that is burnt: mass, centre of gravity and inertia of a body with a tank.

use crate::error::AircraftError;
use crate::mass::MassProperties;

/// A body and the fuel in its tank, a point of mass on the forward axis.
///
/// With the mass $m_0$ without fuel, a tank at $d$ from the centre of gravity of that, and fuel $f$:
///
/// $$ m = m_0 + f, \qquad I = I_0 + \frac{m_0 f}{m_0 + f} d^2 \quad \text{for } I_y \text{ and } I_z $$
///
/// What fuel has of inertia about its own tank, and its sloshing, are not in it. Fuel leaves with the velocity and the
/// rotation of the place where it is: thrust is the net force that data print, so that $m \dot v = F$ and
/// $I \dot \omega + \omega \times I \omega = M$ hold with the mass of the moment, and no term of $\dot m$ is left over. The
/// centre of gravity, whose motion is flown, moves along the fuselage by millimetres a minute; that velocity is left out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FuelledBody {
    /// Without fuel, about its own centre of gravity.
    empty: MassProperties,
    full_kg: f64,
    /// Tank behind the centre of gravity with all fuel, m.
    tank_aft_m: f64,
}

/// How much fuel an engine takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Consumption {
    /// The same all the time, kg/s.
    Flow {
        /// kg/s.
        kg_s: f64,
    },
    /// By thrust, kg/(N s).
    ThrustSpecific {
        /// kg/(N s).
        kg_n_s: f64,
    },
}

impl Consumption {
    /// Fuel burnt in a second at a thrust, kg; none for a thrust that brakes.
    #[must_use]
    pub fn rate_kg_s(self, thrust_n: f64) -> f64 {
        match self {
            Self::Flow { kg_s } => kg_s,
            Self::ThrustSpecific { kg_n_s } => kg_n_s * thrust_n.max(0.0),
        }
    }
}

impl FuelledBody {
    /// A body that has these properties with that much fuel, in a tank behind its centre of gravity.
    ///
    /// # Errors
    /// Fuel that is not above zero or not less than the body; a tank so far off that what remains is no body.
    pub fn new(
        loaded: MassProperties,
        full_kg: f64,
        tank_aft_m: f64,
    ) -> Result<Self, AircraftError> {
        loaded.validate()?;
        AircraftError::unless_positive("fuel in kg", full_kg)?;
        AircraftError::unless_finite("place of the tank in m", tank_aft_m)?;
        let empty_kg = loaded.mass_kg - full_kg;
        AircraftError::unless_positive("mass without fuel in kg", empty_kg)?;
        let mut body = Self { empty: loaded, full_kg, tank_aft_m };
        body.empty.mass_kg = empty_kg;
        let apart = body.apart_kg_m2(full_kg);
        body.empty.iy_kg_m2 -= apart;
        body.empty.iz_kg_m2 -= apart;
        body.empty.validate()?;
        Ok(body)
    }

    /// Fuel at the start, kg.
    #[must_use]
    pub fn full_kg(&self) -> f64 {
        self.full_kg
    }

    /// The body with that much fuel; with more than at the start with that, with less than none with none.
    #[must_use]
    pub fn with(&self, fuel_kg: f64) -> MassProperties {
        let fuel_kg = fuel_kg.min(self.full_kg).max(0.0);
        let apart = self.apart_kg_m2(fuel_kg);
        MassProperties {
            mass_kg: self.empty.mass_kg + fuel_kg,
            iy_kg_m2: self.empty.iy_kg_m2 + apart,
            iz_kg_m2: self.empty.iz_kg_m2 + apart,
            ..self.empty
        }
    }

    /// How far the centre of gravity is behind that with all fuel, m.
    #[must_use]
    pub fn cg_aft_m(&self, fuel_kg: f64) -> f64 {
        let fuel_kg = fuel_kg.min(self.full_kg).max(0.0);
        self.tank_aft_m * (fuel_kg - self.full_kg) / (self.empty.mass_kg + fuel_kg)
    }

    /// What the fuel's place adds to the moments of inertia, kg m².
    fn apart_kg_m2(&self, fuel_kg: f64) -> f64 {
        let empty_kg = self.empty.mass_kg;
        // From the tank to the centre of gravity without fuel.
        let arm_m = self.tank_aft_m * (empty_kg + self.full_kg) / empty_kg;
        empty_kg * fuel_kg / (empty_kg + fuel_kg) * arm_m * arm_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn loaded() -> MassProperties {
        MassProperties {
            mass_kg: 1000.0,
            ix_kg_m2: 1000.0,
            iy_kg_m2: 3000.0,
            iz_kg_m2: 3500.0,
            ixz_kg_m2: 50.0,
            engine_kg_m2_s: 0.0,
        }
    }

    /// Two points of mass on a line, their sum taken by hand: 800 kg without fuel and what is left of 200 kg.
    #[test]
    fn the_body_is_that_of_two_points_on_a_line() {
        let body = FuelledBody::new(loaded(), 200.0, 1.5).expect("a body");
        let empty_at_m = -200.0 * 1.5 / 800.0;
        let own = 3000.0 - 800.0 * empty_at_m * empty_at_m - 200.0 * 1.5 * 1.5;
        for fuel_kg in [200.0, 130.0, 40.0, 0.0] {
            let mass_kg = 800.0 + fuel_kg;
            let cg_m = (800.0 * empty_at_m + fuel_kg * 1.5) / mass_kg;
            let (to_empty, to_tank) = (empty_at_m - cg_m, 1.5 - cg_m);
            let iy = own + 800.0 * to_empty * to_empty + fuel_kg * to_tank * to_tank;
            let found = body.with(fuel_kg);
            assert!((found.mass_kg - mass_kg).abs() < 1e-12);
            assert!((found.iy_kg_m2 - iy).abs() < 1e-9, "{fuel_kg}: {} {iy}", found.iy_kg_m2);
            assert!((found.iz_kg_m2 - iy - 500.0).abs() < 1e-9);
            assert!((body.cg_aft_m(fuel_kg) - cg_m).abs() < 1e-12);
        }
    }

    #[test]
    fn fuel_that_no_body_has_is_refused() {
        for (fuel_kg, aft_m) in
            [(0.0, 0.0), (1000.0, 0.0), (f64::NAN, 0.0), (200.0, f64::NAN), (200.0, 10.0)]
        {
            assert!(FuelledBody::new(loaded(), fuel_kg, aft_m).is_err(), "{fuel_kg} {aft_m}");
        }
    }

    #[test]
    fn an_engine_that_brakes_makes_no_fuel() {
        let by_thrust = Consumption::ThrustSpecific { kg_n_s: 2e-5 };
        assert!((by_thrust.rate_kg_s(1000.0) - 0.02).abs() < 1e-15);
        assert!(by_thrust.rate_kg_s(-1000.0).abs() < 1e-300);
    }
}

//! Straight flight: which angle of attack, elevator and throttle hold it.

use fspid_aircraft::airspeed::calibrated_m_s;
use fspid_aircraft::{AirMotion, Flow, Trim};
use serde_json::{Value, json};

use super::condition::{Flight, Question, flight};
use super::facts::Facts;
use super::loading;
use fspid_scenario::aircraft::units::{KNOT_M_S, Kind};
use fspid_scenario::aircraft::{AircraftFailure, quantity};

/// A flight that is held.
#[derive(Clone, Debug, PartialEq)]
pub struct Trimmed {
    pub(super) flight: Flight,
    pub(super) trim: Trim,
}

/// Trims an aircraft for straight flight.
///
/// # Errors
/// [`AircraftFailure`]: as [`flight`], and a flight that cannot be held, with the limit in its way.
pub fn trim(question: &Question<'_>) -> Result<Trimmed, AircraftFailure> {
    let flight = flight(question)?;
    let trim = flight.trimmed()?;
    Ok(Trimmed { flight, trim })
}

impl Trimmed {
    fn flow(&self) -> Flow {
        self.flight.aircraft.flow(&self.trim.state, &AirMotion::STILL)
    }

    /// Mach number of the flight.
    pub(super) fn mach(&self) -> f64 {
        self.flow().mach()
    }

    /// The flight in a line: `trimmed at 53.6448 m/s, 0 m; standard atmosphere, …`.
    pub(super) fn condition(&self) -> String {
        let (units, target) = (self.flight.units, &self.trim.target);
        let speed = quantity(units, Kind::Speed, target.airspeed_m_s);
        let altitude = quantity(units, Kind::Length, target.altitude_m);
        let climb = quantity(units, Kind::Angle, target.flight_path_rad);
        let air = self.flight.air_in_words();
        let kink = match self.flight.aircraft.has_kink_at(&self.trim) {
            true => {
                "; right on a kink of the aircraft's data: slopes, and what follows from them, are means of two sides and of neither, so trim a little beside it"
            }
            false => "",
        };
        match target.flight_path_rad == 0.0 {
            true => format!("trimmed at {speed}, {altitude}; {air}{kink}"),
            false => format!("trimmed at {speed}, {altitude}, climbing {climb}; {air}{kink}"),
        }
    }

    /// The flight that was asked for.
    fn target(&self) -> Facts {
        let (target, flow) = (&self.trim.target, self.flow());
        let knots = target.airspeed_m_s / KNOT_M_S;
        let facts = Facts::default()
            .number("true airspeed", "airspeed", Kind::Speed, target.airspeed_m_s)
            .number("  in knots", "airspeed_kt", Kind::Plain, knots);
        let calibrated = calibrated_m_s(target.airspeed_m_s, &flow.air).ok();
        let facts = match calibrated {
            Some(speed) => {
                let name = "  calibrated, in knots";
                facts.number(name, "calibrated_airspeed_kt", Kind::Plain, speed / KNOT_M_S)
            }
            None => facts,
        };
        let facts = loading::facts(facts, &self.flight.loading, &self.flight.data);
        facts
            .number("Mach number", "mach", Kind::Plain, flow.mach())
            .number("altitude", "altitude", Kind::Length, target.altitude_m)
            .number("climb angle", "climb_angle", Kind::Angle, target.flight_path_rad)
            .number("density", "density", Kind::Density, flow.air.density_kg_m3)
            .number(
                "dynamic pressure",
                "dynamic_pressure",
                Kind::Pressure,
                flow.dynamic_pressure_pa(),
            )
    }

    /// What holds it.
    fn point(&self) -> Facts {
        let (trim, point) = (&self.trim, &self.trim.point);
        let theta_rad = point.alpha_rad + trim.target.flight_path_rad;
        let [alpha, theta, throttle] = self.names();
        let facts = Facts::default().number(alpha, "alpha", Kind::Angle, point.alpha_rad).number(
            theta,
            "theta",
            Kind::Angle,
            theta_rad,
        );
        self.fuselage(facts)
            .number(
                "elevator, trailing edge down positive",
                "elevator",
                Kind::Angle,
                point.elevator_rad,
            )
            .number(throttle, "throttle", Kind::Plain, point.throttle)
            .number("thrust", "thrust", Kind::Force, trim.thrust_n)
    }

    /// What angle of attack, pitch angle and throttle are called: tables have no reference.
    fn names(&self) -> [&'static str; 3] {
        match self.flight.data.derivatives() {
            Ok(_) => [
                "angle of attack, from the reference",
                "pitch angle, from the reference",
                "throttle, 1 at the reference",
            ],
            Err(_) => ["angle of attack", "pitch angle", "throttle, of its travel"],
        }
    }

    /// The angle of attack of the fuselage, where the reference is not along it.
    fn fuselage(&self, facts: Facts) -> Facts {
        let reference = self.flight.data.derivatives().map(|data| data.reference.alpha_rad);
        match reference {
            Ok(alpha_rad) if alpha_rad != 0.0 => {
                let alpha_rad = alpha_rad + self.trim.point.alpha_rad;
                facts.number(
                    "angle of attack of the fuselage",
                    "alpha_body",
                    Kind::Angle,
                    alpha_rad,
                )
            }
            _ => facts,
        }
    }

    /// What is left of the accelerations.
    fn residual(&self) -> Facts {
        let residual = &self.trim.residual;
        Facts::default()
            .number("forward", "forward", Kind::Acceleration, residual.forward_m_s2)
            .number("down", "down", Kind::Acceleration, residual.downward_m_s2)
            .number("in pitch", "pitch", Kind::AngularAcceleration, residual.pitch_rad_s2)
    }

    /// The trim for people.
    #[must_use]
    pub fn text(&self) -> String {
        let units = self.flight.units;
        format!(
            "{}\n{}\n\nflight\n{}\nheld by\n{}\nleft over after {} steps\n{}",
            self.flight.data.title,
            self.flight.air_in_words(),
            self.target().text(units),
            self.point().text(units),
            self.trim.iterations,
            self.residual().text(units),
        )
    }

    /// The trim for programs.
    #[must_use]
    pub fn json(&self) -> Value {
        let units = self.flight.units;
        json!({
            "aircraft": self.flight.data.name,
            "units": units.name(),
            "air": self.flight.air_name(),
            "gravity_m_s2": self.flight.aircraft.environment().gravity_m_s2,
            "flight": self.target().json(units),
            "trim": self.point().json(units),
            "residual": self.residual().json(units),
            "iterations": self.trim.iterations,
        })
    }
}

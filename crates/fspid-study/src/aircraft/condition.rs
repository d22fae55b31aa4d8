//! The flight that a question is about: which aircraft, how fast, how high, in which air.

use fspid_aircraft::aerodynamics::derivatives::{DerivativeModel, DragLaw, ThrustLaw};
use fspid_aircraft::atmosphere::{ALTITUDE_MAX_M, ALTITUDE_MIN_M};
use fspid_aircraft::data::{AircraftData, DerivativeData, Laws};
use fspid_aircraft::{Air, Aircraft, Environment, Trim, TrimTarget};

use super::failure::AircraftFailure;
use super::load::load;
use super::parse::quantity;
use super::units::{ANGLES, Kind, LENGTHS, SPEEDS, Units};
use crate::inference::Refused;

/// Which air and gravity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AirChoice {
    /// The standard atmosphere at the altitude, standard gravity.
    #[default]
    Standard,
    /// Density and gravity of the aircraft's source, at every altitude: the flight of its book.
    Source,
}

/// How drag depends on lift away from the reference.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DragChoice {
    /// Along the tangent at the reference.
    #[default]
    Linear,
    /// By the parabola with the same tangent.
    Polar,
}

/// How thrust depends on speed at a held throttle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ThrustChoice {
    /// Not at all.
    #[default]
    Constant,
    /// As the source's derivative says.
    WithSpeed,
}

/// A question about an aircraft in straight flight, as it is written.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Question<'a> {
    /// Name or file of the aircraft.
    pub aircraft: &'a str,
    /// True airspeed; that of the reference if left out.
    pub speed: Option<&'a str>,
    /// Altitude; that of the reference if left out.
    pub altitude: Option<&'a str>,
    /// Angle of the flight path, climbing positive; level if left out.
    pub climb_angle: Option<&'a str>,
    /// Units of bare numbers and of the answer.
    pub units: Units,
    /// Which air.
    pub air: AirChoice,
    /// Which drag.
    pub drag: DragChoice,
    /// Which thrust.
    pub thrust: ThrustChoice,
}

/// An aircraft that can be flown, and the flight that is asked about.
#[derive(Clone, Debug, PartialEq)]
pub struct Flight {
    pub(super) data: AircraftData,
    pub(super) aircraft: Aircraft<DerivativeModel>,
    pub(super) target: TrimTarget,
    pub(super) units: Units,
    pub(super) air: AirChoice,
}

impl Question<'_> {
    /// The aircraft alone.
    pub(super) fn data(&self) -> Result<AircraftData, AircraftFailure> {
        load(self.aircraft)
    }

    /// True where no flight is named, so that the source's own condition is meant.
    pub(super) fn is_at_reference(&self) -> bool {
        self.speed.is_none() && self.altitude.is_none() && self.climb_angle.is_none()
    }

    fn laws(&self) -> Laws {
        Laws {
            drag: match self.drag {
                DragChoice::Linear => DragLaw::Linear,
                DragChoice::Polar => DragLaw::Polar,
            },
            thrust: match self.thrust {
                ThrustChoice::Constant => ThrustLaw::Constant,
                ThrustChoice::WithSpeed => ThrustLaw::WithSpeed,
            },
        }
    }

    fn environment(&self, data: &DerivativeData) -> Environment {
        match self.air {
            AirChoice::Standard => Environment::STANDARD,
            AirChoice::Source => data.reference_environment(),
        }
    }

    /// The aircraft in the air that is asked for.
    pub(super) fn aircraft_of(
        &self,
        data: &AircraftData,
    ) -> Result<Aircraft<DerivativeModel>, AircraftFailure> {
        let environment = self.environment(data.derivatives()?);
        Ok(data.aircraft(self.laws(), environment)?)
    }

    /// The flight, every mistake in it at once.
    fn target(&self, data: &DerivativeData) -> Result<TrimTarget, Refused> {
        let mut problems = Vec::new();
        let units = self.units;
        let mut read = |option, text: Option<&str>, known: &[_], kind, without| match text {
            None => without,
            Some(text) => quantity(option, text, known, units.of(kind)).unwrap_or_else(|problem| {
                problems.push(problem);
                without
            }),
        };
        let reference = &data.reference;
        let airspeed_m_s =
            read("--speed", self.speed, &SPEEDS, Kind::Speed, reference.airspeed_m_s);
        let altitude_m =
            read("--altitude", self.altitude, &LENGTHS, Kind::Length, reference.altitude_m);
        let flight_path_rad = read("--climb-angle", self.climb_angle, &ANGLES, Kind::Angle, 0.0);
        if !(airspeed_m_s > 0.0) {
            problems.push("--speed must be above 0".to_owned());
        }
        if self.air == AirChoice::Standard && Air::standard(altitude_m).is_err() {
            let (min, max) = (ALTITUDE_MIN_M / 1000.0, ALTITUDE_MAX_M / 1000.0);
            problems.push(format!(
                "--altitude: the standard atmosphere is known from {min} to {max} km"
            ));
        }
        if !(flight_path_rad.abs() < std::f64::consts::FRAC_PI_2) {
            problems.push("--climb-angle must be between -90 and 90 deg".to_owned());
        }
        if !problems.is_empty() {
            return Err(Refused::all(problems));
        }
        Ok(TrimTarget { airspeed_m_s, altitude_m, flight_path_rad })
    }
}

/// The flight that a question is about.
///
/// # Errors
/// [`AircraftFailure`]: an aircraft that is not known or has only a linear model, numbers that cannot be used.
pub fn flight(question: &Question<'_>) -> Result<Flight, AircraftFailure> {
    let data = question.data()?;
    let derivatives = data.derivatives()?;
    let target = question.target(derivatives).map_err(AircraftFailure::Refused)?;
    let aircraft = question.aircraft_of(&data)?;
    Ok(Flight { aircraft, target, units: question.units, air: question.air, data })
}

impl Flight {
    /// The trim of the flight.
    pub(super) fn trimmed(&self) -> Result<Trim, AircraftFailure> {
        self.aircraft.trim(self.target).map_err(|failure| AircraftFailure::Trim {
            failure: Box::new(failure),
            units: self.units,
        })
    }

    /// The air in words.
    pub(super) fn air_in_words(&self) -> String {
        let gravity = self.aircraft.environment().gravity_m_s2;
        let gravity = super::failure::quantity(self.units, Kind::Acceleration, gravity);
        match self.air {
            AirChoice::Standard => format!("standard atmosphere, gravity {gravity}"),
            AirChoice::Source => format!("density of the source everywhere, gravity {gravity}"),
        }
    }

    /// The air for programs.
    pub(super) const fn air_name(&self) -> &'static str {
        match self.air {
            AirChoice::Standard => "standard",
            AirChoice::Source => "source",
        }
    }
}

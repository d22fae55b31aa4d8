//! The flight that a question is about: which aircraft, how fast, how high, in which air.

use fspid_aircraft::aerodynamics::derivatives::{DragLaw, ThrustLaw};
use fspid_aircraft::atmosphere::{ALTITUDE_MAX_M, ALTITUDE_MIN_M};
use fspid_aircraft::data::{AircraftData, Laws, Loading, ModelData, Reference};
use fspid_aircraft::{Air, Aircraft, ForceModel, Trim, TrimTarget};
use fspid_sim::aircraft::Forces;

use super::load::load_at;
use super::loading::{self, LoadingQuestion};
use super::parse::quantity;
use fspid_scenario::aircraft::AircraftFailure;
use fspid_scenario::aircraft::units::{ANGLES, Kind, LENGTHS, SPEEDS, Units};
use fspid_scenario::flyer::flyer;
use fspid_scenario::supervisor::Refused;

/// Which air and gravity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AirChoice {
    /// The standard atmosphere at the altitude, with standard gravity; for tables with the gravity of their file.
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
    /// How it is loaded.
    pub loading: LoadingQuestion<'a>,
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
    pub(super) aircraft: Aircraft<Forces>,
    pub(super) target: TrimTarget,
    pub(super) loading: Loading,
    pub(super) units: Units,
    pub(super) air: AirChoice,
}

impl Question<'_> {
    /// The aircraft alone, as loaded.
    pub(super) fn data(&self) -> Result<AircraftData, AircraftFailure> {
        let loading = self.read_loading()?;
        loading::loaded(load_at(self.aircraft, loading.cg_mac)?, loading)
    }

    fn read_loading(&self) -> Result<Loading, AircraftFailure> {
        self.loading.read(self.units).map_err(AircraftFailure::Refused)
    }

    /// True where no flight is named, so that the source's own condition is meant.
    pub(super) fn is_at_reference(&self) -> bool {
        let loading = self.loading == LoadingQuestion::default();
        self.speed.is_none() && self.altitude.is_none() && self.climb_angle.is_none() && loading
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

    /// The aircraft in the air that is asked for.
    pub(super) fn aircraft_of(
        &self,
        data: &AircraftData,
    ) -> Result<Aircraft<Forces>, AircraftFailure> {
        let laws = self.laws();
        if matches!(data.model, ModelData::Forces(_)) && laws != Laws::default() {
            let message = "--drag and --thrust are for derivatives; tables say it themselves";
            return Err(AircraftFailure::Refused(Refused::one(message.to_owned())));
        }
        Ok(flyer(data, laws, self.air == AirChoice::Source)?)
    }

    /// What has to be named, because the aircraft's source has no flight of its own.
    fn missing(&self, reference: Option<&Reference>) -> Vec<String> {
        let options = [("--speed", self.speed), ("--altitude", self.altitude)];
        let missing = options.iter().filter(|(_, text)| reference.is_none() && text.is_none());
        let told = |(option, _): &(&str, _)| {
            format!("{option} is missing: the aircraft is known by tables, not at one flight")
        };
        missing.map(told).collect()
    }

    /// The flight, every mistake in it at once.
    fn target(&self, reference: Option<&Reference>) -> Result<TrimTarget, Refused> {
        let mut problems = self.missing(reference);
        let units = self.units;
        let mut read = |option, text: Option<&str>, known: &[_], kind, without| match text {
            None => without,
            Some(text) => quantity(option, text, known, units.of(kind)).unwrap_or_else(|problem| {
                problems.push(problem);
                without
            }),
        };
        // What stands in for an option that is missing; the flight is refused then.
        let (airspeed_m_s, altitude_m) =
            reference.map_or((1.0, 0.0), |flight| (flight.airspeed_m_s, flight.altitude_m));
        let airspeed_m_s = read("--speed", self.speed, &SPEEDS, Kind::Speed, airspeed_m_s);
        let altitude_m = read("--altitude", self.altitude, &LENGTHS, Kind::Length, altitude_m);
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
    let reference = reference(&data)?;
    let target = question.target(reference).map_err(AircraftFailure::Refused)?;
    let aircraft = question.aircraft_of(&data)?;
    let (units, air, loading) = (question.units, question.air, question.read_loading()?);
    if !aircraft.model().has_engine() && question.climb_angle.is_some() {
        let message =
            "--climb-angle: the aircraft has no engine; at its speed its path is that of its glide";
        return Err(AircraftFailure::Refused(Refused::one(message.to_owned())));
    }
    Ok(Flight { aircraft, target, loading, units, air, data })
}

/// The flight of the aircraft's source; tables have none.
fn reference(data: &AircraftData) -> Result<Option<&Reference>, AircraftFailure> {
    match &data.model {
        ModelData::Forces(_) => Ok(None),
        _ => Ok(Some(&data.derivatives()?.reference)),
    }
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
        let gravity = fspid_scenario::aircraft::quantity(self.units, Kind::Acceleration, gravity);
        match self.air {
            AirChoice::Standard => {
                let own = matches!(self.data.model, ModelData::Forces(_));
                let whose = if own { " of the aircraft's file" } else { "" };
                format!("standard atmosphere, gravity {gravity}{whose}")
            }
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

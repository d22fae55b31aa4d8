//! The trim problem of an autopilot mode: the quantities to be held, and the straight flight that holds them within the
//! throttle's limits and along the ground track.

use fspid_aircraft::trim::{Held, Path, Power};
use fspid_aircraft::{ForceModel, Trim};

use super::{SAME, pitch_rad};
use crate::aircraft::AircraftPlant;
use crate::math::sin_cos;
use crate::scenario::Scenario;

/// An angle over the ground is turned into one through the air by the airspeed that it makes: so often.
const TURNS: usize = 12;

/// How the path is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Way {
    /// A pitch angle, rad.
    Pitch(f64),
    /// An angle of the path through the air, rad.
    Through(f64),
    /// An angle of the path over the ground, rad.
    OverGround(f64),
    /// A vertical speed over the ground, climbing positive, m/s.
    Climb(f64),
    /// An airspeed, m/s.
    Airspeed(f64),
}

/// What is to be held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wanted {
    pub(super) power: Power,
    pub(super) way: Way,
    pub(super) altitude_m: f64,
    /// How far a throttle that is moved may go.
    pub(super) throttle: [f64; 2],
    /// Least and largest pitch that is commanded, rad; none without an end.
    pub(super) pitch_rad: Option<[f64; 2]>,
}

/// Why there is no place to be asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Nowhere {
    /// There is no such flight within the limits where a mode would hold it.
    NoFlight,
    /// Nobody asks for one: a pitch that is held comes to nothing within them, or there is no such aircraft.
    NotAsked,
}

/// Air that stays as it is at the start of the flight, m/s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Air {
    /// Along the heading.
    pub(super) ahead_m_s: f64,
    pub(super) up_m_s: f64,
}

impl Air {
    /// Of a scenario.
    pub(super) fn of(scenario: &Scenario) -> Self {
        let Some(weather) = &scenario.surroundings.weather else { return Self::default() };
        let [north, east, down] =
            crate::air::sum_at(&weather.winds, &weather.course.place(0.0)).earth_m_s;
        let (sine, cosine) = sin_cos(weather.course.heading_rad);
        Self { ahead_m_s: north * cosine + east * sine, up_m_s: -down }
    }

    fn is_still(self) -> bool {
        self == Self::default()
    }
}

/// An aircraft from whose trim flights are looked for.
#[derive(Clone, Copy)]
pub(super) struct Seeker<'a> {
    pub(super) plant: &'a AircraftPlant,
    pub(super) air: Air,
}

impl Seeker<'_> {
    /// The flight in which this is held, or the pitch that may be commanded next to it.
    pub(super) fn end(&self, wanted: &Wanted) -> Result<Trim, Nowhere> {
        let none = match (wanted.way, wanted.power) {
            (Way::Pitch(_), Power::Throttle(_)) => Nowhere::NotAsked,
            _ => Nowhere::NoFlight,
        };
        let found = self.powered(wanted, wanted.way).ok_or(none)?;
        let theta_rad = pitch_rad(&found);
        // Further than the pitch that loops may command no path is held.
        match wanted.pitch_rad.map(|[least, most]| theta_rad.max(least).min(most)) {
            Some(kept_rad) if (kept_rad - theta_rad).abs() > SAME => {
                self.powered(wanted, Way::Pitch(kept_rad)).ok_or(Nowhere::NotAsked)
            }
            _ => Ok(found),
        }
    }

    /// With an airspeed as far as the throttle goes for it.
    fn powered(&self, wanted: &Wanted, way: Way) -> Option<Trim> {
        let found = self.along(wanted.power, way, wanted.altitude_m);
        let Power::Airspeed(airspeed_m_s) = wanted.power else { return found };
        let [least, most] = wanted.throttle;
        let is_within =
            |it: &Trim| it.point.throttle >= least - SAME && it.point.throttle <= most + SAME;
        let at = |end: f64| {
            let power = Power::Throttle(end);
            if end.is_finite() { self.along(power, way, wanted.altitude_m) } else { None }
        };
        // At its end a throttle stays where it leaves the airspeed short of what is held.
        let short = |it: &Trim| it.target.airspeed_m_s <= airspeed_m_s;
        let beyond = |it: &Trim| it.target.airspeed_m_s >= airspeed_m_s;
        found
            .filter(is_within)
            .or_else(|| at(most).filter(short))
            .or_else(|| at(least).filter(beyond))
    }

    fn along(&self, power: Power, way: Way, altitude_m: f64) -> Option<Trim> {
        let seek = |path: Path| {
            self.plant.aircraft().at_held(self.plant.trim(), &Held { power, path, altitude_m })
        };
        let climb = |over_ground_m_s: f64| Path::VerticalSpeed(over_ground_m_s - self.air.up_m_s);
        match way {
            Way::Pitch(theta_rad) => seek(Path::Pitch(theta_rad)),
            Way::Through(path_rad) => seek(Path::FlightPath(path_rad)),
            Way::Airspeed(airspeed_m_s) => seek(Path::Airspeed(airspeed_m_s)),
            Way::Climb(climb_m_s) => seek(climb(climb_m_s)),
            Way::OverGround(path_rad) if self.air.is_still() => seek(Path::FlightPath(path_rad)),
            Way::OverGround(path_rad) => {
                let mut at = *self.plant.trim();
                for _ in 0..TURNS {
                    let climb_m_s = self.ground_m_s(&at) * libm::tan(path_rad);
                    let next = seek(climb(climb_m_s))?;
                    let moved = next.target.airspeed_m_s / at.target.airspeed_m_s - 1.0;
                    at = next;
                    if moved.abs() < 0.1 * SAME {
                        return Some(at);
                    }
                }
                None
            }
        }
    }

    /// Speed over the ground.
    fn ground_m_s(&self, trim: &Trim) -> f64 {
        trim.target.airspeed_m_s * libm::cos(trim.target.flight_path_rad) + self.air.ahead_m_s
    }

    /// How fast a flight climbs over the ground, m/s.
    pub(super) fn climb_m_s(&self, trim: &Trim) -> f64 {
        trim.target.airspeed_m_s * libm::sin(trim.target.flight_path_rad) + self.air.up_m_s
    }

    /// The travel of its throttle.
    pub(super) fn throttle(&self) -> [f64; 2] {
        let travel = self.plant.aircraft().model().travel().throttle;
        [travel.min, travel.max]
    }
}

//! The trim problem of an autopilot mode: the quantities to be held, and the straight flight that holds them within the
//! limits of throttle and pitch and along the ground track.

use fspid_aircraft::trim::{Held, Path, Power};
use fspid_aircraft::{ForceModel, Trim};

use super::SAME;
use crate::aircraft::{AircraftPlant, pitch_rad};
use crate::autopilot::AtLimits;
use crate::math::sin_cos;
use crate::scenario::Scenario;

/// An angle over the ground is turned into one through the air by the airspeed that it makes: so often.
const TURNS: usize = 12;

/// So many airspeeds on the way to another one are asked whether the throttle suffices for it.
const ON_THE_WAY: usize = 5;

/// Who comes to another airspeed is taken to overshoot it by this part of the way, as throttles do that come from the other end of
/// their travel: where the throttle does not bring it back from there, it stands at its end.
const OVERSHOOT: f64 = 0.5;

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
    /// True for an altitude or a beam, which a path that is not quite theirs leaves further with time.
    pub(super) is_gathered: bool,
}

/// A flight that is found, and what stands at a limit in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct There {
    pub(super) trim: Trim,
    pub(super) at_limits: AtLimits,
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
    /// The airspeed that there was before.
    pub(super) from_m_s: f64,
}

impl Seeker<'_> {
    /// The flight in which this is held, or the pitch that may be commanded next to it.
    pub(super) fn end(&self, wanted: &Wanted) -> Result<There, Nowhere> {
        let none = match (wanted.way, wanted.power) {
            (Way::Pitch(_), Power::Throttle(_)) => Nowhere::NotAsked,
            _ => Nowhere::NoFlight,
        };
        // Further than the pitch that loops may command no path is held.
        let kept_rad = |trim: &Trim| {
            let theta_rad = pitch_rad(trim);
            let kept_rad = wanted.pitch_rad.map(|[least, most]| theta_rad.max(least).min(most))?;
            ((kept_rad - theta_rad).abs() > SAME).then_some(kept_rad)
        };
        let keeping = |kept_rad: f64| {
            let way = Way::Pitch(kept_rad);
            let free = self.along(wanted.power, way, wanted.altitude_m);
            let kept = self.powered(wanted, way, free).ok_or(Nowhere::NotAsked)?;
            Ok(There { at_limits: AtLimits { pitch: true, ..kept.at_limits }, ..kept })
        };
        // A path that pitch does not allow takes no throttle.
        let free = self.along(wanted.power, wanted.way, wanted.altitude_m);
        if let Some(kept_rad) = free.as_ref().and_then(kept_rad).filter(|_| !wanted.is_gathered) {
            return keeping(kept_rad);
        }
        let found = self.powered(wanted, wanted.way, free).ok_or(none)?;
        match kept_rad(&found.trim) {
            None => Ok(found),
            Some(_) if wanted.is_gathered => Err(Nowhere::NoFlight),
            Some(kept_rad) => keeping(kept_rad),
        }
    }

    /// With an airspeed as far as the throttle goes for it, and where it comes to that from the one before; `free` is what is found
    /// with a throttle without limits.
    fn powered(&self, wanted: &Wanted, way: Way, free: Option<Trim>) -> Option<There> {
        let there =
            |throttle| move |trim| There { trim, at_limits: AtLimits { throttle, pitch: false } };
        let Power::Airspeed(airspeed_m_s) = wanted.power else { return free.map(there(false)) };
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
        // Where it is known which way it would have to go it stands at that end; else at either.
        let at_most = || at(most).filter(short);
        let at_least = || at(least).filter(beyond);
        let found = match free {
            Some(trim) if is_within(&trim) => {
                Some(there(self.overshoots(wanted, way, &trim))(trim))
            }
            Some(trim) if trim.point.throttle > most => at_most().map(there(true)),
            Some(_) => at_least().map(there(true)),
            None => at_most().or_else(at_least).map(there(true)),
        };
        found.filter(|it| self.is_come_to(wanted, way, it.trim.target.airspeed_m_s))
    }

    /// The throttle that an airspeed takes.
    fn takes(&self, airspeed_m_s: f64, way: Way, altitude_m: f64) -> Option<f64> {
        let found = self.along(Power::Airspeed(airspeed_m_s), way, altitude_m)?;
        Some(found.point.throttle)
    }

    /// True where the throttle does not bring an airspeed that is come to back from a little beyond it.
    fn overshoots(&self, wanted: &Wanted, way: Way, trim: &Trim) -> bool {
        let airspeed_m_s = trim.target.airspeed_m_s;
        let [least, most] = wanted.throttle;
        let away_m_s = airspeed_m_s - self.from_m_s;
        if away_m_s.abs() <= SAME * airspeed_m_s {
            return false;
        }
        let takes = self.takes(airspeed_m_s + OVERSHOOT * away_m_s, way, wanted.altitude_m);
        takes.is_some_and(|takes| if away_m_s > 0.0 { takes < least } else { takes > most })
    }

    /// True where the throttle may be moved so far that every airspeed on the way from the one before to this one is left
    /// towards it.
    fn is_come_to(&self, wanted: &Wanted, way: Way, airspeed_m_s: f64) -> bool {
        let away_m_s = airspeed_m_s - self.from_m_s;
        if matches!(way, Way::Airspeed(_)) || away_m_s.abs() <= SAME * airspeed_m_s {
            return true;
        }
        let [least, most] = wanted.throttle;
        (0..ON_THE_WAY).all(|step| {
            let part = step as f64 / ON_THE_WAY as f64;
            let at_m_s = self.from_m_s + part * away_m_s;
            let takes = self.takes(at_m_s, way, wanted.altitude_m);
            takes.is_some_and(|takes| if away_m_s > 0.0 { takes < most } else { takes > least })
        })
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

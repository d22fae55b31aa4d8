//! Where a flight comes to that goes on: the airspeed and altitude to which set-points, the targets of modes, and configurations
//! lead, with the throttle as it is where nobody moves it.

use core::fmt;

use fspid_aircraft::trim::{Held, Path, Power};
use fspid_aircraft::{Trim, TrimTarget};
use fspid_numeric::units::degrees;

use crate::aircraft::{AircraftPlant, Change, Standing};
use crate::autopilot::{Autopilot, Mode, Moves, OuterLoop, Quantity, Target};
use crate::scenario::Scenario;

/// A mode that leads an aircraft away from where it started.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Led {
    /// Number of the mode, from 0.
    pub mode: usize,
    /// What is written that it holds, in SI units, if anything is.
    pub target: Option<(Quantity, f64)>,
    /// The airspeed to which it leads, m/s; none where it leads to no straight flight within the limits.
    pub airspeed_m_s: Option<f64>,
}

impl fmt::Display for Led {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "mode {} of the autopilot", self.mode + 1)?;
        if let Some((quantity, target)) = self.target {
            let (value, unit) = match quantity {
                Quantity::Altitude | Quantity::GlideSlope => (target, "m"),
                Quantity::VerticalSpeed | Quantity::Airspeed => (target, "m/s"),
                Quantity::FlightPath | Quantity::Heading => (degrees(target), "deg"),
            };
            // No more digits than say something.
            let value = libm::round(value * 1e6) / 1e6;
            write!(f, ", which holds {} at {value} {unit},", quantity.in_words())?;
        }
        match self.airspeed_m_s {
            Some(airspeed_m_s) => write!(
                f,
                " brings the aircraft in time to {airspeed_m_s:.1} m/s, with the throttle as it is if nobody moves it"
            ),
            None => f.write_str(
                " leads to no straight flight within the limits of the aircraft's data and controls, with the throttle as it is where nobody moves it",
            ),
        }
    }
}

/// Where a flight comes to.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    /// What leads there, where it is a mode.
    pub(crate) led: Option<Led>,
    /// The aircraft there; none where nothing is found within its limits.
    pub(crate) plant: Option<AircraftPlant>,
}

/// Targets of a mode by the place of their quantity, in SI units, as far as they are written.
type Targets = [Option<f64>; Quantity::ALL.len()];

/// Places that differ by less, as a part of airspeed and in rad, were asked.
const SAME: f64 = 1e-4;
/// The same of altitude, m.
const SAME_M: f64 = 1.0;

/// A scenario, the trim that it starts from, and what its modes are to hold.
struct Walk<'a> {
    scenario: &'a Scenario,
    start: Trim,
    targets: Vec<Targets>,
}

/// The places to which a scenario leads beside the trims of its aircraft: one for each mode of its autopilot that may be flown
/// with an aircraft that it comes to stand with, and one for each such aircraft without an autopilot.
pub(crate) fn places(
    scenario: &Scenario,
    aircraft: &AircraftPlant,
    standings: &[Standing],
) -> Vec<Place> {
    let targets = scenario.autopilot.as_ref().map(targets).unwrap_or_default();
    let walk = Walk { scenario, start: *aircraft.trim(), targets };
    let mut ends: Vec<Vec<Option<Trim>>> = Vec::new();
    let mut all = Vec::new();
    for (number, standing) in standings.iter().enumerate() {
        let mut own = Vec::new();
        for mode in 0..walk.modes().max(1) {
            let before = ends.get(number.wrapping_sub(1)).and_then(|it| it.get(mode));
            let begins_before =
                standing.by == Change::Fuel || walk.begins_s(mode) < standing.from_s;
            let from = if begins_before { before } else { own.get(mode.wrapping_sub(1)) };
            let there = walk.leads_to(standing, mode, from.copied().flatten().as_ref());
            all.extend(walk.place(standing, mode, there));
            own.push(there.ok());
        }
        ends.push(own);
    }
    all
}

/// What is written that each mode holds, or has to be so when it begins.
fn targets(autopilot: &Autopilot) -> Vec<Targets> {
    let mut all: Vec<Targets> = Vec::new();
    let mut before: Option<&Mode> = None;
    for mode in autopilot.modes() {
        let last = all.last().copied().unwrap_or_default();
        all.push(Quantity::ALL.map(|quantity| match mode.target(quantity) {
            Target::Value(value) => Some(value),
            Target::Hold if before.is_some_and(|it| is_kept(autopilot, it, mode, quantity)) => {
                last.get(quantity.place()).copied().flatten()
            }
            Target::Hold => {
                let mut conditions = mode.entry.conditions.iter();
                conditions.find(|it| it.quantity == quantity).map(|it| it.value)
            }
        }));
        before = Some(mode);
    }
    all
}

/// True where what holds a quantity stays engaged from one mode to the next.
fn is_kept(autopilot: &Autopilot, one: &Mode, next: &Mode, quantity: Quantity) -> bool {
    let both = one.total_energy && next.total_energy;
    let by_energy = both && matches!(quantity, Quantity::Altitude | Quantity::Airspeed);
    let stays = |number: &usize| {
        let holds = autopilot.loops().get(*number).is_some_and(|it| it.holds == quantity);
        holds && next.engaged.contains(number)
    };
    by_energy || one.engaged.iter().any(stays)
}

/// Why a flight leads to no place that is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Nowhere {
    /// There is none within the limits where a mode would hold it.
    NoFlight,
    /// Nobody asks for one: a pitch that is held comes to nothing within them, or there is no such aircraft.
    NotAsked,
}

impl Walk<'_> {
    fn modes(&self) -> usize {
        self.scenario.autopilot.as_ref().map_or(0, |it| it.modes().len())
    }

    fn mode(&self, number: usize) -> Option<(&Autopilot, &Mode)> {
        let autopilot = self.scenario.autopilot.as_ref()?;
        Some((autopilot, autopilot.modes().get(number)?))
    }

    fn begins_s(&self, number: usize) -> f64 {
        self.mode(number).map_or(0.0, |(_, mode)| mode.entry.at_s)
    }

    /// What is asked of where a mode leads; nothing where it was asked already or is not flown with that aircraft.
    fn place(
        &self,
        standing: &Standing,
        number: usize,
        there: Result<Trim, Nowhere>,
    ) -> Option<Place> {
        let plant = standing.plant.as_ref()?;
        let is_mode = self.mode(number).is_some();
        if is_mode && standing.modes(self.scenario).iter().all(|(other, _)| *other != number) {
            return None;
        }
        let led = |airspeed_m_s: Option<f64>| {
            is_mode.then(|| Led { mode: number, target: self.written(number), airspeed_m_s })
        };
        match there {
            Ok(trim) if is_same(&trim.target, &plant.trim().target) => None,
            Ok(trim) => {
                let led = led(Some(trim.target.airspeed_m_s));
                Some(Place { led, plant: Some(plant.at(trim)) })
            }
            Err(Nowhere::NoFlight) => Some(Place { led: led(None), plant: None }),
            Err(Nowhere::NotAsked) => None,
        }
    }

    /// The target of a mode that tells most of where it leads.
    fn written(&self, number: usize) -> Option<(Quantity, f64)> {
        use Quantity::{Airspeed, Altitude, FlightPath, VerticalSpeed};
        let targets = self.targets.get(number)?;
        [Airspeed, VerticalSpeed, FlightPath, Altitude]
            .into_iter()
            .find_map(|quantity| Some((quantity, (*targets.get(quantity.place())?)?)))
    }

    /// Where a mode leads an aircraft from where the one before it led, or from the start.
    fn leads_to(
        &self,
        standing: &Standing,
        number: usize,
        from: Option<&Trim>,
    ) -> Result<Trim, Nowhere> {
        let Some(plant) = &standing.plant else { return Err(Nowhere::NotAsked) };
        let (held, range_rad) = self.held(number, from);
        let seek = |held: &Held| plant.aircraft().at_held(plant.trim(), held);
        let none = match held.path {
            Path::Pitch(_) => Nowhere::NotAsked,
            Path::FlightPath(_) | Path::VerticalSpeed(_) | Path::Airspeed(_) => Nowhere::NoFlight,
        };
        let found = seek(&held).ok_or(none)?;
        let theta_rad = pitch_rad(&found);
        // Further than the pitch that loops may command no path is held.
        match range_rad.map(|[least, most]| theta_rad.max(least).min(most)) {
            Some(kept_rad) if (kept_rad - theta_rad).abs() > SAME => {
                seek(&Held { path: Path::Pitch(kept_rad), ..held }).ok_or(Nowhere::NotAsked)
            }
            _ => Ok(found),
        }
    }

    /// What is held in a mode, and the pitch that it may command, rad.
    fn held(&self, number: usize, from: Option<&Trim>) -> (Held, Option<[f64; 2]>) {
        let base_rad = pitch_rad(&self.start) + self.scenario.held_at_the_end_rad();
        let theta_rad = from.map_or(base_rad, pitch_rad);
        let from = from.unwrap_or(&self.start);
        let TrimTarget { airspeed_m_s, altitude_m, flight_path_rad } = from.target;
        let untouched = Held {
            power: Power::Throttle(from.point.throttle),
            path: Path::Pitch(theta_rad),
            altitude_m,
        };
        let Some((autopilot, mode)) = self.mode(number) else { return (untouched, None) };
        let written = |quantity: Quantity, or: f64| {
            let targets = self.targets.get(number);
            targets.and_then(|it| *it.get(quantity.place())?).unwrap_or(or)
        };
        let engaged = || mode.engaged.iter().filter_map(|&number| autopilot.loops().get(number));
        let by_throttle = mode.total_energy || engaged().any(|it| it.moves == Moves::Throttle);
        let airspeed_m_s = written(Quantity::Airspeed, airspeed_m_s);
        let power = if by_throttle { Power::Airspeed(airspeed_m_s) } else { untouched.power };
        let climb_m_s = from.target.airspeed_m_s * libm::sin(flight_path_rad);
        let holds =
            if mode.total_energy { Some(Quantity::Altitude) } else { outermost(autopilot, mode) };
        let path = match holds {
            None | Some(Quantity::Heading) => untouched.path,
            Some(Quantity::Altitude) => Path::FlightPath(0.0),
            Some(Quantity::VerticalSpeed) => {
                Path::VerticalSpeed(written(Quantity::VerticalSpeed, climb_m_s))
            }
            Some(Quantity::FlightPath) => {
                Path::FlightPath(written(Quantity::FlightPath, flight_path_rad))
            }
            Some(Quantity::GlideSlope) => {
                Path::FlightPath(autopilot.glide_slope().map_or(0.0, |beam| -beam.angle_rad))
            }
            // Nobody holds it by throttle as well: no mode holds anything twice.
            Some(Quantity::Airspeed) => Path::Airspeed(airspeed_m_s),
        };
        let altitude_m = written(Quantity::Altitude, altitude_m);
        let range_rad = limits_rad(autopilot, mode)
            .map(|[least, most]| [base_rad + least, base_rad + most])
            .filter(|_| holds.is_some());
        (Held { power, path, altitude_m }, range_rad)
    }
}

/// Pitch angle, rad.
fn pitch_rad(trim: &Trim) -> f64 {
    trim.point.alpha_rad + trim.target.flight_path_rad
}

fn is_same(one: &TrimTarget, other: &TrimTarget) -> bool {
    (one.airspeed_m_s / other.airspeed_m_s - 1.0).abs() <= SAME
        && (one.flight_path_rad - other.flight_path_rad).abs() <= SAME
        && (one.altitude_m - other.altitude_m).abs() <= SAME_M
}

/// What the loop holds that moves pitch in the end and that no other loop moves.
fn outermost(autopilot: &Autopilot, mode: &Mode) -> Option<Quantity> {
    let engaged =
        || mode.engaged.iter().filter_map(|&number| Some((number, autopilot.loops().get(number)?)));
    let is_moved = |number: usize| engaged().any(|(_, it)| it.moves == Moves::Loop(number));
    let of_path = |it: &OuterLoop| matches!(it.moves, Moves::Pitch | Moves::Loop(_));
    let mut found = engaged().filter(|(number, it)| of_path(it) && !is_moved(*number));
    found.next().map(|(_, it)| it.holds)
}

/// Least and largest pitch that a mode commands, rad; none where nothing limits it.
fn limits_rad(autopilot: &Autopilot, mode: &Mode) -> Option<[f64; 2]> {
    let engaged = mode.engaged.iter().filter_map(|&number| autopilot.loops().get(number));
    let by_loop = engaged.into_iter().find(|it| it.moves == Moves::Pitch);
    let by_loop = by_loop.map(|it| (&it.controller, it.units.moved));
    let by_energy = autopilot.total_energy().filter(|_| mode.total_energy);
    let (controller, per_rad) = by_energy.map(|it| (&it.distribution, 1.0)).or(by_loop)?;
    let limits = controller.config().limits?;
    Some([limits.lower() / per_rad, limits.upper() / per_rad])
}

#[cfg(test)]
mod tests;

//! Air that the modes of a flight come to: the wind of its end, and either wind as it blows on the headings that they turn to.

use core::f64::consts::PI;

use crate::air::{Steady, Wind, sum_at};
use crate::autopilot::{Autopilot, Mode, Moves, Quantity, Target};
use crate::rest::Doubt;
use crate::scenario::Scenario;
use crate::surroundings::seen;

/// A scenario in a wind as if it stayed, and the numbers of the modes that come to it.
#[derive(Clone, Debug)]
pub(super) struct Blown {
    pub(super) scenario: Scenario,
    pub(super) modes: Vec<usize>,
    pub(super) seen_as: SeenAs,
}

/// In what a wind differs from that of the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SeenAs {
    /// It blows at the end of the flight.
    AtTheEnd,
    /// It blows on another heading.
    OnAnotherHeading,
}

/// Winds that differ by less, m/s along one axis of the aircraft, are one.
const SAME_M_S: f64 = 1e-9;

impl SeenAs {
    /// Why it is open whether a mode holds that grows in it.
    pub(super) const fn doubt(self, spectral_radius: f64) -> Doubt {
        match self {
            Self::AtTheEnd => Doubt::WindOfTheEnd { spectral_radius },
            Self::OnAnotherHeading => Doubt::WindOnAHeading { spectral_radius },
        }
    }
}

/// The air that modes of a scenario's autopilot come to and that is another, seen from the aircraft, than that of its start.
/// What is counted over the ground moves by wind ahead more or less for the same motion through the air.
pub(super) fn blown(scenario: &Scenario) -> Vec<Blown> {
    let Some((autopilot, weather)) =
        scenario.autopilot.as_ref().zip(scenario.surroundings.weather.as_ref())
    else {
        return Vec::new();
    };
    let [start, end] = [0.0, scenario.timing.end_s()]
        .map(|time_s| sum_at(&weather.winds, &weather.course.place(time_s)).earth_m_s);
    let heading_rad = weather.course.heading_rad;
    let of_start = seen(start, heading_rad);
    let mut all: Vec<Blown> = Vec::new();
    for (wind, at_the_end) in [(end, true), (start, false)] {
        for (mode, headings) in headings_rad(autopilot, heading_rad, wind).iter().enumerate() {
            for &on_rad in headings.iter().filter(|it| !is_same(seen(wind, **it), of_start)) {
                let turned = !is_same(seen(wind, on_rad), seen(wind, heading_rad));
                let seen_as = match at_the_end && !turned {
                    true => SeenAs::AtTheEnd,
                    false => SeenAs::OnAnotherHeading,
                };
                add(&mut all, mode, (in_it(scenario, wind, on_rad), seen_as));
            }
        }
    }
    all
}

/// A mode more that comes to an air.
fn add(all: &mut Vec<Blown>, mode: usize, (scenario, seen_as): (Scenario, SeenAs)) {
    let weather = |it: &Scenario| it.surroundings.weather.clone();
    match all.iter_mut().find(|it| weather(&it.scenario) == weather(&scenario)) {
        // The wind of the end may be that of the start.
        Some(found) if found.modes.contains(&mode) => {}
        Some(found) => found.modes.push(mode),
        None => all.push(Blown { scenario, modes: vec![mode], seen_as }),
    }
}

/// The scenario as if this wind stayed, turned as it is seen on a heading: the aircraft keeps the heading of its start.
fn in_it(scenario: &Scenario, earth_m_s: [f64; 3], heading_rad: f64) -> Scenario {
    let mut own = scenario.clone();
    if let Some(weather) = &mut own.surroundings.weather {
        let start_rad = weather.course.heading_rad;
        let is_turned = (heading_rad - start_rad).abs() > 0.0;
        let earth_m_s = match is_turned {
            true => seen(seen(earth_m_s, heading_rad), -start_rad),
            false => earth_m_s,
        };
        weather.winds = vec![Wind::Steady(Steady { earth_m_s })];
    }
    own
}

fn is_same(one: [f64; 3], other: [f64; 3]) -> bool {
    one.iter().zip(&other).all(|(one, other)| (one - other).abs() <= SAME_M_S)
}

/// The headings on which each mode is flown: the last that was asked for, and of one that turns without end those along a wind
/// and against it, between which all others lie. What keeps a heading after such a turn may keep any.
fn headings_rad(autopilot: &Autopilot, start_rad: f64, wind: [f64; 3]) -> Vec<Vec<f64>> {
    let [north, east, _] = wind;
    let along_rad = libm::atan2(east, north);
    let mut now = vec![start_rad];
    let of_mode = |mode: &Mode| {
        let is_steered = mode
            .engaged
            .iter()
            .any(|&it| autopilot.loops().get(it).is_some_and(|it| it.moves == Moves::Bank));
        match mode.target(Quantity::Heading) {
            Target::Value(heading_rad) if is_steered => now = vec![heading_rad],
            _ if !is_steered && mode.bank_rad.abs() > 0.0 => {
                now = vec![along_rad, along_rad + PI];
            }
            _ => {}
        }
        now.clone()
    };
    autopilot.modes().iter().map(of_mode).collect()
}

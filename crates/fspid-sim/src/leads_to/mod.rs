//! The steady flight that a scenario ends in: the airspeed and altitude reached with the final set-points, mode targets and
//! configuration, with the throttle fixed where nothing controls it. Climbs and turns on the way that last are included.

mod targets;
#[cfg(test)]
mod tests;
mod walk;
mod wanted;

use fspid_aircraft::{Trim, TrimTarget};
use fspid_core::Gains;

use crate::aircraft::{AircraftPlant, Change, Standing};
use crate::autopilot::AtLimits;
use crate::controller::Controller;
use crate::held_limits::pitches_at_the_end;
use crate::led::Led;
use crate::scenario::Scenario;
use walk::Walk;

/// Where a flight comes to.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    /// Number of the aircraft that comes there, among those that the flight stands with.
    standing: usize,
    /// What leads there, where it is a mode.
    pub(crate) led: Option<Led>,
    /// The aircraft there; none where nothing is found within its limits.
    pub(crate) plant: Option<AircraftPlant>,
    /// What of its mode stands at a limit there, and so moves nothing.
    pub(crate) at_limits: AtLimits,
}

/// Places that differ by less, as a part of airspeed and in rad, were asked.
const SAME: f64 = 1e-4;
/// The same of altitude, m.
const SAME_M: f64 = 1.0;

/// The places to which a scenario leads beside the trims of its aircraft: for each mode of its autopilot that may be flown with
/// an aircraft that it comes to stand with, and for each such aircraft without an autopilot.
pub(crate) fn places(
    scenario: &Scenario,
    aircraft: &AircraftPlant,
    standings: &[Standing],
    held: (&Controller, Gains<f64>),
) -> Vec<Place> {
    let mut all: Vec<Place> = Vec::new();
    for pitch_rad in pitches_rad(scenario, aircraft, held) {
        let walk = Walk::new(scenario, aircraft, pitch_rad);
        for place in places_of(&walk, standings) {
            if !all.iter().any(|other| is_asked_by(other, &place)) {
                all.push(place);
            }
        }
    }
    all
}

/// Pitches that the end of the flight holds, rad from the trim; the set-point where there is no linear model to ask for loads.
fn pitches_rad(
    scenario: &Scenario,
    aircraft: &AircraftPlant,
    (controller, gains): (&Controller, Gains<f64>),
) -> Vec<f64> {
    match aircraft.linear() {
        Ok(plant) => pitches_at_the_end(scenario, &plant, controller, gains),
        Err(_) => vec![scenario.held_at_the_end_rad()],
    }
}

/// True where two places are one.
fn is_asked_by(one: &Place, other: &Place) -> bool {
    let whose = |it: &Place| (it.standing, it.led.map(|led| led.mode), it.at_limits);
    let is_near = match (&one.plant, &other.plant) {
        (None, None) => true,
        (Some(one), Some(other)) => {
            one.aircraft() == other.aircraft() && is_same(&one.trim().target, &other.trim().target)
        }
        _ => false,
    };
    whose(one) == whose(other) && is_near
}

fn places_of(walk: &Walk<'_>, standings: &[Standing]) -> Vec<Place> {
    let mut ends: Vec<Vec<Option<Trim>>> = Vec::new();
    let mut all = Vec::new();
    for (number, standing) in standings.iter().enumerate() {
        let mut own: Vec<Option<Trim>> = Vec::new();
        for mode in 0..walk.modes().max(1) {
            let before = ends.get(number.wrapping_sub(1)).and_then(|it| it.get(mode));
            let begins_before =
                standing.by == Change::Fuel || walk.begins_s(mode) < standing.from_s;
            let from = if begins_before { before } else { own.get(mode.wrapping_sub(1)) };
            let there = walk.leads_to(standing, mode, from.copied().flatten().as_ref());
            own.push(walk::straight(&there));
            let place = |it| walk.place((number, standing), mode, it);
            all.extend(there.into_iter().filter_map(place));
        }
        ends.push(own);
    }
    all
}

fn is_same(one: &TrimTarget, other: &TrimTarget) -> bool {
    (one.airspeed_m_s / other.airspeed_m_s - 1.0).abs() <= SAME
        && (one.flight_path_rad - other.flight_path_rad).abs() <= SAME
        && (one.altitude_m - other.altitude_m).abs() <= SAME_M
}

//! Why a flight leaves it undecided whether its loop is stable, whatever the loop at rest says: how it ended, and what comes of it
//! when it goes on.

use crate::closed_loop::simulate;
use crate::controller::Controller;
use crate::flown_on::{self, Fate};
use crate::held_limits::{Ends, Moves, last_plant};
use crate::rest::Doubt;
use crate::sample_guard;
use crate::scenario::{NamedController, Scenario};
use crate::trace::Trace;

/// Fewest samples of a last tenth of which something is said.
const LEAST_TAIL: usize = 10;

/// Why nothing at rest speaks of a flight that was flown.
///
/// [`Doubt::HeldByGuard`] where its last sample, or that of the flight as it goes on, is beyond the controller's sample guard;
/// [`Doubt::RunsAway`] where that of a plant that does not come to rest by itself ends at a limit of controller or servo with an
/// error that grows, through the last tenth of it, at every sample; and [`Doubt::SwingAtLimits`] where that of a linear plant, or
/// that of an aircraft at limits, is lost, or a flight ends, as it is or flown on, at limits in a swing that does not shrink.
#[must_use]
pub fn doubt_of_flight(
    scenario: &Scenario,
    controller: &Controller,
    trace: &Trace,
) -> Option<Doubt> {
    fate((scenario, controller, trace)).doubt()
}

/// The same of each of some flights; those that are flown on fly side by side as far as they can.
#[must_use]
pub fn doubts_of_flights(flights: &[(&Scenario, &Controller, &Trace)]) -> Vec<Option<Doubt>> {
    let mut doubts = vec![None; flights.len()];
    let (mut places, mut open) = (Vec::new(), Vec::new());
    for (place, flight) in flights.iter().enumerate() {
        match fate(*flight) {
            Fate::Known(doubt) => doubts[place] = doubt,
            Fate::Open(onwards) => {
                places.push(place);
                open.push(onwards);
            }
        }
    }
    for (place, doubt) in places.into_iter().zip(flown_on::doubts(&open)) {
        doubts[place] = doubt;
    }
    doubts
}

fn fate<'a>((scenario, controller, trace): (&'a Scenario, &'a Controller, &Trace)) -> Fate<'a> {
    let moves = || last_plant(scenario).map(|plant| Moves::of(&plant));
    if sample_guard::holds_the_command(scenario, controller, trace) {
        return Fate::Known(Some(Doubt::HeldByGuard));
    }
    if runs_away(scenario, controller, trace) && moves().is_some_and(|it| it != Moves::Back) {
        return Fate::Known(Some(Doubt::RunsAway));
    }
    Fate::of(scenario, controller, trace, moves)
}

/// The same of one of a scenario's controllers, for who has not flown it; none where it cannot be flown.
#[must_use]
pub fn doubt_when_flown(scenario: &Scenario, named: &NamedController) -> Option<Doubt> {
    let alone =
        Scenario { controllers: vec![named.clone()], externals: Vec::new(), ..scenario.clone() };
    let trace = simulate(&alone).ok()?.traces.pop()?;
    doubt_of_flight(&alone, &named.controller, &trace)
}

/// True where each sample of the last tenth is at a limit, and further off than the one before.
fn runs_away(scenario: &Scenario, controller: &Controller, trace: &Trace) -> bool {
    let rows = trace.rows();
    let tail = rows / 10;
    let ends = Ends::of(scenario, controller);
    let is_cut = |command_rad: &f64| ends.are_met(*command_rad, 0.0);
    if tail < LEAST_TAIL || !trace.command_rad.last().is_some_and(is_cut) {
        return false;
    }
    let errors: Vec<f64> =
        trace.setpoint_rad.iter().zip(&trace.theta_rad).map(|(r, y)| (r - y).abs()).collect();
    let grows = errors.iter().skip(rows - tail).is_sorted_by(|one, next| one < next);
    grows && trace.command_rad.iter().rev().take(tail).all(is_cut)
}

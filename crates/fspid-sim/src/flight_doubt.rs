//! Why a flight leaves it undecided whether its loop is stable, whatever the loop at rest says: how it ended, and what comes of it
//! when it goes on.

use crate::closed_loop::simulate;
use crate::controller::Controller;
use crate::flown_on;
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
/// error that grows, through the last tenth of it, at every sample; [`Doubt::OuterLoopRunsAway`] where an autopilot does so with
/// an altitude, an airspeed, a heading or a beam; and [`Doubt::SwingAtLimits`] where that of a linear plant, or that of an aircraft
/// at limits, is lost, or a flight ends, as it is or flown on, at limits in a swing that does not shrink.
#[must_use]
pub fn doubt_of_flight(
    scenario: &Scenario,
    controller: &Controller,
    trace: &Trace,
) -> Option<Doubt> {
    let moves = || last_plant(scenario).map(|plant| Moves::of(&plant));
    if sample_guard::holds_the_command(scenario, controller, trace) {
        return Some(Doubt::HeldByGuard);
    }
    if runs_away(scenario, controller, trace) && moves().is_some_and(|it| it != Moves::Back) {
        return Some(Doubt::RunsAway);
    }
    flown_on::doubt(scenario, controller, trace, moves)
        .or_else(|| outer_loop_runs_away(trace).then_some(Doubt::OuterLoopRunsAway))
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
    let grows = grows_through(tail, &trace.setpoint_rad, &trace.theta_rad);
    grows && trace.command_rad.iter().rev().take(tail).all(is_cut)
}

/// What an autopilot holds, and what it is: where nobody holds it the two are the same, and nothing grows.
const HELD: [[&str; 2]; 3] = [
    ["altitude_target_m", "altitude_m"],
    ["airspeed_target_m_s", "airspeed_m_s"],
    ["heading_target_rad", "heading_rad"],
];

/// True where an autopilot is at a limit of its own through the last tenth, and something that it holds gets further away at each
/// sample: a throttle at its end while speed is lost, a pitch that lets an altitude sink.
fn outer_loop_runs_away(trace: &Trace) -> bool {
    let tail = trace.rows() / 10;
    let limited = trace.autopilot_limited.iter().rev().take(tail);
    if tail < LEAST_TAIL || limited.len() < tail || !limited.copied().all(|it| it) {
        return false;
    }
    let grows = |[target, found]: [&str; 2]| match (trace.column(target), trace.column(found)) {
        (Some(target), Some(found)) => grows_through(tail, target, found),
        _ => false,
    };
    let below_beam = trace.column("above_glide_slope_m");
    HELD.into_iter().any(grows)
        || below_beam.is_some_and(|it| grows_through(tail, it, &vec![0.0; it.len()]))
}

/// True where two quantities get further apart at each of so many last samples.
fn grows_through(tail: usize, one: &[f64], other: &[f64]) -> bool {
    let apart: Vec<f64> =
        one.iter().zip(other).rev().take(tail).map(|(one, other)| (one - other).abs()).collect();
    apart.is_sorted_by(|later, before| later > before)
}

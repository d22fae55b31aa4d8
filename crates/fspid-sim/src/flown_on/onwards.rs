//! Flights as they go on, one by one or side by side.

use core::ops::ControlFlow;

use super::moved::{Afterwards, Moved, held_on};
use super::moving_gains::MovingGains;
use super::pieces::{BEAM, Pieces, Shown, Span};
use super::{
    Asked, diverged, have_left, is_lost, leave_at_limits, lengths, moving_rad, of_limits_or_gains,
    outer_at,
};
use crate::batch::{BatchRow, Entrant, LANES, fly_group_while};
use crate::closed_loop::fly;
use crate::controller::Controller;
use crate::error::SimError;
use crate::held_limits::Ends;
use crate::instant::Instant;
use crate::rest::Doubt;
use crate::sample_guard;
use crate::scenario::{Prepared, Scenario};
use crate::trace::Outcome;

/// A flight that is to be flown on.
pub(crate) struct Onwards<'a> {
    pub(super) scenario: &'a Scenario,
    pub(super) controller: &'a Controller,
    pub(super) ends: Ends,
    pub(super) asked: Asked,
}

impl Onwards<'_> {
    /// Why the flight is in doubt as it goes on.
    pub(crate) fn doubt(&self) -> Option<Doubt> {
        self.asked.ways.iter().find_map(|afterwards| self.doubt_after(*afterwards))
    }

    fn doubt_after(&self, afterwards: Afterwards) -> Option<Doubt> {
        self.prepared(afterwards)
            .map_or_else(|| self.of_its_own(), |prepared| self.doubt_alone(&prepared, afterwards))
    }

    /// The flight as it goes on; none of what cannot be flown on.
    fn prepared(&self, afterwards: Afterwards) -> Option<Prepared> {
        let [horizon, _] = lengths(self.scenario.timing.rows());
        held_on(self.scenario, horizon, afterwards)
    }

    fn doubt_alone(&self, prepared: &Prepared, afterwards: Afterwards) -> Option<Doubt> {
        let mut course = Course::new(self, prepared, afterwards);
        let outcome = fly(prepared, self.controller, |instant| {
            course.see(&instant);
            if course.goes_on() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        course.doubt(outcome)
    }

    /// What cannot be flown on has its own swing alone.
    fn of_its_own(&self) -> Option<Doubt> {
        self.asked.swings_itself.then_some(Doubt::SwingAtLimits)
    }
}

/// Why each of some flights is in doubt as it goes on, side by side as far as they can fly so.
pub(crate) fn doubts(flights: &[Onwards<'_>]) -> Vec<Option<Doubt>> {
    let mut doubts = vec![None; flights.len()];
    let most = flights.iter().map(|flight| flight.asked.ways.len()).max();
    for round in 0..most.unwrap_or(0) {
        let open = flights.iter().enumerate().filter_map(|(place, flight)| {
            let afterwards = *flight.asked.ways.get(round)?;
            doubts[place].is_none().then_some((place, flight, afterwards))
        });
        let open: Vec<_> = open.collect();
        for group in open.chunks(LANES) {
            let asked: Vec<_> =
                group.iter().map(|&(_, flight, afterwards)| (flight, afterwards)).collect();
            for ((place, ..), doubt) in group.iter().zip(doubts_together(&asked)) {
                doubts[*place] = doubt;
            }
        }
    }
    doubts
}

fn doubts_together(flights: &[(&Onwards<'_>, Afterwards)]) -> Vec<Option<Doubt>> {
    let prepared: Option<Vec<Prepared>> =
        flights.iter().map(|(flight, afterwards)| flight.prepared(*afterwards)).collect();
    let together =
        prepared.filter(|all| all.len() > 1).and_then(|all| doubts_in_lanes(flights, &all));
    together.unwrap_or_else(|| {
        flights.iter().map(|(flight, afterwards)| flight.doubt_after(*afterwards)).collect()
    })
}

/// None of flights that cannot fly side by side.
fn doubts_in_lanes(
    flights: &[(&Onwards<'_>, Afterwards)],
    prepared: &[Prepared],
) -> Option<Vec<Option<Doubt>>> {
    let pairs = || flights.iter().zip(prepared);
    let entrants =
        pairs().map(|((flight, _), prepared)| Entrant { prepared, controller: flight.controller });
    let entrants: Vec<Entrant<'_>> = entrants.collect();
    let courses =
        pairs().map(|((flight, afterwards), prepared)| Course::new(flight, prepared, *afterwards));
    let mut courses: Vec<Course<'_>> = courses.collect();
    let outcomes = fly_group_while::<LANES>(&entrants, |row: &BatchRow<'_, LANES>| {
        let mut goes_on = false;
        for (lane, course) in courses.iter_mut().enumerate().filter(|(_, it)| it.goes_on()) {
            if let Some(instant) = row.instant(lane) {
                course.see(&instant);
                goes_on |= course.goes_on();
            }
        }
        if goes_on { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    let outcomes = outcomes.ok()?;
    Some(courses.iter().zip(outcomes).map(|(course, outcome)| course.doubt(outcome)).collect())
}

/// What is seen of a flight as it goes on.
struct Course<'a> {
    flight: &'a Onwards<'a>,
    prepared: &'a Prepared,
    moved: Moved,
    pieces: Pieces<'a>,
    /// What it did within its own length.
    own: Option<Span>,
    is_held: bool,
    has_rested: bool,
    /// The beam that it holds has ended: what comes after it tells nothing.
    has_passed: bool,
}

impl<'a> Course<'a> {
    fn new(flight: &'a Onwards<'a>, prepared: &'a Prepared, afterwards: Afterwards) -> Self {
        let scenario = flight.scenario;
        let [_, piece] = lengths(scenario.timing.rows());
        let moved = Moved::of(scenario, afterwards);
        let pieces = Pieces::new(scenario, &flight.ends, piece);
        let [is_held, has_rested, has_passed] = [false; 3];
        Self { flight, prepared, moved, pieces, own: None, is_held, has_rested, has_passed }
    }

    const fn goes_on(&self) -> bool {
        !self.has_rested && !self.has_passed
    }

    /// Takes a sample.
    fn see(&mut self, instant: &Instant) {
        let Onwards { scenario, controller, asked, .. } = self.flight;
        let rows = scenario.timing.rows();
        let outer = outer_at(instant);
        if instant.autopilot.is_some_and(|it| it.is_behind_beam) && outer.off[BEAM].abs() > 0.0 {
            self.has_passed = true;
            return;
        }
        let at_servo = self.prepared.at_servo.as_ref().and_then(|it| it.get(instant.k));
        self.pieces.push(Shown {
            moving_rad: moving_rad(scenario, instant.setpoint_rad, instant.theta_rad),
            command_rad: instant.step.command_rad,
            at_servo_rad: at_servo.copied().unwrap_or(0.0),
            elevator_rad: instant.elevator_rad,
            autopilot_is_limited: instant.autopilot.is_some_and(|it| it.is_limited),
            gains: instant.step.gains,
            outer,
        });
        if instant.k + 1 == rows {
            self.own = Some(self.pieces.whole());
        }
        let [theta_rad, rate_rad_s] = instant.measured;
        self.is_held =
            sample_guard::is_beyond(controller, [instant.setpoint_rad, theta_rad, rate_rad_s]);
        let pieces = &self.pieces;
        let is_seen = instant.k > rows + 2 * pieces.length && pieces.is_whole();
        let rests = || match asked.gains {
            Some(gains) => {
                (pieces.rests() && MovingGains::stand(pieces)) || gains.have_come_back(pieces)
            }
            None => pieces.rests(),
        };
        self.has_rested = self.moved == Moved::Nothing && is_seen && rests();
    }

    fn doubt(&self, outcome: Result<Outcome, SimError>) -> Option<Doubt> {
        let Ok(outcome) = outcome else { return self.flight.of_its_own() };
        match (self.is_held, self.has_rested) {
            (true, _) => Some(Doubt::HeldByGuard),
            (false, true) => None,
            (false, false) => self
                .is_in_doubt(outcome)
                .then(|| of_limits_or_gains(self.flight.asked.gains, &self.pieces)),
        }
    }

    fn is_in_doubt(&self, outcome: Outcome) -> bool {
        let Self { flight, pieces, moved, own, .. } = self;
        let Asked { moves, gains, swings_itself, .. } = &flight.asked;
        let has_grown =
            || *moved == Moved::ByNoise && own.is_some_and(|own| pieces.has_doubled_since(own));
        let goes_on = match flight.scenario.plant.linear() {
            Some(_) => {
                outcome != Outcome::Completed || pieces.goes_on(*moved, *moves) || has_grown()
            }
            None => {
                pieces.swings_on(*moved, *moves)
                    || is_lost(outcome, *swings_itself, pieces)
                    || leave_at_limits(pieces, *moved)
                    || gains.is_some() && diverged(outcome)
            }
        };
        goes_on || have_left(*gains, pieces, *moved)
    }
}

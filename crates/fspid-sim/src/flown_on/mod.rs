//! Extended simulation of a flight behind limits, or with gains that move, that has not come to rest, or ends in a limit cycle:
//! does it settle when the simulation continues past the end of the flight?
//!
//! Around a rest that limits leave, small motions decay; a swing that meets limits may grow from there on, or stay. Of such a
//! flight nothing at rest speaks, so that it is flown on: with what is held at its end, and with what swings, and once without
//! what moves it, which would hide a swing that stays. A sample guard is a limit too: beyond it a command is held for good. So
//! are gains that move: around a rest they are those there.

mod moved;
mod moving_gains;
mod onwards;
mod pieces;
#[cfg(test)]
mod tests;

use fspid_core::Gains;

use crate::autopilot::{Autopilot, Mode, Quantity};
use crate::controller::Controller;
use crate::held_limits::{Ends, Moves};
use crate::instant::Instant;
use crate::plant::Plant;
use crate::rest::Doubt;
use crate::sample_guard;
use crate::scenario::Scenario;
use crate::signal::{Disturbance, Entry};
use crate::trace::{EndCause, Outcome, Trace};
use moved::{Afterwards, Moved, changes_late, has_swings, is_noisy, swings_by_command};
use moving_gains::{MovingGains, leave_what_a_mode_holds};
pub(crate) use onwards::{Onwards, doubts};
use pieces::{Outer, Pieces, Shown};

/// So many times as long a flight is flown on.
const TIMES: usize = 10;
/// Samples of it, at least and at most.
const SAMPLES: [usize; 2] = [10_000, 100_000];
/// It comes to rest in two of so many pieces of it, or in longer ones.
const PIECES: usize = 50;
/// Fewest samples of a fifth of which something is said.
const LEAST_FIFTH: usize = 10;
/// A flight that has shown so many periods of what swings has shown which limits are met.
const PERIODS: f64 = 2.0;

/// What comes of a flight behind limits, or with gains that move: known from the flight itself, or asked of it as it goes on.
pub(crate) enum Fate<'a> {
    /// Why it is in doubt, if it is.
    Known(Option<Doubt>),
    /// To be flown on.
    Open(Onwards<'a>),
}

impl<'a> Fate<'a> {
    /// Why a flight behind limits is in doubt: it is lost, or it has not come to rest, and flown on is lost, or still meets limits in
    /// a swing that does not shrink, or is held by its sample guard. One with gains that move, limits or none, has to come back
    /// towards its rest as well.
    ///
    /// A nonlinear aircraft that is flown on is asked for a swing that stays at limits alone, for it has slow motions beside: what it
    /// comes to without one is told by where its flight leads. Of another simulator's aircraft the flight itself is asked for such a
    /// swing, and not flown on.
    pub(crate) fn of(
        scenario: &'a Scenario,
        controller: &'a Controller,
        trace: &Trace,
        moves: impl FnOnce() -> Option<Moves>,
    ) -> Self {
        let ends = Ends::of(scenario, controller);
        let is_free = ends.are_none() && scenario.autopilot.is_none();
        let gains = MovingGains::of(scenario, controller);
        if is_free && gains.is_none() && !sample_guard::is_set(controller) {
            return Self::Known(None);
        }
        match Asked::of(scenario, &ends, gains, trace, moves) {
            Ok(asked) => Self::Open(Onwards { scenario, controller, ends, asked }),
            Err(known) => Self::Known(known),
        }
    }
}

impl Fate<'_> {
    /// Why the flight is in doubt, flown on alone if need be.
    pub(crate) fn doubt(self) -> Option<Doubt> {
        match self {
            Self::Known(doubt) => doubt,
            Self::Open(onwards) => onwards.doubt(),
        }
    }
}

impl Asked {
    /// What is asked of the flight as it goes on; of one that is not flown on, why it is in doubt, if it is.
    fn of(
        scenario: &Scenario,
        ends: &Ends,
        gains: Option<MovingGains>,
        trace: &Trace,
        moves: impl FnOnce() -> Option<Moves>,
    ) -> Result<Self, Option<Doubt>> {
        let rows = scenario.timing.rows();
        let is_linear = scenario.plant.linear().is_some();
        let pieces = pieces_of(scenario, ends, trace);
        let in_doubt =
            |is_in_doubt: bool| Err(is_in_doubt.then(|| of_limits_or_gains(gains, &pieces)));
        let moved = Moved::of(scenario, Afterwards::Noise);
        if trace.rows() < rows {
            let swings_itself = || moves().is_some_and(|moves| pieces.swings_on(moved, moves));
            // With fixed gains and without limits a loop that holds at rest holds; what else ends an aircraft's flight its verdict tells.
            return in_doubt(
                is_linear
                    || is_lost(trace.outcome, swings_itself(), &pieces)
                    || leave_at_limits(&pieces, moved)
                    || gains.is_some_and(|it| has_gone_away(trace.outcome, it, &pieces, moved)),
            );
        }
        let flies_on = !matches!(scenario.plant, Plant::External(_));
        let swings = has_swings(scenario) || swings_by_command(scenario);
        let is_stilled = gains.is_some() && swings && flies_on && rows <= SAMPLES[1];
        let has_rested = has_come_to_rest(scenario, &pieces, gains, trace);
        if has_rested && !is_stilled {
            return Err(None);
        }
        let moves = moves().ok_or(None)?;
        let changes_late = changes_late(scenario, trace);
        let swings_itself = || !changes_late && pieces.swings_on(moved, moves);
        // One that is as long as that is its own answer.
        if !flies_on || rows > SAMPLES[1] {
            return in_doubt(match is_linear && flies_on {
                true => pieces.goes_on(moved, moves) || have_left(gains, &pieces, moved),
                false => {
                    swings_itself() || gains.is_some() && leave_what_a_mode_holds(&pieces, moved)
                }
            });
        }
        // At a limit that it has met once, noise may carry a plant that runs away over the edge; any other that still meets them.
        let meets =
            if moves == Moves::Away { pieces.whole().meets() } else { pieces.tail().meets() };
        // An aircraft that no longer meets limits, with the gains of its rest, is on its way to the rest that holds.
        let wanders = gains.is_some() && !MovingGains::stand(&pieces);
        if !(is_linear || meets || changes_late || wanders) {
            return Err(None);
        }
        let swings_itself = !is_linear && swings_itself();
        let ways = ways(scenario, has_rested, meets, is_stilled).collect();
        Ok(Self { ways, moves, gains, swings_itself })
    }
}

/// What acts on after a flight, each time that it is flown on: one that has rested is asked for its swings by themselves alone.
fn ways(
    scenario: &Scenario,
    has_rested: bool,
    meets: bool,
    is_stilled: bool,
) -> impl Iterator<Item = Afterwards> {
    let all = [
        (Afterwards::Swings, !has_rested),
        (Afterwards::Quiet, !has_rested && has_swings(scenario)),
        (Afterwards::Noise, !has_rested && is_noisy(scenario) && meets),
        (Afterwards::Still, is_stilled),
    ];
    all.into_iter().filter_map(|(afterwards, is_asked)| is_asked.then_some(afterwards))
}

/// The flight itself in five pieces, and what is left.
fn pieces_of<'a>(scenario: &Scenario, ends: &'a Ends, trace: &Trace) -> Pieces<'a> {
    let at_servo = scenario.loads_rad(Entry::Servo);
    let mut pieces = Pieces::new(scenario, ends, (trace.rows() / 5).max(1));
    let outer = outer_of(scenario, trace);
    for k in 0..trace.rows() {
        pieces.push(Shown {
            moving_rad: moving_rad(scenario, trace.setpoint_rad[k], trace.theta_rad[k]),
            command_rad: trace.command_rad[k],
            at_servo_rad: at_servo.as_ref().and_then(|it| it.get(k)).copied().unwrap_or(0.0),
            elevator_rad: trace.elevator_rad[k],
            autopilot_is_limited: trace.autopilot_limited.get(k) == Some(&true),
            gains: trace.gains.get(k).copied().unwrap_or(Gains::ZERO),
            outer: outer(k),
        });
    }
    pieces
}

/// What the loops around the pitch loop hold at each sample of a flight; nothing without them.
fn outer_of(scenario: &Scenario, trace: &Trace) -> impl Fn(usize) -> Outer {
    let held = [
        ["altitude_m", "altitude_target_m"],
        ["airspeed_m_s", "airspeed_target_m_s"],
        ["heading_rad", "heading_target_rad"],
    ];
    let held = held.map(|names| names.map(|name| trace.column(name)));
    let above = trace.column("above_glide_slope_m");
    let modes_of_beams = modes_of_beams(scenario);
    let lateral = ["bank_rad", "aileron_rad"].map(|name| trace.column(name));
    let modes = trace.column("mode");
    move |k| {
        let at = |column: Option<&[f64]>| column.and_then(|it| it.get(k)).copied();
        let off = held.map(|[is, wanted]| Some(at(is)? - at(wanted)?));
        let [altitude_m, airspeed_m_s, heading_rad] = off.map(Option::unwrap_or_default);
        let lateral_rad = lateral.map(|it| at(it).unwrap_or_default());
        let mode = at(modes).unwrap_or_default();
        // Modes count from 1 there.
        let holds_a_beam = modes_of_beams.get((mode as usize).saturating_sub(1)) == Some(&true);
        let above_m = at(above).filter(|_| holds_a_beam).unwrap_or_default();
        Outer { off: [altitude_m, airspeed_m_s, heading_rad, above_m], mode, lateral_rad }
    }
}

/// For each mode, whether it holds the beam of a glide slope.
fn modes_of_beams(scenario: &Scenario) -> Vec<bool> {
    let holds_a_beam = |autopilot: &Autopilot, mode: &Mode| {
        let mut engaged = mode.engaged.iter().filter_map(|&number| autopilot.loops().get(number));
        engaged.any(|outer| outer.holds == Quantity::GlideSlope)
    };
    let of = |autopilot: &Autopilot| {
        autopilot.modes().iter().map(|mode| holds_a_beam(autopilot, mode)).collect()
    };
    scenario.autopilot.as_ref().map(of).unwrap_or_default()
}

/// The same of a sample that is being flown.
fn outer_at(instant: &Instant) -> Outer {
    let (Some(aircraft), Some(autopilot)) = (instant.aircraft, instant.autopilot) else {
        return Outer::default();
    };
    let wanted = |quantity: Quantity| autopilot.targets[quantity.place()];
    let off = [
        aircraft.altitude_m - wanted(Quantity::Altitude),
        aircraft.airspeed_m_s - wanted(Quantity::Airspeed),
        aircraft.heading_rad - wanted(Quantity::Heading),
        autopilot.above_beam_m - wanted(Quantity::GlideSlope),
    ];
    let lateral_rad = [aircraft.bank_rad, aircraft.aileron_rad];
    Outer { off, mode: f64::from(autopilot.mode), lateral_rad }
}

/// What comes to rest, or swings: the error of the pitch loop; with an autopilot, whose swings move the set-point, the pitch itself.
fn moving_rad(scenario: &Scenario, setpoint_rad: f64, theta_rad: f64) -> f64 {
    match scenario.autopilot {
        None => setpoint_rad - theta_rad,
        Some(_) => theta_rad,
    }
}

/// True where the flight itself has come to rest; or where something moves it for ever, what it does, without limits, once its
/// beginning has died out.
fn has_come_to_rest(
    scenario: &Scenario,
    pieces: &Pieces<'_>,
    gains: Option<MovingGains>,
    trace: &Trace,
) -> bool {
    let has_ended = || match Moved::of(scenario, Afterwards::Noise) {
        // A pitch that rests tells nothing of a heading that goes round, or of a beam that is left.
        Moved::Nothing => pieces.rests() && (gains.is_none() || MovingGains::stand(pieces)),
        Moved::BySwings => {
            !pieces.tail().meets() && pieces.repeats() && has_shown_its_swings(scenario)
        }
        Moved::ByNoise => {
            let is_quiet = pieces.is_quiet(gains.is_some());
            !pieces.whole().meets() && is_quiet && has_shown_its_swings(scenario)
        }
    };
    // Of a few samples nothing is said.
    pieces.length >= LEAST_FIFTH && has_ended() && !changes_late(scenario, trace)
}

/// True where a flight holds some periods of everything that swings.
fn has_shown_its_swings(scenario: &Scenario) -> bool {
    let end_s = scenario.timing.end_s();
    let mut periods = periods_s(scenario);
    periods.all(|(from_s, period_s)| from_s > end_s || from_s + PERIODS * period_s <= end_s)
}

/// From when on, and with what period, set-point and disturbances swing, s.
fn periods_s(scenario: &Scenario) -> impl Iterator<Item = (f64, f64)> {
    let of_disturbances = scenario.disturbances.iter().filter_map(Disturbance::period_s);
    of_disturbances.chain(scenario.setpoint.period_s())
}

/// How many samples a flight of so many is flown on to, and how many are a piece of that.
fn lengths(rows: usize) -> [usize; 2] {
    let horizon = (TIMES * rows).clamp(SAMPLES[0], SAMPLES[1]);
    [horizon, (rows / 5).max(horizon / PIECES)]
}

/// What is asked of a flight that is flown on.
struct Asked {
    /// What acts on each time, until one of them leaves it in doubt.
    ways: Vec<Afterwards>,
    moves: Moves,
    gains: Option<MovingGains>,
    /// It is that of an aircraft, and ends in a swing at limits; whoever flies on without it has left it behind.
    swings_itself: bool,
}

fn have_left(gains: Option<MovingGains>, pieces: &Pieces<'_>, moved: Moved) -> bool {
    gains.is_some_and(|it| it.have_left(pieces, moved) || it.leave_what_is_held(pieces, moved))
}

/// By what a flight is in doubt that has not come back to its rest: by gains that move, where no limit is met near its end.
fn of_limits_or_gains(gains: Option<MovingGains>, pieces: &Pieces<'_>) -> Doubt {
    match gains {
        Some(_) if !pieces.tail().meets() => Doubt::AwayFromRest,
        _ => Doubt::SwingAtLimits,
    }
}

fn diverged(outcome: Outcome) -> bool {
    matches!(outcome, Outcome::EndedEarly(end) if end.cause == EndCause::Diverged)
}

/// True of a flight with gains that move that is lost by them: it diverged, or went away from what is held.
fn has_gone_away(outcome: Outcome, gains: MovingGains, pieces: &Pieces<'_>, moved: Moved) -> bool {
    diverged(outcome) || gains.leave_what_is_held(pieces, moved)
}

/// True of an aircraft that leaves, standing at a limit, the altitude, airspeed, heading or beam that a mode holds: its elevator is
/// at its stop, or what an outer loop may ask for does not suffice. Who meets limits now and then is on its way through a gust.
fn leave_at_limits(pieces: &Pieces<'_>, moved: Moved) -> bool {
    let stands = pieces.last_fifths().is_some_and(|[_, fifth]| fifth.stands_at_limits());
    stands && leave_what_a_mode_holds(pieces, moved)
}

/// True of an aircraft that ends early out of a swing at limits, or on its back at them; without either it comes down to the ground
/// as commanded.
fn is_lost(outcome: Outcome, swings_itself: bool, pieces: &Pieces<'_>) -> bool {
    match outcome {
        Outcome::EndedEarly(end) => {
            swings_itself || (end.cause == EndCause::Diverged && pieces.ends_at_limits())
        }
        Outcome::Completed | Outcome::ModeNeverBegan { .. } => false,
    }
}

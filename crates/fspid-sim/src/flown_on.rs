//! Extended simulation of a linear plant behind limits whose flight has not come to rest, or ends in a limit cycle: does it
//! settle when the simulation continues past the end of the flight?
//!
//! Around a rest that limits leave, small motions decay; a swing that meets limits may grow from there on, or stay. Of such a
//! flight nothing at rest speaks, so that it is flown on: with what is held at its end, and with what swings.

use core::ops::ControlFlow;

use crate::closed_loop::fly;
use crate::controller::Controller;
use crate::held_limits::{Ends, Moves};
use crate::scenario::{Prepared, Scenario};
use crate::signal::{Disturbance, Entry};
use crate::timing::Timing;
use crate::trace::{Outcome, Trace};

/// So many times as long a flight is flown on.
const TIMES: usize = 10;
/// Samples of it, at least and at most.
const SAMPLES: [usize; 2] = [5_000, 100_000];
/// Fewest samples of a fifth of which something is said.
const LEAST_FIFTH: usize = 10;
/// An error that moves within a fifth of the flight by no more than this share of all its movement has come to rest.
const RESTS: f64 = 1e-3;
/// What has moved so many times as much has grown.
const GROWN: f64 = 1.05;
/// With nothing that moves it, a swing that does not shrink by a hundredth stays.
const STAYS: f64 = 0.99;
/// Under noise two parts of a flight differ by chance: what has doubled has grown.
const GROWN_IN_NOISE: f64 = 2.0;
/// Swings whose extremes differ by no more than this share of their size repeat.
const ALIKE: f64 = 1e-3;
/// So many steps of a sensor's resolution are a swing that it makes by itself: about a place between two of them.
const UNSEEN: f64 = 2.0;
/// Under noise an error that moves in the last two fifths by no more than this share of all its movement has come to an end.
const QUIET: f64 = 0.2;
/// A flight that has shown so many periods of what swings has shown which limits are met.
const PERIODS: f64 = 2.0;
/// A limit of rate is met a thousandth before it, for rounding.
const AT_RATE: f64 = 0.999;

/// What an error does over some samples, and whether a limit was met in them.
#[derive(Clone, Copy, Debug)]
struct Span {
    least_rad: f64,
    most_rad: f64,
    meets: bool,
}

impl Span {
    const NONE: Self = Self { least_rad: f64::INFINITY, most_rad: f64::NEG_INFINITY, meets: false };

    fn and(self, other: Self) -> Self {
        Self {
            least_rad: self.least_rad.min(other.least_rad),
            most_rad: self.most_rad.max(other.most_rad),
            meets: self.meets || other.meets,
        }
    }

    fn of(spans: &[Self]) -> Self {
        spans.iter().fold(Self::NONE, |all, one| all.and(*one))
    }

    fn size_rad(self) -> f64 {
        (self.most_rad - self.least_rad).max(0.0)
    }

    /// True for swings of the same extremes, but for so much.
    fn is_like(self, other: Self, but_rad: f64) -> bool {
        let apart_rad =
            (self.least_rad - other.least_rad).abs().max((self.most_rad - other.most_rad).abs());
        apart_rad <= ALIKE * self.size_rad() + but_rad
    }
}

/// A flight in pieces of one length; the last may be shorter.
struct Pieces<'a> {
    ends: &'a Ends,
    length: usize,
    /// An error that moves by no more has not moved for a sensor of such a resolution.
    unseen_rad: f64,
    samples: usize,
    all: Vec<Span>,
    before: Option<[f64; 2]>,
}

impl<'a> Pieces<'a> {
    fn new(scenario: &Scenario, ends: &'a Ends, length: usize) -> Self {
        let resolution_rad =
            scenario.surroundings.pitch_sensor.map_or(0.0, |it| it.model().resolution);
        let unseen_rad = UNSEEN * resolution_rad;
        Self { ends, length, unseen_rad, samples: 0, all: Vec::new(), before: None }
    }

    /// Takes a sample: its error, its command, what acts beside it at the servo, and the elevator.
    fn push(&mut self, error_rad: f64, command_rad: f64, at_servo_rad: f64, elevator_rad: f64) {
        let [by_command, by_elevator] = self.before.map_or([0.0; 2], |[command, elevator]| {
            [command_rad - command, elevator_rad - elevator]
        });
        self.before = Some([command_rad, elevator_rad]);
        let meets = self.ends.are_met(command_rad, at_servo_rad)
            || self.ends.are_met_by_moving(AT_RATE, by_command, by_elevator);
        let sample = Span { least_rad: error_rad, most_rad: error_rad, meets };
        if self.samples.is_multiple_of(self.length) {
            self.all.push(Span::NONE);
        }
        self.samples += 1;
        if let Some(last) = self.all.last_mut() {
            *last = last.and(sample);
        }
    }

    fn whole(&self) -> Span {
        Span::of(&self.all)
    }

    /// True for a part that stands still.
    fn stands(&self, part: Span) -> bool {
        part.size_rad() <= RESTS * self.whole().size_rad()
    }

    /// True for a part that has come to rest, within the limits or as well as its sensor sees.
    fn is_at_rest(&self, part: Span) -> bool {
        part.size_rad() <= self.unseen_rad || (!part.meets && self.stands(part))
    }

    /// True where the last piece, whole, has come to rest.
    fn rests(&self) -> bool {
        self.samples.is_multiple_of(self.length)
            && self.all.last().is_some_and(|it| self.is_at_rest(*it))
    }

    /// True where the last two pieces are whole and alike.
    fn repeats(&self) -> bool {
        match self.all.last_chunk() {
            Some([one, other]) if self.samples.is_multiple_of(self.length) => {
                one.is_like(*other, 0.0)
            }
            _ => false,
        }
    }

    /// The last two pieces, one of them whole.
    fn tail(&self) -> Span {
        Span::of(&self.all[self.all.len().saturating_sub(2)..])
    }

    /// The flight in five parts.
    fn fifths(&self) -> [Span; 5] {
        let pieces = self.all.len();
        std::array::from_fn(|part| Span::of(&self.all[part * pieces / 5..(part + 1) * pieces / 5]))
    }

    /// True where limits are met near the end, and the error moves there as one does that will not settle: a last fifth beside
    /// the one before it; or of a swing that is longer, the last two beside the first two.
    ///
    /// With nothing that moves it, a swing that does not shrink stays. Moved by swings it grows; and the error of a plant that
    /// runs away has to repeat what it did, for at a limit such a plant may be held by luck. Under noise it doubles.
    fn goes_on(&self, moved: Moved, moves: Moves) -> bool {
        let [first, second, _, fourth, fifth] = self.fifths();
        let (start, end) = (first.and(second), fourth.and(fifth));
        let grows = |times: f64| {
            fifth.size_rad() >= times * fourth.size_rad()
                || end.size_rad() >= times.max(GROWN) * start.size_rad()
        };
        end.meets
            && match (moved, moves) {
                // What a limit keeps short of its set-point stands still there.
                (_, Moves::Back) if self.stands(end) => false,
                (Moved::Nothing, _) => grows(STAYS),
                (Moved::BySwings, Moves::Away) => !fifth.is_like(fourth, self.unseen_rad),
                (Moved::BySwings, Moves::On | Moves::Back) => grows(GROWN),
                (Moved::ByNoise, _) => grows(GROWN_IN_NOISE),
            }
    }
}

/// What keeps an error moving for ever.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Moved {
    Nothing,
    BySwings,
    ByNoise,
}

impl Moved {
    fn of(scenario: &Scenario) -> Self {
        let is_noisy = scenario.disturbances.iter().any(Disturbance::is_noise)
            || scenario.setpoint.is_noise()
            || scenario.surroundings.is_noisy();
        let swings =
            scenario.setpoint.goes_on() || scenario.disturbances.iter().any(Disturbance::goes_on);
        match (is_noisy, swings) {
            (true, _) => Self::ByNoise,
            (false, true) => Self::BySwings,
            (false, false) => Self::Nothing,
        }
    }
}

/// True where a flight of a linear plant behind limits has not come to rest, and flown on is lost, or still meets limits in a
/// swing that does not shrink.
pub(crate) fn is_lost(
    scenario: &Scenario,
    controller: &Controller,
    trace: &Trace,
    moves: impl FnOnce() -> Option<Moves>,
) -> bool {
    let rows = scenario.timing.rows();
    let ends = Ends::of(scenario, controller);
    // Moving air is that of a way that ends with the flight.
    let is_linear = scenario.plant.linear().is_some() && scenario.surroundings.weather.is_none();
    if ends.are_none() || !is_linear || trace.rows() < rows {
        return false;
    }
    let pieces = pieces_of(scenario, &ends, trace);
    if has_come_to_rest(scenario, &pieces) {
        return false;
    }
    let Some(moves) = moves() else { return false };
    let moved = Moved::of(scenario);
    // One that is as long as that is its own answer.
    if rows > SAMPLES[1] {
        return pieces.goes_on(moved, moves);
    }
    // What cannot be flown on says nothing.
    let flies_on =
        |own: &Scenario| flies_on_and_is_lost(own, controller, &ends, moves).unwrap_or(false);
    if moved != Moved::ByNoise {
        return flies_on(scenario);
    }
    // Noise hides a swing that stays: without it nothing but the limits keeps one up. A plant that runs away may be carried over
    // the edge by the noise itself.
    flies_on(&without_noise(scenario))
        || (moves == Moves::Away && pieces.whole().meets && flies_on(scenario))
}

/// The scenario with the same errors but without noise at servo, elevator and measurement, or of sensors.
fn without_noise(scenario: &Scenario) -> Scenario {
    let mut own = scenario.clone();
    own.disturbances.retain(|it| !it.is_noise());
    own.surroundings = own.surroundings.without_noise();
    own
}

/// The flight itself in five pieces, and what is left.
fn pieces_of<'a>(scenario: &Scenario, ends: &'a Ends, trace: &Trace) -> Pieces<'a> {
    let at_servo = scenario.loads_rad(Entry::Servo);
    let mut pieces = Pieces::new(scenario, ends, (trace.rows() / 5).max(1));
    for k in 0..trace.rows() {
        let load_rad = at_servo.as_ref().and_then(|it| it.get(k)).copied().unwrap_or(0.0);
        let error_rad = trace.setpoint_rad[k] - trace.theta_rad[k];
        pieces.push(error_rad, trace.command_rad[k], load_rad, trace.elevator_rad[k]);
    }
    pieces
}

/// True where the flight itself has come to rest; or where something moves it for ever, what it does, without limits, once its
/// beginning has died out.
fn has_come_to_rest(scenario: &Scenario, pieces: &Pieces<'_>) -> bool {
    let (whole, tail) = (pieces.whole(), pieces.tail());
    let has_ended = match Moved::of(scenario) {
        Moved::Nothing => pieces.is_at_rest(tail),
        Moved::BySwings => !tail.meets && pieces.repeats() && has_shown_its_swings(scenario),
        Moved::ByNoise => {
            let is_quiet = tail.size_rad() <= QUIET * whole.size_rad();
            !whole.meets && is_quiet && has_shown_its_swings(scenario)
        }
    };
    // Of a few samples nothing is said.
    pieces.length >= LEAST_FIFTH && has_ended
}

/// True where a flight holds some periods of everything that swings.
fn has_shown_its_swings(scenario: &Scenario) -> bool {
    let end_s = scenario.timing.end_s();
    let of_disturbances = scenario.disturbances.iter().filter_map(Disturbance::period_s);
    let mut periods = of_disturbances.chain(scenario.setpoint.period_s());
    periods.all(|(from_s, period_s)| from_s > end_s || from_s + PERIODS * period_s <= end_s)
}

fn flies_on_and_is_lost(
    scenario: &Scenario,
    controller: &Controller,
    ends: &Ends,
    moves: Moves,
) -> Option<bool> {
    let rows = scenario.timing.rows();
    let prepared = held_on(scenario, (TIMES * rows).clamp(SAMPLES[0], SAMPLES[1]))?;
    let mut pieces = Pieces::new(scenario, ends, (rows / 5).max(LEAST_FIFTH));
    let moved = Moved::of(scenario);
    let mut rested = false;
    let outcome = fly(&prepared, controller, |instant| {
        let load_rad =
            prepared.at_servo.as_ref().and_then(|it| it.get(instant.k)).copied().unwrap_or(0.0);
        let error_rad = instant.setpoint_rad - instant.theta_rad;
        pieces.push(error_rad, instant.step.command_rad, load_rad, instant.elevator_rad);
        rested = moved == Moved::Nothing && instant.k > rows && pieces.rests();
        if rested { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let is_lost = !matches!(outcome.ok()?, Outcome::Completed);
    Some(!rested && (is_lost || pieces.goes_on(moved, moves)))
}

/// The flight as it goes on to so many samples: what stands still at its end is held, what swings swings on, and what would
/// begin later does not.
fn held_on(scenario: &Scenario, rows: usize) -> Option<Prepared> {
    let before = scenario.timing.rows();
    let dt_s = scenario.timing.dt_s();
    let mut own = scenario.clone();
    own.timing = Timing::new(dt_s, dt_s * (rows - 1) as f64).ok()?;
    let end_s = scenario.timing.end_s();
    own.plant_changes.retain(|it| it.at_s() <= end_s);
    let disturbances = core::mem::take(&mut own.disturbances);
    let mut prepared = own.prepare().ok()?;
    hold(&mut prepared.setpoint_rad, before, scenario.setpoint.goes_on());
    let places = [
        (Entry::Servo, &mut prepared.at_servo),
        (Entry::Elevator, &mut prepared.at_elevator),
        (Entry::Measurement, &mut prepared.at_measurement),
    ];
    for (entry, values) in places {
        for (stream, disturbance) in (0_u64..).zip(&disturbances) {
            if disturbance.entry() == entry {
                let mut one = vec![0.0; rows];
                disturbance.add_to(&mut one, own.timing, stream);
                hold(&mut one, before, disturbance.goes_on());
                let values = values.get_or_insert_with(|| vec![0.0; rows]);
                values.iter_mut().zip(one).for_each(|(sum, value)| *sum += value);
            }
        }
    }
    Some(prepared)
}

/// Holds the last of the first samples, unless the signal swings on; one that is nothing within them stays so.
fn hold(values: &mut [f64], before: usize, swings_on: bool) {
    let begins_later = values.iter().take(before).all(|value| *value == 0.0);
    let last = values.get(before - 1).copied().unwrap_or(0.0);
    if !swings_on || begins_later {
        values.iter_mut().skip(before).for_each(|value| *value = last);
    }
}

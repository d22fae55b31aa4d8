//! A flight in pieces: how far error and command move in each, and which of them meet a limit.

use fspid_aircraft::{ForceModel, Range};
use fspid_core::Gains;

use super::moved::Moved;
use crate::held_limits::{Ends, Moves};
use crate::math::turned_towards;
use crate::scenario::Scenario;

/// What moves within a part of the flight by no more than this share of all its movement has come to rest.
const RESTS: f64 = 1e-3;
/// With nothing that moves it, a swing that does not shrink by a tenth from one fifth of a flight to the next stays.
const STAYS: f64 = 0.9;
/// What has moved so many times as much has grown.
const GROWN: f64 = 1.05;
/// Under noise two parts of a flight differ by chance: what has doubled has grown.
const GROWN_IN_NOISE: f64 = 2.0;
/// Swings whose extremes differ by no more than this share of their size repeat.
const ALIKE: f64 = 1e-3;
/// So many steps of a sensor's resolution are a swing that it makes by itself: about a place between two of them.
const UNSEEN: f64 = 2.0;
/// Under noise an error that moves in the last two fifths by no more than this share of all its movement has come to an end.
const QUIET: f64 = 0.2;
/// The same where gains move with the error: what moves by more may swing by itself.
const QUIET_GAINS: f64 = 0.05;
/// A swing at limits of an aircraft meets them at one of so many samples at least.
const AT_LIMITS: usize = 4;
/// What goes so many times as far as it is large turns back in between.
const TURNS: f64 = 1.5;
/// A limit of rate is met a thousandth before it, for rounding.
const AT_RATE: f64 = 0.999;

/// Least and largest of a quantity, rad, or in its own unit.
#[derive(Clone, Copy, Debug)]
struct Reach {
    least_rad: f64,
    most_rad: f64,
}

impl Reach {
    const NONE: Self = Self { least_rad: f64::INFINITY, most_rad: f64::NEG_INFINITY };

    const fn at(value_rad: f64) -> Self {
        Self { least_rad: value_rad, most_rad: value_rad }
    }

    fn and(self, other: Self) -> Self {
        Self {
            least_rad: self.least_rad.min(other.least_rad),
            most_rad: self.most_rad.max(other.most_rad),
        }
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

/// A sample of a flight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shown {
    /// What is to come to rest, rad: the error, or the pitch.
    pub(super) moving_rad: f64,
    pub(super) command_rad: f64,
    /// What acts beside the command at the servo, rad.
    pub(super) at_servo_rad: f64,
    pub(super) elevator_rad: f64,
    pub(super) autopilot_is_limited: bool,
    /// Gains of the controller.
    pub(super) gains: Gains<f64>,
    pub(super) outer: Outer,
}

/// How many quantities are asked for that a mode holds, and the places of heading and beam among them.
pub(super) const HELD: usize = 4;
pub(super) const HEADING: usize = 2;
pub(super) const BEAM: usize = 3;

/// What the loops around the pitch loop hold.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Outer {
    /// How far altitude, m, airspeed, m/s, heading, rad, and the beam of a glide slope, m, are from what they are to be; 0 of what
    /// nobody holds.
    pub(super) off: [f64; HELD],
    /// Number of the mode.
    pub(super) mode: f64,
    /// Bank and aileron, rad.
    pub(super) lateral_rad: [f64; 2],
}

/// What error, command and elevator do over some samples, and whether a limit was met in them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    error: Reach,
    /// How far the error went, there and back.
    way_rad: f64,
    command: Reach,
    elevator: Reach,
    gains: [Reach; 3],
    /// Of [`Outer::off`], and of the modes.
    off: [Reach; HELD],
    modes: Reach,
    bank: Reach,
    /// How far the bank went, there and back.
    bank_way_rad: f64,
    samples: usize,
    /// At how many of them a limit was met.
    met: usize,
    /// At how many of them the aileron stood at one of its stops.
    aileron_met: usize,
}

impl Span {
    const NONE: Self = Self {
        error: Reach::NONE,
        way_rad: 0.0,
        command: Reach::NONE,
        elevator: Reach::NONE,
        gains: [Reach::NONE; 3],
        off: [Reach::NONE; HELD],
        modes: Reach::NONE,
        bank: Reach::NONE,
        bank_way_rad: 0.0,
        samples: 0,
        met: 0,
        aileron_met: 0,
    };

    pub(super) fn and(self, other: Self) -> Self {
        Self {
            error: self.error.and(other.error),
            way_rad: self.way_rad + other.way_rad,
            command: self.command.and(other.command),
            elevator: self.elevator.and(other.elevator),
            gains: [0, 1, 2].map(|place| self.gains[place].and(other.gains[place])),
            off: std::array::from_fn(|place| self.off[place].and(other.off[place])),
            modes: self.modes.and(other.modes),
            bank: self.bank.and(other.bank),
            bank_way_rad: self.bank_way_rad + other.bank_way_rad,
            samples: self.samples + other.samples,
            met: self.met + other.met,
            aileron_met: self.aileron_met + other.aileron_met,
        }
    }

    /// True where a limit was met.
    pub(super) const fn meets(self) -> bool {
        self.met > 0 || self.aileron_met > 0
    }

    pub(super) fn error_size_rad(self) -> f64 {
        self.error.size_rad()
    }

    /// True where each gain moves by no more than a share of what it is at most, so that they are those of one rest.
    pub(super) fn has_gains_within(self, share: f64) -> bool {
        self.gains.iter().all(|gain| {
            let most = gain.least_rad.abs().max(gain.most_rad.abs());
            gain.size_rad() <= share * most
        })
    }

    /// How far off the error is at most.
    pub(super) fn error_off_rad(self) -> f64 {
        self.error.least_rad.abs().max(self.error.most_rad.abs())
    }

    /// How far what a mode holds, in the units of [`Outer::off`], moves from what it is to be, and how far it is at most.
    pub(super) fn off(self) -> [[f64; 2]; HELD] {
        self.off.map(|it| [it.size_rad(), it.least_rad.abs().max(it.most_rad.abs())])
    }

    /// True where one mode flew all of it.
    pub(super) fn is_of_one_mode(self) -> bool {
        self.modes.size_rad() == 0.0
    }

    pub(super) const fn samples(self) -> usize {
        self.samples
    }

    /// True where a limit was met for so long that what moves is a swing at it.
    const fn is_at_limits(self) -> bool {
        self.met * AT_LIMITS >= self.samples
    }

    /// True where limits were met all the time, but for a tenth of it.
    pub(super) const fn stands_at_limits(self) -> bool {
        10 * self.met >= 9 * self.samples
    }

    /// True where the error went there and back: what drifts one way at a limit is no swing.
    pub(super) fn turns(self) -> bool {
        self.way_rad >= TURNS * self.error.size_rad()
    }

    /// True where the bank went there and back, and the aileron stood at its stops for as long.
    fn banks_at_stops(self) -> bool {
        self.aileron_met * AT_LIMITS >= self.samples
            && self.bank_way_rad >= TURNS * self.bank.size_rad()
    }

    fn of(spans: &[Self]) -> Self {
        spans.iter().fold(Self::NONE, |all, one| all.and(*one))
    }
}

/// A flight in pieces of one length; the last may be shorter.
pub(super) struct Pieces<'a> {
    ends: &'a Ends,
    /// Travel of the aileron, of an aircraft that has one.
    aileron_rad: Option<Range>,
    pub(super) length: usize,
    /// An error that moves by no more has not moved for a sensor of such a resolution.
    unseen_rad: f64,
    /// An autopilot may stand at a limit of its own while the pitch drifts, as in a long climb.
    pub(super) may_drift: bool,
    samples: usize,
    all: Vec<Span>,
    before: Option<Shown>,
}

impl<'a> Pieces<'a> {
    pub(super) fn new(scenario: &Scenario, ends: &'a Ends, length: usize) -> Self {
        let resolution_rad =
            scenario.surroundings.pitch_sensor.map_or(0.0, |it| it.model().resolution);
        let unseen_rad = UNSEEN * resolution_rad;
        let may_drift = scenario.autopilot.is_some();
        let aircraft = scenario.plant.aircraft();
        let aileron_rad = aircraft.map(|it| it.aircraft().model().travel().aileron_rad);
        let (samples, all, before) = (0, Vec::new(), None);
        Self { ends, aileron_rad, length, unseen_rad, may_drift, samples, all, before }
    }

    /// True where what moves is the error of the pitch loop, and not the pitch itself.
    pub(super) const fn shows_errors(&self) -> bool {
        !self.may_drift
    }

    /// Takes a sample. A heading is followed through whole turns: one that goes round gets further away with each.
    pub(super) fn push(&mut self, mut shown: Shown) {
        let off_rad = &mut shown.outer.off[HEADING];
        *off_rad = turned_towards(self.before.map_or(0.0, |it| it.outer.off[HEADING]), *off_rad);
        let Shown { moving_rad, command_rad, at_servo_rad, elevator_rad, .. } = shown;
        let before = self.before.unwrap_or(shown);
        let meets = shown.autopilot_is_limited
            || self.ends.are_met(command_rad, at_servo_rad)
            || self.ends.are_met_by_moving(
                AT_RATE,
                command_rad - before.command_rad,
                elevator_rad - before.elevator_rad,
            );
        let [[bank_rad, aileron_rad], [bank_before_rad, _]] =
            [shown, before].map(|it| it.outer.lateral_rad);
        let is_at_a_stop = |it: Range| aileron_rad <= it.min || aileron_rad >= it.max;
        let sample = Span {
            error: Reach::at(moving_rad),
            way_rad: (moving_rad - before.moving_rad).abs(),
            command: Reach::at(command_rad),
            elevator: Reach::at(elevator_rad),
            gains: [shown.gains.kp, shown.gains.ki, shown.gains.kd].map(Reach::at),
            off: shown.outer.off.map(Reach::at),
            modes: Reach::at(shown.outer.mode),
            bank: Reach::at(bank_rad),
            bank_way_rad: (bank_rad - bank_before_rad).abs(),
            samples: 1,
            met: usize::from(meets),
            aileron_met: usize::from(self.aileron_rad.is_some_and(is_at_a_stop)),
        };
        self.before = Some(shown);
        if self.samples.is_multiple_of(self.length) {
            self.all.push(Span::NONE);
        }
        self.samples += 1;
        if let Some(last) = self.all.last_mut() {
            *last = last.and(sample);
        }
    }

    pub(super) fn whole(&self) -> Span {
        Span::of(&self.all)
    }

    /// The last two pieces, one of them whole.
    pub(super) fn tail(&self) -> Span {
        self.last(2)
    }

    /// So many of the last pieces, or all that there are.
    pub(super) fn last(&self, pieces: usize) -> Span {
        self.before_last(pieces, 0)
    }

    /// So many pieces before so many of the last, or all of these that there are.
    pub(super) fn before_last(&self, pieces: usize, last: usize) -> Span {
        let end = self.all.len().saturating_sub(last);
        Span::of(&self.all[end.saturating_sub(pieces)..end])
    }

    /// True where the last two pieces have come to rest: within the limits with a command that stands, for an error alone stands
    /// too where it turns, and before a response has begun; or as well as the sensor sees.
    pub(super) fn rests(&self) -> bool {
        let tail = self.tail();
        let stands = |of: fn(Span) -> Reach| self.stands(tail, of);
        tail.error.size_rad() <= self.unseen_rad
            || (!tail.meets() && stands(|it| it.error) && stands(|it| it.command))
    }

    /// True where the last piece is whole.
    pub(super) fn is_whole(&self) -> bool {
        self.samples.is_multiple_of(self.length)
    }

    /// True where the last two pieces are whole and alike.
    pub(super) fn repeats(&self) -> bool {
        match self.all.last_chunk() {
            Some([one, other]) if self.is_whole() => one.error.is_like(other.error, 0.0),
            _ => false,
        }
    }

    /// True where little is left of a beginning, under noise; of gains that move with it, next to nothing.
    pub(super) fn is_quiet(&self, gains_move: bool) -> bool {
        self.moves_by_at_most(self.tail(), if gains_move { QUIET_GAINS } else { QUIET })
    }

    /// The flight in five parts.
    fn fifths(&self) -> [Span; 5] {
        let pieces = self.all.len();
        std::array::from_fn(|part| Span::of(&self.all[part * pieces / 5..(part + 1) * pieces / 5]))
    }

    /// The last two of five parts; none of fewer pieces than that.
    pub(super) fn last_fifths(&self) -> Option<[Span; 2]> {
        let [.., fourth, fifth] = self.fifths();
        (self.all.len() >= 5).then_some([fourth, fifth])
    }

    /// True where the error moves in a part by no more than a share of all its movement, or than its sensor sees.
    pub(super) fn moves_by_at_most(&self, part: Span, share: f64) -> bool {
        let moves_rad = part.error.size_rad();
        moves_rad <= self.unseen_rad.max(share * self.whole().error.size_rad())
    }

    /// True where limits are still met near the end of a flight that was flown on, and the error moves there as one does that
    /// will not settle: a last fifth beside the one before it; or of a swing that is longer, the last two beside the first two.
    ///
    /// With nothing that moves it, what still meets limits then has not settled. Moved by swings it grows; and the error of a
    /// plant that runs away has to repeat what it did, for at a limit such a plant may be held by luck. Under noise it doubles.
    pub(super) fn goes_on(&self, moved: Moved, moves: Moves) -> bool {
        let [.., fourth, fifth] = self.fifths();
        let end = fourth.and(fifth);
        end.meets()
            && match (moved, moves) {
                (_, Moves::Back) if self.stands_at_a_limit(end) => false,
                (Moved::Nothing, _) => true,
                (Moved::BySwings, Moves::Away) => {
                    !fifth.error.is_like(fourth.error, self.unseen_rad)
                }
                (Moved::BySwings, Moves::On | Moves::Back) => self.grows(GROWN),
                (Moved::ByNoise, _) => self.grows(GROWN_IN_NOISE),
            }
    }

    /// True for an aircraft's flight at the end of which limits are met again and again in an error that does not shrink.
    pub(super) fn swings_on(&self, moved: Moved, moves: Moves) -> bool {
        // Of fewer pieces than fifths nothing is said.
        if self.all.len() < 5 {
            return false;
        }
        let [.., fourth, fifth] = self.fifths();
        let end = fourth.and(fifth);
        let stands = moves == Moves::Back && self.stands_at_a_limit(end);
        let times = if moved == Moved::Nothing { STAYS } else { GROWN_IN_NOISE };
        let is_at_limits = fourth.is_at_limits() && fifth.is_at_limits();
        let swings = !self.may_drift || end.turns();
        (is_at_limits && swings && !stands && self.grows(times)) || self.banks_on(times)
    }

    /// True where the bank swings at the stops of the aileron through the last two fifths, and does not shrink.
    fn banks_on(&self, times: f64) -> bool {
        let [.., fourth, fifth] = self.fifths();
        let stands = self.stands(fourth.and(fifth), |it| it.bank);
        let at_stops = fourth.banks_at_stops() && fifth.banks_at_stops();
        at_stops && !stands && fifth.bank.size_rad() >= times * fourth.bank.size_rad()
    }

    /// True where limits are met again and again at the end of a flight.
    pub(super) fn ends_at_limits(&self) -> bool {
        self.tail().is_at_limits()
    }

    /// True where the error moves in the last two fifths, under noise at limits, twice as much as in an earlier part.
    pub(super) fn has_doubled_since(&self, earlier: Span) -> bool {
        let [.., fourth, fifth] = self.fifths();
        let end = fourth.and(fifth);
        end.meets() && end.error.size_rad() >= GROWN_IN_NOISE * earlier.error.size_rad()
    }

    /// True for a part that a limit keeps short of its set-point, where a plant that comes to rest by itself is left to do so.
    fn stands_at_a_limit(&self, part: Span) -> bool {
        self.stands(part, |it| it.error) || self.stands(part, |it| it.elevator)
    }

    /// True where a quantity stands still in a part.
    fn stands(&self, part: Span, of: fn(Span) -> Reach) -> bool {
        of(part).size_rad() <= RESTS * of(self.whole()).size_rad()
    }

    fn grows(&self, times: f64) -> bool {
        let [first, second, _, fourth, fifth] = self.fifths();
        let (start, end) = (first.and(second).error, fourth.and(fifth).error);
        fifth.error.size_rad() >= times * fourth.error.size_rad()
            || end.size_rad() >= times.max(GROWN) * start.size_rad()
    }
}

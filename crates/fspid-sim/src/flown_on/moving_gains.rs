//! Flights whose gains move with an error: when they have left the rest around which the loop holds, limits or none.
//!
//! The rest is that of the gains there. A flight that is further off than that flies with others, of which it tells nothing.

#[cfg(test)]
mod tests;

use core::f64::consts::PI;

use super::moved::Moved;
use super::periods_s;
use super::pieces::{HEADING, HELD, Pieces, Span};
use crate::controller::Controller;
use crate::rest::leakage_per_s;
use crate::scenario::Scenario;
use crate::sensor::Sensor;

/// With nothing that moves it, an error that shrinks by less than a hundredth from one fifth of a flight to the next stays: where
/// no limit is met, nothing but a swing does, and slow motions that shrink are told from it.
const STAYS: f64 = 0.99;
/// What widths of actuator or sensors keep swinging, and what creeps one way, grows where it moves so many times as much: a slow
/// motion towards a rest has the same pace for long.
const GROWN: f64 = 1.05;
/// Of a fifth that holds so many periods of what swings, the size is that of the next but for growth.
const PERIODS: f64 = 2.0;
/// What is moved by something has grown where it has doubled.
const DOUBLED: f64 = 2.0;
/// An aircraft's error or pitch that moves at the end by no more than this share of all its movement moves no gains.
const STANDS: f64 = 0.02;
/// Nor does what is held, away from where it is to be, by more than this share of the furthest that it was, if it gets further away.
const STILL: f64 = 1e-3;
/// A swing that is so many times as wide as the widths of actuator and sensors is none of theirs.
const WIDTHS: f64 = 10.0;
/// Gains that move by no more than this share of themselves are those of one rest.
const SETTLED_GAINS: f64 = 0.01;
/// An error that moves in two pieces of the way by no more than this share of what it moved in the two before shrinks.
const SHRINKS: f64 = 0.9;
/// Pieces of a flight that is flown on that are as long as the flight, at least.
const OWN_LENGTH: usize = 5;
/// What a step of a rate gyro is of pitch: that of a second.
const RATE_S: f64 = 1.0;
/// An aircraft's error that is so many times as large has not drifted with speed and height: what runs away by its gains does so
/// ever faster.
const GONE: f64 = 1.25;
/// An error that is no larger is none of an aircraft that has left its set-point, rad.
const NEAR_RAD: f64 = PI / 180.0;
/// Altitude, m, airspeed, m/s, heading, rad, and the beam of a glide slope, m, that are nearer to what they are to be are there.
const NEAR: [f64; HELD] = [3.0, 0.5, NEAR_RAD, 3.0];

/// How a flight is judged whose gains move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MovingGains {
    /// All widths that keep a loop swinging by themselves, rad: a deadband, play, the steps of a sensor.
    width_rad: f64,
    /// The slowest of what swings, s; 0 for none.
    longest_period_s: f64,
    dt_s: f64,
    /// Speed and height drift beside; only what turns back is a swing.
    is_of_aircraft: bool,
    /// The controller's gains keep what their inputs were.
    accumulate: bool,
}

impl MovingGains {
    /// None where all gains are fixed: those of the controller, and of outer loops that a mode engages.
    pub(super) fn of(scenario: &Scenario, controller: &Controller) -> Option<Self> {
        let tunes = |it: &Controller| matches!(it, Controller::SelfTuning(_));
        let mut outer = scenario.autopilot.iter().flat_map(|it| it.loops());
        if !(tunes(controller) || outer.any(|it| tunes(&it.controller))) {
            return None;
        }
        let width_rad = width_rad(scenario);
        let longest_period_s =
            periods_s(scenario).map(|(_, period_s)| period_s).fold(0.0, f64::max);
        let dt_s = scenario.timing.dt_s();
        let is_of_aircraft = scenario.plant.linear().is_none();
        let accumulate = accumulates(controller);
        Some(Self { width_rad, longest_period_s, dt_s, is_of_aircraft, accumulate })
    }

    /// True where the error at the end of a flight does not shrink.
    ///
    /// Under what swings a fifth has to hold some periods of it, for otherwise each fifth is another part of one.
    pub(super) fn have_left(self, pieces: &Pieces<'_>, moved: Moved) -> bool {
        let Some([fourth, fifth]) = pieces.last_fifths() else { return false };
        let turns = fourth.and(fifth).turns();
        let [before_rad, last_rad] = [fourth, fifth].map(Span::error_size_rad);
        let stays_or_grows = match moved {
            // What is seen in steps is as large but for one.
            Moved::Nothing if turns && last_rad > WIDTHS * self.width_rad => {
                last_rad + self.width_rad >= STAYS * before_rad
            }
            Moved::Nothing => last_rad >= GROWN * before_rad,
            Moved::BySwings => {
                let fifth_s = fifth.samples() as f64 * self.dt_s;
                let is_seen = PERIODS * self.longest_period_s <= fifth_s;
                is_seen && last_rad >= DOUBLED * before_rad
            }
            Moved::ByNoise => last_rad >= DOUBLED * before_rad,
        };
        stays_or_grows && (turns || !self.is_of_aircraft)
    }

    /// True where what is held is left: altitude or airspeed, which go away from what a mode holds or do not come back to it, with
    /// an error that does not stand, for at a limit of an outer loop the pitch stands while they go; or an aircraft's set-point.
    pub(super) fn leave_what_is_held(self, pieces: &Pieces<'_>, moved: Moved) -> bool {
        let Some([fourth, fifth]) = pieces.last_fifths() else { return false };
        if self.is_of_aircraft && pieces.shows_errors() && has_gone_off([fourth, fifth], moved) {
            return true;
        }
        leave_what_a_mode_holds(pieces, moved)
    }

    /// True where an aircraft's flight ends so near a rest that its gains are those of the rest.
    pub(super) fn stand(pieces: &Pieces<'_>) -> bool {
        Self::have_stood(pieces, pieces.tail())
    }

    /// True where a flight that is flown on has been so near a rest, within its limits, for as long as the flight was; of a linear
    /// plant with gains that hardly move any more, and an error that shrinks.
    pub(super) fn have_come_back(self, pieces: &Pieces<'_>) -> bool {
        let last = pieces.last(OWN_LENGTH);
        let is_at_its_rest = || self.is_of_aircraft || self.come_to_one_rest(pieces, last);
        !last.meets() && Self::have_stood(pieces, last) && is_at_its_rest()
    }

    /// True where the gains are those of one rest, and the error goes on to shrink towards it.
    ///
    /// Gains that follow their inputs are meant: those of an accumulating law come to another rest with every motion.
    fn come_to_one_rest(self, pieces: &Pieces<'_>, last: Span) -> bool {
        let [before_rad, last_rad] =
            [pieces.before_last(2, 2), pieces.tail()].map(Span::error_size_rad);
        !self.accumulate && last.has_gains_within(SETTLED_GAINS) && last_rad <= SHRINKS * before_rad
    }

    fn have_stood(pieces: &Pieces<'_>, part: Span) -> bool {
        let furthest = furthest(pieces);
        let [part_off, before, last] =
            [part, pieces.before_last(1, 1), pieces.last(1)].map(Span::off);
        let stands = |place: usize| {
            let [[moves, _], [_, before], [moves_last, last]] =
                [part_off, before, last].map(|it| it[place]);
            let far = furthest[place];
            // What gets away slowly from where it is to be does not stand there.
            let goes_away = last > NEAR[place] && last > before && moves_last > STILL * far;
            moves <= NEAR[place].max(STANDS * far) && !goes_away
        };
        pieces.moves_by_at_most(part, STANDS) && (0..NEAR.len()).all(stands)
    }
}

/// True where altitude, airspeed, heading or a beam go away from what one mode holds through the last two fifths, or do not come
/// back to it.
pub(super) fn leave_what_a_mode_holds(pieces: &Pieces<'_>, moved: Moved) -> bool {
    let Some([fourth, fifth]) = pieces.last_fifths() else { return false };
    let furthest = furthest(pieces);
    let [before, last] = [fourth, fifth].map(Span::off);
    let times = if moved == Moved::Nothing { STAYS } else { DOUBLED };
    let goes = |place: usize| {
        let [[_, before], [moves, last]] = [before, last].map(|it| it[place]);
        last > NEAR[place] && last >= times * before && moves > STANDS * furthest[place]
    };
    fourth.and(fifth).is_of_one_mode() && (0..NEAR.len()).any(goes)
}

/// How far what a mode holds was from what it is to be, in the units of [`NEAR`]; a heading no further than half a turn, for whole
/// turns behind it leave it no more room to swing.
fn furthest(pieces: &Pieces<'_>) -> [f64; HELD] {
    let mut furthest = pieces.whole().off().map(|[_, most]| most);
    furthest[HEADING] = furthest[HEADING].min(PI);
    furthest
}

/// True where the error has become so much larger from one fifth of a flight to the next that what drifts would not, nor chance
/// where something moves it.
fn has_gone_off([before, last]: [Span; 2], moved: Moved) -> bool {
    let [before_rad, last_rad] = [before, last].map(Span::error_off_rad);
    let times = if moved == Moved::Nothing { GONE } else { DOUBLED };
    last_rad > NEAR_RAD && last_rad >= times * before_rad
}

fn accumulates(controller: &Controller) -> bool {
    matches!(controller, Controller::SelfTuning(fspid) if leakage_per_s(fspid).is_some())
}

/// All widths of actuator and sensors, rad.
fn width_rad(scenario: &Scenario) -> f64 {
    let resolution = |sensor: Option<Sensor>| sensor.map_or(0.0, |it| it.model().resolution);
    let surroundings = &scenario.surroundings;
    scenario.actuator.deadband_rad()
        + scenario.actuator.play_rad()
        + resolution(surroundings.pitch_sensor)
        + RATE_S * resolution(surroundings.rate_sensor)
}

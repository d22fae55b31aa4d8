//! The segments of an actuator's motion between two samples, each with its own linear law: following the command, rate
//! limited, against a stop, in backlash.

use super::{Actuator, ActuatorState, within};

/// A time during which the surface obeys one linear law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Leg {
    pub(crate) duration_s: f64,
    /// Deflection at its beginning, rad.
    pub(crate) from_rad: f64,
    /// Its rate there, rad/s, for lags of second order.
    pub(crate) from_rate_rad_s: f64,
    pub(crate) course: Course,
}

/// The law of a leg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Course {
    /// The lag, towards this deflection.
    Follow { target_rad: f64 },
    /// A constant rate; 0 to stand still.
    Ramp { rate_rad_s: f64 },
}

/// What moves the actuator.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Drive {
    /// Its lag.
    Free,
    /// Its rate limit, for so long.
    Limited { rate_rad_s: f64, until_s: f64 },
    /// Nothing: it is there, or against a stop.
    Held,
}

/// What ends a leg before its time.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Event {
    Stop(f64),
    RateLimit(f64),
    Reversal,
    Contact,
}

/// Most legs a sample; a chattering actuator is held after them. A lag of second order that a scenario may have swings sixteen times
/// within one, each with up to six legs, through stops, rate limit and play.
const MOST_LEGS: usize = 256;
/// Shorter legs are rounding, s.
const SHORTEST_S: f64 = 1e-12;
/// Excess over a rate limit that is rounding.
const ROUNDING: f64 = 1e-9;
/// Halvings that find an event to the last bit of a piece.
const HALVINGS: usize = 52;

impl Actuator {
    /// Follows a held command for `dt_s` and shows every leg in order; their times add up to `dt_s`.
    pub(crate) fn legs(
        &self,
        state: &mut ActuatorState,
        command_rad: f64,
        dt_s: f64,
        mut each: impl FnMut(Leg),
    ) {
        let target_rad = self.target_rad(command_rad);
        self.settle(state, command_rad);
        let mut left_s = dt_s;
        for _ in 0..MOST_LEGS {
            if !(left_s > 0.0) {
                return;
            }
            let drive = self.drive(state, target_rad);
            let direction = self.direction(state, target_rad, drive);
            self.meet(state, direction);
            let (from, moves) = (*state, self.moves_surface(state));
            let duration_s = self.pass(state, target_rad, drive, direction, left_s);
            each(self.leg(&from, duration_s, if moves { drive } else { Drive::Held }, target_rad));
            left_s -= duration_s;
        }
        each(self.leg(state, left_s, Drive::Held, target_rad));
    }

    /// The target, rad, of one that nothing but a lag of second order ever moves, so that every time is one leg of it without
    /// an event; for who moves the position by [`second_order_after`](super::lag::second_order_after) and says so by
    /// [`land`](Self::land).
    pub(crate) fn set_off(&self, state: &mut ActuatorState, command_rad: f64) -> Option<f64> {
        let is_free = self.rate_limit_rad_s.or(self.travel_rad.map(|(most, _)| most)).is_none();
        if !(is_free && self.play_rad == 0.0 && self.lag.order() == 2) {
            return None;
        }
        let target_rad = self.target_rad(command_rad);
        let direction = self.direction(state, target_rad, Drive::Free);
        self.meet(state, direction);
        Some(target_rad)
    }

    /// Where a leg by the lag has led, rad and rad/s.
    pub(crate) fn land(&self, state: &mut ActuatorState, [position_rad, rate_rad_s]: [f64; 2]) {
        (state.position_rad, state.rate_rad_s) = (position_rad, rate_rad_s);
        state.surface_rad = state.position_rad - state.contact * 0.5 * self.play_rad;
    }

    /// Moves an actuator without lag and rate limit to its command at once.
    pub(crate) fn settle(&self, state: &mut ActuatorState, command_rad: f64) {
        if self.is_at_once() {
            state.position_rad = within(self.travel_rad, self.target_rad(command_rad));
            let (x, half_rad) = (state.position_rad, 0.5 * self.play_rad);
            state.surface_rad = state.surface_rad.clamp(x - half_rad, x + half_rad);
        }
    }

    fn drive(&self, state: &ActuatorState, target_rad: f64) -> Drive {
        let gap_rad = target_rad - state.position_rad;
        if self.pressed(state, gap_rad) {
            return Drive::Held;
        }
        if let Some(limit) = self.rate_limit_rad_s {
            let until_s = gap_rad.abs() / limit - self.lag.trailing_s();
            let at_limit = self.lag.order() < 2 || state.rate_rad_s * gap_rad.signum() >= limit;
            if until_s > SHORTEST_S && at_limit {
                return Drive::Limited { rate_rad_s: limit.copysign(gap_rad), until_s };
            }
        }
        if self.lag.order() == 0 { Drive::Held } else { Drive::Free }
    }

    /// True at a stop with the command beyond it.
    fn pressed(&self, state: &ActuatorState, gap_rad: f64) -> bool {
        let towards = state.rate_rad_s * gap_rad >= 0.0;
        self.travel_rad.is_some_and(|(least, most)| {
            let up = state.position_rad >= most && gap_rad > 0.0;
            let down = state.position_rad <= least && gap_rad < 0.0;
            towards && (up || down)
        })
    }

    /// Which way the position moves next: 1, -1 or 0.
    fn direction(&self, state: &ActuatorState, target_rad: f64, drive: Drive) -> f64 {
        let velocity = match drive {
            Drive::Held => 0.0,
            Drive::Limited { rate_rad_s, .. } => rate_rad_s,
            Drive::Free if self.lag.order() == 2 && state.rate_rad_s != 0.0 => state.rate_rad_s,
            Drive::Free => target_rad - state.position_rad,
        };
        if velocity == 0.0 { 0.0 } else { velocity.signum() }
    }

    /// Opens the side of the play that is moved away from and closes the one that is reached.
    fn meet(&self, state: &mut ActuatorState, direction: f64) {
        if direction * state.contact < 0.0 {
            state.contact = 0.0;
        }
        let room_rad = 0.5 * self.play_rad - direction * (state.position_rad - state.surface_rad);
        if direction != 0.0 && room_rad <= 0.0 {
            state.contact = direction;
        }
    }

    fn moves_surface(&self, state: &ActuatorState) -> bool {
        self.play_rad == 0.0 || state.contact != 0.0
    }

    /// Moves the actuator through one leg of at most `left_s`, and returns its duration, s.
    fn pass(
        &self,
        state: &mut ActuatorState,
        target_rad: f64,
        drive: Drive,
        direction: f64,
        left_s: f64,
    ) -> f64 {
        let moves = self.moves_surface(state);
        let duration_s = match drive {
            Drive::Held => {
                state.rate_rad_s = 0.0;
                left_s
            }
            Drive::Limited { rate_rad_s, until_s } => {
                self.ramp(state, rate_rad_s, left_s.min(until_s))
            }
            Drive::Free => self.follow(state, target_rad, direction, left_s),
        };
        if moves {
            state.surface_rad = state.position_rad - state.contact * 0.5 * self.play_rad;
        }
        duration_s
    }

    /// A leg at a constant rate, up to the stop or the far side of the play.
    fn ramp(&self, state: &mut ActuatorState, rate_rad_s: f64, most_s: f64) -> f64 {
        let stop_rad =
            self.travel_rad.map(|(least, most)| if rate_rad_s > 0.0 { most } else { least });
        let stop_s =
            stop_rad.map_or(f64::INFINITY, |stop| (stop - state.position_rad) / rate_rad_s);
        let contact_s = if self.moves_surface(state) {
            f64::INFINITY
        } else {
            let far_rad = state.surface_rad + (0.5 * self.play_rad).copysign(rate_rad_s);
            (far_rad - state.position_rad) / rate_rad_s
        };
        let duration_s = most_s.min(stop_s).min(contact_s).max(0.0);
        state.rate_rad_s = rate_rad_s;
        state.position_rad = within(self.travel_rad, state.position_rad + rate_rad_s * duration_s);
        if duration_s >= stop_s {
            state.position_rad = stop_rad.unwrap_or(state.position_rad);
            state.rate_rad_s = 0.0;
        } else if duration_s >= contact_s {
            state.contact = rate_rad_s.signum();
        }
        duration_s
    }

    /// A leg by the lag, up to the first event.
    fn follow(
        &self,
        state: &mut ActuatorState,
        target_rad: f64,
        direction: f64,
        left_s: f64,
    ) -> f64 {
        let pieces = self.lag.pieces(left_s);
        let piece_s = left_s / f64::from(pieces);
        let whole = self.lag.piece(piece_s);
        for piece in 0..pieces {
            let from = [state.position_rad, state.rate_rad_s];
            let behind = whole.after(from, target_rad);
            if self.event(state, direction, behind).is_none() {
                [state.position_rad, state.rate_rad_s] = behind;
                continue;
            }
            let at = |time_s: f64| self.lag.after(from, target_rad, time_s);
            let (mut before_s, mut event_s) = (0.0, piece_s);
            for _ in 0..HALVINGS {
                let middle_s = 0.5 * (before_s + event_s);
                let happened = self.event(state, direction, at(middle_s)).is_some();
                *(if happened { &mut event_s } else { &mut before_s }) = middle_s;
            }
            let event = self.event(state, direction, at(event_s));
            [state.position_rad, state.rate_rad_s] = at(event_s);
            happen(state, direction, event);
            return (f64::from(piece) * piece_s + event_s).min(left_s);
        }
        left_s
    }

    /// What has happened on the way to a position and rate.
    fn event(
        &self,
        state: &ActuatorState,
        direction: f64,
        [position_rad, rate_rad_s]: [f64; 2],
    ) -> Option<Event> {
        let inside_rad = within(self.travel_rad, position_rad);
        if (position_rad - inside_rad).abs() > 0.0 {
            return Some(Event::Stop(inside_rad));
        }
        if self.lag.order() == 2 {
            let limit = self.rate_limit_rad_s.unwrap_or(f64::INFINITY);
            if rate_rad_s.abs() > limit * (1.0 + ROUNDING) {
                return Some(Event::RateLimit(limit.copysign(rate_rad_s)));
            }
            if self.play_rad > 0.0 && direction * rate_rad_s < 0.0 {
                return Some(Event::Reversal);
            }
        }
        let crossed_rad = direction * (position_rad - state.surface_rad);
        let open = !self.moves_surface(state);
        (open && crossed_rad > 0.5 * self.play_rad).then_some(Event::Contact)
    }

    fn leg(&self, from: &ActuatorState, duration_s: f64, drive: Drive, target_rad: f64) -> Leg {
        let course = match drive {
            Drive::Held => Course::Ramp { rate_rad_s: 0.0 },
            Drive::Limited { rate_rad_s, .. } => Course::Ramp { rate_rad_s },
            Drive::Free => {
                let shift_rad = self.bias_rad - from.contact * 0.5 * self.play_rad;
                Course::Follow { target_rad: target_rad + shift_rad }
            }
        };
        let from_rad = self.deflection_rad(from);
        Leg { duration_s, from_rad, from_rate_rad_s: from.rate_rad_s, course }
    }
}

fn happen(state: &mut ActuatorState, direction: f64, event: Option<Event>) {
    match event {
        Some(Event::Stop(stop_rad)) => {
            (state.position_rad, state.rate_rad_s) = (stop_rad, 0.0);
        }
        Some(Event::RateLimit(rate_rad_s)) => state.rate_rad_s = rate_rad_s,
        Some(Event::Reversal) => state.rate_rad_s = 0.0,
        Some(Event::Contact) => state.contact = direction,
        None => {}
    }
}

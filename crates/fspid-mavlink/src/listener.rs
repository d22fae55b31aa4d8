//! Messages of one sender, each at its own rate, joined into lines: one for each attitude.

use crate::frame::{Damage, Frame, Frames};
use crate::values::{SETPOINT, Told, Values, told};

/// Values with their names, `time_s` first.
pub type Line = Vec<(&'static str, f64)>;

/// Times that go back by more than this, in milliseconds, are those of another flight.
const BACK_MS: u32 = 500;
/// How long a value stands that is not told again, in milliseconds: three messages of a stream of one a second, the slowest
/// that autopilots are asked for. A set-point of a mode that has ended would else stand beside every attitude that follows.
const STANDS_MS: u32 = 3000;
/// So many attitudes of another sender, and none of the one that is followed, and the other one is followed.
const MISSED: u32 = 100;
/// Component of an autopilot. Gimbals and the like tell attitudes of their own.
const AUTOPILOT: u8 = 1;

/// Who sends: a system of MAVLink and its component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sender {
    /// Number of the system.
    pub system: u8,
    /// Number of the component.
    pub component: u8,
}

/// What was heard so far. Damage is told as it comes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Frames that were whole.
    pub frames: u64,
    /// Of these, those that say nothing of a pitch loop, or are not known.
    pub unused: u64,
    /// Of these, those that another sender sent than the one that is followed.
    pub others: u64,
    /// Who is followed.
    pub followed: Option<Sender>,
}

/// Hears packets; what it remembers is bounded.
#[derive(Clone, Debug, Default)]
pub struct Listener {
    counts: Counts,
    /// Attitudes of others since the last of the one that is followed.
    missed: u32,
    time_ms: u32,
    yaw_rad: Option<f64>,
    held: Vec<Held>,
    /// Whether the set-point is one that was told for the attitude.
    is_target: bool,
}

/// The latest of a value, and the time of the attitude before it.
#[derive(Clone, Copy, Debug)]
struct Held {
    name: &'static str,
    value: Option<f64>,
    told_ms: u32,
}

impl Listener {
    /// The lines of a packet, and what is wrong with it, in their order.
    pub fn hear(&mut self, packet: &[u8]) -> Vec<Result<Line, Damage>> {
        let heard = Frames(packet).map(|frame| self.take(&frame?));
        heard.filter_map(Result::transpose).collect()
    }

    /// What was heard so far.
    #[must_use]
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Heading of the latest attitude, rad, which no line has; nothing if it is no finite number.
    #[must_use]
    pub fn yaw_rad(&self) -> Option<f64> {
        self.yaw_rad
    }

    fn take(&mut self, frame: &Frame<'_>) -> Result<Option<Line>, Damage> {
        self.counts.frames += 1;
        let told = told(frame)?;
        if matches!(told, Told::Unused) {
            self.counts.unused += 1;
            return Ok(None);
        }
        let sender = Sender { system: frame.system, component: frame.component };
        if !self.follows(sender, matches!(told, Told::Attitude { .. })) {
            self.counts.others += 1;
            return Ok(None);
        }
        Ok(self.joined(told))
    }

    /// Whether a sender is the one that is followed: the first that tells an attitude, until another has to be.
    fn follows(&mut self, sender: Sender, is_attitude: bool) -> bool {
        if self.counts.followed == Some(sender) {
            self.missed = if is_attitude { 0 } else { self.missed };
            return true;
        }
        self.missed = self.missed.saturating_add(is_attitude.into());
        let is_better = self.counts.followed.is_none_or(|now| {
            self.missed > MISSED || (sender.component == AUTOPILOT && now.component != AUTOPILOT)
        });
        if is_attitude && is_better {
            let counts = Counts { followed: Some(sender), ..self.counts };
            *self = Self { counts, ..Self::default() };
        }
        is_attitude && is_better
    }

    /// Remembers what is told, and makes a line of an attitude.
    fn joined(&mut self, told: Told) -> Option<Line> {
        match told {
            Told::Attitude { time_ms, yaw_rad, values } => {
                self.yaw_rad = Some(yaw_rad).filter(|yaw_rad| yaw_rad.is_finite());
                return Some(self.line(time_ms, values));
            }
            Told::Held(values) => values.into_iter().for_each(|it| self.hold(it)),
            Told::Target(setpoint_deg) => {
                self.is_target = true;
                self.hold((SETPOINT, setpoint_deg));
            }
            Told::Desired(setpoint_deg) if !self.is_target => {
                self.hold((SETPOINT, Some(setpoint_deg)));
            }
            Told::Desired(_) | Told::Unused => {}
        }
        None
    }

    fn hold(&mut self, (name, value): (&'static str, Option<f64>)) {
        let new = Held { name, value, told_ms: self.time_ms };
        match self.held.iter_mut().find(|held| held.name == name) {
            Some(held) => *held = new,
            None => self.held.push(new),
        }
    }

    fn line(&mut self, time_ms: u32, values: Values) -> Line {
        // An autopilot that has begun anew: what it said before is not what it says now.
        if time_ms.saturating_add(BACK_MS) < self.time_ms {
            self.held.clear();
        }
        self.held.retain(|held| time_ms.saturating_sub(held.told_ms) <= STANDS_MS);
        // Without a target a desired pitch counts again.
        self.is_target &= self.held.iter().any(|held| held.name == SETPOINT);
        self.time_ms = time_ms;
        let time = ("time_s", Some(f64::from(time_ms) / 1000.0));
        let held = self.held.iter().map(|held| (held.name, held.value));
        let all = [time].into_iter().chain(values).chain(held);
        all.filter_map(|(name, value)| value.map(|value| (name, value))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn setpoint_at(listener: &mut Listener, time_ms: u32) -> Option<f64> {
        let line = listener.joined(Told::Attitude { time_ms, yaw_rad: 0.0, values: Vec::new() });
        line.expect("a line").into_iter().find(|(name, _)| *name == SETPOINT).map(|(_, it)| it)
    }

    #[test]
    fn a_set_point_that_is_not_told_any_more_is_none_and_a_desired_pitch_counts_again() {
        let mut listener = Listener::default();
        assert_eq!(setpoint_at(&mut listener, 10_000), None);
        listener.joined(Told::Target(Some(2.0)));
        listener.joined(Told::Desired(7.0));
        assert_eq!(setpoint_at(&mut listener, 10_000 + STANDS_MS), Some(2.0));
        assert_eq!(setpoint_at(&mut listener, 10_001 + STANDS_MS), None);
        listener.joined(Told::Desired(7.0));
        assert_eq!(setpoint_at(&mut listener, 10_100 + STANDS_MS), Some(7.0));
    }
}

//! One controller of the autopilot's cascade during a flight: its state, engagement and output.

use fspid_core::{Sample, State, Step};

use crate::controller::Controller;

/// Whether what a loop moves is cut, and which way it wanted to go.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Cut {
    #[default]
    Not,
    Up,
    Down,
}

impl Cut {
    /// The side to which a difference points; not cut for none.
    pub(crate) fn towards(difference: f64) -> Self {
        if difference > 0.0 {
            Self::Up
        } else if difference < 0.0 {
            Self::Down
        } else {
            Self::Not
        }
    }

    /// The same seen through a sign.
    pub(super) fn through(self, sign: f64) -> Self {
        match self {
            cut if sign > 0.0 => cut,
            Self::Up => Self::Down,
            Self::Down => Self::Up,
            Self::Not => Self::Not,
        }
    }

    /// This one, or the other where nothing is cut.
    pub(crate) fn or(self, other: Self) -> Self {
        if self == Self::Not { other } else { self }
    }

    /// Which way a controller is cut that answers a step after a command, at which it was cut this way: one that stands at a
    /// limit does not move and is cut as before.
    pub(crate) fn after(self, step: &Step<f64>, before: f64) -> Self {
        match step.saturated {
            true => Self::towards(step.command_rad - before).or(self),
            false => Self::Not,
        }
    }
}

/// What a controller of the cascade is asked with at a sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Asked {
    pub(super) target: f64,
    pub(super) measured: f64,
    pub(super) rate: f64,
    /// What it takes over from when it becomes engaged.
    pub(super) current: f64,
    /// Whether what it moves is cut.
    pub(super) blocked: Cut,
}

/// The memory of a controller of the cascade.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Channel {
    memory: Option<State<f64>>,
    /// Whether its answer was cut, by limits of its own.
    own: Cut,
    /// The same, or below.
    pub(super) cut: Cut,
}

impl Channel {
    /// True from the sample on at which it was asked first.
    pub(super) fn is_engaged(&self) -> bool {
        self.memory.is_some()
    }

    /// True where its answer was cut by limits of its own.
    pub(super) fn is_limited(&self) -> bool {
        self.own != Cut::Not
    }

    /// What it remembers while it is engaged.
    pub(super) fn memory(&self) -> Option<&State<f64>> {
        self.memory.as_ref()
    }

    /// The same, to be moved.
    pub(super) fn memory_mut(&mut self) -> Option<&mut State<f64>> {
        self.memory.as_mut()
    }

    /// Forgets.
    pub(super) fn disengage(&mut self) {
        *self = Self::default();
    }

    /// The controller's answer. The first after it became engaged is what it takes over from.
    pub(super) fn answer(&mut self, controller: &Controller, asked: &Asked) -> f64 {
        let sample = Sample {
            setpoint_rad: asked.target,
            measurement_rad: asked.measured,
            rate_rad_s: asked.rate,
        };
        let Some(before) = self.memory else {
            let mut memory = State::new();
            let step = controller.track(&mut memory, sample, asked.current);
            // What is taken over may lie beyond its limits.
            let own = Cut::towards(asked.current - step.command_rad);
            *self = Self { memory: Some(memory), own, cut: own };
            return step.command_rad;
        };
        let mut memory = before;
        let step = controller.step(&mut memory, sample);
        // Below there is no way further: the integral waits, the other terms may come back at once.
        if asked.blocked != Cut::Not
            && Cut::towards(memory.integral - before.integral) == asked.blocked
        {
            memory.integral = before.integral;
        }
        self.own = self.own.after(&step, before.command_rad);
        self.cut = self.own.or(asked.blocked);
        self.memory = Some(memory);
        step.command_rad
    }
}

#[cfg(test)]
mod tests {
    use fspid_core::{Gains, Pid, PidConfig};

    use super::*;

    fn integrating() -> Controller {
        let gains = Gains { kp: 0.5, ki: 0.2, kd: 0.0 };
        Controller::Fixed(Pid::new(gains, PidConfig::sampled_every(0.1)).expect("allowed"))
    }

    fn asked(current: f64, blocked: Cut) -> Asked {
        Asked { target: 2.0, measured: 0.0, rate: 0.0, current, blocked }
    }

    #[test]
    fn the_first_answer_is_what_is_taken_over_and_the_next_goes_on_from_there() {
        let (mut channel, controller) = (Channel::default(), integrating());
        assert_eq!(channel.answer(&controller, &asked(7.0, Cut::Not)), 7.0);
        // One sample of the integral: 0.2 · 2 · 0.1.
        let next = channel.answer(&controller, &asked(0.0, Cut::Not));
        assert!((next - 7.04).abs() < 1e-12, "{next}");
    }

    #[test]
    fn an_integral_waits_while_what_it_moves_is_cut_that_way_and_no_other() {
        for (blocked, after_s) in [(Cut::Up, 7.04), (Cut::Down, 7.4), (Cut::Not, 7.4)] {
            let (mut channel, controller) = (Channel::default(), integrating());
            let answers: Vec<f64> =
                (0..11).map(|_| channel.answer(&controller, &asked(7.0, blocked))).collect();
            let last = answers.last().copied().unwrap_or(f64::NAN);
            assert!((last - after_s).abs() < 1e-12, "{blocked:?}: {last}");
        }
    }

    #[test]
    fn what_is_disengaged_takes_over_anew() {
        let (mut channel, controller) = (Channel::default(), integrating());
        for _ in 0..5 {
            channel.answer(&controller, &asked(7.0, Cut::Not));
        }
        channel.disengage();
        assert!(!channel.is_engaged());
        assert_eq!(channel.answer(&controller, &asked(-3.0, Cut::Not)), -3.0);
    }
}

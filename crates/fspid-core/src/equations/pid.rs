//! The PID equations of one sample: from gains and inputs to the command.

use fspid_numeric::{Real, Scalar};

use super::{Memory, ends, limited, numbers};
use crate::gains::Gains;
use crate::integral::{AntiWindup, IntegralForm};
use crate::pid_config::PidConfig;
use crate::sample::Sample;
use crate::tuner::GainCoupling;

/// [`AntiWindup`] without its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AntiWindupKind {
    /// Nothing.
    None,
    /// Limits of the integral term.
    Clamping,
    /// The memory stands still.
    Conditional,
    /// The memory is pulled.
    BackCalculation,
}

impl AntiWindupKind {
    fn of<R>(anti_windup: AntiWindup<R>) -> Self {
        match anti_windup {
            AntiWindup::None => Self::None,
            AntiWindup::Clamping(_) => Self::Clamping,
            AntiWindup::Conditional => Self::Conditional,
            AntiWindup::BackCalculation { .. } => Self::BackCalculation,
        }
    }
}

/// Which equations a controller has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PidStructure {
    /// Bumpless or literal.
    pub integral: IntegralForm,
    /// Kind of anti-windup.
    pub anti_windup: AntiWindupKind,
    /// True if something moves with the gains.
    pub coupled: bool,
    /// True if a part of the command is fed forward.
    pub feeds_forward: bool,
    /// True if the command has limits or a slew limit.
    pub limited: bool,
}

numbers! {
    /// The numbers in the equations of a PID controller.
    PidNumbers:
    /// Sample period, s.
    dt_s,
    /// Gain of the pitch-rate loop at the nominal gains, s.
    rate_gain_s,
    /// Its change with `kd`.
    rate_gain_per_kd,
    /// Set-point weight in the proportional term at the nominal gains.
    proportional_weight,
    /// Its change with `kp`.
    weight_per_kp,
    /// Set-point weight in the derivative.
    derivative_weight,
    /// The nominal `kp`, from which that is counted.
    nominal_kp,
    /// The nominal `kd`.
    nominal_kd,
    /// Command per set-point beside the gains.
    feedforward,
    /// Derivative filter, s.
    filter_s,
    /// Lower limit of the command, rad.
    lower_rad,
    /// Upper limit of the command, rad.
    upper_rad,
    /// Largest change of the command in a sample, rad.
    slew_rad,
    /// Lower limit of the integral term, rad.
    term_lower_rad,
    /// Upper limit of the integral term, rad.
    term_upper_rad,
    /// Tracking time of the anti-windup, s.
    tracking_s,
}

/// A PID controller as equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PidEquations<S> {
    /// Which.
    pub structure: PidStructure,
    /// The numbers in them.
    pub numbers: PidNumbers<S>,
}

/// A sample before any limit of the command.
#[derive(Clone, Copy, Debug)]
pub struct Free<S> {
    /// The error, rad.
    pub error_rad: S,
    /// What the derivative acts on, rad.
    pub derivative_input_rad: S,
    /// The derivative, rad/s.
    pub derivative_rad_s: S,
    /// The integral's memory with this sample in it.
    pub wound: S,
    /// The integral's term of the command, rad.
    pub term_rad: S,
    /// The command, rad.
    pub command_rad: S,
}

/// What a command is made of before any limit: the first three less the rate's, and what is fed forward, in this order, are
/// it to the bit.
#[derive(Clone, Copy, Debug)]
pub struct Parts<S> {
    /// $k_p (b r - y)$, rad.
    pub proportional_rad: S,
    /// $I$, rad.
    pub integral_rad: S,
    /// $k_d d$, rad.
    pub derivative_rad: S,
    /// $k_r q$, rad, which is taken off.
    pub rate_rad: S,
    /// $k_f r$, rad.
    pub fed_forward_rad: S,
}

/// A sample behind the limits.
#[derive(Clone, Copy, Debug)]
pub struct Regulated<S> {
    /// The command, rad.
    pub command_rad: S,
    /// How much of it was cut off, rad.
    pub excess_rad: S,
    /// The integral's memory to keep.
    pub integral: S,
}

impl<R: Real> PidEquations<R> {
    /// The equations of a configuration, with what moves with the gains; nothing is checked.
    pub fn new(config: &PidConfig<R>, nominal: Gains<R>, coupling: GainCoupling<R>) -> Self {
        // In full, so that a new option does not compile until an equation has it.
        let PidConfig {
            dt_s,
            rate_gain_s,
            setpoint_weights,
            feedforward,
            derivative,
            integral,
            anti_windup,
            limits,
            slew_rad_s,
            guard: _,
        } = *config;
        let (lower_rad, upper_rad) = ends(limits);
        let term_limits = match anti_windup {
            AntiWindup::Clamping(limits) => Some(limits),
            AntiWindup::None | AntiWindup::Conditional | AntiWindup::BackCalculation { .. } => None,
        };
        let (term_lower_rad, term_upper_rad) = ends(term_limits);
        let coupled = coupling != GainCoupling::NONE;
        let feeds_forward = feedforward != R::ZERO;
        let numbers = PidNumbers {
            dt_s,
            rate_gain_s,
            rate_gain_per_kd: coupling.rate_gain,
            proportional_weight: setpoint_weights.proportional,
            weight_per_kp: coupling.setpoint_weight,
            derivative_weight: setpoint_weights.derivative,
            feedforward,
            nominal_kp: nominal.kp,
            nominal_kd: nominal.kd,
            filter_s: derivative.filter_s,
            lower_rad,
            upper_rad,
            slew_rad: slew_rad_s.map_or(R::from_f64(f64::INFINITY), |slew_rad_s| slew_rad_s * dt_s),
            term_lower_rad,
            term_upper_rad,
            tracking_s: match anti_windup {
                AntiWindup::BackCalculation { tracking_s } => tracking_s,
                AntiWindup::None | AntiWindup::Clamping(_) | AntiWindup::Conditional => R::ONE,
            },
        };
        let anti_windup = AntiWindupKind::of(anti_windup);
        let limited = limits.is_some() || slew_rad_s.is_some();
        Self {
            structure: PidStructure { integral, anti_windup, coupled, feeds_forward, limited },
            numbers,
        }
    }

    /// The same equations for numbers of another kind.
    pub fn lifted<S: Scalar>(&self) -> PidEquations<S> {
        let numbers = self.numbers.map(|number| S::constant(number.to_f64()));
        PidEquations { structure: self.structure, numbers }
    }
}

impl<S: Scalar> PidEquations<S> {
    /// The memory with which the first sample is answered: as if it had stood for ever, so that nothing
    /// changes; $d_0 = 0$.
    #[inline(always)]
    pub fn at_first(&self, sample: &Sample<S>, nominal: &Gains<S>) -> Memory<S> {
        Memory {
            command_rad: S::zero(),
            integral: S::zero(),
            derivative_rad_s: S::zero(),
            error_rad: sample.setpoint_rad - sample.measurement_rad,
            derivative_input_rad: self.derivative_input_rad(sample),
            kp: nominal.kp,
            ki: nominal.ki,
            kd: nominal.kd,
            model_rad: sample.measurement_rad,
            model_rad_s: S::zero(),
        }
    }

    /// $$ u = k_p (b r - y) + I + k_d d - k_r q + k_f r, \qquad
    /// d_k = \frac{T_f d_{k-1} + x_k - x_{k-1}}{T_f + T}, \quad x = c r - y $$
    #[inline(always)]
    pub fn free(&self, memory: &Memory<S>, sample: &Sample<S>, gains: &Gains<S>) -> Free<S> {
        let (n, Gains { kp, ki, kd }) = (&self.numbers, *gains);
        let Sample { setpoint_rad, measurement_rad, rate_rad_s } = *sample;
        let error_rad = setpoint_rad - measurement_rad;
        let (weight, rate_gain_s) = self.coupled(gains);
        let proportional_rad = kp * (weight * setpoint_rad - measurement_rad);

        let wound = self.wound(memory.integral, error_rad, ki);
        let term_rad = self.term_rad(wound, ki);

        let derivative_input_rad = self.derivative_input_rad(sample);
        let difference_rad = derivative_input_rad - memory.derivative_input_rad;
        let derivative_rad_s =
            (n.filter_s * memory.derivative_rad_s + difference_rad) / (n.filter_s + n.dt_s);

        let command_rad =
            proportional_rad + term_rad + kd * derivative_rad_s - rate_gain_s * rate_rad_s;
        let command_rad = self.fed_forward(command_rad, setpoint_rad);
        Free { error_rad, derivative_input_rad, derivative_rad_s, wound, term_rad, command_rad }
    }

    /// The terms of a free command; `free` does not ask here, so that what is exported of it stays as it is.
    pub fn parts(&self, free: &Free<S>, sample: &Sample<S>, gains: &Gains<S>) -> Parts<S> {
        let (weight, rate_gain_s) = self.coupled(gains);
        Parts {
            proportional_rad: gains.kp * (weight * sample.setpoint_rad - sample.measurement_rad),
            integral_rad: free.term_rad,
            derivative_rad: gains.kd * free.derivative_rad_s,
            rate_rad: rate_gain_s * sample.rate_rad_s,
            fed_forward_rad: self.fed_forward(S::zero(), sample.setpoint_rad),
        }
    }

    /// A command with $k_f r$ on top.
    #[inline(always)]
    fn fed_forward(&self, command_rad: S, setpoint_rad: S) -> S {
        if !self.structure.feeds_forward {
            return command_rad;
        }
        command_rad + self.numbers.feedforward * setpoint_rad
    }

    /// The sample behind slew limit, limits and anti-windup, in this order.
    #[inline(always)]
    pub fn regulated(&self, memory: &Memory<S>, free: &Free<S>, ki: S) -> Regulated<S> {
        let command_rad = self.limited_rad(memory.command_rad, free.command_rad);
        let excess_rad = free.command_rad - command_rad;
        let integral = self.unwound(memory.integral, free, excess_rad, ki);
        Regulated { command_rad, excess_rad, integral }
    }

    #[inline(always)]
    fn limited_rad(&self, last_rad: S, free_rad: S) -> S {
        if !self.structure.limited {
            return free_rad;
        }
        let n = &self.numbers;
        let slewed_rad = limited(free_rad, last_rad - n.slew_rad, last_rad + n.slew_rad);
        limited(slewed_rad, n.lower_rad, n.upper_rad)
    }

    #[inline(always)]
    fn derivative_input_rad(&self, sample: &Sample<S>) -> S {
        self.numbers.derivative_weight * sample.setpoint_rad - sample.measurement_rad
    }

    /// $b = b' + s_b (k_p - k_p')$ and $k_r = k_r' + s_r (k_d - k_d')$.
    #[inline(always)]
    pub fn coupled(&self, gains: &Gains<S>) -> (S, S) {
        let n = &self.numbers;
        if !self.structure.coupled {
            return (n.proportional_weight, n.rate_gain_s);
        }
        let weight = n.proportional_weight + n.weight_per_kp * (gains.kp - n.nominal_kp);
        (weight, n.rate_gain_s + n.rate_gain_per_kd * (gains.kd - n.nominal_kd))
    }

    /// The integral's memory with this sample's error in it.
    #[inline(always)]
    fn wound(&self, memory: S, error_rad: S, ki: S) -> S {
        match self.structure.integral {
            IntegralForm::Bumpless => memory + ki * error_rad * self.numbers.dt_s,
            IntegralForm::Literal => memory + error_rad,
        }
    }

    /// The integral's term of the command, rad.
    #[inline(always)]
    fn term_rad(&self, memory: S, ki: S) -> S {
        let (n, term_rad) = (&self.numbers, self.unclamped_rad(memory, ki));
        match self.structure.anti_windup {
            AntiWindupKind::Clamping => limited(term_rad, n.term_lower_rad, n.term_upper_rad),
            AntiWindupKind::None
            | AntiWindupKind::Conditional
            | AntiWindupKind::BackCalculation => term_rad,
        }
    }

    /// The same without limits of its own.
    #[inline(always)]
    pub fn unclamped_rad(&self, memory: S, ki: S) -> S {
        match self.structure.integral {
            IntegralForm::Bumpless => memory,
            IntegralForm::Literal => ki * memory * self.numbers.dt_s,
        }
    }

    /// A command that another gave, within this controller's limits.
    #[inline(always)]
    pub fn within_limits(&self, command_rad: S) -> S {
        limited(command_rad, self.numbers.lower_rad, self.numbers.upper_rad)
    }

    /// The integral's memory from which the next sample continues at `command_rad`, from the memory that a step
    /// to this sample has left: the term that fills what the other terms leave,
    ///
    /// $$ I = u - k_p (b r - y) - k_d d + k_r q - k_f r $$
    ///
    /// within the limits of the term. Where $k_i$ is zero the memory stays as it is: nothing would bring it back.
    #[inline(always)]
    pub fn tracking(&self, memory: &Memory<S>, sample: &Sample<S>, command_rad: S) -> S {
        let Sample { setpoint_rad, measurement_rad, rate_rad_s } = *sample;
        let &Memory { kp, ki, kd, integral, derivative_rad_s, .. } = memory;
        let (weight, rate_gain_s) = self.coupled(&Gains { kp, ki, kd });
        let proportional_rad = kp * (weight * setpoint_rad - measurement_rad);
        let rest_rad = proportional_rad + kd * derivative_rad_s - rate_gain_s * rate_rad_s;
        let rest_rad = self.fed_forward(rest_rad, setpoint_rad);
        let (n, term_rad) = (&self.numbers, command_rad - rest_rad);
        let term_rad = match self.structure.anti_windup {
            AntiWindupKind::Clamping => limited(term_rad, n.term_lower_rad, n.term_upper_rad),
            AntiWindupKind::None
            | AntiWindupKind::Conditional
            | AntiWindupKind::BackCalculation => term_rad,
        };
        let moved = self.remembered(term_rad, ki, integral, |memory| memory);
        S::zero().if_less(ki.abs(), moved, integral)
    }

    /// The memory to keep: the wound one after anti-windup.
    #[inline(always)]
    fn unwound(&self, before: S, free: &Free<S>, excess_rad: S, ki: S) -> S {
        match self.structure.anti_windup {
            AntiWindupKind::None => free.wound,
            AntiWindupKind::Clamping => self.clamped(free.wound, ki),
            AntiWindupKind::Conditional => {
                // Signs, not a product: that of two small numbers underflows to zero.
                let (zero, drive) = (S::zero(), ki * free.error_rad);
                let above = zero.if_less(drive, before, free.wound);
                let below = drive.if_less(zero, before, free.wound);
                zero.if_less(excess_rad, above, excess_rad.if_less(zero, below, free.wound))
            }
            AntiWindupKind::BackCalculation => {
                let n = &self.numbers;
                let shift_rad = excess_rad * n.dt_s / n.tracking_s;
                let moved = self.remembered(shift_rad, ki, free.wound, |shift| free.wound - shift);
                // Without a gain nothing winds up, and nothing would bring it back.
                S::zero().if_less(ki.abs(), moved, free.wound)
            }
        }
    }

    #[inline(always)]
    fn clamped(&self, wound: S, ki: S) -> S {
        let (lower_rad, upper_rad) = (self.numbers.term_lower_rad, self.numbers.term_upper_rad);
        let term_rad = self.unclamped_rad(wound, ki);
        let kept_rad = limited(term_rad, lower_rad, upper_rad);
        let kept = self.remembered(kept_rad, ki, wound, |memory| memory);
        term_rad.if_less(lower_rad, kept, upper_rad.if_less(term_rad, kept, wound))
    }

    /// What follows from the memory that makes a term of `term_rad`; `otherwise` where the gain is too
    /// small for any sum to make that term.
    #[inline(always)]
    fn remembered(&self, term_rad: S, ki: S, otherwise: S, follows: impl Fn(S) -> S) -> S {
        let infinity = S::constant(f64::INFINITY);
        let finite = |memory: S| memory.abs().if_less(infinity, follows(memory), otherwise);
        match self.structure.integral {
            IntegralForm::Bumpless => finite(term_rad),
            IntegralForm::Literal => {
                // Nothing is divided by zero, not even to be thrown away.
                let (zero, divisor) = (S::zero(), ki * self.numbers.dt_s);
                let safe = zero.if_less(divisor.abs(), divisor, S::one());
                zero.if_less(divisor.abs(), finite(term_rad / safe), otherwise)
            }
        }
    }
}

//! The settings of a PID controller apart from its gains: sample period, limits, derivative, anti-windup, weights.

use fspid_numeric::Real;

use crate::controller_setting::ControllerSetting;
use crate::equations::{Free, Memory, PidEquations, Regulated};
use crate::error::{ConfigError, allowed_if, finite, not_negative, positive};
use crate::gains::Gains;
use crate::guard::{Faults, Guard};
use crate::integral::{AntiWindup, IntegralForm};
use crate::limits::Limits;
use crate::sample::Sample;
use crate::second_input::ModelState;
use crate::state::{Previous, State, Step};

/// Weights of the set-point in the proportional and derivative terms; 1 for plain error feedback.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SetpointWeights<R> {
    /// $b$ in $k_p (b r - y)$.
    pub proportional: R,
    /// $c$ in $k_d \frac{d}{dt} (c r - y)$; 0 is the derivative of the measurement.
    pub derivative: R,
}

/// How the derivative is formed: $d_k = \frac{T_f d_{k-1} + x_k - x_{k-1}}{T_f + T}$ with
/// $x = c r - y$ and $d_0 = 0$; the backward difference where $T_f = 0$.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Derivative<R> {
    /// Time constant $T_f$ of the filter, s; 0 for none.
    pub filter_s: R,
}

/// Room to be left below overflow by the integral: gains and scales up to 10⁹ then leave the next
/// sample an answer.
const INTEGRAL_ROOM: f64 = 1.0 / (1_u64 << 30) as f64;
/// As [`INTEGRAL_ROOM`] for what the next sample's rates are taken from; they act on the integral
/// through a gain, so that they leave it as much again.
const RATE_ROOM: f64 = INTEGRAL_ROOM * INTEGRAL_ROOM;

/// True if both numbers are below that fraction of the largest; false for NaN.
fn leave<R: Real>(room: f64, values: [R; 2]) -> bool {
    let largest = R::from_f64(room) / R::MIN_POSITIVE;
    values.iter().all(|value| value.abs() <= largest)
}

/// True for an integral that leaves the next sample an answer.
pub(crate) fn may_be_remembered<R: Real>(integral: R) -> bool {
    leave(INTEGRAL_ROOM, [integral, integral])
}

/// The largest rates and the largest integral with which a sample is answered and not held as an overflow.
pub fn largest_remembered<R: Real>() -> [R; 2] {
    [RATE_ROOM, INTEGRAL_ROOM].map(|room| R::from_f64(room) / R::MIN_POSITIVE)
}

impl<R: Real> Derivative<R> {
    /// From the ISA form: $T_f = T_d / N$; an infinite `n` means no filter. The gains that go with
    /// it are those of [`Gains::from_isa`].
    ///
    /// # Errors
    /// [`ConfigError::Number`] for a time that is negative or not finite and an `n` that is not
    /// positive, or so small that the quotient overflows.
    pub fn from_isa(td_s: R, n: R) -> Result<Self, ConfigError> {
        let td_s = not_negative(ControllerSetting::DerivativeTime, td_s)?;
        let filter_s = td_s / n;
        let good = n > R::ZERO && filter_s.is_finite();
        allowed_if(good, ControllerSetting::FilterRatio, n, "a number above 0")?;
        Ok(Self { filter_s })
    }
}

/// Configuration of a PID controller without its gains. Public fields, checked when a controller
/// is built from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PidConfig<R> {
    /// Sample period $T$, s.
    pub dt_s: R,
    /// Gain of the pitch-rate loop, s: subtracts `rate_gain · q`.
    pub rate_gain_s: R,
    /// Set-point weights.
    pub setpoint_weights: SetpointWeights<R>,
    /// Command per set-point $k_f$ beside the gains: adds $k_f r$, whatever the gains are. At gains that stand still it
    /// is a set-point weight of $b + k_f / k_p$; where they move it does not move with them.
    pub feedforward: R,
    /// Derivative filter.
    pub derivative: Derivative<R>,
    /// Bumpless or literal.
    pub integral: IntegralForm,
    /// Anti-windup.
    pub anti_windup: AntiWindup<R>,
    /// Limits of the command, rad; they come before the slew limit where both cannot be kept.
    pub limits: Option<Limits<R>>,
    /// Largest change of the command, rad/s; the first sample is answered from a command of 0.
    pub slew_rad_s: Option<R>,
    /// Largest sample that is believed.
    pub guard: Guard<R>,
}

/// What a controller answers a sample by.
pub(crate) struct Moment<'a, R> {
    pub(crate) equations: &'a PidEquations<R>,
    /// What it remembers.
    pub(crate) memory: &'a Memory<R>,
    /// The gains of the moment.
    pub(crate) gains: Gains<R>,
    /// The reference model, to be remembered.
    pub(crate) model: ModelState<R>,
}

impl<R: Real> PidConfig<R> {
    /// Plain error feedback, no feed-forward, no filter, no limits, no anti-windup, no rate loop.
    pub fn sampled_every(dt_s: R) -> Self {
        Self {
            dt_s,
            rate_gain_s: R::ZERO,
            setpoint_weights: SetpointWeights { proportional: R::ONE, derivative: R::ONE },
            feedforward: R::ZERO,
            derivative: Derivative { filter_s: R::ZERO },
            integral: IntegralForm::default(),
            anti_windup: AntiWindup::None,
            limits: None,
            slew_rad_s: None,
            guard: Guard::default(),
        }
    }

    /// True if the command is a linear function of samples and memory.
    pub fn is_linear(&self) -> bool {
        // In full, so that somebody says of a new option whether it is linear.
        let Self {
            dt_s: _,
            rate_gain_s: _,
            setpoint_weights: _,
            feedforward: _,
            derivative: _,
            integral: _,
            anti_windup,
            limits,
            slew_rad_s,
            guard: _,
        } = self;
        let clamped = matches!(anti_windup, AntiWindup::Clamping(_));
        limits.is_none() && slew_rad_s.is_none() && !clamped
    }

    pub(crate) fn check(&self) -> Result<(), ConfigError> {
        positive(ControllerSetting::SamplePeriod, self.dt_s)?;
        finite(ControllerSetting::RateGain, self.rate_gain_s)?;
        finite(ControllerSetting::ProportionalWeight, self.setpoint_weights.proportional)?;
        finite(ControllerSetting::DerivativeWeight, self.setpoint_weights.derivative)?;
        finite(ControllerSetting::Feedforward, self.feedforward)?;
        not_negative(ControllerSetting::DerivativeFilter, self.derivative.filter_s)?;
        self.anti_windup.check(self.dt_s)?;
        if let Some(slew) = self.slew_rad_s {
            positive(ControllerSetting::SlewLimit, slew)?;
        }
        let unlimited = self.limits.is_none() && self.slew_rad_s.is_none();
        if self.anti_windup.acts_at_limits() && unlimited {
            let what = "this anti-windup needs an output or slew limit to act at";
            return Err(ConfigError::Conflict { what });
        }
        Ok(())
    }

    /// The sample as this controller uses it, or its fault. Where the rate is not used it is zero:
    /// then it cannot be at fault.
    #[inline(always)]
    pub(crate) fn admitted(&self, sample: Sample<R>, uses_rate: bool) -> Result<Sample<R>, Faults> {
        let mut used = sample;
        if !uses_rate {
            used.rate_rad_s = R::ZERO;
        }
        self.guard.fault(used).map_or(Ok(used), Err)
    }

    /// The answer to a sample that cannot be used: the last command, bit for bit. `gains`, the nominal
    /// ones, are named where there was no good sample yet.
    pub(crate) fn hold(&self, state: &mut State<R>, fault: Faults, gains: Gains<R>) -> Step<R> {
        state.latch(fault);
        let last_rad = state.command_rad;
        Step {
            // Only a memory that this controller has not written can lie outside the limits.
            command_rad: self.limits.map_or(last_rad, |limits| limits.clamp(last_rad)),
            gains: state.gains().unwrap_or(gains),
            saturated: false,
            faults: state.faults,
        }
    }

    /// True if the command depends on the pitch rate.
    pub(crate) fn uses_rate(&self) -> bool {
        self.rate_gain_s != R::ZERO
    }

    /// One sample by its equations with the gains of the moment, from a memory. `sample` has been [admitted](Self::admitted).
    ///
    /// Either the whole memory moves on, or none of it (overflow: held and latched).
    #[inline(always)]
    pub(crate) fn step(
        &self,
        state: &mut State<R>,
        sample: Sample<R>,
        moment: Moment<'_, R>,
    ) -> Step<R> {
        let Moment { equations, memory, gains, model } = moment;
        let free = equations.free(memory, &sample, &gains);
        let regulated = equations.regulated(memory, &free, gains.ki);
        let Free { error_rad, derivative_input_rad, derivative_rad_s, wound, .. } = free;
        let Regulated { command_rad, excess_rad, integral } = regulated;

        // Not only what is infinite: from a memory near overflow the way to any other sample would
        // overflow, however good that sample, and the output would be held for ever.
        let steepest = [error_rad / self.dt_s, derivative_input_rad / self.dt_s];
        let clear = leave(RATE_ROOM, steepest)
            && leave(INTEGRAL_ROOM, [wound, integral])
            && leave(RATE_ROOM, [model.pitch_rad, model.rate_rad_s]);
        // Before the limits, which would turn an overflow into a number.
        if !(clear && free.command_rad.is_finite()) {
            // Not the gains of the moment, with which it overflowed: nothing of this sample is remembered.
            let Memory { kp, ki, kd, .. } = *memory;
            return self.hold(state, Faults::OVERFLOW, Gains { kp, ki, kd });
        }
        let previous = Previous { error_rad, derivative_input_rad, gains, model };
        *state = State {
            command_rad,
            integral,
            derivative_rad_s,
            previous: Some(previous),
            faults: state.faults,
        };
        Step { command_rad, gains, saturated: excess_rad != R::ZERO, faults: state.faults }
    }
}

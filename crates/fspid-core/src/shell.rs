//! Everything of a PID controller but where its gains come from.

use fspid_fuzzy::Real;

use crate::error::{ConfigError, finite, not_negative, positive};
use crate::gains::Gains;
use crate::guard::{Faults, Guard};
use crate::limits::Limits;

/// What a controller is given at a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<R> {
    /// Commanded pitch, rad.
    pub setpoint_rad: R,
    /// Measured pitch, rad.
    pub measurement_rad: R,
    /// Measured pitch rate, rad/s; ignored by a controller without a rate loop.
    pub rate_rad_s: R,
}

/// What a controller answers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<R> {
    /// Command, rad; positive is nose up.
    pub command_rad: R,
    /// Gains used.
    pub gains: Gains<R>,
    /// The command was cut by an output or slew limit.
    pub saturated: bool,
    /// Faults latched so far.
    pub faults: Faults,
}

/// A controller's memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<R> {
    command_rad: R,
    /// Integral of `ki e` in rad (bumpless) or of `e` in rad s (literal).
    integral: R,
    derivative_rad_s: R,
    previous: Option<Previous<R>>,
    faults: Faults,
}

/// What a controller remembers of the last good sample.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Previous<R> {
    error_rad: R,
    /// What the derivative acts on: $c r - y$.
    derivative_input_rad: R,
    gains: Gains<R>,
}

impl<R: Real> State<R> {
    /// At rest: no command, empty integral, no previous sample.
    #[must_use]
    pub fn new() -> Self {
        Self {
            command_rad: R::ZERO,
            integral: R::ZERO,
            derivative_rad_s: R::ZERO,
            previous: None,
            faults: Faults::NONE,
        }
    }

    /// Faults latched since the last call, which clears them.
    pub fn take_faults(&mut self) -> Faults {
        self.faults.take()
    }

    /// Gains of the last good sample, `None` before the first.
    pub(crate) fn gains(&self) -> Option<Gains<R>> {
        self.previous.map(|previous| previous.gains)
    }

    /// $e_k - e_{k-1}$, zero at the first sample.
    pub(crate) fn error_delta(&self, error_rad: R) -> R {
        self.previous
            .map_or(R::ZERO, |previous| error_rad - previous.error_rad)
    }

    pub(crate) fn latch(&mut self, fault: Faults) {
        self.faults.latch(fault);
    }

    /// The answer to a sample that cannot be used: the last command, bit for bit.
    pub(crate) fn hold(&mut self, fault: Faults, nominal: Gains<R>) -> Step<R> {
        self.latch(fault);
        Step {
            command_rad: self.command_rad,
            gains: self.gains().unwrap_or(nominal),
            saturated: false,
            faults: self.faults,
        }
    }

    fn is_finite(&self) -> bool {
        self.command_rad.is_finite()
            && self.integral.is_finite()
            && self.derivative_rad_s.is_finite()
            && self.previous.is_none_or(|previous| {
                previous.error_rad.is_finite()
                    && previous.derivative_input_rad.is_finite()
                    && previous.gains.are_finite()
            })
    }
}

impl<R: Real> Default for State<R> {
    fn default() -> Self {
        Self::new()
    }
}

/// What the integral remembers when its gain changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum IntegralForm {
    /// $I_k = I_{k-1} + k_i e_k T$: a new gain bends the integral, the command never jumps.
    #[default]
    Bumpless,
    /// $I_k = k_i \sum e_j T$, as the paper prints it: a change of the gain moves the command at
    /// once by $\Delta k_i \sum e_j T$.
    Literal,
}

/// Weights of the set-point in the proportional and derivative terms; 1 for plain error feedback.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SetpointWeights<R> {
    /// $b$ in $k_p (b r - y)$.
    pub proportional: R,
    /// $c$ in $k_d \frac{d}{dt} (c r - y)$; 0 is the derivative of the measurement.
    pub derivative: R,
}

/// How the derivative is formed: $d_k = \frac{T_f d_{k-1} + x_k - x_{k-1}}{T_f + T}$ with
/// $x = c r - y$; the backward difference where $T_f = 0$.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Derivative<R> {
    /// Time constant $T_f$ of the filter, s; 0 for none.
    pub filter_s: R,
}

/// What happens to the integral while the command is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AntiWindup<R> {
    /// Nothing: it winds up.
    None,
    /// The integral term is kept within these limits, rad.
    Clamping(Limits<R>),
    /// It stands still while the error would drive the command further out.
    Conditional,
    /// It is pulled towards the limit: $I \leftarrow I + (u - u_{free}) T / T_t$.
    BackCalculation {
        /// Tracking time $T_t$, s.
        tracking_s: R,
    },
}

/// Configuration of a PID controller without its gains. Public fields, checked when a controller
/// is built from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shell<R> {
    /// Sample period $T$, s.
    pub dt_s: R,
    /// Gain of the pitch-rate loop, s: subtracts `rate_gain · q`.
    pub rate_gain_s: R,
    /// Set-point weights.
    pub setpoint_weights: SetpointWeights<R>,
    /// Derivative filter.
    pub derivative: Derivative<R>,
    /// Bumpless or literal.
    pub integral: IntegralForm,
    /// Anti-windup.
    pub anti_windup: AntiWindup<R>,
    /// Limits of the command, rad.
    pub limits: Option<Limits<R>>,
    /// Largest change of the command, rad/s.
    pub slew_rad_s: Option<R>,
    /// Largest sample that is believed.
    pub guard: Guard<R>,
}

impl<R: Real> Shell<R> {
    /// Plain error feedback, no filter, no limits, no anti-windup, no rate loop.
    pub fn sampled_every(dt_s: R) -> Self {
        Self {
            dt_s,
            rate_gain_s: R::ZERO,
            setpoint_weights: SetpointWeights {
                proportional: R::ONE,
                derivative: R::ONE,
            },
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
        self.limits.is_none()
            && self.slew_rad_s.is_none()
            && !matches!(self.anti_windup, AntiWindup::Clamping(_))
    }

    pub(crate) fn check(&self) -> Result<(), ConfigError> {
        positive("sample period, s", self.dt_s)?;
        finite("rate_gain, s", self.rate_gain_s)?;
        finite(
            "set-point weight of the proportional term",
            self.setpoint_weights.proportional,
        )?;
        finite(
            "set-point weight of the derivative term",
            self.setpoint_weights.derivative,
        )?;
        not_negative("derivative filter, s", self.derivative.filter_s)?;
        if let AntiWindup::BackCalculation { tracking_s } = self.anti_windup {
            positive("anti-windup tracking time, s", tracking_s)?;
        }
        if let Some(slew) = self.slew_rad_s {
            positive("slew limit, rad/s", slew)?;
        }
        if self.acts_at_limits() && self.limits.is_none() && self.slew_rad_s.is_none() {
            let what = "this anti-windup needs an output or slew limit to act at";
            return Err(ConfigError::Conflict { what });
        }
        Ok(())
    }

    fn acts_at_limits(&self) -> bool {
        matches!(
            self.anti_windup,
            AntiWindup::Conditional | AntiWindup::BackCalculation { .. }
        )
    }

    /// One sample with the gains of the moment. `sample` has passed the guard.
    ///
    /// Either the whole memory moves on, or none of it (overflow: held and latched).
    #[inline]
    pub(crate) fn step(&self, state: &mut State<R>, sample: Sample<R>, gains: Gains<R>) -> Step<R> {
        let Sample {
            setpoint_rad,
            measurement_rad,
            rate_rad_s,
        } = sample;
        let weights = self.setpoint_weights;
        let error_rad = setpoint_rad - measurement_rad;
        let proportional_rad = gains.kp * (weights.proportional * setpoint_rad - measurement_rad);

        let derivative_input_rad = weights.derivative * setpoint_rad - measurement_rad;
        let derivative_rad_s = self.derivative_of(state, derivative_input_rad);

        let free_command = |integral: R| {
            proportional_rad + self.integral_term(integral, gains.ki) + gains.kd * derivative_rad_s
                - self.rate_gain_s * rate_rad_s
        };

        let integral = state.integral + self.integral_increment(error_rad, gains.ki);
        let free_rad = free_command(integral);
        let mut command_rad = self.limited(state.command_rad, free_rad);
        let excess_rad = free_rad - command_rad;
        let integral = self.unwound(state.integral, integral, excess_rad, error_rad, gains.ki);
        if matches!(self.anti_windup, AntiWindup::Clamping(_)) {
            // Clamping bounds the integral of this very sample, not only what is remembered of it.
            command_rad = self.limited(state.command_rad, free_command(integral));
        }
        let previous = Previous {
            error_rad,
            derivative_input_rad,
            gains,
        };
        let next = State {
            command_rad,
            integral,
            derivative_rad_s,
            previous: Some(previous),
            faults: state.faults,
        };
        if !next.is_finite() {
            return state.hold(Faults::OVERFLOW, gains);
        }
        *state = next;
        Step {
            command_rad,
            gains,
            saturated: excess_rad != R::ZERO,
            faults: state.faults,
        }
    }

    fn derivative_of(&self, state: &State<R>, input_rad: R) -> R {
        let Some(previous) = state.previous else {
            return R::ZERO;
        };
        let filter_s = self.derivative.filter_s;
        let difference_rad = input_rad - previous.derivative_input_rad;
        (filter_s * state.derivative_rad_s + difference_rad) / (filter_s + self.dt_s)
    }

    fn integral_increment(&self, error_rad: R, ki: R) -> R {
        match self.integral {
            IntegralForm::Bumpless => ki * error_rad * self.dt_s,
            IntegralForm::Literal => error_rad * self.dt_s,
        }
    }

    /// The integral's part of the command, rad.
    fn integral_term(&self, integral: R, ki: R) -> R {
        match self.integral {
            IntegralForm::Bumpless => integral,
            IntegralForm::Literal => ki * integral,
        }
    }

    /// What has to be remembered for the integral's part of the command to move by `shift_rad`.
    fn integral_shift(&self, shift_rad: R, ki: R) -> R {
        match self.integral {
            IntegralForm::Bumpless => shift_rad,
            // Without a gain the sum has no part in the command and nothing to correct.
            IntegralForm::Literal if ki == R::ZERO => R::ZERO,
            IntegralForm::Literal => shift_rad / ki,
        }
    }

    fn limited(&self, last_rad: R, free_rad: R) -> R {
        let slewed = self.slew_rad_s.map_or(free_rad, |slew| {
            free_rad.limited(last_rad - slew * self.dt_s, last_rad + slew * self.dt_s)
        });
        self.limits.map_or(slewed, |limits| limits.clamp(slewed))
    }

    /// The integral after anti-windup. `excess_rad` is how much of the command was cut off.
    fn unwound(&self, before: R, after: R, excess_rad: R, error_rad: R, ki: R) -> R {
        match self.anti_windup {
            AntiWindup::None => after,
            AntiWindup::Clamping(limits) => {
                let term = self.integral_term(after, ki);
                after + self.integral_shift(limits.clamp(term) - term, ki)
            }
            AntiWindup::Conditional => {
                let drives_further_out = excess_rad * (ki * error_rad) > R::ZERO;
                if drives_further_out { before } else { after }
            }
            AntiWindup::BackCalculation { tracking_s } => {
                after - self.integral_shift(excess_rad * self.dt_s / tracking_s, ki)
            }
        }
    }
}

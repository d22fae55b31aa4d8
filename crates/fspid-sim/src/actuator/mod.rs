//! Actuators with everything that keeps a surface from doing what it is told.
//!
//! # Order
//! The command passes, after its delay: command limits, deadband, lag, rate limit, position limit
//! (travel), backlash, bias. Everything is counted in the sense of the command: nose up positive for
//! an elevator, so that a travel of 17 deg trailing edge down and 23 deg up is from -17 to 23 deg.
//!
//! $$ v = \text{dead}(\text{limit}(c)), \qquad \tau \dot x = v - x \ \text{ or }
//! \ddot x = \omega_n^2 (v - x) - 2 \zeta \omega_n \dot x, \qquad |\dot x| \le R, \quad
//! x_- \le x \le x_+ $$
//! $$ y = x \text{ through the play } w, \qquad \delta = y + b $$
//!
//! # Exactness
//! Between two samples the command is held and an actuator passes through *legs*: following by its
//! lag, held by its rate limit, pressed against a stop, crossing its play. Each leg has a closed
//! form, and is cut where the next one begins. First order: no error. Second order: the response is
//! exact, but events are looked for at every sixteenth of $1 / \omega_n$ (a hundredth of a period),
//! so that a limit that is crossed and left again within such a piece is passed over; what is missed
//! stays below 0.05 % of the motion. More than 64 legs a sample are not followed; the rest is held.
//!
//! A first-order servo, which has nothing but command limits, a lag and a rate limit, is one linear system with a
//! linear plant in calm air: there it is sampled with it by matrix exponentials, in place of leg by leg. The two ways
//! differ by rounding, and the first is the one that lanes fly.

pub(crate) mod lag;
mod leg;
mod preset;

pub use lag::Lag;
pub(crate) use leg::{Course, Leg};
pub use preset::Preset;

use crate::error::{SimError, finite, not_negative, positive};

/// An actuator: a lag and what limits it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Actuator {
    lag: Lag,
    command_limits_rad: Option<(f64, f64)>,
    deadband_rad: f64,
    rate_limit_rad_s: Option<f64>,
    travel_rad: Option<(f64, f64)>,
    play_rad: f64,
    bias_rad: f64,
    delay_samples: usize,
}

/// Everything of an actuator by name, for what has to decide about each part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActuatorParts {
    /// The linear part.
    pub lag: Lag,
    /// Limits of the command, rad.
    pub command_limits_rad: Option<(f64, f64)>,
    /// Half width of the deadband, rad.
    pub deadband_rad: f64,
    /// Rate limit, rad/s.
    pub rate_limit_rad_s: Option<f64>,
    /// Ends of the travel, rad.
    pub travel_rad: Option<(f64, f64)>,
    /// Full width of the play, rad.
    pub play_rad: f64,
    /// How far the surface stands from where the actuator says, rad.
    pub bias_rad: f64,
    /// Delay of the command in samples.
    pub delay_samples: usize,
}

/// Where an actuator is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ActuatorState {
    /// Position x before the play, rad.
    position_rad: f64,
    /// Its rate, rad/s; kept for lags of second order only.
    rate_rad_s: f64,
    /// Position y behind the play, without bias, rad.
    surface_rad: f64,
    /// Which side of the play is closed: 1 pushes up, -1 down, 0 neither.
    contact: f64,
}

impl ActuatorState {
    /// Rate, rad/s; kept for lags of second order only.
    pub(crate) fn rate_rad_s(&self) -> f64 {
        self.rate_rad_s
    }

    /// Position before the play, rad.
    pub(crate) fn position_rad(&self) -> f64 {
        self.position_rad
    }

    /// Moves the position, and the surface with it (part 0), or the rate (part 1).
    pub(crate) fn nudge(&mut self, part: usize, by: f64) {
        if part == 0 {
            self.position_rad += by;
            self.surface_rad += by;
        } else {
            self.rate_rad_s += by;
        }
    }
}

/// Deflections so near are the same, rad: many times the rounding of a sample, far below any motion.
const SAME: f64 = 1e-12;
/// Longest delay; more is a mistake in the file.
pub(crate) const MAX_DELAY_SAMPLES: usize = 10_000;

impl Actuator {
    /// The elevator is where it is commanded.
    #[must_use]
    pub const fn ideal() -> Self {
        Self::new(Lag::NONE)
    }

    /// A servo of $1 / (\tau s + 1)$ without limits; 0 for no lag.
    ///
    /// # Errors
    /// [`SimError::Number`] for a time constant that is negative or not finite.
    pub fn first_order(time_constant_s: f64) -> Result<Self, SimError> {
        let time_constant_s = not_negative("time_constant_s", time_constant_s)?;
        if time_constant_s == 0.0 {
            return Ok(Self::ideal());
        }
        Lag::first_order(time_constant_s).map(Self::new)
    }

    /// An actuator with this lag and no limits.
    #[must_use]
    pub const fn new(lag: Lag) -> Self {
        Self {
            lag,
            command_limits_rad: None,
            deadband_rad: 0.0,
            rate_limit_rad_s: None,
            travel_rad: None,
            play_rad: 0.0,
            bias_rad: 0.0,
            delay_samples: 0,
        }
    }

    /// With another lag.
    #[must_use]
    pub const fn with_lag(self, lag: Lag) -> Self {
        Self { lag, ..self }
    }

    /// With commands cut at two limits around 0.
    ///
    /// # Errors
    /// [`SimError::Number`] unless `least_rad` ≤ 0 ≤ `most_rad`, and not both are 0.
    pub fn with_command_limits(self, least_rad: f64, most_rad: f64) -> Result<Self, SimError> {
        let limits = around_zero("command limits, rad", least_rad, most_rad)?;
        Ok(Self { command_limits_rad: Some(limits), ..self })
    }

    /// With commands kept within ± `limit_rad`: a lag of first order never overshoots its command, so that this bounds
    /// the deflection as well.
    ///
    /// # Errors
    /// [`SimError::Number`] unless the limit is finite and positive.
    pub fn with_position_limit(self, limit_rad: f64) -> Result<Self, SimError> {
        let limit_rad = positive("position limit, rad", limit_rad)?;
        self.with_command_limits(-limit_rad, limit_rad)
    }

    /// With commands up to ± `half_width_rad` taken for 0 and larger ones for so much less.
    ///
    /// # Errors
    /// [`SimError::Number`] for a width that is negative or not finite.
    pub fn with_deadband(self, half_width_rad: f64) -> Result<Self, SimError> {
        Ok(Self { deadband_rad: not_negative("deadband, rad", half_width_rad)?, ..self })
    }

    /// With a rate kept within ± `limit_rad_s`.
    ///
    /// # Errors
    /// [`SimError::Number`] unless the limit is finite and positive.
    pub fn with_rate_limit(self, limit_rad_s: f64) -> Result<Self, SimError> {
        let limit = positive("rate limit, rad/s", limit_rad_s)?;
        Ok(Self { rate_limit_rad_s: Some(limit), ..self })
    }

    /// With stops at both ends of the travel, which take all speed.
    ///
    /// # Errors
    /// [`SimError::Number`] unless `least_rad` ≤ 0 ≤ `most_rad`, and not both are 0.
    pub fn with_travel(self, least_rad: f64, most_rad: f64) -> Result<Self, SimError> {
        let travel = around_zero("travel, rad", least_rad, most_rad)?;
        Ok(Self { travel_rad: Some(travel), ..self })
    }

    /// With play (hysteresis, backlash) of this full width between actuator and surface; at the
    /// start the surface is in its middle.
    ///
    /// # Errors
    /// [`SimError::Number`] for a width that is negative or not finite.
    pub fn with_play(self, width_rad: f64) -> Result<Self, SimError> {
        Ok(Self { play_rad: not_negative("play, rad", width_rad)?, ..self })
    }

    /// With a surface that stands this far from where the actuator says.
    ///
    /// # Errors
    /// [`SimError::Number`] for a bias that is not finite.
    pub fn with_bias(self, bias_rad: f64) -> Result<Self, SimError> {
        Ok(Self { bias_rad: finite("bias, rad", bias_rad)?, ..self })
    }

    /// With commands that arrive `samples` periods late. The loop keeps them; [`advance`] takes the
    /// command that has arrived.
    ///
    /// [`advance`]: Self::advance
    ///
    /// # Errors
    /// [`SimError::Number`] beyond 10 000 samples.
    pub fn with_delay(self, samples: usize) -> Result<Self, SimError> {
        if samples > MAX_DELAY_SAMPLES {
            let (found, allowed) = (samples as f64, "0 to 10000");
            return Err(SimError::Number { what: "delay_samples", found, allowed });
        }
        Ok(Self { delay_samples: samples, ..self })
    }

    /// Everything by name.
    #[must_use]
    pub fn parts(&self) -> ActuatorParts {
        let Self {
            lag,
            command_limits_rad,
            deadband_rad,
            rate_limit_rad_s,
            travel_rad,
            play_rad,
            bias_rad,
            delay_samples,
        } = *self;
        ActuatorParts {
            lag,
            command_limits_rad,
            deadband_rad,
            rate_limit_rad_s,
            travel_rad,
            play_rad,
            bias_rad,
            delay_samples,
        }
    }

    /// The linear part.
    #[must_use]
    pub fn lag(&self) -> Lag {
        self.lag
    }

    /// Delay of the command in samples.
    #[must_use]
    pub fn delay_samples(&self) -> usize {
        self.delay_samples
    }

    /// Rate limit, rad/s.
    #[must_use]
    pub fn rate_limit_rad_s(&self) -> Option<f64> {
        self.rate_limit_rad_s
    }

    /// Ends of the travel, rad.
    #[must_use]
    pub fn travel_rad(&self) -> Option<(f64, f64)> {
        self.travel_rad
    }

    /// Limits of the command, rad.
    #[must_use]
    pub fn command_limits_rad(&self) -> Option<(f64, f64)> {
        self.command_limits_rad
    }

    /// Half width of the deadband, rad.
    #[must_use]
    pub fn deadband_rad(&self) -> f64 {
        self.deadband_rad
    }

    /// Full width of the play, rad.
    #[must_use]
    pub fn play_rad(&self) -> f64 {
        self.play_rad
    }

    /// How far the surface stands from where the actuator says, rad.
    #[must_use]
    pub fn bias_rad(&self) -> f64 {
        self.bias_rad
    }

    /// True with nothing but lag, bias and delay.
    #[must_use]
    pub fn is_linear(&self) -> bool {
        let limits = self.command_limits_rad.or(self.travel_rad).is_some();
        let widths = self.deadband_rad > 0.0 || self.play_rad > 0.0;
        !limits && !widths && self.rate_limit_rad_s.is_none()
    }

    /// True with nothing but command limits that are equal to both sides, a lag of at most first order, a rate limit and
    /// delay: while no rate limit holds it, it is one linear system with its plant.
    pub(crate) fn is_first_order_servo(&self) -> bool {
        let widths = self.deadband_rad > 0.0 || self.play_rad > 0.0;
        let centred = self.command_limits_rad.is_none_or(|(least, most)| least + most == 0.0);
        let unbiased = self.bias_rad == 0.0 && self.travel_rad.is_none();
        self.lag.order() < 2 && centred && unbiased && !widths
    }

    /// True without lag and rate limit: the actuator is where it is told to be.
    pub(crate) fn is_at_once(&self) -> bool {
        self.lag.order() == 0 && self.rate_limit_rad_s.is_none()
    }

    /// The command within its limits, rad.
    pub(crate) fn limited_rad(&self, command_rad: f64) -> f64 {
        within(self.command_limits_rad, command_rad)
    }

    /// Gap to its command, rad, within which a first-order servo is slower than its rate limit.
    pub(crate) fn free_gap_rad(&self) -> f64 {
        self.rate_limit_rad_s.map_or(f64::INFINITY, |limit| limit * self.lag.trailing_s())
    }

    /// How a sample of `dt_s` passes when a first-order servo starts `gap_rad` short of its command: the rate [rad/s]
    /// at which it is held by its limit, and for how long [s].
    pub(crate) fn rate_limited_phase(&self, gap_rad: f64, dt_s: f64) -> Option<(f64, f64)> {
        let limit = self.rate_limit_rad_s?;
        let duration_s = (gap_rad.abs() - self.free_gap_rad()) / limit;
        (duration_s > 0.0).then(|| (limit.copysign(gap_rad), duration_s.min(dt_s)))
    }

    /// What the lag is told when this command has arrived: within its limits, less the deadband.
    #[must_use]
    pub fn target_rad(&self, command_rad: f64) -> f64 {
        let limited = self.limited_rad(command_rad);
        limited - limited.clamp(-self.deadband_rad, self.deadband_rad)
    }

    /// Where the surface stands, bias included, rad.
    #[must_use]
    pub fn deflection_rad(&self, state: &ActuatorState) -> f64 {
        state.surface_rad + self.bias_rad
    }

    /// Follows a held command for `dt_s`.
    pub fn advance(&self, state: &mut ActuatorState, command_rad: f64, dt_s: f64) {
        self.legs(state, command_rad, dt_s, |_| {});
    }

    /// True where following a held command for `dt_s` leads elsewhere than the lag alone would.
    pub(crate) fn is_limited(&self, state: &ActuatorState, command_rad: f64, dt_s: f64) -> bool {
        if self.is_linear() {
            return false;
        }
        let free = Self::new(self.lag);
        let (mut limited, mut follows) = (*state, *state);
        follows.position_rad = state.surface_rad;
        self.advance(&mut limited, command_rad, dt_s);
        free.advance(&mut follows, command_rad, dt_s);
        let apart_rad = (limited.surface_rad - follows.surface_rad).abs();
        let rates_apart = (limited.rate_rad_s - follows.rate_rad_s).abs();
        // Written so that NaN is limited.
        !(apart_rad <= SAME && rates_apart * dt_s <= SAME)
    }

    /// True where a sine of this amplitude and frequency asks for more than the rate limit:
    /// $a \omega > R$.
    #[must_use]
    pub fn sine_saturates_rate(&self, amplitude_rad: f64, frequency_rad_s: f64) -> bool {
        self.rate_limit_rad_s.is_some_and(|limit| amplitude_rad.abs() * frequency_rad_s > limit)
    }

    /// Frequency above which a sine of this amplitude is cut by the rate limit, rad/s: $R / a$, a
    /// cheap sign of pilot-in-the-loop oscillations. None without limit or amplitude.
    #[must_use]
    pub fn rate_onset_rad_s(&self, amplitude_rad: f64) -> Option<f64> {
        let onset = self.rate_limit_rad_s? / amplitude_rad.abs();
        onset.is_finite().then_some(onset)
    }
}

/// `value` within an interval, if there is one.
fn within(limits: Option<(f64, f64)>, value: f64) -> f64 {
    limits.map_or(value, |(least, most)| value.clamp(least, most))
}

fn around_zero(what: &'static str, least: f64, most: f64) -> Result<(f64, f64), SimError> {
    let (least, most) = (finite(what, least)?, finite(what, most)?);
    if least <= 0.0 && most >= 0.0 && least < most {
        return Ok((least, most));
    }
    let found = if least > 0.0 { least } else { most };
    Err(SimError::Number { what, found, allowed: "an interval with 0 in it" })
}

#[cfg(test)]
mod tests;

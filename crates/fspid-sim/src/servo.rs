//! The elevator servo.

use crate::actuator::{Actuator, Lag};
use crate::error::{SimError, not_negative, positive};

/// A first-order servo with optional limits, behind a delay of whole samples.
///
/// $$ \tau \dot \delta = v - \delta, \qquad |\dot \delta| \le R, \qquad |v| \le P $$
///
/// with the delayed command $v$ in the nose-up sense. The position limit acts on the command, which
/// a first-order servo never overshoots, so that it bounds the deflection as well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Servo {
    time_constant_s: f64,
    position_limit_rad: Option<f64>,
    rate_limit_rad_s: Option<f64>,
    delay_samples: usize,
}

/// Longest delay; more is a mistake in the file.
const MAX_DELAY_SAMPLES: usize = 10_000;

impl Servo {
    /// An ideal servo: the elevator is where it is commanded.
    #[must_use]
    pub fn ideal() -> Self {
        Self {
            time_constant_s: 0.0,
            position_limit_rad: None,
            rate_limit_rad_s: None,
            delay_samples: 0,
        }
    }

    /// A servo of $1 / (\tau s + 1)$; 0 for none.
    ///
    /// # Errors
    /// [`SimError::Number`] for a time constant that is negative or not finite.
    pub fn first_order(time_constant_s: f64) -> Result<Self, SimError> {
        let time_constant_s = not_negative("time_constant_s", time_constant_s)?;
        Ok(Self { time_constant_s, ..Self::ideal() })
    }

    /// With the deflection kept within ± `limit_rad`.
    ///
    /// # Errors
    /// [`SimError::Number`] unless the limit is finite and positive.
    pub fn with_position_limit(self, limit_rad: f64) -> Result<Self, SimError> {
        let limit_rad = positive("position limit, rad", limit_rad)?;
        Ok(Self { position_limit_rad: Some(limit_rad), ..self })
    }

    /// With the deflection's rate kept within ± `limit_rad_s`.
    ///
    /// # Errors
    /// [`SimError::Number`] unless the limit is finite and positive.
    pub fn with_rate_limit(self, limit_rad_s: f64) -> Result<Self, SimError> {
        let limit_rad_s = positive("rate limit, rad/s", limit_rad_s)?;
        Ok(Self { rate_limit_rad_s: Some(limit_rad_s), ..self })
    }

    /// With commands that arrive `samples` periods late.
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

    /// The same servo as an actuator: its position limit acts on the command.
    ///
    /// # Errors
    /// None: what a servo allows, an actuator allows.
    pub fn as_actuator(&self) -> Result<Actuator, SimError> {
        let lag = match self.time_constant_s {
            0.0 => Lag::NONE,
            time_constant_s => Lag::first_order(time_constant_s)?,
        };
        let mut actuator = Actuator::new(lag).with_delay(self.delay_samples)?;
        if let Some(limit_rad) = self.position_limit_rad {
            actuator = actuator.with_command_limits(-limit_rad, limit_rad)?;
        }
        if let Some(limit_rad_s) = self.rate_limit_rad_s {
            actuator = actuator.with_rate_limit(limit_rad_s)?;
        }
        Ok(actuator)
    }

    /// Time constant, s; 0 for an ideal servo.
    #[must_use]
    pub fn time_constant_s(&self) -> f64 {
        self.time_constant_s
    }

    /// Delay of the command in samples.
    #[must_use]
    pub fn delay_samples(&self) -> usize {
        self.delay_samples
    }

    /// True without position and rate limit.
    #[must_use]
    pub fn is_linear(&self) -> bool {
        self.position_limit_rad.is_none() && self.rate_limit_rad_s.is_none()
    }

    /// True without lag and rate limit: the deflection is the command.
    pub(crate) fn is_at_once(&self) -> bool {
        self.time_constant_s == 0.0 && self.rate_limit_rad_s.is_none()
    }

    /// Position limit, rad, and rate limit, rad/s.
    pub(crate) fn limits(&self) -> [Option<f64>; 2] {
        [self.position_limit_rad, self.rate_limit_rad_s]
    }

    /// The command within the position limit, rad.
    pub(crate) fn limited(&self, command_rad: f64) -> f64 {
        match self.position_limit_rad {
            Some(limit) => command_rad.clamp(-limit, limit),
            None => command_rad,
        }
    }

    /// How a sample of `dt_s` passes when the servo starts `gap_rad` short of its command: the rate
    /// [rad/s] at which it is held by its limit, and for how long [s].
    pub(crate) fn rate_limited_phase(&self, gap_rad: f64, dt_s: f64) -> Option<(f64, f64)> {
        let limit = self.rate_limit_rad_s?;
        // Below this gap the lag alone is slower than the limit.
        let free_gap_rad = limit * self.time_constant_s;
        let duration_s = (gap_rad.abs() - free_gap_rad) / limit;
        (duration_s > 0.0).then(|| (limit.copysign(gap_rad), duration_s.min(dt_s)))
    }
}

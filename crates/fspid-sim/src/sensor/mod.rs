//! Sensors: what a controller sees of a quantity, and when.
//!
//! # Order
//! A sensor looks at the quantity at its own sampling times $t_j = j T_s$. What it sees passes, in
//! this order: erection (vertical gyros only), scale, bias and drift, noise, quantisation. The value
//! is available a delay later and is held until the next one:
//!
//! $$ m(t) = Q \left( (1 + s) y(t_j) + b + d_j + \sigma n_j \right), \qquad
//! j = \left\lfloor \frac{t - t_d}{T_s} \right\rfloor $$
//!
//! A sensor without a sampling time of its own looks at every sample of the loop. Between samples of
//! the loop the quantity is taken to be a straight line; before the first it was what it is there.
//!
//! $$ \sigma = N \sqrt{\frac{1}{2 T_s}}, \qquad
//! d_{j+1} = e^{-T_s / T_d} d_j + \sigma_d \sqrt{1 - e^{-2 T_s / T_d}} n_j $$
//!
//! with the one-sided noise density N, unit/√Hz, over the bandwidth $1 / 2 T_s$, the bias b from run
//! to run of standard deviation $\sigma_b$, and the drift d, a process of Gauss and Markov that
//! starts from its stationary distribution.
//!
//! # Random streams
//! Of the seed, from [`STREAM`] on, 4 for each channel number: noise 0, bias 1, drift 2. Sample j of
//! the sensor's own clock takes number j. With a sampling time of its own the noise and the drift at a
//! time do not depend on the loop's period; without one the sensor's clock is the loop's, so that at
//! another period the density is the same and the numbers belong to other times.
//!
//! Quantities are in any one unit: rad for pitch, rad/s for pitch rate, m for altitude, m/s for speed.

mod memory;
mod preset;
mod seeing;

pub(crate) use memory::View;
pub use memory::{SensorState, Truth};
pub use preset::SensorPreset;
pub(crate) use seeing::Seeing;

use crate::error::{SimError, finite, not_negative, positive};
use crate::loop_model::Sensing;
use crate::signal::noise::standard_normal;

/// Number of the first random stream of sensors; turbulence and disturbances have others.
pub const STREAM: u64 = 2 << 32;
/// Streams that each channel has.
const STREAMS: u64 = 4;
/// Erection that no small motion meets the end of, rad/s.
const AT_ONCE_RAD_S: f64 = 1e6;

/// Channel number of the pitch sensor in the streams of its seed.
pub const PITCH: u32 = 0;
/// Channel number of the pitch-rate sensor.
pub const RATE: u32 = 1;

/// What a sensor does to its quantity. Public fields, checked when a [`Sensor`] is built; the
/// default does nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SensorModel {
    /// One-sided noise density N, unit/√Hz.
    pub noise_density: f64,
    /// Standard deviation of the bias from run to run, unit.
    pub bias: f64,
    /// Standard deviation of the drift, unit.
    pub drift: f64,
    /// Correlation time of the drift, s; needed where there is drift.
    pub drift_time_s: f64,
    /// Scale error s.
    pub scale_error: f64,
    /// Resolution, unit; 0 for none.
    pub resolution: f64,
    /// Sampling time, s; 0 for every sample of the loop.
    pub period_s: f64,
    /// Delay from looking to showing, s; need not be a multiple of anything.
    pub delay_s: f64,
    /// How fast a vertical gyro erects towards the apparent vertical, rad/s; 0 for none.
    pub erection_rad_s: f64,
}

/// A sensor of one channel, prepared for the loop's period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    model: SensorModel,
    seed: u64,
    channel: u32,
    /// From here on nothing is drawn any more.
    silent_from_s: f64,
}

impl Sensor {
    /// A sensor whose random numbers come from `seed` and the streams of `channel`.
    ///
    /// # Errors
    /// [`SimError::Number`] for a number that is not finite or, but for the scale error, negative;
    /// for drift without a correlation time.
    pub fn new(model: SensorModel, seed: u64, channel: u32) -> Result<Self, SimError> {
        for (what, value) in [
            ("noise density", model.noise_density),
            ("bias", model.bias),
            ("drift", model.drift),
            ("drift time, s", model.drift_time_s),
            ("resolution", model.resolution),
            ("sensor period, s", model.period_s),
            ("sensor delay, s", model.delay_s),
            ("erection rate, rad/s", model.erection_rad_s),
        ] {
            not_negative(what, value)?;
        }
        finite("scale error", model.scale_error)?;
        if model.drift > 0.0 {
            positive("drift time, s", model.drift_time_s)?;
        }
        Ok(Self { model, seed, channel, silent_from_s: f64::INFINITY })
    }

    /// What it does.
    #[must_use]
    pub fn model(&self) -> &SensorModel {
        &self.model
    }

    /// The same without noise from some time on, and with a drift that dies out from there on.
    pub(crate) fn silent_from(self, silent_from_s: f64) -> Self {
        Self { silent_from_s, ..self }
    }

    /// What small motions around rest see of it: scale and age.
    pub(crate) fn around_rest(self, dt_s: f64, seeing: Seeing) -> Self {
        let Sensing { samples, part, at_largest_age, .. } = Sensing::through(Some(&self), dt_s);
        let latest_s = (samples as f64 + part) * dt_s;
        let delay_s = match seeing {
            Seeing::Earliest if at_largest_age => self.model.delay_s,
            Seeing::Midway if at_largest_age => 0.5 * (self.model.delay_s + latest_s),
            _ => latest_s,
        };
        let erects = seeing == Seeing::Erecting && self.model.erection_rad_s > 0.0;
        let erection_rad_s = if erects { AT_ONCE_RAD_S } else { 0.0 };
        let SensorModel { scale_error, .. } = self.model;
        let plain = SensorModel { scale_error, erection_rad_s, ..SensorModel::default() };
        let model = match seeing {
            Seeing::AsTheyCome if at_largest_age => {
                let SensorModel { period_s, delay_s, .. } = self.model;
                SensorModel { period_s, delay_s, ..plain }
            }
            _ => SensorModel { delay_s, ..plain },
        };
        Self { model, ..self }
    }

    /// The same without an error of its scale.
    pub(crate) fn without_scale(self) -> Self {
        Self { model: SensorModel { scale_error: 0.0, ..self.model }, ..self }
    }

    /// The bias of this sensor, drawn from its seed, unit.
    #[must_use]
    pub fn bias(&self) -> f64 {
        match self.model.bias {
            bias if bias > 0.0 => bias * standard_normal(self.seed, self.stream(1), 0),
            _ => 0.0,
        }
    }

    /// Stream of a source of randomness.
    fn stream(&self, source: u64) -> u64 {
        STREAM + STREAMS * u64::from(self.channel) + source
    }
}

#[cfg(test)]
mod tests;

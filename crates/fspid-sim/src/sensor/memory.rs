//! What a sensor remembers, and how it looks.

use super::{Sensor, SensorModel};
use crate::error::SimError;
use crate::loop_model::Sensing;
use crate::math::exp;
use crate::signal::noise::standard_normal;
use crate::timing::{Age, SAME_SAMPLE};

/// The quantity at a sample of the loop.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Truth {
    /// Its value.
    pub value: f64,
    /// Angle between the true vertical and the one that a pendulum in the aircraft shows,
    /// $\arctan(a_x / g)$, rad, forward acceleration positive; only erecting gyros look at it, and
    /// 0 for a linear plant, whose speed is not known.
    pub apparent_vertical_rad: f64,
}

/// What a sensor shows at a sample of the loop, as a part of what there was: the values of two samples in a straight line,
/// then what is added; without the resolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct View {
    /// Samples of the loop between which it looks, and how far back from the newer one.
    pub(crate) newer: usize,
    pub(crate) older: usize,
    pub(crate) part: f64,
    /// Bias, drift and noise.
    added: [f64; 3],
}

impl View {
    /// What is seen of the values of the two samples.
    fn between(&self, newer: f64, older: f64) -> f64 {
        if self.part == 0.0 { newer } else { newer + self.part * (older - newer) }
    }

    /// What is shown of the values of the two samples, with a scale error.
    pub(crate) fn shown(&self, newer: f64, older: f64, scale_error: f64) -> f64 {
        let seen = self.between(newer, older);
        let [bias, drift, noise] = self.added;
        seen + scale_error * seen + bias + drift + noise
    }
}

/// The memory of a sensor over one flight.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorState {
    sensor: Sensor,
    dt_s: f64,
    period_s: f64,
    bias: f64,
    noise: f64,
    /// What remains of the drift after one period, and what is added to it.
    drift_step: [f64; 2],
    drift: f64,
    tilt_rad: f64,
    /// The last values that it may look at, a ring over the samples of the loop.
    history: Vec<f64>,
    /// The sensor's sample that is shown.
    shown: Option<u64>,
    value: f64,
}

/// Longest memory, samples of the loop.
const MOST_SAMPLES: f64 = 1e6;

impl Sensor {
    /// How many samples of the loop it remembers.
    ///
    /// # Errors
    /// [`SimError::Number`] for a delay or sampling time of more than a million samples.
    pub fn memory_samples(&self, dt_s: f64) -> Result<usize, SimError> {
        let model = self.model;
        let period_s = if model.period_s > 0.0 { model.period_s } else { dt_s };
        let samples = ((model.delay_s + period_s) / dt_s).ceil() + 2.0;
        let what = "sensor delay and period";
        let allowed = "at most a million sample periods";
        // Written so that NaN fails.
        if !(samples <= MOST_SAMPLES) {
            return Err(SimError::Number { what, found: samples, allowed });
        }
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 2 and a million"
        )]
        let samples = samples as usize;
        Ok(samples)
    }

    /// How it looks at each sample of a flight, whatever there is to be seen of a linear plant, whose vertical is the true
    /// one.
    pub(crate) fn views(&self, dt_s: f64, rows: usize) -> Result<Vec<View>, SimError> {
        let mut state = self.start(dt_s)?;
        let mut views = Vec::with_capacity(rows);
        let mut last = state.view(0, 0, true);
        state.shown = Some(0);
        for k in 0..rows {
            let sample = state.sample_at(k);
            while let Some(next) = state.shown.map(|shown| shown + 1).filter(|it| *it <= sample) {
                last = state.view(k, next, next == sample);
                state.shown = Some(next);
            }
            views.push(last);
        }
        Ok(views)
    }

    /// The memory for a flight that is sampled every `dt_s`; after this nothing is allocated.
    ///
    /// # Errors
    /// [`SimError::Number`] for a delay or sampling time of more than a million samples.
    pub fn start(&self, dt_s: f64) -> Result<SensorState, SimError> {
        let model = self.model;
        let period_s = if model.period_s > 0.0 { model.period_s } else { dt_s };
        let history = vec![0.0; self.memory_samples(dt_s)?];
        let normal = |source: u64| standard_normal(self.seed, self.stream(source), 0);
        let kept = if model.drift > 0.0 { exp(-period_s / model.drift_time_s) } else { 0.0 };
        Ok(SensorState {
            sensor: *self,
            dt_s,
            period_s,
            bias: self.bias(),
            noise: model.noise_density * (0.5 / period_s).sqrt(),
            drift_step: [kept, model.drift * (1.0 - kept * kept).sqrt()],
            drift: if model.drift > 0.0 { model.drift * normal(2) } else { 0.0 },
            tilt_rad: 0.0,
            history,
            shown: None,
            value: 0.0,
        })
    }
}

impl SensorState {
    /// What the sensor shows at sample `k` of the loop; samples count up by one from 0.
    pub fn measure(&mut self, k: usize, truth: Truth) -> f64 {
        self.erect(truth.apparent_vertical_rad);
        self.remember(k, truth.value + self.tilt_rad);
        let sample = self.sample_at(k);
        while self.shown.is_none_or(|shown| shown < sample) {
            let next = self.shown.map_or(0, |shown| shown + 1);
            self.look(k, next, next == sample);
        }
        self.value
    }

    /// What there was so many samples before sample `k` of the loop, which is not looked at yet; none before the first.
    pub(crate) fn past(&mut self, k: usize, samples: usize) -> Option<&mut f64> {
        let place = k.checked_sub(samples)? % self.history.len();
        self.history.get_mut(place)
    }

    /// How many of them what is looked at from a sample on depends on.
    pub(crate) fn depends_on(&self) -> usize {
        if self.holds() {
            // It is looked at within a sample after its delay.
            let delay = SensorModel { period_s: 0.0, ..self.sensor.model };
            let sensor = Sensor { model: delay, ..self.sensor };
            return Sensing::through(Some(&sensor), self.dt_s).samples + 2;
        }
        Sensing::through(Some(&self.sensor), self.dt_s).remembered()
    }

    /// True where it shows a value until its clock has come to the next.
    pub(crate) fn holds(&self) -> bool {
        self.sensor.model.period_s > 0.0
    }

    /// What it shows until then.
    pub(crate) fn held(&mut self) -> &mut f64 {
        &mut self.value
    }

    /// The gyro's axis follows the apparent vertical at its erection rate, so that a long forward
    /// acceleration shows as a nose that is too high.
    fn erect(&mut self, apparent_vertical_rad: f64) {
        let most_rad = self.sensor.model.erection_rad_s * self.dt_s;
        self.tilt_rad += (apparent_vertical_rad - self.tilt_rad).clamp(-most_rad, most_rad);
    }

    fn remember(&mut self, k: usize, value: f64) {
        let places = self.history.len();
        if k == 0 {
            self.history.fill(value);
        } else if let Some(place) = self.history.get_mut(k % places) {
            *place = value;
        }
    }

    /// The sensor's last sample that is available at sample `k` of the loop; before the first it is
    /// taken to be sample 0.
    fn sample_at(&self, k: usize) -> u64 {
        let time_s = k as f64 * self.dt_s - self.sensor.model.delay_s;
        let sample = if self.sensor.model.period_s > 0.0 {
            (time_s / self.period_s + SAME_SAMPLE).floor().max(0.0)
        } else {
            k as f64
        };
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "not negative, and the cast saturates"
        )]
        let sample = sample as u64;
        sample
    }

    /// Takes sample `j` of the sensor: draws its drift and, if it is the one to `show`, its value.
    fn look(&mut self, k: usize, j: u64, show: bool) {
        let view = self.view(k, j, show);
        if show {
            let value = |sample: usize| {
                let place = sample % self.history.len();
                self.history.get(place).copied().unwrap_or(0.0)
            };
            let model = &self.sensor.model;
            let raw = view.shown(value(view.newer), value(view.older), model.scale_error);
            self.value = quantised(raw, model.resolution);
        }
        self.shown = Some(j);
    }

    /// How sample `j` of the sensor looks, taken at sample `k` of the loop; its noise is drawn if it is shown.
    fn view(&mut self, k: usize, j: u64, show: bool) -> View {
        let [kept, added] = self.drift_step;
        let (sensor, number) = (self.sensor, usize::try_from(j).unwrap_or(usize::MAX));
        let normal = |source: u64| standard_normal(sensor.seed, sensor.stream(source), number);
        let is_drawn = j as f64 * self.period_s < sensor.silent_from_s;
        if j > 0 && added > 0.0 {
            self.drift = kept * self.drift + if is_drawn { added * normal(2) } else { 0.0 };
        }
        let is_noisy = is_drawn && show && self.noise > 0.0;
        let noise = if is_noisy { self.noise * normal(0) } else { 0.0 };
        let (newer, older, part) = self.places(k, j);
        View { newer, older, part, added: [self.bias, self.drift, noise] }
    }

    /// The samples of the loop between which sample `j` lies, and how far back from the newer one it does.
    fn places(&self, k: usize, j: u64) -> (usize, usize, f64) {
        let delay_s = self.sensor.model.delay_s;
        let at_s = if self.sensor.model.period_s > 0.0 {
            j as f64 * self.period_s
        } else {
            k as f64 * self.dt_s - delay_s
        };
        let Age { whole, part } = Age::of((k as f64 - at_s.max(0.0) / self.dt_s).max(0.0));
        // Before the start there was what there is at the first sample.
        let newer = k.saturating_sub(whole);
        let older = if part > 0.0 { newer.saturating_sub(1) } else { newer };
        (newer, older, part)
    }
}

/// The nearest multiple of a resolution, ties away from zero.
fn quantised(value: f64, resolution: f64) -> f64 {
    if resolution > 0.0 { (value / resolution).round() * resolution } else { value }
}

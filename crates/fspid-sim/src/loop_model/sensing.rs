//! Output equations of the linear loop with sensors: delay, scale and interpolation between samples.

use crate::sensor::Sensor;
use crate::timing::{Age, SAME_SAMPLE};

/// A sensor as the loop around rest sees it: scale and age. Bias, drift and noise are no part of a linear
/// loop; resolution is a bounded disturbance of it.
///
/// $$ m_k = s \left( (1 - f) y_{k-n} + f y_{k-n-1} \right) $$
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensing {
    /// Factor s on the quantity.
    pub scale: f64,
    /// Whole samples n that the value is old.
    pub samples: usize,
    /// Part f of a sample beyond them.
    pub part: f64,
    /// Resolution, unit: what is shown is the nearest multiple, off by half of it at most. No part of the matrix.
    pub resolution: f64,
    /// The sensor has a clock of its own, so that the age of its values changes; taken is the largest.
    pub at_largest_age: bool,
    /// Fewest samples of the quantity that the loop remembers, so that loops of several ages have the same states.
    pub keeps: usize,
}

impl Sensing {
    /// The quantity as it is.
    pub const DIRECT: Self = Self {
        scale: 1.0,
        samples: 0,
        part: 0.0,
        resolution: 0.0,
        at_largest_age: false,
        keeps: 0,
    };

    /// Through a sensor that is read every `dt_s`, if there is one.
    #[must_use]
    pub fn through(sensor: Option<&Sensor>, dt_s: f64) -> Self {
        let Some(model) = sensor.map(Sensor::model) else {
            return Self::DIRECT;
        };
        let scale = 1.0 + model.scale_error;
        let resolution = model.resolution;
        let delay = model.delay_s / dt_s;
        if model.period_s == 0.0 {
            let Age { whole, part } = Age::of(delay);
            return Self { scale, samples: whole, part, resolution, ..Self::DIRECT };
        }
        let period = model.period_s / dt_s;
        let Oldest { age, changes } = Oldest::of(period, delay);
        let Age { whole, part } = Age::of(age);
        Self { scale, samples: whole, part, resolution, at_largest_age: changes, ..Self::DIRECT }
    }

    /// How many samples of the quantity the loop has to remember.
    pub(crate) fn remembered(&self) -> usize {
        self.keeps.max(self.samples + usize::from(self.part > 0.0))
    }
}

/// The largest age of what a sensor with a clock of its own shows, samples of the loop.
struct Oldest {
    age: f64,
    /// False where all ages are the same.
    changes: bool,
}

impl Oldest {
    /// Of a period and a delay, samples of the loop.
    fn of(period: f64, delay: f64) -> Self {
        let is_whole = |number: f64| (number - number.round()).abs() <= SAME_SAMPLE;
        let whole_above = |number: f64| (number - SAME_SAMPLE).ceil().max(0.0);
        if is_whole(period) && period.round() >= 1.0 {
            // Sampling times that are those of the loop leave out the age of a whole period.
            let beyond = period.round() - 1.0;
            return Self { age: whole_above(delay) + beyond, changes: beyond > 0.0 };
        }
        let each = 1.0 / period;
        if each >= 1.0 && is_whole(each) {
            // So many of its samples are one of the loop's, and as many lie between it and what is shown each time.
            return Self { age: whole_above(delay * each) / each, changes: false };
        }
        // What is shown is replaced before it is a period older than it was when it came.
        Self { age: delay + period, changes: true }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::SensorModel;

    fn seen(period_s: f64, delay_s: f64) -> Sensing {
        let model = SensorModel { period_s, delay_s, ..SensorModel::default() };
        let sensor = Sensor::new(model, 1, 0).expect("a sensor");
        Sensing::through(Some(&sensor), 0.01)
    }

    #[test]
    fn a_delay_of_one_and_a_half_samples_lies_between_the_second_and_third_last_value() {
        let sensing = seen(0.0, 0.015);
        assert_eq!((sensing.samples, sensing.remembered()), (1, 2));
        assert!((sensing.part - 0.5).abs() < 1e-12);
    }

    #[test]
    fn a_sensor_with_the_period_of_the_loop_is_late_by_whole_samples() {
        let sensing = seen(0.01, 0.015);
        assert_eq!((sensing.samples, sensing.at_largest_age), (2, false));
    }

    /// Two samples of 20 ms were taken for 10 ms of age that never change: 7.3 dB of a margin of 10.6 dB.
    #[test]
    fn a_sensor_that_is_read_several_times_a_sample_is_always_of_one_age() {
        for (period_s, delay_s, age_s) in
            [(0.005, 0.005, 0.005), (0.005, 0.006, 0.01), (0.005, 0.0, 0.0), (0.002, 0.013, 0.014)]
        {
            let sensing = seen(period_s, delay_s);
            assert!(!sensing.at_largest_age, "{period_s} {delay_s}");
            let age_s_found = 0.01 * (sensing.samples as f64 + sensing.part);
            assert!((age_s_found - age_s).abs() < 1e-9, "{period_s} {delay_s} {age_s_found}");
        }
    }

    /// Ages of clocks that meet the loop's again and again are in steps: the largest is a step below.
    #[test]
    fn a_sensor_out_of_step_is_taken_no_younger_than_it_ever_is() {
        for (period, delay) in [(1.25, 0.0), (0.7, 0.3), (2.6, 1.1), (0.31, 2.05)] {
            let Oldest { age, changes } = Oldest::of(period, delay);
            let shown = |k: f64| k - ((k - delay) / period).floor() * period;
            let ages: Vec<f64> = (10..10_000).map(|k| shown(f64::from(k))).collect();
            let oldest = ages.iter().copied().fold(0.0, f64::max);
            assert!(changes && oldest <= age + 1e-9 && oldest > age - 0.3, "{oldest} {age}");
        }
    }

    #[test]
    fn a_slower_sensor_is_taken_at_its_largest_age() {
        let sensing = seen(0.04, 0.01);
        assert_eq!((sensing.samples, sensing.at_largest_age), (4, true));
    }
}

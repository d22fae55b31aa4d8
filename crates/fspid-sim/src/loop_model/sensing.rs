//! Output equations of the linear loop with sensors: delay, scale and interpolation between samples.

use crate::sensor::Sensor;
use crate::timing::{Age, SAME_SAMPLE, count};

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
        let aligned = (period - period.round()).abs() <= SAME_SAMPLE;
        // Sampling times that are those of the loop leave out the age of a whole period.
        let beyond = if aligned { period.round() - 1.0 } else { period };
        let age = (delay - SAME_SAMPLE).ceil().max(0.0) + beyond.max(0.0);
        let at_largest_age = !aligned || beyond > 0.0;
        let samples = count(age.ceil());
        Self { scale, samples, resolution, at_largest_age, ..Self::DIRECT }
    }

    /// How many samples of the quantity the loop has to remember.
    pub(crate) fn remembered(&self) -> usize {
        self.keeps.max(self.samples + usize::from(self.part > 0.0))
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

    #[test]
    fn a_slower_sensor_is_taken_at_its_largest_age() {
        let sensing = seen(0.04, 0.01);
        assert_eq!((sensing.samples, sensing.at_largest_age), (4, true));
    }
}

//! Scales of sensors between bounds.

use fspid_numeric::scalar::Interval;
use fspid_sim::loop_model::LoopSettings;

use super::Parameter;
use crate::check::{ROUNDED, printed};
use crate::description::LoopDescription;

/// A sensor whose scale may differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScaledSensor {
    /// That of the pitch angle.
    Pitch,
    /// That of the pitch rate.
    Rate,
}

impl ScaledSensor {
    fn place(self, settings: &mut LoopSettings) -> &mut f64 {
        match self {
            Self::Pitch => &mut settings.pitch.scale,
            Self::Rate => &mut settings.rate.scale,
        }
    }
}

impl Parameter {
    /// The least and the most scale of a sensor, that is 1 and its error, whose scale in the loop as it is is `nominal`.
    #[must_use]
    pub fn scales(&self, ends: [f64; 2], nominal: f64) -> [f64; 2] {
        let point = Interval::point;
        let error = |end: f64| match self.relative {
            true => (point(nominal) * ROUNDED - Interval::ONE) * printed(end),
            false => printed(end) / point(100.0),
        };
        let scales = ends.map(|end| (Interval::ONE + error(end) * ROUNDED) * ROUNDED);
        let [one, other] = scales.map(|it| [it.lower(), it.upper()]);
        [one[0].min(other[0]), one[1].max(other[1])]
    }
}

/// True if several parameters are about one sensor, or one is about it twice.
pub(super) fn is_twofold(parameters: &[Parameter]) -> bool {
    let of =
        |sensor| parameters.iter().flat_map(|one| &one.sensors).filter(move |it| **it == sensor);
    [ScaledSensor::Pitch, ScaledSensor::Rate].into_iter().any(|sensor| of(sensor).count() > 1)
}

/// What a loop is set to at each corner of the scales that differ; sensors of one parameter have theirs together.
pub(super) fn corners(
    parameters: &[Parameter],
    ends: &[[f64; 2]],
    description: &LoopDescription,
) -> Vec<LoopSettings> {
    let mut found = vec![description.settings()];
    for (parameter, &ends) in parameters.iter().zip(ends) {
        if parameter.is_of_plant() {
            continue;
        }
        let at = |settings: &LoopSettings, end: usize| {
            let mut settings = settings.clone();
            for sensor in &parameter.sensors {
                let place = sensor.place(&mut settings);
                *place = parameter.scales(ends, *place)[end];
            }
            settings
        };
        found = found.iter().flat_map(|it| [at(it, 0), at(it, 1)]).collect();
    }
    found
}

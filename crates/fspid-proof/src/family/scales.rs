//! Scales of sensors between bounds.

use fspid_numeric::scalar::Interval;
use fspid_sim::loop_model::LoopSettings;

use super::Parameter;
use crate::certificate::Claim;
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

/// True if of each plant one form falls at all scales that differ, so that these may change from sample to sample, each by
/// itself. Scales of one draw are asked together at its ends alone, which says nothing of two that go their own ways.
///
/// A plant on the face of parts is a limit of plants beside it, which lie within theirs: the parts that cover those cover
/// it, too. So it is enough that parts whose plants overlap have the same claim.
pub(super) fn may_change(parameters: &[Parameter], parts: &[(&[[f64; 2]], &Claim)]) -> bool {
    let is_of_plant = |side: &usize| parameters[*side].is_of_plant();
    let of_plant: Vec<usize> = (0..parameters.len()).filter(is_of_plant).collect();
    let share_plants = |one: &[[f64; 2]], other: &[[f64; 2]]| {
        of_plant.iter().all(|&side| overlap(one[side], other[side]))
    };
    let is_alone = |(place, (ends, claim)): (usize, &(&[[f64; 2]], &Claim))| {
        let mut others = parts[place + 1..].iter();
        others.all(|(other, another)| claim == another || !share_plants(ends, other))
    };
    // What a tied gain is tied to is shown by sensors.
    let is_tied = |(_, claim): &(&[[f64; 2]], &Claim)| matches!(claim, Claim::SProcedure { .. });
    of_plant.len() < parameters.len()
        && parameters.iter().all(|one| one.sensors.len() <= 1)
        && !parts.iter().any(is_tied)
        && parts.iter().enumerate().all(is_alone)
}

/// True if more than a face belongs to both, or what belongs to both is all of one.
fn overlap([from, to]: [f64; 2], [first, last]: [f64; 2]) -> bool {
    let (lower, upper) = (from.max(first), to.min(last));
    let stands = to <= from || last <= first;
    lower < upper || stands && lower <= upper
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

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_lti::Matrix;

    fn parameter(sensors: &[ScaledSensor]) -> Parameter {
        let (name, paths) = (String::new(), Vec::new());
        let (relative, inverse, sensors) = (false, false, sensors.to_vec());
        Parameter { name, paths, relative, inverse, sensors, ends: [0.0, 2.0] }
    }

    fn common(rate: f64) -> Claim {
        Claim::CommonQuadratic { form: Matrix::identity(2), rate }
    }

    /// Of parts with a number of the plant, from where to where, a scale, and which of two forms.
    fn of_plant_and_scale(parts: &[([f64; 2], [f64; 2], f64)]) -> bool {
        let parameters = [parameter(&[]), parameter(&[ScaledSensor::Pitch])];
        let ends: Vec<[[f64; 2]; 2]> = parts.iter().map(|it| [it.0, it.1]).collect();
        let claims: Vec<Claim> = parts.iter().map(|it| common(it.2)).collect();
        let parts = ends.iter().map(|it| it.as_slice()).zip(&claims);
        may_change(&parameters, &parts.collect::<Vec<_>>())
    }

    const LOW: [f64; 2] = [0.0, 1.0];
    const HIGH: [f64; 2] = [1.0, 2.0];
    const ALL: [f64; 2] = [0.0, 2.0];

    #[test]
    fn scales_may_change_where_one_form_does_for_all_of_them() {
        assert!(of_plant_and_scale(&[(ALL, ALL, 0.9)]));
        assert!(of_plant_and_scale(&[(ALL, LOW, 0.9), (ALL, HIGH, 0.9)]));
        assert!(!of_plant_and_scale(&[(ALL, LOW, 0.9), (ALL, HIGH, 0.8)]));
    }

    #[test]
    fn plants_that_stand_still_may_have_a_form_each() {
        assert!(of_plant_and_scale(&[(LOW, ALL, 0.9), (HIGH, ALL, 0.8)]));
        assert!(of_plant_and_scale(&[(LOW, ALL, 0.9), (HIGH, LOW, 0.8), (HIGH, HIGH, 0.8)]));
        assert!(!of_plant_and_scale(&[(LOW, ALL, 0.9), (HIGH, LOW, 0.8), (HIGH, HIGH, 0.9)]));
        // Of plants from 0.5 to 1 there are two forms.
        assert!(!of_plant_and_scale(&[([0.5, 2.0], LOW, 0.9), (LOW, HIGH, 0.8)]));
        // A plant that is between no two others has a part of its own, and others around it.
        assert!(!of_plant_and_scale(&[([1.0, 1.0], LOW, 0.9), (ALL, HIGH, 0.8)]));
        assert!(!of_plant_and_scale(&[([1.0, 1.0], LOW, 0.9), ([1.0, 1.0], HIGH, 0.8)]));
        assert!(!of_plant_and_scale(&[(HIGH, LOW, 0.9), ([1.0, 1.0], HIGH, 0.8)]));
        assert!(of_plant_and_scale(&[([0.5, 0.5], LOW, 0.9), (HIGH, HIGH, 0.8)]));
    }

    #[test]
    fn two_scales_of_one_draw_may_not_change_each_by_itself() {
        let one = [ALL];
        let both = [ScaledSensor::Pitch, ScaledSensor::Rate];
        assert!(!may_change(&[parameter(&both)], &[(one.as_slice(), &common(0.9))]));
        let two = [ALL, ALL];
        let apart = both.map(|sensor| parameter(&[sensor]));
        assert!(may_change(&apart, &[(two.as_slice(), &common(0.9))]));
    }

    #[test]
    fn without_a_scale_or_with_gains_that_are_tied_to_what_is_shown_nothing_may_change() {
        let one = [ALL];
        let of = |sensors: &[ScaledSensor], claim: &Claim| {
            may_change(&[parameter(sensors)], &[(one.as_slice(), claim)])
        };
        assert!(of(&[ScaledSensor::Rate], &common(0.9)));
        assert!(!of(&[], &common(0.9)));
        let form = Matrix::identity(2);
        let tied = Claim::SProcedure { form, rate: 0.9, multipliers: vec![1.0] };
        assert!(!of(&[ScaledSensor::Rate], &tied));
    }
}

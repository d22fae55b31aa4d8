//! Uncertain sensor scale factors between bounds.

use fspid_numeric::scalar::Interval;
use fspid_sim::loop_model::LoopSettings;

use super::{Parameter, cover};
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
        let [one, other] = ends.map(|end| self.scale_at(end, nominal));
        [one[0].min(other[0]), one[1].max(other[1])]
    }

    /// Between what the scale of a sensor lies at one end, as arithmetic may round it.
    fn scale_at(&self, end: f64, nominal: f64) -> [f64; 2] {
        let point = Interval::point;
        let error = match self.relative {
            true => (point(nominal) * ROUNDED - Interval::ONE) * printed(end),
            false => printed(end) / point(100.0),
        };
        let scale = (Interval::ONE + error * ROUNDED) * ROUNDED;
        [scale.lower(), scale.upper()]
    }
}

/// True if several parameters are about one sensor, or one is about it twice.
pub(super) fn is_twofold(parameters: &[Parameter]) -> bool {
    let of =
        |sensor| parameters.iter().flat_map(|one| &one.sensors).filter(move |it| **it == sensor);
    [ScaledSensor::Pitch, ScaledSensor::Rate].into_iter().any(|sensor| of(sensor).count() > 1)
}

/// A part's sides of the plant, those of scales, and its claim.
type Apart<'a> = (Vec<[f64; 2]>, Vec<[f64; 2]>, &'a Claim);

/// True if of each plant one form falls at all scales that differ, so that these may change from sample to sample, each by
/// itself. Scales of one draw are asked together at its ends alone, which says nothing of two that go their own ways.
pub(super) fn may_change(parameters: &[Parameter], parts: &[(&[[f64; 2]], &Claim)]) -> bool {
    let sides = |ends: &[[f64; 2]], of_plant: bool| -> Vec<[f64; 2]> {
        let kept = parameters.iter().zip(ends).filter(|(one, _)| one.is_of_plant() == of_plant);
        kept.map(|(_, ends)| *ends).collect()
    };
    let whole: Vec<[f64; 2]> = parameters.iter().map(|one| one.ends).collect();
    let [plants, scales] = [true, false].map(|of_plant| sides(&whole, of_plant));
    let apart = parts.iter().map(|&(ends, claim)| (sides(ends, true), sides(ends, false), claim));
    let apart: Vec<Apart<'_>> = apart.collect();
    // What a tied gain is tied to is shown by sensors.
    let is_tied = |(_, _, claim): &Apart<'_>| matches!(claim, Claim::SProcedure { .. });
    !scales.is_empty()
        && parameters.iter().all(|one| one.sensors.len() <= 1)
        && !apart.iter().any(is_tied)
        && has_one_form(&plants, &scales, &apart.iter().collect::<Vec<_>>(), &mut {
            cover::MOST_CUTS
        })
}

/// True if of each plant between some ends there is a claim whose parts hold it at all scales; plants are cut where parts
/// end, so many times at most.
fn has_one_form(
    plants: &[[f64; 2]],
    scales: &[[f64; 2]],
    parts: &[&Apart<'_>],
    cuts: &mut usize,
) -> bool {
    let near: Vec<&Apart<'_>> =
        parts.iter().filter(|part| cover::has_inside(&part.0, plants)).copied().collect();
    let holding = near.iter().filter(|part| cover::holds_all(&part.0, plants));
    let holding: Vec<&&Apart<'_>> = holding.collect();
    let does_for_all = |claim: &Claim| {
        let own = holding.iter().filter(|part| part.2 == claim);
        cover::covers(scales, &own.map(|part| part.1.as_slice()).collect::<Vec<_>>())
    };
    if holding.iter().any(|part| does_for_all(part.2)) {
        return true;
    }
    let Some((side, at)) = near.iter().find_map(|part| cover::face_within(&part.0, plants)) else {
        return false;
    };
    if !cover::may_cut(cuts) {
        return false;
    }
    [[plants[side][0], at], [at, plants[side][1]]].into_iter().all(|half| {
        let mut ends = plants.to_vec();
        ends[side] = half;
        has_one_form(&ends, scales, &near, cuts)
    })
}

/// What a loop is set to at each corner of the scales that differ. Sensors of one parameter have theirs together, end by end:
/// as a factor of errors of two signs one grows while the other falls.
pub(super) fn corners(
    parameters: &[Parameter],
    ends: &[[f64; 2]],
    description: &LoopDescription,
) -> Vec<LoopSettings> {
    let differing = parameters.iter().zip(ends).filter(|(one, _)| !one.is_of_plant());
    differing.fold(vec![description.settings()], |found, (parameter, &ends)| {
        found.iter().flat_map(|settings| parameter.settings_at(ends, settings)).collect()
    })
}

impl Parameter {
    /// A loop's settings at both ends, with all that arithmetic may make of each.
    fn settings_at(&self, ends: [f64; 2], settings: &LoopSettings) -> Vec<LoopSettings> {
        let with = |all: Vec<LoopSettings>, sensor: ScaledSensor, of: &dyn Fn(f64) -> [f64; 2]| {
            let both = |settings: &LoopSettings| {
                let mut settings = settings.clone();
                let nominal = *sensor.place(&mut settings);
                of(nominal).map(|scale| {
                    *sensor.place(&mut settings) = scale;
                    settings.clone()
                })
            };
            all.iter().flat_map(both).collect()
        };
        let own = vec![settings.clone()];
        if let [sensor] = self.sensors[..] {
            return with(own, sensor, &|nominal| self.scales(ends, nominal));
        }
        let at = |end: f64| {
            let sensors = self.sensors.iter().copied();
            sensors.fold(own.clone(), |all, it| with(all, it, &|one| self.scale_at(end, one)))
        };
        ends.into_iter().flat_map(at).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::family::tests::fixed_loop;
    use fspid_lti::Matrix;
    use fspid_sim::loop_model::Sensing;

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
        // Nothing is known of some plants at some scales.
        assert!(!of_plant_and_scale(&[([1.0, 1.0], LOW, 0.9), (ALL, HIGH, 0.8)]));
        assert!(!of_plant_and_scale(&[(HIGH, LOW, 0.9), ([1.0, 1.0], HIGH, 0.8)]));
    }

    #[test]
    fn parts_that_overlap_leave_each_plant_one_form_if_they_did_before() {
        let (low, high) = ([0.0, 1.2], [0.8, 2.0]);
        assert!(of_plant_and_scale(&[(low, ALL, 0.9), (high, ALL, 0.8)]));
        assert!(of_plant_and_scale(&[(low, ALL, 0.9), (ALL, LOW, 0.8), (high, HIGH, 0.8)]));
        assert!(!of_plant_and_scale(&[(low, ALL, 0.9), (high, LOW, 0.8), (high, HIGH, 0.7)]));
        assert!(!of_plant_and_scale(&[([0.0, 0.7], ALL, 0.9), (high, ALL, 0.8)]));
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

    #[test]
    fn sensors_of_one_draw_whose_errors_have_two_signs_go_apart_and_not_together() {
        let with = |scale: f64| Sensing { scale, ..Sensing::DIRECT };
        let description = LoopDescription { pitch: with(1.05), rate: with(0.95), ..fixed_loop() };
        let mut both = parameter(&[ScaledSensor::Pitch, ScaledSensor::Rate]);
        both.relative = true;
        let found = corners(&[both], &[ALL], &description);
        let near = |pitch: f64, rate: f64| {
            let is = |it: &&LoopSettings| {
                (it.pitch.scale - pitch).abs() < 1e-9 && (it.rate.scale - rate).abs() < 1e-9
            };
            found.iter().filter(is).count()
        };
        // No error at all, and twice that of each; each with all that rounding makes of it.
        assert_eq!([near(1.0, 1.0), near(1.1, 0.9), found.len()], [4, 4, 8]);
    }
}

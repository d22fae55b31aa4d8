//! Gains over any box of the supervisor's inputs, enclosed as they are asked for.

use fspid_core::fuzzy::OutOfRange;
use fspid_core::{Law, SelfTuner};
use fspid_fuzzy::system::System;
use fspid_numeric::scalar::Interval;

use super::increments::{Enclosure, Side};
use super::law::{One, each};

/// The gains of a memoryless law.
pub(crate) struct GainsOver<'a> {
    enclosure: Enclosure<'a>,
    each: [One; 3],
    range: f64,
    clamps: bool,
    /// An input whose scale is 0 is always 0.
    sees: [bool; 2],
}

impl<'a> GainsOver<'a> {
    /// Those of a tuner; none where gains remember.
    pub(crate) fn of(tuner: &'a SelfTuner<f64>, system: Option<&'a System>) -> Option<Self> {
        let settings = tuner.settings();
        let scale = settings.input_scale;
        let sees = [scale.error_per_rad, scale.change_per_rad].map(|scale| scale.abs() > 0.0);
        (settings.law == Law::Memoryless).then(|| Self {
            enclosure: Enclosure::new(tuner, system),
            each: each(tuner, 1.0),
            range: tuner.supervisor().range(),
            clamps: tuner.supervisor().out_of_range() == OutOfRange::Clamp,
            sees,
        })
    }

    /// The gains where error and change, in supervisor units, lie between bounds; none where an input may be refused.
    pub(crate) fn over(&mut self, inputs: [Interval; 2]) -> Option<[Interval; 3]> {
        let range = self.range;
        let inside = |input: &Interval| input.lower() >= -range && input.upper() <= range;
        if !self.clamps && !inputs.iter().all(inside) {
            return None;
        }
        let side = |place: usize| {
            let [lower, upper] = [inputs[place].lower(), inputs[place].upper()];
            if !self.sees[place] {
                return Side::point(0.0);
            }
            let asked = Interval::between(lower.clamp(-range, range), upper.clamp(-range, range));
            Side { asked, inputs: [lower, upper] }
        };
        let sides = [0, 1].map(side);
        let [of_kp, of_ki, of_kd] = self.enclosure.over(sides);
        let [kp, ki, kd] = &self.each;
        Some([kp.memoryless(of_kp), ki.memoryless(of_ki), kd.memoryless(of_kd)])
    }
}

//! On-demand enclosures of the gains over arbitrary boxes of the supervisor's inputs.

use fspid_core::fuzzy::OutOfRange;
use fspid_core::{Law, SelfTuner, SetCentres};
use fspid_fuzzy::system::System;
use fspid_numeric::scalar::Interval;

use super::increments::{Enclosure, Side};
use super::law::{One, each};

/// Parts that a side of inputs is cut into where all gains over it are asked for once: boxes of increments shrink with it.
const PARTS: u32 = 8;

/// The increments of a tuner over inputs, and what its law makes of them.
pub(crate) struct GainsOver<'a> {
    enclosure: Enclosure<'a>,
    each: [One; 3],
    range: f64,
    clamps: bool,
    /// An input whose scale is 0 is always 0.
    sees: [bool; 2],
    /// Where the centres of each input's sets lie.
    sets: [Option<SetCentres<f64>>; 2],
}

impl<'a> GainsOver<'a> {
    /// Those of a tuner without memory; none where gains remember.
    pub(crate) fn of(tuner: &'a SelfTuner<f64>, system: Option<&'a System>) -> Option<Self> {
        let is_memoryless = tuner.settings().law == Law::Memoryless;
        is_memoryless.then(|| Self::any(tuner, system))
    }

    /// Those of any tuner.
    pub(crate) fn any(tuner: &'a SelfTuner<f64>, system: Option<&'a System>) -> Self {
        let settings = tuner.settings();
        let scale = settings.input_scale;
        let sees = [scale.error_per_rad, scale.change_per_rad].map(|scale| scale.abs() > 0.0);
        Self {
            enclosure: Enclosure::new(tuner, system),
            each: each(tuner, 1.0),
            range: tuner.supervisor().range(),
            clamps: tuner.supervisor().out_of_range() == OutOfRange::Clamp,
            sees,
            sets: [settings.input_sets.error, settings.input_sets.change],
        }
    }

    /// The gains of a law without memory where error and change, in supervisor units, lie between bounds; none where an
    /// input may be refused.
    pub(crate) fn over(&mut self, inputs: [Interval; 2]) -> Option<[Interval; 3]> {
        let increments = self.increments(inputs)?;
        Some(self.made_of(increments, One::memoryless))
    }

    /// Every gain that a tuner comes to which begins with its nominal ones and sees nothing beyond these bounds of error and
    /// change, in supervisor units, either way; none where an input may be refused, or where nothing holds a gain back.
    pub(crate) fn reached_from_nominal(
        &mut self,
        law: Law<f64>,
        most: [f64; 2],
    ) -> Option<[Interval; 3]> {
        let parts = |most: f64| {
            let end = move |part: u32| most * (2.0 * f64::from(part) / f64::from(PARTS) - 1.0);
            (0..PARTS).map(move |part| Interval::between(end(part), end(part + 1)))
        };
        let [error, change] = most;
        let mut hull: Option<[Interval; 3]> = None;
        for inputs in parts(error).flat_map(|error| parts(change).map(move |it| [error, it])) {
            let own = self.increments(inputs)?;
            hull = Some(
                hull.map_or(own, |all| [0, 1, 2].map(|gain: usize| all[gain].hull(own[gain]))),
            );
        }
        let gains = match law {
            Law::Memoryless => self.made_of(hull?, One::memoryless),
            Law::Accumulating { .. } => self.made_of(hull?, One::accumulated),
        };
        gains.iter().all(|gain| gain.is_bounded()).then_some(gains)
    }

    fn made_of(
        &self,
        [of_kp, of_ki, of_kd]: [Interval; 3],
        by: fn(&One, Interval) -> Interval,
    ) -> [Interval; 3] {
        let [kp, ki, kd] = &self.each;
        [by(kp, of_kp), by(ki, of_ki), by(kd, of_kd)]
    }

    fn increments(&mut self, inputs: [Interval; 2]) -> Option<[Interval; 3]> {
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
            let within = [lower, upper].map(|end| end.clamp(-range, range));
            Side { inputs: [lower, upper], ..Side::seen(within, range, self.sets[place]) }
        };
        Some(self.enclosure.over([0, 1].map(side)))
    }
}

#[cfg(test)]
mod tests {
    use fspid_core::fuzzy::{Defuzzifier, Supervisor};
    use fspid_core::{Gains, InputSets, SetCentres, TunerSettings};
    use fspid_fuzzy::NumberTable;

    use super::super::{array, producible};
    use super::*;

    /// Rules that conclude numbers which differ from place to place.
    fn numbers() -> Supervisor<f64> {
        let grid = |seed: usize| {
            core::array::from_fn(|row| {
                core::array::from_fn(|column| {
                    ((row * column * 5 + row * 7 + column + seed) % 13) as f64 / 13.0 - 0.5
                })
            })
        };
        let table = NumberTable::new([grid(0), grid(3), grid(8)]).expect("numbers");
        Supervisor::of_numbers(&table, 2.0, OutOfRange::Clamp).expect("allowed")
    }

    /// The paper's rules.
    fn labels() -> Supervisor<f64> {
        let rule = Defuzzifier::Exact;
        Supervisor::new(&fspid_core::paper::rules(), 5.0, rule, OutOfRange::Clamp).expect("allowed")
    }

    #[test]
    fn every_gain_over_a_box_lies_in_its_bounds_also_of_sets_that_are_moved() {
        let moved = |small, medium| SetCentres::new(small, medium).ok();
        for (error, change) in
            [(None, None), (moved(0.1, 0.7), None), (moved(0.5, 0.9), moved(0.05, 0.3))]
        {
            let settings = TunerSettings {
                input_sets: InputSets { error, change },
                ..TunerSettings::literal()
            };
            let nominal = Gains { kp: 1.0, ki: 1.0, kd: 1.0 };
            for supervisor in [numbers(), labels()] {
                let range = supervisor.range();
                let tuner = SelfTuner::new(nominal, supervisor, settings).expect("allowed");
                let parts = fspid_fuzzy::system::Parts::try_from(tuner.supervisor()).ok();
                let system = parts.and_then(|parts| System::new(parts).ok());
                let mut over = GainsOver::of(&tuner, system.as_ref()).expect("memoryless");
                for (from, width) in [(-1.2, 0.15), (-0.05, 0.1), (0.15, 0.9), (-1.2, 2.4)] {
                    let sides = [from, -0.7 * from].map(|at| [range * at, range * (at + width)]);
                    let inputs = sides.map(|[least, most]| Interval::between(least, most));
                    let bounds = over.over(inputs).expect("clamped");
                    for step in 0..=400 {
                        let share = |by: usize| (step * by % 401) as f64 / 400.0;
                        let at = |side: [f64; 2], share: f64| side[0] + share * (side[1] - side[0]);
                        let seen = [at(sides[0], share(1)), at(sides[1], share(37))];
                        let gains = array(producible(&tuner, seen[0], seen[1]));
                        for (bounds, gain) in bounds.iter().zip(gains) {
                            assert!(
                                bounds.contains(gain),
                                "{error:?} {change:?} {seen:?}: {gain} {bounds:?}"
                            );
                        }
                    }
                }
            }
        }
    }
}

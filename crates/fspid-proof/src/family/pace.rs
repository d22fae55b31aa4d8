//! Numbers of a family that move in flight: how fast they may, and why.
//!
//! Each number moves at no more than the rate that takes it steadily through all its range in a time T, in samples and
//! between them, so by a part d of it in a sample. Patches of the box have a form each, which falls at all numbers inside
//! while these move within the sample. They overlap: what is left of each once a margin w is taken off its faces, its core,
//! covers the box together with the other cores. A flight counts on the form of one patch as long as its numbers are inside
//! at the begin of each sample, which from a core on is so for n samples at least, with n d at most w; then they are in the
//! core of a patch whose form it counts on next. Where for all patches i and j that meet so
//!
//! $$ \rho_j^{2n} P_j \prec P_i $$
//!
//! the form is smaller each time that a patch is left than it was the last time, by a factor that all of them have: the
//! motion comes to rest.
//!
//! # Source
//! J. P. Hespanha and A. S. Morse, *Stability of switched systems with average dwell-time*, CDC 1999, 2655, for forms that
//! are counted on for a time.

use fspid_lti::Matrix;
use fspid_numeric::scalar::{Interval, Scalar};

use super::{Family, Parameter, Part, cover};
use crate::caps::MOST_PATCHES;
use crate::certificate::Claim;
use crate::check::{IntervalMatrix, printed, prove_positive_definite};
use crate::description::LoopDescription;

/// How fast the numbers of a family may move.
#[derive(Clone, Debug, PartialEq)]
pub struct Pace {
    /// Each number moves at no more than the rate that takes it steadily from one end to the other in this time, s; at 0 it
    /// may be anywhere at any time.
    pub crosses_in_s: f64,
    /// What is taken off the faces of a patch inside the box for its core, over the whole side.
    pub overlap: f64,
    /// Where in the box which form is counted on.
    pub patches: Vec<Patch>,
}

/// A box of numbers with one form.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// From where to where each parameter goes.
    pub ends: Vec<[f64; 2]>,
    /// That of the parts that cover it.
    pub claim: Claim,
}

/// More samples than are counted on a form, which has fallen to nothing before.
const MOST_SAMPLES: f64 = 1e9;

impl Pace {
    /// How far a number moves in a sample at most.
    fn in_a_sample(&self, ends: [f64; 2], dt_s: f64) -> Interval {
        // In no time at all: all of it, as in any that is shorter than a sample.
        let share = (printed(dt_s) / Interval::point(self.crosses_in_s)).upper().min(1.0);
        width(ends) * Interval::point(share)
    }

    /// How far what plants are made of moves in a sample at most.
    pub(super) fn of_plant(&self, parameters: &[Parameter], dt_s: f64) -> Vec<f64> {
        let moved = |one: &Parameter| {
            let moved = self.in_a_sample(one.ends, dt_s);
            // |1/a - 1/b| = |a - b| |1/a| |1/b|.
            if one.inverse { moved * one.number(one.ends).square() } else { moved }
        };
        parameters.iter().filter(|one| one.is_of_plant()).map(|one| moved(one).upper()).collect()
    }

    /// Samples that begin with numbers in a patch if the first of them begins in its core: at least one.
    fn samples(&self, parameters: &[Parameter], dt_s: f64) -> Option<u64> {
        let on = |one: &Parameter| {
            let moved = self.in_a_sample(one.ends, dt_s).upper();
            let margin = Interval::point(self.overlap) * width(one.ends);
            if moved > 0.0 { (margin / Interval::point(moved)).lower() } else { MOST_SAMPLES }
        };
        let fewest = libm::floor(parameters.iter().map(on).fold(MOST_SAMPLES, f64::min));
        // Written so that NaN is too few.
        (fewest >= 1.0).then_some(fewest as u64)
    }

    /// What of a patch its numbers may be in when its form begins to be counted on.
    fn core(&self, parameters: &[Parameter], patch: &Patch) -> Vec<[f64; 2]> {
        let core = |(one, &[from, to]): (&Parameter, &[f64; 2])| {
            let margin = (Interval::point(self.overlap) * width(one.ends)).upper();
            let [first, last] = one.ends;
            // Beyond the box there is nothing.
            let lower = if from <= first { from } else { (from + margin).next_up() };
            let upper = if to >= last { to } else { (to - margin).next_down() };
            [lower, upper]
        };
        parameters.iter().zip(&patch.ends).map(core).collect()
    }

    /// Whether the numbers of a family may move so, if the claim of each of its parts holds while they move within a sample.
    pub(super) fn check(
        &self,
        family: &Family,
        description: &LoopDescription,
    ) -> Result<(), &'static str> {
        self.is_whole(&family.parameters, &family.parts)?;
        hang_together(&family.parts)?;
        self.keeps_up(&family.parameters, description)
    }

    /// Whether forms go over into each other, of numbers that may move.
    pub(super) fn keeps_up(
        &self,
        parameters: &[Parameter],
        description: &LoopDescription,
    ) -> Result<(), &'static str> {
        if !parameters.iter().all(|one| one.may_move(description)) {
            return Err("a number that moves changes what the states of the plant are");
        }
        let whole: Vec<[f64; 2]> = parameters.iter().map(|one| one.ends).collect();
        if let [patch] = self.patches.as_slice()
            && cover::holds_all(&patch.ends, &whole)
        {
            return Ok(());
        }
        let samples = self.samples(parameters, description.controller.config().dt_s);
        let samples = samples.ok_or("its numbers leave the patches too fast")?;
        let cores: Vec<_> = self.patches.iter().map(|it| self.core(parameters, it)).collect();
        let is_empty = |core: &[[f64; 2]]| !core.iter().all(|[from, to]| from <= to);
        let kept: Vec<&[[f64; 2]]> =
            cores.iter().map(Vec::as_slice).filter(|core| !is_empty(core)).collect();
        if !cover::covers(&whole, &kept) {
            return Err("its patches overlap too little");
        }
        for (next, core) in self.patches.iter().zip(&cores).filter(|(_, core)| !is_empty(core)) {
            let meets = |it: &&Patch| it.claim != next.claim && cover::touches(&it.ends, core);
            if !self.patches.iter().filter(meets).all(|it| goes_over(it, next, samples)) {
                return Err("its numbers go over from form to form too fast");
            }
        }
        Ok(())
    }

    /// True of numbers that are some, and of patches that are covered by parts with their claim about all gains.
    fn is_whole(&self, parameters: &[Parameter], parts: &[Part]) -> Result<(), &'static str> {
        let Self { crosses_in_s, overlap, patches } = self;
        if !(*crosses_in_s >= 0.0 && crosses_in_s.is_finite() && (0.0..=1.0).contains(overlap)) {
            let what =
                "the time in which its numbers cross their ranges, or the overlap, is not allowed";
            return Err(what);
        }
        if !(1..=MOST_PATCHES).contains(&patches.len()) {
            return Err("allowed are 1 to 64 patches");
        }
        for Patch { ends, claim } in patches {
            // Written so that NaN is not in order.
            let in_order =
                ends.iter().all(|[from, to]| from <= to && from.is_finite() && to.is_finite());
            if ends.len() != parameters.len() || !in_order {
                return Err("a patch has other parameters, or ends that are not in order");
            }
            if common(claim).is_none() {
                return Err("its numbers move, and a patch has no one form for all gains");
            }
            let own = parts.iter().filter(|part| part.claim == *claim);
            if !cover::covers(ends, &own.map(|part| part.ends.as_slice()).collect::<Vec<_>>()) {
                return Err("a patch is not covered by parts with its form");
            }
        }
        Ok(())
    }
}

impl Parameter {
    /// True for a number whose change leaves the states of the plant what they are, so that a flight goes on where it was:
    /// of an aircraft or an actuator, or a factor on all of a transfer function's numerator, which is one on its elevator,
    /// and not 0, where the states are others. Other coefficients of a transfer function that moved would have no meaning
    /// without a choice of its states. The scale of a sensor may; not that of two by one draw, as each sees its own delay.
    #[must_use]
    pub fn may_move(&self, description: &LoopDescription) -> bool {
        if !self.is_of_plant() {
            return self.sensors.len() == 1;
        }
        let of = |table: &str| self.paths.iter().all(|path| path.starts_with(table));
        // A coefficient may stand in a table of its own kind of plant.
        let is_effect = |index: usize| {
            let name = format!("numerator[{index}]");
            let is_it = |path: &String| path.rsplit('.').next() == Some(name.as_str());
            self.paths.iter().any(is_it)
        };
        let numerator = || {
            let places = description.numerator.iter().enumerate();
            places.filter(|(_, it)| **it != 0.0).map(|(index, _)| index)
        };
        let is_factor = self.paths.len() >= numerator().count()
            && numerator().all(is_effect)
            && (self.relative || numerator().count() == 1);
        let of_numerator = |path: &String| {
            path.rsplit('.').next().is_some_and(|last| last.starts_with("numerator["))
        };
        let [from, to] = self.ends;
        let has_a_sign = from > 0.0 || to < 0.0;
        let is_effect =
            of("plant.") && self.paths.iter().all(of_numerator) && is_factor && has_a_sign;
        !self.paths.is_empty() && (of("aircraft.") || of("actuator.") || is_effect)
    }
}

fn width([from, to]: [f64; 2]) -> Interval {
    Interval::point(to) - Interval::point(from)
}

/// Whether parts can be those of plants that change with their numbers without a jump: of what numbers that move do within
/// a sample only slopes are known.
fn hang_together(parts: &[Part]) -> Result<(), &'static str> {
    let entries = |part: &Part| part.plants.all.concat();
    let lags = |part: &&Part| part.plants.without_lag == parts[0].plants.without_lag;
    if !parts.iter().all(|part| lags(&part) && part.plants.holds_its_middle()) {
        return Err(
            "its numbers move, and its plants are not told as those of one function of them",
        );
    }
    let all: Vec<Vec<Interval>> = parts.iter().map(entries).collect();
    for (place, (part, own)) in parts.iter().zip(&all).enumerate() {
        let others = parts.iter().zip(&all).skip(place);
        let mut near = others.filter(|(other, _)| cover::touches(&part.ends, &other.ends));
        let meet = |(_, other): (&Part, &Vec<Interval>)| {
            own.iter().zip(other).all(|(own, other)| own.intersection(*other).is_some())
        };
        if !near.all(meet) {
            return Err("its numbers move, and plants jump from part to part");
        }
    }
    Ok(())
}

/// The form and the rate of a claim about all gains.
pub(super) fn common(claim: &Claim) -> Option<(&Matrix, f64)> {
    match claim {
        Claim::CommonQuadratic { form, rate } => Some((form, *rate)),
        _ => None,
    }
}

/// True if the form of the next patch, once it has fallen for so many samples, is below that of the one before.
fn goes_over(before: &Patch, next: &Patch, samples: u64) -> bool {
    let Some(((below, _), (form, rate))) = common(&before.claim).zip(common(&next.claim)) else {
        return false;
    };
    let fallen = IntervalMatrix::from(form).scaled(power(Interval::point(rate).square(), samples));
    let left = IntervalMatrix::from(below).difference(&fallen);
    left.is_ok_and(|left| prove_positive_definite(&left).is_ok())
}

/// A number of at most 1 to the power of a whole one, by products alone.
fn power(base: Interval, times: u64) -> Interval {
    let (mut result, mut square) = (Interval::ONE, base);
    for bit in 0..u64::BITS - times.leading_zeros() {
        if times >> bit & 1 == 1 {
            result = result * square;
        }
        square = square.square();
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::family::tests::fixed_loop;
    use crate::family::{ScaledSensor, moves::Off};

    const DT_S: f64 = 0.1;

    fn parameter(ends: [f64; 2], inverse: bool) -> Parameter {
        let (name, paths) = (String::new(), vec!["actuator.time_constant_s".to_owned()]);
        Parameter { name, paths, relative: false, inverse, sensors: Vec::new(), ends }
    }

    fn scale(ends: [f64; 2]) -> Parameter {
        Parameter { sensors: vec![ScaledSensor::Pitch], ..parameter(ends, false) }
    }

    fn pace(crosses_in_s: f64, overlap: f64, patches: Vec<Patch>) -> Pace {
        Pace { crosses_in_s, overlap, patches }
    }

    fn patch(ends: [f64; 2], size: f64, rate: f64) -> Patch {
        let form = Matrix::identity(2).scaled(size);
        Patch { ends: vec![ends], claim: Claim::CommonQuadratic { form, rate } }
    }

    #[test]
    fn what_plants_are_made_of_moves_by_its_share_of_the_range_in_a_sample_and_by_all_of_it_at_most()
     {
        let all = [parameter([1.0, 3.0], false), scale([-5.0, 5.0]), parameter([0.1, 0.2], true)];
        let moved = |crosses_in_s: f64| pace(crosses_in_s, 0.0, Vec::new()).of_plant(&all, DT_S);
        let near = |found: &[f64], expected: [f64; 2]| {
            let off = |(one, other): (&f64, f64)| *one >= other && *one - other < 1e-12 * other;
            assert!(found.len() == 2 && found.iter().zip(expected).all(off), "{found:?}");
        };
        near(&moved(10.0), [0.02, 0.1]);
        for crosses_in_s in [0.0, 0.01, DT_S] {
            near(&moved(crosses_in_s), [2.0, 10.0]);
        }
    }

    #[test]
    fn numbers_stay_in_a_patch_for_the_samples_that_its_margin_takes_them() {
        let all = [parameter([1.0, 3.0], false), scale([-5.0, 5.0])];
        let samples = |crosses_in_s, overlap, all: &[Parameter]| {
            pace(crosses_in_s, overlap, Vec::new()).samples(all, DT_S)
        };
        // 25.5 of them.
        assert_eq!(samples(10.0, 0.255, &all), Some(25));
        assert_eq!(samples(10.0, 0.009, &all), None);
        assert_eq!(samples(0.0, 0.255, &all), None);
        let standing = [parameter([2.0, 2.0], false)];
        assert_eq!(samples(10.0, 0.0, &standing), Some(1_000_000_000));
        let both = [all[0].clone(), standing[0].clone()];
        assert_eq!(samples(10.0, 0.255, &both), Some(25));
    }

    #[test]
    fn forms_go_over_into_each_other_where_patches_meet_and_are_not_asked_to_where_they_do_not() {
        let number = [parameter([0.0, 3.0], false)];
        let keeps_up =
            |patches: &[Patch]| pace(10.0, 0.1, patches.to_vec()).keeps_up(&number, &fixed_loop());
        // Nine samples at least, in which a form falls to 0.39 of itself.
        let [low, middle, high] = [[0.0, 1.5], [0.8, 2.4], [1.5, 3.0]];
        let of = |sizes: [f64; 3]| {
            [low, middle, high].into_iter().zip(sizes).map(|(ends, size)| patch(ends, size, 0.949))
        };
        let patches = |sizes| of(sizes).collect::<Vec<_>>();
        assert_eq!(keeps_up(&patches([1.0, 2.0, 4.0])), Ok(()));
        let too_fast = Err("its numbers go over from form to form too fast");
        assert_eq!(keeps_up(&patches([1.0, 4.0, 8.0])), too_fast);
        assert_eq!(keeps_up(&patches([4.0, 2.0, 4.0])), Ok(()));
        assert_eq!(keeps_up(&patches([8.0, 2.0, 4.0])), too_fast);
        let few = Err("its patches overlap too little");
        assert_eq!(keeps_up(&patches([1.0, 2.0, 4.0])[..2]), few);
        assert_eq!(keeps_up(&patches([1.0; 3])[1..]), few);
    }

    #[test]
    fn powers_of_a_rate_are_products() {
        for times in [0, 1, 2, 3, 10, 1000] {
            let found = power(Interval::point(0.5), times);
            assert!(found.contains(libm::exp2(-(times as f64))) && found.upper() < 1.1);
        }
        assert!(power(Interval::point(0.9), 1_000_000_000).upper() < 1e-300);
        assert_eq!(power(Interval::ONE, 12345), Interval::ONE);
    }

    #[test]
    fn what_is_off_is_held_by_what_is_nowhere_less() {
        let off = |entries: [f64; 2], rate: [f64; 2]| Off {
            entries: entries.to_vec(),
            pitch_rate: vec![Interval::between(rate[0], rate[1])],
        };
        let own = off([1.0, 2.0], [-1.0, 1.0]);
        assert!(own.encloses(&own) && own.encloses(&off([1.0, 1.0], [0.0, 1.0])));
        assert!(!own.encloses(&off([1.0, 2.1], [0.0, 1.0])));
        assert!(!own.encloses(&off([0.0, 0.0], [-1.0, 1.1])));
        assert!(!own.encloses(&off([1.1, 0.0], [-2.0, 0.0])));
    }
}

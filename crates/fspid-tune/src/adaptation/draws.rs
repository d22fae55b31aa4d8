//! How sure a number of flights is: parts of the plants, and seeds, are left out one after the other.

use crate::contest::beyond;

/// Fewest plants from which an interval is told.
pub(super) const FEWEST: usize = 5;
/// Most parts of the plants, of which one after the other is left out.
const PARTS: usize = 20;
/// Chance that an interval does not hold the number.
const CHANCE: f64 = 0.05;
/// What rounding alone does to a number.
const ROUNDING: f64 = 1e-12;
/// Correlations and shares are no nearer to 1: their transformations end there.
const MOST: f64 = 1.0 - 1e-15;

/// Most parts that so many plants can have.
pub(super) fn most_parts(plants: usize) -> usize {
    plants.min(PARTS)
}

/// The parts of the plants that a number is made of; the others are in none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Parts {
    pub(super) of: Vec<Option<usize>>,
    /// Of how many plants.
    plants: usize,
}

impl Parts {
    /// Of plants, each with whether it is in the number: what is not in it is no evidence.
    pub(super) fn of(is_in: &[bool]) -> Self {
        let mut plants = 0;
        let part = |is_in: &bool| {
            is_in.then(|| {
                plants += 1;
                (plants - 1) % PARTS
            })
        };
        Self { of: is_in.iter().map(part).collect(), plants }
    }

    /// The part that a plant is in.
    pub(super) fn part(&self, plant: usize) -> Option<usize> {
        self.of.get(plant).copied().flatten()
    }

    /// How many parts are left out; none where there are too few plants for an interval.
    pub(super) fn count(&self) -> usize {
        if self.plants < FEWEST { 0 } else { most_parts(self.plants) }
    }

    pub(super) fn has(&self, plant: usize) -> bool {
        self.part(plant).is_some()
    }
}

/// A number with its interval, which is told for five plants and more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// It holds the number with 95 %.
    pub interval: Option<[f64; 2]>,
}

impl Estimate {
    /// The same of a function that keeps the order.
    #[must_use]
    pub fn map(self, of: fn(f64) -> f64) -> Self {
        Self { value: of(self.value), interval: self.interval.map(|ends| ends.map(of)) }
    }

    /// True where the whole interval is above a number; never without one.
    #[must_use]
    pub fn is_above(&self, number: f64) -> bool {
        self.interval.is_some_and(|[lower, _]| lower > number)
    }
}

/// How much each plant and each seed counts, 1 or 0.
#[derive(Clone, Debug)]
pub(super) struct Weights {
    pub(super) plants: Vec<f64>,
    pub(super) seeds: Vec<f64>,
    /// The part of the plants that is left out.
    pub(super) left: Option<usize>,
}

/// What kind of number has an interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Any number: a logarithm, a slope.
    Any,
    /// From -1 to 1; its error is that of its hyperbolic arctangent (Fisher).
    Correlation,
    /// From 0 to 1; its error is that of the logarithm of its odds.
    Share,
}

impl Kind {
    /// On a scale on which errors are alike on both sides.
    fn scaled(self, value: f64) -> f64 {
        match self {
            Self::Correlation => libm::atanh(value.clamp(-MOST, MOST)),
            Self::Share => {
                let share = value.clamp(1.0 - MOST, MOST);
                libm::log(share / (1.0 - share))
            }
            Self::Any => value,
        }
    }

    fn unscaled(self, value: f64) -> f64 {
        match self {
            Self::Any => value,
            Self::Correlation => libm::tanh(value),
            Self::Share => 1.0 / (1.0 + libm::exp(-value)),
        }
    }
}

/// What is left out of plants and seeds.
///
/// The plants' part of a number's variance comes from leaving out one part of the plants after the other, parts of unequal
/// sizes allowed for: with $\theta$ of all $n$ plants, $\theta_g$ without the $m_g$ plants of part $g$ of $G$, and
/// $h_g = n / m_g$,
///
/// $$ s^2 = \frac{1}{G} \sum_g \frac{1}{h_g - 1} \left( h_g \theta - (h_g - 1) \theta_g - \bar\theta \right)^2,
/// \quad \bar\theta = G \theta - \sum_g \left( 1 - \frac{m_g}{n} \right) \theta_g $$
///
/// Seeds are left out one by one. Both parts are added; degrees of freedom are Satterthwaite's.
///
/// # Source
/// Busing, Meijer and van der Leeden (1999), "Delete-m jackknife for unequal m", Statistics and Computing 9.
#[derive(Clone, Debug)]
pub(super) struct Draws {
    as_flown: Weights,
    /// Without a part of the plants, with how many of all plants it has, of 1.
    parts: Vec<(f64, Weights)>,
    /// Without a seed.
    seeds: Vec<Weights>,
}

impl Draws {
    /// Of the win, which is flown again without each part of its plants.
    pub(super) fn of_win(parts: &Parts, seeds: usize) -> Self {
        let mut draws = Self::new(parts, seeds);
        for (part, (_, weights)) in draws.parts.iter_mut().enumerate() {
            weights.left = Some(part);
        }
        draws
    }

    /// Of what is not flown again.
    pub(super) fn new(parts: &Parts, seeds: usize) -> Self {
        let plants = parts.of.len();
        let often = |stays: &dyn Fn(usize) -> bool| -> Vec<f64> {
            (0..plants).map(|it| if parts.has(it) && stays(it) { 1.0 } else { 0.0 }).collect()
        };
        let as_flown = Weights { plants: often(&|_| true), seeds: vec![1.0; seeds], left: None };
        let part = |part: usize| {
            let kept = often(&|plant| parts.part(plant) != Some(part));
            let share = 1.0 - kept.iter().sum::<f64>() / parts.plants as f64;
            (share, Weights { plants: kept, ..as_flown.clone() })
        };
        let seed = |seed: usize| {
            let mut without = as_flown.clone();
            without.seeds[seed] = 0.0;
            without
        };
        // Of one seed nobody knows what another would do.
        let left_seeds = if seeds < 2 { 0 } else { seeds };
        let (parts, seeds) = ((0..parts.count()).map(part), (0..left_seeds).map(seed));
        Self { parts: parts.collect(), seeds: seeds.collect(), as_flown }
    }

    /// A number that depends on how much plants and seeds count; `None` where it has no value, and without an interval
    /// where it has none without some of them.
    pub(super) fn estimate(
        &self,
        kind: Kind,
        of: impl Fn(&Weights) -> Option<f64>,
    ) -> Option<Estimate> {
        let finite = |weights: &Weights| of(weights).filter(|value| value.is_finite());
        let value = finite(&self.as_flown)?;
        let middle = kind.scaled(value);
        let scatter = self.scatter(middle, |it| finite(it).map(|value| kind.scaled(value)));
        let interval = scatter.map(|scatter| {
            let far = scatter.times() * libm::sqrt(scatter.variance());
            let far = far.max(ROUNDING * (1.0 + middle.abs()));
            let [lower, upper] = [middle - far, middle + far].map(|end| kind.unscaled(end));
            // The scale ends before 0 and 1 do, where the number itself may be.
            [lower.min(value), upper.max(value)]
        });
        Some(Estimate { value, interval })
    }

    /// A part of a whole, as a share, with the interval of a ratio: all shares that the scatter of both does not exclude.
    ///
    /// $$ (a - \theta b)^2 \le t^2 (s_{aa} - 2 \theta s_{ab} + \theta^2 s_{bb}) $$
    ///
    /// Where the whole may be 0 these have no end, and there is no interval. What scatters about a share is skewed the more the
    /// smaller the whole is, so that an interval that is as long on both sides is too short on one.
    ///
    /// # Source
    /// E. C. Fieller, "Some problems in interval estimation", Journal of the Royal Statistical Society B 16 (1954) 175.
    pub(super) fn share(
        &self,
        part: impl Fn(&Weights) -> Option<f64>,
        whole: impl Fn(&Weights) -> Option<f64>,
    ) -> Option<Estimate> {
        let finite = |value: Option<f64>| value.filter(|it| it.is_finite());
        let (a, b) = (finite(part(&self.as_flown))?, finite(whole(&self.as_flown))?);
        let value = finite(Some(a / b))?;
        let scatters =
            self.scatter(a, |it| finite(part(it))).zip(self.scatter(b, |it| finite(whole(it))));
        let interval = scatters.and_then(|(of_part, of_whole)| {
            let times = of_part.less(value, &of_whole).times();
            let square = times * times;
            let least = b * b - square * of_whole.variance();
            let middle = (a * b - square * of_part.with(&of_whole)) / least;
            let product = (a * a - square * of_part.variance()) / least;
            let far = libm::sqrt((middle * middle - product).max(0.0));
            let rounding = ROUNDING * (1.0 + value.abs());
            let ends = [(middle - far).min(value - rounding), (middle + far).max(value + rounding)];
            (least > 0.0).then_some(ends)
        });
        Some(Estimate { value, interval })
    }

    /// How a number scatters about that which is had of all.
    fn scatter(&self, middle: f64, of: impl Fn(&Weights) -> Option<f64>) -> Option<Scatter> {
        let parts = self.parts.iter().map(|(share, weights)| Some((*share, of(weights)?)));
        let parts: Vec<(f64, f64)> = parts.collect::<Option<_>>()?;
        let seeds: Vec<f64> = self.seeds.iter().map(&of).collect::<Option<_>>()?;
        if parts.is_empty() {
            return None;
        }
        Some(Scatter { parts: of_parts(middle, &parts), seeds: of_seeds(&seeds) })
    }
}

/// What is left out of plants and of seeds changes a number by so much: the squares sum up to its variance.
struct Scatter {
    parts: Vec<f64>,
    seeds: Vec<f64>,
}

fn product(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}

impl Scatter {
    /// The covariance with that of another number.
    fn with(&self, other: &Self) -> f64 {
        product(&self.parts, &other.parts) + product(&self.seeds, &other.seeds)
    }

    fn variance(&self) -> f64 {
        self.with(self)
    }

    /// That of the number less so many times the other.
    fn less(&self, times: f64, other: &Self) -> Self {
        let less = |one: &[f64], other: &[f64]| {
            one.iter().zip(other).map(|(one, other)| one - times * other).collect()
        };
        Self { parts: less(&self.parts, &other.parts), seeds: less(&self.seeds, &other.seeds) }
    }

    /// How many standard errors an interval is on either side; without a spread none.
    fn times(&self) -> f64 {
        let variances = [product(&self.parts, &self.parts), product(&self.seeds, &self.seeds)];
        let freedoms =
            [self.parts.len() as f64 - 1.0, self.seeds.len().saturating_sub(1).max(1) as f64];
        let whole: f64 = variances.iter().sum();
        let doubts = variances.iter().zip(freedoms).map(|(it, freedom)| it * it / freedom);
        let freedom = whole * whole / doubts.sum::<f64>();
        if freedom >= 1.0 { beyond(CHANCE, freedom) } else { 0.0 }
    }
}

/// The plants' part of a scatter, from numbers without a part of them, each with its share of the plants.
fn of_parts(whole: f64, parts: &[(f64, f64)]) -> Vec<f64> {
    let count = parts.len() as f64;
    let mean = count * whole - parts.iter().map(|(share, it)| (1.0 - share) * it).sum::<f64>();
    let beside = |&(share, without): &(f64, f64)| {
        let times = 1.0 / share;
        let pseudo = times * whole - (times - 1.0) * without;
        (pseudo - mean) / libm::sqrt((times - 1.0) * count)
    };
    parts.iter().map(beside).collect()
}

/// The seeds' part of a scatter, from numbers without one of them.
fn of_seeds(seeds: &[f64]) -> Vec<f64> {
    let count = seeds.len() as f64;
    let mean = seeds.iter().sum::<f64>() / count;
    seeds.iter().map(|it| (it - mean) * libm::sqrt((count - 1.0) / count)).collect()
}

#[cfg(test)]
mod tests {
    use fspid_scenario::dispersion::standard_normal::quantile;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng as _, SeedableRng as _};

    use super::super::means::line;
    use super::*;

    /// All of so many plants.
    fn all_of(plants: usize, seeds: usize) -> Draws {
        Draws::new(&Parts::of(&vec![true; plants]), seeds)
    }

    /// Mean of numbers, one for each plant.
    fn mean(values: &[f64], weights: &Weights) -> Option<f64> {
        let sum: f64 = weights.plants.iter().zip(values).map(|(w, it)| w * it).sum();
        Some(sum / weights.plants.iter().sum::<f64>())
    }

    #[test]
    fn the_interval_of_a_mean_is_students_with_parts_of_any_size() {
        for plants in [5, 16, 20, 23, 60, 144] {
            // As good as drawn.
            let value = |it: usize| (1e4 * (1.0 + libm::sin(1.0 + 12.9898 * it as f64))) % 1.0;
            let values: Vec<f64> = (0..plants).map(value).collect();
            let mean_of_all = values.iter().sum::<f64>() / plants as f64;
            let found = all_of(plants, 1).estimate(Kind::Any, |it| mean(&values, it));
            let found = found.expect("a mean");
            let [lower, upper] = found.interval.expect("enough plants");
            assert!((0.5 * (lower + upper) - mean_of_all).abs() < 1e-12, "{found:?}");
            let square = |it: &f64| (it - mean_of_all) * (it - mean_of_all);
            let squares: f64 = values.iter().map(square).sum();
            let error = libm::sqrt(squares / (plants * (plants - 1)) as f64);
            let far = beyond(0.05, most_parts(plants) as f64 - 1.0) * error;
            // Parts of several plants each scatter as they happen to.
            let near = if plants <= PARTS { 1e-9 } else { 0.5 };
            assert!((0.5 * (upper - lower) / far - 1.0).abs() < near, "{plants}: {found:?} {far}");
        }
        let few = all_of(FEWEST - 1, 1).estimate(Kind::Any, |_| Some(1.0));
        assert!(few.is_some_and(|it| it.interval.is_none()));
    }

    #[test]
    fn the_interval_of_a_correlation_stays_within_one_and_that_of_a_share_within_its_ends() {
        let draws = all_of(5, 1);
        let pairs = [(0.0, 0.1), (1.0, 0.9), (2.0, 2.2), (3.0, 2.9), (4.0, 4.4)];
        let part = |which: usize| {
            let pairs = &pairs;
            move |weights: &Weights| {
                let pairs = pairs.iter().zip(&weights.plants).map(|(&(x, y), w)| (x, y, *w));
                line(pairs).map(|found| found[which])
            }
        };
        let found = draws.estimate(Kind::Correlation, part(0)).expect("a line");
        let [lower, upper] = found.interval.expect("enough plants");
        assert!(-1.0 < lower && lower < found.value && found.value < upper && upper < 1.0);
        let share = |weights: &Weights| {
            let counted = weights.plants.iter().zip([0.1, 0.2, 0.6, 0.9, 0.9]);
            Some(counted.map(|(w, it)| w * it).sum::<f64>() / weights.plants.iter().sum::<f64>())
        };
        let found = draws.estimate(Kind::Share, share).expect("a mean");
        let [lower, upper] = found.interval.expect("enough plants");
        assert!(0.0 < lower && lower < 0.3 && 0.7 < upper && upper < 1.0, "{found:?}");
        // At its ends a share is in its interval, and so is a correlation.
        for (kind, end) in [(Kind::Share, 0.0), (Kind::Share, 1.0), (Kind::Correlation, -1.0)] {
            let found = draws.estimate(kind, |_| Some(end)).expect("a number");
            let [lower, upper] = found.interval.expect("enough plants");
            assert!(lower <= end && end <= upper && upper - lower < 1e-9, "{found:?}");
        }
        // Of what is nothing without some plant, nothing is known.
        let one = draws.estimate(Kind::Share, |weights| Some(0.5 * weights.plants[0]));
        let [lower, upper] = one.and_then(|it| it.interval).expect("enough plants");
        assert!(lower < 1e-9 && upper > 1.0 - 1e-9, "{one:?}");
    }

    /// An interval that is as long on both sides missed three times as many on one as on the other: of wins that are small beside
    /// their scatter 86 to 89 % of what said 95 %.
    #[test]
    fn ninety_five_of_a_hundred_intervals_hold_the_share_of_a_small_win() {
        const EXPERIMENTS: u32 = 1000;
        /// The part, the whole, and what both have in common scatters about them.
        const SHARE: f64 = 0.4;
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let mut normal =
            || quantile((random.next_u64() >> 11) as f64 * (0.5 * f64::EPSILON) + 1e-17);
        let (mut below, mut above, mut without) = (0, 0, 0);
        for _ in 0..EXPERIMENTS {
            // The mean of ten is three standard errors from 0.
            let whole: Vec<f64> = (0..10).map(|_| -1.0 + normal()).collect();
            let part: Vec<f64> =
                whole.iter().map(|it| -SHARE + 0.5 * (it + 1.0) + 0.5 * normal()).collect();
            let draws = all_of(10, 1);
            let found = draws.share(|it| mean(&part, it), |it| mean(&whole, it));
            match found.expect("a share").interval {
                None => without += 1,
                Some([lower, upper]) => {
                    below += u32::from(SHARE < lower);
                    above += u32::from(SHARE > upper);
                }
            }
        }
        // Where the whole may be nothing there is no interval, which excludes nothing.
        assert!((100..400).contains(&without), "{without}");
        let missed = f64::from(below + above) / f64::from(EXPERIMENTS);
        assert!((0.03..0.07).contains(&missed), "{below} {above} of {EXPERIMENTS}");
    }

    #[test]
    fn a_share_of_a_whole_that_is_certain_has_the_interval_of_its_part() {
        let (part, draws) = ([0.1, 0.2, 0.6, 0.9, 0.9], all_of(5, 1));
        let share = draws.share(|it| mean(&part, it), |_| Some(2.0)).expect("a share");
        let of_part = draws.estimate(Kind::Any, |it| Some(mean(&part, it)? / 2.0));
        let [lower, upper] = share.interval.expect("it has an end");
        let [least, most] = of_part.and_then(|it| it.interval).expect("enough plants");
        assert!((lower - least).abs() < 1e-12 && (upper - most).abs() < 1e-12, "{share:?}");
        let of_nothing = draws.share(|it| mean(&part, it), |it| Some(mean(&part, it)? - 0.5));
        assert!(of_nothing.is_some_and(|it| it.interval.is_none()), "{of_nothing:?}");
    }

    /// Seeds that scatter make an interval wider than plants alone do.
    #[test]
    fn seeds_are_in_the_interval() {
        let values = [1.0, 2.0, 3.0, 4.0, 5.0];
        let width = |seeds: usize| {
            let draws = all_of(5, seeds);
            let found = draws.estimate(Kind::Any, |weights| {
                let seeds = weights.seeds.iter().enumerate().map(|(at, w)| w * at as f64);
                let count: f64 = weights.seeds.iter().sum();
                Some(mean(&values, weights)? + 10.0 * seeds.sum::<f64>() / count)
            });
            let [lower, upper] = found.and_then(|it| it.interval).expect("enough plants");
            upper - lower
        };
        assert!(width(3) > 4.0 * width(1), "{} {}", width(3), width(1));
    }
}

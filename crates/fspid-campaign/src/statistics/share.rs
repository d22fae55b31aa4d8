//! Variance-based sensitivity: the share of a measure's variance that each parameter explains.

use std::collections::BTreeMap;

use serde::Serialize;

use super::rank::{equal, ordered};
use super::{Moments, beta};

/// Share of the variance of a measure that a parameter explains alone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Share {
    /// 0 (nothing) to 1 (everything).
    pub fraction: f64,
    /// The same without the correction for scatter inside the classes: too high for independent runs.
    ///
    /// For runs on a low-discrepancy sequence the truth lies between the two, see [`Classes::share_of`].
    pub uncorrected: f64,
    /// Standard error of the fraction.
    pub standard_error: f64,
    /// How many classes of the parameter were compared.
    pub classes: usize,
}

/// The fewest pairs that are asked: four classes of four.
pub const FEWEST_PAIRS: usize = 16;

/// Share of the variance of the measure that the parameter explains alone: Sobol' index of first order, from given data.
///
/// $$ S = \frac{\operatorname{Var}(\operatorname{E}[Y \mid X])}{\operatorname{Var}(Y)} $$
///
/// See [`Classes`], which serves many measures of the same parameter. What the parameter does only together with others is
/// not in it: the shares of independent parameters sum to at most 1, and what is missing there is interaction and noise.
///
/// `None` for columns of different lengths, fewer than [`FEWEST_PAIRS`] pairs, a constant column, values that are not finite.
#[must_use]
pub fn first_order(parameter: &[f64], measure: &[f64]) -> Option<Share> {
    Classes::of(parameter)?.share_of(measure)
}

/// The runs in classes of nearly the same value of a parameter.
///
/// A parameter with at most $M = \lfloor \sqrt n \rfloor$ different values has a class for each; another one is cut into $M$
/// classes of equal probability, equal values staying together. With that many neither error counts beside the scatter of
/// the sample, which is of the order of $n^{-1/2}$: classes of width $1/M$ hide a share of the order of $M^{-2} = n^{-1}$ of
/// a smooth curve, and the noise of the class means leaves a standard deviation of about $\sqrt{2M}/n$.
///
/// # Source
/// E. Plischke, E. Borgonovo, C. L. Merz, *Global sensitivity measures from given data*, European Journal of Operational
/// Research 226 (2013), for the classes; the number of them is this project's.
#[derive(Clone, Debug, PartialEq)]
pub struct Classes {
    class_of_run: Vec<u32>,
    count: usize,
}

impl Classes {
    /// Of a parameter; `None` for fewer than [`FEWEST_PAIRS`] values, a constant and values that are not finite.
    #[must_use]
    pub fn of(parameter: &[f64]) -> Option<Self> {
        let runs = parameter.len();
        if runs < FEWEST_PAIRS || !parameter.iter().all(|value| value.is_finite()) {
            return None;
        }
        let order = ordered(parameter);
        let most = runs.isqrt();
        let discrete = equal(&order).take(most + 1).count() <= most;

        let mut class_of_run = vec![0; runs];
        let (mut class, mut before) = (0, 0);
        for together in equal(&order) {
            for &(_, run) in together {
                if let Some(place) = class_of_run.get_mut(run) {
                    *place = class;
                }
            }
            let after = before + together.len();
            // The next class begins where another of the equal parts is reached.
            if after < runs && (discrete || after * most / runs > before * most / runs) {
                class += 1;
            }
            before = after;
        }
        (class > 0).then_some(Self { class_of_run, count: class as usize + 1 })
    }

    /// How many classes.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// Share of the variance of a measure that the parameter explains, from the variance between the classes less the part
    /// that the scatter inside them brings into their means,
    ///
    /// $$ \hat S = \frac{\sum_m n_m \bar y_m^2 - \sum_m (1 - n_m / n) s_m^2}{\sum_i y_i^2}, \quad \sum_i y_i = 0, $$
    ///
    /// limited to [0, 1]. For classes of equal size this is Kelley's $\varepsilon^2$, and without the second sum his $\eta^2$.
    ///
    /// The standard error is that of the mean of the influences of the runs, which must be independent,
    ///
    /// $$ (2 y_i \bar y_m - \bar y_m^2 - \hat S y_i^2) / \operatorname{Var}(y). $$
    ///
    /// Measured with `oracles/make_statistics.py --simulate` on the Ishigami function (shares 0.3139, 0.4424, 0):
    ///
    /// - Independent runs and Latin hypercubes, 128 to 8192 runs: the standard error is 0.88 to 1.2 times the scatter of the
    ///   estimate for the first two shares and 1.2 to 1.45 times for the third. The second, a wave of two periods, comes out
    ///   0.058 too low in 11 classes (128 runs), 0.006 in 32 (1024 runs).
    /// - Scrambled Sobol' sequence of 1024 runs: 0.021 to 0.031 too low, which is the correction. On so even a sample the
    ///   other parameters hardly scatter the means of the classes, and [`uncorrected`](Share::uncorrected) is right; where
    ///   noise drawn independently for each run (turbulence, sensors) scatters them, the correction is due again.
    ///
    /// `None` for a column of another length than the parameter's, a constant, and values that are not finite.
    ///
    /// # Source
    /// T. L. Kelley, *An unbiased correlation ratio measure*, Proceedings of the National Academy of Sciences 21 (1935);
    /// S. Da Veiga, F. Gamboa, *Efficient estimation of sensitivity indices*, Journal of Nonparametric Statistics 25 (2013),
    /// for the influence.
    #[must_use]
    pub fn share_of(&self, measure: &[f64]) -> Option<Share> {
        if measure.len() != self.class_of_run.len() {
            return None;
        }
        let moments = Moments::of(measure)?;
        let deviation = moments.standard_deviation.filter(|&deviation| deviation > 0.0)?;
        let runs = || {
            let standardised = measure.iter().map(|value| (value - moments.mean) / deviation);
            self.class_of_run.iter().map(|&class| class as usize).zip(standardised)
        };
        let mut groups = vec![Group::default(); self.count];
        for (class, value) in runs() {
            if let Some(group) = groups.get_mut(class) {
                group.add(value);
            }
        }
        let n = measure.len() as f64;
        // Sum of the squares of standardised values.
        let all = n - 1.0;
        let between: f64 = groups.iter().map(|group| group.sum * group.mean()).sum();
        let uncorrected = (between / all).clamp(0.0, 1.0);
        let fraction = ((between - scatter_of_means(&groups, n)) / all).clamp(0.0, 1.0);
        let influences = runs().map(|(class, value)| {
            let mean = groups.get(class).map_or(0.0, Group::mean);
            (2.0 * value - mean) * mean - fraction * value * value
        });
        let standard_error = deviation_of(influences) / all * n.sqrt();
        Some(Share { fraction, uncorrected, standard_error, classes: self.count })
    }
}

impl Classes {
    /// The chance of ranks of a measure that differ as much between the classes, or more, where the parameter does nothing:
    /// that of a ratio of variances, by the beta distribution of $\eta^2$, and not less than where runs change places and tell
    /// the same.
    ///
    /// Ranks, because one far value would make any class that it falls into explain everything. Classes of few runs, and a
    /// measure that is nearly always the same (a flight fails or does not), can be put together in few ways, of which the beta
    /// distribution knows nothing: with 3 of 100 000 flights failed, two of them are in one class once in a hundred times.
    ///
    /// `None` as for [`Classes::share_of`].
    ///
    /// # Source
    /// W. H. Kruskal, W. A. Wallis, *Use of ranks in one-criterion variance analysis*, Journal of the American Statistical
    /// Association 47 (1952); D. L. Wallace, *Simplified beta-approximations to the Kruskal-Wallis H test*, the same 54 (1959).
    /// The least chances are counted out; twice the second, for what is a little more extreme, is this project's.
    #[must_use]
    pub fn chance_of(&self, ranks: &[f64]) -> Option<f64> {
        let explained = self.share_of(ranks)?.uncorrected;
        let (classes, n) = (self.count as f64, ranks.len() as f64);
        let [a, b] = [(classes - 1.0) / 2.0, (n - classes) / 2.0];
        let chance = beta::at_most(b, a, (1.0 - explained, explained));
        if chance > RARE {
            return Some(chance);
        }
        let order = ordered(ranks);
        let often = equal(&order).max_by_key(|it| it.len())?;
        // Of each class how many runs there are, and how many of them do not have the most frequent value.
        let mut sizes = vec![(0, 0); self.count];
        for class in &self.class_of_run {
            sizes.get_mut(*class as usize)?.0 += 1;
        }
        let mut least = libm::exp(least_of_sizes(&sizes));
        if 2 * often.len() >= ranks.len() {
            for (class, rank) in self.class_of_run.iter().zip(ranks) {
                let is_other = often.first().is_none_or(|it| it.0.total_cmp(rank).is_ne());
                sizes.get_mut(*class as usize)?.1 += usize::from(is_other);
            }
            least = least.max(2.0 * libm::exp(least_of_two(&sizes)));
        }
        Some(chance.max(least).min(1.0))
    }
}

/// A chance beyond which nobody asks how many ways there are.
const RARE: f64 = 0.1;

/// Logarithm of the chance that the classes are these, where those of one size may change places.
fn least_of_sizes(classes: &[(usize, usize)]) -> f64 {
    let runs = classes.iter().map(|it| it.0).sum();
    let inside: f64 = classes.iter().map(|it| factorial(it.0)).sum();
    inside - factorial(runs) + alike(classes.iter().map(|it| it.0))
}

/// Logarithm of the chance that runs with another value than the most frequent one are spread over the classes as they are,
/// where classes of one size may change places.
fn least_of_two(classes: &[(usize, usize)]) -> f64 {
    let ways = |of: usize, some: usize| factorial(of) - factorial(some) - factorial(of - some);
    let (runs, others) = classes.iter().fold((0, 0), |sum, it| (sum.0 + it.0, sum.1 + it.1));
    let spread: f64 = classes.iter().map(|it| ways(it.0, it.1)).sum();
    let places = alike(classes.iter().map(|it| it.0)) - alike(classes.iter().copied());
    spread - ways(runs, others) + places
}

/// Logarithm of the number of ways in which those that are alike may change places.
fn alike<T: Ord>(all: impl Iterator<Item = T>) -> f64 {
    let mut counts = BTreeMap::new();
    all.for_each(|it| *counts.entry(it).or_insert(0) += 1);
    counts.into_values().map(factorial).sum()
}

/// Logarithm of n!.
fn factorial(n: usize) -> f64 {
    libm::lgamma(n as f64 + 1.0)
}

/// Standardised values of a measure in one class.
#[derive(Clone, Copy, Debug, Default)]
struct Group {
    count: f64,
    sum: f64,
    squares: f64,
}

impl Group {
    fn add(&mut self, value: f64) {
        self.count += 1.0;
        self.sum += value;
        self.squares += value * value;
    }

    fn mean(&self) -> f64 {
        self.sum / self.count
    }

    /// Sum of the squares about the mean of the class.
    fn inside(&self) -> f64 {
        (self.squares - self.sum * self.mean()).max(0.0)
    }
}

/// What the scatter inside the classes contributes on average to the sum of squares between them.
fn scatter_of_means(groups: &[Group], n: f64) -> f64 {
    // A class of one run shows no scatter of its own; it is given that of the others.
    let free: f64 = groups.iter().map(|group| group.count - 1.0).sum();
    let pooled = groups.iter().map(Group::inside).sum::<f64>() / free;
    let scatter = |group: &Group| {
        let variance =
            if group.count > 1.0 { group.inside() / (group.count - 1.0) } else { pooled };
        (1.0 - group.count / n) * variance
    };
    groups.iter().map(scatter).sum()
}

/// Standard deviation about the mean, over n.
fn deviation_of(values: impl Iterator<Item = f64>) -> f64 {
    let (mut n, mut mean, mut squares) = (0.0, 0.0, 0.0);
    for value in values {
        n += 1.0;
        let off = value - mean;
        mean += off / n;
        squares += off * (value - mean);
    }
    (squares / n).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(runs: u32, value: impl Fn(u32) -> f64) -> Vec<f64> {
        (0..runs).map(value).collect()
    }

    #[test]
    fn a_measure_that_a_discrete_parameter_decides_is_explained_in_full() {
        let parameter = column(100, |run| f64::from(run % 5));
        let measure = column(100, |run| f64::from((run % 5) * (run % 5)));
        let share = first_order(&parameter, &measure).expect("a share");
        assert!((share.fraction - 1.0).abs() < 1e-14 && share.standard_error < 1e-14, "{share:?}");
        assert_eq!(share.classes, 5);
    }

    /// A straight line over 10⁴ runs in 100 classes: the variance inside a class is 1e-4 of the whole.
    #[test]
    fn a_smooth_curve_loses_no_more_than_the_width_of_the_classes() {
        let line = column(10_000, f64::from);
        let share = first_order(&line, &line).expect("a share");
        assert!((share.fraction - (1.0 - 1e-4)).abs() < 1e-5, "{share:?}");
        assert_eq!(share.classes, 100);
    }

    /// Two classes, 0 0 1 1 .. against 0 1 0 1 ..: the means of the classes agree, the raw share is 0 and the corrected below.
    #[test]
    fn a_share_is_never_below_zero() {
        let parameter = column(64, |run| f64::from(run / 2 % 2));
        let measure = column(64, |run| f64::from(run % 2));
        assert_eq!(first_order(&parameter, &measure).expect("a share").fraction, 0.0);
    }

    /// Kelley's ε² by hand: 8 runs at each of two values, measure (0, 2) four times each against (1, 3): between 16/4 = 4,
    /// inside 16, η² = 4/20, ε² = (4 − 16/14) / 20 = 1/7.
    #[test]
    fn two_equal_classes_give_kelleys_epsilon_squared() {
        let parameter = column(16, |run| f64::from(run / 8));
        let measure = column(16, |run| f64::from(run % 2 * 2 + run / 8));
        let share = first_order(&parameter, &measure).expect("a share");
        assert!(
            (share.fraction - 1.0 / 7.0).abs() < 1e-14 && (share.uncorrected - 0.2).abs() < 1e-14,
            "{share:?}"
        );
    }

    #[test]
    fn equal_values_stay_in_one_class() {
        // Half of the runs at one value, the others spread: 6 of 10 classes are left.
        let parameter = column(100, |run| f64::from(run.max(50)));
        let classes = Classes::of(&parameter).expect("classes");
        assert!((0..=50).all(|run| classes.class_of_run.get(run) == Some(&0)));
        assert_eq!(classes.count(), 6);
    }

    #[test]
    fn a_value_that_occurs_once_is_a_class_too() {
        let parameter = column(50, |run| f64::from(run.min(1)));
        let measure = column(50, |run| if run == 0 { 100.0 } else { f64::from(run % 2) });
        let share = first_order(&parameter, &measure).expect("a share");
        assert!(share.fraction > 0.99 && share.fraction < 1.0, "{share:?}");
    }

    #[test]
    fn columns_that_say_nothing_have_no_share() {
        let line = column(40, f64::from);
        let mut holed = line.clone();
        holed[7] = f64::NAN;
        for (parameter, measure) in [
            (line.clone(), vec![1.0; 40]),
            (vec![1.0; 40], line.clone()),
            (line.clone(), line[1..].to_vec()),
            (line[..15].to_vec(), line[..15].to_vec()),
            (line.clone(), holed.clone()),
            (holed.clone(), line.clone()),
        ] {
            assert_eq!(first_order(&parameter, &measure), None);
        }
    }
}

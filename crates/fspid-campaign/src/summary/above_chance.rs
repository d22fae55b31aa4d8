//! Which shares of the variance are more than chance, of all that are asked together.

use super::data::{ControllerSummary, Influence, Sensitivity};

/// Least share of the variance that is named.
pub(crate) const LEAST_SHARE: f64 = 0.01;
/// The chance that any share at all is named where no parameter does anything.
const DOUBT: f64 = 0.05;

/// The shares of a controller that are more than chance. Every measure is asked about every parameter: at two standard errors
/// each, a table of a hundred shares names some parameter that does nothing nearly always.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AboveChance {
    /// How many shares are asked.
    pub(crate) asked: usize,
    /// How many of them are named.
    pub(crate) named: usize,
    /// The largest p-value that is more than chance; below 0 where none is.
    most: f64,
}

impl AboveChance {
    pub(crate) fn of(controller: &ControllerSummary) -> Self {
        Self::among(&controller.sensitivities)
    }

    /// By Holm's correction for all of them.
    fn among(sensitivities: &[Sensitivity]) -> Self {
        let all = || sensitivities.iter().flat_map(|it| &it.influences);
        let mut chances: Vec<f64> = all().filter_map(|it| it.p).collect();
        chances.sort_by(f64::total_cmp);
        let asked = chances.len();
        let is_sure = |(rank, p): &(usize, &f64)| (asked - rank) as f64 * **p <= DOUBT;
        let most = chances.iter().enumerate().take_while(is_sure).last().map_or(-1.0, |it| *it.1);
        let mut found = Self { asked, named: 0, most };
        found.named = all().filter(|it| found.names(it).is_some()).count();
        found
    }

    /// The share of an influence that is more than chance, and large enough to be named.
    pub(crate) fn names(&self, influence: &Influence) -> Option<f64> {
        let (share, p) = (influence.share?.fraction, influence.p?);
        (share >= LEAST_SHARE && p <= self.most).then_some(share)
    }

    /// How many of how many.
    pub(crate) fn in_words(&self) -> String {
        format!("{} of {} shares are above chance, asked together at 95 %", self.named, self.asked)
    }
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;
    use crate::statistics::rank::ranks;
    use crate::statistics::share::Classes;
    use crate::summary::SensitivityTarget;

    /// Numbers on [0, 1), each turned into another.
    fn column(random: &mut ChaCha8Rng, runs: usize, value: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut uniform = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        (0..runs).map(|_| value(uniform())).collect()
    }

    fn sensitivity(measure: &[f64], parameters: &[Vec<f64>]) -> Sensitivity {
        let ranks = ranks(measure);
        let influence = |values: &Vec<f64>| {
            let classes = Classes::of(values);
            let share = classes.as_ref().and_then(|it| it.share_of(measure));
            let p = classes.as_ref().and_then(|it| it.chance_of(&ranks));
            Influence { parameter: "x".to_owned(), correlation: None, share, p }
        };
        let runs = measure.len() as u64;
        Sensitivity {
            of: SensitivityTarget::Failure,
            used: runs,
            runs_used: runs,
            runs,
            influences: parameters.iter().map(influence).collect(),
        }
    }

    /// Parameters as dispersions draw them: even numbers, a choice of two, one of three of which two are rare, seeds.
    fn parameters(random: &mut ChaCha8Rng, runs: usize) -> Vec<Vec<f64>> {
        let choice = |x: f64| if x < 0.8 { 0.5 } else { 1.5 };
        let rare = |x: f64| if x < 0.9 { 0.0 } else { libm::floor(20.0 * x) };
        let even = [0; 3].map(|_| column(random, runs, |x| x));
        let [choice, rare] = [column(random, runs, choice), column(random, runs, rare)];
        even.into_iter()
            .chain([choice, rare, column(random, runs, |x| libm::floor(1e12 * x))])
            .collect()
    }

    /// Measures of twenty kinds: even, far-tailed, counted, mostly zero.
    fn measures(random: &mut ChaCha8Rng, runs: usize) -> Vec<Vec<f64>> {
        let far = |x: f64| 1.0 / (1.0 - x);
        let zeros = |x: f64| if x < 0.9 { 0.0 } else { x };
        let kinds: [fn(f64) -> f64; 3] = [|x| x, far, zeros];
        let mut all: Vec<Vec<f64>> = kinds
            .into_iter()
            .flat_map(|kind| [kind; 5])
            .map(|it| column(random, runs, it))
            .collect();
        for share in [0.05, 0.1, 0.2, 0.4, 0.5] {
            all.push(column(random, runs, |x| if x < share { 1.0 } else { 0.0 }));
        }
        all
    }

    /// At two standard errors each one of these tables in two named a parameter that does nothing, of few runs nearly all.
    #[test]
    fn a_table_of_parameters_without_any_influence_names_one_in_a_twentieth_of_campaigns_at_most() {
        const TABLES: usize = 400;
        for runs in [16, 20, 30, 50, 100] {
            let mut random = ChaCha8Rng::seed_from_u64(runs as u64);
            let mut naming = 0;
            for _ in 0..TABLES {
                let parameters = parameters(&mut random, runs);
                let all = measures(&mut random, runs);
                let all: Vec<Sensitivity> =
                    all.iter().map(|it| sensitivity(it, &parameters)).collect();
                naming += usize::from(AboveChance::among(&all).named > 0);
            }
            // A twentieth is 20, and three standard errors are 13.
            assert!(naming <= 33, "{runs} runs: {naming} of {TABLES}");
        }
    }

    #[test]
    fn a_parameter_that_does_much_is_named_among_many_that_do_nothing() {
        for runs in [30, 100] {
            let mut random = ChaCha8Rng::seed_from_u64(7);
            let mut naming = 0;
            for _ in 0..100 {
                let parameters = parameters(&mut random, runs);
                let mut measures = measures(&mut random, runs);
                // Nine tenths of the variance are the first parameter's.
                let noise = column(&mut random, runs, |x| x / 3.0);
                measures[0] = parameters[0].iter().zip(noise).map(|(x, noise)| x + noise).collect();
                let all: Vec<Sensitivity> =
                    measures.iter().map(|it| sensitivity(it, &parameters)).collect();
                let found = AboveChance::among(&all);
                naming += usize::from(found.names(&all[0].influences[0]).is_some());
            }
            assert!(naming >= 90, "{runs} runs: {naming} of 100");
        }
    }
}

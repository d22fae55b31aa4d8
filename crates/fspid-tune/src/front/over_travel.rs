//! Error over travel: a line for each controller through the means of its rungs, with a band around it, and the limit below.
//!
//! A point is the mean over cases and tunings of error and travel on a rung. The band has a part for cases and one for seeds,
//! as for differences ([`joint`](super::joint)); as a line is no mean itself, the values of a part are what it is without each
//! case, or each seed, weighed so that their scatter is that of a mean (Tukey's pseudo-values). It holds all along the line,
//! and for all lines together. How hard a case is for everybody is no difference between controllers and would make every band as wide
//! as cases differ, so that it is taken out: values of a case are divided by their mean over all tuned controllers, rungs and
//! seeds, and what that makes too narrow is given back (Cousineau's normalisation with Morey's correction).
//!
//! # Source
//! D. Cousineau, *Confidence intervals in within-subject designs*, Tutorials in Quantitative Methods for Psychology 1 (2005)
//! 42; R. D. Morey, *Confidence intervals from normalized data: a correction to Cousineau (2005)*, the same 4 (2008) 61. R. G.
//! Miller, *The jackknife — a review*, Biometrika 61 (1974) 1.

use super::curves::Curve;
use super::joint::{Along, FEWEST_CASES, FEWEST_SEEDS, Means, PLACES};
use super::{FrontOutcome, Rung};
use crate::contest::{Judged, Quantity};

/// Error over travel of one controller, or the limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Name of the controller; none of the limit.
    pub controller: Option<String>,
    /// True for a controller that is tuned at each rung, and for the limit.
    pub is_tuned: bool,
    /// Mean travel, deg, and mean error, deg s, of each rung.
    pub points: Vec<(f64, f64)>,
    /// Lower and upper end of the error, deg s, at travels along the line, deg; empty with fewer than three seeds
    /// or six cases, and of the limit, which is proved.
    pub band: Vec<(f64, [f64; 2])>,
}

/// The lines of all controllers, and that of the limit last; none where no case is common to all.
pub(super) fn lines(outcome: &FrontOutcome) -> Vec<Line> {
    let cases = common(outcome);
    let Some(first) = outcome.rungs.first().map(|rung| &rung.outcome.judged) else {
        return Vec::new();
    };
    if cases.is_empty() {
        return Vec::new();
    }
    let all: Vec<(bool, Values)> = first
        .contestants
        .iter()
        .enumerate()
        .map(|(place, it)| (it.is_tuned, Values::of(&outcome.rungs, place, &cases)))
        .collect();
    let tuned: Vec<&Values> = all.iter().filter(|(tuned, _)| *tuned).map(|(_, it)| it).collect();
    let hardness = Hardness::of(&tuned);
    let controllers = first.contestants.iter().zip(&all).map(|(it, (is_tuned, values))| Line {
        controller: Some(it.name.clone()),
        is_tuned: *is_tuned,
        points: values.as_it_is(),
        band: if *is_tuned { values.band(&hardness) } else { Vec::new() },
    });
    let mut lines: Vec<Line> = controllers.collect();
    let points = outcome.rungs.iter().filter_map(|rung| limit_of(rung, &cases)).collect();
    lines.push(Line { controller: None, is_tuned: true, points, band: Vec::new() });
    lines
}

/// Cases with a limit of which nobody lost a flight on any rung.
pub(super) fn common(outcome: &FrontOutcome) -> Vec<usize> {
    let Some(first) = outcome.rungs.first() else {
        return Vec::new();
    };
    let kept = |rung: &Rung, case: usize| {
        let judged = &rung.outcome.judged;
        let all = rung.near.controllers.iter();
        let has_limit =
            all.clone().all(|(_, shares)| shares.get(case).copied().flatten().is_some());
        has_limit && !judged.kept(judged.contestants.iter(), &[case]).is_empty()
    };
    let cases = first.outcome.judged.all();
    cases.into_iter().filter(|case| outcome.rungs.iter().all(|rung| kept(rung, *case))).collect()
}

/// Mean travel of the best design of the controller compared with, deg, and the mean proved limit of some cases there, deg s.
fn limit_of(rung: &Rung, cases: &[usize]) -> Option<(f64, f64)> {
    let judged = &rung.outcome.judged;
    let contestant = judged.contestants.get(judged.against)?;
    let design = contestant.designs.get(Judged::best(contestant))?;
    let (_, shares) = rung.near.controllers.get(judged.against)?;
    let (mut sum, mut weights) = (0.0, 0.0);
    for &case in cases {
        let weight = judged.cases.get(case)?.weight;
        let error = judged.mean(design, &[case], Quantity::ERROR)?;
        sum += weight * error * shares.get(case).copied().flatten()?;
        weights += weight;
    }
    Some((judged.mean(design, cases, Quantity::ACTIVITY)?, sum / weights))
}

/// Travel and error of a controller: by rung, seed and case.
struct Values {
    weights: Vec<f64>,
    rungs: Vec<Vec<Vec<[f64; 2]>>>,
}

impl Values {
    fn of(rungs: &[Rung], contestant: usize, cases: &[usize]) -> Self {
        let weight =
            |judged: &Judged, case: usize| judged.cases.get(case).map_or(0.0, |it| it.weight);
        let first = rungs.first().map(|rung| &rung.outcome.judged);
        let weights = first.map_or(Vec::new(), |it| cases.iter().map(|c| weight(it, *c)).collect());
        let of_rung = |rung: &Rung| {
            let judged = &rung.outcome.judged;
            let designs = judged.contestants.get(contestant).map_or(&[][..], |it| &it.designs);
            let both = |design, case| {
                [Quantity::ACTIVITY, Quantity::ERROR]
                    .map(|it| judged.value(design, case, it).unwrap_or(f64::NAN))
            };
            designs.iter().map(|it| cases.iter().map(|&case| both(it, case)).collect()).collect()
        };
        Self { weights, rungs: rungs.iter().map(of_rung).collect() }
    }

    /// How many tunings there are on every rung.
    fn seeds(&self) -> usize {
        self.rungs.iter().map(Vec::len).min().unwrap_or(0)
    }

    /// Means of each rung over some seeds and cases; any may be there more than once.
    fn means(&self, seeds: &[usize], cases: &[usize]) -> Vec<(f64, f64)> {
        let whole: f64 =
            cases.iter().map(|&case| self.weights[case]).sum::<f64>() * seeds.len() as f64;
        let mean = |rung: &Vec<Vec<[f64; 2]>>, which: usize| {
            let of_seed = |&seed: &usize| -> f64 {
                cases.iter().map(|&case| self.weights[case] * rung[seed][case][which]).sum()
            };
            seeds.iter().map(of_seed).sum::<f64>() / whole
        };
        self.rungs.iter().map(|rung| (mean(rung, 0), mean(rung, 1))).collect()
    }

    fn as_it_is(&self) -> Vec<(f64, f64)> {
        let seeds: Vec<usize> = (0..self.seeds()).collect();
        let cases: Vec<usize> = (0..self.weights.len()).collect();
        self.means(&seeds, &cases)
    }

    /// The same without how hard each case is for everybody.
    fn without(&self, hardness: &Hardness) -> Self {
        let of_case = |(case, values): (usize, &[f64; 2])| {
            std::array::from_fn(|which| values[which] / hardness.factors[case][which])
        };
        let of_seed = |seed: &Vec<[f64; 2]>| seed.iter().enumerate().map(of_case).collect();
        let of_rung = |rung: &Vec<Vec<[f64; 2]>>| rung.iter().map(of_seed).collect();
        Self { weights: self.weights.clone(), rungs: self.rungs.iter().map(of_rung).collect() }
    }

    /// What the line is without each case, and without each seed, so that the mean of each list is near the middle and its
    /// scatter that of what was drawn; none where what is left has no line.
    fn pseudo_values(
        &self,
        middle: &Along,
        along: &dyn Fn(&Curve) -> Along,
    ) -> Option<Vec<Vec<Along>>> {
        let (seeds, cases) = (self.seeds(), self.weights.len());
        let but = |count: usize, one: usize| (0..count).filter(|it| *it != one).collect::<Vec<_>>();
        let line = |seeds: &[usize], cases: &[usize]| {
            Some(along(&Curve::through(self.means(seeds, cases).into_iter())?))
        };
        let (all_seeds, all_cases) = (but(seeds, seeds), but(cases, cases));
        let of_case = |one: usize| line(&all_seeds, &but(cases, one));
        let of_seed = |one: usize| line(&but(seeds, one), &all_cases);
        let part = |count: usize, of: &dyn Fn(usize) -> Option<Along>| -> Option<Vec<Along>> {
            let all = count as f64;
            let pseudo = |without: Along| {
                std::array::from_fn(|it| all * middle[it] - (all - 1.0) * without[it])
            };
            (0..count).map(|one| of(one).map(pseudo)).collect()
        };
        Some(vec![part(cases, &of_case)?, part(seeds, &of_seed)?])
    }

    /// The band around the line through its points, which holds together with those of all other tuned controllers.
    fn band(&self, hardness: &Hardness) -> Vec<(f64, [f64; 2])> {
        let (seeds, cases) = (self.seeds(), self.weights.len());
        let even = self.without(hardness);
        let lines = [self, &even].map(|it| Curve::through(it.as_it_is().into_iter()));
        let [Some(line), Some(even_line)] = lines else {
            return Vec::new();
        };
        if seeds < FEWEST_SEEDS || cases < FEWEST_CASES {
            return Vec::new();
        }
        let places = |curve: &Curve| -> Along {
            let [least, most] = curve.range();
            std::array::from_fn(|it| least + (most - least) * it as f64 / (PLACES - 1) as f64)
        };
        let even_places = places(&even_line);
        let along = |curve: &Curve| even_places.map(|place| curve.at(place));
        let middle = along(&even_line);
        let Some(parts) = even.pseudo_values(&middle, &along) else {
            return Vec::new();
        };
        let ends = Means { middle, parts }.ends(hardness.controllers);
        let ends = |it: usize, travel: f64| {
            let off = |end: f64| hardness.correction() * (end - middle[it]);
            ends.each_ref().map(|side| libm::exp(line.at(travel) + off(side[it])))
        };
        let told = places(&line).into_iter().enumerate();
        told.map(|(it, travel)| (libm::exp(travel), ends(it, travel))).collect()
    }
}

/// How hard each case is for everybody: factors of travel and error, whose geometric mean over the cases is 1.
struct Hardness {
    factors: Vec<[f64; 2]>,
    /// How many controllers that is of.
    controllers: usize,
}

impl Hardness {
    fn of(tuned: &[&Values]) -> Self {
        let cases = tuned.first().map_or(0, |it| it.weights.len());
        let mean = |case: usize, which: usize| {
            let all = tuned.iter().flat_map(|it| it.rungs.iter().flatten());
            let logs: Vec<f64> = all.map(|seed| libm::log(seed[case][which])).collect();
            logs.iter().sum::<f64>() / logs.len() as f64
        };
        let means: Vec<[f64; 2]> = (0..cases).map(|case| [0, 1].map(|it| mean(case, it))).collect();
        let whole = [0, 1].map(|it| means.iter().map(|mean| mean[it]).sum::<f64>() / cases as f64);
        let factor = |mean: &[f64; 2]| std::array::from_fn(|it| libm::exp(mean[it] - whole[it]));
        Self { factors: means.iter().map(factor).collect(), controllers: tuned.len() }
    }

    /// Morey's: what taking the mean over so many controllers out of each case makes too narrow.
    fn correction(&self) -> f64 {
        let count = self.controllers.max(2) as f64;
        libm::sqrt(count / (count - 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::Draw;

    /// Two controllers on three rungs, with `seeds` tunings and eight cases of which each is twice as hard as the one before;
    /// noise of single cases and of tunings.
    fn values(seeds: usize, noise: f64) -> [Values; 2] {
        let mut random = Draw::of(3, 0);
        [0, 1].map(|_| {
            let mut unit = || random.below(2001) as f64 / 1000.0 - 1.0;
            let of_case: Vec<f64> = (0..8).map(|_| 1.0 + noise * unit()).collect();
            let of_seed: Vec<f64> = (0..seeds).map(|_| 1.0 + 0.2 * noise * unit()).collect();
            let value = |rung: usize, seed: usize, case: usize| {
                let travel = [8.0, 12.0, 20.0][rung];
                let hard = f64::from(1_u32 << case);
                [travel, hard * 40.0 / travel * of_case[case] * of_seed[seed]]
            };
            let of_rung =
                |rung| (0..seeds).map(|s| (0..8).map(|c| value(rung, s, c)).collect()).collect();
            Values { weights: vec![1.0; 8], rungs: (0..3).map(of_rung).collect() }
        })
    }

    #[test]
    fn a_band_lies_around_its_line_and_is_as_wide_as_controllers_differ_between_cases() {
        let width = |noise| {
            let both = values(3, noise);
            let line = Curve::through(both[0].as_it_is().into_iter()).expect("a line");
            let band = both[0].band(&Hardness::of(&both.each_ref()));
            assert_eq!(band.len(), PLACES);
            for (travel, [lower, upper]) in &band {
                let middle = libm::exp(line.at(libm::log(*travel)));
                assert!(lower < &middle && &middle < upper, "{lower} {middle} {upper}");
            }
            libm::log(band[0].1[1] / band[0].1[0])
        };
        // Some three standard deviations either way of a mean over eight cases, uniform with a deviation of 0.1 / √3: that
        // the hardest case is 128 times as hard as the easiest is seen in neither.
        assert!((0.05..0.3).contains(&width(0.1)), "{}", width(0.1));
        let ratio = width(0.2) / width(0.1);
        assert!((1.7..2.4).contains(&ratio), "{ratio}");
    }

    #[test]
    fn one_tuning_and_two_have_no_band() {
        for seeds in [1, 2] {
            let both = values(seeds, 0.1);
            assert!(both[0].band(&Hardness::of(&both.each_ref())).is_empty());
        }
    }
}

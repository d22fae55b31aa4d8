//! Statistics against values made by `oracles/make_statistics.py`, closed forms, and exact sums.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use std::f64::consts::PI;
use std::path::Path;

use fspid_campaign::statistics::{Moments, Sorted, binomial, quantile, rank, share};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn rows(file: &str) -> Vec<Vec<String>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(file);
    let text = std::fs::read_to_string(path).expect("a reference file");
    text.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

fn number(word: &str) -> f64 {
    word.parse().expect("a number")
}

fn column(words: &str) -> Vec<f64> {
    words.split(' ').map(number).collect()
}

fn relative(found: f64, expected: f64) -> f64 {
    if found == expected { 0.0 } else { (found / expected - 1.0).abs() }
}

/// What the documentation of `binomial` promises; found 1.6e-15 at worst.
const BOUND_TOL: f64 = 1e-14;

#[test]
fn exact_bounds_of_a_probability_agree_with_sixty_digits() {
    let mut worst = (0.0, String::new());
    for row in rows("clopper_pearson.csv") {
        let (failures, runs) = (row[0].parse().expect("failures"), row[1].parse().expect("runs"));
        let confidence = number(&row[2]);
        let [lower, upper] =
            binomial::clopper_pearson(failures, runs, confidence).expect("an interval");
        let upper_bound = binomial::upper_bound(failures, runs, confidence).expect("a bound");
        let lower_bound = binomial::lower_bound(failures, runs, confidence).expect("a bound");
        for (found, expected) in [lower, upper, upper_bound, lower_bound].iter().zip(&row[3..]) {
            let off = relative(*found, number(expected));
            if off > worst.0 {
                worst = (off, format!("{row:?}: {found}"));
            }
        }
    }
    assert!(worst.0 < BOUND_TOL, "{worst:?}");
}

/// The probability that the interval holds the truth, summed over all outcomes, each probability from the one before.
fn coverage(runs: u64, confidence: f64, truth: f64) -> f64 {
    let mut probability = libm::pow(1.0 - truth, runs as f64);
    let mut sum = 0.0;
    for failures in 0..=runs {
        let [lower, upper] =
            binomial::clopper_pearson(failures, runs, confidence).expect("an interval");
        if lower <= truth && truth <= upper {
            sum += probability;
        }
        probability *= (runs - failures) as f64 / (failures + 1) as f64 * truth / (1.0 - truth);
    }
    sum
}

#[test]
fn an_exact_interval_holds_the_truth_at_least_as_often_as_it_says() {
    for runs in [1, 2, 7, 20, 60] {
        for confidence in [0.5, 0.95, 0.999] {
            let least = (1..40)
                .map(|step| coverage(runs, confidence, f64::from(step) / 40.0))
                .fold(f64::INFINITY, f64::min);
            // 60 rounded products.
            assert!(least > confidence - 1e-13, "{runs} runs, {confidence}: {least}");
        }
    }
}

#[test]
fn quantiles_agree_with_numpy() {
    let columns: Vec<Sorted> =
        rows("moments.csv").iter().map(|row| column(&row[0]).into()).collect();
    for row in rows("quantiles.csv") {
        let index: usize = row[0].parse().expect("an index");
        let found = quantile::quantile(&columns[index], number(&row[1])).expect("a quantile");
        let size =
            columns[index].values().iter().fold(0.0, |size: f64, value| size.max(value.abs()));
        // Both round the place, the difference and the sum.
        assert!((found - number(&row[2])).abs() <= 4.0 * f64::EPSILON * size, "{row:?}: {found}");
    }
}

#[test]
fn ranks_of_the_ends_of_a_quantile_agree_with_exact_tails() {
    for row in rows("order_ranks.csv") {
        let runs: u32 = row[0].parse().expect("runs");
        let counted: Sorted = (1..=runs).map(f64::from).collect::<Vec<_>>().into();
        let found =
            quantile::interval(&counted, number(&row[1]), number(&row[2])).expect("an interval");
        let expected = [&row[3], &row[4]].map(|rank| rank.parse::<f64>().ok());
        assert_eq!([found.lower, found.upper], expected, "{row:?}");
    }
}

#[test]
fn moments_agree_with_exact_fractions() {
    for row in rows("moments.csv") {
        let found = Moments::of(&column(&row[0])).expect("moments");
        // Compensated sums leave the rounding of the terms and of the result.
        let size = found.minimum.abs().max(found.maximum.abs());
        assert!((found.mean - number(&row[1])).abs() <= f64::EPSILON * size, "{row:?}");
        match found.standard_deviation {
            Some(deviation) => assert!(
                relative(deviation, number(&row[2])) < 4.0 * f64::EPSILON,
                "{deviation} {row:?}"
            ),
            None => assert_eq!(row[2], ""),
        }
    }
}

#[test]
fn correlations_of_ranks_agree_with_scipy() {
    for row in rows("spearman.csv") {
        let (x, y) = (column(&row[0]), column(&row[1]));
        assert_eq!(rank::ranks(&x), column(&row[2]));
        let found = rank::spearman(&x, &y).expect("a correlation");
        assert!((found.coefficient - number(&row[3])).abs() < 1e-14, "{found:?}");
        let [lower, upper] = found.interval_95.expect("an interval");
        // As narrow as Bonett and Wright's where nothing says more.
        let [least, most] = [&row[4], &row[5]].map(|it| number(it));
        assert!(lower < least + 1e-14 && upper > most - 1e-14, "{found:?}");
        assert!(upper - lower < 2.0 * (most - least), "{found:?}");
    }
}

#[test]
fn shares_agree_with_the_adjusted_share_of_an_analysis_of_variance() {
    for row in rows("shares.csv") {
        let found = share::first_order(&column(&row[0]), &column(&row[1])).expect("a share");
        assert_eq!(found.classes.to_string(), row[2]);
        assert!((found.fraction - number(&row[3])).abs() < 1e-13, "{found:?}, not {}", row[3]);
    }
}

/// Uniform on [0, 1): the generator SplitMix64 of G. L. Steele, D. Lea, C. H. Flood (2014).
struct Uniform(u64);

impl Uniform {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Three parameters on [−π, π] and sin x₁ + 7 sin² x₂ + 0.1 x₃⁴ sin x₁.
fn ishigami(random: &mut Uniform, runs: usize) -> ([Vec<f64>; 3], Vec<f64>) {
    let parameters =
        [0; 3].map(|_| (0..runs).map(|_| PI * (2.0 * random.next() - 1.0)).collect::<Vec<_>>());
    let [a, b, c] = &parameters;
    let measure = (0..runs)
        .map(|run| {
            let (sine, other) = (libm::sin(a[run]), libm::sin(b[run]));
            sine + 7.0 * other * other + 0.1 * libm::pow(c[run], 4.0) * sine
        })
        .collect();
    (parameters, measure)
}

/// T. Ishigami, T. Homma (1990): the shares of the variance in closed form.
const ISHIGAMI: [f64; 3] = [0.3139, 0.4424, 0.0];

#[test]
fn shares_of_the_ishigami_function_are_those_in_closed_form() {
    let mut random = Uniform(1);
    for runs in [10_000, 100_000] {
        let (parameters, measure) = ishigami(&mut random, runs);
        for (parameter, expected) in parameters.iter().zip(ISHIGAMI) {
            let found = share::first_order(parameter, &measure).expect("a share");
            // Three standard errors, and what classes of this width hide of sin² over two periods: 4 (2π)² / 12 S / n.
            let tolerance = 3.0 * found.standard_error + 14.0 / runs as f64;
            assert!(
                (found.fraction - expected).abs() < tolerance,
                "{runs}: {found:?}, not {expected}"
            );
            // Found 0.0068, 0.0078 and 0.0026 at 10 000 runs in 300 simulations, and 1/√10 of it.
            assert!(found.standard_error < 0.9 / (runs as f64).sqrt(), "{found:?}");
        }
    }
}

#[test]
fn the_standard_error_of_a_share_is_the_scatter_of_the_estimate() {
    let (mut random, campaigns) = (Uniform(2), 200);
    let mut found = [const { Vec::new() }; 3];
    let mut stated = [0.0; 3];
    for _ in 0..campaigns {
        let (parameters, measure) = ishigami(&mut random, 1000);
        for (index, parameter) in parameters.iter().enumerate() {
            let share = share::first_order(parameter, &measure).expect("a share");
            found[index].push(share.fraction);
            stated[index] += share.standard_error / f64::from(campaigns);
        }
    }
    for (index, expected) in ISHIGAMI.iter().enumerate() {
        let moments = Moments::of(&found[index]).expect("moments");
        let scatter = moments.standard_deviation.expect("a scatter");
        // Of 200 campaigns the scatter is known to 5 %. The third share is 0, cut off at 0: stated too large, never too small.
        let ratio = stated[index] / scatter;
        assert!(ratio > 0.85 && (ratio < 1.15 || *expected == 0.0), "{expected}: {ratio}");
        // sin² over two periods in 31 classes: 0.006 too low.
        assert!((moments.mean - expected).abs() < 0.012, "{expected}: {}", moments.mean);
    }
}

/// Recorded on x86-64; another machine must find them too.
#[test]
fn the_same_numbers_give_the_same_bits_everywhere() {
    let (parameters, measure) = ishigami(&mut Uniform(3), 1000);
    let moments = Moments::of(&measure).expect("moments");
    let found = share::first_order(&parameters[0], &measure).expect("a share");
    let correlation = rank::spearman(&parameters[0], &measure).expect("a correlation");
    let [lower, upper] = binomial::clopper_pearson(17, 100_000, 0.95).expect("an interval");
    let values = [
        moments.mean,
        moments.standard_deviation.expect("a spread"),
        found.fraction,
        found.standard_error,
    ]
    .into_iter()
    .chain([correlation.coefficient, lower, upper])
    .chain(correlation.interval_95.expect("an interval"));
    let bits: Vec<String> = values.map(|value| format!("{:016x}", value.to_bits())).collect();
    assert_eq!(bits, RECORDED);
}

const RECORDED: [&str; 9] = [
    "400b4538b32e1f6c",
    "400dd029c5d2e955",
    "3fd3fa6fc806fab0",
    "3f96fb3f094eb8e5",
    "3fda4ca0f09a7909",
    "3f19f6140a5523b7",
    "3f31d64c3fcb2bee",
    "3fd6c5ac7e165601",
    "3fdda4eb3b96cd63",
];

/// The same cases every time.
fn repeatable() -> ProptestConfig {
    ProptestConfig {
        rng_seed: RngSeed::Fixed(20_261_120),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(repeatable())]

    #[test]
    fn bounds_rise_with_failures_and_fall_with_runs(failures in 0u64..500, more in 0u64..100_000, confidence in 0.01..0.9999f64) {
        let runs = failures + more;
        let [lower, upper] = binomial::clopper_pearson(failures, runs, confidence).expect("an interval");
        prop_assert!(0.0 <= lower && lower <= upper && upper <= 1.0);
        if runs > 0 {
            let estimate = failures as f64 / runs as f64;
            prop_assert!(lower <= estimate && estimate <= upper || confidence < 0.5);
        }
        let [next_lower, next_upper] = binomial::clopper_pearson(failures + 1, runs + 1, confidence).expect("an interval");
        prop_assert!(lower <= next_lower && upper <= next_upper);
        let [longer_lower, longer_upper] = binomial::clopper_pearson(failures, runs + 1, confidence).expect("an interval");
        prop_assert!(longer_lower <= lower && longer_upper <= upper);
        let wider = binomial::clopper_pearson(failures, runs, confidence + 5e-5).expect("an interval");
        prop_assert!(wider[0] <= lower && upper <= wider[1]);
    }

    #[test]
    fn a_quantile_lies_in_its_interval_and_rises_with_the_share(
        values in prop::collection::vec(-1e3..1e3f64, 1..80), share in 0.0..=1.0f64, confidence in 0.5..0.999f64,
    ) {
        let sorted = Sorted::of(&values);
        let found = quantile::quantile(&sorted, share).expect("a quantile");
        let interval = quantile::interval(&sorted, share, confidence).expect("an interval");
        prop_assert!(interval.lower.is_none_or(|lower| interval.upper.is_none_or(|upper| lower <= upper)));
        prop_assert!(quantile::quantile(&sorted, (share + 0.01).min(1.0)).expect("a quantile") >= found);
        let wider = quantile::interval(&sorted, share, confidence + 5e-4).expect("an interval");
        prop_assert!(wider.lower.is_none_or(|wide| interval.lower.is_some_and(|lower| wide <= lower)));
        prop_assert!(wider.upper.is_none_or(|wide| interval.upper.is_some_and(|upper| wide >= upper)));
    }

    #[test]
    fn ranks_do_not_change_with_the_shape_of_a_rising_curve(values in prop::collection::vec(-20i32..20, 0..60)) {
        let plain: Vec<f64> = values.iter().map(|&value| f64::from(value)).collect();
        let bent: Vec<f64> = plain.iter().map(|value| value * value * value).collect();
        let ranks = rank::ranks(&plain);
        prop_assert_eq!(&ranks, &rank::ranks(&bent));
        prop_assert_eq!(ranks.iter().sum::<f64>(), (values.len() * (values.len() + 1)) as f64 / 2.0);
    }
}

//! Distributions against their moments, quantiles and limits.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::*;

const COUNT: usize = 100_000;

/// Smallest coordinate that comes, and smaller ones still.
const SMALL: [f64; 4] = [1.110_223_024_625_156_5e-16, 5.551_115_123_125_783e-17, 1e-300, 5e-324];

/// Draws at random points.
fn draws(distribution: &Distribution, seed: u64) -> Vec<Vec<Draw>> {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let mut coordinate = || ((generator.next_u64() >> 12) as f64 + 0.5) / SEED_LIMIT as f64;
    let draw = |_| {
        let u: Vec<f64> = (0..distribution.dimensions()).map(|_| coordinate()).collect();
        let mut into = Vec::new();
        distribution.draw(&u, &mut into).unwrap();
        into
    };
    (0..COUNT).map(draw).collect()
}

fn number(draw: Draw) -> f64 {
    let Draw::Number(value) = draw else { panic!("{draw:?} is no number") };
    value
}

/// Numbers of one entry.
fn numbers(distribution: &Distribution, entry: usize, seed: u64) -> Vec<f64> {
    draws(distribution, seed).into_iter().map(|draw| number(draw[entry])).collect()
}

/// The only draw at a coordinate.
fn at(distribution: &Distribution, u: f64) -> Draw {
    let mut into = Vec::new();
    distribution.draw(&[u], &mut into).unwrap();
    assert_eq!(into.len(), 1);
    into[0]
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn variance(values: &[f64]) -> f64 {
    let mean = mean(values);
    values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / values.len() as f64
}

/// Mean, variance and quantiles within four standard errors; the fourth central moment over the
/// squared variance says how sure a variance is.
fn assert_like(values: &[f64], moments: [f64; 3], quantiles: &[(f64, f64)]) {
    let n = COUNT as f64;
    let [expected_mean, expected_variance, kurtosis] = moments;
    let error = (mean(values) - expected_mean).abs();
    assert!(error < 4.0 * libm::sqrt(expected_variance / n), "mean {}", mean(values));
    let error = (variance(values) / expected_variance - 1.0).abs();
    assert!(error < 4.0 * libm::sqrt((kurtosis - 1.0) / n), "variance {}", variance(values));
    for &(p, value) in quantiles {
        let share = values.iter().filter(|v| **v < value).count() as f64 / n;
        assert!((share - p).abs() < 4.0 * libm::sqrt(p * (1.0 - p) / n), "{p}: {share}");
    }
}

fn normal(mean: f64, deviation: f64, lower: Option<f64>, upper: Option<f64>) -> Normal {
    Normal::new(mean, deviation).unwrap().truncated(lower, upper).unwrap()
}

#[test]
fn normal_numbers_have_their_moments_and_quantiles() {
    let plain = Distribution::Normal(Normal::new(3.0, 0.5).unwrap());
    // Φ at -2, -1, 0, 0.5 and 3.
    let quantiles = [
        (0.022_750_131_948_179, 2.0),
        (0.158_655_253_931_457, 2.5),
        (0.5, 3.0),
        (0.691_462_461_274_013, 3.25),
        (0.998_650_101_968_37, 4.5),
    ];
    assert_like(&numbers(&plain, 0, 1), [3.0, 0.25, 3.0], &quantiles);
}

#[test]
fn truncated_normal_numbers_have_their_moments_and_quantiles() {
    // Between -1 and 1 standard deviations: P = 0.682689, variance 1 - 2φ(1)/P, fourth moment
    // 3 - 8φ(1)/P.
    let both = Distribution::Normal(normal(10.0, 2.0, Some(8.0), Some(12.0)));
    let ratio = 0.241_970_724_519_143 / 0.682_689_492_137_086;
    let spread = 1.0 - 2.0 * ratio;
    let kurtosis = (3.0 - 8.0 * ratio) / (spread * spread);
    let p = (0.308_537_538_725_987 - 0.158_655_253_931_457) / 0.682_689_492_137_086;
    let quantiles = [(p, 9.0), (0.5, 10.0), (1.0 - p, 11.0)];
    assert_like(&numbers(&both, 0, 2), [10.0, 4.0 * spread, kurtosis], &quantiles);
    // The upper half: moments of |z|.
    let half = Distribution::Normal(normal(0.0, 1.0, Some(0.0), None));
    let first = libm::sqrt(std::f64::consts::FRAC_2_PI);
    let spread = 1.0 - first * first;
    let fourth = 3.0 - 2.0 * first * first - 3.0 * first * first * first * first;
    let quantiles = [(0.682_689_492_137_086, 1.0), (0.954_499_736_103_642, 2.0)];
    let moments = [first, spread, fourth / (spread * spread)];
    assert_like(&numbers(&half, 0, 3), moments, &quantiles);
}

#[test]
fn truncated_quantiles_agree_with_sixty_digits_however_far_out_the_limits_are() {
    let mut compared = 0;
    for line in include_str!("../../tests/data/truncated_normal.csv").lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
        let [m, deviation, lower, upper, u, expected] = row[..] else { panic!("{line}") };
        let found = normal(m, deviation, Some(lower), Some(upper)).quantile(u);
        // Digits of the probabilities, 1e-14, over z; and those of the value.
        let tolerance = 1e-15 * (deviation + expected.abs());
        assert!((found - expected).abs() <= tolerance, "{line}: {found}");
        compared += 1;
    }
    assert_eq!(compared, 80);
}

#[test]
fn no_number_is_ever_beyond_its_limits() {
    let limits = [
        (0.0, 1.0, Some(8.0), Some(9.0)),
        (0.0, 1.0, Some(-37.0), Some(-36.9)),
        (0.0, 1.0, Some(37.0), None),
        (0.0, 1.0, None, Some(-37.0)),
        (0.0, 1.0, Some(-100.0), Some(100.0)),
        (0.1, 1e-3, Some(0.1), Some(0.1 + 1e-12)),
        (1e6, 1e-6, None, Some(1e6 - 1e-5)),
        (-5.0, 1e-300, Some(-6.0), Some(-4.0)),
        (0.3, 1e300, Some(0.0), Some(1e290)),
    ];
    for (m, deviation, lower, upper) in limits {
        let one = normal(m, deviation, lower, upper);
        let mut before = f64::NEG_INFINITY;
        let tails = SMALL.iter().rev().copied();
        let grid = (1..500).map(|k| f64::from(k) / 500.0);
        for u in tails.chain(grid).chain([1.0 - SMALL[0]]) {
            let value = one.quantile(u);
            assert!(value.is_finite() && value >= before, "{one:?} at {u}: {value}");
            assert!(lower.is_none_or(|lower| value >= lower), "{value}");
            assert!(upper.is_none_or(|upper| value <= upper), "{value}");
            before = value;
        }
    }
}

#[test]
fn uniform_numbers_have_their_moments_and_quantiles() {
    let uniform = Distribution::Uniform(Uniform::new(-1.0, 3.0).unwrap());
    let quantiles = [(0.25, 0.0), (0.5, 1.0), (0.99, 2.96)];
    assert_like(&numbers(&uniform, 0, 4), [1.0, 16.0 / 12.0, 1.8], &quantiles);
    assert_eq!(at(&uniform, 0.25), Draw::Number(0.0));
}

#[test]
fn logarithms_of_log_uniform_numbers_are_uniform_for_either_sign() {
    for sign in [1.0, -1.0] {
        let [lower, upper] = if sign > 0.0 { [0.01, 100.0] } else { [-100.0, -0.01] };
        let log_uniform = Distribution::LogUniform(LogUniform::new(lower, upper).unwrap());
        let logarithms: Vec<f64> =
            numbers(&log_uniform, 0, 5).into_iter().map(|v| libm::log10(v * sign)).collect();
        let quantiles = [(0.25, -1.0), (0.5, 0.0), (0.75, 1.0)];
        assert_like(&logarithms, [0.0, 16.0 / 12.0, 1.8], &quantiles);
        assert!((number(at(&log_uniform, 0.5)) - sign).abs() < 1e-15);
        assert!(number(at(&log_uniform, SMALL[0])) >= lower);
        assert!(number(at(&log_uniform, 1.0 - SMALL[0])) <= upper);
        assert!(number(at(&log_uniform, 0.2)) < number(at(&log_uniform, 0.3)));
    }
    // From the smallest normal number to the largest.
    let widest = LogUniform::new(f64::MIN_POSITIVE, f64::MAX).unwrap();
    let middle = libm::log10(widest.quantile(0.5));
    assert!((middle - 0.5 * (-307.652_655_568_588 + 308.254_715_559_917)).abs() < 1e-9);
    assert!(widest.quantile(1.0 - SMALL[0]) <= f64::MAX);
}

#[test]
fn a_choice_comes_in_proportion_to_its_weights() {
    let weights = [0.0, 2.0, 0.0, 1.0, 5.0, 0.0];
    for (weights, count) in [(Some(&weights[..]), 6), (None, 6)] {
        let choice = Distribution::Choice(Choice::new(count, weights).unwrap());
        let mut counts = [0_u32; 6];
        for draw in draws(&choice, 6) {
            let Draw::Index(index) = draw[0] else { panic!("{draw:?}") };
            counts[index] += 1;
        }
        for (index, found) in counts.into_iter().enumerate() {
            let p = weights.map_or(1.0 / 6.0, |weights| weights[index] / 8.0);
            let n = COUNT as f64;
            assert!((f64::from(found) - n * p).abs() <= 4.0 * libm::sqrt(n * p * (1.0 - p)));
        }
    }
}

#[test]
fn a_value_without_weight_never_comes_even_at_the_borders() {
    let choice = Distribution::Choice(Choice::new(4, Some(&[0.0, 1.0, 3.0, 0.0])).unwrap());
    for (u, index) in [(SMALL[3], 1), (0.25 - 1e-16, 1), (0.25, 2), (1.0 - SMALL[0], 2)] {
        assert_eq!(at(&choice, u), Draw::Index(index));
    }
    let tiny = Choice::new(3, Some(&[1.0, 1e-30, 0.0])).unwrap();
    assert_eq!(tiny.index(1.0 - SMALL[0]), 0);
    let even = Choice::new(3, None).unwrap();
    assert_eq!([even.index(SMALL[3]), even.index(1.0 - SMALL[0])], [0, 2]);
}

#[test]
fn seeds_are_the_digits_of_the_coordinate_and_differ_from_run_to_run() {
    assert_eq!(at(&Distribution::Seed, SMALL[0]), Draw::Seed(0));
    assert_eq!(at(&Distribution::Seed, 0.5), Draw::Seed(1 << 51));
    assert_eq!(at(&Distribution::Seed, 1.0 - SMALL[0]), Draw::Seed(SEED_LIMIT - 1));
    let mut seeds: Vec<u64> = draws(&Distribution::Seed, 7)
        .into_iter()
        .map(|draw| if let Draw::Seed(seed) = draw[0] { seed } else { panic!("{draw:?}") })
        .collect();
    seeds.sort_unstable();
    seeds.dedup();
    assert_eq!(seeds.len(), COUNT);
    assert!(seeds.last().is_some_and(|seed| *seed < SEED_LIMIT));
}

/// Three entries, the last of them truncated far into one tail.
fn correlated() -> (Correlated, Vec<Vec<f64>>) {
    let matrix = vec![vec![1.0, 0.8, -0.5], vec![0.8, 1.0, 0.1], vec![-0.5, 0.1, 1.0]];
    let entries = vec![
        Normal::new(10.0, 2.0).unwrap(),
        Normal::new(-1.0, 0.01).unwrap(),
        normal(0.0, 1.0, Some(-1.0), Some(1.0)),
    ];
    (Correlated::new(entries, &matrix).unwrap(), matrix)
}

/// Correlation of two lists.
fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let (mean_a, mean_b) = (mean(a), mean(b));
    let products = a.iter().zip(b).map(|(a, b)| (a - mean_a) * (b - mean_b));
    products.sum::<f64>() / COUNT as f64 / libm::sqrt(variance(a) * variance(b))
}

/// Ranks from 0.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0.0; values.len()];
    order.into_iter().enumerate().for_each(|(rank, index)| ranks[index] = rank as f64);
    ranks
}

#[test]
fn correlated_numbers_have_their_own_moments_and_the_matrix_between_them() {
    let (correlated, matrix) = correlated();
    let all = draws(&Distribution::Correlated(correlated), 8);
    let column = |entry: usize| all.iter().map(|draw| number(draw[entry])).collect::<Vec<f64>>();
    let columns = [column(0), column(1), column(2)];
    assert_like(&columns[0], [10.0, 4.0, 3.0], &[(0.158_655_253_931_457, 8.0)]);
    assert_like(&columns[1], [-1.0, 1e-4, 3.0], &[(0.5, -1.0)]);
    let ratio = 0.241_970_724_519_143 / 0.682_689_492_137_086;
    let spread = 1.0 - 2.0 * ratio;
    assert_like(&columns[2], [0.0, spread, (3.0 - 8.0 * ratio) / (spread * spread)], &[(0.5, 0.0)]);
    let n = libm::sqrt(COUNT as f64);
    let found = correlation(&columns[0], &columns[1]);
    assert!((found - 0.8).abs() < 4.0 * (1.0 - 0.64) / n, "{found}");
    // Spearman's rank correlation of normal numbers, for the truncated ones as well; its standard
    // error is at most 1.06 / √n.
    for (a, b) in [(0, 1), (0, 2), (1, 2)] {
        let expected = 6.0 / std::f64::consts::PI * libm::asin(0.5 * matrix[a][b]);
        let found = correlation(&ranks(&columns[a]), &ranks(&columns[b]));
        assert!((found - expected).abs() < 4.0 * 1.06 / n, "{a} and {b}: {found}");
    }
}

#[test]
fn a_correlation_of_one_repeats_and_of_minus_one_mirrors() {
    let entries = vec![Normal::new(0.0, 1.0).unwrap(); 3];
    let matrix = [vec![1.0, 1.0, -1.0], vec![1.0, 1.0, -1.0], vec![-1.0, -1.0, 1.0]];
    let distribution = Distribution::Correlated(Correlated::new(entries, &matrix).unwrap());
    let mut into = Vec::new();
    distribution.draw(&[0.9, 0.2, 0.7], &mut into).unwrap();
    assert_eq!(number(into[0]), standard_normal::quantile(0.9));
    assert_eq!((number(into[1]), number(into[2])), (number(into[0]), -number(into[0])));
    // Far out everything stays finite.
    into.clear();
    distribution.draw(&[SMALL[3]; 3], &mut into).unwrap();
    assert!(into.into_iter().all(|draw| number(draw).abs() <= 37.5));
}

#[test]
fn ends_are_the_limits_or_three_standard_deviations() {
    let ends = |distribution: Distribution| {
        let ends = distribution.ends();
        assert_eq!(ends.len(), distribution.dimensions());
        ends.into_iter().map(|ends| (ends.smallest, ends.largest)).collect::<Vec<_>>()
    };
    let n = |a, b| vec![(Draw::Number(a), Draw::Number(b))];
    assert_eq!(ends(Distribution::Normal(Normal::new(1.0, 2.0).unwrap())), n(-5.0, 7.0));
    assert_eq!(ends(Distribution::Normal(normal(1.0, 2.0, Some(-50.0), Some(2.0)))), n(-50.0, 2.0));
    assert_eq!(ends(Distribution::Uniform(Uniform::new(-1.0, 2.0).unwrap())), n(-1.0, 2.0));
    assert_eq!(ends(Distribution::LogUniform(LogUniform::new(1.0, 2.0).unwrap())), n(1.0, 2.0));
    let half = normal(0.0, 1.0, Some(0.0), None);
    let [smallest, largest] = half.ends();
    assert_eq!(smallest, 0.0);
    assert!((largest - half.quantile(0.998_650_101_968_37)).abs() < 1e-10);
    let index = |a, b| vec![(Draw::Index(a), Draw::Index(b))];
    assert_eq!(ends(Distribution::Choice(Choice::new(5, None).unwrap())), index(0, 4));
    let some = Choice::new(4, Some(&[0.0, 1.0, 1.0, 0.0])).unwrap();
    assert_eq!(ends(Distribution::Choice(some)), index(1, 2));
    let seeds = vec![(Draw::Seed(0), Draw::Seed(SEED_LIMIT - 1))];
    assert_eq!(ends(Distribution::Seed), seeds);
    let three = ends(Distribution::Correlated(correlated().0));
    assert_eq!(three[0], (Draw::Number(4.0), Draw::Number(16.0)));
    assert_eq!(three[2], (Draw::Number(-1.0), Draw::Number(1.0)));
}

#[test]
fn draws_have_the_recorded_bits() {
    let bits = |distribution: &Distribution| number(at(distribution, 0.123)).to_bits();
    let found = [
        bits(&Distribution::Normal(Normal::new(3.0, 0.5).unwrap())),
        bits(&Distribution::Normal(normal(0.0, 1.0, Some(8.0), Some(9.0)))),
        bits(&Distribution::LogUniform(LogUniform::new(0.01, 100.0).unwrap())),
    ];
    let recorded = [0x4003_5c09_888c_5861, 0x4020_0843_c0c2_2631, 0x3f9f_ca6a_abfa_d2e9];
    assert_eq!(found, recorded, "{found:#018x?}");
}

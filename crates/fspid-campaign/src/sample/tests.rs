//! Points against the laws that each sampling obeys, and against recorded bits.

use fspid_scenario::dispersion::{Distribution, Draw};

use super::*;

/// All points of a campaign, one after the other.
fn points(sampling: Sampling, dimensions: usize, runs: u64, seed: u64) -> Vec<Vec<f64>> {
    let cube = Cube::new(sampling, dimensions, runs, seed).unwrap();
    (0..runs).map(|run| point(&cube, run)).collect()
}

fn point(cube: &Cube, run: u64) -> Vec<f64> {
    let mut into = vec![f64::NAN; cube.dimensions()];
    cube.point(run, &mut into);
    into
}

/// Cell of a coordinate among `cells` of equal width.
fn cell(u: f64, cells: usize) -> usize {
    (u * cells as f64) as usize
}

/// Pearson's statistic of counts that should be equal.
fn chi_square(counts: &[u32]) -> f64 {
    let expected = counts.iter().sum::<u32>() as f64 / counts.len() as f64;
    counts.iter().map(|&n| f64::from(n) - expected).map(|d| d * d / expected).sum()
}

/// Statistic of pairs of numbers in 16 by 16 cells.
fn chi_square_of_pairs(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let mut counts = [0; 256];
    for (u, v) in pairs {
        counts[16 * cell(u, 16) + cell(v, 16)] += 1;
    }
    chi_square(&counts)
}

/// Exceeded by chi-square with 63 degrees of freedom with a probability of 1e-4.
const LIMIT_63: f64 = 113.5;
/// The same for 255 degrees of freedom.
const LIMIT_255: f64 = 347.7;

#[test]
fn every_sampling_is_read_back_from_its_name() {
    for (sampling, name) in Sampling::ALL.into_iter().zip(Sampling::NAMES) {
        assert_eq!(sampling.name(), name);
        assert_eq!(Sampling::from_name(name), Some(sampling));
    }
    assert_eq!(Sampling::from_name("halton"), None);
}

#[test]
fn a_size_that_cannot_be_drawn_is_refused_with_what_is_allowed() {
    let new = |sampling, dimensions, runs| Cube::new(sampling, dimensions, runs, 1).map(|_| ());
    for sampling in Sampling::ALL {
        for runs in [0, RUNS_LIMIT + 1, u64::MAX] {
            let expected = SampleError::Runs { found: runs, limit: RUNS_LIMIT };
            assert_eq!(new(sampling, 1, runs), Err(expected));
        }
        assert_eq!(new(sampling, 0, 1), Ok(()));
        assert_eq!(new(sampling, sampling.dimensions_limit(), RUNS_LIMIT), Ok(()));
    }
    for sampling in [Sampling::Random, Sampling::LatinHypercube] {
        let expected = SampleError::Dimensions { found: 4097, limit: 4096 };
        assert_eq!(new(sampling, 4097, 1), Err(expected));
    }
    let sobol = new(Sampling::Sobol, 162, 1).unwrap_err();
    assert_eq!(sobol, SampleError::SobolDimensions { found: 162, limit: 161 });
    assert!(sobol.to_string().contains("161") && sobol.to_string().contains("latin-hypercube"));
}

#[test]
fn streams_of_a_campaign_lie_beyond_those_of_the_flights() {
    let last_of_sensors = fspid_sim::sensor::STREAM + 4 * u64::from(u32::MAX) + 3;
    assert!(last_of_sensors < STREAM && STREAM + (DIMENSIONS_LIMIT as u64) < KEY_STREAM);
}

#[test]
fn a_point_depends_on_seed_and_run_alone() {
    for sampling in Sampling::ALL {
        let cube = Cube::new(sampling, 3, 1000, 7).unwrap();
        let before = point(&cube, 123);
        let mut backwards: Vec<_> = (0..1000).rev().map(|run| point(&cube, run)).collect();
        backwards.reverse();
        assert_eq!(backwards, points(sampling, 3, 1000, 7));
        assert_eq!(backwards[123], before);
        // More dimensions add coordinates and change none; a longer list is left alone at its end.
        let mut more = [9.0; 5];
        cube.point(123, &mut more);
        assert_eq!((&more[..3], &more[3..]), (&before[..], &[9.0, 9.0][..]));
        assert_eq!(point(&Cube::new(sampling, 8, 1000, 7).unwrap(), 123)[..3], before);
        assert_ne!(point(&Cube::new(sampling, 3, 1000, 8).unwrap(), 123), before);
        // A run that does not exist.
        assert_eq!(point(&cube, 1123), before);
        let longer = point(&Cube::new(sampling, 3, 2000, 7).unwrap(), 123);
        assert_eq!(longer == before, sampling != Sampling::LatinHypercube);
    }
}

#[test]
fn coordinates_are_strictly_inside_the_unit_interval_and_never_come_twice() {
    for sampling in Sampling::ALL {
        let mut first: Vec<f64> =
            points(sampling, 1, 20_000, 5).into_iter().map(|point| point[0]).collect();
        assert!(first.iter().all(|&u| 0.0 < u && u < 1.0));
        first.sort_by(f64::total_cmp);
        first.dedup();
        assert_eq!(first.len(), 20_000);
    }
}

#[test]
fn no_two_runs_of_evenly_spread_points_share_a_seed() {
    for sampling in [Sampling::LatinHypercube, Sampling::Sobol] {
        let mut draws = Vec::new();
        for point in points(sampling, 1, 1 << 16, 77) {
            Distribution::Seed.draw(&point, &mut draws).unwrap();
        }
        let seed = |draw| if let Draw::Seed(seed) = draw { seed } else { panic!("{draw:?}") };
        let mut seeds: Vec<u64> = draws.into_iter().map(seed).collect();
        seeds.sort_unstable();
        seeds.dedup();
        assert_eq!(seeds.len(), 1 << 16);
    }
}

#[test]
fn random_coordinates_are_uniform_and_unrelated_to_other_dimensions_runs_and_seeds() {
    let all = points(Sampling::Random, 6, 16_384, 2026);
    let other = points(Sampling::Random, 6, 16_384, 2027);
    for d in 0..6 {
        let mut counts = [0; 64];
        all.iter().for_each(|point| counts[cell(point[d], 64)] += 1);
        assert!(chi_square(&counts) < LIMIT_63, "{d}");
        let next_run = chi_square_of_pairs(all.windows(2).map(|two| (two[0][d], two[1][d])));
        let next_seed = chi_square_of_pairs(all.iter().zip(&other).map(|(a, b)| (a[d], b[d])));
        let next_dimension = chi_square_of_pairs(all.iter().map(|a| (a[d], a[(d + 1) % 6])));
        // The first digits of a run and the last ones of the next.
        let low = |u: f64| (u * 4_294_967_296.0).fract();
        let digits = chi_square_of_pairs(all.windows(2).map(|two| (two[0][d], low(two[1][d]))));
        for statistic in [next_run, next_seed, next_dimension, digits] {
            assert!(statistic < LIMIT_255, "{d}: {statistic}");
            // Too even would be as wrong: below this with a probability of 1e-4.
            assert!(statistic > 179.4, "{d}: {statistic}");
        }
    }
}

#[test]
fn dimensions_runs_and_seeds_of_a_latin_hypercube_are_unrelated() {
    let all = points(Sampling::LatinHypercube, 4, 10_007, 2026);
    let other = points(Sampling::LatinHypercube, 4, 10_007, 2027);
    for d in 0..4 {
        let next_run = chi_square_of_pairs(all.windows(2).map(|two| (two[0][d], two[1][d])));
        let next_seed = chi_square_of_pairs(all.iter().zip(&other).map(|(a, b)| (a[d], b[d])));
        let next_dimension = chi_square_of_pairs(all.iter().map(|a| (a[d], a[(d + 1) % 4])));
        for statistic in [next_run, next_seed, next_dimension] {
            // With both margins even there are 225 degrees of freedom: 1e-4 on either side.
            assert!((154.5..312.6).contains(&statistic), "{d}: {statistic}");
        }
    }
}

#[test]
fn a_latin_hypercube_has_one_point_in_each_stratum_of_each_dimension() {
    for runs in [1, 2, 3, 13, 64, 1000, 8191] {
        let all = points(Sampling::LatinHypercube, 3, runs, 11);
        for d in 0..3 {
            let mut strata: Vec<usize> =
                all.iter().map(|point| cell(point[d], runs as usize)).collect();
            strata.sort_unstable();
            assert!(strata.into_iter().eq(0..runs as usize), "{runs} runs");
        }
    }
}

#[test]
fn runs_of_a_million_share_no_stratum_of_a_latin_hypercube() {
    let cube = Cube::new(Sampling::LatinHypercube, 1, 1_000_000, 3).unwrap();
    let mut taken = vec![false; 1_000_000];
    let mut thirds = [0_u32; 64];
    for run in (0..1_000_000).step_by(31) {
        let u = point(&cube, run)[0];
        assert!(!std::mem::replace(&mut taken[cell(u, 1_000_000)], true), "run {run}");
        thirds[cell(u, 64)] += 1;
    }
    assert!(chi_square(&thirds) < LIMIT_63);
}

#[test]
fn the_place_in_a_stratum_is_uniform() {
    let mut counts = [0; 64];
    for point in points(Sampling::LatinHypercube, 2, 5000, 1) {
        point.iter().for_each(|u| counts[cell((u * 5000.0).fract(), 64)] += 1);
    }
    assert!(chi_square(&counts) < LIMIT_63);
}

#[test]
fn each_block_of_a_power_of_two_of_sobol_points_is_even_in_every_dimension() {
    let all = points(Sampling::Sobol, SOBOL_DIMENSIONS_LIMIT, 2048, 42);
    for d in 0..SOBOL_DIMENSIONS_LIMIT {
        for size in [1, 2, 16, 256, 1024] {
            for block in all.chunks(size) {
                let mut taken = vec![false; size];
                block.iter().for_each(|point| taken[cell(point[d], size)] = true);
                assert!(taken.into_iter().all(|taken| taken), "dimension {d}, {size} points");
            }
        }
    }
}

#[test]
fn the_first_two_dimensions_of_sobol_are_a_net_in_boxes_of_every_shape() {
    let all = points(Sampling::Sobol, 2, 1024, 9);
    for (wide, high) in (0..=10).map(|k| (1 << k, 1024 >> k)) {
        let mut counts = [0_u32; 1024];
        all.iter()
            .for_each(|point| counts[cell(point[0], wide) * high + cell(point[1], high)] += 1);
        assert!(counts.iter().all(|&n| n == 1), "{wide} by {high}");
    }
}

#[test]
fn a_scrambled_point_is_uniform_over_the_seeds() {
    // Of one fixed point, so that only the scramble can make it so; the upper digits and, moved
    // up, the lower ones.
    let (mut upper, mut lower) = ([0; 64], [0; 64]);
    for seed in 0..8192 {
        let u = point(&Cube::new(Sampling::Sobol, 3, 1000, seed).unwrap(), 0)[2];
        upper[cell(u, 64)] += 1;
        lower[cell((u * 536_870_912.0).fract(), 64)] += 1;
    }
    assert!(chi_square(&upper) < LIMIT_63 && chi_square(&lower) < LIMIT_63);
}

/// Root mean square error of the mean of a smooth function of 6 coordinates over 24 seeds.
fn error(sampling: Sampling, runs: u64) -> f64 {
    let value = |point: &[f64]| {
        point.iter().map(|u| libm::exp(*u) / (std::f64::consts::E - 1.0)).product::<f64>()
    };
    let squares = (0..24).map(|seed| {
        let all = points(sampling, 6, runs, seed);
        let mean = all.iter().map(|point| value(point)).sum::<f64>() / runs as f64;
        (mean - 1.0) * (mean - 1.0)
    });
    (squares.sum::<f64>() / 24.0).sqrt()
}

#[test]
fn means_of_a_smooth_function_are_far_better_with_even_points() {
    let [random, latin_hypercube, sobol] = Sampling::ALL.map(|sampling| error(sampling, 1024));
    // The variance of the product is ((e + 1) / 2(e - 1))⁶ - 1 = 0.605, of which the strata take
    // away that of the six factors, 0.492. Of 24 errors the root mean square is known to 15 %.
    assert!((random * 32.0 / libm::sqrt(0.605) - 1.0).abs() < 0.5, "{random}");
    assert!((latin_hypercube * 32.0 / libm::sqrt(0.113) - 1.0).abs() < 0.5, "{latin_hypercube}");
    assert!(sobol < 0.05 * random, "{sobol}");
    // Faster than 1/n, which a digital shift would give; 1/√n is what random points have.
    let coarse = error(Sampling::Sobol, 64);
    assert!(coarse / sobol > 24.0, "{}", coarse / sobol);
}

/// Last coordinate of the first and of the last run of a large campaign, and Fowler, Noll and Vo's
/// hash of all coordinates of some runs.
fn bits(sampling: Sampling) -> [u64; 3] {
    let cube = Cube::new(sampling, 64, 1_000_003, 20_260_701).unwrap();
    let last = |run| point(&cube, run)[63].to_bits();
    let some = (0..1_000_003).step_by(10_007).flat_map(|run| point(&cube, run));
    let digest = some
        .flat_map(|u| u.to_bits().to_le_bytes())
        .fold(FNV, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
    [last(0), last(1_000_002), digest]
}

/// Start of that hash.
const FNV: u64 = 0xcbf2_9ce4_8422_2325;

/// Not accuracies: they change with any change of an algorithm, and only then. Whoever changes one says
/// so under "Numbers" in the changelog, for no campaign can be repeated then.
#[test]
fn points_have_the_recorded_bits() {
    let recorded = [
        [0x3fd9_f67a_2dac_7fba, 0x3fed_83b2_19f7_6007, 0x9d22_27f8_cde1_79bf],
        [0x3fc5_b8b9_e8f3_0c6a, 0x3fea_7f0d_a648_9751, 0x06ce_ffe9_04c1_1519],
        [0x3fdf_c81c_965e_436e, 0x3fe5_4564_97a4_0059, 0xc31e_7ce2_c77e_429f],
    ];
    let found = Sampling::ALL.map(bits);
    assert_eq!(found, recorded, "{found:#018x?}");
}

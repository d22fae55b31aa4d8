//! Enclosures of all outputs over boxes of inputs.

use fspid_fuzzy::Defuzzifier;
use fspid_fuzzy::audit::Reach;
use fspid_fuzzy::system::System;
use fspid_numeric::scalar::Interval;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::soundness::{ROUNDING, defuzzifier, random_system};
use super::{PRINTED, parts, system};

const RANGE: f64 = 5.0;

/// The ends of `count` cells between the ends of an input.
fn ends(cell: usize, count: usize) -> Interval {
    let at = |n: usize| RANGE * (2.0 * n as f64 / count as f64 - 1.0);
    Interval::between(at(cell), at(cell + 1))
}

fn answers(system: &System, point: [f64; 2]) -> Vec<f64> {
    let mut workspace = system.workspace();
    let answers = system.evaluate(&point, &mut workspace).expect("finite");
    answers.iter().map(|answer| answer.value.expect("rules fire")).collect()
}

/// Sum over cells of the widths of an output's enclosure, and of the range of a few samples.
fn widths(system: &System, reach: &mut Reach<'_>, count: usize, every: usize) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for n in (0..count * count).step_by(every) {
        let cell = [ends(n / count, count), ends(n % count, count)];
        let proved = reach.over(&cell).to_vec();
        let mut found = [f64::INFINITY, f64::NEG_INFINITY];
        for k in 0..25_u32 {
            let [one, other] = [k / 5, k % 5].map(|k| f64::from(k) / 4.0);
            let at =
                |side: Interval, share: f64| side.lower() + share * (side.upper() - side.lower());
            let answers = answers(system, [at(cell[0], one), at(cell[1], other)]);
            for (answer, proved) in answers.iter().zip(&proved) {
                assert!(
                    proved.lower() - ROUNDING <= *answer && *answer <= proved.upper() + ROUNDING
                );
            }
            found = [found[0].min(answers[0]), found[1].max(answers[0])];
        }
        sums[0] += proved[0].width();
        sums[1] += found[1] - found[0];
    }
    sums
}

#[test]
fn cells_of_the_paper_s_surface_are_enclosed_a_twentieth_wider_than_they_are() {
    let system = system(PRINTED);
    let mut reach = Reach::new(&system);
    // Of the finer grids some cells are enough; slopes help in the last.
    for (count, every, excess) in [(12, 1, 0.05), (24, 1, 0.06), (48, 7, 0.06), (384, 439, 0.04)] {
        let [proved, sampled] = widths(&system, &mut reach, count, every);
        assert!(proved < (1.0 + excess) * sampled, "{count}: {proved} {sampled}");
    }
}

#[test]
fn the_cells_together_reach_as_far_as_the_surface() {
    let system = system(PRINTED);
    let mut reach = Reach::new(&system);
    // The proved extremes of `surface.rs`.
    let known = [[-4.234_089_8, 4.444_385_1], [-4.444_275, 4.444_275], [-4.234_089_8, 3.902_748_8]];
    let count = 48;
    let mut hulls: Vec<Option<Interval>> = vec![None; 3];
    for n in 0..count * count {
        let cell = [ends(n / count, count), ends(n % count, count)];
        for (hull, proved) in hulls.iter_mut().zip(reach.over(&cell)) {
            *hull = Some(hull.map_or(*proved, |hull| hull.hull(*proved)));
        }
    }
    for (hull, [least, most]) in hulls.into_iter().flatten().zip(known) {
        assert!(hull.lower() <= least + 1e-6 && hull.lower() > least - 1e-3, "{hull:?}");
        assert!(hull.upper() >= most - 1e-6 && hull.upper() < most + 1e-3, "{hull:?}");
    }
}

#[test]
fn a_box_beyond_the_range_is_answered_as_it_is_clamped() {
    let system = system(PRINTED);
    let mut reach = Reach::new(&system);
    let side = Interval::between(4.0, RANGE);
    let inside = reach.over(&[side, side]).to_vec();
    let beyond = Interval::between(4.0, f64::INFINITY);
    assert_eq!(reach.over(&[beyond, side]), inside);
}

#[test]
fn a_box_with_too_few_sides_has_no_bounds() {
    let system = system(PRINTED);
    let mut reach = Reach::new(&system);
    assert_eq!(reach.over(&[Interval::ZERO]), [Interval::ENTIRE; 3]);
}

#[test]
fn sampled_centroids_are_enclosed_as_they_are_computed() {
    let parts = parts(PRINTED, Defuzzifier::Midpoint(100));
    let system = System::new(parts).expect("a sound system");
    let mut reach = Reach::new(&system);
    let [proved, sampled] = widths(&system, &mut reach, 24, 31);
    assert!(proved < 1.1 * sampled, "{proved} {sampled}");
}

proptest! {
    // The same systems at each run; other seeds belong to the long checks.
    #![proptest_config(ProptestConfig {
        rng_seed: RngSeed::Fixed(61),
        ..ProptestConfig::with_cases(120)
    })]

    #[test]
    fn no_point_of_a_box_has_an_answer_outside_of_the_enclosure(
        numbers in proptest::collection::vec(0.0_f64..1.0, 97),
        count in 1_usize..=3,
        defuzzifier in defuzzifier(),
        corner in proptest::array::uniform3(-1.2_f64..=1.0),
        width in prop_oneof![Just(0.5), Just(0.1), Just(0.01), Just(0.0)],
        points in proptest::collection::vec(proptest::array::uniform3(0.0_f64..=1.0), 30),
    ) {
        let system = random_system(&numbers, count, defuzzifier);
        let mut reach = Reach::new(&system);
        let sides = corner.map(|lower| Interval::between(lower, lower + width));
        let proved = reach.over(&sides[..count])[0];
        for shares in &points {
            let point: Vec<f64> =
                corner.iter().zip(shares).map(|(lower, share)| lower + share * width).collect();
            let mut workspace = system.workspace();
            let answer = system.evaluate(&point[..count], &mut workspace).expect("finite")[0];
            let found = answer.value.expect("there is a fallback");
            let slack = answer.error_bound + ROUNDING;
            prop_assert!(proved.lower() <= found + slack, "{answer:?} {proved:?}");
            prop_assert!(found <= proved.upper() + slack, "{answer:?} {proved:?}");
        }
    }
}

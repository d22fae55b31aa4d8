//! Forms that fall under every matrix of a set: known answers, the paper's loops, and whatever is found.
#![allow(clippy::unwrap_used, reason = "a test")]

use crate::solve_loops;

use fspid_lti::Matrix;
use fspid_proof::solve::{
    BestRate, Condition, Effort, LyapunovProblem, Solution, Verdict, best_rate, common_lyapunov,
};
use proptest::prelude::*;
use solve_loops::{GAINS_747, GAINS_NAVION, Plant, difference, is_positive_definite, matrix};

fn everywhere(matrices: &[Matrix]) -> Vec<Condition<'_>> {
    matrices.iter().map(|matrix| Condition { matrix, cone: None }).collect()
}

fn search(matrices: &[Matrix], rate: f64) -> Verdict {
    let conditions = everywhere(matrices);
    common_lyapunov(
        &LyapunovProblem { conditions: &conditions, cones: &[], rate },
        &Effort::default(),
    )
}

fn found(matrices: &[Matrix], rate: f64) -> Option<Solution> {
    match search(matrices, rate) {
        Verdict::Found(solution) => Some(solution),
        Verdict::NotFound { .. } => None,
    }
}

fn best(matrices: &[Matrix]) -> BestRate {
    let conditions = everywhere(matrices);
    let problem = LyapunovProblem { conditions: &conditions, cones: &[], rate: 1.0 };
    best_rate(&problem, &Effort::default()).unwrap()
}

/// The differences as they are written, in the coordinates of the caller, with half the margin taken off.
fn assert_falls(matrices: &[Matrix], rate: f64, solution: &Solution) {
    let level = rate * rate - 0.5 * solution.margin;
    assert!(solution.margin > 0.0 && is_positive_definite(&solution.p));
    for m in matrices {
        assert!(is_positive_definite(&difference(level, &solution.p, m, &solution.p)));
    }
}

#[test]
fn scalars_fall_as_slowly_as_the_slowest_of_them() {
    let scalars = [matrix(&[[0.5]]), matrix(&[[-0.8]])];
    // λ = 0.64 is the lowest level; a fall of 0.9² leaves 0.81 - 0.64 and one of 0.7² lacks as much as 0.15.
    let solution = found(&scalars, 0.9).unwrap();
    assert!((solution.margin - 0.17).abs() < 1e-9, "{}", solution.margin);
    let Verdict::NotFound { best_margin } = search(&scalars, 0.7) else {
        panic!("no form falls faster than its loop")
    };
    assert!((best_margin + 0.15).abs() < 1e-6, "{best_margin}");
    assert!((best(&scalars).rate - 0.8).abs() < 0.02);
}

#[test]
fn the_golden_pair_has_the_golden_ratio_as_its_best_rate() {
    // [[1, 1], [0, 1]] and its transpose: the identity already reaches the joint spectral radius (1 + √5)/2.
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let scaled = |factor: f64| {
        [matrix(&[[1.0, 1.0], [0.0, 1.0]]), matrix(&[[1.0, 0.0], [1.0, 1.0]])]
            .map(|matrix| matrix.scaled(factor))
    };
    assert_falls(&scaled(0.615), 1.0, &found(&scaled(0.615), 1.0).unwrap());
    assert_eq!(found(&scaled(0.62), 1.0), None);
    // The rate is given back a little of its distance from 1.
    let rate = best(&scaled(0.5)).rate;
    assert!(rate > 0.5 * golden && rate < 0.5 * golden + 0.02, "{rate}");
}

#[test]
fn a_rate_beyond_the_best_is_not_found_and_one_above_it_is() {
    let pair = [matrix(&[[0.9, 0.5], [0.0, 0.3]]), matrix(&[[0.4, -0.2], [0.6, 0.7]])];
    let BestRate { rate, solution } = best(&pair);
    assert_falls(&pair, rate, &solution);
    assert!(rate < 1.0);
    assert!(found(&pair, rate + 0.01).is_some());
    assert_eq!(found(&pair, rate - 0.02), None);
}

#[test]
fn two_stable_matrices_whose_switching_grows_have_no_form() {
    let pair = [matrix(&[[0.0, 2.0], [0.0, 0.0]]), matrix(&[[0.0, 0.0], [2.0, 0.0]])];
    let Verdict::NotFound { best_margin } = search(&pair, 1.0) else { panic!("2² in two steps") };
    assert!((best_margin + 3.0).abs() < 1e-3, "{best_margin}");
}

#[test]
fn the_paper_s_loops_are_found_with_gains_that_move_by_a_fifth_and_by_three_tenths() {
    for (plant, gains, part) in
        [(Plant::boeing_747(), GAINS_747, 0.2), (Plant::navion(), GAINS_NAVION, 0.3)]
    {
        let corners = plant.corners(gains, part);
        let solution = found(&corners, 1.0).unwrap();
        assert_falls(&corners, 1.0, &solution);
        assert!(solution.margin > 1e-4 && solution.steps < 200, "{solution:?}");
        let BestRate { rate, solution } = best(&corners);
        assert!(rate < 1.0);
        assert_falls(&corners, rate, &solution);
    }
}

/// Measured by bisection: one form proves 53.5 % for the 747 and 54.5 % for the Navion.
#[test]
fn one_form_covers_gains_that_move_by_half_but_not_by_six_tenths() {
    for (plant, gains) in [(Plant::boeing_747(), GAINS_747), (Plant::navion(), GAINS_NAVION)] {
        assert_falls(
            &plant.corners(gains, 0.53),
            1.0,
            &found(&plant.corners(gains, 0.53), 1.0).unwrap(),
        );
        assert_eq!(found(&plant.corners(gains, 0.56), 1.0), None);
    }
}

#[test]
fn a_cone_excuses_what_happens_outside_of_it() {
    // The first state grows and the second decays; inside |x2| > 3 |x1| the sum of squares falls.
    let m = matrix(&[[1.2, 0.0], [0.0, 0.5]]);
    let cones = [matrix(&[[-9.0, 0.0], [0.0, 1.0]])];
    let ask = |cone| {
        let conditions = [Condition { matrix: &m, cone }];
        common_lyapunov(
            &LyapunovProblem { conditions: &conditions, cones: &cones, rate: 1.0 },
            &Effort::default(),
        )
    };
    assert!(matches!(ask(None), Verdict::NotFound { .. }));
    let Verdict::Found(solution) = ask(Some(0)) else { panic!("the form falls inside the cone") };
    let tau = solution.multipliers[0];
    assert!(tau > 0.0 && is_positive_definite(&solution.p));
    let decrease = difference(1.0 - 0.5 * solution.margin, &solution.p, &m, &solution.p);
    assert!(is_positive_definite(&decrease.sum(&cones[0].scaled(-tau)).unwrap()));
}

#[test]
fn conditions_share_the_multiplier_of_their_cone() {
    // Each wants a multiplier between its own limits: [1.44 - 1, 9 · 0.75] / 9 for p1 = p2; both share one.
    let matrices = [matrix(&[[1.2, 0.0], [0.0, 0.5]]), matrix(&[[1.1, 0.1], [0.0, 0.6]])];
    let cones = [matrix(&[[-9.0, 0.0], [0.0, 1.0]])];
    let conditions: Vec<Condition> =
        matrices.iter().map(|matrix| Condition { matrix, cone: Some(0) }).collect();
    let problem = LyapunovProblem { conditions: &conditions, cones: &cones, rate: 1.0 };
    let Verdict::Found(solution) = common_lyapunov(&problem, &Effort::default()) else {
        panic!("the form falls inside the cone")
    };
    assert_eq!(solution.multipliers.len(), 1);
    for m in &matrices {
        let decrease = difference(1.0, &solution.p, m, &solution.p);
        let decrease = decrease.sum(&cones[0].scaled(-solution.multipliers[0])).unwrap();
        assert!(is_positive_definite(&decrease));
    }
}

#[test]
fn what_does_not_fit_together_is_not_found() {
    let two = Matrix::identity(2).scaled(0.5);
    let refused = Verdict::NotFound { best_margin: f64::NEG_INFINITY };
    assert_eq!(search(&[], 1.0), refused);
    assert_eq!(search(&[Matrix::zeros(2, 3)], 1.0), refused);
    assert_eq!(search(&[two.clone(), Matrix::identity(3)], 1.0), refused);
    assert_eq!(search(&[two.scaled(f64::NAN)], 1.0), refused);
    assert!(matches!(search(core::slice::from_ref(&two), f64::NAN), Verdict::NotFound { .. }));
    let conditions = [Condition { matrix: &two, cone: Some(0) }];
    let problem = LyapunovProblem { conditions: &conditions, cones: &[], rate: 1.0 };
    assert_eq!(common_lyapunov(&problem, &Effort::default()), refused);
    assert_eq!(best_rate(&problem, &Effort::default()), None);
}

#[test]
fn matrices_that_forget_everything_fall_at_any_rate() {
    let still = [Matrix::zeros(3, 3), matrix(&[[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]])];
    assert_falls(&still, 0.5, &found(&still, 0.5).unwrap());
}

#[test]
fn the_same_question_has_the_same_answer_to_the_last_bit() {
    let corners = Plant::navion().corners(GAINS_NAVION, 0.4);
    let bits = || -> Vec<u64> {
        found(&corners, 1.0).unwrap().p.data().iter().map(|value| value.to_bits()).collect()
    };
    assert_eq!(bits(), bits());
}

/// Loops a little off a slow one, with states of very different size.
fn slow_loops() -> impl Strategy<Value = Vec<Matrix>> {
    (2_usize..7, 1_usize..6, 0.0..0.6_f64).prop_flat_map(|(n, m, spread)| {
        let entries = prop::collection::vec(-1.0..1.0_f64, n * n * m);
        let scales = prop::collection::vec(-4_i32..4, n);
        (entries, scales).prop_map(move |(entries, scales)| {
            (0..m)
                .map(|k| {
                    let mut matrix = Matrix::identity(n);
                    for i in 0..n {
                        for j in 0..n {
                            let own = if i == j { -0.1 - 0.5 * i as f64 } else { 0.0 };
                            let turn = if i == j {
                                0.0
                            } else if i < j {
                                1.0
                            } else {
                                -1.0
                            };
                            let rate = own + turn + spread * entries[(k * n + i) * n + j];
                            let scale = libm::pow(10.0, f64::from(scales[i] - scales[j]));
                            let old = matrix.get(i, j).unwrap();
                            matrix.set(i, j, old + 0.01 * rate * scale).unwrap();
                        }
                    }
                    matrix
                })
                .collect()
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    #[test]
    fn whatever_is_found_falls_when_the_differences_are_written_out(loops in slow_loops()) {
        if let Some(solution) = found(&loops, 1.0) {
            assert_falls(&loops, 1.0, &solution);
        }
    }

    #[test]
    fn no_form_is_found_when_a_loop_is_unstable(loops in slow_loops(), excess in 1e-6..1e-2_f64) {
        let radius = fspid_lti::spectral_radius(&loops[0]).unwrap();
        let unstable = loops[0].scaled((1.0 + excess) / radius);
        let loops: Vec<Matrix> = loops[1..].iter().cloned().chain([unstable]).collect();
        prop_assert_eq!(found(&loops, 1.0), None);
    }
}

//! Statistics against values that another tool computed: `oracles/make_contest.py`.

use super::signed_rank::SignedRank;
use super::student::{beyond, two_sided};
use super::two_way::TwoWay;

/// Sums in another order, and a continued fraction in place of another tool's series.
const TOL: f64 = 1e-11;

fn rows(text: &str) -> impl Iterator<Item = Vec<&str>> {
    text.lines().skip(1).map(|line| line.split(',').collect())
}

fn number(text: &str) -> f64 {
    text.parse().expect("a number")
}

fn numbers(text: &str) -> Vec<f64> {
    text.split(' ').map(number).collect()
}

fn near(found: f64, expected: f64) -> bool {
    found == expected || (found - expected).abs() <= TOL * expected.abs().max(1e-3)
}

#[test]
fn tails_of_students_distribution_are_those_of_another_tool() {
    for row in rows(include_str!("../../tests/data/student.csv")) {
        let [t, freedom, expected] = [0, 1, 2].map(|at| number(row[at]));
        let found = two_sided(t, freedom);
        // The smallest of them is below what a double holds.
        let is_near = found == expected || (found / expected - 1.0).abs() < 1e-11;
        assert!(is_near, "{t} {freedom}: {found} {expected}");
        if expected > 1e-12 && expected < 1.0 {
            assert!(near(beyond(expected, freedom), t), "{t} {freedom}");
        }
    }
    assert_eq!((two_sided(f64::NAN, 3.0), two_sided(1.0, f64::NAN)), (1.0, 1.0));
    assert_eq!(two_sided(f64::INFINITY, 3.0), 0.0);
}

#[test]
fn without_a_degree_of_freedom_nothing_is_known_and_one_in_a_trillion_is_far_away() {
    assert_eq!([0.0, -1.0].map(|freedom| two_sided(1.0, freedom)), [1.0, 1.0]);
    // Of one degree of freedom, Cauchy's distribution, the chance is 2/π arctan(1/t).
    let chance = 1e-12;
    let expected = 1.0 / libm::tan(0.5 * std::f64::consts::PI * chance);
    assert!(near(beyond(chance, 1.0), expected), "{}", beyond(chance, 1.0));
}

#[test]
fn signed_ranks_are_those_of_every_combination_of_signs() {
    for row in rows(include_str!("../../tests/data/signed_rank.csv")) {
        let differences = numbers(row[1]);
        let found = SignedRank::of(&differences, number(row[0])).expect("differences");
        let pairs = [(found.p, 2), (found.estimate, 3), (found.lower, 4), (found.upper, 5)];
        for (value, column) in pairs {
            assert!(near(value, number(row[column])), "{differences:?} {column}: {value}");
        }
    }
}

#[test]
fn a_normal_approximation_takes_over_where_counting_would_be_long() {
    // 201 differences, every fourth below 0: z by the textbook formula with continuity.
    let differences: Vec<f64> =
        (1..=201).map(|k| if k % 4 == 0 { -f64::from(k) } else { f64::from(k) }).collect();
    let found = SignedRank::of(&differences, 0.95).expect("differences");
    let below: f64 = (1..=50).map(|k| 4.0 * f64::from(k)).sum();
    let (mean, variance) = (201.0 * 202.0 / 4.0, 201.0 * 202.0 * 403.0 / 24.0);
    let z = (mean - below - 0.5) / f64::sqrt(variance);
    assert!((found.p / libm::erfc(z / std::f64::consts::SQRT_2) - 1.0).abs() < 1e-5, "{}", found.p);
    assert!(found.lower < found.estimate && found.estimate < found.upper && found.lower > 0.0);
}

#[test]
fn mean_ratios_over_cases_and_designs_are_those_of_another_tool() {
    for row in rows(include_str!("../../tests/data/two_way.csv")) {
        let [mine, theirs] =
            [0, 1].map(|at| row[at].split('|').map(numbers).collect::<Vec<Vec<f64>>>());
        let found = TwoWay::of(&mine, &theirs).expect("a difference");
        let [lower, upper] = found.interval(number(row[2])).expect("an interval");
        let error = found.error.expect("an error");
        let values = [found.estimate, error, found.freedom, found.p(), lower, upper];
        for (value, expected) in values.into_iter().zip(&row[3..]) {
            assert!(near(value, number(expected)), "{value} {expected}");
        }
    }
}

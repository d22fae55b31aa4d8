//! Certified integrals against values of 45 digits, and what they promise when cut short.

use fspid_fuzzy::membership::{Gaussian, Shape, ShapeKind};
use fspid_numeric::quadrature::{Accuracy, Curve, Quadrature};
use fspid_numeric::scalar::{Interval, Scalar};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Error of a certified value, as a share of the domain or area, that is reached.
const REACHED: f64 = 1e-12;

/// A shape written out here as in the oracle.
fn grade<S: Scalar>(kind: &str, params: &[f64], x: S) -> S {
    let p = |index: usize| S::constant(params[index]);
    match kind {
        "gaussian" => Gaussian::grade(&[p(0), p(1)], x),
        "bell" => S::one() / (S::one() + ((x - p(0)) / p(1)).abs().pow(p(2) + p(2))),
        "sigmoid" => S::one() / (S::one() + (-p(0) * (x - p(1))).exp()),
        "triangle" => {
            let sides = ((x - p(0)) / (p(1) - p(0))).smaller((p(2) - x) / (p(2) - p(1)));
            sides.larger(S::zero())
        }
        "block" => x.if_less(p(0), S::zero(), x.if_less(p(1), S::one(), S::zero())),
        other => panic!("unknown shape {other}"),
    }
}

/// The largest of sets, each cut at its clip.
struct Union(Vec<(String, f64, Vec<f64>)>);

impl Union {
    fn parse(text: &str) -> Self {
        let set = |text: &str| {
            let mut words = text.split(' ');
            let kind = words.next().expect("a kind").to_owned();
            let mut numbers = words.map(|word| word.parse().expect("a number"));
            (kind, numbers.next().expect("a clip"), numbers.collect())
        };
        Self(text.split(';').map(set).collect())
    }
}

impl Curve for Union {
    fn at<S: Scalar>(&self, x: S) -> S {
        self.0.iter().fold(S::zero(), |top, (kind, clip, params)| {
            top.larger(grade(kind, params, x).smaller(S::constant(*clip)))
        })
    }
}

/// Rows of the reference file: domain, curve, and four true values, rounded down.
fn references() -> impl Iterator<Item = (Quadrature<'static>, f64, Union, [f64; 4])> {
    include_str!("data/integrals.csv").lines().skip(1).map(|row| {
        let columns: Vec<&str> = row.split(',').collect();
        let [lower, upper] = [0, 1].map(|column| columns[column].parse::<f64>().expect("a bound"));
        let bits = |column: usize| u64::from_str_radix(columns[column], 16).expect("bits");
        let values = [3, 4, 5, 6].map(|column| f64::from_bits(bits(column)));
        let quadrature = Quadrature::new(lower, upper).expect("in order");
        (quadrature, upper - lower, Union::parse(columns[2]), values)
    })
}

/// True if the interval holds a value that lies between `down` and the next float.
fn holds(interval: Interval, down: f64) -> bool {
    interval.lower() <= down && down.next_up() <= interval.upper()
}

#[test]
fn the_true_values_lie_within_bounds_that_are_narrow() {
    let mut compared = 0;
    for (quadrature, width, curve, [area, moment, centroid, bisector]) in references() {
        let ours = quadrature.integrate(&curve);
        assert!(ours.complete, "{ours:?}");
        assert!(holds(ours.area, area) && ours.area.width() <= REACHED * area, "{ours:?} {area}");
        assert!(holds(ours.moment, moment), "{ours:?} {moment}");
        let ours = ours.centroid().expect("some area");
        assert!(holds(ours, centroid) && ours.width() <= REACHED * width, "{ours:?} {centroid}");
        let ours = quadrature.bisector(&curve).expect("some area");
        assert!(holds(ours, bisector) && ours.width() <= REACHED * width, "{ours:?} {bisector}");
        compared += 1;
    }
    assert_eq!(compared, 15);
}

#[test]
fn bounds_hold_at_every_limit_of_work_and_every_accuracy() {
    for (quadrature, _, curve, [area, moment, ..]) in references() {
        for (panels, relative) in [(0, 1e-13), (1, 1e-13), (7, 1e-13), (60, 1e-16), (500, 1e-3)] {
            let accuracy = Accuracy { panels, relative, ..Accuracy::default() };
            let ours = quadrature.with_accuracy(accuracy).integrate(&curve);
            assert!(holds(ours.area, area) && holds(ours.moment, moment), "{ours:?}");
            assert!(!ours.complete || ours.area.radius() <= relative * ours.area.magnitude());
            assert!(panels > 1 || !ours.complete, "{ours:?}");
        }
    }
}

#[test]
fn hints_that_are_wrong_do_no_harm() {
    let hints = [-1e9, -3.0, -3.0, 0.123_456, 0.5, f64::NAN, 4.0, 1e9];
    for (quadrature, _, curve, [area, ..]) in references() {
        let ours = quadrature.with_corners(&hints).integrate(&curve);
        assert!(ours.complete && holds(ours.area, area), "{ours:?}");
    }
}

/// A shape of the family with its example parameters.
struct Example(ShapeKind);

impl Curve for Example {
    fn at<S: Scalar>(&self, x: S) -> S {
        let mut params = [S::zero(); 32];
        let example = self.0.example();
        for (to, &from) in params.iter_mut().zip(example) {
            *to = S::constant(from);
        }
        self.0.grade(&params[..example.len()], x)
    }
}

#[test]
fn every_shape_is_integrated_and_agrees_with_many_midpoints() {
    const SAMPLES: u32 = 400_000;
    for kind in ShapeKind::ALL {
        let mut corners = Vec::new();
        kind.corners(kind.example(), &mut |x| corners.push(x));
        corners.sort_by(f64::total_cmp);
        let quadrature = Quadrature::new(-6.0, 6.0).expect("in order");
        let step = 12.0 / f64::from(SAMPLES);
        let sample = |k: u32| Example(*kind).at(-6.0 + (f64::from(k) + 0.5) * step);
        let midpoints: f64 = (0..SAMPLES).map(sample).sum::<f64>() * step;
        for quadrature in [quadrature, quadrature.with_corners(&corners)] {
            let ours = quadrature.integrate(&Example(*kind));
            let name = kind.name();
            println!("{name}: {} panels, area {:e}", ours.panels, ours.area.width());
            assert!(ours.complete && ours.area.width() < 1e-12, "{name}: {ours:?}");
            // A jump costs the midpoints half a step.
            assert!(
                (ours.area.midpoint() - midpoints).abs() < 1e-4,
                "{name}: {ours:?} {midpoints}"
            );
        }
    }
}

#[test]
fn straight_sides_between_hints_cost_a_panel_each() {
    let corners = [-1.0, 0.0, 2.0];
    let quadrature = Quadrature::new(-3.0, 3.0).expect("in order").with_corners(&corners);
    let ours = quadrature.integrate(&Example(ShapeKind::Triangle));
    assert!(ours.area.contains(1.5) && ours.area.width() < 1e-14, "{ours:?}");
    assert!(ours.panels <= 8, "{ours:?}");
}

/// One third, so that nothing is exact.
struct Third;

impl Curve for Third {
    fn at<S: Scalar>(&self, _: S) -> S {
        S::one() / S::constant(3.0)
    }
}

/// Nothing.
struct Nothing;

impl Curve for Nothing {
    fn at<S: Scalar>(&self, x: S) -> S {
        x.smaller(S::zero()).larger(S::zero())
    }
}

/// A comb with a thousand teeth.
struct Comb;

impl Curve for Comb {
    fn at<S: Scalar>(&self, x: S) -> S {
        let turns = x * S::constant(2000.0 * core::f64::consts::PI);
        turns.sin().if_less(S::zero(), S::zero(), S::one())
    }
}

#[test]
fn the_simplest_curves_are_no_exception() {
    let unit = Quadrature::new(0.0, 1.0).expect("in order");
    let third = unit.integrate(&Third);
    assert!(
        third.complete && third.area.width() < 1e-15 && third.centroid().unwrap().contains(0.5)
    );
    assert!(unit.area_up_to(&Third, 0.75).contains(0.25));
    assert!(unit.area_up_to(&Third, -2.0).contains(0.0));
    assert!(unit.area_up_to(&Third, 2.0).intersection(third.area).is_some());
    let nothing = unit.integrate(&Nothing);
    assert_eq!((nothing.area, nothing.centroid()), (Interval::ZERO, None));
    assert_eq!(unit.bisector(&Nothing), None);
    let point = Quadrature::new(2.0, 2.0).expect("in order").integrate(&Third);
    assert_eq!((point.area, point.moment), (Interval::ZERO, Interval::ZERO));
    for (lower, upper) in [(1.0, 0.0), (f64::NAN, 0.0), (0.0, f64::INFINITY), (-1e308, 1e308)] {
        assert!(Quadrature::new(lower, upper).is_none());
    }
}

#[test]
fn a_curve_with_too_many_jumps_is_still_bounded() {
    let unit = Quadrature::new(0.0, 1.0).expect("in order");
    for (panels, complete) in [(2000, false), (100_000, true)] {
        let accuracy = Accuracy { panels, relative: 1e-10, absolute: 0.0 };
        let ours = unit.with_accuracy(accuracy).integrate(&Comb);
        assert!(ours.area.contains(0.5) && ours.complete == complete, "{ours:?}");
    }
}

#[test]
fn two_rules_with_one_consequent_cost_no_more_than_one() {
    let quadrature = Quadrature::new(-5.0, 5.0).expect("in order");
    let one = quadrature.integrate(&Union::parse("gaussian 0.6 0.3 1.1"));
    let two = quadrature.integrate(&Union::parse("gaussian 0.6 0.3 1.1;gaussian 0.4 0.3 1.1"));
    assert!(two.complete && two.panels <= one.panels + 12, "{one:?} {two:?}");
    assert!(two.area.intersection(one.area).is_some(), "{one:?} {two:?}");
}

#[test]
fn the_bisector_of_two_sets_with_nothing_between_holds_the_gap() {
    let apart = Union::parse("block 0.5 0.0 1.0;block 0.5 3.0 4.0");
    let quadrature = Quadrature::new(-1.0, 5.0).expect("in order");
    let bisector = quadrature.bisector(&apart).expect("some area");
    assert!(bisector.encloses(Interval::between(1.0, 3.0)), "{bisector:?}");
    assert!(bisector.width() < 2.0 + 1e-7, "not the whole range: {bisector:?}");
}

/// Two halves that meet where both of them vanish, in proportion to the distance: known to the root of what the area is known to.
#[test]
fn the_bisector_of_two_sets_that_meet_in_a_point_is_known_to_a_millionth() {
    let meeting = Union::parse("triangle 0.5 0.0 1.0 2.0;triangle 0.5 2.0 3.0 4.0");
    let quadrature = Quadrature::new(-1.0, 5.0).expect("in order");
    let bisector = quadrature.bisector(&meeting).expect("some area");
    assert!(bisector.contains(2.0) && bisector.width() < 6e-6, "{bisector:?}");
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(2026),
        cases: 200,
        ..ProptestConfig::default()
    })]

    #[test]
    fn any_union_of_bells_is_bounded_narrowly_and_without_contradiction(
        sets in prop::collection::vec(
            (prop::sample::select(vec!["gaussian", "bell"]), -5.0..5.0_f64, 0.05..3.0_f64, 0.5..4.0_f64, 0.0..=1.0_f64),
            1..8,
        ),
        split in -4.0..4.0_f64,
    ) {
        let set = |(kind, centre, width, slope, clip): (&str, f64, f64, f64, f64)| {
            (kind.to_owned(), clip, vec![centre, width, slope])
        };
        let curve = Union(sets.into_iter().map(set).collect());
        let over = |lower, upper| Quadrature::new(lower, upper).expect("in order");
        let whole = over(-5.0, 5.0).integrate(&curve);
        prop_assert!(whole.complete && whole.area.width() < 1e-12 * whole.area.magnitude(), "{whole:?}");
        // The same in two parts, and coarsely.
        let parts = [over(-5.0, split), over(split, 5.0)].map(|part| part.integrate(&curve));
        let [left, right] = parts;
        let sum = left.area + right.area;
        prop_assert!(whole.area.intersection(sum).is_some(), "{whole:?} {sum:?}");
        let moments = left.moment_about_zero() + right.moment_about_zero();
        prop_assert!(whole.moment.intersection(moments).is_some(), "{whole:?} {moments:?}");
        let coarse = Accuracy { relative: 1e-4, ..Accuracy::USUAL };
        let coarse = over(-5.0, 5.0).with_accuracy(coarse).integrate(&curve);
        prop_assert!(whole.area.intersection(coarse.area).is_some(), "{whole:?} {coarse:?}");
        let bisector = over(-5.0, 5.0).bisector(&curve).expect("some area");
        let left = over(-5.0, 5.0).area_up_to(&curve, bisector.midpoint());
        prop_assert!((left.midpoint() - 0.5 * whole.area.midpoint()).abs() < 1e-11, "{bisector:?} {left:?}");
    }
}

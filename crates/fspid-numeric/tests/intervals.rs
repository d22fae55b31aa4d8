//! Intervals hold every true value: exact integers, 1300-bit references, sampled points.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use fspid_numeric::scalar::{Interval, Scalar};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn repeatable() -> ProptestConfig {
    ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(2026),
        cases: 1000,
        ..ProptestConfig::default()
    }
}

fn between(one: f64, other: f64) -> Interval {
    Interval::between(one, other)
}

/// Mantissa and exponent of a float, zero or normal: `m * 2^e`.
fn parts(value: f64) -> (i128, i32) {
    if value == 0.0 {
        return (0, 0);
    }
    assert!(value.is_normal(), "{value:e}");
    let (bits, sign) = (value.abs().to_bits(), if value < 0.0 { -1 } else { 1 });
    let exponent = i32::try_from(bits >> 52).expect("11 bits") - 1075;
    let mantissa = i128::from((bits & ((1 << 52) - 1)) | 1 << 52);
    let spare = i32::try_from(mantissa.trailing_zeros()).expect("at most 52");
    (sign * (mantissa >> spare), exponent + spare)
}

/// A float as a whole number of `2^-70`; exact.
fn fixed_point(value: f64) -> i128 {
    let (mantissa, exponent) = parts(value);
    mantissa << (exponent + 70)
}

proptest! {
    #![proptest_config(repeatable())]

    #[test]
    fn sums_and_products_hold_the_exact_one(
        a in -(1_i64 << 53)..=1 << 53,
        b in -(1_i64 << 53)..=1 << 53,
        digits in 0_u32..53,
    ) {
        // Fewer digits in some cases, so that exact results occur too.
        let (a, b) = (a >> digits, b >> (digits / 2));
        #[allow(clippy::cast_precision_loss, reason = "at most 53 bits")]
        let (x, y) = (a as f64, b as f64);
        let (sum, product) = (Interval::point(x) + Interval::point(y), Interval::point(x) * Interval::point(y));
        let whole = |bound: f64| {
            let (mantissa, exponent) = parts(bound);
            mantissa << exponent
        };
        for (interval, exact) in [
            (sum, i128::from(a) + i128::from(b)),
            (product, i128::from(a) * i128::from(b)),
        ] {
            prop_assert!(whole(interval.lower()) <= exact && exact <= whole(interval.upper()));
            let fits = exact.unsigned_abs().leading_zeros() + exact.trailing_zeros() >= 75;
            // A sum is exact wherever it can be; a product where few digits show that it is.
            prop_assert!(interval.is_point() || interval != sum || !fits, "{interval:?} {exact}");
            prop_assert!(interval.upper() <= interval.lower().next_up().next_up());
        }
    }

    #[test]
    fn quotients_hold_the_exact_one(n in 1_i64 << 40..1 << 41, d in 1_i64..1 << 40, cut in 0_u32..40) {
        let d = (d >> cut).max(1);
        #[allow(clippy::cast_precision_loss, reason = "at most 41 bits")]
        let quotient = Interval::point(n as f64) / Interval::point(d as f64);
        let times_divisor = |bound: f64| {
            let (mantissa, exponent) = parts(bound);
            ((mantissa * i128::from(d)) << exponent.max(0), -exponent.min(0))
        };
        let (lower, shift) = times_divisor(quotient.lower());
        prop_assert!(lower <= i128::from(n) << shift);
        let (upper, shift) = times_divisor(quotient.upper());
        prop_assert!(upper >= i128::from(n) << shift);
        prop_assert!(n % d != 0 || quotient.is_point());
    }

    #[test]
    fn roots_hold_the_exact_one(n in 1_i64..1 << 20) {
        #[allow(clippy::cast_precision_loss, reason = "20 bits")]
        let root = Scalar::sqrt(Interval::point(n as f64));
        let square = |bound: f64| {
            let (mantissa, exponent) = parts(bound);
            ((mantissa * mantissa) << (2 * exponent.max(0)), -2 * exponent.min(0))
        };
        let ((lower, shift), (upper, shift_up)) = (square(root.lower()), square(root.upper()));
        prop_assert!(lower <= i128::from(n) << shift && upper >= i128::from(n) << shift_up);
    }

    #[test]
    fn differences_of_nearby_numbers_are_exact(x in 1.0_f64..2.0, steps in 0_u64..1000) {
        let y = f64::from_bits(x.to_bits() + steps);
        let difference = Interval::point(y) - Interval::point(x);
        prop_assert!(difference.is_point());
        prop_assert_eq!(fixed_point(difference.lower()), fixed_point(y) - fixed_point(x));
    }
}

/// A function by its name, of intervals and of floats.
type Function = (&'static str, fn(Interval) -> Interval, fn(f64) -> f64);
/// Likewise of two numbers.
type Operation = (&'static str, fn(Interval, Interval) -> Interval, fn(f64, f64) -> f64);

/// Every function of one number.
const FUNCTIONS: [Function; 16] = [
    ("exp", Scalar::exp, Scalar::exp),
    ("ln", Scalar::ln, Scalar::ln),
    ("sqrt", Scalar::sqrt, Scalar::sqrt),
    ("sin", Scalar::sin, Scalar::sin),
    ("cos", Scalar::cos, Scalar::cos),
    ("tan", Scalar::tan, Scalar::tan),
    ("asin", Scalar::asin, Scalar::asin),
    ("acos", Scalar::acos, Scalar::acos),
    ("atan", Scalar::atan, Scalar::atan),
    ("sinh", Scalar::sinh, Scalar::sinh),
    ("cosh", Scalar::cosh, Scalar::cosh),
    ("tanh", Scalar::tanh, Scalar::tanh),
    ("floor", Scalar::floor, Scalar::floor),
    ("ceil", Scalar::ceil, Scalar::ceil),
    ("abs", Scalar::abs, Scalar::abs),
    ("square", Scalar::square, Scalar::square),
];

/// Every operation on two numbers.
const OPERATIONS: [Operation; 7] = [
    ("plus", |a, b| a + b, |a, b| a + b),
    ("minus", |a, b| a - b, |a, b| a - b),
    ("times", |a, b| a * b, |a, b| a * b),
    ("over", |a, b| a / b, |a, b| a / b),
    ("smaller", Scalar::smaller, Scalar::smaller),
    ("larger", Scalar::larger, Scalar::larger),
    ("pow", Scalar::pow, Scalar::pow),
];

/// The point that lies at `share` of the way through the interval.
fn inside(interval: Interval, share: f64) -> f64 {
    (interval.lower() + share * (interval.upper() - interval.lower()))
        .clamp(interval.lower(), interval.upper())
}

/// Intervals of very different sizes, often with a bound at zero or one.
fn any_interval() -> impl Strategy<Value = Interval> {
    let bound = || {
        prop_oneof![
            4 => -3.0..3.0_f64,
            2 => -1e3..1e3_f64,
            1 => Just(0.0),
            1 => Just(1.0),
            1 => Just(2.0),
            1 => -1e-8..1e-8_f64,
        ]
    };
    let near = (bound(), 0.0..0.1_f64).prop_map(|(from, width)| between(from, from + width));
    prop_oneof![
        (bound(), bound()).prop_map(|(a, b)| between(a, b)),
        near,
        bound().prop_map(Interval::point)
    ]
}

proptest! {
    #![proptest_config(repeatable())]

    #[test]
    fn a_function_of_a_point_inside_lies_inside(x in any_interval(), share in 0.0..=1.0_f64) {
        let point = inside(x, share);
        for (name, of_interval, of_float) in FUNCTIONS {
            let (image, value) = (of_interval(x), of_float(point));
            prop_assert!(value.is_nan() || image.contains(value), "{name} {x:?}: {image:?}, {point} {value}");
            prop_assert!(image.lower() <= image.upper());
        }
    }

    #[test]
    fn a_function_of_a_part_lies_in_that_of_the_whole(x in any_interval(), from in 0.0..=1.0_f64, to in 0.0..=1.0_f64) {
        let part = between(inside(x, from), inside(x, to));
        for (name, of_interval, of_float) in FUNCTIONS {
            // A part outside of the domain answers everything.
            let outside = of_float(part.lower()).is_nan() || of_float(part.upper()).is_nan()
                || of_float(part.upper()).is_infinite();
            let (narrow, wide) = (of_interval(part), of_interval(x));
            prop_assert!(outside || wide.encloses(narrow), "{name} {x:?} {part:?}: {wide:?} {narrow:?}");
        }
    }

    #[test]
    fn an_operation_on_points_inside_lies_inside(
        x in any_interval(), y in any_interval(), at in 0.0..=1.0_f64, at_y in 0.0..=1.0_f64,
    ) {
        let (a, b) = (inside(x, at), inside(y, at_y));
        for (name, of_intervals, of_floats) in OPERATIONS {
            let (image, value) = (of_intervals(x, y), of_floats(a, b));
            let defined = !value.is_nan() && (value.is_finite() || name == "pow" && a != 0.0);
            prop_assert!(!defined || image.contains(value), "{name} {x:?} {y:?}: {image:?}, {a} {b} {value}");
            let narrow = of_intervals(Interval::point(a), Interval::point(b));
            prop_assert!(!defined || image.encloses(narrow), "{name} {x:?} {y:?}: {image:?} {narrow:?}");
        }
    }

    #[test]
    fn a_choice_between_cases_holds_the_one_taken(
        x in any_interval(), bound in any_interval(), at in 0.0..=1.0_f64, at_bound in 0.0..=1.0_f64,
    ) {
        let (then, otherwise) = (Interval::ONE, Interval::ENTIRE);
        let chosen = x.if_less(bound, then, otherwise);
        if inside(x, at) < inside(bound, at_bound) {
            prop_assert!(chosen.encloses(then));
        } else {
            prop_assert_eq!(chosen, otherwise);
        }
    }
}

#[test]
fn elementary_functions_hold_the_high_precision_values_tightly() {
    let float = |bits: &str| f64::from_bits(u64::from_str_radix(bits, 16).expect("bits"));
    let mut compared = 0;
    for row in include_str!("data/elementary.csv").lines().skip(1) {
        let columns: Vec<&str> = row.split(',').collect();
        let (x, down) = (float(columns[1]), float(columns[3]));
        let up = if columns[4] == "1" { down } else { down.next_up() };
        let image = match FUNCTIONS.iter().find(|(name, ..)| *name == columns[0]) {
            Some((_, function, _)) => function(Interval::point(x)),
            None => Interval::point(x).pow(Interval::point(float(columns[2]))),
        };
        assert!(image.lower() <= down && up <= image.upper(), "{row}: {image:?} {down}");
        // Beyond 2^53 turns and near poles nothing is known; reciprocals of powers widen twice.
        let steps = image.upper().to_bits().abs_diff(image.lower().to_bits());
        let pole = columns[0] == "tan" && down.abs() > 1e7;
        let known = x.abs() < 1e15 && down != 0.0 && !pole;
        assert!(!known || steps <= 30, "{row}: {image:?} is {steps} floats wide");
        compared += 1;
    }
    assert!(compared > 2000);
}

#[test]
fn the_functions_of_libm_err_by_at_most_two_units() {
    let float = |bits: &str| f64::from_bits(u64::from_str_radix(bits, 16).expect("bits"));
    let mut worst = 0_u64;
    for row in include_str!("data/elementary.csv").lines().skip(1) {
        let columns: Vec<&str> = row.split(',').collect();
        let (x, down) = (float(columns[1]), float(columns[3]));
        let value = match FUNCTIONS.iter().find(|(name, ..)| *name == columns[0]) {
            Some((_, _, function)) => function(x),
            None => x.pow(float(columns[2])),
        };
        // The true value lies between `down` and the float above.
        let [down, up, value] = [down, down.next_up(), value].map(f64::to_bits);
        let neighbours = [down, if columns[4] == "1" { down } else { up }];
        worst = worst.max(neighbours.map(|near| near.abs_diff(value)).into_iter().min().unwrap());
    }
    println!("libm: at most {worst} floats from the nearer neighbour of the true value");
    // One float from a neighbour is less than two units from the true value.
    assert!(worst <= 1);
}

#[test]
fn the_exponential_holds_the_high_precision_values() {
    let float = |bits: &str| f64::from_bits(u64::from_str_radix(bits, 16).expect("bits"));
    for row in include_str!("data/exp_f64.csv").lines().skip(1) {
        let columns: Vec<&str> = row.split(',').collect();
        let image = Scalar::exp(Interval::point(float(columns[1])));
        let nearest = float(columns[3]);
        // The true value is off the nearest float towards the side of the remainder.
        let remainder: f64 = columns[5].parse().unwrap_or(0.0);
        assert!(image.contains(nearest), "{row}: {image:?}");
        assert!(remainder <= 0.0 || image.upper() > nearest || nearest == f64::INFINITY, "{row}");
        assert!(remainder >= 0.0 || image.lower() < nearest, "{row}");
    }
}

#[test]
fn waves_reach_their_tops_and_bottoms_only_where_they_are() {
    let sine = |lower: f64, upper: f64| Scalar::sin(between(lower, upper));
    assert_eq!(sine(0.0, 2.0).upper(), 1.0);
    assert!(sine(0.0, 1.5).upper() < 1.0 && sine(1.6, 3.0).upper() < 1.0);
    assert_eq!(sine(-2.0, 0.0).lower(), -1.0);
    assert_eq!(sine(0.0, 5.0), between(-1.0, 1.0));
    assert_eq!(Scalar::cos(between(3.0, 3.2)).lower(), -1.0);
    assert_eq!(Scalar::cos(Interval::ENTIRE), between(-1.0, 1.0));
    assert_eq!(Scalar::tan(between(1.5, 1.6)), Interval::ENTIRE);
    assert!(Scalar::tan(between(-1.5, 1.5)).is_bounded());
}

#[test]
fn grades_of_exponential_form_stay_between_zero_and_one() {
    for x in
        [between(-1e3, 0.0), Interval::ZERO, between(-1e-20, 0.0), between(-f64::INFINITY, -1.0)]
    {
        assert!(Interval::UNIT.encloses(Scalar::exp(x)), "{x:?}");
    }
    assert_eq!(Scalar::exp(Interval::ZERO), Interval::ONE);
}

#[test]
fn an_argument_outside_of_the_domain_adds_nothing() {
    let partly = between(-1.0, 4.0);
    assert_eq!(Scalar::sqrt(partly), between(0.0, 2.0));
    assert_eq!(Scalar::ln(between(-1.0, 1.0)), between(f64::NEG_INFINITY, 0.0));
    for outside in [
        Scalar::sqrt(-Interval::ONE),
        Scalar::ln(Interval::ZERO),
        Scalar::asin(Interval::point(2.0)),
    ] {
        assert_eq!(outside, Interval::ENTIRE);
    }
    assert_eq!(Scalar::acos(between(1.0, 3.0)), Interval::ZERO);
}

//! The exponential function against high-precision values made by `oracles/`.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use fspid_numeric::Scalar;

/// Rows of a reference file without its header.
fn rows(text: &str) -> impl Iterator<Item = Vec<&str>> {
    text.lines().skip(1).map(|line| line.split(',').collect())
}

/// Distance in units in the last place of the correctly rounded result, its own rounding removed.
fn error_in_ulps(ours_bits: i64, rounded_bits: i64, remainder: f64) -> f64 {
    (ours_bits - rounded_bits) as f64 - remainder
}

#[test]
fn exp_is_within_one_unit_in_the_last_place() {
    let rows = rows(include_str!("data/exp_f64.csv"));
    let mut worst = 0.0_f64;
    for row in rows {
        let bits = |text: &str| u64::from_str_radix(text, 16).expect("hexadecimal");
        let (x, rounded) = (f64::from_bits(bits(row[1])), f64::from_bits(bits(row[3])));
        let ours = Scalar::exp(x);
        if row[5].is_empty() || rounded == 0.0 {
            assert_eq!(ours, rounded, "{row:?}");
            continue;
        }
        let remainder = row[5].parse().expect("a number");
        let ulps = error_in_ulps(ours.to_bits() as i64, rounded.to_bits() as i64, remainder);
        assert!(ulps.abs() <= 1.0, "{row:?}: {ours:e} is {ulps} ulp off");
        worst = worst.max(ulps.abs());
    }
    println!("worst error of exp in f64: {worst:.3} ulp");
}

#[test]
fn exp_is_within_one_unit_in_the_last_place_in_single_precision() {
    let rows = rows(include_str!("data/exp_f32.csv"));
    let mut worst = 0.0_f64;
    for row in rows {
        let bits = |text: &str| u32::from_str_radix(text, 16).expect("hexadecimal");
        let (x, rounded) = (f32::from_bits(bits(row[1])), f32::from_bits(bits(row[3])));
        let ours = Scalar::exp(x);
        if row[5].is_empty() || rounded == 0.0 {
            assert_eq!(ours, rounded, "{row:?}");
            continue;
        }
        let remainder = row[5].parse().expect("a number");
        let ulps = error_in_ulps(ours.to_bits().into(), rounded.to_bits().into(), remainder);
        assert!(ulps.abs() <= 1.0, "{row:?}: {ours:e} is {ulps} ulp off");
        worst = worst.max(ulps.abs());
    }
    println!("worst error of exp in f32: {worst:.3} ulp");
}

#[test]
fn exp_of_what_is_no_number_is_no_number() {
    assert!(Scalar::exp(f64::NAN).is_nan() && Scalar::exp(f32::NAN).is_nan());
    assert_eq!((Scalar::exp(f64::INFINITY), Scalar::exp(f64::NEG_INFINITY)), (f64::INFINITY, 0.0));
    assert_eq!((Scalar::exp(f32::INFINITY), Scalar::exp(f32::NEG_INFINITY)), (f32::INFINITY, 0.0));
}

//! A network in the place of rules: by hand, its laws, and what is refused.
#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use fspid_fuzzy::{
    FuzzyError, Increments, LARGEST_WEIGHT, Network, NetworkRow, OutOfRange, Supervisor, UNITS,
};
use proptest::prelude::*;

const ZEROS: NetworkRow<f64> = [0.0; UNITS];

fn supervisor(rows: [NetworkRow<f64>; 6], policy: OutOfRange) -> Supervisor<f64> {
    Supervisor::of_network(&Network::new(rows).expect("allowed"), 3.0, policy).expect("allowed")
}

fn delta(supervisor: &Supervisor<f64>, error: f64, change: f64) -> [f64; 3] {
    let Increments { kp, ki, kd } = supervisor.infer(error, change).expect("finite").delta;
    [kp, ki, kd]
}

fn first(weight: f64) -> NetworkRow<f64> {
    let mut row = ZEROS;
    row[0] = weight;
    row
}

#[test]
fn an_answer_is_the_formula_by_hand() {
    // u = 2 * 0.5 + 4 * 0.5 = 3 in the first unit; softsign(1 + 3) = 4/5, softsign(1 - 3) = -2/3, softsign(1) = 1/2.
    let rows = [first(2.0), first(4.0), first(1.0), first(3.0), first(-3.0), ZEROS];
    let supervisor = supervisor(rows, OutOfRange::Clamp);
    let unit: f64 = 4.0 / 5.0 - 2.0 / 3.0 - 1.0;
    let expected = 3.0 * (3.0 * unit) / (1.0 + (3.0 * unit).abs());
    let [kp, ki, kd] = delta(&supervisor, 1.5, 1.5);
    assert!((kp - expected).abs() < 1e-15 && kp < -2.0, "{kp} {expected}");
    assert_eq!((ki, kd), (-kp, 0.0));
}

fn rows(size: f64) -> impl Strategy<Value = [NetworkRow<f64>; 6]> {
    prop::array::uniform6(prop::array::uniform8(-size..size))
}

proptest! {
    #[test]
    fn a_network_is_silent_at_rest_mirrored_and_within_its_range(
        rows in prop_oneof![rows(1.0), rows(20.0), rows(LARGEST_WEIGHT)],
        error in -4.0..4.0,
        change in -4.0..4.0,
    ) {
        for policy in [OutOfRange::Clamp, OutOfRange::Evaluate] {
            let supervisor = supervisor(rows, policy);
            prop_assert_eq!(delta(&supervisor, 0.0, 0.0), [0.0; 3]);
            prop_assert_eq!(delta(&supervisor, -0.0, 0.0), [0.0; 3]);
            let answer = delta(&supervisor, error, change);
            prop_assert!(answer.iter().all(|increment| increment.abs() <= 3.0), "{:?}", answer);
            let mirrored = delta(&supervisor, -error, -change);
            prop_assert_eq!(answer.map(f64::to_bits), mirrored.map(f64::to_bits));
            // Beyond the range the answer is that at its end.
            let within = [error, change].map(|input: f64| input.clamp(-3.0, 3.0));
            let inside = delta(&supervisor, within[0], within[1]);
            prop_assert_eq!(answer.map(f64::to_bits), inside.map(f64::to_bits));
            let told = supervisor.infer(error, change).expect("finite");
            let is_outside = within != [error, change];
            prop_assert_eq!(told.clamped, is_outside && policy == OutOfRange::Clamp);
            prop_assert!(!told.underflowed);
        }
    }

    #[test]
    fn single_precision_is_near_double(
        rows in rows(3.0),
        error in -3.0..3.0_f32,
        change in -3.0..3.0_f32,
    ) {
        let rounded = rows.map(|row| row.map(|weight| weight as f32));
        let network = Network::new(rounded).expect("allowed");
        let single = Supervisor::of_network(&network, 3.0_f32, OutOfRange::Clamp).expect("allowed");
        let single = single.infer(error, change).expect("finite").delta;
        let double = delta(&supervisor(rows, OutOfRange::Clamp), f64::from(error), f64::from(change));
        for (single, double) in [single.kp, single.ki, single.kd].into_iter().zip(double) {
            prop_assert!((f64::from(single) - double).abs() < 1e-4, "{} {}", single, double);
        }
    }
}

#[test]
fn a_weight_that_is_no_number_or_too_large_is_refused_by_its_place() {
    for found in [f64::NAN, f64::INFINITY, -2.0 * LARGEST_WEIGHT] {
        let mut rows = [ZEROS; 6];
        rows[4][6] = found;
        let error = Network::new(rows).expect_err("not allowed");
        assert!(matches!(error, FuzzyError::Weight { row: "delta_ki", unit: 7, .. }), "{error:?}");
        assert!(error.to_string().starts_with("delta_ki: the weight of unit 7 is"), "{error}");
    }
    let network = Network::new([[LARGEST_WEIGHT; UNITS]; 6]).expect("allowed");
    for range in [0.0, f64::NAN, f64::INFINITY] {
        assert!(Supervisor::of_network(&network, range, OutOfRange::Clamp).is_err());
    }
    let refusing = Supervisor::of_network(&network, 1.0, OutOfRange::Error).expect("allowed");
    assert!(refusing.infer(1.5, 0.0).is_err() && refusing.infer(0.0, f64::NAN).is_err());
}

#[test]
fn a_network_is_not_written_out_as_rules() {
    let network = supervisor([ZEROS; 6], OutOfRange::Clamp);
    assert!(network.table().is_none() && network.numbers().is_none() && !network.has_labels());
    assert_eq!(network.network().map(|it| *it.rows()), Some([ZEROS; 6]));
    #[cfg(feature = "alloc")]
    assert!(fspid_fuzzy::system::Parts::try_from(&network).is_err());
}

//! However far sets are sent, what is learned is a system with its sets in order.

use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::{Membership, Parts, System};
use fspid_tune::anfis::{AnfisError, Curve, Data, Order, Plan, Stop, grid, learn};
use proptest::prelude::*;

use crate::anfis::{axis, learned, samples};

/// Parameters of the sets of an input.
fn sets(parts: &Parts) -> Vec<&[f64]> {
    fn params(membership: &Membership) -> &[f64] {
        match membership {
            Membership::Shape { params, .. } => params,
            Membership::Formula { .. } => &[],
        }
    }
    parts.inputs[0].terms.iter().map(|term| params(&term.membership)).collect()
}

/// Sets of another kind in place of those of the grid.
fn with_sets(kind: ShapeKind, sets: &[&[f64]]) -> Parts {
    let mut parts = grid(&[axis("x", 0.0, 1.0, sets.len())], &["y"], Curve::Bell, Order::Zero);
    for (term, params) in parts.inputs[0].terms.iter_mut().zip(sets) {
        term.membership = Membership::Shape { kind, params: params.to_vec(), height: 1.0 };
    }
    parts
}

#[test]
fn triangles_move_where_they_have_a_slope() {
    // A kink at 0.3, where no set has its peak at first.
    let data = samples(0.0, 1.0, 51, |x| (x - 0.3).abs());
    let start = grid(&[axis("x", 0.0, 1.0, 3)], &["y"], Curve::Triangle, Order::Zero);
    let found = learned(&start, &data, &Plan { epochs: 150, ..Plan::default() });
    let (first, last) = (found.history[0].training, found.best().training);
    assert!(last < 0.1 * first, "{first} to {last}");
    // Corners of sets have gone where the data have their kink.
    let sets = sets(&found.parts);
    let nearest = sets.concat().iter().map(|x| (x - 0.3).abs()).fold(f64::INFINITY, f64::min);
    assert!(nearest < 0.005, "{sets:?}");
}

#[test]
fn sides_of_a_trapezoid_never_cross_and_feet_at_infinity_stay() {
    let infinity = f64::INFINITY;
    let start = with_sets(
        ShapeKind::Trapezoid,
        &[
            &[-infinity, -infinity, 0.2, 0.6],
            &[0.2, 0.5, 0.55, 0.8],
            &[0.5, 0.9, infinity, infinity],
        ],
    );
    let data = samples(0.0, 1.0, 41, |x| if x < 0.4 { 0.0 } else { 1.0 });
    for step in [0.02, 0.3] {
        let found = learned(&start, &data, &Plan { epochs: 60, step, ..Plan::default() });
        assert!(found.best().training < 0.7 * found.history[0].training, "{:?}", found.best());
        for (set, before) in sets(&found.parts).into_iter().zip(sets(&start)) {
            assert!(set.is_sorted(), "{set:?}");
            let stays = |(now, before): (&f64, &f64)| before.is_finite() || now == before;
            assert!(set.iter().zip(before).all(stays), "{set:?}");
        }
    }
}

#[test]
fn a_gap_between_sets_is_never_opened_over_data() {
    // Two triangles that only just overlap at the data in the middle.
    let start = with_sets(ShapeKind::Triangle, &[&[-1.0, 0.0, 0.52], &[0.48, 1.0, 2.0]]);
    let data = samples(0.0, 1.0, 21, |x| if x < 0.51 { 1.0 + x } else { 0.0 });
    let found = learned(&start, &data, &Plan { epochs: 40, step: 0.2, ..Plan::default() });
    assert!(matches!(found.stop, Stop::Epochs | Stop::Stuck | Stop::Flat), "{}", found.stop);
    let system = System::new(found.parts).expect("a system");
    let mut workspace = system.workspace();
    for row in data.rows() {
        let answers = system.evaluate(row.inputs, &mut workspace).expect("finite");
        assert!(answers[0].value.is_some(), "{:?}", row.inputs);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn any_data_and_any_step_leave_a_system_with_its_sets_in_order(
        curve in prop::sample::select(vec![Curve::Gaussian, Curve::Bell, Curve::Triangle]),
        targets in prop::collection::vec(-1e3..1e3_f64, 5..20),
        step in 1e-3..10.0_f64,
        order in prop::sample::select(vec![Order::Zero, Order::One]),
    ) {
        let mut data = Data::new(1, 1);
        for (k, target) in targets.iter().enumerate() {
            data.push(&[k as f64 / (targets.len() - 1) as f64], &[*target]).expect("finite");
        }
        let start = grid(&[axis("x", 0.0, 1.0, 4)], &["y"], curve, order);
        let found = learn(&start, &data, &Plan { epochs: 12, step, ..Plan::default() });
        let found = match found {
            Ok(found) => found,
            Err(AnfisError::Overflow) => return Ok(()),
            Err(error) => panic!("{error}"),
        };
        prop_assert!(System::new(found.parts.clone()).is_ok());
        prop_assert!(found.best().training <= found.history[0].training);
        // The middle of a triangle's corners, the centre of the others.
        let place = |set: &[f64]| match curve {
            Curve::Triangle => set.iter().sum::<f64>() / 3.0,
            _ => set[0],
        };
        let places: Vec<f64> = sets(&found.parts).into_iter().map(place).collect();
        prop_assert!(places.windows(2).all(|pair| pair[0] < pair[1]), "{places:?}");
        if curve == Curve::Bell {
            prop_assert!(sets(&found.parts).iter().all(|set| set[1] > 0.0 && set[2] > 0.0));
        }
    }
}

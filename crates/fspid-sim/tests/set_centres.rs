//! Bent inputs of a supervisor against general fuzzy systems whose triangles are moved.

use fspid_core::fuzzy::{Defuzzifier, NumberTable, OutOfRange, RuleTable, Supervisor};
use fspid_core::{Gains, InputSets, SelfTuner, SetCentres, TunerSettings};
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::{Answer, Membership, Parts, System};

const PRINTED: &str = include_str!("../../../data/rule-tables/printed.toml");
const RANGE: f64 = 5.0;

/// The paper's rules with triangles from neighbour to neighbour, their centres at these places.
fn triangles(centres: [[f64; 7]; 2]) -> System {
    let texts: Vec<&str> = PRINTED.split("\"\"\"").collect();
    let table = RuleTable::parse([texts[1], texts[3], texts[5]]).expect("the shipped table");
    let supervisor = Supervisor::new(&table, RANGE, Defuzzifier::Exact, OutOfRange::Clamp);
    let mut parts = Parts::try_from(&supervisor.expect("allowed")).expect("rules");
    for (input, centres) in parts.inputs.iter_mut().zip(centres) {
        for (at, term) in input.terms.iter_mut().enumerate() {
            let before = if at == 0 { centres[0] - 1.0 } else { centres[at - 1] };
            let after = if at == 6 { centres[6] + 1.0 } else { centres[at + 1] };
            let params = vec![before, centres[at], after];
            term.membership = Membership::Shape { kind: ShapeKind::Triangle, params, height: 1.0 };
        }
    }
    System::new(parts).expect("sound")
}

fn centres(small: f64, medium: f64) -> [f64; 7] {
    [-1.0, -medium, -small, 0.0, small, medium, 1.0].map(|part| part * RANGE)
}

#[test]
fn bending_the_input_of_even_triangles_is_the_same_as_moving_the_triangles() {
    let even = centres(1.0 / 3.0, 2.0 / 3.0);
    for [(small, medium), (other_small, other_medium)] in
        [[(0.1, 0.5), (0.5, 0.6)], [(0.3, 0.9), (1.0 / 3.0, 2.0 / 3.0)], [(0.6, 0.95), (0.05, 0.1)]]
    {
        let moved = triangles([centres(small, medium), centres(other_small, other_medium)]);
        let fixed = triangles([even, even]);
        let places = [(small, medium), (other_small, other_medium)]
            .map(|(small, medium)| SetCentres::new(small, medium).expect("in order"));
        let (mut one, mut other) = (moved.workspace(), fixed.workspace());
        for row in -25..=25_i32 {
            for column in -25..=25_i32 {
                let input = [row, column].map(|k| 0.2 * f64::from(k) - 0.01);
                let warp = [0, 1].map(|k| places[k].warp(input[k], RANGE));
                let expected = moved.evaluate(&input, &mut one).expect("inside");
                let found = fixed.evaluate(&warp, &mut other).expect("inside");
                for (found, expected) in found.iter().zip(expected) {
                    let value = |answer: &Answer| answer.value.expect("some rule fires");
                    let (found, expected) = (value(found), value(expected));
                    // The grades differ by the rounding of quotients.
                    assert!((found - expected).abs() < 1e-11, "{input:?}: {found} {expected}");
                }
            }
        }
    }
}

#[test]
fn a_tuner_with_numbers_and_uneven_sets_answers_as_a_system_whose_triangles_are_moved() {
    let grid = |seed: usize| {
        std::array::from_fn(|i| {
            std::array::from_fn(|j| ((i * 7 + j + seed) * 37 % 101) as f64 / 10.1 - 5.0)
        })
    };
    let numbers = NumberTable::new([1, 2, 3].map(grid)).expect("finite");
    let supervisor = Supervisor::of_numbers(&numbers, RANGE, OutOfRange::Clamp).expect("allowed");
    let mut parts = Parts::try_from(&supervisor).expect("rules");
    let moved = [centres(0.1, 0.5), centres(0.5, 0.9)];
    for (input, centres) in parts.inputs.iter_mut().zip(moved) {
        for (at, term) in input.terms.iter_mut().enumerate() {
            let (kind, params) = match at {
                0 => (ShapeKind::LinearZ, vec![centres[0], centres[1]]),
                6 => (ShapeKind::LinearS, vec![centres[5], centres[6]]),
                at => (ShapeKind::Triangle, centres[at - 1..=at + 1].to_vec()),
            };
            term.membership = Membership::Shape { kind, params, height: 1.0 };
        }
    }
    let general = System::new(parts).expect("sound");
    let places = |small, medium| SetCentres::new(small, medium).ok();
    let settings = TunerSettings {
        input_sets: InputSets { error: places(0.1, 0.5), change: places(0.5, 0.9) },
        ..TunerSettings::literal()
    };
    let tuner = SelfTuner::new(Gains::ZERO, supervisor, settings).expect("allowed");
    let mut workspace = general.workspace();
    for row in -28..=28_i32 {
        for column in -28..=28_i32 {
            let [error, change] = [row, column].map(|k| 0.2 * f64::from(k) - 0.01);
            let found = tuner.increments_where_seen(error, change).expect("clamped");
            let expected = general.evaluate(&[error, change], &mut workspace).expect("clamped");
            for (found, expected) in [found.kp, found.ki, found.kd].into_iter().zip(expected) {
                let expected = expected.value.expect("some rule fires");
                // The grades differ by the rounding of quotients.
                assert!((found - expected).abs() < 1e-11, "{error} {change}: {found} {expected}");
            }
        }
    }
}

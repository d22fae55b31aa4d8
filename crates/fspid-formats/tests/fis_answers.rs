//! What systems from `.fis` files answer, against values computed from the same numbers by a script
//! that never saw the reader (`oracles/make_fis.py`).

use fspid_formats::fis;
use fspid_fuzzy::system::{Answer, System};

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/fis");

fn system(name: &str) -> System {
    let text = std::fs::read_to_string(format!("{FOLDER}/{name}.fis")).expect("a fixture");
    let reading = fis::read(&text).unwrap_or_else(|problems| panic!("{name}:\n{problems}"));
    System::new(reading.parts).expect("a system that can be built")
}

/// Inputs and answers, line by line.
fn expected(name: &str) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(format!("{FOLDER}/{name}.csv")).expect("a fixture");
    let row = |line: &str| line.split(',').map(|cell| cell.parse().expect("a number")).collect();
    text.lines().skip(1).map(row).collect()
}

fn answers(system: &System, inputs: &[f64]) -> Vec<f64> {
    let mut workspace = system.workspace();
    let answers = system.evaluate(inputs, &mut workspace).expect("finite inputs");
    answers.iter().map(|Answer { value, .. }| value.expect("an answer")).collect()
}

/// Sums of 101 products in doubles against 40 digits, for spans up to 100.
const TOLERANCE: f64 = 1e-12;

fn agrees(name: &str) {
    let system = system(name);
    let inputs = system.parts().inputs.len();
    for row in expected(name) {
        let (question, right) = row.split_at(inputs);
        let spans = system.parts().outputs.iter().map(|o| o.universe.expect("a range").span());
        for ((found, right), span) in answers(&system, question).iter().zip(right).zip(spans) {
            let error = (found - right).abs();
            assert!(error <= TOLERANCE * span, "{name} at {question:?}: {found}, not {right}");
        }
    }
}

#[test]
fn the_paper_s_controller_answers_by_matlab_s_rule() {
    agrees("paper");
}

#[test]
fn hedges_negations_weights_products_and_sums_answer_as_defined() {
    agrees("heater");
}

#[test]
fn numbers_and_linear_functions_answer_as_defined() {
    agrees("sugeno");
}

#[test]
fn the_tip_is_the_one_printed_in_matlab_s_documentation() {
    agrees("tipper");
    let system = system("tipper");
    for (question, tip) in [([2.0, 1.0], 7.0169), ([4.0, 5.0], 14.4585), ([7.0, 8.0], 20.3414)] {
        let found = answers(&system, &question)[0];
        assert!((found - tip).abs() < 0.5e-4, "{question:?}: {found}, not {tip}");
    }
}

#[test]
fn the_paper_s_controller_with_the_integral_answers_the_handbook_s_values() {
    let mut parts = system("paper").parts().clone();
    for output in &mut parts.outputs {
        output.defuzzifier = Default::default();
    }
    let exact = System::new(parts).expect("allowed");
    for (question, right) in [
        ([0.0, 0.0], [0.216_500_696_638, 0.0, -1.666_610_153_842]),
        ([5.0, 5.0], [-4.234_089_847_555, 4.444_274_913_314, 3.902_748_775_224]),
        ([1.0, -2.0], [0.995_958_158_631, -0.608_034_418_811, -0.642_500_373_380]),
        ([-3.3, 0.7], [1.628_328_059_925, -1.628_352_085_306, -3.151_303_923_865]),
    ] {
        for (found, right) in answers(&exact, &question).iter().zip(right) {
            assert!((found - right).abs() < 1e-11, "{question:?}: {found}, not {right}");
        }
    }
}

//! A small invented model with each feature of the subset; its check figures come from `oracles/make_daveml.py`.
#![allow(clippy::unwrap_used, clippy::float_cmp, clippy::indexing_slicing, reason = "a test")]

use fspid_daveml::document::Role;
use fspid_daveml::{EvaluateError, Model, Reading};
use fspid_numeric::scalar::Dual;
use proptest::prelude::*;

fn toy() -> Reading {
    fspid_daveml::read(include_str!("data/toy.dml")).unwrap()
}

fn answers(model: &Model, inputs: [f64; 5]) -> [f64; 5] {
    let mut outputs = [0.0; 5];
    model.evaluate(&inputs, &mut outputs).unwrap();
    outputs
}

#[test]
fn the_check_cases_pass() {
    let report = toy().model.check();
    assert_eq!(report.shots.len(), 5);
    assert!(report.passed(), "{report}");
}

#[test]
fn a_check_case_that_is_wrong_is_told_with_what_was_found() {
    let text = include_str!("data/toy.dml").replacen(
        "<varID>stall</varID> <signalValue>0",
        "<varID>stall</varID> <signalValue>1",
        1,
    );
    let report = fspid_daveml::read(&text).unwrap().model.check();
    assert!(!report.passed());
    assert_eq!(
        report.to_string(),
        "4 of 5 check cases passed; largest deviation 1e6 of its tolerance: stall is 0 nd, expected 1 ± 0.000001 \
         (`between all breakpoints`)"
    );
}

#[test]
fn what_the_file_says_about_itself_is_kept() {
    let document = toy().document;
    assert_eq!(document.header.name, "Toy & test model");
    assert_eq!(document.header.authors[0].organisation, "The fspid developers");
    assert_eq!(document.header.description, "Coefficients of nothing that flies.");
    assert_eq!(document.header.references[0].address, "http://example.org/nothing");
    assert_eq!(document.header.modifications[0].description, "Began.");
    assert_eq!(document.tables[0].provenance.references, ["REF01"]);
    assert_eq!(document.variables[1].symbol, "α");
    assert_eq!(document.variables[3].roles, [Role::Control]);
}

#[test]
fn inputs_and_outputs_stand_in_the_order_of_the_file() {
    let model = toy().model;
    let ids = |ports: Vec<&fspid_daveml::Port>| {
        ports.iter().map(|port| port.id.clone()).collect::<Vec<_>>()
    };
    assert_eq!(ids(model.inputs().collect()), ["V", "alpha", "M", "flap", "gust"]);
    assert_eq!(ids(model.outputs().collect()), ["CL", "CD", "Cm", "path", "trig"]);
}

#[test]
fn the_box_is_where_all_tables_of_a_variable_have_values() {
    let model = toy().model;
    let bounds: Vec<_> = model
        .bounds()
        .iter()
        .map(|bounds| (model.variables()[bounds.variable].id.clone(), bounds.min, bounds.max))
        .collect();
    assert_eq!(
        bounds,
        [("alpha".into(), -10.0, 25.0), ("M".into(), 0.3, 0.8), ("flap".into(), 0.0, 30.0)]
    );
}

#[test]
fn slices_of_the_wrong_length_are_refused() {
    let model = toy().model;
    let few = model.evaluate(&[1.0], &mut [0.0; 5]);
    assert_eq!(few, Err(EvaluateError::Inputs { found: 1, expected: 5 }));
    let room = model.evaluate(&[1.0; 5], &mut [0.0; 4]);
    assert_eq!(room, Err(EvaluateError::Outputs { found: 4, expected: 5 }));
}

#[test]
fn computing_does_not_use_the_heap() {
    let model = toy().model;
    let used = allocation_counter::measure(|| {
        let _ = answers(&model, [80.0, 3.7, 0.47, 12.5, 2.0]);
    });
    assert_eq!(used.count_total, 0);
}

#[test]
fn an_input_that_is_not_a_number_spoils_what_depends_on_it_and_nothing_else() {
    let outputs = answers(&toy().model, [80.0, 3.7, 0.47, 12.5, f64::NAN]);
    assert_eq!(outputs.map(f64::is_nan), [false, false, true, true, false]);
}

proptest! {
    /// Central differences err by the third derivative times 10⁻¹² and by rounding over 10⁻⁶.
    #[test]
    fn derivatives_are_those_of_differences(alpha in 1.0..9.0, mach in 0.61..0.79, flap in 1.0..29.0, gust in 0.5..5.0) {
        let model = toy().model;
        let at = [80.0, alpha, mach, flap, gust];
        let mut exact = [Dual::fixed(0.0); 5];
        model.evaluate(&Dual::variables(at), &mut exact).unwrap();
        for input in 0..5 {
            let (mut ahead, mut behind) = (at, at);
            ahead[input] += 1e-6;
            behind[input] -= 1e-6;
            let (above, below) = (answers(&model, ahead), answers(&model, behind));
            for output in 0..5 {
                let slope = (above[output] - below[output]) / 2e-6;
                prop_assert!((exact[output].derivative[input] - slope).abs() < 1e-7);
            }
        }
    }
}

#[test]
fn what_is_assumed_and_left_out_is_noted_with_its_place() {
    let reading = fspid_daveml::read(include_str!("data/notes.dml")).unwrap();
    let notes: Vec<_> = reading.notes.iter().map(ToString::to_string).collect();
    assert_eq!(
        notes,
        [
            "3:3: `a` has neither value nor calculation: taken as an input; say <isInput/> if it is one",
            "5:5: <uncertainty> is left out: values are taken as certain",
            "10:5: `a` may be extrapolated, but min holds it inside of the breakpoints",
            "13:14: check case `s`: `b` is taken as 3",
        ]
    );
    assert!(reading.model.check().passed());
}

//! Every dialect and every quirk of `.fis` files, by example.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use fspid_formats::{Note, Reading, fis};
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::{
    Antecedent, Conclusion, Defuzzifier, FallbackValue, Membership, Sampling, Statement, Universe,
    Variable,
};
use fspid_fuzzy::{Hedge, OutOfRange, SNormKind, TNormKind};

const OCTAVE: &str = include_str!("data/fis/octave.fis");
const FUZZYLITE: &str = include_str!("data/fis/fuzzylite.fis");
const TYPE_2: &str = include_str!("data/fis/type2.fis");
const QUIRKS: &str = include_str!("data/fis/quirks.fis");
const PAPER: &str = include_str!("data/fis/paper.fis");
const SUGENO: &str = include_str!("data/fis/sugeno.fis");

fn read(text: &str) -> Reading {
    fis::read(text).unwrap_or_else(|problems| panic!("{problems}"))
}

fn notes(reading: &Reading) -> Vec<String> {
    reading.notes.iter().map(Note::to_string).collect()
}

fn noted(reading: &Reading, words: &str) -> bool {
    notes(reading).iter().any(|note| note.contains(words))
}

/// Kind and parameters of a term of an input.
fn shape(reading: &Reading, input: usize, term: usize) -> (ShapeKind, Vec<f64>) {
    match &reading.parts.inputs[input].terms[term].membership {
        Membership::Shape { kind, params, .. } => (*kind, params.clone()),
        Membership::Formula { .. } => panic!("a formula"),
    }
}

/// Statements of a rule as (input, term, hedges).
fn statements(reading: &Reading, rule: usize) -> Vec<(usize, usize, Vec<Hedge>)> {
    let one = |antecedent: &Antecedent| match antecedent {
        Antecedent::Is(Statement {
            variable: Variable::Input(input),
            term: Some(term),
            hedges,
        }) => (*input, *term, hedges.clone()),
        other => panic!("{other:?}"),
    };
    match &reading.parts.blocks[0].rules[rule].antecedent {
        Antecedent::All(parts) | Antecedent::Any(parts) => parts.iter().map(one).collect(),
        Antecedent::Is(_) => vec![one(&reading.parts.blocks[0].rules[rule].antecedent)],
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_file_answers_by_matlab_s_own_rule_and_says_so() {
    let reading = read(PAPER);
    for output in &reading.parts.outputs {
        assert_eq!(output.defuzzifier, Defuzzifier::Centroid(Sampling::Endpoints(101)));
        assert_eq!(output.fallback.value, FallbackValue::Middle);
    }
    assert!(reading.parts.inputs.iter().all(|input| input.out_of_range == OutOfRange::Evaluate));
    assert_eq!(
        notes(&reading),
        [
            "answers by MATLAB's rule: centroid over samples (endpoints:101), the middle of the range \
          where no rule fires, inputs outside their range as they are"
        ]
    );
}

#[test]
fn sigma_stands_before_the_centre() {
    let (kind, params) = shape(&read(PAPER), 0, 0);
    assert_eq!((kind, params), (ShapeKind::Gaussian, vec![-5.0, 0.707_768_166_906_682_5]));
}

#[test]
fn octave_s_spacing_quotes_norms_and_missing_version_are_read() {
    let reading = read(OCTAVE);
    let block = &reading.parts.blocks[0];
    assert!(block.and.is(TNormKind::EinsteinProduct) && block.or.is(SNormKind::EinsteinSum));
    let output = &reading.parts.outputs[0];
    assert_eq!(output.defuzzifier, Defuzzifier::Centroid(Sampling::Trapezoid(101)));
    assert_eq!(shape(&reading, 1, 1).1, [0.7, 0.1, 0.9, 0.1], "sigma and centre twice");
    assert_eq!(statements(&reading, 1)[0].2, [Hedge::Power(1.5)]);
    assert_eq!(statements(&reading, 1)[1].2, [Hedge::Not, Hedge::Somewhat]);
    assert_eq!(statements(&reading, 2)[1].2, [Hedge::Power(4.0)]);
    assert!(matches!(block.rules[2].antecedent, Antecedent::Any(_)));
}

#[test]
fn fuzzylite_s_shapes_norms_and_indices_are_read() {
    use ShapeKind::*;
    let reading = read(FUZZYLITE);
    let infinity = f64::INFINITY;
    let shapes: Vec<_> = (0..9).map(|term| shape(&reading, 0, term)).collect();
    let expected = [
        (Ramp, vec![0.0, 5.0]),
        (Rectangle, vec![2.0, 4.0]),
        (Cosine, vec![5.0, 3.0]),
        (Spike, vec![5.0, 2.0]),
        (Concave, vec![3.0, 8.0]),
        (Step, vec![5.0, -1.0]),
        (Points, vec![0.0, 0.0, 3.0, 1.0, 9.0, 0.25]),
        (Trapezoid, vec![5.0, 6.0, infinity, infinity]),
        (Trapezoid, vec![-infinity, 2.0, 2.0, 4.0]),
    ];
    assert_eq!(shapes, expected);
    assert_eq!(reading.parts.inputs[1].universe, None);
    assert!(noted(&reading, "an infinite range is read as no range"));
    assert!(reading.parts.blocks[0].and.is(TNormKind::HamacherProduct));
    assert!(reading.parts.outputs[0].aggregation.is(SNormKind::BoundedSum));
    assert!(noted(&reading, "`OrMethod` is missing; `max` is assumed"));
}

#[test]
fn codes_that_tools_read_in_different_ways_are_told() {
    let reading = read(FUZZYLITE);
    assert_eq!(statements(&reading, 0)[1].2, [Hedge::Seldom]);
    assert_eq!(statements(&reading, 2)[0].2, [Hedge::Any]);
    assert_eq!(statements(&reading, 3)[0].2, [Hedge::Power(3.0)]);
    assert_eq!(statements(&reading, 1), [(0, 1, vec![Hedge::Not])]);
    for words in
        ["47:7: `.01` is read as fuzzylite's `seldom`", "`.99` is read as", "`.30` is read as"]
    {
        assert!(noted(&reading, words), "{words}: {:?}", notes(&reading));
    }
}

#[test]
fn pairs_of_membership_functions_are_interval_sets() {
    let reading = read(TYPE_2);
    let term = &reading.parts.inputs[0].terms[0];
    let lower =
        Membership::Shape { kind: ShapeKind::Triangle, params: vec![-4.0, -2.0, 0.5], height: 0.8 };
    assert_eq!((term.name.as_str(), &term.lower), ("N", &Some(lower)));
    let same = &reading.parts.inputs[1].terms[1];
    assert_eq!(same.lower, None, "upper and lower are the same");
    let conclusions: Vec<_> =
        reading.parts.outputs[0].terms.iter().map(|term| &term.conclusion).collect();
    assert_eq!(*conclusions[0], Conclusion::Interval([-1.0, -0.75]));
    assert_eq!(*conclusions[1], Conclusion::Constant(0.0));
    assert!(noted(&reading, "type reduction ends at the same two points"));
    assert!(noted(&reading, "16:1: labels of lower membership functions are not kept"));
}

#[test]
fn a_type_reduction_that_answers_otherwise_is_refused() {
    let problems = fis::read(&TYPE_2.replace("EIASC", "NT")).unwrap_err();
    assert!(problems.to_string().starts_with(
        "13:15: `NT`: this type reduction is not computed here and would answer other numbers; \
         expected one of `Karnik-Mendel`, `KM`"
    ));
}

#[test]
fn a_missing_type_reduction_is_assumed_as_the_toolbox_assumes_it() {
    let reading = read(&TYPE_2.replace("TypeRedMethod='EIASC'\n", ""));
    assert!(noted(&reading, "`TypeRedMethod` is missing; `Karnik-Mendel` is assumed"));
}

#[test]
fn a_step_without_a_direction_is_refused() {
    let problems = fis::read(&FUZZYLITE.replace("[5.000 -inf]", "[5.000 0]")).unwrap_err();
    let message =
        "25:27: `0`: `binarymf` [threshold direction]: direction is 0.0; allowed is 1 or -1";
    assert_eq!(problems.to_string(), message);
}

#[test]
fn the_undescribed_files_of_newer_type_2_systems_are_refused_by_name() {
    let problems = fis::read(&SUGENO.replace("'sugeno'", "'sugenotype2'")).unwrap_err();
    let message =
        "3:6: `sugenotype2`: interval type-2 systems of MATLAB R2019b and later are not read";
    assert!(problems.to_string().starts_with(message), "{problems}");
}

#[test]
fn spacing_order_capitals_and_comments_do_not_matter() {
    let reading = read(QUIRKS);
    let parts = &reading.parts;
    assert_eq!(parts.name, "it's odd");
    assert_eq!(parts.inputs[1].name, "bare words");
    assert_eq!(parts.outputs[0].name, "speed-up factor (v1.0)");
    assert_eq!(parts.outputs[0].universe, Some(Universe { lower: -1.0, upper: 4.0 }));
    assert_eq!(parts.blocks[0].rules.len(), 3);
    assert_eq!(parts.blocks[0].rules[0].weight, 0.5);
    assert_eq!(statements(&reading, 0), [(0, 0, vec![]), (1, 1, vec![Hedge::Not])]);
}

#[test]
fn quotes_percent_signs_and_hashes_may_stand_in_labels() {
    assert_eq!(read(QUIRKS).parts.outputs[0].terms[0].name, "it's 50% # sure");
}

#[test]
fn labels_may_be_numbers_and_repeat_and_be_empty() {
    let reading = read(QUIRKS);
    let names: Vec<_> =
        reading.parts.inputs.iter().flat_map(|i| &i.terms).map(|t| t.name.as_str()).collect();
    assert_eq!(names, ["2", "2 (2)", "mf1", "spike"]);
    assert!(noted(&reading, "13:1: `2` is there already; this one is called `2 (2)`"));
}

#[test]
fn the_sign_of_a_width_that_is_squared_makes_no_difference() {
    let reading = read(QUIRKS);
    let Conclusion::Set { membership, .. } = &reading.parts.outputs[0].terms[0].conclusion else {
        panic!("a set");
    };
    let params = vec![0.0, 0.5];
    assert_eq!(*membership, Membership::Shape { kind: ShapeKind::Gaussian, params, height: 1.0 });
    assert!(
        noted(&reading, "9:44: the sign of `-.5` makes no difference"),
        "{:?}",
        notes(&reading)
    );
}

#[test]
fn a_triangle_of_no_width_is_a_singleton() {
    assert_eq!(shape(&read(QUIRKS), 1, 1), (ShapeKind::Singleton, vec![5.0]));
}

#[test]
fn counts_in_the_header_that_disagree_are_told_and_not_believed() {
    let reading = read(QUIRKS);
    assert!(
        noted(&reading, "29:3: `NumRules` says 7, but there are 3 rules"),
        "{:?}",
        notes(&reading)
    );
    assert!(noted(&reading, "16:1: `NumMFs` says 3, but there are 2 membership functions"));
}

#[test]
fn keys_that_change_no_answer_are_told() {
    assert!(noted(&read(QUIRKS), "17:1: `Description` changes no answer and is not kept"));
}

#[test]
fn a_rule_without_a_condition_is_told() {
    let reading = read(QUIRKS);
    assert_eq!(reading.parts.blocks[0].rules[2].antecedent, Antecedent::Always);
    assert!(noted(&reading, "5:1: a rule without a condition always fires"));
    let never = read(&QUIRKS.replace("0 0, 1 (1) : 1", "0 0, 1 (1) : 2"));
    let antecedent = Antecedent::Not(Box::new(Antecedent::Always));
    assert_eq!(never.parts.blocks[0].rules[2].antecedent, antecedent);
}

#[test]
fn a_rule_without_a_conclusion_is_told_and_left_out() {
    let reading = read(&QUIRKS.replace("0 0, 1 (1) : 1", "1 1, 0 (1) : 1"));
    assert_eq!(reading.parts.blocks[0].rules.len(), 2);
    assert!(noted(&reading, "a rule without a conclusion has no effect and is left out"));
}

#[test]
fn missing_methods_are_assumed_as_matlab_assumes_them() {
    let reading = read(QUIRKS);
    let block = &reading.parts.blocks[0];
    assert!(block.and.is(TNormKind::Minimum) && block.implication.is(TNormKind::Minimum));
    assert!(block.or.is(SNormKind::Maximum));
    assert!(noted(&reading, "`Type` is missing; `mamdani` is assumed"));
    assert!(noted(&reading, "`ImpMethod` is missing; `min` is assumed"));
}

#[test]
fn methods_without_effect_in_a_sugeno_system_are_told() {
    let reading = read(&SUGENO.replace("ImpMethod='prod'", "ImpMethod='min'"));
    assert!(reading.parts.blocks[0].implication.is(TNormKind::AlgebraicProduct));
    assert!(noted(&reading, "`ImpMethod` has no effect in a Sugeno system"));
    assert_eq!(
        reading.parts.outputs[0].terms[1].conclusion,
        Conclusion::Linear { coefficients: vec![0.5, -1.0], constant: 3.0 }
    );
}

#[test]
fn line_ends_and_a_byte_order_mark_make_no_difference() {
    for text in [PAPER, QUIRKS, FUZZYLITE] {
        for ends in ["\r\n", "\r"] {
            let other = format!("\u{feff}{}", text.replace('\n', ends));
            assert_eq!(read(&other), read(text), "{ends:?}");
        }
    }
}

#[test]
fn a_switched_off_variable_stays_off() {
    let reading = read(&FUZZYLITE.replace("Enabled=1\nName='level'", "Enabled=0\nName='level'"));
    assert!(!reading.parts.inputs[0].enabled && reading.parts.inputs[1].enabled);
}

/// Octave lets a hedge in a conclusion act on the set; such files were refused.
#[test]
fn a_hedge_in_a_conclusion_makes_a_set_of_its_own_as_in_octave() {
    let text = OCTAVE
        .replace("2 1, 2 (1) : 1", "2 1, 2.20 (1) : 1")
        .replace("1.15 -2.05, 1 (0.5) : 1", "1.15 -2.05, -1.05 (0.5) : 1")
        .replace("1 2.40, 1 (1) : 2", "1 2.40, 2.20 (1) : 2");
    let reading = read(&text);
    let output = &reading.parts.outputs[0];
    let names: Vec<_> = output.terms.iter().map(|term| term.name.as_str()).collect();
    assert_eq!(names, ["slow", "fast", "fast^2", "not slow^0.5"]);
    let concluded: Vec<_> =
        reading.parts.blocks[0].rules.iter().map(|rule| rule.consequents[0].term).collect();
    assert_eq!(concluded, [2, 3, 2]);
    let grade = |term: usize, x: f64| match &output.terms[term].conclusion {
        Conclusion::Set { membership, .. } => membership.grade(x, &[], &mut [0.0; 8]),
        other => panic!("{other:?}"),
    };
    for x in [-3.0, 0.0, 10.0, 20.0, 35.0, 50.0, 60.0, 82.0, 100.0, 120.0] {
        assert!((grade(2, x) - grade(1, x).powi(2)).abs() < 1e-14, "{x}");
        assert!((grade(3, x) - (1.0 - grade(0, x).sqrt())).abs() < 1e-14, "{x}");
    }
    assert!(noted(&reading, "a hedge in a conclusion changes the set, as in Octave: `fast^2`"));
    // The integral over the set that was made, against the same system with the power written out.
    let answer = |parts: &fspid_fuzzy::system::Parts, at: &[f64]| {
        let system = fspid_fuzzy::system::System::new(parts.clone()).expect("a system");
        let mut room = system.workspace();
        system.evaluate(at, &mut room).expect("finite")[0].value
    };
    let found = answer(&reading.parts, &[45.0, 0.1]).expect("an answer");
    let (mut moment, mut area) = (0.0, 0.0);
    for sample in 0..=100_u32 {
        let (x, end) = (f64::from(sample), matches!(sample, 0 | 100));
        let weight = if end { 0.5 } else { 1.0 } * grade(1, x).powi(2);
        (moment, area) = (moment + x * weight, area + weight);
    }
    assert!((found - moment / area).abs() < 1e-9, "{found} for {}", moment / area);
}

#[test]
fn a_hedge_of_a_number_is_refused_for_a_number_has_no_grades() {
    let text = SUGENO.replace("1 1, 1 (1) : 1", "1 1, 1.20 (1) : 1");
    assert_ne!(text, SUGENO);
    let told = fis::read(&text).expect_err("refused").to_string();
    assert!(told.contains("`1.20`: a hedge or `not` in a conclusion about such a term"), "{told}");
}

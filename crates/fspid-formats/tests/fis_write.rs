//! Writing `.fis`: what reads back the same, what is refused, what is lost and by how much.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use fspid_formats::{Reading, WriteOptions, Writing, fis};
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::{
    Antecedent, Conclusion, Defuzzifier, FallbackValue, Membership, Parts, Sampling, Statement,
    System, Variable,
};
use fspid_fuzzy::{Hedge, OutOfRange, SNormKind, TNormKind};

const FILES: [(&str, &str); 4] = [
    ("paper", include_str!("data/fis/paper.fis")),
    ("tipper", include_str!("data/fis/tipper.fis")),
    ("heater", include_str!("data/fis/heater.fis")),
    ("sugeno", include_str!("data/fis/sugeno.fis")),
];
const TYPE_2: &str = include_str!("data/fis/type2.fis");
const FUZZYLITE: &str = include_str!("data/fis/fuzzylite.fis");
const STRICT: WriteOptions = WriteOptions { lossy: false };
const LOSSY: WriteOptions = WriteOptions { lossy: true };

fn read(text: &str) -> Parts {
    let reading: Reading = fis::read(text).unwrap_or_else(|problems| panic!("{problems}\n{text}"));
    reading.parts
}

fn heater() -> Parts {
    read(FILES[2].1)
}

fn written(parts: &Parts) -> Writing {
    fis::write(parts, STRICT).unwrap_or_else(|problems| panic!("{problems}"))
}

/// What is refused without leave to lose it, and the notes with leave.
fn lost(parts: &Parts) -> (String, Vec<String>) {
    let problems = fis::write(parts, STRICT).expect_err("a loss").to_string();
    let writing = fis::write(parts, LOSSY).unwrap_or_else(|problems| panic!("{problems}"));
    (problems, writing.notes.iter().map(ToString::to_string).collect())
}

/// What cannot be written at all.
fn never(parts: &Parts) -> String {
    fis::write(parts, LOSSY).expect_err("impossible").to_string()
}

/// Largest difference of answers over the ranges.
fn differ(one: &Parts, other: &Parts) -> f64 {
    let systems = [one, other].map(|parts| System::new(parts.clone()).expect("allowed"));
    let [mut first, mut second] = systems.each_ref().map(System::workspace);
    let mut largest = 0.0_f64;
    for n in 0..300 {
        let share = |step: f64| (f64::from(n) * step).fract();
        let shares = [share(0.618), share(0.414)];
        let ranges = one.inputs.iter().map(|input| input.universe.expect("a range"));
        let question: Vec<_> = ranges.zip(shares).map(|(u, s)| u.lower + s * u.span()).collect();
        let left = systems[0].evaluate(&question, &mut first).expect("finite");
        let right = systems[1].evaluate(&question, &mut second).expect("finite");
        for (left, right) in left.iter().zip(right) {
            let pair = (left.value.expect("an answer"), right.value.expect("an answer"));
            largest = largest.max((pair.0 - pair.1).abs());
        }
    }
    largest
}

fn is(input: usize, term: usize, hedges: &[Hedge]) -> Antecedent {
    let (variable, hedges) = (Variable::Input(input), hedges.to_vec());
    Antecedent::Is(Statement { variable, term: Some(term), hedges })
}

#[test]
fn what_is_read_is_written_and_read_again_without_a_difference() {
    for (name, text) in FILES.into_iter().chain([("type 2", TYPE_2)]) {
        let parts = read(text);
        let writing = written(&parts);
        assert_eq!(read(&writing.text), parts, "{name}");
        assert_eq!(written(&read(&writing.text)).text, writing.text, "{name}");
    }
}

#[test]
fn a_file_in_matlab_s_own_words_comes_back_letter_by_letter() {
    let (_, text) = FILES[1];
    assert_eq!(written(&read(text)).text, text);
}

#[test]
fn numbers_keep_every_bit() {
    let mut parts = heater();
    let universe = parts.inputs[0].universe.as_mut().expect("a range");
    (universe.lower, universe.upper) = (-1.0 / 3.0, 1e22 + 1e6);
    parts.blocks[0].rules[0].weight = 0.1 + 0.2;
    assert_eq!(read(&written(&parts).text), parts);
}

#[test]
fn interval_sets_are_written_for_taskin_s_toolbox_and_say_so() {
    let writing = written(&read(TYPE_2));
    assert!(writing.text.contains("MF1L='N':'trimf',[-4 -2 0.5 0.8]\n"), "{}", writing.text);
    assert!(writing.notes[0].message.contains("MATLAB does not read them"));
    let mut mamdani = heater();
    let lower = Some(mamdani.inputs[0].terms[0].membership.clone());
    mamdani.inputs[0].terms[0].lower = lower;
    assert_eq!(never(&mamdani), "interval sets can be written for Sugeno systems only");
}

#[test]
fn the_exact_integral_is_a_loss_with_its_error_in_the_answers() {
    let mut parts = read(FILES[0].1);
    for output in &mut parts.outputs {
        output.defuzzifier = Defuzzifier::Centroid(Sampling::Exact);
    }
    let (problems, notes) = lost(&parts);
    assert_eq!(
        problems,
        "integrals are `exact`; the file stands for `endpoints:101`; expected that a loss is allowed"
    );
    assert!(notes[1].starts_with("output `dkp`: answers differ by up to 0.0"), "{notes:?}");
    assert!(notes[1].ends_with(" at 500 points of the ranges and near the worst of them, beyond the ranges not measured"), "{notes:?}");
}

#[test]
fn a_fallback_that_is_not_the_middle_is_a_loss() {
    let mut parts = heater();
    parts.outputs[1].fallback.value = FallbackValue::Number(0.5);
    assert!(written(&parts).notes.is_empty(), "the middle of 0 to 1");
    parts.outputs[1].fallback.value = FallbackValue::Number(0.25);
    let (problems, _) = lost(&parts);
    assert!(problems.starts_with("output `valve`: where no rule fires MATLAB answers the middle"));
}

#[test]
fn inputs_that_are_clamped_are_a_loss() {
    let mut parts = heater();
    parts.inputs[0].out_of_range = OutOfRange::Clamp;
    let (problems, _) = lost(&parts);
    assert!(
        problems.starts_with("input `room`: MATLAB evaluates values outside the range as they are")
    );
}

#[test]
fn foreign_norms_are_refused_or_replaced_by_the_nearest() {
    let mut parts = heater();
    parts.blocks[0].and = TNormKind::EinsteinProduct.into();
    parts.outputs.iter_mut().for_each(|output| output.aggregation = SNormKind::BoundedSum.into());
    let (problems, notes) = lost(&parts);
    assert!(
        problems.contains("the file has no such `and`; `prod` differs by up to 0.0"),
        "{problems}"
    );
    assert!(
        problems.contains("the file has no such `aggregation`; `probor` differs by up to 0.250")
    );
    assert!(notes.iter().any(|note| note.contains("answers differ by up to")), "{notes:?}");
}

#[test]
fn a_foreign_norm_that_no_rule_uses_is_no_loss() {
    let mut parts = read(FILES[1].1);
    parts.blocks[0].and = TNormKind::EinsteinProduct.into();
    assert_eq!(differ(&parts, &read(&written(&parts).text)), 0.0);
}

#[test]
fn norms_that_differ_from_block_to_block_are_a_loss() {
    let mut parts = heater();
    let mut other = parts.blocks[0].clone();
    parts.blocks.push(other.clone());
    assert_eq!(read(&written(&parts).text).blocks[0].rules.len(), 10, "blocks that agree are one");
    other.implication = TNormKind::Minimum.into();
    parts.blocks[1] = other;
    let (problems, _) = lost(&parts);
    assert!(
        problems.contains("the file has one `implication` for all; that of the first is taken")
    );
}

#[test]
fn shapes_under_another_name_are_the_same_function() {
    use ShapeKind::*;
    for (kind, params, name) in [
        (Ramp, vec![10.0, 20.0], "linsmf',[10 20]"),
        (Ramp, vec![20.0, 10.0], "linzmf',[10 20]"),
        (Rectangle, vec![10.0, 20.0], "trapmf',[10 10 20 20]"),
        (Step, vec![20.0, 1.0], "trapmf',[20 20 Inf Inf]"),
        (Step, vec![20.0, -1.0], "trapmf',[-Inf -Inf 20 20]"),
        (Points, vec![10.0, 0.0, 20.0, 1.0, 25.0, 0.0], "trimf',[10 20 25]"),
        (Points, vec![10.0, 0.0, 20.0, 1.0], "linsmf',[10 20]"),
    ] {
        let mut parts = heater();
        parts.inputs[0].terms[1].membership = Membership::Shape { kind, params, height: 1.0 };
        let writing = written(&parts);
        assert!(writing.text.contains(name), "{name}: {}", writing.text);
        assert!(writing.notes[0].message.contains("the same function"), "{:?}", writing.notes);
        let error = differ(&parts, &read(&writing.text));
        assert!(error <= 1e-12, "{name}: {error}");
    }
}

#[test]
fn shapes_that_matlab_lacks_become_a_trapezoid_with_its_error() {
    let mut parts = read(FUZZYLITE);
    parts.inputs[1].universe = parts.inputs[0].universe;
    parts.blocks[0].and = TNormKind::Minimum.into();
    parts.outputs[0].aggregation = SNormKind::Maximum.into();
    let (problems, notes) = lost(&parts);
    let cosine = "input `level`, term `c`: MATLAB has no such `cosine`; the nearest trapezoid differs by up to 0.0";
    assert!(problems.contains(cosine), "{problems}");
    assert!(notes.iter().any(|note| note.starts_with(cosine)), "{notes:?}");
}

#[test]
fn a_height_below_one_is_a_loss() {
    let mut parts = heater();
    let params = vec![15.0, 20.0, 25.0];
    let kind = ShapeKind::Triangle;
    parts.inputs[0].terms[1].membership = Membership::Shape { kind, params, height: 0.75 };
    let (problems, _) = lost(&parts);
    assert!(
        problems.contains("MATLAB has no such `triangle`; the nearest trapezoid differs by up to")
    );
}

#[test]
fn hedges_without_a_code_become_the_nearest_one() {
    let mut parts = heater();
    parts.blocks[0].rules[0].antecedent = is(0, 0, &[Hedge::Very, Hedge::Very]);
    assert!(written(&parts).text.contains("1.40 0, 3 2"));
    parts.blocks[0].rules[0].antecedent = is(0, 0, &[Hedge::Extremely]);
    let (problems, _) = lost(&parts);
    assert!(
        problems.contains("rule 1: no code says these hedges; `.00` differs by up to 0.125"),
        "{problems}"
    );
}

#[test]
fn negations_of_several_statements_move_inwards_where_the_norms_mirror_each_other() {
    let mut parts = read(FILES[1].1);
    let both = Antecedent::All(vec![is(0, 0, &[]), is(1, 0, &[Hedge::Very])]);
    parts.blocks[0].rules[1].antecedent = Antecedent::Not(Box::new(both));
    let writing = written(&parts);
    assert!(writing.text.contains("-1 -1.20, 2 (1) : 2\n"), "{}", writing.text);
    assert!(differ(&parts, &read(&writing.text)) < 1e-12);
    parts.blocks[0].or = SNormKind::AlgebraicSum.into();
    assert!(
        never(&parts)
            .contains("`not` before several statements cannot be written with these norms")
    );
}

#[test]
fn an_or_inside_an_and_becomes_two_rules_where_the_maximum_joins_them() {
    let mut parts = read(FILES[1].1);
    let service = Antecedent::Any(vec![is(0, 0, &[]), is(0, 2, &[])]);
    parts.blocks[0].rules[1].antecedent = Antecedent::All(vec![is(1, 1, &[]), service]);
    let writing = written(&parts);
    assert!(
        writing.text.contains("NumRules=4\n")
            && writing.text.contains("1 2, 2 (1) : 1\n3 2, 2 (1) : 1\n")
    );
    assert_eq!(differ(&parts, &read(&writing.text)), 0.0);
    parts.outputs[0].aggregation = SNormKind::UnboundedSum.into();
    assert!(
        never(&parts).contains("rule 2: a nested condition cannot be written with these norms")
    );
}

#[test]
fn several_conclusions_about_one_output_take_a_row_each() {
    let mut parts = heater();
    let mut second = parts.blocks[0].rules[0].consequents[0].clone();
    second.term = 0;
    parts.blocks[0].rules[0].consequents.push(second);
    let writing = written(&parts);
    assert!(
        writing.text.contains("1.20 0, 3 2 (1) : 1\n1.20 0, 1 0 (1) : 1\n"),
        "{}",
        writing.text
    );
    assert!(differ(&parts, &read(&writing.text)) < 1e-12);
}

#[test]
fn a_switched_off_rule_keeps_its_place_with_the_weight_zero() {
    let mut parts = heater();
    parts.blocks[0].rules[1].enabled = false;
    let writing = written(&parts);
    assert!(writing.text.contains("-1.05 1, 2 0 (0) : 1\n"));
    assert!(writing.notes[0].message.contains("rule 2 is switched off"));
    assert!(differ(&parts, &read(&writing.text)) < 1e-12);
}

#[test]
fn conditions_that_are_certain_take_no_index() {
    let mut parts = read(FILES[1].1);
    let nothing = Antecedent::Not(Box::new(Antecedent::Always));
    parts.blocks[0].rules[1].antecedent = Antecedent::Any(vec![
        nothing,
        is(0, 1, &[]),
        Antecedent::All(vec![Antecedent::Always, is(1, 1, &[])]),
    ]);
    let writing = written(&parts);
    assert!(writing.text.contains("2 2, 2 (1) : 2\n"), "{}", writing.text);
    assert_eq!(differ(&parts, &read(&writing.text)), 0.0);
}

#[test]
fn what_the_format_has_no_idea_of_is_refused_whatever_is_allowed() {
    let chained = |parts: &mut Parts| {
        let (variable, hedges) = (Variable::Output(0), vec![]);
        parts.blocks[0].rules[4].antecedent =
            Antecedent::Is(Statement { variable, term: Some(0), hedges });
    };
    let hedged =
        |parts: &mut Parts| parts.blocks[0].rules[0].consequents[0].hedges = vec![Hedge::Very];
    let off = |parts: &mut Parts| parts.inputs[0].enabled = false;
    let mixed = |parts: &mut Parts| {
        parts.outputs[0].defuzzifier = Defuzzifier::WeightedSum(Default::default());
        parts.outputs[0]
            .terms
            .iter_mut()
            .for_each(|term| term.conclusion = Conclusion::Constant(1.0));
    };
    type Change<'c> = &'c dyn Fn(&mut Parts);
    let cases: [(Change, &str); 4] = [
        (&chained, "rule 5: a condition about an output cannot be written"),
        (&hedged, "rule 1: a hedge in a conclusion cannot be written"),
        (&off, "input `room` is switched off, which the file cannot say"),
        (&mixed, "a file is either Mamdani or Sugeno; some outputs are joined, others weighted"),
    ];
    for (change, message) in cases {
        let mut parts = heater();
        change(&mut parts);
        assert!(never(&parts).contains(message), "{message}: {}", never(&parts));
    }
}

#[test]
fn a_name_with_a_quote_or_a_line_break_is_a_loss() {
    let mut parts = heater();
    parts.outputs[0].name = "heater's\npower".into();
    let (problems, _) = lost(&parts);
    assert!(problems.contains("is written as `heater_s_power`"), "{problems}");
}

#[test]
fn names_of_rules_and_descriptions_are_left_out_with_a_note() {
    let mut parts = heater();
    parts.blocks[0].rules[0].name = "cold start".into();
    let notes = written(&parts).notes;
    assert_eq!(notes[0].message, "descriptions and names of rules and rule blocks are left out");
}

#[test]
fn a_system_that_cannot_be_built_is_not_written() {
    let mut parts = heater();
    parts.blocks[0].rules[0].weight = 2.0;
    assert_eq!(never(&parts), "rule 1: the weight is 2.0; allowed is a number from 0 to 1");
}

/// One line said that it cannot be written, and another what would be written.
#[test]
fn a_set_by_a_formula_of_other_inputs_is_refused_once() {
    let mut parts = heater();
    let names: Vec<String> = std::iter::once("x".to_owned())
        .chain(parts.inputs.iter().map(|input| input.name.clone()))
        .collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let formula = fspid_fuzzy::Formula::parse(&format!("0.1 * x + {}", names[1]), &names);
    parts.inputs[0].terms[0].membership =
        Membership::Formula { formula: formula.expect("a formula"), height: 1.0 };
    let told = never(&parts);
    assert_eq!(told.lines().count(), 1, "{told}");
}

//! Systems in every dialect of FCL: what they mean, and that nothing gets lost on the way back.
#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use crate::common;

use common::{EXACT, LOSSY, answers, notes, paper, problems};
use fspid_formats::fcl::{self, Dialect, ReadOptions};
use fspid_fuzzy::Hedge;
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::{
    Antecedent, Conclusion, Defuzzifier, FallbackValue, Membership, Parts, Sampling, SetReading,
};

const IEC: &str = include_str!("data/fcl/tipper-iec.fcl");
const JFUZZYLOGIC: &str = include_str!("data/fcl/tipper-jfuzzylogic.fcl");
const FUZZYLITE: &str = include_str!("data/fcl/tipper-fuzzylite.fcl");
const SUGENO: &str = include_str!("data/fcl/sugeno.fcl");
const PAPER_FUZZYLITE: &str = include_str!("data/fcl/paper-fuzzylite.fcl");
const PAPER_JFUZZYLOGIC: &str = include_str!("data/fcl/paper-jfuzzylogic.fcl");
const PAPER_IEC: &str = include_str!("data/fcl/paper-iec.fcl");

fn read(text: &str) -> Parts {
    fcl::read(text).unwrap_or_else(|problems| panic!("{problems}")).parts
}

/// A function block with one input and one output around these rules.
fn around(rules: &str) -> String {
    format!(
        "FUNCTION_BLOCK f VAR_INPUT x : REAL; END_VAR VAR_OUTPUT y : REAL; END_VAR
         FUZZIFY x TERM low := (0, 1) (1, 0); TERM high := (0, 0) (1, 1); END_FUZZIFY
         DEFUZZIFY y TERM a := 1; TERM b := 2; METHOD : COGS; DEFAULT := 0; END_DEFUZZIFY
         RULEBLOCK r AND : MIN; OR : MAX; ACCU : MAX; {rules} END_RULEBLOCK END_FUNCTION_BLOCK"
    )
}

fn first_rule(rules: &str) -> fspid_fuzzy::system::Rule {
    read(&around(rules)).blocks[0].rules[0].clone()
}

fn shape(parts: &Parts, input: usize, term: usize) -> (ShapeKind, Vec<f64>, f64) {
    match &parts.inputs[input].terms[term].membership {
        Membership::Shape { kind, params, height } => (*kind, params.clone(), *height),
        Membership::Formula { .. } => panic!("a formula"),
    }
}

#[test]
fn the_standard_s_dialect_is_known_and_means_exact_integrals() {
    let reading = fcl::read(IEC).unwrap();
    let told = "read as the dialect of IEC 61131-7; integrals are computed by `exact` unless the \
                text says otherwise";
    assert_eq!(notes(&reading), [told, "35:31: no OR is given; maximum is assumed"]);
    let tip = &reading.parts.outputs[0];
    assert_eq!(tip.defuzzifier, Defuzzifier::Centroid(Sampling::Exact));
    assert_eq!(tip.fallback.value, FallbackValue::Number(0.0));
    assert_eq!(tip.universe.unwrap().upper, 30.0);
}

#[test]
fn jfuzzylogic_s_dialect_is_known_by_its_words_and_means_left_ends() {
    let reading = fcl::read(JFUZZYLOGIC).unwrap();
    let told = &notes(&reading)[0];
    assert!(
        told.starts_with("read as jFuzzyLogic's dialect, for a word for a set at 11:15"),
        "{told}"
    );
    let parts = reading.parts;
    assert_eq!(parts.outputs[0].defuzzifier, Defuzzifier::Centroid(Sampling::LeftEnd(1000)));
    assert!(parts.outputs[0].fallback.previous);
    assert_eq!(shape(&parts, 0, 2), (ShapeKind::Gaussian, vec![10.0, 1.5], 1.0));
    assert_eq!(shape(&parts, 1, 0), (ShapeKind::Trapezoid, vec![-2.0, 0.0, 1.0, 3.0], 1.0));
    assert_eq!(parts.blocks[0].rules[0].name, "first");
    assert_eq!(parts.blocks[0].rules[1].name, "", "a number that only counts is no name");
}

#[test]
fn fuzzylite_s_dialect_is_known_and_means_midpoints() {
    let reading = fcl::read(FUZZYLITE).unwrap();
    let told = &notes(&reading)[0];
    assert!(told.starts_with("read as fuzzylite's dialect, for ENABLED at 14:11"), "{told}");
    let parts = reading.parts;
    let tip = &parts.outputs[0];
    assert_eq!(tip.defuzzifier, Defuzzifier::Centroid(Sampling::Midpoint(200)));
    assert_eq!((tip.fallback.previous, tip.fallback.value), (true, FallbackValue::Number(12.5)));
    assert_eq!(shape(&parts, 0, 2), (ShapeKind::Gaussian, vec![10.0, 1.5], 0.9));
    assert_eq!(parts.inputs[1].universe, None, "a range without ends is none");
    let Antecedent::Is(statement) = &parts.blocks[0].rules[1].antecedent else { panic!("one") };
    assert_eq!(statement.hedges, [Hedge::Very]);
}

#[test]
fn the_dialect_can_be_told_and_is_then_not_found_out() {
    let options = ReadOptions { dialect: Some(Dialect::Fuzzylite), ..ReadOptions::default() };
    let reading = fcl::read_with(IEC, options).unwrap();
    assert!(notes(&reading)[0].starts_with("read as fuzzylite's dialect as asked"));
    let sampling = reading.parts.outputs[0].defuzzifier.sampling();
    assert_eq!(sampling, Some(Sampling::Midpoint(1000)));
}

#[test]
fn mixed_dialects_are_read_as_the_standard_and_told() {
    let text = IEC
        .replace("poor := (0, 1) (4, 0)", "poor := GAUSS 0 1")
        .replace("FUZZIFY food", "FUZZIFY food RANGE := (0 .. 10);");
    let told = &notes(&fcl::read(&text).unwrap())[0];
    assert!(told.contains("dialects are mixed: RANGE in FUZZIFY"), "{told}");
    assert!(told.contains("jFuzzyLogic's"), "{told}");
}

/// What used to happen in fuzzylite: the paper's controller with the standard's keywords was loaded
/// without an error, said that it was ready, and had 0 of 49 rules.
#[test]
fn upper_case_if_is_and_then_loads_49_of_49_rules() {
    let upper = PAPER_FUZZYLITE
        .replace(": if ", ": IF ")
        .replace(" is ", " IS ")
        .replace(" and ", " AND ")
        .replace(" then ", " THEN ");
    assert_eq!(upper.matches(" IF ").count(), 49);
    assert_eq!(read(&upper).blocks[0].rules.len(), 49);
    assert_eq!(read(&upper), read(PAPER_FUZZYLITE));
}

#[test]
fn keywords_are_read_in_any_case_everywhere() {
    let lower = around("RULE 1 : IF x IS low AND NOT x IS high THEN y IS a WITH 0.5;");
    let other = lower.to_lowercase();
    let mixed: String = other
        .chars()
        .enumerate()
        .map(|(n, c)| if n % 2 == 0 { c.to_ascii_uppercase() } else { c })
        .collect();
    assert_eq!(read(&other), read(&lower));
    assert_eq!(read(&mixed).blocks[0].rules[0].weight, 0.5);
}

#[test]
fn two_points_need_no_blanks_around_them() {
    for range in ["(0..30)", "(0 .. 30)", "(0.0..30.)", "( 0..+3e1 )", "0 .. 30"] {
        let text = IEC.replace("(0..30)", range);
        assert_eq!(read(&text).outputs[0].universe.unwrap().upper, 30.0, "{range}");
    }
}

#[test]
fn comments_of_every_dialect_may_stand_anywhere() {
    let text = IEC.replace(" IS ", " (* a\n*) IS /* b */ ").replace(";\n", "; // c # d\n");
    assert_eq!(read(&text).blocks, read(IEC).blocks);
}

#[test]
fn line_ends_and_a_byte_order_mark_make_no_difference() {
    let texts = [IEC.replace('\n', "\r\n"), IEC.replace('\n', "\r"), format!("\u{feff}{IEC}")];
    for text in texts {
        assert_eq!(fcl::read(&text).unwrap(), fcl::read(IEC).unwrap());
    }
}

#[test]
fn the_accumulation_may_stand_with_the_rules_or_with_the_output() {
    let moved =
        IEC.replace("  ACCU : MAX;\n", "").replace("METHOD : COG;", "METHOD : COG; ACCU : ASUM;");
    let norm = read(&moved).outputs[0].aggregation.clone();
    assert_eq!(norm, fspid_fuzzy::SNormKind::AlgebraicSum.into());
    let both = IEC.replace("METHOD : COG;", "METHOD : COG; ACCU : BSUM;");
    let told = problems(fcl::read(&both));
    assert_eq!(
        told,
        "34:10: `MAX`: `tip` is accumulated by BSUM elsewhere; expected the same everywhere"
    );
}

#[test]
fn a_rule_needs_no_sign_at_its_end_and_a_block_no_name() {
    let text = IEC.replace("RULEBLOCK No1", "RULEBLOCK").replace("cheap;", "cheap");
    let reading = fcl::read(&text).unwrap();
    assert!(notes(&reading)[0].contains("fuzzylite's dialect, for a rule without `;` at 36:3"));
    assert_eq!(reading.parts.blocks[0].rules, read(IEC).blocks[0].rules);
    assert_eq!(reading.parts.blocks[0].name, "");
}

#[test]
fn defaults_are_a_number_no_change_or_nothing() {
    let default = |text: &str| read(&IEC.replace("DEFAULT := 0;", text)).outputs[0].fallback;
    assert_eq!(default("DEFAULT := -2.5;").value, FallbackValue::Number(-2.5));
    assert!(default("DEFAULT := NC;").previous);
    assert_eq!(default("DEFAULT := nan;").value, FallbackValue::Nothing);
    assert_eq!(default("").value, FallbackValue::Nothing);
}

#[test]
fn every_method_of_every_dialect_is_known() {
    type Make = fn(Sampling) -> Defuzzifier;
    let rows: [(&str, Make); 12] = [
        ("COG", Defuzzifier::Centroid),
        ("cog", Defuzzifier::Centroid),
        ("COA", Defuzzifier::Bisector),
        ("LM", Defuzzifier::SmallestOfMaximum),
        ("RM", Defuzzifier::LargestOfMaximum),
        ("MM", Defuzzifier::MeanOfMaximum),
        ("MOM", Defuzzifier::MeanOfMaximum),
        ("Centroid", Defuzzifier::Centroid),
        ("Bisector", Defuzzifier::Bisector),
        ("SmallestOfMaximum", Defuzzifier::SmallestOfMaximum),
        ("LargestOfMaximum", Defuzzifier::LargestOfMaximum),
        ("MeanOfMaximum", Defuzzifier::MeanOfMaximum),
    ];
    for (word, make) in rows {
        let parts = read(&IEC.replace("METHOD : COG;", &format!("METHOD : {word};")));
        let exact = parts.outputs[0].defuzzifier.with_sampling(Sampling::Exact);
        assert_eq!(exact, make(Sampling::Exact), "{word}");
    }
}

#[test]
fn points_that_are_a_triangle_or_a_trapezoid_are_read_as_one() {
    let parts = read(IEC);
    assert_eq!(shape(&parts, 0, 1), (ShapeKind::Trapezoid, vec![1.0, 4.0, 6.0, 9.0], 1.0));
    assert_eq!(shape(&parts, 0, 0).0, ShapeKind::Points);
    let Conclusion::Set { membership: Membership::Shape { kind, .. }, .. } =
        &parts.outputs[0].terms[0].conclusion
    else {
        panic!("a set")
    };
    assert_eq!(*kind, ShapeKind::Triangle);
}

#[test]
fn local_numbers_stand_for_themselves_and_conclusions_may_be_several() {
    let parts = read(SUGENO);
    assert_eq!(shape(&parts, 0, 2), (ShapeKind::Singleton, vec![0.5], 1.0));
    assert_eq!(parts.outputs[0].terms[2].conclusion, Conclusion::Constant(0.5));
    let rules = &parts.blocks[0].rules;
    assert_eq!(
        (rules[2].name.as_str(), rules[2].consequents.len(), rules[2].weight),
        ("7", 2, 0.5)
    );
    assert!(matches!(rules[1].antecedent, Antecedent::Not(_)));
    // x = 0.25: low 0.75, high 0.125, exactly 0; rules fire with 0.75, 0.875, 0.5.
    let expected = (0.75 - 0.25 * 0.875 + 0.5 * 0.5 + 0.5) / (0.75 + 0.875 + 0.5 + 0.5);
    let answer = answers(&parts, &[0.25, 0.0])[0].unwrap();
    assert!((answer - expected).abs() < 1e-15, "{answer} {expected}");
}

#[test]
fn a_local_variable_that_is_defuzzified_is_an_output_that_rules_may_ask_about() {
    let text = around("RULE 1 : IF x IS low THEN m IS big; RULE 2 : IF m IS big THEN y IS a;")
        .replace("VAR_OUTPUT", "VAR m : REAL; END_VAR VAR_OUTPUT")
        .replace(
            "RULEBLOCK r",
            "DEFUZZIFY m TERM big := 3; METHOD : COGS; END_DEFUZZIFY RULEBLOCK r",
        );
    let reading = fcl::read(&text).unwrap();
    assert_eq!(reading.parts.outputs.len(), 2);
    assert!(
        notes(&reading).iter().any(|note| note.contains("the local variable `m` is an output"))
    );
    assert!(
        reading.parts.blocks[0].rules[1].antecedent
            == Antecedent::Is(fspid_fuzzy::system::Statement {
                variable: fspid_fuzzy::system::Variable::Output(0),
                term: Some(0),
                hedges: Vec::new(),
            })
    );
}

#[test]
fn and_binds_tighter_than_or_and_brackets_are_kept() {
    let rule = first_rule("RULE 1 : IF x IS low OR x IS high AND x IS low THEN y IS a;");
    assert!(
        matches!(&rule.antecedent, Antecedent::Any(parts) if matches!(parts[1], Antecedent::All(_)))
    );
    let rule = first_rule("RULE 1 : IF (x IS low OR x IS high) AND x IS low THEN y IS a;");
    assert!(
        matches!(&rule.antecedent, Antecedent::All(parts) if matches!(parts[0], Antecedent::Any(_)))
    );
}

#[test]
fn a_weight_may_follow_brackets() {
    let rule = first_rule("RULE 1 : IF ((x IS low) OR (x IS NOT high)) THEN (y IS a) WITH .25;");
    assert_eq!(rule.weight, 0.25);
}

#[test]
fn connectives_that_are_no_pair_are_told() {
    let text = IEC.replace("AND : MIN;", "AND : MIN; OR : ASUM;");
    let told = notes(&fcl::read(&text).unwrap());
    let pair = "31:11: `and` (minimum) and `or` (algebraic-sum) are no pair by De Morgan";
    assert!(told.contains(&pair.into()), "{told:?}");
    let alone = IEC.replace("AND : MIN;", "OR : BSUM;");
    let and = read(&alone).blocks[0].and.clone();
    assert_eq!(
        and,
        fspid_fuzzy::TNormKind::BoundedDifference.into(),
        "the other one is its mirror image"
    );
}

#[test]
fn a_centre_of_gravity_of_numbers_is_their_weighted_mean_and_told() {
    let text = around("RULE 1 : IF x IS low THEN y IS a;").replace("COGS", "COG");
    let reading = fcl::read(&text).unwrap();
    assert_eq!(reading.parts.outputs[0].defuzzifier.name(), "weighted-average");
    assert!(notes(&reading).iter().any(|note| note.contains("is read as COGS")));
}

#[test]
fn a_range_that_is_missing_is_taken_from_terms_with_ends() {
    let reading = fcl::read(&IEC.replace("RANGE := (0..30);", "")).unwrap();
    assert_eq!(reading.parts.outputs[0].universe.unwrap().upper, 30.0);
    assert!(notes(&reading).contains(&"8:3: no RANGE is given; the terms span 0.0 to 30.0".into()));
    let told = problems(fcl::read(
        &FUZZYLITE
            .replace("RANGE := (0.000 .. 30.000);", "")
            .replace("Triangle 0 5 10", "Sigmoid 0 1"),
    ));
    assert!(told.contains("has no RANGE, and its terms have no ends"), "{told}");
}

#[test]
fn another_tool_s_options_are_told_and_our_own_are_used() {
    let text = IEC.replace(
        "RULEBLOCK No1",
        "OPTION vendor (colour, 3) : x; FSPID_SAMPLING tip : ENDPOINTS 101; FSPID_RANGE food := (0 .. 10);
         FSPID_OUT_OF_RANGE food : CLAMP; FSPID_DEFAULT tip : MIDDLE; END_OPTION RULEBLOCK No1",
    );
    let reading = fcl::read(&text).unwrap();
    assert!(notes(&reading).iter().any(|note| note.contains("`vendor` is another tool's")));
    let parts = reading.parts;
    assert_eq!(parts.outputs[0].defuzzifier.sampling(), Some(Sampling::Endpoints(101)));
    assert_eq!(parts.outputs[0].fallback.value, FallbackValue::Middle);
    assert_eq!(parts.inputs[1].out_of_range, fspid_fuzzy::OutOfRange::Clamp);
    let again = fcl::write(&parts, Dialect::Iec, EXACT).unwrap();
    assert_eq!(read(&again.text), parts);
}

#[test]
fn of_several_function_blocks_the_one_that_is_asked_for_is_read() {
    let text = format!("{IEC}\n{}", around("RULE 1 : IF x IS low THEN y IS a;"));
    let told = problems(fcl::read(&text));
    assert_eq!(
        told,
        "42:16: `f`: a second function block; ask for the one that is meant; expected one of `tipper`, `f`"
    );
    let options = |block| ReadOptions { block: Some(block), ..ReadOptions::default() };
    assert_eq!(fcl::read_with(&text, options("F")).unwrap().parts.name, "f");
    assert_eq!(fcl::read_with(&text, options("tipper")).unwrap().parts, read(IEC));
    let told = fcl::read_with(&text, options("g")).unwrap_err().to_string();
    assert!(told.starts_with("there is no function block `g`, but one of `tipper`, `f`"), "{told}");
}

#[test]
fn names_in_another_case_are_found_and_told() {
    let reading = fcl::read(&IEC.replace("IF service IS poor", "IF Service IS Poor")).unwrap();
    let told = notes(&reading);
    assert!(
        told.contains(&"35:15: `Service` is read as `service`, which differs in case".into()),
        "{told:?}"
    );
    assert_eq!(reading.parts, read(IEC));
}

#[test]
fn what_is_written_reads_back_as_the_same_system_in_its_own_dialect() {
    let rows = [
        (IEC, Dialect::Iec),
        (SUGENO, Dialect::Iec),
        (JFUZZYLOGIC, Dialect::JFuzzyLogic),
        (FUZZYLITE, Dialect::Fuzzylite),
        (PAPER_IEC, Dialect::Iec),
        (PAPER_FUZZYLITE, Dialect::Fuzzylite),
        (PAPER_JFUZZYLOGIC, Dialect::JFuzzyLogic),
    ];
    for (text, dialect) in rows {
        let parts = read(text);
        let written = fcl::write(&parts, dialect, EXACT).unwrap();
        assert_eq!(read(&written.text), parts, "{}", written.text);
    }
}

#[test]
fn the_paper_s_controller_is_written_as_it_is_stored() {
    let midpoints =
        fcl::write(&paper(Sampling::Midpoint(1000)), Dialect::Fuzzylite, EXACT).unwrap();
    assert_eq!(midpoints.text, PAPER_FUZZYLITE);
    let left = fcl::write(&paper(Sampling::LeftEnd(1000)), Dialect::JFuzzyLogic, EXACT).unwrap();
    assert_eq!(left.text, PAPER_JFUZZYLOGIC);
    let exact = fcl::write(&paper(Sampling::Exact), Dialect::Iec, LOSSY).unwrap();
    assert_eq!(exact.text, PAPER_IEC);
}

/// The handbook's reference values; 1e-12 is the acceptance bar.
#[test]
fn the_paper_s_controller_answers_as_published_after_reading() {
    let rows = [
        ([1.0, -2.0], [0.995_958_158_631, -0.608_034_418_811, -0.642_500_373_380]),
        ([-3.3, 0.7], [1.628_328_059_925, -1.628_352_085_306, -3.151_303_923_865]),
        ([0.0, 0.0], [0.216_500_696_638, 0.0, -1.666_610_153_842]),
    ];
    let mut parts = read(PAPER_FUZZYLITE);
    for output in &mut parts.outputs {
        output.defuzzifier = output.defuzzifier.with_sampling(Sampling::Exact);
    }
    let fitted = read(PAPER_IEC);
    for (at, expected) in rows {
        for (answer, expected) in answers(&parts, &at).into_iter().zip(expected) {
            assert!((answer.unwrap() - expected).abs() < 1e-12, "{at:?} {answer:?} {expected}");
        }
        for (answer, expected) in answers(&fitted, &at).into_iter().zip(expected) {
            assert!((answer.unwrap() - expected).abs() < 0.02, "{at:?} {answer:?} {expected}");
        }
    }
}

#[test]
fn the_paper_s_controller_answers_by_fuzzylite_s_rule_after_reading() {
    let peak = answers(&read(PAPER_FUZZYLITE), &[-5.0, -5.0]);
    let expected = [4.444_379_776_849_196, -4.444_269_413_413_933, 1.020_331_707_786_908_7];
    for (answer, expected) in peak.into_iter().zip(expected) {
        assert!((answer.unwrap() - expected).abs() < 1e-12);
    }
}

#[test]
fn a_gaussian_is_refused_in_the_standard_s_dialect_unless_a_loss_is_allowed() {
    let told = fcl::write(&paper(Sampling::Exact), Dialect::Iec, EXACT).unwrap_err();
    let first = told.list[0].to_string();
    assert!(
        first.starts_with(
            "`error.NB`: gaussian has no words in the dialect of IEC 61131-7; expected a loss"
        ),
        "{first}"
    );
    let written = fcl::write(&paper(Sampling::Exact), Dialect::Iec, LOSSY).unwrap();
    let told: Vec<_> = written.notes.iter().map(ToString::to_string).collect();
    assert!(told[0].contains("points with grades within 9.0e-4 of the curve"), "{}", told[0]);
    assert!(
        told.last()
            .unwrap()
            .starts_with("largest change of an answer within the ranges of the inputs, found at 500 points and near the worst of them; beyond the ranges it is not measured")
    );
}

#[test]
fn another_tool_s_integrals_are_refused_unless_a_loss_is_allowed() {
    let parts = paper(Sampling::Endpoints(101));
    for dialect in [Dialect::Fuzzylite, Dialect::JFuzzyLogic] {
        let told = fcl::write(&parts, dialect, EXACT).unwrap_err().to_string();
        assert!(told.contains("`endpoints:101`, which has no words here"), "{told}");
        let written = fcl::write(&parts, dialect, LOSSY).unwrap();
        let sampling = read(&written.text).outputs[0].defuzzifier.sampling();
        assert_eq!(sampling, Some(dialect.sampling()));
    }
}

#[test]
fn what_has_no_words_in_any_dialect_is_refused_even_if_a_loss_is_allowed() {
    let mut parts = read(IEC);
    parts.blocks[0].activation = fspid_fuzzy::system::Activation::Proportional;
    let told = fcl::write(&parts, Dialect::Iec, LOSSY).unwrap_err().to_string();
    assert!(told.contains("the activation method has no words in FCL"), "{told}");
}

#[test]
fn names_that_are_none_are_replaced_if_a_loss_is_allowed() {
    let mut parts = read(IEC);
    parts.inputs[0].name = "quality of service".into();
    parts.inputs[0].terms[0].name = "then".into();
    let told = fcl::write(&parts, Dialect::Iec, EXACT).unwrap_err().to_string();
    assert!(told.contains("`quality of service`: not a name here"), "{told}");
    let written = fcl::write(&parts, Dialect::Iec, LOSSY).unwrap();
    let again = read(&written.text);
    assert_eq!(again.inputs[0].name, "quality_of_service");
    assert_eq!(again.inputs[0].terms[0].name, "n_then");
    let told = written.notes.last().unwrap().to_string();
    assert_eq!(
        told,
        "largest change of an answer within the ranges of the inputs, found at 500 points and near the worst of them; beyond the ranges it is not measured: `tip` 0.0e0"
    );
}

#[test]
fn a_system_that_is_none_is_refused() {
    let told = fcl::write(&Parts::default(), Dialect::Iec, LOSSY).unwrap_err().to_string();
    assert!(told.contains("has no input"), "{told}");
}

/// Both have a word for it, but fuzzylite's is followed by centre and width, jFuzzyLogic's by half of the width and the
/// centre.
#[test]
fn fuzzylite_s_cosine_is_not_jfuzzylogic_s() {
    let params = |word: &str| {
        let text = IEC.replace("poor := (0, 1) (4, 0)", &format!("poor := {word} 3 4"));
        shape(&read(&text), 0, 0).1
    };
    assert_eq!(params("Cosine"), [3.0, 4.0], "centre, width");
    for word in ["COSINE", "cosine"] {
        assert_eq!(params(word), [4.0, 6.0], "centre, width");
    }
}

/// jFuzzyLogic reads functions in upper case; they were refused as unknown names.
#[test]
fn functions_in_upper_case_are_the_same_functions() {
    let text = |formula: &str| {
        format!(
            "FUNCTION_BLOCK f VAR_INPUT x : REAL; END_VAR VAR_OUTPUT y : REAL; END_VAR
             FUZZIFY x TERM t := (0, 1) (9, 1); END_FUZZIFY
             DEFUZZIFY y TERM c := FUNCTION {formula}; METHOD : COGS; DEFAULT := 0; END_DEFUZZIFY
             RULEBLOCK r AND : MIN; RULE 1 : IF x IS t THEN y IS c; END_RULEBLOCK END_FUNCTION_BLOCK"
        )
    };
    for (upper, lower) in [
        ("SIN(x) + ABS(-x) * EXP(0)", "sin(x) + abs(-x) * exp(0)"),
        ("LN(x)", "log(x)"),
        ("COS(PI * x)", "cos(pi * x)"),
    ] {
        let answer = |formula| answers(&fcl::read(&text(formula)).expect(formula).parts, &[2.0]);
        assert_eq!(answer(upper), answer(lower), "{upper}");
    }
}

/// jFuzzyLogic takes `=` for `:=`; such files were refused.
#[test]
fn an_equals_sign_assigns_as_well() {
    let tipper = include_str!("data/fcl/tipper-jfuzzylogic.fcl");
    let equals = tipper.replace(":=", "=");
    assert_ne!(equals, tipper);
    assert_eq!(fcl::read(&equals).expect("a system").parts, fcl::read(tipper).expect("one").parts);
}

/// Such files were refused: \"has no DEFUZZIFY section\".
#[test]
fn an_output_without_a_section_is_left_out_and_the_rest_is_read() {
    let text = "FUNCTION_BLOCK f
        VAR_INPUT x : REAL; END_VAR VAR_OUTPUT lost : REAL; y : REAL; END_VAR
        FUZZIFY x TERM low := (0, 1) (1, 0); TERM high := (0, 0) (1, 1); END_FUZZIFY
        DEFUZZIFY y TERM a := 1; TERM b := 2; METHOD : COGS; DEFAULT := 0; END_DEFUZZIFY
        RULEBLOCK r AND : MIN;
          RULE 1 : IF x IS low THEN y IS a, lost IS very good;
          RULE 2 : IF x IS high THEN lost IS bad;
          RULE 3 : IF x IS high THEN y IS b;
          RULE 4 : IF lost IS bad THEN y IS b;
        END_RULEBLOCK END_FUNCTION_BLOCK";
    let reading = fcl::read(text).expect("a system");
    let names: Vec<_> = reading.parts.outputs.iter().map(|output| output.name.as_str()).collect();
    assert_eq!((names, reading.parts.blocks[0].rules.len()), (vec!["y"], 2));
    assert_eq!(answers(&reading.parts, &[0.25]), [Some(1.25)]);
    let told = notes(&reading).join("\n");
    assert!(told.contains("`lost` has no DEFUZZIFY section: it is left out"), "{told}");
    assert!(told.contains("2 rules about outputs that are left out"), "{told}");
}

/// Such files were refused; their sets can be looked at all the same.
#[test]
fn a_system_without_any_output_is_read_as_far_as_it_goes() {
    let head = "FUNCTION_BLOCK f VAR_INPUT x : REAL; END_VAR";
    let sets = "FUZZIFY x TERM low := (0, 1) (1, 0); END_FUZZIFY";
    let rules = "RULEBLOCK r AND : MIN; RULE 1 : IF x IS low THEN y IS a; END_RULEBLOCK";
    for text in [
        format!("{head} {sets} END_FUNCTION_BLOCK"),
        format!("{head} VAR_OUTPUT y : REAL; END_VAR {sets} {rules} END_FUNCTION_BLOCK"),
    ] {
        let reading = fcl::read(&text).expect("a system");
        assert!(reading.parts.outputs.is_empty() && reading.parts.inputs[0].terms.len() == 1);
        assert!(answers(&reading.parts, &[0.5]).is_empty());
        let told = notes(&reading).join("\n");
        assert!(told.contains("without an output nothing can be concluded"), "{told}");
    }
}

/// Written as points, such a set used to be refused by the reader.
#[test]
fn a_straight_side_that_is_weighed_is_written_as_a_ramp_or_refused() {
    let mut parts = read(&around("RULE 1 : IF x IS low THEN y IS a;"));
    parts.outputs[0].defuzzifier = Defuzzifier::WeightedAverage(SetReading::Tsukamoto);
    for (kind, params, ramp) in [
        (ShapeKind::LinearS, [2.0, 4.0], [2.0, 4.0]),
        (ShapeKind::LinearZ, [2.0, 4.0], [4.0, 2.0]),
        (ShapeKind::Ramp, [2.0, 4.0], [2.0, 4.0]),
    ] {
        let params = params.to_vec();
        for term in &mut parts.outputs[0].terms {
            let membership = Membership::Shape { kind, params: params.clone(), height: 1.0 };
            term.conclusion = Conclusion::Set { membership, lower: None };
        }
        let written = fcl::write(&parts, Dialect::Fuzzylite, LOSSY).unwrap();
        let back = read(&written.text);
        let Conclusion::Set { membership, .. } = &back.outputs[0].terms[0].conclusion else {
            panic!("{}", written.text);
        };
        let expected =
            Membership::Shape { kind: ShapeKind::Ramp, params: ramp.to_vec(), height: 1.0 };
        assert_eq!(*membership, expected);
        let told = fcl::write(&parts, Dialect::Iec, LOSSY).unwrap_err().to_string();
        assert!(told.contains("points do not tell the place of a grade"), "{told}");
    }
}

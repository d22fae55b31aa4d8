//! Systems in the Fuzzy Markup Language: what they mean, what is refused, and that nothing gets
//! lost on the way back. Such files were no known format.
#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use crate::common;

use common::{EXACT, LOSSY, answers, notes, paper, problems};
use fspid_formats::fcl::{self, Dialect};
use fspid_formats::{MAX_INPUT_BYTES, fis, fml};
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::{
    Antecedent, Conclusion, Defuzzifier, FallbackValue, Membership, Parts, Sampling, Statement,
    System, Universe, Variable,
};
use fspid_fuzzy::{Hedge, OutOfRange, SNormKind, TNormKind};

const HEATER: &str = include_str!("data/fml/heater.xml");
const PLANES: &str = include_str!("data/fml/planes.xml");
const BEFORE: &str = include_str!("data/fml/before.xml");
const BROKEN: &str = include_str!("data/fml/broken.xml");

fn read(text: &str) -> Parts {
    fml::read(text).unwrap_or_else(|problems| panic!("{problems}")).parts
}

fn grade(parts: &Parts, input: usize, term: usize, x: f64) -> f64 {
    parts.inputs[input].terms[term].membership.grade(x, &[], &mut [0.0; 8])
}

#[test]
fn every_part_of_a_mamdani_system_arrives() {
    let parts = read(HEATER);
    assert_eq!(parts.name, "heater");
    assert_eq!(parts.inputs[0].universe, Some(Universe { lower: -10.0, upper: 10.0 }));
    assert_eq!(parts.inputs[0].out_of_range, OutOfRange::Evaluate);
    let output = &parts.outputs[0];
    assert_eq!(output.fallback.value, FallbackValue::Number(5.0));
    assert_eq!(output.defuzzifier, Defuzzifier::Centroid(Sampling::Exact));
    assert!(output.aggregation.is(SNormKind::Maximum));
    let [block] = &parts.blocks[..] else { panic!("{} blocks", parts.blocks.len()) };
    assert!(block.and.is(TNormKind::Minimum) && block.or.is(SNormKind::AlgebraicSum));
    assert!(block.implication.is(TNormKind::AlgebraicProduct));
    let [first, second] = &block.rules[..] else { panic!("{} rules", block.rules.len()) };
    assert_eq!((first.name.as_str(), first.weight), ("first", 0.5));
    assert!(matches!(&first.antecedent, Antecedent::Any(parts) if parts.len() == 2));
    // A name that only counts is none.
    assert_eq!((second.name.as_str(), second.weight), ("", 1.0));
}

#[test]
fn what_a_system_means_is_what_its_sets_rules_and_methods_say() {
    let parts = read(HEATER);
    // -2 is low to 1/2, the draught of 4.5 is strong: 1; very: 1. Product, or: 1; half its weight.
    // Off is the complement of 1/2, and not some is 1 - exp(-50/9).
    let off: f64 = 1.0 - 0.5;
    let not_some = 1.0 - (-0.5 * (2.5_f64 / 0.75).powi(2)).exp();
    let (much, little) = (0.5, off.min(not_some));
    let (area_much, area_little) = (30.0 * much, 20.0 * little);
    let wanted = (75.0 * area_much + 20.0 * area_little) / (area_much + area_little);
    let found = answers(&parts, &[-2.0, 4.5])[0].expect("an answer");
    assert!((found - wanted).abs() < 1e-12, "{found} for {wanted}");
    // Nothing fires where it is neither cold nor draughty.
    assert_eq!(answers(&parts, &[0.0, 0.0])[0].map(|x| x > 0.0), Some(true));
}

#[test]
fn a_complement_is_one_minus_the_set_wherever_a_rule_names_it() {
    let parts = read(HEATER);
    let Antecedent::All(statements) = &parts.blocks[0].rules[1].antecedent else { panic!("and") };
    let hedges: Vec<_> = statements
        .iter()
        .map(|part| match part {
            Antecedent::Is(statement) => statement.hedges.clone(),
            _ => panic!("a statement"),
        })
        .collect();
    assert_eq!(hedges, [vec![Hedge::Not], vec![Hedge::Not]]);
    // The set is that of the other temperatures: under the file's name the rule would read the other way round.
    assert_eq!(parts.inputs[0].terms[2].name, "complement of off");
}

#[test]
fn numbers_planes_and_monotone_sets_are_weighted() {
    let parts = read(PLANES);
    assert!(matches!(parts.outputs[0].terms[0].conclusion, Conclusion::Constant(2.5)));
    let plane = Conclusion::Linear { coefficients: vec![1.0, -2.0], constant: 0.125 };
    assert_eq!(parts.outputs[0].terms[1].conclusion, plane);
    assert_eq!(parts.outputs[1].fallback.value, FallbackValue::Nothing);
    // At x = 1 only `high` holds; y = 1 is a corner to 1/2. The plane: 1 - 2 + 1/8.
    let found = answers(&parts, &[1.0, 1.0]);
    assert_eq!(found, [Some(-0.875), Some(9.0)]);
    // Half way up the strength is 1/2, and the place where the set has it 4.5.
    assert_eq!(answers(&parts, &[0.0, 0.0])[1], Some(4.5));
}

#[test]
fn a_rule_with_a_method_of_its_own_is_a_block_of_its_own() {
    let reading = fml::read(PLANES).expect("a system");
    let ands: Vec<_> = reading.parts.blocks.iter().map(|block| block.and.clone()).collect();
    let expected =
        [TNormKind::AlgebraicProduct, TNormKind::Minimum, TNormKind::Minimum].map(Into::into);
    assert_eq!(ands, expected);
    let told = notes(&reading).join("\n");
    assert!(told.contains("rules with methods of their own"), "{told}");
}

#[test]
fn sets_with_one_side_rise_to_the_right_in_the_standard_and_fell_before() {
    let standard = read(HEATER);
    assert_eq!([grade(&standard, 1, 2, 5.0), grade(&standard, 1, 0, -5.0)], [1.0, 1.0]);
    assert!(grade(&standard, 1, 2, 2.0) < 0.01 && grade(&standard, 1, 0, 2.0) < 0.01);
    let reading = fml::read(BEFORE).expect("a system");
    let before = &reading.parts;
    assert_eq!([grade(before, 0, 0, -1.0), grade(before, 0, 0, 1.0)], [1.0, 0.0]);
    assert_eq!([grade(before, 0, 1, -1.0), grade(before, 0, 1, 1.0)], [0.0, 1.0]);
    let told = notes(&reading).join("\n");
    assert!(told.contains("`RightLinearShape` begins with 1 and falls"), "{told}");
    assert!(told.contains("`piShape` with two numbers is read as centre and width"), "{told}");
    assert!(told.contains("a network address is not used"), "{told}");
}

#[test]
fn files_from_before_the_standard_answer() {
    let parts = read(BEFORE);
    let found = answers(&parts, &[0.5])[0].expect("an answer");
    let mirrored = answers(&parts, &[-0.5])[0].expect("an answer");
    assert!(found > 0.0 && (found + mirrored).abs() < 1e-15, "{found} and {mirrored}");
}

#[test]
fn every_problem_of_a_broken_file_is_told_with_its_place() {
    let told = problems(fml::read(BROKEN));
    let expected = include_str!("data/fml/broken.txt");
    assert_eq!(told, expected.trim_end(), "\n{told}");
}

#[test]
fn entities_deep_nests_and_texts_without_end_are_refused() {
    let bomb =
        "<!DOCTYPE f [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;&a;\">]><fuzzySystem name=\"&b;\"/>";
    let told = problems(fml::read(bomb));
    assert!(told.starts_with("1:1: `<!DOCTYPE`: a document type is not read"), "{told}");
    let deep = format!("<fuzzySystem name=\"a\">{}", "<a>".repeat(100_000));
    let closed = format!("{deep}{}</fuzzySystem>", "</a>".repeat(100_000));
    for (text, words) in [(&closed, "nested too deeply"), (&deep, "not well-formed")] {
        let told = problems(fml::read(text));
        assert!(told.contains(words), "{told}");
    }
    let told = problems(fml::read(&" ".repeat(MAX_INPUT_BYTES + 1)));
    assert_eq!(told, "the text has 10485761 bytes; expected at most 10485760");
    for text in
        ["", "no markup", "<a", "<html/>", "<fuzzySystem/>", "\u{feff}<fuzzySystem name='a'/>"]
    {
        assert!(fml::read(text).is_err(), "{text}");
    }
}

#[test]
fn columns_are_counted_after_a_byte_order_mark_and_with_every_line_end() {
    for (text, place) in [
        ("\u{feff}<fuzzySystem name='a' b='1'/>", "1:23"),
        ("<fuzzySystem\rname='ä' b='1'/>", "2:10"),
        ("<fuzzySystem\r\nname='ä'\n b='1'/>", "3:2"),
    ] {
        let told = problems(fml::read(text));
        assert!(told.contains(&format!("{place}: `b`: not an attribute")), "{text:?}: {told}");
    }
}

/// What is written reads back, and then stays as it is.
fn comes_back(parts: &Parts) -> (String, Parts) {
    let text = fml::write(parts, EXACT).unwrap_or_else(|problems| panic!("{problems}")).text;
    let again = read(&text);
    let second = fml::write(&again, EXACT).unwrap_or_else(|problems| panic!("{problems}")).text;
    assert_eq!(read(&second), again, "{second}");
    (text, again)
}

#[test]
fn what_is_written_reads_back_and_answers_the_same_bits() {
    for text in [PLANES, BEFORE, &HEATER.replace("complement=\"true\"", "complement=\"false\"")] {
        let parts = read(text);
        let (_, again) = comes_back(&parts);
        assert_eq!(again.inputs, parts.inputs);
        assert_eq!(again.outputs, parts.outputs);
        for step in 0..50 {
            let at: Vec<f64> = (0..parts.inputs.len())
                .map(|input| (f64::from(step) * (0.37 + 0.2 * input as f64)).sin() * 3.0)
                .collect();
            assert_eq!(answers(&again, &at), answers(&parts, &at), "{at:?}");
        }
    }
}

#[test]
fn the_paper_s_controller_goes_out_and_comes_back_with_every_bit() {
    let parts = paper(Sampling::Exact);
    let (text, again) = comes_back(&parts);
    assert!(
        text.contains("<gaussianShape param1=\"-5\" param2=\"0.7077681669066825\"/>"),
        "{text}"
    );
    for at in [[0.0, 0.0], [5.0, 5.0], [-3.3, 0.7], [1.0, -2.0], [9.0, -9.0]] {
        assert_eq!(answers(&again, &at), answers(&parts, &at), "{at:?}");
    }
}

#[test]
fn another_tool_s_integrals_are_a_loss_that_is_measured() {
    let parts = fis::read(include_str!("data/fis/paper.fis")).expect("a system").parts;
    let refused = fml::write(&parts, EXACT).expect_err("sampled").to_string();
    assert!(refused.contains("integrals are computed by `endpoints:101`"), "{refused}");
    let writing = fml::write(&parts, LOSSY).expect("allowed");
    let told = writing.notes.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n");
    assert!(
        told.contains(
            "largest change of an answer within the ranges of the inputs, found at 500 points and near the worst of them; beyond the ranges it is not measured: `dkp` 4.1e-2"
        ),
        "{told}"
    );
    assert!(fml::read(&writing.text).is_ok());
}

#[test]
fn every_shape_is_written_as_itself_as_points_or_near_it() {
    for &kind in ShapeKind::ALL {
        let mut parts = read(BEFORE);
        let set = Membership::Shape { kind, params: kind.example().to_vec(), height: 1.0 };
        parts.inputs[0].terms[2].membership = set.clone();
        match fml::write(&parts, EXACT) {
            Ok(writing) => {
                let again = read(&writing.text);
                for step in -200..=200_i32 {
                    let x = f64::from(step) / 32.0;
                    let (found, wanted) = (grade(&again, 0, 2, x), grade(&parts, 0, 2, x));
                    // Points have their own steps between them.
                    assert!((found - wanted).abs() < 1e-15, "{} {x}", kind.name());
                }
            }
            Err(refused) => {
                let refused = refused.to_string();
                assert!(refused.contains("has no words in FML"), "{}: {refused}", kind.name());
                let near = fml::write(&parts, LOSSY).expect("allowed");
                assert!(fml::read(&near.text).is_ok(), "{}", kind.name());
            }
        }
    }
}

#[test]
fn every_norm_defuzzifier_and_modifier_comes_back() {
    let parts = read(BEFORE);
    for &kind in TNormKind::ALL {
        let mut parts = parts.clone();
        parts.blocks[0].and = kind.into();
        parts.blocks[0].implication = kind.into();
        assert_eq!(comes_back(&parts).1, parts);
    }
    for &kind in SNormKind::ALL {
        let mut parts = parts.clone();
        parts.blocks[0].or = kind.into();
        parts.outputs[0].aggregation = kind.into();
        let named = !matches!(kind, SNormKind::UnboundedSum | SNormKind::NormalizedSum);
        assert_eq!(fml::write(&parts, EXACT).is_ok(), named, "{}", kind.name());
        if named {
            assert_eq!(comes_back(&parts).1, parts);
        }
    }
    for name in
        ["centroid", "bisector", "mean-of-maximum", "smallest-of-maximum", "largest-of-maximum"]
    {
        let mut parts = parts.clone();
        parts.outputs[0].defuzzifier = Defuzzifier::from_name(name).expect("known");
        assert_eq!(comes_back(&parts).1, parts);
    }
    let modifiers = Hedge::NAMED.iter().copied().chain([3.0, 1.25, 0.5].map(Hedge::Power));
    for hedge in modifiers {
        let mut parts = parts.clone();
        let Antecedent::Is(statement) = &mut parts.blocks[0].rules[0].antecedent else { panic!() };
        statement.hedges = vec![hedge];
        assert_eq!(comes_back(&parts).1, parts, "{}", hedge.name());
    }
}

#[test]
fn a_modifier_in_a_conclusion_makes_a_set_of_its_own() {
    let text = BEFORE.replacen(
        "<Clause><Variable>u</Variable><Term>up</Term>",
        "<Clause modifier=\"very\"><Variable>u</Variable><Term>up</Term>",
        1,
    );
    let parts = read(&text);
    let term = &parts.outputs[0].terms[2];
    assert_eq!((term.name.as_str(), parts.blocks[0].rules[1].consequents[0].term), ("very up", 2));
    let Conclusion::Set { membership, .. } = &term.conclusion else { panic!("a set") };
    let found: f64 = membership.grade(0.25, &[], &mut [0.0; 4]);
    assert!((found - 0.25).abs() < 1e-15, "{found}");
    assert!(System::new(parts).is_ok());
}

#[test]
fn what_has_no_words_is_refused_by_name() {
    let base = read(BEFORE);
    let refused = |change: fn(&mut Parts), words: &str| {
        let mut parts = read(BEFORE);
        change(&mut parts);
        let told = fml::write(&parts, EXACT).expect_err(words).to_string();
        assert!(told.contains(words), "{told}");
    };
    refused(|parts| parts.inputs[0].enabled = false, "is switched off");
    refused(|parts| parts.inputs[0].out_of_range = OutOfRange::Clamp, "values outside its range");
    refused(|parts| parts.outputs[0].fallback.previous = true, "keeps its answer");
    refused(
        |parts| {
            let one = parts.blocks[0].rules[0].antecedent.clone();
            let both = Antecedent::All(vec![one.clone(), one.clone()]);
            parts.blocks[0].rules[0].antecedent = Antecedent::Any(vec![both, one]);
        },
        "both `and` and `or`",
    );
    refused(
        |parts| parts.blocks[0].rules[0].consequents[0].hedges = vec![Hedge::Very],
        "a hedge of a conclusion's strength",
    );
    // Points have no place of a grade; what was written once could not be read.
    let mut scaled = read(PLANES);
    let Conclusion::Set { membership: Membership::Shape { height, .. }, .. } =
        &mut scaled.outputs[1].terms[0].conclusion
    else {
        panic!("a set")
    };
    *height = 0.5;
    let told = fml::write(&scaled, LOSSY).expect_err("no words").to_string();
    assert!(told.contains("points cannot stand for it"), "{told}");
    let mut renamed = base;
    renamed.inputs[0].name = " e\n".into();
    assert!(fml::write(&renamed, EXACT).is_err());
    let writing = fml::write(&renamed, LOSSY).expect("allowed");
    assert_eq!(read(&writing.text).inputs[0].name, "_e_");
}

#[test]
fn names_with_signs_of_xml_come_back() {
    let mut parts = read(BEFORE);
    parts.name = "<a & \"b\" > 'c'".into();
    parts.inputs[0].name = "x<y&z".into();
    parts.inputs[0].terms[0].name = "\"quoted\" ä".into();
    assert_eq!(comes_back(&parts).1, parts);
}

#[test]
fn nothing_is_too_strange_to_be_answered() {
    for text in [HEATER, PLANES, BEFORE, BROKEN] {
        for (end, _) in text.char_indices().step_by(3) {
            fspid_formats::fuzzing::fml(&text.as_bytes()[..end]);
        }
        for (at, old) in text.char_indices().step_by(2) {
            for new in ["", "<", "\"", "9", "&", "/"] {
                let changed = format!("{}{new}{}", &text[..at], &text[at + old.len_utf8()..]);
                fspid_formats::fuzzing::fml(changed.as_bytes());
            }
        }
    }
}

/// It was written without one, and called lost; a default that is the middle was called lost, though nothing was.
#[test]
fn a_missing_range_is_a_loss_and_a_default_in_the_middle_is_none() {
    let mut parts = read(BEFORE);
    parts.inputs[0].universe = None;
    let refused = fml::write(&parts, EXACT).expect_err("the standard asks for one").to_string();
    assert!(refused.contains("has no range, which the standard asks for"), "{refused}");
    let writing = fml::write(&parts, LOSSY).expect("allowed");
    let again = read(&writing.text);
    assert!(again.inputs[0].universe.is_some(), "{}", writing.text);
    assert_eq!(answers(&again, &[0.3]), answers(&parts, &[0.3]));
    let mut parts = read(HEATER);
    parts.blocks.clear();
    parts.outputs[0].fallback.value = FallbackValue::Middle;
    let writing = fml::write(&parts, EXACT).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(writing.notes, [], "nothing is lost");
    assert!(matches!(read(&writing.text).outputs[0].fallback.value, FallbackValue::Number(_)));
}

/// An infinite end used to be written as `-inf`, which the reader refuses.
#[test]
fn a_rectangle_without_an_end_is_written_as_points() {
    let mut parts = paper(Sampling::Exact);
    for (ends, [inside, outside]) in
        [([f64::NEG_INFINITY, 1.0], [-4.0, 1.5]), ([1.0, f64::INFINITY], [1.5, 0.5])]
    {
        let params = ends.to_vec();
        parts.inputs[0].terms[0].membership =
            Membership::Shape { kind: ShapeKind::Rectangle, params, height: 1.0 };
        let back = read(&fml::write(&parts, EXACT).unwrap().text);
        assert_eq!([inside, outside].map(|x| grade(&back, 0, 0, x)), [1.0, 0.0]);
    }
}

/// "An integral stays in its range" of a default of -1000, which does not.
#[test]
fn a_default_outside_of_a_range_that_limits_is_lost() {
    let mut parts = read(HEATER);
    parts.outputs[0].clamp = true;
    assert!(fml::write(&parts, EXACT).is_ok());
    parts.outputs[0].fallback.value = FallbackValue::Number(-1000.0);
    let told = fml::write(&parts, EXACT).unwrap_err().to_string();
    assert!(told.contains("its default lies outside of its range"), "{told}");
    assert!(fml::write(&parts, LOSSY).is_ok());
}

/// It was written as a number, read as one that is averaged, and answered 0.9 in place of the default; beside sets the file that
/// was written was refused.
#[test]
fn a_singleton_that_is_integrated_is_no_number_of_fcl() {
    let mut parts = read(HEATER);
    let membership =
        Membership::Shape { kind: ShapeKind::Singleton, params: vec![60.0], height: 1.0 };
    parts.outputs[0].terms[0].conclusion = Conclusion::Set { membership, lower: None };
    for dialect in [Dialect::Iec, Dialect::Fuzzylite, Dialect::JFuzzyLogic] {
        let told = fcl::write(&parts, dialect, LOSSY).unwrap_err().to_string();
        assert!(told.contains("is read as a number in FCL"), "{told}");
    }
}

/// What rules ask used to come back added up, with other answers and without a word.
#[test]
fn the_aggregation_of_a_weighted_output_that_rules_ask_is_a_loss_that_is_told() {
    let mut parts = read(PLANES);
    let variable = Variable::Output(0);
    let asking = Antecedent::Is(Statement { variable, term: Some(0), hedges: vec![] });
    let mut rule = parts.blocks[0].rules[0].clone();
    rule.antecedent = asking;
    parts.blocks[0].rules.push(rule);
    assert!(parts.outputs[0].defuzzifier.sampling().is_none());
    assert!(parts.outputs[0].aggregation.is(SNormKind::UnboundedSum));
    assert!(fml::write(&parts, EXACT).is_ok());
    parts.outputs[0].aggregation = SNormKind::Maximum.into();
    let told = fml::write(&parts, EXACT).expect_err("another aggregation").to_string();
    assert!(told.contains("how that is joined has no words in FML"), "{told}");
    let writing = fml::write(&parts, LOSSY).expect("allowed");
    assert!(read(&writing.text).outputs[0].aggregation.is(SNormKind::UnboundedSum));
    parts.blocks[0].rules.pop();
    assert!(fml::write(&parts, EXACT).is_ok(), "nobody asks");
}

//! What jFuzzyLogic makes of rule blocks, against its own answers (`oracles/make_jfuzzylogic.py`).

use crate::common;

use common::{EXACT, LOSSY, answers, notes, problems};
use fspid_formats::fcl::{self, Dialect, ReadOptions};
use fspid_formats::fll;
use fspid_fuzzy::system::{Antecedent, Membership, Parts};
use fspid_fuzzy::{SNormKind, TNormKind};

const SYSTEM: &str = include_str!("data/fcl/asked-jfuzzylogic.fcl");
const ANSWERS: &str = include_str!("data/fcl/asked-jfuzzylogic.csv");
/// Sums of 1000 products in doubles.
const TOLERANCE: f64 = 1e-12;
const WEIGHED: &str = "IF x IS b THEN z IS l";

/// The system with these statements and rules; several rules are separated by semicolons.
fn with(statements: &str, rules: &str) -> String {
    let numbered =
        rules.split("; ").zip(1..).map(|(rule, number)| format!("RULE {number} : {rule};\n"));
    SYSTEM.replace("[statements]", statements).replace("[rules]", &numbered.collect::<String>())
}

fn read(text: &str) -> Parts {
    fcl::read(text).unwrap_or_else(|problems| panic!("{problems}\n{text}")).parts
}

/// Statements, rules, the two questions, and the two answers.
fn asked() -> impl Iterator<Item = (&'static str, &'static str, [f64; 2], [f64; 2])> {
    ANSWERS.lines().skip(1).map(|line| {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |cell: usize| cells[cell].parse::<f64>().expect("a number");
        (cells[0], cells[1], [number(2), number(3)], [number(4), number(5)])
    })
}

fn agrees(parts: &Parts, question: [f64; 2], right: [f64; 2], text: &str) {
    for (found, right) in answers(parts, &question).into_iter().zip(right) {
        let found = found.expect("there is a default");
        assert!((found - right).abs() < TOLERANCE, "{found}, not {right}, at {question:?}\n{text}");
    }
}

#[test]
fn rule_blocks_in_jfuzzylogic_s_dialect_answer_as_jfuzzylogic_does() {
    for (statements, rules, question, right) in asked() {
        let text = with(statements, rules);
        agrees(&read(&text), question, right, &text);
    }
}

#[test]
fn what_is_written_for_jfuzzylogic_is_read_by_its_ways_as_the_same_answers() {
    let (mut written, mut refused) = (0, 0);
    for (statements, rules, question, right) in asked() {
        let mut parts = read(&with(statements, rules));
        if rules.contains("x IS d") || rules.contains("x IS e") {
            continue;
        }
        // The formulas of the sets that are cut have no words there.
        parts.inputs[0].terms.truncate(3);
        match fcl::write(&parts, Dialect::JFuzzyLogic, EXACT) {
            Ok(writing) => {
                agrees(&read(&writing.text), question, right, &writing.text);
                written += 1;
            }
            Err(problems) => {
                assert!(problems.to_string().contains("no pair of jFuzzyLogic"), "{problems}");
                refused += 1;
            }
        }
    }
    // Rules that were joined by a norm that their *and* has no pair with, each asked three times.
    assert_eq!((written, refused), (171, 9));
}

#[test]
fn what_is_written_in_the_standard_s_dialect_adds_equal_conclusions_up_by_an_option() {
    let rules = format!("IF x IS a THEN z IS h; IF y IS a THEN z IS h; {WEIGHED}");
    let mut parts = read(&with("AND : PROD; ACCU : SUM;", &rules));
    for input in &mut parts.inputs {
        input.terms.truncate(2);
    }
    let writing = fcl::write(&parts, Dialect::Iec, LOSSY).expect("words");
    assert!(writing.text.contains("FSPID_EQUAL_CONCLUSIONS z : ADDED;"), "{}", writing.text);
    assert!(
        writing.notes.iter().any(|note| note.message.contains("other tools join them by ACCU"))
    );
    let added = answers(&read(&writing.text), &[3.0, 6.0])[0].expect("an answer");
    assert!((added - 9.0 / 1.6).abs() < TOLERANCE, "0.3 and 0.6 are 0.9: {added}");
    let without = writing.text.replace("  FSPID_EQUAL_CONCLUSIONS z : ADDED;\n", "");
    let joined = answers(&read(&without), &[3.0, 6.0])[0].expect("an answer");
    assert!((joined - 6.0 / 1.3).abs() < TOLERANCE, "the greater of 0.3 and 0.6: {joined}");
}

#[test]
fn equal_conclusions_that_are_not_one_rule_are_refused() {
    let refused = |statements: &str, rules: &str| problems(fcl::read(&with(statements, rules)));
    let equal = "IF x IS a THEN z IS h; IF y IS a THEN z IS h";
    for (statements, rules, why) in [
        ("ACCU : BSUM;", format!("{equal} WITH 0.5; {WEIGHED}"), "they have weights"),
        (
            "AND : HAMACHER; ACCU : MAX;",
            format!("{equal}; IF x IS a OR y IS b THEN z IS l"),
            "another OR",
        ),
        (
            "ACCU : MAX;",
            format!("{equal}; IF v IS h THEN z IS l; IF x IS a THEN v IS h"),
            "ask outputs",
        ),
        ("ACCU : MAX;", "IF x IS a THEN z IS h; IF y IS a THEN z IS NOT h".into(), "hedged"),
    ] {
        let told = refused(statements, &rules);
        assert!(told.contains(why) && told.contains("`ACCU : SUM`"), "{told}");
    }
    let second =
        "END_RULEBLOCK RULEBLOCK two ACCU : MAX; RULE 1 : IF y IS a THEN z IS h; END_RULEBLOCK";
    let text = with("ACCU : MAX;", "IF x IS a THEN z IS h").replacen("END_RULEBLOCK", second, 1);
    assert!(problems(fcl::read(&text)).contains("several rule blocks"));
    // Added up, all of them are as they stand.
    assert!(fcl::read(&text.replace("ACCU : MAX", "ACCU : SUM")).is_ok());
}

#[test]
fn equal_weights_and_deep_conditions_are_joined_as_far_as_that_is_the_same() {
    let half = "IF x IS a THEN z IS h WITH 0.5; IF y IS a THEN z IS h WITH 0.5";
    assert!(fcl::read(&with("ACCU : MAX;", half)).is_ok());
    assert!(problems(fcl::read(&with("ACCU : BSUM;", half))).contains("they have weights"));
    // Without an OR of the rules, the block takes that of the accumulation.
    let equal = "IF x IS a AND y IS a THEN z IS h; IF y IS b THEN z IS h";
    assert!(read(&with("AND : HAMACHER; ACCU : MAX;", equal)).blocks[0].or.is(SNormKind::Maximum));
    let nested = |nots: usize| {
        let deep = format!("{} x IS a", "NOT ".repeat(nots));
        fcl::read(&with("ACCU : MAX;", &format!("IF {deep} THEN z IS h; IF y IS a THEN z IS h")))
    };
    assert!(nested(63).is_ok());
    assert!(problems(nested(64)).contains("their conditions are nested too deeply"));
}

#[test]
fn an_or_that_accu_has_too_stays_as_it_is() {
    let rules = "IF x IS a OR y IS b THEN z IS h; IF y IS a THEN z IS h";
    let rule = read(&with("AND : MIN; ACCU : MAX;", rules)).blocks[0].rules[0].antecedent.clone();
    assert!(matches!(&rule, Antecedent::Any(parts) if matches!(parts[0], Antecedent::Any(_))));
    let rule = read(&with("AND : PROD; ACCU : MAX;", rules)).blocks[0].rules[0].antecedent.clone();
    assert!(matches!(&rule, Antecedent::Any(parts) if matches!(parts[0], Antecedent::Not(_))));
}

/// A join of one part joins nothing: no norm is asked for it.
#[test]
fn connectives_that_join_one_part_alone_need_no_word() {
    let mut parts = read(&with("AND : MIN; ACCU : SUM;", WEIGHED));
    parts.inputs[0].terms.truncate(2);
    let block = &mut parts.blocks[0];
    block.and = TNormKind::EinsteinProduct.into();
    block.or = SNormKind::HamacherSum.into();
    let alone = block.rules[0].antecedent.clone();
    for joined in [Antecedent::All(vec![alone.clone()]), Antecedent::Any(vec![alone])] {
        parts.blocks[0].rules[0].antecedent = joined;
        assert!(fcl::write(&parts, Dialect::JFuzzyLogic, EXACT).is_ok());
    }
}

#[test]
fn joined_rules_are_told_and_keep_what_else_they_conclude() {
    let rules = "IF x IS a THEN z IS h, v IS h; IF y IS a THEN z IS h; IF x IS b THEN z IS l";
    let reading = fcl::read(&with("AND : MIN; ACCU : MAX;", rules)).expect("a system");
    let told = notes(&reading);
    assert!(
        told.iter()
            .any(|note| note.contains("`z` are read as one") && note.contains("3 rules became 3")),
        "{told:?}"
    );
    let rules = &reading.parts.blocks[0].rules;
    assert_eq!(rules.iter().map(|rule| rule.consequents.len()).collect::<Vec<_>>(), [1, 1, 1]);
    assert_eq!(rules[0].consequents[0].output, 1, "what the first rule concludes beside");
    assert!(matches!(&rules[1].antecedent, Antecedent::Any(parts) if parts.len() == 2));
}

#[test]
fn connectives_that_are_no_pair_of_jfuzzylogic_are_a_loss_that_is_measured() {
    let rules =
        format!("IF x IS a AND y IS a THEN z IS h; IF x IS a OR y IS b THEN z IS l; {WEIGHED}");
    let mut parts = read(&with("AND : MIN; ACCU : SUM;", &rules));
    parts.inputs[0].terms.truncate(2);
    parts.blocks[0].or = SNormKind::AlgebraicSum.into();
    let told = fcl::write(&parts, Dialect::JFuzzyLogic, EXACT).expect_err("no pair").to_string();
    assert!(told.contains("no pair of jFuzzyLogic"), "{told}");
    let writing = fcl::write(&parts, Dialect::JFuzzyLogic, LOSSY).expect("a loss");
    assert!(read(&writing.text).blocks[0].or.is(SNormKind::Maximum), "{}", writing.text);
    let told = writing.notes.last().expect("a measure").message.clone();
    assert!(told.contains("largest change") && !told.contains("`z` 0.0e0"), "{told}");
    // One that no rule uses is free.
    parts.blocks[0].rules.remove(1);
    assert!(fcl::write(&parts, Dialect::JFuzzyLogic, EXACT).is_ok());
    parts.blocks[0].and = TNormKind::EinsteinProduct.into();
    let told = fcl::write(&parts, Dialect::JFuzzyLogic, LOSSY).expect_err("no word").to_string();
    assert!(told.contains("HAMACHER with EINSTEIN"), "{told}");
}

#[test]
fn a_difference_that_jfuzzylogic_cuts_at_0_is_read_as_its_formula() {
    let reading = fcl::read(&with("AND : MIN;", WEIGHED)).expect("a system");
    let terms = &reading.parts.inputs[0].terms;
    assert!(matches!(terms[3].membership, Membership::Formula { .. }));
    assert!(notes(&reading).iter().any(|note| note.contains("`DSIGM` is cut at 0")));
    let text = with("AND : MIN;", WEIGHED).replace("DSIGM 2 3 1 6", "DSIGM 2 3 2 6");
    assert!(
        matches!(read(&text).inputs[0].terms[3].membership, Membership::Shape { .. }),
        "never below 0"
    );
}

/// Written without brackets they meant something else to jFuzzyLogic, where *and* and *or* have one rank.
#[test]
fn mixed_connectives_are_written_in_brackets_in_every_dialect() {
    let rule = format!("IF x IS a OR (y IS a AND y IS b) THEN z IS h; {WEIGHED}");
    let mut parts = read(&with("AND : PROD; ACCU : SUM;", &rule));
    parts.inputs[0].terms.truncate(2);
    for dialect in [Dialect::Iec, Dialect::JFuzzyLogic, Dialect::Fuzzylite] {
        let text = fcl::write(&parts, dialect, LOSSY).expect("words").text.to_lowercase();
        assert!(text.contains("if x is a or (y is a and y is b) then"), "{text}");
    }
    let text = fll::write(&parts, LOSSY).expect("words").text;
    assert!(text.contains("if x is a or (y is a and y is b) then"), "{text}");
}

#[test]
fn the_rank_of_and_is_the_dialect_s() {
    let text = with("AND : PROD; ACCU : SUM;", "IF x IS a OR y IS a AND y IS b THEN z IS h");
    let top = |dialect| {
        let options = ReadOptions { dialect: Some(dialect), ..ReadOptions::default() };
        fcl::read_with(&text, options).expect("a system").parts.blocks[0].rules[0]
            .antecedent
            .clone()
    };
    assert!(matches!(top(Dialect::JFuzzyLogic), Antecedent::All(_)));
    assert!(matches!(top(Dialect::Iec), Antecedent::Any(_)));
    assert!(matches!(top(Dialect::Fuzzylite), Antecedent::Any(_)));
}

/// Each change from one to the other is a level: a hostile row of them must not exhaust the stack.
#[test]
fn long_rows_of_mixed_connectives_are_refused() {
    let row = |count: usize| {
        let row = "x IS a AND y IS a OR ".repeat(count);
        fcl::read(&with("AND : PROD;", &format!("IF {row}x IS b THEN z IS h")))
    };
    assert!(row(32).is_ok());
    for count in [33, 100_000] {
        assert!(problems(row(count)).contains("more than 64 levels deep"), "{count}");
    }
    let alike = "x IS a AND ".repeat(10_000);
    assert!(fcl::read(&with("AND : PROD;", &format!("IF {alike}x IS b THEN z IS h"))).is_ok());
}

#[test]
fn without_accu_conclusions_are_joined_as_the_dialect_has_it_and_that_is_told() {
    let rules = "IF x IS a THEN v IS h; IF y IS a THEN v IS h";
    let reading = fcl::read(&with("AND : MIN;", rules)).expect("a system");
    assert!(reading.parts.outputs[1].aggregation.is(SNormKind::UnboundedSum));
    let told = notes(&reading);
    assert!(
        told.iter().any(|note| note.contains("no ACCU is given for `v`; SUM is assumed")),
        "{told:?}"
    );
    let text =
        with("AND : MIN;", "IF x IS a THEN z IS h; IF y IS a THEN z IS h; IF x IS a THEN v IS h");
    let options = ReadOptions { dialect: Some(Dialect::Iec), ..ReadOptions::default() };
    let told = notes(&fcl::read_with(&text, options).expect("a system"));
    for note in ["for `z`; rules that conclude the same are added up", "for `v`; MAX is assumed"] {
        assert!(told.iter().any(|told| told.contains(note)), "{told:?}");
    }
}

#[test]
fn the_last_of_and_and_or_sets_both_and_that_is_told() {
    let reading = fcl::read(&with("AND : MIN; OR : ASUM;", WEIGHED)).expect("a system");
    let block = &reading.parts.blocks[0];
    assert!(block.and.is(TNormKind::AlgebraicProduct) && block.or.is(SNormKind::AlgebraicSum));
    let told = notes(&reading);
    assert!(
        told.iter().any(|note| note.contains("from the last of AND and OR: PROD and ASUM")),
        "{told:?}"
    );
    for alike in ["AND : PROD;", "AND : PROD; OR : ASUM;", "OR : ASUM;"] {
        let told = notes(&fcl::read(&with(alike, WEIGHED)).expect("a system"));
        assert!(!told.iter().any(|note| note.contains("the last of AND and OR")), "{told:?}");
    }
}

#[test]
fn fll_tells_that_version_8_joins_equal_conclusions_by_the_aggregation() {
    let text = |rules: &str| {
        format!(
            "Engine: e\nInputVariable: x\n  range: 0 1\n  term: a Ramp 0 1\nOutputVariable: z\n  range: 0 1\n  aggregation: Maximum\n  \
             defuzzifier: WeightedAverage TakagiSugeno\n  term: h Constant 1\n  term: l Constant 0\nRuleBlock: r\n  \
             conjunction: Minimum\n  disjunction: Maximum\n  activation: General\n{rules}"
        )
    };
    let told = |rules: &str| {
        let reading = fll::read(&text(rules)).unwrap_or_else(|problems| panic!("{problems}"));
        notes(&reading).iter().any(|note| note.contains("version 8 joins them by the aggregation"))
    };
    let twice = "  rule: if x is a then z is h\n  rule: if x is not a then z is h\n";
    assert!(told(twice));
    assert!(
        !told("  rule: if x is a then z is h\n  rule: if x is not a then z is l\n"),
        "each once"
    );
}

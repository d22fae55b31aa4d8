//! What is wrong with a text: every problem, its line and column, the word, and what would be right.

use crate::common;

use common::{EXACT, problems};
use fspid_formats::fcl::Dialect;
use fspid_formats::{fcl, fll};
use fspid_fuzzy::SNormKind;
use fspid_fuzzy::system::{Antecedent, Variable};

#[test]
fn every_problem_of_a_broken_text_is_told_at_once() {
    let fcl = problems(fcl::read(include_str!("data/fcl/broken.fcl")));
    assert_eq!(fcl, include_str!("data/fcl/broken.txt").trim_end());
    let fll = problems(fll::read(include_str!("data/fll/broken.fll")));
    assert_eq!(fll, include_str!("data/fll/broken.txt").trim_end());
}

/// A rule in a function block with an input x of low and high, and an output y of a and b.
fn told_of_rule(rule: &str) -> String {
    let text = format!(
        "FUNCTION_BLOCK f VAR_INPUT x : REAL; END_VAR VAR_OUTPUT y : REAL; END_VAR
FUZZIFY x TERM low := (0, 1) (1, 0); TERM high := (0, 0) (1, 1); END_FUZZIFY
DEFUZZIFY y TERM a := 1; TERM b := 2; METHOD : COGS; END_DEFUZZIFY
RULEBLOCK r
{rule}
END_RULEBLOCK END_FUNCTION_BLOCK"
    );
    problems(fcl::read(&text))
}

#[test]
fn a_rule_that_cannot_be_read_is_a_problem_and_never_skipped() {
    let rows = [
        ("RULE 1 : x IS low THEN y IS a;", "5:10: `x`: does not fit here; expected `if`"),
        (
            "RULE 1 : IF x IS THEN y IS a;",
            "5:18: `THEN`: the term is missing; expected one of `low`, `high`",
        ),
        (
            "RULE 1 : IF x IS low THEN y IS;",
            "5:31: `;`: the term is missing; expected one of `a`, `b`",
        ),
        (
            "RULE 1 : IF x IS low THEN;",
            "5:26: `;`: not the name of a variable; expected one of `x`, `y`",
        ),
        (
            "RULE 1 : IF x IS low y IS a;",
            "5:22: `y`: does not fit behind a term; expected `and`, `or`, `then`, `with` or the end",
        ),
        ("RULE 1 : IF (x IS low THEN y IS a;", "5:23: `THEN`: does not fit here; expected `)`"),
        ("RULE 1 : IF x IS low) THEN y IS a;", "5:21: `)`: does not fit here; expected `then`"),
        (
            "RULE 1 : IF x IS low THEN y IS a WITH -0.5;",
            "5:39: `-0.5`: not a weight; expected a number from 0 to 1",
        ),
        (
            "RULE 1 : IF x IS low THEN y IS a WITH ;",
            "5:39: `;`: not a weight; expected a number from 0 to 1",
        ),
        ("RULE 1 : IF x IS low THEN y IS a IS b;", "5:34: `IS`: does not fit here; expected `;`"),
        (
            "RULE 1 : IF x IS low THEN y IS any;",
            "5:27: `y`: nothing is concluded about it; expected a term after the hedges",
        ),
        ("RULE 1 IF x IS low THEN y IS a;", "5:8: `IF`: does not fit here; expected `:`"),
        ("RULE 1 : IF x IS low THEN y", "6:1: `END_RULEBLOCK`: the rule ends; expected `is`"),
    ];
    for (rule, expected) in rows {
        assert_eq!(told_of_rule(rule), expected, "{rule}");
    }
}

#[test]
fn problems_in_several_rules_are_all_told() {
    let rules = "RULE 1 : IF x IS cold THEN y IS a;\nRULE 2 : IF x IS low THEN y IS c\nRULE 3 : IF z IS low THEN y IS a;";
    let told = told_of_rule(rules);
    let places: Vec<&str> = told.lines().filter_map(|line| line.split(": ").next()).collect();
    assert_eq!(places, ["5:18", "6:32", "7:13"]);
}

#[test]
fn sections_that_do_not_end_are_told_where_the_next_begins() {
    let text = include_str!("data/fcl/tipper-iec.fcl");
    for end in ["END_VAR", "END_FUZZIFY", "END_DEFUZZIFY", "END_RULEBLOCK"] {
        let told = problems(fcl::read(&text.replacen(end, "", 1)));
        let expected = format!("a section has no end; expected `{end}`");
        assert!(told.contains(&expected), "{told}");
    }
    let told = problems(fcl::read(&text.replace("END_FUNCTION_BLOCK", "")));
    assert!(told.contains("a function block has no end; expected `END_FUNCTION_BLOCK`"), "{told}");
    assert_eq!(problems(fcl::read("")), "the text has no FUNCTION_BLOCK");
}

#[test]
fn a_comment_without_an_end_is_told_where_it_begins() {
    let told = problems(fcl::read("FUNCTION_BLOCK a\n  (* END_FUNCTION_BLOCK"));
    assert!(told.contains("2:3: a comment has no end; expected `*)` or `*/`"), "{told}");
}

#[test]
fn a_system_without_outputs_or_rules_of_a_broken_kind_is_told_as_a_whole() {
    let told = problems(fll::read("Engine: nothing\n"));
    assert_eq!(
        told,
        "the system: has no input; at least one is needed\nthe system: has no output; at least one is needed"
    );
}

#[test]
fn a_rule_about_an_undefined_term_names_the_known_ones() {
    // As in a container-crane file that went round for years.
    let text =
        include_str!("data/fcl/tipper-iec.fcl").replace("tip IS generous", "tip IS pos_medium");
    assert_eq!(
        problems(fcl::read(&text)),
        "37:70: `pos_medium`: no term of `tip` has this name; expected one of `cheap`, `average`, `generous`"
    );
}

#[test]
fn brackets_beyond_64_levels_are_refused_where_they_are() {
    let nested = |depth: usize| {
        told_of_rule(&format!(
            "RULE 1 : IF {}x IS low{} THEN y IS c;",
            "(".repeat(depth),
            ")".repeat(depth)
        ))
    };
    assert!(nested(64).contains("no term of `y`"), "{}", nested(64));
    let message = "brackets and negations are nested more than 64 levels deep";
    assert_eq!(nested(65), format!("5:78: `x`: {message}"));
    let nots = format!("RULE 1 : IF {} x IS low THEN y IS a;", "NOT ".repeat(65));
    assert!(told_of_rule(&nots).contains(message));
}

/// One word for a block stands for all its outputs: it used to be that of the first, whatever rules ask.
#[test]
fn weighted_outputs_that_rules_ask_are_not_written_with_the_aggregation_of_another() {
    let text = "FUNCTION_BLOCK f VAR_INPUT x : REAL; END_VAR VAR_OUTPUT y : REAL; z : REAL; END_VAR \
        FUZZIFY x TERM up := (0, 0) (1, 1); END_FUZZIFY \
        DEFUZZIFY y TERM big := 1; METHOD : COGS; RANGE := (0 .. 1); END_DEFUZZIFY \
        DEFUZZIFY z TERM big := 2; TERM small := 1; METHOD : COGS; RANGE := (0 .. 2); END_DEFUZZIFY \
        RULEBLOCK b AND : MIN; ACT : MIN; ACCU : MAX; \
        RULE 1 : IF x IS up THEN z IS small; RULE 2 : IF x IS up THEN y IS big; \
        RULE 3 : IF y IS big THEN z IS big; END_RULEBLOCK END_FUNCTION_BLOCK";
    for dialect in [Dialect::Iec, Dialect::JFuzzyLogic] {
        let mut parts = fcl::read(text).expect("a system").parts;
        assert!(fcl::write(&parts, dialect, EXACT).is_ok());
        parts.outputs[1].aggregation = SNormKind::BoundedSum.into();
        // The output that nobody asks is free, that of the one that is asked comes back.
        let written = fcl::write(&parts, dialect, EXACT).expect("z is not asked").text;
        let again = fcl::read(&written).expect("a system").parts;
        assert!(again.outputs[0].aggregation.is(SNormKind::Maximum), "{written}");
        let asking = parts.blocks[0].rules[2].clone();
        parts.blocks[0].rules.push(asking);
        if let Antecedent::Is(statement) = &mut parts.blocks[0].rules[3].antecedent {
            statement.variable = Variable::Output(1);
        }
        let told = fcl::write(&parts, dialect, EXACT).expect_err("both are asked").to_string();
        assert!(told.contains("is joined in another way"), "{told}");
    }
}

//! Hedges in conclusions, which fuzzylite carries on to the conclusions behind them, against answers of pyfuzzylite
//! (`oracles/make_fuzzylite.py`).

use crate::common;

use common::{EXACT, answers, notes, problems};
use fspid_formats::fcl::{self, Dialect};
use fspid_formats::{Writing, fll};
use fspid_fuzzy::Hedge;
use fspid_fuzzy::system::{Activation, Consequent, Parts};

const SYSTEM: &str = include_str!("data/fll/hedged.fll");
const ANSWERS: &str = include_str!("data/fll/hedged.csv");
const NOTE: &str = "holds for the conclusions behind it too, as in fuzzylite";
/// Sums of 100 products in doubles.
const TOLERANCE: f64 = 1e-12;

/// The system with other rules, separated by semicolons.
fn with_rules(rules: &str) -> String {
    let (head, _) = SYSTEM.split_once("  rule: ").expect("a rule");
    rules.split("; ").fold(head.to_owned(), |text, rule| text + &format!("  rule: {rule}\n"))
}

fn read(text: &str) -> Parts {
    fll::read(text).unwrap_or_else(|problems| panic!("{problems}")).parts
}

/// Whether pyfuzzylite answers by these rules as the parts do; it must have been asked for them.
fn answers_as_pyfuzzylite(parts: &Parts, rules: &str) {
    let mut asked = 0;
    for row in ANSWERS.lines().skip(1).filter_map(|line| line.split_once(',')) {
        if row.0 != rules {
            continue;
        }
        asked += 1;
        let numbers: Vec<f64> =
            row.1.split(',').map(|cell| cell.parse().expect("a number")).collect();
        for (found, &right) in answers(parts, &numbers[..1]).iter().zip(&numbers[1..]) {
            let equal = found.map_or(right.is_nan(), |it| (it - right).abs() < TOLERANCE);
            assert!(equal, "{rules} at {}: {found:?}, not {right}", numbers[0]);
        }
    }
    assert!(asked > 0, "pyfuzzylite has not been asked: {rules}");
}

#[test]
fn a_hedge_of_a_conclusion_goes_on_to_those_behind_it_as_in_fuzzylite() {
    let mut rules: Vec<&str> =
        ANSWERS.lines().skip(1).filter_map(|line| line.split(',').next()).collect();
    rules.dedup();
    assert_eq!(rules.len(), 14);
    for rules in rules {
        answers_as_pyfuzzylite(&read(&with_rules(rules)), rules);
    }
}

#[test]
fn hedges_that_go_on_are_told_with_the_line_of_their_rule() {
    let told = |rules: &str| {
        let reading = fll::read(&with_rules(rules)).expect("a system");
        notes(&reading).into_iter().filter(|note| note.contains(NOTE)).collect::<Vec<_>>()
    };
    let found = told("if x is up then a is very s and b is s");
    assert!(matches!(&found[..], [only] if only.contains("49:")), "{found:?}");
    assert_eq!(told("if x is up then b is s and a is very s"), [""; 0]);
    assert_eq!(told("if x is up then off is not s and a is s"), [""; 0]);
}

#[test]
fn that_a_rule_which_does_not_fire_concludes_nothing_is_told() {
    let told = |rules: &str| {
        let reading = fll::read(&with_rules(rules)).expect("a system");
        assert_eq!(answers(&reading.parts, &[0.0]), [None; 4], "{rules}");
        notes(&reading).iter().any(|note| note.contains("does not fire"))
    };
    assert!(told("if x is up then a is not s"));
    assert!(told("if x is up then a is very any s"));
    assert!(!told("if x is up then a is very s"));
}

/// The first rule's conclusions are hedged so: `a`, `b`, `c` or `off`, and its hedges.
fn hedged(conclusions: &[(usize, &[Hedge])]) -> Parts {
    let mut parts = read(SYSTEM);
    let consequents = conclusions.iter().map(|&(output, hedges)| Consequent {
        output,
        term: 0,
        hedges: hedges.to_vec(),
    });
    parts.blocks[0].rules[0].consequents = consequents.collect();
    parts
}

/// The rules of a text, separated by semicolons.
fn rules_of(text: &str, key: &str, end: &str) -> String {
    let rules = text.lines().filter_map(|line| line.trim().strip_prefix(key));
    let rules =
        rules.filter_map(|rule| rule.split_once("if ").map(|(_, rule)| format!("if {rule}")));
    rules.map(|rule| rule.trim_end_matches(end).to_owned()).collect::<Vec<_>>().join("; ")
}

const VERY: &[Hedge] = &[Hedge::Very];
const NOT: &[Hedge] = &[Hedge::Not];
const NOT_VERY: &[Hedge] = &[Hedge::Not, Hedge::Very];
const SOMEWHAT: &[Hedge] = &[Hedge::Somewhat];

/// Systems, and the rules that fuzzylite has for them.
fn systems() -> [(Parts, &'static str); 6] {
    [
        (hedged(&[(0, VERY), (1, &[])]), "if x is up then b is s and a is very s"),
        (hedged(&[(0, VERY), (1, VERY)]), "if x is up then a is very s and b is s"),
        (
            hedged(&[(0, VERY), (1, NOT_VERY), (2, NOT_VERY)]),
            "if x is up then a is very s and b is not s and c is s",
        ),
        (
            hedged(&[(2, NOT_VERY), (0, &[]), (1, VERY)]),
            "if x is up then a is s and b is very s and c is not s",
        ),
        (hedged(&[(0, VERY), (1, NOT)]), "if x is up then a is very s; if x is up then b is not s"),
        (
            hedged(&[(0, VERY), (1, SOMEWHAT), (2, &[])]),
            "if x is up then c is s and a is very s; if x is up then b is somewhat s",
        ),
    ]
}

#[test]
fn what_is_written_answers_the_same_in_fuzzylite() {
    for (parts, rules) in systems() {
        let Writing { text, .. } = fll::write(&parts, EXACT).expect("written");
        assert_eq!(rules_of(&text, "rule: ", ""), rules);
        answers_as_pyfuzzylite(&parts, rules);
        answers_as_pyfuzzylite(&read(&text), rules);
    }
}

#[test]
fn fuzzylite_s_fcl_carries_hedges_on_and_the_standard_s_does_not() {
    for (parts, rules) in systems() {
        let text = fcl::write(&parts, Dialect::Fuzzylite, EXACT).expect("written").text;
        assert_eq!(rules_of(&text, "RULE ", ";"), rules);
        answers_as_pyfuzzylite(&fcl::read(&text).expect("read").parts, rules);
    }
    let parts = hedged(&[(0, NOT), (1, &[])]);
    let text = fcl::write(&parts, Dialect::Iec, EXACT).expect("written").text;
    let consequents = &fcl::read(&text).expect("read").parts.blocks[0].rules[0].consequents;
    assert_eq!([&consequents[0].hedges[..], &consequents[1].hedges], [NOT, &[]]);
}

#[test]
fn a_rule_that_would_have_to_be_split_is_refused_where_rules_are_counted() {
    let mut parts = hedged(&[(0, VERY), (1, NOT)]);
    let writing = fll::write(&parts, EXACT).expect("written");
    assert!(
        writing.notes[0].message.contains("rule 1 is written as 2 rules"),
        "{:?}",
        writing.notes
    );
    parts.blocks[0].activation = Activation::Highest { count: 1 };
    let told = fll::write(&parts, EXACT).expect_err("counted").to_string();
    assert!(told.contains("rule 1") && told.contains("hedges of its conclusions"), "{told}");
}

#[test]
fn hedges_that_gather_without_end_are_refused_with_their_line() {
    let many = format!("if x is up then {}a is s", "a is very s and ".repeat(100));
    let told = problems(fll::read(&with_rules(&many)));
    assert!(told.contains("49:") && told.contains("too many hedges"), "{told}");
}

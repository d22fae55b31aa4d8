//! Texts that nobody writes: no panic, no recursion, time in proportion to the length.

mod common;

use std::time::{Duration, Instant};

use common::problems;
use fspid_formats::{MAX_INPUT_BYTES, fcl, fll, fuzzing};

/// Both readers at once; whatever they answer, they answer, and what they read comes back.
fn both(text: &str) -> Duration {
    let start = Instant::now();
    fuzzing::fcl(text.as_bytes());
    fuzzing::fll(text.as_bytes());
    start.elapsed()
}

/// Pieces of which hostile texts are made.
const PIECES: [&str; 34] = [
    "(",
    ")",
    "NOT ",
    "IF ",
    ";",
    ":",
    ":=",
    "\0",
    "\u{1}",
    "é",
    "0",
    "1e999",
    "-",
    "..",
    "(*",
    "/*",
    "*)",
    "//",
    "#",
    "\n",
    "\r",
    " ",
    "RULE 1 : ",
    "TERM a := (0, 0)",
    "FUNCTION_BLOCK ",
    "END_VAR ",
    "Engine: a\n",
    "InputVariable: x\n",
    "term: a Discrete ",
    "rule: if ( x is ",
    "OutputVariable: x\n",
    "FUNCTION_BLOCK a VAR_INPUT x, ",
    "FUNCTION_BLOCK a RULEBLOCK RULE 1 : ",
    "FUNCTION_BLOCK a OPTION FSPID_",
];

#[test]
fn every_piece_repeated_is_answered_in_time() {
    for piece in PIECES {
        let took = both(&piece.repeat((1 << 20) / piece.len()));
        assert!(took < Duration::from_secs(10), "{piece:?}: {took:?} for 1 MiB");
    }
}

#[test]
fn every_beginning_of_a_file_is_answered() {
    let files = [
        include_str!("data/fcl/tipper-jfuzzylogic.fcl"),
        include_str!("data/fcl/sugeno.fcl"),
        include_str!("data/fll/quirks.fll"),
    ];
    for text in files {
        for (end, _) in text.char_indices() {
            both(&text[..end]);
        }
    }
}

#[test]
fn every_file_with_one_character_changed_is_answered() {
    for text in [include_str!("data/fcl/sugeno.fcl"), include_str!("data/fll/sugeno.fll")] {
        for (at, old) in text.char_indices() {
            for new in ["", "(", "-", "9", "(*", "#", "\u{1}"] {
                both(&format!("{}{new}{}", &text[..at], &text[at + old.len_utf8()..]));
            }
        }
    }
}

#[test]
fn a_hundred_thousand_brackets_are_refused_in_no_time() {
    let brackets = "(".repeat(100_000);
    let fcl = include_str!("data/fcl/sugeno.fcl")
        .replace("IF x IS low", &format!("IF {brackets} x IS low"));
    let fll = include_str!("data/fll/sugeno.fll")
        .replace("if x is low", &format!("if {brackets} x is low"));
    let formula = include_str!("data/fll/sugeno.fll")
        .replace("Function x^2", &format!("Function {brackets}x^2"));
    for text in [&fcl, &fll, &formula] {
        let start = Instant::now();
        let told = if text.starts_with("FUNCTION") {
            problems(fcl::read(text))
        } else {
            problems(fll::read(text))
        };
        // 10 ms are the aim; a busy machine is given ten times that.
        assert!(start.elapsed() < Duration::from_millis(100), "{:?}", start.elapsed());
        assert!(told.contains("deep") || told.contains("bytes"), "{told}");
    }
}

#[test]
fn ten_mebibytes_on_one_line_are_answered_and_more_is_refused() {
    let garbage = "x(y".repeat(MAX_INPUT_BYTES / 3);
    let took = both(&garbage);
    assert!(took < Duration::from_secs(20), "{took:?}");
    let told = problems(fcl::read(&"x".repeat(MAX_INPUT_BYTES + 1)));
    assert_eq!(told, "the text has 10485761 bytes; expected at most 10485760");
    assert_eq!(problems(fll::read(&"x".repeat(MAX_INPUT_BYTES + 1))), told);
}

/// Systems of `n` variables, terms and rules.
fn large(n: usize) -> [String; 2] {
    let names = || (0..n).map(|k| format!("v{k}"));
    let declared: String = names().map(|v| format!("{v} : REAL;\n")).collect();
    let fuzzify: String =
        names().map(|v| format!("FUZZIFY {v} TERM t := (0, 1) (1, 0); END_FUZZIFY\n")).collect();
    let rules: String = names()
        .enumerate()
        .map(|(k, v)| format!("RULE {k} : IF {v} IS t THEN y IS t{k};\n"))
        .collect();
    let terms: String = (0..n).map(|k| format!("TERM t{k} := {k};\n")).collect();
    let fcl = format!(
        "FUNCTION_BLOCK f VAR_INPUT {declared} END_VAR VAR_OUTPUT y : REAL; END_VAR {fuzzify}
         DEFUZZIFY y {terms} METHOD : COGS; END_DEFUZZIFY
         RULEBLOCK r ACCU : MAX; {rules} END_RULEBLOCK END_FUNCTION_BLOCK"
    );
    let inputs: String =
        names().map(|v| format!("InputVariable: {v}\n term: t Ramp 0 1\n")).collect();
    let terms: String = (0..n).map(|k| format!(" term: t{k} Constant {k}\n")).collect();
    let rules: String =
        names().enumerate().map(|(k, v)| format!(" rule: if {v} is t then y is t{k}\n")).collect();
    let fll = format!(
        "Engine: f\n{inputs}OutputVariable: y\n defuzzifier: WeightedAverage\n{terms}RuleBlock:\n{rules}"
    );
    [fcl, fll]
}

#[test]
fn twice_the_system_takes_about_twice_the_time() {
    let time = |n: usize| {
        let [fcl, fll] = large(n);
        let start = Instant::now();
        assert!(fcl::read(&fcl).is_ok() && fll::read(&fll).is_ok());
        start.elapsed().as_secs_f64()
    };
    time(1000);
    let ratio = (0..5).map(|_| time(8000) / time(2000)).fold(f64::INFINITY, f64::min);
    // Four times the text; a quadratic reader would take sixteen times as long.
    assert!(ratio < 8.0, "{ratio}");
}

#[test]
fn unknown_names_among_many_are_told_in_time() {
    let [fcl, fll] = large(5000);
    let (fcl, fll) = (fcl.replace("IF v", "IF w"), fll.replace("if v", "if w"));
    let start = Instant::now();
    assert!(problems(fcl::read(&fcl)).contains("and more problems"));
    assert!(problems(fll::read(&fll)).contains("and more problems"));
    assert!(start.elapsed() < Duration::from_secs(10), "{:?}", start.elapsed());
}

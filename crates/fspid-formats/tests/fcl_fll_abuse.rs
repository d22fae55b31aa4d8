//! Texts that nobody writes: no panic, no recursion, every one answered. That the work is in
//! proportion to the length is counted in `src/work/tests.rs`; no test here looks at a clock.

use crate::common;

use common::problems;
use fspid_formats::{MAX_INPUT_BYTES, fcl, fll, fuzzing};

/// Both readers at once; whatever they answer, they answer, and what they read comes back.
fn both(text: &str) {
    fuzzing::fcl(text.as_bytes());
    fuzzing::fll(text.as_bytes());
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
fn every_piece_repeated_is_answered() {
    for piece in PIECES {
        both(&piece.repeat((1 << 18) / piece.len()));
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
fn a_hundred_thousand_brackets_are_refused() {
    let brackets = "(".repeat(100_000);
    let fcl = include_str!("data/fcl/sugeno.fcl")
        .replace("IF x IS low", &format!("IF {brackets} x IS low"));
    let fll = include_str!("data/fll/sugeno.fll")
        .replace("if x is low", &format!("if {brackets} x is low"));
    let formula = include_str!("data/fll/sugeno.fll")
        .replace("Function x^2", &format!("Function {brackets}x^2"));
    for text in [&fcl, &fll, &formula] {
        let told = if text.starts_with("FUNCTION") {
            problems(fcl::read(text))
        } else {
            problems(fll::read(text))
        };
        assert!(told.contains("deep") || told.contains("bytes"), "{told}");
    }
}

#[test]
fn ten_mebibytes_on_one_line_are_answered_and_more_is_refused() {
    let garbage = "x(y".repeat(MAX_INPUT_BYTES / 3);
    both(&garbage);
    let told = problems(fcl::read(&"x".repeat(MAX_INPUT_BYTES + 1)));
    assert_eq!(told, "the text has 10485761 bytes; expected at most 10485760");
    assert_eq!(problems(fll::read(&"x".repeat(MAX_INPUT_BYTES + 1))), told);
}

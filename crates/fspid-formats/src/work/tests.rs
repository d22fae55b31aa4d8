//! Reading takes work in proportion to the length of a text, whatever stands in it.

use super::of;
use crate::note::Reading;
use crate::{fcl, fis, fll, fml};
use fspid_diagnostics::Problems;

type Read = fn(&str) -> Result<Reading, Problems>;

const READERS: [(&str, Read); 4] =
    [("fcl", fcl::read), ("fll", fll::read), ("fis", fis::read), ("fml", fml::read)];

/// Most characters that are passed, and names that are looked at, for each byte of a text. A reader
/// looks at a line as a whole, then at its words; a rule is tokens first and then clauses.
const WORK_A_BYTE: u64 = 12;

/// Pieces of which hostile texts are made.
const PIECES: [&str; 54] = [
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
    "[",
    "]",
    "'",
    "\"",
    "=",
    "%",
    "[System]\n",
    "a=b\n",
    "[[[[\n",
    "\u{202e}",
    "[Input1]\nRange=[",
    "MF1='a':'trimf',[",
    "1, 1 (",
    "<a>",
    "<a/>",
    "<fuzzySystem a='1'>",
    "&lt;",
    "<!--",
    "<![CDATA[",
    "<fuzzySystem name='a'><knowledgeBase><fuzzyVariable>",
];

/// The work and the heap for a text, whatever the answer.
fn spent(read: Read, text: &str) -> (u64, u64) {
    let mut work = 0;
    let heap = allocation_counter::measure(|| work = of(|| read(text)).1);
    (work, heap.bytes_total)
}

#[test]
fn any_piece_repeated_takes_work_in_proportion_to_its_length() {
    for piece in PIECES {
        let text = |bytes: usize| piece.repeat(bytes / piece.len());
        let (short, long) = (text(1 << 14), text(1 << 16));
        for (name, read) in READERS {
            let (once, four) = (spent(read, &short), spent(read, &long));
            let most = WORK_A_BYTE * long.len() as u64;
            assert!(four.0 <= most, "{name}, {piece:?}: {} for {} bytes", four.0, long.len());
            // Every problem has its own words, and what is told of them does not grow.
            assert!(four.1 <= 6 * once.1, "{name}, {piece:?}: {} bytes, then {}", once.1, four.1);
        }
    }
}

/// A system of `n` variables, terms and rules in each format.
fn large(n: usize) -> [(&'static str, Read, String); 4] {
    let [fcl, fll] = words(n);
    [
        ("fcl", fcl::read as Read, fcl),
        ("fll", fll::read, fll),
        ("fis", fis::read, numbers(n)),
        ("fml", fml::read, elements(n, "v")),
    ]
}

/// The same in elements; rules ask about variables that begin with `asked`.
fn elements(n: usize, asked: &str) -> String {
    let variables: String = (0..n)
        .map(|k| {
            format!(
                "<fuzzyVariable name=\"v{k}\" domainleft=\"0\" domainright=\"1\">\n\
                 <fuzzyTerm name=\"t\"><sShape param1=\"0\" param2=\"1\"/></fuzzyTerm></fuzzyVariable>\n"
            )
        })
        .collect();
    let terms: String = (0..n)
        .map(|k| format!("<tskTerm name=\"t{k}\" order=\"0\"><tskValue>{k}</tskValue></tskTerm>\n"))
        .collect();
    let clause = |variable: &str, term: &str| {
        format!("<clause><variable>{variable}</variable><term>{term}</term></clause>")
    };
    let rules: String = (0..n)
        .map(|k| {
            let (if_, then) = (clause(&format!("{asked}{k}"), "t"), clause("y", &format!("t{k}")));
            format!(
                "<rule name=\"r{k}\"><antecedent>{if_}</antecedent>\n\
                 <consequent><then>{then}</then></consequent></rule>\n"
            )
        })
        .collect();
    format!(
        "<fuzzySystem name=\"f\"><knowledgeBase>{variables}<tskVariable name=\"y\">{terms}</tskVariable>\n\
         </knowledgeBase><tskRuleBase>{rules}</tskRuleBase></fuzzySystem>"
    )
}

fn words(n: usize) -> [String; 2] {
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

/// Rules of `.fis` name everything by position: the variables stay two.
fn numbers(n: usize) -> String {
    let terms: String = (1..=n).map(|k| format!("MF{k}='t{k}':'constant',[{k}]\n")).collect();
    let rules: String = (1..=n).map(|k| format!("1, {k} (1) : 1\n")).collect();
    format!(
        "[System]\nType='sugeno'\nAndMethod='min'\nOrMethod='max'\nDefuzzMethod='wtaver'\n\
         [Input1]\nRange=[0 1]\nMF1='t':'trimf',[0 1 2]\n[Output1]\nRange=[0 1]\n{terms}[Rules]\n{rules}"
    )
}

/// The clock that stood here before told how busy the machine was: `cargo test` failed for a
/// newcomer.
#[test]
fn four_times_the_system_takes_about_four_times_the_work() {
    for ((name, read, small), (_, _, big)) in large(500).into_iter().zip(large(2000)) {
        assert!(read(&small).is_ok() && read(&big).is_ok(), "{name}");
        let (once, four) = (spent(read, &small), spent(read, &big));
        // A quadratic reader would take sixteen times as much.
        assert!(four.0 <= 5 * once.0, "{name}: {} characters, then {}", once.0, four.0);
        // Vectors grow by doubling: up to twice what their share would be.
        assert!(four.1 <= 6 * once.1, "{name}: {} bytes, then {}", once.1, four.1);
        let most = WORK_A_BYTE * big.len() as u64;
        assert!(four.0 <= most, "{name}: {} for {} bytes", four.0, big.len());
    }
}

#[test]
fn unknown_names_among_many_are_told_without_looking_at_all_of_them_each_time() {
    let once = |n: usize| {
        let [fcl, fll] = words(n);
        let (fcl, fll) = (fcl.replace("IF v", "IF w"), fll.replace("if v", "if w"));
        let told = |read: Read, text: &str| read(text).unwrap_err().to_string();
        assert!(told(fcl::read, &fcl).contains("and more problems"));
        assert!(told(fll::read, &fll).contains("and more problems"));
        let fml = elements(n, "w");
        assert!(told(fml::read, &fml).contains("and more problems"));
        [spent(fcl::read, &fcl), spent(fll::read, &fll), spent(fml::read, &fml)]
    };
    for (small, big) in once(500).into_iter().zip(once(2000)) {
        assert!(big.0 <= 5 * small.0 && big.1 <= 6 * small.1, "{small:?}, then {big:?}");
    }
}

#[test]
fn a_hundred_thousand_brackets_are_not_gone_into() {
    let brackets = "(".repeat(100_000);
    let fcl = include_str!("../../tests/data/fcl/sugeno.fcl")
        .replace("IF x IS low", &format!("IF {brackets} x IS low"));
    let fll = include_str!("../../tests/data/fll/sugeno.fll");
    let rule = fll.replace("if x is low", &format!("if {brackets} x is low"));
    let formula = fll.replace("Function x^2", &format!("Function {brackets}x^2"));
    for (read, text) in [(fcl::read as Read, fcl), (fll::read, rule), (fll::read, formula)] {
        let told = read(&text).unwrap_err().to_string();
        assert!(told.contains("deep") || told.contains("bytes"), "{told}");
        let (work, heap) = spent(read, &text);
        assert!(work <= WORK_A_BYTE * text.len() as u64, "{work}");
        // A tree as deep as the text is long would be many times this.
        assert!(heap <= 64 * text.len() as u64, "{heap}");
    }
}

#[test]
fn work_that_grows_with_the_square_would_be_seen() {
    let careless = |text: &str| text.chars().for_each(|_| super::add(text.len()));
    let (once, four) = (of(|| careless(&"x".repeat(100))).1, of(|| careless(&"x".repeat(400))).1);
    assert_eq!((once, four), (10_000, 160_000));
}

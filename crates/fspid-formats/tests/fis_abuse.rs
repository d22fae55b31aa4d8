//! Texts that nobody means well: they end with an answer, without a panic and without memory for
//! what they only announce. That the work is linear is counted in `src/work/tests.rs`.

use std::fmt::Write;

use fspid_formats::{MAX_INPUT_BYTES, fis};

const PAPER: &str = include_str!("data/fis/paper.fis");
/// In ten mebibytes there is room for thrice as many.
const RULES: usize = 200_000;

/// The first problem of a text that is refused.
fn refused(text: &str) -> String {
    let problems = fis::read(text).expect_err("no system").list;
    assert!(problems.len() <= 51, "{} problems", problems.len());
    problems.iter().for_each(|problem| assert!(problem.to_string().len() < 1000, "{problem}"));
    problems[0].to_string()
}

/// How much of a text is tried: all that is read of the first of several, and by night of each; else a tenth.
fn most_bytes(number: usize) -> usize {
    let is_long = std::env::var_os("FSPID_LONG_TESTS").is_some();
    if is_long || number == 0 { MAX_INPUT_BYTES } else { MAX_INPUT_BYTES / 10 }
}

#[test]
fn mebibytes_of_anything_are_refused() {
    let all = [
        "x",
        "\0",
        "[",
        "]",
        "'",
        "\"",
        "=",
        "%",
        "\n",
        "\r",
        "[System]\n",
        "a=b\n",
        "[[[[\n",
        "ä",
        "\u{202e}",
    ];
    for (number, with) in all.into_iter().enumerate() {
        let most = most_bytes(number);
        refused(&with.repeat(most / with.len()));
        let line = format!("{with}\n");
        refused(&format!("[System]\n{}", line.repeat(most / 2 / line.len())));
    }
}

#[test]
fn a_text_beyond_the_limit_is_refused_at_once() {
    let text = "x".repeat(MAX_INPUT_BYTES + 1);
    assert_eq!(refused(&text), "the text has 10485761 bytes; expected at most 10485760");
}

#[test]
fn one_line_of_mebibytes_is_refused() {
    let all = [
        ("[Input1]\nRange=[", "1 "),
        ("[Input1]\nMF1='a':'trimf',[", "1,"),
        ("[Input1]\nName='", "''"),
        ("[Rules]\n", "1 "),
        ("[Rules]\n1, 1 (", "("),
        ("[System]\nAndMethod='", "min"),
        ("[Input", "9"),
        ("[Input1]\nMF", "1"),
    ];
    for (number, (begin, with)) in all.into_iter().enumerate() {
        refused(&format!("{begin}{}", with.repeat((most_bytes(number) - 100) / with.len())));
    }
}

#[test]
fn hundreds_of_thousands_of_rules_are_read() {
    let (head, _) = PAPER.split_once("[Rules]\n").expect("rules");
    let head = head.replacen("dkp", "d", 1);
    let rules: String = (0..RULES).map(|n| format!("{} 1,1 1 1(1):1\n", n % 7 + 1)).collect();
    let reading = fis::read(&format!("{head}[Rules]\n{rules}")).expect("a large system");
    assert_eq!(reading.parts.blocks[0].rules.len(), RULES);
}

#[test]
fn announced_counts_take_no_memory() {
    for count in ["1e18", "99999999999999999999", "1e308"] {
        let text = PAPER.replace("NumMFs=7", &format!("NumMFs={count}"));
        let text = text.replace("NumRules=49", &format!("NumRules={count}"));
        let reading = fis::read(&text).expect("counts are only told");
        assert_eq!(reading.parts.inputs[0].terms.len(), 7);
    }
    for section in
        ["[Input999999999999]\nRange=[0 1]", "[Output18446744073709551615]\nRange=[0 1]\nNumMFs=0"]
    {
        let text = format!("{section}\n{PAPER}");
        assert!(refused(&text).contains("is left out"), "{}", refused(&text));
    }
}

#[test]
fn membership_functions_without_end_are_read() {
    let mut text = String::from("[Input1]\nRange=[0 1]\n");
    for n in 1..=150_000 {
        writeln!(text, "MF{n}='a':'trimf',[0 1 2]").expect("a string");
    }
    refused(&text);
}

#[test]
fn variables_without_end_are_refused() {
    let sections = (1..=200_000).map(|n| format!("[Input{n}]\nRange=[0 1]\n"));
    refused(&sections.collect::<String>());
}

#[test]
fn numbers_out_of_this_world_are_refused_or_read_and_nothing_else() {
    for number in
        ["1e999", "-1e999", "nan", "9".repeat(5000).as_str(), "0x1", "1e", "١", "1/0", "--1"]
    {
        let text = PAPER.replacen("Range=[-5 5]", &format!("Range=[{number} 5]"), 1);
        let _ = fis::read(&text);
        let text = PAPER.replacen("[Rules]\n1 ", &format!("[Rules]\n{number} "), 1);
        refused(&text);
    }
}

#[test]
fn control_characters_never_reach_a_message() {
    let message = refused(&PAPER.replacen("OrMethod='max'", "OrMethod='m\0\u{1b}[31max'", 1));
    assert!(!message.contains(['\0', '\u{1b}']), "{message:?}");
}

#[test]
fn noise_is_refused() {
    // A multiplicative generator: the same noise every time.
    let mut state = 1_u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        char::from((state >> 24) as u8)
    };
    let noise: String = (0..1_000_000).map(|_| next()).collect();
    refused(&noise);
    refused(&format!("[Rules]\n{noise}"));
}

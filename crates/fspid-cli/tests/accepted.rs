//! What `check` accepts is answered: numbers at random at random places of shipped scenarios.
//!
//! `FSPID_ACCEPTED_DRAWS=2000` draws more of them, and `FSPID_ACCEPTED_FIRST` others.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

use crate::common::{answers, code, json, text};
use crate::hostile_answers::{bare_null, unnumbered};

pub(crate) const SCENARIOS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios");

/// Scenarios of different kinds.
const FILES: [&str; 10] = [
    "747-pitch-step",
    "disturbances",
    "limits",
    "plant-change",
    "requirements",
    "contest/light",
    "gallery/b747-turbulence",
    "gallery/delay",
    "gallery/navion-step",
    "gallery/sensor-own",
];

/// What is asked of a scenario that is accepted; the map is small, for there is one for each controller and plant.
const QUESTIONS: [&[&str]; 4] = [
    &["simulate", "FILE"],
    &["simulate", "FILE", "--format", "json"],
    &["analyse", "FILE", "--map", "3", "--format", "json"],
    &["verify", "FILE", "--set", "ctms", "--format", "json"],
];

/// Seconds of the processor that an answer may take, whatever else the machine does: twenty times what the slowest takes.
#[cfg(unix)]
const MOST_SECONDS: u32 = 120;

/// Sizes at which something may go wrong.
const SIZES: [f64; 18] = [
    0.0,
    5e-324,
    1e-308,
    1e-200,
    1e-100,
    1e-30,
    1e-12,
    1e-6,
    1.0,
    100.0,
    1e4,
    1e9,
    1e15,
    1e30,
    1e100,
    1e200,
    1e300,
    f64::MAX,
];

/// Numbers of a counter: the same each time, on every machine.
pub(crate) struct Drawn(pub(crate) u64);

impl Drawn {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ bits >> 31
    }

    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    pub(crate) fn one_of<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }

    fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A value of a number of the file, as `--set` takes it.
    pub(crate) fn value(&mut self, row: &Value) -> String {
        let schema = &row["schema"];
        if schema["type"] == "integer" {
            let ends = [&schema["minimum"], &schema["maximum"]].map(Value::as_i64);
            let all =
                [ends[0].unwrap_or(-1), ends[1].unwrap_or(i64::MAX), 0, 1, 7, 100, 300, 100_000];
            return self.one_of(&all).to_string();
        }
        let end = |names: [&str; 2]| names.iter().find_map(|name| schema[*name].as_f64());
        let now = row["value"].as_f64().unwrap_or(1.0);
        let sign = *self.one_of(&[1.0, 1.0, -1.0]);
        let value = match self.below(8) {
            0 => end(["minimum", "exclusiveMinimum"]).unwrap_or(-now),
            1 => end(["maximum", "exclusiveMaximum"]).unwrap_or(-now),
            2 | 3 => sign * *self.one_of(&SIZES),
            4 => (now * 10.0).round(),
            5 => now * 10.0_f64.powi(self.below(25) as i32 - 12),
            _ => now * (0.5 + 1.5 * self.unit()),
        };
        format!("{value:?}")
    }
}

/// The program, which ends where it works for too long.
pub(crate) fn asked(arguments: &[&str]) -> Output {
    let program = env!("CARGO_BIN_EXE_fspid");
    #[cfg(unix)]
    let mut command = {
        let limited = format!("ulimit -t {MOST_SECONDS}; exec \"$0\" \"$@\"");
        let mut command = Command::new("sh");
        command.args(["-c", &limited, program]);
        command
    };
    #[cfg(not(unix))]
    let mut command = Command::new(program);
    let output = command.args(arguments).current_dir(SCENARIOS).output();
    output.expect("the program starts")
}

/// The numbers of a scenario, but for what is required of it.
pub(crate) fn numbers(file: &str) -> Vec<Value> {
    let words = ["check", file, "--paths", "--format", "json"];
    let output = asked(&words);
    answers::hold(&words, &output);
    let answer = json(&output);
    let is_number = |row: &&Value| {
        let kind = row["schema"]["type"].as_str().unwrap_or_default();
        let path = row["path"].as_str().unwrap_or_default();
        ["number", "integer"].contains(&kind)
            && path != "schema"
            && !path.starts_with("requirement")
    };
    let rows = answer["paths"].as_array().expect("paths");
    rows.iter().filter(is_number).cloned().collect()
}

/// Changes of one to three numbers; of an aircraft's own many numbers not too often.
pub(crate) fn changes(drawn: &mut Drawn, rows: &[Value]) -> Vec<String> {
    let count = *drawn.one_of(&[1, 1, 1, 2, 3]);
    let is_inner = |row: &&Value| row["path"].as_str().is_some_and(|path| path.contains(".name."));
    let (inner, outer): (Vec<&Value>, Vec<&Value>) = rows.iter().partition(is_inner);
    let from = if drawn.below(5) == 0 && !inner.is_empty() { &inner } else { &outer };
    let change = |_| {
        let row = *drawn.one_of(from);
        format!("{}={}", row["path"].as_str().unwrap_or_default(), drawn.value(row))
    };
    (0..count).map(change).collect()
}

pub(crate) fn setting(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(otherwise)
}

#[test]
fn what_check_accepts_is_answered_with_numbers_or_with_reasons() {
    let files = FILES.map(|file| format!("{file}.toml"));
    for file in &files {
        assert!(Path::new(SCENARIOS).join(file).is_file(), "{file}");
    }
    let all: Vec<Vec<Value>> = files.iter().map(|file| numbers(file)).collect();
    let (first, count) = (setting("FSPID_ACCEPTED_FIRST", 0), setting("FSPID_ACCEPTED_DRAWS", 36));
    let mut wrong = Vec::new();
    let mut accepted = 0;
    for draw in first..first + count {
        let mut drawn = Drawn(draw.wrapping_mul(0x2545_f491_4f6c_dd1d));
        let place = drawn.below(files.len());
        let sets = changes(&mut drawn, &all[place]);
        let words = |question: &[&str]| {
            let named = question.iter().map(|word| word.replace("FILE", &files[place]));
            let sets = sets.iter().flat_map(|set| ["--set".to_owned(), set.clone()]);
            named.chain(sets).collect::<Vec<String>>()
        };
        let check = told(&words(&["check", "FILE"]), &[0, 2]);
        let is_accepted = check.as_ref().is_ok_and(|code| *code == 0);
        wrong.extend(check.err());
        if is_accepted {
            accepted += 1;
            wrong.extend(QUESTIONS.iter().filter_map(|it| told(&words(it), &[0, 1]).err()));
        }
    }
    assert!(wrong.is_empty(), "{} of {count} draws:\n{}", wrong.len(), wrong.join("\n"));
    assert!(4 * accepted > count, "{accepted} of {count} were accepted, which says little");
}

/// How a command ended, or what is wrong with that or with what it told.
fn told(words: &[String], codes: &[i32]) -> Result<i32, String> {
    answer(words, codes).map(|output| code(&output))
}

/// What a command told, or what is wrong with that or with how it ended.
pub(crate) fn answer(words: &[String], codes: &[i32]) -> Result<Output, String> {
    let arguments: Vec<&str> = words.iter().map(String::as_str).collect();
    let output = asked(&arguments);
    let (out, told) = (text(&output.stdout), text(&output.stderr));
    let failed = |what: String| Err(format!("fspid {}: {what}", words.join(" ")));
    if output.status.code().is_none() {
        return failed(format!("{}: {told}", output.status));
    }
    if !codes.contains(&code(&output)) {
        return failed(format!("exit code {}: {told}", code(&output)));
    }
    for all in [&out, &told] {
        if let Some(word) = unnumbered(all) {
            let around = all.lines().find(|line| unnumbered(line).is_some()).unwrap_or_default();
            return failed(format!("the word {word}: {around}"));
        }
    }
    if let Err(what) = answers::held(&arguments, &output) {
        return failed(what);
    }
    if words.iter().any(|word| word == "json")
        && let Some(place) = bare_null(&json(&output))
    {
        return failed(format!("a null without its reason at {place}"));
    }
    Ok(output)
}

//! Tries to refute what is proved: draws scenarios, certifies them, and flies each proved one over its whole
//! range of set-points and loads.
//!
//! `cargo run --release -p fspid-proof --example refute_proofs -- --count 3000 [--from 0] [--structures | --limits | --networks]`
//!
//! With `--structures` the self-tuners are of other structures than the paper's.
//!
//! With `--limits` the gains are fixed and limits of servo and command hold every step up.
//! Ends with 1 where a flight of a proved loop does not settle.

#![allow(clippy::print_stdout, reason = "an example shows something")]
#![allow(clippy::expect_used, clippy::indexing_slicing, reason = "shared with a test")]
#![allow(dead_code, reason = "shared with a test")]
#![allow(missing_docs, reason = "shared with a test")]

#[path = "../tests/flown_proofs/drawn.rs"]
mod drawn;
#[path = "../tests/flown_proofs/flown.rs"]
mod flown;

use std::collections::BTreeMap;
use std::process::ExitCode;

use drawn::Dice;
use flown::Answer;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().collect();
    let after = |name: &str, otherwise: u64| {
        let place = arguments.iter().position(|argument| argument == name);
        let text = place.and_then(|place| arguments.get(place + 1));
        text.and_then(|text| text.parse().ok()).unwrap_or(otherwise)
    };
    let (count, from) = (after("--count", 100), after("--from", 0));
    let [structures, limits, networks] = ["--structures", "--limits", "--networks"]
        .map(|option| arguments.iter().any(|argument| argument == option));
    let mut answers: BTreeMap<String, u64> = BTreeMap::new();
    let (mut flights, mut held_in_all, mut stepped_in_all, mut contradicted) = (0, 0, 0, 0);
    for seed in from..from + count {
        let dice = &mut Dice::new(seed);
        let drawn = match (structures, limits, networks) {
            (true, ..) => drawn::structured(dice),
            (false, true, _) => drawn::with_limits(dice),
            (false, false, true) => drawn::networked(dice),
            (false, false, false) => drawn::scenario(dice),
        };
        let answer = flown::answer(&drawn);
        if arguments.iter().any(|argument| argument == "--each") {
            println!("scenario {seed}: {answer:?}");
        }
        let name = match answer {
            Answer::NotProvable(reason) => format!("not provable: {reason}"),
            Answer::Open => "open".to_owned(),
            Answer::Refuted => "refuted".to_owned(),
            Answer::Settled { whole, flights: flown, held, stepped } => {
                stepped_in_all += u64::from(stepped);
                flights += flown;
                held_in_all += u64::from(held);
                format!("proved for {}, all flights settle", if whole { "all" } else { "less" })
            }
            Answer::Contradicted(reason) => {
                contradicted += 1;
                println!("scenario {seed}: {reason}");
                "proved, and a flight does not settle".to_owned()
            }
        };
        *answers.entry(name).or_default() += 1;
    }
    for (name, count) in &answers {
        println!("{count:6}  {name}");
    }
    println!(
        "{flights} flights; {held_in_all} claims over a range of set-points that matters; {stepped_in_all} of steps with limits; {contradicted} contradicted"
    );
    ExitCode::from(u8::from(contradicted > 0))
}

//! The examples of help, in a folder that is made as help says.

use std::path::Path;

use crate::common;

use common::{code, fspid, text};

/// What takes less time than the example and asks the same.
const LESS: [(&str, &str); 4] = [
    ("--runs 1000000", "--runs 150"),
    ("--runs 10000 ", "--runs 150 "),
    ("--flights 1000000", "--flights 1000"),
    ("--measure overshoot_pct", "--measure overshoot_pct --budget 64"),
];

/// The commands of an answer to `-h`, and the ones that its heading asks for first.
fn commands(help: &str) -> Vec<String> {
    let asked_first = help.lines().filter_map(|line| line.strip_prefix("Examples, after `"));
    let asked_first = asked_first.filter_map(|line| line.strip_suffix("`:")).map(str::to_owned);
    let lines = help.lines().filter_map(|line| line.strip_prefix("  "));
    let examples = lines.filter(|line| line.starts_with("fspid ")).flat_map(|line| {
        let line = line.split_once('#').map_or(line, |(command, _)| command);
        line.split(';').map(|command| command.trim().to_owned()).collect::<Vec<_>>()
    });
    asked_first.chain(examples).collect()
}

fn run(command: &str, folder: &Path) {
    let shorter = LESS.iter().fold(command.to_owned(), |it, (from, to)| it.replace(from, to));
    let mut words: Vec<&str> = shorter.split_whitespace().skip(1).collect();
    if words.contains(&"rare") && !words.contains(&"--flights") {
        words.extend(["--flights", "1000"]);
    }
    let output = fspid(&words, folder);
    // 1 is an answer too: a requirement that is not met.
    assert!(code(&output) < 2, "{shorter}: {}", text(&output.stderr));
}

/// Four of them ended with "there is no dispersion" or "there is no requirement", of the very file that help tells to make.
#[test]
fn the_examples_of_help_can_be_run_as_they_stand() {
    for asked in [&["campaign"][..], &["campaign", "rare"], &["verify"]] {
        let folder = tempfile::tempdir().expect("a folder");
        let folder = folder.path();
        run("fspid init pitch.toml", folder);
        let help = fspid(&[asked, &["-h"]].concat(), folder);
        let commands = commands(&text(&help.stdout));
        assert!(commands.len() > 3, "{commands:?}");
        commands.iter().for_each(|command| run(command, folder));
    }
}

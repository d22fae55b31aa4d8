//! What holds for every command: JSON where it is asked for, errors too; templates that check and run.

use crate::common;

use std::path::Path;

use common::{code, fspid, json, text, with_input};

/// Names of the commands that a help lists, without `help` itself.
fn listed(help: &str) -> Vec<String> {
    let after = help.split_once("Commands:\n").map_or("", |(_, rest)| rest);
    let lines = after.lines().take_while(|line| !line.trim().is_empty());
    // A long explanation goes on in a line that begins farther to the right.
    let names = lines.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let names = names.filter_map(|line| line.split_whitespace().next());
    names.filter(|name| *name != "help").map(str::to_owned).collect()
}

/// Every command of the program, as words of a command line.
fn commands(folder: &Path) -> Vec<Vec<String>> {
    let mut all = Vec::new();
    for name in listed(&text(&fspid(&["-h"], folder).stdout)) {
        let below = listed(&text(&fspid(&[&name, "-h"], folder).stdout));
        match below.is_empty() {
            true => all.push(vec![name]),
            false => all.extend(below.into_iter().map(|it| vec![name.clone(), it])),
        }
    }
    all
}

/// A command that answers, the exit codes that are well, and a key of its answer. They run in this order in one folder.
const ANSWERS: [(&str, &[i32], &str); 54] = [
    ("init pitch.toml", &[0], "file"),
    ("init --list", &[0], "templates"),
    ("init --template tuning tuning.toml", &[0], "next"),
    ("init --template contest contest.toml", &[0], "about"),
    ("init --template campaign campaign.toml", &[0], "file"),
    ("init --template fuzzy-system tip.toml", &[0], "file"),
    ("init --template rule-table rules.toml", &[0], "file"),
    ("init --template aircraft mine.toml", &[0], "file"),
    ("check mine.toml", &[0], "modes"),
    ("check pitch.toml", &[0], "digest"),
    ("check pitch.toml --paths", &[0], "paths"),
    ("check rules.toml", &[0], "rules"),
    ("simulate pitch.toml", &[0, 1], "controllers"),
    ("simulate pitch.toml --trace flown.csv", &[0, 1], "controllers"),
    ("show flown.csv --controller FSPID --x-plane --speed 1000", &[0], "sent"),
    ("analyse pitch.toml", &[0, 1], "controllers"),
    ("limit pitch.toml --travel-deg 20 --quiet --set loop.duration_s=2", &[0], "ladder"),
    ("certify pitch.toml --controller FSPID", &[0, 1], "controllers"),
    ("verify pitch.toml --set ctms", &[0, 1], "requirements"),
    ("campaign plan campaign.toml --runs 8 --out flown", &[0], "shards"),
    ("campaign shard 0 --quiet --out flown", &[0], "flown"),
    ("campaign merge --out flown", &[0], "digest"),
    ("campaign run campaign.toml --runs 8 --quiet --out run", &[0], "rows"),
    ("campaign report run/campaign.parquet", &[0], "schema"),
    ("campaign replay run --run 3", &[0], "schema"),
    ("campaign search campaign.toml --measure overshoot_pct --budget 30", &[0], "measure"),
    (
        "campaign rare campaign.toml --fails overshoot_pct --flights 1000 --set loop.duration_s=2",
        &[0],
        "at_most",
    ),
    ("tune tuning.toml --budget 12 --quiet", &[0, 1], "best"),
    ("tune contest.toml --all --budget 8 --quiet", &[0, 1], "controllers"),
    ("tune pitch.toml --rule amigo", &[0, 1], "controller"),
    ("tune pitch.toml --rule list", &[0], "rules"),
    ("contest contest.toml --budget 4 --seeds 1 --quiet --out who", &[0], "schema"),
    ("adaptation pitch.toml --seeds 1 --budget 8 --quiet", &[0], "steps"),
    ("export pitch.toml --controller FSPID --to c --samples 50 --out code", &[0], "files"),
    ("export tip.toml --to lua --samples 50 --out tip-code", &[0], "files"),
    ("infer printed --range 5 --error 1 --change -2", &[0], "outputs"),
    ("explain tip.toml --input service=7 --input food=8", &[0], "outputs"),
    ("convert tip.toml tip.fis --lossy", &[0], "file"),
    (
        "learn sugeno-grid --range 1 --teacher mirrored --points 5,5 --epochs 2 --out l.toml",
        &[0, 2],
        "epochs",
    ),
    ("surface tip.toml --nodes 3", &[0], "axes"),
    ("audit tip.toml --boxes 20", &[0], "outputs"),
    ("aircraft list", &[0], "aircraft"),
    ("aircraft show navion", &[0], "body"),
    ("aircraft show ctms-transport", &[0], "known_by"),
    ("aircraft trim navion", &[0], "trim"),
    ("aircraft linearise navion", &[0], "longitudinal"),
    ("aircraft modes navion", &[0], "longitudinal"),
    ("aircraft qualities navion", &[0], "category"),
    ("aircraft derive navion", &[0], "derivatives"),
    ("schema", &[0], "properties"),
    ("schema aircraft", &[0], "oneOf"),
    ("completions bash", &[0], "script"),
    ("manual --out man", &[0], "files"),
    ("reproduce --out paper", &[0], "claims"),
];

/// The others, whose answers the tests of their own commands look at.
const ELSEWHERE: [&str; 6] =
    ["bench", "fly", "drive", "serve", "aircraft envelope", "aircraft import"];

#[test]
fn every_command_answers_with_one_json_object() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    for command in commands(folder) {
        let command = command.join(" ");
        let is_here = ANSWERS
            .iter()
            .any(|(words, ..)| *words == command || words.starts_with(&format!("{command} ")));
        assert!(is_here || ELSEWHERE.contains(&command.as_str()), "{command} is nowhere");
    }
    for (words, codes, key) in ANSWERS {
        let mut arguments: Vec<&str> = words.split(' ').collect();
        arguments.extend(["--format", "json"]);
        let output = fspid(&arguments, folder);
        assert!(codes.contains(&code(&output)), "{words}: {}", text(&output.stderr));
        let answer = json(&output);
        assert!(!answer[key].is_null(), "{words} has no {key}: {answer}");
        // A schema itself is the only answer without the version of its shape.
        assert!(answer["schema"].is_u64() || words.starts_with("schema"), "{words}: {answer}");
    }
}

#[test]
fn the_manual_has_a_page_for_every_command_and_shells_complete_each() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let output = fspid(&["manual", "--out", "man"], folder);
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    for command in commands(folder) {
        let name = format!("man/fspid-{}.1", command.join("-"));
        let page = std::fs::read_to_string(folder.join(&name)).expect(&name);
        assert!(page.contains(".SH SYNOPSIS") && page.contains(r"\-\-help"), "{name}");
    }
    assert!(!text(&output.stdout).contains("external-controller"), "it is for the program alone");
    // The same program writes the same pages: no date, and what stood there is written anew.
    let before = std::fs::read(folder.join("man/fspid-simulate.1")).expect("a page");
    assert_eq!(code(&fspid(&["manual", "--out", "man"], folder)), 0);
    assert_eq!(std::fs::read(folder.join("man/fspid-simulate.1")).expect("a page"), before);
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = text(&fspid(&["completions", shell], folder).stdout);
        for command in commands(folder) {
            assert!(script.contains(command.last().expect("a name")), "{shell}: {command:?}");
        }
    }
}

/// An error used to be words alone, and standard output empty.
#[test]
fn every_command_tells_what_is_wrong_as_json_too() {
    let folder = tempfile::tempdir().expect("a folder");
    for command in commands(folder.path()) {
        let mut words: Vec<&str> = command.iter().map(String::as_str).collect();
        words.extend(["--no-such-option", "--format", "json"]);
        let output = fspid(&words, folder.path());
        assert_eq!(code(&output), 2, "{command:?}");
        let error = &json(&output)["error"];
        assert_eq!((error["code"].as_i64(), error["kind"].as_str()), (Some(2), Some("input")));
        assert!(error["message"].as_str().is_some_and(|it| it.contains("no-such-option")));
        assert!(!output.stderr.is_empty(), "people are told too");
    }
}

#[test]
fn the_problems_of_a_file_have_their_places_in_json() {
    let folder = tempfile::tempdir().expect("a folder");
    let (folder, set) = (folder.path(), "controller.PID.kq=1");
    assert_eq!(code(&fspid(&["init", "a.toml"], folder)), 0);
    let output = fspid(&["check", "a.toml", "--set", set, "--format", "json"], folder);
    let answer = json(&output);
    let problem = &answer["error"]["problems"]["problems"][0];
    assert_eq!(problem["path"], "controller[0].kq", "{answer}");
    assert_eq!(code(&output), 2);
}

/// Every template with a command that runs it.
const TEMPLATES: [(&str, &str); 9] = [
    ("pitch-hold", "simulate FILE --report report.html"),
    ("aircraft-in-turbulence", "simulate FILE --set loop.duration_s=5 --report report.html"),
    ("aircraft", "aircraft modes FILE"),
    ("requirements", "verify FILE"),
    ("campaign", "campaign run FILE --runs 16 --quiet --out robust"),
    ("tuning", "tune FILE --budget 40 --quiet --out design.toml"),
    ("contest", "contest FILE --budget 30 --seeds 2 --quiet --out who"),
    ("rule-table", "infer FILE --range 5 --error 1 --change -2"),
    ("fuzzy-system", "infer FILE --input service=7 --input food=8"),
];

#[test]
fn every_template_checks_and_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let list = text(&fspid(&["init", "--list"], folder).stdout);
    assert_eq!(list.lines().count(), TEMPLATES.len(), "{list}");
    for (name, command) in TEMPLATES {
        assert!(list.contains(name), "{name} is not in the list");
        let file = format!("{name}.toml");
        let written = fspid(&["init", "--template", name, &file], folder);
        assert_eq!(code(&written), 0, "{}", text(&written.stderr));
        let content = std::fs::read_to_string(folder.join(&file)).expect("it is there");
        assert!(content.lines().filter(|line| line.contains('#')).count() > 5, "{name}");
        assert!(content.contains("fspid check FILE"), "{name} does not say how to check it");
        let checked = fspid(&["check", &file], folder);
        assert_eq!(code(&checked), 0, "{name}: {}", text(&checked.stderr));
        let told = text(&checked.stderr);
        assert!(!told.contains("warning"), "{name}: {told}");
        let words = command.replace("FILE", &file);
        let ran = fspid(&words.split(' ').collect::<Vec<_>>(), folder);
        assert_eq!(code(&ran), 0, "{words}: {}{}", text(&ran.stdout), text(&ran.stderr));
    }
    let wrong = fspid(&["init", "--template", "tunning"], folder);
    assert!(code(&wrong) == 2 && text(&wrong.stderr).contains("did you mean `tuning`?"));
}

/// `--trace -` wrote a file that was called `-`.
#[test]
fn a_hyphen_is_standard_input_and_output() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let scenario = text(&fspid(&["init"], folder).stdout);
    let tip = text(&fspid(&["init", "--template", "fuzzy-system"], folder).stdout);
    let flown = with_input(&["simulate", "-", "--trace", "-"], folder, &scenario);
    assert_eq!(code(&flown), 0, "{}", text(&flown.stderr));
    assert!(text(&flown.stdout).starts_with("time_s,setpoint_deg,PID.theta_deg"));
    assert!(text(&flown.stderr).contains("my first flight"), "the answer is for people");
    for (words, begins) in [
        ("simulate - --report -", "<!doctype html>"),
        ("analyse - --map 0 --report -", "<!doctype html>"),
        ("verify - --set ctms --junit -", "<?xml"),
        ("verify - --set ctms --report -", "<!doctype html>"),
        ("certify - --controller PID --report -", "<!doctype html>"),
        ("check -", "-: good; my first flight"),
        ("tune - --rule amigo --controller PID --out -", "# "),
    ] {
        let output = with_input(&words.split(' ').collect::<Vec<_>>(), folder, &scenario);
        assert!(code(&output) < 2, "{words}: {}", text(&output.stderr));
        let out = text(&output.stdout);
        assert!(out.starts_with(begins), "{words}: {}", out.chars().take(200).collect::<String>());
    }
    for (words, begins) in [
        ("infer - --input service=7 --input food=8", "tip"),
        ("convert - - --as fis --lossy", "[System]"),
        ("surface - --out -", "<svg"),
        ("surface - --csv -", "service,food,tip"),
        ("explain - --input service=7 --input food=8 --svg -", "<svg"),
    ] {
        let output = with_input(&words.split(' ').collect::<Vec<_>>(), folder, &tip);
        assert_eq!(code(&output), 0, "{words}: {}", text(&output.stderr));
        assert!(text(&output.stdout).starts_with(begins), "{words}: {}", text(&output.stdout));
    }
    // What is written there can be read there: the format is known by what it begins with.
    for format in ["toml", "fis", "fll", "xml"] {
        let words = ["convert", "-", "-", "--lossy", "--as", format];
        let written = with_input(&words, folder, &tip);
        assert_eq!(code(&written), 0, "{format}: {}", text(&written.stderr));
        let read = with_input(&["check", "-"], folder, &text(&written.stdout));
        let told = text(&read.stdout);
        assert!(told.contains("2 inputs, 1 output"), "{format}: {told}{}", text(&read.stderr));
    }
    assert!(!folder.join("-").exists(), "no file of that name was written");
    let both = with_input(&["simulate", "-", "--trace", "-", "--report", "-"], folder, &scenario);
    assert!(code(&both) == 2 && text(&both.stderr).contains("standard output holds one thing"));
    let both = with_input(&["verify", "-", "--requirements", "-"], folder, &scenario);
    assert!(code(&both) == 2 && text(&both.stderr).contains("standard input is one file"));
}

/// `surface x.fis --out tipper.png` made a folder of that name.
#[test]
fn an_unknown_ending_is_refused_and_the_known_ones_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert_eq!(code(&fspid(&["init", "a.toml"], folder)), 0);
    for (words, known) in [
        ("simulate a.toml --trace a.png", "known is .csv"),
        ("simulate a.toml --report a.pdf", "known are .html, .htm"),
        ("analyse a.toml --report a", "no ending; known are .html, .htm"),
        ("verify a.toml --set ctms --junit a.json", "known is .xml"),
        ("verify a.toml --set ctms --report a.pdf", "known are .html, .htm"),
        ("certify a.toml --report a.pdf", "known are .html, .htm"),
        ("tune a.toml --history a.csv", "known is .parquet"),
        ("tune a.toml --out a.json", "known is .toml"),
        ("surface printed --range 5 --out a.png", "known is .svg"),
        ("explain printed --range 5 --error 1 --change 0 --svg a.png", "known is .svg"),
        ("surface printed --range 5 --csv a.txt", "known is .csv"),
        ("convert printed --range 5 a.txt", "known are .toml, .fis, .t2fis, .fcl, .fll, .xml"),
        ("init a.json", "known is .toml"),
        ("campaign merge --to a.csv --out x", "known is .parquet"),
        ("aircraft import a.dml --out a.json", "known is .toml"),
    ] {
        let output = fspid(&words.split(' ').collect::<Vec<_>>(), folder);
        let told = text(&output.stderr);
        assert!(code(&output) == 2 && told.contains(known), "{words}: {told}");
    }
    assert_eq!(std::fs::read_dir(folder).expect("a folder").count(), 1, "nothing was written");
}

/// `cannot open`, `No such file or directory (os error 2)` and others stood beside each other.
#[test]
fn a_missing_file_is_told_in_the_same_words_everywhere() {
    let folder = tempfile::tempdir().expect("a folder");
    for words in [
        "check none.toml",
        "simulate none.toml",
        "analyse none.toml",
        "certify none.toml",
        "certify --check none.toml",
        "verify none.toml",
        "tune none.toml",
        "fly none.toml",
        "contest none.toml --out c",
        "adaptation none.toml",
        "campaign run none.toml --out c",
        "campaign report none.toml",
        "campaign search none.toml --measure x",
        "infer none.toml --input x=1",
        "infer printed --range 5 --points none.toml",
        "explain none.toml --input x=1",
        "audit none.toml",
        "surface none.toml",
        "convert none.toml m.fcl",
        "aircraft show none.toml",
        "aircraft import none.toml",
        "learn sugeno-grid --range 5 --data none.toml --out o.toml",
    ] {
        let output = fspid(&words.split(' ').collect::<Vec<_>>(), folder.path());
        let told = text(&output.stderr);
        assert_eq!(code(&output), 2, "{words}");
        assert!(
            told.contains("none.toml: cannot be read: there is no such file"),
            "{words}: {told}"
        );
    }
}

/// `error: unexpected argument '-5' found`, with a tip that made it worse.
#[test]
fn a_negative_count_says_what_is_allowed() {
    let folder = tempfile::tempdir().expect("a folder");
    for (words, told) in [
        (
            "campaign run a.toml --runs -5 --out c",
            "--runs is -5; allowed is a whole number from 1 to 1000000000",
        ),
        (
            "campaign run a.toml --runs 0 --out c",
            "--runs is 0; allowed is a whole number from 1 to 1000000000",
        ),
        ("tune a.toml --budget -5", "--budget is -5; allowed is a whole number from 1 to 10000000"),
        ("tune a.toml --budget 0", "--budget is 0; allowed is a whole number from 1 to 10000000"),
        ("campaign report -", "fspid: -: a file with a name is needed"),
        ("convert tip.toml a.png", "fspid: a.png: unknown ending"),
        ("tune a.toml --seed x", "--seed is x; allowed is a whole number, 0 or more"),
        ("analyse a.toml --map -1", "--map is -1; allowed is a whole number from 0 to 201"),
        ("audit printed --range x", "--range is x; allowed is a number"),
    ] {
        let output = fspid(&words.split(' ').collect::<Vec<_>>(), folder.path());
        let found = text(&output.stderr);
        assert!(code(&output) == 2 && found.contains(told), "{words}: {found}");
    }
}

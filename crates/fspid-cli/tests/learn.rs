//! Learning a fuzzy system from data on the command line.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn fspid(arguments: &[&str], folder: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fspid"));
    command.args(arguments).current_dir(folder).output().expect("the program starts")
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("an exit code")
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("UTF-8")
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("UTF-8")
}

#[test]
fn the_supervisor_of_the_paper_is_learned_as_numbers_and_answers_from_its_new_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let learn = |out: &str, more: &[&str]| {
        let mut arguments = vec!["learn", "printed", "--range", "5", "--teacher", "printed"];
        arguments.extend([
            "--points",
            "9,9",
            "--conclude",
            "constant",
            "--sets-stay",
            "--out",
            out,
        ]);
        arguments.extend(more);
        fspid(&arguments, folder.path())
    };
    let done = learn("numbers.toml", &["--format", "json"]);
    assert_eq!(code(&done), 0, "{}", stderr(&done));
    let answer: Value = serde_json::from_str(&stdout(&done)).expect("JSON");
    assert_eq!(
        (&answer["best_epoch"], answer["epochs"].as_array().map(Vec::len)),
        (&1.into(), Some(1))
    );
    assert!(answer["epochs"][0]["training"].as_f64().is_some_and(|error| error < 0.15), "{answer}");
    let asked = ["infer", "numbers.toml", "--input", "error=2", "--input", "change=-1"];
    assert_eq!(code(&fspid(&asked, folder.path())), 0);
    // The same bytes again, and in words.
    let first = std::fs::read(folder.path().join("numbers.toml")).expect("written");
    let again = learn("again.toml", &[]);
    assert_eq!(std::fs::read(folder.path().join("again.toml")).expect("written"), first);
    assert!(stdout(&again).starts_with("1 epoch(s); nothing is to move"), "{}", stdout(&again));
}

#[test]
fn data_are_read_by_columns_and_bad_lines_are_told_before_anything_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let teach = ["learn", "printed", "--range", "5", "--teacher", "printed", "--points", "5,5"];
    let start =
        [&teach[..], &["--conclude", "linear", "--sets-stay", "--out", "start.toml"]].concat();
    assert_eq!(code(&fspid(&start, folder.path())), 0);
    let mut rows = "error,change,delta_kp,delta_ki,delta_kd\n".to_owned();
    for k in 0..60 {
        let (e, c) = (f64::from(k % 10) - 4.5, f64::from(k / 10) * 1.5 - 4.0);
        rows.push_str(&format!("{e},{c},{},{},{}\n", e + c, e * c, 1.0 - e));
    }
    std::fs::write(path("rows.csv"), &rows).expect("written");
    let learn = |file: &str, out: &str| {
        let more = ["--data", file, "--epochs", "3", "--validate", "0.2", "--out", out];
        fspid(&[&["learn", "start.toml"][..], &more].concat(), folder.path())
    };
    let done = learn("rows.csv", "learned.toml");
    assert_eq!(code(&done), 0, "{}", stderr(&done));
    assert!(stdout(&done).contains("validation"), "{}", stdout(&done));
    // Products up to 15.75 are beyond what a supervisor of this range takes.
    let far = ["--range", "5", "--data", "rows.csv", "--sets-stay", "--out", "far.toml"];
    let far = fspid(&[&["learn", "sugeno-grid"][..], &far].concat(), folder.path());
    assert_eq!(code(&far), 0, "{}", stderr(&far));
    assert!(stderr(&far).contains("warning: a scenario refuses it: delta_ki has numbers up to"));
    assert!(!stdout(&far).contains("It flies") && stdout(&far).contains("beyond the range:"));
    std::fs::write(path("bad.csv"), rows.replace("-4.5,-4,", "-4.5,nan,")).expect("written");
    let refused = learn("bad.csv", "never.toml");
    assert_eq!(code(&refused), 2);
    let told = "bad.csv:2: change is NaN; allowed is a finite number";
    assert!(stderr(&refused).contains(told), "{}", stderr(&refused));
    assert!(!path("never.toml").exists());
    let mamdani = [&teach[..], &["--out", "never.toml"]].concat();
    let refused = fspid(&mamdani, folder.path());
    assert!(code(&refused) == 2 && stderr(&refused).contains("Takagi and Sugeno"));
    let tip = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/systems/tip.toml");
    std::fs::copy(tip, path("tip.toml")).expect("copied");
    let more = ["--teacher", "tip.toml", "--points", "5,5", "--out", "never.toml"];
    let refused = fspid(&[&["learn", "start.toml"][..], &more].concat(), folder.path());
    let told = "the teacher has service, food, tip; the system has error, change, delta_kp";
    assert!(code(&refused) == 2 && stderr(&refused).contains(told), "{}", stderr(&refused));
}

/// IAE of each controller of a scenario, in degrees and seconds, by name.
fn iae(scenario: &str, folder: &Path) -> Vec<(String, f64)> {
    let flown = fspid(&["simulate", scenario, "--format", "json"], folder);
    assert_eq!(code(&flown), 0, "{}", stderr(&flown));
    let answer: Value = serde_json::from_str(&stdout(&flown)).expect("JSON");
    let controllers = answer["controllers"].as_array().expect("a list");
    let of = |one: &Value| {
        let iae = one["metrics"]["iae"].as_f64().expect("a number");
        (one["name"].as_str().expect("a name").to_owned(), iae)
    };
    controllers.iter().map(of).collect()
}

#[test]
fn a_supervisor_learned_from_a_scenario_s_own_flies_nearly_as_its_teacher() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert_eq!(code(&fspid(&["init", "flight.toml"], folder)), 0);
    let starter = std::fs::read_to_string(folder.join("flight.toml")).expect("written");
    for table in ["mirrored", "printed"] {
        let labels = starter.replace("\"mirrored\" ", &format!("\"{table}\" "));
        std::fs::write(folder.join("labels.toml"), &labels).expect("written");
        let learn = [
            "learn",
            "sugeno-grid",
            "--range",
            "5",
            "--teacher",
            "labels.toml",
            "--controller",
            "FSPID",
            "--points",
            "25,25",
            "--sets-stay",
            "--out",
            "learned.fis",
            "--format",
            "json",
        ];
        let learned = fspid(&learn, folder);
        assert_eq!(code(&learned), 0, "{}", stderr(&learned));
        let answer: Value = serde_json::from_str(&stdout(&learned)).expect("JSON");
        let error = answer["epochs"][0]["training"].as_f64().expect("a number");
        // Of a range of 5: what a bilinear surface on seven by seven nodes leaves of the centroid's.
        assert!(error < 0.15, "{table}: {error}");
        let numbers =
            labels.replace(&format!("table = \"{table}\" "), "system = \"learned.fis\" #");
        std::fs::write(folder.join("numbers.toml"), numbers).expect("written");
        let (taught, flown) = (iae("labels.toml", folder), iae("numbers.toml", folder));
        assert_eq!(taught[0], flown[0]);
        let (fixed, taught, flown) = (taught[0].1, taught[1].1, flown[1].1);
        println!("{table}: rms {error}, IAE fixed {fixed}, labels {taught}, numbers {flown}");
        // The supervisor moves the IAE by 4 % and more; learning it again by a small part of that.
        assert!(
            (flown - taught).abs() < 0.1 * (fixed - taught).abs(),
            "{table}: {fixed} {taught} {flown}"
        );
    }
}

#[test]
fn an_option_of_one_of_two_systems_is_refused_where_neither_has_a_use_for_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let grid =
        ["learn", "sugeno-grid", "--teacher", "mirrored", "--points", "9,9", "--out", "a.fis"];
    let refused = fspid(&grid, folder);
    let told = "sugeno-grid needs --range";
    assert!(code(&refused) == 2 && stderr(&refused).contains(told), "{}", stderr(&refused));
    let more = ["--range", "5", "--controller", "FSPID"];
    let refused = fspid(&[&grid[..], &more].concat(), folder);
    assert!(
        code(&refused) == 2 && stderr(&refused).contains("--controller"),
        "{}",
        stderr(&refused)
    );
    assert_eq!(code(&fspid(&[&grid[..], &["--range", "5", "--sets-stay"]].concat(), folder)), 0);
    // What is told of the numbers can be pasted into a scenario.
    let stay = fspid(&[&grid[..], &["--range", "5", "--sets-stay"]].concat(), folder);
    let told = stdout(&stay);
    let (_, numbers) = told.split_once("rounded:\n\n").expect("numbers");
    assert_eq!(code(&fspid(&["init", "flight.toml"], folder)), 0);
    let path = folder.join("flight.toml");
    let starter = std::fs::read_to_string(&path).expect("written").replace("range = 5.0 ", "#");
    let pasted = starter.replace("table = \"mirrored\" ", &format!("{numbers}#"));
    std::fs::write(&path, pasted).expect("written");
    let checked = fspid(&["check", "flight.toml"], folder);
    assert_eq!(code(&checked), 0, "{}", stderr(&checked));
    // Sets that move do not fly, and that is said at once.
    let moving = ["--range", "5", "--epochs", "2", "--out", "moved.fis"];
    let moved = fspid(&[&grid[..6], &moving].concat(), folder);
    assert!(stderr(&moved).contains("it does not fly: "), "{}", stderr(&moved));
    let both = [
        "learn",
        "a.fis",
        "--range",
        "5",
        "--teacher",
        "a.fis",
        "--points",
        "9,9",
        "--out",
        "b.fis",
    ];
    let refused = fspid(&both, folder);
    assert!(
        code(&refused) == 2 && stderr(&refused).contains("--range goes with"),
        "{}",
        stderr(&refused)
    );
}

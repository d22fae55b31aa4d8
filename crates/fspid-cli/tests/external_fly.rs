//! Controllers that are programs, at the other end of standard input and output: exports answer as their originals, and
//! whatever another does is told and ends no conversation.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::common::{code, fspid, json, started, text, with_input};
use crate::external::{STRANGE, library};
use crate::repository::repository;

/// A folder with a scenario of `init`.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    assert_eq!(code(&fspid(&["init", "pitch.toml"], folder.path())), 0);
    std::fs::write(folder.path().join("fspid_external.h"), fspid_export::write::EXTERNAL_HEADER)
        .and_then(|()| std::fs::write(folder.path().join("strange.c"), STRANGE))
        .expect("files");
    folder
}

/// Builds `x.so`, which does something at a sample of that number.
fn strange(folder: &Path, does: &str, at: usize) {
    let defined = [format!("STRANGE={does}"), format!("AT={at}"), "KEPT=0".to_owned()];
    library(folder, "x.so", &["strange.c".into()], &defined.each_ref().map(String::as_str));
}

/// `x.so` flies, and a hang is told after a moment.
const FLOWN: [&str; 6] = [
    "fly",
    "pitch.toml",
    "--controller",
    "X",
    "--set",
    "controller[]={ name = \"X\", kind = \"external\", library = \"x.so\", answer_limit_s = 0.3 }",
];

/// So many samples of a pitch that rises.
fn samples(count: usize) -> String {
    (0..count).map(|k| format!("5 {} 0.01 1\n", k as f64 * 0.25)).collect()
}

fn lines(output: &Output) -> Vec<String> {
    text(&output.stdout).lines().map(str::to_owned).collect()
}

/// The samples of a flight, and between them what no client should write.
fn flight(folder: &Path, scenario: &str, controller: &str) -> String {
    assert_eq!(code(&fspid(&["simulate", scenario, "--trace", "t.csv"], folder)), 0);
    let csv = std::fs::read_to_string(folder.join("t.csv")).expect("traces");
    let names: Vec<&str> = csv.lines().next().unwrap_or_default().split(',').collect();
    let at = |name: String| names.iter().position(|it| *it == name).expect("a column");
    let [theta, q] = ["theta_deg", "q_deg_s"].map(|name| at(format!("{controller}.{name}")));
    let mut input = String::new();
    for (k, line) in csv.lines().skip(1).enumerate() {
        let cells: Vec<&str> = line.split(',').collect();
        let (setpoint, pitch, rate) = (cells[1], cells[theta], cells[q]);
        let _ = match k % 400 {
            100 => writeln!(input, "no sample"),
            150 => writeln!(input, "nan {pitch} 0.01 {rate}"),
            200 => writeln!(input, "{setpoint} {pitch} 0.01 inf"),
            250 => writeln!(input, "{setpoint} {pitch} 0 {rate}"),
            300 => writeln!(input, "{setpoint} {pitch} 0.01"),
            350 => writeln!(input, "reset"),
            _ => writeln!(input, "{setpoint} {pitch} 0.01 {rate}"),
        };
        if k == 420 {
            let _ = writeln!(input, "{setpoint} 1e300 0.01 {rate}");
        }
    }
    input
}

#[test]
fn exports_of_shipped_designs_answer_the_bytes_of_their_originals() {
    for (design, controller) in [("navion-paper", "FSPID"), ("b747-short-period", "PID")] {
        let folder = tempfile::tempdir().expect("a folder");
        let (scenario, prefix) = (format!("{design}.toml"), controller.to_lowercase());
        let shipped = repository().join("data/designs").join(&scenario);
        std::fs::copy(shipped, folder.path().join(&scenario)).expect("a design");
        let export = |to: &[&str]| {
            let asked = [&["export", &scenario, "--controller", controller, "--to"], to].concat();
            assert_eq!(code(&fspid(&asked, folder.path())), 0);
        };
        export(&["c", "--numbers", "double", "--samples", "9", "--out", "code"]);
        export(&["fmu2", "--out", "unit"]);
        let sources = [format!("code/{prefix}.c"), format!("code/external/{prefix}_external.c")];
        library(folder.path(), "flown.so", &sources.map(PathBuf::from), &[]);
        std::fs::write(folder.path().join("in.txt"), flight(folder.path(), &scenario, controller))
            .expect("samples");
        let fmu = format!("unit/{prefix}.fmu");
        for angles in ["degrees", "radians"] {
            let fly = |who: &[&str]| {
                let asked = [&["fly", &scenario, "--angles", angles], who].concat();
                let input = std::fs::File::open(folder.path().join("in.txt")).expect("samples");
                let flown = Command::new(env!("CARGO_BIN_EXE_fspid"))
                    .args(asked)
                    .current_dir(folder.path())
                    .stdin(input)
                    .output()
                    .expect("the program starts");
                let told = text(&flown.stderr);
                assert_eq!(code(&flown), 0, "{told}");
                // Nobody knows that it does, and it was told that it does.
                let may_need = told.contains("no pitch rate, which this controller may need;");
                assert_eq!(may_need, who[0] != "--controller", "{told}");
                lines(&flown)
            };
            let original = fly(&["--controller", controller]);
            assert!(original.len() > 3000, "{design}");
            assert!(original == fly(&["--library", "flown.so"]), "{design} in {angles}: C");
            assert!(original == fly(&["--fmu", &fmu]), "{design} in {angles}: FMU");
        }
    }
}

#[test]
fn whatever_a_controller_does_is_told_with_its_time_and_every_line_is_answered() {
    let folder = folder();
    strange(folder.path(), "", 0);
    let sound = lines(&with_input(&FLOWN, folder.path(), &samples(20)));
    assert_eq!(sound.len(), 20);
    let junk = "char junk[99] = { 1 }; if (write(0, junk, 99)) { }";
    for (does, told) in [
        ("*(volatile int *)8 = 1", "crashed with SIGSEGV"),
        ("abort()", "crashed with SIGABRT"),
        ("for (;;) { }", "gave no answer within 0.3 s"),
        ("exit(3)", "ended its process with code 3"),
        ("answer->command_rad = NAN; return", "answered a command that is not finite"),
        ("answer->command_rad = -INFINITY; return", "answered a command that is not finite"),
        (junk, "wrote something else than an answer"),
        ("char junk[9]; if (write(0, junk, 9)) { } _exit(0)", "ended its process with code 0"),
    ] {
        // The first, the tenth, the last.
        for at in [0, 9, 19] {
            strange(folder.path(), does, at);
            let output = with_input(&FLOWN, folder.path(), &samples(20));
            let errors = text(&output.stderr);
            assert_eq!(code(&output), 1, "{does} at {at}: {errors}");
            let time_s = ["0", "0.09", "0.19"][at / 9];
            let sentence = format!("line {}: the controller {told} at t = {time_s} s;", at + 1);
            assert!(errors.contains(&sentence), "{does} at {at}: {errors}");
            assert!(errors.contains(", controller lost 1, resets 0\n"), "{errors}");
            assert!(errors.ends_with("fspid: the controller was lost\n"), "{errors}");
            // What was flown is there, and the last command is held behind it.
            let answers = lines(&output);
            let held = at.checked_sub(1).map_or("0.0", |last| sound[last].as_str());
            assert_eq!(answers[..at], sound[..at], "{does}");
            assert!(answers.len() == 20 && answers[at..].iter().all(|it| it == held), "{does}");
        }
    }
}

#[test]
fn a_reset_starts_a_lost_controller_anew() {
    let folder = folder();
    strange(folder.path(), "abort()", 3);
    let input = format!("{0}reset\n{0}", samples(5));
    let asked = [&FLOWN[..], &["--format", "json"]].concat();
    let output = with_input(&asked, folder.path(), &input);
    let answers = lines(&output);
    assert_eq!((answers.len(), answers[5].as_str()), (11, "ok"));
    assert_eq!(answers[..5], answers[6..]);
    let errors = text(&output.stderr);
    assert_eq!(errors.matches("crashed with SIGABRT at t = 0.03 s").count(), 2, "{errors}");
    assert!(errors.contains("\"controller_lost\":2}"), "{errors}");
}

#[test]
fn a_controller_that_prints_without_end_stops_nobody_that_does_not_read_it() {
    let folder = folder();
    strange(folder.path(), "for (int i = 0; i < 99999; i++) { puts(\"from me\"); }", 2);
    let output = with_input(&FLOWN, folder.path(), &samples(9));
    let errors = text(&output.stderr);
    assert_eq!((code(&output), lines(&output).len()), (0, 9), "{errors}");
    assert!(errors.contains("from me\nfrom me\n") && errors.len() < 4096, "{}", errors.len());
}

#[test]
fn two_flights_of_one_library_at_the_same_time_do_not_meet() {
    let folder = folder();
    let defined = ["STRANGE=", "KEPT=1"];
    library(folder.path(), "x.so", &["strange.c".into()], &defined);
    let alone = lines(&with_input(&FLOWN, folder.path(), &samples(300)));
    let mut both = [started(&FLOWN, folder.path()), started(&FLOWN, folder.path())];
    let mut pipes = both.each_mut().map(|child| child.stdin.take().expect("a pipe"));
    for line in samples(300).lines() {
        for pipe in &mut pipes {
            std::io::Write::write_all(pipe, format!("{line}\n").as_bytes()).expect("taken");
        }
    }
    drop(pipes);
    for child in both {
        assert_eq!(lines(&child.wait_with_output().expect("it ends")), alone);
    }
}

#[test]
fn a_controller_that_cannot_be_flown_is_wrong_input_before_the_first_sample() {
    let folder = folder();
    strange(folder.path(), "", 0);
    let told = |who: &[&str]| {
        let output = with_input(&[&["fly", "pitch.toml"], who].concat(), folder.path(), "5 0 0.01");
        assert_eq!((code(&output), output.stdout.len()), (2, 0), "{who:?}");
        text(&output.stderr)
    };
    let other = "loop.sample_period_s=0.02";
    assert!(told(&["--library", "strange.c"]).contains("cannot be loaded"));
    let several = told(&["--library", "x.so", "--library", "strange.c"]);
    assert!(several.contains("choose one with --controller: PID, FSPID, x.so, strange.c"));
    assert!(told(&["--controller", "x.si", "--library", "x.so"]).contains("did you mean `x.so`?"));
    library(folder.path(), "p.so", &["strange.c".into()], &["STRANGE=", "KEPT=0", "PERIOD=0.01"]);
    assert!(told(&["--library", "p.so", "--set", other]).contains("its period is 0.01 s"));
    let empty = with_input(
        &["fly", "pitch.toml", "--library", "x.so", "--format", "json"],
        folder.path(),
        "",
    );
    assert_eq!((code(&empty), json_of(&empty)), (0, 0));
}

/// Flights in which the controller was lost, of a summary on standard error.
fn json_of(output: &Output) -> u64 {
    let summary = Output { stdout: output.stderr.clone(), ..output.clone() };
    json(&summary)["controller_lost"].as_u64().expect("a number")
}

//! The program as people and scripts meet it: answers, exit codes, files, bytes.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn fspid(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fspid"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program starts")
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder")
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

fn json(output: &Output) -> Value {
    serde_json::from_str(&stdout(output)).expect("JSON on standard output")
}

/// The example of a scenario file.
const EXAMPLE: &str = r#"
schema = 1
name = "747 pitch step"
[plant]
preset = "b747-paper"
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.01
duration_s = 20.0
[setpoint]
kind = "step"
amplitude_deg = 1.0
[[controller]]
name = "PC"
kind = "p"
kp = 3.5287
rate_gain = 0.9144
[[controller]]
name = "FSPID"
kind = "fspid"
nominal = { kp = 2.0, ki = 0.5, kd = 1.0 }
supervisor = { table = "printed", range = 5.0, error_sign = "setpoint-minus-measurement", error_scale = 1.0, change = "rate", change_scale = 0.2, output_scale = { kp = 0.2, ki = 0.05, kd = 0.1 } }
law = "memoryless"
"#;

fn example(folder: &Path) {
    std::fs::write(folder.join("a.toml"), EXAMPLE).expect("written");
}

#[test]
fn infer_answers_the_reference_point_as_json() {
    let folder = folder();
    let answer = fspid(
        &[
            "infer", "--table", "printed", "--range", "5", "--error", "1", "--change", "-2",
            "--format", "json",
        ],
        folder.path(),
    );
    assert_eq!(code(&answer), 0, "{}", stderr(&answer));
    let delta = json(&answer);
    let near = |name: &str, value: f64| (delta[name].as_f64().expect(name) - value).abs() < 1e-11;
    assert!(near("delta_kp", 0.995_958_158_631), "{delta}");
    assert!(near("delta_ki", -0.608_034_418_811), "{delta}");
    assert!(near("delta_kd", -0.642_500_373_380), "{delta}");
}

#[test]
fn infer_answers_a_file_of_points_with_seventeen_digits_a_number() {
    let folder = folder();
    std::fs::write(folder.path().join("p.csv"), "kind,e,ec\nx,1,-2\nx,0.0,0\n\n").expect("written");
    let answer = fspid(&["infer", "--range", "5", "--points", "p.csv"], folder.path());
    assert_eq!(code(&answer), 0, "{}", stderr(&answer));
    let text = stdout(&answer);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 3);
    assert_eq!(lines[0], "e,ec,delta_kp,delta_ki,delta_kd");
    for word in lines[1].split(',') {
        let digits = word.split('e').next().expect("mantissa").matches(char::is_numeric).count();
        assert_eq!(digits, 17, "{word}");
    }
}

#[test]
fn infer_refuses_bad_points_with_their_lines_and_answers_none() {
    let folder = folder();
    std::fs::write(folder.path().join("p.csv"), "e,ec\n1,2\nx,3\n1,1e999\n").expect("written");
    let answer = fspid(&["infer", "--range", "5", "--points", "p.csv"], folder.path());
    assert_eq!((code(&answer), stdout(&answer).len()), (2, 0));
    let message = stderr(&answer);
    assert!(message.contains("p.csv:3: e is `x`"), "{message}");
    assert!(message.contains("p.csv:4: change is inf"), "{message}");
}

#[test]
fn infer_tells_every_problem_of_a_question_at_once() {
    let folder = folder();
    let answer = fspid(
        &[
            "infer",
            "--table",
            "nowhere",
            "--range",
            "-5",
            "--error",
            "1",
            "--change",
            "1",
            "--defuzzifier",
            "cog",
            "--out-of-range",
            "wrap",
        ],
        folder.path(),
    );
    assert_eq!(code(&answer), 2);
    let message = stderr(&answer);
    for part in ["printed, mirrored", "--range is -5", "endpoints:N", "clamp, evaluate, error"] {
        assert!(message.contains(part), "{part} in {message}");
    }
}

#[test]
fn infer_refuses_what_the_policy_refuses() {
    let folder = folder();
    let ask = |error: &str, policy: &str| {
        fspid(
            &["infer", "--range", "5", "--error", error, "--change", "0", "--out-of-range", policy],
            folder.path(),
        )
    };
    assert_eq!(code(&ask("6", "clamp")), 0);
    assert_eq!(code(&ask("6", "evaluate")), 0);
    assert_eq!(code(&ask("6", "error")), 2);
    assert_eq!(code(&ask("nan", "clamp")), 2);
    assert_eq!(code(&ask("1e999", "evaluate")), 2);
}

#[test]
fn the_starter_is_good_flies_and_is_not_overwritten() {
    let folder = folder();
    assert_eq!(code(&fspid(&["init", "pitch.toml"], folder.path())), 0);
    let before = std::fs::read(folder.path().join("pitch.toml")).expect("written");
    assert_eq!(code(&fspid(&["init", "pitch.toml"], folder.path())), 2);
    assert_eq!(std::fs::read(folder.path().join("pitch.toml")).expect("still there"), before);
    assert_eq!(code(&fspid(&["check", "pitch.toml"], folder.path())), 0);
    let flown =
        fspid(&["simulate", "pitch.toml", "--report", "r.html", "--trace", "t.csv"], folder.path());
    assert_eq!(code(&flown), 0, "{}", stderr(&flown));
    let report = std::fs::read_to_string(folder.path().join("r.html")).expect("written");
    assert!(report.contains("</html>") && report.matches("<script").count() == 1);
}

#[test]
fn simulate_answers_metrics_and_says_why_one_is_absent() {
    let folder = folder();
    example(folder.path());
    let answer = json(&fspid(&["simulate", "a.toml", "--format", "json"], folder.path()));
    assert_eq!((&answer["schema"], &answer["scenario"]), (&1.into(), &"747 pitch step".into()));
    let pc = &answer["controllers"][0];
    assert_eq!(pc["name"], "PC");
    // Sampled at 10 ms; in continuous time this loop overshoots 14.6 %.
    let overshoot = pc["metrics"]["overshoot_pct"].as_f64().expect("a number");
    assert!((overshoot - 15.211_245).abs() < 1e-4, "{overshoot}");
    assert_eq!(pc["absent"]["settling_time_s"], "not settled within 20 s");
    assert!(pc["metrics"]["settling_time_s"].is_null());
    for name in ["rise_time_s", "final_error_pct", "iae", "itae", "ise", "command_variation"] {
        assert!(pc["metrics"][name].is_number(), "{name}");
    }
}

#[test]
fn a_trace_has_a_row_for_every_sample_and_columns_by_controller() {
    let folder = folder();
    example(folder.path());
    fspid(&["simulate", "a.toml", "--trace", "t.csv"], folder.path());
    let text = std::fs::read_to_string(folder.path().join("t.csv")).expect("written");
    let mut lines = text.lines();
    let header = lines.next().expect("a heading");
    assert!(header.starts_with("time_s,setpoint_deg,PC.theta_deg,PC.q_deg_s,PC.command_deg"));
    assert_eq!(lines.count(), 2001);
    let single = EXAMPLE.replace(
        "[[controller]]\nname = \"PC\"\nkind = \"p\"\nkp = 3.5287\nrate_gain = 0.9144\n",
        "",
    );
    std::fs::write(folder.path().join("one.toml"), single).expect("written");
    fspid(&["simulate", "one.toml", "--trace", "one.csv"], folder.path());
    let text = std::fs::read_to_string(folder.path().join("one.csv")).expect("written");
    let header = text.lines().next().expect("a heading");
    assert_eq!(header, "time_s,setpoint_deg,theta_deg,q_deg_s,command_deg,elevator_deg,kp,ki,kd");
}

#[test]
fn an_unstable_loop_is_a_result_without_metrics() {
    let folder = folder();
    example(folder.path());
    let fly = |set: &str, failed: bool| {
        let output =
            fspid(&["simulate", "a.toml", "--format", "json", "--set", set], folder.path());
        // It used to be 0 for both: nothing is required of a flight that fails by itself.
        assert_eq!(code(&output), i32::from(failed), "{}", stderr(&output));
        assert_eq!(stderr(&output).contains("fspid: 1 flight failed"), failed);
        let controller = json(&output)["controllers"][0].clone();
        assert_eq!(controller["failed"], failed);
        controller
    };
    let wild = fly("controller.PC.kp=100", true);
    assert!(wild["verdict"].as_str().expect("text").starts_with("diverged at t = "), "{wild}");
    assert_eq!(wild["outcome"]["kind"], "diverged");
    assert!(wild["outcome"]["at_s"].is_f64());
    // Above the neutral gain with the gyro switched off it grows too slowly to be seen.
    let slow = fly("controller.PC.rate_gain=0.0", false);
    assert!(!slow["verdict"].as_str().expect("text").contains("unstable"), "{slow}");
    let output = fspid(
        &[
            "simulate",
            "a.toml",
            "--format",
            "json",
            "--set",
            "controller.PC.rate_gain=0.0",
            "--set",
            "controller.PC.kp=4.54",
        ],
        folder.path(),
    );
    let grows = json(&output)["controllers"][0].clone();
    assert!(grows["verdict"].as_str().expect("text").starts_with("unstable"), "{grows}");
    for result in [&wild, &grows] {
        let metrics = result["metrics"].as_object().expect("an object");
        assert!(metrics.values().all(Value::is_null), "{result}");
        assert_eq!(metrics.len(), result["absent"].as_object().expect("an object").len());
    }
}

#[test]
fn a_requirement_that_is_not_met_ends_with_one() {
    let folder = folder();
    let requirement = "[[requirement]]\nmeasure = \"overshoot_pct\"\nmost = 12.0\n";
    std::fs::write(folder.path().join("a.toml"), format!("{EXAMPLE}\n{requirement}"))
        .expect("written");
    let both = fspid(&["simulate", "a.toml"], folder.path());
    assert_eq!(code(&both), 1);
    assert!(stdout(&both).contains("NOT MET: PC") && stdout(&both).contains("met: FSPID"));
    let one =
        fspid(&["simulate", "a.toml", "--set", "requirement[0].controller=FSPID"], folder.path());
    assert_eq!(code(&one), 0, "{}", stderr(&one));
}

#[test]
fn every_problem_of_a_file_is_told_with_its_line_and_nothing_is_written() {
    let folder = folder();
    let bad = EXAMPLE
        .replace("kp = 3.5287", "kp = nan")
        .replace("time_constant_s = 0.1", "time_constant_s = -1")
        .replace("preset = \"b747-paper\"", "preset = \"b747-papr\"");
    std::fs::write(folder.path().join("bad.toml"), bad).expect("written");
    for command in [&["check", "bad.toml"][..], &["simulate", "bad.toml", "--trace", "t.csv"]] {
        let output = fspid(command, folder.path());
        assert_eq!((code(&output), stdout(&output).len()), (2, 0));
        let message = stderr(&output);
        for part in ["bad.toml:5:", "bad.toml:7:", "bad.toml:17:", "did you mean \"b747-paper\"?"] {
            assert!(message.contains(part), "{part} in {message}");
        }
    }
    assert!(!folder.path().join("t.csv").exists());
}

#[test]
fn a_missing_file_and_a_huge_flight_end_with_two() {
    let folder = folder();
    example(folder.path());
    assert_eq!(code(&fspid(&["simulate", "nowhere.toml"], folder.path())), 2);
    let huge = fspid(&["simulate", "a.toml", "--set", "loop.duration_s=1e10"], folder.path());
    assert_eq!(code(&huge), 2);
    assert!(stderr(&huge).contains("samples"), "{}", stderr(&huge));
    assert_eq!(code(&fspid(&["fly"], folder.path())), 2);
    assert_eq!(code(&fspid(&[], folder.path())), 2);
    assert_eq!(code(&fspid(&["--help"], folder.path())), 0);
}

#[test]
fn an_output_that_cannot_be_written_ends_with_four_and_keeps_the_old_file() {
    let folder = folder();
    example(folder.path());
    std::fs::create_dir(folder.path().join("in-the-way")).expect("made");
    let output = fspid(&["simulate", "a.toml", "--trace", "in-the-way"], folder.path());
    assert_eq!(code(&output), 4, "{}", stderr(&output));
    let output = fspid(&["simulate", "a.toml", "--trace", "missing/t.csv"], folder.path());
    assert_eq!(code(&output), 4, "{}", stderr(&output));
    assert!(stderr(&output).contains("nothing there was changed"));
    std::fs::write(folder.path().join("file"), "old").expect("written");
    let output = fspid(&["reproduce", "--out", "file"], folder.path());
    assert_eq!(code(&output), 4, "{}", stderr(&output));
    assert_eq!(std::fs::read_to_string(folder.path().join("file")).expect("there"), "old");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_output_ends_with_four() {
    let folder = folder();
    example(folder.path());
    let full = std::fs::File::options().write(true).open("/dev/full").expect("a full device");
    let status = Command::new(env!("CARGO_BIN_EXE_fspid"))
        .args(["simulate", "a.toml"])
        .current_dir(folder.path())
        .stdout(full)
        .stderr(std::process::Stdio::null())
        .status()
        .expect("the program starts");
    assert_eq!(status.code(), Some(4));
}

#[test]
fn two_runs_of_everything_write_the_same_bytes() {
    let folder = folder();
    example(folder.path());
    for run in ["one", "two"] {
        std::fs::create_dir(folder.path().join(run)).expect("made");
        let (trace, report) = (format!("{run}/t.csv"), format!("{run}/r.html"));
        let flown =
            fspid(&["simulate", "a.toml", "--trace", &trace, "--report", &report], folder.path());
        std::fs::write(folder.path().join(run).join("answer.txt"), stdout(&flown))
            .expect("written");
        let out = format!("{run}/paper");
        let paper = fspid(&["reproduce", "--check", "--out", &out], folder.path());
        assert_eq!(code(&paper), 0, "{}", stderr(&paper));
    }
    let (one, two) = (files(&folder.path().join("one")), files(&folder.path().join("two")));
    assert!(one.len() > 20, "{} files", one.len());
    assert_eq!(
        one.iter().map(|(name, _)| name).collect::<Vec<_>>(),
        two.iter().map(|(name, _)| name).collect::<Vec<_>>()
    );
    for ((name, one), (_, two)) in one.iter().zip(&two) {
        assert!(one == two, "{name} differs");
    }
}

/// All files below a folder by name, sorted.
fn files(root: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("listed") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(root).expect("below").display().to_string();
                found.push((name, std::fs::read(path).expect("read")));
            }
        }
    }
    found.sort();
    found
}

#[test]
fn the_schema_is_printed_as_json() {
    let folder = folder();
    let schema = json(&fspid(&["schema"], folder.path()));
    assert!(schema["properties"]["controller"].is_object(), "{schema}");
}

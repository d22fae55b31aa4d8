//! `fspid tune` as engineers, interruptions and mistakes meet it.

use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

const SCENARIO: &str = r#"schema = 1
name = "to be tuned"

[plant]
preset = "navion-paper"

[actuator]
time_constant_s = 0.1

[loop]
sample_period_s = 0.02
duration_s = 4.0

[setpoint]
kind = "step"
amplitude_deg = 2.0

# The gains that are looked for.
[[controller]]
name = "PID"
kind = "pid"
kp = { tune = [0.1, 10.0], scale = "log", start = 1.0 } # command per error
ki = { tune = [0.01, 5.0], scale = "log", start = 0.5 }
kd = { tune = [0.01, 1.0], scale = "log", start = 0.1 }
derivative_filter_s = 0.05
derivative_on = "measurement"

[[requirement]]
measure = "overshoot_pct"
most = 25.0

[tuning]
budget = 60

[[tuning.case]]
name = "weak elevator"
set = ["plant.preset.numerator[0]=9.0"]

[[tuning.case]]
name = "as it is"
set = []

[[tuning.objective]]
measure = "iae_deg_s"

[[tuning.objective]]
measure = "elevator_travel_deg"
weight = 0.05
"#;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("pitch.toml"), SCENARIO).expect("written");
    folder
}

fn fspid(arguments: &[&str], folder: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fspid"));
    command.args(arguments).current_dir(folder).output().expect("the program starts")
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).expect("UTF-8")
}

fn done(arguments: &[&str], folder: &Path) -> String {
    let output = fspid(arguments, folder);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}\n{}", text(&output.stderr));
    text(&output.stdout).to_owned()
}

fn refused(arguments: &[&str], folder: &Path) -> String {
    let output = fspid(arguments, folder);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}\n{}", text(&output.stdout));
    text(&output.stderr).to_owned()
}

fn read(folder: &Path, name: &str) -> Vec<u8> {
    std::fs::read(folder.join(name)).expect("it was written")
}

#[test]
fn a_design_is_the_scenario_with_numbers_in_place_of_marks_and_flies() {
    let folder = folder();
    let folder = folder.path();
    let output = fspid(&["tune", "pitch.toml", "--out", "design.toml"], folder);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let (told, beside) = (text(&output.stdout), text(&output.stderr));
    assert!(beside.ends_with("\nnext: fspid verify design.toml\n"), "{beside}");
    assert!(told.contains("cma-es with seed 1, 60 candidates of 2 flights"), "{told}");
    let design = String::from_utf8(read(folder, "design.toml")).expect("UTF-8");
    assert!(
        design.starts_with("# Controller \"PID\" was tuned by: fspid tune pitch.toml"),
        "{design}"
    );
    assert!(design.contains("# command per error") && !design.contains("tune = ["), "{design}");
    let flown = done(&["simulate", "design.toml"], folder);
    assert!(flown.contains("settled"), "{flown}");
    assert!(!folder.join("design.toml.state.json").exists());
}

#[test]
fn every_optimiser_ends_below_the_start_and_on_any_number_of_threads_the_same() {
    let folder = folder();
    let folder = folder.path();
    for optimiser in
        ["cma-es", "de", "l-shade", "pso", "ga", "nelder-mead", "bfgs", "sqp", "nsga-ii"]
    {
        let run = |threads: &str, out: &str| {
            let arguments = [
                "tune",
                "pitch.toml",
                "--optimiser",
                optimiser,
                "--threads",
                threads,
                "--out",
                out,
                "--history",
                "history.parquet",
                "--quiet",
                "--format",
                "json",
            ];
            let answer = done(&arguments, folder);
            (answer, read(folder, out), read(folder, "history.parquet"))
        };
        let one = run("1", "one.toml");
        let three = run("3", "three.toml");
        assert_eq!((&one.0, &one.2), (&three.0, &three.2), "{optimiser}");
        assert_eq!(one.1, three.1, "{optimiser}");
        let answer: serde_json::Value = serde_json::from_str(&one.0).expect("JSON");
        let cost = |of: &str| answer[of]["cost"].as_f64().unwrap_or(f64::INFINITY);
        assert!(cost("best") < cost("start"), "{optimiser}: {answer:#}");
        assert_eq!(answer["hypervolume"].is_number(), optimiser == "nsga-ii", "{answer:#}");
        assert_eq!(answer["front"].is_array(), optimiser == "nsga-ii", "{answer:#}");
    }
}

/// A search that has written its state and now stands still. It is waited for however long that
/// takes; one that had ended before it was seen is begun again.
#[cfg(unix)]
fn caught(arguments: &[&str], folder: &Path, state: &Path) -> Child {
    loop {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fspid"));
        command.args(arguments).current_dir(folder).stdout(Stdio::null()).stderr(Stdio::null());
        let mut child = command.spawn().expect("the program starts");
        while child.try_wait().expect("a state").is_none() {
            if !state.exists() {
                std::thread::sleep(Duration::from_millis(20));
                continue;
            }
            let number = child.id().to_string();
            assert!(
                Command::new("kill").args(["-STOP", &number]).status().expect("kill").success()
            );
            if state.exists() && !folder.join("cut.toml").exists() {
                return child;
            }
            child.kill().expect("killed");
        }
        child.wait().expect("ended");
        for left in [state, &folder.join("cut.toml"), &folder.join("cut.parquet")] {
            let _ = std::fs::remove_file(left);
        }
    }
}

#[cfg(unix)]
#[test]
fn a_search_that_was_killed_goes_on_to_the_same_design_and_history() {
    let folder = folder();
    let folder = folder.path();
    let arguments = |out: &'static str, history: &'static str| {
        ["tune", "pitch.toml", "--budget", "4000", "--out", out, "--history", history]
    };
    let state = folder.join("cut.toml.state.json");
    let mut child = caught(&arguments("cut.toml", "cut.parquet"), folder, &state);
    child.kill().expect("it still searches");
    child.wait().expect("it ended");
    assert!(state.exists() && !folder.join("cut.toml").exists());
    // Another search does not take its state.
    let other = refused(&["tune", "pitch.toml", "--seed", "9", "--out", "cut.toml"], folder);
    assert!(other.contains("cut.toml.state.json") && other.contains("another search"), "{other}");
    // What it has found so far is taken without an end of it, nor a change of its state.
    let kept = read(folder, "cut.toml.state.json");
    let so_far = [&arguments("cut.toml", "cut.parquet")[..], &["--so-far"]].concat();
    assert!(done(&so_far, folder).contains("the search is not over"));
    let design = String::from_utf8(read(folder, "cut.toml")).expect("UTF-8");
    assert!(design.contains("the search is not over") && !design.contains("tune = ["), "{design}");
    assert_eq!(read(folder, "cut.toml.state.json"), kept);
    let output = fspid(&arguments("cut.toml", "cut.parquet"), folder);
    assert!(text(&output.stderr).contains("going on after"), "{}", text(&output.stderr));
    done(&arguments("whole.toml", "whole.parquet"), folder);
    assert_eq!(read(folder, "cut.toml"), read(folder, "whole.toml"));
    assert_eq!(read(folder, "cut.parquet"), read(folder, "whole.parquet"));
    assert!(!state.exists());
    let none = refused(&so_far, folder);
    assert!(none.contains("no search was saved there"), "{none}");
}

/// It used to wait for the end of the generation that was flown.
#[cfg(unix)]
#[test]
fn ctrl_c_does_not_wait_for_a_generation_and_the_search_goes_on() {
    let folder = folder();
    let folder = folder.path();
    // A generation of minutes.
    let effort = ["--optimiser", "de", "--budget", "900000", "--population", "300000"];
    let arguments = [["tune", "pitch.toml"].as_slice(), &effort].concat();
    let state = folder.join("pitch.toml.PID.state.json");
    let mut patience = Duration::from_millis(250);
    while !state.exists() {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fspid"));
        command.args(&arguments).current_dir(folder).stdout(Stdio::null()).stderr(Stdio::piped());
        let child = command.spawn().expect("the program starts");
        // One that has not flown its start yet keeps nothing, and is begun again.
        std::thread::sleep(patience);
        patience *= 2;
        let interrupt = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
        assert!(interrupt.expect("kill").success());
        let output = child.wait_with_output().expect("it ends");
        // One that did not listen yet has no code.
        assert!(matches!(output.status.code(), Some(130) | None), "{}", text(&output.stderr));
    }
    let state = std::fs::read_to_string(state).expect("the state");
    let state: serde_json::Value = serde_json::from_str(&state).expect("JSON");
    assert_eq!(state["trials"].as_array().map(Vec::len), Some(1), "the start alone");
}

#[test]
fn what_is_wrong_is_told_before_anything_runs() {
    let folder = folder();
    let folder = folder.path();
    let with = |from: &str, to: &str| {
        assert!(SCENARIO.contains(from), "{from}");
        std::fs::write(folder.join("wrong.toml"), SCENARIO.replace(from, to)).expect("written");
    };
    let tune = ["tune", "wrong.toml", "--out", "design.toml"];
    for (from, to, message) in [
        ("tune = [0.1, 10.0]", "tune = [10.0, 0.1]", "the bounds hold no number between them"),
        ("[tuning]\nbudget = 60", "[tuning]\nbudget = 0", "tuning.budget: out of range"),
        (
            "derivative_filter_s = 0.05",
            "derivative_filter_s = { tune = [-0.1, 0.1], start = 0.05 }",
            "derivative_filter_s: -0.1 is not allowed",
        ),
        ("start = 1.0 }", "start = 10.0 }", "the start has no cost"),
        ("measure = \"iae_deg_s\"", "measure = \"phugoid_damping\"", "the start has no cost"),
        ("numerator[0]=9.0", "numerator[7]=9.0", "case \"weak elevator\" makes the scenario wrong"),
    ] {
        with(from, to);
        let told = refused(&tune, folder);
        assert!(told.contains(message), "{from} -> {to}: {told}");
    }
    for (arguments, message) in [
        (["--budget", "0"], "--budget is 0; allowed is a whole number from 1 to 10000000"),
        (["--optimiser", "cmaes"], "there is no optimiser `cmaes`; did you mean `cma-es`?"),
        (["--controller", "FSPID"], "the controller is \"FSPID\"; allowed is PID"),
        (["--set", "controller.PID.kq=1"], "did you mean"),
    ] {
        let told = refused(&["tune", "pitch.toml", arguments[0], arguments[1]], folder);
        assert!(told.contains(message), "{arguments:?}: {told}");
    }
    assert!(!folder.join("design.toml").exists());
}

/// They were told one at a time, each after the one before was there.
#[test]
fn all_that_a_tuning_needs_is_told_at_once() {
    let folder = folder();
    let folder = folder.path();
    let init = fspid(&["init", "plain.toml"], folder);
    assert_eq!(init.status.code(), Some(0), "{}", text(&init.stderr));
    let told = refused(&["tune", "plain.toml"], folder);
    for words in
        ["[[tuning.objective]]", "kp = { tune = [0.1, 10.0]", "`start`", "init --template tuning"]
    {
        assert!(told.contains(words), "{words}: {told}");
    }
    let (without, _) = SCENARIO.split_once("[tuning]").expect("there is one");
    std::fs::write(folder.join("marked.toml"), without).expect("written");
    let told = refused(&["tune", "marked.toml"], folder);
    assert!(told.contains("[[tuning.objective]]") && !told.contains("kp = {"), "{told}");
}

#[test]
fn a_best_candidate_that_breaks_a_requirement_is_not_called_good() {
    let folder = folder();
    let folder = folder.path();
    let hard = SCENARIO.replace(
        "measure = \"overshoot_pct\"\nmost = 25.0",
        "measure = \"rise_time_s\"\nmost = 0.001",
    );
    std::fs::write(folder.join("hard.toml"), hard).expect("written");
    let output = fspid(&["tune", "hard.toml", "--out", "design.toml"], folder);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("not good enough"), "{}", text(&output.stdout));
    let design = String::from_utf8(read(folder, "design.toml")).expect("UTF-8");
    assert!(design.contains("# NOT GOOD ENOUGH"), "{design}");
}

#[test]
fn changes_from_outside_stand_in_the_design() {
    let folder = folder();
    let folder = folder.path();
    let arguments = [
        "tune",
        "pitch.toml",
        "--set",
        "loop.duration_s=3",
        "--set",
        "controller.PID.derivative_filter_s={ tune = [0.01, 0.1] }",
        "--out",
        "design.toml",
    ];
    done(&arguments, folder);
    let checked = done(&["check", "design.toml"], folder);
    assert!(checked.contains("151 samples"), "{checked}");
}

#[test]
fn a_rule_gives_gains_and_a_start_for_the_search() {
    let folder = folder();
    let folder = folder.path();
    for rule in [
        "ziegler-nichols",
        "tyreus-luyben",
        "simc",
        "lambda",
        "amigo",
        "itae",
        "pole-placement",
        "lqr",
        "autotune-relay",
    ] {
        let output = fspid(&["tune", "pitch.toml", "--rule", rule, "--out", "start.toml"], folder);
        let told = text(&output.stdout);
        assert!(
            told.contains("formula") && told.contains("closed loop"),
            "{rule}: {told}\n{}",
            text(&output.stderr)
        );
        // A rule whose gains do not hold the aircraft says so, and is no success.
        assert_eq!(
            output.status.code(),
            Some(if told.contains("NOT HELD") { 1 } else { 0 }),
            "{told}"
        );
        let start = String::from_utf8(read(folder, "start.toml")).expect("UTF-8");
        assert!(start.contains("tune = [0.1, 10.0]"), "{start}");
        done(&["check", "start.toml"], folder);
    }
    let json = done(&["tune", "pitch.toml", "--rule", "simc", "--format", "json"], folder);
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert!(json["gains"]["kp"].as_f64().is_some_and(|kp| kp > 0.0), "{json:#}");
    let told = refused(&["tune", "pitch.toml", "--rule", "cohen-coon"], folder);
    assert!(told.contains("known are ziegler-nichols, tyreus-luyben"), "{told}");
    assert!(done(&["tune", "pitch.toml", "--rule", "list"], folder).lines().count() == 9);
}

#[test]
fn a_rule_does_not_write_gains_that_a_schedule_would_multiply_again() {
    let folder = folder();
    let folder = folder.path();
    let text = SCENARIO
        .replace("[plant]\npreset = \"navion-paper\"", "[aircraft]\nname = \"navion\"\nairspeed_ft_s = 176.0\naltitude_ft = 0.0\nmodel = \"linear\"")
        .replace("derivative_on = ", "schedule = { dynamic_pressure_pa = 1700.0 }\nderivative_on = ");
    std::fs::write(folder.join("scheduled.toml"), text).expect("written");
    let told = refused(&["tune", "scheduled.toml", "--rule", "simc"], folder);
    assert!(told.contains("whose gains come from a schedule"), "{told}");
}

/// The scenario with a self-tuning controller whose numbers for kp are free, and one cell of those for kd.
fn with_numbers() -> String {
    let zeros = format!("[{}]", ["[0, 0, 0, 0, 0, 0, 0]"; 7].join(", "));
    let kd = zeros.replacen("0", "{ tune = [-1.0, 1.0] }", 1);
    let tuner = format!(
        r#"[[controller]]
name = "TS"
kind = "fspid"
nominal = {{ kp = 1.0, ki = 0.5, kd = 0.1 }}
derivative_filter_s = 0.05
derivative_on = "measurement"

[controller.supervisor]
range = 2.0
error_scale = 1.0
change_scale = 0.2
output_scale = {{ kp = 0.5, ki = 0.0, kd = 0.05 }}
numbers.delta_kp = {{ tune = "numbers", reach = 1.0, start = {zeros} }}
numbers.delta_ki = {zeros}
numbers.delta_kd = {kd}

[[requirement]]
measure"#
    );
    SCENARIO
        .replacen("[[requirement]]\nmeasure", &tuner, 1)
        .replace("budget = 60", "budget = 60\ncontroller = \"TS\"")
}

#[test]
fn free_numbers_of_a_supervisor_are_tuned_alike_on_any_number_of_threads() {
    let folder = folder();
    let folder = folder.path();
    std::fs::write(folder.join("pitch.toml"), with_numbers()).expect("written");
    let run = |threads: &str, out: &str| {
        let arguments = [
            "tune",
            "pitch.toml",
            "--threads",
            threads,
            "--out",
            out,
            "--history",
            "history.parquet",
            "--quiet",
            "--format",
            "json",
        ];
        (done(&arguments, folder), read(folder, out), read(folder, "history.parquet"))
    };
    let (one, three) = (run("1", "one.toml"), run("3", "three.toml"));
    assert_eq!((&one.0, &one.2), (&three.0, &three.2));
    let answer: serde_json::Value = serde_json::from_str(&one.0).expect("JSON");
    let cost = |of: &str| answer[of]["cost"].as_f64().unwrap_or(f64::INFINITY);
    assert!(cost("best") < cost("start"), "{answer:#}");
    // 25 numbers of a symmetric grid, and the one cell.
    let parameters = answer["parameters"].as_array().expect("a list");
    assert_eq!(parameters.len(), 26);
    assert_eq!(parameters[0]["path"], "controller.TS.supervisor.numbers.delta_kp[0][0]");
    assert_eq!(parameters[0]["bounds"], serde_json::json!([-1.0, 1.0]));
    // The design holds seven rows below each other, flies, and is as good as the search said.
    let design = String::from_utf8(one.1).expect("UTF-8");
    assert!(design.contains("numbers.delta_kp = [\n  ["), "{design}");
    assert!(!design.contains("reach ="), "{design}");
    done(&["check", "one.toml"], folder);
    assert!(done(&["simulate", "one.toml"], folder).contains("TS"));
}

#[test]
fn check_tells_of_every_case_that_makes_no_scenario() {
    let folder = folder();
    let folder = folder.path();
    done(&["check", "pitch.toml"], folder);
    let wrong = "\n[[tuning.case]]\nname = \"misspelt\"\nset = [\"plant.presett=navion-paper\"]\n
[[tuning.case]]\nname = \"misspelt as well\"\nset = [\"plant.presett=navion-paper\"]\n
[contest]\n[[contest.case]]\nname = \"backwards\"\nset = [\"loop.duration_s=-1\"]\n";
    std::fs::write(folder.join("wrong.toml"), format!("{SCENARIO}{wrong}")).expect("written");
    let told = refused(&["check", "wrong.toml"], folder);
    assert!(told.contains("case \"misspelt\" makes the scenario wrong"), "{told}");
    assert!(told.contains("plant.presett") && told.contains("loop.duration_s"), "{told}");
    assert!(told.contains("case \"backwards\""), "{told}");
    // The same mistake once.
    assert!(!told.contains("misspelt as well"), "{told}");
    let asked = ["check", "wrong.toml", "--format", "json"];
    let error = crate::common::json(&crate::common::fspid(&asked, folder));
    let problems = error["error"]["problems"]["problems"].as_array().expect("a list").clone();
    let cases: Vec<_> = problems.iter().map(|it| &it["case"]).collect();
    assert_eq!(cases, ["misspelt", "backwards"]);
}

/// Problems of a case were told in a sentence alone by those who go on to fly or to prove it.
#[test]
fn who_goes_on_to_the_cases_tells_their_problems_as_check_does() {
    let folder = folder();
    let folder = folder.path();
    for kind in ["tuning", "contest"] {
        let case = "name = \"misspelt\"\nset = [\"plant.presett=navion-paper\"]\n";
        let wrong = format!("{SCENARIO}\n[[{kind}.case]]\n{case}");
        std::fs::write(folder.join(format!("{kind}.toml")), wrong).expect("written");
    }
    for asked in [
        "tune tuning.toml --budget 4 --quiet",
        "certify tuning.toml --cases tuning",
        "contest contest.toml --quiet --out contest",
    ] {
        let mut asked: Vec<&str> = asked.split(' ').collect();
        asked.extend(["--format", "json"]);
        let error = crate::common::json(&crate::common::fspid(&asked, folder))["error"].clone();
        let problem = &error["problems"]["problems"][0];
        assert_eq!(problem["case"], "misspelt", "{asked:?}: {error}");
        assert_eq!(problem["path"], "plant.presett", "{asked:?}: {error}");
    }
}

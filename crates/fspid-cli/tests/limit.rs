//! `fspid limit`, and what `simulate` and `contest` tell of it.

use crate::common;

use common::{code, fspid, json, text};

/// A flight that is solved in no time: a light plant, a servo with limits, two controllers of which one is slow.
const PITCH: &str = r#"
schema = 1
name = "Short"

[plant]
numerator = [1.151, 0.1774]
denominator = [1.0, 0.739, 0.921, 0.0]
elevator_sign = "nose-up-positive"

[actuator]
time_constant_s = 0.1
position_limit_deg = 20.0
rate_limit_deg_s = 60.0

[loop]
sample_period_s = 0.05
duration_s = 8.0

[setpoint]
kind = "step"
amplitude_deg = 3.0
at_s = 1.0

[[controller]]
name = "quick"
kind = "pid"
kp = 4.0
ki = 1.0
kd = 2.0

[[controller]]
name = "slow"
kind = "pid"
kp = 1.0
ki = 0.3
kd = 0.3
"#;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("pitch.toml"), PITCH).expect("written");
    folder
}

#[test]
fn every_controller_stands_beside_the_limit_at_its_own_travel() {
    let folder = folder();
    let words = ["limit", "pitch.toml", "--quiet", "--format", "json"];
    let output = fspid(&words, folder.path());
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let answer = json(&output);
    assert_eq!(answer["travel_of"], "elevator");
    let controllers = answer["controllers"].as_array().expect("a list");
    for it in controllers {
        let number = |key: &str| it[key].as_f64().expect("a number");
        let proved = it["limit"]["proved"].as_f64().expect("a number");
        let reached = it["limit"]["reached"].as_f64().expect("a number");
        assert!(proved <= reached && reached <= number("value"), "{it}");
        assert!(proved > 0.97 * reached, "{it}");
        assert!((number("of_possible_pct") - 100.0 * proved / number("value")).abs() < 1e-9);
    }
    // The measures are those of a report.
    let flown = json(&fspid(&["simulate", "pitch.toml", "--format", "json"], folder.path()));
    let iae = flown["controllers"][0]["metrics"]["iae_deg_s"].as_f64();
    let iae = iae.or_else(|| flown["controllers"][0]["iae_deg_s"].as_f64());
    if let Some(iae) = iae {
        assert!((controllers[0]["value"].as_f64().expect("a number") - iae).abs() < 1e-9 * iae);
    }
    let ladder = answer["ladder"].as_array().expect("a list");
    assert_eq!(ladder.len(), 7);
    let proved: Vec<f64> = ladder.iter().filter_map(|it| it["proved"].as_f64()).collect();
    assert!(proved.windows(2).all(|pair| pair[1] <= pair[0] * (1.0 + 1e-5)), "{proved:?}");
}

#[test]
fn the_answer_for_people_tells_units_and_shares_and_the_page_a_curve() {
    let folder = folder();
    let words =
        ["limit", "pitch.toml", "--travel-deg", "4,8", "--causal", "--report", "limit.html"];
    let output = fspid(&words, folder.path());
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let told = text(&output.stdout);
    for part in ["IAE proved, at least [deg s]", "without the future", "of what is possible", " %"]
    {
        assert!(told.contains(part), "{part}: {told}");
    }
    let page = std::fs::read_to_string(folder.path().join("limit.html")).expect("a page");
    assert!(page.contains("limit, proved") && page.contains("quick"), "no curve");
}

#[test]
fn what_no_limit_can_be_told_of_is_refused_with_everything_at_once() {
    let folder = folder();
    let refused = |words: &[&str]| {
        let output = fspid(words, folder.path());
        assert_eq!(code(&output), 2, "{words:?}");
        text(&output.stderr)
    };
    let told = refused(&[
        "limit",
        "pitch.toml",
        "--set",
        "actuator.backlash_deg=0.5",
        "--travel-of",
        "command",
    ]);
    assert!(told.contains("backlash_deg") && told.contains("--travel-of elevator"), "{told}");
    let told = refused(&["limit", "pitch.toml", "--travel-deg", "0"]);
    assert!(told.contains("a number of degrees above 0"), "{told}");
    let told = refused(&["limit", "pitch.toml", "--travel-deg", "5,x"]);
    assert!(told.contains("a number of degrees above 0"), "{told}");
    // Who flies to the end and is unstable has no travel that counts: it is said of each.
    let told = refused(&["limit", "pitch.toml", "--set", "actuator.delay_samples=60"]);
    assert!(told.contains("there is no travel to ask the limit at"), "{told}");
    assert_eq!(told.matches("unstable at rest").count(), 2, "{told}");
}

#[test]
fn a_travel_that_a_push_at_the_elevator_needs_alone_has_no_limit_and_says_so() {
    let folder = folder();
    let push = "\n[[disturbance]]\nkind = \"step\"\nenters_at = \"elevator\"\namplitude_deg = 9.0\nat_s = 3.0\n";
    std::fs::write(folder.path().join("pushed.toml"), format!("{PITCH}{push}")).expect("written");
    let words = ["limit", "pushed.toml", "--travel-deg", "1,20", "--quiet"];
    let output = fspid(&words, folder.path());
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("needs more"), "{}", text(&output.stdout));
    let words = [words.as_slice(), &["--format", "json"]].concat();
    let ladder = &json(&fspid(&words, folder.path()))["ladder"];
    assert!(ladder[0]["why_none"].is_string() && ladder[0]["reached"].is_null(), "{ladder}");
    let reached = ladder[1]["reached_travel_deg"].as_f64().expect("flown");
    assert!(ladder[1]["proved"].is_f64() && reached <= 20.0 * (1.0 + 1e-6), "{ladder}");
}

#[test]
fn simulate_tells_the_shares_on_request() {
    let folder = folder();
    let output = fspid(&["simulate", "pitch.toml", "--limit"], folder.path());
    assert!(text(&output.stdout).contains("of what is possible"), "{}", text(&output.stderr));
    let output = fspid(&["simulate", "pitch.toml", "--limit", "--format", "json"], folder.path());
    assert!(json(&output)["limit"]["controllers"][0]["of_possible_pct"].is_f64());
    let words = ["simulate", "pitch.toml", "--limit", "--report", "page.html"];
    fspid(&words, folder.path());
    let page = std::fs::read_to_string(folder.path().join("page.html")).expect("a report");
    assert!(page.contains("What is possible") && page.contains("of what is possible"), "{page}");
}

#[test]
fn a_tuning_tells_how_near_each_design_comes_to_the_limit_in_the_flights_it_is_tuned_on() {
    let folder = folder();
    assert_eq!(code(&fspid(&["init", "--template", "contest", "c.toml"], folder.path())), 0);
    let tune = |beside: &[&str]| {
        let mut words = vec!["tune", "c.toml", "--budget", "12", "--quiet", "--limit"];
        words.extend(["--set", "loop.sample_period_s=0.05"]);
        words.extend(beside);
        let output = fspid(&words, folder.path());
        assert_ne!(code(&output), 2, "{}", text(&output.stderr));
        output
    };
    let told = text(&tune(&["--all"]).stdout);
    assert!(told.contains("of what is possible [%]"), "{told}");
    let one = json(&tune(&["--controller", "PID", "--format", "json"]));
    let limit = &one["limit"]["controllers"][0];
    assert_eq!(limit["name"], "PID");
    let each = limit["by_case_pct"].as_array().expect("one for each flight");
    assert!(!each.is_empty());
    for share in each {
        let share = share.as_f64().expect("a share");
        assert!((1.0..=100.0).contains(&share), "{one}");
    }
}

/// A small contest of the template, with these words beside.
fn contest<'a>(budget: &'a str, seeds: &'a str, out: &'a str, beside: &[&'a str]) -> Vec<&'a str> {
    let mut words = vec!["contest", "c.toml", "--budget", budget, "--seeds", seeds, "--quiet"];
    words.extend(["--out", out, "--set", "loop.sample_period_s=0.05", "--format", "json"]);
    words.extend(beside);
    words
}

fn folder_with_contest() -> tempfile::TempDir {
    let folder = folder();
    assert_eq!(code(&fspid(&["init", "--template", "contest", "c.toml"], folder.path())), 0);
    folder
}

#[test]
fn a_contest_tells_how_near_its_designs_come() {
    let folder = folder_with_contest();
    let output = fspid(&contest("4", "1", "who", &["--limit"]), folder.path());
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let limit = &json(&output)["limit"];
    assert!(limit["cases_of_mean"].as_u64().is_some_and(|count| count > 0), "{limit}");
    for it in limit["controllers"].as_array().expect("a list") {
        let share = it["of_possible_pct"].as_f64().expect("a number");
        assert!(share > 0.0 && share <= 100.0, "{it}");
    }
    assert!(folder.path().join("who/limit.json").is_file());
}

#[test]
fn a_front_holds_a_contest_at_every_effort_and_tells_of_all() {
    let folder = folder_with_contest();
    let words = contest("6", "2", "front", &["--front", "travel=12,24"]);
    let output = fspid(&words, folder.path());
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let answer = json(&output);
    assert_eq!(answer["rungs"].as_array().expect("a list").len(), 2);
    assert!(answer["fronts"][0]["standing"].is_string(), "{answer}");
    for file in ["front.html", "front.json", "travel-12-deg/contest.html", "travel-24-deg/designs"]
    {
        assert!(folder.path().join("front").join(file).exists(), "{file}");
    }
    // The same command goes on from there, and tells the same.
    let again = fspid(&words, folder.path());
    assert_eq!(text(&again.stdout), text(&output.stdout));
    for wrong in ["height", "travel=12", "travel=12,-1", "travel=a,b"] {
        let words = ["contest", "c.toml", "--front", wrong, "--out", "wrong"];
        let output = fspid(&words, folder.path());
        assert_eq!(code(&output), 2, "{wrong}");
        assert!(text(&output.stderr).contains("a front is `travel`"), "{wrong}");
    }
}

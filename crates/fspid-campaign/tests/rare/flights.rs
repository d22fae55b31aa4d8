//! Flights whose probability of failure is known.

use std::path::Path;

use fspid_campaign::rare::{Method, Question, Rare, rare};
use fspid_campaign::sample::Sampling;
use fspid_campaign::{Campaign, CampaignError, Folder, Progress, Shards, local, plan};
use fspid_scenario::dispersion::standard_normal::above;

/// The largest error of a step is its size, which is drawn: the error before anything has moved.
const STEP: &str = r#"
schema = 1
name = "a step of a size that is drawn"
[plant]
preset = "b747-paper"
[loop]
sample_period_s = 0.01
duration_s = 0.1
[setpoint]
kind = "step"
amplitude_deg = 1.0
[[controller]]
name = "PID"
kind = "pid"
kp = 2.0
ki = 0.5
kd = 1.0
[[requirement]]
measure = "largest_error_deg"
most = 1.35
[[requirement]]
measure = "gain_margin_db"
least = 6.0
[[dispersion]]
path = "setpoint.amplitude_deg"
distribution = "normal"
mean = 1.0
standard_deviation = 0.1
[[dispersion]]
path = "controller[0].kp"
distribution = "uniform"
lower = 1.9
upper = 2.1
"#;

/// Three and a half standard deviations: 2.33e-4.
const DEVIATIONS: f64 = 3.5;

fn campaign(text: &str) -> Campaign {
    let folder = tempfile::tempdir().expect("a folder");
    let scenario = folder.path().join("step.toml");
    std::fs::write(&scenario, text).expect("written");
    let question = fspid_campaign::Question {
        scenario: &scenario,
        overrides: &[],
        runs: 1,
        seed: 1,
        sampling: Sampling::Random,
        shards: Shards::ForThreads,
    };
    plan(&question, &Folder::new(Path::new("."))).unwrap_or_else(|error| panic!("{error}"))
}

fn question(method: Method, flights: u64) -> Question {
    Question {
        fails: "largest_error_deg".to_owned(),
        controller: None,
        method,
        flights,
        seed: 1,
        most: None,
    }
}

fn asked(text: &str, question: &Question) -> Result<Rare, CampaignError> {
    let campaign = campaign(text);
    let progress = Progress::default();
    local::in_threads(2, || rare(&campaign, question, None, &progress)).expect("threads")
}

#[test]
fn a_flight_whose_probability_is_known_is_answered_by_both_methods() {
    let found = asked(STEP, &question(Method::Both, 8000)).expect("answered");
    let exact = above(DEVIATIONS);
    for (method, known) in found.known() {
        let fspid_campaign::rare::Known::Within(interval) = known else {
            panic!("{method:?} {known:?}")
        };
        // Twice the stated interval: the seed is one of many.
        let (low, high) = (interval.low * interval.low, interval.high * interval.high);
        let centre = interval.estimate;
        assert!(low / centre < exact && exact < high / centre, "{method:?} {interval:?}");
    }
    assert_eq!(found.agree(), Some(true));
    let likeliest = found.likeliest.as_ref().expect("a failure");
    // Nothing fails within three and a half standard deviations, and the likeliest is hardly beyond.
    assert!((3.5..3.9).contains(&likeliest.distance.expect("numbers are drawn")), "{likeliest:?}");
    assert!(likeliest.changes[0].starts_with("setpoint.amplitude_deg=1.3"), "{likeliest:?}");
    assert!(likeliest.command.contains("--set setpoint.amplitude_deg=1.3"));
    let plain = found.plain_flights().expect("an interval");
    assert!(plain > 2.0 * found.flights() as f64, "{plain}");
}

#[test]
fn what_cannot_be_asked_is_refused_by_name() {
    let refused = |text: &str, fails: &str, controller: Option<&str>| {
        let question = Question {
            fails: fails.to_owned(),
            controller: controller.map(str::to_owned),
            ..question(Method::Subset, 2000)
        };
        asked(text, &question).expect_err("refused").to_string()
    };
    let told = refused(STEP, "largest_eror_deg", None);
    assert!(told.contains("no requirement `largest_eror_deg`"), "{told}");
    assert!(told.contains("largest_error_deg") && !told.contains("gain_margin_db"), "{told}");
    let told = refused(STEP, "gain_margin_db", None);
    assert!(told.contains("of the linear loop and not of a flight"), "{told}");
    let told = refused(STEP, "largest_error_deg", Some("nobody"));
    assert!(told.contains("no controller `nobody`") && told.contains("PID"), "{told}");
    let none: String = STEP.split("[[requirement]]").next().unwrap_or_default().to_owned()
        + "[[dispersion]]\npath = \"setpoint.amplitude_deg\"\ndistribution = \"uniform\"\nlower = 0.9\nupper = 1.1\n";
    let told = refused(&none, "overshoot_pct", None);
    assert!(told.contains("the scenario has no requirement"), "{told}");
    let few = asked(STEP, &question(Method::Subset, 10)).expect_err("refused").to_string();
    assert!(few.contains("allowed is a whole number from 1000"), "{few}");
}

/// One in ten thousand steps is of 2 deg, and fails. The climb went up with the others, to "at most 1e-12".
#[test]
fn a_value_that_is_hardly_ever_chosen_counts_as_if_it_always_failed() {
    let drawn = "distribution = \"normal\"\nmean = 1.0\nstandard_deviation = 0.1";
    let of = |weights: &str| {
        let choice = format!("distribution = \"choice\"\nvalues = [1.0, 2.0]\nweights = {weights}");
        let text = STEP.replace(drawn, &choice);
        assert_ne!(text, STEP);
        asked(&text, &question(Method::Subset, 4000)).expect("answered")
    };
    let hardly = of("[9999, 1]");
    assert!((hardly.hardly_flown.share - 1e-4).abs() < 1e-15 && hardly.at_most() >= 1e-4);
    assert!(hardly.notes().iter().any(|note| note.contains("met too seldom")), "{hardly:?}");
    // What is met often enough is counted, and a value without weight is none.
    let often = of("[9, 1]");
    assert!(
        often.hardly_flown.share.abs() < 1e-18 && often.interval().is_some_and(|it| it.low < 0.1)
    );
    assert!(often.interval().is_some_and(|it| it.high > 0.1 && it.high < 0.2), "{often:?}");
    assert!(of("[1, 0]").hardly_flown.share.abs() < 1e-18);
}

/// Of 8000 flights of importance sampling alone a tenth or so is drawn as flights are, and all were taken for that: "at most
/// 3.8e-6" of 6e-4.
#[test]
fn a_value_that_importance_sampling_hardly_meets_counts_as_if_it_always_failed() {
    let drawn = "distribution = \"normal\"\nmean = 1.0\nstandard_deviation = 0.1";
    let choice = "distribution = \"choice\"\nvalues = [1.0, 2.0]\nweights = [997, 3]";
    let text = STEP.replace(drawn, choice);
    assert_ne!(text, STEP);
    let found = asked(&text, &question(Method::Importance, 8000)).expect("answered");
    assert!((found.hardly_flown.share - 0.003).abs() < 1e-15 && found.at_most() >= 0.003);
}

/// Two choices that are harmless each, and unstable together: 9e-4 of all flights. Each comes often enough, and "at most 1e-12"
/// was told of both.
const TOGETHER: &str = r#"
schema = 1
name = "two choices that fail together"
[plant]
numerator = [1.15101, 0.17742]
denominator = [1.0, 0.739, 0.921468, 0.0]
elevator_sign = "nose-up-positive"
[actuator]
time_constant_s = 0.1
delay_samples = 1
[loop]
sample_period_s = 0.1
duration_s = 3.0
[setpoint]
kind = "step"
amplitude_deg = 1.0
at_s = 0.0
[[controller]]
name = "PID"
kind = "pid"
kp = 1.0
ki = 0.3
kd = 0.5
[[requirement]]
measure = "largest_error_deg"
most = 3.0
[[dispersion]]
path = "setpoint.amplitude_deg"
distribution = "normal"
mean = 1.0
standard_deviation = 0.2
[[dispersion]]
path = "controller[0].kp"
distribution = "choice"
values = [1.0, 3.0]
weights = [0.97, 0.03]
[[dispersion]]
path = "actuator.delay_samples"
distribution = "choice"
values = [1, 6]
weights = [0.97, 0.03]
"#;

#[test]
fn values_that_come_often_and_hardly_ever_together_count_as_if_they_always_failed() {
    let asked_for = |flights| Question { most: Some(1e-4), ..question(Method::Subset, flights) };
    let found = asked(TOGETHER, &asked_for(2000)).expect("answered");
    assert!((found.hardly_flown.share - 9e-4).abs() < 1e-15, "{:?}", found.hardly_flown);
    assert_eq!(found.hardly_flown.likeliest, ["controller[0].kp=3.0", "actuator.delay_samples=6"]);
    assert!(found.at_most() >= 9e-4 && found.is_allowed() == Some(false), "{}", found.text());
    let told = "The likeliest of them is controller[0].kp=3.0, actuator.delay_samples=6.";
    assert!(found.text().contains(told) && found.text().contains(": NOT MET."), "{}", found.text());
}

/// A load that the command does not hold within its limit: every flight is undecided at rest, and was "MET".
#[test]
fn what_nobody_can_tell_to_be_stable_is_counted_and_never_met() {
    let text = r#"
schema = 1
name = "undecided"
[plant]
preset = "navion-paper"
[loop]
sample_period_s = 0.05
duration_s = 1.0
[setpoint]
kind = "step"
amplitude_deg = 1.0
[[disturbance]]
kind = "step"
enters_at = "servo"
amplitude_deg = 3.0
at_s = 0.0
[[controller]]
name = "PID"
kind = "pid"
kp = 1.0
ki = 0.5
kd = 0.2
output_limits_deg = [-2.5, 2.5]
[[requirement]]
measure = "largest_error_deg"
most = 30.0
[[dispersion]]
path = "setpoint.amplitude_deg"
distribution = "normal"
mean = 1.0
standard_deviation = 0.1
"#;
    let question = Question { most: Some(0.5), ..question(Method::Subset, 1000) };
    let campaign = campaign(text);
    let folder = tempfile::tempdir().expect("a folder");
    let folder = Folder::new(folder.path());
    let ask = || {
        let progress = Progress::default();
        let asked = || rare(&campaign, &question, Some(&folder), &progress);
        local::in_threads(2, asked).expect("threads").expect("answered")
    };
    let found = ask();
    assert_eq!(found.undecided, found.flights());
    assert!(found.at_most() < 0.5 && found.is_allowed() == Some(false), "{}", found.text());
    assert!(found.text().contains("UNDECIDED of 1") && !found.text().contains(": MET"));
    assert!(found.text().contains("NOT MET, for nobody can tell"), "{}", found.text());
    assert_eq!(found.json()["undecided"], found.flights());
    // What was flown before is counted as well.
    assert_eq!(ask().json(), found.json());
    // A limit that holds the load leaves nothing in doubt.
    let held = text.replace("[-2.5, 2.5]", "[-20.0, 20.0]");
    let held = asked(&held, &question).expect("answered");
    assert_eq!((held.undecided, held.is_allowed()), (0, Some(true)), "{}", held.text());
}

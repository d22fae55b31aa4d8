//! What a contest counts as evidence, and what keeps a smaller error from winning.

use fspid_tune::contest::{Outcome, Quantity};

use super::{LOOP, MARKED, TUNING, cases, pid, place};
use crate::problem::RUNS_AWAY;

/// Who holds it, and who behind a limit until it is lost.
const HOLDERS: &str = r#"[[controller]]
name = "A"
kind = "pid"
kp = 0.12
ki = 0.0
kd = 0.1
setpoint_weights = { proportional = 0.5833333 }
[[controller]]
name = "B"
kind = "pid"
kp = 0.8
ki = 0.0
kd = 0.5
setpoint_weights = { proportional = 0.9375, derivative = 0.0 }
output_limits_deg = [-0.49, 5.0]
[contest]
"#;

fn case(name: &str, set: &str) -> String {
    format!("\n[[contest.case]]\nname = \"{name}\"\nset = [{set}]\n")
}

/// "B wins, as these designs are written: 70 % less IAE, p = 0.0020", of flights that diverge after 297 s: who has one of which
/// nobody can tell whether it is stable does not win.
#[test]
fn who_flies_loops_of_which_nobody_can_tell_whether_they_are_stable_does_not_win() {
    let longer = |number: u32| {
        let (amplitude, duration) = (9.9 + 0.1 * f64::from(number), 20 + number);
        case(
            &format!("c{number}"),
            &format!("\"setpoint.amplitude_deg={amplitude:.1}\", \"loop.duration_s={duration}\""),
        )
    };
    let all: String = (0..10).map(longer).collect();
    let place = place(&format!("{RUNS_AWAY}{HOLDERS}{all}"));
    let outcome = place.held();
    let told = outcome.text();
    let first = "B is first, and nobody wins: 10 of its 10 flights are of loops of which nobody can tell whether they are stable";
    assert!(told.starts_with(first), "{told}");
    let answer = outcome.json();
    assert!(answer["verdict"]["winner"].is_null());
    let count = outcome.summaries[1].whole.count;
    assert_eq!((count.undecided, count.unstable, count.failed, count.of), (10, 0, 0, 10));
    assert_eq!(outcome.summaries[0].whole.count.undecided, 0);
    assert!(told.contains("not better, for nobody can tell whether it is stable"), "{told}");
    let page = std::fs::read_to_string(place.out().join("contest.html")).expect("a page");
    assert!(told.contains("the first of which is \"c0\", says why"), "{told}");
    assert!(page.contains("undecided") && page.contains("nobody can tell whether"));
}

/// Twelve sizes of the step of a loop without limits were twelve cases: "B wins: 1.6 % less IAE (95 %: 1.6 to 1.6 % less)".
#[test]
fn one_flight_of_a_linear_loop_in_twelve_sizes_is_one_case() {
    let linear = LOOP.replace("position_limit_deg = 20.0\nrate_limit_deg_s = 60.0\n", "");
    let sizes: String = (1..13)
        .map(|size| case(&format!("{size} deg"), &format!("\"setpoint.amplitude_deg={size}\"")))
        .collect();
    let two = [
        pid("slack", "kp = 0.2\nki = 0.1\nkd = 0.05"),
        pid("good", "kp = 0.8\nki = 0.4\nkd = 0.16"),
    ]
    .concat();
    let held = |servo: &str| place(&format!("{servo}{two}\n[contest]\n{sizes}")).held();
    let outcome = held(&linear);
    let found = outcome.comparison(1).expect("a comparison");
    assert_eq!((found.evidence, found.is_sure), (1, false));
    assert!(outcome.json()["verdict"]["winner"].is_null(), "{}", outcome.text());
    // Where limits are met, each size is a flight of its own.
    let limited = held(&LOOP.replace("position_limit_deg = 20.0", "position_limit_deg = 0.4"));
    assert!(limited.comparison(1).is_some_and(|it| it.evidence == 12), "{}", limited.text());
}

/// "32 % less IAE (95 %: 32 to 32 % less), p = 0.0005" of one flight that goes on for 61 to 72 s: its RMS error alone is another.
#[test]
fn one_flight_that_only_goes_on_longer_is_one_case() {
    // Of a phugoid something would be left.
    let linear = LOOP
        .replace("position_limit_deg = 20.0\nrate_limit_deg_s = 60.0\n", "")
        .replace("navion-full", "navion-paper");
    let lengths: String = (0..12)
        .map(|number| {
            let (at, duration) = (1.0 + 0.5 * f64::from(number), 150 + number);
            case(
                &format!("{duration} s"),
                // A limit that no flight meets: without it the cases are refused as copies.
                &format!(
                    "\"setpoint.at_s={at:?}\", \"loop.duration_s={duration}\", \"actuator.position_limit_deg={}\"",
                    60 + number
                ),
            )
        })
        .collect();
    let two = [
        pid("slack", "kp = 0.4\nki = 0.2\nkd = 0.1"),
        pid("good", "kp = 0.8\nki = 0.4\nkd = 0.16"),
    ]
    .concat();
    let outcome = place(&format!("{linear}{two}\n[contest]\n{lengths}")).held();
    let found = outcome.comparison(1).expect("a comparison");
    assert_eq!((found.evidence, found.is_sure), (1, false), "{}", outcome.text());
}

/// Who is linear was tuned on a step of 5 deg when it is judged on one of 6; beside a self-tuner, which flies each size otherwise,
/// it is a case.
#[test]
fn another_size_of_what_everybody_was_tuned_on_is_no_evidence() {
    let linear = LOOP.replace("position_limit_deg = 20.0\nrate_limit_deg_s = 60.0\n", "");
    let judged = case("6 deg", "\"setpoint.amplitude_deg=6\"")
        + &case("slow", "\"actuator.time_constant_s=0.08\"");
    let contest = format!("\n[contest]\nseeds = 2\n{judged}");
    let evidence = |controllers: &str| {
        let outcome = place(&format!("{linear}{controllers}{TUNING}{contest}")).held();
        (outcome.comparison(1).expect("a comparison").evidence, outcome.text())
    };
    let (both_linear, told) = evidence(MARKED);
    assert_eq!(both_linear, 1, "{told}");
    assert!(told.contains("\"6 deg\" as \"as written\" of the tuning"), "{told}");
    let tuner = "\n[[controller]]\nname = \"self-tuner\"\nkind = \"fspid\"\nnominal = { kp = { tune = [0.1, 3.0], scale = \"log\", start = 0.8 }, ki = 0.4, kd = 0.16 }\nsupervisor = { table = \"mirrored\", range = 5.0, error_scale = 1.0, output_scale = { kp = 0.02, ki = 0.01, kd = 0.0 } }\n";
    let own = MARKED.split("\n[[controller]]\nname = \"P\"").next().expect("the first");
    assert_eq!(evidence(&format!("{own}{tuner}")).0, 2);
}

/// All cases flew the same few aircraft, which were those of the tuning as well: of 30 contests with two draws each, 23 had a
/// winner, 4 of them the one that is worse over all draws.
#[test]
fn each_case_draws_its_own_aircraft_and_none_of_the_tuning() {
    let drawn = "\n[[dispersion]]\npath = \"actuator.time_constant_s\"\ndistribution = \"uniform\"\nlower = 0.03\nupper = 0.2\n";
    let two = case("one", "\"setpoint.amplitude_deg=4\"")
        + &case("other", "\"setpoint.amplitude_deg=4\", \"loop.duration_s=8.02\"")
        + &case("tuned", "\"setpoint.amplitude_deg=5\", \"loop.duration_s=8.04\"");
    // A mirror image flies the aircraft of what it mirrors.
    let two = two
        + &case("down", "\"setpoint.amplitude_deg=-4\"")
            .replace("set =", "mirror_of = \"one\"\nset =");
    let tuning = TUNING.replace("seed = 3", "seed = 3\nruns = 2");
    let text = format!("{LOOP}{MARKED}{tuning}{drawn}\n[contest]\nseeds = 2\nruns = 2\n{two}");
    let outcome = place(&text).held();
    let errors = |outcome: &Outcome, case: usize| {
        let design = &outcome.judged.contestants[0].designs[0];
        let flights = outcome.judged.flights(design, case);
        flights.iter().map(|it| it.measures[0].expect("flown")).collect::<Vec<f64>>()
    };
    let [one, other] = [0, 1].map(|case| errors(&outcome, case));
    for (mine, theirs) in one.iter().zip(&other) {
        assert!((mine / theirs - 1.0).abs() > 1e-3, "{one:?} {other:?}");
    }
    assert_eq!(outcome.comparison(1).map(|it| it.evidence), Some(3));
    for (up, down) in one.iter().zip(errors(&outcome, 3)) {
        assert!((up / down - 1.0).abs() < 1e-9, "{one:?}");
    }
    // A campaign draws the same aircraft of the seed that is told.
    let cases = &outcome.json()["cases"];
    let told = cases[0]["draws_seed"].as_u64().expect("a seed");
    assert!(told < 1 << 53 && cases[1]["draws_seed"].as_u64().is_some_and(|it| it != told));
    // Another seed draws others.
    let again = text.replace("runs = 2\n\n[[contest", "runs = 2\nrun_seed = 2\n\n[[contest");
    assert_ne!(errors(&place(&again).held(), 0), one);
}

#[test]
fn an_unstable_loop_that_does_not_diverge_is_judged_as_it_flew_and_failed() {
    let oscillating =
        "\n[[contest.case]]\nname = \"late\"\nset = [\"actuator.delay_samples=40\"]\n";
    let text = format!(
        "{LOOP}{}{}{}",
        pid("calm", "kp = 0.2\nki = 0.1\nkd = 0.05"),
        pid("brisk", "kp = 0.8\nki = 0.4\nkd = 0.16"),
        cases(oscillating)
    );
    let outcome = place(&text).held();
    let count = outcome.summaries[1].whole.count;
    assert_eq!((count.lost, count.unstable), (0, 1));
    assert!(count.failed >= 1, "{count:?}");
    let late = outcome.summaries[1].cases[8].spread(Quantity::ERROR).expect("an error");
    assert!(late.median.is_finite());
}

#[test]
fn a_self_tuner_that_is_unstable_at_rest_fails_though_its_case_asks_nothing_of_it() {
    let gains = "nominal = { kp = 5.9, ki = 0.43, kd = 0.0 }\nlaw = \"memoryless\"\nsupervisor = { table = \"mirrored\", range = 5.0, output_scale = { kp = 0.0, ki = 0.0, kd = 0.0 } }";
    let still = format!("\n[[controller]]\nname = \"still\"\nkind = \"fspid\"\n{gains}\n");
    let asked = |words: &str| {
        let requirement =
            format!("\n[[requirement]]\nmeasure = \"sensitivity_peak\"\nmost = 5.0\n{words}\n");
        let fixed = pid("fixed", "kp = 5.9\nki = 0.43\nkd = 0.0");
        let text = format!("{LOOP}{fixed}{still}{requirement}{}", cases(""));
        let outcome = place(&text).held();
        [0, 1].map(|place| outcome.summaries[place].whole.count)
    };
    let [fixed, tuned] = asked("");
    assert!(fixed.unstable > 0 && fixed.lost < fixed.of, "{fixed:?}");
    assert_eq!((tuned.unstable, tuned.failed), (fixed.unstable, fixed.failed));
    let [fixed, tuned] = asked("not_in = [\"commands\", \"plants\"]");
    assert_eq!((tuned.unstable, tuned.failed), (fixed.unstable, fixed.failed));
    assert!(tuned.failed > 0);
}

/// "A wins" of 4.8 deg of travel in the mean, where at most 2 deg were allowed and the other took 2.2: none of its tunings had found
/// anything that was.
#[test]
fn who_found_nothing_that_was_allowed_does_not_win() {
    let plant = "[plant]\nnumerator = [11.2, 20.0]\ndenominator = [1.0, 5.05, 13.2, 0.0]\nelevator_sign = \"nose-up-positive\"\n[actuator]\ntime_constant_s = 0.1\n[loop]\nsample_period_s = 0.05\nduration_s = 8.0\n[setpoint]\nkind = \"step\"\namplitude_deg = 2.0\nat_s = 0.5\n";
    let pid = |name: &str, least: f64, start: f64| {
        format!(
            "[[controller]]\nname = \"{name}\"\nkind = \"pid\"\nkp = {{ tune = [{least}, 5.0], scale = \"log\", start = {start} }}\nki = 0.1\nkd = 0.02\nderivative_filter_s = 0.1\n"
        )
    };
    let tuning = "[tuning]\nbudget = 20\nseed = 6\n[[tuning.objective]]\nmeasure = \"iae_deg_s\"\n[[tuning.limit]]\nmeasure = \"elevator_travel_deg\"\nmost = 2.0\n[[tuning.case]]\nname = \"as written\"\nset = []\n[contest]\nseeds = 3\n";
    let all: String = (0..9)
        .map(|k| {
            let [gain, stiffness] = [8.0 + f64::from(k), 16.0 - 0.7 * f64::from(k)];
            case(
                &format!("c{k}"),
                &format!(
                    "\"plant.numerator[0]={gain:.1}\", \"plant.denominator[2]={stiffness:.1}\""
                ),
            )
        })
        .collect();
    let held = |least_of_a: f64| {
        let two = [pid("A", least_of_a, 1.5), pid("B", 0.05, 0.3)].concat();
        place(&format!("schema = 1\nname = \"allowed\"\n{plant}{two}{tuning}{all}")).held()
    };
    let outcome = held(1.2);
    let told = outcome.text();
    let first = "A is first, and nobody wins: 3 of its 3 tunings found nothing that was allowed";
    assert!(told.starts_with(first), "{told}");
    assert!(outcome.json()["verdict"]["winner"].is_null());
    assert!(told.contains("not worse, for the tunings of what it is compared with found nothing"));
    assert!(told.contains("kept to every limit and requirement"), "{told}");
    // With room to keep to it both do.
    let both = held(0.05);
    assert!(both.judged.contestants.iter().all(|it| it.not_allowed() == [0, 3]), "{}", both.text());
}

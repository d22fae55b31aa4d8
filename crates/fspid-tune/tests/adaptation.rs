//! Whether a self-tuner adapts: what the experiment must say where the truth is known.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use std::path::PathBuf;

use fspid_tune::adaptation::{Adaptation, Answer, Options, Treatment, Watch, uncounted};
use fspid_tune::{Source, TuneError};
use rayon::ThreadPoolBuilder;

/// Plants of different effectiveness under the same steps, up and down and of two sizes; `tuner` is the rest of the
/// self-tuner, `cases` what each plant changes beside its plant.
fn scenario(tuner: &str, of_plant: impl Fn(usize) -> String) -> String {
    scenario_of(6, tuner, |plant, _| of_plant(plant))
}

/// The same of so many plants over the same range of effectiveness, by which what each changes may go.
fn scenario_of(plants: usize, tuner: &str, of_plant: impl Fn(usize, f64) -> String) -> String {
    let mut text = format!(
        r#"schema = 1
name = "plants"

[plant]
numerator = [4.0, 4.0]
denominator = [1.0, 2.0, 6.0, 0.5]
elevator_sign = "nose-up-positive"

[actuator]
time_constant_s = 0.1
position_limit_deg = 20.0

[loop]
sample_period_s = 0.02
duration_s = 8.0

[setpoint]
kind = "step"
amplitude_deg = 3.0
at_s = 1.0

[[controller]]
name = "PID"
kind = "pid"
kp = 1.0
ki = 0.8
kd = 0.3

[[controller]]
name = "FSPID"
kind = "fspid"
nominal = {{ kp = 1.0, ki = 0.8, kd = 0.3 }}
{tuner}

[tuning]
budget = 1

[[tuning.objective]]
measure = "iae_deg_s"

[contest]
against = "PID"
seeds = 1
"#
    );
    for plant in 0..plants {
        let factor = libm::pow(1.4, 5.0 * plant as f64 / (plants - 1) as f64);
        let effectiveness = 2.0 * factor;
        for amplitude in [3.0, -1.0] {
            text.push_str(&format!(
                "\n[[contest.case]]\nname = \"{plant}, {amplitude} deg\"\ngroup = \"all\"\nset = [\"plant.numerator=[{effectiveness}, {effectiveness}]\", \"setpoint.amplitude_deg={amplitude}\"{}]\n",
                of_plant(plant, factor)
            ));
        }
    }
    text
}

const RULES: &str = r#"supervisor = { table = "mirrored", range = 5.0, error_scale = 1.0, change_scale = 0.2, output_scale = { kp = 0.1, ki = 0.05, kd = 0.02 } }"#;
const NO_RULES: &str = r#"supervisor = { table = "mirrored", range = 5.0, output_scale = { kp = 0.0, ki = 0.0, kd = 0.0 } }"#;

fn measured_on(text: &str, threads: usize, budget: usize) -> Result<Answer, TuneError> {
    let folder = tempfile::tempdir().expect("a folder");
    let path: PathBuf = folder.path().join("plants.toml");
    std::fs::write(&path, text).expect("written");
    let source = Source { path, overrides: Vec::new() };
    let options = Options { seeds: 2, budget, ..Options::default() };
    let asked = Adaptation::new(&source, &options)?;
    let flown = uncounted();
    let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| asked.measured(Watch { stops: &|| false, flown: &flown }))
}

fn measured(text: &str) -> Answer {
    measured_on(text, 2, 24).expect("an answer")
}

fn row(answer: &Answer, treatment: Treatment) -> f64 {
    let row = answer.rows.iter().find(|row| row.treatment == treatment).expect("it flew");
    row.iae.expect("a mean").value
}

#[test]
fn a_supervisor_that_says_nothing_explains_nothing_whatever_is_done_to_it() {
    let answer = measured(&scenario(NO_RULES, |_| String::new()));
    assert_eq!((answer.flights, answer.kept, answer.plants.len()), (12, 12, 6));
    for treatment in Treatment::ALL {
        if treatment == Treatment::PlantTuned {
            // Frozen gains of its own plant are no worse than the nominal ones.
            assert!(row(&answer, treatment) < 0.999, "{:?}", row(&answer, treatment));
        } else {
            // The PID has the same numbers; means are off by rounding.
            assert!((row(&answer, treatment) - 1.0).abs() < 1e-12, "{treatment:?}");
        }
    }
    assert!(answer.moved.iter().all(|it| it.deviation < 1e-12), "{:?}", answer.moved);
    assert!(answer.text().contains("kp: it does not move from 1"), "{}", answer.text());
    assert!(answer.steps.iter().all(|it| it.share.is_none_or(|share| share.value.abs() < 1e6)));
    assert!(answer.headline().contains("not shown to help"), "{}", answer.headline());
    // Nothing is won: what there is is a difference.
    for told in [answer.text(), answer.page()] {
        assert!(told.contains("What the difference is made of"), "{told}");
        assert!(told.contains("share of the difference") && !told.contains("he win is made of"));
    }
}

#[test]
fn steps_add_up_to_the_win_and_shares_to_one() {
    let answer = measured(&scenario(RULES, |_| String::new()));
    let whole = answer.win.expect("a win or a loss").value;
    let product: f64 = answer.steps.iter().map(|it| it.iae.expect("a ratio").value).product();
    assert!((product / whole - 1.0).abs() < 1e-12, "{product} {whole}");
    // The nominal gains are the PID's, so that nothing comes of them.
    assert!((answer.steps[0].iae.expect("a ratio").value - 1.0).abs() < 1e-12);
    if whole < 1.0 {
        let shares: f64 = answer.steps.iter().map(|it| it.share.expect("a share").value).sum();
        assert!((shares - 1.0).abs() < 1e-9, "{shares}");
    }
    // Nobody who shuffles time knows the moment.
    assert!((row(&answer, Treatment::Against) * whole - 1.0).abs() < 1e-12);
    for moved in &answer.moved {
        let parts = [moved.between_plants, moved.between_flights, moved.within_flights];
        let sum: f64 = parts.iter().map(|it| it.expect("it moves").value).sum();
        assert!((sum - 1.0).abs() < 1e-9, "{moved:?}");
    }
}

/// Plants were drawn anew as if they did not meet in the means of others: of "answers to the moment" 63 to 67 % of the
/// intervals of 95 % held the truth, at 5, 10 and 20 plants alike.
#[test]
fn intervals_are_of_what_leaving_a_plant_out_of_the_scenario_changes() {
    /// Student's distribution with 5 degrees of freedom, 2.5 % beyond on either side.
    const STUDENT: f64 = 2.570_581_835_636_314;
    const PLANTS: usize = 6;
    let text = scenario(RULES, |_| String::new());
    let steps = |text: &str| measured_on(text, 2, 1).expect("an answer").steps;
    let left = (0..PLANTS).map(|plant| {
        let own = format!("\nname = \"{plant}, ");
        let parts = text.split("\n[[contest.case]]").filter(|part| !part.starts_with(&own));
        steps(&parts.collect::<Vec<_>>().join("\n[[contest.case]]"))
    });
    let left: Vec<_> = left.collect();
    for (place, step) in steps(&text).iter().enumerate() {
        let found = step.iae.expect("a ratio").map(libm::log);
        let without: Vec<f64> =
            left.iter().map(|it| libm::log(it[place].iae.expect("a ratio").value)).collect();
        let mean = without.iter().sum::<f64>() / PLANTS as f64;
        let squares: f64 = without.iter().map(|it| (it - mean) * (it - mean)).sum();
        let far = STUDENT * libm::sqrt(squares * (PLANTS - 1) as f64 / PLANTS as f64);
        let [lower, upper] = found.interval.expect("enough plants");
        assert!((lower - (found.value - far)).abs() < 1e-9, "{step:?} {far}");
        assert!((upper - (found.value + far)).abs() < 1e-9, "{step:?} {far}");
    }
}

/// Gains that are written for each plant are whole adaptation, and nothing else is in the win.
#[test]
fn gains_that_know_the_plant_are_found_to_be_adaptation() {
    let of_plant = |_: usize, factor: f64| {
        let [kp, ki, kd] = [2.4, 2.0, 0.6].map(|gain| gain / factor);
        // With so much delay a gain that is right on one plant is too much, or too little, on another.
        format!(
            ", \"actuator.delay_samples=8\", \"controller.FSPID.nominal={{kp={kp}, ki={ki}, kd={kd}}}\""
        )
    };
    let answer = measured(&scenario_of(16, NO_RULES, of_plant));
    let step = |treatment| {
        let step = answer.steps.iter().find(|it| it.treatment == treatment).expect("a step");
        step.iae.expect("a ratio")
    };
    let plant = step(Treatment::AsItIs);
    assert!(
        plant.value < 0.95 && plant.interval.is_some_and(|[_, upper]| upper < 1.0),
        "{plant:?}"
    );
    for it in &answer.following {
        let followed = it.effectiveness.expect("it follows");
        assert!((followed.slope.value + 1.0).abs() < 1e-9, "{followed:?}");
        assert!((followed.correlation.value + 1.0).abs() < 1e-9, "{followed:?}");
    }
    for moved in &answer.moved {
        assert!(moved.between_plants.is_some_and(|it| it.value > 1.0 - 1e-9), "{moved:?}");
    }
    assert!(answer.headline().contains("adapts to its plant;"), "{}", answer.headline());
}

#[test]
fn threads_do_not_show_and_the_best_gains_take_no_more_travel() {
    let text = scenario(RULES, |_| String::new());
    let [one, three] = [1, 3].map(|threads| measured_on(&text, threads, 24).expect("an answer"));
    assert_eq!(one.json(), three.json());
    assert_eq!((one.text(), one.page()), (three.text(), three.page()));
    let best = one.rows.iter().find(|row| row.treatment == Treatment::PlantTuned).expect("flown");
    // On each plant the sum of the travel is bounded; the mean of ratios may be a little above.
    assert!(best.travel.is_some_and(|it| it.value < 1.05) && best.lost == 0, "{best:?}");
}

/// With a limit on one side alone every candidate was infinite, and none was told.
#[test]
fn gains_with_a_limit_on_one_side_are_searched_for() {
    let limits = "gain_limits = { kp_min = 0.0, ki_min = 0.0, kd_min = 0.0 }";
    let answer = measured(&scenario(&format!("{RULES}\n{limits}"), |_| String::new()));
    let best = row(&answer, Treatment::PlantTuned);
    assert!(best < 1.05 && best > 0.3, "{best}");
}

#[test]
fn what_cannot_be_asked_is_refused_by_name() {
    let fixed = scenario(RULES, |_| String::new()).replace("kind = \"fspid\"", "kind = \"pid\"");
    let only_pid: Vec<&str> = fixed.split("[[controller]]").collect();
    let head = only_pid[0];
    let pid = format!("{head}[[controller]]{}", only_pid[1]);
    let error = measured_on(&pid, 1, 8).expect_err("there is no self-tuner").to_string();
    assert!(error.contains("kind fspid, of which the scenario has none"), "{error}");
    let text = scenario(RULES, |_| String::new());
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("plants.toml");
    std::fs::write(&path, text).expect("written");
    let source = Source { path, overrides: Vec::new() };
    let options = Options { against: Some("PIDD".to_owned()), ..Options::default() };
    let error = Adaptation::new(&source, &options).expect_err("no such").to_string();
    assert!(error.contains("PIDD") && error.contains("PID"), "{error}");
    let options = Options { seeds: 0, ..Options::default() };
    assert!(Adaptation::new(&source, &options).is_err());
}

#[test]
fn one_plant_is_told_to_be_too_few() {
    let text = scenario(RULES, |_| String::new());
    let one = text.split("\n[[contest.case]]").next().expect("a head");
    let one = one.split("[contest]").next().expect("a head");
    let answer = measured(one);
    assert_eq!((answer.flights, answer.plants.len()), (1, 1));
    assert!(answer.headline().contains("nothing is said for certain"), "{}", answer.headline());
    assert!(answer.steps.iter().all(|it| it.treatment != Treatment::OtherPlants));
    assert!(answer.text().contains("its gains of each moment"), "{}", answer.text());
    assert!(!answer.text().contains("adaptation to the plant"), "{}", answer.text());
    assert!(answer.win.is_some_and(|it| it.interval.is_none()));
}

/// The scenario without its cases.
fn head() -> String {
    let text = scenario(RULES, |_| String::new());
    text.split("\n[[contest.case]]").next().expect("a head").to_owned()
}

/// A case of a plant by its effectiveness, with a limit of the elevator.
fn case(name: &str, effectiveness: f64, limit_deg: f64, amplitude_deg: f64) -> String {
    format!(
        "\n[[contest.case]]\nname = \"{name}\"\ngroup = \"all\"\nset = [\"plant.numerator=[{effectiveness}, {effectiveness}]\", \"actuator.position_limit_deg={limit_deg}\", \"setpoint.amplitude_deg={amplitude_deg}\"]\n"
    )
}

/// A limit that never acts made a plant of its own: one plant that was written six times "answers the moment, alike on every
/// plant", with intervals of no width.
#[test]
fn a_plant_that_is_written_six_times_is_one() {
    for is_alike in [true, false] {
        let amplitude = |number: f64| if is_alike { 3.0 } else { 1.0 + 0.25 * number };
        let cases = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]
            .map(|number| case(&format!("limit {number}"), 4.0, 200.0 + number, amplitude(number)));
        let answer = measured_on(&(head() + &cases.concat()), 2, 1).expect("an answer");
        assert_eq!((answer.flights, answer.plants.len()), (6, 1), "{}", answer.text());
        assert_eq!(answer.plants[0].written, 6);
        assert!(answer.headline().contains("here one is flown"), "{}", answer.headline());
        assert!(answer.win.is_some_and(|it| it.interval.is_none()), "{:?}", answer.win);
        let is_told = "The plant of \"limit 0\" is written in 6 ways, and is one";
        assert!(answer.text().contains(is_told), "{}", answer.text());
    }
}

#[test]
fn plants_that_fly_alike_in_most_flights_are_two_where_a_limit_acts_in_one() {
    let cases = [1.0, 2.0, 3.0].map(|amplitude| {
        // A step of 3 deg kicks the elevator by some 50.
        let limits = [200.0, 40.0, 190.0];
        limits.map(|limit| case(&format!("{limit}, {amplitude}"), 4.0, limit, amplitude)).concat()
    });
    let answer = measured_on(&(head() + &cases.concat()), 2, 1).expect("an answer");
    let written: Vec<usize> = answer.plants.iter().map(|it| it.written).collect();
    assert_eq!(written, [2, 1], "{}", answer.text());
}

/// Also the gains of the other plants are those of others.
#[test]
fn plants_that_are_written_three_times_say_what_they_say_when_written_once() {
    let plants = [2.0, 2.8, 3.9, 5.5, 7.7, 10.8];
    let of = |limits: &[f64]| {
        let mut text = head();
        for effectiveness in plants {
            for limit in limits {
                for amplitude in [3.0, -1.0] {
                    let name = format!("{effectiveness}, {limit}, {amplitude}");
                    text += &case(&name, effectiveness, *limit, amplitude);
                }
            }
        }
        measured_on(&text, 2, 1).expect("an answer")
    };
    let (once, thrice) = (of(&[200.0]), of(&[200.0, 210.0, 220.0]));
    assert_eq!((once.plants.len(), thrice.plants.len(), thrice.flights), (6, 6, 36));
    let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
    for (a, b) in once.steps.iter().zip(&thrice.steps) {
        let (a, b) = (a.iae.expect("a ratio"), b.iae.expect("a ratio"));
        let ([lower, upper], [others_lower, others_upper]) =
            (a.interval.expect("enough plants"), b.interval.expect("enough plants"));
        assert!(near(a.value, b.value), "{a:?} {b:?}");
        assert!(near(lower, others_lower) && near(upper, others_upper), "{a:?} {b:?}");
    }
}

/// Three plants that fly alike and seventeen with commands of their own were told as twenty: of intervals of 95 % of such
/// wins 68 % held the truth.
#[test]
fn plants_that_are_in_no_part_of_the_win_are_no_evidence_of_it() {
    let effectiveness = |number: usize| 2.0 * libm::pow(1.1, number as f64);
    let of = |alike: usize, alone: usize| {
        let mut text = head();
        for number in 0..alike + alone {
            let amplitude = if number < alike { 3.0 } else { 3.0 + 0.1 * number as f64 };
            text += &case(&format!("plant {number}"), effectiveness(number), 40.0, amplitude);
        }
        // One that nobody holds.
        text += &case("lost", -4.0, 40.0, 3.0);
        measured_on(&text, 2, 1).expect("an answer")
    };
    let few = of(3, 8);
    assert_eq!((few.flights, few.kept, few.plants.len(), few.plants_kept()), (12, 3, 12, 3));
    let headline = "5 plants or more, and of the 12 that fly here 3 are in the win.";
    assert!(few.headline().contains(headline), "{}", few.headline());
    assert!(few.win.is_some_and(|it| it.interval.is_none()), "{:?}", few.win);
    assert!(few.rows.iter().all(|it| it.iae.is_none_or(|it| it.interval.is_none())));
    assert!(few.detail().ends_with("3 flights of 3 plants."), "{}", few.detail());
    assert!(few.text().contains("9 of 12 plants are in no part of the win"), "{}", few.text());
    // What the gains do is of all plants that are flown: eleven, and not the one that is lost.
    let followed = few.following[0].effectiveness.expect("it follows");
    assert!(followed.slope.interval.is_some(), "{followed:?}");
    // Plants that are lost are none of those that there must be, and change no interval.
    let [enough, too_few] = [of(5, 0), of(4, 0)];
    let has_interval = |answer: &Answer| answer.win.is_some_and(|it| it.interval.is_some());
    assert!(has_interval(&enough) && !has_interval(&too_few), "{}", enough.text());
    assert!(too_few.headline().contains("nothing is said for certain"), "{}", too_few.headline());
}

/// One plant whose numbers differ in their ninth digit was six, with intervals of no width.
#[test]
fn plants_that_differ_in_their_ninth_digit_are_one() {
    let of = |apart: f64| {
        let cases = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0].map(|number| {
            case(&format!("plant {number}"), 4.0 * (1.0 + apart * number), 40.0, 3.0)
        });
        measured_on(&(head() + &cases.concat()), 2, 1).expect("an answer")
    };
    let near = of(1e-9);
    assert_eq!((near.flights, near.plants.len(), near.plants[0].written), (6, 1, 6));
    assert!(near.headline().contains("here one is flown"), "{}", near.headline());
    assert_eq!(of(1e-3).plants.len(), 6);
}

/// Six plants that integrate, and a self-tuner and a PID by their proportional gains.
fn integrating([of_pid, of_tuner]: [f64; 2], beside: &str) -> String {
    let mut text = format!(
        r#"schema = 1
name = "unstable"
[plant]
numerator = [1.15101, 0.17742]
denominator = [1.0, 0.739, 0.921468, 0.0]
elevator_sign = "nose-up-positive"
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.05
duration_s = 2.0
[setpoint]
kind = "step"
amplitude_deg = 5.0
at_s = 0.0
[[controller]]
name = "PID"
kind = "pid"
kp = {of_pid}
ki = 0.5
kd = 0.05
output_limits_deg = [-100.0, 100.0]
[[controller]]
name = "FSPID"
kind = "fspid"
nominal = {{ kp = {of_tuner}, ki = 0.5, kd = 0.05 }}
output_limits_deg = [-100.0, 100.0]
supervisor = {{ table = "mirrored", range = 5.0, error_scale = 1.0, change_scale = 0.2, output_scale = {{ kp = 0.1, ki = 0.01, kd = 0.01 }} }}
{beside}
[contest]
against = "PID"
"#
    );
    for plant in 0..6 {
        let effectiveness = 1.0 + 0.1 * f64::from(plant);
        text.push_str(&format!(
            "[[contest.case]]\nname = \"{plant}\"\nset = [\"plant.numerator[0]={effectiveness}\"]\n"
        ));
    }
    text
}

/// "IAE -60 %", "answers the moment" of loops of which a contest says that nobody wins with them.
#[test]
fn loops_that_are_unstable_at_rest_win_nothing_and_nothing_is_won_over_them() {
    let own = measured_on(&integrating([0.5, 4.0], ""), 2, 1).expect("an answer");
    let headline = own.headline();
    assert!(headline.starts_with("Nothing is won by FSPID: "), "{}", own.text());
    assert!(headline.ends_with("flights are of loops that are unstable at rest."), "{headline}");
    assert!(own.text().contains("What the difference is made of"), "{}", own.text());
    assert!(own.steps.iter().all(|it| it.share.is_none()) && own.page().contains("No win"));
    assert_eq!(own.json()["barred"], headline);
    let row = |treatment| own.rows.iter().find(|row| row.treatment == treatment).expect("flown");
    assert!(row(Treatment::AsItIs).unstable.is_some_and(|it| it > 0));
    assert_eq!(
        (row(Treatment::Against).unstable, row(Treatment::Shuffled).unstable),
        (Some(0), None)
    );
    let other = measured_on(&integrating([4.0, 0.5], ""), 2, 1).expect("an answer").headline();
    assert!(other.starts_with("Nothing is won over PID: "), "{other}");
    let neither = measured_on(&integrating([0.4, 0.5], ""), 2, 1).expect("an answer");
    assert!(neither.barred.is_none() && neither.json()["barred"].is_null(), "{}", neither.text());
}

#[test]
fn loops_of_which_nobody_can_tell_win_nothing() {
    let load = "[[disturbance]]\nkind = \"step\"\nenters_at = \"servo\"\namplitude_deg = 3.0\nat_s = 0.0\n";
    let text = integrating([0.4, 0.5], load).replace("[-100.0, 100.0]", "[-2.5, 2.5]");
    let answer = measured_on(&text, 2, 1).expect("an answer");
    let headline = answer.headline();
    assert!(headline.contains("of which nobody can tell"), "{}", answer.text());
    assert!(answer.text().contains("0 of 6, undecided 6"), "{}", answer.text());
}

#[test]
fn the_one_that_fails_more_of_its_flights_wins_nothing() {
    let asked =
        "[[requirement]]\nmeasure = \"overshoot_pct\"\nmost = 1e-9\ncontroller = \"FSPID\"\n";
    let answer = measured_on(&integrating([0.4, 0.8], asked), 2, 1).expect("an answer");
    assert_eq!(answer.headline(), "Nothing is won by FSPID: all of its flights fail.");
}

/// The seed of everything that is drawn was not that of the plants.
#[test]
fn the_seed_draws_the_plants_where_no_contest_says_another() {
    let text = head().split("[tuning]").next().expect("a head").to_owned()
        + "[[dispersion]]\npath = \"actuator.time_constant_s\"\ndistribution = \"uniform\"\nlower = 0.05\nupper = 0.2\n";
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("drawn.toml");
    std::fs::write(&path, text).expect("written");
    let source = Source { path, overrides: Vec::new() };
    let of = |seed: u64| {
        let options = Options { seeds: 1, budget: 1, runs: Some(3), seed, ..Options::default() };
        let flown = uncounted();
        let asked = Adaptation::new(&source, &options).expect("it can be asked");
        let answer = asked.measured(Watch { stops: &|| false, flown: &flown }).expect("an answer");
        answer.plants.iter().map(|it| it.mean.kp).collect::<Vec<_>>()
    };
    assert_eq!(of(Options::default().seed), of(1));
    assert_ne!(of(1), of(2));
}

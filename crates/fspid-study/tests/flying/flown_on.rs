//! Flights behind limits that have not come to rest go on, whatever hides what comes of them: noise, few samples, a plant that
//! holds by itself; and every command says the same of them.

use fspid_sim::stability::doubt_when_flown;
use fspid_sim::{Doubt, EndCause};
use fspid_study::analysis::{Analysis, Question, Stability};
use fspid_study::judgement::NotEvaluated;
use fspid_study::metrics::{Absent, Verdict};
use fspid_study::simulation::Simulation;

use crate::flying::{doubt, result, study};

/// An unstable plant that follows a slow sine, which takes more than its limits leave from the second quarter of a period on.
const SLOW_SINE: &str = r#"
schema = 1
name = "slow sine"
[plant]
numerator = [1.0]
denominator = [1.0, 0.5, -0.5]
elevator_sign = "nose-up-positive"
[loop]
sample_period_s = 0.01
duration_s = 10.0
[setpoint]
kind = "sine"
amplitude_deg = 10.0
frequency_hz = 0.01
[[controller]]
name = "PID"
kind = "pid"
kp = 2.0
ki = 0.3
kd = 1.0
derivative_filter_s = 0.05
output_limits_deg = [-4.0, 4.0]
anti_windup = { kind = "conditional" }
"#;

fn diverges(text: &str, set: &[&str]) -> bool {
    let verdict = result(text, set).metrics.verdict;
    matches!(verdict, Verdict::EndedEarly(end) if end.cause == EndCause::Diverged)
}

/// What the flight itself says, whatever is known of where it leads.
fn when_flown(text: &str, set: &[&str]) -> Option<Doubt> {
    let scenario = study(text, set).scenario;
    doubt_when_flown(&scenario, &scenario.controllers[0])
}

/// With a noise of a millionth of a degree, or of none, the flight that meets no limit was "stable", and diverged at 42 s.
#[test]
fn noise_does_not_hide_what_a_flight_comes_to() {
    for size in ["0.0", "1e-6"] {
        let noise = format!(
            "[[disturbance]]\nkind = \"noise\"\nenters_at = \"measurement\"\nstandard_deviation_deg = {size}\nseed = 1\n"
        );
        let text = format!("{SLOW_SINE}{noise}");
        assert_eq!(doubt(&result(&text, &[])), Some(Doubt::SwingAtLimits), "{size}");
        assert!(diverges(&text, &["loop.duration_s=60.0"]), "{size}");
        assert_eq!(doubt(&result(&text, &["setpoint.amplitude_deg=5.0"])), None, "{size}");
    }
}

/// 49 samples, at the end of which the pitch is twice as far as it was told to go.
#[test]
fn a_flight_of_few_samples_is_flown_on_as_any_other() {
    let few = ["setpoint.kind=step", "loop.sample_period_s=0.1", "loop.duration_s=4.8"];
    let limited = |set: &[&str]| {
        let limits = "controller.PID.output_limits_deg=[-6.0, 6.0]";
        let text = SLOW_SINE
            .replace("frequency_hz = 0.01\n", "")
            .replace("derivative_filter_s = 0.05\n", "");
        let set = [&few[..], &[limits], set].concat();
        (
            doubt(&result(&text, &set)),
            diverges(&text, &[&set[..], &["loop.duration_s=60.0"]].concat()),
        )
    };
    assert_eq!(limited(&[]), (Some(Doubt::SwingAtLimits), true));
    assert_eq!(limited(&["setpoint.amplitude_deg=3.0"]), (None, false));
}

/// Half a second of a step that is lost after half a minute: no limit is met by then, and noise, or a sine that has shown many
/// periods, was all that moved it.
#[test]
fn what_moves_a_flight_for_ever_does_not_hide_a_beginning_that_is_not_over() {
    let step = [
        "setpoint.kind=step",
        "controller.PID.output_limits_deg=[-6.0, 6.0]",
        "controller.PID.kd=0.0",
        "controller.PID.kp=0.55",
        "controller.PID.ki=0.02",
        "loop.duration_s=0.5",
    ];
    let text = SLOW_SINE.replace("frequency_hz = 0.01\n", "");
    let noise =
        "kind = \"noise\"\nenters_at = \"measurement\"\nstandard_deviation_deg = 1e-6\nseed = 1\n";
    let sine =
        "kind = \"sine\"\nenters_at = \"servo\"\namplitude_deg = 1e-6\nfrequency_hz = 20.0\n";
    for moves in ["", noise, sine] {
        let table = if moves.is_empty() { "" } else { "[[disturbance]]\n" };
        let text = format!("{text}{table}{moves}");
        let flight = result(&text, &step);
        assert!(flight.trace.command_rad.iter().all(|it| it.to_degrees().abs() < 6.0), "{moves}");
        assert_eq!(doubt(&flight), Some(Doubt::SwingAtLimits), "{moves}");
        assert!(diverges(&text, &[&step[..], &["loop.duration_s=60.0"]].concat()), "{moves}");
    }
}

/// A plant that comes to rest by itself behind a slew limit, lightly damped.
const SLEW: &str = r#"
schema = 1
name = "slew"
[plant]
numerator = [1.4]
denominator = [1.0, 0.62, 0.84]
elevator_sign = "nose-up-positive"
[actuator]
delay_samples = 3
[loop]
sample_period_s = 0.02
duration_s = 30.0
[setpoint]
kind = "step"
amplitude_deg = 6.0
[[controller]]
name = "PID"
kind = "pid"
kp = 1.5
ki = 1.0
kd = 0.8
derivative_on = "measurement"
derivative_filter_s = 0.1
slew_limit_deg_s = 4.0
"#;

/// It swings by 13 deg for ever, and `stable` was met: its plant holds by itself. Short of its set-point at a limit it stands.
#[test]
fn a_swing_at_limits_of_a_plant_that_holds_by_itself_is_undecided_and_what_stands_at_a_limit_is_not()
 {
    let doubt = |set: &[&str]| doubt(&result(SLEW, set));
    assert_eq!(doubt(&[]), Some(Doubt::SwingAtLimits));
    assert_eq!(doubt(&["setpoint.amplitude_deg=1.0"]), None);
    assert_eq!(doubt(&["controller.PID.slew_limit_deg_s=60.0"]), None);
    let short_of_it =
        ["controller.PID.slew_limit_deg_s=60.0", "controller.PID.output_limits_deg=[-3.0, 3.0]"];
    assert_eq!(doubt(&short_of_it), None);
    // However long it is, and with noise that never reaches it: of rounding alone one part moves twice as much as another.
    let noise = "sensor={preset=\"ideal\", seed=1, pitch={noise_deg_rt_hz=0.0005}}";
    let long = ["loop.duration_s=2001.0", noise];
    assert_eq!(doubt(&[&short_of_it[..], &long].concat()), None);
}

/// A pitch sensor of a coarse resolution keeps a small swing up by itself: that is no swing at limits.
#[test]
fn a_swing_that_is_not_larger_than_what_the_sensor_shows_is_no_doubt() {
    let limits = "controller.PID.output_limits_deg=[-4.0, 4.0]";
    let text = SLOW_SINE
        .replace("kind = \"sine\"", "kind = \"step\"")
        .replace("frequency_hz = 0.01\n", "");
    let seen = "sensor={preset=\"ideal\", seed=1, pitch={resolution_deg=0.05}}";
    assert_eq!(doubt(&result(&text, &[limits, seen, "setpoint.amplitude_deg=1.0"])), None);
}

/// `analyse` flew nothing, and was "stable" of what `simulate` is not.
#[test]
fn analyse_says_of_a_swing_at_limits_what_its_flight_is_told() {
    for (text, set) in [(SLEW, vec![]), (SLOW_SINE, vec![])] {
        let study = study(text, &set);
        let analysis = Analysis::of(&study, Question::default()).expect("a loop");
        assert_eq!(analysis.stability(), Stability::Undecided);
        assert!(analysis.text().contains("nor when it is flown on"), "{}", analysis.text());
    }
    let calm = study(SLEW, &["setpoint.amplitude_deg=1.0"]);
    let analysis = Analysis::of(&calm, Question::default()).expect("a loop");
    assert_eq!(analysis.stability(), Stability::Stable);
}

/// A linear plant, its actuator, sample period and duration in s, and a step in deg that a PID flies.
fn stepped(
    [numerator, denominator]: [&str; 2],
    actuator: &str,
    [sample_period_s, duration_s]: [f64; 2],
    step_deg: f64,
    pid: &str,
) -> String {
    format!(
        "schema = 1\nname = \"step\"\nplant = {{ numerator = {numerator}, denominator = {denominator}, elevator_sign = \"nose-up-positive\" }}\nactuator = {{ {actuator} }}\nloop = {{ sample_period_s = {sample_period_s:?}, duration_s = {duration_s:?} }}\nsetpoint = {{ kind = \"step\", amplitude_deg = {step_deg:?} }}\n[[controller]]\nname = \"PID\"\nkind = \"pid\"\n{pid}\n"
    )
}

/// A double integrator behind a limit of rate: small motions decay, and a swing that noise has once made large stays. It ended at
/// 370 000 deg after 240 s; without its noise it rests, which was all that was asked of it.
#[test]
fn noise_that_carries_a_flight_into_a_swing_at_limits_leaves_it_in_doubt() {
    let kicked = stepped(
        ["[1.0, 0.5]", "[1.0, 1.5, 0.0, 0.0]"],
        "time_constant_s = 0.1, rate_limit_deg_s = 5.0",
        [0.02, 60.0],
        1.0,
        "kp = 4.0\nki = 1.5\nkd = 2.0\nderivative_filter_s = 0.05\n[[disturbance]]\nkind = \"noise\"\nenters_at = \"servo\"\nstandard_deviation_deg = 3.0\nseed = 1\nat_s = 10.0",
    );
    for duration in ["loop.duration_s=60.0", "loop.duration_s=240.0"] {
        assert_eq!(doubt(&result(&kicked, &[duration])), Some(Doubt::SwingAtLimits), "{duration}");
    }
    let little = ["disturbance[0].standard_deviation_deg=0.01"];
    assert_eq!(doubt(&result(&kicked, &little)), None);
}

/// A step that leaves the Navion of the textbook in a swing between the limits of the command's rate.
const SLEWED: &str = r#"
schema = 1
name = "slewed"
[plant]
preset = "navion-full"
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.02
duration_s = 60.0
[setpoint]
kind = "step"
amplitude_deg = 30.0
[[controller]]
name = "PID"
kind = "pid"
kp = 1.0
ki = 0.5
kd = 0.05
slew_limit_deg_s = 8.0
"#;

/// With any sine beside it, of no size or after the flight too, a swing that stays was held for that of the sine.
#[test]
fn a_sine_does_not_hide_a_swing_that_stays_at_limits() {
    assert_eq!(doubt(&result(SLEWED, &[])), Some(Doubt::SwingAtLimits));
    for (size, at) in [("0.0", "0.0"), ("1e-6", "0.0"), ("1.0", "0.0"), ("1.0", "100.0")] {
        let sine = format!(
            "[[disturbance]]\nkind = \"sine\"\nenters_at = \"servo\"\namplitude_deg = {size}\nfrequency_hz = 1.0\nat_s = {at}\n"
        );
        let text = format!("{SLEWED}{sine}");
        assert_eq!(doubt(&result(&text, &[])), Some(Doubt::SwingAtLimits), "{size} at {at}");
        assert_eq!(doubt(&result(&text, &["setpoint.amplitude_deg=2.0"])), None, "{size} at {at}");
    }
}

/// Its length was not that of the flight that was asked for, so that nothing was asked: "stable", beside "diverged".
#[test]
fn a_flight_that_is_lost_at_limits_within_its_own_length_is_in_doubt() {
    let long = ["loop.duration_s=60.0"];
    assert!(diverges(SLOW_SINE, &long));
    assert_eq!(doubt(&result(SLOW_SINE, &long)), Some(Doubt::RunsAway));
    let analysed = Analysis::of(&study(SLOW_SINE, &long), Question::default()).expect("a loop");
    assert_eq!(analysed.loops[0].stability(), Stability::Undecided);
}

/// A response that has hardly begun moves no more than one that has ended; and an error stands where it turns.
#[test]
fn a_response_that_has_hardly_begun_or_just_turns_has_not_come_to_rest() {
    let begun = stepped(
        ["[1.0, 0.3]", "[1.0, 0.86, 1.89, -0.144]"],
        "time_constant_s = 0.035, position_limit_deg = 5.0",
        [0.005, 0.44],
        5.0,
        "kp = 0.17\nki = 0.16\nkd = 2.6\nintegral = \"literal\"\nsetpoint_weights = { proportional = 0.0 }\nderivative_on = \"measurement\"",
    );
    let at = "setpoint.at_s=0.045";
    for duration in ["0.2", "0.44", "1.0", "2.2"] {
        let set = [at, &*format!("loop.duration_s={duration}")];
        assert_eq!(doubt(&result(&begun, &set)), Some(Doubt::SwingAtLimits), "{duration} s");
    }
    assert!(diverges(&begun, &[at, "loop.duration_s=400.0"]));
}

/// An unstable plant at rest, which a load takes at its end beyond what the limits can bring back.
#[test]
fn what_changes_at_the_end_of_a_flight_is_flown_on() {
    let load = "[[disturbance]]\nkind = \"step\"\nenters_at = \"servo\"\namplitude_deg = 3.9\nat_s = 39.99\n";
    let rests = SLOW_SINE.replace("frequency_hz = 0.01\n", "") + load;
    let step = ["setpoint.kind=step", "setpoint.amplitude_deg=0.1", "loop.duration_s=40.0"];
    assert_eq!(doubt(&result(&rests, &step)), Some(Doubt::SwingAtLimits));
    assert!(diverges(&rests, &[&step[..2], &["loop.duration_s=120.0"]].concat()));
    let small = [&step[..], &["disturbance[0].amplitude_deg=0.5"]].concat();
    assert_eq!(doubt(&result(&rests, &small)), None);
}

/// A flight that ends before its overshoot comes to the guard, after which the command is held for good.
#[test]
fn a_sample_guard_that_is_met_later_leaves_a_flight_in_doubt() {
    let guarded = stepped(
        ["[1.0, 1.0]", "[1.0, 1.0, 1.0, -0.3]"],
        "time_constant_s = 0.05",
        [0.01, 0.8],
        10.0,
        "kp = 4.0\nki = 1.0\nkd = 2.0\nderivative_filter_s = 0.02\nsample_guard_deg = 11.0",
    );
    assert_eq!(doubt(&result(&guarded, &[])), Some(Doubt::HeldByGuard));
    assert!(diverges(&guarded, &["loop.duration_s=100.0"]));
    assert_eq!(doubt(&result(&guarded, &["controller.PID.sample_guard_deg=60.0"])), None);
}

/// The scenario with an aircraft at an airspeed in place of its plant.
fn of_aircraft(of_plant: &str, aircraft: &str, speed: &str) -> String {
    let lines = of_plant.lines().map(|line| match line.starts_with("plant") {
        true => format!("aircraft = {{ name = \"{aircraft}\", {speed}, altitude_m = 500.0 }}"),
        false => line.to_owned(),
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// A DC-8 whose elevator is too slow for its gains: it lies on its back after 55 s, and its flight ends after 10 s.
fn slow_elevator() -> String {
    let step = stepped(
        ["[]", "[]"],
        "time_constant_s = 0.09, rate_limit_deg_s = 2.08",
        [0.02, 10.1],
        -2.34,
        "kp = 0.579\nki = 2.16\nkd = 0.945\nderivative_filter_s = 0.05",
    );
    of_aircraft(&step, "dc-8-approach", "airspeed_m_s = 81.35")
}

/// It was stable in its 10 s.
#[test]
fn a_swing_at_limits_that_grows_after_the_flight_of_an_aircraft_leaves_it_in_doubt() {
    let slow = slow_elevator();
    assert_eq!(doubt(&result(&slow, &[])), Some(Doubt::SwingAtLimits));
    assert!(diverges(&slow, &["loop.duration_s=60.0"]));
    // Also where no limit is met yet, for the step comes at the end.
    assert_eq!(doubt(&result(&slow, &["setpoint.at_s=10.09"])), Some(Doubt::SwingAtLimits));
    // And beside an autopilot that moves the throttle alone, and adds nothing to the set-point.
    let throttle = "[[outer_loop]]\nname = \"autothrottle\"\nkind = \"pid\"\nholds = \"airspeed\"\nmoves = \"throttle\"\nkp = 0.02\n[[mode]]\nname = \"speed\"\nengage = [\"autothrottle\"]\n";
    let held = format!("{slow}\n{throttle}");
    assert_eq!(doubt(&result(&held, &["setpoint.at_s=10.09"])), Some(Doubt::SwingAtLimits));
    assert_eq!(doubt(&result(&held, &["setpoint.amplitude_deg=-0.2"])), None);
    // A step that is small for the same elevator, and one that is fast enough.
    assert_eq!(doubt(&result(&slow, &["setpoint.amplitude_deg=-0.2"])), None);
    assert_eq!(doubt(&result(&slow, &["actuator.rate_limit_deg_s=20.0"])), None);
}

/// Its margins were met beside "diverged".
#[test]
fn an_aircraft_that_is_lost_at_limits_within_its_flight_has_no_margins_to_require() {
    let asked = "[[requirement]]\nmeasure = \"stable\"\n[[requirement]]\nmeasure = \"phase_margin_deg\"\nleast = 10.0\n";
    let found = |set: &[&str]| {
        let flown = Simulation::of(&study(&format!("{}\n{asked}", slow_elevator()), set));
        let judged = flown.expect("it flies").judgements;
        judged.into_iter().map(|it| (it.met, it.found.err())).collect::<Vec<_>>()
    };
    let undecided = NotEvaluated::Absent(Absent::Undecided(Doubt::SwingAtLimits));
    let lost = found(&["loop.duration_s=60.0"]);
    assert_eq!(lost, vec![(false, None), (false, Some(undecided))]);
    let fast = found(&["loop.duration_s=60.0", "actuator.rate_limit_deg_s=20.0"]);
    assert_eq!(fast, vec![(true, None); 2]);
}

/// A swing that an aircraft's own flight shows is told, and one that comes of it when it goes on, in moving air as in still air.
#[test]
fn a_swing_at_limits_that_the_flight_of_an_aircraft_shows_leaves_it_in_doubt() {
    let step = |aircraft: &str, speed: &str, pid: &str| {
        let of_plant = stepped(["[]", "[]"], "time_constant_s = 0.2", [0.02, 22.0], -0.72, pid);
        of_aircraft(&of_plant, aircraft, speed)
    };
    let beaver = step(
        "beaver",
        "airspeed_m_s = 47.0",
        "kp = 3.3\nki = 2.3\nkd = 0.3\nderivative_filter_s = 0.05\nslew_limit_deg_s = 2.6",
    );
    let navion = step(
        "navion",
        "airspeed_ft_s = 176.0",
        "kp = 3.8\nki = 0.1\nkd = 0.6\nderivative_filter_s = 0.05\nslew_limit_deg_s = 5.8",
    );
    let breeze = "[wind]\nkind = \"log-shear\"\nw20_kt = 0.1\nfrom_deg = 0.0\n";
    assert_eq!(doubt(&result(&format!("{beaver}\n{breeze}"), &[])), Some(Doubt::SwingAtLimits));
    let slow = format!("{}\n{breeze}", slow_elevator());
    assert_eq!(doubt(&result(&slow, &[])), Some(Doubt::SwingAtLimits));
    assert_eq!(doubt(&result(&slow, &["actuator.rate_limit_deg_s=20.0"])), None);
    // Wherever in its swing the flight ends.
    for (text, duration) in
        [(&beaver, "22.0"), (&navion, "29.0"), (&navion, "31.5"), (&navion, "60.0")]
    {
        let set = [&*format!("loop.duration_s={duration}")];
        assert_eq!(doubt(&result(text, &set)), Some(Doubt::SwingAtLimits), "{duration} s");
        let wide = [set[0], "controller.PID.slew_limit_deg_s=90.0"];
        assert_eq!(doubt(&result(text, &wide)), None, "{duration} s");
    }
}

/// "PASS phase_margin_deg 48.1 deg", of a flight that diverges at 25 s.
#[test]
fn a_requirement_on_margins_is_not_evaluated_where_limits_leave_the_flight_in_doubt() {
    let asked = "[[requirement]]\nmeasure = \"stable\"\n[[requirement]]\nmeasure = \"phase_margin_deg\"\nleast = 10.0\n";
    let found = |set: &[&str]| {
        let flown = Simulation::of(&study(&format!("{SLEWED}{asked}"), set)).expect("it flies");
        flown.judgements.into_iter().map(|it| (it.met, it.found)).collect::<Vec<_>>()
    };
    let undecided = NotEvaluated::Absent(Absent::Undecided(Doubt::SwingAtLimits));
    assert_eq!(found(&[]), vec![(false, Err(undecided)); 2]);
    let small = found(&["setpoint.amplitude_deg=2.0"]);
    assert!(small.iter().all(|(met, found)| *met && found.is_ok()), "{small:?}");
}

/// A Navion's altitude went up and down by 5 m for ever, at the limit of rate of the loop that holds it: "stable".
#[test]
fn a_swing_at_a_limit_of_an_outer_loop_leaves_the_flight_in_doubt() {
    let capture = include_str!("../../../../scenarios/gallery/altitude-capture.toml");
    let of = |most_per_s: &str, more: &[&str]| {
        let limit = format!("outer_loop.altitude.most_per_s={most_per_s}");
        let set = ["outer_loop.altitude.kp=0.6", &limit];
        doubt(&result(capture, &[&set[..], more].concat()))
    };
    let ends = ["outer_loop.altitude.least=-0.8", "outer_loop.altitude.most=1.4"];
    for duration in ["60.0", "90.0", "300.0"] {
        let long = &*format!("loop.duration_s={duration}");
        let narrow = [&ends[..], &[long]].concat();
        assert_eq!(of("0.065", &narrow), Some(Doubt::SwingAtLimits), "{duration} s");
        assert_eq!(of("0.3", &narrow), None, "{duration} s");
    }
    // A climb at a limit that the flight does not end is no swing.
    assert_eq!(of("1.0", &["loop.duration_s=30.0"]), None);
}

/// Told to fly 5 % faster with 0.03 of throttle to spare, it was stable in its 90 s and on its back after 156 s.
#[test]
fn a_speed_that_is_lost_at_a_limit_of_an_outer_loop_leaves_the_flight_in_doubt() {
    let level = include_str!("../data/level_at_the_throttle.toml");
    let of = |set: &[&str]| doubt(&result(level, set));
    // Where the mode leads is asked before the flight goes on.
    assert!(matches!(of(&[]), Some(Doubt::Led { .. } | Doubt::LedNowhere(_))));
    assert_eq!(when_flown(level, &[]), Some(Doubt::SwingAtLimits));
    assert!(diverges(level, &["loop.duration_s=400.0"]));
    // Lost within the flight it is in no less doubt.
    assert_eq!(when_flown(level, &["loop.duration_s=400.0"]), Some(Doubt::SwingAtLimits));
    let free = ["outer_loop.autothrottle.least=-0.5", "outer_loop.autothrottle.most=0.5"];
    assert_eq!(of(&free), None);
}

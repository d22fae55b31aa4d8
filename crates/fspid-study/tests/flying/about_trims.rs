//! What grows about the trim of a nonlinear aircraft is asked of everything that flies: of what is held from the sample before,
//! of the aircraft that it comes to be, and with what actuators and sensors do to small motions. Flights of the program refute
//! what would be said of less.

use fspid_sim::Doubt;
use fspid_study::analysis::{Analysis, Question, Stability};
use fspid_study::simulation::{ControllerResult, Simulation};

use serde_json::Value;

use crate::flying::study;

fn result(text: &str, set: &[&str]) -> ControllerResult {
    let found = Simulation::of(&study(text, set)).expect("it flies");
    found.results.into_iter().next().expect("a controller")
}

fn doubt(result: &ControllerResult) -> Option<Doubt> {
    result.at_rest.undecided.map(|it| it.doubt)
}

/// A Navion whose throttle answers airspeed and its rate, with an engine that follows at once.
const THROTTLE: &str = r#"
schema = 1
name = "throttle"
[aircraft]
name = "navion"
airspeed_ft_s = 176.0
altitude_ft = 1000.0
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.02
duration_s = 30.0
[setpoint]
kind = "step"
amplitude_deg = 0.5
at_s = 1.0
[[outer_loop]]
name = "autothrottle"
kind = "pid"
holds = "airspeed"
moves = "throttle"
kp = 0.2
ki = 0.02
rate_gain = 1.0
[[mode]]
name = "hold"
engage = ["autothrottle"]
[[controller]]
name = "PID"
kind = "pid"
kp = 0.82
ki = 0.43
kd = 0.165
derivative_filter_s = 0.05
"#;

/// The throttle accelerates what is looked at, and was no number of the flight: one that went from end to end at every sample was
/// "stable" and proved.
#[test]
fn a_throttle_that_answers_itself_grows_as_it_is_flown() {
    let flown = result(THROTTLE, &[]);
    let unstable = flown.at_rest.unstable.expect("it grows");
    assert_eq!(unstable.mode, Some(0));
    let throttle = flown.trace.column("throttle").expect("a throttle");
    let turns = throttle.windows(2).rev().take(100).filter(|two| (two[1] - two[0]).abs() > 1.0);
    assert_eq!(turns.count(), 100);
    // Less of the rate is held, and so it is by an engine that takes a while.
    assert!(result(THROTTLE, &["outer_loop[0].rate_gain=0.4"]).at_rest.unstable.is_none());
    let engine = THROTTLE
        .replace("[loop]", "[engine]\nkind = \"first-order\"\ntime_constant_s = 0.5\n[loop]");
    assert!(result(&engine, &[]).at_rest.unstable.is_none());
}

/// A Navion whose altitude is held by pitch, and a brake that comes out.
const BRAKE: &str = r#"
schema = 1
name = "brake"
[aircraft]
name = "navion"
airspeed_ft_s = 176.0
altitude_ft = 1000.0
[[configuration]]
name = "brake"
assumption = "made up"
drag.alpha = 0.6
[[configuration_change]]
name = "brake"
to = 1.0
at_s = 5.0
takes_s = 1.0
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.02
duration_s = 30.0
[setpoint]
kind = "step"
amplitude_deg = 0.0
[[outer_loop]]
name = "altitude"
kind = "pid"
holds = "altitude"
moves = "vertical speed"
kp = 0.15
[[outer_loop]]
name = "vertical speed"
kind = "pid"
holds = "vertical-speed"
moves = "pitch"
kp = 0.5
ki = 0.3
[[mode]]
name = "hold"
engage = ["altitude", "vertical speed"]
[[controller]]
name = "PID"
kind = "pid"
kp = 0.82
ki = 0.43
kd = 0.165
derivative_filter_s = 0.05
"#;

/// Drag that rises with the angle of attack makes of a held altitude a speed that runs away: it flew into the ground in 285 s,
/// "stable" and proved.
#[test]
fn loops_around_the_pitch_loop_are_asked_with_the_aircraft_that_comes_to_be() {
    let later = result(BRAKE, &[]).at_rest.unstable.expect("it grows");
    assert!(later.mode == Some(0) && later.from_s == 6.0, "{later:?}");
    let out = ["aircraft.configuration=[\"brake\"]", "configuration_change=[]"];
    let at_once = result(BRAKE, &out).at_rest.unstable.expect("it grows");
    assert!((later.doubling_s / at_once.doubling_s - 1.0).abs() < 1e-3);
    // A mode that ends before the brake is out does not meet it, as far as anybody knows before the flight.
    let then = "[[mode]]\nname = \"free\"\nat_s = 3.0\nengage = []\n[[controller]]";
    let ends = result(&BRAKE.replace("[[controller]]", then), &[]);
    assert!(ends.at_rest.unstable.is_none());
    assert_eq!(doubt(&ends), Some(Doubt::ChangedAircraft));
    // And one that begins after it meets the aircraft of the start no more.
    let in_first = ["configuration_change[0].to=0.0", "aircraft.configuration=[\"brake\"]"];
    let free = "[[mode]]\nname = \"free\"\nengage = []\n[[mode]]\nname = \"hold\"\nat_s = 7.0\n";
    let begins = result(&BRAKE.replace("[[mode]]\nname = \"hold\"\n", free), &in_first);
    assert!(begins.at_rest.unstable.is_none() && doubt(&begins).is_none(), "{:?}", begins.at_rest);
}

/// An altitude that is held with the tank full, and swings with it empty.
#[test]
fn loops_around_the_pitch_loop_are_asked_with_an_empty_tank() {
    let tight = ["outer_loop[0].kp=0.6", "outer_loop[1].kp=2.6", "outer_loop[1].ki=1.0"];
    let calm = BRAKE.replace(
        "[[configuration_change]]\nname = \"brake\"\nto = 1.0\nat_s = 5.0\ntakes_s = 1.0\n",
        "",
    );
    assert_eq!(doubt(&result(&calm, &tight)), None);
    let burns = calm.replace("[loop]", "[fuel]\non_board_kg = 600.0\nflow_kg_s = 10.0\n[loop]");
    assert_eq!(doubt(&result(&burns, &tight)), Some(Doubt::ChangedAircraft));
}

/// Differences lay inside a deadband and inside a play, so that poles were those of an elevator that nobody moves: a loop that
/// doubles in a second was stable, and the shipped autopilots unstable with 0.05 deg of play.
#[test]
fn deadband_and_play_of_an_actuator_do_not_hide_the_loops_around() {
    let calm = BRAKE.replace("at_s = 5.0\ntakes_s", "at_s = 25.0\ntakes_s");
    let still = ["configuration_change[0].to=0.0"];
    let tight = ["outer_loop[0].kp=3.0", "outer_loop[1].kp=2.6", still[0]];
    for actuator in ["", "actuator.deadband_deg=0.1", "actuator.backlash_deg=0.1"] {
        let with = |set: &[&str]| {
            let set: Vec<&str> =
                set.iter().copied().chain([actuator]).filter(|it| !it.is_empty()).collect();
            result(&calm, &set).at_rest
        };
        assert!(with(&tight).unstable.is_some_and(|it| it.mode == Some(0)), "{actuator}");
        assert!(with(&still).unstable.is_none() && with(&still).undecided.is_none(), "{actuator}");
    }
}

/// A Navion whose centre of gravity is behind its neutral point, with half a degree of elevator.
const AFT: &str = r#"
schema = 1
name = "aft"
[aircraft]
name = "navion"
airspeed_ft_s = 176.0
cg_mac = 0.5
altitude_ft = 1000.0
[actuator]
time_constant_s = 0.1
position_limit_deg = 0.5
[loop]
sample_period_s = 0.01
duration_s = 20.0
[setpoint]
kind = "step"
amplitude_deg = 3.0
at_s = 1.0
[[controller]]
name = "PID"
kind = "pid"
kp = 0.82
ki = 0.43
kd = 0.165
derivative_filter_s = 0.05
"#;

/// It was "settled" in 20 s and 30 s, `stable` met, and diverged at 57 s.
#[test]
fn an_unstable_aircraft_that_is_held_beyond_its_elevator_is_not_called_stable() {
    assert_eq!(doubt(&result(AFT, &[])), Some(Doubt::BeyondLimits));
    assert_eq!(doubt(&result(AFT, &["setpoint.amplitude_deg=0.3"])), None);
    assert_eq!(doubt(&result(AFT, &["actuator.position_limit_deg=8.0"])), None);
    // Without a limit of the servo the elevator's own travel is one.
    let free = AFT.replace("position_limit_deg = 0.5\n", "");
    assert_eq!(doubt(&result(&free, &["loop.duration_s=3.0"])), None);
    let far = [
        "loop.duration_s=3.0",
        "setpoint.amplitude_deg=0.1",
        "disturbance=[{kind=\"step\", enters_at=\"elevator\", amplitude_deg=40.0, at_s=2.9}]",
    ];
    assert_eq!(doubt(&result(&free, &far)), Some(Doubt::BeyondLimits));
    // An aircraft that holds by itself rests somewhere.
    assert_eq!(doubt(&result(AFT, &["aircraft.cg_mac=0.295"])), None);
}

/// Seen through a vertical gyro the pitch of this loop comes to a swing of 0.25 deg from any motion, however small.
#[test]
fn a_gyro_that_erects_to_the_apparent_vertical_is_told_where_small_motions_grow_by_it() {
    let gyro = "[sensor]\npreset = \"vertical-gyro\"\nseed = 1\npitch = { noise_deg_rt_hz = 0.0, bias_deg = 0.0, drift_deg = 0.0 }\nrate = { noise_deg_s_rt_hz = 0.0, bias_deg_s = 0.0 }\n[loop]";
    let text = AFT
        .replace("cg_mac = 0.5\n", "")
        .replace("position_limit_deg = 0.5\n", "")
        .replace("[loop]", gyro);
    let flown = result(&text, &["setpoint.amplitude_deg=0.001", "loop.duration_s=400.0"]);
    assert_eq!(doubt(&flown), Some(Doubt::Erection));
    let last = flown.trace.theta_rad.iter().rev().take(5000).map(|rad| rad.to_degrees().abs());
    assert!(last.fold(0.0, f64::max) > 0.1);
    let upright = text.replace(
        "bias_deg = 0.0, drift_deg = 0.0 }",
        "bias_deg = 0.0, drift_deg = 0.0, erection_deg_min = 0.0 }",
    );
    assert_eq!(doubt(&result(&upright, &[])), None);
}

/// A flying wing at 10 Hz whose autopilot sees altitude and airspeed by clocks of their own.
const AGES: &str = r#"
schema=1
name="x"
[aircraft]
name="skywalker-x8"
airspeed_m_s=18
altitude_m=800
validity="warn"
thrust="with-speed"
[lateral]
bank_time_s=0.64
yaw_damping=0.6
[actuator]
natural_frequency_rad_s=25.0
damping=0.7
delay_samples=1
[loop]
sample_period_s=0.1
duration_s=300.0
[setpoint]
kind="step"
amplitude_deg=0.0
[[outer_loop]]
name="A"
kind="pid"
holds="altitude"
moves="B"
kp=2.62137
sensor = {delay_s=0.114, period_s=0.2}
[[outer_loop]]
name="B"
kind="pid"
holds="flight-path"
moves="pitch"
kp=0.17342
ki=0.05974
[[outer_loop]]
name="T"
kind="pid"
holds="airspeed"
moves="throttle"
kp=5.60665
ki=0.01364
sensor = {period_s=0.5, delay_s=0.073}
[[outer_loop]]
name="H"
kind="pid"
holds="heading"
moves="bank"
kp=1.62985
ki=0.25207
kd = 0.0171
derivative_filter_s=1.123
[[mode]]
name="m"
engage=["A", "B", "T", "H"]
[[disturbance]]
kind="pulse"
enters_at="elevator"
amplitude_deg=1e-05
at_s=1.0
width_s=1.0
[[gust]]
kind="full-cycle"
right_m_s=1.0000000000000002e-06
gradient_m=18
at_s=1.0
[[controller]]
name="PID"
kind="pid"
kp=0.5
ki=0.3
kd=0.15
derivative_filter_s=0.05
"#;

/// With the largest age each loop grows, and the flight comes to rest all the same: ages change.
#[test]
fn loops_that_see_by_clocks_of_their_own_are_undecided_where_one_age_is_unstable() {
    let flown = result(AGES, &["loop.duration_s=600.0"]);
    assert!(flown.at_rest.unstable.is_none());
    assert_eq!(doubt(&flown), Some(Doubt::ChangingAge));
    let last = flown.trace.theta_rad.iter().rev().take(100).map(|rad| rad.abs());
    assert!(last.fold(0.0, f64::max) < 1e-8);
}

/// Of a Navion with a hundredth of its inertia in yaw. Steps of 10 ms made of a motion of 125 rad/s that doubles in a third of a
/// second one that dies out.
#[test]
fn an_airframe_that_is_faster_than_the_steps_of_the_integration_is_undecided() {
    let light = AFT
        .replace("cg_mac = 0.5\n", "iz_kg_m2 = 60.0\nvalidity = \"warn\"\n")
        .replace("position_limit_deg = 0.5\n", "");
    assert_eq!(doubt(&result(&light, &[])), Some(Doubt::FastMotion));
    // Steps that follow it find that it grows.
    let found = result(&light, &["loop.sample_period_s=0.002", "loop.duration_s=5.0"]);
    assert_ne!(doubt(&found), Some(Doubt::FastMotion));
}

/// `"stable": true` in JSON, where the flight said that nobody knows.
#[test]
fn everything_that_a_flight_doubts_is_in_doubt_for_analyse() {
    let loops = |text: &str, set: &[&str]| {
        let found = Analysis::of(&study(text, set), Question::default()).expect("a loop");
        (found.json()["controllers"][0].clone(), found.stability(), found.text())
    };
    let (json, stability, text) = loops(AFT, &[]);
    assert_eq!((json["stable"].clone(), stability), (Value::Null, Stability::Undecided));
    assert_eq!(json["stability"], "undecided");
    let why = json["undecided"].as_str().expect("a reason");
    assert!(
        why.contains("more elevator than a limit leaves") && text.contains("UNDECIDED"),
        "{why}"
    );
    let (json, stability, _) = loops(AFT, &["setpoint.amplitude_deg=0.3"]);
    assert_eq!((json["stable"].clone(), stability), (Value::Bool(true), Stability::Stable));
    assert!(json.get("undecided").is_none());
    // A mode that grows with the aircraft of later has a line of its own.
    let (json, stability, text) = loops(BRAKE, &[]);
    assert_eq!((json["stable"].clone(), stability), (Value::Bool(false), Stability::Unstable));
    assert!(text.contains("mode hold, with the aircraft from 6 s on: UNSTABLE"), "{text}");
}

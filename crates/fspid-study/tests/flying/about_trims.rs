//! What grows about the trim of a nonlinear aircraft is asked of everything that flies: of what is held from the sample before,
//! of the aircraft that it comes to be, and with what actuators and sensors do to small motions. Flights of the program refute
//! what would be said of less.

use fspid_aircraft::AirMotion;
use fspid_sim::Doubt;
use fspid_sim::autopilot::Quantity;
use fspid_study::analysis::{Analysis, Question, Stability};
use fspid_study::report;
use fspid_study::simulation::{ControllerResult, Simulation};
use serde_json::Value;

use crate::flying::{NAVION, doubt, result, study, trimmed};

/// A throttle that answers airspeed and its rate.
const THROTTLE: &str = r#"
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
"#;

/// The throttle accelerates what is looked at, and was no number of the flight: one that went from end to end at every sample was
/// "stable" and proved.
#[test]
fn a_throttle_that_answers_itself_grows_as_it_is_flown() {
    let navion = format!("{NAVION}{THROTTLE}");
    let flown = result(&navion, &[]);
    let unstable = flown.at_rest.unstable.expect("it grows");
    assert_eq!(unstable.mode, Some(0));
    let throttle = flown.trace.column("throttle").expect("a throttle");
    let turns = throttle.windows(2).rev().take(100).filter(|two| (two[1] - two[0]).abs() > 1.0);
    assert_eq!(turns.count(), 100);
    // Less of the rate is held, and so it is by an engine that takes a while.
    assert!(result(&navion, &["outer_loop[0].rate_gain=0.4"]).at_rest.unstable.is_none());
    let engine =
        navion.replace("[loop]", "[engine]\nkind = \"first-order\"\ntime_constant_s = 0.5\n[loop]");
    assert!(result(&engine, &[]).at_rest.unstable.is_none());
}

/// An altitude that is held by pitch, and a brake that comes out.
const BRAKE: &str = r#"
[[configuration]]
name = "brake"
assumption = "made up"
drag.alpha = 0.6
[[configuration_change]]
name = "brake"
to = 1.0
at_s = 5.0
takes_s = 1.0
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
"#;

/// The Navion with them.
fn braked() -> String {
    format!("{NAVION}{BRAKE}")
}

/// Drag that rises with the angle of attack makes of a held altitude a speed that runs away: it flew into the ground in 285 s,
/// "stable" and proved.
#[test]
fn loops_around_the_pitch_loop_are_asked_with_the_aircraft_that_comes_to_be() {
    let brake = braked();
    let later = result(&brake, &[]).at_rest.unstable.expect("it grows");
    assert!(later.mode == Some(0) && later.from_s == 6.0, "{later:?}");
    let out = ["aircraft.configuration=[\"brake\"]", "configuration_change=[]"];
    let at_once = result(&brake, &out).at_rest.unstable.expect("it grows");
    assert!((later.doubling_s / at_once.doubling_s - 1.0).abs() < 1e-3);
    // A mode that ends before the brake is out does not meet it, as far as anybody knows before the flight.
    let then = "[[mode]]\nname = \"free\"\nat_s = 3.0\nengage = []\n";
    let ends = result(&(braked() + then), &[]);
    assert!(ends.at_rest.unstable.is_none());
    assert_eq!(doubt(&ends), Some(Doubt::ChangedAircraft));
    // And one that begins after it meets the aircraft of the start no more.
    let in_first = ["configuration_change[0].to=0.0", "aircraft.configuration=[\"brake\"]"];
    let free = "[[mode]]\nname = \"free\"\nengage = []\n[[mode]]\nname = \"hold\"\nat_s = 7.0\n";
    let begins = result(&brake.replace("[[mode]]\nname = \"hold\"\n", free), &in_first);
    assert!(begins.at_rest.unstable.is_none() && doubt(&begins).is_none(), "{:?}", begins.at_rest);
}

/// An altitude that is held with the tank full, and swings with it empty.
#[test]
fn loops_around_the_pitch_loop_are_asked_with_an_empty_tank() {
    let tight = ["outer_loop[0].kp=0.6", "outer_loop[1].kp=2.6", "outer_loop[1].ki=1.0"];
    let calm = braked().replace(
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
    let calm = braked().replace("at_s = 5.0\ntakes_s", "at_s = 25.0\ntakes_s");
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

/// A centre of gravity behind the neutral point, with half a degree of elevator and a step of 3 deg.
const AFT: [&str; 3] =
    ["aircraft.cg_mac=0.5", "actuator.position_limit_deg=0.5", "setpoint.amplitude_deg=3.0"];

/// It was "settled" in 20 s and 30 s, `stable` met, and diverged at 57 s.
#[test]
fn an_unstable_aircraft_that_is_held_beyond_its_elevator_is_not_called_stable() {
    let of = |more: &[&str]| doubt(&result(NAVION, &[&AFT[..], more].concat()));
    assert_eq!(of(&[]), Some(Doubt::BeyondLimits));
    assert_eq!(of(&["setpoint.amplitude_deg=0.3"]), None);
    assert_eq!(of(&["actuator.position_limit_deg=8.0"]), None);
    // An aircraft that holds by itself rests somewhere.
    assert_eq!(of(&["aircraft.cg_mac=0.295"]), None);
    // Without a limit of the servo the elevator's own travel is one, whatever moves it there: a load that the servo takes back
    // leaves it where it was.
    let free = |more: &[&str]| {
        let wide = ["actuator.position_limit_deg=90.0", "loop.duration_s=3.0"];
        of(&[&wide[..], more].concat())
    };
    let load = |place: &str, amplitude_deg: f64| {
        let step = "kind=\"step\", at_s=2.9";
        format!("disturbance=[{{{step}, enters_at=\"{place}\", amplitude_deg={amplitude_deg:?}}}]")
    };
    assert_eq!(free(&[]), None);
    assert_eq!(free(&[&load("elevator", 40.0)]), None);
    assert_eq!(free(&[&load("measurement", 500.0)]), Some(Doubt::BeyondLimits));
}

/// Seen through a vertical gyro the pitch of this loop comes to a swing of 0.25 deg from any motion, however small.
#[test]
fn a_gyro_that_erects_to_the_apparent_vertical_is_told_where_small_motions_grow_by_it() {
    let gyro = "[sensor]\npreset = \"vertical-gyro\"\nseed = 1\npitch = { noise_deg_rt_hz = 0.0, bias_deg = 0.0, drift_deg = 0.0 }\nrate = { noise_deg_s_rt_hz = 0.0, bias_deg_s = 0.0 }\n[loop]";
    let text = NAVION.replace("[loop]", gyro);
    let flown = result(&text, &["setpoint.amplitude_deg=0.001", "loop.duration_s=400.0"]);
    assert!(matches!(doubt(&flown), Some(Doubt::Erection { .. })));
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
schema = 1
name = "ages"
[aircraft]
name = "skywalker-x8"
airspeed_m_s = 18
altitude_m = 800
validity = "warn"
thrust = "with-speed"
[lateral]
bank_time_s = 0.64
yaw_damping = 0.6
[actuator]
natural_frequency_rad_s = 25.0
damping = 0.7
delay_samples = 1
[loop]
sample_period_s = 0.1
duration_s = 300.0
[setpoint]
kind = "step"
amplitude_deg = 0.0
[[outer_loop]]
name = "A"
kind = "pid"
holds = "altitude"
moves = "B"
kp = 2.62137
sensor = {delay_s=0.114, period_s=0.2}
[[outer_loop]]
name = "B"
kind = "pid"
holds = "flight-path"
moves = "pitch"
kp = 0.17342
ki = 0.05974
[[outer_loop]]
name = "T"
kind = "pid"
holds = "airspeed"
moves = "throttle"
kp = 5.60665
ki = 0.01364
sensor = {period_s=0.5, delay_s=0.073}
[[outer_loop]]
name = "H"
kind = "pid"
holds = "heading"
moves = "bank"
kp = 1.62985
ki = 0.25207
kd = 0.0171
derivative_filter_s = 1.123
[[mode]]
name = "m"
engage = ["A", "B", "T", "H"]
[[disturbance]]
kind = "pulse"
enters_at = "elevator"
amplitude_deg = 1e-5
at_s = 1.0
width_s = 1.0
[[gust]]
kind = "full-cycle"
right_m_s = 1e-6
gradient_m = 18
at_s = 1.0
[[controller]]
name = "PID"
kind = "pid"
kp = 0.5
ki = 0.3
kd = 0.15
derivative_filter_s = 0.05
"#;

/// Largest change of altitude from one sample to the next in a quarter of a flight.
fn largest_step_m(flown: &ControllerResult, quarter: usize) -> f64 {
    let altitude_m = flown.trace.column("altitude_m").expect("it has one");
    let length = altitude_m.len() / 4;
    let steps = altitude_m.windows(2).skip(quarter * length).take(length - 1);
    steps.fold(0.0, |most: f64, two| most.max((two[1] - two[0]).abs()))
}

/// With the largest age each loop grows, and the flight comes to rest all the same: ages come in turn, and so they are asked.
#[test]
fn loops_that_see_by_clocks_of_their_own_are_asked_with_all_ages_in_turn() {
    let flown = result(AGES, &["loop.duration_s=600.0"]);
    assert!(flown.at_rest.unstable.is_none());
    assert_eq!(doubt(&flown), None);
    let last = flown.trace.theta_rad.iter().rev().take(100).map(|rad| rad.abs());
    assert!(last.fold(0.0, f64::max) < 1e-8);
    // Of a throttle that answers a little more each doubling is the one that is told.
    let faint = ["disturbance[0].amplitude_deg=1e-6", "loop.duration_s=60.0"];
    let answering = |kp: &'static str| result(AGES, &[&[kp], &faint[..]].concat());
    let grown = |flown: &ControllerResult| largest_step_m(flown, 3) / largest_step_m(flown, 2);
    let held = answering("outer_loop[2].kp=6.2");
    assert!(held.at_rest.unstable.is_none() && doubt(&held).is_none() && grown(&held) < 1.0);
    let flown = answering("outer_loop[2].kp=6.4");
    let told_s = flown.at_rest.unstable.expect("it grows").doubling_s;
    let doubling_s = 15.0 * std::f64::consts::LN_2 / grown(&flown).ln();
    assert!((doubling_s / told_s - 1.0).abs() < 0.01, "{doubling_s} {told_s}");
    // A period that no time makes whole is asked at three of its ages.
    let uneven = result(AGES, &["outer_loop[2].sensor.period_s=0.5123456"]);
    assert_eq!(doubt(&uneven), Some(Doubt::ChangingAge));
}

/// With a hundredth of its inertia in yaw. Steps of 10 ms made of a motion of 125 rad/s that doubles in a third of a second one
/// that dies out.
#[test]
fn an_airframe_that_is_faster_than_the_steps_of_the_integration_is_undecided() {
    let light = ["aircraft.iz_kg_m2=60.0", "aircraft.validity=warn"];
    assert_eq!(doubt(&result(NAVION, &light)), Some(Doubt::FastMotion));
    let fine = [&light[..], &["loop.sample_period_s=0.002", "loop.duration_s=5.0"]].concat();
    assert_ne!(doubt(&result(NAVION, &fine)), Some(Doubt::FastMotion));
}

/// A row of Mach numbers at the Mach number of the trim. Differences across it are the mean of two slopes: an altitude that is held
/// by pitch was "stable", and left the range of its data from an error of a centimetre.
#[test]
fn a_trim_right_on_a_kink_of_the_aircrafts_data_is_undecided_and_one_beside_it_is_not() {
    let plant = trimmed(&[]);
    let flow = plant.aircraft().flow(&plant.trim().state, &AirMotion::STILL);
    let rows = |by: f64| {
        let at = |beyond: f64, drag: f64| {
            format!("{{mach={:?}, drag={{reference={drag}}}}}", flow.mach() * (1.0 + by) + beyond)
        };
        let [below, here, above] = [at(-0.05, 0.049), at(0.0, 0.051), at(0.05, 0.09)];
        format!("aircraft.name.mach_row=[{below}, {here}, {above}]")
    };
    let asked = |by: f64, text: &str| {
        let rows = rows(by);
        let set = [rows.as_str(), "aircraft.validity=warn"];
        let study = study(text, &set);
        let analysis = Analysis::of(&study, Question::default()).expect("a loop");
        (doubt(&result(text, &set)), analysis.loops[0].margins().is_ok())
    };
    let throttle = THROTTLE.replace("rate_gain = 1.0", "rate_gain = 0.4");
    for text in [NAVION.to_owned(), format!("{NAVION}{throttle}")] {
        assert_eq!(asked(0.0, &text), (Some(Doubt::Kink), false));
        assert_eq!(asked(1e-4, &text), (None, true));
    }
    // Nor is it certain of a mode that differences across the kink call growing.
    let growing =
        |by: f64| result(&format!("{NAVION}{THROTTLE}"), &[&rows(by), "aircraft.validity=warn"]);
    assert_eq!(doubt(&growing(0.0)), Some(Doubt::Kink));
    assert!(growing(1e-4).at_rest.unstable.is_some_and(|it| it.mode == Some(0)));
}

/// A dive of 14 deg at the throttle of 40 m/s ends at 76 m/s, where the elevator has four times its power.
const DIVE: [&str; 6] = [
    "aircraft.airspeed_ft_s=131.2336",
    "aircraft.altitude_ft=13779.5",
    "actuator={time_constant_s=0.05, delay_samples=6}",
    "setpoint.amplitude_deg=-14.0",
    "controller.PID={name=\"PID\", kind=\"pid\", kp=1.2, ki=2.0, kd=1.4, derivative_filter_s=0.02, setpoint_weights={proportional=0.3, derivative=0.0}}",
    "loop.duration_s=20.0",
];

#[test]
fn a_set_point_that_is_held_on_is_asked_at_the_airspeed_to_which_it_leads() {
    let dive = [&DIVE[..], &["loop.duration_s=80.0"]].concat();
    assert!(matches!(doubt(&result(NAVION, &DIVE)), Some(Doubt::HeldOn { .. })));
    let flown = result(NAVION, &dive);
    assert!(matches!(doubt(&flown), Some(Doubt::HeldOn { .. })));
    let rates = flown.trace.theta_rad.windows(2).rev().take(500);
    let swings = rates.fold(0.0, |most: f64, two| most.max((two[1] - two[0]).abs()));
    assert!(swings > 20.0_f64.to_radians() * 0.01, "{swings}");
    // A smaller dive is held, at the airspeed that is told.
    let small = [&DIVE[..], &["setpoint.amplitude_deg=-2.0", "loop.duration_s=200.0"]].concat();
    let flown = result(NAVION, &small);
    assert_eq!(doubt(&flown), None);
    let airspeed_m_s =
        *flown.trace.column("airspeed_m_s").expect("it has one").last().expect("flown");
    let plant = trimmed(&small);
    let there = plant.aircraft().at_held_pitch(plant.trim(), -2.0_f64.to_radians());
    let told_m_s = there.expect("it glides").target.airspeed_m_s;
    assert!((airspeed_m_s / told_m_s - 1.0).abs() < 0.03, "{airspeed_m_s} {told_m_s}");
}

/// A Navion at 40 m/s whose vertical speed is held by pitch, in two modes.
const TWO_MODES: &str = r#"
schema = 1
name = "two modes"
[aircraft]
name = "navion"
airspeed_m_s = 40.0
altitude_m = 3000.0
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.02
duration_s = 20.0
[setpoint]
kind = "step"
amplitude_deg = 0.0
[[outer_loop]]
name = "vertical speed"
kind = "pid"
holds = "vertical-speed"
moves = "pitch"
kp = 0.5
ki = 0.3
least = -20.0
most = 10.0
most_per_s = 2.0
[[outer_loop]]
name = "autothrottle"
kind = "pid"
holds = "airspeed"
moves = "throttle"
kp = 0.1
ki = 0.01
[[mode]]
name = "level"
engage = ["vertical speed"THROTTLE]
[[mode]]
name = "then"
at_s = 3.0
engage = ["vertical speed"THROTTLE]
target = { TARGET }
[[controller]]
name = "PID"
kind = "pid"
kp = 4
ki = 0.5
kd = 0.3
derivative_filter_s = 0.05
"#;

fn two_modes(throttle: bool, target: &str) -> String {
    let by = if throttle { ", \"autothrottle\"" } else { "" };
    TWO_MODES.replace("THROTTLE", by).replace("TARGET", target)
}

/// How far pitch swings in the last 2000 samples of a flight, deg.
fn swing_deg(flown: &ControllerResult) -> f64 {
    let last = || flown.trace.theta_rad.iter().rev().take(2000);
    let most = last().copied().fold(f64::NEG_INFINITY, f64::max);
    (most - last().copied().fold(f64::INFINITY, f64::min)).to_degrees()
}

/// Modes were asked at the trim of the start alone: pitch swings by 10 deg without end at 78 m/s, "stable" and margins met.
#[test]
fn a_mode_is_asked_at_the_airspeed_that_its_targets_lead_to() {
    let faster = two_modes(true, "airspeed_m_s = 78.0");
    let led = |text: &str, set: &[&str]| match doubt(&result(text, set)) {
        Some(Doubt::Led { led, .. } | Doubt::LedNowhere(led)) => {
            Some((led.mode, led.target, led.airspeed_m_s))
        }
        None => None,
        other => panic!("{other:?}"),
    };
    let (mode, target, airspeed_m_s) = led(&faster, &[]).expect("in doubt");
    assert_eq!((mode, target), (1, Some((Quantity::Airspeed, 78.0))));
    assert!((airspeed_m_s.expect("it is flown") - 78.0).abs() < 1e-9);
    let flown = result(&faster, &["loop.duration_s=300.0"]);
    assert!(swing_deg(&flown) > 5.0, "{}", swing_deg(&flown));
    let why = Analysis::of(&study(&faster, &[]), Question::default()).expect("a loop").json();
    let why = why["controllers"][0]["undecided"].as_str().expect("a reason").to_owned();
    assert!(why.contains("mode 2 of the autopilot, which holds airspeed at 78 m/s,"), "{why}");
    // A little faster it is held, and flown.
    assert_eq!(led(&two_modes(true, "airspeed_m_s = 48.0"), &[]), None);
    let calm = result(&two_modes(true, "airspeed_m_s = 48.0"), &["loop.duration_s=200.0"]);
    assert!(swing_deg(&calm) < 0.2, "{}", swing_deg(&calm));
    // No such flight is in the data.
    let (_, _, nowhere) = led(&two_modes(true, "airspeed_m_s = 150.0"), &[]).expect("in doubt");
    assert_eq!(nowhere, None);
}

/// With nobody at the throttle a path has an airspeed of its own.
#[test]
fn a_mode_without_a_throttle_is_asked_at_the_airspeed_that_its_path_makes() {
    let down = two_modes(false, "vertical_speed_m_s = -4.6");
    let flown = result(&down, &["loop.duration_s=300.0"]);
    let Some(Doubt::Led { led, .. }) = doubt(&flown) else { panic!("{:?}", flown.at_rest) };
    assert_eq!(led.target, Some((Quantity::VerticalSpeed, -4.6)));
    let told_m_s = led.airspeed_m_s.expect("it is flown");
    let airspeed_m_s = flown.trace.column("airspeed_m_s").expect("it has one");
    let last_m_s = airspeed_m_s.last().copied().expect("flown");
    assert!((last_m_s / told_m_s - 1.0).abs() < 0.05, "{last_m_s} {told_m_s}");
    assert!(swing_deg(&flown) > 5.0, "{}", swing_deg(&flown));
    assert_eq!(doubt(&result(&two_modes(false, "vertical_speed_m_s = -0.5"), &[])), None);
    // The loop may not command that path: its pitch ends at its limit, where the airspeed stays low.
    let limited = result(&down, &["loop.duration_s=300.0", "outer_loop[0].least=-6.0"]);
    assert!(doubt(&limited).is_none() && limited.at_rest.unstable.is_none());
    let airspeed_m_s = limited.trace.column("airspeed_m_s").expect("it has one");
    assert!(airspeed_m_s.iter().all(|it| *it < 52.0) && swing_deg(&limited) < 0.01);
}

/// A green mark stood beside a flight whose stability nobody knows.
#[test]
fn the_card_of_a_flight_that_is_undecided_at_rest_is_no_good_one() {
    let card = |text: &str| {
        let study = study(text, &[]);
        let simulation = Simulation::of(&study).expect("it flies");
        report::of_simulation(&study, &simulation)
    };
    let led = card(&two_modes(true, "airspeed_m_s = 78.0"));
    assert!(led.contains("! Flown, stability undecided") && !led.contains("\u{2713} Flown"));
    assert!(card(&two_modes(true, "airspeed_m_s = 48.0")).contains("\u{2713} Flown"));
}

/// A Navion at 42 m/s with an air brake out, which is drawn in.
const DRAWN_IN: &str = r#"
schema = 1
name = "drawn in"
[aircraft]
name = "navion"
airspeed_m_s = 42.0
altitude_m = 1000.0
climb_angle_deg = -3.0
configuration = ["brake"]
[[configuration]]
name = "brake"
assumption = "made up"
drag.reference = 0.12
[[configuration_change]]
name = "brake"
to = 0.0
at_s = 3.0
takes_s = 4.0
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.02
duration_s = 50.0
[setpoint]
kind = "step"
amplitude_deg = 0.5
at_s = 9.0
[[controller]]
name = "PID"
kind = "pid"
kp = 5.0
ki = 0.5
kd = 0.3
derivative_filter_s = 0.05
"#;

/// The changed aircraft was asked with a throttle of its own at the speed of the start, where it is held. The throttle stays, and
/// at 75 m/s the elevator goes from end to end.
#[test]
fn a_changed_aircraft_is_asked_at_the_airspeed_that_its_old_throttle_makes() {
    let brake = doubt(&result(DRAWN_IN, &[]));
    assert!(matches!(brake, Some(Doubt::HeldOn { .. })), "{brake:?}");
    let flown = result(DRAWN_IN, &["loop.duration_s=250.0"]);
    assert!(swing_deg(&flown) > 5.0, "{}", swing_deg(&flown));
    let stays = ["configuration_change[0].to=1.0"];
    assert_eq!(doubt(&result(DRAWN_IN, &stays)), None);
    assert_eq!(doubt(&result(DRAWN_IN, &["controller[0].kp=2.0"])), None);
}

/// `"stable": true` in JSON, where the flight said that nobody knows.
#[test]
fn everything_that_a_flight_doubts_is_in_doubt_for_analyse() {
    let loops = |text: &str, set: &[&str]| {
        let study = study(text, set);
        let found = Analysis::of(&study, Question::default()).expect("a loop");
        // The page of an autopilot's scenario was refused, and told no reason.
        let page = report::of_analysis(&study, &found).expect("a page");
        (found.json()["controllers"][0].clone(), found.stability(), found.text() + &page)
    };
    let (json, stability, text) = loops(NAVION, &AFT);
    assert_eq!((json["stable"].clone(), stability), (Value::Null, Stability::Undecided));
    assert_eq!(json["stability"], "undecided");
    let why = json["undecided"].as_str().expect("a reason");
    assert!(
        why.contains("more elevator than a limit leaves") && text.contains("UNDECIDED"),
        "{why}"
    );
    let why = why.trim_start_matches("undecided: ");
    assert!(text.contains(&format!("Nobody can tell: {why}.")), "the page");
    let (json, stability, _) = loops(NAVION, &[]);
    assert_eq!((json["stable"].clone(), stability), (Value::Bool(true), Stability::Stable));
    assert!(json.get("undecided").is_none());
    // A mode that grows with the aircraft of later has a line of its own.
    let (json, stability, text) = loops(&braked(), &[]);
    assert_eq!((json["stable"].clone(), stability), (Value::Bool(false), Stability::Unstable));
    assert!(text.contains("mode hold, with the aircraft from 6 s on: UNSTABLE"), "{text}");
    assert!(text.contains("it grows in mode hold, with the aircraft from 6 s on"), "the page");
}

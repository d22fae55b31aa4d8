//! Flights of gains that move, without limits: those that do not come back to the rest around which the loop holds.

use fspid_scenario::file::Study;
use fspid_sim::stability::{doubt_of_flight, doubts_of_flights};
use fspid_sim::{Controller, Doubt, EndCause, Scenario, Trace, simulate};
use fspid_study::metrics::Verdict;

use super::{Draw, doubt, is_lost, last_fifths_move_deg, result, study};

/// A step of a plant with an integrator, whose self-tuner has no limit of any kind.
const FREE: &str = r#"
schema = 1
name = "gains that move"
[plant]
numerator = [2.0, 1.0]
denominator = [1.0, 1.2, 2.0, 0.0]
elevator_sign = "nose-up-positive"
[loop]
sample_period_s = 0.02
duration_s = 20.0
[setpoint]
kind = "step"
amplitude_deg = 5.0
[[controller]]
name = "C"
kind = "fspid"
nominal = { kp = 1.0, ki = 0.4, kd = 0.2 }
derivative_filter_s = 0.05
[controller.supervisor]
table = "mirrored"
range = 5.0
error_scale = 2.0
change_scale = 1.0
output_scale = { kp = 0.1, ki = 0.04, kd = 0.02 }
"#;

/// A larger step, whose rules lower kp where the error is large: it diverges after 39 s.
const AWAY: &[&str] = &[
    "setpoint.amplitude_deg=8.0",
    "controller.C.supervisor.output_scale={kp=-0.15, ki=0.2, kd=0.02}",
];

/// A Navion that climbs to a height and captures it; the self-tuner of its vertical speed has an integral whose gain is negative
/// where the error is large.
const CAPTURE: &str = r#"
schema = 1
name = "holds 1300 ft, and flies away from it"
aircraft = { name = "navion", airspeed_ft_s = 176.0, altitude_ft = 1000.0 }
engine = { kind = "first-order", time_constant_s = 1.0 }
actuator = { time_constant_s = 0.1 }
loop = { sample_period_s = 0.02, duration_s = 60.0 }
setpoint = { kind = "step", amplitude_deg = 0.0 }
mode = [{ name = "level", engage = ["altitude", "vertical speed", "autothrottle"] }, { name = "climb", at_s = 5.0, engage = ["vertical speed", "autothrottle"], target = { vertical_speed_ft_min = 500.0 } }, { name = "capture", when = { altitude_above_ft = 1230.0 }, engage = ["altitude", "vertical speed", "autothrottle"], target = { altitude_ft = 1300.0 } }]
controller = [{ name = "PID", kind = "pid", kp = 0.82, ki = 0.43, kd = 0.165, derivative_filter_s = 0.05 }]
requirement = [{ measure = "stable" }]
[[outer_loop]]
name = "altitude"
kind = "pid"
holds = "altitude"
moves = "vertical speed"
kp = 0.4
[[outer_loop]]
name = "vertical speed"
kind = "fspid"
holds = "vertical-speed"
moves = "pitch"
nominal = { kp = 0.5, ki = 0.5 }
[outer_loop.supervisor]
table = "mirrored"
range = 5.0
error_scale = 16.0
change_scale = 40.0
output_scale = { kp = 0.0, ki = 0.12, kd = 0.0 }
[[outer_loop]]
name = "autothrottle"
kind = "pid"
holds = "airspeed"
moves = "throttle"
kp = 0.2
ki = 0.02
"#;

fn drawn(draw: &mut Draw) -> (Vec<String>, f64) {
    let nominal =
        [draw.between(0.2, 4.0), draw.of(&[0.0, 0.2, 0.8, 2.0]), draw.of(&[0.0, 0.1, 0.6])];
    let sizes = nominal.map(|gain: f64| {
        let gain = if gain == 0.0 { 0.3 * nominal[0] } else { gain };
        gain * draw.between(0.02, 0.6) * draw.of(&[0.2, 0.4, 0.9, -0.4])
    });
    let duration_s = draw.between(8.0, 30.0);
    let set = vec![
        format!(
            "plant.denominator=[1.0, {:?}, {:?}{}]",
            draw.between(0.3, 4.0),
            draw.between(0.3, 8.0),
            draw.of(&["", ", 0.0"]),
        ),
        format!("setpoint.amplitude_deg={:?}", draw.between(1.0, 10.0)),
        format!("loop.duration_s={duration_s:?}"),
        format!(
            "controller.C.nominal={{kp={:?}, ki={:?}, kd={:?}}}",
            nominal[0], nominal[1], nominal[2]
        ),
        format!(
            "controller.C.supervisor.output_scale={{kp={:?}, ki={:?}, kd={:?}}}",
            sizes[0], sizes[1], sizes[2]
        ),
        format!("controller.C.supervisor.error_scale={:?}", draw.between(0.2, 8.0)),
        format!("controller.C.supervisor.change_scale={:?}", draw.between(0.1, 4.0)),
        format!("controller.C.supervisor.table={}", draw.of(&["printed", "mirrored"])),
        format!("controller.C.integral={}", draw.of(&["literal", "bumpless"])),
    ];
    (set, duration_s)
}

/// Of 1750 such flights that were `stable`, a fortieth diverged within ten times their length.
#[test]
fn flights_of_drawn_gains_that_move_and_are_called_stable_come_back_in_ten_times_their_length() {
    let mut draw = Draw::seeded(146);
    let (mut stable, mut lost, mut swings) = (0, 0, 0);
    for number in 0..350 {
        let (set, duration_s) = drawn(&mut draw);
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let flown = result(FREE, &set);
        let long = format!("loop.duration_s={:?}", f64::max(10.0 * duration_s, 200.0));
        let flown_on = || result(FREE, &[&set[..], &[long.as_str()]].concat());
        if doubt(&flown) == Some(Doubt::AwayFromRest) {
            let flown_on = flown_on();
            let [last, before] = last_fifths_move_deg(&flown_on);
            lost += usize::from(is_lost(&flown_on));
            swings += usize::from(!is_lost(&flown_on));
            assert!(is_lost(&flown_on) || last > 0.9 * before, "{number}: {set:?}");
        } else if flown.at_rest.stability_word() == Some("stable") {
            stable += 1;
            let flown_on = flown_on();
            let [last, before] = last_fifths_move_deg(&flown_on);
            assert!(!is_lost(&flown_on), "{number}: {set:?}");
            // What moves by less than a thousandth of all its movement is at rest.
            let at_rest_deg = 1e-3 * flown_on.trace.setpoint_rad[0].to_degrees();
            let comes_back = last < before || last < at_rest_deg;
            assert!(comes_back, "{number}: {last} after {before} deg, {set:?}");
        }
    }
    assert!(stable > 100 && lost > 3 && swings > 1, "{stable} {lost} {swings}");
}

/// An aircraft that holds its height by a vertical speed whose self-tuner drives large errors away: it was `stable` for the minute
/// of its scenario, met every requirement, and was lost a minute later.
#[test]
fn an_aircraft_whose_outer_gains_drive_it_away_after_its_flight_is_undecided() {
    let flown = result(CAPTURE, &[]);
    assert_eq!(flown.metrics.verdict, Verdict::Flown);
    assert!(matches!(doubt(&flown), Some(Doubt::AwayFromRest | Doubt::SwingAtLimits)));
    assert!(is_lost(&result(CAPTURE, &["loop.duration_s=240.0"])));
    // Rules that leave the integral its sign bring it back.
    let held = result(CAPTURE, &["outer_loop.vertical speed.supervisor.output_scale.ki=0.02"]);
    assert_eq!(doubt(&held), None);
}

/// With the noise of a sensor, and in steps of one: what moves a flight for ever, or keeps it from standing still, is not taken for
/// gains that leave the rest, and does not hide those that do.
#[test]
fn noise_swings_and_widths_neither_hide_what_leaves_the_rest_nor_are_taken_for_it() {
    let noise = "[[disturbance]]\nkind = \"noise\"\nenters_at = \"measurement\"\nstandard_deviation_deg = 0.02\nseed = 1\n";
    let sine = "[[disturbance]]\nkind = \"sine\"\nenters_at = \"servo\"\namplitude_deg = 0.2\nfrequency_hz = 0.4\n";
    let slow = "[[disturbance]]\nkind = \"sine\"\nenters_at = \"servo\"\namplitude_deg = 0.2\nfrequency_hz = 0.003\n";
    let play = "[actuator]\ntime_constant_s = 0.05\nbacklash_deg = 0.2\n";
    let steps = "[sensor]\npreset = \"ideal\"\n[sensor.pitch]\nresolution_deg = 0.05\n";
    for moves in ["", noise, sine, slow, play, steps] {
        let text = format!("{FREE}{moves}");
        assert_eq!(doubt(&result(&text, &[])), None, "{moves}");
        let away = doubt(&result(&text, AWAY));
        assert_eq!(away, Some(Doubt::AwayFromRest), "{moves}");
        assert!(is_lost(&result(&text, &[AWAY, &["loop.duration_s=400.0"]].concat())), "{moves}");
    }
}

/// Rules in rings around a middle that holds, from which a step of 7 deg swings by 6.6 deg for ever.
const RINGS: &str = r#"
schema = 1
name = "rings of rules"
plant = { numerator = [2.0, 1.0], denominator = [1.0, 3.374, 0.761, 0.0], elevator_sign = "nose-up-positive" }
loop = { sample_period_s = 0.02, duration_s = 10.48 }
setpoint = { kind = "step", amplitude_deg = 7.345 }
[[controller]]
name = "C"
kind = "fspid"
nominal = { kp = 3.676, ki = 2.0, kd = 0.1 }
derivative_filter_s = 0.05
supervisor = { numbers = { delta_kp = [[0.85, 0.85, 0.85, 0.85, 0.85, 0.85, 0.85], [0.85, -0.018, -0.018, -0.018, -0.018, -0.018, 0.85], [0.85, -0.018, -0.987, -0.987, -0.987, -0.018, 0.85], [0.85, -0.018, -0.987, 0.0, -0.987, -0.018, 0.85], [0.85, -0.018, -0.987, -0.987, -0.987, -0.018, 0.85], [0.85, -0.018, -0.018, -0.018, -0.018, -0.018, 0.85], [0.85, 0.85, 0.85, 0.85, 0.85, 0.85, 0.85]], delta_ki = [[-0.898, -0.898, -0.898, -0.898, -0.898, -0.898, -0.898], [-0.898, -0.641, -0.641, -0.641, -0.641, -0.641, -0.898], [-0.898, -0.641, 0.536, 0.536, 0.536, -0.641, -0.898], [-0.898, -0.641, 0.536, 0.0, 0.536, -0.641, -0.898], [-0.898, -0.641, 0.536, 0.536, 0.536, -0.641, -0.898], [-0.898, -0.641, -0.641, -0.641, -0.641, -0.641, -0.898], [-0.898, -0.898, -0.898, -0.898, -0.898, -0.898, -0.898]], delta_kd = [[0.423, 0.423, 0.423, 0.423, 0.423, 0.423, 0.423], [0.423, -0.914, -0.914, -0.914, -0.914, -0.914, 0.423], [0.423, -0.914, 0.87, 0.87, 0.87, -0.914, 0.423], [0.423, -0.914, 0.87, 0.0, 0.87, -0.914, 0.423], [0.423, -0.914, 0.87, 0.87, 0.87, -0.914, 0.423], [0.423, -0.914, -0.914, -0.914, -0.914, -0.914, 0.423], [0.423, 0.423, 0.423, 0.423, 0.423, 0.423, 0.423]] }, range = 5.0, error_scale = 0.556, change_scale = 1.14, output_scale = { kp = 3.492, ki = 1.9, kd = 0.095 } }
"#;

/// Beside a deadband of a millionth of a degree, a set-point that swings by as little, or noise of a billionth, it was `stable`.
#[test]
fn a_swing_that_stays_is_seen_behind_widths_swings_and_noise_however_small_they_are() {
    let beside = [
        "",
        "[actuator]\ntime_constant_s = 0.001\ndeadband_deg = 1e-6\n",
        "[actuator]\ntime_constant_s = 0.001\nbacklash_deg = 1e-6\n",
        "[sensor]\npreset = \"ideal\"\n[sensor.rate]\nresolution_deg_s = 1e-7\n",
        "[[disturbance]]\nkind = \"sine\"\nenters_at = \"servo\"\namplitude_deg = 1e-6\nfrequency_hz = 0.2\n",
        "[[disturbance]]\nkind = \"noise\"\nenters_at = \"measurement\"\nstandard_deviation_deg = 1e-9\nseed = 1\n",
    ];
    for beside in beside {
        let text = format!("{RINGS}{beside}");
        assert_eq!(doubt(&result(&text, &[])), Some(Doubt::AwayFromRest), "{beside}");
    }
    let swung = RINGS.replace(
        "setpoint = { kind = \"step\", amplitude_deg = 7.345 }",
        "setpoint = { kind = \"square\", amplitude_deg = 7.345, half_period_s = 20.0 }",
    );
    assert_ne!(swung, RINGS);
    assert_eq!(doubt(&result(&swung, &["loop.duration_s=40.0"])), Some(Doubt::AwayFromRest));
    // Without the rules it settles, whatever stands beside it.
    let fixed = "controller.C.supervisor.output_scale={ kp = 0.0, ki = 0.0, kd = 0.0 }";
    assert_eq!(doubt(&result(RINGS, &[fixed])), None);
    let [last, before] = last_fifths_move_deg(&result(RINGS, &["loop.duration_s=300.0"]));
    assert!(last > 1.0 && last > 0.99 * before, "{last} {before}");
}

/// A step is flown on until it moves by a fiftieth of all its movement with gains that stand: a swing that is smaller than that moves
/// them.
#[test]
fn a_swing_of_a_hundredth_of_the_step_that_gains_keep_up_is_seen() {
    for times in [50.0, 100.0] {
        let error_scale = format!("controller.C.supervisor.error_scale={:?}", 0.556 * times);
        let change_scale = format!("controller.C.supervisor.change_scale={:?}", 1.14 * times);
        let set = [error_scale.as_str(), &change_scale];
        assert_eq!(doubt(&result(RINGS, &set)), Some(Doubt::AwayFromRest), "{times}");
        let long = result(RINGS, &[&set[..], &["loop.duration_s=300.0"]].concat());
        let [last, before] = last_fifths_move_deg(&long);
        assert!(last < 7.345 / 50.0 && last > 0.99 * before, "{last} {before}");
    }
}

/// A loop that a load makes unstable at rest, whose integral is as large as the load and has a gain that follows the error.
const LOADED: &str = r#"
schema = 1
name = "under a load"
plant = { preset = "navion-paper" }
loop = { sample_period_s = 0.01, duration_s = 10.0 }
setpoint = { kind = "step", amplitude_deg = 1.0, at_s = 1.0 }
[[controller]]
name = "C"
kind = "fspid"
nominal = { kp = 0.5658, ki = 0.649, kd = 0.3112 }
supervisor = { table = "mirrored", range = 5.0, error_scale = 4.536, change_scale = 0.2846, output_scale = { kp = 0.02123, ki = 0.04714, kd = 0.02135 } }
derivative_filter_s = 0.06683
derivative_on = "measurement"
integral = "literal"
"#;

/// It was called unstable for a load that begins after its flight as well.
#[test]
fn a_load_that_begins_after_the_flight_is_none_that_the_loop_rests_under() {
    let shapes =
        ["kind = \"step\"", "kind = \"pulse\"\nwidth_s = 9.0", "kind = \"ramp\"\nwidth_s = 1.0"];
    for shape in shapes {
        let loaded = |at_s: f64| {
            let load = format!(
                "[[disturbance]]\n{shape}\nenters_at = \"elevator\"\namplitude_deg = 15.0\nat_s = {at_s:?}\n"
            );
            result(&format!("{LOADED}{load}"), &[]).at_rest.stability_word()
        };
        assert_eq!(loaded(5.0), Some("unstable"), "{shape}");
        assert_eq!(loaded(10.01), Some("stable"), "{shape}");
    }
}

/// Two steps of a load that cancel are a pulse.
#[test]
fn loads_that_others_take_off_again_within_the_flight_are_none_that_the_loop_rests_under() {
    let step = |at_s: f64, amplitude_deg: f64| {
        format!(
            "[[disturbance]]\nkind = \"step\"\nenters_at = \"elevator\"\nat_s = {at_s:?}\namplitude_deg = {amplitude_deg:?}\n"
        )
    };
    let loaded = |loads: &[String]| {
        result(&format!("{LOADED}{}", loads.concat()), &[]).at_rest.stability_word()
    };
    let [on, off] = [step(5.0, 15.0), step(6.0, -15.0)];
    assert_eq!(loaded(std::slice::from_ref(&on)), Some("unstable"));
    assert_eq!(loaded(&[off, on.clone()]), Some("stable"));
    // What is taken off after the end is held by the flight.
    assert_eq!(loaded(&[on, step(10.01, -15.0)]), Some("unstable"));
}

/// Campaigns ask the flights of a group side by side.
#[test]
fn flights_that_are_flown_on_side_by_side_are_in_doubt_as_each_of_them_alone() {
    let mut draw = Draw::seeded(147);
    let beside = [
        "",
        "[[disturbance]]\nkind = \"noise\"\nenters_at = \"measurement\"\nstandard_deviation_deg = 0.02\nseed = 1\n",
        "[[disturbance]]\nkind = \"sine\"\nenters_at = \"servo\"\namplitude_deg = 0.2\nfrequency_hz = 0.4\n",
        "[actuator]\ntime_constant_s = 0.05\n",
        "[actuator]\ntime_constant_s = 0.05\nrate_limit_deg_s = 20.0\n",
        "[actuator]\ntime_constant_s = 0.05\nbacklash_deg = 0.2\n",
    ];
    let mut found = [0; 2];
    // What stands beside all of a group, or beside each of them another.
    for group in 0..7 {
        let studies: Vec<Study> = (0..11)
            .map(|flight| {
                let text = format!("{FREE}{}", beside[if group < 6 { group } else { flight % 6 }]);
                let (set, _) = drawn(&mut draw);
                let set: Vec<&str> = set.iter().map(String::as_str).collect();
                study(&text, &[&set[..], &["loop.duration_s=12.0"]].concat())
            })
            .collect();
        let traces: Vec<Trace> = studies
            .iter()
            .map(|it| simulate(&it.scenario).expect("it flies").traces.remove(0))
            .collect();
        let flights: Vec<(&Scenario, &Controller, &Trace)> = studies
            .iter()
            .zip(&traces)
            .map(|(it, trace)| (&it.scenario, &it.scenario.controllers[0].controller, trace))
            .collect();
        let alone = |it: &(&Scenario, &Controller, &Trace)| doubt_of_flight(it.0, it.1, it.2);
        let alone: Vec<Option<Doubt>> = flights.iter().map(alone).collect();
        assert_eq!(doubts_of_flights(&flights), alone, "{group}");
        alone.iter().for_each(|doubt| found[usize::from(doubt.is_some())] += 1);
    }
    assert!(found[0] > 20 && found[1] > 5, "{found:?}");
}

/// A climb by an altitude loop whose kp the rules make negative where the error is large: at the limit of its vertical speed the
/// pitch stands, and the altitude goes away. It was `stable`, certified, and "HOLDS, AND IS WHAT FLIES".
const GOES_AWAY: &str = r#"
schema = 1
name = "climbs to 1300 ft, and flies into the ground"
aircraft = { name = "navion", airspeed_ft_s = 176.0, altitude_ft = 1000.0 }
engine = { kind = "first-order", time_constant_s = 1.0 }
actuator = { time_constant_s = 0.1 }
loop = { sample_period_s = 0.02, duration_s = 60.0 }
setpoint = { kind = "step", amplitude_deg = 0.0 }
mode = [{ name = "level", engage = ["altitude", "vertical speed", "autothrottle"] }, { name = "capture", at_s = 5.0, engage = ["altitude", "vertical speed", "autothrottle"], target = { altitude_ft = 1300.0 } }]
controller = [{ name = "PID", kind = "pid", kp = 0.82, ki = 0.43, kd = 0.165, derivative_filter_s = 0.05 }]
[[outer_loop]]
name = "altitude"
kind = "fspid"
holds = "altitude"
moves = "vertical speed"
nominal = { kp = 0.2, ki = 0.004, kd = 0.0 }
least = -2.54
most = 2.54
[outer_loop.supervisor]
numbers = { delta_kp = [[-1, -1, -1, -1, -1, -1, -1], [-0.3, -0.3, -0.3, -0.3, -0.3, -0.3, -0.3], [0, 0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0, 0], [-0.3, -0.3, -0.3, -0.3, -0.3, -0.3, -0.3], [-1, -1, -1, -1, -1, -1, -1]], delta_ki = [[0,0,0,0,0,0,0],[0,0,0,0,0,0,0],[0,0,0,0,0,0,0],[0,0,0,0,0,0,0],[0,0,0,0,0,0,0],[0,0,0,0,0,0,0],[0,0,0,0,0,0,0]], delta_kd = [[0,0,0,0,0,0,0],[0,0,0,0,0,0,0],[0,0,0,0,0,0,0],[0,0,0,0,0,0,0],[0,0,0,0,0,0,0],[0,0,0,0,0,0,0],[0,0,0,0,0,0,0]] }
range = 5.0
error_scale = 0.05
change_scale = 1.0
output_scale = { kp = 0.3, ki = 0.0, kd = 0.0 }
[[outer_loop]]
name = "vertical speed"
kind = "pid"
holds = "vertical-speed"
moves = "pitch"
kp = 0.5
ki = 0.5
[[outer_loop]]
name = "autothrottle"
kind = "pid"
holds = "airspeed"
moves = "throttle"
kp = 0.2
ki = 0.02
"#;

#[test]
fn an_altitude_that_goes_away_from_what_is_held_at_a_limit_of_its_loop_is_undecided() {
    let flown = result(GOES_AWAY, &[]);
    assert_eq!(flown.metrics.verdict, Verdict::Flown);
    assert!(doubt(&flown).is_some());
    let hits =
        result(GOES_AWAY, &["mode.capture.target.altitude_ft=2000.0", "loop.duration_s=200.0"]);
    assert!(doubt(&hits).is_some(), "{:?}", hits.metrics.verdict);
    let held = "outer_loop.altitude.supervisor.output_scale.kp=0.0";
    assert_ne!(doubt(&result(GOES_AWAY, &[held])), Some(Doubt::AwayFromRest));
}

/// A step of a Navion, linear or with its own six degrees of freedom, whose integral the rules make negative where the error is
/// large. Linear it diverges, in still air as in any; nonlinear it comes off its set-point and flies into the ground.
const DIVES: &str = r#"
schema = 1
name = "an integral that drives away"
aircraft = { name = "navion", airspeed_ft_s = 176.0, altitude_ft = 1000.0, model = "linear" }
loop = { sample_period_s = 0.02, duration_s = 19.28 }
setpoint = { kind = "step", amplitude_deg = 6.386 }
[[controller]]
name = "C"
kind = "fspid"
nominal = { kp = 0.638, ki = 0.2, kd = 0.0 }
derivative_filter_s = 0.05
supervisor = { table = "mirrored", range = 5.0, error_scale = 4.771, change_scale = 1.505, output_scale = { kp = 0.1267, ki = 0.0905, kd = -0.0427 } }
"#;

/// In moving air flights were not flown on: a steady wind, of which a linear plant feels nothing, made this loop `stable`.
#[test]
fn moving_air_does_not_hide_gains_that_leave_their_rest() {
    let airs = [
        "",
        "[wind]\nkind = \"steady\"\nspeed_m_s = 1.0\nfrom_deg = 0.0\n",
        "[[gust]]\nkind = \"full-cycle\"\nup_m_s = 2.0\ngradient_m = 30.0\nat_s = 5.0\n",
        "[turbulence]\nintensity = \"light\"\nseed = 1\n",
    ];
    for air in airs {
        let text = format!("{DIVES}{air}");
        assert_eq!(doubt(&result(&text, &[])), Some(Doubt::AwayFromRest), "{air}");
        assert!(is_lost(&result(&text, &["loop.duration_s=200.0"])), "{air}");
        // Rules that leave the integral its sign bring it back.
        let held = "controller.C.supervisor.output_scale.ki=0.02";
        assert_eq!(doubt(&result(&text, &[held])), None, "{air}");
    }
}

/// What comes off its set-point without turning back was taken for the drift of speed and height.
#[test]
fn an_aircraft_that_its_gains_drive_off_its_set_point_is_undecided_whether_or_not_it_turns_back() {
    let nonlinear = "aircraft.model=nonlinear";
    let flown = result(DIVES, &[nonlinear]);
    assert!(matches!(flown.metrics.verdict, Verdict::NotSettled { .. }));
    assert_eq!(doubt(&flown), Some(Doubt::AwayFromRest));
    let on = result(DIVES, &[nonlinear, "loop.duration_s=100.0"]);
    let hits_the_ground = EndCause::HitGround;
    assert!(matches!(on.metrics.verdict, Verdict::EndedEarly(end) if end.cause == hits_the_ground));
    assert_eq!(doubt(&on), Some(Doubt::AwayFromRest));
    let held = "controller.C.supervisor.output_scale.ki=0.02";
    assert_eq!(doubt(&result(DIVES, &[nonlinear, held])), None);
}

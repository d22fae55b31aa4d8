//! Turns of an aircraft: in moving air, at the stops of aileron and elevator.

use fspid_sim::Doubt;

use crate::flying::{column, doubt, result};

const TURN: &str = include_str!("../../../../scenarios/gallery/turn.toml");

/// With the speed over the ground in the yaw damper the bank was off by 4.7 deg.
#[test]
fn a_steady_wind_carries_a_turn_along_and_changes_nothing_about_it() {
    let banks = |speed_m_s: f64| {
        let wind =
            format!("wind={{ kind = \"steady\", speed_m_s = {speed_m_s:?}, from_deg = 0.0 }}");
        let trace = result(TURN, &["mode[1].target.heading_deg=179.0", &wind]).trace;
        trace.column("bank_rad").expect("an aircraft's").to_vec()
    };
    let off = banks(20.0).into_iter().zip(banks(0.001)).map(|(one, other)| (one - other).abs());
    let most_rad = off.fold(0.0, f64::max);
    assert!(most_rad < 1e-6, "{most_rad} rad");
}

/// A small unmanned aircraft that holds its path over the ground begins in a tailwind and turns into it.
const INTO_THE_WIND: &str = r#"
schema = 1
name = "Aerosonde turns from a tailwind into a headwind"
[aircraft]
name = "aerosonde"
airspeed_m_s = 25.0
altitude_m = 200.0
thrust = "constant"
[actuator]
time_constant_s = 0.05
[loop]
sample_period_s = 0.01
duration_s = 30.0
[setpoint]
kind = "step"
amplitude_deg = 0.0
[wind]
kind = "steady"
speed_m_s = 15.0
from_deg = 180.0
[[outer_loop]]
name = "flight path"
kind = "pid"
holds = "flight-path"
moves = "pitch"
kp = 5
ki = 0.5
[[outer_loop]]
name = "autothrottle"
kind = "pid"
holds = "airspeed"
moves = "throttle"
kp = 0.05
ki = 0.01
[[outer_loop]]
name = "heading"
kind = "pid"
holds = "heading"
moves = "bank"
kp = 1.0
least = -20.0
most = 20.0
[[mode]]
name = "level"
engage = ["flight path", "autothrottle", "heading"]
[[mode]]
name = "turn back"
at_s = 2.0
engage = ["flight path", "autothrottle", "heading"]
target = { flight_path_deg = 0.001, heading_deg = 180.0 }
[[controller]]
name = "PID"
kind = "pid"
kp = 0.5
ki = 0.5
kd = 0.03
derivative_filter_s = 0.02
"#;

/// It was asked in the tailwind of its start alone: "stable" of a path that swings by 12 deg for ever.
#[test]
fn a_mode_is_asked_in_the_wind_as_it_blows_on_the_heading_that_it_turns_to() {
    let told = doubt(&result(INTO_THE_WIND, &[]));
    assert!(matches!(told, Some(Doubt::WindOnAHeading { .. })), "{told:?}");
    let long = result(INTO_THE_WIND, &["loop.duration_s=200.0"]);
    let path = &column(&long.trace, "flight_path_rad")[15_000..];
    let ends = |ends: [f64; 2], it: &f64| [ends[0].min(*it), ends[1].max(*it)];
    let [least, most] = path.iter().fold([f64::INFINITY, f64::NEG_INFINITY], ends);
    assert!((most - least).to_degrees() > 10.0, "{least} {most}");
    // It holds with the wind from the side, and in less of it.
    for calm in ["mode[1].target.heading_deg=90.0", "wind.speed_m_s=5.0"] {
        let flight = result(INTO_THE_WIND, &[calm]);
        assert!(flight.at_rest.unstable.is_none() && doubt(&flight).is_none(), "{calm}");
    }
}

/// Small motions jumped there from one end of the circle to the other: "doubles every 0.0006 s".
#[test]
fn who_begins_to_the_south_is_as_stable_as_who_begins_to_the_north() {
    for heading_deg in [180.0, -180.0, 179.9] {
        let set = ["aircraft.heading_deg", "mode[1].target.heading_deg"]
            .map(|path| format!("{path}={heading_deg:?}"));
        let flight = result(INTO_THE_WIND, &[&set[0], &set[1], "wind.from_deg=0.0"]);
        assert!(flight.at_rest.unstable.is_none() && doubt(&flight).is_none(), "{heading_deg}");
    }
}

/// A steep turn in which altitude and airspeed are held.
const STEEP: &str = r#"
schema = 1
name = "a turn that sinks"
[aircraft]
name = "aerosonde"
airspeed_m_s = 25.0
altitude_m = 200.0
[lateral]
bank_time_s = 0.3
yaw_damping = 0.0
[actuator]
time_constant_s = 0.05
[loop]
sample_period_s = 0.02
duration_s = 40.0
[setpoint]
kind = "step"
amplitude_deg = 0.0
[[outer_loop]]
name = "altitude"
kind = "pid"
holds = "altitude"
moves = "vertical speed"
kp = 0.15
least = -5.0
most = 5.0
[[outer_loop]]
name = "vertical speed"
kind = "pid"
holds = "vertical-speed"
moves = "pitch"
kp = 2.0
ki = 0.2
[[outer_loop]]
name = "autothrottle"
kind = "pid"
holds = "airspeed"
moves = "throttle"
kp = 0.05
ki = 0.02
[[mode]]
name = "straight"
engage = ["altitude", "vertical speed", "autothrottle"]
[[mode]]
name = "a turn that sinks"
at_s = 2.0
engage = ["altitude", "vertical speed", "autothrottle"]
bank_deg = 58.0
[[controller]]
name = "PID"
kind = "pid"
kp = 1.2
ki = 0.2
kd = 0.08
derivative_filter_s = 0.05
"#;

/// Its pitch rate takes more elevator than the load alone, and a leveller lets the bank come out steeper than it is asked for: it
/// was "stable", flown for 400 s as well, in which it sank to the ground with its elevator at the stop.
#[test]
fn a_turn_that_leaves_its_altitude_at_the_stop_of_the_elevator_is_in_doubt() {
    for set in [&[][..], &["loop.duration_s=400.0"]] {
        let flight = result(STEEP, set);
        assert_eq!(doubt(&flight), Some(Doubt::SwingAtLimits), "{set:?}");
    }
    let flight = result(STEEP, &["mode[1].bank_deg=40.0"]);
    assert!(flight.at_rest.unstable.is_none() && doubt(&flight).is_none());
}

/// A transport whose heading loop asks for more than its aileron gives.
const SWINGING: &str = r#"
schema = 1
name = "heading swings at the limits of bank and aileron"
[aircraft]
name = "b747-cruise-low"
airspeed_m_s = 205.0
altitude_m = 6096.0
[lateral]
bank_time_s = 0.5
yaw_damping = 0.7
[actuator]
time_constant_s = 0.05
[loop]
sample_period_s = 0.05
duration_s = 60.0
[setpoint]
kind = "step"
amplitude_deg = 0.0
[[outer_loop]]
name = "heading"
kind = "pid"
holds = "heading"
moves = "bank"
kp = 16.0
least = -30.0
most = 30.0
[[outer_loop]]
name = "altitude"
kind = "pid"
holds = "altitude"
moves = "pitch"
kp = 0.1
ki = 0.01
kd = 0.1
least = -10.0
most = 10.0
[[outer_loop]]
name = "autothrottle"
kind = "pid"
holds = "airspeed"
moves = "throttle"
kp = 0.1
ki = 0.01
[[mode]]
name = "straight"
engage = ["heading", "altitude", "autothrottle"]
[[mode]]
name = "turn"
at_s = 2.0
engage = ["heading", "altitude", "autothrottle"]
target = { heading_deg = 90.0 }
[[controller]]
name = "PID"
kind = "pid"
kp = 1.5
ki = 0.5
kd = 1.2
derivative_filter_s = 0.05
"#;

/// Its bank swings by 25 deg from stop to stop of the aileron for ever, with a pitch that hardly moves: it was "stable" after any
/// time.
#[test]
fn a_bank_that_swings_at_the_stops_of_the_aileron_is_in_doubt() {
    for set in [&[][..], &["loop.duration_s=600.0"], &["mode[1].target.heading_deg=1.0"]] {
        let flight = result(SWINGING, set);
        assert_eq!(doubt(&flight), Some(Doubt::SwingAtLimits), "{set:?}");
    }
    let flight = result(SWINGING, &["outer_loop[0].kp=2.0"]);
    assert!(flight.at_rest.unstable.is_none() && doubt(&flight).is_none());
}

/// A heading by its derivative as it is seen, late by two samples and a half.
const SEEN_LATE: &str = r#"outer_loop[3]={ name = "heading", kind = "pid", holds = "heading", moves = "bank", kp = 1.2, kd = 0.3, derivative_on = "measurement", derivative_filter_s = 0.5, least = -30.0, most = 30.0, sensor = { delay_s = 0.05 } }"#;

/// The same by half of its target.
const WEIGHED: &str = r#"outer_loop[3]={ name = "heading", kind = "pid", holds = "heading", moves = "bank", kp = 1.2, ki = 0.1, setpoint_weights = { proportional = 0.5, derivative = 0.0 }, least = -30.0, most = 30.0 }"#;

/// A target in another turn than the heading that was held moved what the derivative sees by a whole turn, and between a sample on
/// each side of south a late sensor showed north.
#[test]
fn a_turn_is_flown_alike_whichever_way_it_heads() {
    let banks = |heading_loop: &str, from_deg: f64, by_deg: f64| {
        let heading = format!("aircraft.heading_deg={from_deg:?}");
        let to_deg = (from_deg + by_deg).rem_euclid(360.0);
        let target = format!("mode[1].target.heading_deg={to_deg:?}");
        let trace = result(TURN, &[heading_loop, &heading, &target, "loop.duration_s=30.0"]).trace;
        trace.column("bank_rad").expect("an aircraft's").to_vec()
    };
    let turns = [SEEN_LATE, WEIGHED].map(|it| [0.0, 20.0, -20.0, 150.0].map(|by_deg| (it, by_deg)));
    for (heading_loop, by_deg) in turns.into_iter().flatten() {
        let known = banks(heading_loop, 50.0, by_deg);
        for from_deg in [5.0, 95.0, 175.0, 185.0, 200.0, 355.0] {
            let off = banks(heading_loop, from_deg, by_deg)
                .into_iter()
                .zip(&known)
                .map(|(one, other)| (one - other).abs());
            let most_rad = off.fold(0.0, f64::max);
            assert!(most_rad < 1e-6, "{most_rad} rad from {from_deg} by {by_deg} deg");
        }
    }
}

/// A self-tuner whose kp the rules turn round where the error is large: it flies past its heading, and round again.
const ROUND: &str = r#"outer_loop[3]={ name = "heading", kind = "fspid", holds = "heading", moves = "bank", nominal = { kp = 3.503, ki = 0.0, kd = 0.038 }, least = -15.0, most = 15.0, most_per_s = 2.0, derivative_on = "measurement", supervisor = { table = "printed", range = 5.0, error_sign = "measurement-minus-setpoint", error_scale = 4.2576, change = "rate", change_scale = 0.1645, output_scale = { kp = 1.1008, ki = 0.0, kd = 0.0056 } } }"#;

/// The pitch rests while the heading goes round: of 60 s, and of 3000 s in which it circles, it was `stable`.
#[test]
fn a_heading_that_goes_round_and_does_not_come_to_what_is_held_is_in_doubt() {
    let turned = |set: &[&str]| {
        let own = ["lateral.bank_time_s=5.0", "mode[1].target.heading_deg=320.0", ROUND];
        doubt(&result(TURN, &[&own[..], set].concat()))
    };
    assert_eq!(turned(&[]), Some(Doubt::AwayFromRest));
    assert!(turned(&["loop.duration_s=3000.0"]).is_some());
    let gentler = "outer_loop[3].supervisor.output_scale={ kp = 0.95, ki = 0.0, kd = 0.0056 }";
    assert_eq!(turned(&[gentler]), None);
}

/// An approach that begins 40 m above its beam, with an integral whose gain the rules turn round where the error is large.
const LEAVES_ITS_BEAM: &str = r#"
schema = 1
name = "leaves its beam"
aircraft = { name = "navion", airspeed_ft_s = 176.0, altitude_ft = 8000.0, thrust = "with-speed" }
engine = { kind = "first-order", time_constant_s = 1.0 }
lateral = { yaw_damping = 0.4 }
actuator = { time_constant_s = 0.1 }
loop = { sample_period_s = 0.05, duration_s = 60.0 }
setpoint = { kind = "step", amplitude_deg = 0.0 }
glide_slope = { angle_deg = 3.0, distance_m = 45764.2 }
mode = [{ name = "approach", engage = ["beam", "flight path", "autothrottle"] }]
controller = [{ name = "PID", kind = "pid", kp = 0.82, ki = 0.43, kd = 0.165, derivative_filter_s = 0.05 }]
[[outer_loop]]
name = "beam"
kind = "fspid"
holds = "glide-slope"
moves = "flight path"
nominal = { kp = 0.09, ki = 0.002, kd = 0.0 }
least = -2.0
most = 2.0
most_per_s = 0.5
supervisor = { table = "printed", range = 5.0, error_sign = "measurement-minus-setpoint", error_scale = 0.5, change = "rate", change_scale = 0.1, output_scale = { kp = 0.033, ki = -0.0007, kd = 0.0 } }
[[outer_loop]]
name = "flight path"
kind = "pid"
holds = "flight-path"
moves = "pitch"
kp = 0.6
ki = 0.4
least = -10.0
most = 10.0
[[outer_loop]]
name = "autothrottle"
kind = "pid"
holds = "airspeed"
moves = "throttle"
kp = 0.1
ki = 0.02
"#;

/// It leaves it by 1.9 m/s for good, and was `stable`, of 60 s and of 600 s.
#[test]
fn a_beam_that_is_left_is_in_doubt() {
    let left = |set: &[&str]| doubt(&result(LEAVES_ITS_BEAM, set));
    assert!(left(&[]).is_some());
    assert!(left(&["loop.duration_s=600.0"]).is_some());
    let fixed = "outer_loop[0].supervisor.output_scale={ kp = 0.0, ki = 0.0, kd = 0.0 }";
    assert_eq!(left(&[fixed]), None);
}

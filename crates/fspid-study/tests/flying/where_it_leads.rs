//! Flights that go on to another airspeed than that of their start: where limits of the throttle, air that rises, errors of
//! sensors, loads, and the way to an altitude lead, which the pitch loop at 42 m/s says nothing of.

use fspid_sim::autopilot::Quantity;
use fspid_sim::{Doubt, Leg};
use fspid_study::simulation::ControllerResult;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use crate::flying::{column, doubt, result};

/// A Navion at 42 m/s whose pitch loop holds there, and swings without end from about 60 m/s on.
fn flight(gains: [f64; 2], rest: &str) -> String {
    let [kp, ki] = gains;
    format!(
        r#"
schema = 1
name = "on its way"
[aircraft]
name = "navion"
airspeed_m_s = 42.0
altitude_m = 4000.0
[engine]
kind = "first-order"
time_constant_s = 1.0
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.02
duration_s = 30.0
[setpoint]
kind = "step"
amplitude_deg = 0.0
[[controller]]
name = "PID"
kind = "pid"
kp = {kp:?}
ki = {ki:?}
kd = 0.165
derivative_filter_s = 0.05
{rest}"#
    )
}

/// Loops that hold vertical speed, with more keys of the second loop and what the second of two modes holds.
fn autopilot(second: &str, target: &str) -> String {
    let name = second.lines().next().unwrap_or_default();
    let engage = match name {
        "" => r#"["vertical speed"]"#.to_owned(),
        name => format!("[\"vertical speed\", {}]", name.trim_start_matches("name = ")),
    };
    let second = match second {
        "" => String::new(),
        keys => format!("[[outer_loop]]\n{keys}\n"),
    };
    format!(
        r#"
[[outer_loop]]
name = "vertical speed"
kind = "pid"
holds = "vertical-speed"
moves = "pitch"
kp = 0.3
ki = 0.2
least = -15.0
most = 15.0
most_per_s = 2.0
{second}
[[mode]]
name = "as it is"
engage = {engage}
[[mode]]
name = "on"
engage = {engage}
at_s = 2.0
target = {{ {target} }}
"#
    )
}

/// Keys of a throttle that holds the airspeed.
fn throttle([kp, ki]: [f64; 2], ends: [f64; 2], more: &str) -> String {
    let [least, most] = ends;
    format!(
        "name = \"autothrottle\"\nkind = \"pid\"\nholds = \"airspeed\"\nmoves = \"throttle\"\nkp = {kp:?}\nki = {ki:?}\nleast = {least:?}\nmost = {most:?}\n{more}"
    )
}

/// Keys of an altitude hold.
fn altitude(most_m_s: f64) -> String {
    format!(
        "name = \"altitude\"\nkind = \"pid\"\nholds = \"altitude\"\nmoves = \"vertical speed\"\nkp = 0.1\nleast = -{most_m_s:?}\nmost = {most_m_s:?}\n"
    )
}

fn steady_air(ahead_m_s: f64, up_m_s: f64) -> String {
    let from_deg = if ahead_m_s > 0.0 { 180.0 } else { 0.0 };
    let speed_m_s = ahead_m_s.abs();
    format!(
        "[wind]\nkind = \"steady\"\nspeed_m_s = {speed_m_s:?}\nfrom_deg = {from_deg:?}\nup_m_s = {up_m_s:?}\n"
    )
}

/// Elevator that a load takes, or pitch that a measurement is off, for good.
fn ramp(enters_at: &str, amplitude_deg: f64) -> String {
    format!(
        "[[disturbance]]\nkind = \"ramp\"\nenters_at = \"{enters_at}\"\namplitude_deg = {amplitude_deg:?}\nat_s = 1.0\nwidth_s = 10.0\n"
    )
}

/// How far pitch swings in the last minute of a flight that goes on, deg.
fn swing_deg(flown: &ControllerResult) -> f64 {
    let theta_rad = &flown.trace.theta_rad;
    let last = &theta_rad[theta_rad.len() - 3000..];
    let ends = |ends: [f64; 2], it: &f64| [ends[0].min(*it), ends[1].max(*it)];
    let [least, most] = last.iter().fold([f64::INFINITY, f64::NEG_INFINITY], ends);
    (most - least).to_degrees()
}

const LONG: [&str; 1] = ["loop.duration_s=400.0"];

/// A flight that is in doubt for where it leads, and swings there, and one beside it that is not, and is calm.
#[track_caller]
fn told_and_flown([swings, holds]: [&str; 2]) -> Option<Doubt> {
    let told = doubt(&result(swings, &[]));
    assert!(matches!(told, Some(Doubt::Led { .. } | Doubt::HeldOn { .. })), "{told:?}");
    let swing = swing_deg(&result(swings, &LONG));
    assert!(swing > 5.0, "{swing} deg");
    let calm = result(holds, &[]);
    assert_eq!((doubt(&calm), calm.at_rest.unstable), (None, None));
    let swing = swing_deg(&result(holds, &LONG));
    assert!(swing < 0.2, "{swing} deg");
    told
}

/// An engaged throttle was taken to hold its airspeed, however little its loop may move it.
#[test]
fn a_throttle_goes_no_further_than_its_limits() {
    let down = |least: f64| {
        let loops =
            autopilot(&throttle([0.2, 0.02], [least, 0.5], ""), "vertical_speed_m_s = -2.0");
        flight([4.0, 0.43], &loops)
    };
    let told = told_and_flown([&down(-0.03), &down(-0.5)]);
    let Some(Doubt::Led { led, .. }) = told else { panic!("{told:?}") };
    let flown = result(&down(-0.03), &LONG);
    let last_m_s = *column(&flown.trace, "airspeed_m_s").last().expect("flown");
    let told_m_s = led.airspeed_m_s.expect("it is flown");
    assert!((last_m_s / told_m_s - 1.0).abs() < 0.05, "{last_m_s} {told_m_s}");
}

/// Without an integral the airspeed ends between that of a throttle that stays and the one that is to be held.
#[test]
fn a_throttle_without_an_integral_is_not_taken_to_hold_its_airspeed() {
    let down = |gains: [f64; 2]| {
        let loops = autopilot(&throttle(gains, [-0.5, 0.5], ""), "vertical_speed_m_s = -2.0");
        flight([4.0, 0.43], &loops)
    };
    told_and_flown([&down([0.003, 0.0]), &down([0.1, 0.02])]);
}

/// The altitude that is held was sought as if the air stood: in air that rises by 3 m/s the aircraft goes down through it.
#[test]
fn air_that_rises_counts_in_the_airspeed_that_a_path_makes() {
    let level = |up_m_s: f64| {
        let loops = autopilot(&altitude(5.0), "altitude_m = 4000.0");
        flight([3.4, 0.43], &format!("{loops}{}", steady_air(0.0, up_m_s)))
    };
    told_and_flown([&level(3.0), &level(0.3)]);
    // The same path over the ground is a steeper one through a wind from behind.
    let told_m_s = |ahead_m_s: f64| {
        let loops =
            autopilot("", "vertical_speed_m_s = 0.0").replace("vertical-speed", "flight-path");
        let loops = loops.replace("vertical_speed_m_s = 0.0", "flight_path_deg = -1.5");
        let text = flight([3.6, 0.43], &format!("{loops}{}", steady_air(ahead_m_s, 0.0)));
        let told = doubt(&result(&text, &[]));
        let Some(Doubt::Led { led, .. }) = told else { panic!("{told:?}") };
        let flown = result(&text.replace("kp = 3.6", "kp = 2.0"), &LONG);
        let last_m_s = *column(&flown.trace, "airspeed_m_s").last().expect("flown");
        (led.airspeed_m_s.expect("it is flown"), last_m_s)
    };
    // The air is denser below, by as much in all of them.
    let [still, behind, ahead] = [0.0, 20.0, -10.0].map(told_m_s);
    for (told_m_s, flown_m_s) in [behind, ahead] {
        let by = [told_m_s / still.0, flown_m_s / still.1];
        assert!((by[0] - 1.0).abs() > 0.03 && (by[0] - by[1]).abs() < 0.01, "{by:?}");
    }
}

/// The set-point alone was taken for the pitch that is held.
#[test]
fn an_error_of_the_measurement_and_a_load_without_an_integral_move_the_pitch_that_is_held() {
    let by = |deg: f64| flight([4.2, 0.43], &ramp("measurement", deg));
    told_and_flown([&by(10.0), &by(1.0)]);
    let by = |deg: f64| flight([5.0, 0.0], &ramp("servo", deg));
    told_and_flown([&by(-55.0), &by(-3.0)]);
}

/// Whoever shows too little airspeed has it flown too fast.
#[test]
fn what_a_sensor_of_an_outer_loop_shows_wrongly_counts_in_what_is_held() {
    let by = |bias: f64| {
        let sensor = format!("[outer_loop.sensor]\nseed = 8\nbias = {bias:?}\n");
        let loops = autopilot(&throttle([0.2, 0.02], [-0.5, 0.5], &sensor), "airspeed_m_s = 45.0");
        flight([4.0, 0.43], &loops)
    };
    told_and_flown([&by(12.0), &by(1.0)]);
}

/// Half an hour of a descent was passed over, since it ends level.
#[test]
fn the_way_to_an_altitude_is_asked_where_it_lasts() {
    let to = |altitude_m: f64| {
        let loops = autopilot(&altitude(2.0), &format!("altitude_m = {altitude_m:?}"));
        flight([4.0, 0.43], &loops)
    };
    let told = told_and_flown([&to(500.0), &to(3960.0)]);
    let Some(Doubt::Led { led, .. }) = told else { panic!("{told:?}") };
    assert_eq!((led.leg, led.target), (Leg::OnTheWay, Some((Quantity::Altitude, 500.0))));
}

/// "flown", stable, after 20 s of a turn that takes more power than there is: it ends at the stall, after a minute.
#[test]
fn a_turn_with_nobody_at_the_throttle_is_in_doubt() {
    let turn = |bank_deg: f64, second: &str| {
        let loops = autopilot(
            second,
            &format!("vertical_speed_m_s = 0.0 }}\nbank_deg = {bank_deg:?}\n#{{"),
        );
        let text =
            flight([1.0, 0.43], &loops).replace("airspeed_m_s = 42.0", "airspeed_m_s = 50.0");
        text.replace("altitude_m = 4000.0", "altitude_m = 1000.0")
    };
    let told = doubt(&result(&turn(45.0, ""), &[]));
    let Some(Doubt::LedNowhere(led)) = told else { panic!("{told:?}") };
    assert_eq!((led.mode, led.leg), (1, Leg::Turn));
    assert!(led.to_string().contains("turns with nobody at the throttle"), "{led}");
    let alpha_rad = result(&turn(45.0, ""), &LONG).trace;
    let most_rad = column(&alpha_rad, "alpha_rad").iter().copied().fold(0.0, f64::max);
    assert!(most_rad.to_degrees() > 10.0, "{}", most_rad.to_degrees());
    assert_eq!(doubt(&result(&turn(10.0, ""), &[])), None);
    assert_eq!(doubt(&result(&turn(45.0, &throttle([0.2, 0.02], [-0.5, 0.5], "")), &[])), None);
}

/// A flight of an autopilot that holds altitude, vertical speed and airspeed, with limits of pitch and throttle and what its second
/// mode does.
fn level([airspeed_m_s, most_deg, most]: [f64; 3], second: &str) -> String {
    let engage = r#"["vertical speed", "altitude", "autothrottle"]"#;
    let loops = format!(
        r#"
[[outer_loop]]
name = "vertical speed"
kind = "pid"
holds = "vertical-speed"
moves = "pitch"
kp = 0.5
ki = 0.5
least = -10.0
most = {most_deg:?}
[[outer_loop]]
{}[[outer_loop]]
{}
[[mode]]
name = "level"
engage = {engage}
[[mode]]
name = "second"
engage = {engage}
at_s = 5.0
{second}
"#,
        altitude(2.5),
        throttle([0.2, 0.02], [-0.6, most], ""),
    );
    let text = flight([0.82, 0.43], &loops)
        .replace("altitude_m = 4000.0", "altitude_m = 305.0\nthrust = \"with-speed\"");
    text.replace("airspeed_m_s = 42.0", &format!("airspeed_m_s = {airspeed_m_s:?}"))
}

/// "flown", stable, after half a minute of a turn that takes more throttle than its loop may give: it comes to the ground.
#[test]
fn a_turn_that_takes_more_than_the_throttle_may_give_is_in_doubt() {
    let turn = |most: f64| level([42.0, 10.0, most], "bank_deg = 31.0");
    let told = doubt(&result(&turn(0.05), &[]));
    let (Some(Doubt::Led { led, .. }) | Some(Doubt::LedNowhere(led))) = told else {
        panic!("{told:?}")
    };
    assert_eq!((led.mode, led.leg), (1, Leg::InTurn), "{led}");
    assert!(led.to_string().contains("in its turn"), "{led}");
    assert!(result(&turn(0.05), &LONG).trace.rows() < 19_000);
    let enough = result(&turn(0.4), &[]);
    assert_eq!((doubt(&enough), enough.at_rest.unstable), (None, None));
    let flown = result(&turn(0.4), &LONG);
    let airspeed_m_s = column(&flown.trace, "airspeed_m_s").last().copied();
    assert!((airspeed_m_s.expect("flown") - 42.0).abs() < 0.1, "{airspeed_m_s:?}");
}

/// "flown", stable, of an altitude that is left for good, since pitch may not be commanded as high as a slower flight takes it.
#[test]
fn an_altitude_that_the_limits_of_pitch_do_not_hold_is_in_doubt() {
    let slower = |most_deg: f64| level([54.0, most_deg, 1.2], "target = { airspeed_m_s = 44.0 }");
    let told = doubt(&result(&slower(2.0), &[]));
    let Some(Doubt::LedNowhere(led)) = told else { panic!("{told:?}") };
    assert_eq!((led.mode, led.leg), (1, Leg::End), "{led}");
    let sunk = result(&slower(2.0), &LONG);
    let altitude_m =
        |flown: &ControllerResult| *column(&flown.trace, "altitude_m").last().expect("flown");
    assert!(altitude_m(&sunk) < 280.0, "{}", altitude_m(&sunk));
    let enough = result(&slower(10.0), &[]);
    assert_eq!((doubt(&enough), enough.at_rest.unstable), (None, None));
    let held = altitude_m(&result(&slower(10.0), &LONG));
    assert!((held - 305.0).abs() < 1.0, "{held}");
}

/// A throttle at its end was asked as if it held the airspeed: with it, an airspeed of which there is no flight was "stable".
#[test]
fn a_throttle_at_its_end_holds_no_airspeed() {
    let faster = |end: f64| {
        let text = level([41.1, 10.0, end], "target = { airspeed_m_s = 43.2 }");
        text.replace("least = -0.6", &format!("least = {:?}", -end))
    };
    let told = doubt(&result(&faster(0.03), &["loop.duration_s=15.0"]));
    assert!(matches!(told, Some(Doubt::Led { .. } | Doubt::LedNowhere(_))), "{told:?}");
    assert!(result(&faster(0.03), &LONG).trace.rows() < 19_000);
    let enough = result(&faster(0.4), &[]);
    assert_eq!((doubt(&enough), enough.at_rest.unstable), (None, None));
}

/// Drawn flights, with limits and gains of everything around: what is not in doubt after half a minute is calm after seven.
#[test]
fn none_of_many_flights_that_are_called_stable_swings_later() {
    let mut random = ChaCha8Rng::seed_from_u64(75);
    let mut draw = |[least, most]: [f64; 2]| {
        least + (most - least) * f64::from(random.next_u32()) / f64::from(u32::MAX)
    };
    let (mut stable, mut in_doubt, mut ended) = (0, 0, Vec::new());
    for number in 0..60 {
        let kind = number % 6;
        let air = match draw([0.0, 1.0]) {
            it if it < 0.4 => steady_air(draw([-12.0, 20.0]), draw([-1.0, 3.5])),
            _ => String::new(),
        };
        let bias = draw([0.1, 8.0]);
        let sensor = format!("[outer_loop.sensor]\nseed = {number}\nbias = {bias:?}\n");
        let ends = [-draw([0.0, 0.2]), draw([0.0, 0.3])];
        let gains = [draw([0.003, 0.2]), if draw([0.0, 1.0]) < 0.3 { 0.0 } else { 0.02 }];
        let climb = format!("vertical_speed_m_s = {:?}", draw([-3.0, 1.0]));
        let rest = match kind {
            0 => autopilot(&throttle(gains, ends, ""), &climb),
            1 => autopilot(
                &throttle(gains, ends, &sensor),
                &format!("airspeed_m_s = {:?}", draw([40.0, 65.0])),
            ),
            2 => autopilot("", &climb),
            3 => autopilot(
                &altitude(draw([0.5, 3.0])),
                &format!("altitude_m = {:?}", draw([500.0, 4300.0])),
            ),
            4 => ramp("measurement", draw([-3.0, 12.0])),
            _ => ramp("servo", draw([-60.0, 20.0])),
        };
        let ki = if kind == 5 { 0.0 } else { 0.43 };
        let text = flight([draw([2.0, 5.0]), ki], &format!("{rest}{air}"));
        let told = result(&text, &[]);
        if told.at_rest.unstable.is_some() || doubt(&told).is_some() {
            in_doubt += 1;
            continue;
        }
        let flown = result(&text, &LONG);
        // What holds may leave the data, or come to the ground: such a flight fails, and ends before.
        if flown.trace.rows() > 19_000 {
            let swing = swing_deg(&flown);
            assert!(swing < 1.0, "{swing} deg in a minute, after 340 s of\n{text}");
            stable += 1;
        } else {
            ended.push(flown.trace.outcome);
        }
    }
    assert!(stable > 15 && in_doubt > 10 && ended.len() < 5, "{stable}, {in_doubt}, {ended:?}");
}

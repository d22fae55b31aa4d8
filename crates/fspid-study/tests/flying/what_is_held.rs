//! Stability at rest is asked wherever the scenario, or what stands around its pitch loop, holds the aircraft, with everything
//! that is late or changes in flight. Flights of the program refute what would be said of less.

use fspid_sim::Doubt;
use fspid_study::metrics::Verdict;
use fspid_study::simulation::{ControllerResult, Simulation};

use crate::flying::{result, study};

fn is_unstable(result: &ControllerResult) -> bool {
    matches!(result.metrics.verdict, Verdict::Unstable { .. })
}

/// Least and largest pitch angle over the second half of a flight, deg.
fn at_the_end(result: &ControllerResult) -> [f64; 2] {
    let theta = &result.trace.theta_rad;
    let last = theta[theta.len() / 2..].iter().map(|rad| rad.to_degrees());
    last.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], deg| {
        [least.min(deg), most.max(deg)]
    })
}

/// A Navion with the paper's rules under a law that accumulates and leaks, whose proportional term does not see the set-point.
const REMEMBERING: &str = r#"
schema = 1
name = "a law that remembers"
[plant]
preset = "navion-full"
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.02
duration_s = 300.0
[setpoint]
kind = "step"
amplitude_deg = 10.0
at_s = 1.0
[[controller]]
name = "F"
kind = "fspid"
law = "accumulating"
leakage_per_s = 20.0
nominal = { kp = 1.2, ki = 0.8, kd = 0.25 }
derivative_filter_s = 0.05
setpoint_weights = { proportional = 0.0 }
[controller.supervisor]
table = "mirrored"
range = 5.0
error_scale = 10.0
change_scale = 0.5
output_scale = { kp = 3.0, ki = 1.0, kd = 0.8 }
"#;

/// The same with a law that does not remember.
fn memoryless() -> String {
    let law = "law = \"accumulating\"\nleakage_per_s = 20.0\n";
    REMEMBERING.replace(law, "law = \"memoryless\"\n")
}

/// It swung for ever, and was called settled, since its measures ended within two per cent by chance; a contest was won so.
#[test]
fn a_law_that_remembers_is_unstable_where_what_it_makes_of_the_held_set_point_grows() {
    let swings = result(REMEMBERING, &[]);
    assert!(is_unstable(&swings), "{}", swings.metrics.verdict);
    let [least, most] = at_the_end(&swings);
    assert!(most - least > 1.0, "{least} {most}");
    let small = result(REMEMBERING, &["setpoint.amplitude_deg=1.0"]);
    assert_eq!(small.metrics.verdict, Verdict::Settled);
    let [least, most] = at_the_end(&small);
    assert!(most - least < 1e-3, "{least} {most}");
    // As the same increments of a law without memory.
    let scales = "controller.F.supervisor.output_scale={kp=0.15, ki=0.05, kd=0.04}";
    assert!(is_unstable(&result(&memoryless(), &[scales])));
}

/// Drawn laws, set-points and weights: what is called stable comes to rest, and what is called unstable leaves it, moved by next
/// to nothing; beside a kink there may be ways to rest as well.
#[test]
fn flights_of_laws_that_remember_do_what_is_said_of_their_rest() {
    let (mut stable, mut unstable) = (0, 0);
    for draw in 0..60_u32 {
        let part = |by: u32| f64::from(draw * by % 61) / 61.0;
        let leakage = [2.0, 8.0, 25.0][draw as usize % 3];
        let set = [
            format!("setpoint.amplitude_deg={}", 1.0 + 14.0 * part(17)),
            format!("controller.F.leakage_per_s={leakage}"),
            format!("controller.F.setpoint_weights.proportional={}", 1.2 * part(23)),
            format!("controller.F.supervisor.error_scale={}", 1.0 + 12.0 * part(7)),
            format!("controller.F.supervisor.output_scale.kp={}", leakage * 0.3 * part(29)),
            format!("controller.F.supervisor.output_scale.ki={}", leakage * 0.1 * part(11)),
        ];
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let flown = result(REMEMBERING, &set);
        let [least, most] = at_the_end(&flown);
        if is_unstable(&flown) {
            unstable += 1;
            let noise = "sensor={preset='ideal', pitch={noise_deg_rt_hz=1e-5}}";
            let moved = result(REMEMBERING, &[set.as_slice(), &[noise]].concat());
            let [least, most] = at_the_end(&moved);
            assert!(!(most - least < 0.02), "{set:?}: {least} {most}");
        } else if flown.at_rest.undecided.is_none() {
            stable += 1;
            assert!(most - least < 0.02, "{set:?}: {least} {most}");
        }
    }
    assert!(stable > 10 && unstable > 10, "{stable} {unstable}");
}

const TABLE: &str = r#"
schema = 1
name = "a flexible mode"
[plant]
numerator = [0.79717, 7.00747, 171.10798]
denominator = [1.0, 2.14026, 114.51738, 0.0]
elevator_sign = "nose-up-positive"
[actuator]
time_constant_s = 0.02
[loop]
sample_period_s = 0.01
duration_s = 60.0
[setpoint]
kind = "table"
time_s = [0.0, 30.0]
value_deg = [5.0, 40.0]
interpolation = "hold"
[[controller]]
name = "F"
kind = "fspid"
nominal = { kp = 0.2653, ki = 0.0796, kd = 0.0531 }
derivative_filter_s = 0.02
setpoint_weights = { proportional = 0.0 }
[controller.supervisor]
table = "printed"
range = 5.0
error_scale = 50.0
change_scale = 0.05
output_scale = { kp = 0.0265, ki = 0.0, kd = 0.0 }
"#;

/// Only the trim and the furthest set-point were asked, at which this loop holds.
#[test]
fn each_set_point_that_a_table_holds_is_asked() {
    let found = result(TABLE, &[]);
    assert!(is_unstable(&found), "{}", found.metrics.verdict);
    let at = found.at_rest.unstable.expect("it grows").at;
    assert!((at.setpoint_rad.to_degrees() - 5.0).abs() < 1e-9, "{at:?}");
    let furthest = result(TABLE, &["setpoint.value_deg=[40.0, 40.0]"]);
    assert!(!is_unstable(&furthest), "{}", furthest.metrics.verdict);
}

#[test]
fn a_pulse_that_lasts_to_the_end_is_held_as_a_step_is() {
    let load = |shape: &str| {
        format!("disturbance=[{{enters_at='servo', amplitude_deg=10.0, at_s=2.0, {shape}}}]")
    };
    let literal = [
        "controller.F.integral=literal",
        "controller.F.setpoint_weights.proportional=1.0",
        "controller.F.supervisor.output_scale={kp=0.15, ki=0.15, kd=0.04}",
        "setpoint.amplitude_deg=0.5",
        "loop.duration_s=60.0",
    ];
    let with = |shape: &str| {
        let load = load(shape);
        result(&memoryless(), &[literal.as_slice(), &[load.as_str()]].concat())
    };
    let [step, long] = [with("kind='step'"), with("kind='pulse', width_s=1000.0")];
    assert_eq!(step.trace.theta_rad, long.trace.theta_rad);
    assert!(is_unstable(&step) && is_unstable(&long));
    assert!(!is_unstable(&with("kind='pulse', width_s=10.0")));
}

const LATE: &str = r#"
schema = 1
name = "an outer loop"
[aircraft]
name = "navion"
airspeed_ft_s = 176.0
altitude_ft = 3000.0
validity = "warn"
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.02
duration_s = 60.0
[setpoint]
kind = "step"
amplitude_deg = 0.0
[[outer_loop]]
name = "vertical speed"
kind = "pid"
holds = "vertical-speed"
moves = "pitch"
kp = 2.0
ki = 0.5
least = -10.0
most = 10.0
[[mode]]
name = "hold"
engage = ["vertical speed"]
target = { vertical_speed_m_s = 0.2 }
[[controller]]
name = "PID"
kind = "pid"
kp = 1.2
ki = 0.8
kd = 0.25
derivative_filter_s = 0.05
[[requirement]]
measure = "stable"
"#;

/// Poles of modes were asked as if every sensor showed at once what there is.
#[test]
fn a_mode_whose_sensors_are_so_late_that_it_swings_is_unstable() {
    assert!(!is_unstable(&result(LATE, &[])));
    for late in [
        "sensor={preset='ideal', pitch={delay_s=0.15}}",
        "outer_loop[0].sensor={delay_s=1.0}",
        "actuator.delay_samples=8",
    ] {
        let found = Simulation::of(&study(LATE, &[late])).expect("it flies");
        let flown = &found.results[0];
        assert!(is_unstable(flown), "{late}: {}", flown.metrics.verdict);
        assert!(flown.at_rest.unstable.is_some_and(|it| it.mode == Some(0)), "{late}");
        // The requirement said that the pitch loop was.
        assert!(!found.judgements[0].met, "{late}");
        let [least, most] = at_the_end(flown);
        assert!(most - least > 1.0, "{late}: {least} {most}");
    }
}

/// A sensor that shows a part of a sample late, and one that has a clock of its own, are late by that.
#[test]
fn a_later_sensor_leaves_less_damping_to_a_mode() {
    let damping = |late: &str| {
        let study = study(LATE, &["outer_loop[0].kp=1.5", late]);
        let analysis = fspid_study::analysis::Analysis::of(&study, Default::default());
        let analysis = analysis.expect("it is analysed");
        analysis.loops[0].modes[0].least_damped().expect("it oscillates")[0]
    };
    let dampings = [
        "sensor={preset='ideal'}",
        "sensor={preset='ideal', pitch={delay_s=0.03}}",
        "sensor={preset='ideal', pitch={delay_s=0.04}}",
        "sensor={preset='ideal', pitch={delay_s=0.04, period_s=0.06}}",
    ]
    .map(damping);
    assert!(dampings.windows(2).all(|pair| pair[1] < pair[0] - 1e-3), "{dampings:?}");
}

/// What outer loops command is held too; that they command as much is not known.
#[test]
fn a_loop_that_grows_at_a_set_point_that_outer_loops_may_command_is_undecided() {
    let tuned = |error_scale: f64| {
        format!(
            "controller=[{{name='F', kind='fspid', nominal={{kp=1.2, ki=0.8, kd=0.25}}, derivative_filter_s=0.05, setpoint_weights={{proportional=-1.0}}, supervisor={{table='mirrored', range=5.0, error_scale={error_scale}, change_scale=1.0, output_scale={{kp=0.15, ki=0.05, kd=0.04}}}}}}]"
        )
    };
    let steep = tuned(10.0);
    let set = ["outer_loop[0].kp=0.3", "outer_loop[0].ki=0.2", steep.as_str()];
    let found = result(LATE, &set);
    let words = found.at_rest.undecided_in_words().expect("undecided");
    assert!(words.contains("loops around the pitch loop may command"), "{words}");
    let narrow = ["outer_loop[0].least=-0.2", "outer_loop[0].most=0.2"];
    let narrow = [set.as_slice(), &narrow].concat();
    assert_eq!(result(LATE, &narrow).at_rest.undecided_in_words(), None);
    // It is added to what the scenario commands.
    let commanded = study(LATE, &[narrow.as_slice(), &["setpoint.amplitude_deg=1.0"]].concat());
    let ends = commanded.scenario.commanded_rad().expect("it moves pitch").map(f64::to_degrees);
    assert!((ends[0] + 0.2).abs() < 1e-9 && (ends[1] - 1.2).abs() < 1e-9, "{ends:?}");
}

const FLAPS: &str = r#"
schema = 1
name = "flaps that make it unstable"
[aircraft]
name = "navion"
airspeed_ft_s = 176.0
altitude_ft = 0.0
atmosphere = "reference"
ground_m = -1000
[[configuration]]
name = "flaps"
assumption = "made up"
pitch.alpha = 1.5
[[configuration_change]]
name = "flaps"
to = 1.0
at_s = 14.0
takes_s = 1.0
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.01
duration_s = 20.0
[setpoint]
kind = "step"
amplitude_deg = 1.0
[[controller]]
name = "PID"
kind = "pid"
kp = 0.3
ki = 0.1
kd = 0.05
"#;

/// A change of the plant was asked, and one of the configuration was not.
#[test]
fn the_aircraft_is_asked_with_the_configuration_that_it_comes_to() {
    let found = result(FLAPS, &[]);
    assert!(is_unstable(&found), "{}", found.metrics.verdict);
    assert_eq!(found.at_rest.unstable.map(|it| it.from_s), Some(15.0));
    assert!(!is_unstable(&result(FLAPS, &["configuration[0].pitch.alpha=0.0"])));
    // With a lift that it cannot have at this speed there is no trim.
    let lost = result(
        FLAPS,
        &["configuration[0].pitch.alpha=0.0", "configuration[0].lift.reference=-9.0"],
    );
    let words = lost.at_rest.undecided_in_words().expect("undecided");
    assert!(words.starts_with("stability at rest: undecided: with its configuration"), "{words}");
    // What cannot be asked of all that flies is not called certified, nor stable.
    let required = FLAPS.to_owned()
        + "[[requirement]]\nmeasure = \"stable\"\n[[requirement]]\nmeasure = \"certified\"\n";
    let set = ["configuration[0].pitch.alpha=0.0", "configuration[0].lift.reference=-9.0"];
    let found = Simulation::of(&study(&required, &set)).expect("it flies");
    assert!(found.judgements.iter().all(|it| !it.met), "{:?}", found.judgements);
    let held = Simulation::of(&study(&required, &set[..1])).expect("it flies");
    assert!(held.judgements.iter().all(|it| it.met), "{:?}", held.judgements);
}

/// Fuel that is burnt ahead of the centre of gravity takes the static stability away.
#[test]
fn an_aircraft_that_is_not_shown_to_hold_with_an_empty_tank_is_undecided() {
    let fuel =
        |tank_mac: f64| format!("fuel={{on_board_kg=200.0, flow_kg_s=0.5, tank_mac={tank_mac}}}");
    let base = [
        "configuration_change=[]",
        "configuration=[]",
        "aircraft.validity=warn",
        "controller.PID.kp=0.1",
        "controller.PID.ki=0.02",
        "controller.PID.kd=0.02",
    ];
    let undecided = |tank_mac: f64| {
        let fuel = fuel(tank_mac);
        let found = result(FLAPS, &[base.as_slice(), &[fuel.as_str()]].concat());
        found.at_rest.undecided_in_words()
    };
    assert!(undecided(-1.0).is_some_and(|words| words.contains("fuel")));
    assert_eq!(undecided(0.3), None);
}

/// A Navion whose heading moves its bank, by a gain that is too small to be seen in a flight of seconds.
const HEADING: &str = r#"
schema = 1
name = "heading"
[aircraft]
name = "navion"
airspeed_m_s = 55.0
altitude_ft = 5000.0
validity = "warn"
[lateral]
bank_time_s = 2.0
yaw_damping = 0.4
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.01
duration_s = 50.0
[setpoint]
kind = "step"
amplitude_deg = 0.0
[[outer_loop]]
name = "heading"
kind = "pid"
holds = "heading"
moves = "bank"
kp = -1.0
ki = 0.0
least = -30.0
most = 30.0
[[mode]]
name = "straight"
engage = ["heading"]
[[mode]]
name = "turned"
at_s = 2.0
engage = ["heading"]
target = { heading_deg = 0.001 }
[[controller]]
name = "PID"
kind = "pid"
kp = 1.5
ki = 0.3
kd = 1.0
derivative_filter_s = 0.05
"#;

/// The aileron was held from the bank that was commanded a sample before, and that was no number of the flight: a loop of the
/// wrong sign was stable, proved and flown.
#[test]
fn loops_of_heading_grow_in_flight_as_their_poles_say_at_any_sample_period() {
    for dt_s in ["0.01", "0.02", "0.05"] {
        let set = [format!("loop.sample_period_s={dt_s}")];
        let flown = result(HEADING, &[set[0].as_str()]);
        let unstable = flown.at_rest.unstable.expect("it grows");
        assert_eq!(unstable.mode, Some(0));
        let rate_1_s = std::f64::consts::LN_2 / unstable.doubling_s;
        let bank = flown.trace.column("bank_rad").expect("a bank");
        let largest = |from_s: f64| {
            let within = flown.trace.time_s.iter().zip(bank);
            let within = within.filter(|(time_s, _)| (from_s..from_s + 10.0).contains(*time_s));
            within.map(|(_, bank)| bank.abs()).fold(0.0, f64::max)
        };
        let flown_1_s = (largest(40.0) / largest(20.0)).ln() / 20.0;
        assert!((flown_1_s / rate_1_s - 1.0).abs() < 0.1, "{dt_s}: {flown_1_s} {rate_1_s}");
    }
    let held = result(HEADING, &["outer_loop[0].kp=1.0"]);
    assert!(held.at_rest.unstable.is_none(), "{:?}", held.at_rest);
}

/// A Learjet with five times its inertia in yaw: with its leveller the bank doubles in 110 s, and pitch settles meanwhile.
#[test]
fn an_aircraft_whose_wings_do_not_hold_is_not_called_stable() {
    const HEAVY: &str = r#"
schema = 1
name = "heavy tip tanks"
[aircraft]
name = "learjet-24"
airspeed_m_s = 206.0
altitude_m = 12192.0
iz_kg_m2 = 300000.0
validity = "warn"
[actuator]
time_constant_s = 0.05
[loop]
sample_period_s = 0.02
duration_s = 30.0
[setpoint]
kind = "step"
amplitude_deg = 1.0
at_s = 1.0
[[controller]]
name = "PID"
kind = "pid"
kp = 0.82
ki = 0.3
kd = 0.2
derivative_filter_s = 0.05
"#;
    let heavy = result(HEAVY, &[]).at_rest.undecided.expect("it grows");
    let Doubt::Wings { spectral_radius } = heavy.doubt else { panic!("{heavy:?}") };
    let doubling_s = 0.02 * std::f64::consts::LN_2 / spectral_radius.ln();
    assert!((doubling_s - 112.0).abs() < 5.0, "{doubling_s}");
    let own = HEAVY.replace("iz_kg_m2 = 300000.0\n", "");
    assert_eq!(result(&own, &[]).at_rest.undecided, None);
    // What flies in pitch alone has no wings to hold.
    assert_eq!(result(HEAVY, &["aircraft.model=linear"]).at_rest.undecided, None);
}

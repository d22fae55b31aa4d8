//! The autopilot around the loop: its poles, its hand-overs, and what happens at limits.

#![allow(clippy::float_cmp, reason = "numbers of modes are whole")]

use fspid_aircraft::aerodynamics::derivatives::{DragLaw, ThrustLaw};
use fspid_aircraft::data::Laws;
use fspid_aircraft::{Aircraft, Range, Spool, TrimTarget};
use fspid_core::{
    AntiWindup, ControllerSetting, Derivative, Gains, Limits, Pid, PidConfig, SetpointWeights,
};
use fspid_sim::actuator::Actuator;
use fspid_sim::aircraft::Forces;
use fspid_sim::autopilot::{
    Autopilot, AutopilotError, Condition, Engagement, Entry, GlideSlope, Mode, Moves, OuterLoop,
    Quantity, Side, TotalEnergy, Units,
};
use fspid_sim::signal::{Profile, Shape};
use fspid_sim::{
    AircraftPlant, Controller, Course, Outcome, Scenario, SimError, Surroundings, Timing, Trace,
    Weather, mode_poles, simulate,
};

use crate::support::derivative_data;

const DT_S: f64 = 0.02;
const SPEED_M_S: f64 = 176.0 * 0.3048;
const ALTITUDE_M: f64 = 300.0;

/// The Navion at the condition of its data, in air that is the same everywhere.
fn navion() -> AircraftPlant {
    with_throttle(Range::ALL)
}

/// The same, whose throttle goes so far.
fn with_throttle(throttle: Range) -> AircraftPlant {
    let data = derivative_data("navion");
    let laws = Laws { drag: DragLaw::Linear, thrust: ThrustLaw::Constant };
    let mut model = data.force_model(laws);
    model.travel.throttle = throttle;
    let forces = Forces::from(model);
    let aircraft = Aircraft::new(data.mass_properties(), forces, data.reference_environment());
    let target =
        TrimTarget { airspeed_m_s: SPEED_M_S, altitude_m: ALTITUDE_M, flight_path_rad: 0.0 };
    let plant = AircraftPlant::trimmed(aircraft.expect("a body"), target).expect("flies");
    plant.with_engine(Spool::FirstOrder { time_constant_s: 1.0 }).expect("an engine")
}

fn controller(gains: [f64; 3], config: PidConfig<f64>) -> Controller {
    let [kp, ki, kd] = gains;
    Controller::Fixed(Pid::new(Gains { kp, ki, kd }, config).expect("allowed"))
}

fn plain(gains: [f64; 3]) -> Controller {
    controller(gains, PidConfig::sampled_every(DT_S))
}

fn pitch() -> Controller {
    let derivative = Derivative { filter_s: 0.05 };
    controller([0.82, 0.43, 0.165], PidConfig { derivative, ..PidConfig::sampled_every(DT_S) })
}

fn outer(name: &str, holds: Quantity, moves: Moves, controller: Controller) -> OuterLoop {
    let name = name.to_owned();
    OuterLoop { name, holds, moves, controller, units: Units::SI, sensor: None }
}

fn mode(name: &str, engaged: &[usize]) -> Mode {
    Mode {
        name: name.to_owned(),
        entry: Entry::default(),
        engaged: engaged.to_vec(),
        total_energy: false,
        targets: Vec::new(),
        bank_rad: 0.0,
    }
}

/// Numbers of the loops of [`loops`].
const VERTICAL_SPEED: usize = 0;
const THROTTLE: usize = 1;
const ALTITUDE: usize = 2;
const SPEED_BY_PITCH: usize = 3;
const FLIGHT_PATH: usize = 4;
const BEAM: usize = 5;

/// With the gains of `oracles/make_outer_loop_poles.py`.
fn loops() -> Vec<OuterLoop> {
    use Quantity as Q;
    vec![
        outer("vertical speed", Q::VerticalSpeed, Moves::Pitch, plain([0.008, 0.004, 0.0])),
        outer("autothrottle", Q::Airspeed, Moves::Throttle, plain([0.2, 0.02, 0.0])),
        outer("altitude", Q::Altitude, Moves::Loop(VERTICAL_SPEED), plain([0.15, 0.0, 0.0])),
        outer("speed by pitch", Q::Airspeed, Moves::Pitch, plain([0.012, 0.0015, 0.0])),
        outer("flight path", Q::FlightPath, Moves::Pitch, plain([0.6, 0.4, 0.0])),
        outer("beam", Q::GlideSlope, Moves::Loop(FLIGHT_PATH), plain([0.0015, 0.000_08, 0.0])),
    ]
}

fn total_energy() -> TotalEnergy {
    let setpoint_weights = SetpointWeights { proportional: 0.0, derivative: 0.0 };
    let config = PidConfig { setpoint_weights, ..PidConfig::sampled_every(DT_S) };
    TotalEnergy {
        altitude_gain_1_s: 0.12,
        airspeed_gain_1_s: 0.12,
        most_path_rad: 0.1,
        most_acceleration_g: 0.1,
        energy: controller([3.0, 2.5, 0.0], config),
        distribution: controller([0.3, 0.45, 0.0], config),
    }
}

fn beam() -> GlideSlope {
    GlideSlope {
        angle_rad: 3.0_f64.to_radians(),
        antenna_m: [9000.0, 0.0],
        altitude_m: 0.0,
        course_rad: 0.0,
        angle_sensor: None,
        range_sensor: None,
    }
}

fn autopilot(modes: Vec<Mode>) -> Autopilot {
    Autopilot::new(loops(), Some(total_energy()), Some(beam()), modes).expect("makes sense")
}

fn scenario(autopilot: Autopilot, end_s: f64) -> Scenario {
    let still = Profile::new(0.0, Shape::Step { at_s: 0.0 }).expect("allowed");
    let timing = Timing::new(DT_S, end_s).expect("allowed");
    let mut scenario =
        Scenario::new("outer loops", navion(), timing, still).with_controller("PID", pitch());
    scenario.actuator = Actuator::first_order(0.1).expect("allowed");
    let course = Course {
        airspeed_m_s: SPEED_M_S,
        height_m: ALTITUDE_M,
        climb_rad: 0.0,
        axes_rad: 0.0,
        heading_rad: 0.0,
        start_m: [0.0, 0.0],
    };
    let weather = Weather { course, winds: Vec::new(), turbulence: None };
    scenario.surroundings = Surroundings { weather: Some(weather), ..Surroundings::default() };
    scenario.autopilot = Some(autopilot);
    scenario
}

fn flown(scenario: &Scenario) -> Trace {
    let mut flight = simulate(scenario).expect("flies");
    let trace = flight.traces.remove(0);
    assert_eq!(trace.outcome, Outcome::Completed);
    trace
}

fn last(trace: &Trace, column: &str) -> f64 {
    trace.column(column).and_then(|values| values.last()).copied().expect("a column")
}

/// Differences of flights and those of a trim that is found by search: relative to the size of the pole, in 1/s above 1.
const POLE_TOL: f64 = 2e-5;

#[test]
fn the_poles_of_every_outer_loop_are_those_of_equations_written_elsewhere() {
    let names = [
        "vertical speed",
        "altitude",
        "airspeed by pitch",
        "flight path",
        "glide slope",
        "total energy",
    ];
    let engaged: [&[usize]; 6] = [
        &[VERTICAL_SPEED, THROTTLE],
        &[ALTITUDE, VERTICAL_SPEED, THROTTLE],
        &[SPEED_BY_PITCH],
        &[FLIGHT_PATH, THROTTLE],
        &[BEAM, FLIGHT_PATH, THROTTLE],
        &[],
    ];
    let modes = names.iter().zip(engaged).map(|(name, engaged)| Mode {
        total_energy: *name == "total energy",
        ..mode(name, engaged)
    });
    let scenario = scenario(autopilot(modes.collect()), 10.0);
    let gains = Gains { kp: 0.82, ki: 0.43, kd: 0.165 };
    let found = mode_poles(&scenario, &pitch(), gains).expect("poles");
    let stored = include_str!("data/outer_loop_poles.csv");
    for (name, found) in names.iter().zip(&found) {
        let expected = stored.lines().filter_map(|line| {
            let (mode, pole) = line.split_once(',')?;
            let (re, im) = pole.split_once(',')?;
            (mode == *name).then_some([re.parse::<f64>().ok()?, im.parse::<f64>().ok()?])
        });
        let expected: Vec<[f64; 2]> = expected.collect();
        assert!(expected.len() >= 8, "{name}: {}", expected.len());
        // Four poles more are those of the lateral motion, which the equations elsewhere do not have.
        assert_eq!(found.poles.len(), expected.len() + 4, "{name}");
        for [re, im] in expected {
            let off = found.poles.iter().map(|pole| libm::hypot(pole.re - re, pole.im - im));
            let off = off.fold(f64::INFINITY, f64::min);
            assert!(off < POLE_TOL * libm::hypot(re, im).max(1.0), "{name}: {re} {im}: {off}");
        }
    }
}

#[test]
fn a_climb_that_captures_an_altitude_ends_there_at_its_airspeed_and_bumps_nothing() {
    let limited = |gains, [lower, upper]: [f64; 2], slew: f64| {
        let limits = Limits::new(ControllerSetting::OutputLimits, lower, upper).ok();
        let anti_windup = AntiWindup::Conditional;
        let config = PidConfig {
            limits,
            anti_windup,
            slew_rad_s: Some(slew),
            ..PidConfig::sampled_every(DT_S)
        };
        controller(gains, config)
    };
    let mut all = loops();
    all[ALTITUDE].controller = limited([0.15, 0.0, 0.0], [-2.54, 2.54], 0.5);
    all[VERTICAL_SPEED].controller = limited([0.008, 0.004, 0.0], [-0.2, 0.2], 0.05);
    let climb = Mode {
        targets: vec![Engagement { quantity: Quantity::VerticalSpeed, target: 2.54 }],
        entry: Entry { at_s: 5.0, conditions: Vec::new() },
        ..mode("climb", &[VERTICAL_SPEED, THROTTLE])
    };
    let above = Condition { quantity: Quantity::Altitude, side: Side::Above, value: 380.0 };
    let capture = Mode {
        targets: vec![Engagement { quantity: Quantity::Altitude, target: 400.0 }],
        entry: Entry { at_s: 0.0, conditions: vec![above] },
        ..mode("capture", &[ALTITUDE, VERTICAL_SPEED, THROTTLE])
    };
    let modes = vec![mode("level", &[ALTITUDE, VERTICAL_SPEED, THROTTLE]), climb, capture];
    let autopilot = Autopilot::new(all, None, Some(beam()), modes).expect("makes sense");
    let trace = flown(&scenario(autopilot, 150.0));
    assert!((last(&trace, "altitude_m") - 400.0).abs() < 0.05, "{}", last(&trace, "altitude_m"));
    assert!((last(&trace, "airspeed_m_s") - SPEED_M_S).abs() < 0.05);
    assert_eq!(last(&trace, "mode"), 3.0);
    let most_m = trace.column("altitude_m").expect("it").iter().fold(0.0_f64, |a, b| a.max(*b));
    // 20 m are left, and the poles of the altitude loop, -0.0799 ± 0.1272j, overshoot by exp(-π 0.0799 / 0.1272) = 14 %.
    assert!(most_m < 403.0, "overshoot to {most_m}");
    // Within the rate that the loop may move the set-point by, through both changes of modes.
    let pairs = trace.setpoint_rad.iter().zip(trace.setpoint_rad.iter().skip(1));
    let steepest = pairs.map(|(a, b)| (b - a).abs() / DT_S).fold(0.0, f64::max);
    assert!(steepest <= 0.05 + 1e-9, "{steepest}");
}

#[test]
fn total_energy_takes_an_aircraft_to_another_altitude_and_airspeed_at_once() {
    let wanted = [
        Engagement { quantity: Quantity::Altitude, target: 330.0 },
        Engagement { quantity: Quantity::Airspeed, target: 56.0 },
    ];
    let hold = Mode { total_energy: true, ..mode("hold", &[]) };
    let go = Mode {
        entry: Entry { at_s: 2.0, conditions: Vec::new() },
        targets: wanted.to_vec(),
        total_energy: true,
        ..mode("go", &[])
    };
    let trace = flown(&scenario(autopilot(vec![hold, go]), 120.0));
    assert!((last(&trace, "altitude_m") - 330.0).abs() < 0.1, "{}", last(&trace, "altitude_m"));
    assert!((last(&trace, "airspeed_m_s") - 56.0).abs() < 0.05);
}

#[test]
fn an_approach_captures_the_beam_from_below_and_follows_it() {
    let meets = Condition { quantity: Quantity::GlideSlope, side: Side::Above, value: -10.0 };
    let approach = Mode {
        entry: Entry { at_s: 0.0, conditions: vec![meets] },
        ..mode("approach", &[BEAM, FLIGHT_PATH, THROTTLE])
    };
    let modes = vec![mode("level", &[ALTITUDE, VERTICAL_SPEED, THROTTLE]), approach];
    // The beam is met after 3275 m: 300 m / tan 3 deg before the antenna. At 150 s the antenna is 1 km away.
    let trace = flown(&scenario(autopilot(modes), 150.0));
    assert_eq!(last(&trace, "mode"), 2.0);
    let above_m = last(&trace, "above_glide_slope_m");
    assert!(above_m.abs() < 1.5, "{above_m}");
    let expected_m = (9000.0 - last(&trace, "north_m")) * libm::tan(3.0_f64.to_radians());
    assert!((last(&trace, "altitude_m") - expected_m - above_m).abs() < 1e-2);
    assert!((last(&trace, "flight_path_rad").to_degrees() + 3.0).abs() < 0.1);
}

#[test]
fn what_nobody_moves_any_more_stays_where_it_was() {
    let climb = Mode {
        targets: vec![Engagement { quantity: Quantity::VerticalSpeed, target: 2.0 }],
        ..mode("climb", &[VERTICAL_SPEED, THROTTLE])
    };
    let off = Mode { entry: Entry { at_s: 10.0, conditions: Vec::new() }, ..mode("off", &[]) };
    let trace = flown(&scenario(autopilot(vec![climb, off]), 20.0));
    let at = |time_s: f64| (time_s / DT_S).round() as usize;
    let before = trace.setpoint_rad[at(10.0) - 1];
    assert!(before > 0.01, "{before}");
    assert!(trace.setpoint_rad[at(10.0)..].iter().all(|it| it.to_bits() == before.to_bits()));
}

#[test]
fn an_outer_integral_waits_while_the_pitch_controller_cannot_go_further() {
    // A pitch controller that may move the elevator by a tenth of a degree cannot climb as fast as it is asked.
    let weak = |anti_windup| {
        let size = 0.1_f64.to_radians();
        let limits = Limits::new(ControllerSetting::OutputLimits, -size, size).ok();
        let config = PidConfig { limits, anti_windup, ..PidConfig::sampled_every(DT_S) };
        controller([0.82, 0.43, 0.165], config)
    };
    let climb = Mode {
        targets: vec![Engagement { quantity: Quantity::VerticalSpeed, target: 8.0 }],
        ..mode("climb", &[VERTICAL_SPEED, THROTTLE])
    };
    let mut scenario = scenario(autopilot(vec![climb]), 60.0);
    scenario.controllers[0].controller = weak(AntiWindup::Conditional);
    let trace = flown(&scenario);
    let furthest = trace.setpoint_rad.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    // Without waiting the integral alone would come to 0.004 · 8 · 60 = 1.9 rad.
    assert!(furthest < 0.2, "{furthest}");
}

/// It used to wind up against the stop of the throttle, and to leave it only when all that was added up was taken off again.
#[test]
fn an_autothrottle_does_not_wind_up_at_the_stop_of_the_throttle() {
    let fast = Mode {
        targets: vec![Engagement { quantity: Quantity::Airspeed, target: SPEED_M_S + 30.0 }],
        ..mode("fast", &[ALTITUDE, VERTICAL_SPEED, THROTTLE])
    };
    let back = Mode {
        targets: vec![Engagement { quantity: Quantity::Airspeed, target: SPEED_M_S }],
        entry: Entry { at_s: 40.0, conditions: Vec::new() },
        ..mode("back", &[ALTITUDE, VERTICAL_SPEED, THROTTLE])
    };
    let mut scenario = scenario(autopilot(vec![fast, back]), 60.0);
    scenario.plant = with_throttle(Range { min: 0.0, max: 1.3 }).into();
    let trace = flown(&scenario);
    let asked = trace.column("throttle_command").expect("it");
    let at = |time_s: f64| asked[(time_s / DT_S).round() as usize];
    assert!(asked.iter().all(|throttle| (0.0..=1.3).contains(throttle)));
    assert!((at(39.0) - 1.3).abs() < 1e-12, "{}", at(39.0));
    // 0.02 · 27 m/s · 39 s would have been added up.
    assert!(at(41.0) < 1.2, "{}", at(41.0));
}

#[test]
fn an_engine_follows_its_throttle_with_its_time_constant() {
    let push = Mode {
        targets: vec![Engagement { quantity: Quantity::Airspeed, target: SPEED_M_S + 1.0 }],
        entry: Entry { at_s: 1.0, conditions: Vec::new() },
        ..mode("push", &[THROTTLE])
    };
    let trace = flown(&scenario(autopilot(vec![mode("hold", &[THROTTLE]), push]), 3.0));
    let (asked, found) =
        (trace.column("throttle_command").expect("it"), trace.column("throttle").expect("it"));
    // One sample of a lag of 1 s under a held command, again and again.
    let kept = libm::exp(-DT_S);
    for (k, (asked, pair)) in asked.iter().zip(found.windows(2)).enumerate() {
        let expected = asked + (pair[0] - asked) * kept;
        assert!((pair[1] - expected).abs() < 1e-9, "{k}: {} {expected}", pair[1]);
    }
    assert!(found.last() > found.first());
}

#[test]
fn a_heading_is_turned_to_the_shorter_way_and_held() {
    let mut all = loops();
    all.push(outer("heading", Quantity::Heading, Moves::Bank, {
        let limits = Limits::new(ControllerSetting::OutputLimits, -0.4, 0.4).ok();
        controller([1.2, 0.0, 0.0], PidConfig { limits, ..PidConfig::sampled_every(DT_S) })
    }));
    let turn = Mode {
        targets: vec![Engagement { quantity: Quantity::Heading, target: 300.0_f64.to_radians() }],
        ..mode("turn", &[ALTITUDE, VERTICAL_SPEED, THROTTLE, 6])
    };
    let autopilot = Autopilot::new(all, None, Some(beam()), vec![turn]);
    let trace = flown(&scenario(autopilot.expect("makes sense"), 60.0));
    // To the left, by 60 deg.
    let banks = trace.column("bank_rad").expect("it");
    assert!(banks.iter().fold(0.0_f64, |a, b| a.min(*b)) < -0.3);
    assert!(banks.iter().fold(0.0_f64, |a, b| a.max(*b)) < 0.1);
    let heading_deg = last(&trace, "heading_rad").to_degrees();
    assert!((heading_deg + 60.0).abs() < 0.5, "{heading_deg}");
    assert!((last(&trace, "altitude_m") - ALTITUDE_M).abs() < 1.0);
}

#[test]
fn loops_and_modes_that_make_no_sense_are_refused_by_name() {
    let refused = |change: &dyn Fn(&mut Vec<OuterLoop>, &mut Vec<Mode>)| {
        let (mut all, mut modes) = (loops(), vec![mode("only", &[VERTICAL_SPEED])]);
        change(&mut all, &mut modes);
        Autopilot::new(all, None, Some(beam()), modes).expect_err("refused").to_string()
    };
    type Change<'a> = (&'a dyn Fn(&mut Vec<OuterLoop>, &mut Vec<Mode>), &'a str);
    let cases: &[Change<'_>] = &[
        (&|_, modes| modes.clear(), "no mode engages the outer loops; allowed is one mode or more"),
        (
            &|_, modes| modes[0].engaged = vec![VERTICAL_SPEED, SPEED_BY_PITCH],
            "in mode \"only\" both \"vertical speed\" and \"speed by pitch\" move pitch; allowed is one of them",
        ),
        (
            &|_, modes| modes[0].engaged = vec![ALTITUDE],
            "in mode \"only\" \"altitude\" moves \"vertical speed\", which is not engaged; allowed is to engage both",
        ),
        (
            &|all, _| all[VERTICAL_SPEED].moves = Moves::Bank,
            "\"vertical speed\" holds vertical speed and cannot move the bank; allowed is pitch, or a loop that holds flight path",
        ),
        (
            &|_, modes| {
                modes[0].targets = vec![Engagement { quantity: Quantity::Altitude, target: 1.0 }];
            },
            "mode \"only\" has a target for altitude, which no engaged loop holds by itself; allowed are targets of loops that no other moves",
        ),
        (
            &|_, modes| modes[0].entry.at_s = 1.0,
            "the first mode, \"only\", waits for something; allowed is one that begins with the flight",
        ),
        (
            &|_, modes| modes.push(mode("only", &[])),
            "the name \"only\" is taken; allowed is a name of its own",
        ),
        (
            &|_, modes| {
                let target = f64::NAN;
                modes[0].targets = vec![Engagement { quantity: Quantity::VerticalSpeed, target }];
            },
            "mode \"only\" has no finite number for vertical speed; allowed are finite numbers",
        ),
    ];
    for (change, expected) in cases {
        assert_eq!(refused(change), *expected);
    }
}

#[test]
fn a_mode_after_the_end_and_a_linear_plant_are_refused() {
    let late = Mode { entry: Entry { at_s: 30.0, conditions: Vec::new() }, ..mode("late", &[]) };
    let modes = vec![mode("first", &[VERTICAL_SPEED]), late];
    let found = simulate(&scenario(autopilot(modes), 10.0)).expect_err("refused");
    let expected = AutopilotError::NeverBegins { mode: "late".into(), at_s: 30.0, end_s: 10.0 };
    assert_eq!(found, SimError::Autopilot(Box::new(expected)));
    let mut linear = scenario(autopilot(vec![mode("first", &[VERTICAL_SPEED])]), 10.0);
    linear.plant = navion().linear().expect("a model").into();
    assert_eq!(simulate(&linear).expect_err("refused"), SimError::AutopilotNeedsAircraft);
}

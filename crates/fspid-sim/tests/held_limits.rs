//! What an unstable plant takes where it is held, and what limits leave.

use fspid_core::{
    Change, ControllerSetting, Fspid, Gains, InputScale, Law, Limits, Pid, PidConfig, SecondInput,
    SelfTuner, TunerSettings, paper,
};
use fspid_fuzzy::{Defuzzifier, OutOfRange, Supervisor};
use fspid_sim::sensor::{Sensor, SensorModel};
use fspid_sim::signal::{Disturbance, Entry, Profile, Shape};
use fspid_sim::stability::{doubt_of_flight, growth_at_rest};
use fspid_sim::{
    Actuator, Controller, Doubt, ElevatorSign, LinearPlant, NamedController, PlantChange, Scenario,
    Surroundings, Timing, Trace, simulate,
};

use crate::batch::Random;

const STEP: Shape = Shape::Step { at_s: 0.0 };

/// $1 / (s^2 + 0.6 s - 0.4)$: 0.4 of elevator the other way hold 1 of pitch.
fn unstable() -> LinearPlant {
    LinearPlant::new(&[1.0], &[1.0, 0.6, -0.4], ElevatorSign::NoseUpPositive).expect("proper")
}

fn stable() -> LinearPlant {
    LinearPlant::new(&[1.0], &[1.0, 0.6, 0.4], ElevatorSign::NoseUpPositive).expect("proper")
}

fn pid(ki: f64, limits: Option<(f64, f64)>) -> Controller {
    let limits = limits.map(|(least, most)| {
        Limits::new(ControllerSetting::OutputLimits, least, most).expect("allowed")
    });
    let config = PidConfig { limits, ..PidConfig::sampled_every(0.02) };
    Controller::Fixed(Pid::new(Gains { kp: 3.0, ki, kd: 1.5 }, config).expect("allowed"))
}

fn scenario(controller: Controller) -> Scenario {
    Scenario {
        name: "held".into(),
        plant: unstable().into(),
        plant_changes: Vec::new(),
        actuator: Actuator::first_order(0.05).expect("allowed"),
        timing: Timing::new(0.02, 2.0).expect("allowed"),
        setpoint: Profile::new(0.0, STEP).expect("allowed"),
        disturbances: Vec::new(),
        controllers: vec![NamedController { name: "C".into(), controller }],
        externals: Vec::new(),
        surroundings: Surroundings::default(),
        autopilot: None,
    }
}

fn load(entry: Entry, size_rad: f64, shape: Shape) -> Disturbance {
    Disturbance::new(entry, size_rad, shape).expect("allowed")
}

fn is_beyond(scenario: &Scenario) -> bool {
    let controller = &scenario.controllers[0].controller;
    let found = growth_at_rest(scenario, controller, controller.nominal()).expect("asked");
    assert_eq!(found.certain, None);
    found.undecided.is_some_and(|it| it.doubt == Doubt::BeyondLimits)
}

/// A self-tuner or a PID, with or without an integral, without limits, and what it holds.
fn drawn(random: &mut Random) -> Scenario {
    let mut config = PidConfig::sampled_every(0.02);
    config.setpoint_weights.proportional = random.one_of(&[1.0, 0.6]);
    config.feedforward = random.one_of(&[0.0, 0.3, -0.4]);
    config.rate_gain_s = random.one_of(&[0.0, 1.0]);
    let gains = Gains { kp: random.between(1.5, 5.0), ki: random.one_of(&[0.0, 0.6]), kd: 1.5 };
    let controller = match random.one_of(&[true, false]) {
        true => Controller::Fixed(Pid::new(gains, config).expect("allowed")),
        false => Controller::SelfTuning(self_tuner(random, gains, config)),
    };
    let mut scenario = scenario(controller);
    scenario.timing = Timing::new(0.02, 120.0).expect("allowed");
    let denominator = random.one_of(&[[1.0, 0.6, -0.4], [1.0, 0.6, 0.0], [1.0, 0.0, -0.2]]);
    let sign = random.one_of(&[ElevatorSign::NoseUpPositive, ElevatorSign::NoseDownPositive]);
    let numerator = match sign {
        ElevatorSign::NoseUpPositive => 1.0,
        ElevatorSign::NoseDownPositive => -1.0,
    };
    scenario.plant = LinearPlant::new(&[numerator], &denominator, sign).expect("proper").into();
    scenario.setpoint = Profile::new(random.between(-0.1, 0.1), STEP).expect("allowed");
    scenario.disturbances = [Entry::Servo, Entry::Elevator, Entry::Measurement]
        .map(|entry| load(entry, random.one_of(&[0.0, 0.04, -0.03]), STEP))
        .to_vec();
    let model = SensorModel { scale_error: random.one_of(&[0.0, 0.1]), ..SensorModel::default() };
    scenario.surroundings.pitch_sensor = Some(Sensor::new(model, 1, 0).expect("allowed"));
    scenario
}

fn self_tuner(random: &mut Random, gains: Gains<f64>, config: PidConfig<f64>) -> Fspid<f64> {
    let settings = TunerSettings {
        law: random.one_of(&[Law::Memoryless, Law::Accumulating { leakage_per_s: 2.0 }]),
        second_input: random.one_of(&[SecondInput::Change, SecondInput::Rate]),
        change: Change::Rate,
        input_scale: InputScale { error_per_rad: random.between(10.0, 60.0), change_per_rad: 3.0 },
        output_scale: Gains {
            kp: random.between(-0.3, 0.3),
            ki: if gains.ki == 0.0 { 0.0 } else { 0.05 },
            kd: random.between(-0.1, 0.1),
        },
        ..TunerSettings::literal()
    };
    let supervisor = Supervisor::new(&paper::rules(), 5.0, Defuzzifier::Exact, OutOfRange::Clamp);
    let tuner = SelfTuner::new(gains, supervisor.expect("allowed"), settings).expect("allowed");
    Fspid::new(tuner, config).expect("allowed")
}

/// Of an own limit from -0.1 to 0.2 rad.
fn own(change: impl FnOnce(&mut Scenario)) -> bool {
    let mut scenario = scenario(pid(0.5, Some((-0.1, 0.2))));
    change(&mut scenario);
    is_beyond(&scenario)
}

#[test]
fn a_set_point_that_takes_more_than_a_limit_leaves_is_beyond_it_on_either_side() {
    let at = |setpoint_rad: f64| {
        own(|it| it.setpoint = Profile::new(setpoint_rad, STEP).expect("allowed"))
    };
    // 0.25 rad take -0.1 of elevator, and -0.5 rad take 0.2.
    assert!(!at(0.2499) && at(0.2501));
    assert!(!at(-0.4999) && at(-0.5001));
}

#[test]
fn loads_count_with_their_signs_where_the_flight_ends() {
    let under = |entry: Entry, size_rad: f64, shape: Shape| {
        own(|it| it.disturbances = vec![load(entry, size_rad, shape)])
    };
    for entry in [Entry::Servo, Entry::Elevator] {
        assert!(!under(entry, 0.0999, STEP) && under(entry, 0.1001, STEP), "{entry:?}");
        assert!(!under(entry, -0.1999, STEP) && under(entry, -0.2001, STEP), "{entry:?}");
        let over = Shape::Pulse { at_s: 0.5, width_s: 0.5 };
        assert!(!under(entry, 1.0, over), "it is over: {entry:?}");
        let swinging = Shape::Sine { at_s: 0.0, frequency_hz: 0.13 };
        assert!(!under(entry, 1.0, swinging), "it never stands still: {entry:?}");
    }
    // An offset of the measured pitch is a pitch.
    assert!(!under(Entry::Measurement, -0.2499, STEP) && under(Entry::Measurement, -0.2501, STEP));
    let both = |at_servo: f64, at_elevator: f64| {
        let loads = [(Entry::Servo, at_servo), (Entry::Elevator, at_elevator)];
        own(|it| it.disturbances = loads.map(|(entry, size)| load(entry, size, STEP)).to_vec())
    };
    assert!(!both(0.5, -0.45) && both(0.08, 0.08));
}

#[test]
fn a_servo_holds_what_acts_behind_it() {
    let servo = |actuator: Actuator, at_servo: f64, at_elevator: f64| {
        let mut scenario = scenario(pid(0.5, None));
        scenario.actuator = actuator;
        let loads = [(Entry::Servo, at_servo), (Entry::Elevator, at_elevator)];
        scenario.disturbances = loads.map(|(entry, size)| load(entry, size, STEP)).to_vec();
        is_beyond(&scenario)
    };
    let lag = || Actuator::first_order(0.05).expect("allowed");
    for actuator in [
        lag().with_command_limits(-0.1, 0.2).expect("allowed"),
        lag().with_travel(-0.1, 0.2).expect("allowed"),
    ] {
        assert!(!servo(actuator, 0.9, 0.0999) && servo(actuator, -0.9, 0.1001));
        assert!(!servo(actuator, -0.9, -0.1999) && servo(actuator, 0.9, -0.2001));
    }
    let biased = lag().with_bias(0.05).expect("allowed").with_travel(-0.1, 0.2).expect("allowed");
    assert!(!servo(biased, 0.0, 0.0499) && servo(biased, 0.0, 0.0501));
}

#[test]
fn a_sensor_s_scale_is_in_the_pitch_that_it_takes_to_show_a_set_point() {
    let at = |scale_error: f64, setpoint_rad: f64| {
        own(|it| {
            let model = SensorModel { scale_error, ..SensorModel::default() };
            it.surroundings.pitch_sensor = Some(Sensor::new(model, 1, 0).expect("allowed"));
            it.setpoint = Profile::new(setpoint_rad, STEP).expect("allowed");
        })
    };
    assert!(!at(-0.2, 0.1999) && at(-0.2, 0.2001));
    assert!(!at(0.2, 0.2999) && at(0.2, 0.3001));
    let bias = |bias: f64, seed: u64| {
        own(|it| {
            let model = SensorModel { bias, ..SensorModel::default() };
            it.surroundings.pitch_sensor = Some(Sensor::new(model, seed, 0).expect("allowed"));
        })
    };
    let drawn = |seed: u64| {
        let model = SensorModel { bias: 1.0, ..SensorModel::default() };
        Sensor::new(model, seed, 0).expect("allowed").bias()
    };
    let seed = (1..).find(|seed| drawn(*seed) < -0.5).expect("a seed");
    let least = 0.25 / -drawn(seed);
    assert!(!bias(0.999 * least, seed) && bias(1.001 * least, seed));
}

#[test]
fn what_no_limit_holds_and_what_holds_by_itself_is_not_asked() {
    let far = |controller: Controller| {
        let mut scenario = scenario(controller);
        scenario.setpoint = Profile::new(1.0, STEP).expect("allowed");
        scenario
    };
    assert!(is_beyond(&far(pid(0.5, Some((-0.1, 0.2))))));
    assert!(!is_beyond(&far(pid(0.5, None))));
    let mut holds = far(pid(0.5, Some((-0.1, 0.2))));
    holds.plant = stable().into();
    assert!(!is_beyond(&holds));
    // The plant that the flight ends with.
    holds.plant_changes = vec![PlantChange::new(1.0, 0.0, unstable()).expect("allowed")];
    assert!(is_beyond(&holds));
    let mut sine = far(pid(0.5, Some((-0.1, 0.2))));
    let shape = Shape::Sine { at_s: 0.0, frequency_hz: 0.13 };
    sine.setpoint = Profile::new(1.0, shape).expect("allowed");
    assert!(!is_beyond(&sine));
}

#[test]
fn a_plant_that_integrates_is_held_by_no_command_and_takes_what_its_loads_take_at_every_set_point()
{
    for denominator in [vec![1.0, 0.0, 0.0], vec![1.0, 0.6, 0.0], vec![1.0, 2.0, 4.0, 0.0]] {
        for ki in [0.0, 0.5] {
            let beyond = |of: Entry, size_rad: f64| {
                let mut scenario = scenario(pid(ki, Some((-0.1, 0.2))));
                let plant = LinearPlant::new(&[1.0], &denominator, ElevatorSign::NoseUpPositive);
                scenario.plant = plant.expect("proper").into();
                scenario.setpoint = Profile::new(1.0, STEP).expect("allowed");
                scenario.disturbances = vec![load(of, size_rad, STEP)];
                is_beyond(&scenario)
            };
            for entry in [Entry::Servo, Entry::Elevator] {
                assert!(!beyond(entry, 0.0999) && beyond(entry, 0.1001), "{denominator:?} {ki}");
                assert!(!beyond(entry, -0.1999) && beyond(entry, -0.2001), "{denominator:?} {ki}");
            }
            assert!(!beyond(Entry::Measurement, 1.0), "{denominator:?} {ki}");
        }
    }
}

#[test]
fn without_an_integral_the_command_at_rest_is_held_against_the_limits() {
    let beyond = |setpoint_rad: f64, of_servo_rad: f64, feedforward: f64| {
        let limits = Limits::new(ControllerSetting::OutputLimits, -0.1, 0.2).expect("allowed");
        let config =
            PidConfig { limits: Some(limits), feedforward, ..PidConfig::sampled_every(0.02) };
        let gains = Gains { kp: 3.0, ki: 0.0, kd: 1.5 };
        let mut scenario = scenario(Controller::Fixed(Pid::new(gains, config).expect("allowed")));
        scenario.setpoint = Profile::new(setpoint_rad, STEP).expect("allowed");
        scenario.disturbances = vec![load(Entry::Servo, of_servo_rad, STEP)];
        is_beyond(&scenario)
    };
    // 3 (r - y) = -0.4 y: y = 3 r / 2.6, which takes -1.2 r / 2.6.
    let least_rad = 0.1 * 2.6 / 1.2;
    assert!(!beyond(0.999 * least_rad, 0.0, 0.0) && beyond(1.001 * least_rad, 0.0, 0.0));
    assert!(!beyond(-1.999 * least_rad, 0.0, 0.0) && beyond(-2.001 * least_rad, 0.0, 0.0));
    // As much the other way makes the pitch the set-point, and takes -0.4 r.
    assert!(!beyond(0.249, 0.0, -0.4) && beyond(0.251, 0.0, -0.4));
    // 3 (0 - y) = -0.4 y - d: a load d takes -3 d / 2.6.
    let least_rad = 0.1 * 2.6 / 3.0;
    assert!(!beyond(0.0, 0.999 * least_rad, 0.0) && beyond(0.0, 1.001 * least_rad, 0.0));
}

/// Limits the command to either side.
fn limit(scenario: &mut Scenario, most_rad: f64) {
    let limits = Limits::new(ControllerSetting::OutputLimits, -most_rad, most_rad);
    let controller = &mut scenario.controllers[0].controller;
    let config = PidConfig { limits: Some(limits.expect("allowed")), ..*controller.config() };
    *controller = match controller {
        Controller::Fixed(pid) => {
            Controller::Fixed(Pid::new(pid.gains(), config).expect("allowed"))
        }
        Controller::SelfTuning(fspid) => {
            let tuner = *fspid.tuner();
            Controller::SelfTuning(Fspid::new(tuner, config).expect("allowed"))
        }
    };
}

/// Controllers of every kind on plants that do not come to rest by themselves: where a flight without limits comes to rest, a
/// limit a thousandth beyond its command leaves enough, and one a thousandth before it does not.
#[test]
fn limits_leave_enough_just_where_the_command_of_a_flight_without_them_comes_to_rest_within() {
    let mut random = Random(20_261_129);
    let (mut rested, mut without_integral) = (0, 0);
    for number in 0..400 {
        let mut scenario = drawn(&mut random);
        let trace = simulate(&scenario).expect("flies").traces.remove(0);
        let commands = &trace.command_rad;
        let last_rad = *commands.last().expect("a sample");
        let tail = &commands[commands.len() / 2..];
        let rests = tail.iter().all(|it| (it - last_rad).abs() < 1e-6 * last_rad.abs());
        if !rests || last_rad.abs() < 1e-4 {
            continue;
        }
        rested += 1;
        without_integral += usize::from(scenario.controllers[0].controller.nominal().ki == 0.0);
        for (share, is_beyond_it) in [(1.001, false), (0.999, true)] {
            limit(&mut scenario, share * last_rad.abs());
            let controller = &scenario.controllers[0].controller;
            let found = growth_at_rest(&scenario, controller, controller.nominal()).expect("asked");
            let doubt = found.undecided.map(|it| it.doubt);
            let is_beyond = doubt == Some(Doubt::BeyondLimits);
            assert_eq!(is_beyond, is_beyond_it, "{number}: {last_rad} {found:?}");
        }
    }
    assert!(rested > 100 && without_integral > 40, "{rested} {without_integral}");
}

/// A flight that ends as these samples say, of a controller with a limit of 1.
fn lost(change: impl FnOnce(&mut Scenario), samples: impl Fn(usize) -> (f64, f64)) -> bool {
    let mut scenario = scenario(pid(0.5, Some((-1.0, 1.0))));
    scenario.timing = Timing::new(0.02, 2.98).expect("allowed");
    change(&mut scenario);
    let mut trace: Trace = simulate(&scenario).expect("flies").traces.remove(0);
    assert_eq!(trace.rows(), 150);
    for k in 0..trace.rows() {
        (trace.theta_rad[k], trace.command_rad[k]) = samples(k);
    }
    let controller = &scenario.controllers[0].controller;
    doubt_of_flight(&scenario, controller, &trace).is_some()
}

#[test]
fn a_flight_is_lost_that_ends_at_a_limit_with_an_error_that_grows() {
    let grows = |k: usize| k as f64;
    let same = |_: &mut Scenario| {};
    for limit in [-1.0, 1.0] {
        assert!(lost(same, |k| (grows(k), limit)));
        assert!(lost(same, |k| (-grows(k), limit)));
        // At the limit for the last tenth, 15 samples.
        assert!(lost(same, |k| (grows(k), if k < 135 { 0.0 } else { limit })));
        assert!(!lost(same, |k| (grows(k), if k < 136 { 0.0 } else { limit })));
        assert!(!lost(same, |k| (grows(k), 0.999 * limit)));
    }
    // It comes back, or stands; what a step once asked for says nothing of it.
    assert!(!lost(same, |k| (-grows(150 - k), 1.0)));
    assert!(lost(same, |k| (if k == 5 { 149.0 } else { grows(k) }, 1.0)));
    assert!(!lost(same, |k| (grows(k.min(148)), 1.0)));
    // A servo's limits as well, and none of a plant that holds by itself.
    let of_servo = |servo: Actuator| {
        move |it: &mut Scenario| {
            it.actuator = servo;
            it.controllers[0].controller = pid(0.5, None);
        }
    };
    let lag = || Actuator::first_order(0.05).expect("allowed");
    let limited = lag().with_command_limits(-0.5, 0.7).expect("allowed");
    assert!(lost(of_servo(limited), |k| (grows(k), 0.7)));
    assert!(!lost(of_servo(limited), |k| (grows(k), 0.69)));
    let travel = lag().with_travel(-0.5, 0.7).expect("allowed");
    assert!(lost(of_servo(travel), |k| (grows(k), -0.5)));
    assert!(!lost(of_servo(travel), |k| (grows(k), -0.49)));
    assert!(!lost(of_servo(lag()), |k| (grows(k), 9.0)));
    assert!(!lost(|it| it.plant = stable().into(), |k| (grows(k), 1.0)));
    // Of fewer than a hundred samples nothing is said.
    let short = |rows: usize| {
        let mut scenario = scenario(pid(0.5, Some((-1.0, 1.0))));
        scenario.timing = Timing::new(0.02, 0.02 * (rows - 1) as f64).expect("allowed");
        let mut trace = simulate(&scenario).expect("flies").traces.remove(0);
        for k in 0..trace.rows() {
            (trace.theta_rad[k], trace.command_rad[k]) = (grows(k), 1.0);
        }
        doubt_of_flight(&scenario, &scenario.controllers[0].controller, &trace).is_some()
    };
    assert!(!short(99) && short(100));
}

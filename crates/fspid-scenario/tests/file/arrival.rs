//! Every key of the file arrives where it belongs: the scenario built by hand is the one read.

use fspid_core::{
    AntiWindup, Change, ControllerSetting, DeadZone, Derivative, ErrorSign, Fspid, GainCoupling,
    GainLimits, Gains, Guard, InputScale, InputSets, IntegralForm, Law, Limits, Pid, PidConfig,
    ReferenceModel, SecondInput, SelfTuner, SetCentres, SetpointWeights, TunerSettings,
};
use fspid_fuzzy::{Defuzzifier, OutOfRange, Supervisor};
use fspid_lti::{DampedIntegrator, IntegralWeights, integral_regulator};
use fspid_scenario::file::{self, rule_table};
use fspid_sim::flight_stack::{
    ElevatorChannel, FlightStack, LevelFlight, Place, Protocol, SetpointChannel,
};
use fspid_sim::signal::{Disturbance, Entry, Interpolation, Profile, Shape};
use fspid_sim::{
    Actuator, Controller, ElevatorSign, External, ExternalSource, LinearPlant, NamedController,
    NamedExternal, PlantChange, Scenario, SimError, Surroundings, Timing,
};

use crate::file::text;

const DEG: f64 = std::f64::consts::PI / 180.0;

fn read(text: &str) -> Scenario {
    let study = file::parse(text, "every-key.toml", None, &[]);
    study.unwrap_or_else(|problems| panic!("{problems}")).scenario
}

fn whole() -> String {
    text("crates/fspid-scenario/tests/scenarios/every-key.toml")
}

fn named(name: &str, controller: Controller) -> NamedController {
    let name = name.to_owned();
    NamedController { name, controller }
}

fn limits(lower: f64, upper: f64) -> Limits<f64> {
    Limits::new(ControllerSetting::OutputLimits, lower, upper).expect("allowed")
}

/// The configuration of `pid` and `fspid`, which set everything.
fn full_config() -> PidConfig<f64> {
    PidConfig {
        dt_s: 0.01,
        rate_gain_s: 0.1,
        setpoint_weights: SetpointWeights { proportional: 0.8, derivative: 0.5 },
        feedforward: 0.25,
        derivative: Derivative { filter_s: 0.05 },
        integral: IntegralForm::Bumpless,
        anti_windup: AntiWindup::Clamping(limits(-5.0 * DEG, 5.0 * DEG)),
        limits: Some(limits(-20.0 * DEG, 20.0 * DEG)),
        slew_rad_s: Some(100.0 * DEG),
        guard: Guard::new(1000.0 * DEG).expect("allowed"),
    }
}

/// The configuration of the two controllers in ISA form.
fn isa_config() -> PidConfig<f64> {
    PidConfig {
        derivative: Derivative { filter_s: 0.1 / 10.0 },
        anti_windup: AntiWindup::BackCalculation { tracking_s: 0.7 },
        limits: Some(limits(-20.0 * DEG, 20.0 * DEG)),
        ..PidConfig::sampled_every(0.01)
    }
}

fn pid(gains: Gains<f64>, config: PidConfig<f64>) -> Controller {
    Controller::Fixed(Pid::new(gains, config).expect("allowed"))
}

const GAINS: Gains<f64> = Gains { kp: 1.0, ki: 0.2, kd: 0.1 };

fn tuned() -> Controller {
    let table = rule_table("printed").expect("carried");
    let supervisor =
        Supervisor::new(&table, 5.0, Defuzzifier::Endpoints(101), OutOfRange::Evaluate);
    let settings = TunerSettings {
        error_sign: ErrorSign::MeasurementMinusSetpoint,
        second_input: SecondInput::Change,
        change: Change::Delta,
        input_scale: InputScale { error_per_rad: 1.0 / DEG, change_per_rad: 20.0 / DEG },
        input_sets: InputSets {
            error: SetCentres::new(0.2, 0.5).ok(),
            change: SetCentres::new(0.3, 0.7).ok(),
        },
        gain_coupling: GainCoupling { setpoint_weight: 0.3, rate_gain: 2.0 },
        output_scale: Gains { kp: 0.01, ki: 0.001, kd: 0.002 },
        law: Law::Accumulating { leakage_per_s: 0.1 },
        gain_limits: Some(GainLimits {
            kp: limits(0.1, 5.0),
            ki: limits(0.0, 2.0),
            kd: limits(0.0, 1.0),
        }),
        dead_zone: Some(DeadZone { error_rad: 0.01 * DEG, change_rad: 0.1 * DEG }),
    };
    let tuner = SelfTuner::new(GAINS, supervisor.expect("allowed"), settings).expect("allowed");
    Controller::SelfTuning(Fspid::new(tuner, full_config()).expect("allowed"))
}

fn tuned_isa(isa: Gains<f64>) -> Controller {
    let table = rule_table("printed").expect("carried");
    let supervisor = Supervisor::new(&table, 5.0, Defuzzifier::Exact, OutOfRange::Clamp);
    let settings = TunerSettings {
        second_input: SecondInput::ModelError(ReferenceModel {
            bandwidth_rad_s: 1.5,
            damping: 0.8,
        }),
        input_scale: InputScale { error_per_rad: 1.0 / DEG, change_per_rad: 1.0 / DEG },
        ..TunerSettings::literal()
    };
    let tuner = SelfTuner::new(isa, supervisor.expect("allowed"), settings).expect("allowed");
    Controller::SelfTuning(Fspid::new(tuner, isa_config()).expect("allowed"))
}

fn regulator(anti_windup: AntiWindup<f64>) -> Controller {
    let model = DampedIntegrator { damping_per_s: 2.0, power_per_s2: 4.0 };
    let weights = IntegralWeights { integral_per_s2: 4.0, position: 5.0, rate_s2: 0.5 };
    let found = integral_regulator(model, weights).expect("allowed");
    let config = PidConfig {
        rate_gain_s: found.rate_s,
        anti_windup,
        setpoint_weights: SetpointWeights { proportional: 0.3, derivative: 1.0 },
        feedforward: 0.0,
        derivative: Derivative { filter_s: 0.0 },
        ..full_config()
    };
    pid(Gains { kp: found.position, ki: 2.0, kd: 0.0 }, config)
}

fn controllers() -> Vec<NamedController> {
    let isa = Gains { kp: 1.0, ki: 1.0 / 5.0, kd: 0.1 };
    let p = PidConfig { rate_gain_s: 0.1, feedforward: 0.25, ..PidConfig::sampled_every(0.01) };
    vec![
        named("p", pid(Gains { kp: 1.0, ki: 0.0, kd: 0.0 }, p)),
        named("pid", pid(GAINS, full_config())),
        named("isa", pid(isa, isa_config())),
        named("fspid", tuned()),
        named("fspid isa", tuned_isa(isa)),
        named("lqi", regulator(full_config().anti_windup)),
        named("lqi tracking", regulator(isa_config().anti_windup)),
    ]
}

fn externals() -> Vec<NamedExternal> {
    let external = |name: &str, stack: FlightStack, answer_limit_s| {
        let source = ExternalSource::FlightStack(Box::new(stack));
        let external =
            External { source, contents: None, answer_limit_s, dt_s: 0.01, renamed: Vec::new() };
        NamedExternal { name: name.to_owned(), external }
    };
    let channel = |number, ends_deg: [f64; 2]| SetpointChannel {
        number,
        setpoint_rad: ends_deg.map(|end_deg| end_deg * DEG),
    };
    let ardupilot = FlightStack {
        protocol: Protocol::ArduPilot { pulses_us: [1100.0, 1900.0] },
        address: "127.0.0.1:9012".parse().expect("an address"),
        connect_limit_s: 10.0,
        lead_in_s: 20.0,
        elevator: ElevatorChannel {
            number: 1,
            command_rad: [-25.0 * DEG, 15.0 * DEG],
            is_reversed: true,
        },
        throttle: None,
        setpoint: Some(channel(1, [-20.0, 20.0])),
        place: Place { latitude_rad: 0.0, longitude_rad: 0.0, declination_rad: 0.0 },
        level: Some(LevelFlight { airspeed_m_s: 50.0, altitude_m: 300.0 }),
    };
    let px4 = FlightStack {
        protocol: Protocol::Px4,
        address: "127.0.0.1:4560".parse().expect("an address"),
        connect_limit_s: 60.0,
        lead_in_s: 5.0,
        elevator: ElevatorChannel {
            number: 2,
            command_rad: [-20.0 * DEG, 20.0 * DEG],
            is_reversed: false,
        },
        throttle: None,
        setpoint: Some(channel(2, [-45.0, 45.0])),
        place: Place {
            latitude_rad: 47.4 * DEG,
            longitude_rad: 8.5 * DEG,
            declination_rad: 3.0 * DEG,
        },
        level: Some(LevelFlight { airspeed_m_s: 25.0, altitude_m: 500.0 }),
    };
    vec![external("ardupilot", ardupilot, 2.0), external("px4", px4, 1.0)]
}

/// Numbers of channels count from 1 in the file, and throttles need an aircraft.
#[test]
fn a_throttle_of_an_aircraft_has_a_channel() {
    let scenario = read(&text("crates/fspid-scenario/tests/scenarios/every-key-aircraft.toml"));
    let stacks = scenario.externals.iter().filter_map(|it| it.external.source.flight_stack());
    let throttles: Vec<_> = stacks.map(|stack| (stack.protocol.name(), stack.throttle)).collect();
    assert_eq!(throttles, [("ArduPilot", Some(2)), ("PX4", Some(4))]);
}

#[test]
fn a_flight_stack_that_does_not_fit_its_plant_is_refused_with_what_does() {
    let refused = |from: &str, to: &str| {
        let found = file::parse(&whole().replacen(from, to, 1), "pitch.toml", None, &[]);
        found.err().map(|problems| problems.to_string()).unwrap_or_default()
    };
    let level = "airspeed_m_s = 50.0\naltitude_m = 300.0\n";
    let said = refused(level, "");
    assert!(said.contains("the plant shows nothing but pitch"), "{said}");
    let said = refused(level, "airspeed_m_s = 50.0\n");
    assert!(said.contains("altitude_m is missing"), "{said}");
    let said = refused("setpoint_deg = [-20.0, 20.0]\n", "");
    assert!(said.contains("setpoint_deg is missing"), "{said}");
    let said = refused("listen = \"127.0.0.1:9012\"", "listen = \"localhost\"");
    assert!(said.contains("such as 127.0.0.1:9002"), "{said}");
    let said = refused("elevator_channel = 3", "elevator_channel = 17");
    assert!(said.contains("elevator_channel"), "{said}");
    let said = refused("pulses_us = [1100.0, 1900.0]", "throttle_channel = 3");
    assert!(said.contains("no throttle that moves"), "{said}");
}

fn disturbances() -> Result<Vec<Disturbance>, SimError> {
    let (at_s, width_s, amplitude) = (1.0, 0.5, 0.1 * DEG);
    Ok(vec![
        Disturbance::new(Entry::Servo, amplitude, Shape::Step { at_s })?,
        Disturbance::new(Entry::Elevator, amplitude, Shape::Pulse { at_s, width_s })?,
        Disturbance::new(Entry::Elevator, amplitude, Shape::Ramp { at_s, width_s })?,
        Disturbance::new(Entry::Measurement, amplitude, Shape::Sine { at_s, frequency_hz: 2.0 })?,
        Disturbance::new(Entry::Measurement, 0.01 * DEG, Shape::Noise { at_s, seed: 7 })?,
    ])
}

fn expected() -> Result<Scenario, SimError> {
    let sign = ElevatorSign::NoseUpPositive;
    let plant =
        |numerator: &[f64], denominator: &[f64]| LinearPlant::new(numerator, denominator, sign);
    let navion = plant(&[11.7304, 22.578], &[1.0, 4.9676, 12.941, 0.0])?;
    let changed = plant(&[10.0, 20.0], &[1.0, 5.0, 13.0, 0.0])?;
    let servo = Actuator::first_order(0.1)?.with_position_limit(25.0 * DEG)?;
    Ok(Scenario {
        name: "every key".to_owned(),
        plant: navion.clone().into(),
        plant_changes: vec![
            PlantChange::new(3.0, 1.0, changed)?,
            PlantChange::new(6.0, 0.0, navion)?,
        ],
        actuator: servo.with_rate_limit(40.0 * DEG)?.with_delay(1)?,
        timing: Timing::new(0.01, 10.0)?,
        setpoint: Profile::new(1.0 * DEG, Shape::Step { at_s: 0.5 })?,
        disturbances: disturbances()?,
        controllers: controllers(),
        externals: externals(),
        surroundings: Surroundings::default(),
        autopilot: None,
    })
}

#[test]
fn every_key_arrives_where_it_belongs() {
    let (found, expected) = (read(&whole()), expected().expect("allowed"));
    for (found, expected) in found.controllers.iter().zip(&expected.controllers) {
        assert_eq!(found, expected);
    }
    assert_eq!(found, expected);
}

#[test]
fn every_kind_of_set_point_arrives() {
    let (at_s, width_s) = (0.5, 2.0);
    let shapes = [
        (
            "square\"\nhalf_period_s = 2.0\nbipolar = true",
            Shape::Square { at_s, half_period_s: 2.0, bipolar: true },
        ),
        (
            "square\"\nhalf_period_s = 2.0",
            Shape::Square { at_s, half_period_s: 2.0, bipolar: false },
        ),
        ("doublet\"\nwidth_s = 2.0", Shape::Doublet { at_s, width_s }),
        ("ramp\"\nwidth_s = 2.0", Shape::Ramp { at_s, width_s }),
        ("sine\"\nfrequency_hz = 3.0", Shape::Sine { at_s, frequency_hz: 3.0 }),
    ];
    for (words, shape) in shapes {
        let text = whole().replacen("kind = \"step\"", &format!("kind = \"{words}"), 1);
        assert_eq!(Ok(read(&text).setpoint), Profile::new(DEG, shape), "{words}");
    }
    for (word, interpolation) in [("hold", Interpolation::Hold), ("linear", Interpolation::Linear)]
    {
        let table = format!(
            "kind = \"table\"\ntime_s = [0, 1.5]\nvalue_deg = [1, -2]\ninterpolation = \"{word}\""
        );
        let text = whole().replacen("kind = \"step\"\namplitude_deg = 1.0\nat_s = 0.5", &table, 1);
        assert_eq!(
            Ok(read(&text).setpoint),
            Profile::table(vec![0.0, 1.5], vec![DEG, -2.0 * DEG], interpolation)
        );
    }
}

/// The words that the file with every key does not use.
#[test]
fn the_other_words_arrive_too() {
    let config = |change: (&str, &str)| {
        let text = whole().replacen(change.0, change.1, 1);
        assert_ne!(text, whole(), "{change:?}");
        *read(&text).controllers[1].controller.config()
    };
    let literal = config(("\"bumpless\"", "\"literal\""));
    assert_eq!(literal.integral, IntegralForm::Literal);
    let clamping = "anti_windup.kind = \"clamping\"\nanti_windup.lower_deg = -5.0\nanti_windup.upper_deg = 5.0\n";
    let none = config((clamping, "anti_windup.kind = \"none\"\n"));
    assert_eq!(none.anti_windup, AntiWindup::None);
    let conditional = config((clamping, "anti_windup.kind = \"conditional\"\n"));
    assert_eq!(conditional.anti_windup, AntiWindup::Conditional);
    let weight = "setpoint_weights.derivative = 0.5\nderivative_on = \"error\"";
    let measured = config((weight, "derivative_on = \"measurement\""));
    assert_eq!(measured.setpoint_weights, SetpointWeights { proportional: 0.8, derivative: 0.0 });
    let both = config((weight, "setpoint_weights.derivative = 0\nderivative_on = \"measurement\""));
    assert_eq!(both.setpoint_weights, measured.setpoint_weights);

    let down = whole().replacen("\"nose-up-positive\"", "\"nose-down-positive\"", 1);
    let scenario = read(&down);
    assert_eq!(
        scenario.plant.linear().expect("linear").elevator_sign(),
        ElevatorSign::NoseDownPositive
    );
    // A change takes over the plant's sign, unless it is a plant with a sign of its own.
    let signs: Vec<ElevatorSign> =
        scenario.plant_changes.iter().map(|change| change.target().elevator_sign()).collect();
    assert_eq!(signs, [ElevatorSign::NoseDownPositive, ElevatorSign::NoseUpPositive]);

    for (word, policy) in [("clamp", OutOfRange::Clamp), ("error", OutOfRange::Error)] {
        let text = whole().replacen("\"evaluate\"", &format!("\"{word}\""), 1);
        let Controller::SelfTuning(fspid) = read(&text).controllers[3].controller else {
            panic!("self-tuning")
        };
        let table = rule_table("printed").expect("carried");
        let expected = Supervisor::new(&table, 5.0, Defuzzifier::Endpoints(101), policy);
        assert_eq!(Ok(*fspid.tuner().supervisor()), expected);
    }
}

//! Scenarios with every option that a proof accepts, drawn from a number.

use fspid_core::{
    AntiWindup, Change, ControllerSetting, DeadZone, Derivative, ErrorSign, Fspid, GainCoupling,
    GainLimits, Gains, Guard, InputScale, InputSets, IntegralForm, Law, Limits, Pid, PidConfig,
    ReferenceModel, SecondInput, SelfTuner, SetCentres, SetpointWeights, TunerSettings,
};
use fspid_fuzzy::{Defuzzifier, Network, NumberTable, OutOfRange, RuleTable, Supervisor};
use fspid_sim::actuator::{Actuator, Lag};
use fspid_sim::sensor::{PITCH, Sensor, SensorModel};
use fspid_sim::signal::{Disturbance, Entry, Profile, Shape};
use fspid_sim::{
    Controller, ElevatorSign, LinearPlant, NamedController, Plant, Scenario, Surroundings, Timing,
};

const DEG: f64 = core::f64::consts::PI / 180.0;
const LABELS: [&str; 7] = ["NB", "NM", "NS", "ZO", "PS", "PM", "PB"];
/// Plants of the books: numerator, denominator, size of the gains that hold them.
const PLANTS: [(&[f64], &[f64], f64); 4] = [
    (&[-1.69144, -0.84341, -0.0099096], &[1.0, 1.17103, 1.55405, 0.012538, 0.0072771], 1.0),
    // Short periods beside a free integrator.
    (&[-1.1573, -0.435], &[1.0, 0.740, 0.9272, 0.0], 1.0),
    (&[-11.304, -23.616], &[1.0, 5.05, 13.2, 0.0], 0.4),
    (&[-11.01, -22.6, -1.31], &[1.0, 5.1, 13.3, 0.684, 0.632], 0.4),
];

/// Numbers from a number: SplitMix64.
pub(crate) struct Dice(u64);

impl Dice {
    /// Begins where no other seed comes by: steps of the generator's own increment would make the numbers of one seed
    /// those of the seed before it, moved by one place.
    pub(crate) fn new(seed: u64) -> Self {
        Self(Self(seed).next())
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    pub(crate) fn part(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, lower: f64, upper: f64) -> f64 {
        lower + (upper - lower) * self.part()
    }

    /// From a to b with even odds for each factor.
    fn sized(&mut self, lower: f64, upper: f64) -> f64 {
        lower * libm::pow(upper / lower, self.part())
    }

    fn happens(&mut self, chance: f64) -> bool {
        self.part() < chance
    }

    fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[(self.part() * all.len() as f64) as usize % all.len()]
    }
}

/// A scenario with one controller and one linear plant.
pub(crate) fn scenario(dice: &mut Dice) -> Scenario {
    of_controllers(dice, controller)
}

/// The same with a self-tuner of another structure than the paper's: what it sees, how its sets lie, what its rules
/// conclude, what follows its gains, and more often than not a law that remembers.
pub(crate) fn structured(dice: &mut Dice) -> Scenario {
    structured_by(dice, |dice, plain, settings| {
        let numbers = dice.happens(0.5).then(|| numbers(dice, 5.0, plain.out_of_range()));
        (numbers.unwrap_or(*plain), settings)
    })
}

/// The same with a network in the place of rules.
pub(crate) fn networked(dice: &mut Dice) -> Scenario {
    structured_by(dice, |dice, plain, settings| {
        let settings = TunerSettings { input_sets: InputSets::EVEN, ..settings };
        (network(dice, 5.0, plain.out_of_range()), settings)
    })
}

/// The supervisor in the place of a plain one, and the settings around it.
type Another =
    fn(&mut Dice, &Supervisor<f64>, TunerSettings<f64>) -> (Supervisor<f64>, TunerSettings<f64>);

fn structured_by(dice: &mut Dice, another_of: Another) -> Scenario {
    of_controllers(dice, |dice, config, size| {
        let weights =
            SetpointWeights { proportional: dice.between(0.2, 1.2), ..config.setpoint_weights };
        let integral = IntegralForm::Bumpless;
        let config = PidConfig { setpoint_weights: weights, integral, ..config };
        let Controller::SelfTuning(fspid) = controller(dice, config, size) else {
            return controller(dice, config, size);
        };
        let plain = fspid.tuner();
        let settings = another(dice, *plain.settings(), plain.nominal());
        let (supervisor, settings) = another_of(dice, plain.supervisor(), settings);
        let tuner = SelfTuner::new(plain.nominal(), supervisor, settings).expect("allowed");
        Controller::SelfTuning(Fspid::new(tuner, config).expect("allowed"))
    })
}

fn another(
    dice: &mut Dice,
    settings: TunerSettings<f64>,
    nominal: Gains<f64>,
) -> TunerSettings<f64> {
    let model =
        ReferenceModel { bandwidth_rad_s: dice.sized(0.5, 4.0), damping: dice.between(0.5, 1.2) };
    let centres = |dice: &mut Dice| {
        let small = dice.between(0.05, 0.6);
        let medium = dice.between(small + 0.1, 0.95);
        if dice.happens(0.6) { SetCentres::new(small, medium).ok() } else { None }
    };
    let input_sets = InputSets { error: centres(dice), change: centres(dice) };
    let gain_coupling = if dice.happens(0.5) {
        GainCoupling {
            setpoint_weight: dice.between(-0.3, 0.3) / nominal.kp,
            rate_gain: dice.between(-0.5, 0.5),
        }
    } else {
        GainCoupling::NONE
    };
    let remembers = dice.happens(0.7);
    let leakage_per_s = dice.sized(0.3, 3.0);
    // What the law adds in a second is what it leaks there.
    let of_law = if remembers { 0.6 * leakage_per_s } else { 1.0 };
    let scale = settings.output_scale;
    TunerSettings {
        second_input: dice.one_of(&[
            SecondInput::Change,
            SecondInput::Rate,
            SecondInput::ModelError(model),
            SecondInput::ModelError(model),
        ]),
        input_sets,
        gain_coupling,
        law: if remembers { Law::Accumulating { leakage_per_s } } else { settings.law },
        output_scale: Gains { kp: of_law * scale.kp, ki: of_law * scale.ki, kd: of_law * scale.kd },
        ..settings
    }
}

fn numbers(dice: &mut Dice, range: f64, policy: OutOfRange) -> Supervisor<f64> {
    let mut grid = || {
        let [by_error, by_second] = [dice.between(-1.2, 1.2), dice.between(-1.2, 1.2)];
        let bent = dice.between(-1.0, 1.0);
        core::array::from_fn(|row| {
            core::array::from_fn(|column| {
                let [e, c] = [row, column].map(|step: usize| step as f64 / 3.0 - 1.0);
                range * (by_error * e + by_second * c + bent * e * c).clamp(-1.0, 1.0)
            })
        })
    };
    let table = NumberTable::new([grid(), grid(), grid()]).expect("finite");
    Supervisor::of_numbers(&table, range, policy).expect("allowed")
}

fn network(dice: &mut Dice, range: f64, policy: OutOfRange) -> Supervisor<f64> {
    let steep = dice.sized(0.3, 6.0);
    let rows = [steep, steep, 2.0, 1.0, 1.0, 1.0];
    let rows = rows.map(|size| [0; 8].map(|_| dice.between(-size, size)));
    let network = Network::new(rows).expect("allowed");
    Supervisor::of_network(&network, range, policy).expect("allowed")
}

fn of_controllers(
    dice: &mut Dice,
    controller: impl Fn(&mut Dice, PidConfig<f64>, f64) -> Controller,
) -> Scenario {
    let dt_s = dice.one_of(&[0.01, 0.02, 0.05]);
    let (numerator, denominator, size) = dice.one_of(&PLANTS);
    let mut bent = |values: &[f64]| -> Vec<f64> {
        values.iter().map(|value| value * dice.between(0.8, 1.25)).collect()
    };
    let (numerator, mut denominator) = (bent(numerator), bent(denominator));
    denominator[0] = 1.0;
    let plant = LinearPlant::new(&numerator, &denominator, ElevatorSign::NoseDownPositive);
    let config = config(dice, dt_s, size);
    let controller = controller(dice, config, size);
    let load =
        Disturbance::new(Entry::Elevator, dice.between(0.0, 5.0) * DEG, Shape::Step { at_s: 1.0 });
    // Up to what no servo here holds.
    let setpoint_rad = dice.sized(0.3, 90.0) * DEG;
    Scenario {
        name: "drawn".to_owned(),
        plant: Plant::from(plant.expect("a plant")),
        plant_changes: Vec::new(),
        timing: Timing::new(dt_s, 5.0).expect("allowed"),
        setpoint: Profile::new(setpoint_rad, Shape::Step { at_s: 0.0 }).expect("allowed"),
        disturbances: if dice.happens(0.5) { vec![load.expect("allowed")] } else { Vec::new() },
        controllers: vec![NamedController { name: "C".to_owned(), controller }],
        externals: Vec::new(),
        actuator: actuator(dice),
        surroundings: Surroundings { weather: None, pitch_sensor: sensor(dice), rate_sensor: None },
        autopilot: None,
    }
}

/// A scenario with fixed gains whose steps are held up by limits of servo and command.
pub(crate) fn with_limits(dice: &mut Dice) -> Scenario {
    let mut scenario = scenario(dice);
    scenario.surroundings.pitch_sensor = None;
    let lag = Lag::first_order(dice.between(0.05, 0.15)).expect("allowed");
    let limit_rad = dice.between(12.0, 30.0) * DEG;
    let servo = Actuator::new(lag)
        .with_command_limits(-limit_rad, limit_rad)
        .and_then(|servo| servo.with_rate_limit(dice.between(15.0, 60.0) * DEG))
        .and_then(|servo| servo.with_delay(dice.one_of(&[0, 1, 3])));
    scenario.actuator = servo.expect("allowed");
    let step_rad = dice.between(1.0, 6.0) * DEG;
    scenario.setpoint = Profile::new(step_rad, Shape::Step { at_s: 0.0 }).expect("allowed");
    let controller = &scenario.controllers[0].controller;
    let config = PidConfig {
        integral: IntegralForm::Bumpless,
        guard: Guard::default(),
        ..*controller.config()
    };
    let fixed = Pid::new(controller.nominal(), config).expect("allowed");
    scenario.controllers[0].controller = Controller::Fixed(fixed);
    scenario
}

/// The same with a self-tuner that remembers, by rules that conclude numbers, and moves nothing that holds a set-point.
#[allow(dead_code, reason = "asked by a test inside of the crate")]
pub(crate) fn remembering_with_limits(dice: &mut Dice) -> Scenario {
    remembering_by(dice, |dice, _, settings| {
        let settings = remembering(dice, settings);
        (numbers(dice, 5.0, OutOfRange::Clamp), settings)
    })
}

/// The same by a network.
#[allow(dead_code, reason = "asked by a test inside of the crate")]
pub(crate) fn remembering_network_with_limits(dice: &mut Dice) -> Scenario {
    remembering_by(dice, |dice, _, settings| {
        let settings = TunerSettings { input_sets: InputSets::EVEN, ..settings };
        let settings = remembering(dice, settings);
        (network(dice, 5.0, OutOfRange::Clamp), settings)
    })
}

fn remembering(dice: &mut Dice, settings: TunerSettings<f64>) -> TunerSettings<f64> {
    let leakage_per_s = dice.sized(0.3, 3.0);
    let scale = settings.output_scale;
    let of_law = |gain: f64| 0.6 * leakage_per_s * gain;
    let coupling = GainCoupling { setpoint_weight: 0.0, ..settings.gain_coupling };
    let second_input = match settings.second_input {
        SecondInput::Rate => SecondInput::Change,
        other => other,
    };
    TunerSettings {
        law: Law::Accumulating { leakage_per_s },
        output_scale: Gains { kp: of_law(scale.kp), ki: of_law(scale.ki), kd: of_law(scale.kd) },
        gain_coupling: coupling,
        second_input,
        dead_zone: None,
        ..settings
    }
}

fn remembering_by(dice: &mut Dice, another_of: Another) -> Scenario {
    let mut scenario = structured_by(dice, another_of);
    let controller = scenario.controllers[0].controller;
    let limited = with_limits(dice);
    if let Controller::SelfTuning(fspid) = controller {
        let weights = SetpointWeights { proportional: 1.0, ..fspid.config().setpoint_weights };
        let config =
            PidConfig { setpoint_weights: weights, guard: Guard::default(), ..*fspid.config() };
        let fspid = Fspid::new(*fspid.tuner(), config).expect("allowed");
        scenario.controllers[0].controller = Controller::SelfTuning(fspid);
    }
    Scenario {
        actuator: limited.actuator,
        setpoint: limited.setpoint,
        surroundings: limited.surroundings,
        ..scenario
    }
}

fn actuator(dice: &mut Dice) -> Actuator {
    let lag = match (dice.part() * 4.0) as u32 {
        0 => Lag::NONE,
        1 => Lag::second_order(dice.between(10.0, 40.0), dice.between(0.5, 1.2)).expect("allowed"),
        _ => Lag::first_order(dice.sized(0.02, 0.2)).expect("allowed"),
    };
    let mut actuator = Actuator::new(lag);
    if dice.happens(0.3) {
        actuator = actuator.with_delay((dice.part() * 4.0) as usize).expect("allowed");
    }
    if dice.happens(0.3) {
        let limit = dice.between(5.0, 30.0) * DEG;
        actuator = actuator.with_command_limits(-limit, limit).expect("allowed");
    }
    if dice.happens(0.2) {
        actuator = actuator.with_rate_limit(dice.between(10.0, 60.0) * DEG).expect("allowed");
    }
    if dice.happens(0.1) {
        actuator = actuator.with_travel(-20.0 * DEG, 15.0 * DEG).expect("allowed");
    }
    if dice.happens(0.1) {
        actuator = actuator.with_bias(dice.between(-2.0, 2.0) * DEG).expect("allowed");
    }
    actuator
}

fn sensor(dice: &mut Dice) -> Option<Sensor> {
    if dice.happens(0.6) {
        return None;
    }
    let pick =
        |dice: &mut Dice, most: f64| if dice.happens(0.5) { dice.between(0.0, most) } else { 0.0 };
    let model = SensorModel {
        scale_error: pick(dice, 0.2),
        delay_s: pick(dice, 0.03),
        bias: pick(dice, 0.02),
        resolution: if dice.happens(0.3) { dice.sized(1e-6, 1e-3) } else { 0.0 },
        ..SensorModel::default()
    };
    let seed = (dice.part() * 1e6) as u64;
    Some(Sensor::new(model, seed, PITCH).expect("allowed"))
}

fn config(dice: &mut Dice, dt_s: f64, size: f64) -> PidConfig<f64> {
    let angle = |dice: &mut Dice, upper: f64| dice.between(5.0, upper) * DEG;
    let around_zero =
        |limit: f64| Limits::new(ControllerSetting::OutputLimits, -limit, limit).expect("allowed");
    let limits = if dice.happens(0.2) { Some(around_zero(angle(dice, 30.0))) } else { None };
    let slew_rad_s = if dice.happens(0.1) { Some(angle(dice, 200.0)) } else { None };
    let can_cut = limits.is_some() || slew_rad_s.is_some();
    let anti_windup = match (dice.part() * 4.0) as u32 {
        1 => AntiWindup::Clamping(around_zero(angle(dice, 30.0))),
        2 if can_cut => AntiWindup::Conditional,
        3 if can_cut => AntiWindup::BackCalculation { tracking_s: 1.0 },
        _ => AntiWindup::None,
    };
    PidConfig {
        rate_gain_s: if dice.happens(0.3) { dice.between(0.0, 0.8 * size) } else { 0.0 },
        setpoint_weights: SetpointWeights {
            proportional: dice.one_of(&[0.0, 0.0, 0.3, 0.7, 1.0, 1.0, 1.3, -0.5]),
            derivative: dice.one_of(&[0.0, 0.5, 1.0]),
        },
        feedforward: if dice.happens(0.25) { dice.between(-size, size) } else { 0.0 },
        derivative: Derivative { filter_s: dice.one_of(&[0.0, 0.05, 0.1]) },
        integral: dice.one_of(&[
            IntegralForm::Bumpless,
            IntegralForm::Bumpless,
            IntegralForm::Literal,
        ]),
        anti_windup,
        limits,
        slew_rad_s,
        guard: if dice.happens(0.1) {
            Guard::new(dice.between(10.0, 60.0) * DEG).expect("allowed")
        } else {
            Guard::default()
        },
        ..PidConfig::sampled_every(dt_s)
    }
}

fn controller(dice: &mut Dice, config: PidConfig<f64>, size: f64) -> Controller {
    let integral = !dice.happens(0.1);
    let nominal = Gains {
        kp: size * dice.between(0.7, 2.2),
        ki: if integral { size * dice.between(0.1, 0.7) } else { 0.0 },
        kd: size * dice.between(0.0, 1.0),
    };
    if dice.happens(0.1) {
        return Controller::Fixed(Pid::new(nominal, config).expect("allowed"));
    }
    let tuner =
        SelfTuner::new(nominal, supervisor(dice), settings(dice, nominal)).expect("allowed");
    Controller::SelfTuning(Fspid::new(tuner, config).expect("allowed"))
}

fn settings(dice: &mut Dice, nominal: Gains<f64>) -> TunerSettings<f64> {
    // With labels of five units at most, so much of the nominal gains.
    let mut share =
        |most: f64| if dice.happens(0.8) { dice.between(-most, most) / 5.0 } else { 0.0 };
    let output_scale = Gains {
        kp: nominal.kp * share(0.8),
        ki: nominal.ki * share(0.8),
        kd: nominal.kd * share(0.8),
    };
    let law = if dice.happens(0.15) {
        Law::Accumulating { leakage_per_s: dice.sized(0.3, 5.0) }
    } else {
        Law::Memoryless
    };
    let around = |dice: &mut Dice, gain: f64| {
        let share = dice.between(0.1, 0.6);
        Limits::new(
            ControllerSetting::GainLimits,
            gain * (1.0 - share),
            gain * (1.0 + share) + 1e-9,
        )
        .expect("allowed")
    };
    let gain_limits = if dice.happens(0.2) {
        Some(GainLimits {
            kp: around(dice, nominal.kp),
            ki: around(dice, nominal.ki),
            kd: around(dice, nominal.kd),
        })
    } else {
        None
    };
    TunerSettings {
        error_sign: dice
            .one_of(&[ErrorSign::SetpointMinusMeasurement, ErrorSign::MeasurementMinusSetpoint]),
        change: dice.one_of(&[Change::Rate, Change::Delta]),
        input_scale: InputScale {
            error_per_rad: dice.sized(5.0, 500.0),
            change_per_rad: if dice.happens(0.9) { dice.sized(1.0, 60.0) } else { 0.0 },
        },
        output_scale,
        law,
        gain_limits,
        dead_zone: if dice.happens(0.15) {
            Some(DeadZone {
                error_rad: dice.between(0.0, 0.5) * DEG,
                change_rad: dice.between(0.0, 0.5) * DEG,
            })
        } else {
            None
        },
        ..TunerSettings::literal()
    }
}

fn supervisor(dice: &mut Dice) -> Supervisor<f64> {
    let mut grid = || -> String {
        let wild = dice.happens(0.4);
        let [by_error, by_change] = [dice.between(-1.2, 1.2), dice.between(-1.2, 1.2)];
        let bent = dice.between(-1.0, 1.0);
        let row = |error: i32, dice: &mut Dice| -> String {
            let label = |change: i32| {
                let (e, c) = (f64::from(error - 3), f64::from(change - 3));
                let smooth = by_error * e + by_change * c + bent * e * c / 3.0;
                let value = if wild { dice.between(-3.4, 3.4) } else { smooth };
                LABELS[(value.round().clamp(-3.0, 3.0) + 3.0) as usize]
            };
            (0..7).map(label).collect::<Vec<_>>().join(" ")
        };
        (0..7).map(|error| row(error, dice)).collect::<Vec<_>>().join("\n")
    };
    let texts = [grid(), grid(), grid()];
    let table = RuleTable::parse(texts.each_ref().map(String::as_str)).expect("a table");
    let rule = dice.one_of(&[
        Defuzzifier::Exact,
        Defuzzifier::Exact,
        Defuzzifier::Endpoints(101),
        Defuzzifier::Midpoint(60),
    ]);
    let policy = dice.one_of(&[
        OutOfRange::Clamp,
        OutOfRange::Clamp,
        OutOfRange::Error,
        OutOfRange::Evaluate,
    ]);
    Supervisor::new(&table, 5.0, rule, policy).expect("allowed")
}

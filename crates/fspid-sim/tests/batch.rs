//! Flights side by side have the bits of single flights, whatever flies beside them.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use std::ops::ControlFlow;

use fspid_core::fuzzy::{Defuzzifier, NumberTable, OutOfRange, RuleTable, Supervisor};
use fspid_core::{
    AntiWindup, Change, ControllerSetting, DeadZone, Derivative, ErrorSign, Fspid, GainCoupling,
    GainLimits, Gains, Guard, InputScale, InputSets, IntegralForm, Law, Limits, Pid, PidConfig,
    ReferenceModel, SecondInput, SelfTuner, SetCentres, SetpointWeights, TunerSettings,
};
use fspid_sim::batch::{Entrant, InstructionSet, Refusal, fly_group_by, fly_many};
use fspid_sim::signal::{Disturbance, Entry, Profile, Shape};
use fspid_sim::{
    Actuator, Controller, EarlyEnd, ElevatorSign, EndCause, Instant, LinearPlant, Outcome,
    PlantChange, Prepared, Scenario, SimError, Surroundings, Timing, fly,
};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// What may differ between cases but not between the flights of one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Structure {
    order: usize,
    self_tuning: bool,
    /// Whether the rules conclude numbers, different ones in each flight.
    numbers: bool,
    literal: bool,
    feeds_forward: bool,
    anti_windup: u8,
    accumulates: bool,
    /// What the supervisor sees: change, rate, model.
    second_input: u8,
    policy: OutOfRange,
    /// Faults, limits, changes of the plant, everything.
    wild: bool,
}

/// Numbers that depend on a seed alone: the generator of Steele, Lea and Flood (2014).
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(super) fn one_of<T: Copy>(&mut self, values: &[T]) -> T {
        let place = self.bits() % values.len() as u64;
        values[usize::try_from(place).expect("a place of the list")]
    }

    pub(super) fn one_in(&mut self, count: u64) -> bool {
        self.bits().is_multiple_of(count)
    }
}

fn table() -> RuleTable {
    let file = include_str!("../../../data/rule-tables/printed.toml");
    let parts: Vec<&str> = file.split("\"\"\"").collect();
    RuleTable::parse([parts[1], parts[3], parts[5]]).expect("a shipped table")
}

/// A stable plant of that order, near the paper's for 3 (Navion) and 4 (747).
fn plant(random: &mut Random, order: usize, nose_up: bool) -> LinearPlant {
    let (numerator, denominator): (&[f64], &[f64]) = match order {
        1 => (&[1.0], &[1.0, 0.5]),
        2 => (&[2.0], &[1.0, 1.2, 2.0]),
        3 => (&[11.7304, 22.578], &[1.0, 4.9676, 12.941, 0.1]),
        4 => (&[1.69144, 0.84341, 0.009_909_6], &[1.0, 1.17103, 1.55405, 0.012_538, 0.007_277_1]),
        // That of order 4 behind a lag of 0.2 s.
        _ => (&[8.4572, 4.217, 0.05], &[1.0, 6.17103, 7.4092, 7.7828, 0.069_967, 0.036_386]),
    };
    let (sign, factor) = if nose_up {
        (ElevatorSign::NoseUpPositive, 1.0)
    } else {
        (ElevatorSign::NoseDownPositive, -1.0)
    };
    let mut near = |value: &f64| value * random.between(0.9, 1.1);
    let numerator: Vec<f64> = numerator.iter().map(|n| factor * near(n)).collect();
    let denominator: Vec<f64> = denominator.iter().map(near).collect();
    LinearPlant::new(&numerator, &denominator, sign).expect("proper")
}

fn servo(random: &mut Random, wild: bool) -> Actuator {
    let mut servo = Actuator::first_order(random.between(0.03, 0.2)).expect("allowed");
    if !wild {
        return servo;
    }
    if random.one_in(4) {
        servo = Actuator::ideal();
    }
    if random.one_in(2) {
        servo = servo.with_position_limit(random.between(0.05, 0.5)).expect("allowed");
    }
    if random.one_in(3) {
        servo = servo.with_rate_limit(random.between(0.1, 3.0)).expect("allowed");
    }
    servo.with_delay((random.bits() % 6) as usize).expect("allowed")
}

fn config(random: &mut Random, structure: Structure) -> PidConfig<f64> {
    let mut config = PidConfig::sampled_every(0.02);
    if structure.feeds_forward {
        config.feedforward = random.between(-1.0, 1.0);
    }
    if structure.literal {
        config.integral = IntegralForm::Literal;
    }
    let limits = |size: f64| {
        Limits::new(ControllerSetting::OutputLimits, -size, 0.8 * size).expect("allowed")
    };
    config.anti_windup = match structure.anti_windup {
        0 => AntiWindup::None,
        1 => AntiWindup::Clamping(limits(random.between(0.01, 0.3))),
        2 => AntiWindup::Conditional,
        _ => AntiWindup::BackCalculation { tracking_s: random.between(0.02, 2.0) },
    };
    if structure.anti_windup > 1 || (structure.wild && random.one_in(2)) {
        config.limits = Some(limits(random.between(0.05, 1.0)));
    }
    if !structure.wild {
        return config;
    }
    config.rate_gain_s = if random.one_in(2) { random.between(0.0, 0.5) } else { 0.0 };
    config.setpoint_weights = SetpointWeights {
        proportional: random.between(0.0, 1.0),
        derivative: random.between(0.0, 1.0),
    };
    config.derivative = Derivative { filter_s: random.between(0.0, 0.1) };
    if random.one_in(2) {
        config.slew_rad_s = Some(random.between(0.1, 5.0));
    }
    if random.one_in(4) {
        // So small that some samples are not believed.
        config.guard = Guard::new(random.between(0.3, 2.0)).expect("allowed");
    }
    config
}

fn supervisor(random: &mut Random, structure: Structure) -> Supervisor<f64> {
    let supervisor = if structure.numbers {
        let grids = [[[0.0; 7]; 7]; 3];
        let grids = grids.map(|grid| grid.map(|row| row.map(|_| random.between(-5.0, 5.0))));
        let numbers = NumberTable::new(grids).expect("finite");
        Supervisor::of_numbers(&numbers, 5.0, structure.policy)
    } else {
        Supervisor::new(&table(), 5.0, Defuzzifier::Exact, structure.policy)
    };
    supervisor.expect("allowed")
}

fn tuner(random: &mut Random, structure: Structure, gains: Gains<f64>) -> SelfTuner<f64> {
    let supervisor = supervisor(random, structure);
    let scale = if random.one_in(6) { 100.0 } else { 1.0 };
    let mut settings = TunerSettings {
        input_scale: InputScale {
            error_per_rad: scale * random.between(0.5, 10.0),
            change_per_rad: random.between(0.01, 1.0),
        },
        output_scale: Gains {
            kp: random.between(0.0, 0.3),
            ki: random.between(0.0, 0.02),
            kd: random.between(0.0, 0.1),
        },
        ..TunerSettings::literal()
    };
    settings.second_input = match structure.second_input {
        0 => SecondInput::Change,
        1 => SecondInput::Rate,
        _ => SecondInput::ModelError(ReferenceModel {
            bandwidth_rad_s: random.between(0.3, 10.0),
            damping: random.between(0.3, 1.5),
        }),
    };
    if structure.accumulates {
        settings.law = Law::Accumulating { leakage_per_s: random.between(0.0, 2.0) };
    }
    if structure.wild {
        make_wild(&mut settings, random, gains);
    }
    SelfTuner::new(gains, supervisor, settings).expect("allowed")
}

/// Each setting that few tuners have, in half of all draws.
fn make_wild(settings: &mut TunerSettings<f64>, random: &mut Random, gains: Gains<f64>) {
    if random.one_in(2) {
        settings.error_sign = ErrorSign::MeasurementMinusSetpoint;
    }
    if random.one_in(2) {
        settings.change = Change::Delta;
    }
    let places = |random: &mut Random| {
        let places = SetCentres::new(random.between(0.05, 0.4), random.between(0.5, 0.95));
        random.one_in(2).then(|| places.expect("in order"))
    };
    settings.input_sets = InputSets { error: places(random), change: places(random) };
    if random.one_in(2) {
        settings.gain_coupling = GainCoupling {
            setpoint_weight: random.between(-1.0, 1.0),
            rate_gain: random.between(-1.0, 1.0),
        };
    }
    if random.one_in(2) {
        settings.dead_zone = Some(DeadZone {
            error_rad: random.between(0.0, 0.2),
            change_rad: random.between(0.0, 2.0),
        });
    }
    if random.one_in(2) {
        let around = |gain: f64| {
            Limits::new(ControllerSetting::GainLimits, gain - 0.2, gain + 0.3).expect("allowed")
        };
        settings.gain_limits =
            Some(GainLimits { kp: around(gains.kp), ki: around(gains.ki), kd: around(gains.kd) });
    }
}

fn controller(random: &mut Random, structure: Structure) -> Controller {
    // Some loops diverge.
    let size = if structure.wild && random.one_in(4) { 1e5 } else { 1.0 };
    // Some integrals stand still, or need a sum that is no number.
    let ki = match random.bits() % 8 {
        0 => 0.0,
        1 => 1e-320,
        _ => random.between(0.0, 0.5),
    };
    let gains = Gains { kp: size * random.between(0.1, 2.0), ki, kd: random.between(0.0, 0.5) };
    let config = config(random, structure);
    if structure.self_tuning {
        let tuner = tuner(random, structure, gains);
        return Controller::SelfTuning(Fspid::new(tuner, config).expect("allowed"));
    }
    Controller::Fixed(Pid::new(gains, config).expect("allowed"))
}

fn scenario(random: &mut Random, structure: Structure) -> Scenario {
    let mut scenario = Scenario {
        name: "batch".into(),
        plant: plant(random, structure.order, false).into(),
        plant_changes: Vec::new(),
        actuator: servo(random, structure.wild),
        timing: Timing::new(0.02, 3.0).expect("allowed"),
        setpoint: Profile::new(random.between(-1.0, 1.0), Shape::Step { at_s: 0.3 })
            .expect("allowed"),
        disturbances: Vec::new(),
        controllers: Vec::new(),
        externals: Vec::new(),
        surroundings: Surroundings::default(),
        autopilot: None,
    };
    if structure.wild {
        for entry in Entry::ALL {
            if random.one_in(2) {
                let shape = Shape::Noise { at_s: 0.5, seed: random.bits() };
                let size = random.between(0.0, 0.1);
                scenario.disturbances.push(Disturbance::new(entry, size, shape).expect("allowed"));
            }
        }
        if random.one_in(4) {
            let change = PlantChange::new(
                random.between(0.0, 2.0),
                random.between(0.0, 0.3),
                plant(random, structure.order, true),
            );
            scenario.plant_changes.push(change.expect("allowed"));
        }
    }
    scenario
}

/// The bits of an instant; all NaN alike.
pub(super) fn bits(instant: &Instant) -> ([u64; 12], bool, u8) {
    let Instant { setpoint_rad, theta_rad, q_rad_s, elevator_rad, measured, step, .. } = instant;
    let [seen_rad, seen_rad_s] = measured;
    let gains = step.gains;
    let numbers = [
        *setpoint_rad,
        *theta_rad,
        *q_rad_s,
        *elevator_rad,
        *seen_rad,
        *seen_rad_s,
        step.command_rad,
        gains.kp,
        gains.ki,
        gains.kd,
        instant.k as f64,
        0.0,
    ];
    let one_nan = |number: f64| if number.is_nan() { f64::NAN } else { number };
    (numbers.map(|number| one_nan(number).to_bits()), step.saturated, step.faults.bits())
}

pub(super) type Flown = (Vec<([u64; 12], bool, u8)>, Result<Outcome, SimError>);

pub(super) fn singly(flights: &[(Prepared, Controller)]) -> Vec<Flown> {
    let single = |(prepared, controller): &(Prepared, Controller)| {
        let mut rows = Vec::new();
        let outcome = fly(prepared, controller, |instant| {
            rows.push(bits(&instant));
            ControlFlow::Continue(())
        });
        (rows, outcome)
    };
    flights.iter().map(single).collect()
}

fn entrants(flights: &[(Prepared, Controller)]) -> Vec<Entrant<'_>> {
    flights.iter().map(|(prepared, controller)| Entrant { prepared, controller }).collect()
}

fn side_by_side<const W: usize>(flights: &[(Prepared, Controller)]) -> Vec<Flown> {
    let mut rows = vec![Vec::new(); flights.len()];
    let outcomes = fly_many::<W>(&entrants(flights), |flight, instant| {
        rows[flight].push(bits(instant));
    });
    rows.into_iter().zip(outcomes.expect("all of one structure")).collect()
}

pub(super) fn flights(
    structure: Structure,
    seed: u64,
    count: usize,
) -> Vec<(Prepared, Controller)> {
    let mut random = Random(seed);
    let flight = |_| {
        let scenario = scenario(&mut random, structure);
        (scenario.prepare().expect("flies"), controller(&mut random, structure))
    };
    (0..count).map(flight).collect()
}

fn assert_same(found: &[Flown], expected: &[Flown], lanes: usize) {
    assert_eq!(found.len(), expected.len());
    for (flight, (found, expected)) in found.iter().zip(expected).enumerate() {
        let differs = found.0.iter().zip(&expected.0).position(|(a, b)| a != b);
        assert_eq!(differs, None, "{lanes} lanes, flight {flight}");
        assert_eq!(found.0.len(), expected.0.len(), "{lanes} lanes, flight {flight}");
        assert_eq!(found.1, expected.1, "{lanes} lanes, flight {flight}");
    }
}

fn compare(structure: Structure, seed: u64, count: usize) {
    let flights = flights(structure, seed, count);
    let expected = singly(&flights);
    assert_same(&side_by_side::<1>(&flights), &expected, 1);
    assert_same(&side_by_side::<4>(&flights), &expected, 4);
    assert_same(&side_by_side::<8>(&flights), &expected, 8);
    assert_same(&side_by_side::<16>(&flights), &expected, 16);
}

pub(super) fn structure() -> impl Strategy<Value = Structure> {
    let policy = prop::sample::select(OutOfRange::ALL.to_vec());
    let flags = (any::<bool>(), any::<bool>(), any::<bool>(), any::<bool>(), any::<bool>());
    let kinds = (0_u8..4, 0_u8..3, any::<bool>());
    (1_usize..=5, flags, kinds, policy).prop_map(|(order, flags, kinds, policy)| {
        let (self_tuning, literal, accumulates, wild, numbers) = flags;
        let (anti_windup, second_input, feeds_forward) = kinds;
        Structure {
            order,
            self_tuning,
            numbers,
            literal,
            feeds_forward,
            anti_windup,
            accumulates,
            second_input,
            policy,
            wild,
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 60,
        rng_seed: RngSeed::Fixed(6),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn every_sample_of_every_flight_has_the_bits_of_a_single_flight(
        structure in structure(), seed in any::<u64>(), count in 1_usize..20,
    ) {
        compare(structure, seed, count);
    }
}

pub(super) const PLAIN: Structure = Structure {
    order: 4,
    self_tuning: true,
    numbers: false,
    literal: false,
    feeds_forward: false,
    anti_windup: 0,
    accumulates: false,
    second_input: 0,
    policy: OutOfRange::Clamp,
    wild: false,
};

pub(super) const WILD: Structure = Structure { wild: true, ..PLAIN };

#[test]
fn flights_with_numbers_of_their_own_have_the_bits_of_single_flights() {
    for (seed, policy) in (7_u64..).zip(OutOfRange::ALL) {
        compare(Structure { numbers: true, wild: seed % 2 == 0, policy, ..PLAIN }, seed, 19);
    }
}

#[test]
fn the_wild_flights_meet_what_they_are_for() {
    let (mut diverged, mut faulty, mut cut) = (0, 0, 0);
    for (seed, policy) in (0_u64..).zip(OutOfRange::ALL) {
        let flights = flights(Structure { wild: true, policy, ..PLAIN }, seed, 200);
        for (rows, outcome) in singly(&flights) {
            diverged += usize::from(matches!(
                outcome,
                Ok(Outcome::EndedEarly(EarlyEnd { cause: EndCause::Diverged, .. }))
            ));
            faulty += usize::from(rows.iter().any(|(_, _, faults)| *faults != 0));
            cut += usize::from(rows.iter().any(|(_, saturated, _)| *saturated));
        }
    }
    assert!(diverged > 5 && faulty > 50 && cut > 200, "{diverged} {faulty} {cut}");
}

#[test]
fn a_flight_that_diverges_leaves_its_neighbours_their_bits() {
    let mut flights = flights(PLAIN, 1, 16);
    let expected = singly(&flights);
    let wild = Gains { kp: 1e6, ki: 0.0, kd: 1e4 };
    let mut config = PidConfig::sampled_every(0.02);
    config.guard = Guard::new(f64::MAX).expect("allowed");
    let settings = TunerSettings::literal();
    let supervisor = Supervisor::new(&table(), 5.0, Defuzzifier::Exact, OutOfRange::Clamp);
    let tuner = SelfTuner::new(wild, supervisor.expect("allowed"), settings).expect("allowed");
    for place in [0, 5, 15] {
        flights[place].1 = Controller::SelfTuning(Fspid::new(tuner, config).expect("allowed"));
    }
    for (place, (found, expected)) in side_by_side::<16>(&flights).iter().zip(&expected).enumerate()
    {
        if [0, 5, 15].contains(&place) {
            assert!(
                matches!(
                    found.1,
                    Ok(Outcome::EndedEarly(EarlyEnd { cause: EndCause::Diverged, .. }))
                ),
                "{place}"
            );
        } else {
            assert_same(std::slice::from_ref(found), std::slice::from_ref(expected), 16);
        }
    }
    assert_same(&side_by_side::<16>(&flights), &singly(&flights), 16);
}

#[test]
fn the_instructions_of_the_machine_do_not_show_in_the_bits() {
    let flights = flights(Structure { wild: true, ..PLAIN }, 3, 16);
    let expected: Vec<_> = singly(&flights).into_iter().map(|(rows, _)| rows).collect();
    for set in InstructionSet::available() {
        let mut rows = vec![Vec::new(); flights.len()];
        let flown = fly_group_by::<16>(set, &entrants(&flights), |row| {
            for (lane, rows) in rows.iter_mut().enumerate() {
                rows.extend(row.instant(lane).as_ref().map(bits));
            }
        });
        assert!(flown.is_ok() && rows == expected, "{set}");
    }
}

#[test]
fn flights_that_cannot_fly_side_by_side_are_refused_by_name() {
    let mut mixed = flights(PLAIN, 1, 3);
    let refusal = |flights: &[(Prepared, Controller)]| {
        fly_many::<2>(&entrants(flights), |_, _| {}).expect_err("refused")
    };
    mixed.extend(flights(Structure { self_tuning: false, ..PLAIN }, 1, 1));
    let what = "its kind of controller";
    assert_eq!(refusal(&mixed), Refusal::Differs { flight: 3, what });
    mixed[3] = flights(Structure { literal: true, ..PLAIN }, 1, 1).remove(0);
    let what = "the form of its integral";
    assert_eq!(refusal(&mixed), Refusal::Differs { flight: 3, what });
    mixed[3] = flights(Structure { feeds_forward: true, ..PLAIN }, 1, 1).remove(0);
    let what = "whether its set-point is fed forward";
    assert_eq!(refusal(&mixed), Refusal::Differs { flight: 3, what });
    mixed[3] = flights(Structure { policy: OutOfRange::Error, ..PLAIN }, 1, 1).remove(0);
    assert_eq!(refusal(&mixed), Refusal::Differs { flight: 3, what: "its supervisor" });
    mixed[3] = flights(Structure { numbers: true, ..PLAIN }, 1, 1).remove(0);
    assert_eq!(refusal(&mixed), Refusal::Differs { flight: 3, what: "its supervisor" });
    mixed[3] = flights(Structure { second_input: 1, ..PLAIN }, 1, 1).remove(0);
    let what = "what its supervisor sees";
    assert_eq!(refusal(&mixed), Refusal::Differs { flight: 3, what });

    mixed[3] = flights(Structure { order: 3, ..PLAIN }, 1, 1).remove(0);
    assert_eq!(refusal(&mixed), Refusal::Differs { flight: 3, what: "the order of its plant" });

    let mut other = scenario(&mut Random(1), PLAIN);
    other.timing = Timing::new(0.02, 1.0).expect("allowed");
    mixed[3] = (other.prepare().expect("flies"), mixed[0].1);
    assert_eq!(refusal(&mixed), Refusal::Differs { flight: 3, what: "its timing" });
    other.actuator = other.actuator.with_bias(0.01).expect("allowed");
    mixed[3] = (other.prepare().expect("flies"), mixed[0].1);
    assert_eq!(refusal(&mixed), Refusal::Part { flight: 3, what: "an actuator or gusts" });
    assert!(refusal(&mixed).to_string().starts_with("flight 3 has an actuator or gusts"));
    let many = fly_group_by::<2>(InstructionSet::best(), &entrants(&mixed), |_| {});
    assert_eq!(many.expect_err("refused"), Refusal::TooMany { found: 4, most: 2 });
}

#[test]
fn a_longer_flight_takes_no_more_memory() {
    let allocated = |duration_s: f64| {
        let mut scenario = scenario(&mut Random(1), PLAIN);
        scenario.timing = Timing::new(0.02, duration_s).expect("allowed");
        let flight = (scenario.prepare().expect("flies"), controller(&mut Random(1), PLAIN));
        let entrants = entrants(std::slice::from_ref(&flight));
        let counted = allocation_counter::measure(|| {
            let flown = fly_group_by::<8>(InstructionSet::best(), &entrants, |row| {
                assert!(row.flies(0));
            });
            assert!(flown.is_ok());
        });
        (counted.count_total, counted.bytes_total)
    };
    assert_eq!(allocated(1.0), allocated(30.0));
}

#[test]
fn no_flights_have_no_outcomes() {
    assert_eq!(fly_many::<8>(&[], |_, _| {}), Ok(Vec::new()));
}

//! Whoever flies, nobody gets below what is proved at his own travel.

use fspid_limit::{
    Assumed, LimitError, Measure, Question, Still, Travel, fly_commands, limit, measured,
};
use fspid_sim::actuator::Lag;
use fspid_sim::core::{Gains, Pid, PidConfig};
use fspid_sim::signal::{Disturbance, Entry, Profile, Shape};
use fspid_sim::{
    Actuator, Controller, ElevatorSign, LinearPlant, Outcome, Scenario, Timing, Trace, simulate,
};

const DEG: f64 = std::f64::consts::PI / 180.0;

/// Numbers by Marsaglia's xorshift.
struct Random(u64);

impl Random {
    fn share(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    fn one_of(&mut self, count: usize) -> usize {
        (self.share() * count as f64) as usize
    }

    fn chance(&mut self, share: f64) -> bool {
        self.share() < share
    }
}

fn plant(random: &mut Random) -> LinearPlant {
    let (sign, numerator, denominator): (_, Vec<f64>, Vec<f64>) = match random.one_of(5) {
        0 => (
            ElevatorSign::NoseDownPositive,
            vec![-1.69144, -0.84341, -0.0099096],
            vec![1.0, 1.17103, 1.55405, 0.012538, 0.0072771],
        ),
        1 => (ElevatorSign::NoseUpPositive, vec![1.151, 0.1774], vec![1.0, 0.739, 0.921, 0.0]),
        // A light aircraft, one without static stability, and two integrators.
        2 => (ElevatorSign::NoseDownPositive, vec![-11.2, -20.0], vec![1.0, 5.05, 13.2, 0.0]),
        3 => (ElevatorSign::NoseUpPositive, vec![2.0, 1.0], vec![1.0, 1.0, -0.3, 0.0]),
        _ => (ElevatorSign::NoseUpPositive, vec![1.0], vec![1.0, 0.0, 0.0]),
    };
    let factor = random.between(0.5, 2.0);
    let numerator: Vec<f64> = numerator.iter().map(|it| it * factor).collect();
    LinearPlant::new(&numerator, &denominator, sign).expect("allowed")
}

fn actuator(random: &mut Random) -> Actuator {
    let order = random.one_of(3);
    let lag = match order {
        0 => Lag::NONE,
        1 => Lag::first_order(random.between(0.03, 0.3)).expect("allowed"),
        _ => {
            Lag::second_order(random.between(8.0, 30.0), random.between(0.4, 1.2)).expect("allowed")
        }
    };
    let mut actuator = Actuator::new(lag).with_delay(random.one_of(4)).expect("allowed");
    if random.chance(0.7) {
        let least = -random.between(3.0, 20.0) * DEG;
        actuator =
            actuator.with_command_limits(least, random.between(3.0, 20.0) * DEG).expect("allowed");
    }
    if order < 2 && random.chance(0.4) {
        actuator = actuator.with_rate_limit(random.between(4.0, 60.0) * DEG).expect("allowed");
    }
    if order < 2 && random.chance(0.3) {
        let least = -random.between(2.0, 15.0) * DEG;
        actuator = actuator.with_travel(least, random.between(2.0, 15.0) * DEG).expect("allowed");
    }
    if random.chance(0.2) {
        actuator = actuator.with_deadband(random.between(0.0, 0.5) * DEG).expect("allowed");
    }
    if random.chance(0.2) {
        actuator = actuator.with_bias(random.between(-1.0, 1.0) * DEG).expect("allowed");
    }
    actuator
}

fn shape(random: &mut Random) -> Shape {
    // Many at once, before any command arrives.
    let at_s = if random.chance(0.3) { 0.0 } else { random.between(0.0, 3.0) };
    match random.one_of(5) {
        0 => Shape::Step { at_s },
        1 => Shape::Pulse { at_s, width_s: random.between(0.1, 2.0) },
        2 => Shape::Sine { at_s, frequency_hz: random.between(0.1, 2.0) },
        3 => Shape::Noise { at_s, seed: random.0 },
        _ => Shape::Ramp { at_s, width_s: random.between(0.1, 3.0) },
    }
}

fn scenario(random: &mut Random) -> Scenario {
    let timing = Timing::new(random.between(0.02, 0.1), 5.0).expect("allowed");
    let setpoint = match random.chance(0.8) {
        true => Profile::new(random.between(-6.0, 6.0) * DEG, shape(random)).expect("allowed"),
        false => Profile::new(0.0, Shape::Step { at_s: 0.0 }).expect("allowed"),
    };
    let plant = plant(random);
    let mut scenario = Scenario::new("attacked", plant, timing, setpoint);
    scenario.actuator = actuator(random);
    for entry in Entry::ALL {
        if random.chance(0.5) {
            let size = random.between(-2.0, 2.0) * DEG;
            scenario
                .disturbances
                .push(Disturbance::new(entry, size, shape(random)).expect("allowed"));
        }
    }
    for index in 0..4 {
        let mut gain = |most: f64| if random.chance(0.8) { random.between(0.0, most) } else { 0.0 };
        let gains = Gains { kp: gain(4.0), ki: gain(2.0), kd: gain(1.0) };
        let pid = Pid::new(gains, PidConfig::sampled_every(timing.dt_s())).expect("allowed");
        scenario = scenario.with_controller(&format!("PID {index}"), Controller::Fixed(pid));
    }
    scenario
}

/// True of a flight whose commands are as still as it is taken for, until something happens.
fn keeps_still(trace: &Trace, still: Option<Still>) -> bool {
    still.is_none_or(|it| trace.command_rad.iter().take(it.until).all(|u| u.abs() <= it.within_rad))
}

fn is_noisy(scenario: &Scenario) -> bool {
    scenario.disturbances.iter().any(|it| it.is_noise() && it.entry() == Entry::Measurement)
}

/// How often something was compared, and how near the nearest came.
#[derive(Default, Debug)]
struct Told {
    compared: usize,
    refused: usize,
    none: usize,
    /// Limits of which nothing was flown within the travel.
    beyond: usize,
    nearest: f64,
}

fn attack(seed: u64, scenarios: usize) -> Told {
    let mut random = Random(seed);
    let mut told = Told { nearest: f64::INFINITY, ..Told::default() };
    for number in 0..scenarios {
        let scenario = scenario(&mut random);
        let measure = Measure::ALL[random.one_of(3)];
        let travel = Travel::ALL[random.one_of(3)];
        let flight = simulate(&scenario).expect("allowed");
        let flown = flight.traces.iter().flat_map(|it| &it.command_rad);
        let within = flown.fold(0.0, |most: f64, u| most.max(u.abs()));
        // Half of them against who keeps as still as these controllers do until something happens.
        // The last two are nobody's that the question knows; before anything happens they do nothing, or answer noise.
        let known = &flight.traces[..2];
        let commands = known.iter().map(|it| it.command_rad.as_slice());
        let still = Still::of(&scenario, commands).filter(|_| random.chance(0.5));
        let assumed = Assumed { within_rad: within.max(0.5), still };
        let question = match Question::of(&scenario, travel, assumed) {
            Ok(question) => question,
            Err(LimitError::Refused(_)) => {
                told.refused += 1;
                continue;
            }
            Err(other) => panic!("{number}: {other} {scenario:#?}"),
        };
        let flown = flight.traces.iter().filter(|it| it.outcome == Outcome::Completed);
        for trace in flown.filter(|it| keeps_still(it, still) || !is_noisy(&scenario)) {
            let (found, way) = measured(
                (measure, travel),
                (&trace.setpoint_rad, &trace.theta_rad),
                (&trace.command_rad, &trace.elevator_rad),
                scenario.timing.dt_s(),
            );
            check(&scenario, &question, (measure, travel), (found, way), &mut told, number);
        }
        // Histories near the best one, each at its own travel.
        let way = random.between(2.0, 30.0) * DEG;
        let Ok(best) = limit(&scenario, &question, (measure, travel), way, || false) else {
            told.none += 1;
            continue;
        };
        let Some(reached) = best.reached else {
            told.beyond += 1;
            continue;
        };
        let flown = fly_commands(&scenario, &reached.command_rad, (measure, travel));
        assert_eq!(flown.as_ref(), Ok(&reached), "{number}: {scenario:#?}");
        assert!(reached.measure >= best.proved * (1.0 - 1e-5), "{number}: {scenario:#?}");
        assert!(reached.travel_rad <= way * (1.0 + 1e-6), "{number}: {way} {scenario:#?}");
        for _ in 0..3 {
            let mut commands = reached.command_rad.clone();
            let size = random.between(0.0, 0.5) * DEG;
            let until = still.map_or(0, |still| still.until);
            let later = commands.iter_mut().skip(until);
            later.for_each(|u| *u += size * random.between(-1.0, 1.0));
            let asked = (measure, travel);
            let Ok(flown) = fly_commands(&scenario, &commands, asked) else { continue };
            let found = (flown.measure, flown.travel_rad);
            check(&scenario, &question, asked, found, &mut told, number);
        }
    }
    told
}

fn check(
    scenario: &Scenario,
    question: &Question,
    asked: (Measure, Travel),
    (found, way): (f64, f64),
    told: &mut Told,
    number: usize,
) {
    // What is flown is rounded; the bound is of exact numbers.
    let way = way * (1.0 + 1e-9) + 1e-12;
    let limit = match limit(scenario, question, asked, way, || false) {
        Ok(limit) => limit,
        Err(LimitError::Solver { .. }) => {
            told.none += 1;
            return;
        }
        Err(other) => panic!("{number} {asked:?} {way}: {other} {scenario:#?}"),
    };
    told.compared += 1;
    assert!(
        limit.proved <= found * (1.0 + 1e-9) + 1e-12,
        "{number} {asked:?} within {way}: {found} is below {} {scenario:#?}",
        limit.proved
    );
    if found > 1e-6 {
        told.nearest = told.nearest.min(found / limit.proved);
    }
}

#[test]
fn nobody_who_flies_gets_below_what_is_proved() {
    let told = attack(0x9e37_79b9_7f4a_7c15, 40);
    // The attack is worth something only where somebody comes near.
    assert!(told.compared > 150 && told.nearest < 1.001, "{told:?}");
}

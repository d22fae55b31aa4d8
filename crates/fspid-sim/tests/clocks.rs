//! Loops whose sensors have clocks of their own: what is told of them at rest is how they fly.

use fspid_core::{Gains, Pid, PidConfig};
use fspid_sim::sensor::{PITCH, RATE, Sensor, SensorModel};
use fspid_sim::signal::{Disturbance, Entry, Profile, Shape};
use fspid_sim::stability::growth_at_rest;
use fspid_sim::{
    Actuator, Controller, Doubt, ElevatorSign, LinearPlant, NamedController, Scenario,
    Surroundings, Timing, simulate,
};

use crate::batch::Random;

const DT_S: f64 = 0.02;

/// A body with a mode that bends.
#[derive(Clone, Copy, Debug)]
struct Drawn {
    body: [f64; 2],
    bends: [f64; 3],
    gains: [f64; 4],
    pitch: [f64; 2],
    rate: Option<[f64; 2]>,
}

fn sensor([period_s, delay_s]: [f64; 2], channel: u32) -> Sensor {
    let model = SensorModel { period_s, delay_s, ..SensorModel::default() };
    Sensor::new(model, 1, channel).expect("allowed")
}

fn scenario(drawn: &Drawn, duration_s: f64) -> Scenario {
    let ([w0, z0], [w, z, c]) = (drawn.body, drawn.bends);
    let (own, other) = ([1.0, 2.0 * z0 * w0, w0 * w0], [1.0, 2.0 * z * w, w * w]);
    let (by_own, by_other) = (w0 * w0, c * w * w);
    let numerator: Vec<f64> = (0..3).map(|k| by_own * other[k] + by_other * own[k]).collect();
    let mut denominator = [0.0; 5];
    for (k, one) in own.iter().enumerate() {
        other.iter().enumerate().for_each(|(j, it)| denominator[k + j] += one * it);
    }
    let plant = LinearPlant::new(&numerator, &denominator, ElevatorSign::NoseUpPositive);
    let [kp, ki, kd, rate_gain_s] = drawn.gains;
    let config = PidConfig { rate_gain_s, ..PidConfig::sampled_every(DT_S) };
    let controller = Controller::Fixed(Pid::new(Gains { kp, ki, kd }, config).expect("allowed"));
    let push = Shape::Pulse { at_s: 0.5, width_s: 0.1 };
    Scenario {
        name: "clocks".into(),
        plant: plant.expect("proper").into(),
        plant_changes: Vec::new(),
        actuator: Actuator::first_order(0.02).expect("allowed"),
        timing: Timing::new(DT_S, duration_s).expect("allowed"),
        setpoint: Profile::new(0.0, Shape::Step { at_s: 0.0 }).expect("allowed"),
        disturbances: vec![Disturbance::new(Entry::Elevator, 1e-90, push).expect("allowed")],
        controllers: vec![NamedController { name: "PID".into(), controller }],
        externals: Vec::new(),
        surroundings: Surroundings {
            pitch_sensor: Some(sensor(drawn.pitch, PITCH)),
            rate_sensor: drawn.rate.map(|it| sensor(it, RATE)),
            ..Surroundings::default()
        },
        autopilot: None,
    }
}

/// Spectral radius where it certainly grows, and the doubt.
fn told(drawn: &Drawn) -> (Option<f64>, Option<Doubt>) {
    let scenario = scenario(drawn, 1.0);
    let controller = &scenario.controllers[0].controller;
    let found = growth_at_rest(&scenario, controller, controller.nominal()).expect("asked");
    (found.certain.map(|it| it.spectral_radius), found.undecided.map(|it| it.doubt))
}

/// Growth a sample over the second half of a flight of so many samples, as a logarithm.
fn flown(drawn: &Drawn, samples: f64) -> f64 {
    let scenario = scenario(drawn, 1.0 + samples * DT_S);
    let theta_rad = simulate(&scenario).expect("flown").traces.remove(0).theta_rad;
    let quarter = theta_rad.len() / 4;
    let largest = |from: usize| {
        theta_rad.iter().skip(from).take(quarter).fold(0.0, |most: f64, it| most.max(it.abs()))
    };
    libm::log(largest(3 * quarter) / largest(2 * quarter)) / quarter as f64
}

fn draw(random: &mut Random) -> Drawn {
    let period = random.between(2.0, 8.0).floor();
    let mut one_of = |values: [f64; 4]| values[(random.bits() % 4) as usize];
    let (beyond, delay_s) = (one_of([0.0, 0.5, 0.25, 0.4]), one_of([0.0, 0.0, 0.013, 0.05]));
    let period_s = (period + beyond) * DT_S;
    let ten = |low: f64, high: f64, random: &mut Random| libm::exp10(random.between(low, high));
    Drawn {
        body: [random.between(0.5, 3.0), random.between(0.2, 0.8)],
        bends: [
            std::f64::consts::TAU / period_s * random.between(0.3, 1.2),
            ten(-2.5, -1.0, random),
            random.between(-0.5, 0.5),
        ],
        gains: [
            ten(-1.0, 0.7, random),
            ten(-1.5, 0.5, random),
            ten(-2.0, 0.3, random),
            if random.one_in(2) { ten(-2.0, 0.0, random) } else { 0.0 },
        ],
        pitch: [period_s, delay_s],
        rate: random.one_in(2).then(|| [random.between(1.0, 4.0).floor() * DT_S, 0.01]),
    }
}

/// The same as if the pitch sensor's values stayed as old as they ever get, and as they are at best.
fn at_each_age(drawn: &Drawn) -> [Drawn; 2] {
    let [period_s, delay_s] = drawn.pitch;
    let oldest_s = (delay_s / DT_S).ceil() * DT_S + period_s - DT_S;
    [oldest_s, 0.0].map(|delay_s| Drawn { pitch: [0.0, delay_s], ..*drawn })
}

#[test]
fn a_loop_that_sees_by_a_clock_of_its_own_flies_as_it_is_told_at_rest() {
    let mut random = Random(20_261_129);
    let (mut holds, mut grows, mut folded, mut saved) = (0, 0, 0, 0);
    for number in 0..2000 {
        let drawn = draw(&mut random);
        let found = told(&drawn);
        let held = at_each_age(&drawn).map(|it| told(&it) == (None, None));
        folded += usize::from(found.0.is_some() && held == [true; 2]);
        match found {
            (Some(radius), _) if radius > 1.003 && radius < 1.05 => {
                grows += 1;
                // It ends before it is lost.
                let told = libm::log(radius);
                let flown = flown(&drawn, 200.0 / told);
                assert!((flown / told - 1.0).abs() < 0.05, "{number} {drawn:?} {told} {flown}");
            }
            (None, None) => {
                holds += 1;
                saved += usize::from(held != [true; 2]);
                let flown = flown(&drawn, 6000.0);
                assert!(flown < 0.0 || flown.is_nan(), "{number} {drawn:?} {flown}");
            }
            _ => {}
        }
        assert_ne!(found.1, Some(Doubt::ChangingAge), "{number} {drawn:?}");
    }
    // It is worth something only where it differs from ages that stand still.
    let counted = [holds, grows, folded, saved];
    assert!(holds > 100 && grows > 100 && folded > 1 && saved > 20, "{counted:?}");
}

/// Periods of a number of samples that no short time makes whole.
#[test]
fn a_loop_whose_ages_hardly_come_again_is_told_only_where_it_flies_so() {
    let mut random = Random(20_261_130);
    let (mut holds, mut undecided, mut grows) = (0, 0, 0);
    for number in 0..200 {
        let mut drawn = draw(&mut random);
        drawn.pitch[0] += DT_S * random.between(0.01, 0.99);
        match told(&drawn) {
            (None, None) => {
                holds += 1;
                let flown = flown(&drawn, 6000.0);
                assert!(flown < 0.0 || flown.is_nan(), "{number} {drawn:?} {flown}");
            }
            (None, Some(_)) => undecided += 1,
            (Some(radius), _) if radius > 1.003 && radius < 1.05 => {
                grows += 1;
                let flown = flown(&drawn, 200.0 / libm::log(radius));
                assert!(flown > 0.0, "{number} {drawn:?} {radius} {flown}");
            }
            _ => {}
        }
    }
    let counted = [holds, undecided, grows];
    assert!(holds > 8 && grows > 15 && undecided > 2, "{counted:?}");
}

#[test]
fn a_sensor_that_looks_every_three_seconds_is_asked_over_all_its_ages() {
    let drawn = |ki: f64| Drawn {
        body: [1.0, 0.7],
        bends: [50.0, 0.1, 0.0],
        gains: [0.2, ki, 0.0, 0.0],
        pitch: [3.0, 0.0],
        rate: None,
    };
    assert_eq!(told(&drawn(0.1)), (None, None));
    assert!(flown(&drawn(0.1), 6000.0) < 0.0);
    let radius = told(&drawn(1.0)).0.expect("it grows");
    let growth = flown(&drawn(1.0), 200.0 / libm::log(radius)) / libm::log(radius);
    assert!((growth - 1.0).abs() < 0.02, "{radius} {growth}");
}

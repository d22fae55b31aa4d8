//! The same of loops with late sensors and every anti-windup at tight limits, in wide sets too.

use fspid_core::{AntiWindup, ControllerSetting, Fspid, Limits, Pid, PidConfig};
use fspid_sim::sensor::{PITCH, RATE, Sensor, SensorModel};

use super::*;

const DEG: f64 = core::f64::consts::PI / 180.0;

/// A sensor that is late by whole samples.
fn late(dice: &mut drawn::Dice, dt_s: f64, channel: u32) -> Option<Sensor> {
    let samples = (dice.part() * 4.0).floor();
    let model = SensorModel { delay_s: samples * dt_s, ..SensorModel::default() };
    (samples > 0.0).then(|| Sensor::new(model, 1, channel).expect("allowed"))
}

/// Limits that a step meets, and what becomes of the integral there.
fn tight(dice: &mut drawn::Dice, seed: u64, config: PidConfig<f64>) -> PidConfig<f64> {
    let around = |most: f64| {
        Limits::new(ControllerSetting::OutputLimits, -most * DEG, most * DEG).expect("allowed")
    };
    let anti_windup = match seed % 4 {
        0 => AntiWindup::Conditional,
        1 => AntiWindup::BackCalculation { tracking_s: dice.between(0.2, 2.0) },
        2 => AntiWindup::Clamping(around(dice.between(1.0, 6.0))),
        _ => AntiWindup::None,
    };
    PidConfig {
        anti_windup,
        limits: Some(around(dice.between(4.0, 15.0))),
        slew_rad_s: seed.is_multiple_of(5).then(|| dice.between(20.0, 80.0) * DEG),
        rate_gain_s: dice.between(0.05, 0.4),
        ..config
    }
}

fn structured(seed: u64) -> Scenario {
    let dice = &mut drawn::Dice::new(seed);
    let mut scenario = match seed % 3 {
        0 => drawn::scenario(dice),
        _ => drawn::with_limits(dice),
    };
    // A servo whose limits are covered.
    scenario.actuator = drawn::with_limits(dice).actuator;
    scenario.name = format!("seed {seed}");
    let dt_s = scenario.timing.dt_s();
    scenario.surroundings.pitch_sensor = late(dice, dt_s, PITCH);
    scenario.surroundings.rate_sensor = late(dice, dt_s, RATE);
    let controller = &mut scenario.controllers[0].controller;
    let config = tight(dice, seed, *controller.config());
    *controller = match controller {
        Controller::Fixed(pid) => {
            Controller::Fixed(Pid::new(pid.gains(), config).expect("allowed"))
        }
        Controller::SelfTuning(fspid) => {
            Controller::SelfTuning(Fspid::new(*fspid.tuner(), config).expect("allowed"))
        }
    };
    scenario
}

#[test]
fn a_set_of_flights_holds_every_flight_through_late_sensors_and_any_anti_windup() {
    let (mut compared, mut limited, mut late, mut tuned) = (0, 0, 0, 0);
    for seed in 0..150 {
        let scenario = structured(seed);
        let plant = scenario.plant.linear().expect("linear");
        let controller = &scenario.controllers[0].controller;
        let Ok(description) = LoopDescription::of(&scenario, plant, controller) else { continue };
        if not_covered(&description).is_some() {
            continue;
        }
        let Ok(model) = description.enclosed() else { continue };
        let set = all_gains(controller);
        let rules = system(&description);
        let loop_ = flown::flown(&description, &model, &set, rules.as_ref()).expect("enclosed");
        let most = 0.02 + 0.04 * (seed % 7) as f64;
        for lower in [0.999, 0.8, -1.0] {
            let patch = Patch { setpoint: [lower * most, most], load: [-0.01, -0.0099] };
            let (samples, ended) = held(&loop_, &scenario, patch, (Beginning::Controller, 0));
            compared += samples;
            limited += usize::from(ended.limited);
            late += usize::from(loop_.layout.pitch > 1) + usize::from(loop_.layout.rate > 1);
            tuned += usize::from(matches!(controller, Controller::SelfTuning(_)));
        }
    }
    let counts = [compared, limited, late, tuned];
    assert!(compared > 3000 && limited > 15 && late > 15 && tuned > 15, "{counts:?}");
}

use super::*;
use proptest::prelude::*;

const DEG: f64 = std::f64::consts::PI / 180.0;

fn first(time_constant_s: f64) -> Actuator {
    Actuator::new(Lag::first_order(time_constant_s).expect("allowed"))
}

fn second(natural_frequency_rad_s: f64, damping: f64) -> Actuator {
    Actuator::new(Lag::second_order(natural_frequency_rad_s, damping).expect("allowed"))
}

/// Deflections at each of `samples` periods under a command of time.
fn flown(actuator: &Actuator, dt_s: f64, samples: usize, command: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut state = ActuatorState::default();
    let mut deflections = vec![actuator.deflection_rad(&state)];
    for k in 0..samples {
        actuator.advance(&mut state, command(k as f64 * dt_s), dt_s);
        deflections.push(actuator.deflection_rad(&state));
    }
    deflections
}

#[test]
fn every_preset_is_allowed_and_found_by_its_name() {
    for preset in Preset::ALL {
        assert!(preset.actuator().is_ok(), "{}", preset.name);
        assert_eq!(Preset::from_name(preset.name), Some(preset));
        assert!(!preset.source.is_empty());
    }
    assert_eq!(Preset::from_name("servo"), None);
}

/// Handbook oracle: 0.0951626 at 10 ms, 0.1812692 at 20 ms.
#[test]
fn the_actuator_of_the_paper_covers_its_share_in_one_sample() {
    let actuator = Preset::from_name("paper").expect("there is one").actuator().expect("allowed");
    for (dt_s, expected) in [(0.01, 0.095_162_6), (0.02, 0.181_269_2)] {
        let deflection = flown(&actuator, dt_s, 1, |_| 1.0)[1];
        assert!((deflection - expected).abs() < 5.1e-8, "{deflection}");
    }
}

#[test]
fn commands_pass_their_limits_before_the_deadband() {
    let actuator = Actuator::new(Lag::NONE)
        .with_command_limits(-2.0, 1.0)
        .and_then(|actuator| actuator.with_deadband(0.25))
        .expect("allowed");
    let targets = [-9.0, -2.0, -0.25, 0.1, 0.5, 1.0, 7.0].map(|c| actuator.target_rad(c));
    assert_eq!(targets, [-1.75, -1.75, 0.0, 0.0, 0.25, 0.75, 0.75]);
}

/// At one sample a second it takes more than 64 legs, after which it was held: 8.6 deg of 3.9.
#[test]
fn a_lag_that_swings_between_stops_is_followed_through_a_long_sample() {
    let actuator = second(99.0, 0.001)
        .with_travel(-DEG, 9.5 * DEG)
        .and_then(|actuator| actuator.with_rate_limit(480.0 * DEG))
        .and_then(|actuator| actuator.with_play(DEG))
        .expect("allowed");
    let [whole, parts] = [1, 100].map(|samples| {
        let deflections = flown(&actuator, 1.0 / samples as f64, samples, |_| 5.0 * DEG);
        deflections.last().copied().expect("one") / DEG
    });
    assert!((whole - parts).abs() < 1e-6, "{whole} {parts}");
}

#[test]
fn an_ideal_actuator_is_where_it_is_commanded_within_its_travel() {
    let actuator = Actuator::new(Lag::NONE).with_travel(-1.0, 2.0).expect("allowed");
    let commands = [0.5, 3.0, -3.0];
    let deflections = flown(&actuator, 1.0, 3, |t| commands[t as usize]);
    assert_eq!(deflections, [0.0, 0.5, 2.0, -1.0]);
}

/// A ramp at R while the gap exceeds R τ, then the lag: both in closed form.
#[test]
fn a_rate_limited_first_order_step_is_a_ramp_and_then_an_exponential() {
    let actuator = first(0.1).with_rate_limit(2.0).expect("allowed");
    for (k, deflection) in flown(&actuator, 0.03, 40, |_| 1.0).into_iter().enumerate() {
        let time_s = 0.03 * k as f64;
        let expected = if time_s < 0.4 {
            2.0 * time_s
        } else {
            1.0 - 0.2 * crate::math::exp(-(time_s - 0.4) / 0.1)
        };
        assert!((deflection - expected).abs() < 1e-12, "{time_s} {deflection} {expected}");
    }
}

/// Towards 2 the lag passes 1 after τ ln 2 and stays; back towards 0 it leaves at once.
#[test]
fn a_stop_is_met_at_its_instant_and_left_at_once() {
    let actuator = first(0.1).with_travel(-1.0, 1.0).expect("allowed");
    let mut state = ActuatorState::default();
    let mut legs = Vec::new();
    actuator.legs(&mut state, 2.0, 0.5, |leg| legs.push(leg));
    assert_eq!(legs.len(), 2);
    assert!((legs[0].duration_s - 0.1 * std::f64::consts::LN_2).abs() < 1e-15, "{legs:?}");
    assert_eq!(legs[1].course, Course::Ramp { rate_rad_s: 0.0 });
    assert_eq!(actuator.deflection_rad(&state), 1.0);
    actuator.advance(&mut state, 0.0, 0.1);
    assert!((actuator.deflection_rad(&state) - crate::math::exp(-1.0)).abs() < 1e-14);
}

#[test]
fn the_surface_waits_while_the_actuator_crosses_its_play() {
    let actuator = Actuator::new(Lag::NONE)
        .with_rate_limit(1.0)
        .and_then(|actuator| actuator.with_play(0.2))
        .expect("allowed");
    let up = flown(&actuator, 0.25, 4, |_| 1.0);
    let expected = [0.0, 0.15, 0.4, 0.65, 0.9];
    assert!(up.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{up:?}");
    let back = flown(&actuator, 0.25, 5, |t| if t < 1.0 { 1.0 } else { 0.0 });
    assert!((back[5] - 0.85).abs() < 1e-12, "{back:?}");
}

#[test]
fn a_small_sine_within_the_play_does_not_reach_the_surface() {
    let actuator = Preset::from_name("c172-jsbsim").expect("there").actuator().expect("allowed");
    let deflections = flown(&actuator, 0.01, 500, |t| 0.024 * libm::sin(5.0 * t));
    assert!(deflections.iter().all(|&deflection| deflection == 0.002));
}

/// The equations of the module in steps of a microsecond.
fn stepped(actuator: &Actuator, commands: &[f64], dt_s: f64, [wn, damping]: [f64; 2]) -> Vec<f64> {
    let (steps, half) = (20_000, 0.5 * actuator.play_rad);
    let limit = actuator.rate_limit_rad_s.unwrap_or(f64::INFINITY);
    let (least, most) = actuator.travel_rad.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    let (mut x, mut rate, mut y) = (0.0_f64, 0.0_f64, 0.0_f64);
    let mut deflections = vec![actuator.bias_rad];
    for &command in commands {
        let target = actuator.target_rad(command);
        for _ in 0..steps {
            let h = dt_s / f64::from(steps);
            rate += h * (wn * wn * (target - x) - 2.0 * damping * wn * rate);
            rate = rate.clamp(-limit, limit);
            let next = x + h * rate;
            x = next.clamp(least, most);
            if (next - x).abs() > 0.0 {
                rate = 0.0;
            }
            y = y.clamp(x - half, x + half);
        }
        deflections.push(y + actuator.bias_rad);
    }
    deflections
}

#[test]
fn a_second_order_actuator_with_every_limit_agrees_with_tiny_steps_of_its_equations() {
    let actuator = second(35.0, 0.5)
        .with_rate_limit(4.0)
        .and_then(|actuator| actuator.with_travel(-0.3, 0.45))
        .and_then(|actuator| actuator.with_play(0.05))
        .and_then(|actuator| actuator.with_deadband(0.02))
        .and_then(|actuator| actuator.with_bias(0.01))
        .expect("allowed");
    let commands: Vec<f64> = (0..60).map(|k| 0.6 * libm::sin(0.23 * f64::from(k))).collect();
    let exact = flown(&actuator, 0.02, 60, |t| commands[(t / 0.02).round() as usize]);
    let stepped = stepped(&actuator, &commands, 0.02, [35.0, 0.5]);
    for (k, (a, b)) in exact.iter().zip(&stepped).enumerate() {
        assert!((a - b).abs() < 2e-4, "{k}: {a} {b}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn a_held_command_gives_the_same_motion_in_one_sample_or_in_ten(
        order in 1_usize..=2, wn in 5.0_f64..60.0, damping in 0.2_f64..2.0,
        limit in 0.5_f64..20.0, most in 0.1_f64..1.0, play in 0.0_f64..0.2, command in -1.5_f64..1.5,
    ) {
        let lag = if order == 1 { first(1.0 / wn) } else { second(wn, damping) };
        let actuator = lag
            .with_rate_limit(limit)
            .and_then(|actuator| actuator.with_travel(-most, most))
            .and_then(|actuator| actuator.with_play(play))
            .expect("allowed");
        let (mut once, mut often) = (ActuatorState::default(), ActuatorState::default());
        for sample in 0..10 {
            let command = if sample % 4 < 2 { command } else { -0.7 * command };
            actuator.advance(&mut once, command, 0.05);
            for _ in 0..10 {
                actuator.advance(&mut often, command, 0.005);
            }
            let apart = actuator.deflection_rad(&once) - actuator.deflection_rad(&often);
            // Second order: events within a piece of another length may be seen here, missed there.
            prop_assert!(apart.abs() < if order == 1 { 1e-9 } else { 2e-3 }, "{apart}");
        }
    }

    #[test]
    fn rate_and_travel_hold_whatever_is_commanded(
        order in 0_usize..=2, limit in 0.1_f64..5.0, least in -1.0_f64..-0.1, most in 0.1_f64..1.0,
        play in 0.0_f64..0.1, commands in prop::collection::vec(-3.0_f64..3.0, 30),
    ) {
        let lag = match order {
            0 => Actuator::new(Lag::NONE),
            1 => first(0.05),
            _ => second(30.0, 0.6),
        };
        let actuator = lag
            .with_rate_limit(limit)
            .and_then(|actuator| actuator.with_travel(least, most))
            .and_then(|actuator| actuator.with_play(play))
            .expect("allowed");
        let mut state = ActuatorState::default();
        let mut before_rad = 0.0;
        for command in commands {
            let mut total_s = 0.0;
            actuator.legs(&mut state, command, 0.02, |leg| total_s += leg.duration_s);
            prop_assert!((total_s - 0.02).abs() < 1e-15);
            let now_rad = actuator.deflection_rad(&state);
            prop_assert!((least..=most).contains(&now_rad), "{now_rad}");
            prop_assert!((now_rad - before_rad).abs() <= limit * 0.02 * (1.0 + 1e-8));
            before_rad = now_rad;
        }
    }
}

#[test]
fn a_sine_asks_for_more_than_the_rate_limit_from_its_onset_frequency_on() {
    let actuator = first(0.1).with_rate_limit(30.0 * DEG).expect("allowed");
    let onset = actuator.rate_onset_rad_s(5.0 * DEG).expect("there is a limit");
    assert!((onset - 6.0).abs() < 1e-12);
    assert!(!actuator.sine_saturates_rate(5.0 * DEG, 5.99));
    assert!(actuator.sine_saturates_rate(-5.0 * DEG, 6.01));
    assert_eq!((actuator.rate_onset_rad_s(0.0), first(0.1).rate_onset_rad_s(1.0)), (None, None));
}

#[test]
fn numbers_out_of_range_are_refused() {
    let actuator = first(0.1);
    for (least, most) in [(0.1, 1.0), (-1.0, -0.1), (0.0, 0.0), (f64::NAN, 1.0)] {
        assert!(actuator.with_travel(least, most).is_err());
        assert!(actuator.with_command_limits(least, most).is_err());
    }
    assert!(actuator.with_deadband(-0.1).is_err() && actuator.with_play(f64::NAN).is_err());
    assert!(actuator.with_rate_limit(0.0).is_err() && actuator.with_delay(10_001).is_err());
    assert!(actuator.is_linear() && !actuator.with_play(0.1).expect("allowed").is_linear());
}

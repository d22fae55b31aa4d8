//! What is told of pieces of which every sample is known.

use fspid_core::{ControllerSetting, Gains, Limits, Pid, PidConfig};

use super::*;
use crate::closed_loop::simulate;
use crate::plant::{ElevatorSign, LinearPlant};
use crate::scenario::NamedController;
use crate::signal::{Profile, Shape};
use crate::timing::Timing;
use crate::trace::EarlyEnd;

/// Where the command of the tests' controller ends, rad.
const MOST_RAD: f64 = 1.0;
/// Samples of a period of what swings here; it is a piece.
const PERIOD: usize = 20;
const BACK: EarlyEnd = EarlyEnd { at_s: 1.0, cause: EndCause::Diverged };
const GROUND: EarlyEnd = EarlyEnd { at_s: 1.0, cause: EndCause::HitGround };

/// A double integrator that a PID with limits of its command holds, for ten pieces.
fn scenario() -> (Scenario, Controller) {
    let plant = LinearPlant::new(&[1.0], &[1.0, 1.0, 0.0], ElevatorSign::NoseUpPositive);
    let timing = Timing::new(0.01, 2.0).expect("allowed");
    let step = Profile::new(0.1, Shape::Step { at_s: 0.0 }).expect("allowed");
    let limits = Limits::new(ControllerSetting::OutputLimits, -MOST_RAD, MOST_RAD);
    let config =
        PidConfig { limits: Some(limits.expect("allowed")), ..PidConfig::sampled_every(0.01) };
    let gains = Gains { kp: 2.0, ki: 0.0, kd: 1.0 };
    let pid = Pid::new(gains, config).expect("allowed");
    (Scenario::new("pieces", plant.expect("proper"), timing, step), Controller::Fixed(pid))
}

fn shown(moving_rad: f64, command_rad: f64) -> Shown {
    let (at_servo_rad, elevator_rad, autopilot_is_limited) = (0.0, 0.0, false);
    Shown {
        moving_rad,
        command_rad,
        at_servo_rad,
        elevator_rad,
        autopilot_is_limited,
        gains: Gains::ZERO,
        outer: Outer::default(),
    }
}

/// A swing of the error and of the command, each of a size in rad for each of ten periods.
fn swinging<'a>(ends: &'a Ends, scenario: &Scenario, sizes_rad: [[f64; 2]; 10]) -> Pieces<'a> {
    let mut pieces = Pieces::new(scenario, ends, PERIOD);
    for [error_rad, command_rad] in sizes_rad {
        for k in 0..PERIOD {
            let side = if k < PERIOD / 2 { 1.0 } else { -1.0 };
            pieces.push(shown(side * error_rad, side * command_rad));
        }
    }
    pieces
}

/// The sizes of ten periods whose error changes by a factor with each, with a command of one size.
fn changing(factor: f64, command_rad: f64) -> [[f64; 2]; 10] {
    let mut error_rad = 0.1 / factor;
    std::array::from_fn(|_| {
        error_rad *= factor;
        [error_rad, command_rad]
    })
}

#[test]
fn an_aircraft_is_lost_on_its_back_at_limits_or_at_the_ground_out_of_a_swing_of_its_own() {
    let (scenario, controller) = scenario();
    let ends = Ends::of(&scenario, &controller);
    let at_limits = swinging(&ends, &scenario, changing(1.0, MOST_RAD));
    let within = swinging(&ends, &scenario, changing(1.0, 0.5 * MOST_RAD));
    let early = Outcome::EndedEarly;
    for (outcome, swings_itself, pieces, wanted) in [
        (early(BACK), false, &at_limits, true),
        (early(BACK), false, &within, false),
        (early(GROUND), false, &at_limits, false),
        (early(GROUND), true, &within, true),
        (Outcome::Completed, true, &at_limits, false),
        (Outcome::ModeNeverBegan { mode: 0 }, true, &at_limits, false),
    ] {
        assert_eq!(is_lost(outcome, swings_itself, pieces), wanted, "{outcome:?} {swings_itself}");
    }
}

#[test]
fn a_swing_of_an_aircraft_goes_on_where_it_is_at_limits_and_does_not_shrink_by_a_tenth_in_a_fifth()
{
    let (scenario, controller) = scenario();
    let ends = Ends::of(&scenario, &controller);
    let swings_on = |factor: f64, command_rad: f64, moved: Moved| {
        swinging(&ends, &scenario, changing(factor, command_rad)).swings_on(moved, Moves::On)
    };
    // From one fifth to the next there are two periods, and from the first two to the last two six.
    for (factor, moved, wanted) in [
        (1.0, Moved::Nothing, true),
        (0.96, Moved::Nothing, true),
        (0.94, Moved::Nothing, false),
        (1.12, Moved::ByNoise, false),
        (1.13, Moved::ByNoise, true),
    ] {
        assert_eq!(swings_on(factor, MOST_RAD, moved), wanted, "{factor} {moved:?}");
        assert!(!swings_on(factor, 0.5 * MOST_RAD, moved), "{factor} {moved:?}: no limit is met");
    }
}

#[test]
fn what_has_come_to_rest_stands_within_limits_in_error_and_command() {
    let (scenario, controller) = scenario();
    let ends = Ends::of(&scenario, &controller);
    // Eight periods of a swing, and two of what is left.
    let rests = |left: [f64; 2]| {
        let mut sizes_rad = [[0.1, 0.1]; 10];
        sizes_rad[8..].fill(left);
        swinging(&ends, &scenario, sizes_rad).rests()
    };
    assert!(rests([0.9e-4, 0.9e-4]));
    assert!(!rests([1.1e-4, 0.9e-4]) && !rests([0.9e-4, 1.1e-4]));
    assert!(!rests([0.9e-4, MOST_RAD]));
}

#[test]
fn limits_of_a_last_quarter_alone_are_no_swing_at_limits() {
    let (scenario, controller) = scenario();
    let ends = Ends::of(&scenario, &controller);
    let mut sizes_rad = changing(1.0, MOST_RAD);
    let goes_on =
        |sizes_rad| swinging(&ends, &scenario, sizes_rad).swings_on(Moved::Nothing, Moves::On);
    assert!(goes_on(sizes_rad));
    // In the fourth fifth it is within them.
    sizes_rad[6..8].fill([0.1, 0.5 * MOST_RAD]);
    assert!(!goes_on(sizes_rad));
}

#[test]
fn a_flight_is_flown_on_ten_times_as_long_within_ends_in_pieces_of_a_fifth_of_it_or_a_fiftieth_of_the_way()
 {
    assert_eq!(lengths(201), [10_000, 200]);
    assert_eq!(lengths(1_001), [10_010, 200]);
    assert_eq!(lengths(5_000), [50_000, 1_000]);
    assert_eq!(lengths(20_000), [100_000, 4_000]);
}

/// A disturbance at the servo of a tenth of the limit.
fn with(shape: Shape) -> Scenario {
    let disturbance = Disturbance::new(Entry::Servo, 0.1, shape).expect("allowed");
    Scenario { disturbances: vec![disturbance], ..scenario().0 }
}

#[test]
fn a_flight_has_shown_what_swings_in_it_for_two_periods() {
    let sine = |at_s: f64, frequency_hz: f64| Shape::Sine { at_s, frequency_hz };
    let shows = |shape: Shape| has_shown_its_swings(&with(shape));
    assert!(has_shown_its_swings(&scenario().0));
    assert!(shows(sine(0.0, 1.0)) && !shows(sine(0.0, 0.99)) && !shows(sine(0.01, 1.0)));
    assert!(shows(sine(1.5, 4.0)) && !shows(sine(1.5, 3.9)));
    assert!(!shows(sine(2.0, 0.1)) && shows(sine(2.01, 0.1)), "it begins after the flight");
    let commanded = Profile::new(0.1, sine(0.0, 0.99)).expect("allowed");
    assert!(!has_shown_its_swings(&Scenario { setpoint: commanded, ..scenario().0 }));
}

/// Whether a flight has come to rest whose last four periods of ten are of a size; before them it moves by 0.1 rad.
fn comes_to_rest(scenario: &Scenario, before_rad: f64, [error_rad, command_rad]: [f64; 2]) -> bool {
    let ends = Ends::of(scenario, &self::scenario().1);
    let mut sizes_rad = [[0.1, before_rad]; 10];
    sizes_rad[6..].fill([error_rad, command_rad]);
    has_come_to_rest(scenario, &swinging(&ends, scenario, sizes_rad), None, &trace_of(scenario))
}

/// The trace of the tests' controller.
fn trace_of(scenario: &Scenario) -> Trace {
    let controllers = vec![NamedController { name: "C".into(), controller: self::scenario().1 }];
    simulate(&Scenario { controllers, ..scenario.clone() }).expect("flies").traces.remove(0)
}

#[test]
fn what_nothing_moves_has_come_to_rest_where_it_stands_and_nothing_changes_late() {
    let (own, controller) = scenario();
    assert!(comes_to_rest(&own, MOST_RAD, [1e-5, 1e-5]));
    assert!(!comes_to_rest(&own, MOST_RAD, [1e-2, 1e-5]));
    assert!(!comes_to_rest(&with(Shape::Step { at_s: 1.9 }), MOST_RAD, [1e-5, 1e-5]));
    // Of a few samples nothing is said.
    let ends = Ends::of(&own, &controller);
    for (length, wanted) in [(LEAST_FIFTH, true), (LEAST_FIFTH - 1, false)] {
        let mut pieces = Pieces::new(&own, &ends, length);
        (0..5 * length).for_each(|_| pieces.push(shown(0.0, 0.0)));
        assert_eq!(has_come_to_rest(&own, &pieces, None, &trace_of(&own)), wanted, "{length}");
    }
}

#[test]
fn what_swings_moves_has_come_to_rest_where_it_repeats_within_limits_and_has_shown_its_swings() {
    let swings = with(Shape::Sine { at_s: 0.0, frequency_hz: 2.0 });
    assert!(comes_to_rest(&swings, MOST_RAD, [0.05, 0.5]), "limits were met before");
    assert!(!comes_to_rest(&swings, 0.5, [0.05, MOST_RAD]));
    assert!(!comes_to_rest(&with(Shape::Sine { at_s: 0.0, frequency_hz: 0.2 }), 0.5, [0.05, 0.5]));
    // A swing that grows by a hundredth does not repeat, nor one of which a part is left out.
    let (_, controller) = scenario();
    let ends = Ends::of(&swings, &controller);
    let rests = |pieces: &Pieces<'_>| has_come_to_rest(&swings, pieces, None, &trace_of(&swings));
    assert!(rests(&swinging(&ends, &swings, changing(1.0, 0.5))));
    assert!(rests(&swinging(&ends, &swings, changing(1.0009, 0.5))));
    assert!(!rests(&swinging(&ends, &swings, changing(1.01, 0.5))));
    let mut cut = swinging(&ends, &swings, changing(1.0, 0.5));
    cut.push(shown(0.1, 0.5));
    assert!(!rests(&cut));
}

#[test]
fn what_noise_moves_has_come_to_rest_where_it_met_no_limit_and_its_beginning_is_over() {
    let noisy = with(Shape::Noise { at_s: 0.0, seed: 1 });
    assert!(comes_to_rest(&noisy, 0.5, [0.02, 0.5]));
    assert!(!comes_to_rest(&noisy, 0.5, [0.021, 0.5]), "it is more than a fifth");
    assert!(!comes_to_rest(&noisy, MOST_RAD, [0.02, 0.5]), "a limit was met");
    let mut slow = noisy.clone();
    slow.disturbances.extend(with(Shape::Sine { at_s: 0.0, frequency_hz: 0.2 }).disturbances);
    assert!(!comes_to_rest(&slow, 0.5, [0.02, 0.5]), "its swing was not shown");
}

/// A flight that follows a swing to the digit has an error of nothing, and one that leads it by as much has not.
#[test]
fn an_error_is_what_the_pitch_lacks_of_the_set_point() {
    let (mut own, controller) = scenario();
    own.setpoint =
        Profile::new(0.1, Shape::Sine { at_s: 0.0, frequency_hz: 1.0 }).expect("allowed");
    let ends = Ends::of(&own, &controller);
    let mut trace = trace_of(&own);
    trace.command_rad.fill(0.0);
    trace.theta_rad = trace.setpoint_rad.clone();
    let pieces = pieces_of(&own, &ends, &trace);
    assert!(pieces.rests() && pieces.length == 40);
    trace.theta_rad.iter_mut().for_each(|it| *it = -*it);
    assert!(!pieces_of(&own, &ends, &trace).rests());
}

/// Neither where its plant leads nor anything else is asked of it.
#[test]
fn a_linear_plant_that_is_lost_within_its_flight_is_in_doubt_at_once() {
    let (own, controller) = scenario();
    let mut trace = trace_of(&own);
    assert_eq!(Fate::of(&own, &controller, &trace, || None).doubt(), None);
    trace.theta_rad.truncate(150);
    trace.time_s.truncate(150);
    let found = Fate::of(&own, &controller, &trace, || panic!("it is known")).doubt();
    assert_eq!(found, Some(Doubt::SwingAtLimits));
    // Without limits a loop that holds at rest holds.
    let gains = Gains { kp: 2.0, ki: 0.0, kd: 1.0 };
    let free = Pid::new(gains, PidConfig::sampled_every(0.01)).expect("allowed");
    let free = Controller::Fixed(free);
    assert_eq!(Fate::of(&own, &free, &trace, || panic!("nothing ends")).doubt(), None);
}

#[test]
fn under_noise_an_error_has_grown_that_moves_twice_as_much_at_limits_as_before() {
    let (own, controller) = scenario();
    let ends = Ends::of(&own, &controller);
    let of =
        |error_rad: f64, command_rad: f64| swinging(&ends, &own, [[error_rad, command_rad]; 10]);
    let earlier = of(0.1, 0.5).whole();
    assert!(of(0.2, MOST_RAD).has_doubled_since(earlier));
    assert!(!of(0.199, MOST_RAD).has_doubled_since(earlier));
    assert!(!of(0.2, 0.5).has_doubled_since(earlier), "no limit is met");
}

/// By how much they move from sample to sample, not where they are.
#[test]
fn a_limit_of_rate_is_met_where_a_command_moves_by_as_much_in_a_sample() {
    let (own, _) = scenario();
    let config = PidConfig { slew_rad_s: Some(10.0), ..PidConfig::sampled_every(0.01) };
    let gains = Gains { kp: 2.0, ki: 0.0, kd: 1.0 };
    let ends = Ends::of(&own, &Controller::Fixed(Pid::new(gains, config).expect("allowed")));
    let meets = |commands_rad: [f64; 3]| {
        let mut pieces = Pieces::new(&own, &ends, PERIOD);
        commands_rad.iter().for_each(|it| pieces.push(shown(0.1, *it)));
        pieces.whole().meets()
    };
    assert!(!meets([0.5; 3]) && !meets([0.5, 0.59, 0.5]));
    assert!(meets([0.5, 0.6, 0.6]) && meets([0.5, 0.4, 0.4]) && meets([0.0, -0.1, -0.1]));
}

/// It swings at a limit around it, or drifts there one way.
#[test]
fn an_autopilot_at_a_limit_swings_on_where_the_pitch_turns_back_and_does_not_shrink() {
    let (own, controller) = scenario();
    let ends = Ends::of(&own, &controller);
    let swings_on = |autopilot_is_limited: bool, pitch: fn(f64) -> f64| {
        let mut pieces = Pieces::new(&own, &ends, PERIOD);
        pieces.may_drift = true;
        for k in 0..10 * PERIOD {
            let moving_rad = pitch(k as f64 / PERIOD as f64);
            pieces.push(Shown { autopilot_is_limited, ..shown(moving_rad, 0.0) });
        }
        pieces.swings_on(Moved::Nothing, Moves::On)
    };
    let swing = |periods: f64| 0.1 * libm::sin(core::f64::consts::TAU * periods);
    assert!(swings_on(true, swing) && !swings_on(false, swing));
    assert!(!swings_on(true, |periods| 0.1 * periods));
}

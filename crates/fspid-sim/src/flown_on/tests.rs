//! What is told of pieces of which every sample is known.

use fspid_core::{ControllerSetting, Gains, Limits, Pid, PidConfig};

use super::*;
use crate::plant::{ElevatorSign, LinearPlant};
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

/// A swing of the error and of the command, each of a size in rad for each of ten periods.
fn swinging<'a>(ends: &'a Ends, scenario: &Scenario, sizes_rad: [[f64; 2]; 10]) -> Pieces<'a> {
    let mut pieces = Pieces::new(scenario, ends, PERIOD);
    for [error_rad, command_rad] in sizes_rad {
        for k in 0..PERIOD {
            let side = if k < PERIOD / 2 { 1.0 } else { -1.0 };
            pieces.push(side * error_rad, side * command_rad, 0.0, 0.0);
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

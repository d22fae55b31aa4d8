//! What is told of the end of a flight whose gains move, of which every sample is known.

use core::f64::consts::TAU;

use fspid_core::{Fspid, Gains, InputScale, Pid, PidConfig, SelfTuner, TunerSettings, paper};
use fspid_fuzzy::{Defuzzifier, OutOfRange, Supervisor};

use super::super::pieces::{Outer, Shown};
use super::*;
use crate::actuator::Actuator;
use crate::held_limits::Ends;
use crate::plant::{ElevatorSign, LinearPlant};
use crate::sensor::{RATE, Sensor, SensorModel};
use crate::signal::{Disturbance, Entry, Profile, Shape};
use crate::surroundings::Surroundings;
use crate::timing::Timing;

/// Samples of a period of what swings here; it is a piece.
const PERIOD: usize = 20;
const DT_S: f64 = 0.01;

fn scenario() -> Scenario {
    let plant = LinearPlant::new(&[1.0], &[1.0, 1.0, 0.0], ElevatorSign::NoseUpPositive);
    let timing = Timing::new(DT_S, 2.0).expect("allowed");
    let step = Profile::new(0.1, Shape::Step { at_s: 0.0 }).expect("allowed");
    Scenario::new("gains", plant.expect("proper"), timing, step)
}

fn self_tuner() -> Controller {
    let settings = TunerSettings {
        input_scale: InputScale { error_per_rad: 1.0, change_per_rad: 1.0 },
        output_scale: Gains { kp: 0.1, ki: 0.0, kd: 0.0 },
        ..TunerSettings::literal()
    };
    let supervisor = Supervisor::new(&paper::rules(), 5.0, Defuzzifier::Exact, OutOfRange::Clamp);
    let nominal = Gains { kp: 2.0, ki: 0.0, kd: 1.0 };
    let tuner = SelfTuner::new(nominal, supervisor.expect("allowed"), settings).expect("allowed");
    Controller::SelfTuning(Fspid::new(tuner, PidConfig::sampled_every(DT_S)).expect("allowed"))
}

/// Ten periods of an error whose size changes by a factor with each, so that from a fifth to the next it changes by its square.
fn changing<'a>(ends: &'a Ends, scenario: &Scenario, factor: f64) -> Pieces<'a> {
    let mut pieces = Pieces::new(scenario, ends, PERIOD);
    let mut size_rad = 0.1;
    for _ in 0..10 {
        for k in 0..PERIOD {
            let moving_rad = if k < PERIOD / 2 { size_rad } else { -size_rad };
            let (at_servo_rad, elevator_rad, autopilot_is_limited) = (0.0, 0.0, false);
            let command_rad = moving_rad;
            pieces.push(Shown {
                moving_rad,
                command_rad,
                at_servo_rad,
                elevator_rad,
                autopilot_is_limited,
                gains: Gains::ZERO,
                outer: Outer::default(),
            });
        }
        size_rad *= factor;
    }
    pieces
}

fn have_left(scenario: &Scenario, factor: f64, moved: Moved) -> bool {
    let controller = self_tuner();
    let ends = Ends::of(scenario, &controller);
    let gains = MovingGains::of(scenario, &controller).expect("they move");
    gains.have_left(&changing(&ends, scenario, factor), moved)
}

#[test]
fn an_error_that_nothing_moves_stays_where_it_shrinks_by_less_than_a_hundredth_in_a_fifth() {
    let plain = scenario();
    for (factor, wanted) in [(1.01, true), (0.998, true), (0.99, false)] {
        assert_eq!(have_left(&plain, factor, Moved::Nothing), wanted, "{factor}");
    }
    // What a width keeps swinging has to grow.
    let lag = || Actuator::first_order(0.05).expect("allowed");
    let moved_by = |actuator: Actuator| Scenario { actuator, ..scenario() };
    let seen_by = |resolution: f64| {
        let model = SensorModel { resolution, ..SensorModel::default() };
        let rate_sensor = Some(Sensor::new(model, 1, RATE).expect("allowed"));
        let surroundings = Surroundings { rate_sensor, ..Surroundings::default() };
        Scenario { surroundings, ..scenario() }
    };
    assert!(have_left(&seen_by(0.0), 0.998, Moved::Nothing));
    // A swing that is ten times as wide is none of its own.
    for narrow in [moved_by(lag().with_play(1e-6).expect("allowed")), seen_by(1e-6)] {
        assert!(have_left(&narrow, 0.998, Moved::Nothing));
    }
    for wide in [
        moved_by(lag().with_play(0.03).expect("allowed")),
        moved_by(lag().with_deadband(0.03).expect("allowed")),
        seen_by(0.03),
    ] {
        for (factor, wanted) in [(1.03, true), (1.01, false), (0.998, false)] {
            assert_eq!(have_left(&wide, factor, Moved::Nothing), wanted, "{factor}");
        }
    }
}

/// A slow motion towards a rest has the same pace for long.
#[test]
fn what_creeps_one_way_stays_where_it_grows() {
    let scenario = scenario();
    let controller = self_tuner();
    let ends = Ends::of(&scenario, &controller);
    let gains = MovingGains::of(&scenario, &controller).expect("they move");
    for (factor, wanted) in [(1.03, true), (1.01, false), (0.998, false)] {
        let mut pieces = Pieces::new(&scenario, &ends, PERIOD);
        let (mut moving_rad, mut pace_rad) = (0.1_f64, 1e-3);
        for k in 0..10 * PERIOD {
            pace_rad *= if (k + 1).is_multiple_of(PERIOD) { factor } else { 1.0 };
            moving_rad += pace_rad;
            let (command_rad, at_servo_rad, elevator_rad) = (moving_rad, 0.0, 0.0);
            pieces.push(Shown {
                moving_rad,
                command_rad,
                at_servo_rad,
                elevator_rad,
                autopilot_is_limited: false,
                gains: Gains::ZERO,
                outer: Outer::default(),
            });
        }
        assert_eq!(gains.have_left(&pieces, Moved::Nothing), wanted, "{factor}");
    }
}

#[test]
fn what_is_moved_has_to_double_in_fifths_that_hold_two_periods() {
    for moved in [Moved::BySwings, Moved::ByNoise] {
        for (factor, wanted) in [(1.42, true), (1.40, false)] {
            assert_eq!(have_left(&scenario(), factor, moved), wanted, "{factor} {moved:?}");
        }
    }
    // A fifth is 0.4 s long.
    for (frequency_hz, wanted) in [(5.1, true), (4.9, false)] {
        let shape = Shape::Sine { at_s: 0.0, frequency_hz };
        let swing = Disturbance::new(Entry::Servo, 0.01, shape).expect("allowed");
        let swung = Scenario { disturbances: vec![swing], ..scenario() };
        assert_eq!(have_left(&swung, 1.5, Moved::BySwings), wanted, "{frequency_hz}");
        assert!(have_left(&swung, 1.5, Moved::ByNoise), "noise has no period");
    }
}

#[test]
fn nothing_is_said_of_fixed_gains_and_of_fewer_pieces_than_fifths() {
    let scenario = scenario();
    let gains = Gains { kp: 2.0, ki: 0.0, kd: 1.0 };
    let fixed = Pid::new(gains, PidConfig::sampled_every(DT_S)).expect("allowed");
    assert_eq!(MovingGains::of(&scenario, &Controller::Fixed(fixed)), None);
    let controller = self_tuner();
    let ends = Ends::of(&scenario, &controller);
    let gains = MovingGains::of(&scenario, &controller).expect("they move");
    let mut few = Pieces::new(&scenario, &ends, PERIOD);
    for _ in 0..4 * PERIOD {
        let (moving_rad, command_rad, at_servo_rad, elevator_rad) = (0.1, 0.1, 0.0, 0.0);
        few.push(Shown {
            moving_rad,
            command_rad,
            at_servo_rad,
            elevator_rad,
            autopilot_is_limited: false,
            gains: Gains::ZERO,
            outer: Outer::default(),
        });
    }
    assert!(!gains.have_left(&few, Moved::Nothing));
}

#[test]
fn gains_stand_where_a_flight_moves_at_its_end_by_a_fiftieth_at_most() {
    let scenario = scenario();
    let ends = Ends::of(&scenario, &self_tuner());
    // The last two of ten periods are 0.5^8 and 0.62^8 of the first.
    assert!(MovingGains::stand(&changing(&ends, &scenario, 0.5)));
    assert!(!MovingGains::stand(&changing(&ends, &scenario, 0.62)));
}

/// At a limit of an outer loop the pitch stands while the altitude goes: an altitude that goes away from what is held by a mode, or
/// swings about it, has left; what stands beside it, comes back, or is another mode's has not.
#[test]
fn what_is_held_is_left_where_it_goes_away_or_swings_and_not_where_it_stands_or_comes_back() {
    let scenario = scenario();
    let controller = self_tuner();
    let ends = Ends::of(&scenario, &controller);
    let gains = MovingGains::of(&scenario, &controller).expect("they move");
    let leaves = |off_m: fn(f64) -> f64, mode: fn(f64) -> f64| {
        let mut pieces = Pieces::new(&scenario, &ends, PERIOD);
        for k in 0..10 * PERIOD {
            let along = k as f64 / (10 * PERIOD) as f64;
            let outer =
                Outer { off: [off_m(along), 0.0, 0.0, 0.0], mode: mode(along), ..Outer::default() };
            pieces.push(Shown { outer, ..still() });
        }
        gains.leave_what_is_held(&pieces, Moved::Nothing)
    };
    let one = |_: f64| 0.0;
    assert!(leaves(|along| 50.0 * along, one));
    assert!(leaves(|along| 20.0 * libm::sin(60.0 * along), one));
    assert!(!leaves(|along| 50.0 - 40.0 * along, one), "it comes back");
    assert!(!leaves(|along| if along < 0.1 { 60.0 } else { 40.0 }, one), "it stands");
    assert!(!leaves(|along| 2.9 * along, one), "it is there");
    assert!(
        !leaves(|along| 50.0 * along, |along| f64::from(u8::from(along > 0.7))),
        "another mode"
    );
}

/// What drifts with speed and height does not go away so fast, and what is nearer than a degree is there. A linear plant has nothing
/// that drifts beside, and is asked otherwise; behind an autopilot it is the pitch itself that moves.
#[test]
fn an_aircraft_leaves_its_set_point_where_its_error_grows_by_a_quarter_from_one_fifth_to_the_next()
{
    let scenario = scenario();
    let controller = self_tuner();
    let ends = Ends::of(&scenario, &controller);
    let of_plants = MovingGains::of(&scenario, &controller).expect("they move");
    let of_aircraft = MovingGains { is_of_aircraft: true, ..of_plants };
    let rises_under =
        |moved: Moved, may_drift: bool, gains: MovingGains, error_deg: fn(f64) -> f64| {
            let mut pieces = Pieces::new(&scenario, &ends, PERIOD);
            pieces.may_drift = may_drift;
            for k in 1..=10 * PERIOD {
                let moving_rad = error_deg(k as f64 / (10 * PERIOD) as f64).to_radians();
                pieces.push(Shown { moving_rad, ..still() });
            }
            gains.leave_what_is_held(&pieces, moved)
        };
    let rises = |may_drift: bool, gains: MovingGains, error_deg: fn(f64) -> f64| {
        rises_under(Moved::Nothing, may_drift, gains, error_deg)
    };
    // From 0.8 of the way to its end.
    assert!(rises(false, of_aircraft, |along| -5.0 * along * along));
    assert!(!rises(false, of_aircraft, |along| -5.0 * along.sqrt()), "it drifts");
    assert!(!rises(false, of_aircraft, |along| 0.99 * along * along), "it is there");
    assert!(!rises(false, of_plants, |along| -5.0 * along * along));
    // Under noise it has to double, from 0.8 to 1.
    let steep = |along: f64| 5.0 * libm::pow(along, 4.0);
    assert!(rises_under(Moved::ByNoise, false, of_aircraft, steep));
    assert!(!rises_under(Moved::ByNoise, false, of_aircraft, |along| 5.0 * along * along));
    assert!(!rises(true, of_aircraft, |along| -5.0 * along * along));
}

/// An aircraft that is flown on has come back where it stood for five pieces, within its limits; two are not enough.
#[test]
fn an_aircraft_has_come_back_where_it_stood_for_as_long_as_its_flight_was() {
    let scenario = scenario();
    let controller = self_tuner();
    let ends = Ends::of(&scenario, &controller);
    let of_plants = MovingGains::of(&scenario, &controller).expect("they move");
    let of_aircraft = MovingGains { is_of_aircraft: true, ..of_plants };
    let climbed = |gains: MovingGains, moving: usize, left_rad: f64, [far_m, off_m]: [f64; 2]| {
        let mut pieces = Pieces::new(&scenario, &ends, PERIOD);
        for k in 0..10 * PERIOD {
            let side = if k % PERIOD < PERIOD / 2 { 1.0 } else { -1.0 };
            let is_moving = k < moving * PERIOD;
            let moving_rad = side * if is_moving { 0.1 } else { left_rad };
            let outer = Outer {
                off: [if is_moving { far_m } else { side * off_m }, 0.0, 0.0, 0.0],
                ..Outer::default()
            };
            pieces.push(Shown { moving_rad, outer, ..still() });
        }
        gains.have_come_back(&pieces)
    };
    let has_come_back = |gains: MovingGains, moving: usize, left_rad: f64, off_m: f64| {
        climbed(gains, moving, left_rad, [0.0, off_m])
    };
    assert!(has_come_back(of_aircraft, 5, 0.0019, 1.4));
    assert!(!has_come_back(of_aircraft, 5, 0.0021, 1.4), "the pitch moves");
    assert!(!has_come_back(of_aircraft, 5, 0.0019, 1.6), "the altitude does");
    assert!(!has_come_back(of_aircraft, 6, 0.0019, 1.4), "not for long enough");
    // A fiftieth of all that it was off, where that is more than three metres.
    assert!(climbed(of_aircraft, 5, 0.0019, [200.0, 1.9]));
    assert!(!climbed(of_aircraft, 5, 0.0019, [200.0, 2.1]));
    assert!(!has_come_back(of_plants, 5, 0.0019, 0.0), "a swing of a linear plant does not shrink");
}

/// After two turns a heading that swings by 5 deg would move by no more than a fiftieth of them.
#[test]
fn a_heading_that_went_round_before_has_no_more_room_to_swing() {
    let scenario = scenario();
    let controller = self_tuner();
    let ends = Ends::of(&scenario, &controller);
    let gains = MovingGains {
        is_of_aircraft: true,
        ..MovingGains::of(&scenario, &controller).expect("they move")
    };
    let swings = |by_deg: f64| {
        let mut pieces = Pieces::new(&scenario, &ends, PERIOD);
        for k in 0..10 * PERIOD {
            let side = if k % PERIOD < PERIOD / 2 { 0.5 } else { -0.5 };
            let turned_rad = 2.0 * TAU * (k as f64 / (5 * PERIOD) as f64).min(1.0);
            let mut outer = Outer::default();
            outer.off[HEADING] = turned_rad + side * by_deg.to_radians();
            let moving_rad = if k < 5 * PERIOD { side } else { 0.0 };
            pieces.push(Shown { moving_rad, outer, ..still() });
        }
        [gains.have_come_back(&pieces), leave_what_a_mode_holds(&pieces, Moved::Nothing)]
    };
    assert_eq!(swings(0.9), [true, false]);
    assert_eq!(swings(5.0), [false, true]);
}

/// A linear plant has come back where its gains stand and its error shrinks, and moves by a fiftieth of all its movement at most.
#[test]
fn a_linear_plant_has_come_back_where_its_gains_stand_and_its_error_shrinks() {
    let scenario = scenario();
    let controller = self_tuner();
    let ends = Ends::of(&scenario, &controller);
    let of_plants = MovingGains::of(&scenario, &controller).expect("they move");
    let shrunk = |left_rad: f64, factor: f64, gain_moves: f64| {
        let mut pieces = Pieces::new(&scenario, &ends, PERIOD);
        let mut size_rad = 0.1;
        for piece in 0..10 {
            size_rad = match piece {
                0..5 => size_rad,
                5 => left_rad,
                _ => factor * size_rad,
            };
            for k in 0..PERIOD {
                let side = if k < PERIOD / 2 { 1.0 } else { -1.0 };
                let kp = 2.0 - gain_moves * (1.0 - side);
                let gains = Gains { kp, ki: 0.0, kd: 1.0 };
                pieces.push(Shown { moving_rad: side * size_rad, gains, ..still() });
            }
        }
        pieces
    };
    assert!(of_plants.have_come_back(&shrunk(0.0019, 0.94, 0.009)));
    assert!(!of_plants.have_come_back(&shrunk(0.0021, 0.94, 0.009)), "the error moves");
    assert!(!of_plants.have_come_back(&shrunk(0.0019, 0.96, 0.009)), "it hardly shrinks");
    assert!(!of_plants.have_come_back(&shrunk(0.0019, 0.94, 0.011)), "a gain moves");
    let accumulating = MovingGains { accumulate: true, ..of_plants };
    assert!(!accumulating.have_come_back(&shrunk(0.0019, 0.94, 0.009)), "it stays where it is");
}

fn still() -> Shown {
    Shown {
        moving_rad: 0.0,
        command_rad: 0.0,
        at_servo_rad: 0.0,
        elevator_rad: 0.0,
        autopilot_is_limited: false,
        gains: Gains::ZERO,
        outer: Outer::default(),
    }
}

//! Limits that another programme and another solver found (`oracles/make_limit.py`), and what is refused.

use fspid_limit::{
    Assumed, LimitError, Measure, Planner, Question, Reached, Refusal, SaidBeside, Still, Travel,
    fly_commands, limit, measured,
};
use fspid_sim::actuator::Lag;
use fspid_sim::core::{Gains, Pid, PidConfig};
use fspid_sim::sensor::{Sensor, SensorModel};
use fspid_sim::signal::{Disturbance, Entry, Profile, Shape};
use fspid_sim::{
    Actuator, Controller, ElevatorSign, LinearPlant, PlantChange, Scenario, Timing, simulate,
};

const DEG: f64 = std::f64::consts::PI / 180.0;

/// The paper's 747 with its servo: a step of 5 deg, 20 s at 20 Hz, ± 20 deg.
fn paper() -> Scenario {
    let plant = LinearPlant::new(
        &[-1.69144, -0.84341, -0.0099096],
        &[1.0, 1.17103, 1.55405, 0.012538, 0.0072771],
        ElevatorSign::NoseDownPositive,
    )
    .expect("allowed");
    let timing = Timing::new(0.05, 20.0).expect("allowed");
    let step = Profile::new(5.0 * DEG, Shape::Step { at_s: 0.0 }).expect("allowed");
    let actuator =
        Actuator::new(Lag::first_order(0.1).expect("allowed")).with_position_limit(20.0 * DEG);
    Scenario { actuator: actuator.expect("allowed"), ..Scenario::new("747", plant, timing, step) }
}

/// A light aircraft that something pushes before its step, two samples late.
fn light() -> Scenario {
    let plant =
        LinearPlant::new(&[11.2, 20.0], &[1.0, 5.05, 13.2, 0.0], ElevatorSign::NoseUpPositive);
    let timing = Timing::new(0.04, 8.0).expect("allowed");
    let step = Profile::new(4.0 * DEG, Shape::Step { at_s: 3.0 }).expect("allowed");
    let actuator =
        Actuator::new(Lag::first_order(0.15).expect("allowed")).with_delay(2).expect("allowed");
    let actuator = actuator.with_command_limits(-6.0 * DEG, 9.0 * DEG).expect("allowed");
    let mut scenario = Scenario::new("light", plant.expect("allowed"), timing, step);
    scenario.actuator = actuator;
    let push = Disturbance::new(Entry::Elevator, DEG, Shape::Step { at_s: 1.0 }).expect("allowed");
    scenario.disturbances.push(push);
    scenario
}

/// How often somebody without a future plans, and the best that he reaches within a travel.
fn planned(
    scenario: &Scenario,
    question: &Question,
    asked: (Measure, Travel),
    travel_rad: f64,
) -> (usize, Reached) {
    let mut planner = Planner::new(scenario, question, asked, || false).expect("few events");
    planner.search(travel_rad).expect("allowed");
    let best = Reached::least_within(travel_rad, planner.reached()).expect("one keeps within");
    (planner.plans(), best)
}

#[test]
fn limits_are_those_that_another_solver_found() {
    let mut compared = 0;
    for line in include_str!("data/limits.csv").lines().skip(1) {
        let [case, counted, travel_deg, expected] =
            line.split(',').collect::<Vec<_>>().try_into().expect("allowed");
        let scenario = if case == "747" { paper() } else { light() };
        let travel = Travel::ALL.into_iter().find(|it| it.name() == counted).expect("allowed");
        let expected: f64 = expected.parse().expect("allowed");
        let question =
            Question::of(&scenario, travel, Assumed::within(90.0 * DEG)).expect("allowed");
        let budget = travel_deg.parse::<f64>().expect("allowed") * DEG;
        let limit =
            limit(&scenario, &question, (Measure::Iae, travel), budget, || false).expect("allowed");
        let flown = limit.reached.expect("flown within the travel");
        let (proved, reached) = (limit.proved / DEG, flown.measure / DEG);
        // The other solver is right to some 1e-7; what the proof gives away is below 2e-6 of it.
        assert!(
            proved <= expected * (1.0 + 1e-7) && proved > expected * (1.0 - 2e-6),
            "{line}: {proved}"
        );
        assert!((reached - expected).abs() < 1e-6 * expected, "{line}: {reached}");
        assert!((flown.travel_rad / budget - 1.0).abs() < 1e-6, "{line}");
        compared += 1;
    }
    assert_eq!(compared, 22);
}

#[test]
fn a_first_jump_that_does_not_count_is_worth_something() {
    let scenario = paper();
    let proved = |travel| {
        let question =
            Question::of(&scenario, travel, Assumed::within(90.0 * DEG)).expect("allowed");
        limit(&scenario, &question, (Measure::Iae, travel), 8.0 * DEG, || false)
            .expect("allowed")
            .proved
    };
    assert!(proved(Travel::Command) < 0.8 * proved(Travel::CommandFromRest));
}

#[test]
fn who_does_not_know_the_future_reaches_no_more_than_the_limit() {
    let scenario = light();
    let asked = (Measure::Iae, Travel::Elevator);
    let question = Question::of(&scenario, asked.1, Assumed::within(90.0 * DEG)).expect("allowed");
    let budget = 12.0 * DEG;
    let limit = limit(&scenario, &question, asked, budget, || false).expect("allowed");
    let (plans, reached) = planned(&scenario, &question, asked, budget);
    // The push and the step each make a new plan.
    assert_eq!(plans, 3);
    assert!(reached.travel_rad <= budget * (1.0 + 1e-6));
    let ratio = reached.measure / limit.proved;
    // Who knows the step before begins it before.
    assert!(ratio > 2.0 && ratio < 5.0, "{ratio}");
}

#[test]
fn with_one_event_at_the_start_the_future_is_worth_nothing() {
    let scenario = paper();
    let asked = (Measure::Iae, Travel::CommandFromRest);
    let question = Question::of(&scenario, asked.1, Assumed::within(90.0 * DEG)).expect("allowed");
    let limit = limit(&scenario, &question, asked, 10.0 * DEG, || false).expect("allowed");
    let (plans, reached) = planned(&scenario, &question, asked, 10.0 * DEG);
    assert_eq!(plans, 1);
    assert!(reached.measure < limit.proved * 1.02, "{}", reached.measure);
}

#[test]
fn what_no_limit_can_be_told_of_is_refused_all_at_once() {
    let mut scenario = paper();
    let plant = scenario.plant.linear().expect("allowed").clone();
    scenario.plant_changes.push(PlantChange::new(1.0, 0.0, plant).expect("allowed"));
    scenario.actuator = scenario.actuator.with_play(0.01).expect("allowed");
    scenario.actuator = scenario.actuator.with_rate_limit(0.5).expect("allowed");
    let refused = Question::of(&scenario, Travel::Command, Assumed::within(1.0)).map(|_| ());
    let expected = vec![Refusal::Changes, Refusal::Play, Refusal::CommandThroughLimits];
    assert_eq!(refused, Err(LimitError::Refused(expected)));
    // Each can be taken away, and the last by counting the elevator's way.
    scenario.plant_changes.clear();
    scenario.actuator = scenario.actuator.with_play(0.0).expect("allowed");
    assert!(Question::of(&scenario, Travel::Elevator, Assumed::within(1.0)).is_ok());
}

#[test]
fn what_is_assumed_and_left_out_is_said_beside() {
    let mut scenario = paper();
    scenario.actuator = Actuator::ideal();
    let noise = Shape::Noise { at_s: 0.0, seed: 1 };
    scenario.disturbances.push(Disturbance::new(Entry::Measurement, DEG, noise).expect("allowed"));
    let question =
        Question::of(&scenario, Travel::Elevator, Assumed::within(90.0 * DEG)).expect("allowed");
    let expected = [SaidBeside::Within(90.0 * DEG), SaidBeside::SeesEverything];
    assert_eq!(question.beside(), expected);
}

#[test]
fn a_travel_that_what_disturbs_the_elevator_alone_needs_more_than_is_refused() {
    let mut scenario = light();
    let push =
        Disturbance::new(Entry::Elevator, 9.0 * DEG, Shape::Step { at_s: 1.0 }).expect("allowed");
    scenario.disturbances.push(push);
    let question =
        Question::of(&scenario, Travel::Elevator, Assumed::within(90.0 * DEG)).expect("allowed");
    let asked = (Measure::Iae, Travel::Elevator);
    // The servo takes back less than 2 of 10 deg in a sample.
    let refused = limit(&scenario, &question, asked, 5.0 * DEG, || false).map(|it| it.proved);
    assert_eq!(refused, Err(LimitError::TravelTooSmall));
}

#[test]
fn a_controller_is_measured_as_reports_do() {
    let pid = Pid::new(Gains { kp: 2.0, ki: 0.5, kd: 1.0 }, PidConfig::sampled_every(0.05));
    let scenario = paper().with_controller("PID", Controller::Fixed(pid.expect("allowed")));
    let trace = simulate(&scenario).expect("allowed").traces.remove(0);
    let (iae, way) = measured(
        (Measure::Iae, Travel::Command),
        (&trace.setpoint_rad, &trace.theta_rad),
        (&trace.command_rad, &trace.elevator_rad),
        0.05,
    );
    let errors = trace.setpoint_rad.iter().zip(&trace.theta_rad).map(|(r, y)| (r - y).abs());
    assert!((iae - 0.05 * errors.sum::<f64>()).abs() < 1e-12 * iae);
    let steps = trace.command_rad.windows(2).map(|it| (it[1] - it[0]).abs());
    assert!((way - steps.sum::<f64>()).abs() < 1e-12 * way);
}

#[test]
fn who_keeps_still_until_something_happens_cannot_be_early() {
    let mut scenario = light();
    scenario.disturbances.clear();
    let still = Still::of(&scenario, [].into_iter()).expect("allowed");
    assert_eq!((still.until, still.until_s, still.within_rad), (75, 3.0, 0.0));
    let asked = (Measure::Iae, Travel::Elevator);
    let limit_of = |still| {
        let assumed = Assumed { within_rad: 1.0, still };
        let question = Question::of(&scenario, asked.1, assumed).expect("allowed");
        limit(&scenario, &question, asked, 10.0 * DEG, || false).expect("allowed")
    };
    let (early, late) = (limit_of(None), limit_of(Some(still)));
    assert!(late.proved > 1.2 * early.proved, "{} {}", late.proved, early.proved);
    let reached = late.reached.expect("flown within the travel");
    assert!(reached.measure < late.proved * (1.0 + 1e-5));
    assert!(reached.command_rad.iter().take(75).all(|u| *u == 0.0));
    // One that only knows when it happens does as well.
    let assumed = Assumed { within_rad: 1.0, still: Some(still) };
    let question = Question::of(&scenario, asked.1, assumed).expect("allowed");
    let (_, reached) = planned(&scenario, &question, asked, 10.0 * DEG);
    assert!(reached.measure < 1.02 * late.proved);
}

/// "30.07 deg s proved" of a servo that stands a degree off, beside a PID that flies it with 2.75: it had not moved until the step.
#[test]
fn nobody_keeps_still_where_a_bias_air_or_noise_of_the_servo_moves_the_aircraft_from_the_start() {
    let quiet = || {
        let mut scenario = light();
        scenario.disturbances.clear();
        scenario
    };
    let until = |scenario: &Scenario| Still::of(scenario, [].into_iter()).map(|it| it.until);
    assert_eq!(until(&quiet()), Some(75));
    let mut biased = quiet();
    biased.actuator = biased.actuator.with_bias(0.1 * DEG).expect("allowed");
    assert_eq!(until(&biased), None);
    let noise = |entry: Entry, size_rad: f64| {
        let shape = Shape::Noise { at_s: 1.0, seed: 1 };
        let mut scenario = quiet();
        scenario.disturbances.push(Disturbance::new(entry, size_rad, shape).expect("allowed"));
        until(&scenario)
    };
    for entry in [Entry::Servo, Entry::Elevator] {
        assert_eq!((noise(entry, 0.1 * DEG), noise(entry, 0.0)), (Some(25), Some(75)), "{entry:?}");
    }
    // It moves nobody but who answers it.
    assert_eq!(noise(Entry::Measurement, 0.1 * DEG), Some(75));
    let mut seen = quiet();
    let model = SensorModel { bias: 0.1 * DEG, ..SensorModel::default() };
    seen.surroundings.rate_sensor = Some(Sensor::new(model, 1, 0).expect("allowed"));
    assert_eq!(until(&seen), None);
}

#[test]
fn a_deadband_makes_no_command_of_what_a_solver_leaves_over_before_anything_happens() {
    let mut scenario = light();
    scenario.disturbances.clear();
    scenario.actuator = scenario.actuator.with_deadband(0.2 * DEG).expect("allowed");
    let still = Still::of(&scenario, [].into_iter());
    let assumed = Assumed { within_rad: 1.0, still };
    for (measure, travel_deg) in [(Measure::Iae, 3.0), (Measure::Ise, 3.0), (Measure::Ise, 0.1)] {
        let asked = (measure, Travel::Elevator);
        let question = Question::of(&scenario, asked.1, assumed).expect("allowed");
        let found = limit(&scenario, &question, asked, travel_deg * DEG, || false);
        let reached = found.expect("allowed").reached.expect("flown within the travel");
        assert!(reached.command_rad.iter().take(75).all(|u| *u == 0.0), "{measure:?}");
    }
}

/// A plant without a lag of its servo, which something pushes by 3 deg at 1 s while nobody moves, a sample late.
fn pushed_servo() -> Scenario {
    let mut scenario = paper();
    scenario.setpoint = Profile::new(0.0, Shape::Step { at_s: 0.0 }).expect("allowed");
    scenario.timing = Timing::new(0.05, 6.0).expect("allowed");
    scenario.actuator = Actuator::ideal().with_delay(1).expect("allowed");
    let push = Disturbance::new(Entry::Servo, 3.0 * DEG, Shape::Step { at_s: 1.0 });
    scenario.disturbances.push(push.expect("allowed"));
    scenario
}

/// The programme took the push back before anybody could know of it: "reached" was told within 0.1 deg, flown with 6.
#[test]
fn commands_that_are_still_cannot_take_back_what_pushes_the_servo() {
    for deadband_deg in [0.0, 0.3] {
        let mut scenario = pushed_servo();
        scenario.actuator = scenario.actuator.with_deadband(deadband_deg * DEG).expect("allowed");
        let asked = (Measure::Iae, Travel::Elevator);
        let still = Still::of(&scenario, [].into_iter());
        let assumed = Assumed { within_rad: 1.0, still };
        let question = Question::of(&scenario, asked.1, assumed).expect("allowed");
        let limit_of = |deg: f64| limit(&scenario, &question, asked, deg * DEG, || false);
        for travel_deg in [0.1, 1.0, 2.6] {
            assert_eq!(limit_of(travel_deg), Err(LimitError::TravelTooSmall), "{travel_deg}");
        }
        let within = limit_of(6.5).expect("allowed");
        let reached = within.reached.expect("flown within the travel");
        assert!(reached.travel_rad <= 6.5 * DEG * (1.0 + 1e-6));
        assert!(
            reached.measure < within.proved * (1.0 + 1e-4) && reached.measure > 0.01 * DEG,
            "{} {}",
            reached.measure,
            within.proved
        );
    }
}

/// The programme allows commands that are cut as much more as the servo is moved; what they take in flight counts.
#[test]
fn what_is_flown_beyond_the_travel_is_not_reached() {
    let mut scenario = light();
    let push = Disturbance::new(Entry::Servo, DEG, Shape::Pulse { at_s: 2.0, width_s: 1.0 });
    scenario.disturbances.push(push.expect("allowed"));
    for (travel, travel_deg) in [(Travel::Command, 1.0), (Travel::CommandFromRest, 4.0)] {
        let asked = (Measure::Iae, travel);
        let assumed = Assumed { within_rad: 1.0, still: Still::of(&scenario, [].into_iter()) };
        let question = Question::of(&scenario, travel, assumed).expect("allowed");
        assert!(question.beside().contains(&SaidBeside::ServoDisturbance));
        let found = limit(&scenario, &question, asked, travel_deg * DEG, || false);
        let found = found.expect("allowed");
        if let Some(reached) = &found.reached {
            assert!(reached.travel_rad <= travel_deg * DEG * (1.0 + 1e-6), "{travel:?}");
            assert!(reached.measure >= found.proved, "{travel:?}");
        }
    }
}

/// What the servo is pushed by before the first command arrives was taken to move the elevator by its lag alone, and no
/// command kept within any travel.
#[test]
fn before_a_command_arrives_rate_and_stops_hold_the_elevator_too() {
    let lag = Actuator::new(Lag::first_order(0.1).expect("allowed"));
    let held = [
        Actuator::ideal().with_rate_limit(5.0 * DEG),
        lag.with_rate_limit(5.0 * DEG),
        Actuator::ideal().with_travel(-DEG, DEG),
        lag.with_travel(-DEG, DEG),
    ];
    for actuator in held {
        let mut scenario = pushed_servo();
        scenario.actuator = actuator.expect("allowed").with_delay(5).expect("allowed");
        let push = Disturbance::new(Entry::Servo, 3.0 * DEG, Shape::Step { at_s: 0.0 });
        scenario.disturbances = vec![push.expect("allowed")];
        let asked = (Measure::Iae, Travel::Elevator);
        let question = Question::of(&scenario, asked.1, Assumed::within(1.0)).expect("allowed");
        let flown = fly_commands(&scenario, &[], asked).expect("allowed");
        let found = limit(&scenario, &question, asked, flown.travel_rad + 1e-9, || false);
        let found = found.expect("somebody flew it");
        assert!(found.proved <= flown.measure, "{} {}", found.proved, flown.measure);
        assert!(found.proved > 1e-3 * flown.measure, "{} {}", found.proved, flown.measure);
    }
}

/// What stands at a stop is not moved by the servo, and no command has to hold against it.
#[test]
fn a_servo_that_is_pushed_against_a_stop_costs_no_travel_of_commands() {
    let mut scenario = pushed_servo();
    scenario.actuator = Actuator::ideal().with_travel(-DEG, DEG).expect("allowed");
    for travel in [Travel::Command, Travel::CommandFromRest] {
        let asked = (Measure::Iae, travel);
        let flown = fly_commands(&scenario, &[], asked).expect("allowed");
        assert!(flown.travel_rad.abs() <= 0.0);
        let question = Question::of(&scenario, travel, Assumed::within(1.0)).expect("allowed");
        let found = limit(&scenario, &question, asked, 1e-9, || false).expect("somebody flew it");
        assert!(found.proved <= flown.measure, "{} {}", found.proved, flown.measure);
    }
}

/// A price that is halved as if travel fell with it: who may take more reached less.
#[test]
fn who_has_more_travel_and_no_future_never_reaches_less() {
    let mut scenario = pushed_servo();
    let push = |entry, deg: f64, at_s| Disturbance::new(entry, deg * DEG, Shape::Step { at_s });
    scenario.disturbances = [push(Entry::Servo, 0.5, 1.0), push(Entry::Elevator, -1.0, 3.33)]
        .into_iter()
        .map(|it| it.expect("allowed"))
        .collect();
    let asked = (Measure::Iae, Travel::Elevator);
    let assumed = Assumed { within_rad: 1.0, still: Still::of(&scenario, [].into_iter()) };
    let question = Question::of(&scenario, asked.1, assumed).expect("allowed");
    let mut planner = Planner::new(&scenario, &question, asked, || false).expect("few events");
    let travels_rad = [2.1, 2.5, 3.2, 3.6].map(|it| it * DEG);
    travels_rad.iter().for_each(|it| planner.search(*it).expect("allowed"));
    let told = travels_rad.map(|it| Reached::least_within(it, planner.reached()));
    let [_, _, near, far] = told.map(|it| it.expect("one keeps within").measure);
    for (it, travel_rad) in told.iter().zip(travels_rad) {
        assert!(it.is_some_and(|it| it.travel_rad <= travel_rad * (1.0 + 1e-6)), "{told:?}");
    }
    let values: Vec<f64> = told.iter().flatten().map(|it| it.measure).collect();
    assert!(values.windows(2).all(|pair| pair[1] <= pair[0]), "{values:?}");
    assert!(far < 0.1 * DEG && far <= near, "{} {}", near / DEG, far / DEG);
}

//! Measures of flights whose every sample is written by hand, at 10 samples a second.

use fspid_core::{Faults, Gains};
use fspid_scenario::requirement::{AskedIn, Origin};
use fspid_scenario::units::radians;
use fspid_sim::Outcome;
use fspid_sim::signal::Edge;

use super::*;

/// A second, eleven samples.
fn timing() -> Timing {
    Timing::new(0.1, 1.0).expect("allowed")
}

/// A flight with these set-points and pitch angles, deg, whose command falls by 1 deg a sample from 3 deg and whose elevator
/// moves by 2 deg there and back again.
fn trace(setpoint_deg: &[f64], theta_deg: &[f64]) -> Trace {
    let rad = |values: &[f64]| values.iter().map(|it| radians(*it)).collect::<Vec<f64>>();
    let rows = theta_deg.len();
    Trace {
        time_s: (0..rows).map(|k| timing().time_s(k)).collect(),
        setpoint_rad: rad(setpoint_deg),
        theta_rad: rad(theta_deg),
        q_rad_s: vec![0.0; rows],
        command_rad: (0..rows).map(|k| radians(3.0 - k as f64)).collect(),
        elevator_rad: (0..rows).map(|k| radians(if k % 2 == 0 { 0.0 } else { 2.0 })).collect(),
        gains: vec![Gains { kp: 1.0, ki: 0.0, kd: 0.0 }; rows],
        autopilot_limited: Vec::new(),
        columns: Vec::new(),
        exit: None,
        outcome: Outcome::Completed,
        saturated_samples: 2,
        faults: Faults::NONE,
    }
}

fn edge(sample: usize, from_deg: f64, to_deg: f64) -> Edge {
    Edge { sample, from_rad: radians(from_deg), to_rad: radians(to_deg) }
}

/// A flight and what the metrics make of it.
struct Whole(Trace, FlightMetrics);

impl Whole {
    fn of(setpoint_deg: &[f64], theta_deg: &[f64], edges: &[Edge]) -> Self {
        let trace = trace(setpoint_deg, theta_deg);
        let metrics = FlightMetrics::of(&trace, edges, timing(), None, &[]);
        Self(trace, metrics)
    }

    /// Held at zero, with these errors, deg.
    fn with_errors(errors_deg: [f64; 11]) -> Self {
        Self::of(&[0.0; 11], &errors_deg.map(|error| -error), &[])
    }

    fn flown(&self) -> Flown<'_> {
        Flown { trace: &self.0, metrics: &self.1, timing: timing() }
    }
}

/// Up by 2 deg at 0.2 s, down by 1 deg at 0.6 s.
fn two_steps() -> Whole {
    let setpoint = [0.0, 0.0, 2.0, 2.0, 2.0, 2.0, 1.0, 1.0, 1.0, 1.0, 1.0];
    let theta = [0.0, 0.0, 0.0, 1.0, 2.5, 1.75, 1.5, 1.25, 1.0, 0.5, 0.75];
    Whole::of(&setpoint, &theta, &[edge(2, 0.0, 2.0), edge(6, 2.0, 1.0)])
}

fn requirement(measure: Measure, conditions: Conditions) -> Requirement {
    Requirement {
        id: "x".to_owned(),
        controller: None,
        measure,
        least: None,
        most: Some(1.0),
        conditions,
        origin: Origin::default(),
        cases: AskedIn::default(),
    }
}

fn from_to(from_s: Option<f64>, to_s: Option<f64>) -> Conditions {
    Conditions { from_s, to_s, ..Conditions::default() }
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-12, "{found} and not {expected}");
}

#[test]
fn the_time_that_counts_has_the_samples_from_its_start_to_its_end_and_both() {
    let time = |from_s, to_s| time_that_counts(timing(), 11, &from_to(from_s, to_s));
    assert_eq!(time(None, None), Ok(0..=10));
    assert_eq!(time(Some(0.3), Some(0.6)), Ok(3..=6));
    assert_eq!(time(Some(0.25), Some(0.65)), Ok(3..=6));
    // A rounding before a sample is on it; more than that is before it.
    assert_eq!(time(Some(0.3), Some(0.6 - 1e-9)), Ok(3..=6));
    assert_eq!(time(Some(0.3), Some(0.6 - 5e-6)), Ok(3..=5));
    assert_eq!(time(Some(1.0), Some(1.0)), Ok(10..=10));
    assert_eq!(time(None, Some(0.0)), Ok(0..=0));
}

#[test]
fn a_time_that_was_not_flown_is_told_and_not_judged() {
    let refused = |from_s: Option<f64>, to_s: Option<f64>, rows| {
        let told = NotEvaluated::NotFlown {
            from_s: from_s.unwrap_or(0.0),
            to_s: to_s.unwrap_or(1.0),
            end_s: 1.0,
        };
        assert_eq!(time_that_counts(timing(), rows, &from_to(from_s, to_s)), Err(told));
    };
    refused(None, Some(1.1), 11);
    refused(None, Some(1.05), 11);
    refused(Some(1.1), None, 11);
    refused(Some(0.6), Some(0.5), 11);
    // Between two samples there is none.
    refused(Some(0.62), Some(0.68), 11);
    // The flight was lost after five samples.
    refused(None, Some(0.6), 5);
    refused(None, Some(0.5), 5);
    refused(Some(0.5), None, 5);
    assert_eq!(time_that_counts(timing(), 5, &from_to(None, Some(0.4))), Ok(0..=4));
    assert_eq!(time_that_counts(timing(), 5, &from_to(None, None)), Ok(0..=4));
}

#[test]
fn a_recovery_ends_where_the_error_comes_into_its_band_for_good_by_a_straight_line() {
    let flight = Whole::with_errors([0.0; 11]);
    let place = CasePlace { at_s: Some(0.5), ..CasePlace::default() };
    let recovered = |errors: &[f64]| flight.flown().recovered(errors, 0.6, None, place);
    let time = |errors: &[f64]| {
        let case = recovered(errors).expect("recovered");
        assert_eq!(case.place, place);
        case.value
    };
    near(time(&[2.0, 1.0, 0.5, -0.2]), 0.18);
    near(time(&[-2.0, -1.0, 0.5]), 0.1 * (1.0 + 0.4 / 1.5));
    // Outside again after it was inside.
    near(time(&[2.0, 0.0, -1.0, -0.2]), 0.25);
    near(time(&[1.0, 0.6, 0.6]), 0.1);
    assert_eq!(time(&[0.6, -0.6, 0.0]), 0.0);
    assert_eq!(time(&[]), 0.0);
    assert!(time(&[f64::NAN, 0.1]).is_nan(), "met by no limit");
    for errors in [&[0.0, 0.1, 0.7][..], &[0.0, 0.0, f64::NAN], &[0.0, 0.0, -0.7]] {
        let told =
            NotEvaluated::NotRecovered { within_deg: 0.6, window_s: 0.2, place: Box::new(place) };
        assert_eq!(recovered(errors), Err(told), "{errors:?}");
    }
}

#[test]
fn a_recovery_is_asked_of_each_step_or_from_a_time_on() {
    let flight = two_steps();
    let recovery = |conditions: Conditions| {
        let cases = flight.flown().recovery(&conditions, None).expect("recovered");
        cases.into_iter().map(|case| (case.value, case.place)).collect::<Vec<_>>()
    };
    let found = recovery(Conditions { within_deg: Some(0.4), ..Conditions::default() });
    // Errors of the first step 2, 1, -0.5, 0.25; of the second -0.5, -0.25, 0, 0.5, 0.25.
    near(found[0].0, 0.1 * (2.0 + 0.1 / 0.75));
    near(found[1].0, 0.1 * (3.0 + 0.1 / 0.25));
    let steps: Vec<_> = found.iter().filter_map(|(_, place)| place.step).collect();
    assert_eq!(steps.iter().map(|step| step.number).collect::<Vec<_>>(), [1, 2]);
    near(steps[0].at_s, 0.2);
    near(steps[1].to_deg, 1.0);
    let later = Conditions { within_deg: Some(0.4), from_s: Some(0.9), ..Conditions::default() };
    let found = recovery(later);
    assert_eq!((found.len(), found[0].1.at_s, found[0].1.step), (1, Some(0.9), None));
    near(found[0].0, 0.04);
    let band_of_nothing = flight.flown().recovery(&Conditions::default(), None);
    assert!(matches!(band_of_nothing, Err(NotEvaluated::NotRecovered { .. })));
}

#[test]
fn what_is_left_of_a_step_is_left_at_the_last_sample_before_the_next() {
    let flight = two_steps();
    let left = |conditions: Conditions| {
        let asked = requirement(Measure::FinalErrorAngle, conditions);
        let cases = flight.flown().final_errors(&asked).expect("there are steps");
        cases.into_iter().map(|case| case.value).collect::<Vec<_>>()
    };
    let found = left(Conditions::default());
    near(found[0], 0.25);
    near(found[1], 0.25);
    let down = left(Conditions { step_deg: Some(1.0), ..Conditions::default() });
    assert_eq!(down.len(), 1);
    near(down[0], 0.25);
    assert_eq!(flight.flown().window(&flight.1.edges[0]), 2..=5);
    assert_eq!(flight.flown().window(&flight.1.edges[1]), 6..=10);
}

#[test]
fn what_is_left_of_a_command_that_never_moves_is_left_at_the_end() {
    let mut errors = [0.5; 11];
    errors[10] = -0.3;
    let flight = Whole::with_errors(errors);
    let of = |conditions| requirement(Measure::FinalErrorAngle, conditions);
    let found = flight.flown().final_errors(&of(Conditions::default())).expect("held");
    near(found[0].value, 0.3);
    assert_eq!((found.len(), found[0].place.at_s), (1, Some(1.0)));
    // A step that is asked for is not there.
    let asked = Conditions { step_deg: Some(2.0), ..Conditions::default() };
    let none = NotEvaluated::NoStepOf { asked_deg: 2.0, found_deg: Vec::new() };
    assert_eq!(flight.flown().final_errors(&of(asked)), Err(none));
    let recovery = flight.flown().recovery(&Conditions::default(), None);
    assert_eq!(recovery, Err(NotEvaluated::Absent(Absent::NoStep)));
}

#[test]
fn steps_of_another_size_are_told_by_their_sizes() {
    let flight = two_steps();
    let asked = Conditions { step_deg: Some(3.0), ..Conditions::default() };
    match flight.flown().counted(&asked) {
        Err(NotEvaluated::NoStepOf { asked_deg, found_deg }) => {
            assert_eq!(asked_deg, 3.0);
            near(found_deg[0], 2.0);
            near(found_deg[1], -1.0);
        }
        other => panic!("{other:?}"),
    }
    let found = flight.flown().steps(&requirement(Measure::Overshoot, Conditions::default()));
    let found = found.expect("measured");
    near(found[0].value, 25.0);
    // Down to 0.5 deg from 2 deg, where 1 deg is asked.
    near(found[1].value, 50.0);
    assert_eq!(found[1].place.step.map(|step| step.number), Some(2));
}

#[test]
fn the_largest_error_is_the_first_of_its_size_and_stays_one_that_is_no_number() {
    let flight = Whole::with_errors([9.0, 0.0, 3.0, 0.0, -4.0, 4.0, 0.0, 0.0, 0.0, 0.0, -8.0]);
    let of = |measure, from_s, to_s| {
        flight.flown().whole(&requirement(measure, from_to(from_s, to_s))).expect("a value")
    };
    near(of(Measure::RmsError, Some(0.1), Some(0.4)).value, (25.0_f64 / 4.0).sqrt());
    let largest = of(Measure::LargestError, Some(0.1), Some(0.9));
    near(largest.value, 4.0);
    assert_eq!(largest.place.at_s, Some(timing().time_s(4)));
    near(of(Measure::LargestError, None, None).value, 9.0);
    near(of(Measure::LargestError, Some(0.6), None).value, 8.0);
    let nothing = of(Measure::LargestError, Some(0.6), Some(0.9));
    assert_eq!((nothing.value, nothing.place), (0.0, CasePlace::default()));
    let in_parts = |it: &Measure| it.family() == Family::Flight && it.takes("from_s");
    for measure in Measure::ALL.into_iter().filter(in_parts) {
        let [part, whole] = [Some(0.1), None].map(|from_s| of(measure, from_s, None).value);
        assert!(part < whole, "{} is that of the part: {part} {whole}", measure.name());
    }
    let mut errors = [1.0; 11];
    errors[3] = f64::NAN;
    let lost = Whole::with_errors(errors);
    let largest = lost.flown().largest_error(0..=5);
    assert!(largest.value.is_nan(), "met by no limit");
    assert_eq!(largest.place.at_s, Some(timing().time_s(3)), "whatever comes after it");
}

#[test]
fn command_and_elevator_are_measured_each_by_itself() {
    let flight = Whole::with_errors([2.0; 11]);
    let value = |measure| {
        let case = flight.flown().whole(&requirement(measure, Conditions::default()));
        let case = case.expect("a value");
        assert_eq!(case.place, CasePlace::default());
        case.value
    };
    near(value(Measure::CommandVariation), 10.0);
    near(value(Measure::LargestCommand), 7.0);
    assert!((value(Measure::CommandRate) - 10.0).abs() < 1e-9);
    near(value(Measure::ElevatorTravel), 20.0);
    assert!((value(Measure::ElevatorRate) - 20.0).abs() < 1e-9);
    near(value(Measure::Saturated), 200.0 / 11.0);
    assert!(value(Measure::ErrorIntegral) > 0.0);
    assert!(value(Measure::TimedErrorIntegral) != value(Measure::ErrorIntegral));
}

/// Two samples of a climb through a level were a level that is held.
#[test]
fn an_altitude_that_is_held_is_seen_for_a_tenth_of_the_time_before_it() {
    let flight = Whole::with_errors([0.0; 11]);
    let asked = |from_s, to_s| flight.flown().is_seen_to_stay(&from_to(from_s, to_s));
    let little = |from_s| Err(NotEvaluated::LittleFlown { from_s, end_s: 1.0 });
    assert_eq!(asked(None, None), Ok(()));
    assert_eq!(asked(Some(0.9), None), Ok(()));
    assert_eq!(asked(Some(1.0 / 1.1), None), Ok(()));
    assert_eq!(asked(Some(0.92), None), little(0.92));
    let why = little(0.98).expect_err("a reason").to_string();
    assert!(why.contains("from 0.98 s on only 0.02 s were flown"), "{why}");
    assert_eq!(asked(Some(0.98), Some(1.0)), Ok(()));
}

/// The last sample of a swing is within any limit by chance.
#[test]
fn an_error_that_is_left_is_seen_over_the_last_tenth_of_its_time() {
    let mut errors = [0.5; 11];
    (errors[9], errors[10]) = (-1.5, 0.1);
    let flight = Whole::with_errors(errors);
    let asked = requirement(Measure::FinalErrorAngle, Conditions::default());
    match flight.flown().final_errors(&asked) {
        Err(NotEvaluated::NotLeft { largest, unit, window_s, .. }) => {
            near(largest, 1.5);
            near(window_s, 1.0);
            assert_eq!(unit, "deg");
        }
        other => panic!("{other:?}"),
    }
    let mut wide = asked.clone();
    wide.most = Some(1.6);
    near(flight.flown().final_errors(&wide).expect("seen")[0].value, 0.1);
    // What is not met at the last sample is told as it is.
    errors[10] = 2.0;
    let lost = Whole::with_errors(errors);
    near(lost.flown().final_errors(&asked).expect("seen")[0].value, 2.0);
    // The same of a step, in per cent of it.
    let theta = [0.0, 0.0, 0.5, 1.0, 2.0, 2.0, 2.0, 2.0, 2.0, 1.8, 2.0];
    let flight = Whole::of(&[2.0; 11], &theta, &[edge(0, 0.0, 2.0)]);
    let mut asked = requirement(Measure::FinalError, Conditions::default());
    assert!(matches!(flight.flown().steps(&asked), Err(NotEvaluated::NotLeft { .. })));
    asked.most = Some(10.1);
    near(flight.flown().steps(&asked).expect("seen")[0].value, 0.0);
}

/// A response of 0.68 s that is 3 % beyond its set-point, on its way to 39 %, had an overshoot of 3 %.
#[test]
fn an_overshoot_is_told_when_its_peak_is_seen() {
    let told = |theta: [f64; 11], most| {
        let flight = Whole::of(&[2.0; 11], &theta, &[edge(0, 0.0, 2.0)]);
        let mut asked = requirement(Measure::Overshoot, Conditions::default());
        asked.most = most;
        flight.flown().steps(&asked).map(|cases| cases[0].value)
    };
    let rising = [0.0, 0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.3, 1.6, 1.9, 2.1];
    assert!(matches!(told(rising, Some(5.5)), Err(NotEvaluated::StillRising { .. })));
    // Short of its set-point, too.
    let before = rising.map(|theta| 0.92 * theta);
    assert!(matches!(told(before, Some(5.0)), Err(NotEvaluated::StillRising { .. })));
    // More than is allowed is told as it is.
    near(told(rising, Some(4.0)).expect("told"), 5.0);
    let seen = [0.0, 0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.3, 1.9, 2.1, 2.0];
    near(told(seen, Some(6.0)).expect("told"), 5.0);
    // So slow that for another second it stays within 5 %, and within 2 % that it does not.
    let slow = [0.0, 0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.3, 1.8, 2.06, 2.061];
    near(told(slow, Some(5.0)).expect("told"), 3.05);
    assert!(matches!(told(slow, Some(3.1)), Err(NotEvaluated::StillRising { .. })));
    // Another step ends the first one as it is commanded.
    let steps = [edge(0, 0.0, 2.0), edge(9, 2.0, 0.0)];
    let flight = Whole::of(&[2.0; 11], &before, &steps);
    let asked = requirement(Measure::Overshoot, Conditions::default());
    let first = flight.flown().steps(&asked);
    assert!(!matches!(first, Err(NotEvaluated::StillRising { .. })), "{first:?}");
}

/// What had settled within 2 % was taken to go no further, and a swing after the first to be no larger.
#[test]
fn an_overshoot_that_still_grows_is_told_where_it_stays_within_its_limit() {
    let told = |ways: [f64; 11], most| {
        let flight = Whole::of(&[2.0; 11], &ways.map(|way| 2.0 * way), &[edge(0, 0.0, 2.0)]);
        let mut asked = requirement(Measure::Overshoot, Conditions::default());
        asked.most = most;
        let found = flight.flown().steps(&asked).map(|cases| cases[0].value);
        assert!(matches!(found, Ok(_) | Err(NotEvaluated::StillRising { .. })), "{found:?}");
        found.ok()
    };
    // To 4 % beyond, each sample with a share of what is left.
    let creeping = |left: f64| core::array::from_fn(|k| 1.04 * (1.0 - left.powi(k as i32)));
    // It is 1 % beyond: in the band of its step, and seen to stay there for two tenths of the time.
    assert_eq!(told(creeping(0.7), Some(2.5)), None);
    assert!(told(creeping(0.7), Some(5.0)).is_some_and(|pct| (1.0..1.1).contains(&pct)));
    assert_eq!(told(creeping(0.7), None), None, "4 % are more than 2 % beyond what was seen");
    assert!(told(creeping(0.5), None).is_some());
    assert!(told(creeping(0.5), Some(4.1)).is_some());
    // In its second swing, which has come up to 30 % beyond where the first had 40 %.
    let swing = [0.0, 0.9, 1.3, 1.4, 1.3, 1.0, 0.7, 0.6, 0.7, 1.0, 1.3];
    assert_eq!(told(swing, Some(45.0)), None);
    let falling = [0.0, 0.4, 0.9, 1.3, 1.4, 1.4, 1.3, 1.2, 1.0, 0.7, 0.6];
    assert_eq!(told(falling, Some(45.0)).map(f64::round), Some(40.0));
}

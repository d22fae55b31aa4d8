//! Flights that come down to the ground, and flights beyond the range of their aircraft's data.

use fspid_scenario::file;
use fspid_sim::{EarlyEnd, EndCause, Outcome};
use fspid_study::metrics::{Absent, Verdict};
use fspid_study::report;
use fspid_study::simulation::Simulation;

use crate::flying::{NAVION, column, study};

/// 300 ft, a step of -10 deg: down after some 12 s.
const DOWN: [&str; 4] = [
    "aircraft.altitude_ft=300.0",
    "setpoint.amplitude_deg=-10.0",
    "setpoint.at_s=1.0",
    "loop.duration_s=60.0",
];

fn flown(text: &str, set: &[&str]) -> Simulation {
    Simulation::of(&study(text, set)).expect("it flies")
}

/// It used to fly on to -276 m and to be called settled.
#[test]
fn a_flight_ends_where_the_aircraft_touches_the_ground() {
    let simulation = flown(NAVION, &DOWN);
    let result = &simulation.results[0];
    let Outcome::EndedEarly(end) = result.trace.outcome else {
        panic!("{:?}", result.trace.outcome)
    };
    let EarlyEnd { at_s, cause } = end;
    assert_eq!(cause, EndCause::HitGround);
    let altitudes = column(&result.trace, "altitude_m");
    assert!(altitudes.iter().all(|altitude| *altitude > 0.0));
    assert!(altitudes[altitudes.len() - 1] < 0.5, "the last sample is just above");
    assert!((at_s - 0.01 * altitudes.len() as f64).abs() < 1e-9, "{at_s}");
    assert_eq!(result.metrics.verdict, Verdict::EndedEarly(end));
    assert_eq!(result.metrics.effort, Err(Absent::EndedEarly(end)));
    assert_eq!(result.metrics.first_step().overshoot_pct, Err(Absent::EndedEarly(end)));
    let sentence = result.metrics.verdict.to_string();
    assert!(sentence.starts_with("hit the ground at t = 1"), "{sentence}");
    assert!(simulation.text().contains(&sentence), "{}", simulation.text());
    assert_eq!(simulation.json()["controllers"][0]["verdict"], sentence.as_str());
    let page = report::of_simulation(&study(NAVION, &DOWN), &simulation);
    assert!(page.contains("HIT THE GROUND") && !page.contains("Settled"));
}

/// The page used to say that the lines of such a flight leave the panels.
#[test]
fn the_page_of_a_flight_into_the_ground_says_that_its_lines_end() {
    let simulation = flown(NAVION, &DOWN);
    let page = report::of_simulation(&study(NAVION, &DOWN), &simulation);
    assert!(page.contains("the flight ended before its time, and so do its lines"));
    assert!(!page.contains("lines leave the panels"));
    // The aircraft is no plant that says something of itself.
    assert!(!page.contains("plant.preset"));
}

#[test]
fn the_ground_is_where_the_file_has_it() {
    let deep = [&DOWN[..], &["aircraft.ground_m=-5000.0"]].concat();
    assert_eq!(flown(NAVION, &deep).results[0].trace.outcome, Outcome::Completed);
    let high = [&DOWN[..], &["aircraft.ground_m=60.0"]].concat();
    let sooner = flown(NAVION, &high).results[0].trace.rows();
    assert!(sooner < flown(NAVION, &DOWN).results[0].trace.rows());
}

/// Such a flight passed every requirement of the loop alone.
#[test]
fn requirements_that_the_loop_meets_do_not_save_a_flight_into_the_ground() {
    let text = format!("{NAVION}\n[[requirement]]\nmeasure = \"gain_margin_db\"\nleast = 1.0\n");
    let simulation = flown(&text, &DOWN);
    assert!(simulation.judgements[0].met && !simulation.requirements_met());
    assert!(simulation.text().contains("FAILED FLIGHT: PID: hit the ground"));
    assert!(flown(&text, &[]).requirements_met());
}

#[test]
fn a_nonlinear_flight_that_begins_at_the_ground_is_refused_and_a_linear_one_is_not() {
    let refused = |set: &[&str]| {
        let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
        file::parse(NAVION, "test.toml", None, &set).expect_err("no flight").to_string()
    };
    let told = refused(&["aircraft.altitude_ft=0.0"]);
    assert!(told.contains("the flight begins at the ground"), "{told}");
    assert!(told.contains("aircraft.altitude_ft") && told.contains("a lower `ground_m`"), "{told}");
    study(NAVION, &["aircraft.altitude_ft=0.0", "aircraft.model=linear"]);
    study(NAVION, &["aircraft.altitude_ft=0.0", "aircraft.ground_m=-1000.0"]);
}

#[test]
fn a_linear_flight_says_that_it_has_no_height() {
    let linear = flown(NAVION, &["aircraft.model=linear"]);
    let note = linear.json()["notes"][0].to_string();
    assert!(note.contains("neither the ground nor the limits"), "{note}");
    let text = linear.text();
    assert!(text.contains("neither the ground nor the limits of the aircraft's data are asked"));
    assert!(!flown(NAVION, &[]).text().contains("no height"));
}

/// It used to be a warning beside "settled" and to meet everything.
#[test]
fn leaving_the_range_of_the_data_fails_unless_the_scenario_allows_it() {
    let text = format!("{NAVION}\n[[requirement]]\nmeasure = \"stable\"\n");
    let far = ["setpoint.amplitude_deg=25.0", "loop.duration_s=40.0"];
    let simulation = flown(&text, &far);
    let exit = simulation.results[0].trace.exit.expect("too slow or too steep");
    let rows = simulation.results[0].trace.rows() as f64;
    assert!(exit.outside_s > 1.0 && exit.outside_s < 0.01 * rows, "{exit:?}");
    assert!((exit.outside_s - 0.01 * exit.samples as f64).abs() < 1e-12);
    assert!(simulation.judgements[0].met && !simulation.requirements_met());
    let sentence = format!("outside for {:.2} s", exit.outside_s);
    assert!(simulation.text().contains(&sentence), "{}", simulation.text());
    assert!(simulation.text().contains("FAILED FLIGHT: PID: left the range"));
    // It used to be "settled" in text, page and JSON beside the failure.
    let json = &simulation.json()["controllers"][0];
    assert_eq!(json["outcome"]["kind"], "left the range");
    assert_eq!((&json["failed"], &json["outcome"]["at_s"]), (&true.into(), &exit.at_s.into()));
    let page = report::of_simulation(&study(&text, &far), &simulation);
    assert!(page.contains("LEFT THE RANGE OF ITS DATA") && !page.contains("Settled"));
    assert!(!simulation.text().contains("PID         settled"), "{}", simulation.text());
    let allowed = flown(&text, &[&far[..], &["aircraft.validity=warn"]].concat());
    assert!(allowed.requirements_met());
    assert!(allowed.text().contains("note: left the range"), "{}", allowed.text());
    assert!(allowed.text().contains(&sentence));
}

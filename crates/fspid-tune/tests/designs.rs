//! The learned designs that are shipped: what their README claims, flown again by a contest.

use std::path::Path;

use fspid_tune::contest::{Contest, Options, Then};
use fspid_tune::{Crew, Source};
use serde_json::Value;

/// The contest that a design holds, as its JSON answer.
fn held(name: &str) -> Value {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/designs/learned");
    let source = Source { path: folder.join(format!("{name}.toml")), overrides: Vec::new() };
    let contest = Contest::new(&source, &Options::default());
    let contest = contest.unwrap_or_else(|error| panic!("{error}"));
    let out = tempfile::tempdir().expect("a folder");
    let outcome = contest.hold(out.path(), Crew::UNSTOPPED, &mut |_| Then::GoOn);
    outcome.unwrap_or_else(|error| panic!("{error}")).json()
}

fn controller<'a>(answer: &'a Value, name: &str) -> &'a Value {
    let controllers = answer["controllers"].as_array().expect("a list");
    controllers.iter().find(|entry| entry["name"] == name).expect("it flies")
}

fn median(answer: &Value, name: &str, measure: &str) -> f64 {
    controller(answer, name)["measures"][measure]["median"].as_f64().expect("a number")
}

/// IAE and elevator travel of the self-tuning PID over those of the PID.
fn ratios(answer: &Value) -> [f64; 2] {
    ["iae_deg_s", "elevator_travel_deg"]
        .map(|measure| median(answer, "FSPID", measure) / median(answer, "PID", measure))
}

/// Flights of a controller that break a requirement.
fn failed(answer: &Value, name: &str) -> u64 {
    controller(answer, name)["flights"]["failed"].as_u64().expect("a count")
}

/// Holds the contest of a design: error and travel of the self-tuning PID over those of the PID at most these, the
/// self-tuner first, and so many flights of it and of the PID fail.
fn is_first(name: &str, most: [f64; 2], fail: [u64; 2]) {
    let answer = held(name);
    let ratios = ratios(&answer);
    assert!(ratios[0] <= most[0] && ratios[1] <= most[1], "{ratios:?}");
    assert_eq!(answer["ranking"][0], "FSPID", "{:#}", answer["ranking"]);
    assert_eq!([failed(&answer, "FSPID"), failed(&answer, "PID")], fail);
}

#[test]
fn the_transport_flies_with_a_tenth_less_error_within_a_tenth_more_travel_where_it_was_not_tuned() {
    let answer = held("transport");
    let [error, travel] = ratios(&answer);
    assert!(error <= 0.90 && travel <= 1.10, "{error} {travel}");
    assert_eq!(answer["ranking"][0], "FSPID", "{:#}", answer["ranking"]);
}

#[test]
fn the_light_aircraft_flies_with_a_tenth_less_error_and_is_mostly_undecided_at_rest() {
    is_first("light", [0.90, 1.05], [39, 0]);
}

#[test]
fn the_self_tuner_of_six_light_aircraft_has_a_tenth_less_error_at_less_travel_and_is_mostly_undecided_at_rest()
 {
    is_first("light-six", [0.90, 1.0], [61, 5]);
}

/// It overshoots in all steps of 1 deg and doublets, which nobody was tuned on, so that it does not win.
#[test]
fn the_self_tuner_of_six_small_unmanned_aircraft_has_a_fifth_less_error_and_is_mostly_undecided_at_rest()
 {
    is_first("uav-six", [0.80, 0.95], [66, 2]);
}

#[test]
fn the_self_tuner_of_small_unmanned_aircraft_for_every_command_has_a_third_less_error_at_less_travel()
 {
    is_first("uav-commands", [0.64, 1.0], [5, 4]);
}

#[test]
fn the_self_tuner_of_transports_for_every_command_has_less_than_0_85_of_the_error_and_is_mostly_undecided_at_rest()
 {
    is_first("transport-commands", [0.82, 1.03], [72, 2]);
}

#[test]
fn the_proved_self_tuner_of_small_unmanned_aircraft_has_a_quarter_less_error_at_less_travel() {
    is_first("uav-steps", [0.77, 0.98], [2, 3]);
}

#[test]
fn the_proved_self_tuner_of_transports_has_less_error_at_the_travel_of_the_pid_and_keeps_the_margins()
 {
    is_first("transport-steps", [0.87, 1.0], [1, 7]);
}

#[test]
fn the_proved_self_tuner_of_light_aircraft_has_0_85_of_the_error_at_less_travel_and_breaks_nothing()
{
    is_first("light-steps", [0.85, 0.98], [0, 0]);
}

#[test]
fn the_proved_network_of_light_aircraft_has_less_than_0_85_of_the_error_at_less_travel() {
    is_first("light-network", [0.85, 0.97], [1, 1]);
}

#[test]
fn the_proved_network_of_small_unmanned_aircraft_has_a_quarter_less_error_at_less_travel() {
    is_first("uav-network", [0.77, 0.94], [2, 1]);
}

/// Proved where the law may go. Of one doublet the flight ends before the overshoot of its last 4 s is seen (E-99); the PID does
/// not come there in them.
#[test]
fn the_damped_self_tuner_of_transports_has_a_fifth_less_error_at_less_travel_and_breaks_nothing_that_the_pid_keeps()
 {
    is_first("transport-damped", [0.81, 0.99], [0, 5]);
}

//! A loop that is proved is not called so where its flight does not hold.

use fspid_aircraft::AirMotion;
use fspid_certify::{Certification, Effort};
use fspid_scenario::file::{self, Study};
use fspid_sim::Plant;

/// A Navion whose altitude is held by a self-tuner, and is to be a hair higher.
const HOLD: &str = include_str!("../../fspid-study/tests/data/altitude-hold.toml");

/// A quiet flight of the Navion at its reference speed.
const NAVION: &str = include_str!("../../fspid-study/tests/data/navion.toml");

fn study(text: &str, set: &[&str]) -> Study {
    let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
    file::parse(text, "test.toml", None, &set).unwrap_or_else(|problems| panic!("{problems}"))
}

fn certified(study: &Study) -> Certification {
    Certification::of(study, None, &Effort::default()).expect("asked")
}

/// Gains of the outer loop move with its error and multiply what it holds: of two set-point weights one mode grows, and of the
/// other one side of the rules alone would.
#[test]
fn a_proof_beside_an_outer_loop_whose_gains_move_names_the_mode_that_is_not_held() {
    for (weight, word) in [("0.7", "UNSTABLE"), ("0.9", "UNDECIDED")] {
        let weight = format!("outer_loop[0].setpoint_weights.proportional={weight}");
        let text = certified(&study(HOLD, &[&weight])).text();
        assert!(text.contains(&format!("{word} with the outer loops of modes level")), "{text}");
    }
}

/// A row of Mach numbers at the Mach number of the trim, where no linear model is that of small motions.
#[test]
fn a_trim_right_on_a_kink_of_the_aircrafts_data_is_not_proved_and_one_beside_it_is() {
    let Plant::Aircraft(plant) = study(NAVION, &[]).scenario.plant else {
        panic!("it flies nonlinear")
    };
    let mach = plant.aircraft().flow(&plant.trim().state, &AirMotion::STILL).mach();
    let is_proved = |by: f64| {
        let at = |beyond: f64, drag: f64| {
            format!("{{mach={:?}, drag={{reference={drag}}}}}", mach * (1.0 + by) + beyond)
        };
        let [below, here, above] = [at(-0.05, 0.049), at(0.0, 0.051), at(0.05, 0.09)];
        let rows = format!("aircraft.name.mach_row=[{below}, {here}, {above}]");
        certified(&study(NAVION, &[&rows, "aircraft.validity=warn"])).all_proved()
    };
    assert!(!is_proved(0.0) && is_proved(1e-4));
}

/// An aircraft whose elevator sign is turned, with gains that are turned with it, as a first answer to "is elevator_sign
/// right?" leads to.
const TURNED: &str = r#"
schema = 1
name = "turned twice"
[plant]
numerator = [-36.11]
denominator = [1.0, 5.3, 24.7]
elevator_sign = "nose-up-positive"
[loop]
sample_period_s = 0.01
duration_s = 10.0
[setpoint]
kind = "step"
amplitude_deg = 5.0
at_s = 0.0
[[controller]]
name = "PID"
kind = "pid"
kp = -1.5
ki = -0.5
kd = -0.15
derivative_filter_s = 0.02
"#;

/// It was PROVED without a word, and is reversed on the aircraft.
#[test]
fn a_proof_of_a_loop_with_negative_gains_says_that_they_are_negative() {
    let text = certified(&study(TURNED, &[])).text();
    assert!(text.contains("PROVED: stable"), "{text}");
    let told = "kp is negative, and here a positive command turns the nose up whatever the elevator does, so gains are positive (kp = 1.5): proved is the loop with elevator_sign as it is written";
    assert!(text.contains(told), "{text}");
    let right = [
        "plant.elevator_sign=nose-down-positive",
        "controller.PID.kp=1.5",
        "controller.PID.ki=0.5",
        "controller.PID.kd=0.15",
    ];
    let text = certified(&study(TURNED, &right)).text();
    assert!(text.contains("PROVED: stable") && !text.contains("is negative"), "{text}");
}

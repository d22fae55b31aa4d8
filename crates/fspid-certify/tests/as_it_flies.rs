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

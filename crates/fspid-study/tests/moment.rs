//! One sample of a flight, taken apart.

use fspid_scenario::file::{self, Study};
use fspid_study::moment::{Moment, NoMoment, set_curves, visits};
use fspid_study::simulation::Simulation;

/// Every scenario that is shipped and names no file.
fn shipped() -> Vec<Study> {
    let starters = file::STARTERS.iter().map(|it| it.text);
    let paper = fspid_data::PAPER.iter().map(|(_, text)| *text);
    starters.chain(paper).filter_map(|text| file::parse(text, "shipped", None, &[]).ok()).collect()
}

fn names(study: &Study) -> Vec<String> {
    study.scenario.controllers.iter().map(|named| named.name.clone()).collect()
}

#[test]
fn the_parts_of_a_command_are_the_command_to_the_bit() {
    let mut asked = 0;
    for study in shipped() {
        for name in names(&study) {
            for at_s in [0.0, 0.37, 2.0] {
                let Ok(moment) = Moment::of(&study, &name, at_s) else { continue };
                let parts = moment.parts;
                let sum = parts.proportional_rad + parts.integral_rad + parts.derivative_rad
                    - parts.rate_rad
                    + parts.fed_forward_rad;
                assert_eq!(sum.to_bits(), moment.free_rad.to_bits(), "{name} at {at_s} s");
                asked += 1;
            }
        }
    }
    assert!(asked > 60, "{asked}");
}

#[test]
fn a_moment_is_a_row_of_the_flight_and_its_rules_add_up_to_what_moved_the_gains() {
    for study in shipped().into_iter().take(8) {
        let simulation = Simulation::of(&study).expect("flown");
        for name in names(&study) {
            let trace = &simulation.result(&name).expect("flown").trace;
            let k = trace.rows().min(80) - 1;
            let moment = Moment::of(&study, &name, trace.time_s[k]).expect("a sample");
            let [found, flown] = [moment.step.command_rad, trace.command_rad[k]].map(f64::to_bits);
            assert_eq!(found, flown, "{name}");
            assert_eq!(moment.step.gains, trace.gains[k], "{name}");
            let Some(fuzzy) = moment.fuzzy else { continue };
            let share = |gain: usize| -> f64 {
                let added = fuzzy.rules.iter().filter_map(|rule| rule.added[gain].as_ref()?.added);
                added.sum()
            };
            let found = fuzzy.increments;
            for (gain, whole) in [found.kp, found.ki, found.kd].into_iter().enumerate() {
                // Areas of pieces that are added up, against one centroid in closed form.
                let close = 1e-9 * (1.0 + whole.abs());
                assert!(
                    (share(gain) - whole).abs() <= close,
                    "{name}: {} for {whole}",
                    share(gain)
                );
            }
        }
    }
}

#[test]
fn a_network_has_a_moment_without_rules_and_adds_what_moved_the_gains() {
    let rows = ["error", "change", "offset", "delta_kp", "delta_ki", "delta_kd"];
    let rows = rows.map(|row| format!("{row} = [0.5, -1, 0.25, 2, 0.1, 0.3, -0.7, 1]"));
    let network = format!("network = {{ {} }} #", rows.join(", "));
    let text = file::starter().replace("table = \"mirrored\" ", &network);
    let study = file::parse(&text, "network", None, &[]).expect("good");
    let moment = Moment::of(&study, "FSPID", 0.3).expect("a sample");
    let fuzzy = moment.fuzzy.as_ref().expect("a supervisor");
    assert!(fuzzy.rules.is_empty() && fuzzy.increments.kp != 0.0, "{fuzzy:?}");
    let moved = moment.step.gains.kp - moment.nominal.kp;
    assert!((moved - fuzzy.increments.kp).abs() < 1e-12, "{moved} {fuzzy:?}");
    assert_eq!(moment.json()["supervisor"]["rules"], serde_json::json!([]));
    // No rule is ever the strongest.
    assert_eq!(visits(&study, "FSPID"), [[0; 7]; 7]);
}

#[test]
fn a_time_behind_the_end_and_an_unknown_name_have_no_moment() {
    let study = file::parse(file::starter(), "starter", None, &[]).expect("good");
    assert!(matches!(Moment::of(&study, "nobody", 0.0), Err(NoMoment::NoController(_))));
    let last =
        Moment::of(&study, "PID", 1e9).expect("the last sample stands for all times behind it");
    assert!((last.at_s - 10.0).abs() < 0.02, "{}", last.at_s);
}

#[test]
fn every_sample_of_a_flight_has_one_strongest_rule_and_every_set_a_peak() {
    let study = file::parse(file::starter(), "starter", None, &[]).expect("good");
    let counts = visits(&study, "FSPID");
    let rows = Simulation::of(&study).expect("flown").results[0].trace.rows();
    assert_eq!(counts.as_flattened().iter().sum::<u32>() as usize, rows);
    assert_eq!(visits(&study, "PID").as_flattened().iter().sum::<u32>(), 0);
    let fspid_sim::Controller::SelfTuning(fspid) = &study.scenario.controllers[1].controller else {
        panic!("the second one tunes itself");
    };
    let curves = set_curves(fspid.tuner());
    for grades in curves.grades.iter().flatten() {
        let peak = grades.iter().copied().fold(0.0, f64::max);
        assert!((0.99..=1.0).contains(&peak), "{peak}");
    }
}

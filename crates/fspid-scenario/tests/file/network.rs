//! Supervisors that are a network: in the scenario, free, and refused.

use fspid_fuzzy::Network;
use fspid_scenario::file::{self, Extra, Template};
use fspid_scenario::fuzzy_system::{self, Options};
use fspid_scenario::tuning::Free;
use fspid_sim::Controller;

/// Eight weights from `first` on, each a half less than the one before.
fn row(first: f64) -> String {
    let weight = |unit: i32| format!("{:?}", first - 0.5 * f64::from(unit));
    format!("[{}]", (0..8).map(weight).collect::<Vec<_>>().join(", "))
}

fn network() -> String {
    let rows = Network::<f64>::ROWS.iter().zip([2.0, 1.5, 1.0, 3.0, 0.5, -1.0]);
    let rows: Vec<String> = rows.map(|(name, first)| format!("{name} = {}", row(first))).collect();
    format!("network = {{ {} }}", rows.join(", "))
}

/// The starter with this supervisor.
fn starter(supervisor: &str) -> String {
    file::starter().replace("table = \"mirrored\" ", &format!("{supervisor} #"))
}

fn parsed(text: &str) -> file::Study {
    file::parse(text, "mine.toml", None, &[]).expect("a scenario")
}

fn problems(text: &str) -> String {
    file::parse(text, "mine.toml", None, &[]).expect_err("it is wrong").to_string()
}

fn supervisor(study: &file::Study) -> fspid_fuzzy::Supervisor<f64> {
    let Controller::SelfTuning(fspid) = &study.scenario.controllers[1].controller else {
        panic!("the second one is self-tuning")
    };
    *fspid.tuner().supervisor()
}

#[test]
fn the_rows_of_a_network_are_those_of_the_file_and_it_flies() {
    let study = parsed(&starter(&network()));
    let supervisor = supervisor(&study);
    let rows = supervisor.network().expect("a network").rows();
    assert_eq!(rows.map(|row| row[0]), [2.0, 1.5, 1.0, 3.0, 0.5, -1.0]);
    assert_eq!(rows[3], [3.0, 2.5, 2.0, 1.5, 1.0, 0.5, 0.0, -0.5]);
    let flight = fspid_sim::simulate(&study.scenario).expect("it flies");
    let other = parsed(&starter(&network().replace("delta_kp = [3.0", "delta_kp = [4.0")));
    let other = fspid_sim::simulate(&other.scenario).expect("it flies");
    assert!(flight.traces[1].theta_rad.iter().all(|theta| theta.is_finite()));
    assert_ne!(flight.traces[1].theta_rad, other.traces[1].theta_rad);
    let told = study.settings.iter().any(|setting| {
        setting.path == "controller.FSPID.supervisor.network.delta_kp" && setting.given
    });
    assert!(told);
}

#[test]
fn a_mirrored_flight_is_flown_alike_to_the_last_bit() {
    let flown = |sign: f64| {
        let mut study = parsed(&starter(&network()));
        study.scenario.disturbances.clear();
        let at_s = 1.0;
        let shape = fspid_sim::signal::Shape::Step { at_s };
        study.scenario.setpoint =
            fspid_sim::signal::Profile::new(0.1 * sign, shape).expect("a step");
        let flight = fspid_sim::simulate(&study.scenario).expect("it flies");
        flight.traces[1].theta_rad.clone()
    };
    let mirrored: Vec<f64> = flown(-1.0).iter().map(|theta| -theta).collect();
    assert_eq!(flown(1.0), mirrored);
    assert!(mirrored.iter().any(|theta| *theta > 0.05));
}

#[test]
fn everything_that_is_wrong_with_a_network_is_told_at_its_weight() {
    let bad = network()
        .replace("offset = [1.0, 0.5", "offset = [nan, 2e6")
        .replace("delta_ki = [0.5, 0.0,", "delta_ki = [");
    let told = problems(&starter(&bad));
    for expected in [
        "network.offset[0]: not a number",
        "network.offset[1]: out of range",
        "network.delta_ki: 6 numbers",
        "-1000000 to 1000000",
    ] {
        assert!(told.contains(expected), "{expected}: {told}");
    }
    let told = problems(&starter(&network().replace("change =", "chnge =")));
    assert!(told.contains("network.chnge: unknown key; did you mean `change`?"), "{told}");
    let told = problems(&starter(&format!("table = \"printed\"\n{}\n", network())));
    assert!(told.contains("not together with `table`"), "{told}");
    let told = problems(&starter(""));
    assert!(told.contains("`table`; or `numbers`; or `system`; or `network`"), "{told}");
}

#[test]
fn what_only_rules_have_is_refused_beside_a_network_by_name() {
    let more = "defuzzifier = \"exact\"\nerror_set_centres = [0.2, 0.6]\nrange = 5.0";
    let told = problems(&starter(&network()).replace("range = 5.0", more));
    assert!(told.contains("a network is not defuzzified"), "{told}");
    assert!(told.contains("error_set_centres: a network has no sets"), "{told}");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("mine.toml");
    std::fs::write(&path, starter(&network())).expect("written");
    let told = fuzzy_system::load(&path.display().to_string(), Options::default());
    let told = told.expect_err("no system").to_string();
    assert!(told.contains("FSPID: the supervisor is a network: it has no sets"), "{told}");
}

#[test]
fn each_weight_may_be_free_and_set_alone() {
    let marked = network().replace("= [2.0,", "= [{ tune = [-8.0, 8.0], start = 2.0 },");
    let marked = starter(&marked);
    let (study, plain) = (parsed(&marked), parsed(&starter(&network())));
    assert_eq!(study.scenario, plain.scenario);
    let mark = &study.tunable_parameters[0];
    assert!(matches!(mark.free, Free::Number(_)));
    assert_eq!(mark.names(), ["controller.FSPID.supervisor.network.error[0]"]);
    let schema = file::schema();
    for text in [&marked, &starter(&network())] {
        let fault = crate::file::schema::fault(&schema, &crate::file::schema::as_json(text), "");
        assert_eq!(fault, None);
    }
    let template =
        Template::parse(&marked, "mine.toml", None, &Extra::default()).expect("a scenario");
    template.check_marks().expect("within what is allowed");
    let moved = template.with(&[(&mark.path, mark.value(&[1.0]))]).expect("a scenario");
    assert_eq!(supervisor(&moved).network().expect("a network").rows()[0][0], 8.0);
    let set = ["controller.FSPID.supervisor.network.delta_kd[7]=9".to_owned()];
    let set = file::parse(&marked, "mine.toml", None, &set).expect("a scenario");
    assert_eq!(supervisor(&set).network().expect("a network").rows()[5][7], 9.0);
}

//! What all cases of a scenario amount to: nothing that was not asked is called proved.

use std::path::{Path, PathBuf};

use fspid_certify::{Cases, CasesError, CertifiedCases, Effort, NoCases, Question};
use fspid_scenario::file::Template;

const FILE: &str = "scenarios/747-pitch-step.toml";

fn answered(which: Cases, set: &[&str], family: bool) -> Result<CertifiedCases, CasesError> {
    let path: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(FILE);
    let set: Vec<String> = set.iter().map(|text| (*text).to_owned()).collect();
    let template = Template::load(&path, &set).unwrap_or_else(|error| panic!("{error}"));
    let effort = Effort { halvings: 0, largest_factor: 1.0, ..Effort::default() };
    let question = Question {
        only: Some("CPID"),
        disturbances: false,
        family,
        nonlinear: false,
        effort: &effort,
    };
    let source = (path.as_path(), set.as_slice());
    CertifiedCases::answering(source, template.study(), which, question, &mut |_| {})
}

const DELAY: &str = "dispersion[]={ name = \"delay\", path = \"actuator.delay_samples\", distribution = \"choice\", values = [0, 2] }";

/// "PROVED at all 2 choices", of four; with 40 times the gain the loop diverges.
#[test]
fn choices_of_a_family_and_factors_are_refused_where_no_family_is_asked() {
    let delay = DELAY;
    let lag = "dispersion[]={ name = \"lag\", path = \"actuator.time_constant_s\", distribution = \"choice\", values = [0.1, 0.2] }";
    let gain = "dispersion[]={ name = \"gain\", path = \"controller.CPID.kp\", distribution = \"choice\", values = [1.0, 40.0], relative = true }";
    let refused = |set: &[&str]| match answered(Cases::Choices, set, false) {
        Err(CasesError::NoCases(refused)) => refused,
        other => panic!("{:?}", other.map(|found| found.text())),
    };
    let of_family = refused(&[delay, lag]);
    assert_eq!(of_family, NoCases::InAFamily("`actuator.time_constant_s`".to_owned()));
    assert!(of_family.to_string().contains("--family"));
    let found = answered(Cases::Choices, &[delay, lag], true).expect("the family is asked");
    assert!(found.all_proved(), "{}", found.text());
    // It was sent to `--family`, which sent it back.
    let factors = refused(&[delay, gain]);
    assert_eq!(factors, NoCases::Factors("`controller.CPID.kp`".to_owned()));
    assert!(factors.to_string().contains("write the values themselves"));
}

/// "PROVED at all 2 choices of the dispersions", of four: with the larger step the flight runs away at the limit of its command.
#[test]
fn choices_of_set_points_and_loads_are_cases_as_well() {
    let bounded = "controller.CPID.output_limits_deg=[-3.0, 3.0]";
    let step = "dispersion[]={ name = \"step\", path = \"setpoint.amplitude_deg\", distribution = \"choice\", values = [1.0, 40.0] }";
    let found = answered(Cases::Choices, &[bounded, DELAY, step], false).expect("cases");
    let names: Vec<&str> = found.changes().iter().map(|it| it.name.as_str()).collect();
    assert_eq!(
        names,
        ["delay 0, step 1.0", "delay 0, step 40.0", "delay 2, step 1.0", "delay 2, step 40.0"]
    );
    assert!(!found.all_proved(), "{}", found.text());
    assert!(found.text().contains("CPID: NOT PROVED at 2 of 4 choices"), "{}", found.text());
    let alone = answered(Cases::Choices, &[step], false).expect("cases of set-points alone");
    assert_eq!(alone.changes().len(), 2);
    // Noise is in no claim.
    let seed = "dispersion[]={ name = \"seed\", path = \"disturbance[0].seed\", distribution = \"choice\", values = [1, 2] }";
    let noise = "disturbance[]={ kind = \"noise\", enters_at = \"measurement\", standard_deviation_deg = 0.01, seed = 1 }";
    let found = answered(Cases::Choices, &[DELAY, noise, seed], false).expect("cases");
    assert_eq!(found.changes().len(), 2);
}

#[test]
fn a_certificate_of_a_choice_says_that_others_have_their_own() {
    let found = answered(Cases::Choices, &[DELAY], false).expect("cases");
    assert!(found.all_proved());
    let text = found.text();
    assert!(text.contains("others have certificates of their own"), "{text}");
    assert!(!text.contains("not about those that a campaign draws"), "{text}");
}

/// "PROVED at all 2 cases", of which one had nobody of that name.
#[test]
fn a_case_without_the_controller_is_not_proved() {
    let case = |name: &str, set: &str| format!("{{ name = \"{name}\", set = [{set}] }}");
    let cases =
        [case("as it is", ""), case("renamed", "\"controller.CPID.name=other\"")].join(", ");
    let tuning = format!(
        "tuning={{ budget = 3, case = [{cases}], objective = [{{ measure = \"iae_deg_s\" }}] }}"
    );
    let found = answered(Cases::Tuning, &[&tuning], false).expect("cases");
    let text = found.text();
    assert!(text.contains("CPID: NOT PROVED at 1 of 2 cases of [tuning]: renamed"), "{text}");
    assert!(
        text.contains("renamed\n  the controller that is asked is not among those of this case\n"),
        "{text}"
    );
    assert!(!found.all_proved());
}

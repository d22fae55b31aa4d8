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

/// "PROVED at all 2 choices", of four; with 40 times the gain the loop diverges.
#[test]
fn choices_of_a_family_are_refused_where_no_family_is_asked() {
    let delay = "dispersion[]={ name = \"delay\", path = \"actuator.delay_samples\", distribution = \"choice\", values = [0, 2] }";
    let gain = "dispersion[]={ name = \"gain\", path = \"controller.CPID.kp\", distribution = \"choice\", values = [1.0, 40.0], relative = true }";
    match answered(Cases::Choices, &[delay, gain], false) {
        Err(CasesError::NoCases(refused @ NoCases::InAFamily(_))) => {
            let told = refused.to_string();
            assert!(told.starts_with("`gain`: ") && told.contains("--family"), "{told}");
        }
        other => panic!("{:?}", other.map(|found| found.text())),
    }
    let found = answered(Cases::Choices, &[delay, gain], true).expect("the family is asked");
    assert!(!found.all_proved(), "{}", found.text());
    assert!(answered(Cases::Choices, &[delay], false).expect("cases").all_proved());
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

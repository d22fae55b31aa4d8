//! Places that are marked free, and what a scenario says of its tuning.

use fspid_scenario::file::{self, Extra, NewValue, Template};
use fspid_scenario::tuning::{Free, Over};

/// The starter with changes of its text.
fn changed(changes: &[(&str, &str)]) -> String {
    changes.iter().fold(file::starter().to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1)
    })
}

fn problems(text: &str) -> String {
    file::parse(text, "mine.toml", None, &[]).expect_err("it is wrong").to_string()
}

const OBJECTIVE: &str = "\n[[tuning.objective]]\nmeasure = \"iae_deg_s\"\n";

#[test]
fn a_mark_flies_as_its_start_and_as_the_middle_of_its_bounds_without_one() {
    let text = changed(&[("kp = 1.0\n", "kp = { tune = [0.1, 10.0], scale = \"log\" }\n")]);
    let study = file::parse(&text, "mine.toml", None, &[]).expect("a scenario");
    let plain = file::parse(file::starter(), "starter.toml", None, &[]).expect("a scenario");
    let Free::Number(number) = study.tunable_parameters[0].free else { panic!("a number") };
    assert!((number.start - 1.0).abs() < 1e-15);
    assert_eq!(study.scenario.controllers.len(), plain.scenario.controllers.len());
    let text = text.replace("\"log\"", "\"log\", start = 1.0");
    let study = file::parse(&text, "mine.toml", None, &[]).expect("a scenario");
    assert_eq!(study.scenario, plain.scenario);
    assert_eq!(study.tunable_parameters[0].path.text(), "controller.PID.kp");
    assert_eq!(study.tunable_parameters[0].controller(), Some("PID"));
}

#[test]
fn a_value_from_the_command_line_is_not_free_any_more() {
    let text = changed(&[("kp = 1.0\n", "kp = { tune = [0.1, 10.0] }\n")]);
    let set = ["controller.PID.kp=2.0".to_owned()];
    let study = file::parse(&text, "mine.toml", None, &set).expect("a scenario");
    assert!(study.tunable_parameters.is_empty());
    let set = ["controller.PID.kp.start=0.5".to_owned()];
    let study = file::parse(&text, "mine.toml", None, &set).expect("a scenario");
    assert_eq!(study.tunable_parameters.len(), 1);
}

#[test]
fn everything_that_is_wrong_with_marks_is_told_at_once_with_its_place() {
    for (mark, message) in [
        ("{ tune = [10.0, 0.1] }", "the bounds hold no number between them"),
        ("{ tune = [1.0, 1.0] }", "the bounds hold no number between them"),
        ("{ tune = [1.0, nan] }", "no bounds"),
        ("{ tune = [1.0] }", "no bounds"),
        ("{ tune = \"fast\" }", "unknown word"),
        ("{ tune = [-1.0, 1.0], scale = \"log\" }", "needs bounds above 0"),
        ("{ tune = [0.0, 1.0], start = 2.0 }", "not within the bounds"),
        ("{ tune = [0.0, 1.0], sclae = \"log\" }", "did you mean `scale`?"),
    ] {
        let text = changed(&[
            ("kp = 1.0\n", &format!("kp = {mark}\n")),
            ("ki = ", "ki = { tune = [2.0, 1.0] } # "),
        ]);
        let told = problems(&text);
        assert!(told.contains(message) && told.contains("controller.PID.kp"), "{mark}: {told}");
        assert!(told.contains("controller.PID.ki"), "{told}");
    }
}

#[test]
fn a_bound_that_the_controller_does_not_allow_is_told_at_its_mark() {
    let text =
        changed(&[("kp = 1.0\n", "kp = 1.0\nderivative_filter_s = { tune = [-1.0, 1.0] }\n")]);
    let template = Template::parse(&text, "mine.toml", None, &Extra::default()).expect("it flies");
    let told = template.check_marks().expect_err("a filter below 0").to_string();
    assert!(told.contains("derivative_filter_s: -1.0 is not allowed"), "{told}");
    assert!(told.starts_with("mine.toml:"), "{told}");
}

#[test]
fn a_grid_of_rules_may_be_free_within_its_reach() {
    let row = "NB NM NS ZO PS PM PB\n";
    let grid = format!("\"\"\"\n{}\"\"\"", row.repeat(7));
    let free = |start: &str| {
        let flat = "ZO ZO ZO ZO ZO ZO ZO\n".repeat(7);
        let table = format!(
            "table = {{ delta_kp = {{ tune = \"rules\", start = {start}, symmetric = false }}, delta_ki = \"\"\"\n{flat}\"\"\", delta_kd = \"\"\"\n{flat}\"\"\" }}"
        );
        changed(&[("table = \"mirrored\"", &table)])
    };
    let text = free(&grid);
    let template =
        Template::parse(&text, "mine.toml", None, &Extra::default()).expect("a scenario");
    let mark = &template.study().tunable_parameters[0];
    assert_eq!(mark.dimensions(), 49);
    let NewValue::Text(highest) = mark.value(&[1.0; 49]) else { panic!("a grid") };
    assert!(highest.starts_with("NS ZO PS PM PB PB PB\n"), "{highest}");
    let before = &template.study().scenario;
    let after = template.with(&[(&mark.path, mark.value(&[1.0; 49]))]).expect("a scenario");
    assert_ne!(before.controllers, after.scenario.controllers);
    let told = problems(&free("\"NB NM\""));
    assert!(told.contains("supervisor.table.delta_kp.start"), "{told}");
    assert!(told.contains("\n1 problem"), "{told}");
    let told = problems(&text.replace("tune = \"rules\"", "tune = \"rule\""));
    assert!(told.contains("unknown word") && told.contains("\n1 problem"), "{told}");
}

#[test]
fn nothing_is_free_where_nothing_flies() {
    let text = format!(
        "{}\n[[requirement]]\nmeasure = \"overshoot_pct\"\nmost = {{ tune = [0.0, 1.0] }}\n",
        file::starter()
    );
    assert!(problems(&text).contains("nothing can be tuned here"));
}

#[test]
fn a_tuning_is_read_with_its_cases_and_objectives() {
    let text = format!(
        "{}\n[tuning]\nover = \"tail\"\nshare = 0.25\n[[tuning.case]]\nname = \"slow\"\nset = [\"loop.duration_s=5\"]\n{OBJECTIVE}weight = -2.0\n",
        file::starter()
    );
    let study = file::parse(&text, "mine.toml", None, &[]).expect("a scenario");
    let tuning = study.tuning.expect("a tuning");
    assert_eq!(tuning.over, Over::Tail { share: 0.25 });
    assert_eq!(tuning.cases[0].set, ["loop.duration_s=5"]);
    assert_eq!(tuning.objectives[0].weight, -2.0);
    // What is to become large is bad where it is small.
    assert_eq!(tuning.objectives[0].requirement.least, Some(0.0));
}

#[test]
fn what_is_wrong_with_a_tuning_is_told() {
    for (tuning, message) in [
        ("[tuning]\n", "tuning.objective: missing key"),
        (&format!("[tuning]\nbudget = 0\n{OBJECTIVE}") as &str, "tuning.budget: out of range"),
        (&format!("[tuning]\noptimiser = \"cmaes\"\n{OBJECTIVE}"), "did you mean \"cma-es\"?"),
        (
            &format!("[tuning]\noptimiser = \"nsga-ii\"\n{OBJECTIVE}"),
            "a front needs two objectives",
        ),
        (&format!("[tuning]\ncontroller = \"XPID\"\n{OBJECTIVE}"), "no controller has this name"),
        (&format!("[tuning]\nshare = 0.1\n{OBJECTIVE}"), "says nothing where `over` is not"),
        (&format!("[tuning]\n{OBJECTIVE}weight = 0.0\n"), "an objective that costs nothing"),
        (&format!("[tuning]\n{OBJECTIVE}weight = nan\n"), "not a number"),
        (&format!("[tuning]\n{OBJECTIVE}within_deg = 1.0\n"), "says nothing about `iae_deg_s`"),
        ("[tuning]\n[[tuning.objective]]\nmeasure = \"iae\"\n", "did you mean \"iae_deg_s\"?"),
        (
            &format!("[tuning]\n[[tuning.case]]\nname = \"a\"\nset = [1]\n{OBJECTIVE}"),
            "no list of changes",
        ),
        (
            &format!(
                "[tuning]\n[[tuning.case]]\nname = \"a\"\nset = []\n[[tuning.case]]\nname = \"a\"\nset = []\n{OBJECTIVE}"
            ),
            "the name is taken by tuning.case[0]",
        ),
    ] {
        let told = problems(&format!("{}\n{tuning}", file::starter()));
        assert!(told.contains(message), "{tuning}: {told}");
    }
}

#[test]
fn every_marked_scenario_flies_and_bears_the_ends_of_its_bounds() {
    for (name, _) in crate::file::marked() {
        let path = crate::file::repository(&format!("scenarios/{name}"));
        let template = Template::load(&path, &[]).unwrap_or_else(|error| panic!("{error}"));
        assert!(
            !template.study().tunable_parameters.is_empty() && template.study().tuning.is_some(),
            "{name}"
        );
        assert_eq!(template.check_marks(), Ok(()), "{name}");
    }
}

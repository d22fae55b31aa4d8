//! Supervisors whose rules conclude numbers: in the scenario, in a file, free, and refused.

use std::path::Path;

use fspid_fuzzy::{Label, Output};
use fspid_scenario::file::{self, Extra, Template};
use fspid_scenario::fuzzy_system::{self, Options, Target};
use fspid_scenario::tuning::Free;
use fspid_sim::Controller;

/// A grid whose cells tell their row and column, symmetric, within 1.
fn grid() -> String {
    let row = |i: i32| {
        let cell = |j: i32| {
            let level = (7 * i + j).min(7 * (6 - i) + 6 - j);
            format!("{:?}", f64::from(level) / 25.0)
        };
        format!("[{}]", (0..7).map(cell).collect::<Vec<_>>().join(", "))
    };
    format!("[{}]", (0..7).map(row).collect::<Vec<_>>().join(", "))
}

/// The starter with these rules.
fn starter(rules: &str) -> String {
    let text = file::starter();
    assert!(text.contains("table = \"mirrored\" "), "{text}");
    text.replace("table = \"mirrored\" ", &format!("{rules} #"))
}

fn numbers(kp: &str) -> String {
    let flat = "[0, 0, 0, 0, 0, 0, 0]";
    let zeros = format!("[{}]", [flat; 7].join(", "));
    starter(&format!("numbers = {{ delta_kp = {kp}, delta_ki = {zeros}, delta_kd = {zeros} }}"))
}

fn problems(text: &str, folder: Option<&Path>) -> String {
    file::parse(text, "mine.toml", folder, &[]).expect_err("it is wrong").to_string()
}

fn self_tuner(study: &file::Study) -> &fspid_core::SelfTuner<f64> {
    let Controller::SelfTuning(fspid) = &study.scenario.controllers[1].controller else {
        panic!("the second one is self-tuning")
    };
    fspid.tuner()
}

#[test]
fn rows_of_numbers_are_the_error_and_columns_its_change_as_in_a_table_of_labels() {
    let study = file::parse(&numbers(&grid()), "mine.toml", None, &[]).expect("a scenario");
    let tuner = self_tuner(&study);
    // Row 0, column 6 is NB of the error and PB of the change: level 6.
    let corner = tuner.supervisor().infer(-5.0, 5.0).expect("finite").delta;
    assert_eq!(corner.kp, 6.0 / 25.0);
    let labels = file::starter().replace("mirrored", "printed");
    let labels = file::parse(&labels, "mine.toml", None, &[]).expect("a scenario");
    let table = self_tuner(&labels).supervisor().table().expect("labels");
    let printed = table.grid(Output::DeltaKp).at(Label::NB, Label::PB);
    let answer = self_tuner(&labels).supervisor().infer(-5.0, 5.0).expect("finite").delta.kp;
    // The same corner of the printed grid: its answer has the sign of that label.
    let level = printed.index() as f64 - 3.0;
    assert!(level == 0.0 || (level > 0.0) == (answer > 0.0), "{printed} {answer}");
    assert!(study.settings.iter().any(|setting| {
        setting.path == "controller.FSPID.supervisor.numbers.delta_kp" && setting.given
    }));
}

#[test]
fn numbers_fly_and_not_as_the_labels_do() {
    let fly = |text: &str| {
        let study = file::parse(text, "mine.toml", None, &[]).expect("a scenario");
        let flight = fspid_sim::simulate(&study.scenario).expect("it flies");
        flight.traces[1].theta_rad.clone()
    };
    let (one, zero) = (fly(&numbers(&grid())), fly(&numbers(&grid().replace("0.", "-0."))));
    assert!(one.iter().all(|theta| theta.is_finite()));
    assert_ne!(one, zero);
}

#[test]
fn everything_that_is_wrong_with_numbers_is_told_at_its_cell() {
    let bad = "[[0, 0, 0, 6.0, 0, 0, 0], [0, 0, 0], 3, [0, 0, nan, 0, 0, 0, \"PB\"]]";
    let told = problems(&numbers(bad), None);
    for expected in [
        "delta_kp: 4 lists",
        "delta_kp[1]: 3 numbers",
        "delta_kp[2]: wrong type: a number",
        "delta_kp[3][2]: not a number",
        "delta_kp[3][6]: wrong type: text",
    ] {
        assert!(told.contains(expected), "{expected}: {told}");
    }
    let told = problems(&numbers(&grid().replace("0.96", "5.5").replace("0.2]", "-7]")), None);
    assert!(told.contains("delta_kp[3][3]: beyond the supervisor's range"), "{told}");
    let told = problems(&starter("table = \"printed\"\nsystem = \"mine.fis\"\n"), None);
    assert!(told.contains("not together with `table`"), "{told}");
    let told = problems(&starter(""), None);
    assert!(told.contains("`table`; or `numbers`; or `system`"), "{told}");
    let told = problems(&numbers(&format!("{}, x = 1", grid())), None);
    assert!(told.contains("numbers.x: unknown key"), "{told}");
    let told = problems(
        &numbers(&grid()).replace("range = 5.0", "defuzzifier = \"exact\"\nrange = 5.0"),
        None,
    );
    assert!(told.contains("rules that conclude numbers are not defuzzified"), "{told}");
}

/// A folder with the numbers of [`numbers`] as a system, changed, in a file of this ending.
fn with_system(
    ending: &str,
    change: impl FnOnce(&mut fuzzy_system::Parts),
) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let scenario = folder.path().join("numbers.toml");
    std::fs::write(&scenario, numbers(&grid())).expect("written");
    let name = scenario.display().to_string();
    let mut parts =
        fuzzy_system::load(&name, Options::default()).expect("a supervisor").system.parts().clone();
    parts.inputs.iter_mut().for_each(|it| it.out_of_range = fspid_fuzzy::OutOfRange::Evaluate);
    change(&mut parts);
    let out = folder.path().join(format!("mine.{ending}"));
    let written = fuzzy_system::write_as(&parts, &out, Target::default()).expect("it can be said");
    std::fs::write(&out, written.text).expect("written");
    (folder, starter(&format!("system = \"mine.{ending}\"")))
}

#[test]
fn a_system_in_a_file_of_any_format_flies_as_the_numbers_that_it_holds() {
    let expected = file::parse(&numbers(&grid()), "mine.toml", None, &[]).expect("a scenario");
    for ending in ["toml", "fis", "fll", "fcl"] {
        let (folder, text) = with_system(ending, |_| {});
        let study = file::parse(&text, "mine.toml", Some(folder.path()), &[]).expect("a scenario");
        let (own, of_file) = (self_tuner(&expected), self_tuner(&study));
        assert_eq!(own.supervisor().numbers(), of_file.supervisor().numbers(), "{ending}");
        assert_ne!(study.digest, expected.digest);
    }
}

#[test]
fn a_system_that_is_no_grid_of_numbers_is_refused_with_everything_that_differs() {
    use fspid_fuzzy::system::{Conclusion, Membership};
    let (folder, text) = with_system("toml", |parts| {
        if let Membership::Shape { params, .. } = &mut parts.inputs[0].terms[2].membership {
            params[1] += 0.25;
        }
        parts.inputs[1].terms[3].name = "zero".to_owned();
        parts.blocks[0].rules[5].weight = 0.5;
        parts.blocks[0].rules[6].enabled = false;
        parts.blocks[0].and = fspid_fuzzy::TNormKind::Minimum.into();
        parts.outputs[2].terms[0].conclusion =
            Conclusion::Linear { coefficients: vec![1.0, 0.0], constant: 0.0 };
    });
    let told = problems(&text, Some(folder.path()));
    for expected in [
        "error: set NS is a triangle over",
        "its rules do not join grades by the product",
        "allowed: inputs error and change with seven triangles each",
    ] {
        assert!(told.contains(expected), "{expected}: {told}");
    }
    assert_eq!(told.matches("allowed: ").count(), 1, "{told}");
    // Rules are looked at where the sets are right.
    let (folder, text) = with_system("toml", |parts| {
        parts.blocks[0].rules[5].weight = 0.5;
        parts.blocks[0].rules[6].enabled = false;
        parts.outputs[2].terms[0].conclusion =
            Conclusion::Linear { coefficients: vec![1.0, 0.0], constant: 0.0 };
    });
    let told = problems(&text, Some(folder.path()));
    for expected in [
        "rule 6: its weight is 0.5, not 1",
        "rule 1: what it says of delta_kd is no number",
        "2 cells of delta_kp have no number: (NB, PM), (NB, PB)",
        "3 cells of delta_kd have no number: (NB, NB), (NB, PM), (NB, PB)",
    ] {
        assert!(told.contains(expected), "{expected}: {told}");
    }
}

#[test]
fn a_system_of_another_range_of_labels_or_unreadable_is_refused_in_words() {
    let (folder, text) = with_system("fis", |_| {});
    let told = problems(&text.replace("range = 5.0", "range = 4.0"), Some(folder.path()));
    assert!(told.contains("its sets reach to 5.0, and the range is 4.0"), "{told}");
    assert!(told.contains("allowed: `range = 5.0`\n"), "{told}");
    let told = problems(&text.replace("mine.fis", "other.fis"), Some(folder.path()));
    assert!(told.contains("cannot be read: there is no such file"), "{told}");
    let told = problems(&text.replace("mine.fis", "mine.csv"), Some(folder.path()));
    assert!(told.contains("no file of a known format"), "{told}");
    std::fs::write(folder.path().join("mine.fis"), "[System]\nName='x'\n").expect("written");
    let told = problems(&text, Some(folder.path()));
    assert!(told.contains("supervisor.system") && told.contains("mine.fis:"), "{told}");
    let labels = folder.path().join("labels.toml");
    let options = Options { range: Some(5.0), ..Options::default() };
    let mamdani = fuzzy_system::load("mirrored", options).expect("shipped");
    std::fs::write(&labels, fuzzy_system::write(mamdani.system.parts())).expect("written");
    let told = problems(&text.replace("mine.fis", "labels.toml"), Some(folder.path()));
    assert!(told.contains("error: set NB is no triangle of height 1"), "{told}");
    assert!(told.contains("delta_kp is the centroid of its rules"), "{told}");
}

/// The first conclusion of delta_kp and the range of both inputs, as a file has them.
fn with_first(number: f64) -> (tempfile::TempDir, String) {
    with_system("toml", |parts| {
        parts.outputs[0].universe = None;
        parts.outputs[0].clamp = false;
        parts.outputs[0].terms[0].conclusion = fspid_fuzzy::system::Conclusion::Constant(number);
    })
}

#[test]
fn numbers_of_a_system_a_trace_beyond_the_range_are_at_its_end_and_others_are_refused() {
    let (folder, text) = with_first(-5.0 * (1.0 + 2e-10));
    let study = file::parse(&text, "mine.toml", Some(folder.path()), &[]).expect("a scenario");
    let numbers = self_tuner(&study).supervisor().numbers().expect("numbers");
    assert_eq!(numbers.grid(Output::DeltaKp)[0][0], -5.0);
    let (folder, text) = with_first(5.1);
    let told = problems(&text, Some(folder.path()));
    assert!(told.contains("delta_kp has numbers up to 5.1, beyond the range of 5.0"), "{told}");
    assert!(told.contains("-5.0 to 5.0; `output_scale` makes increments larger"), "{told}");
    assert!(!told.contains("seven triangles"), "{told}");
}

#[test]
fn numbers_that_are_shown_do_not_round_past_their_range_nor_to_nothing() {
    let numbers = |range: f64, number: f64| {
        let mut grids = [[[0.0; 7]; 7]; 3];
        (grids[1][2][3], grids[2][6][6]) = (-number, number / 2.0);
        fuzzy_system::Numbers { range, grids }
    };
    for range in [3.3337, 5.0, 0.99996, 1e-3, 1e-90, 1e12] {
        let own = numbers(range, range);
        assert_eq!(own.beyond(range), Vec::<String>::new());
        let shown: toml::Table = own.toml().parse().expect("TOML");
        let read = |name: &str, row: usize, column: usize| {
            shown["numbers"][name][row][column].as_float().expect("a number")
        };
        let (most, half) = (-read("delta_ki", 2, 3), read("delta_kd", 6, 6));
        assert!(most <= range && most > 0.999 * range, "{range}: {most}");
        assert!((half - range / 2.0).abs() < 1e-3 * range, "{range}: {half}");
    }
    // What lies beyond is told, not moved.
    let far = numbers(5.0, 6.0);
    assert_eq!(far.beyond(5.0), ["delta_ki has numbers up to 6.0, beyond the range of 5.0"]);
    assert!(far.toml().contains("-6.000"), "{}", far.toml());
    assert_eq!(far.grids_within(5.0), far.grids);
}

#[test]
fn a_scenario_is_known_by_its_controllers_however_they_are_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("mine.toml");
    let name = path.display().to_string();
    let document: toml::Table = file::starter().parse().expect("TOML");
    let controllers = document["controller"].to_string();
    let mut others = document;
    others.remove("controller");
    let in_a_line = format!("controller = {controllers}\n{others}");
    let spaced = file::starter().replace("[[controller]]", " [[ controller ]]  # tuned");
    for text in [spaced, in_a_line] {
        std::fs::write(&path, &text).expect("written");
        assert!(fuzzy_system::is_scenario(&name), "{text}");
        let own = fuzzy_system::load(&name, Options::default()).expect("one supervisor");
        assert_eq!(own.system.parts().name, "FSPID");
    }
    std::fs::write(&path, "range = 5.0\n# [[controller]]\n").expect("written");
    assert!(!fuzzy_system::is_scenario(&name));
}

#[test]
fn the_supervisor_of_a_scenario_is_a_system_by_the_name_of_its_controller() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("mine.toml");
    std::fs::write(&path, file::starter()).expect("written");
    let name = path.display().to_string();
    let load = |controller| fuzzy_system::load(&name, Options { controller, ..Options::default() });
    let own = load(None).expect("one supervisor");
    assert_eq!(own.system.parts().name, "FSPID");
    let shipped = Options { range: Some(5.0), ..Options::default() };
    let shipped = fuzzy_system::load("mirrored", shipped).expect("shipped");
    assert_eq!(own.system.parts().blocks, shipped.system.parts().blocks);
    let told = load(Some("PID")).expect_err("it has none").to_string();
    assert!(told.contains("--controller PID: those with a supervisor are FSPID"), "{told}");
}

#[test]
fn a_grid_of_numbers_may_be_free_and_so_may_a_single_cell() {
    let marked = numbers(&format!("{{ tune = \"numbers\", reach = 0.5, start = {} }}", grid()));
    let study = file::parse(&marked, "mine.toml", None, &[]).expect("a scenario");
    let plain = file::parse(&numbers(&grid()), "mine.toml", None, &[]).expect("a scenario");
    assert_eq!(study.scenario, plain.scenario);
    let mark = &study.tunable_parameters[0];
    assert_eq!((mark.dimensions(), mark.controller()), (25, Some("FSPID")));
    assert!(matches!(mark.free, Free::Numbers(_)));
    let schema = file::schema();
    assert_eq!(
        crate::file::schema::fault(&schema, &crate::file::schema::as_json(&marked), ""),
        None
    );
    assert_eq!(mark.names()[24], "controller.FSPID.supervisor.numbers.delta_kp[3][3]");
    let template =
        Template::parse(&marked, "mine.toml", None, &Extra::default()).expect("a scenario");
    template.check_marks().expect("within the range");
    let moved = template.with(&[(&mark.path, mark.value(&[1.0; 25]))]).expect("a scenario");
    let corner = self_tuner(&moved).supervisor().infer(5.0, 5.0).expect("finite").delta.kp;
    assert_eq!(corner, 0.5);
    let cell = numbers(&grid().replace("0.96", "{ tune = [-1.0, 1.0], start = 0.96 }"));
    let study = file::parse(&cell, "mine.toml", None, &[]).expect("a scenario");
    assert_eq!(study.scenario, plain.scenario);
    let set = ["controller.FSPID.supervisor.numbers.delta_kp[3][3]=-2".to_owned()];
    let set = file::parse(&cell, "mine.toml", None, &set).expect("a scenario");
    assert_eq!(self_tuner(&set).supervisor().infer(0.0, 0.0).expect("finite").delta.kp, -2.0);
}

#[test]
fn what_is_wrong_with_a_free_grid_is_told_with_what_is_allowed() {
    for (mark, expected) in [
        (format!("{{ tune = \"numbers\", start = {} }}", grid()), "reach: missing key"),
        ("{ tune = \"numbers\", reach = 0.5 }".to_owned(), "start: missing key"),
        (format!("{{ tune = \"numbers\", reach = -1, start = {} }}", grid()), "reach: wrong value"),
        (
            format!(
                "{{ tune = \"numbers\", reach = 1, start = {} }}",
                grid().replacen("0.0", "0.1", 1)
            ),
            "cell (i, j) is not cell (6 - i, 6 - j)",
        ),
        (
            format!(
                "{{ tune = \"numbers\", reach = 1, start = {} }}",
                grid().replacen("0.0", "nan", 1)
            ),
            "delta_kp.start[0][0]: not a number",
        ),
        ("{ tune = \"numbers\", reach = 1, start = 3 }".to_owned(), "start: wrong type: a number"),
        (
            format!("{{ tune = \"rules\", reach = 1, start = {} }}", grid()),
            "start: no grid of labels",
        ),
        (format!("{{ tune = \"number\", start = {} }}", grid()), "unknown word"),
        (format!("{{ tune = [0.0, 1.0], start = {} }}", grid()), "start: not within the bounds"),
        (
            format!("{{ tune = \"numbers\", reach = 1, at_rest = 0, start = {} }}", grid()),
            "unknown key of a mark",
        ),
    ] {
        let told = problems(&numbers(&mark), None);
        assert!(told.contains(expected) && told.contains("\n1 problem"), "{expected}: {told}");
    }
    let far = numbers(&format!("{{ tune = \"numbers\", reach = 4.5, start = {} }}", grid()));
    let template = Template::parse(&far, "mine.toml", None, &Extra::default()).expect("it flies");
    let told = template.check_marks().expect_err("beyond the range").to_string();
    assert!(told.contains("an end of its reach is not allowed"), "{told}");
    assert!(told.contains("beyond the supervisor's range"), "{told}");
}

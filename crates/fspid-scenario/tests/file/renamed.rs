//! Old keys: read as the new ones, with one warning a place, for one version.

use fspid_scenario::file::{self, Extra, Problems, Study, Template};

use crate::file::{repository, shipped, text};

/// The starter with these lines in its supervisor, and these in its self-tuning controller.
fn scenario(supervisor: &str, controller: &str) -> String {
    let text = file::starter().replacen("range = 5.0", &format!("range = 5.0\n{supervisor}"), 1);
    text.replacen("law = ", &format!("{controller}\nlaw = "), 1)
}

const OLD: [&str; 2] = [
    "sees = \"error-and-model-error\"\nmodel = { bandwidth_rad_s = 1.25 }\nerror_sets = [0.2, 0.5]\nchange_sets = [0.3, 0.6]",
    "followers = { setpoint_weight_per_kp = 0.5, rate_gain_per_kd = 3.0 }",
];
const NEW: [&str; 2] = [
    "second_input = \"error-and-model-error\"\nmodel = { bandwidth_rad_s = 1.25 }\nerror_set_centres = [0.2, 0.5]\nchange_set_centres = [0.3, 0.6]",
    "gain_coupling = { setpoint_weight_per_kp = 0.5, rate_gain_per_kd = 3.0 }",
];

fn set(text: &str, overrides: &[&str]) -> Result<Study, Problems> {
    let overrides: Vec<String> = overrides.iter().map(|&it| it.to_owned()).collect();
    file::parse(text, "mine.toml", None, &overrides)
}

fn read(text: &str, overrides: &[&str]) -> Study {
    set(text, overrides).unwrap_or_else(|problems| panic!("{problems}"))
}

/// The line in which a text stands.
fn line_of(text: &str, part: &str) -> usize {
    text.lines().position(|line| line.contains(part)).expect("it is there") + 1
}

/// The warning of an old key.
fn told(place: &str, path: &str, old: &str, new: &str) -> String {
    format!("{place}: {path}: `{old}` is called `{new}` now; the old key is read for one version")
}

#[test]
fn an_old_key_is_read_with_one_warning_and_flies_the_same_bits_as_the_new_one() {
    let (old, new) = (scenario(OLD[0], OLD[1]), scenario(NEW[0], NEW[1]));
    let (found, expected) = (read(&old, &[]), read(&new, &[]));
    assert_eq!(found.scenario, expected.scenario);
    assert_eq!(found.settings, expected.settings);
    assert_ne!(found.scenario, read(file::starter(), &[]).scenario);
    let path = |key| format!("controller[1].{key}");
    let line = |key| format!("line {}", line_of(&old, key));
    let warnings = [
        ("followers", "followers", "gain_coupling"),
        ("supervisor.sees", "sees", "second_input"),
        ("supervisor.error_sets", "error_sets", "error_set_centres"),
        ("supervisor.change_sets", "change_sets", "change_set_centres"),
    ];
    let warnings = warnings.map(|(key, old, new)| told(&line(old), &path(key), old, new));
    let own = &found.warnings[..warnings.len()];
    assert_eq!(own, warnings);
    assert_eq!(&found.warnings[warnings.len()..], &expected.warnings[..]);
}

#[test]
fn an_old_key_beside_its_new_one_is_refused_with_both_places() {
    let text = scenario("second_input = \"error-and-rate\"\nsees = \"error-and-change\"", "");
    let problems = set(&text, &[]).expect_err("both");
    let [problem] = &problems.list[..] else { panic!("{problems}") };
    assert_eq!(problem.path, "controller[1].supervisor.sees");
    assert_eq!(problem.place.map(|it| it.line), Some(line_of(&text, "sees = ")));
    let other = line_of(&text, "second_input = ");
    let message = format!("the old key of `second_input`, which is here as well in line {other}");
    assert_eq!(problem.message, message);
}

#[test]
fn an_old_key_is_read_in_a_change_and_wins_over_the_new_one_of_the_file() {
    let text = scenario(NEW[0], NEW[1]);
    let pairs = [
        ("FSPID.supervisor.sees", "sees", "second_input", "\"error-and-change\""),
        ("FSPID.supervisor.error_sets[0]", "error_sets", "error_set_centres", "0.1"),
        ("FSPID.followers.rate_gain_per_kd", "followers", "gain_coupling", "1.0"),
    ];
    let rid = "controller.FSPID.supervisor={ table = \"mirrored\", range = 5.0 }";
    for (path, old, new, value) in pairs {
        let change = format!("controller.{path}={value}");
        let renamed = change.replacen(old, new, 1);
        let without = if old == "sees" { vec![rid] } else { Vec::new() };
        let sets = |last: &str| [&without[..], &[last]].concat().join("\n");
        let (sets, renamed_sets) = (sets(&change), sets(&renamed));
        let found = read(&text, &sets.lines().collect::<Vec<_>>());
        let expected = read(&text, &renamed_sets.lines().collect::<Vec<_>>());
        assert_eq!(found.scenario, expected.scenario, "{change}");
        let warning = told(&format!("--set {change}"), &format!("controller.{path}"), old, new);
        let mut warnings = expected.warnings;
        warnings.insert(0, warning);
        assert_eq!(found.warnings, warnings);
        // The same as a line of the file itself.
        let listed = format!("set = [\n  {}\n]\n{text}", quoted(&sets).join(",\n  "));
        let found = read(&listed, &[]);
        assert_eq!(found.scenario, expected.scenario, "{change}");
        let line = line_of(&listed, &format!("'{change}'"));
        warnings[0] = told(&format!("line {line}"), &format!("controller.{path}"), old, new);
        assert_eq!(found.warnings, warnings);
    }
}

/// Lines as texts of TOML.
fn quoted(lines: &str) -> Vec<String> {
    lines.lines().map(|line| format!("'{line}'")).collect()
}

#[test]
fn an_old_key_is_read_in_a_table_that_is_set_as_a_whole() {
    let whole = |key: &str| {
        format!(
            "controller.FSPID.supervisor={{ table = \"mirrored\", range = 5.0, {key} = \"error-and-rate\" }}"
        )
    };
    let (old, new) = (whole("sees"), whole("second_input"));
    let (found, expected) = (read(file::starter(), &[&old]), read(file::starter(), &[&new]));
    assert_eq!(found.scenario, expected.scenario);
    assert_eq!(found.warnings.len(), expected.warnings.len() + 1);
    assert!(found.warnings[0].contains("controller.FSPID.supervisor.sees: `sees` is called"));
}

#[test]
fn an_old_key_is_read_in_the_path_of_a_dispersion_and_is_the_same_place_as_the_new_one() {
    let dispersed = |paths: &str| {
        format!(
            "{}\n[[dispersion]]\n{paths}\ndistribution = \"uniform\"\nlower = 0.15\nupper = 0.25\n",
            scenario(NEW[0], NEW[1])
        )
    };
    let path = |key: &str| format!("controller.FSPID.supervisor.{key}[0]");
    for (key, many) in [("path", false), ("paths", true)] {
        let line = |name: &str| match many {
            true => format!("{key} = [\n  \"{}\"\n]", path(name)),
            false => format!("{key} = \"{}\"", path(name)),
        };
        let text = dispersed(&line("error_sets"));
        let found = read(&text, &[]);
        let expected = read(&dispersed(&line("error_set_centres")), &[]);
        assert_eq!(found.dispersions, expected.dispersions);
        let place = format!("line {}", line_of(&text, "supervisor.error_sets"));
        let warning = told(&place, &path("error_sets"), "error_sets", "error_set_centres");
        assert_eq!(found.warnings.iter().filter(|it| **it == warning).count(), 1);
        let template = Template::parse(&text, "mine.toml", None, &Extra::default()).expect("sound");
        assert!(template.check_dispersions().is_ok());
    }
    let both = format!("paths = [\"{}\", \"{}\"]", path("error_sets"), path("error_set_centres"));
    let problems = set(&dispersed(&both), &[]).expect_err("one place twice").to_string();
    assert!(problems.contains("is drawn already"), "{problems}");
}

#[test]
fn an_old_key_is_read_around_a_mark_and_the_mark_has_the_new_path() {
    let mark = "[{ tune = [0.1, 0.3], start = 0.2 }, 0.5]";
    let text = scenario(&format!("error_sets = {mark}"), "");
    let found = read(&text, &[]);
    let expected = read(&scenario(&format!("error_set_centres = {mark}"), ""), &[]);
    assert_eq!(found.scenario, expected.scenario);
    let [mark] = &found.tunable_parameters[..] else { panic!("{:?}", found.tunable_parameters) };
    assert_eq!(mark.path.text(), "controller.FSPID.supervisor.error_set_centres[0]");
    assert_eq!(mark.free, expected.tunable_parameters[0].free);
    assert_eq!(found.warnings.iter().filter(|it| it.contains("error_sets")).count(), 1);
    // The bytes of the mark are those of the text as it is.
    assert!(text[mark.bytes()].starts_with("{ tune"));
}

#[test]
fn an_old_key_in_a_case_becomes_the_new_one_with_the_line_of_the_case() {
    for (table, key) in [("tuning", "objective"), ("contest", "")] {
        let objective = match key {
            "" => String::new(),
            key => format!("[[{table}.{key}]]\nmeasure = \"iae_deg_s\"\n"),
        };
        let change = "controller.FSPID.supervisor.sees=error-and-rate";
        let text = format!(
            "{}\n[{table}]\n{objective}\n[[{table}.case]]\nname = \"a\"\nset = [\"loop.duration_s=9\", \"{change}\"]\n",
            file::starter()
        );
        let study = read(&text, &[]);
        let cases = match table {
            "tuning" => study.tuning.expect("one").cases,
            _ => study.contest.expect("one").cases,
        };
        assert_eq!(
            cases[0].set,
            ["loop.duration_s=9", "controller.FSPID.supervisor.second_input=error-and-rate"]
        );
        let (path, _) = change.split_once('=').expect("a change");
        let place = format!("line {}", line_of(&text, change));
        let warning = told(&place, path, "sees", "second_input");
        assert_eq!(study.warnings.iter().filter(|it| **it == warning).count(), 1, "{table}");
    }
}

#[test]
fn nothing_that_is_shipped_has_an_old_key() {
    let learned = ["light", "light-six", "transport"].map(|name| {
        let path = format!("data/designs/learned/{name}.toml");
        (path.clone(), text(&path))
    });
    let scenarios = shipped().into_iter().map(|(name, text)| (format!("scenarios/{name}"), text));
    for (name, text) in scenarios.chain(learned) {
        let study = file::parse(&text, &name, repository(&name).parent(), &[]);
        let study = study.unwrap_or_else(|problems| panic!("{problems}"));
        assert!(!study.warnings.iter().any(|it| it.contains("the old key")), "{name}");
    }
}

#[test]
fn an_old_key_is_not_proposed_and_not_in_the_schema() {
    let problems = set(&scenario("see = 1", ""), &[]).expect_err("unknown").to_string();
    assert!(problems.contains("supervisor.see: unknown key\n"), "{problems}");
    assert!(!problems.contains("sees"), "{problems}");
    // In a table that never had it, an old key is a key like any other.
    let problems = set(&scenario("", "sees = 1"), &[]).expect_err("unknown").to_string();
    assert!(problems.contains("controller[1].sees: unknown key"), "{problems}");
    let schema = file::schema().to_string();
    for old in ["sees", "followers", "error_sets", "change_sets"] {
        assert!(!schema.contains(&format!("\"{old}\"")), "{old}");
    }
}

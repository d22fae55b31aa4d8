//! Dispersions: what is read, what is refused in which words, and what is tried before a campaign.

use fspid_scenario::dispersion::Drawn;
use fspid_scenario::file::{self, Extra, NewValue, Template};

fn scenario(dispersion: &str) -> String {
    format!("{}\n[[dispersion]]\n{dispersion}\n", file::starter())
}

fn refused(dispersion: &str) -> String {
    let problems = file::parse(&scenario(dispersion), "x.toml", None, &[]);
    problems.expect_err("a mistake").to_string()
}

fn template(dispersion: &str) -> Template {
    let text = scenario(dispersion);
    let template = Template::parse(&text, "x.toml", None, &Extra::default());
    template.unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn mistakes_in_a_dispersion_are_told_with_what_would_be_right() {
    let path = "path = \"controller[0].kp\"";
    for (dispersion, words) in [
        (format!("{path}\ndistribution = \"gaussian\""), "unknown word"),
        (
            format!("{path}\ndistribution = \"normal\"\nmean = 1.0"),
            "standard_deviation: missing key",
        ),
        (
            format!("{path}\ndistribution = \"seed\"\nmean = 1.0"),
            "says nothing to distribution \"seed\"",
        ),
        (
            format!("{path}\ndistribution = \"uniform\"\nlower = 2.0\nupper = 1.0"),
            "the lower one must come first",
        ),
        (
            format!("{path}\ndistribution = \"log-uniform\"\nlower = -1.0\nupper = 1.0"),
            "both must be above 0",
        ),
        (format!("{path}\ndistribution = \"choice\"\nvalues = []"), "1 to 1000 numbers"),
        (format!("{path}\ndistribution = \"choice\"\nvalues = [1, 2]\nweights = [1.0]"), "weight"),
        (
            format!("{path}\npaths = [\"a\"]\ndistribution = \"seed\""),
            "exactly one of `path` and `paths`",
        ),
        (
            format!("{path}\ndistribution = \"seed\"\nrelative = true"),
            "only numbers can be factors",
        ),
        ("distribution = \"seed\"".to_owned(), "exactly one of `path` and `paths`"),
        ("path = \"a..b\"\ndistribution = \"seed\"".to_owned(), "cannot be read"),
        ("path = \"requirement[0].most\"\ndistribution = \"seed\"".to_owned(), "cannot differ"),
        ("paths = [\"a\", \"a\"]\ndistribution = \"seed\"".to_owned(), "`a` is drawn already"),
        (
            format!(
                "{path}\ndistribution = \"seed\"\n[[dispersion]]\n{path}\ndistribution = \"seed\""
            ),
            "drawn already",
        ),
    ] {
        let text = refused(&dispersion);
        assert!(text.contains(words) && text.contains("dispersion["), "{dispersion}\n{text}");
    }
}

#[test]
fn a_correlation_that_is_none_is_refused_at_its_line() {
    let correlated = |matrix: &str, means: &str| {
        refused(&format!(
            "paths = [\"controller[0].kp\", \"controller[0].ki\"]\ndistribution = \"correlated\"\nmeans = {means}\nstandard_deviations = [0.1, 0.1]\ncorrelation = {matrix}"
        ))
    };
    for (matrix, words) in [
        ("[[1.0, 0.5], [0.4, 1.0]]", "0.4"),
        ("[[1.0, 1.5], [1.5, 1.0]]", "1.5"),
        ("[[1.0], [0.5, 1.0]]", "row"),
        ("[[1.0, nan], [nan, 1.0]]", "no matrix"),
        ("0.5", "no matrix"),
    ] {
        let text = correlated(matrix, "[1.0, 1.0]");
        assert!(text.contains(words) && text.contains("].correlation"), "{matrix}\n{text}");
    }
    let text = correlated("[[1.0, 0.5], [0.5, 1.0]]", "[1.0]");
    assert!(text.contains("1 numbers for 2 paths"), "{text}");
}

/// Its line was that of the table, and "limits (`lower`, `upper`)" were to mend it.
#[test]
fn a_path_that_is_nowhere_is_told_at_its_line_with_the_nearest_that_is() {
    let rest = "distribution = \"uniform\"\nlower = 0.5\nupper = 1.0";
    for (path, nearest, relative) in [
        ("controller[0].Kp", "controller.PID.kp", false),
        ("controller.PID.kpp", "controller.PID.kp", true),
        ("actuator.time_constant", "actuator.time_constant_s", false),
    ] {
        let text = format!("{rest}\nrelative = {relative}\npath = \"{path}\"");
        let problems = template(&text).check_dispersions().expect_err("a misspelt path");
        let told = problems.to_string();
        let words = format!("dispersion[0].path: there is no `{path}`; did you mean `{nearest}`?");
        assert!(told.contains(&words) && !told.contains("`lower`"), "{told}");
        let whole = scenario(&text);
        let line = whole.lines().position(|line| line.starts_with("path = ")).expect("there") + 1;
        assert!(told.starts_with(&format!("x.toml:{line}:8: ")), "{line}: {told}");
    }
    let several = format!("{rest}\npaths = [\"controller[0].kp\", \"controller[0].kq\"]");
    let problems = template(&several).check_dispersions().expect_err("a misspelt path");
    assert!(problems.to_string().contains("dispersion[0].paths[1]: there is no"), "{problems}");
}

#[test]
fn a_dispersion_that_would_make_the_scenario_wrong_is_found_before_a_campaign() {
    let normal = "path = \"actuator.time_constant_s\"\ndistribution = \"normal\"\nmean = 0.1\nstandard_deviation = 0.05";
    let problems = template(normal).check_dispersions().expect_err("negative times").to_string();
    assert!(problems.contains("dispersion[0]: actuator.time_constant_s=-0.0"), "{problems}");
    let line =
        scenario(normal).lines().position(|line| line == "[[dispersion]]").expect("there") + 1;
    assert!(problems.starts_with(&format!("x.toml:{line}:")), "its own line {line}: {problems}");
    assert!(problems.contains("`lower`, `upper`"), "{problems}");
    let cut = format!("{normal}\nlower = 0.01");
    assert_eq!(template(&cut).check_dispersions(), Ok(vec![Vec::new()]));
    let nothing =
        "path = \"controller[0].nothing\"\ndistribution = \"uniform\"\nlower = 0.0\nupper = 1.0";
    let problems = template(nothing).check_dispersions().expect_err("no such key").to_string();
    assert!(problems.contains("there is no `controller[0].nothing`"), "{problems}");
    let factor = "path = \"controller[0].rate_gain\"\ndistribution = \"uniform\"\nlower = 0.5\nupper = 1.0\nrelative = true";
    let problems = template(factor).check_dispersions().expect_err("nothing to scale").to_string();
    assert!(problems.contains("there is no number at `controller[0].rate_gain`"), "{problems}");
    let draws = |path: &str| {
        format!("path = \"{path}\"\ndistribution = \"uniform\"\nlower = 0.5\nupper = 1.0")
    };
    for [one, other] in [["PID", "0"], ["0", "00"]] {
        let of = |it: &str| match it.starts_with('P') {
            true => format!("controller.{it}.kp"),
            false => format!("controller[{it}].kp"),
        };
        let twice = format!("{}\n[[dispersion]]\n{}", draws(&of(one)), draws(&of(other)));
        let problems = template(&twice).check_dispersions().expect_err("drawn twice").to_string();
        let said = format!("`{}` is drawn already, as `{}`", of(other), of(one));
        assert!(problems.contains(&said) && problems.contains("dispersion[1]"), "{problems}");
    }
    let renamed =
        "path = \"controller[0].name\"\ndistribution = \"choice\"\nvalues = [\"PID\", \"other\"]";
    let problems = template(renamed).check_dispersions().expect_err("another name").to_string();
    assert!(problems.contains("changes the controllers"), "{problems}");
}

#[test]
fn draws_become_values_and_factors_go_with_what_stands_in_the_preset() {
    let template = template(
        "name = \"gain\"\npaths = [\"plant.preset.numerator[0]\", \"plant.preset.numerator[1]\"]\ndistribution = \"uniform\"\nlower = 0.5\nupper = 1.5\nrelative = true\n[[dispersion]]\npath = \"controller[0].integral\"\ndistribution = \"choice\"\nvalues = [\"literal\", \"bumpless\"]",
    );
    let nominal = template.check_dispersions().expect("sound");
    let [gain, kind] = template.study().dispersions.as_slice() else { panic!("two") };
    assert_eq!(gain.names().collect::<Vec<_>>(), ["gain"]);
    let mut drawn = Vec::new();
    gain.draw(&[0.5], &mut drawn);
    kind.draw(&[0.9], &mut drawn);
    assert_eq!(drawn, [Drawn::Number(1.0), Drawn::Text("bumpless".to_owned())]);
    let values = gain.values(&[Drawn::Number(2.0)], &nominal[0]);
    let numbers: Vec<String> = values.iter().map(|(_, value)| value.to_string()).collect();
    let plant = file::preset("navion-paper").expect("carried");
    let doubled: Vec<String> =
        plant.numerator.iter().take(2).map(|x| format!("{:?}", 2.0 * x)).collect();
    assert_eq!(numbers, doubled);
    let chosen = kind.values(&drawn[1..], &nominal[1]);
    assert_eq!(chosen[0].1, NewValue::Text("bumpless".to_owned()));
}

/// A campaign went on with another plant than it had begun with.
#[test]
fn the_digest_is_of_files_that_only_a_dispersion_names_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let plant = |name: &str, damping: f64| {
        let text = format!(
            "name = \"own\"\ntitle = \"own\"\nnumerator = [1.0]\ndenominator = [1.0, {damping:?}, 0.0]\nelevator_sign = \"nose-up-positive\"\nsource = \"made up\"\n"
        );
        std::fs::write(folder.path().join(name), text).expect("a file");
    };
    let text = scenario(
        "path = \"plant.file\"\ndistribution = \"choice\"\nvalues = [\"a.toml\", \"b.toml\"]",
    );
    let text = text.replace("preset = \"navion-paper\"", "file = \"a.toml\"");
    let study = || file::parse(&text, "x.toml", Some(folder.path()), &[]);
    let study = || study().unwrap_or_else(|problems| panic!("{problems}"));
    plant("a.toml", 1.0);
    plant("b.toml", 2.0);
    let before = study();
    assert_eq!(before.files, ["a.toml", "b.toml"]);
    assert_eq!(before.digest, study().digest);
    plant("b.toml", 2.1);
    assert_ne!(before.digest, study().digest);
    let template = Template::parse(&text, "x.toml", Some(folder.path()), &Extra::default());
    assert_eq!(template.expect("a scenario").study().digest, study().digest);
}

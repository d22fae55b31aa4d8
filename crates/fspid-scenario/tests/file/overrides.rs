use fspid_scenario::file;

fn set(overrides: &[&str]) -> Result<file::Study, file::Problems> {
    let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
    file::parse(file::starter(), "starter.toml", None, &overrides)
}

fn problem(text: &str) -> file::Problem {
    let problems = set(&[text]).expect_err(text);
    assert_eq!(problems.list.len(), 1, "{problems}");
    problems.list[0].clone()
}

#[test]
fn a_value_is_set_by_its_path() {
    let study = set(&["loop.sample_period_s=0.02", "plant.preset=b747-paper", "name=two words"]);
    let scenario = study.expect("allowed").scenario;
    assert_eq!(scenario.timing.dt_s(), 0.02);
    assert_eq!(Some(scenario.plant), file::preset("b747-paper").map(|file| file.plant.into()));
    assert_eq!(scenario.name, "two words");
}

#[test]
fn a_controller_is_addressed_by_name_or_index() {
    for path in [
        "controller.FSPID.nominal.kp",
        "controller[1].nominal.kp",
        "controller.\"FSPID\".nominal.kp",
    ] {
        let study = set(&[&format!("{path}=2.5")]).expect("allowed");
        assert_eq!(study.scenario.controllers[1].controller.nominal().kp, 2.5, "{path}");
    }
}

#[test]
fn a_key_or_table_that_the_file_leaves_out_can_be_set() {
    let study = set(&["controller.PID.isa.gain=3", "setpoint.at_s=1"]);
    let problems = study.expect_err("kp and isa exclude each other").to_string();
    assert!(problems.contains("controller[0].isa: not together with `kp`"), "{problems}");
    let study = set(&["controller.PID.output_limits_deg=[-5, 5]"]).expect("allowed");
    assert!(study.scenario.controllers[0].controller.config().limits.is_some());
}

#[test]
fn later_settings_win() {
    let study = set(&["controller[0].kp=3", "controller.PID.kp=4"]).expect("allowed");
    assert_eq!(study.scenario.controllers[0].controller.nominal().kp, 4.0);
}

#[test]
fn what_is_wrong_with_a_setting_is_told_with_the_setting() {
    let found = problem("loop.sample_period_s=0");
    assert_eq!(found.origin.as_deref(), Some("--set loop.sample_period_s=0"));
    assert_eq!((found.path.as_str(), found.found.as_str()), ("loop.sample_period_s", "0"));
}

#[test]
fn an_unknown_path_says_what_is_known() {
    let found = problem("loop.sample_perod_s=0.01");
    assert!(found.message.contains("did you mean `sample_period_s`?"), "{found:?}");
    let found = problem("controller.FPID.nominal.kp=2");
    assert!(
        found.message.contains("did you mean `FSPID`?") && found.allowed.contains("PID, FSPID"),
        "{found:?}"
    );
    let found = problem("controller[2].kp=2");
    assert!(found.allowed.contains("0 to 1"), "{found:?}");
    let found = problem("colour.of=red");
    assert!(
        found.message.contains("unknown key") && found.allowed.contains("controller"),
        "{found:?}"
    );
    let found = problem("name.first=x");
    assert!(found.message.contains("it is text"), "{found:?}");
}

#[test]
fn a_setting_that_cannot_be_read_is_refused() {
    for text in [
        "loop",
        "=3",
        "loop..x=1",
        "loop.duration_s=[1",
        "controller[x].kp=1",
        "controller[0.kp=1",
        "name=\"open",
        "name=\"a\"\nplant = 3",
        "loop.duration_s=",
    ] {
        let found = problem(text);
        assert!(found.origin.is_some_and(|origin| origin.starts_with("--set ")), "{text}");
    }
    let deep = format!("loop.duration_s={}", "[".repeat(100_000));
    assert!(set(&[&deep]).is_err());
    let deep = format!("{}=1", vec!["a"; 100_000].join("."));
    assert!(set(&[&deep]).is_err());
}

/// The whole list of the shipped file was quoted, and a matrix that no file knows.
#[test]
fn an_overflow_names_the_number_that_was_set() {
    for (set, path) in [
        ("plant.preset.numerator[0]=1e308", "numerator[0]"),
        ("plant.preset.denominator[0]=1e-308", "denominator[0]"),
    ] {
        let found = problem(set);
        let (_, value) = set.split_once('=').expect("two parts");
        assert_eq!((found.path.as_str(), found.found.as_str()), (path, value), "{found:?}");
        assert_eq!(found.origin.as_deref(), Some(format!("--set {set}").as_str()));
    }
}

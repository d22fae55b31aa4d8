use std::path::Path;

use fspid_scenario::file::{self, LoadError};
use fspid_scenario::measure::Measure;
use fspid_sim::Controller;

use crate::file::{repository, shipped, text};

fn parse(text: &str) -> Result<file::Study, file::Problems> {
    file::parse(text, "test.toml", None, &[])
}

#[test]
fn the_starter_is_without_problems_and_warnings_and_flies() {
    let study = parse(file::starter()).expect("no problems");
    assert!(study.warnings.is_empty(), "{:?}", study.warnings);
    let flight = fspid_sim::simulate(&study.scenario).expect("it flies");
    assert_eq!(flight.traces.len(), 2);
    assert!(flight.traces.iter().all(|trace| trace.time_s.len() == 1001));
}

#[test]
fn the_first_line_of_the_starter_names_its_schema_to_an_editor() {
    assert!(file::starter().starts_with("#:schema "));
}

/// Any roughness was taken: 7 m blew 22 times as hard at height as was asked for, from the other side, and `check` was
/// content; at 20 ft the wind was infinite.
#[test]
fn a_wind_over_ground_rougher_than_the_layer_is_deep_is_refused() {
    let rough = |roughness_m: f64| {
        let set = [format!("wind.roughness_m={roughness_m:?}")];
        let name = "scenarios/gallery/wind-shear.toml";
        file::parse(&text(name), name, None, &set)
    };
    for allowed_m in [0.045_72, 0.6096, 0.9144] {
        assert!(rough(allowed_m).is_ok(), "{allowed_m}");
    }
    for refused_m in [0.92, 3.0, 6.096, 7.0, 0.0, -1.0, f64::NAN] {
        let told = rough(refused_m).expect_err("refused").to_string();
        assert!(told.contains("wind.roughness_m"), "{told}");
        assert!(refused_m.is_nan() || told.contains("allowed: above 0, up to 0.9144 m"), "{told}");
    }
}

#[test]
fn every_commented_line_of_the_starter_may_be_uncommented() {
    for line in file::starter().lines() {
        let Some(commented) = line.strip_prefix("# ") else {
            continue;
        };
        let is_key = commented.split(" = ").next().is_some_and(|key| {
            key.ends_with("_deg") || key.ends_with("_s") || key == "delay_samples"
        });
        if is_key
            && !commented.starts_with("at_s")
            && !commented.starts_with("width_s")
            && !commented.starts_with("amplitude_deg")
        {
            let study = parse(&file::starter().replace(line, commented));
            assert!(study.is_ok(), "{commented}: {study:?}");
        }
    }
    let uncommented = |from: &str| {
        let (before, block) = file::starter().split_once(from).expect("the block is there");
        let end = block.find("\n\n").unwrap_or(block.len());
        let (block, after) = block.split_at(end);
        format!("{before}{}{}{after}", &from[2..], block.replace("\n# ", "\n"))
    };
    let study = parse(&uncommented("# [[requirement]]"));
    let study = study.unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!((study.scenario.disturbances.len(), study.requirements.len()), (1, 1));
}

#[test]
fn every_shipped_scenario_flies_without_a_warning() {
    let names: Vec<String> = shipped().into_iter().map(|(name, _)| name).collect();
    assert!(names.len() >= 6, "{names:?}");
    for name in names {
        let study = file::load(&repository("scenarios").join(&name), &[]);
        let study = study.unwrap_or_else(|error| panic!("{error}"));
        assert!(study.warnings.is_empty(), "{name}: {:?}", study.warnings);
        let flight = fspid_sim::simulate(&study.scenario).expect("it flies");
        for trace in &flight.traces {
            assert_eq!(trace.outcome, fspid_sim::Outcome::Completed, "{name}");
        }
    }
}

#[test]
fn every_plant_that_is_carried_says_what_it_is_and_where_it_is_from() {
    let names = file::plant_names();
    assert_eq!(
        names,
        ["b747-paper", "navion-paper", "b747-short-period", "navion-full", "ctms-pitch"]
    );
    for name in names {
        let text = text(&format!("data/plants/{name}.toml"));
        let plant = file::parse_plant(&text, name).unwrap_or_else(|problems| panic!("{problems}"));
        assert_eq!(file::preset(name).as_ref(), Some(&plant));
        assert_eq!(plant.name, name);
        assert!(!plant.title.is_empty() && plant.source.len() > 40, "{name}");
        assert!(plant.condition.aircraft.is_some(), "{name}");
    }
    assert_eq!(file::preset("concorde"), None);
}

/// A push of the elevator that the sign calls nose up must raise the nose.
#[test]
fn the_elevator_sign_of_every_plant_agrees_with_its_numerator() {
    for name in file::plant_names() {
        let plant = file::preset(name).expect("carried");
        let nose_up = plant.numerator[0] * plant.elevator_sign.per_nose_up();
        assert!(nose_up > 0.0, "{name}");
    }
}

/// Natural frequency and damping in the notes of the data are those of the coefficients.
#[test]
fn the_modes_of_the_747_are_those_of_its_notes() {
    let plant = file::preset("b747-paper").expect("carried");
    let poles = plant.plant.transfer_function().poles().expect("found");
    let slowest = poles.iter().map(|pole| pole.re.hypot(pole.im)).fold(f64::INFINITY, f64::min);
    assert!((slowest - 0.068_651_97).abs() < 1e-8, "{slowest}");
}

#[test]
fn the_rule_tables_are_the_printed_one_and_its_mirror_image() {
    let printed = file::rule_table("printed").expect("carried");
    assert_eq!(file::rule_table("mirrored"), Some(printed.mirrored()));
    assert_eq!(file::rule_table("tilted"), None);
}

#[test]
fn degrees_of_the_file_are_radians_of_the_controller() {
    let study = file::load(&repository("scenarios/limits.toml"), &[]).expect("no problems");
    let controller = &study.scenario.controllers[1].controller;
    let limits = controller.config().limits.expect("has limits");
    assert!((limits.upper() - 8.0_f64.to_radians()).abs() < 1e-15);
    let fspid = parse(file::starter()).expect("no problems").scenario.controllers[1].controller;
    let Controller::SelfTuning(fspid) = fspid else { panic!("a self-tuning controller") };
    // One degree is an error of 1 to the supervisor; the answer is that of the rules themselves.
    let table = file::rule_table("mirrored").expect("carried");
    let rules = fspid_fuzzy::Supervisor::new(
        &table,
        5.0,
        fspid_fuzzy::Defuzzifier::Exact,
        fspid_fuzzy::OutOfRange::Clamp,
    );
    let delta = rules.expect("allowed").infer(1.0, 0.0).expect("inside").delta;
    let mut state = fspid_core::State::new();
    let sample = fspid_core::Sample {
        setpoint_rad: 1.0_f64.to_radians(),
        measurement_rad: 0.0,
        rate_rad_s: 0.0,
    };
    let gains = fspid.step(&mut state, sample).gains;
    assert!((gains.kp - (1.0 + 0.05 * delta.kp)).abs() < 1e-14, "{gains:?}");
    assert!((gains.kd - (0.05 + 0.01 * delta.kd)).abs() < 1e-14, "{gains:?}");
}

#[test]
fn the_isa_form_gives_the_parallel_gains_and_the_filter() {
    let study = file::load(&repository("scenarios/limits.toml"), &[]).expect("no problems");
    let isa = &study.scenario.controllers[3].controller;
    let parallel = &study.scenario.controllers[2].controller;
    assert_eq!(isa.nominal(), parallel.nominal());
    assert_eq!(isa.config().derivative, parallel.config().derivative);
    assert_eq!(isa.config().setpoint_weights.derivative, 0.0);
    assert_eq!(isa.config().setpoint_weights.proportional, 0.5);
}

#[test]
fn what_is_left_out_takes_the_documented_default() {
    let study = file::load(&repository("scenarios/747-pitch-step.toml"), &[]).expect("no problems");
    for named in &study.scenario.controllers {
        let config = named.controller.config();
        let expected = fspid_core::PidConfig {
            rate_gain_s: config.rate_gain_s,
            ..fspid_core::PidConfig::sampled_every(0.01)
        };
        assert_eq!(*config, expected, "{}", named.name);
    }
    let names: Vec<&str> =
        study.scenario.controllers.iter().map(|named| named.name.as_str()).collect();
    assert_eq!(names, ["PC", "CPID", "FSPID"]);
    assert_eq!(study.scenario.controllers[0].controller.config().rate_gain_s, 0.9144);
}

#[test]
fn an_absent_actuator_is_an_ideal_servo() {
    let (before, rest) = file::starter().split_once("[actuator]").expect("there is one");
    let (_, after) = rest.split_once("[loop]").expect("there is one");
    let study = parse(&format!("{before}[loop]{after}")).expect("no problems");
    assert_eq!(study.scenario.actuator, fspid_sim::Actuator::ideal());
}

#[test]
fn a_requirement_is_read_with_its_measure_and_controller() {
    let study = file::load(&repository("scenarios/limits.toml"), &[]).expect("no problems");
    let [requirement] = study.requirements.as_slice() else { panic!("one requirement") };
    assert_eq!(requirement.controller.as_deref(), Some("back-calculation"));
    assert_eq!(requirement.measure, Measure::Overshoot);
    assert_eq!((requirement.least, requirement.most), (None, Some(10.0)));
}

#[test]
fn integers_are_numbers_where_numbers_are_asked_for() {
    let text = file::starter();
    let whole = text.replace("duration_s = 10.0", "duration_s = 10").replace("kp = 1.0", "kp = 1");
    let (a, b) = (parse(text).expect("good"), parse(&whole).expect("good"));
    assert_eq!(a.scenario, b.scenario);
}

#[test]
fn an_accumulating_law_without_gain_limits_warns_of_its_drift_at_rest() {
    let (before, rest) = text("scenarios/square-accumulating.toml")
        .split_once("[controller.gain_limits]")
        .map(|(a, b)| (a.to_owned(), b.to_owned()))
        .expect("has limits");
    let (_, after) = rest.split_once("[controller.supervisor]").expect("has a supervisor");
    let free = format!("{before}[controller.supervisor]{after}")
        .replace("leakage_per_s = 0.1\n", "")
        .replace("output_scale = { kp = 0.01, ki = 0.001, kd = 0.001 }", "")
        .replace("range = 40.0", "range = 5.0");
    let study = parse(&free).expect("it is allowed");
    let [warning] = study.warnings.as_slice() else { panic!("{:?}", study.warnings) };
    assert!(
        warning.contains("controller[1]")
            && warning.contains("kp by +0.2165")
            && warning.contains("kd by -1.6666"),
        "{warning}"
    );
    // A limit on the side of the drift, or a dead zone, ends it.
    for cure in [
        "gain_limits = { kp_max = 9, kd_min = -9 }",
        "dead_zone = { error_deg = 0.1, change_deg_s = 0.1 }",
    ] {
        let study =
            parse(&free.replace("law = ", &format!("{cure}\nlaw = "))).expect("it is allowed");
        assert!(study.warnings.is_empty(), "{:?}", study.warnings);
    }
}

#[test]
fn an_event_after_the_end_and_a_sine_too_fast_for_the_samples_are_warned_of() {
    let late = file::starter().replace("at_s = 0.0", "at_s = 11.0");
    let warnings = parse(&late).expect("it is allowed").warnings;
    assert!(warnings.len() == 1 && warnings[0].contains("setpoint.at_s is 11.0 s"), "{warnings:?}");
    let fast = file::starter().replacen("kind = \"step\"", "kind = \"sine\"\nfrequency_hz = 51", 1);
    let warnings = parse(&fast).expect("it is allowed").warnings;
    assert!(warnings.len() == 1 && warnings[0].contains("at most 50.0 Hz"), "{warnings:?}");
}

fn warnings(changes: &[&str]) -> Vec<String> {
    let changes: Vec<String> = changes.iter().map(|&it| it.to_owned()).collect();
    let study = file::parse(file::starter(), "test.toml", None, &changes);
    study.expect("it is allowed").warnings
}

/// "good; … 2 samples of 20.0 s" of a flight of 10 s, and half a sample was one without a word.
#[test]
fn a_sample_that_is_longer_than_the_flight_is_warned_of() {
    let long = warnings(&["loop.sample_period_s=20", "disturbance=[]"]);
    let told = "loop.sample_period_s is 20.0 s, longer than the flight of 10.0 s: one sample period is flown, and the flight ends at 20.0 s";
    assert!(long.iter().any(|it| it == told), "{long:?}");
    let brief = warnings(&["loop.duration_s=0.005", "disturbance=[]"]);
    assert!(brief.iter().any(|it| it.ends_with("the flight ends at 0.01 s")), "{brief:?}");
    assert!(warnings(&["loop.duration_s=0.01", "disturbance=[]"]).is_empty());
}

#[test]
fn a_supervisor_that_sees_nothing_is_warned_of() {
    let scale = |which| format!("controller.FSPID.supervisor.{which}_scale=0");
    let [error, change] = [scale("error"), scale("change")];
    let found = warnings(&[&error, &change]);
    assert!(found.len() == 1 && found[0].contains("the supervisor sees nothing"), "{found:?}");
    assert!(warnings(&[&error]).is_empty() && warnings(&[&change]).is_empty());
}

#[test]
fn a_controller_that_commands_nothing_is_warned_of() {
    let zero = |name: &str| ["kp", "ki", "kd"].map(|gain| format!("controller.{name}.{gain}=0"));
    let [kp, ki, kd] = zero("PID");
    let found = warnings(&[&kp, &ki, &kd]);
    assert!(found.len() == 1 && found[0].contains("this controller commands nothing"), "{found:?}");
    assert!(warnings(&[&kp, &ki]).is_empty());
    assert!(warnings(&[&kp, &ki, &kd, "controller.PID.feedforward=1"]).is_empty());
    // A self-tuner begins at 0 and moves.
    let [kp, ki, kd] = zero("FSPID.nominal");
    let none = |gain| format!("controller.FSPID.supervisor.output_scale.{gain}=0");
    let none = ["kp", "ki", "kd"].map(none);
    assert!(warnings(&[&kp, &ki, &kd]).is_empty());
    let found = warnings(&[&kp, &ki, &kd, &none[0], &none[1], &none[2]]);
    assert!(found.len() == 1 && found[0].contains("this controller commands nothing"), "{found:?}");
}

/// It was "good" without a word, and unstable or turned around.
#[test]
fn gains_of_a_sign_that_turns_the_loop_around_are_warned_of() {
    let [kp, ki, kd] = ["kp=-1.5", "ki=-0.5", "kd=-0.15"].map(|it| format!("controller.PID.{it}"));
    let found = warnings(&[&kp, &ki, &kd]);
    assert!(found.len() == 1 && found[0].contains("kp is negative"), "{found:?}");
    assert!(
        found[0].ends_with("(kp = 1.5); if kp is meant so, is elevator_sign right?"),
        "{found:?}"
    );
    assert!(warnings(&[&ki, &kd]).is_empty());
}

#[test]
fn the_digest_follows_text_overrides_and_the_files_referred_to() {
    let folder = tempfile::tempdir().expect("a folder");
    let plant = folder.path().join("mine.toml");
    std::fs::write(&plant, text("data/plants/navion-paper.toml")).expect("written");
    let scenario = file::starter().replace("preset = \"navion-paper\"", "file = \"mine.toml\"");
    let digest = |text: &str, set: &[&str]| {
        let set: Vec<String> = set.iter().map(|&text| text.to_owned()).collect();
        let study = file::parse(text, "x", Some(folder.path()), &set);
        study.unwrap_or_else(|problems| panic!("{problems}")).digest
    };
    let first = digest(&scenario, &[]);
    assert_eq!(first.len(), 64);
    assert_eq!(first, digest(&scenario, &[]));
    assert_ne!(first, digest(&format!("{scenario}\n"), &[]));
    assert_ne!(first, digest(&scenario, &["loop.duration_s=10"]));
    // The same bytes in a row, once as text alone and once as text and setting.
    let (text_alone, with_setting) = (format!("{scenario}# name=a"), format!("{scenario}# "));
    assert_ne!(digest(&text_alone, &[]), digest(&with_setting, &["name=a"]));
    let changed = text("data/plants/navion-paper.toml").replace("22.578", "22.579");
    std::fs::write(&plant, changed).expect("written");
    assert_ne!(first, digest(&scenario, &[]));
}

#[test]
fn files_that_are_referred_to_are_regular_files_relative_to_the_scenario() {
    let folder = tempfile::tempdir().expect("a folder");
    let inner = folder.path().join("rules");
    std::fs::create_dir_all(inner.join("folder.toml")).expect("made");
    std::fs::write(inner.join("mine.toml"), text("data/rule-tables/printed.toml"))
        .expect("written");
    let scenario = |table: &str| {
        file::starter().replace("table = \"mirrored\"", &format!("table = \"{table}\""))
    };
    let path = folder.path().join("scenario.toml");
    std::fs::write(&path, scenario("rules/mine.toml")).expect("written");
    assert!(file::load(&path, &[]).is_ok());
    for (table, words) in
        [("rules/folder.toml", "no regular file"), ("rules/none.toml", "no such file")]
    {
        std::fs::write(&path, scenario(table)).expect("written");
        let Err(LoadError::Problems(problems)) = file::load(&path, &[]) else { panic!("{table}") };
        assert_eq!(problems.list[0].path, "controller[1].supervisor.table");
        assert!(problems.to_string().contains(words), "{problems}");
    }
    let without_folder = parse(&scenario("rules/mine.toml")).expect_err("no folder");
    assert!(without_folder.to_string().contains("not in a folder"), "{without_folder}");
}

#[test]
fn a_problem_in_another_file_is_told_with_that_files_name_and_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let rules = text("data/rule-tables/printed.toml").replacen(
        "PM PM PS ZO NS NM NM",
        "PM PM PS ZO XX NM NM",
        1,
    );
    let line = rules.lines().position(|line| line.contains("XX")).expect("there") + 1;
    std::fs::write(folder.path().join("rules.toml"), rules).expect("written");
    let scenario = file::starter().replace("table = \"mirrored\"", "table = \"rules.toml\"");
    let problems =
        file::parse(&scenario, "s.toml", Some(folder.path()), &[]).expect_err("a bad cell");
    let [problem] = problems.list.as_slice() else { panic!("{problems}") };
    assert_eq!(
        (problem.origin.as_deref(), problem.line_and_column()),
        (Some("rules.toml"), (line, 13))
    );
    assert!(problem.message.contains("row 4 (error ZO), column 5 (change PS)"), "{problems}");
    assert_eq!(problem.found, "XX");
}

#[test]
fn a_file_that_cannot_be_read_is_unreadable_and_not_wrong() {
    for path in [Path::new("no-such-file.toml").to_owned(), repository("scenarios")] {
        assert!(matches!(file::load(&path, &[]), Err(LoadError::Unreadable { .. })));
    }
}

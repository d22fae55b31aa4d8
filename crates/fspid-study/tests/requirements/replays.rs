//! A replay gives the number of its line again, bit for bit.

use std::path::Path;

use fspid_scenario::file;
use fspid_scenario::measure::Measure;
use fspid_scenario::requirement::SET_NAMES;
use fspid_study::judgement::{Judgement, NotEvaluated};
use fspid_study::simulation::Simulation;
use fspid_study::verify::Verification;

use crate::requirements::{JUMBO, repository, verified, written};

/// Every measure without a limit that anything could miss.
fn every_measure() -> String {
    let requirement = |measure: Measure| {
        let conditions = match measure {
            Measure::RecoveryTime => "within_deg = 2.0\n",
            Measure::AltitudeOvershoot => "target_ft = 0.0\n",
            _ => "",
        };
        let limit = if measure.is_yes_or_no() { "" } else { "least = 0.0\n" };
        format!("[[requirement]]\nmeasure = \"{}\"\n{limit}{conditions}\n", measure.name())
    };
    Measure::ALL.into_iter().map(requirement).collect()
}

fn bits(judgement: &Judgement) -> Result<u64, String> {
    match &judgement.found {
        Ok(case) => Ok(case.value.to_bits()),
        // Where it was found is another place in a scenario of one controller.
        Err(NotEvaluated::Unstable { spectral_radius, .. }) => {
            Err(format!("{}", spectral_radius.to_bits()))
        }
        Err(reason) => Err(reason.to_string()),
    }
}

/// Writes the replays of a verification into a folder and judges each of them alone, by `verify` and by `simulate`.
fn replay_all(verification: &Verification, folder: &Path) -> usize {
    std::fs::create_dir_all(folder).expect("made");
    let replays = verification.replays(folder);
    assert_eq!(replays.len(), verification.judgements.len());
    for (replay, judgement) in replays.iter().zip(&verification.judgements) {
        let path = folder.join(&replay.name);
        std::fs::write(&path, &replay.text).expect("written");
        let again = verified(&path, &[], &[]);
        let [alone] = again.judgements.as_slice() else { panic!("{}: one line", replay.name) };
        assert_eq!(bits(alone), bits(judgement), "{}\n{}", replay.name, replay.text);
        assert_eq!(alone.met, judgement.met, "{}", replay.name);
        assert_eq!(alone.requirement.id, judgement.requirement.id);
        let simulated = Simulation::of(&file::load(&path, &[]).expect("read")).expect("it flies");
        assert_eq!(simulated.judgements, again.judgements, "one judging code for both");
    }
    replays.len()
}

#[test]
fn every_measure_of_every_controller_is_replayed_bit_for_bit() {
    let (folder, path) = written(&format!("{JUMBO}\n{}", every_measure()));
    let replayed = replay_all(&verified(&path, &[], &[]), &folder.path().join("replay"));
    assert!(replayed > 50, "{replayed}");
}

/// A rate loop and a set-point weight that go with the gains were those of the nominal gains in the replay: 30.8 deg of phase
/// margin, too little, were 50.1 deg and enough.
#[test]
fn what_goes_with_frozen_gains_is_replayed_as_it_is_there() {
    let (folder, path) = written(&format!("{JUMBO}\n{}", every_measure()));
    let coupled =
        "controller.FSPID.gain_coupling={ rate_gain_per_kd = 0.4, setpoint_weight_per_kp = 0.1 }";
    let verification = verified(&path, &[coupled], &[]);
    let moved = |it: &&Judgement| it.controller == "FSPID" && it.place().frozen.is_some();
    assert!(verification.judgements.iter().filter(moved).count() > 2);
    replay_all(&verification, &folder.path().join("replay"));
}

/// The flight of the scenario is well, and the one of the ready set's own step leaves the range of the aircraft's data:
/// this used to be PASS, beside a replay that the program calls failed.
#[test]
fn a_flight_of_a_set_s_own_that_fails_is_told_and_its_replay_fails_too() {
    let step = include_str!("../../../../scenarios/gallery/navion-step.toml");
    let (flight, _) = step.split_once("[[requirement]]").expect("it asks for an overshoot");
    let (folder, path) = written(flight);
    let set = [
        "ctms",
        "controller.PID.kp=3",
        "controller.PID.ki=3",
        "controller.PID.kd=1.2",
        "controller.PID.setpoint_weights.proportional=0.6",
        "loop.duration_s=30",
        "aircraft.name.validity.alpha_deg[1]=5",
    ];
    let verification = verified(&path, &set, &[]);
    let [failed] = verification.failed_flights.as_slice() else {
        panic!("{:?}", verification.failed_flights)
    };
    assert!(failed.own_step_deg.is_some_and(|step_deg| (step_deg - 11.46).abs() < 0.01));
    assert!(failed.failures[0].starts_with("left the range of its model at t = 1"), "{failed:?}");
    assert_eq!((verification.unmet(), verification.all_met()), (0, false));
    let told = verification.text(None);
    assert!(
        told.contains("- PID, on a flight of its own with a step of 11.4592 deg: left"),
        "{told}"
    );
    assert!(told.ends_with("met; 1 flight failed; FAIL\n"), "{told}");
    assert!(
        verification.junit(None).contains("<testcase name=\"flight with a step of 11.4592 deg\"")
    );
    let own = &verification.json(None)["failed_flights"][0]["own_flight"];
    assert_eq!(own["step_deg"], failed.own_step_deg.expect("seen above"));
    for replay in verification.replays(folder.path()) {
        let again = file::parse(&replay.text, "replay", Some(folder.path()), &[]).expect("read");
        let again = Simulation::of(&again).expect("it flies");
        assert_eq!(again.failed_flights()[0].failures, failed.failures, "{}", replay.name);
    }
}

/// A file was written for it that nobody could read.
#[test]
fn a_line_that_lacks_its_target_has_no_replay() {
    let folder = tempfile::tempdir().expect("a folder");
    let verification = verified(&repository("scenarios/gallery/sensor-ahrs.toml"), &["rvsm"], &[]);
    let lacks = |it: &&Judgement| matches!(it.found, Err(NotEvaluated::NoTarget));
    let lacking = verification.judgements.iter().filter(lacks).count();
    let replays = verification.replays(folder.path());
    assert_eq!((lacking, replays.len()), (1, verification.judgements.len() - 1));
    for replay in replays {
        let again = file::parse(&replay.text, "replay", Some(folder.path()), &[]);
        assert!(again.is_ok(), "{}", replay.name);
    }
}

/// The scenarios of a folder and those below it that have an autopilot.
fn with_autopilot(folder: &Path) -> Vec<std::path::PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut paths: Vec<_> = entries.map(|entry| entry.expect("readable").path()).collect();
    paths.sort();
    let mut found = Vec::new();
    for path in paths {
        if path.is_dir() {
            found.extend(with_autopilot(&path));
        } else if path.extension().is_some_and(|extension| extension == "toml")
            && file::load(&path, &[]).is_ok_and(|study| study.scenario.autopilot.is_some())
        {
            found.push(path);
        }
    }
    found
}

/// Such a flight is one of the pitch loop alone. Its replay kept the outer loops, which commanded something else: a PASS
/// with a final error of 0.0002 % was replayed as a FAIL with 90 %.
#[test]
fn a_line_on_a_flight_of_its_own_is_replayed_without_the_autopilot_that_the_flight_has_not() {
    let mut paths = with_autopilot(&repository("scenarios"));
    paths.push(repository("crates/fspid-scenario/tests/scenarios/every-key-autopilot.toml"));
    assert!(paths.len() > 5, "{paths:?}");
    // Nobody but who asks says which altitude is aimed at.
    let aimed = |&name: &&'static str| match name {
        "rvsm" => "rvsm:target_ft=1200",
        name => name,
    };
    let sets: Vec<&str> = SET_NAMES.iter().map(aimed).collect();
    for path in paths {
        let folder = tempfile::tempdir().expect("a folder");
        let verification = verified(&path, &sets, &[]);
        replay_all(&verification, folder.path());
        let own = verification.judgements.iter().filter(|it| it.own_step_deg.is_some());
        assert!(own.count() > 3, "{}", path.display());
        let told = verification.text(None).split_whitespace().collect::<Vec<_>>().join(" ");
        let note = "in place of its command and of the pitch loop alone, without the outer loops, modes, total energy and glide slope around it; everything else is as written.";
        assert!(told.contains(note), "{told}");
    }
}

/// Changes of what is left out, in files that it names, would have no place in the replay.
#[test]
fn changes_inside_of_the_autopilot_are_not_in_replays_without_it() {
    let path = repository("crates/fspid-scenario/tests/scenarios/every-key-autopilot.toml");
    let folder = tempfile::tempdir().expect("a folder");
    let inside = "outer_loop.climb.supervisor.table.name=another";
    let verification = verified(&path, &["ctms", "mil-f-9490d", inside], &[]);
    replay_all(&verification, folder.path());
    for (replay, judgement) in
        verification.replays(folder.path()).iter().zip(&verification.judgements)
    {
        let keeps = replay.text.contains("outer_loop[1].supervisor.table");
        assert_eq!(keeps, judgement.own_step_deg.is_none(), "{}", replay.text);
    }
}

/// Its own flight used not to be flown where that of the scenario failed.
#[test]
fn a_set_is_judged_on_its_own_flight_also_where_the_flight_of_the_scenario_fails() {
    let step = include_str!("../../../../scenarios/gallery/navion-step.toml");
    let (_folder, path) = written(step);
    let down = ["aircraft.altitude_ft=300", "setpoint.amplitude_deg=-10", "loop.duration_s=60"];
    let verification = verified(&path, &[&["ctms"], &down[..]].concat(), &[]);
    assert_eq!(verification.failed_flights[0].own_step_deg, None);
    let of_set = verification.judgements.iter().filter(|it| it.requirement.origin.set.is_some());
    let own: Vec<&Judgement> = of_set.filter(|it| it.own_step_deg.is_some()).collect();
    assert!(!own.is_empty() && own.iter().all(|it| it.found.is_ok()), "{own:?}");
}

#[test]
fn frozen_gains_are_fixed_in_their_replay() {
    let (folder, path) = written(&format!(
        "{JUMBO}\n[[requirement]]\nmeasure = \"frozen_phase_margin_deg\"\nleast = 80.0\ncontroller = \"FSPID\"\n"
    ));
    let verification = verified(&path, &[], &[]);
    let replay = &verification.replays(folder.path())[0];
    let study = file::parse(&replay.text, "replay", None, &[]).expect("a scenario");
    let [named] = study.scenario.controllers.as_slice() else { panic!("one controller") };
    let fspid_sim::Controller::Fixed(pid) = named.controller else { panic!("fixed gains") };
    let frozen = verification.judgements[0].place().frozen.expect("frozen gains");
    assert_eq!(pid.gains(), frozen.gains);
    assert_eq!(pid.config().derivative.filter_s, 0.05);
    assert!(replay.text.starts_with("# Replays line 1 of `fspid verify "), "{}", replay.text);
    assert!(replay.text.contains("# FAIL: found "), "{}", replay.text);
}

/// The gains in ISA form bring a filter of their own with them.
#[test]
fn a_filter_that_came_with_the_gains_stays_when_they_are_frozen() {
    let isa = JUMBO
        .replace(
            "nominal = { kp = 1.33, ki = 1.0, kd = 1.22 }",
            "nominal_isa = { gain = 1.33, ti_s = 1.4, td_s = 0.9, n = 13.0 }",
        )
        .replace("derivative_filter_s = 0.05\n", "");
    let (folder, path) = written(&format!("{isa}\n{}", every_measure()));
    replay_all(&verified(&path, &[], &[]), &folder.path().join("replay"));
}

#[test]
fn gains_that_do_not_hold_the_plant_are_replayed_as_such() {
    let wild = [
        "controller.FSPID.supervisor.output_scale.kp=2.0",
        "controller.FSPID.supervisor.output_scale.ki=1.0",
        "controller.FSPID.supervisor.output_scale.kd=1.0",
    ];
    let (folder, path) = written(&format!(
        "{JUMBO}\n[[requirement]]\nmeasure = \"frozen_stable\"\n[[requirement]]\nmeasure = \"frozen_disk_margin\"\nleast = 0.1\n"
    ));
    let verification = verified(&path, &wild, &[]);
    assert_eq!(verification.unmet(), 2);
    replay_all(&verification, &folder.path().join("replay"));
}

#[test]
fn a_plant_of_a_change_in_flight_is_alone_in_its_replay() {
    let text = std::fs::read_to_string(repository("scenarios/plant-change.toml")).expect("shipped");
    let (folder, path) = written(&format!("{text}\n{}", every_measure()));
    let verification = verified(&path, &[], &[]);
    replay_all(&verification, &folder.path().join("replay"));
    let later = verification.judgements.iter().filter_map(|judgement| judgement.place().plant);
    assert!(later.filter(|plant| plant.index > 0).count() > 5);
}

#[test]
fn changes_of_what_presets_say_are_in_their_replay() {
    let text = JUMBO.replace("b747-paper", "navion-full");
    let change = "[[plant_change]]\nat_s = 10.0\npreset = \"navion-full\"\n";
    let (folder, path) = written(&format!("{text}\n{change}\n{}", every_measure()));
    let settings = ["plant_change[0].preset.denominator[1]=0.5", "plant.preset.numerator[0]=-12.0"];
    let verification = verified(&path, &settings, &[]);
    assert_ne!(verified(&path, &[], &[]).judgements, verification.judgements);
    replay_all(&verification, &folder.path().join("replay"));
    let later = verification.judgements.iter().filter_map(|judgement| judgement.place().plant);
    assert!(later.filter(|plant| plant.index > 0).count() > 5);
}

/// Presets keep their speed: without it a replay would have no control anticipation.
#[test]
fn a_plant_of_a_change_keeps_the_speed_of_its_preset() {
    let text = JUMBO.replace("kp = 1.0", "kp = 0.5").replace("b747-paper", "navion-full");
    let change = "[[plant_change]]\nat_s = 10.0\npreset = \"b747-paper\"\n";
    let (folder, path) = written(&format!("{text}\n{change}\n{}", every_measure()));
    let verification = verified(&path, &[], &[]);
    replay_all(&verification, &folder.path().join("replay"));
    let cap = |j: &&Judgement| j.requirement.measure == Measure::ControlAnticipation;
    let cap = verification.judgements.iter().find(cap).expect("asked");
    assert_eq!(cap.place().plant.map(|plant| plant.index), Some(1), "{cap:?}");
}

#[test]
fn nonlinear_aircraft_are_replayed_too() {
    for name in ["navion-step", "b747-turbulence", "sensor-own"] {
        let path = repository(&format!("scenarios/gallery/{name}.toml"));
        let folder = tempfile::tempdir().expect("a folder");
        let short = ["loop.duration_s=1.5"];
        let requirements = folder.path().join("all.toml");
        std::fs::write(&requirements, every_measure()).expect("written");
        replay_all(&verified(&path, &short, &[&requirements]), folder.path());
    }
}

#[test]
fn files_that_a_scenario_refers_to_are_found_from_the_replays() {
    let (folder, path) = written(
        &JUMBO
            .replace("preset = \"b747-paper\"", "file = \"data/plant.toml\"")
            .replace("table = \"mirrored\"", "table = \"data/rules.toml\""),
    );
    let data = folder.path().join("data");
    std::fs::create_dir(&data).expect("made");
    for (from, to) in [("plants/b747-paper", "plant"), ("rule-tables/mirrored", "rules")] {
        let from = repository(&format!("data/{from}.toml"));
        std::fs::copy(from, data.join(format!("{to}.toml"))).expect("copied");
    }
    let requirements = folder.path().join("all.toml");
    std::fs::write(&requirements, every_measure()).expect("written");
    let verification = verified(&path, &[], &[&requirements]);
    for place in ["replay", "far/down/below", "."] {
        replay_all(&verification, &folder.path().join(place));
    }
    let replay = &verification.replays(&folder.path().join("replay"))[0];
    assert!(replay.text.contains("file = \"../data/plant.toml\""), "{}", replay.text);
    let tuning = &verification.replays(&folder.path().join("far/down/below"))[1];
    assert!(tuning.text.contains("table = \"../../../data/rules.toml\""), "{}", tuning.text);
}

#[test]
fn what_was_set_from_outside_is_in_the_replays() {
    let (folder, path) = written(JUMBO);
    let settings = ["mil-f-9490d", "mil-f-8785c:level=2,category=C", "setpoint.amplitude_deg=4.0"];
    let verification = verified(&path, &settings, &[]);
    replay_all(&verification, &folder.path().join("replay"));
    let replay = &verification.replays(folder.path())[0];
    assert!(replay.text.contains("amplitude_deg = 4.0"), "{}", replay.text);
    assert!(replay.text.contains("confidence = \"recalled\""), "{}", replay.text);
}

/// A contest names the controller that the others are compared with, and a tuning the one that is tuned: replays of the
/// others had an error in place of a number.
#[test]
fn a_replay_has_no_contest_and_no_tuning_which_name_other_controllers() {
    let contest = "[contest]\nagainst = \"P\"\n[[contest.case]]\nname = \"as written\"\nset = []\n[tuning]\ncontroller = \"P\"\n[[tuning.objective]]\nmeasure = \"iae_deg_s\"";
    let (folder, path) = written(&format!("{JUMBO}\n{contest}\n{}", every_measure()));
    let verification = verified(&path, &[], &[]);
    replay_all(&verification, &folder.path().join("replay"));
    let replay = &verification.replays(folder.path())[0];
    assert!(!replay.text.contains("contest") && !replay.text.contains("tuning"), "{}", replay.text);
}

#[test]
fn names_that_a_file_system_would_mind_make_sound_files() {
    let hostile = JUMBO
        .replace("name = \"jumbo\"", "name = \"a\\\"b\\\\c\\n<d>\\u0001\"")
        .replace("name = \"P\"", "name = \"../ä b\\\"c\\n\"");
    let requirement = "[[requirement]]\nid = \"R/1 <&>\\n\"\nmeasure = \"phase_margin_deg\"\nleast = 1.0\nsource = \"line one\\nline \\\"two\\\"\"\n";
    let (folder, path) = written(&format!("{hostile}\n{requirement}"));
    let verification = verified(&path, &[], &[]);
    replay_all(&verification, &folder.path().join("replay"));
    for replay in verification.replays(folder.path()) {
        let safe = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
        assert!(replay.name.chars().all(safe), "{}", replay.name);
    }
}

#[test]
fn two_runs_write_the_same_replays() {
    let (folder, path) = written(&format!("{JUMBO}\n{}", every_measure()));
    let replays = || verified(&path, &[], &[]).replays(folder.path());
    assert!(replays() == replays());
}

//! Controllers that are programs of their own: exports fly with the bits of the original, and whatever another does is a
//! verdict in words.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use fspid_export::program::Precision;
use fspid_export::{Angles, Request, Target, export};
use fspid_external::ProcessHost;
use fspid_sim::external::set_host;
use fspid_sim::signal::{Profile, Shape};
use fspid_sim::{
    Controller, ElevatorSign, External, ExternalSource, LinearPlant, NamedExternal, Scenario,
    Timing, Trace, simulate,
};
use proptest::prelude::*;
use serde_json::Value;

use crate::common::{code, fspid, json, text};
use crate::repository::repository;

/// A proportional controller that does something else at its sample 123, or another.
pub(crate) const STRANGE: &str = r#"
#include "fspid_external.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#ifndef VERSION
#define VERSION FSPID_EXTERNAL_VERSION
#endif
#ifndef AT
#define AT 123
#endif
#ifndef PERIOD
#define PERIOD 0.0
#endif
static double kept;
uint32_t fspid_external_version(void) { return VERSION; }
double fspid_external_period_s(void) { return PERIOD; }
size_t fspid_external_state_bytes(void) { return sizeof(int); }
void fspid_external_reset(void *state) { *(int *)state = 0; }
void fspid_external_step(void *state, const fspid_external_sample *sample, fspid_external_answer *answer)
{
    int *k = state;
    *k += 1;
    if (*k == AT + 1) {
        STRANGE;
    }
    kept += 1e-4;
    answer->command_rad = 0.9 * (sample->setpoint_rad - sample->measurement_rad) + kept * KEPT;
}
"#;

/// A scenario of a step with a controller of equations, as `init` writes it.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    assert_eq!(code(&fspid(&["init", "pitch.toml"], folder.path())), 0);
    folder
}

/// Builds a library of C.
pub(crate) fn library(folder: &Path, name: &str, sources: &[PathBuf], defined: &[&str]) {
    let built = Command::new("cc")
        .args(["-shared", "-fPIC", "-O1", "-ffp-contract=off", "-I", "."])
        .args(sources)
        .args(defined.iter().map(|it| format!("-D{it}")))
        .args(["-lm", "-o", name])
        .current_dir(folder)
        .output()
        .expect("the compiler that links Rust");
    assert!(built.status.success(), "{}", text(&built.stderr));
}

/// Flies the controller that does this at 1.23 s beside those of a scenario.
fn strange(folder: &Path, does: &str, defined: &[&str]) -> Output {
    std::fs::write(folder.join("fspid_external.h"), fspid_export::write::EXTERNAL_HEADER)
        .and_then(|()| std::fs::write(folder.join("strange.c"), STRANGE))
        .expect("files");
    let does = format!("STRANGE={does}");
    library(folder, "x.so", &["strange.c".into()], &[&[does.as_str(), "KEPT=0"], defined].concat());
    let entry = "controller[]={ name = \"X\", kind = \"external\", library = \"x.so\", answer_limit_s = 0.2 }";
    fspid(&["simulate", "pitch.toml", "--set", entry, "--format", "json"], folder)
}

/// The verdict on a controller in an answer of `simulate`.
pub(crate) fn verdict(answer: &Value, name: &str) -> String {
    let all = answer["controllers"].as_array().expect("controllers");
    let found = all.iter().find(|it| it["name"] == name).expect("the controller");
    found["verdict"].as_str().expect("a sentence").to_owned()
}

/// The columns of a controller, as they are written.
fn columns(csv: &str, name: &str) -> Vec<String> {
    let names: Vec<&str> = csv.lines().next().unwrap_or_default().split(',').collect();
    let is_mine = |at: &usize| names.get(*at).is_some_and(|it| it.starts_with(&format!("{name}.")));
    let mine: Vec<usize> = (0..names.len()).filter(is_mine).collect();
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        mine.iter().map(|at| cells[*at]).collect::<Vec<_>>().join(",")
    };
    csv.lines().skip(1).map(row).collect()
}

#[test]
fn shipped_designs_fly_as_libraries_with_the_bits_of_their_originals() {
    for (design, controller) in [("navion-paper", "FSPID"), ("b747-short-period", "PID")] {
        let folder = tempfile::tempdir().expect("a folder");
        let (scenario, prefix) = (format!("{design}.toml"), controller.to_lowercase());
        std::fs::copy(
            repository().join("data/designs").join(&scenario),
            folder.path().join(&scenario),
        )
        .expect("a design");
        let asked =
            ["export", &scenario, "--controller", controller, "--to", "c", "--numbers", "double"];
        let asked = [&asked[..], &["--samples", "9", "--out", "code"]].concat();
        assert_eq!(code(&fspid(&asked, folder.path())), 0);
        let sources = [format!("code/{prefix}.c"), format!("code/external/{prefix}_external.c")];
        library(folder.path(), "flown.so", &sources.map(PathBuf::from), &[]);
        let flown = ["simulate", &scenario, "--library", "flown.so", "--trace", "t.csv"];
        assert_eq!(code(&fspid(&flown, folder.path())), 0);
        let csv = std::fs::read_to_string(folder.path().join("t.csv")).expect("traces");
        let (original, external) = (columns(&csv, controller), columns(&csv, "flown.so"));
        assert!(original.len() > 3000 && original[0].split(',').count() == 7, "{design}");
        assert!(original == external, "{design}: bits differ");
    }
}

#[test]
fn shipped_designs_fly_as_fmus_of_both_versions_with_the_bits_of_their_originals() {
    let folder = tempfile::tempdir().expect("a folder");
    let scenario = "navion-paper.toml";
    std::fs::copy(repository().join("data/designs").join(scenario), folder.path().join(scenario))
        .expect("a design");
    for version in ["fmu2", "fmu3"] {
        let asked =
            ["export", scenario, "--controller", "FSPID", "--to", version, "--out", version];
        assert_eq!(code(&fspid(&asked, folder.path())), 0);
        let fmu = format!("{version}/fspid.fmu");
        let flown = ["simulate", scenario, "--fmu", &fmu, "--trace", "t.csv"];
        let output = fspid(&flown, folder.path());
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        let csv = std::fs::read_to_string(folder.path().join("t.csv")).expect("traces");
        let (original, external) = (columns(&csv, "FSPID"), columns(&csv, "fspid.fmu"));
        assert!(original.len() > 3000 && original == external, "{version}: bits differ");
    }
    let slower = ["--set", "loop.sample_period_s=0.02"];
    let output = fspid(
        &[&["simulate", scenario, "--fmu", "fmu2/fspid.fmu"], &slower[..]].concat(),
        folder.path(),
    );
    assert_eq!(code(&output), 2);
    assert!(text(&output.stderr).contains("its period is 0.01 s"), "{}", text(&output.stderr));
    std::fs::write(folder.path().join("no.fmu"), "no archive").expect("a file");
    let output = fspid(&["simulate", scenario, "--fmu", "no.fmu"], folder.path());
    assert_eq!(code(&output), 2);
    assert!(text(&output.stderr).contains("it is no zip archive"), "{}", text(&output.stderr));
}

#[test]
fn a_campaign_of_an_export_has_the_numbers_of_its_original_on_any_number_of_threads() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |arguments: &[&str]| {
        let output = fspid(arguments, folder.path());
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        output
    };
    run(&["init", "--template", "campaign", "c.toml"]);
    let asked = ["export", "c.toml", "--controller", "FSPID", "--to", "c", "--numbers", "double"];
    run(&[&asked[..], &["--samples", "9", "--out", "code"]].concat());
    let sources = ["code/fspid.c", "code/external/fspid_external.c"];
    library(folder.path(), "flown.so", &sources.map(PathBuf::from), &[]);
    // What is exported does not vary from run to run.
    let text_of = std::fs::read_to_string(folder.path().join("c.toml")).expect("a scenario");
    assert!(!text_of.contains("path = \"controller"), "{text_of}");
    let flown = ["campaign", "run", "c.toml", "--library", "flown.so", "--runs", "6", "--quiet"];
    run(&[&flown[..], &["--out", "one", "--threads", "1"]].concat());
    run(&[&flown[..], &["--out", "three", "--threads", "3"]].concat());
    let rows = |folder_name: &str| {
        std::fs::read(folder.path().join(folder_name).join("campaign.parquet")).expect("rows")
    };
    assert!(rows("one") == rows("three"));
    // Every measure of the flights, run by run; margins are not asked of a program.
    let answer = json(&run(&["campaign", "report", "one/campaign.parquet", "--format", "json"]));
    let of = |name: &str| {
        let all = answer["controllers"].as_array().expect("controllers");
        let mine = all.iter().find(|it| it["name"] == name).expect("the controller");
        let mut measures = mine["measures"].as_array().expect("measures").clone();
        // Of the one that has equations and limits that are known alone.
        measures.retain(|it| it["name"] != "requirement.phase_margin_deg.value");
        measures.retain(|it| it["name"] != "saturated_pct");
        measures
    };
    assert!(of("FSPID").len() > 10);
    assert_eq!(of("FSPID"), of("flown.so"));
}

#[test]
fn whatever_a_controller_does_is_a_verdict_and_never_ours() {
    let folder = folder();
    for (does, told) in [
        ("*(volatile int *)8 = 1", "the controller crashed with SIGSEGV at t = 1.23 s"),
        ("abort()", "the controller crashed with SIGABRT at t = 1.23 s"),
        ("for (;;) { }", "the controller gave no answer within 0.2 s at t = 1.23 s"),
        ("exit(3)", "the controller ended its process with code 3 at t = 1.23 s"),
        (
            "answer->command_rad = NAN; return",
            "the controller answered a command that is not finite at t = 1.23 s",
        ),
        ("return", "the controller answered a command that is not finite at t = 1.23 s"),
        (
            "char junk[99] = { 1 }; if (write(0, junk, 99)) { }",
            "the controller wrote something else than an answer at t = 1.23 s",
        ),
    ] {
        let output = strange(folder.path(), does, &[]);
        assert_eq!(code(&output), 1, "{does}: {}", text(&output.stderr));
        assert_eq!(verdict(&json(&output), "X"), told, "{does}");
        // The others fly as ever.
        assert_eq!(verdict(&json(&output), "PID"), "settled", "{does}");
    }
}

#[test]
fn what_a_controller_prints_is_for_people_and_changes_no_answer() {
    let folder = folder();
    let silent = strange(folder.path(), "", &[]);
    let output = strange(folder.path(), "puts(\"from the controller\")", &[]);
    assert_eq!((code(&silent), code(&output)), (0, 0));
    assert_eq!(json(&output)["controllers"], json(&silent)["controllers"]);
    assert!(text(&output.stderr).contains("from the controller"));
}

#[test]
fn what_cannot_be_flown_is_wrong_input_and_says_what_to_change() {
    let folder = folder();
    let refused = |defined: &[&str], words: &str| {
        let output = strange(folder.path(), "", defined);
        let told = text(&output.stdout);
        assert_eq!(code(&output), 2, "{told}");
        assert!(told.contains(words), "{told}");
    };
    refused(&["PERIOD=0.02"], "its period is 0.02 s, and the scenario samples every 0.01 s");
    refused(&["VERSION=7U"], "is of version 7 of fspid_external.h; allowed is version 1");
    refused(&["fspid_external_reset=another"], "has no function fspid_external_reset; allowed is");
    std::fs::write(folder.path().join("text.so"), "no library").expect("a file");
    for (file, words) in [
        ("text.so", "cannot be loaded"),
        ("none.so", "there is no such file"),
        (".", "it is no regular file"),
    ] {
        let output = fspid(&["simulate", "pitch.toml", "--library", file], folder.path());
        let told = text(&output.stderr);
        assert_eq!(code(&output), 2, "{told}");
        assert!(told.contains(words), "{file}: {told}");
    }
}

#[test]
fn memory_that_a_controller_keeps_for_itself_does_not_reach_its_next_flight() {
    let folder = folder();
    strange(folder.path(), "", &[]);
    let defined = ["STRANGE=", "KEPT=1"];
    library(folder.path(), "one.so", &["strange.c".into()], &defined);
    std::fs::copy(folder.path().join("one.so"), folder.path().join("two.so")).expect("a copy");
    let flown = ["simulate", "pitch.toml", "--library", "one.so", "--library", "two.so"];
    let flown = [&flown[..], &["--trace", "t.csv"]].concat();
    assert_eq!(code(&fspid(&flown, folder.path())), 0);
    let csv = std::fs::read_to_string(folder.path().join("t.csv")).expect("traces");
    assert_eq!(columns(&csv, "one.so"), columns(&csv, "two.so"));
}

#[test]
fn what_needs_equations_is_refused_by_name_and_flights_are_judged() {
    let folder = folder();
    strange(folder.path(), "", &[]);
    let entry = "controller[]={ name = \"X\", kind = \"external\", library = \"x.so\" }";
    for command in [&["certify"][..], &["export", "--to", "c", "--out", "code"]] {
        let asked = [command, &["pitch.toml", "--set", entry, "--controller", "X"]].concat();
        let output = fspid(&asked, folder.path());
        assert_eq!(code(&output), 2, "{command:?}");
        assert!(text(&output.stderr).contains("`X`"), "{}", text(&output.stderr));
    }
    let requirements = "[[requirement]]\nmeasure = \"phase_margin_deg\"\nleast = 1.0\ncontroller = \"x.so\"\n\n\
                        [[requirement]]\nmeasure = \"overshoot_pct\"\nmost = 99.0\ncontroller = \"x.so\"\n";
    std::fs::write(folder.path().join("r.toml"), requirements).expect("a file");
    let asked = ["verify", "pitch.toml", "--library", "x.so", "--requirements", "r.toml"];
    let output = fspid(&[&asked[..], &["--format", "json"]].concat(), folder.path());
    assert_eq!(code(&output), 1);
    let told = text(&output.stdout);
    assert!(told.contains("an external controller has no equations here"), "{told}");
    let met: Vec<bool> = json(&output)["requirements"]
        .as_array()
        .expect("requirements")
        .iter()
        .map(|it| it["met"].as_bool().expect("a judgement"))
        .collect();
    assert_eq!(met, [false, true]);
    let analysed = fspid(&["analyse", "pitch.toml", "--library", "x.so"], folder.path());
    assert!(text(&analysed.stdout).contains("x.so        external, without equations here"));
}

/// A drawn controller and its export, flown side by side.
fn flown(controller: &Controller, folder: &Path) -> Vec<Trace> {
    let request = Request {
        name: "drawn",
        target: Target::C,
        precision: Precision::Double,
        angles: Angles::Radians,
        samples: 3,
        points: 0,
        digest: "drawn",
        elevator: None,
        its_loop: None,
        evidence: false,
    };
    let exported = export(controller, &request).expect("nothing that is drawn is refused");
    for file in &exported.files {
        let path = folder.join(&file.name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        std::fs::write(path, &file.bytes).expect("a file");
    }
    library(folder, "drawn.so", &["drawn.c".into(), "external/drawn_external.c".into()], &[]);
    let dt_s = controller.config().dt_s;
    let plant =
        LinearPlant::new(&[1.151, 0.1774], &[1.0, 0.739, 0.921, 0.0], ElevatorSign::NoseUpPositive);
    let timing = Timing::new(dt_s, 300.0 * dt_s).expect("allowed");
    let setpoint =
        Profile::new(0.2, Shape::Square { at_s: 0.0, half_period_s: 60.0 * dt_s, bipolar: true })
            .expect("allowed");
    let mut scenario = Scenario::new("drawn", plant.expect("a plant"), timing, setpoint)
        .with_controller("original", *controller);
    let source = ExternalSource::Library(folder.join("drawn.so"));
    let (contents, renamed) = (None, Vec::new());
    let external = External { source, contents, answer_limit_s: 60.0, dt_s, renamed };
    scenario.externals.push(NamedExternal { name: "export".to_owned(), external });
    simulate(&scenario).expect("flies").traces
}

/// Bits of everything that a trace has of its controller.
fn bits(trace: &Trace) -> Vec<u64> {
    let gains = trace.gains.iter().flat_map(|gains| [gains.kp, gains.ki, gains.kd]);
    let numbers = trace.command_rad.iter().chain(&trace.theta_rad).copied().chain(gains);
    numbers.map(f64::to_bits).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, max_shrink_iters: 4, ..ProptestConfig::default() })]

    #[test]
    fn any_controller_flies_as_its_own_export_with_the_same_bits(
        controller in fspid_options::any_controller(),
    ) {
        set_host(ProcessHost::new(env!("CARGO_BIN_EXE_fspid").into(), &["external-controller"]));
        let folder = tempfile::tempdir().expect("a folder");
        let traces = flown(&controller, folder.path());
        let [original, exported] = &traces[..] else { panic!("two flights") };
        prop_assert_eq!(original.outcome, exported.outcome);
        prop_assert_eq!(bits(original), bits(exported));
        prop_assert_eq!(original.saturated_samples, exported.saturated_samples);
        prop_assert_eq!(original.faults, exported.faults);
    }
}

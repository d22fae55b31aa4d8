//! Data for a review: complete, the same each time, and honest about what the vectors do not find.

use std::path::Path;
use std::process::Command;

use fspid_core::{AntiWindup, Controller, ControllerSetting, Gains, Limits, Pid, PidConfig};
use fspid_export::program::Precision;
use fspid_export::{Angles, Export, LoopWord, Request, Target, export};

fn controller() -> Controller<f64> {
    let mut config = PidConfig::sampled_every(0.01);
    config.derivative.filter_s = 0.05;
    config.limits = Limits::new(ControllerSetting::OutputLimits, -0.3, 0.35).ok();
    config.slew_rad_s = Some(2.0);
    config.anti_windup = AntiWindup::BackCalculation { tracking_s: 0.5 };
    Controller::Fixed(Pid::new(Gains { kp: 1.2, ki: 0.8, kd: 0.3 }, config).expect("allowed"))
}

fn exported() -> Export {
    let request = Request {
        name: "Pitch",
        target: Target::C,
        precision: Precision::Single,
        angles: Angles::Degrees,
        samples: 2500,
        points: fspid_export::table::POINTS,
        digest: "0",
        elevator: None,
        its_loop: Some(LoopWord { words: "unstable at rest".to_owned(), is_in_doubt: true }),
        evidence: true,
    };
    export(&controller(), &request).expect("nothing is refused")
}

fn text<'a>(export: &'a Export, name: &str) -> &'a str {
    let file = export.evidence.iter().find(|file| file.name == name);
    std::str::from_utf8(&file.expect("a file of the pack").bytes).expect("text")
}

#[test]
fn every_number_of_the_design_has_its_lines_and_a_vector_that_fails_without_it() {
    let export = exported();
    assert_eq!(export, exported(), "the same bytes each time");
    let source = text(&export, "code/pitch.c");
    let trace = text(&export, "trace.csv");
    for name in [
        "nominal_kp",
        "nominal_ki",
        "nominal_kd",
        "upper_rad",
        "lower_rad",
        "slew_rad",
        "guard_rad",
    ] {
        assert!(source.contains(name), "{name} is in the code");
        let row = trace.lines().find(|row| row.starts_with(&format!("design,{name},")));
        let row = row.unwrap_or_else(|| panic!("{name} is traced"));
        assert!(!row.contains("none"), "a change is not found: {row}");
    }
    let different = "2500, 0 are answered otherwise";
    assert!(text(&export, "README.md").contains(different), "the program answers its vectors");
}

/// The page said nothing of the loop, and the script compared the code alone with what was exported.
#[test]
fn the_page_tells_of_the_loop_and_every_file_beside_it_has_its_digest() {
    let export = exported();
    let page = text(&export, "README.md");
    assert!(
        page.contains(
            "## The loop\n\nOf the loop of that scenario the program says: unstable at rest."
        ),
        "{page}"
    );
    assert!(page.contains("nothing of whether the design is good"), "{page}");
    assert!(
        export
            .notes
            .iter()
            .any(|it| it.starts_with("warning: of the loop of this scenario: unstable at rest;"))
    );
    let digests = [text(&export, "code.sha256"), text(&export, "pack.sha256")].concat();
    let mut named: Vec<&str> = digests.lines().filter_map(|it| it.split("  ").nth(1)).collect();
    named.extend(["README.md", "code.sha256", "pack.sha256"]);
    named.sort_unstable();
    let mut all: Vec<&str> = export.evidence.iter().map(|it| it.name.as_str()).collect();
    all.sort_unstable();
    assert_eq!(named, all.into_iter().collect::<Vec<_>>());
}

#[test]
fn what_is_not_found_is_listed_by_name() {
    let export = exported();
    let mutants = text(&export, "mutants.csv");
    let left: std::collections::BTreeSet<&str> = mutants
        .lines()
        .filter(|row| row.ends_with(",none") || row.contains(",equivalent: "))
        .filter_map(|row| row.split(',').next())
        .collect();
    let page = text(&export, "README.md");
    assert!(page.contains(&format!("Not found, {}:", left.len())), "{page}");
    let first = page.lines().nth(2).expect("a line behind the verdict");
    assert!(first.contains("single changes:") && first.ends_with("not told apart."), "{first}");
}

#[test]
fn what_goes_one_way_has_its_reason() {
    let coverage = text_of("coverage.csv");
    let one_way: Vec<&str> = coverage.lines().filter(|row| row.contains(",0,")).collect();
    assert!(one_way.iter().all(|row| !row.ends_with("not known")), "{one_way:?}");
}

fn text_of(name: &str) -> String {
    text(&exported(), name).to_owned()
}

/// The exit code of the pack's script, and the first line of its page behind it.
fn verdict(folder: &Path) -> (Option<i32>, String) {
    let ran = Command::new("sh").arg("make-evidence.sh").current_dir(folder).output();
    let page = std::fs::read_to_string(folder.join("README.md")).expect("the page");
    (ran.expect("a shell").status.code(), page.lines().next().expect("a line").to_owned())
}

/// It ended with 0 and "Not proved yet" where every vector was answered otherwise.
#[test]
fn a_pack_whose_code_is_not_as_exported_or_answers_otherwise_says_so_first_and_ends_with_1() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let folder = folder.path();
    for file in exported().evidence {
        let path = folder.join(&file.name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a temporary folder");
        std::fs::write(path, &file.bytes).expect("a temporary file");
    }
    let said = |line: &str| (Some(1), line.to_owned());

    let beside = folder.join("code/math.h");
    std::fs::write(&beside, "").expect("a temporary file");
    let line = "Wrong: code/ is not what was exported, beside it is code/math.h.";
    assert_eq!(verdict(folder), said(line));
    std::fs::remove_file(beside).expect("it was there");

    let source = folder.join("code/pitch.c");
    let text = std::fs::read_to_string(&source).expect("the code");
    let changed = text.replacen("    1.2f,", "    1.3f,", 1);
    assert_ne!(text, changed, "kp is a number of the design");
    std::fs::write(&source, changed).expect("a temporary file");
    let line = "Wrong: code/ is not what was exported, code/pitch.c: FAILED.";
    assert_eq!(verdict(folder), said(line));

    // Also where somebody makes the digests anew.
    let anew = "find code -type f | LC_ALL=C sort | xargs sha256sum > code.sha256";
    let ran = Command::new("sh").args(["-c", anew]).current_dir(folder).status();
    assert!(ran.expect("a shell").success());
    let (code, line) = verdict(folder);
    assert_eq!(code, Some(1), "{line}");
    let is_told = line.starts_with("Wrong: ") && line.contains("-O0: 2500 samples, ");
    assert!(is_told && line.ends_with(" different."), "{line}");
}

//! Data for a review: complete, the same each time, and honest about what the vectors do not find.

use fspid_core::{AntiWindup, Controller, ControllerSetting, Gains, Limits, Pid, PidConfig};
use fspid_export::program::Precision;
use fspid_export::{Angles, Export, Request, Target, export};

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

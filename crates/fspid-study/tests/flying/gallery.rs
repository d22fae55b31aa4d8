//! Every scenario of the gallery loads, flies and is judged.

use std::path::PathBuf;

use fspid_scenario::file;
use fspid_study::report;
use fspid_study::simulation::Simulation;

fn gallery() -> Vec<PathBuf> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/gallery");
    let entries = std::fs::read_dir(folder).expect("there is a gallery");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("readable").path()).collect();
    paths.sort();
    paths
}

#[test]
fn every_scenario_of_the_gallery_flies_and_meets_its_requirements() {
    let paths = gallery();
    assert!(paths.len() >= 14, "{}", paths.len());
    for path in paths {
        let study = file::load(&path, &[]).unwrap_or_else(|error| panic!("{error}"));
        assert!(study.warnings.is_empty(), "{}: {:?}", path.display(), study.warnings);
        let simulation = Simulation::of(&study).expect("it flies");
        let text = simulation.text();
        assert!(!simulation.judgements.is_empty(), "{}: nothing is judged", path.display());
        assert!(simulation.requirements_met(), "{}: {text}", path.display());
        assert!(report::of_simulation(&study, &simulation).contains("</html>"));
    }
}

#[test]
fn every_scenario_of_the_gallery_says_in_its_first_line_what_it_is_for() {
    for path in gallery() {
        let text = std::fs::read_to_string(&path).expect("readable");
        assert!(text.starts_with("# "), "{}", path.display());
        // What stands around the loop takes as much again as the loop.
        let most = if text.contains("[[mode]]") { 120 } else { 70 };
        assert!(text.lines().count() <= most, "{}", path.display());
    }
}

//! The report of the paper as a document: complete, self-contained, well-formed, and the same each time.

use std::collections::BTreeSet;

use fspid_paper::{CLAIMS, Library, Reproduction, report};
use fspid_scenario::file;

use crate::sound::assert_sound;

fn paper() -> (Library, Reproduction) {
    let reproduction = Reproduction::stored().expect("the shipped scenarios are right");
    (Library::stored(), reproduction)
}

#[test]
fn the_report_of_the_paper_is_sound_and_holds_every_claim() {
    let (library, reproduction) = paper();
    let html = report::of_reproduction(&library, &reproduction);
    assert_sound(&html);
    for claim in CLAIMS {
        assert!(html.contains(&format!("<tr id=\"{}\">", claim.id)), "{}", claim.id);
    }
    for statement in &reproduction.statements {
        assert!(html.contains(&format!("<tr id=\"{}\">", statement.id)), "{}", statement.id);
    }
    assert!(html.contains(&reproduction.digest) && html.contains(env!("CARGO_PKG_VERSION")));
    assert!(html.len() < 6_000_000, "{} bytes", html.len());
}

#[test]
fn every_assumption_and_erratum_has_its_anchor() {
    let (library, reproduction) = paper();
    let html = report::of_reproduction(&library, &reproduction);
    for number in 1..=23 {
        assert!(html.contains(&format!("<h3 id=\"A{number}\">")), "A{number}");
    }
    for number in 1..=19 {
        assert!(html.contains(&format!("id=\"E{number}\">")), "E{number}");
    }
}

#[test]
fn parameters_that_the_claims_do_not_determine_are_named_where_there_are_several_seeds() {
    let (library, mut reproduction) = paper();
    for problem in &mut reproduction.record.problems {
        problem.runs.truncate(1);
        let mut other = problem.runs[0].clone();
        other.seed += 1;
        other.point[0] *= 2.0;
        problem.runs.push(other);
    }
    let html = report::of_reproduction(&library, &reproduction);
    assert_sound(&html);
    assert!(html.contains("<strong>Not determined by the claims:</strong> error_scale."));
}

#[test]
fn two_runs_write_the_same_bytes() {
    let once = || {
        let (library, reproduction) = paper();
        (
            report::of_reproduction(&library, &reproduction),
            report::files_of_reproduction(&library, &reproduction),
        )
    };
    assert!(once() == once());
}

#[test]
fn what_lies_beside_the_report_has_names_of_its_own_and_can_be_flown_again() {
    let (library, reproduction) = paper();
    let files = report::files_of_reproduction(&library, &reproduction);
    let names: BTreeSet<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names.len(), files.len(), "a name is given twice");
    for (name, text) in &files {
        match name.split('/').next() {
            Some("figures") => {
                assert!(text.starts_with("<svg ") && text.trim_end().ends_with("</svg>"), "{name}")
            }
            Some("traces") => assert!(text.starts_with("time_s,"), "{name}"),
            Some("scenarios") => {
                let again = file::parse(text, name, None, &[]);
                assert!(again.is_ok(), "{name}");
            }
            _ => panic!("{name} belongs nowhere"),
        }
    }
    assert!(
        names.contains("scenarios/own/figure-8b.toml")
            && names.contains("figures/figure-8b-own.svg")
    );
}

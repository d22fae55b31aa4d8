//! Whether the identified loops are stable at rest, with gains that stand elsewhere, and while they move.

use crate::report::templates::render;
use fspid_proof::{Bearing, Claim, Effort, Outcome, Verdict};

use crate::report::Paper;
use crate::{FIGURES, Fit};
use fspid_certify::{Certification, Certified, scope_in_short};
use fspid_page::context;
use fspid_page::number::fixed;
use fspid_page::page::{Cell, PageSection, PageTable};
use fspid_scenario::file::Study;
use fspid_study::analysis::{AnalysedLoop, Analysis, Margins, Question, flown_inputs};

/// Verdicts alone: the report does not ask for the largest output scale, nor for proofs that take long.
fn effort() -> Effort {
    Effort { halvings: 0, largest_factor: 1.0, cones: 0, ..Effort::default() }
}

/// Margins and verdicts of every figure.
pub(super) fn section(paper: &Paper<'_>) -> PageSection {
    let head = [
        "loop",
        "gain margin at rest [dB]",
        "phase margin at rest [deg]",
        "verdict while gains move",
        "why",
        "inputs of the flight [supervisor units]",
    ];
    let table = |caption: &str, fit: Fit| {
        let mut table = PageTable::new(caption, &head).in_cards();
        for figure in FIGURES {
            let study = paper.library.figure(fit, figure.id).ok();
            for row in study.iter().flat_map(|study| rows(figure.id, study)) {
                table.push(row);
            }
        }
        table
    };
    let context = context! {
        own => table("Loops with parameters of their own for each figure.", Fit::Own),
        shared => table("Loops with one set of scale factors for all figures of a range.", Fit::Shared),
    };
    PageSection::of("stability", "Stability while the gains move", render("stability", context))
}

fn rows(figure: &str, study: &Study) -> Vec<Vec<Cell>> {
    let question = Question { map_points: 0, ..Question::default() };
    let analysis = Analysis::of(study, question);
    let certification = Certification::of(study, None, &effort());
    let (Ok(analysis), Ok(certification)) = (analysis, certification) else {
        return Vec::new();
    };
    let found = analysis.loops.iter().zip(&certification.results);
    found.map(|(analysed, certified)| row(figure, study, analysed, certified)).collect()
}

fn row(figure: &str, study: &Study, analysed: &AnalysedLoop, certified: &Certified) -> Vec<Cell> {
    let margin = |of: &dyn Fn(&Margins) -> f64, decimals, least| match analysed.margins() {
        Ok(margins) if of(&margins) < least => {
            Cell { class: "number unmet", ..Cell::number(fixed(of(&margins), decimals)) }
        }
        Ok(margins) if of(&margins).is_finite() => Cell::number(fixed(of(&margins), decimals)),
        Ok(_) => Cell { class: "absent", ..Cell::text("without end") },
        Err(reason) => Cell { class: "absent", ..Cell::text(reason.to_string()) },
    };
    let (class, verdict, why) = match verdict(certified) {
        ("met", verdict, why) if analysed.has_poor_margins() => {
            ("absent", format!("{verdict}, poor margins"), why)
        }
        (class, verdict, why) => (class, verdict.to_owned(), why),
    };
    vec![
        Cell::text(format!("Fig. {figure}, {}", analysed.name)),
        margin(&Margins::smaller_gain_margin_db, 1, 6.0),
        margin(&|margins| margins.phase_margin_deg, 1, 45.0),
        Cell { class, ..Cell::text(verdict) },
        Cell::text(why),
        Cell::text(flown(study, &analysed.name)),
    ]
}

fn verdict(certified: &Certified) -> (&'static str, &'static str, String) {
    let outcome = match &certified.outcome {
        Err(reason) => return ("absent", "not provable", reason.to_string()),
        Ok(outcome) => outcome,
    };
    match &outcome.verdict {
        Verdict::Proved(certificate, rechecked) => {
            let scope = scope_in_short(certificate, rechecked);
            ("met", "\u{2713} proved", format!("for every gain it can have, {scope}"))
        }
        Verdict::Refuted(certificate, rechecked) => {
            let bearing = certificate.bearing(rechecked);
            let why = match bearing {
                // What that says and what not stands once, above the tables.
                Bearing::GrowsStandingStill => why(&certificate.claim),
                bearing => format!("{}; {bearing}", why(&certificate.claim)),
            };
            ("unmet", refuted(bearing), why)
        }
        Verdict::Open => ("absent", "? open", open(outcome)),
    }
}

fn refuted(bearing: Bearing) -> &'static str {
    match bearing {
        Bearing::GrowsStandingStill => "\u{2717} refuted standing still",
        Bearing::GrowsInSomeOrder => "\u{2717} refuted in some order",
        Bearing::Grows
        | Bearing::Stable
        | Bearing::PitchLoopStable
        | Bearing::OtherScale { .. }
        | Bearing::RateNotKept => "\u{2717} refuted",
    }
}

fn open(outcome: &Outcome) -> String {
    match &outcome.instead {
        None => "neither proved nor refuted".to_owned(),
        Some((certificate, rechecked)) => format!(
            "for what the scenario asks neither proved nor refuted; proved is less: {}",
            scope_in_short(certificate, rechecked)
        ),
    }
}

fn why(claim: &Claim) -> String {
    match claim {
        Claim::FrozenGrowth { input: [error, change], .. } => format!(
            "the gains that the rules give at error {}, change {} do not hold the aircraft if they stay",
            fixed(*error, 2),
            fixed(*change, 2)
        ),
        Claim::SequenceGrowth { .. } => {
            "a sequence of gains that the rules give lets the loop grow".to_owned()
        }
        Claim::CommonQuadratic { .. } | Claim::SProcedure { .. } | Claim::BoundedRate(_) => {
            String::new()
        }
    }
}

/// Between which inputs of its supervisor a loop flies.
fn flown(study: &Study, name: &str) -> String {
    let inputs = flown_inputs(study, name);
    if inputs.is_empty() {
        return "fixed gains".to_owned();
    }
    let range = |of: &dyn Fn(&(f64, f64)) -> f64| {
        let ends = (f64::INFINITY, f64::NEG_INFINITY);
        let (least, most) = inputs
            .iter()
            .map(of)
            .fold(ends, |(least, most), value| (least.min(value), most.max(value)));
        format!("{} to {}", fixed(least, 1), fixed(most, 1))
    };
    format!("error {}, change {}", range(&|input| input.0), range(&|input| input.1))
}

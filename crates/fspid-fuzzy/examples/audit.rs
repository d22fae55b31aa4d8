//! Audits the paper's supervisor and prints what was proved, with the time it took.
//!
//! `cargo run --release -p fspid-fuzzy --all-features --example audit [most boxes a question]`

#![allow(clippy::print_stdout, reason = "an example shows something")]
#![allow(clippy::disallowed_types, reason = "the time it took is what is asked here")]

use std::time::Instant;

use fspid_fuzzy::audit::{
    AlongInput, Extreme, OutputSurface, Statement, SurfaceOptions, rule_base, surface,
};
use fspid_fuzzy::system::{Parts, System};
use fspid_fuzzy::{Defuzzifier, OutOfRange, RuleTable, Supervisor};

const PRINTED: &str = fspid_data::RULE_TABLES[0].1;

fn main() {
    let grids: Vec<&str> = PRINTED.split("\"\"\"").collect();
    let table = RuleTable::parse([grids[1], grids[3], grids[5]]).expect("a shipped table");
    let supervisor = Supervisor::new(&table, 5.0, Defuzzifier::Exact, OutOfRange::Clamp);
    let system =
        System::new(Parts::try_from(&supervisor.expect("allowed")).expect("rules")).expect("sound");
    let mut options = SurfaceOptions::default();
    if let Some(boxes) = std::env::args().nth(1) {
        options.boxes = boxes.parse().expect("a number of boxes");
    }

    let begin = Instant::now();
    let rules = rule_base(&system);
    println!("{} rules, {} contradictions", rules.rules, rules.contradictions.len());
    let audit = surface(&system, &options).expect("universes are known");
    for (part, output) in system.parts().outputs.iter().zip(&audit.outputs) {
        println!("\n{}", part.name);
        show(output);
    }
    println!("\n{} boxes in {:.1?}", audit.boxes, begin.elapsed());
}

fn show(output: &OutputSurface) {
    line("least value", &output.least);
    line("largest value", &output.most);
    println!("  at rest {:.9?}", output.at_rest);
    line("least coverage", &output.coverage.least);
    line("departure from odd", &output.odd.departure);
    line("departure from even", &output.even.departure);
    for (_, symmetry) in &output.exchange {
        line("change on exchange", &symmetry.departure);
    }
    for (input, along) in output.along.iter().enumerate() {
        println!("  along input {}", input + 1);
        show_along(along);
    }
}

fn show_along(along: &AlongInput) {
    line("  least slope", &along.least_slope);
    line("  largest slope", &along.most_slope);
    println!("    Lipschitz constant {:.6?}", along.lipschitz);
    let [lower, upper] = &along.sector;
    line("  least chord from rest", lower);
    line("  largest chord from rest", upper);
    let monotone = &along.monotone;
    let verdict = match &monotone.statement {
        Statement::Proved => "proved",
        Statement::Refuted(_) => "refuted",
        Statement::Open => "open",
    };
    let way = if monotone.rises { "rising" } else { "falling" };
    println!("    {way} throughout: {verdict}");
    println!("    steepest the wrong way {:.6?}", monotone.worst);
    println!("    share of wrong slopes {:.5?}", monotone.wrong_share);
}

fn line(what: &str, extreme: &Extreme) {
    let Extreme { bounds, at, boxes, settled } = extreme;
    let settled = if *settled { "" } else { ", budget used up" };
    println!("  {what} {bounds:.9?} at {at:.4?} ({boxes} boxes{settled})");
}

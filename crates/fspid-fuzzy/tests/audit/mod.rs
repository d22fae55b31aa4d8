//! What is true of rule bases and surfaces.

#![allow(clippy::float_cmp, reason = "what is exact is asked for exactly")]

mod chained;
mod formulas;
mod reach;
mod rule_base;
mod soundness;
mod surface;
mod type2;

use fspid_fuzzy::system::{Parts, System};
use fspid_fuzzy::{Defuzzifier, OutOfRange, RuleTable, Supervisor};

const PRINTED: &str = include_str!("../../../../data/rule-tables/printed.toml");
const MIRRORED: &str = include_str!("../../../../data/rule-tables/mirrored.toml");

fn parts(text: &str, rule: Defuzzifier) -> Parts {
    let grids: Vec<&str> = text.split("\"\"\"").collect();
    let table = RuleTable::parse([grids[1], grids[3], grids[5]]).expect("a shipped table");
    let supervisor = Supervisor::new(&table, 5.0, rule, OutOfRange::Clamp).expect("allowed");
    Parts::try_from(&supervisor).expect("rules")
}

fn system(text: &str) -> System {
    System::new(parts(text, Defuzzifier::Exact)).expect("a sound system")
}

//! General fuzzy systems: their file, their answers, explanations and drawings.
#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

mod answering;
mod auditing;
mod explaining;
mod messages;
mod schema;
mod writing;

use fspid_scenario::fuzzy_system::{System, parse};

/// What to leave for a waiter.
const TIP: &str = include_str!("../systems/tip.toml");
/// Every key and every way of saying something.
const EVERY_KEY: &str = include_str!("../systems/every-key.toml");
/// An interval type-2 system.
const TYPE_2: &str = include_str!("../systems/type2.toml");

fn tip() -> System {
    parse(TIP, "tip.toml").expect("a good file")
}

/// `name=value` pairs as the command line gives them.
fn values(pairs: &[&str]) -> Vec<String> {
    pairs.iter().map(|pair| (*pair).to_owned()).collect()
}

//! Terms that several rules conclude about one output.
//!
//! A weighted method here adds such conclusions up. The standard, jFuzzyLogic, and fuzzylite from version 8 on join them by
//! the accumulation first, and weigh each term once.

use std::collections::BTreeMap;

use fspid_fuzzy::system::{Consequent, Parts};

/// A conclusion by its rule block and rule.
pub(crate) type Place = (usize, usize);

/// The terms of an output that are concluded more than once by rules that are switched on, with the places of their
/// conclusions.
pub(crate) fn terms(parts: &Parts, output: usize) -> BTreeMap<usize, Vec<Place>> {
    let mut found: BTreeMap<usize, Vec<Place>> = BTreeMap::new();
    for (block, own) in parts.blocks.iter().enumerate().filter(|(_, block)| block.enabled) {
        for (rule, own) in own.rules.iter().enumerate().filter(|(_, rule)| rule.enabled) {
            let about = |own: &&Consequent| own.output == output;
            for consequent in own.consequents.iter().filter(about) {
                found.entry(consequent.term).or_default().push((block, rule));
            }
        }
    }
    found.retain(|_, places| places.len() > 1);
    found
}

/// True if a weighted method adds several conclusions of one term up.
pub(crate) fn adds_up(parts: &Parts, output: usize) -> bool {
    let weighs = parts.outputs.get(output).is_some_and(|own| own.defuzzifier.sampling().is_none());
    weighs && !terms(parts, output).is_empty()
}

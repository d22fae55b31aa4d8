//! What is to be known before the numbers are used.

use super::Source;
use super::words::{count, cut, percent};

/// Longest note, in characters; names of controllers are as long as their users like.
const MOST: usize = 1500;

pub(super) fn notes(source: &Source<'_>) -> Vec<String> {
    let sure = percent(source.summary.head.confidence);
    let mut notes = vec![
        "The numbers say how often flights fail if the model is right and its numbers are distributed as the scenario says. They do not say whether that is so.".to_owned(),
        format!("Intervals of probabilities (binomial) and of quantiles (order statistics) are exact at {sure} for independent runs. Intervals of rank correlations (95 %) and standard errors of shares of the variance are approximate. Each holds for its own number; that all on this page hold together is less sure."),
    ];
    notes.extend(source.summary.notes.iter().map(|note| cut(&note.to_string(), MOST)));
    let controllers = source.summary.controllers.iter().enumerate();
    notes.extend(controllers.filter(|(_, it)| it.refused.count > 0).map(|(n, it)| {
        format!(
            "{}: the numbers of {} of {} runs make no scenario. They count as failed and are in no other figure.",
            source.name(n),
            count(it.refused.count),
            count(it.refused.of)
        )
    }));
    notes
}

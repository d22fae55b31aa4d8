//! What is to be known before the numbers are used.

use super::Source;
use super::words::{count, cut, list, percent};
use crate::summary::{MeasureCount, Note};

/// Most measures that a note names.
const MOST_NAMES: usize = 5;
/// Longest note, in characters; names of controllers are as long as their users like.
const MOST: usize = 1500;

pub(super) fn notes(source: &Source<'_>) -> Vec<String> {
    let sure = percent(source.summary.head.confidence);
    let mut notes = vec![
        "The numbers say how often flights fail if the model is right and its numbers are distributed as the scenario says. They do not say whether that is so.".to_owned(),
        format!("Intervals of probabilities (binomial) and of quantiles (order statistics) are exact at {sure} for independent runs. Intervals of rank correlations (95 %) and standard errors of shares of the variance are approximate. Each holds for its own number; that all on this page hold together is less sure."),
    ];
    notes.extend(source.summary.notes.iter().map(in_words));
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

/// A note; of many missing measures, those first that most flights lack.
fn in_words(note: &Note) -> String {
    let Note::Missing { controller, measures } = note else {
        return cut(&note.to_string(), MOST);
    };
    let mut sorted: Vec<&MeasureCount> = measures.iter().collect();
    sorted.sort_by_key(|it| std::cmp::Reverse(it.flights));
    let named = sorted.iter().take(MOST_NAMES);
    let mut words: Vec<String> =
        named.map(|it| format!("{} ({})", cut(&it.name, 60), count(it.flights))).collect();
    if sorted.len() > MOST_NAMES {
        words.push(format!("{} more", sorted.len() - MOST_NAMES));
    }
    format!(
        "{}: some flights do not have every measure, and what is said of one is said of the flights that have it. Missing, with the number of flights: {}.",
        cut(controller, 60),
        list(&words)
    )
}

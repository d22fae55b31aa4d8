//! Hedges of conclusions as fuzzylite has them: one degree goes through the conclusions of a rule, from the first
//! to the last, and every hedge that it meets stays in it. `a is very x and b is not y` concludes *b* by *not very*.
//! Conclusions about an output that is switched off are passed by, with their hedges.

use fspid_fuzzy::Hedge;
use fspid_fuzzy::system::{Activation, Consequent, Output, Parts, Rule};

use super::MAX_DEPTH;
use crate::loss::Loss;
use crate::report::Report;
use fspid_diagnostics::Place;

/// Gives every conclusion of a rule that was read the hedges of those before it.
pub(crate) fn take_along(rule: &mut Rule, enabled: &[bool], place: Place, report: &mut Report) {
    let mut carried: Vec<Hedge> = Vec::new();
    let mut told = false;
    for consequent in rule.consequents.iter_mut().filter(|own| counts(own, enabled)) {
        if carried.len() > MAX_DEPTH {
            let expected = format!("at most {MAX_DEPTH}");
            let message = "too many hedges go on from one conclusion to the next";
            report.problem(place, "", message, expected);
            return;
        }
        told |= !carried.is_empty();
        consequent.hedges.append(&mut carried);
        carried.clone_from(&consequent.hedges);
    }
    if told {
        let message =
            "a hedge in a conclusion holds for the conclusions behind it too, as in fuzzylite";
        report.note(place, message);
    }
}

/// Puts the conclusions of every rule in an order that fuzzylite has words for, or splits the rule.
pub(crate) fn arrange(parts: &mut Parts, loss: &mut Loss) {
    let enabled = switches(&parts.outputs);
    for block in &mut parts.blocks {
        let divisible =
            matches!(block.activation, Activation::General | Activation::Threshold { .. });
        let mut arranged = Vec::with_capacity(block.rules.len());
        for (rule, number) in std::mem::take(&mut block.rules).into_iter().zip(1..) {
            let pieces = pieces(&rule.consequents, &enabled);
            let what = format!("rule {number}");
            match (pieces.len(), divisible) {
                (0 | 1, _) => {}
                (count, true) => loss.note(format!(
                    "{what} is written as {count} rules, for fuzzylite takes hedges along from one conclusion to the next"
                )),
                (_, false) => loss.cannot(
                    &what,
                    "hedges of its conclusions would go on to others in fuzzylite, and its rules are counted",
                    "conclusions that are hedged alike, or the activation `General`",
                ),
            }
            let piece = |consequents| Rule { consequents, ..rule.clone() };
            arranged.extend(pieces.into_iter().map(piece));
        }
        block.rules = arranged;
    }
}

/// The hedges to write for each conclusion of a rule that is [arranged](arrange).
pub(super) fn own<'c>(consequents: &'c [Consequent], outputs: &[Output]) -> Vec<&'c [Hedge]> {
    let enabled = switches(outputs);
    let mut carried: &[Hedge] = &[];
    let own = consequents.iter().map(|consequent| {
        let hedges = consequent.hedges.as_slice();
        if !counts(consequent, &enabled) {
            return hedges;
        }
        let own = hedges.strip_suffix(carried).unwrap_or(hedges);
        carried = hedges;
        own
    });
    own.collect()
}

/// The conclusions as they stand if one rule has words for them; else sorted by their hedges, where no output is concluded
/// twice and so no order matters; else cut into rules.
fn pieces(consequents: &[Consequent], enabled: &[bool]) -> Vec<Vec<Consequent>> {
    let standing = cut(consequents, enabled);
    let mut concluded: Vec<usize> = consequents.iter().map(|own| own.output).collect();
    concluded.sort_unstable();
    concluded.dedup();
    if standing.len() <= 1 || concluded.len() < consequents.len() {
        return standing;
    }
    let mut sorted = consequents.to_vec();
    sorted.sort_by_key(|consequent| consequent.hedges.len());
    let sorted = cut(&sorted, enabled);
    if sorted.len() < standing.len() { sorted } else { standing }
}

/// Cut before each conclusion that does not have the hedges of the one before it.
fn cut(consequents: &[Consequent], enabled: &[bool]) -> Vec<Vec<Consequent>> {
    let mut pieces: Vec<Vec<Consequent>> = Vec::new();
    let mut carried: &[Hedge] = &[];
    for consequent in consequents {
        let counts = counts(consequent, enabled);
        let follows = consequent.hedges.ends_with(carried) && carried.len() <= MAX_DEPTH;
        match pieces.last_mut() {
            Some(piece) if follows || !counts => piece.push(consequent.clone()),
            _ => pieces.push(vec![consequent.clone()]),
        }
        if counts {
            carried = &consequent.hedges;
        }
    }
    pieces
}

fn counts(consequent: &Consequent, enabled: &[bool]) -> bool {
    enabled.get(consequent.output).is_some_and(|&enabled| enabled)
}

/// Which outputs are switched on.
pub(crate) fn switches(outputs: &[Output]) -> Vec<bool> {
    outputs.iter().map(|output| output.enabled).collect()
}

//! Who wins, if anybody does, and why.

use super::compare::{Bar, Comparison, Standing, barred};
use super::outcome::Outcome;
use super::words::{counted, cut, failing, finding, list, name, p_value, some_of, standing};

/// Who is first on all cases, and what that rests on.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Headline {
    /// Whether lost flights or a significant difference decide it.
    pub(super) is_decided: bool,
    /// "PID wins", "PID is first, and nobody wins", "one tuning each: no winner can be named".
    pub(super) word: String,
    /// Who wins, if anybody does.
    pub(super) winner: Option<usize>,
    /// Why, without a full stop.
    pub(super) why: String,
    /// Whose comparison the reason tells in full, if it does.
    pub(super) told: Option<usize>,
}

pub(super) fn headline(outcome: &Outcome) -> Headline {
    let first = outcome.leader();
    let winner = cut(name(outcome, first), 60);
    let bar = bar_of_first(outcome, first);
    if outcome.judged.is_tuned_once() {
        let bar = bar.map_or(String::new(), |words| format!("; {words}"));
        let (word, tell) = match outcome.judged.has_idle_seeds() {
            true => (
                "every seed found the same: no winner can be named",
                "another tuning may find another order; an optimiser that draws, or a larger budget, would tell",
            ),
            false => (
                "one tuning each: no winner can be named",
                "another seed may find another order; contest.seeds = 3 or more would tell",
            ),
        };
        let why = format!("{winner} is first in it, and {tell}{bar}");
        let word = word.to_owned();
        return Headline { is_decided: false, word, winner: None, why, told: None };
    }
    let (is_decided, why) = match bar {
        Some(words) => (false, words),
        None => decision(outcome, first),
    };
    let word = match is_decided {
        // Nothing is known of how the designs were found.
        true if !outcome.judged.is_tuned() => {
            format!("{winner} wins, as these designs are written")
        }
        true => format!("{winner} wins"),
        false => format!("{winner} is first, and nobody wins"),
    };
    let told = outcome.comparison(first).filter(|_| is_decided).map(|it| it.contestant);
    Headline { is_decided, word, winner: is_decided.then_some(first), why, told }
}

/// Whether the first wins, and why, or why not: it has to be better than every other, and not than the one alone that all are
/// compared with.
fn decision(outcome: &Outcome, first: usize) -> (bool, String) {
    if outcome.beside_first.is_none() {
        return (false, "an error is 0 somewhere, so that errors have no ratios".to_owned());
    }
    let open = open(outcome, first);
    let is_open = |place: usize| open.contains(&place);
    let names: Vec<String> = open.iter().map(|place| cut(name(outcome, *place), 60)).collect();
    let undecided = format!("nothing decides between it and {}", list(&names));
    let against = outcome.judged.against;
    match outcome.comparison(first) {
        Some(found) if open.is_empty() => {
            let others = match outcome.judged.contestants.len() {
                2 => "",
                _ => "; everybody else is significantly worse, too",
            };
            (true, format!("{}{others}", finding(outcome, found)))
        }
        Some(_) if !is_open(against) => {
            (false, format!("it is better than {}, and {undecided}", cut(name(outcome, against), 60)))
        }
        None if open.is_empty() => (
            true,
            "every other controller has a significantly larger error or loses significantly more flights"
                .to_owned(),
        ),
        _ => (false, undecided),
    }
}

/// Places of those that the first is not known to be better than, in the order of the ranking: by the comparisons of everybody
/// with it, whomever the tables compare with.
fn open(outcome: &Outcome, first: usize) -> Vec<usize> {
    let is_worse = |it: &Comparison| it.standing == Standing::Worse && it.is_sure;
    let is_behind = |place: usize| {
        let mut beside = outcome.beside_first.iter().flatten();
        beside.any(|it| it.contestant == place && is_worse(it))
    };
    let ranking = outcome.first().ranking.into_iter();
    ranking.filter(|place| *place != first && !is_behind(*place)).collect()
}

/// How everybody else stands beside the first, where the sentences compare with another one.
pub(super) fn beside_first(outcome: &Outcome) -> Option<String> {
    let first = outcome.leader();
    if first == outcome.judged.against || outcome.judged.contestants.len() < 3 {
        return None;
    }
    let beside = outcome.beside_first.as_ref()?;
    let against = outcome.judged.against;
    let place = |it: &usize| {
        beside.iter().find(|found| found.contestant == *it && found.contestant != against)
    };
    let one = |found: &Comparison| {
        format!(
            "{} {} ({}, {})",
            cut(name(outcome, found.contestant), 60),
            standing(found),
            p_value(if found.by_flights { found.lost.p_adjusted } else { found.p_adjusted }),
            counted(found.evidence, "case", "cases")
        )
    };
    let all: Vec<String> = outcome.first().ranking.iter().filter_map(place).map(one).collect();
    Some(format!("Beside {}, which is first: {}.", cut(name(outcome, first), 60), all.join(", ")))
}

/// What keeps the first from winning, whatever its error: loops that are unstable at rest, or of which nobody can tell, flights
/// that all fail, or more that fail than of another, or tunings that broke what they were held to.
fn bar_of_first(outcome: &Outcome, first: usize) -> Option<String> {
    let (judged, count) = (&outcome.judged, outcome.summaries.get(first)?.whole.count);
    if count.unstable > 0 {
        let some = some_of(count.unstable, count.of);
        return Some(format!("{some} of loops that are unstable at rest"));
    }
    if count.undecided > 0 {
        let some = some_of(count.undecided, count.of);
        return Some(format!("{some} of loops of which nobody can tell whether they are stable"));
    }
    let others = (0..judged.contestants.len()).filter(|place| *place != first);
    let mut bars = others.filter_map(|place| Some((place, barred(judged, first, place)?)));
    bars.next().map(|(place, bar)| match bar {
        Bar::NotAllowed => {
            let [bad, of] = judged.contestants[first].not_allowed();
            format!("{bad} of its {of} tunings found nothing that was allowed")
        }
        _ => failing(outcome, first, place),
    })
}

#[cfg(test)]
mod tests;

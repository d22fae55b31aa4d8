//! Numbers and findings in words.

pub(super) use fspid_page::columns::cut;
use fspid_page::number::{fixed, short};
use fspid_scenario::requirement::Requirement;
use fspid_scenario::tuning::{Over, Tuning};

use super::compare::{Bar, CONFIDENCE, Comparison, Standing};
use super::flight::{FAR, Flight};
use super::judged::{CaseGroup, Contestant, Judged, Quantity};
use super::outcome::Outcome;
use super::summary::Spread;

/// What the tuning made small.
pub(super) fn objectives(tuning: &Tuning) -> Vec<String> {
    let one = |it: &fspid_scenario::tuning::Objective| {
        let name = it.requirement.measure.name();
        if it.weight.total_cmp(&1.0).is_eq() {
            name.to_owned()
        } else {
            format!("{} {name}", it.weight)
        }
    };
    let mut all: Vec<String> = tuning.objectives.iter().map(one).collect();
    match tuning.over {
        Over::Mean => {}
        Over::Worst => all.push("of the worst flight".to_owned()),
        Over::Tail { share } => {
            all.push(format!("over the worst {} % of the flights", 100.0 * share));
        }
    }
    all
}

/// Limits of means over the training flights.
pub(super) fn limits(tuning: &Tuning) -> Vec<String> {
    let one = |it: &Requirement| format!("{} {}", it.measure.name(), it.limits_in_words());
    tuning.limits.iter().map(one).collect()
}

/// A number with four digits.
pub(super) fn number(value: f64) -> String {
    if value.is_infinite() {
        return "lost".to_owned();
    }
    short(value, 4)
}

/// Median and quartiles: "1.234 (1.2 to 1.3)".
pub(super) fn spread(found: Option<Spread>, designs: usize) -> String {
    let Some(found) = found else {
        return "none".to_owned();
    };
    let median = number(found.median);
    if designs < 2 || found.median.is_infinite() {
        return median;
    }
    format!("{median} ({} to {})", number(found.lower), number(found.upper))
}

/// Some flights of a controller, of so many: "5 of its 6 flights are".
pub(crate) fn some_of(some: u64, of: u64) -> String {
    format!("{some} of its {of} flights {}", if some == 1 { "is" } else { "are" })
}

/// By how much a ratio is less or more than 1: "12 % less".
pub(super) fn change(ratio: f64) -> String {
    if ratio.is_infinite() {
        return "more without bound".to_owned();
    }
    let percent = 100.0 * (ratio - 1.0);
    let size = percent.abs();
    let digits = if size >= 10.0 { 0 } else { 1 };
    let text = format!("{size:.digits$}");
    match text.trim_matches(['0', '.']).is_empty() {
        true => "no difference".to_owned(),
        false if size >= 1000.0 => format!("{} times as much", number(ratio)),
        false => format!("{text} % {}", if percent < 0.0 { "less" } else { "more" }),
    }
}

/// An interval of a ratio: "5.1 to 18 % less", "from 3.0 % less to 4.0 % more".
pub(super) fn interval([lower, upper]: [f64; 2]) -> String {
    let size = |ratio: f64| change(ratio).split(" % ").next().unwrap_or_default().to_owned();
    let is_plain = |ratio: f64| change(ratio).contains(" % ");
    match (is_plain(lower) && is_plain(upper), lower < 1.0, upper < 1.0) {
        (true, false, false) => format!("{} to {} % more", size(lower), size(upper)),
        (true, true, true) => format!("{} to {} % less", size(upper), size(lower)),
        _ => format!("from {} to {}", change(lower), change(upper)),
    }
}

/// The same for tables: "+34 %", "\u{2212}5.1 %".
pub(super) fn signed(ratio: f64) -> String {
    if ratio.is_infinite() {
        return "unbounded".to_owned();
    }
    let percent = 100.0 * (ratio - 1.0);
    let digits = if percent.abs() >= 10.0 { 0 } else { 1 };
    let text = fixed(percent, digits);
    let is_positive = percent > 0.0 && text.contains(|c: char| ('1'..='9').contains(&c));
    format!("{}{text} %", if is_positive { "+" } else { "" })
}

/// An interval for tables: "+24 % to +44 %".
pub(super) fn signed_interval([lower, upper]: [f64; 2]) -> String {
    let below = if lower > 0.0 { signed(lower) } else { "unbounded".to_owned() };
    format!("{below} to {}", signed(upper))
}

/// The spread of a controller's means over the cases that nobody lost; over all where each was lost by somebody.
pub(super) fn spread_of(outcome: &Outcome, place: usize, quantity: Quantity) -> String {
    let (it, part) = (&outcome.judged.contestants[place], &outcome.summaries[place].whole);
    let found = match kept(outcome) {
        0 => part.spread(quantity),
        _ => part.kept_spread(quantity),
    };
    spread(found, it.designs.len())
}

/// How many cases nobody lost a flight of.
pub(super) fn kept(outcome: &Outcome) -> usize {
    let judged = &outcome.judged;
    judged.kept(judged.contestants.iter(), &judged.all()).len()
}

/// Over which cases [`spread_of`] is.
pub(super) fn over_kept(outcome: &Outcome) -> String {
    match (kept(outcome), outcome.judged.cases.len()) {
        (kept, all) if kept == all => "the cases".to_owned(),
        (0, _) => "the cases, of which each was lost by somebody".to_owned(),
        (kept, all) => format!("the {kept} of {all} cases that nobody lost a flight of"),
    }
}

/// What the columns of the measures hold: of several designs each a median, of one its means as they are.
pub(super) fn columns(outcome: &Outcome) -> String {
    match outcome.judged.has_several_designs() {
        true => format!("Medians over the seeds (quartiles) of means over {}.", over_kept(outcome)),
        false => format!("Means over {}.", over_kept(outcome)),
    }
}

/// A p-value in words.
pub(super) fn p_value(p: f64) -> String {
    match p {
        p if p < 1e-4 => "p < 0.0001".to_owned(),
        p if p < 0.01 => format!("p = {p:.4}"),
        p if p > 0.995 => "p = 1".to_owned(),
        p if p < 0.1 => format!("p = {p:.3}"),
        p => format!("p = {p:.2}"),
    }
}

/// A count with its noun.
pub(super) fn counted(count: usize, one: &str, many: &str) -> String {
    if count == 1 { format!("1 {one}") } else { format!("{count} {many}") }
}

pub(super) fn per_cent() -> String {
    format!("{} %", 100.0 * CONFIDENCE)
}

/// Words as a list: "one, two and three".
pub(super) fn list(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [only] => only.clone(),
        [head @ .., last] => format!("{} and {last}", head.join(", ")),
    }
}

pub(super) fn name(outcome: &Outcome, place: usize) -> &str {
    outcome.judged.contestants.get(place).map_or("", |it| it.name.as_str())
}

/// A group's name for people.
pub(super) fn group(name: &str) -> &str {
    if name.is_empty() { "other cases" } else { name }
}

/// How many flights of a controller fail, and why, and how many of another: "8 of its 8 flights fail (left the range of
/// its model), 2 of 8 of PID".
pub(super) fn failing(outcome: &Outcome, place: usize, other: usize) -> String {
    let count = |place: usize| outcome.summaries[place].whole.count;
    let (mine, theirs) = (count(place), count(other));
    let verb = if mine.failed == 1 { "fails" } else { "fail" };
    let designs = outcome.judged.contestants[place].designs.iter();
    let why = kinds(designs.flat_map(|it| &it.flights).filter(|flight| flight.failed));
    let why = if why.is_empty() { why } else { format!(" ({why})") };
    format!(
        "{} of its {} flights {verb}{why}, {} of {} of {}",
        mine.failed,
        mine.of,
        theirs.failed,
        theirs.of,
        cut(name(outcome, other), 60)
    )
}

/// Most kinds of reasons that are told at once.
const MOST_KINDS: usize = 2;

/// The kinds of reasons, the most frequent first: the measure, or the words before what differs from flight to flight.
pub(super) fn kinds<'a>(failed: impl Iterator<Item = &'a Flight>) -> String {
    let mut counted: Vec<(String, usize)> = Vec::new();
    for reason in failed.flat_map(|flight| &flight.reasons) {
        let kind = kind(reason);
        match counted.iter_mut().find(|(known, _)| *known == kind) {
            Some((_, count)) => *count += 1,
            None => counted.push((kind, 1)),
        }
    }
    counted.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
    let mut told: Vec<String> =
        counted.iter().take(MOST_KINDS).map(|(kind, _)| kind.clone()).collect();
    if counted.len() > MOST_KINDS {
        told.push(format!("{} more", counted.len() - MOST_KINDS));
    }
    told.join(", ")
}

/// Words that lead over to a number which is left out.
const LEADING: [&str; 5] = ["=", "t", "at", "within", "to"];

/// A reason without its numbers.
fn kind(reason: &str) -> String {
    if reason == FAR {
        return reason.to_owned();
    }
    let end = reason.find(|c: char| c.is_ascii_digit() || ",;:(".contains(c));
    let words = reason.get(..end.unwrap_or(reason.len())).unwrap_or(reason).trim();
    let mut words: Vec<&str> = words.trim_end_matches(['-', '+', '.', ' ']).split(' ').collect();
    while words.last().is_some_and(|last| LEADING.contains(last)) {
        words.pop();
    }
    let words = words.join(" ");
    cut(if words.is_empty() { reason } else { &words }, 40)
}

/// What a comparison found: "12 % less error than PID (95 %: from 18 % less to 5.1 % less), p = 0.0004".
pub(super) fn finding(outcome: &Outcome, found: &Comparison) -> String {
    let reference = name(outcome, outcome.judged.against);
    let mut words = Vec::new();
    if found.by_flights {
        words.push(lost_against(outcome, found));
    }
    match found.ratio.mean {
        None => words.push("no case that both flew".to_owned()),
        Some(ratio) => {
            let change = match change(ratio).as_str() {
                "no difference" => format!("the same IAE as {reference}"),
                change => format!("{change} IAE than {reference}"),
            };
            let sure = found
                .ratio
                .interval
                .map_or(String::new(), |it| format!(" ({}: {})", per_cent(), interval(it)));
            let place = match found.ratio.cases == found.evidence {
                true => String::new(),
                false => format!(
                    " on the {} that neither lost",
                    counted(found.ratio.cases, "case", "cases")
                ),
            };
            let p = p_value(found.p_adjusted);
            let alone = if outcome.judged.is_tuned_once() { " over the cases alone" } else { "" };
            words.push(format!("{change}{place}{sure}, {p}{alone}"));
        }
    }
    if let Some(ratio) = outcome.activity_of(found.contestant).and_then(|it| it.ratio.mean) {
        words.push(match change(ratio).as_str() {
            "no difference" => "as much elevator travel".to_owned(),
            change => format!("{change} elevator travel"),
        });
    }
    words.extend(failed_against(outcome, found));
    words.join("; ")
}

/// How many more flights a controller fails than the one compared with, if it does: a small error in flights that
/// break requirements is not the whole answer.
fn failed_against(outcome: &Outcome, found: &Comparison) -> Option<String> {
    let against = outcome.judged.against;
    let count = |place: usize| outcome.summaries[place].whole.count;
    let is_more = count(found.contestant).compared(count(against), |it| it.failed).is_gt();
    let is_ahead = match found.standing {
        Standing::Better => true,
        Standing::Worse => false,
        Standing::Open | Standing::Barred => found.ratio.mean.is_some_and(|ratio| ratio < 1.0),
    };
    let word = if is_ahead { "but" } else { "and" };
    is_more.then(|| format!("{word} {}", failing(outcome, found.contestant, against)))
}

/// How many flights a controller loses and how many the one compared with.
fn lost_against(outcome: &Outcome, found: &Comparison) -> String {
    let lost = |place: usize| {
        let count = outcome.summaries[place].whole.count;
        format!("{} of {}", count.lost, count.of)
    };
    let against = outcome.judged.against;
    format!(
        "it loses {} flights, {} {}; they differ in {}, {}",
        lost(found.contestant),
        name(outcome, against),
        lost(against),
        counted(found.lost.cases, "case", "cases"),
        p_value(found.lost.p_adjusted)
    )
}

/// How a controller stands, in some words.
pub(super) fn standing(found: &Comparison) -> String {
    let word = match (found.standing, found.by_flights, found.is_sure) {
        (Standing::Better, true, false) => "ahead by lost flights",
        (Standing::Worse, true, false) => "behind by lost flights",
        (Standing::Better, true, true) => "better by lost flights",
        (Standing::Worse, true, true) => "worse by lost flights",
        (Standing::Better, false, true) => "better",
        (Standing::Worse, false, true) => "worse",
        (Standing::Better, false, false) => "ahead in this one tuning",
        (Standing::Worse, false, false) => "behind in this one tuning",
        (Standing::Open, ..) => "not significant",
        (Standing::Barred, ..) => match found.bar {
            Some((true, Bar::AllFail)) => "not better, for all its flights fail",
            Some((true, Bar::NotAllowed)) => "not better, for its tunings found nothing allowed",
            Some((false, Bar::NotAllowed)) => {
                "not worse, for the tunings of what it is compared with found nothing allowed"
            }
            Some((true, Bar::Unstable)) => "not better, for it is unstable at rest",
            Some((true, Bar::Undecided)) => "not better, for nobody can tell whether it is stable",
            Some((true, Bar::FailsMore)) => "not better, for more of its flights fail",
            _ => "not worse, for what it is compared with fails",
        },
    };
    // Lost flights come first, and do not hide what holds where both came back.
    let elsewhere = match found.ratio.mean {
        Some(ratio)
            if found.by_flights
                && found.standing != Standing::Barred
                && found.p_adjusted <= 1.0 - CONFIDENCE =>
        {
            if ratio < 1.0 {
                ", a smaller error elsewhere"
            } else {
                ", a larger error elsewhere"
            }
        }
        _ => "",
    };
    format!("{word}{elsewhere}")
}

/// A controller against the one compared with, in a sentence.
pub(super) fn sentence(outcome: &Outcome, found: &Comparison) -> String {
    let who = name(outcome, found.contestant);
    let word = match found.standing {
        Standing::Open => "not significantly different".to_owned(),
        _ => standing(found),
    };
    format!("{who} is {word}: {}.", finding(outcome, found))
}

/// Who is first in each group of cases, a sentence each.
pub(super) fn by_group(outcome: &Outcome) -> Vec<String> {
    let groups = outcome.judged.groups();
    let sentence = |(place, CaseGroup { name: group_name, cases }): (usize, &CaseGroup)| {
        let first = outcome.first_of_group(place);
        let whose = first.ranking.iter().map(|&it| {
            let change = match first.ratios[it] {
                _ if it == outcome.judged.against => "compared with".to_owned(),
                Some(ratio) => change(ratio),
                None => "no case that both flew".to_owned(),
            };
            let lost = outcome.summaries[it].groups[place].count.lost;
            let lost = if lost > 0 {
                format!("; {} lost", counted(lost as usize, "flight", "flights"))
            } else {
                String::new()
            };
            format!("{} ({change}{lost})", name(outcome, it))
        });
        format!(
            "{} ({}): {}",
            group(group_name),
            counted(cases.len(), "case", "cases"),
            whose.collect::<Vec<_>>().join(", ")
        )
    };
    groups.iter().enumerate().map(sentence).collect()
}

/// Cases that are flown as others are: they count in means and not in tests.
fn no_evidence(judged: &Judged) -> Option<String> {
    let name = |case: usize| judged.cases.get(case).map_or("", |it| it.name.as_str());
    let of = |case: usize| match (judged.trained_name(case), judged.twin_of.get(case)?) {
        (Some(training), _) => Some(format!("\"{}\" as \"{training}\" of the tuning", name(case))),
        (None, Some(twin)) => Some(format!("\"{}\" as \"{}\"", name(case), name(*twin))),
        (None, None) => None,
    };
    let all: Vec<String> = judged.all().into_iter().filter_map(of).collect();
    let some: Vec<&str> = all.iter().take(TWINS_TOLD).map(String::as_str).collect();
    let more = match all.len().saturating_sub(TWINS_TOLD) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    (!all.is_empty()).then(|| {
        format!(
            "{} flown to a millionth like another, or as another in another size, and no evidence: {}{more}. They count in means and not in tests.",
            match all.len() {
                1 => "One case is".to_owned(),
                count => format!("{count} cases are"),
            },
            some.join(", ")
        )
    })
}

/// Pairs that have less evidence than there is of all: what a third controller alone can tell apart is one case between two.
fn between(outcome: &Outcome) -> Vec<String> {
    let judged = &outcome.judged;
    let (all, others) = (judged.evidence().len(), judged.contestants.len().saturating_sub(1));
    let (against, first) = (judged.against, outcome.leader());
    let with = |one: usize| move |it| (one, it);
    let pairs = outcome.error.iter().flatten().map(with(against));
    let beside = outcome.beside_first.iter().flatten().map(with(first));
    let beside = beside.filter(|(_, it)| first != against && it.contestant != against);
    let few = pairs.chain(beside).filter(|(_, it): &(usize, &Comparison)| it.evidence < all);
    few.map(|(one, it)| {
        let is_too_few = least_p(it.evidence) * others as f64 > 1.0 - CONFIDENCE;
        format!(
            "Between {} and {} {} of {all} cases {} evidence: both fly the others to a millionth like these{}.",
            cut(name(outcome, it.contestant), 60),
            cut(name(outcome, one), 60),
            it.evidence,
            if it.evidence == 1 { "is" } else { "are" },
            if is_too_few { ", and no difference could be significant" } else { "" }
        )
    })
    .collect()
}

/// The smallest p-value that the signs of so many cases can have: 2^(1-n).
fn least_p(cases: usize) -> f64 {
    libm::exp2(1.0 - cases as f64)
}

/// Cases without evidence that are told by their names.
const TWINS_TOLD: usize = 5;

/// What is to be known before the numbers are believed.
pub(super) fn cautions(outcome: &Outcome) -> Vec<String> {
    let (judged, setting) = (&outcome.judged, &outcome.setting);
    let mut notes = Vec::new();
    let others = judged.contestants.len().saturating_sub(1);
    let evidence = judged.evidence().len();
    if least_p(evidence) * others as f64 > 1.0 - CONFIDENCE {
        notes.push(format!(
            "{} {} too few for {}: no difference could be significant.",
            counted(evidence, "case", "cases"),
            if evidence == 1 { "is" } else { "are" },
            counted(others, "comparison", "comparisons")
        ));
    }
    notes.extend(no_evidence(judged));
    notes.extend(between(outcome));
    if judged.is_tuned() && setting.efforts.len() < 2 {
        notes.push("Each controller was tuned once: what another seed would have found is not in the intervals.".to_owned());
    }
    for contestant in &judged.contestants {
        notes.extend(nothing_allowed(contestant));
    }
    notes.extend((0..judged.contestants.len()).filter_map(|place| undecided(outcome, place)));
    notes.extend((0..judged.contestants.len()).filter_map(|place| loads_left(outcome, place)));
    notes
}

/// How many tunings of a controller found nothing that was allowed, if any.
pub(crate) fn nothing_allowed(contestant: &Contestant) -> Option<String> {
    let [bad, of] = contestant.not_allowed();
    (bad > 0).then(|| format!(
        "{}: {bad} of {of} tunings found no candidate that came back from every training flight and kept to every limit and requirement; the one that broke them least was judged.",
        contestant.name
    ))
}

/// In how many flights of a controller nobody can tell whether its loop is stable, if in any, and where to ask why.
fn undecided(outcome: &Outcome, place: usize) -> Option<String> {
    let (judged, count) = (&outcome.judged, outcome.summaries.get(place)?.whole.count);
    let designs = &judged.contestants.get(place)?.designs;
    let is_undecided = |case: usize| {
        designs.iter().flat_map(|it| judged.flights(it, case)).any(|flight| flight.undecided)
    };
    let first = judged.cases.get(judged.all().into_iter().find(|case| is_undecided(*case))?)?;
    Some(format!(
        "{}: of the loops of {} of its {} flights nobody can tell whether they are stable; `fspid simulate` with the changes of their case, the first of which is \"{}\", says why.",
        cut(name(outcome, place), 60),
        count.undecided,
        count.of,
        first.name
    ))
}

/// In how many flights of a controller much of a constant load is left, if in any.
fn loads_left(outcome: &Outcome, place: usize) -> Option<String> {
    let count = outcome.summaries.get(place)?.whole.count;
    let stays = match count.load_stays {
        0 => String::new(),
        all if all == count.load_left => {
            "; without an integral at rest it stays for good".to_owned()
        }
        some => format!("; in {some} of them, without an integral at rest, it stays for good"),
    };
    let words = format!(
        "{}: in {} of its {} flights a constant load at the servo is not removed: the loop at rest leaves more than a tenth of its largest effect at the end{stays}.",
        cut(name(outcome, place), 60),
        count.load_left,
        count.of
    );
    (count.load_left > 0).then_some(words)
}

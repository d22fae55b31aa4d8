//! Tables: controllers, failures, mirrored cases, cases.

use fspid_page::analysis::{Chapter, DataTable, Datum, Item};
use fspid_page::number::significant;
use fspid_scenario::measure::label;

use super::chapter;
use crate::contest::compare::{Comparison, Standing};
use crate::contest::flight::{FAILED, LOST};
use crate::contest::judged::{CaseGroup, Quantity};
use crate::contest::words::{
    columns, counted, cut, group, kept, kinds, name, number, p_value, per_cent, signed,
    signed_interval, spread, spread_of,
};
use crate::contest::{First, Flight, Outcome, text, words};

/// Most rows of the table of cases, and most columns of a table by groups.
const MOST_ROWS: usize = 300;
const MOST_GROUPS: usize = 16;
/// Most groups beside each other: a page of 1200 px has room for them.
const GROUPS_IN_A_TABLE: usize = 5;

pub(super) fn table(caption: String, head: &[&str], rows: Vec<Vec<Datum>>) -> DataTable {
    let head = head.iter().map(|it| (*it).to_owned()).collect();
    DataTable { caption, head, rows, cards: true }
}

/// What everyone came to, the first first.
pub(super) fn controllers(outcome: &Outcome) -> DataTable {
    let reference = cut(name(outcome, outcome.judged.against), 40);
    let head = [
        "controller",
        "standing",
        "IAE [deg s]",
        "difference (interval)",
        "p",
        "elevator travel [deg]",
        "difference",
        "lost",
    ];
    let rows = outcome.first().ranking.into_iter().map(|place| {
        let of = |quantity| Datum::Number(spread_of(outcome, place, quantity));
        let found = outcome.comparison(place);
        let p = found.map_or(DASH.to_owned(), |it| {
            p_value(it.p_adjusted).replace("p = ", "").replace("p ", "")
        });
        let activity = outcome.activity_of(place).and_then(|it| it.ratio.mean);
        let count = outcome.summaries[place].whole.count;
        vec![
            Datum::Text(cut(name(outcome, place), 60)),
            standing(outcome, place),
            of(Quantity::ERROR),
            difference(found),
            Datum::Number(p),
            of(Quantity::ACTIVITY),
            Datum::Number(activity.map_or(DASH.to_owned(), signed)),
            Datum::Number(format!("{} of {}", count.lost, count.of)),
        ]
    });
    let caption = format!(
        "{} Differences are those from {reference} in the geometric mean over the cases that neither lost; their intervals hold together at {}. p is the larger of two tests, after Holm's correction.",
        columns(outcome),
        per_cent()
    );
    table(caption, &head, rows.collect())
}

const DASH: &str = "\u{2013}";

fn difference(found: Option<&Comparison>) -> Datum {
    let Some(ratio) = found.map(|it| it.ratio) else {
        return Datum::Number(DASH.to_owned());
    };
    Datum::Number(match (ratio.mean, ratio.interval) {
        (Some(mean), Some(ends)) => format!("{} ({})", signed(mean), signed_interval(ends)),
        (Some(mean), None) => signed(mean),
        _ => DASH.to_owned(),
    })
}

/// The other measures of everyone, and other ways to compare.
pub(super) fn more(outcome: &Outcome) -> DataTable {
    let reference = cut(name(outcome, outcome.judged.against), 40);
    let is_other =
        |it: &Quantity| ![Quantity::ERROR, Quantity::ACTIVITY, Quantity::Cost].contains(it);
    let others: Vec<Quantity> = Quantity::all().filter(is_other).collect();
    let mut head = vec!["controller".to_owned()];
    head.extend(others.iter().map(|it| format!("{} [{}]", label(it.name(), it.unit()), it.unit())));
    head.push("cost".to_owned());
    head.push("difference of travel (interval)".to_owned());
    head.extend(["ratio of mean IAE", "IAE in a typical case (interval)"].map(str::to_owned));
    let rows = outcome.first().ranking.into_iter().map(|place| {
        let of = |quantity| Datum::Number(spread_of(outcome, place, quantity));
        let mut row = vec![Datum::Text(cut(name(outcome, place), 60))];
        row.extend(others.iter().copied().map(of));
        row.push(of(Quantity::Cost));
        row.push(difference(outcome.activity_of(place)));
        row.extend(typical(outcome.comparison(place)));
        row
    });
    let caption = format!(
        "{} Cost: what the tuning made small, on the cases of the contest. Ratio of mean IAE: the mean over all cases and seeds by that of {reference}. Typical case: the median over pairs of cases by Hodges and Lehmann, lost cases as the worst, with its own {} interval over cases.",
        columns(outcome),
        per_cent()
    );
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    table(caption, &head, rows.collect())
}

fn typical(found: Option<&Comparison>) -> [Datum; 2] {
    let Some(found) = found else {
        return [DASH, DASH].map(|it| Datum::Number(it.to_owned()));
    };
    let means = found.ratio_of_means.map(|ratio| match ratio.is_infinite() {
        true => "lost".to_owned(),
        false => significant(ratio, 3),
    });
    let typical = found.typical.map(|it| {
        let [middle, lower, upper] = [it.estimate, it.lower, it.upper].map(libm::exp);
        format!("{} ({})", signed(middle), signed_interval([lower, upper]))
    });
    let number = |text: Option<String>, why: &str| {
        text.map_or_else(|| Datum::Absent(why.to_owned()), Datum::Number)
    };
    [number(means, "both lose flights"), number(typical, "none")]
}

fn standing(outcome: &Outcome, place: usize) -> Datum {
    let Some(found) = outcome.comparison(place) else {
        return Datum::Text("compared with".to_owned());
    };
    let word = words::standing(found);
    match found.standing {
        Standing::Better if found.is_sure => Datum::Met(word),
        Standing::Worse if found.is_sure => Datum::Unmet(word),
        _ => Datum::Text(word),
    }
}

/// Lost and failed flights, and how alike mirrored cases are flown.
pub(super) fn failures_chapter(outcome: &Outcome) -> Chapter {
    let mut items = vec![Item::Table(failures(outcome))];
    if let Some(reasons) = reasons(outcome) {
        items.push(Item::Heading("Why flights failed".to_owned()));
        items.extend(reasons);
    }
    let mirrors = outcome.summaries.iter().enumerate();
    let mirrors: Vec<String> =
        mirrors.filter_map(|(place, it)| text::mirror(outcome, place, it)).collect();
    if !mirrors.is_empty() {
        items.push(Item::Heading("Both directions alike?".to_owned()));
        items.push(Item::Text("Largest difference between a case and its mirror image, over all seeds and draws: of the error integral as the larger by the smaller, and of the overshoot.".to_owned()));
        items.push(Item::List(mirrors));
    }
    chapter("failures", "Failures", items)
}

fn failures(outcome: &Outcome) -> DataTable {
    let contestants = outcome.judged.contestants.iter().zip(&outcome.summaries);
    let percent = |[lower, upper]: [f64; 2]| {
        format!("{} % to {} %", significant(100.0 * lower, 2), significant(100.0 * upper, 2))
    };
    let rows = contestants.map(|(it, summary)| {
        let count = summary.whole.count;
        let whole = summary.whole.spread(Quantity::ERROR);
        vec![
            Datum::Text(cut(&it.name, 60)),
            Datum::Number(format!("{} of {}", count.lost, count.of)),
            Datum::Number(percent(summary.lost)),
            Datum::Number(format!("{} of {}", count.failed, count.of)),
            Datum::Number(percent(summary.failed)),
            Datum::Number(format!("{} of {}", count.unstable, count.of)),
            Datum::Number(format!("{} of {}", count.undecided, count.of)),
            Datum::Number(spread(whole, it.designs.len())),
        ]
    });
    let without = kept(outcome);
    let head = [
        "controller",
        "lost",
        "probability of a loss",
        "failed",
        "probability of a failure",
        "unstable at rest",
        "undecided",
        "IAE on all cases [deg s]",
    ];
    let caption = format!(
        "A flight is lost that {LOST}. A flight fails that {FAILED}. Intervals are those of Clopper and Pearson at {} with each case as one flight, for draws and seeds of a case fail together: for other cases like these, and the designs as they were found. Loops that are unstable at rest, and those of which nobody can tell (undecided), are judged by their error as they flew, and who has one does not win. A mean with a lost flight is \"lost\". Nobody lost a flight of {}.",
        per_cent(),
        match without {
            kept if kept == outcome.judged.cases.len() => "any case".to_owned(),
            kept => format!("{kept} of {} cases", outcome.judged.cases.len()),
        }
    );
    table(caption, &head, rows.collect())
}

/// Controllers by groups of cases: how many flights failed, and mostly why; none where none failed.
fn reasons(outcome: &Outcome) -> Option<Vec<Item>> {
    let judged = &outcome.judged;
    let groups = judged.groups();
    let mut any = false;
    let rows: Vec<Vec<Datum>> = judged
        .contestants
        .iter()
        .map(|contestant| {
            let mut row = vec![Datum::Text(cut(&contestant.name, 60))];
            for CaseGroup { cases, .. } in groups.iter().take(MOST_GROUPS) {
                let flights: Vec<&Flight> = contestant
                    .designs
                    .iter()
                    .flat_map(|design| cases.iter().flat_map(|case| judged.flights(design, *case)))
                    .collect();
                let failed: Vec<&Flight> =
                    flights.iter().copied().filter(|flight| flight.failed).collect();
                any |= !failed.is_empty();
                row.push(match failed.len() {
                    0 => Datum::Met(format!("none of {}", flights.len())),
                    some => Datum::Unmet(format!(
                        "{some} of {}: {}",
                        flights.len(),
                        kinds(failed.iter().copied())
                    )),
                });
            }
            row
        })
        .collect();
    let caption = format!(
        "Failed flights of all flights of each group, over all seeds and draws, and the reasons that most of them have. The whole reason of every flight is in contest.parquet.{}",
        left_out(groups.len())
    );
    any.then(|| grouped_tables(caption, &groups, &rows))
}

/// How everyone differs from the one compared with, by group of cases; the first of each group is marked.
pub(super) fn by_group(outcome: &Outcome) -> Vec<Item> {
    let judged = &outcome.judged;
    let groups = judged.groups();
    let firsts: Vec<First> =
        (0..groups.len().min(MOST_GROUPS)).map(|place| outcome.first_of_group(place)).collect();
    let rows = outcome.first().ranking.into_iter().map(|place| {
        let mut row = vec![Datum::Text(cut(name(outcome, place), 60))];
        for (group, first) in firsts.iter().enumerate() {
            let change = match first.ratios.get(place).copied().flatten() {
                _ if place == judged.against => "compared with".to_owned(),
                Some(ratio) => signed(ratio),
                None => DASH.to_owned(),
            };
            let lost = outcome.summaries[place].groups[group].count.lost;
            let words = match lost {
                0 => change,
                lost => format!("{change}, {lost} lost"),
            };
            row.push(match first.ranking.first() == Some(&place) {
                true => Datum::Met(words),
                false => Datum::Text(words),
            });
        }
        row
    });
    let caption = format!(
        "Mean difference of IAE from {} over the cases of each group that neither lost; below 0 is better. The first of each group is marked, which is a rank and no significance.{}",
        cut(name(outcome, judged.against), 60),
        left_out(groups.len())
    );
    grouped_tables(caption, &groups, &rows.collect::<Vec<_>>())
}

/// Tables of a column for each group, so many in one as a page has room for; the caption stands above the first.
fn grouped_tables(caption: String, groups: &[CaseGroup], rows: &[Vec<Datum>]) -> Vec<Item> {
    let heads: Vec<String> = groups
        .iter()
        .take(MOST_GROUPS)
        .map(|CaseGroup { name, cases }| {
            format!("{} ({})", cut(group(name), 40), counted(cases.len(), "case", "cases"))
        })
        .collect();
    let mut captions = [caption].into_iter();
    let chunk = |(index, heads): (usize, &[String])| {
        let first = 1 + index * GROUPS_IN_A_TABLE;
        let part = |row: &Vec<Datum>| -> Vec<Datum> {
            let cells = row.iter().skip(first).take(heads.len());
            row.iter().take(1).chain(cells).cloned().collect()
        };
        let head = ["controller"].into_iter().chain(heads.iter().map(String::as_str));
        let head: Vec<&str> = head.collect();
        let caption = captions.next().unwrap_or_else(|| "Further groups of cases.".to_owned());
        Item::Table(table(caption, &head, rows.iter().map(part).collect()))
    };
    heads.chunks(GROUPS_IN_A_TABLE).enumerate().map(chunk).collect()
}

/// A sentence about groups that a table has no room for.
fn left_out(groups: usize) -> String {
    match groups.saturating_sub(MOST_GROUPS) {
        0 => String::new(),
        more => format!(" {} left out.", counted(more, "group is", "groups are")),
    }
}

/// The error of everyone on each case.
pub(super) fn cases(outcome: &Outcome) -> DataTable {
    let judged = &outcome.judged;
    let mut head = vec!["case", "group"];
    let names: Vec<String> = judged.contestants.iter().map(|it| cut(&it.name, 30)).collect();
    head.extend(names.iter().map(String::as_str));
    let rows = judged.cases.iter().enumerate().take(MOST_ROWS).map(|(place, case)| {
        let medians: Vec<f64> = outcome
            .summaries
            .iter()
            .map(|it| it.cases[place].spread(Quantity::ERROR).map_or(f64::INFINITY, |it| it.median))
            .collect();
        let least = medians.iter().copied().fold(f64::INFINITY, f64::min);
        let mut row =
            vec![Datum::Text(cut(&case.name, 60)), Datum::Text(group(&case.group).to_owned())];
        row.extend(medians.iter().map(|it| match *it <= least && it.is_finite() {
            true => Datum::Met(number(*it)),
            false => Datum::Number(number(*it)),
        }));
        row
    });
    let left = judged.cases.len().saturating_sub(MOST_ROWS);
    let left = if left > 0 { format!(" {left} cases are left out.") } else { String::new() };
    let median = match judged.has_several_designs() {
        true => ": median over the seeds",
        false => "",
    };
    let caption = format!("IAE [deg s] of each case{median}; the smallest is marked.{left}");
    table(caption, &head, rows.collect())
}

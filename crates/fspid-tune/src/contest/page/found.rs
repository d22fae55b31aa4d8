//! What the tunings found.

use fspid_page::analysis::{Chapter, Datum, Item};

use super::tables;
use crate::contest::judged::{Contestant, Judged};
use crate::contest::words::{counted, cut, number};
use crate::contest::{Found, Outcome};

/// Most numbers of a controller that are shown; a grid of rules has dozens.
const MOST_NUMBERS: usize = 60;

fn items(outcome: &Outcome) -> Vec<Item> {
    let tuned = outcome.judged.contestants.iter().filter(|it| it.is_tuned);
    let mut items = Vec::new();
    let rows: Vec<Vec<Datum>> = tuned.clone().flat_map(seeds).collect();
    if rows.is_empty() {
        return items;
    }
    let head = ["controller", "seed", "candidates", "cost on the training cases", "why it ended"];
    let caption = "Every tuning. The design with the least cost on the training cases is the one that is drawn and shown below; nobody looked at the contest to choose it.";
    items.push(Item::Table(tables::table(caption.to_owned(), &head, rows)));
    for contestant in tuned {
        let best = contestant.designs.get(Judged::best(contestant));
        if let Some(found) = best.and_then(|it| it.found.as_ref()) {
            items.push(numbers(contestant, found));
        }
    }
    items
}

/// A table for each controller that was tuned; none where nobody was.
pub(super) fn chapter(outcome: &Outcome) -> Option<Chapter> {
    let items = items(outcome);
    (!items.is_empty()).then(|| super::chapter("tuned", "What was tuned", items))
}

fn seeds(contestant: &Contestant) -> Vec<Vec<Datum>> {
    let found = contestant.designs.iter().filter_map(|it| it.found.as_ref());
    found
        .map(|it| {
            let cost = it.cost.map_or_else(
                || Datum::Unmet("none was allowed".to_owned()),
                |cost| Datum::Number(number(cost)),
            );
            vec![
                Datum::Text(cut(&contestant.name, 60)),
                Datum::Number(it.effort.seed.to_string()),
                Datum::Number(it.candidates.to_string()),
                cost,
                Datum::Text(it.stop.clone()),
            ]
        })
        .collect()
}

fn numbers(contestant: &Contestant, found: &Found) -> Item {
    let rows = found.numbers.iter().take(MOST_NUMBERS).map(|it| {
        let bounds = it.bounds.map_or_else(
            || Datum::Text("label from \u{2212}3 (NB) to 3 (PB)".to_owned()),
            |[lower, upper]| {
                let note = if it.at_bound { "; it is active" } else { "" };
                Datum::Text(format!("{} to {}{note}", number(lower), number(upper)))
            },
        );
        vec![
            Datum::Text(cut(&it.path, 80)),
            Datum::Number(number(it.start)),
            Datum::Number(number(it.value)),
            bounds,
        ]
    });
    let left = found.numbers.len().saturating_sub(MOST_NUMBERS);
    let left = if left > 0 { format!(" {left} more stand in the design.") } else { String::new() };
    let caption = format!("Free numbers of the best design, seed {}.{left}", found.effort.seed);
    let head = ["number", "start", "found", "bounds"];
    let table = tables::table(caption, &head, rows.collect());
    let count = counted(found.numbers.len(), "free number", "free numbers");
    let title = format!("{}: {count}", cut(&contestant.name, 60));
    Item::Fold(title, vec![Item::Table(table)])
}

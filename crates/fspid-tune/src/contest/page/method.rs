//! How it was judged, so that nobody has to believe it.

use fspid_page::analysis::{Chapter, Datum, Item};

use super::tables;
use crate::contest::Outcome;
use crate::contest::flight::{FAILED, LOST};
use crate::contest::words::{counted, cut, group, name, number, per_cent};

fn items(outcome: &Outcome) -> Vec<Item> {
    let setting = &outcome.setting;
    let reference = cut(name(outcome, outcome.judged.against), 60);
    let mut items = vec![
        Item::Heading("Tuning".to_owned()),
        Item::Text(match setting.efforts.first().filter(|_| outcome.judged.is_tuned()) {
            None => "Nobody has free numbers; all fly as they are written.".to_owned(),
            Some(effort) => format!(
                "Every controller with free numbers was tuned with {} and {} from each of {}, to make small: {}{}. Each candidate flew {}{}. A requirement of the scenario that is broken comes before any cost. Controllers without free numbers fly as they are written.",
                effort.optimiser,
                counted(effort.budget, "candidate", "candidates"),
                counted(setting.efforts.len(), "seed", "seeds"),
                setting.objectives.join(" + "),
                match setting.limits.is_empty() {
                    true => String::new(),
                    false => format!(", with on average {}", setting.limits.join(", ")),
                },
                training(outcome),
                if setting.training_runs > 0 {
                    format!(", with {} of the dispersions each", counted(setting.training_runs as usize, "draw", "draws"))
                } else {
                    String::new()
                },
            ),
        }),
        Item::Heading("What counts as one observation".to_owned()),
        Item::Text("Flights of one case, or of one design, are not independent of each other. So cases and designs are counted, never flights: draws of a case are averaged first. Weights of cases count in means alone. All controllers fly the same cases and the same draws, so that differences are paired.".to_owned()),
        Item::Heading("Differences and their intervals".to_owned()),
        Item::Text(format!("For each case the logarithm of the IAE, averaged over the seeds, less that of {reference}. The mean over the cases is the logarithm of the mean ratio. Its error has a part for the cases, which are as if drawn from many cases like these, and a part for the seeds of each tuned controller (crossed random effects; what is peculiar to a single flight is counted in every part, which errs on the wide side); Student's distribution with the degrees of freedom of Satterthwaite (1946) gives interval and p-value.")),
        Item::Text(format!("A second test assumes no distribution: Wilcoxon's signed ranks of the cases, exact, with Pratt's treatment of ties; the estimate of Hodges and Lehmann and its interval belong to it. The larger of both p-values counts, after Holm's correction (1979) for all comparisons; the intervals of all cases are widened likewise (Bonferroni), so that all hold together at {}. Significant is a corrected p of at most 0.05. Who wins is held against every other by the same tests, and not against {reference} alone. Cases that two fly to a millionth alike, or in another size as a linear loop flies its steps, are one between them; each case draws aircraft of its own. Elevator travel, groups and single cases are told without such a test.", per_cent())),
        Item::Heading("Lost flights".to_owned()),
        Item::Text(format!("A flight is lost that {LOST}. A flight fails that {FAILED}. Who fails all flights does not win and is not called better than anybody; nor is who fails more than another, where the signed ranks of the shares that fail of each case say that this is significant. A loop that is unstable at rest and does not diverge is judged by its error like any other, but the flight counts as failed, and who has one does not win, however small the error in its window; nor does who has one of which nobody can tell whether it is stable (undecided). Lost flights never vanish from a mean: with one the mean is infinite, \"lost\". In the test of ranks a case in which one controller loses a larger share of its flights is its largest defeat. The mean ratio is that of the cases that neither lost, and says so. Who loses the larger share of all flights ranks behind and is never called better; it is called worse where the signed ranks of the shares that are lost of each case, after Holm's correction, say that this is significant, and behind where they do not.")),
        Item::Text("A step that did not settle counts in means of settling times with the whole length of its window.".to_owned()),
    ];
    items.push(Item::Fold("The cases".to_owned(), vec![Item::Table(case_table(outcome))]));
    items
}

pub(super) fn chapter(outcome: &Outcome) -> Chapter {
    super::chapter("method", "How it was judged", items(outcome))
}

fn training(outcome: &Outcome) -> String {
    let names = &outcome.setting.training;
    match names.len() {
        0 => "the scenario as it is written".to_owned(),
        count => {
            let names: Vec<String> = names.iter().map(|it| cut(it, 60)).collect();
            format!(
                "{} ({})",
                counted(count, "training case", "training cases"),
                cut(&names.join(", "), 600)
            )
        }
    }
}

fn case_table(outcome: &Outcome) -> fspid_page::analysis::DataTable {
    let cases = &outcome.judged.cases;
    let rows = cases.iter().map(|case| {
        let mirrored = case.mirror_of.and_then(|place| cases.get(place));
        vec![
            Datum::Text(cut(&case.name, 60)),
            Datum::Text(group(&case.group).to_owned()),
            Datum::Code(cut(&case.set.join(" "), 300)),
            Datum::Number(case.runs.to_string()),
            Datum::Number(case.draws_seed.map_or(String::new(), |it| it.to_string())),
            Datum::Number(number(case.weight)),
            Datum::Text(mirrored.map_or(String::new(), |it| cut(&it.name, 60))),
        ]
    });
    let head = [
        "case",
        "group",
        "what it changes",
        "flights of a design",
        "seed of its draws",
        "weight in means",
        "mirror image of",
    ];
    tables::table("What the controllers were judged on.".to_owned(), &head, rows.collect())
}

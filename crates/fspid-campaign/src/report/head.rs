//! Which campaign it is, and how it is made again.

use fspid_page::analysis::{Chapter, DataTable, Datum, Item};
use fspid_study::shell;

use super::Source;
use super::words::{count, cut};
use crate::plan::Plan;

/// Longest text of a scenario that is shown whole, in bytes: beyond, a page would be longer than its figures.
const MOST_TEXT: usize = 100_000;

pub(super) fn heading(source: &Source<'_>) -> String {
    let name = source.summary.head.scenario.as_deref().filter(|name| !name.trim().is_empty());
    cut(name.unwrap_or("Scenario without a name"), 200)
}

pub(super) fn lead(source: &Source<'_>) -> String {
    let head = &source.summary.head;
    let controllers = match head.controllers.len() {
        1 => "one controller".to_owned(),
        many => format!("{many} controllers, all on the same runs"),
    };
    let flown = match head.runs {
        1 => "One run".to_owned(),
        runs => format!("{} runs", count(runs)),
    };
    let drawn = match head.parameters.len() {
        1 => "one parameter".to_owned(),
        many => format!("{many} parameters"),
    };
    let incomplete = head.incomplete().map_or_else(String::new, |it| format!("{it}. "));
    format!(
        "{incomplete}{flown} of one scenario with {drawn} drawn anew for each, flown with {controllers}."
    )
}

pub(super) fn facts(source: &Source<'_>) -> Vec<(String, String)> {
    let head = &source.summary.head;
    let fact = |what: &str, value: String| (what.to_owned(), value);
    let names: Vec<String> = head.controllers.iter().map(|name| cut(name, 60)).collect();
    let here = Plan::this_program();
    let mut facts = vec![
        fact("runs", count(head.runs)),
        fact("flights", count(head.rows)),
        fact("seed", head.seed.to_string()),
        fact("sampling", head.sampling.name().to_owned()),
        fact("controllers", names.join(", ")),
        fact("folder in commands", cut(source.folder, 200)),
        fact("flown by", cut(&head.program, 60)),
        fact("this page by", here),
        fact("campaign", head.campaign.clone()),
        match head.digest {
            Some(digest) => fact("digest of all rows (checked)", digest.to_string()),
            None => fact("digest", "each part has its own (checked)".to_owned()),
        },
        fact("digest of the scenario", head.scenario_digest.clone()),
    ];
    facts.extend(head.incomplete().map(|incomplete| fact("incomplete", incomplete)));
    if !head.changes.is_empty() {
        facts.push(fact("changes to the scenario", cut(&head.changes.join(", "), 400)));
    }
    facts
}

/// The commands that make the file and the page again.
pub(super) fn commands(source: &Source<'_>) -> String {
    let head = &source.summary.head;
    let [scenario, folder] = [source.scenario, source.folder].map(shell::word);
    let set: String =
        head.changes.iter().map(|change| format!(" --set {}", shell::word(change))).collect();
    let (runs, seed, sampling) = (head.planned_runs, head.seed, head.sampling.name());
    let file = match (head.shards, head.incomplete()) {
        (None, _) => shell::word(&format!("{}/campaign.parquet", source.folder)),
        (Some(_), None) => folder.clone(),
        (Some(_), Some(_)) => format!("{folder} --incomplete"),
    };
    format!(
        "fspid campaign run {scenario}{set} --runs {runs} --seed {seed} --sampling {sampling} --out {folder}\nfspid campaign report {file} --out campaign.html"
    )
}

/// The parameters, and the scenario as it was planned.
pub(super) fn scenario(source: &Source<'_>) -> Chapter {
    let head = &source.summary.head;
    let row = |it: &crate::summary::Parameter| {
        vec![Datum::Text(cut(&it.name, 48)), Datum::Text(cut(&it.meaning, 400))]
    };
    let table = DataTable {
        caption: "What was drawn for each run.".to_owned(),
        head: ["parameter", "how it is distributed"].map(str::to_owned).to_vec(),
        rows: head.parameters.iter().map(row).collect(),
        cards: false,
    };
    let text = &head.scenario_text;
    let shown = text.get(..text.floor_char_boundary(MOST_TEXT)).unwrap_or(text);
    let mut items = vec![
        Item::Table(table),
        Item::Fold(
            format!("The scenario's text: {} of the command above", cut(source.scenario, 200)),
            vec![Item::Code(shown.to_owned())],
        ),
    ];
    if shown.len() < text.len() {
        items.push(Item::Warning("The scenario is too long to be shown whole.".to_owned()));
    }
    Chapter { id: "scenario".to_owned(), title: "Scenario".to_owned(), items }
}

//! The page of a contest: who wins where, then what that rests on.

mod figures;
mod found;
mod method;
mod responses;
mod tables;

use fspid_campaign::Plan;
use fspid_page::analysis::{Chapter, Item, Picture, Standing as Colour, Verdict};
use fspid_page::campaign::CampaignPage;
use fspid_plot::{SeriesStyle, Svg};
use fspid_study::shell::word;

use super::flight::LOST;
use super::headline::{Headline, beside_first, headline};
use super::words::{cautions, cut, list, name, sentence};
use super::{Contest, Outcome, text};

/// Most sentences above the table; the table has all.
const MOST_SENTENCES: usize = 12;

/// The page as one HTML file.
pub(super) fn page(contest: &Contest, outcome: &Outcome) -> String {
    let setting = &outcome.setting;
    let scenario = match setting.scenario.trim() {
        "" => "Scenario without a name".to_owned(),
        name => cut(name, 200),
    };
    let mut chapters = vec![figures::where_chapter(outcome), figures::trade_chapter(outcome)];
    chapters.push(tables::failures_chapter(outcome));
    chapters.push(responses::chapter(contest, outcome));
    chapters.extend(found::chapter(outcome));
    chapters.push(method::chapter(outcome));
    CampaignPage {
        title: format!("{scenario}: contest"),
        lead: text::held(outcome),
        facts: facts(outcome),
        commands: command(outcome),
        verdicts: vec![verdict(outcome)],
        answer: answer(outcome),
        notes: notes(outcome),
        chapters,
        heading: format!("{scenario}: who wins where"),
    }
    .render()
}

fn verdict(outcome: &Outcome) -> Verdict {
    let against = outcome.judged.against;
    let Headline { is_decided, word, why, .. } = headline(outcome);
    let first = outcome.first().ranking.first().copied();
    let name = match first == Some(against) {
        true => "the controller that the others are compared with".to_owned(),
        false => format!("compared with {}", cut(name(outcome, against), 60)),
    };
    let standing = if is_decided { Colour::Good } else { Colour::Fair };
    Verdict { standing, word, name, detail: format!("{}.", capital(&why)) }
}

/// A text with a capital at its beginning.
fn capital(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |first| first.to_uppercase().chain(chars).collect())
}

/// Sentences, the table of controllers, and the figure of differences.
fn answer(outcome: &Outcome) -> Vec<Item> {
    let ranking = outcome.first().ranking;
    let told = headline(outcome).told;
    let found = ranking.iter().filter(|place| Some(**place) != told);
    let found = found.filter_map(|place| outcome.comparison(*place));
    let sentences: Vec<String> = found
        .take(MOST_SENTENCES)
        .map(|it| sentence(outcome, it))
        .chain(beside_first(outcome))
        .collect();
    let mut items = vec![Item::Heading("Who is how far from whom, by kind of case".to_owned())];
    items.extend(tables::by_group(outcome));
    items.extend([
        Item::Heading("The controllers".to_owned()),
        Item::Table(tables::controllers(outcome)),
        Item::Fold("More of everyone".to_owned(), vec![Item::Table(tables::more(outcome))]),
    ]);
    // Of two controllers the verdict above has said the one sentence that there is.
    if !sentences.is_empty() {
        items.push(Item::Heading("The same in sentences".to_owned()));
        items.push(Item::List(sentences));
    }
    items
}

fn notes(outcome: &Outcome) -> Vec<String> {
    let mut notes = cautions(outcome);
    let seeds = match outcome.judged.is_tuned() {
        true => " and seeds like these",
        false => "",
    };
    notes.push(format!("Significant means: cases like these{seeds} would tell the same. It does not mean that the difference matters, nor that other aircraft would tell the same."));
    notes.push(format!("A flight is lost that {LOST}; it has no error. It makes the mean of its design infinite, which the tables call \"lost\"; its case ranks behind every case without; and a controller that loses a larger share of its flights than another stands behind it, whatever its error elsewhere. Whether other cases would tell the same is tested apart."));
    notes
}

fn facts(outcome: &Outcome) -> Vec<(String, String)> {
    let (judged, setting) = (&outcome.judged, &outcome.setting);
    let fact = |what: &str, value: String| (what.to_owned(), value);
    let names: Vec<String> = judged.contestants.iter().map(|it| cut(&it.name, 60)).collect();
    let flights: usize =
        judged.contestants.iter().flat_map(|it| &it.designs).map(|it| it.flights.len()).sum();
    let mut facts = vec![
        fact("controllers", list(&names)),
        fact("compared with", cut(name(outcome, judged.against), 60)),
        fact("cases", judged.cases.len().to_string()),
        fact("flights judged", flights.to_string()),
    ];
    if let Some(effort) = setting.efforts.first().filter(|_| outcome.judged.is_tuned()) {
        let seeds: Vec<String> = setting.efforts.iter().map(|it| it.seed.to_string()).collect();
        facts.push(fact("optimiser", effort.optimiser.clone()));
        facts.push(fact("candidates of each tuning", effort.budget.to_string()));
        facts.push(fact("seeds", cut(&list(&seeds), 200)));
        facts.push(fact("made small", setting.objectives.join(" + ")));
        if !setting.limits.is_empty() {
            facts.push(fact("on average", setting.limits.join(", ")));
        }
    }
    facts.push(fact("digest of the scenario", setting.digest.clone()));
    facts.push(fact("by", Plan::this_program()));
    facts
}

fn command(outcome: &Outcome) -> String {
    let setting = &outcome.setting;
    let mut words = vec![format!("fspid contest {}", word(&setting.file))];
    words.extend(setting.overrides.iter().map(|it| format!("--set {}", word(it))));
    if let Some(effort) = setting.efforts.first().filter(|_| outcome.judged.is_tuned()) {
        words.push(format!("--seeds {} --budget {}", setting.efforts.len(), effort.budget));
    }
    words.push(format!("--out {}", word(&setting.folder)));
    words.join(" ")
}

/// How the controller at a place is drawn in every figure: by its rank, so that those who matter most differ.
fn style(outcome: &Outcome, place: usize) -> SeriesStyle {
    let ranking = outcome.first().ranking;
    SeriesStyle::Numbered(ranking.iter().position(|it| *it == place).unwrap_or(place))
}

fn picture(name: &str, svg: Svg, caption: impl Into<String>) -> Item {
    Item::Figure(Picture { name: name.to_owned(), svg, caption: caption.into() })
}

fn chapter(id: &str, title: &str, items: Vec<Item>) -> Chapter {
    Chapter { id: id.to_owned(), title: title.to_owned(), items }
}

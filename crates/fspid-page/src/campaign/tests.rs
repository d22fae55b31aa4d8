//! What holds for the page of a campaign.

use super::*;
use crate::analysis::{DataTable, Datum, Picture, Standing};
use fspid_plot::{IntervalFigure, ShareMap};

const HOSTILE: &str = "<script>alert('x')</script>\" & 日本";

fn picture(name: &str) -> Item {
    let figure = ShareMap {
        title: HOSTILE.to_owned(),
        x_label: HOSTILE.to_owned(),
        y_label: HOSTILE.to_owned(),
        quantity: HOSTILE.to_owned(),
        most_pct: None,
        x_edges: vec![0.0, 1.0],
        y_edges: vec![0.0, 1.0],
        cells: Vec::new(),
    };
    Item::Figure(Picture {
        name: name.to_owned(),
        svg: figure.render(),
        caption: HOSTILE.to_owned(),
    })
}

fn full() -> CampaignPage {
    let words = || HOSTILE.to_owned();
    let table = DataTable {
        caption: words(),
        head: vec![words(), "again".to_owned()],
        rows: vec![vec![Datum::Text(words()), Datum::Code(words())]],
        cards: true,
    };
    let intervals = IntervalFigure {
        title: "Failing".to_owned(),
        columns: Vec::new(),
        rows: Vec::new(),
        series: Vec::new(),
        width_px: 720.0,
    };
    let small = Picture { name: words(), svg: intervals.render(), caption: words() };
    let fold =
        Item::Fold(words(), vec![picture("same"), Item::Fold(words(), vec![picture("same")])]);
    CampaignPage {
        title: words(),
        heading: words(),
        lead: words(),
        facts: vec![(words(), words())],
        commands: format!("fspid {HOSTILE}"),
        verdicts: vec![Verdict {
            standing: Standing::Bad,
            word: "12 of 100 failed".to_owned(),
            name: words(),
            detail: words(),
        }],
        answer: vec![Item::Figure(small), Item::Table(table), picture("same")],
        notes: vec![words()],
        chapters: vec![Chapter { id: "same".to_owned(), title: words(), items: vec![fold] }],
    }
}

#[test]
fn the_answer_stands_before_the_contents_and_its_notes_do_too() {
    let page = full().render();
    let at = |text: &str| page.find(text).unwrap_or_else(|| panic!("{text} is missing"));
    assert!(at("<dl class=\"facts\">") < at("\u{2717} 12 of 100 failed"));
    assert!(at("\u{2717} 12 of 100 failed") < at("<nav class=\"contents\""));
    assert!(at("Before these numbers are used") < at("<nav class=\"contents\""));
    assert!(!page.contains("class=\"failed\""), "a template failed");
}

#[test]
fn nothing_that_somebody_named_becomes_markup() {
    let page = full().render();
    assert!(page.matches("<script").count() == 1 && page.contains("&lt;script&gt;"));
    assert!(page.contains("<code><span>&lt;script&gt;"), "a command in a table");
    assert!(!page.contains("href=\"http") && !page.contains("src="));
}

#[test]
fn ids_within_folds_are_unique_too() {
    let page = full().render();
    let mut ids: Vec<&str> =
        page.split(" id=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    ids.retain(|id| !id.starts_with("fig-"));
    let count = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), count, "{ids:?}");
    assert!(page.matches("<details>").count() == 2);
}

/// What was folded on the screen was missing in print.
#[test]
fn what_is_folded_is_printed() {
    let page = full().render();
    let (_, print) = page.split_once("details::details-content{").expect("a rule");
    assert!(print.starts_with("content-visibility:visible"), "{}", &print[..80]);
    assert!(!page.contains("details:not([open]){display:none}"));
    let (_, script) = page.split_once("addEventListener(\"beforeprint\"").expect("a script");
    assert!(script.contains("details:not([open])") && script.contains("one.open = true"));
}

#[test]
fn a_page_on_which_nothing_flew_says_so() {
    let page = CampaignPage::default().render();
    assert!(page.contains("NOTHING FLEW") && !page.contains("verdict good"));
}

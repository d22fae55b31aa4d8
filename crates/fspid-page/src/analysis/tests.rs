//! What holds for the page of an analysis.

use super::*;
use fspid_plot::{LineFigure, LinePanel};

fn picture(name: &str, caption: &str) -> Picture {
    let figure = LineFigure {
        title: caption.to_owned(),
        panels: vec![LinePanel::default()],
        width_px: 720.0,
    };
    Picture { name: name.to_owned(), svg: figure.render(), caption: caption.to_owned() }
}

fn table() -> DataTable {
    let words = |text: &str| text.to_owned();
    DataTable {
        caption: words("Margins."),
        head: vec![words("controller"), words("gain margin [dB]"), words("verdict")],
        rows: vec![
            vec![
                Datum::Text(words("CPID")),
                Datum::Number(words("5.64")),
                Datum::Unmet(words("NOT MET")),
            ],
            vec![
                Datum::Text(words("PC")),
                Datum::Absent(words("no crossing")),
                Datum::Met(words("met")),
            ],
            vec![Datum::Text(words("bold")), Datum::Failing(words("the loop is unstable"), 2)],
        ],
        cards: true,
    }
}

fn verdict(standing: Standing, word: &str) -> Verdict {
    let detail = "Gain margin 5.6 dB.".to_owned();
    Verdict { standing, word: word.to_owned(), name: "<FSPID>".to_owned(), detail }
}

fn full() -> AnalysisPage {
    let items = vec![
        Item::Text("A loop & its margins.".to_owned()),
        Item::Heading("Figures".to_owned()),
        Item::Figure(picture("bode", "Bode")),
        Item::Figures(vec![picture("bode", "one"), picture("bode", "two")]),
        Item::Figures(vec![picture("a", "a"), picture("b", "b"), picture("c", "c")]),
        Item::Table(table()),
        Item::List(vec!["first".to_owned(), "second".to_owned()]),
        Item::Code("fspid certify --check x.json".to_owned()),
        Item::Warning("Frozen gains prove nothing.".to_owned()),
    ];
    let chapter =
        |id: &str| Chapter { id: id.to_owned(), title: "Margins".to_owned(), items: items.clone() };
    AnalysisPage {
        title: "paper: loop analysis".to_owned(),
        heading: "paper".to_owned(),
        lead: "Margins of the sampled loop.".to_owned(),
        verdicts: vec![verdict(Standing::Good, "Stable"), verdict(Standing::Bad, "UNSTABLE")],
        beside: Vec::new(),
        warnings: vec!["Saturation is not covered.".to_owned()],
        requirements: Some((table(), false)),
        chapters: vec![chapter("margins"), chapter("margins"), chapter("content"), chapter("")],
        provenance: Provenance {
            command: "fspid analyse FILE --report OUT.html".to_owned(),
            digest: "0123".to_owned(),
            further: vec![("grid".to_owned(), "9 x 9".to_owned())],
        },
    }
}

#[test]
fn the_verdict_stands_before_the_contents_and_everything_else() {
    let page = full().render();
    let at = |text: &str| page.find(text).unwrap_or_else(|| panic!("{text} is missing"));
    assert!(at("\u{2717} UNSTABLE") < at("<nav class=\"contents\""));
    assert!(at("Saturation is not covered.") < at("<nav class=\"contents\""));
    assert!(at("\u{2717} NOT all met") < at("2. Margins"));
    assert!(page.contains("role=\"alert\""));
    assert!(!page.contains("class=\"failed\""), "a template failed");
}

#[test]
fn ids_are_unique_although_names_are_not() {
    let page = full().render();
    let mut ids: Vec<&str> =
        page.split(" id=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    // Inside of drawings of the same figure the ids are those of its content.
    ids.retain(|id| !id.starts_with("fig-"));
    let count = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), count);
    for link in page.split("href=\"#").skip(1).filter_map(|rest| rest.split('"').next()) {
        assert!(ids.contains(&link), "{link} leads nowhere");
    }
}

#[test]
fn names_are_escaped_and_cells_look_as_what_they_are() {
    let page = full().render();
    assert!(page.contains("&lt;FSPID&gt;") && !page.contains("<FSPID>"));
    assert!(page.contains("class=\"unmet\" data-label=\"verdict\">\u{2717} NOT MET<"));
    assert!(page.contains("class=\"met\" data-label=\"verdict\">\u{2713} met<"));
    assert!(page.contains("class=\"absent\" data-label=\"gain margin [dB]\">no crossing<"));
    assert!(page.contains("colspan=\"2\" class=\"failing\""));
}

#[test]
fn a_page_without_a_verdict_does_not_look_like_a_good_one() {
    let page = AnalysisPage::default().render();
    assert!(page.contains("NOTHING WAS JUDGED") && page.contains("verdict bad"));
    assert!(!page.contains("verdict good") && !page.contains("all met"));
}

#[test]
fn rows_longer_than_the_head_are_shown_whole() {
    let mut odd = full();
    let long = vec![Datum::Number("1".to_owned()); 9];
    odd.requirements = Some((DataTable { rows: vec![long, Vec::new()], ..table() }, true));
    let page = odd.render();
    assert!(!page.contains("class=\"failed\""), "a template failed");
    assert!(page.contains("\u{2713} all met"));
}

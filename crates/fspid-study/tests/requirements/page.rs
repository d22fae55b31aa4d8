//! The page of `fspid verify`: sound, with the numbers of the answer, and the same each time.

use serde_json::Value;

use crate::as_read::as_read;
use crate::requirements::answers::{THREE, hostile};
use crate::requirements::{JUMBO, verified, written};
use crate::sound::assert_sound;

/// The row of a requirement in the table of a controller.
fn row<'a>(html: &'a str, controller: &str, id: &str) -> &'a str {
    let (_, table) = html.split_once(&format!("<caption>{controller}: ")).expect("a table");
    let (table, _) = table.split_once("</table>").expect("closed");
    // Pages write a slash as they write what might close a tag.
    let id = id.replace('/', "&#x2f;");
    let (_, row) = table.split_once(&format!("<th scope=\"row\">{id}</th>")).expect("a row");
    row.split_once("</tr>").expect("closed").0
}

#[test]
fn the_page_has_the_verdict_and_every_number_of_the_answer_beside_its_limit() {
    let (_folder, path) = written(&format!("{JUMBO}\n{THREE}"));
    let verification = verified(&path, &["ctms"], &[]);
    let (html, answer) = (verification.page(), verification.json(None));
    assert_sound(&html);
    let verdict = html.find("\u{2717} FAIL").expect("the verdict");
    assert!(verdict < html.find("class=\"contents\"").expect("contents"));
    let words =
        format!("{} requirements met", answer["requirements"].as_array().map_or(0, Vec::len));
    assert!(html.contains(&format!("{} of {words}", answer["met"])), "{words}");
    for line in answer["requirements"].as_array().expect("lines") {
        let text = |key: &str| line[key].as_str().unwrap_or_default();
        let row = row(&html, text("controller"), text("id"));
        let cell = |label: &str| {
            let (_, rest) = row.split_once(&format!("data-label=\"{label}\">")).expect("a cell");
            rest.split_once("</td>").expect("closed").0.to_owned()
        };
        let expected = match (&line["value"], &line["met"]) {
            (_, Value::Bool(true)) => "\u{2713} met",
            (Value::Null, _) => "\u{2717} NOT EVALUATED",
            _ => "\u{2717} NOT MET",
        };
        assert_eq!(cell("verdict"), expected, "{line}");
        assert!(cell("set, clause").contains(text("clause")), "{line}");
        match line["value"].as_f64().filter(|_| text("measure") != "stable") {
            Some(value) => {
                let told = cell("found");
                let (number, unit) = told.split_once(' ').unwrap_or((&told, ""));
                let number: f64 = number.parse().expect("a number");
                assert!((number - value).abs() <= 1e-4 * value.abs(), "{number} {value}");
                assert_eq!(unit, text("unit"), "{line}");
            }
            None if line["value"].is_null() => {
                assert!(as_read(row).contains(text("reason")), "{line}");
            }
            None => {}
        }
    }
}

#[test]
fn everything_that_the_text_says_of_the_lines_stands_in_the_page() {
    let (_folder, path) = written(&format!("{JUMBO}\n{THREE}"));
    let verification = verified(&path, &["mil-f-8785c:level=2,category=C"], &[]);
    let (page, text) = (as_read(&verification.page()), verification.text(None));
    let (_, said) = text.split_once("What is asked\n").expect("what is asked");
    let (said, _) = said.split_once("\nWith --replay").expect("the last paragraph");
    for paragraph in said.split("\n- ").flat_map(|it| it.split("\n\n")) {
        let paragraph = paragraph.trim_start_matches("- ").trim_start_matches("Notes");
        let sentence: Vec<&str> = paragraph.split_whitespace().collect();
        let sentence = sentence.join(" ");
        assert!(page.contains(sentence.trim_start_matches("- ")), "{sentence}");
    }
    let set = "fspid verify FILE --set 'mil-f-8785c:level=2,category=C' --report OUT.html";
    assert!(page.contains(&set.replace('\'', "")) || page.contains(set), "the command");
    assert!(page.contains("fspid simulate FILE --report OUT.html"), "where the figures are");
}

#[test]
fn names_of_a_hostile_scenario_stay_text_and_two_pages_have_the_same_bytes() {
    let (_folder, path) = written(&hostile());
    let [one, other] = [(), ()].map(|()| verified(&path, &[], &[]).page());
    assert!(one == other);
    assert_sound(&one);
    assert!(one.contains("&lt;R id=") && !one.contains("<R id"), "an id is no tag");
    assert!(!one.contains("</testsuite>"), "a name closes nothing");
    let odd = one.chars().find(|c| c.is_control() && !['\n', '\t'].contains(c));
    assert_eq!(odd, None, "no character that a page may not hold");
}

#[test]
fn a_page_on_which_all_is_met_says_so() {
    let one = "[[requirement]]\nmeasure = \"stable\"\n";
    let (_folder, path) = written(&format!("{JUMBO}\n{one}"));
    let html = verified(&path, &[], &[]).page();
    assert!(html.contains("\u{2713} PASS") && html.contains("Every requirement is met"));
    assert!(!html.contains("verdict bad") && !html.contains("NOT MET"));
}

/// A green PASS stood above an altitude that goes up and down by 45 m for ever, and the doubt behind it in the notes.
#[test]
fn a_loop_of_which_it_is_undecided_whether_it_is_stable_is_told_beside_the_verdict() {
    let capture = include_str!("../../../../scenarios/gallery/altitude-capture.toml");
    let (_folder, path) = written(capture);
    let html = |limit: &str| {
        let limit = format!("outer_loop.altitude.most_per_s={limit}");
        verified(&path, &["outer_loop.altitude.kp=0.6", &limit], &[]).page()
    };
    let doubt = "It is undecided whether the loop is stable of PID: see the notes.";
    let (swings, rests) = (as_read(&html("0.15")), as_read(&html("1.0")));
    assert!(swings.contains("PASS") && swings.contains(doubt));
    assert!(rests.contains("PASS") && !rests.contains("undecided"));
    assert!(html("0.15").contains("verdict fair") && html("1.0").contains("verdict good"));
}

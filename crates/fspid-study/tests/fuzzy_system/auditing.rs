//! What is said to be true of a system.

use fspid_scenario::fuzzy_system::parse;
use fspid_study::fuzzy_system::{AuditQuestion, Mark, audit};
use fspid_study::report;

use super::{TIP, tip, values};

/// Few boxes, so that the tests are quick.
const QUICK: AuditQuestion<'static> = AuditQuestion { spans: &[], rest: &[], boxes: Some(200) };

#[test]
fn a_sound_system_holds_and_every_finding_is_a_sentence() {
    let system = tip();
    let found = audit(&system, &QUICK).expect("good");
    let chapters = found.chapters();
    let titles: Vec<&str> = chapters.iter().map(|chapter| chapter.title.as_str()).collect();
    assert_eq!(titles, ["rules", "tip"]);
    let all = chapters.iter().flat_map(|chapter| &chapter.findings);
    for finding in all {
        assert!(finding.sentence.len() > 4 && !finding.sentence.contains("NaN"), "{finding:?}");
        assert_ne!(finding.mark, Mark::NotMeant, "{finding:?}");
    }
    assert!(found.text().contains("3 rules; no two contradict each other"));
}

#[test]
fn contradictions_repetitions_and_unused_terms_are_named() {
    let text = TIP.replace(
        "if service is excellent or food is very delicious then tip is generous",
        "if service is good then tip is average with 0.5\nif service is good then tip is cheap",
    );
    let system = parse(&text, "tip.toml").expect("good");
    let found = audit(&system, &QUICK).expect("good").text();
    let flat = found.split_whitespace().collect::<Vec<_>>().join(" ");
    for part in [
        "from the same condition rule 2 and rule 4 conclude average and cheap",
        "rule 2 and rule 3 say the same",
        "no rule asks for excellent of service; delicious of food",
        "no rule concludes generous",
    ] {
        assert!(flat.contains(part), "{part} in\n{found}");
    }
}

#[test]
fn a_place_where_no_rule_fires_is_told() {
    let narrow =
        TIP.replace("sigma = 1.5", "sigma = 0.02").replace("left_foot = -2", "left_foot = -1");
    let triangles = narrow
        .replace(
            "shape = \"gaussian\", centre = 0, sigma = 0.02",
            "shape = \"triangle\", left = -1, peak = 0, right = 1",
        )
        .replace(
            "shape = \"gaussian\", centre = 5, sigma = 0.02",
            "shape = \"triangle\", left = 4, peak = 5, right = 6",
        )
        .replace(
            "shape = \"gaussian\", centre = 10, sigma = 0.02",
            "shape = \"triangle\", left = 9, peak = 10, right = 11",
        );
    let system = parse(&triangles, "tip.toml").expect("good");
    let found = audit(&system, &QUICK).expect("good").text();
    assert!(found.contains("no rule fires at service ="), "{found}");
}

#[test]
fn numbers_are_proved_bounds_by_name_and_the_page_stands_alone() {
    let system = tip();
    let rest = values(&["service=5", "food=5"]);
    let spans = values(&["food=2..8"]);
    let question = AuditQuestion { spans: &spans, rest: &rest, boxes: Some(200) };
    let found = audit(&system, &question).expect("good");
    let json = found.json();
    assert_eq!(json["domain"]["food"], serde_json::json!([2.0, 8.0]));
    assert_eq!(json["rest"]["service"], 5.0);
    let tip = &json["outputs"]["tip"];
    for key in ["least", "most", "coverage", "along", "odd", "even", "at_rest"] {
        assert!(!tip[key].is_null(), "{key}");
    }
    assert!(tip["along"]["service"]["lipschitz"][1].as_f64().expect("a number") > 0.0);
    let page = report::of_audit(&found);
    assert!(
        page.contains("</html>")
            && !page.contains("class=\"failed\"")
            && page.matches("<script").count() == 1
    );
    assert!(
        !page.contains("http://")
            || page.matches("http://").count() == page.matches("http://www.w3.org").count()
    );
    let wrong = values(&["fod=1..2", "food=2..1"]);
    let question = AuditQuestion { spans: &wrong, ..QUICK };
    let told = audit(&system, &question).expect_err("wrong").to_string();
    assert!(told.contains("did you mean `food`?") && told.contains("NAME=LOWER..UPPER"), "{told}");
}

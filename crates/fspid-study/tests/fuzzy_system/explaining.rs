//! Shares, and what a conclusion lacked.

use fspid_scenario::fuzzy_system::{Options, load, parse};
use fspid_study::fuzzy_system::{Basis, explain};

use super::{TIP, tip, values};

#[test]
fn shares_of_the_area_sum_to_one_and_contributions_to_the_answer() {
    let options = Options { range: Some(5.0), ..Options::default() };
    let supervisor = load("printed", options).expect("shipped").system;
    for n in 0..50 {
        let (error, change) = (4.9 * (f64::from(n) * 0.7).sin(), 4.9 * (f64::from(n) * 1.3).cos());
        let inputs = [format!("error={error}"), format!("change={change}")];
        let found = explain(&supervisor, &inputs, None).expect("good");
        let answers = found.json();
        for (shares, name) in found.shares.iter().zip(["delta_kp", "delta_ki", "delta_kd"]) {
            assert_eq!(shares.basis, Basis::Outline);
            let parts: f64 = shares.list.iter().map(|share| share.part).sum();
            assert!((parts - 1.0).abs() < 1e-12, "{parts}");
            let value = answers["outputs"][name]["value"].as_f64().expect("a number");
            let sum = shares.sum.expect("rules fire");
            assert!((sum - value).abs() < 1e-12, "{name}: {sum} {value}");
        }
    }
}

#[test]
fn a_rule_that_others_cover_fires_and_has_no_share() {
    let doubled = TIP.replace(
        "if service is good then tip is average with 0.5",
        "if service is good then tip is average with 0.5\nif service is good then tip is average with 0.25",
    );
    let system = parse(&doubled, "tip.toml").expect("good");
    let found = explain(&system, &values(&["service=5", "food=5"]), None).expect("good");
    let own = |rule: usize| {
        let share = found.shares[0].list.iter().find(|share| share.of.origin[1] == rule);
        share.expect("it fires").part
    };
    assert!(own(1) > 0.5 && own(2) == 0.0);
    let strongest = found.rules[0];
    assert_eq!((strongest.rule, strongest.strength), (1, 0.5));
}

#[test]
fn curved_sets_are_shared_on_a_grid_and_sums_belong_to_nobody() {
    let set = "{ shape = \"triangle\", left = 0, peak = 5, right = 10 }";
    let curved = TIP.replace(set, "{ shape = \"gaussian\", centre = 5, sigma = 2 }");
    let system = parse(&curved, "tip.toml").expect("good");
    let found = explain(&system, &values(&["service=3", "food=4"]), None).expect("good");
    assert!(matches!(found.shares[0].basis, Basis::Grid(_)));
    let value = found.json()["outputs"]["tip"]["value"].as_f64().expect("a number");
    assert!((found.shares[0].sum.expect("rules fire") - value).abs() < 1e-3);
    let summed = TIP.replace("fallback = \"middle\"", "aggregation = \"algebraic-sum\"");
    let system = parse(&summed, "tip.toml").expect("good");
    let found = explain(&system, &values(&["service=3", "food=4"]), None).expect("good");
    assert_eq!((found.shares[0].basis, found.shares[0].list.len()), (Basis::Aggregated, 0));
}

#[test]
fn a_weighted_average_is_shared_by_weight() {
    let (inputs, _) = TIP.split_once("[[output]]").expect("an output");
    let text = format!(
        "{inputs}[[output]]\nname = \"tip\"\ndefuzzifier = \"weighted-average\"\nterms = {{ cheap = 5, generous = {{ constant = 20, slopes = {{ food = 1 }} }} }}\n\
         [[rules]]\nlines = [\"if service is poor then tip is cheap\", \"if service is good then tip is generous\"]\n"
    );
    let system = parse(&text, "tip.toml").expect("good");
    let found = explain(&system, &values(&["service=2", "food=3"]), None).expect("good");
    let shares = &found.shares[0];
    assert_eq!(shares.basis, Basis::Weights);
    let value = found.json()["outputs"]["tip"]["value"].as_f64().expect("a number");
    assert!((shares.sum.expect("rules fire") - value).abs() < 1e-12);
    assert!((shares.list.iter().map(|share| share.part).sum::<f64>() - 1.0).abs() < 1e-12);
}

#[test]
fn a_conclusion_that_was_not_drawn_names_the_statement_that_held_it_down() {
    let system = tip();
    let inputs = values(&["service=1", "food=8"]);
    let found = explain(&system, &inputs, Some("tip=generous")).expect("good");
    let lacks = &found.why_not.as_ref().expect("asked").rules;
    assert_eq!((lacks.len(), lacks[0].rule), (1, [0, 2]));
    // Of the two, joined by `or`, the better one is nearest to helping.
    assert_eq!(lacks[0].limit, Some(1));
    assert!((lacks[0].statements[1].1 - 0.25).abs() < 1e-12, "{lacks:?}");
    assert!((lacks[0].strength - 0.25).abs() < 1e-12);
    let text = found.text();
    assert!(text.contains("0.250000  food is very delicious  <- holds it down"), "{text}");
    let told = explain(&system, &inputs, Some("tip=generos")).expect_err("wrong").to_string();
    assert!(told.contains("did you mean `generous`?"), "{told}");
}

#[test]
fn the_drawing_names_rules_and_answer() {
    let system = tip();
    let found = explain(&system, &values(&["service=3", "food=8"]), None).expect("good");
    let figures = found.figures();
    let svg = figures[0].1.as_str();
    for part in ["tip at service = 3, food = 8", "rule 1: cheap,", ">average<", ">16.7<"] {
        assert!(svg.contains(part), "{part}");
    }
}

/// It said that no rule fired beside a rule that fires at 1, and `100.00 %  NaN`.
#[test]
fn a_rule_whose_formula_has_no_number_fires_and_is_not_shared_as_one() {
    let system = parse(include_str!("../systems/memory.toml"), "memory.toml").expect("good");
    let found = explain(&system, &values(&["x=1"]), None).expect("good");
    let told = found.text();
    assert!(told.contains("the rules gave no number; the output's default"), "{told}");
    assert!(told.contains("no number  rule 1: more"), "{told}");
    assert!(!told.contains("NaN") && !told.contains("together"), "{told}");
    let json = found.json();
    assert_eq!(json["outputs"]["sum"]["reason"], "the rules gave no number");
    let nothing = TIP.replace("fallback = \"middle\"", "enabled = false\nfallback = \"middle\"");
    let system = parse(&nothing, "tip.toml").expect("good");
    let told = explain(&system, &values(&["service=5", "food=5"]), None).expect("good").text();
    assert!(told.contains("the output is switched off; the middle of the range"), "{told}");
}

//! What is said to be true of a system.

use fspid_scenario::fuzzy_system::parse;
use fspid_study::fuzzy_system::{AuditQuestion, Mark, ask, audit};
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

/// A system of one output `z` over an input `x` from -1 to 1 with a low and a high set, and one that is everywhere.
fn of_x(terms: &str, output: &str, rules: &str) -> String {
    format!(
        "schema = 1\nkind = \"fuzzy-system\"\nname = \"t\"\n[[input]]\nname = \"x\"\nrange = [-1, 1]\n[input.terms]\nlo = {{ shape = \"linear-z\", shoulder = -1, foot = 0 }}\nhi = {{ shape = \"linear-s\", foot = -1, shoulder = 1 }}\nall = {{ shape = \"rectangle\", start = -5, end = 5 }}\n{terms}\n[[output]]\nname = \"z\"\nrange = [0, 1]\n{output}\n[[rules]]\n{rules}\n"
    )
}

const NUMBERS: &str = "defuzzifier = \"weighted-average\"\n[output.terms]\na = 0\nb = 1";
const SETS: &str = "[output.terms]\na = { shape = \"triangle\", left = 0, peak = 0.25, right = 0.5 }\nb = { shape = \"triangle\", left = 0.5, peak = 0.75, right = 1 }";

/// Systems of which the audit proved what one question refutes: conclusions of rules that do not fire, with hedges that make
/// something of nothing; shapings and joinings that are formulas; formulas without a value, and across poles.
fn refuted() -> Vec<String> {
    let on_f = "lines = [\"if x is f then z is a\", \"if x is all then z is b\"]";
    let set = |formula: &str| format!("f = {{ formula = \"{formula}\" }}");
    let not_a = "lines = [\"if x is lo then z is b\", \"if x is hi then z is not a\", \"if x is hi and x is lo then z is not a\"]";
    let any_a = "lines = [\"if x is lo then z is any a\", \"if x is all then z is b\"]";
    let implied = "implication = { formula = \"max(1-a, b)\" }\nlines = [\"if x is lo then z is b\", \"if x is hi then z is a\", \"if x is hi and x is lo then z is a\"]";
    let root = "defuzzifier = \"weighted-average\"\nfallback = 100\n[output.terms]\na = { value = \"sqrt(x)\" }";
    let joined = SETS.replacen("[output.terms]", "aggregation = { formula = \"max(a*0.5, b)\" }\nsampling = \"endpoints:101\"\n[output.terms]", 1);
    let both = "lines = [\"if x is lo then z is a\", \"if x is hi then z is b\"]";
    let mut all = vec![
        of_x("", NUMBERS, any_a),
        of_x("", SETS, not_a),
        of_x("", SETS, implied),
        of_x("", root, "lines = [\"if x is all then z is a\"]"),
        of_x("", &joined, both),
    ];
    for formula in ["max(0.5, ln(x))", "tan(2*x)", "1/x", "sqrt(x)", "asin(2*x)"] {
        all.push(of_x(&set(formula), NUMBERS, on_f));
    }
    all
}

#[test]
fn what_hedges_and_formulas_make_of_nothing_is_within_what_is_proved() {
    for text in refuted() {
        let system = parse(&text, "t.toml").unwrap_or_else(|problems| panic!("{problems}\n{text}"));
        let found = audit(&system, &QUICK).expect("good");
        let json = found.json();
        let z = &json["outputs"]["z"];
        let bound =
            |key: &str, end: usize, open: f64| z[key]["bounds"][end].as_f64().unwrap_or(open);
        let (least, most) = (bound("least", 0, f64::NEG_INFINITY), bound("most", 1, f64::INFINITY));
        let may_fall_back = z["may_fall_back"] == true;
        let mut before: Option<f64> = None;
        let (mut rises, mut falls) = (false, false);
        for step in 0..=40 {
            let x = f64::from(step) / 20.0 - 1.0;
            let asked = ask(&system, &values(&[&format!("x={x}")])).expect("asked");
            let answered: Vec<_> = asked.answers().map(|(_, it)| *it).collect();
            let Some(value) = answered[0].value else { continue };
            let is_of_rules = answered[0].source == fspid_fuzzy::system::Source::Rules;
            let within = least - 1e-9 <= value && value <= most + 1e-9;
            assert!(
                within || may_fall_back && !is_of_rules,
                "{x}: {value}, {least} to {most}\n{text}"
            );
            rises |= before.is_some_and(|before| value > before + 1e-9);
            falls |= before.is_some_and(|before| value < before - 1e-9);
            before = Some(value);
        }
        if rises && falls {
            assert_ne!(z["along"]["x"]["monotone"], "proved", "{text}");
        }
        for finding in found.chapters().iter().flat_map(|it| &it.findings) {
            let proved = finding.mark == Mark::Holds;
            let told = &finding.sentence;
            assert!(!(proved && told.contains("odd about")), "{told}\n{text}");
            assert!(
                !told.contains("change nothing") && !told.contains("changes nothing"),
                "{told}\n{text}"
            );
        }
    }
}

/// "Some rule fires everywhere" of a grid that is joined by what falls with its grades, or whose grade depends on another input.
#[test]
fn a_complete_grid_is_covered_only_where_norms_join_grades_of_their_own_inputs() {
    let two = |of_y: &str, rules: &str| {
        let text = of_x("", SETS, rules);
        let y =
            format!("[[input]]\nname = \"y\"\nrange = [-1, 1]\n[input.terms]\n{of_y}\n[[output]]");
        text.replacen("[[output]]", &y, 1)
    };
    let sets = "lo = { shape = \"linear-z\", shoulder = -1, foot = 1 }\nhi = { shape = \"linear-s\", foot = -1, shoulder = 1 }";
    let grid = "lines = [\"if x is all and y is lo then z is a\", \"if x is all and y is hi then z is b\"]";
    let falls = format!("and = {{ formula = \"1 - 2*min(a, b)\" }}\n{grid}");
    let other = "lo = { formula = \"max(0, 0.5 - 0.6*x)\" }";
    let alone = "lines = [\"if x is all and y is lo then z is a\"]";
    for (text, wanted) in
        [(two(sets, grid), true), (two(sets, &falls), false), (two(other, alone), false)]
    {
        let system = parse(&text, "t.toml").unwrap_or_else(|problems| panic!("{problems}\n{text}"));
        let json = audit(&system, &QUICK).expect("good").json();
        let everywhere = &json["outputs"]["z"]["coverage"]["everywhere"];
        assert_eq!(everywhere == "proved", wanted, "{everywhere}\n{text}");
    }
}

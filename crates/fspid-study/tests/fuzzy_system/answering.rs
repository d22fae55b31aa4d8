//! Answers, by name.

use fspid_scenario::fuzzy_system::{LoadError, Options, load, parse};
use fspid_study::fuzzy_system::{SliceQuestion, SystemTable, ask, slice};
use fspid_study::rows::{RowAnswers, RowsError, answer_rows};

use super::{TIP, tip, values};

fn tip_at(service: f64, food: f64) -> f64 {
    let system = tip();
    let mut workspace = system.workspace();
    let answers = system.evaluate(&[service, food], &mut workspace).expect("finite");
    answers[0].value.expect("rules fire")
}

#[test]
fn an_answer_says_by_which_rule_it_was_computed() {
    let system = tip();
    let json = ask(&system, &values(&["food=8", "service=3"])).expect("good").json();
    assert_eq!(json["outputs"]["tip"]["value"], tip_at(3.0, 8.0));
    assert_eq!(json["outputs"]["tip"]["rule"], "centroid, exact");
    assert_eq!(json["outputs"]["tip"]["source"], "rules");
    let text = ask(&system, &values(&["food=18", "service=3"])).expect("good").text();
    assert!(text.contains("food lies outside of its range; used as it is"), "{text}");
}

#[test]
fn every_problem_of_a_question_is_told_at_once() {
    let system = tip();
    let told =
        ask(&system, &values(&["fod=1", "service=x", "service"])).expect_err("wrong").to_string();
    for part in [
        "there is no input `fod`; did you mean `food`? Known are service, food",
        "service is `x`; allowed is a number",
        "`service` is no name=value",
        "food has no value; add --input food=…",
    ] {
        assert!(told.contains(part), "{part} in\n{told}");
    }
}

#[test]
fn an_option_overrides_the_rule_of_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("tip.toml");
    std::fs::write(&path, TIP).expect("written");
    let name = path.display().to_string();
    let options = Options { sampling: Some("endpoints:101"), ..Options::default() };
    let system = load(&name, options).expect("good").system;
    let answer = ask(&system, &values(&["food=8", "service=4"])).expect("good");
    assert!(answer.text().contains("centroid, endpoints:101"));
    let options = Options { out_of_range: Some("error"), ..Options::default() };
    let system = load(&name, options).expect("good").system;
    assert!(ask(&system, &values(&["food=11", "service=4"])).is_err());
    let options =
        Options { sampling: Some("cog"), out_of_range: Some("wrap"), ..Options::default() };
    let told = load(&name, options).expect_err("wrong").to_string();
    assert!(told.contains("vertices:N") && told.contains("clamp, evaluate, error"), "{told}");
}

#[test]
fn a_name_that_is_no_system_lists_what_is() {
    let told = load("nowhere", Options::default()).expect_err("wrong").to_string();
    assert!(
        told.contains(".fis, .t2fis, .fcl, .fll or .xml") && told.contains("printed, mirrored"),
        "{told}"
    );
    let needs = load("printed", Options::default()).expect_err("wrong").to_string();
    assert!(needs.contains("--range"), "{needs}");
    let missing = load("nowhere.toml", Options::default());
    assert!(matches!(missing, Err(LoadError::Unreadable { .. })));
}

fn rows(text: &str) -> (Result<u64, RowsError>, String) {
    let system = tip();
    let mut out = Vec::new();
    let done = answer_rows(&mut SystemTable::new(&system), &mut text.as_bytes(), &mut out);
    (done, String::from_utf8(out).expect("UTF-8"))
}

#[test]
fn columns_are_found_by_name_and_others_are_passed_over() {
    let (done, out) = rows("\u{feff}note,food,service\r\nx,8,3\r\n\r\n\"a, b\",8, 4 \r\n");
    assert_eq!(done.expect("good"), 2);
    let expected = format!(
        "service,food,tip\n3.0,8.0,{:?}\n4.0,8.0,{:?}\n",
        tip_at(3.0, 8.0),
        tip_at(4.0, 8.0)
    );
    assert_eq!(out, expected);
}

#[test]
fn rows_before_the_first_bad_one_are_answered_and_problems_are_counted() {
    let (done, out) = rows("service,food\n1,2\n1,x\n1,nan\n3\n1,2\n");
    let Err(RowsError::Problems { problems, answered }) = done else { panic!("{done:?}") };
    assert_eq!(answered, Some(1));
    assert_eq!(out.lines().count(), 2);
    assert_eq!(
        problems,
        [
            "3: food is `x`; allowed is a number",
            "4: food is NaN; allowed is a finite number",
            "5: food is ``; allowed is a number",
        ]
    );
    let (done, _) = rows(&format!("service,food\n{}", "x,1\n".repeat(100)));
    let Err(RowsError::Problems { problems, .. }) = done else { panic!("{done:?}") };
    assert_eq!(problems.len(), 21);
}

#[test]
fn a_heading_without_a_column_is_refused() {
    let (done, out) = rows("service,fod\n1,2\n");
    assert!(
        done.expect_err("wrong").to_string().contains("it must name the columns service and food")
    );
    assert!(out.is_empty());
    assert!(rows("").0.is_err());
}

/// The first of them used to be taken, without a word.
#[test]
fn a_column_that_stands_twice_is_refused_whether_it_is_asked_or_passed_over() {
    for (heading, told) in [
        (
            "service,food,food",
            "columns 2 and 3 are both named `food`; names of columns must differ",
        ),
        (" \"service\" ,food,x,service", "columns 1 and 4 are both named `service`"),
        ("x,service,x,food", "columns 1 and 3 are both named `x`"),
    ] {
        let (done, out) = rows(&format!("{heading}\n1,2,3,4\n"));
        let error = done.expect_err("twice").to_string();
        assert!(error.contains(told) && out.is_empty(), "{error}");
    }
    // Spreadsheets leave columns without a name, and as many as they like.
    assert!(rows("service,food,,\n1,2,,\n").0.is_ok());
}

#[test]
fn an_output_without_an_answer_is_an_empty_cell_and_one_that_keeps_its_answer_keeps_it() {
    let text = TIP.replace("fallback = \"middle\"", "").replace("sigma = 1.5", "sigma = 0.01");
    let system = parse(&text, "tip.toml").expect("good");
    let run = |system: &fspid_scenario::fuzzy_system::System| {
        let mut out = Vec::new();
        let mut rows = "service,food\n2.5,5\n5,5\n2.5,5\n".as_bytes();
        answer_rows(&mut SystemTable::new(system), &mut rows, &mut out).expect("good");
        String::from_utf8(out).expect("UTF-8")
    };
    assert_eq!(run(&system), "service,food,tip\n2.5,5.0,\n5.0,5.0,15.0\n2.5,5.0,\n");
    let keeping =
        text.replace("name = \"tip\"\nrange", "name = \"tip\"\nkeep_previous = true\nrange");
    let keeping = parse(&keeping, "tip.toml").expect("good");
    assert_eq!(run(&keeping), "service,food,tip\n2.5,5.0,\n5.0,5.0,15.0\n2.5,5.0,15.0\n");
}

/// Two equal triangles with a gap between them, whose conclusions are no outline of straight lines.
const GAP: &str = "Engine: gap
InputVariable: a
  enabled: true
  range: 0 1
  lock-range: false
  term: lo Ramp 1 0
  term: hi Ramp 0 1
OutputVariable: o
  enabled: true
  range: 0 1
  lock-range: false
  aggregation: Maximum
  defuzzifier: Bisector 100
  default: nan
  lock-previous: false
  term: x Triangle 0.1 0.2 0.4
  term: y Triangle 0.6 0.8 0.9
RuleBlock: r
  enabled: true
  conjunction: none
  disjunction: none
  implication: EinsteinProduct
  activation: General
  rule: if a is lo then o is x
  rule: if a is hi then o is y
";

/// Tables and drawings of answers have no room for what a single answer says of itself.
#[test]
fn answers_that_are_hardly_known_are_told_beside_tables_and_slices() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("gap.fll");
    std::fs::write(&path, GAP).expect("written");
    let options = Options { sampling: Some("exact"), ..Options::default() };
    let loaded = load(&path.display().to_string(), options).expect("good");
    let last = loaded.notes.last().expect("what is asked in place of what the file says");
    assert!(last.ends_with("every integral is computed by `exact` here, as was asked"), "{last}");
    let system = loaded.system;
    let text = ask(&system, &values(&["a=0.5"])).expect("good").text();
    let told = "KNOWN ONLY WITHIN 1.0e-1: the set has a gap where it is halved";
    assert!(text.contains(told) && text.contains("0.5000000"), "{text}");
    let mut table = SystemTable::new(&system);
    let mut rows = "a\n0.25\n0.5\n0.75\n".as_bytes();
    answer_rows(&mut table, &mut rows, &mut Vec::new()).expect("good");
    let remarks = table.remarks();
    assert_eq!(remarks.len(), 1, "{remarks:?}");
    assert!(remarks[0].starts_with(&format!("1 answer of `o` {told}")), "{remarks:?}");
    let of = |nodes| {
        let question = SliceQuestion { nodes: Some(nodes), ..SliceQuestion::default() };
        slice(&system, &question).expect("good")
    };
    assert_eq!(of(3).remarks(), remarks);
    let bound = of(3).json()["outputs"][0]["error_bound"].as_f64().expect("told");
    assert!((bound - 0.1).abs() < 1e-6, "{bound}");
    assert!(of(4).remarks().is_empty() && of(4).json()["outputs"][0]["error_bound"].is_null());
}

#[test]
fn a_slice_has_the_answers_of_the_system_and_says_what_stays() {
    let system = tip();
    let fixed = values(&["food=8"]);
    let question = SliceQuestion { fixed: &fixed, nodes: Some(3), ..SliceQuestion::default() };
    let curve = slice(&system, &question).expect("good");
    let expected = [0.0, 5.0, 10.0].map(|x| format!("{x:?},{:?}\n", tip_at(x, 8.0))).concat();
    assert_eq!(curve.csv(), format!("service,tip\n{expected}"));
    assert_eq!(curve.fixed_in_words(), "food = 8");
    let surface = slice(&system, &SliceQuestion { nodes: Some(2), ..SliceQuestion::default() });
    let csv = surface.expect("good").csv();
    assert!(csv.contains(&format!("10.0,0.0,{:?}\n", tip_at(10.0, 0.0))), "{csv}");
}

#[test]
fn a_slice_is_drawn_with_its_names_and_refuses_what_is_not_there() {
    let system = tip();
    let drawn = slice(&system, &SliceQuestion::default()).expect("good");
    let figures = drawn.figures();
    assert_eq!(figures.len(), 1);
    let svg = figures[0].1.as_str();
    for part in [">service<", ">food<", ">tip<", "Surface in space, and as a map"] {
        assert!(svg.contains(part), "{part}");
    }
    let fixed = values(&["food=1", "service=2"]);
    let question = SliceQuestion {
        x: Some("fod"),
        fixed: &fixed,
        output: Some("tipp"),
        ..SliceQuestion::default()
    };
    let told = slice(&system, &question).expect_err("wrong").to_string();
    assert!(
        told.contains("did you mean `food`?") && told.contains("did you mean `tip`?"),
        "{told}"
    );
    assert!(slice(&system, &SliceQuestion { nodes: Some(1), ..SliceQuestion::default() }).is_err());
    let question = SliceQuestion { x: Some("food"), y: Some("food"), ..SliceQuestion::default() };
    assert!(slice(&system, &question).is_err());
}

/// It was an empty picture, and the rules were said to have no answer.
#[test]
fn a_surface_is_not_drawn_at_a_number_that_is_none() {
    let system = tip();
    for value in ["nan", "inf", "-inf"] {
        let fixed = values(&[&format!("food={value}")]);
        let question = SliceQuestion { fixed: &fixed, ..SliceQuestion::default() };
        let told = slice(&system, &question).expect_err("no number").to_string();
        assert!(told.contains("allowed is a finite number"), "{told}");
    }
}

//! Requirements that are asked in some cases of a tuning or a contest, and limits of means.

use fspid_scenario::file::{self, Study};

const CASES: &str = r#"
[tuning]
[[tuning.objective]]
measure = "iae_deg_s"
[[tuning.case]]
name = "calm"
set = ["loop.duration_s=5"]
[[tuning.case]]
name = "rough"
group = "gusts"
set = ["loop.duration_s=6"]
"#;

fn text(requirements: &str) -> String {
    format!("{}{CASES}{requirements}", file::starter())
}

fn study(requirements: &str) -> Study {
    file::parse(&text(requirements), "mine.toml", None, &[]).expect("a scenario")
}

fn problems(requirements: &str) -> String {
    let read = file::parse(&text(requirements), "mine.toml", None, &[]);
    read.expect_err("it is wrong").to_string()
}

/// Ids of what a study is asked beyond the starter's own.
fn ids(study: &Study) -> Vec<&str> {
    let mine = study.requirements.iter().filter(|it| ["a", "b", "c"].contains(&it.id.as_str()));
    mine.map(|it| it.id.as_str()).collect()
}

const THREE: &str = r#"
[[requirement]]
id = "a"
measure = "overshoot_pct"
most = 10.0
not_in = ["gusts"]
[[requirement]]
id = "b"
measure = "overshoot_pct"
most = 30.0
only_in = ["rough"]
[[requirement]]
id = "c"
measure = "sensitivity_peak"
most = 2.0
"#;

#[test]
fn a_requirement_is_asked_in_the_cases_that_it_names_and_elsewhere_in_all_others() {
    let study = study(THREE);
    assert_eq!(ids(&study), ["a", "c"]);
    assert_eq!(ids(&study.clone().in_case("calm", "")), ["a", "c"]);
    assert_eq!(ids(&study.in_case("rough", "gusts")), ["b", "c"]);
}

#[test]
fn what_the_scenario_as_it_is_written_is_not_asked_is_told() {
    let study = study(THREE);
    let told: Vec<&String> = study.warnings.iter().filter(|it| it.contains("only")).collect();
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(told[0].contains("overshoot_pct is asked in some cases"), "{told:?}");
}

#[test]
fn cases_that_there_are_not_and_lists_of_none_are_refused_together() {
    let told = problems(
        "[[requirement]]\nmeasure = \"overshoot_pct\"\nmost = 1.0\nnot_in = [\"gust\"]\nonly_in = []\n\
         [[requirement]]\nmeasure = \"overshoot_pct\"\nmost = 1.0\nonly_in = 3\n",
    );
    assert!(told.contains("no case and no group is called \"gust\""), "{told}");
    assert!(told.contains("[[contest.case]], or of their groups"), "{told}");
    assert_eq!(told.matches("no list of names").count(), 2, "{told}");
    assert!(told.contains("3 problems"), "{told}");
}

#[test]
fn a_limit_of_a_mean_is_read_with_its_conditions_and_refused_without_a_number() {
    let limit = "[[tuning.limit]]\nmeasure = \"largest_error_deg\"\nfrom_s = 1.0\nmost = 4.0\n";
    let tuning = study(limit).tuning.expect("a tuning");
    assert_eq!(tuning.limits[0].most, Some(4.0));
    assert_eq!(tuning.limits[0].conditions.from_s, Some(1.0));
    let told = problems("[[tuning.limit]]\nmeasure = \"elevator_travel_deg\"\n");
    assert!(told.contains("tuning.limit[0].most") && told.contains("has a limit"), "{told}");
}

#[test]
fn a_requirement_that_no_case_is_left_for_is_refused() {
    let text = |not: &str| {
        format!(
            "[[requirement]]\nmeasure = \"overshoot_pct\"\nmost = 1.0\nonly_in = [\"rough\"]\nnot_in = [\"{not}\"]\n"
        )
    };
    assert!(problems(&text("gusts")).contains("it would be asked nowhere"));
    assert_eq!(study(&text("calm")).case_requirements.len(), study("").case_requirements.len() + 1);
}

/// With `most = 1` the opposite of what was asked for met it.
#[test]
fn a_question_has_no_limit_by_which_its_opposite_could_be_an_answer() {
    for measure in ["stable", "certified", "frozen_stable"] {
        let with = |limit: &str| {
            let asked = format!("[[requirement]]\nmeasure = \"{measure}\"\n{limit}\n");
            file::parse(&format!("{}{asked}", file::starter()), "asked.toml", None, &[])
        };
        for limit in ["most = 1.0", "most = 0.5", "least = 0.0", "least = 0.5", "least = 2.0"] {
            let told = with(limit).expect_err("refused").to_string();
            assert!(told.contains("a limit of a question"), "{measure} {limit}: {told}");
        }
        for limit in ["", "least = 1.0"] {
            let study = with(limit).expect("allowed");
            let asked = study.requirements.last().expect("a requirement");
            assert_eq!((asked.least, asked.most), (Some(1.0), None), "{measure} {limit}");
        }
    }
}

#[test]
fn what_is_yes_or_no_has_no_mean_that_could_be_limited() {
    let told = problems("[[tuning.limit]]\nmeasure = \"stable\"\nleast = 0.9\n");
    assert!(told.contains("it is yes or no") && told.contains("tuning.limit[0].measure"), "{told}");
}

/// In turbulent air no line of it is asked, and nothing of it was told: 1 of 1 met.
#[test]
fn a_set_of_which_nothing_is_asked_is_refused() {
    let with = |air: &str| {
        let asked = format!(
            "[[requirement]]\nset = \"mil-f-9490d-altitude\"\ntarget_ft = 5000.0\nair = \"{air}\"\n"
        );
        file::parse(&format!("{}{asked}", file::starter()), "asked.toml", None, &[])
    };
    let told = with("turbulent").expect_err("refused").to_string();
    assert!(told.contains("no line of `mil-f-9490d-altitude` is asked"), "{told}");
    assert!(with("smooth").is_ok());
}

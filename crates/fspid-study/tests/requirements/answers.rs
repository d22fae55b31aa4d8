//! The answers of `fspid verify`: text for people, JSON for programs, JUnit XML for continuous integration.

use fspid_study::verify::{Question, VerifyError, verify};

use crate::requirements::{JUMBO, repository, verified, written};

/// One line that is met, one that is not, one that cannot be evaluated; for each of two controllers.
pub(super) const THREE: &str = r#"
[[requirement]]
measure = "stable"

[[requirement]]
id = "R-2"
measure = "phase_margin_deg"
least = 80.0
clause = "2.1"
source = "our specification"
confidence = "own"
note = "as agreed"

[[requirement]]
measure = "overshoot_pct"
most = 10.0
step_deg = 1.0
"#;

#[test]
fn the_text_has_a_line_for_each_requirement_and_controller_and_ends_with_the_verdict() {
    let (_folder, path) = written(&format!("{JUMBO}\n{THREE}"));
    let text = verified(&path, &[], &[]).text(None);
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[0].starts_with("jumbo (") && lines[0].ends_with("scenario.toml)"), "{text}");
    assert_eq!(lines.iter().filter(|line| line.starts_with("PASS  ")).count(), 2, "{text}");
    assert_eq!(lines.iter().filter(|line| line.starts_with("FAIL  ")).count(), 4, "{text}");
    let last = "2 of 6 requirements met, 2 could not be evaluated; FAIL";
    assert_eq!(lines.last(), Some(&last), "{text}");
    let phase = lines.iter().find(|line| line.contains("R-2")).expect("a line");
    for part in ["phase_margin_deg", "2.1", " P ", " deg", "at least 80 deg", "rad/s"] {
        assert!(phase.contains(part), "{part}: {phase}");
    }
    assert!(text.contains("the command has no step of 1 deg; its steps are of 5 deg"), "{text}");
    assert!(text.contains("source: our specification, 2.1 (own); note: as agreed"), "{text}");
    assert!(text.contains("--replay DIR"), "{text}");
}

#[test]
fn the_columns_of_the_text_stand_below_each_other() {
    let (_folder, path) = written(&format!("{JUMBO}\n{THREE}"));
    let text = verified(&path, &[], &[]).text(None);
    let head = text.lines().nth(2).expect("a head");
    let place = |word: &str| head.find(word).expect("a column");
    for line in text.lines().filter(|line| line.starts_with("PASS  ") || line.starts_with("FAIL  "))
    {
        let cells: Vec<char> = line.chars().collect();
        for column in ["requirement", "controller", "limit"] {
            let at = place(column);
            assert!(cells[at] != ' ' && cells[at - 1] == ' ', "{column}: {line}");
        }
    }
}

#[test]
fn the_text_names_the_file_that_replays_a_line() {
    let (_folder, path) = written(&format!("{JUMBO}\n{THREE}"));
    let paths: Vec<String> = (1..=6).map(|number| format!("my replays/{number}.toml")).collect();
    let text = verified(&path, &[], &[]).text(Some(&paths));
    assert!(text.contains("      replay: fspid verify 'my replays/1.toml'"), "{text}");
    assert!(!text.contains("--replay DIR"), "{text}");
}

#[test]
fn all_met_is_said_so() {
    let (_folder, path) = written(&format!("{JUMBO}\n[[requirement]]\nmeasure = \"stable\"\n"));
    let verification = verified(&path, &[], &[]);
    assert!(verification.all_met());
    assert!(verification.text(None).ends_with("\n2 of 2 requirements met; PASS\n"));
}

#[test]
fn the_json_holds_every_line_with_number_limit_source_and_worst_case() {
    let (_folder, path) = written(&format!("{JUMBO}\n{THREE}"));
    let verification = verified(&path, &[], &[]);
    let paths: Vec<String> = (1..=6).map(|number| format!("r/{number}.toml")).collect();
    let json = verification.json(Some(&paths));
    assert_eq!((&json["schema"], &json["scenario"]), (&1.into(), &"jumbo".into()));
    assert_eq!(json["digest"].as_str().map(str::len), Some(64));
    let counts = ["met", "not_met", "not_evaluated"].map(|key| json[key].as_u64());
    assert_eq!(counts, [Some(2), Some(4), Some(2)]);
    assert_eq!(json["all_met"], false);
    let lines = json["requirements"].as_array().expect("a list");
    assert_eq!(lines.len(), 6);
    let phase = &lines[2];
    assert_eq!((&phase["id"], &phase["controller"]), (&"R-2".into(), &"P".into()));
    assert_eq!((&phase["measure"], &phase["unit"]), (&"phase_margin_deg".into(), &"deg".into()));
    assert_eq!((&phase["least"], &phase["met"]), (&80.0.into(), &false.into()));
    assert_eq!((&phase["clause"], &phase["confidence"]), (&"2.1".into(), &"own".into()));
    assert_eq!((&phase["note"], &phase["replay"]), (&"as agreed".into(), &"r/3.toml".into()));
    assert_eq!(phase.get("most"), None);
    let case = verification.judgements[2].found.as_ref().expect("evaluated");
    assert_eq!(phase["value"].as_f64(), Some(case.value));
    assert_eq!(phase["worst_case"]["frequency_rad_s"].as_f64(), case.place.frequency_rad_s);
    let overshoot = &lines[4];
    assert_eq!((overshoot.get("value"), &overshoot["met"]), (None, &false.into()));
    assert!(overshoot["reason"].as_str().expect("why").contains("no step of 1 deg"));
    assert_eq!(overshoot["conditions"]["step_deg"], 1.0);
}

#[test]
fn a_margin_without_an_end_is_a_word_in_json() {
    let requirement =
        "[[requirement]]\nmeasure = \"gain_margin_low_db\"\nleast = 6.0\ncontroller = \"P\"\n";
    let (_folder, path) = written(&format!("{JUMBO}\n{requirement}"));
    let verification = verified(&path, &[], &[]);
    assert!(verification.all_met());
    assert_eq!(verification.json(None)["requirements"][0]["value"], "infinite");
    assert!(verification.text(None).contains("without end"));
}

/// Names that would end an attribute, a tag, a comment or the document.
pub(super) fn hostile() -> String {
    let text = JUMBO
        .replace("name = \"jumbo\"", "name = \"<a b='c'> & \\\"d\\\" ]]> -->\\u0001\\n\\t\\u007f\"")
        .replace("name = \"P\"", "name = \"</testsuite><!-- &amp; 'P' \\\"\"");
    let requirement = "\n[[requirement]]\nid = \"<R id=\\\"1\\\">\\n\"\nmeasure = \"phase_margin_deg\"\nleast = 80.0\nsource = \"<&>'\\\"\\n\\u0002\"\n";
    format!("{text}\n{THREE}\n{requirement}")
}

#[test]
fn the_xml_is_read_by_another_parser_whatever_the_names() {
    let (_folder, path) = written(&hostile());
    let verification = verified(&path, &[], &[]);
    let paths: Vec<String> = (1..=8).map(|number| format!("<&{number}>.toml")).collect();
    let xml = verification.junit(Some(&paths));
    let document =
        roxmltree::Document::parse(&xml).unwrap_or_else(|error| panic!("{error}\n{xml}"));
    let suites = document.root_element();
    assert_eq!(suites.tag_name().name(), "testsuites");
    let children = |node: roxmltree::Node<'_, '_>, name: &str| {
        node.children().filter(|child| child.has_tag_name(name)).count()
    };
    let suite = suites.children().find(|node| node.has_tag_name("testsuite")).expect("a suite");
    assert_eq!((children(suites, "testsuite"), children(suite, "testcase")), (1, 8));
    // What XML cannot hold is replaced, everything else comes back as it was.
    assert_eq!(suite.attribute("name"), Some("<a b='c'> & \"d\" ]]> -->\u{fffd}\n\t\u{7f}"));
    assert_eq!(suite.attribute("tests"), Some("8"));
    assert_eq!(suite.attribute("failures"), Some("6"));
    let cases: Vec<_> = suite.children().filter(|node| node.has_tag_name("testcase")).collect();
    for (case, judgement) in cases.iter().zip(&verification.judgements) {
        assert_eq!(case.attribute("name"), Some(judgement.requirement.id.as_str()));
        let class = case.attribute("classname").expect("a class");
        assert!(class.ends_with(&judgement.controller), "{class}");
        let failure = case.children().find(|node| node.has_tag_name("failure"));
        assert_eq!(failure.is_none(), judgement.met, "{class}");
        if let Some(failure) = failure {
            let kind = if judgement.found.is_ok() { "not met" } else { "not evaluated" };
            assert_eq!(failure.attribute("type"), Some(kind));
            let message = failure.attribute("message").expect("a message");
            assert!(message.contains(&judgement.value_in_words()), "{message}");
            assert!(failure.text().expect("details").contains("replay: fspid verify <&"), "{xml}");
        }
    }
}

#[test]
fn the_text_of_hostile_names_moves_no_cursor() {
    let (_folder, path) = written(&hostile());
    let text = verified(&path, &[], &[]).text(None);
    assert!(text.chars().all(|c| c == '\n' || !c.is_control()), "{text:?}");
    assert_eq!(text.lines().filter(|line| line.starts_with("FAIL  ")).count(), 6, "{text}");
}

#[test]
fn nothing_required_is_an_error_that_says_what_to_write() {
    let (_folder, path) = written(JUMBO);
    let question = Question { path: &path, settings: &[], requirement_files: &[] };
    let error = verify(&question).expect_err("nothing is required");
    assert!(matches!(error, VerifyError::NothingRequired { .. }), "{error:?}");
    for part in ["--set mil-f-9490d", "--requirements", "[[requirement]]", "least = 45.0"] {
        assert!(error.to_string().contains(part), "{part}: {error}");
    }
}

#[test]
fn everything_that_is_wrong_with_what_comes_from_outside_is_told_at_once() {
    let (folder, path) = written(JUMBO);
    let (bad, empty) = (folder.path().join("bad.toml"), folder.path().join("empty.toml"));
    std::fs::write(
        &bad,
        "name = \"ours\"\ncolour = 1\n[[requirement]]\nmeasure = \"overshoot\"\nmost = 1\n",
    )
    .expect("written");
    std::fs::write(&empty, "requirement = []\n").expect("written");
    let settings = [
        "cmts",
        "mil-f-8785c:level=4",
        "mil-f-9490d:speed",
        "ctms:level=1",
        "ctms:air=1,air=2",
        "loop.duration_s=-1",
    ];
    let settings: Vec<String> = settings.map(str::to_owned).to_vec();
    let question =
        Question { path: &path, settings: &settings, requirement_files: &[&bad, &empty] };
    let message = verify(&question).expect_err("seven mistakes").to_string();
    for part in [
        "--set cmts: unknown set; did you mean \"ctms\"?",
        "a ready set: mil-f-9490d, mil-f-8785c, ctms, mil-f-9490d-altitude, rvsm, ac-25.1329; or a change: path=value",
        "--set mil-f-8785c:level=4: requirement[0].level: out of range",
        "--set mil-f-9490d:speed: `speed` has no `=`",
        "--set ctms:air=1,air=2: `air` is chosen twice",
        "--set ctms:level=1: requirement[1].level: the set \"ctms\" leaves no such choice",
        "--set loop.duration_s=-1: loop.duration_s: out of range",
        "bad.toml:2:1: colour: unknown key",
        "bad.toml:4:11: requirement[2].measure: unknown word; did you mean \"overshoot_pct\"?",
        "empty.toml:1:15: requirement: there is none",
    ] {
        assert!(message.contains(part), "{part} in\n{message}");
    }
}

#[test]
fn sets_files_and_the_scenario_s_own_requirements_are_judged_together() {
    let (folder, path) = written(&format!("{JUMBO}\n{THREE}"));
    let ours = folder.path().join("ours.toml");
    std::fs::write(
        &ours,
        "schema = 1\nname = \"ours\"\n[[requirement]]\nmeasure = \"disk_margin\"\nleast = 0.2\n",
    )
    .expect("written");
    let verification = verified(&path, &["ctms"], &[&ours]);
    let mut ids: Vec<&str> =
        verification.judgements.iter().map(|j| j.requirement.id.as_str()).collect();
    ids.dedup();
    assert_eq!(
        ids,
        [
            "stable",
            "R-2",
            "overshoot_pct",
            "ctms/overshoot",
            "ctms/rise-time",
            "ctms/settling-time",
            "ctms/final-error",
            "disk_margin"
        ]
    );
}

#[test]
fn the_shipped_scenario_for_a_review_board_meets_what_it_is_asked() {
    let verification = verified(&repository("scenarios/requirements.toml"), &[], &[]);
    assert!(verification.all_met(), "{}", verification.text(None));
    assert_eq!(verification.judgements.len(), 22);
    let turbulent = repository("scenarios/gallery/b747-turbulence.toml");
    let verification = verified(&turbulent, &["mil-f-9490d:air=turbulent"], &[]);
    let line =
        verification.judgements.iter().find(|j| j.requirement.id == "mil-f-9490d/turbulence");
    assert!(line.is_some_and(|judgement| judgement.met), "{}", verification.text(None));
}

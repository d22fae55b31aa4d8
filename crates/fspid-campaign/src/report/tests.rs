//! What holds for the page of a campaign, whatever was flown.

use std::path::Path;

use super::*;
use crate::plan::Plan;
use crate::sample::Sampling;
use crate::{Folder, Progress, Question, Shards, local, plan};

const HEAD: &str = "schema = 1\nname = \"a test\"\n[plant]\npreset = \"b747-paper\"\n[loop]\nsample_period_s = 0.05\nduration_s = 10.0\n";
const STEP: &str = "[setpoint]\nkind = \"step\"\namplitude_deg = 1.0\n";
const SINE: &str = "[setpoint]\nkind = \"sine\"\namplitude_deg = 1.0\nfrequency_hz = 0.2\n";
const EFFECT: &str = "[[dispersion]]\nname = \"effect\"\npath = \"plant.preset.numerator[0]\"\ndistribution = \"uniform\"\nlower = 0.2\nupper = 4.0\nrelative = true\n";
const DAMPING: &str = "[[dispersion]]\nname = \"damping\"\npath = \"plant.preset.denominator[1]\"\ndistribution = \"uniform\"\nlower = 0.4\nupper = 1.3\nrelative = true\n";
const SEED: &str =
    "[[dispersion]]\nname = \"noise\"\npath = \"sensor.seed\"\ndistribution = \"seed\"\n";
const WORDS: &str = "[[dispersion]]\nname = \"law\"\npath = \"controller[0].derivative_on\"\ndistribution = \"choice\"\nvalues = [\"error\", \"measurement\"]\n";

fn pid(name: &str) -> String {
    format!("[[controller]]\nname = {name:?}\nkind = \"pid\"\nkp = 2.0\nki = 0.5\nkd = 1.0\n")
}

fn at_most(overshoot_pct: f64) -> String {
    format!(
        "[[requirement]]\nmeasure = \"overshoot_pct\"\nmost = {overshoot_pct:?}\nsource = \"a test\"\nconfidence = \"own\"\n"
    )
}

/// A campaign in a folder of its own.
struct Flown {
    home: tempfile::TempDir,
    folder: Folder,
}

fn flown(parts: &[&str], runs: u64) -> Flown {
    let home = tempfile::tempdir().expect("a folder");
    let scenario = home.path().join("scenario.toml");
    std::fs::write(&scenario, parts.concat()).expect("written");
    let folder = Folder::new(&home.path().join("campaign"));
    fly(&scenario, &folder, runs);
    Flown { home, folder }
}

fn fly(scenario: &Path, folder: &Folder, runs: u64) {
    let question = Question {
        scenario,
        overrides: &[],
        runs,
        seed: 3,
        sampling: Sampling::Random,
        shards: Shards::ForThreads,
    };
    let campaign = plan(&question, folder).unwrap_or_else(|error| panic!("{error}"));
    folder.put_plan(campaign.plan()).expect("written");
    local::run(folder, &campaign, 2, &Progress::default()).expect("flown");
}

fn summarised(path: &Path) -> Summary {
    Summary::of(path, SummarySettings::default()).unwrap_or_else(|error| panic!("{error}"))
}

impl Flown {
    fn page(&self) -> String {
        let path = self.folder.merged_path();
        let page = page(&path, &Settings::default()).unwrap_or_else(|error| panic!("{error}"));
        assert!(!page.contains("class=\"failed\""), "a template failed");
        assert!(
            !page.contains("NaN") && page.matches("<script").count() == 1 && !page.contains("src=")
        );
        assert!(!page.contains("href=\"http"), "it needs nothing from outside");
        assert!(page.len() < 3_000_000, "{} bytes", page.len());
        page
    }
}

#[track_caller]
fn assert_says(page: &str, words: &[&str]) {
    for words in words {
        assert!(page.contains(words), "{words} is missing");
    }
}

#[test]
fn a_page_answers_first_and_has_the_same_bytes_twice() {
    let two = [pid("CPID"), pid("other").replace("kp = 2.0", "kp = 4.0")].concat();
    let flown = flown(&[HEAD, STEP, &two, &at_most(30.0), EFFECT, DAMPING], 120);
    let page = flown.page();
    assert_says(
        &page,
        &[
            " of 120 flights failed",
            "<h3>Requirements</h3>",
            "at most 30\u{a0}%",
            "<span>fspid</span> <span>campaign</span> <span>replay</span> <span>DIR</span> <span>--run</span>",
            "--runs 120 --seed 3 --sampling random --out DIR",
            "The first 120 runs, flown again",
            "Where flights fail",
            "id=\"map-",
            "id=\"sensitivity-failing\"",
            "the worst kind first",
            "Before these numbers are used",
        ],
    );
    let at = |text: &str| page.find(text).expect("it is there");
    assert!(at("flights failed") < at("Contents"));
    assert_eq!(flown.page(), page);
    let path = flown.folder.merged_path();
    let settings = Settings { folder: Some("my runs".to_owned()), ..Settings::default() };
    let named = super::page(&path, &settings).expect("a page");
    assert_says(&named, &["--out &#x27;my runs&#x27;", "<span>'my</span> <span>runs'</span>"]);
    assert_says(&page, &["fspid campaign run SCENARIO.toml "]);
    // The plan beside the rows knows what the scenario was called, and its folder is of one machine.
    let scenario = flown.folder.plan().expect("a plan").scenario_path;
    assert!(std::path::Path::new(&scenario).is_absolute() && scenario.ends_with("scenario.toml"));
    assert_says(&named, &["fspid campaign run scenario.toml ", "scenario.toml of the command"]);
    assert!(!named.contains(scenario.trim_end_matches("/scenario.toml")));
    assert!(!named.contains("SCENARIO.toml"));
}

#[test]
fn one_run_has_a_page_that_claims_little() {
    let page = flown(&[HEAD, STEP, &pid("CPID"), &at_most(1e6), EFFECT], 1).page();
    assert_says(
        &page,
        &["One run of one scenario", "with so few runs", "The first run, flown again"],
    );
    assert_says(&page, &["at most 95 % (95 %)"]);
    // A single flight that went well proves nothing.
    assert!(page.contains("verdict fair") && !page.contains("verdict good"));
}

#[test]
fn flights_that_do_not_settle_are_not_called_good_for_want_of_requirements() {
    let page = flown(&[HEAD, STEP, &pid("CPID"), EFFECT], 20).page();
    assert_says(&page, &["The scenario has no requirements", "nothing is required of it"]);
    // Some come into their band too late to be seen to stay.
    assert_says(&page, &["20 flights failed", "not settled within"]);
    assert!(!page.contains("verdict good"));
}

#[test]
fn where_all_failed_or_none_did_the_worst_twentieth_is_mapped() {
    let none = flown(&[HEAD, STEP, &pid("CPID"), &at_most(1e6), EFFECT, DAMPING], 60).page();
    assert_says(&none, &["None of 60 flights failed", "No flight failed.", "verdict good"]);
    assert_says(&none, &["Where the worst flights lie", "highest 5 % of overshoot_pct"]);
    let all = flown(&[HEAD, STEP, &pid("CPID"), &at_most(1e-9), EFFECT, DAMPING], 60).page();
    assert_says(&all, &["All 60 flights failed", "at least ", "Where the worst flights lie"]);
    assert!(!all.contains("verdict good"));
}

#[test]
fn parameters_whose_size_means_nothing_have_no_map() {
    let page = flown(&[HEAD, STEP, &pid("CPID"), &at_most(30.0), WORDS], 40).page();
    assert_says(&page, &["no parameter is a number"]);
    // A seed is one, but says nothing.
    let sensor = "[sensor]\npreset = \"irs\"\n";
    let page = flown(&[HEAD, STEP, sensor, &pid("CPID"), &at_most(30.0), SEED], 40).page();
    assert_says(&page, &["no parameter is a number"]);
}

#[test]
fn a_single_number_has_its_failures_in_bins_and_no_map() {
    let page = flown(&[HEAD, STEP, &pid("CPID"), &at_most(30.0), EFFECT], 60).page();
    assert_says(&page, &["Flights over effect", "where effect lies between two values"]);
    assert!(!page.contains("id=\"map-0-0\"") && !page.contains("id=\"runs-0\""));
}

#[test]
fn measures_that_no_flight_has_are_named() {
    let page = flown(&[HEAD, SINE, &pid("CPID"), EFFECT], 20).page();
    assert_says(&page, &["No flight has: overshoot, settling time, rise time", "IAE"]);
}

#[test]
fn names_that_would_break_a_page_do_not() {
    let names = [
        "<script>alert(1)</script>",
        "a name that is so long that no figure has room for it, as happens when names are whole sentences without an end",
        "飛行制御 \u{1f6e9} \" & '",
    ];
    let controllers: String = names.iter().map(|name| pid(name)).collect();
    let title = "name = \"</title><script>alert(2)</script>\"\n";
    let head = HEAD.replace("name = \"a test\"\n", title);
    let dispersion = EFFECT.replace("\"effect\"", "\"</svg><script>alert(3)</script>\"");
    let page = flown(&[&head, STEP, &controllers, &at_most(30.0), &dispersion, DAMPING], 40).page();
    assert_says(&page, &["&lt;script&gt;alert(1)", "飛行制御"]);
}

#[test]
fn twelve_controllers_make_a_page_of_bounded_size() {
    let controllers: String = (0..12)
        .map(|n| pid(&format!("PID {n}")).replace("kp = 2.0", &format!("kp = {}.5", n + 1)))
        .collect();
    let page = flown(&[HEAD, STEP, &controllers, &at_most(30.0), EFFECT, DAMPING], 200).page();
    assert_says(
        &page,
        &[
            "<summary>Further controllers</summary>",
            "Further controllers are in the table",
            "PID 11",
        ],
    );
    assert_says(&page, &["Maps are drawn for"]);
}

#[test]
fn flights_that_diverge_leave_the_bands_and_are_told_of() {
    let wild = pid("wild").replace("kp = 2.0", "kp = 60.0");
    let page = flown(&[HEAD, STEP, &pid("calm"), &wild, EFFECT], 40).page();
    assert_says(&page, &["diverged", "ended early; from then on they are in no band"]);
}

/// A page without its figures is still a page; one with figures of another scenario would be a lie.
#[test]
fn a_file_that_the_scenario_names_and_that_is_gone_is_told_of() {
    let head = HEAD.replace("preset = \"b747-paper\"", "file = \"plant.toml\"");
    let home = tempfile::tempdir().expect("a folder");
    let scenario = home.path().join("scenario.toml");
    let effect = EFFECT.replace("plant.preset.numerator[0]", "controller[0].kp");
    std::fs::write(&scenario, [head.as_str(), STEP, &pid("CPID"), &effect].concat())
        .expect("written");
    let plant = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/plants/b747-paper.toml");
    std::fs::copy(plant, home.path().join("plant.toml")).expect("copied");
    let folder = Folder::new(&home.path().join("campaign"));
    fly(&scenario, &folder, 5);
    let flown = Flown { home, folder };
    assert_says(&flown.page(), &["The first 5 runs, flown again"]);
    std::fs::remove_file(flown.home.path().join("plant.toml")).expect("removed");
    let without = flown.page();
    assert_says(&without, &["could not be flown again: the scenario cannot be read again"]);
    assert_says(&without, &["All measures in numbers"]);
}

/// What a map shows is counted here a second time, from runs flown again one by one.
#[test]
fn boxes_of_a_map_hold_the_runs_that_lie_in_them() {
    let flown = flown(&[HEAD, STEP, &pid("CPID"), &at_most(15.0), EFFECT, DAMPING], 60);
    let found = Found::at(&flown.folder.merged_path(), SummarySettings::default());
    let files = found.expect("a file").files;
    let names = ["damping".to_owned(), "effect".to_owned()];
    let event = by_parameter::Event::Failed;
    let counted = by_parameter::counted(&files, &names, &event, (1, 3)).expect("readable");
    let counted = counted.expect("they differ");
    let campaign = crate::Campaign::new(flown.folder.plan().expect("a plan"), flown.folder.path());
    let campaign = campaign.expect("a campaign");
    let mut again = vec![vec![by_parameter::Counts::default(); 3]; 3];
    let third = |value: f64, (lo, hi): (f64, f64)| {
        let width = (hi - lo) / 3.0;
        usize::from(value >= lo + width) + usize::from(value >= lo + 2.0 * width)
    };
    for run in 0..60 {
        let replay = crate::replay::replay(&campaign, run).expect("flown");
        let drawn: Vec<f64> = replay
            .drawn
            .iter()
            .map(|it| match it {
                fspid_scenario::dispersion::Drawn::Number(number) => *number,
                _ => panic!("numbers"),
            })
            .collect();
        let overshoot = replay.simulation.results[0].metrics.first_step().overshoot_pct;
        // The scenario draws the effect first; the map has the damping along its columns.
        let (effect, damping) =
            (third(drawn[0], counted.ends[1]), third(drawn[1], counted.ends[0]));
        again[effect][damping].all += 1;
        again[effect][damping].failed += u64::from(!overshoot.is_ok_and(|value| value <= 15.0));
    }
    assert_eq!(counted.of[0].together[0], again);
    let failed: u64 = again.iter().flatten().map(|it| it.failed).sum();
    assert!(failed > 5 && failed < 55, "{failed}");
    assert_eq!(counted.of[0].failed.len() as u64, failed);
}

#[test]
fn curves_are_those_of_the_run_as_it_is_flown_alone() {
    let flown = flown(&[HEAD, STEP, &pid("CPID"), &pid("other"), EFFECT], 9);
    let path = flown.folder.merged_path();
    let summary = Summary::of(&path, SummarySettings::default()).expect("a summary");
    let found = Found::at(&path, SummarySettings::default()).expect("a file");
    let source =
        Source { summary: &summary, files: &found.files, folder: "DIR", scenario: "s.toml" };
    let reflown = reflown::reflown(&source, &[vec![7], vec![]], u64::MAX).expect("flown again");
    let campaign = crate::Campaign::new(flown.folder.plan().expect("a plan"), flown.folder.path());
    let replay = crate::replay::replay(&campaign.expect("a campaign"), 7).expect("flown");
    let degrees = |rad: &f64| fspid_scenario::units::degrees(*rad);
    let trace = &replay.simulation.results[0].trace;
    let pitch_deg: Vec<f64> = trace.theta_rad.iter().map(degrees).collect();
    assert_eq!(reflown.controllers[0].first[7].pitch_deg, pitch_deg);
    assert_eq!(reflown.controllers[0].worst[0].1.pitch_deg, pitch_deg);
    assert_eq!(reflown.time_s, trace.time_s);
    let other = &replay.simulation.results[1].trace;
    let elevator_deg: Vec<f64> = other.elevator_rad.iter().map(degrees).collect();
    assert_eq!(reflown.controllers[1].first[7].elevator_deg, elevator_deg);
}

#[test]
fn a_file_alone_is_enough_where_the_scenario_names_no_others() {
    let flown = flown(&[HEAD, STEP, &pid("CPID"), EFFECT], 5);
    let home = tempfile::tempdir().expect("a folder");
    let moved = home.path().join("moved.parquet");
    std::fs::copy(flown.folder.merged_path(), &moved).expect("copied");
    assert_eq!(super::page(&moved, &Settings::default()).expect("a page"), flown.page());
}

#[test]
fn a_summary_of_another_file_is_not_put_on_the_page() {
    let one = flown(&[HEAD, STEP, &pid("CPID"), EFFECT], 5);
    let other = flown(&[HEAD, STEP, &pid("other"), EFFECT], 6);
    let summary = summarised(&other.folder.merged_path());
    let mixed = page_of(&one.folder.merged_path(), &summary, &Settings::default());
    let mixed = mixed.expect("a page");
    assert_eq!(mixed, one.page());
}

#[test]
fn a_file_of_another_program_is_not_flown_again() {
    let flown = flown(&[HEAD, STEP, &pid("CPID"), EFFECT], 5);
    let summary = Summary::of(&flown.folder.merged_path(), SummarySettings::default());
    let mut summary = summary.expect("a summary");
    summary.head.program = "fspid 0.0.1".to_owned();
    let found = Found::at(&flown.folder.merged_path(), SummarySettings::default());
    let found = found.expect("a file");
    let source =
        Source { summary: &summary, files: &found.files, folder: "DIR", scenario: "s.toml" };
    let page = source.page().expect("a page").render();
    assert_says(&page, &["could not be flown again: they were flown by fspid 0.0.1"]);
    assert_says(&page, &[&Plan::this_program()]);
}

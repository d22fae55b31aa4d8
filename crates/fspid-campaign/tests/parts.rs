//! Summaries of parts that were not merged: the same as of the whole, in whatever pieces and on however many threads.

use std::path::{Path, PathBuf};

use fspid_campaign::rows::{CONTROLLER, FAILED, PARAMETER, REQUIREMENT, VERDICT};
use fspid_campaign::sample::Sampling;
use fspid_campaign::summary::{
    ControllerSummary, MeasureSummary, Note, Summary, SummaryError, SummarySettings, json, text,
};
use fspid_campaign::table::{Cell, Column, ColumnTable, Kind, Schema, Writer};
use fspid_campaign::{
    Folder, Plan, Progress, Question, Range, Shards, local, merge, plan, report, shard,
};
use proptest::prelude::*;

const RUNS: u64 = 90;
const CONTROLLERS: [&str; 2] = ["A", "B"];
const SKETCHED: SummarySettings =
    SummarySettings { confidence: 0.95, exact_rows: 0, incomplete: false };

/// A campaign's folder that is removed in the end.
struct Flown {
    _home: tempfile::TempDir,
    folder: Folder,
    campaign: fspid_campaign::Campaign,
}

/// All shards of the shipped campaign, so many runs each, not merged.
fn flown(runs: u64, shard_runs: u64) -> Flown {
    let home = tempfile::tempdir().expect("a folder");
    let scenario = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/campaign.toml");
    let folder = Folder::new(&home.path().join("c"));
    let question = Question {
        scenario: &scenario,
        overrides: &[],
        runs,
        seed: 7,
        sampling: Sampling::Random,
        shards: Shards::Of(shard_runs),
    };
    let campaign = plan(&question, &folder).unwrap_or_else(|error| panic!("{error}"));
    folder.put_plan(campaign.plan()).expect("written");
    let fly = || {
        for number in 0..campaign.plan().shards() {
            shard::fly(&folder, &campaign, number, &Progress::default()).expect("flown");
        }
    };
    local::in_threads(2, fly).expect("threads");
    Flown { _home: home, folder, campaign }
}

impl Flown {
    fn of_parts(&self, settings: SummarySettings) -> Summary {
        Summary::of(self.folder.path(), settings).unwrap_or_else(|error| panic!("{error}"))
    }

    fn merged(&self, settings: SummarySettings) -> Summary {
        let to = self.folder.path().join("elsewhere.parquet");
        merge(&self.folder, &self.campaign, &to).expect("merged");
        Summary::of(&to, settings).unwrap_or_else(|error| panic!("{error}"))
    }

    fn lose(&self, number: u64) {
        let range = self.campaign.plan().shard(number).expect("a shard");
        std::fs::remove_file(self.folder.shard_path(range)).expect("removed");
    }
}

#[test]
fn parts_say_what_the_merged_file_says() {
    let flown = flown(RUNS, 20);
    // All columns at once, and where they do not fit together, one after the other.
    for exact_rows in [1 << 20, 2 * RUNS] {
        let settings = SummarySettings { exact_rows, ..SKETCHED };
        let (parts, mut merged) = (flown.of_parts(settings), flown.merged(settings));
        assert_eq!(parts.head.shards.map(|it| (it.found, it.of)), Some((5, 5)));
        assert_eq!(text(&parts), text(&merged));
        merged.head.shards = parts.head.shards;
        assert_eq!(parts, merged);
    }
    let (parts, mut merged) = (flown.of_parts(SKETCHED), flown.merged(SKETCHED));
    assert_eq!(parts.head.digest, None);
    (merged.head.shards, merged.head.digest) = (parts.head.shards, None);
    assert_eq!(parts, merged);
}

#[test]
fn how_a_campaign_was_cut_and_who_counts_does_not_show() {
    let with = |shard_runs, threads| {
        let flown = flown(RUNS, shard_runs);
        let mut found = local::in_threads(threads, || flown.of_parts(SKETCHED)).expect("threads");
        found.head.shards = None;
        json(&found).to_string()
    };
    let one = with(7, 1);
    for (shard_runs, threads) in [(7, 4), (33, 3), (90, 1)] {
        assert_eq!(with(shard_runs, threads), one, "{shard_runs} {threads}");
    }
}

#[test]
fn a_gap_is_refused_or_told_everywhere() {
    let flown = flown(RUNS, 10);
    flown.lose(0);
    flown.lose(4);
    let refused = Summary::of(flown.folder.path(), SummarySettings::default());
    let told = refused.expect_err("shards are missing").to_string();
    assert!(
        told.starts_with("7 of 9 shards are there; runs 0 to 9 are missing (20 in all)"),
        "{told}"
    );
    for exact_rows in [0, 1000] {
        let settings = SummarySettings { incomplete: true, exact_rows, ..SKETCHED };
        let summary = flown.of_parts(settings);
        let words = "INCOMPLETE: from 7 of 9 shards, 70 of 90 runs";
        assert!(matches!(summary.notes[0], Note::Incomplete { runs: 70, planned_runs: 90, .. }));
        assert_eq!((summary.head.runs, summary.head.planned_runs), (70, 90));
        assert_eq!(text(&summary).lines().nth(1), Some(format!("  {words}").as_str()));
        let json = json(&summary);
        assert_eq!((&json["runs"], &json["planned_runs"]), (&70.into(), &90.into()));
        assert_eq!(json["shards"], serde_json::json!({ "found": 7, "of": 9 }));
        assert_eq!(json["notes"][0]["note"], "incomplete");
        let settings = report::Settings { summary: settings, folder: None };
        let page = report::page_of(flown.folder.path(), &summary, &settings).expect("a page");
        assert!(page.contains(words) && page.contains("--incomplete --out"), "{page}");
        assert!(!page.contains("could not be flown again"), "{page}");
        for controller in &summary.controllers {
            assert_eq!(controller.failed.of, 70);
            let named = controller.failed_runs.iter().map(|it| it.run);
            let named =
                named.chain(controller.measures.iter().flat_map(|it| &it.lowest).map(|it| it.run));
            assert!(named.into_iter().all(|run| !(run < 10 || (40..50).contains(&run))));
        }
    }
}

#[test]
fn a_folder_without_parts_with_damaged_ones_and_with_strange_ones_is_refused() {
    let flown = flown(40, 10);
    let plan = flown.campaign.plan();
    let path = |number| flown.folder.shard_path(plan.shard(number).expect("a shard"));
    let other = Folder::new(&flown.folder.path().join("other"));
    let refused = |settings| {
        Summary::of(flown.folder.path(), settings).expect_err("not a campaign").to_string()
    };
    assert!(matches!(Summary::of(other.path(), SKETCHED), Err(SummaryError::Table(_))));
    // A byte of a value is another: the footer is whole, the digest differs.
    let whole = std::fs::read(path(2)).expect("read");
    let mut damaged = whole.clone();
    // Values stand in front of the metadata, which takes most of so small a file.
    damaged[whole.len() / 4] ^= 1;
    std::fs::write(path(2), &damaged).expect("written");
    for settings in [SKETCHED, SummarySettings::default()] {
        let told = refused(settings);
        assert!(told.contains("000000020-000000029.parquet"), "{told}");
    }
    std::fs::write(path(2), &whole).expect("written");
    std::fs::copy(path(2), path(2).with_file_name("again.parquet")).expect("copied");
    assert!(refused(SKETCHED).contains("both hold runs 20 to 29"), "{}", refused(SKETCHED));
    std::fs::remove_file(path(2).with_file_name("again.parquet")).expect("removed");
    (0..4).for_each(|number| flown.lose(number));
    let incomplete = SummarySettings { incomplete: true, ..SKETCHED };
    assert!(refused(incomplete).starts_with("0 of 4 shards"), "{}", refused(incomplete));
}

/// A flight as a test draws it.
#[derive(Clone, Debug)]
struct Row {
    value: Option<f64>,
    site: Option<&'static str>,
    verdict: &'static str,
}

/// Columns of a campaign, made by hand.
fn schema() -> std::sync::Arc<Schema> {
    let column = |name: &str, kind| Column::new(name, kind);
    let columns = vec![
        column("run", Kind::Integer),
        column(CONTROLLER, Kind::Text),
        column(FAILED, Kind::Boolean),
        column(VERDICT, Kind::Text),
        column("reasons", Kind::Text),
        column("diverged_at_s", Kind::Float).unit("s"),
        column(&format!("{PARAMETER}site"), Kind::Text),
        column(&format!("{PARAMETER}x"), Kind::Float),
        column("overshoot_pct", Kind::Float).unit("%"),
        column(&format!("{REQUIREMENT}low.value"), Kind::Float)
            .meaning("overshoot_pct, the worst case; required: at most 12 %"),
        column(&format!("{REQUIREMENT}low.met"), Kind::Boolean),
    ];
    std::sync::Arc::new(Schema::new(columns).expect("columns"))
}

fn hand_plan(runs: u64) -> Plan {
    Plan {
        scenario_text: "schema = 1\n".to_owned(),
        scenario_path: "s.toml".to_owned(),
        scenario_folder: PathBuf::new(),
        scenario_digest: "ab".to_owned(),
        overrides: Vec::new(),
        sampling: Sampling::Random,
        runs,
        seed: 1,
        shard_runs: 1,
        program: Plan::this_program(),
    }
}

/// Writes a part with the runs of a range.
fn write_part(folder: &Folder, plan: &Plan, range: Range, rows: &[Row]) {
    let mut table = ColumnTable::new(schema());
    for run in range.first..range.end {
        for (place, controller) in CONTROLLERS.iter().enumerate() {
            let row = &rows[(run as usize + place) % rows.len()];
            let failed = row.verdict == "diverged";
            let diverged_at_s = failed.then_some((run % 5) as f64);
            let met = row.value.map(|value| value <= 12.0);
            let cells: Vec<Cell<'_>> = vec![
                (run as i64).into(),
                (*controller).into(),
                failed.into(),
                row.verdict.into(),
                failed.then_some("why").into(),
                diverged_at_s.into(),
                row.site.into(),
                ((run * 37 % 101) as f64).into(),
                row.value.into(),
                row.value.into(),
                met.into(),
            ];
            table.push(&cells).expect("a row");
        }
    }
    let metadata = [
        ("fspid.campaign", plan.id()),
        ("fspid.program", plan.program.clone()),
        ("fspid.first_run", range.first.to_string()),
        ("fspid.end_run", range.end.to_string()),
    ];
    let metadata = metadata.map(|(key, value)| (key.to_owned(), value));
    let file = std::fs::File::create(folder.shard_path(range)).expect("created");
    let mut writer = Writer::new(file, table.schema(), &metadata).expect("begun");
    writer.write(&table).expect("written");
    writer.finish(&[]).expect("finished");
}

/// The summary of rows that are cut into parts at some runs.
fn cut(rows: &[Row], cuts: &[u64], settings: SummarySettings) -> Summary {
    let home = tempfile::tempdir().expect("a folder");
    let folder = Folder::new(&home.path().join("c"));
    let plan = hand_plan(rows.len() as u64);
    folder.put_plan(&plan).expect("written");
    let mut ends: Vec<u64> =
        cuts.iter().map(|cut| cut % plan.runs).filter(|cut| *cut > 0).collect();
    ends.push(plan.runs);
    ends.sort_unstable();
    ends.dedup();
    let mut first = 0;
    for end in ends {
        write_part(&folder, &plan, Range { first, end }, rows);
        first = end;
    }
    Summary::of(folder.path(), settings).unwrap_or_else(|error| panic!("{error}"))
}

fn rows() -> impl Strategy<Value = Vec<Row>> {
    // Constant, bimodal over 10¹², negative, all over the doubles, not finite, missing.
    let value = prop_oneof![
        Just(Some(0.1)),
        (1.0..2.0).prop_map(Some),
        (1e12..1.1e12).prop_map(Some),
        (-5.0..-4.99).prop_map(Some),
        any::<f64>().prop_map(Some),
        Just(None),
    ];
    let site = prop::sample::select(vec![Some("sea"), Some("desert"), Some("arctic"), None]);
    let verdict = prop::sample::select(vec!["settled", "diverged", "flown"]);
    let row =
        (value, site, verdict).prop_map(|(value, site, verdict)| Row { value, site, verdict });
    prop::collection::vec(row, 2..60)
}

/// What a sketch says of a measure, against all its values.
fn check_measure(sketched: &MeasureSummary, exact: &MeasureSummary) {
    let same = |it: &MeasureSummary| {
        (it.count, it.missing, it.not_finite, it.lowest.clone(), it.highest.clone())
    };
    assert_eq!(same(sketched), same(exact));
    assert_eq!(sketched.quantiles.len(), exact.quantiles.len());
    for (near, exact) in sketched.quantiles.iter().zip(&exact.quantiles) {
        let sketch = near.sketch.expect("from a sketch");
        // Two roundings apart where values are as large as doubles go.
        let slack = 1e-15 * sketch.at_least.abs().max(sketch.at_most.abs());
        assert!(sketch.at_least - slack <= exact.value, "{near:?} {exact:?}");
        assert!(exact.value <= sketch.at_most + slack, "{near:?} {exact:?}");
        assert!(near.interval.lower.is_none() == exact.interval.lower.is_none());
        let lower = near.interval.lower.zip(exact.interval.lower);
        let upper = near.interval.upper.zip(exact.interval.upper);
        assert!(lower.is_none_or(|(near, exact)| near <= exact), "{near:?} {exact:?}");
        assert!(upper.is_none_or(|(near, exact)| near >= exact), "{near:?} {exact:?}");
    }
    if let (Some(near), Some(exact)) = (sketched.moments, exact.moments) {
        let size = exact.minimum.abs().max(exact.maximum.abs());
        assert!((near.mean - exact.mean).abs() <= 1e-14 * size, "{near:?} {exact:?}");
        assert_eq!((near.minimum, near.maximum), (exact.minimum, exact.maximum));
    }
}

/// What does not come from sketches is the same to the bit.
fn check_others(sketched: &ControllerSummary, exact: &ControllerSummary) {
    assert_eq!(sketched.verdicts, exact.verdicts);
    assert_eq!((sketched.failed, sketched.refused), (exact.failed, exact.refused));
    assert_eq!(sketched.requirements, exact.requirements);
    assert_eq!(sketched.failed_runs, exact.failed_runs);
    assert_eq!(sketched.sensitivities, exact.sensitivities);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn sketches_of_any_pieces_agree_and_hold_what_all_values_say(
        rows in rows(),
        cuts in prop::collection::vec(0u64..60, 0..6),
    ) {
        let exact = cut(&rows, &cuts, SummarySettings::default());
        let (pieces, whole) = (cut(&rows, &cuts, SKETCHED), cut(&rows, &[], SKETCHED));
        prop_assert_eq!(&pieces.controllers, &whole.controllers);
        prop_assert_eq!(&exact.controllers, &cut(&rows, &[], SummarySettings::default()).controllers);
        for (sketched, exact) in pieces.controllers.iter().zip(&exact.controllers) {
            check_others(sketched, exact);
            for (sketched, exact) in sketched.measures.iter().zip(&exact.measures) {
                check_measure(sketched, exact);
            }
        }
    }
}

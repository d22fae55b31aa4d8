//! What a merged file says: the same as its rows, counted and sorted by hand.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use fspid_campaign::rows::HIT_GROUND;
use fspid_campaign::sample::Sampling;
use fspid_campaign::statistics::{rank, share};
use fspid_campaign::summary::{
    Bad, ControllerSummary, Extreme, MeasureCount, MeasureSummary, NotMerged, Note,
    SENSITIVITY_RUNS, SensitivityTarget, Severity, Summary, SummaryError, SummarySettings, json,
    text,
};
use fspid_campaign::table::{
    Cell, Column, ColumnTable, Kind, Reader, Schema, TableError, Values, Writer,
};
use fspid_campaign::{Folder, Progress, Question, Shards, local, plan};
use fspid_study::metrics::LEFT_RANGE;
use proptest::prelude::*;

/// A file of its own in a folder that is removed in the end.
struct File {
    _home: tempfile::TempDir,
    path: PathBuf,
}

/// A row made by hand.
#[derive(Clone, Debug)]
struct Row {
    verdict: &'static str,
    reasons: Option<String>,
    diverged_at_s: Option<f64>,
    gain: f64,
    site: Option<&'static str>,
    steps: i64,
    overshoot_pct: Option<f64>,
    met: Option<bool>,
}

/// A flight that is well.
fn good(run: u64) -> Row {
    // Spread over 0 to 1 without order.
    let gain = (run * 37 % 101) as f64 / 101.0;
    let site = ["sea", "desert", "arctic"][(run % 3) as usize];
    Row {
        verdict: "settled",
        reasons: None,
        diverged_at_s: None,
        gain,
        site: Some(site),
        steps: (run % 5) as i64,
        overshoot_pct: Some(10.0 * gain + (run % 3) as f64),
        met: Some(true),
    }
}

fn diverged(run: u64, at_s: f64) -> Row {
    Row {
        verdict: "diverged",
        reasons: Some(format!("diverged at {at_s} s")),
        diverged_at_s: Some(at_s),
        overshoot_pct: None,
        met: Some(false),
        ..good(run)
    }
}

fn schema() -> Arc<Schema> {
    let column = |name: &str, kind| Column::new(name, kind);
    let columns = vec![
        column("run", Kind::Integer),
        column("controller", Kind::Text),
        column("failed", Kind::Boolean),
        column("verdict", Kind::Text),
        column("reasons", Kind::Text),
        column("diverged_at_s", Kind::Float).unit("s"),
        column("parameter.gain", Kind::Float).meaning("uniform"),
        column("parameter.site", Kind::Text),
        column("parameter.steps", Kind::Integer),
        column("overshoot_pct", Kind::Float).unit("%").meaning("beyond the set-point"),
        column("requirement.low.value", Kind::Float)
            .unit("%")
            .meaning("overshoot, the worst case; required: at most 12 %"),
        column("requirement.low.met", Kind::Boolean).meaning("whether overshoot is at most 12 %"),
    ];
    Arc::new(Schema::new(columns).expect("columns"))
}

fn cells<'a>(run: u64, controller: &'a str, row: &'a Row) -> Vec<Cell<'a>> {
    vec![
        (run as i64).into(),
        controller.into(),
        row.reasons.is_some().into(),
        row.verdict.into(),
        row.reasons.as_deref().into(),
        row.diverged_at_s.into(),
        row.gain.into(),
        row.site.into(),
        row.steps.into(),
        row.overshoot_pct.into(),
        row.overshoot_pct.into(),
        row.met.into(),
    ]
}

fn metadata(runs: u64, sampling: &str) -> Vec<(String, String)> {
    let plan = serde_json::json!({
        "runs": runs, "seed": "7", "sampling": sampling, "scenario_digest": "ab", "changes": ["a=1"],
        "scenario": "schema = 1\nname = \"made by hand\"\n",
    });
    [("campaign", "cd".to_owned()), ("program", "fspid 0".to_owned()), ("plan", plan.to_string())]
        .map(|(key, value)| (format!("fspid.{key}"), value))
        .to_vec()
}

fn written(table: &ColumnTable, metadata: &[(String, String)]) -> File {
    let home = tempfile::tempdir().expect("a folder");
    let path = home.path().join("campaign.parquet");
    let file = std::fs::File::create(&path).expect("created");
    let mut writer = Writer::new(file, table.schema(), metadata).expect("begun");
    writer.write(table).expect("written");
    writer.finish(&[]).expect("finished");
    File { _home: home, path }
}

fn table(runs: u64, controllers: &[&str], row: impl Fn(u64, usize) -> Row) -> ColumnTable {
    let mut table = ColumnTable::new(schema());
    for run in 0..runs {
        for (place, controller) in controllers.iter().enumerate() {
            table.push(&cells(run, controller, &row(run, place))).expect("a row");
        }
    }
    table
}

fn made(runs: u64, controllers: &[&str], row: impl Fn(u64, usize) -> Row) -> Summary {
    let file = written(&table(runs, controllers, row), &metadata(runs, "random"));
    of(&file.path)
}

fn of(path: &Path) -> Summary {
    Summary::of(path, SummarySettings::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn measure<'a>(controller: &'a ControllerSummary, name: &str) -> &'a MeasureSummary {
    controller.measures.iter().find(|measure| measure.name == name).expect("a measure")
}

fn near(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= 1e-12 * expected.abs().max(1.0)
}

/// 1 - 0.05^(1/300) = 0.009936: the rule of three, exactly.
#[test]
fn no_failures_in_three_hundred_runs_are_bounded_from_above() {
    let summary = made(300, &["A"], |run, _| good(run));
    let failed = summary.controllers[0].failed;
    assert_eq!((failed.count, failed.of, failed.estimate), (0, 300, Some(0.0)));
    assert!(near(failed.at_most.expect("a bound"), 1.0 - libm::pow(0.05, 1.0 / 300.0)));
    assert!(near(failed.upper, 1.0 - libm::pow(0.025, 1.0 / 300.0)));
    assert_eq!(summary.notes, []);
    assert!(summary.controllers[0].failed_runs.is_empty());
    assert!(text(&summary).contains("fails 0 of 300: at most 1.0 % (95 %)"), "{}", text(&summary));
    let failing = &summary.controllers[0].sensitivities[0];
    assert_eq!(failing.of, SensitivityTarget::Failure);
    assert!(failing.influences.iter().all(|it| it.share.is_none() && it.correlation.is_none()));
}

#[test]
fn a_campaign_whose_flights_all_diverged_has_no_measures_and_says_so() {
    let summary = made(40, &["A"], |run, _| diverged(run, 10.0 - 0.1 * run as f64));
    let controller = &summary.controllers[0];
    assert_eq!(controller.failed.count, 40);
    assert!(near(controller.failed.at_least.expect("a bound"), libm::pow(0.05, 1.0 / 40.0)));
    let overshoot = measure(controller, "overshoot_pct");
    assert_eq!((overshoot.count, overshoot.missing), (0, 40));
    assert_eq!((overshoot.moments, overshoot.histogram.as_ref()), (None, None));
    assert!(overshoot.quantiles.is_empty() && overshoot.lowest.is_empty());
    let low = &controller.requirements[0];
    assert_eq!((low.not_met.count, low.not_met.of, low.without_value), (40, 40, 40));
    assert_eq!(low.worst, None);
    // The earliest first, and ten of them.
    let runs: Vec<u64> = controller.failed_runs.iter().map(|failed| failed.run).collect();
    assert_eq!(runs, [39, 38, 37, 36, 35, 34, 33, 32, 31, 30]);
    let missing = ["overshoot_pct", "requirement.low.value"];
    let missing = missing.map(|name| MeasureCount { name: name.to_owned(), flights: 40 }).to_vec();
    assert_eq!(summary.notes, [Note::Missing { controller: "A".to_owned(), measures: missing }]);
    assert!(text(&summary).contains("fails 40 of 40: at least"), "{}", text(&summary));
    assert!(json(&summary)["controllers"][0]["measures"][1]["mean"].is_null());
}

#[test]
fn a_single_run_is_summarised() {
    let summary = made(1, &["A", "B"], |run, _| good(run));
    assert_eq!((summary.head.runs, summary.head.rows), (1, 2));
    assert_eq!(summary.head.controllers, ["A", "B"]);
    let overshoot = measure(&summary.controllers[1], "overshoot_pct");
    assert!(overshoot.quantiles.iter().all(|quantile| quantile.value == 0.0));
    // Nothing is known of the median; the value is below the quantile 0.99 with a probability of 0.99.
    let interval = |index: usize| {
        let interval = overshoot.quantiles[index].interval;
        (interval.lower, interval.upper)
    };
    assert_eq!([interval(3), interval(6)], [(None, None), (Some(0.0), None)]);
    assert_eq!(overshoot.moments.and_then(|moments| moments.standard_deviation), None);
    assert_eq!(overshoot.lowest, [Extreme { run: 0, value: 0.0 }]);
    assert!(text(&summary).contains("fails 0 of 1"), "{}", text(&summary));
}

#[test]
fn failures_are_counted_by_kind_and_named_the_worst_first() {
    let summary = made(30, &["A", "B"], |run, place| match (place, run) {
        (0, 4) => diverged(run, 3.0),
        (0, 9) => diverged(run, 1.5),
        (0, 2) => Row {
            verdict: "refused",
            reasons: Some("no scenario".to_owned()),
            overshoot_pct: None,
            met: None,
            ..good(run)
        },
        (0, 12) => Row {
            reasons: Some(format!("{LEFT_RANGE} at t = 3.00 s; low 14 %, at most 12 %")),
            ..good(run)
        },
        (0, 15) => Row { verdict: HIT_GROUND, reasons: Some("hit".to_owned()), ..good(run) },
        (0, 20) => Row { verdict: "unstable", reasons: Some("unstable".to_owned()), ..good(run) },
        (0, 1 | 7) => Row {
            reasons: Some("low 14 %, at most 12 %".to_owned()),
            overshoot_pct: Some(14.0),
            met: Some(false),
            ..good(run)
        },
        _ => good(run),
    });
    let [a, b] = &summary.controllers[..] else { panic!("two controllers") };
    assert_eq!((a.failed.count, a.refused.count, b.failed.count), (8, 1, 0));
    let verdicts: Vec<_> =
        a.verdicts.iter().map(|count| (count.verdict.as_str(), count.flights)).collect();
    let settled = ("settled", 25);
    assert_eq!(
        verdicts,
        [settled, ("refused", 1), ("unstable", 1), (HIT_GROUND, 1), ("diverged", 2)]
    );
    let worst: Vec<_> = a.failed_runs.iter().map(|it| (it.run, it.severity)).collect();
    assert_eq!(
        worst,
        [
            (9, Severity::Diverged),
            (4, Severity::Diverged),
            (15, Severity::HitGround),
            (20, Severity::Unstable),
            (12, Severity::LeftRange),
            (2, Severity::Refused),
            (1, Severity::RequirementsNotMet),
            (7, Severity::RequirementsNotMet),
        ]
    );
    let low = &a.requirements[0];
    assert_eq!((low.not_met.count, low.not_met.of), (4, 29));
    assert_eq!((low.without_value, low.not_judged), (2, 1));
    assert_eq!(low.worst, Some(Extreme { run: 1, value: 14.0 }));
    assert_eq!((low.required.as_str(), low.limits.most), ("at most 12 %", Some(12.0)));
    assert_eq!(measure(a, "requirement.low.value").bad, Some(Bad::High));
    assert!(measure(a, "diverged_at_s").is_event);
}

#[test]
fn texts_explain_by_class_and_numbers_by_rank() {
    let summary = made(300, &["A"], |run, _| good(run));
    let depends = &summary.controllers[0].sensitivities;
    let overshoot = SensitivityTarget::Measure("overshoot_pct".to_owned());
    let overshoot = depends.iter().find(|it| it.of == overshoot).expect("there");
    assert_eq!((overshoot.used, [overshoot.runs_used, overshoot.runs]), (300, [300, 300]));
    let runs: Vec<Row> = (0..300).map(good).collect();
    let y: Vec<f64> = runs.iter().filter_map(|row| row.overshoot_pct).collect();
    let gain: Vec<f64> = runs.iter().map(|row| row.gain).collect();
    let steps: Vec<f64> = runs.iter().map(|row| row.steps as f64).collect();
    let site: Vec<f64> = (0..300).map(|run| f64::from(run % 3)).collect();
    let [by_gain, by_site, by_steps] = &overshoot.influences[..] else { panic!("three") };
    assert_eq!(by_gain.parameter, "gain");
    assert_eq!(by_gain.correlation, rank::spearman(&gain, &y));
    assert_eq!(by_gain.share, share::first_order(&gain, &y));
    assert_eq!(by_site.correlation, None);
    assert_eq!(by_site.share, share::first_order(&site, &y));
    assert_eq!(by_steps.correlation, rank::spearman(&steps, &y));
    assert_eq!(by_steps.share, share::first_order(&steps, &y));
    // Independent by construction: 10 gain has variance 100/12, the class of the site 2/3.
    let expected = (100.0 / 12.0) / (100.0 / 12.0 + 2.0 / 3.0);
    let found = by_gain.share.expect("a share").fraction;
    assert!((found - expected).abs() < 0.03, "{found} {expected}");
}

#[test]
fn values_that_are_no_numbers_are_left_out_and_counted() {
    let summary = made(50, &["A"], |run, _| Row {
        overshoot_pct: Some(if run == 3 { f64::INFINITY } else { run as f64 }),
        ..good(run)
    });
    let overshoot = measure(&summary.controllers[0], "overshoot_pct");
    assert_eq!((overshoot.count, overshoot.missing, overshoot.not_finite), (49, 0, 1));
    assert_eq!(overshoot.highest[0], Extreme { run: 49, value: 49.0 });
    assert!(matches!(&summary.notes[..], [Note::NotFinite { .. }]), "{:?}", summary.notes);
    // For a requirement, infinity is the worst that "at most" can find.
    let low = &summary.controllers[0].requirements[0];
    assert_eq!(low.worst.map(|worst| worst.run), Some(3));
}

#[test]
fn samples_that_are_not_independent_are_said_to_be_so() {
    let rows = table(20, &["A"], |run, _| good(run));
    let notes = |sampling| of(&written(&rows, &metadata(20, sampling)).path).notes;
    assert_eq!(notes("random"), []);
    let sampling = Sampling::LatinHypercube;
    assert_eq!(notes("latin-hypercube"), [Note::RunsNotIndependent { sampling }]);
    let sampling = Sampling::Sobol;
    assert_eq!(notes("sobol"), [Note::RunsNotIndependent { sampling }, Note::SharesOvercorrected]);
}

#[test]
fn files_that_are_no_merged_campaign_are_refused_with_the_reason() {
    let rows = table(20, &["A", "B"], |run, _| good(run));
    let refused = |table: &ColumnTable, metadata: &[(String, String)]| {
        let file = written(table, metadata);
        match Summary::of(&file.path, SummarySettings::default()) {
            Err(SummaryError::NotMerged { reason, .. }) => reason,
            other => panic!("{other:?}"),
        }
    };
    let meta = metadata(20, "random");
    assert_eq!(refused(&rows, &meta[..2]), NotMerged::Part);
    assert_eq!(refused(&rows, &[]), NotMerged::NoKey { key: "fspid.campaign" });
    assert_eq!(refused(&rows, &metadata(20, "dice")), NotMerged::Plan { place: "/sampling" });
    let rows_expected = NotMerged::Rows { found: 40, runs: 21, controllers: 2 };
    assert_eq!(refused(&rows, &metadata(21, "random")), rows_expected);
    let mut swapped = rows.slice(0..10).expect("rows");
    swapped.append(&rows.slice(12..14).expect("rows")).expect("appended");
    swapped.append(&rows.slice(10..12).expect("rows")).expect("appended");
    swapped.append(&rows.slice(14..40).expect("rows")).expect("appended");
    let order = NotMerged::Order { row: 10, run: 5, controller: "A".to_owned() };
    assert_eq!(refused(&swapped, &meta), order);
    let other = Arc::new(Schema::new(vec![Column::new("run", Kind::Float)]).expect("columns"));
    let mut other = ColumnTable::new(other);
    other.push(&[1.0.into()]).expect("a row");
    let no_column = NotMerged::NoColumn { name: "run".to_owned(), kind: Kind::Integer };
    assert_eq!(refused(&other, &meta), no_column);
}

#[test]
fn damaged_and_foreign_files_and_what_is_no_confidence_are_refused() {
    let file = written(&table(20, &["A"], |run, _| good(run)), &metadata(20, "random"));
    let summary = |confidence| {
        Summary::of(&file.path, SummarySettings { confidence, ..SummarySettings::default() })
    };
    assert!(matches!(summary(95.0), Err(SummaryError::Statistics(_))));
    assert!(matches!(summary(f64::NAN), Err(SummaryError::Statistics(_))));
    let whole = std::fs::read(&file.path).expect("read");
    // A value within a page: only the digest shows it. Row 1 has an overshoot of 1 + 10·37/101.
    let value = (10.0 * (37.0 / 101.0) + 1.0_f64).to_le_bytes();
    let place = whole.windows(8).position(|bytes| bytes == value).expect("there");
    let mut bytes = whole.clone();
    bytes[place] ^= 1;
    std::fs::write(&file.path, &bytes).expect("written");
    assert!(
        matches!(summary(0.9), Err(SummaryError::Table(TableError::DigestDiffers { .. }))),
        "{:?}",
        summary(0.9)
    );
    std::fs::write(&file.path, &whole[..whole.len() / 2]).expect("written");
    assert!(matches!(summary(0.9), Err(SummaryError::Table(TableError::NotParquet { .. }))));
}

/// 2¹⁷ and some: every run counts for quantiles, the first 2¹⁷ for sensitivities.
#[test]
fn of_many_runs_the_first_are_asked_what_measures_depend_on() {
    let runs = SENSITIVITY_RUNS as u64 + 100;
    // In the last runs, the overshoot is another one.
    let summary = made(runs, &["A"], |run, _| match run < SENSITIVITY_RUNS as u64 {
        true => good(run),
        false => Row { overshoot_pct: Some(1000.0 + run as f64), ..good(run) },
    });
    let runs_used = SENSITIVITY_RUNS as u64;
    assert_eq!(summary.notes, [Note::FirstRunsOnly { runs_used, runs }]);
    let controller = &summary.controllers[0];
    let overshoot = measure(controller, "overshoot_pct");
    assert_eq!((overshoot.count, overshoot.highest[0].run), (runs, runs - 1));
    let depends = &controller.sensitivities[2];
    assert_eq!((depends.used, [depends.runs_used, depends.runs]), (runs_used, [runs_used, runs]));
    let y: Vec<f64> = (0..runs_used).filter_map(|run| good(run).overshoot_pct).collect();
    let gain: Vec<f64> = (0..runs_used).map(|run| good(run).gain).collect();
    assert_eq!(depends.influences[0].correlation, rank::spearman(&gain, &y));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_numbers_in_the_columns_are_summarised(
        bits in prop::collection::vec((any::<u64>(), any::<u64>(), any::<bool>()), 2..40),
    ) {
        let summary = made(bits.len() as u64, &["A"], |run, _| {
            let (overshoot, gain, failed) = bits[run as usize];
            Row {
                overshoot_pct: (overshoot % 5 > 0).then_some(f64::from_bits(overshoot)),
                gain: f64::from_bits(gain),
                diverged_at_s: failed.then_some(f64::from_bits(overshoot ^ gain)),
                reasons: failed.then(String::new),
                ..good(run)
            }
        });
        let overshoot = measure(&summary.controllers[0], "overshoot_pct");
        let all = overshoot.count + overshoot.missing + overshoot.not_finite;
        prop_assert_eq!(all, bits.len() as u64);
        let failed = bits.iter().filter(|bits| bits.2).count() as u64;
        prop_assert_eq!(summary.controllers[0].failed.count, failed);
        prop_assert!(!text(&summary).is_empty() && json(&summary)["schema"] == 1);
    }
}

fn campaign_file(runs: u64) -> File {
    let home = tempfile::tempdir().expect("a folder");
    let folder = Folder::new(home.path());
    let scenario = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/campaign.toml");
    let question = Question {
        scenario: &scenario,
        // A limit that some do not meet, and some gains that some do not survive.
        overrides: &["loop.duration_s=10.0".to_owned(), "requirement[0].most=12.0".to_owned()],
        runs,
        seed: 7,
        sampling: Sampling::LatinHypercube,
        shards: Shards::ForThreads,
    };
    let campaign = plan(&question, &folder).unwrap_or_else(|error| panic!("{error}"));
    folder.put_plan(campaign.plan()).expect("written");
    local::run(&folder, &campaign, 2, &Progress::default()).expect("flown");
    File { path: folder.merged_path(), _home: home }
}

/// The numbers of a column in the rows of one of two controllers.
fn floats(table: &ColumnTable, name: &str, place: usize) -> Vec<Option<f64>> {
    table.floats(name).expect("numbers").iter().skip(place).step_by(2).copied().collect()
}

fn truths(table: &ColumnTable, name: &str, place: usize) -> Vec<Option<bool>> {
    let Values::Boolean(cells) = table.column(name).expect("a column") else { panic!("truths") };
    cells.iter().skip(place).step_by(2).copied().collect()
}

#[test]
fn a_flown_campaign_is_summarised_as_its_rows_say() {
    let file = campaign_file(200);
    let summary = of(&file.path);
    let reader = Reader::open(&file.path).expect("a file");
    let rows = reader.tables().next().expect("a row group").expect("readable");
    assert_eq!(summary.head.scenario.as_deref(), Some("747 pitch step, dispersed"));
    assert_eq!((summary.head.runs, summary.head.seed, summary.head.rows), (200, 7, 400));
    assert_eq!(summary.head.digest, Some(reader.digest()));
    assert_eq!(summary.head.controllers, ["CPID", "FSPID"]);
    for (place, controller) in summary.controllers.iter().enumerate() {
        let failed: Vec<bool> = truths(&rows, "failed", place).into_iter().flatten().collect();
        assert_eq!(controller.failed.count, failed.iter().filter(|&&it| it).count() as u64);
        assert_eq!(controller.verdicts.iter().map(|it| it.flights).sum::<u64>(), 200);
        for measure in &controller.measures {
            check_measure(measure, &floats(&rows, &measure.name, place));
        }
        for requirement in &controller.requirements {
            let met = truths(&rows, &format!("requirement.{}.met", requirement.id), place);
            let count = |wanted| met.iter().filter(|it| **it == wanted).count() as u64;
            assert_eq!(requirement.not_met.count, count(Some(false)));
            assert_eq!(requirement.not_judged, count(None));
        }
        for sensitivity in &controller.sensitivities {
            let y = match &sensitivity.of {
                SensitivityTarget::Measure(name) => floats(&rows, name, place),
                SensitivityTarget::Failure => {
                    failed.iter().map(|&failed| Some(f64::from(u8::from(failed)))).collect()
                }
            };
            for influence in &sensitivity.influences {
                let x = floats(&rows, &format!("parameter.{}", influence.parameter), place);
                let pairs = x.iter().zip(&y).filter_map(|(x, y)| Some(((*x)?, (*y)?)));
                let (x, y): (Vec<f64>, Vec<f64>) = pairs.unzip();
                assert_eq!(sensitivity.used, y.len() as u64);
                assert_eq!(influence.correlation, rank::spearman(&x, &y));
                assert_eq!(influence.share, share::first_order(&x, &y));
            }
        }
    }
    let failed = summary.controllers.iter().map(|it| it.failed.count).sum::<u64>();
    assert!((1..400).contains(&failed), "{failed}: the test should see some failures, and not all");
}

/// Compares a measure with the cells of its column.
fn check_measure(measure: &MeasureSummary, cells: &[Option<f64>]) {
    let name = &measure.name;
    let values: Vec<f64> = cells.iter().flatten().copied().collect();
    assert_eq!(measure.count, values.len() as u64, "{name}");
    assert_eq!(measure.missing, (cells.len() - values.len()) as u64, "{name}");
    let mut sorted: Vec<(f64, u64)> =
        cells.iter().zip(0..).filter_map(|(cell, run)| cell.map(|value| (value, run))).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let lowest: Vec<(f64, u64)> = measure.lowest.iter().map(|it| (it.value, it.run)).collect();
    assert_eq!(lowest, sorted[..sorted.len().min(5)], "{name}");
    sorted.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let highest: Vec<(f64, u64)> = measure.highest.iter().map(|it| (it.value, it.run)).collect();
    assert_eq!(highest, sorted[..sorted.len().min(5)], "{name}");
    let Some(moments) = measure.moments else {
        assert!(values.is_empty(), "{name}");
        return;
    };
    assert!(near(moments.mean, values.iter().sum::<f64>() / values.len() as f64), "{name}");
    sorted.reverse();
    for quantile in &measure.quantiles {
        let place = quantile.share * (values.len() - 1) as f64;
        let (below, above) = (sorted[place.floor() as usize].0, sorted[place.ceil() as usize].0);
        let expected = below + (place - place.floor()) * (above - below);
        assert!(near(quantile.value, expected), "{name} {}", quantile.share);
        // With one or two values, the interval of an outer quantile may lie beyond what is interpolated.
        let is_inside = quantile.interval.lower.is_none_or(|lower| lower <= quantile.value)
            && quantile.interval.upper.is_none_or(|upper| upper >= quantile.value);
        assert!(is_inside || values.len() < 3, "{name} {}", quantile.share);
    }
    let histogram = measure.histogram.as_ref().expect("a histogram");
    let counted = histogram.counts.iter().sum::<u64>() + histogram.below + histogram.above;
    assert_eq!(counted, measure.count, "{name}");
}

#[test]
fn the_same_file_gives_the_same_words_and_bits_with_any_number_of_threads() {
    let file = written(
        &table(400, &["A", "B"], |run, place| match (place, run % 11) {
            (1, 5) => diverged(run, 1.0 + run as f64 / 7.0),
            _ => good(run),
        }),
        &metadata(400, "random"),
    );
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| of(&file.path))
    };
    let one = with(1);
    assert_eq!(one, with(4));
    assert_eq!(json(&one).to_string(), json(&with(3)).to_string());
}

#[test]
fn the_text_fits_into_a_hundred_columns_and_the_json_says_the_same() {
    let summary = of(&campaign_file(60).path);
    let text = text(&summary);
    let widest = text.lines().map(|line| line.chars().count()).max();
    assert!(widest <= Some(100), "{widest:?}\n{text}");
    let json = json(&summary);
    assert_eq!(json["schema"], 1);
    assert_eq!(json["controllers"][1]["name"], "FSPID");
    let failed = &json["controllers"][0]["failed"];
    assert_eq!(failed["of"], 60);
    assert_eq!(failed["upper"].as_f64(), Some(summary.controllers[0].failed.upper));
    let measures = json["controllers"][0]["measures"].as_array().expect("a list");
    assert_eq!(measures.len(), summary.controllers[0].measures.len());
    let named = |name: &str| measures.iter().find(|it| it["name"] == name).expect("there");
    assert_eq!(named("diverged_at_s")["mean"], serde_json::Value::Null);
    assert_eq!(named("overshoot_pct")["bad"], "high");
    assert_eq!(json["notes"][0]["note"], "runs-not-independent");
}

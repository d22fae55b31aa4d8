//! What the parts of a campaign cost, under a harness: `cargo bench -p fspid-campaign --bench campaign`.
//!
//! The work is that of `fspid bench`; each part has its own count of things done, so that its rate is printed.

use divan::Bencher;
use divan::counter::ItemsCount;
use fspid_campaign::bench::{SCENARIO, Work};
use fspid_campaign::sample::Sampling;
use fspid_campaign::table::{ColumnTable, Writer};
use fspid_campaign::{Campaign, Folder, Progress, Question, Range, Shards, local, merge, plan};

/// Flights of a sample: four groups in lanes.
const FLIGHTS: u64 = 32;
/// Rows of a shard that is written, and of each of the parts that are merged.
const ROWS: u64 = 2048;

fn main() {
    divan::main();
}

fn work() -> Work {
    Work::new().expect("the scenario is built in")
}

#[divan::bench]
fn inferences_one_by_one(bencher: Bencher<'_, '_>) {
    let work = work();
    let bencher = bencher.counter(ItemsCount::new(work.inferences()));
    bencher.bench_local(|| work.infer_one_by_one(1));
}

#[divan::bench]
fn inferences_as_a_batch(bencher: Bencher<'_, '_>) {
    let work = work();
    let bencher = bencher.counter(ItemsCount::new(work.inferences()));
    bencher.bench_local(|| work.infer_as_batch(1));
}

#[divan::bench]
fn steps_one_by_one(bencher: Bencher<'_, '_>) {
    let work = work();
    bencher.counter(ItemsCount::new(work.steps())).bench_local(|| work.fly_one_by_one());
}

#[divan::bench]
fn steps_side_by_side(bencher: Bencher<'_, '_>) {
    let work = work();
    bencher.counter(ItemsCount::new(work.steps())).bench_local(|| work.fly_in_lanes());
}

/// Drawing a run's numbers and building its scenario.
#[divan::bench]
fn runs_drawn_and_built(bencher: Bencher<'_, '_>) {
    let work = work();
    let campaign = work.campaign();
    let mut run = 0;
    bencher.counter(ItemsCount::new(1_u64)).bench_local(|| {
        run += 1;
        campaign.study(&campaign.drawn(run))
    });
}

/// Preparing a run that is built: signals sampled, plant discretised.
#[divan::bench]
fn runs_prepared(bencher: Bencher<'_, '_>) {
    let work = work();
    let study = work.campaign().study(&work.campaign().drawn(0)).expect("a scenario");
    bencher.counter(ItemsCount::new(1_u64)).bench_local(|| study.scenario.prepare());
}

/// Everything, on one thread and on two.
#[divan::bench(args = [1, 2])]
fn flights_with_all_measures(bencher: Bencher<'_, '_>, threads: usize) {
    let work = work();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let bencher = bencher.counter(ItemsCount::new(FLIGHTS * threads as u64));
    bencher.bench_local(|| pool.install(|| work.fly(FLIGHTS * threads as u64)));
}

/// Rows enough for a shard, of a few flights again and again.
fn rows(campaign: &Campaign) -> ColumnTable {
    let range = Range { first: 0, end: FLIGHTS };
    let flown = campaign.fly(range, &Progress::default()).expect("flown");
    let mut table = ColumnTable::new(std::sync::Arc::clone(campaign.rows().schema()));
    for _ in 0..ROWS / FLIGHTS {
        table.append(&flown).expect("the same columns");
    }
    table
}

/// Rows of a shard written as Parquet, into memory.
#[divan::bench]
fn rows_written(bencher: Bencher<'_, '_>) {
    let work = work();
    let table = rows(work.campaign());
    bencher.counter(ItemsCount::new(ROWS)).bench_local(|| {
        let mut writer = Writer::new(Vec::new(), work.campaign().rows().schema(), &[])?;
        writer.write(&table)?;
        writer.finish(&[])
    });
}

/// Rows of four parts merged: read, checked, digested, written, flushed to the disk.
#[divan::bench(sample_count = 20)]
fn rows_merged(bencher: Bencher<'_, '_>) {
    let home = tempfile::tempdir().expect("a folder");
    let scenario = home.path().join("scenario.toml");
    std::fs::write(&scenario, SCENARIO).expect("written");
    let folder = Folder::new(&home.path().join("campaign"));
    let question = Question {
        scenario: &scenario,
        overrides: &["loop.duration_s=1.0".to_owned()],
        runs: ROWS,
        seed: 1,
        sampling: Sampling::Random,
        shards: Shards::Of(ROWS / 4),
    };
    let campaign = plan(&question, &folder).expect("a plan");
    folder.put_plan(campaign.plan()).expect("written");
    local::run(&folder, &campaign, 0, &Progress::default()).expect("flown");
    let bencher = bencher.counter(ItemsCount::new(ROWS));
    bencher.bench_local(|| merge(&folder, &campaign, &folder.merged_path()));
}

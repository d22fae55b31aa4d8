//! A campaign as a whole: planned, flown in parts, merged; the same bytes however that was done.

use std::path::{Path, PathBuf};

use fspid_campaign::sample::Sampling;
use fspid_campaign::table::{Reader, Values};
use fspid_campaign::{
    Campaign, CampaignError, Folder, Progress, Question, Shards, local, merge, plan, shard,
};

fn scenario() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/campaign.toml")
}

fn planned(folder: &Folder, runs: u64, shard_runs: u64) -> Campaign {
    cut(folder, runs, Shards::Of(shard_runs))
}

fn cut(folder: &Folder, runs: u64, shards: Shards) -> Campaign {
    let question = Question {
        scenario: &scenario(),
        overrides: &["loop.duration_s=10.0".to_owned()],
        runs,
        seed: 7,
        sampling: Sampling::LatinHypercube,
        shards,
    };
    let campaign = plan(&question, folder).unwrap_or_else(|error| panic!("{error}"));
    folder.put_plan(campaign.plan()).expect("written");
    campaign
}

fn flown(runs: u64, shard_runs: u64, threads: usize) -> (Vec<u8>, String) {
    let home = tempfile::tempdir().expect("a folder");
    let folder = Folder::new(&home.path().join("campaign"));
    let campaign = planned(&folder, runs, shard_runs);
    let flown = local::run(&folder, &campaign, threads, &Progress::default());
    let digest = flown.unwrap_or_else(|error| panic!("{error}")).digest.to_string();
    (std::fs::read(folder.merged_path()).expect("merged"), digest)
}

#[test]
fn the_merged_file_has_the_same_bytes_for_any_number_of_threads_and_size_of_shards() {
    let whole = flown(50, 50, 1);
    for (shard_runs, threads) in [(50, 2), (7, 3), (1, 8), (16, 1)] {
        assert_eq!(flown(50, shard_runs, threads), whole, "{shard_runs} {threads}");
    }
}

#[test]
fn a_small_campaign_is_cut_finer_for_workers_unless_it_is_cut_already() {
    let home = tempfile::tempdir().expect("a folder");
    let runs = |name: &str, runs, shards| {
        cut(&Folder::new(&home.path().join(name)), runs, shards).plan().shard_runs
    };
    assert_eq!(runs("workers", 10_000, Shards::ForWorkers), 512);
    assert_eq!(runs("workers", 10_000, Shards::ForThreads), 512, "it goes on as it was cut");
    assert_eq!(runs("threads", 10_000, Shards::ForThreads), 8192);
    assert_eq!(runs("threads", 10_000, Shards::ForWorkers), 8192, "it goes on as it was cut");
    assert_eq!(runs("large", 300_000, Shards::ForWorkers), 5120);
    assert_eq!(runs("larger", 1_000_000_000, Shards::ForWorkers), 8192);
    assert_eq!(runs("one", 1, Shards::ForWorkers), 512);
}

#[test]
fn nonlinear_aircraft_in_gusts_of_their_own_fly_the_same_on_any_number_of_threads() {
    let name =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/campaign-turbulence.toml");
    let flown = |threads| {
        let home = tempfile::tempdir().expect("a folder");
        let folder = Folder::new(home.path());
        let question = Question {
            scenario: &name,
            overrides: &["loop.duration_s=3.0".to_owned()],
            runs: 9,
            seed: 2,
            sampling: Sampling::Sobol,
            shards: Shards::Of(4),
        };
        let campaign = plan(&question, &folder).unwrap_or_else(|error| panic!("{error}"));
        folder.put_plan(campaign.plan()).expect("written");
        local::run(&folder, &campaign, threads, &Progress::default()).expect("flown").digest
    };
    assert_eq!(flown(1), flown(3));
}

#[test]
fn an_interrupted_campaign_goes_on_and_flies_nothing_twice() {
    let home = tempfile::tempdir().expect("a folder");
    let folder = Folder::new(home.path());
    let campaign = planned(&folder, 30, 8);
    let progress = Progress::default();
    for number in [2, 0] {
        shard::fly(&folder, &campaign, number, &progress).expect("flown");
    }
    // A part that was being written when the machine went down, and one that was damaged since.
    std::fs::write(folder.shards_path().join(".fspid-half.unfinished"), b"PAR1").expect("written");
    let damaged = folder.shard_path(campaign.plan().shard(2).expect("there is one"));
    let mut bytes = std::fs::read(&damaged).expect("written");
    // Every byte of the first column's first page, some of which no number is made of.
    bytes[100..400].iter_mut().for_each(|byte| *byte ^= 1);
    std::fs::write(&damaged, bytes).expect("written");
    let progress = Progress::default();
    let flown_now = local::run(&folder, &campaign, 2, &progress).expect("flown");
    assert_eq!((flown_now.found, flown_now.flown), (1, 3));
    assert_eq!((progress.found(), progress.flown()), (8, 22));
    assert_eq!(std::fs::read(folder.merged_path()).expect("merged"), flown(30, 30, 1).0);
    let again = local::run(&folder, &campaign, 2, &Progress::default()).expect("flown");
    assert_eq!((again.found, again.flown), (4, 0));
    assert!(!folder.shards_path().join(".fspid-half.unfinished").exists());
}

#[test]
fn a_part_of_a_worker_with_any_bit_changed_is_refused() {
    let home = tempfile::tempdir().expect("a folder");
    let worker = Folder::new(&home.path().join("worker"));
    let campaign = planned(&worker, 4, 2);
    shard::fly(&worker, &campaign, 1, &Progress::default()).expect("flown");
    let range = campaign.plan().shard(1).expect("there is one");
    let part = std::fs::read(worker.shard_path(range)).expect("written");
    let folder = Folder::new(&home.path().join("driver"));
    let campaign = planned(&folder, 4, 2);
    // Values, the statistics around them, names, the footer.
    for place in (0..part.len()).step_by((part.len() / 300) | 1) {
        let mut damaged = part.clone();
        damaged[place] ^= 1 << (place % 8);
        let told = shard::put(&folder, &campaign, 1, &damaged);
        assert!(told.is_err(), "byte {place} of {}", part.len());
        assert!(!folder.shard_path(range).exists(), "byte {place} of {}", part.len());
    }
    shard::put(&folder, &campaign, 1, &part).expect("it is as it was written");
}

#[test]
fn gaps_overlaps_and_foreign_parts_are_refused_by_name() {
    let home = tempfile::tempdir().expect("a folder");
    let folder = Folder::new(&home.path().join("one"));
    let campaign = planned(&folder, 30, 10);
    let progress = Progress::default();
    for number in [0, 2] {
        shard::fly(&folder, &campaign, number, &progress).expect("flown");
    }
    let merged =
        || merge(&folder, &campaign, &folder.merged_path()).map(|digest| digest.to_string());
    let gap = merged().expect_err("a gap");
    assert!(matches!(gap, CampaignError::Gap { count: 10, .. }), "{gap}");
    assert!(gap.to_string().contains("runs 10 to 19 are missing"), "{gap}");
    let copy = folder.shards_path().join("copy.parquet");
    shard::fly(&folder, &campaign, 1, &progress).expect("flown");
    std::fs::copy(folder.shard_path(campaign.plan().shard(1).expect("one")), &copy)
        .expect("copied");
    let overlap = merged().expect_err("an overlap");
    assert!(matches!(overlap, CampaignError::Overlap { .. }), "{overlap}");
    let other = Folder::new(&home.path().join("other"));
    let theirs = planned(&other, 31, 31);
    shard::fly(&other, &theirs, 0, &progress).expect("flown");
    std::fs::copy(other.shard_path(theirs.plan().shard(0).expect("one")), &copy).expect("copied");
    let foreign = merged().expect_err("a foreign part");
    assert!(matches!(foreign, CampaignError::Foreign { .. }), "{foreign}");
    std::fs::remove_file(copy).expect("removed");
    assert_eq!(merged().expect("merged").len(), 64);
}

#[test]
fn a_second_process_in_the_folder_is_refused() {
    let home = tempfile::tempdir().expect("a folder");
    let folder = Folder::new(home.path());
    let campaign = planned(&folder, 3, 3);
    let lock = folder.lock(true).expect("free");
    let refused = local::run(&folder, &campaign, 1, &Progress::default()).expect_err("busy");
    assert!(matches!(refused, CampaignError::Busy { .. }), "{refused}");
    drop(lock);
    local::run(&folder, &campaign, 1, &Progress::default()).expect("free again");
}

#[test]
fn a_plan_that_was_changed_by_hand_is_refused_with_the_place() {
    let home = tempfile::tempdir().expect("a folder");
    let folder = Folder::new(home.path());
    planned(&folder, 3, 3);
    let text = std::fs::read_to_string(folder.plan_path()).expect("written");
    for (from, to, words) in [
        ("\"runs\": 3", "\"runs\": 4", "/campaign is not the digest"),
        ("\"runs\": 3", "\"runs\": 0", "/runs is 0; it must be from 1"),
        ("\"shard_runs\": 3", "\"shard_runs\": 1e9", "/shard_runs is no whole number"),
        ("\"latin-hypercube\"", "\"lhs\"", "\"lhs\", which is unknown"),
        ("\"seed\": \"7\"", "\"seed\": \"-7\"", "/seed is no whole number"),
        ("\"schema\": 1", "\"schema\": 2", "/schema is not 1"),
        ("{", "", "campaign.json"),
    ] {
        let changed = text.replacen(from, to, 1);
        assert_ne!(changed, text, "{from}");
        std::fs::write(folder.plan_path(), changed).expect("written");
        let refused = folder.plan().expect_err("changed").to_string();
        assert!(refused.contains(words), "{refused}");
    }
    std::fs::write(folder.plan_path(), text).expect("written");
    assert!(folder.plan().is_ok());
}

#[test]
fn a_folder_with_another_campaign_is_refused_with_the_difference() {
    let home = tempfile::tempdir().expect("a folder");
    let folder = Folder::new(home.path());
    let mine = planned(&folder, 3, 3);
    folder.put_plan(mine.plan()).expect("the same plan stays");
    let other = fspid_campaign::Plan { seed: 8, ..mine.plan().clone() };
    let refused = folder.put_plan(&other).expect_err("another seed").to_string();
    assert!(refused.contains("seed: 7 there, 8 here"), "{refused}");
}

#[test]
fn a_row_holds_what_was_drawn_and_a_replay_gives_the_same_numbers() {
    let home = tempfile::tempdir().expect("a folder");
    let folder = Folder::new(home.path());
    let campaign = planned(&folder, 20, 20);
    local::run(&folder, &campaign, 2, &Progress::default()).expect("flown");
    let reader = Reader::open(folder.merged_path()).expect("a file");
    assert_eq!(reader.rows(), 40);
    reader.verify().expect("whole");
    let replay = fspid_campaign::replay::replay(&campaign, 13).expect("flown again");
    let table = reader.tables().next().expect("a row group").expect("readable");
    let alone = campaign.fly_together(std::iter::once((13, replay.drawn.clone())));
    let alone = alone.expect("no external controllers");
    let again = campaign.rows().table(&alone).expect("rows");
    assert_eq!(table.slice(26..28).expect("rows"), again);
    let Values::Float(overshoot) = table.column("overshoot_pct").expect("a column") else {
        panic!("numbers")
    };
    let simulated = replay.simulation.results[1].metrics.first_step().overshoot_pct;
    assert_eq!(overshoot[27], simulated.ok());
    // The changes make it the run's scenario for anybody.
    let mut changes = vec!["loop.duration_s=10.0".to_owned()];
    changes.extend(replay.changes);
    let study = fspid_scenario::file::load(&scenario(), &changes).expect("a scenario");
    assert_eq!(study.scenario, replay.study.scenario);
}

#[test]
fn every_column_stands_in_the_documentation_with_its_unit() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/campaigns.md");
    let docs = std::fs::read_to_string(docs).expect("the documentation");
    let home = tempfile::tempdir().expect("a folder");
    let campaign = planned(&Folder::new(home.path()), 1, 1);
    for column in campaign.rows().schema().columns() {
        let name = column.name.as_str();
        let family =
            ["parameter.", "requirement."].iter().find(|family| name.starts_with(**family));
        let row = match family {
            Some(family) => docs.lines().find(|line| line.contains(&format!("`{family}"))),
            None => docs.lines().find(|line| line.contains(&format!("`{name}`"))),
        };
        let row = row.unwrap_or_else(|| panic!("{name} is not documented"));
        assert!(family.is_some() || row.contains(&column.unit), "{name}: {row}");
    }
}

/// A Latin hypercube of as many runs as there are cases has one run in each: a sweep, and no lottery.
#[test]
fn a_choice_among_the_design_gusts_goes_through_all_of_them() {
    let home = tempfile::tempdir().expect("a folder");
    let path = home.path().join("sweep.toml");
    let text = include_str!("../../../scenarios/gallery/gust-sweep.toml");
    std::fs::write(&path, text).expect("written");
    let folder = Folder::new(&home.path().join("campaign"));
    let question = Question {
        scenario: &path,
        overrides: &["loop.duration_s=3.0".to_owned()],
        runs: 18,
        seed: 7,
        sampling: Sampling::LatinHypercube,
        shards: Shards::Of(18),
    };
    let campaign = plan(&question, &folder).unwrap_or_else(|error| panic!("{error}"));
    folder.put_plan(campaign.plan()).expect("written");
    local::run(&folder, &campaign, 2, &Progress::default()).unwrap_or_else(|e| panic!("{e}"));
    let reader = Reader::open(folder.merged_path()).expect("a file");
    let table = reader.tables().next().expect("a row group").expect("readable");
    let Values::Integer(cases) = table.column("parameter.case").expect("a column") else {
        panic!("whole numbers")
    };
    let mut cases: Vec<i64> = cases.iter().map(|case| case.expect("drawn")).collect();
    cases.sort_unstable();
    assert_eq!(cases, (1..=18).collect::<Vec<i64>>());
    let Values::Float(loads) =
        table.column("requirement.largest_load_factor_g.value").expect("a column")
    else {
        panic!("numbers")
    };
    assert!(loads.iter().all(|load| load.is_some_and(|load| load > 1.0)));
}

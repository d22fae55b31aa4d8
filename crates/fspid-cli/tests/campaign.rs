//! `fspid campaign` as people, schedulers and accidents meet it.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)
}

/// A folder with the shipped campaign, its flights cut short.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let text = std::fs::read_to_string(repository("scenarios/campaign.toml")).expect("shipped");
    let short = text.replace("duration_s = 50.0", "duration_s = 5.0");
    std::fs::write(folder.path().join("pitch.toml"), short).expect("written");
    folder
}

fn command(arguments: &[&str], folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fspid"));
    command.args(arguments).current_dir(folder);
    command
}

fn fspid(arguments: &[&str], folder: &Path) -> Output {
    command(arguments, folder).output().expect("the program starts")
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("an exit code")
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).expect("UTF-8")
}

fn done(arguments: &[&str], folder: &Path) -> String {
    let output = fspid(arguments, folder);
    assert_eq!(code(&output), 0, "{arguments:?}\n{}", text(&output.stderr));
    text(&output.stdout).to_owned()
}

const SMALL: [&str; 9] =
    ["campaign", "run", "pitch.toml", "--runs", "40", "--seed", "5", "--shard-runs", "7"];
/// Enough work that it is still going on when it is interrupted.
const LARGE: [&str; 7] = ["campaign", "run", "pitch.toml", "--runs", "1200", "--shard-runs", "30"];

fn with<'a>(arguments: &[&'a str], more: &[&'a str]) -> Vec<&'a str> {
    arguments.iter().chain(more).copied().collect()
}

fn merged(folder: &Path, out: &str) -> Vec<u8> {
    std::fs::read(folder.join(out).join("campaign.parquet")).expect("merged")
}

#[test]
fn shards_flown_in_any_order_merge_to_the_file_of_a_run() {
    let folder = folder();
    let folder = folder.path();
    let whole = done(&with(&SMALL, &["--out", "whole", "--quiet", "--threads", "1"]), folder);
    let mut plan = SMALL;
    plan[1] = "plan";
    let planned = done(&with(&plan, &["--out", "parts"]), folder);
    assert!(planned.contains("40 runs in 6 shards, numbered 0 to 5"), "{planned}");
    let merge = ["campaign", "merge", "--out", "parts"];
    let early = fspid(&merge, folder);
    assert_eq!(code(&early), 2);
    assert!(text(&early.stderr).contains("runs 0 to 39 are missing (40 in all)"));
    for shard in ["4", "0", "2", "5", "1", "3", "3"] {
        let told = done(&["campaign", "shard", shard, "--out", "parts", "--quiet"], folder);
        assert!(told.contains("runs "), "{told}");
    }
    let answer = done(&merge, folder);
    assert_eq!(merged(folder, "parts"), merged(folder, "whole"));
    let digest = |answer: &str| answer.lines().last().map(str::to_owned);
    assert_eq!(digest(&answer), digest(&whole));
}

#[test]
fn what_cannot_be_is_refused_with_what_can() {
    let folder = folder();
    let folder = folder.path();
    done(&with(&SMALL, &["--out", "here", "--quiet"]), folder);
    for (arguments, words) in [
        (vec!["campaign", "shard", "6", "--out", "here"], "there is no shard 6; allowed is 0 to 5"),
        (
            vec!["campaign", "replay", "here", "--run", "40"],
            "there is no run 40; allowed is 0 to 39",
        ),
        (vec!["campaign", "run", "--out", "here", "--runs", "9"], "--runs goes with a scenario"),
        (vec!["campaign", "run", "--out", "nowhere"], "there is no campaign here"),
        (
            vec!["campaign", "run", "pitch.toml", "--runs", "0", "--out", "x"],
            "--runs is 0; allowed is a whole number from 1",
        ),
        (
            vec!["campaign", "plan", "pitch.toml", "--shard-runs", "65537", "--out", "x"],
            "--shard-runs is 65537; allowed is a whole number from 1 to 65536",
        ),
        (vec!["campaign", "run", "pitch.toml", "--out", "here"], "another campaign is there"),
        (
            vec!["campaign", "search", "pitch.toml", "--measure", "overshot"],
            "there is no measure `overshot`; did you mean",
        ),
        (vec!["campaign", "run", "none.toml", "--out", "x"], "none.toml: cannot be read"),
    ] {
        let output = fspid(&arguments, folder);
        assert_eq!(code(&output), 2, "{arguments:?}");
        assert!(text(&output.stderr).contains(words), "{arguments:?}\n{}", text(&output.stderr));
    }
}

#[test]
fn a_replay_and_the_command_it_names_give_the_same_trace() {
    let folder = folder();
    let folder = folder.path();
    done(&with(&SMALL, &["--out", "here", "--quiet"]), folder);
    let told = done(&["campaign", "replay", "here", "--run", "31", "--trace", "one.csv"], folder);
    let alone = told.lines().find_map(|line| line.trim().strip_prefix("alone: fspid "));
    let program = env!("CARGO_BIN_EXE_fspid");
    let line = format!("{program} {} --trace two.csv", alone.expect("a command"));
    let shell = Command::new("sh").args(["-c", &line]).current_dir(folder).output();
    assert!(shell.expect("a shell").status.success(), "{line}");
    let read = |name: &str| std::fs::read(folder.join(name)).expect("a trace");
    assert_eq!(read("one.csv"), read("two.csv"));
}

#[test]
fn a_report_says_how_often_it_fails_as_text_json_and_page() {
    let folder = folder();
    let folder = folder.path();
    done(&with(&SMALL, &["--out", "here", "--quiet"]), folder);
    let file = "here/campaign.parquet";
    let told = done(&["campaign", "report", file, "--out", "page.html"], folder);
    assert!(told.contains("fails 0 of 40: at most"), "{told}");
    let page = std::fs::read_to_string(folder.join("page.html")).expect("written");
    assert!(page.contains("<span>here</span> <span>--run</span>"), "a replay names the folder");
    assert!(
        !page.contains("http://")
            || page.matches("http://").count() == page.matches("http://www.w3.org").count()
    );
    let json = done(&["campaign", "report", file, "--format", "json"], folder);
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(json["schema"], 1);
    for (arguments, words) in [
        (vec!["campaign", "report", "pitch.toml"], "pitch.toml"),
        (vec!["campaign", "report", "none.parquet"], "none.parquet"),
        (vec!["campaign", "report", file, "--confidence", "1.5"], "1.5"),
        (vec!["campaign", "report", "here/shards/000000000-000000006.parquet"], "000000000"),
    ] {
        let output = fspid(&arguments, folder);
        assert_eq!(code(&output), 2, "{arguments:?}");
        assert!(text(&output.stderr).contains(words), "{}", text(&output.stderr));
    }
}

#[test]
fn progress_is_plain_lines_where_nobody_watches_and_nothing_when_quiet() {
    let folder = folder();
    let loud = fspid(&with(&SMALL, &["--out", "loud"]), folder.path());
    let told = text(&loud.stderr);
    assert!(told.contains("40 of 40 runs") && told.contains("failed") && !told.contains('\r'));
    let next = "\nnext: fspid campaign report loud --out loud.html\n";
    assert!(told.ends_with(next), "{told}");
    let quiet = fspid(&with(&SMALL, &["--out", "quiet", "--quiet"]), folder.path());
    assert_eq!(text(&quiet.stderr), "");
}

fn started(out: &str, folder: &Path) -> Child {
    let arguments = with(&LARGE, &["--out", out, "--quiet"]);
    let mut command = command(&arguments, folder);
    command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("the program starts")
}

#[cfg(unix)]
fn signal(child: &Child, name: &str) {
    let number = child.id().to_string();
    assert!(Command::new("kill").args([name, &number]).status().expect("kill").success());
}

/// A campaign that has finished some shards and now stands still in the middle of its work. It is
/// waited for however long that takes; one that had ended before it was seen is begun again.
#[cfg(unix)]
fn caught(out: &str, folder: &Path, count: usize) -> Child {
    let shards = folder.join(out).join("shards");
    loop {
        let mut child = started(out, folder);
        while child.try_wait().expect("a state").is_none() {
            let files = std::fs::read_dir(&shards).into_iter().flatten().flatten();
            let is_whole = |name: &str| name.ends_with(".parquet") && !name.starts_with('.');
            if files.filter(|file| is_whole(&file.file_name().to_string_lossy())).count() < count {
                std::thread::sleep(Duration::from_millis(5));
                continue;
            }
            signal(&child, "-STOP");
            if !folder.join(out).join("campaign.parquet").exists() {
                return child;
            }
            child.kill().expect("killed");
        }
        child.wait().expect("ended");
        std::fs::remove_dir_all(folder.join(out)).expect("removed");
    }
}

#[cfg(unix)]
#[test]
fn a_killed_campaign_goes_on_to_the_bytes_of_one_that_was_not() {
    let folder = folder();
    let folder = folder.path();
    for (out, shards) in [("killed", 2), ("killed", 7)] {
        let mut child = caught(out, folder, shards);
        // The lock is held: a second one in the same folder is told so.
        let second = fspid(&with(&LARGE, &["--out", out]), folder);
        assert_eq!(code(&second), 2, "{}", text(&second.stdout));
        assert!(text(&second.stderr).contains("another process is working in this folder"));
        // SIGKILL, which nobody can catch.
        child.kill().expect("killed");
        child.wait().expect("ended");
    }
    assert!(!folder.join("killed/campaign.parquet").exists());
    done(&with(&LARGE, &["--out", "killed", "--quiet"]), folder);
    done(&with(&LARGE, &["--out", "whole", "--quiet"]), folder);
    assert_eq!(merged(folder, "killed"), merged(folder, "whole"));
}

#[cfg(unix)]
#[test]
fn an_interrupted_campaign_and_a_full_disk_lose_nothing() {
    let folder = folder();
    let folder = folder.path();
    let mut child = caught("here", folder, 2);
    signal(&child, "-INT");
    signal(&child, "-CONT");
    assert!(!child.wait().expect("ended").success());
    // No file may grow beyond 4 KiB: the next part does not fit, as on a full disk.
    let program = env!("CARGO_BIN_EXE_fspid");
    let line = format!("trap '' XFSZ; ulimit -f 8; exec {program} {} --out here", LARGE.join(" "));
    let full =
        Command::new("sh").args(["-c", &line]).current_dir(folder).output().expect("a shell");
    assert_eq!(code(&full), 4, "{}", text(&full.stderr));
    let told = text(&full.stderr);
    assert!(
        told.contains("cannot write here/shards/") && told.contains("when it is run again"),
        "{told}"
    );
    done(&with(&LARGE, &["--out", "here", "--quiet"]), folder);
    done(&with(&LARGE, &["--out", "whole", "--quiet"]), folder);
    assert_eq!(merged(folder, "here"), merged(folder, "whole"));
}

#[test]
fn a_report_of_parts_refuses_gaps_unless_asked_and_says_so_first_in_every_form() {
    let folder = folder();
    let folder = folder.path();
    let mut plan = SMALL;
    plan[1] = "plan";
    done(&with(&plan, &["--out", "c"]), folder);
    for shard in ["0", "1", "2", "4", "5"] {
        done(&["campaign", "shard", shard, "--quiet", "--out", "c"], folder);
    }
    let refused = fspid(&["campaign", "report", "c"], folder);
    assert_eq!(code(&refused), 2);
    assert!(text(&refused.stderr).contains("5 of 6 shards are there"), "{}", text(&refused.stderr));
    let incomplete = "INCOMPLETE: from 5 of 6 shards, 33 of 40 runs";
    let told = done(&["campaign", "report", "c", "--incomplete"], folder);
    assert_eq!(told.lines().nth(1).map(str::trim), Some(incomplete));
    done(&["campaign", "report", "c", "--incomplete", "--out", "c.html"], folder);
    let page = std::fs::read_to_string(folder.join("c.html")).expect("a page");
    assert!(page.contains(incomplete));

    done(&["campaign", "shard", "3", "--quiet", "--out", "c"], folder);
    let of_parts = done(&["campaign", "report", "c"], folder);
    done(&["campaign", "merge", "--out", "c"], folder);
    let of_file = done(&["campaign", "report", "c/campaign.parquet"], folder);
    assert_eq!(of_parts, of_file);
}

#[test]
fn a_store_without_an_engine_that_puts_parts_there_is_refused() {
    let folder = folder();
    let stored = with(&SMALL, &["--out", "c", "--store", "s3://bucket"]);
    let refused = fspid(&stored, folder.path());
    assert_eq!(code(&refused), 2);
    assert!(text(&refused.stderr).contains("--store goes with --engine ray and dask"));
}

/// A search for rare failures of some hundred flights, and what its folder holds.
const RARE: [&str; 13] = [
    "campaign",
    "rare",
    "pitch.toml",
    "--fails",
    "overshoot_pct",
    "--flights",
    "1000",
    "--seed",
    "3",
    "--set",
    "loop.duration_s=2.5",
    "--set",
    "requirement[0].most=13.5",
];

fn rare_files(folder: &Path, out: &str) -> Vec<(String, Vec<u8>)> {
    let parts = std::fs::read_dir(folder.join(out).join("flights")).expect("parts");
    let parts = parts.map(|entry| entry.expect("an entry").path());
    let whole = ["answer.json", "levels.svg", "question.json"].map(|it| folder.join(out).join(it));
    let mut files: Vec<PathBuf> = parts.chain(whole).collect();
    files.sort();
    let read = |path: &PathBuf| {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        (name, std::fs::read(path).expect("read"))
    };
    files.iter().map(read).collect()
}

#[test]
fn a_rare_failure_has_the_same_bytes_for_any_threads_and_after_an_interruption() {
    let folder = folder();
    let folder = folder.path();
    let one = done(&with(&RARE, &["--threads", "1", "--out", "one", "--quiet"]), folder);
    let two = done(&with(&RARE, &["--threads", "2", "--out", "two", "--quiet"]), folder);
    assert_eq!(one, two);
    assert_eq!(rare_files(folder, "one"), rare_files(folder, "two"));
    // What an interruption leaves: the first parts, and perhaps a beginning of the next under another name.
    let parts = rare_files(folder, "two").len() - 3;
    assert!(parts > 6, "{parts}");
    for number in parts / 2..parts {
        let part = folder.join(format!("two/flights/{number:06}.scores"));
        std::fs::remove_file(part).expect("removed");
    }
    std::fs::remove_file(folder.join("two/answer.json")).expect("removed");
    std::fs::write(folder.join("two/flights/.tmpAbCdEf"), "fspid rare sc").expect("written");
    assert_eq!(done(&with(&RARE, &["--out", "two", "--quiet"]), folder), one);
    std::fs::remove_file(folder.join("two/flights/.tmpAbCdEf")).expect("removed");
    assert_eq!(rare_files(folder, "one"), rare_files(folder, "two"));
    // Nothing kept, the same answer.
    assert_eq!(done(&with(&RARE, &["--quiet"]), folder), one);
}

#[test]
fn a_folder_of_another_question_and_a_damaged_part_are_refused() {
    let folder = folder();
    let folder = folder.path();
    done(&with(&RARE, &["--out", "kept", "--quiet"]), folder);
    let mut other = RARE;
    other[8] = "4";
    let refused = fspid(&with(&other, &["--out", "kept"]), folder);
    assert_eq!(code(&refused), 2);
    let told = text(&refused.stderr);
    assert!(told.contains("seed: \"3\" there, \"4\" here"), "{told}");
    let part = folder.join("kept/flights/000001.scores");
    let whole = std::fs::read_to_string(&part).expect("a part");
    for damaged in [
        whole.replace("end\n", ""),
        whole.replacen("fspid", "fspad", 1),
        whole.replacen("\n-", "\nx-", 1),
    ] {
        std::fs::write(&part, damaged).expect("written");
        let refused = fspid(&with(&RARE, &["--out", "kept"]), folder);
        assert_eq!(code(&refused), 2);
        let told = text(&refused.stderr);
        assert!(told.contains("000001.scores") && told.contains("remove it"), "{told}");
    }
}

#[test]
fn a_probability_that_is_required_decides_about_the_exit_code() {
    let folder = folder();
    let folder = folder.path();
    let met = fspid(&with(&RARE, &["--most", "0.9", "--quiet"]), folder);
    assert_eq!(code(&met), 0, "{}", text(&met.stderr));
    assert!(text(&met.stdout).contains(": MET."), "{}", text(&met.stdout));
    let not_met = fspid(&with(&RARE, &["--most", "1e-12", "--quiet"]), folder);
    assert_eq!(code(&not_met), 1);
    assert!(text(&not_met.stdout).contains(": NOT MET."), "{}", text(&not_met.stdout));
    let importance = with(&RARE, &["--most", "0.9", "--method", "importance"]);
    let refused = fspid(&importance, folder);
    assert_eq!(code(&refused), 2);
    assert!(text(&refused.stderr).contains("says nothing of regions"), "{}", text(&refused.stderr));
    for most in ["0", "-1", "2", "nan", "much"] {
        let refused = fspid(&with(&RARE, &["--most", most]), folder);
        assert_eq!(code(&refused), 2, "{most}");
    }
    let refused = fspid(&["campaign", "rare", "pitch.toml", "--fails", "overshot_pct"], folder);
    assert_eq!(code(&refused), 2);
    assert!(text(&refused.stderr).contains("overshoot_pct"), "{}", text(&refused.stderr));
    let refused = fspid(&["campaign", "rare", "pitch.toml", "--fails", "phase_margin_deg"], folder);
    assert!(text(&refused.stderr).contains("not of a flight"), "{}", text(&refused.stderr));
}

//! Nothing of the user's is lost: what a command reads is not written over, names do not collide, links stay links, and
//! what was cut off is cleared.

use crate::common;

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::Command;

use common::{code, fspid, started, text};

/// A command of words in a folder.
fn run(words: &str, folder: &Path) -> (i32, String) {
    let output = fspid(&words.split(' ').collect::<Vec<_>>(), folder);
    (code(&output), text(&output.stderr))
}

/// Runs what must go well.
fn done(words: &str, folder: &Path) {
    let (code, told) = run(words, folder);
    assert_eq!(code, 0, "{words}: {told}");
}

fn listed(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let name = |entry: fs::DirEntry| entry.file_name().to_string_lossy().into_owned();
    let mut names: Vec<String> = entries.map(|entry| name(entry.expect("an entry"))).collect();
    names.sort();
    names
}

/// A scenario with these controllers.
fn scenario(folder: &Path, name: &str, controllers: &[&str]) {
    let starter = text(&fspid(&["init"], folder).stdout);
    let (head, _) = starter.split_once("[[controller]]").expect("controllers");
    let one = |name: &&str| {
        format!("[[controller]]\nname = {name:?}\nkind = \"pid\"\nkp = 1.0\nki = 0.5\nkd = 0.3\n\n")
    };
    let controllers: String = controllers.iter().map(one).collect();
    fs::write(folder.join(name), format!("{head}{controllers}")).expect("written");
}

/// Links with an ending that an output takes, to files that a command reads.
const LINKS: [(&str, &str); 13] = [
    ("a.csv", "a.toml"),
    ("a.html", "a.toml"),
    ("a.xml", "a.toml"),
    ("tip.csv", "tip.toml"),
    ("tip.svg", "tip.toml"),
    ("tip.html", "tip.toml"),
    ("t.parquet", "t.toml"),
    ("merged.html", "run/campaign.parquet"),
    ("part.html", PART),
    ("plan.csv", "run/campaign.json"),
    ("plan.html", "run/campaign.json"),
    ("plan.parquet", "run/campaign.json"),
    ("part.csv", PART),
];
const PART: &str = "run/shards/000000000-000000003.parquet";
/// Lines that would write over what they read.
const OVER: [&str; 28] = [
    "simulate a.toml --trace a.csv",
    "simulate a.toml --report a.html",
    "simulate a.toml --trace new.csv --report a.html",
    "analyse a.toml --map 0 --report a.html",
    "verify a.toml --set ctms --junit a.xml",
    "verify a.toml --set ctms --report a.html",
    "verify a.toml --set ctms --junit new.xml --report a.html",
    "certify a.toml --controller PID --report a.html",
    "certify a.toml --controller PID --report ./a.html",
    "audit tip.toml --boxes 5 --report tip.html",
    "surface tip.toml --nodes 3 --csv tip.csv",
    "surface tip.toml --nodes 3 --out tip.svg",
    "explain tip.toml --input service=7 --input food=8 --svg tip.svg",
    "convert tip.toml tip.toml",
    "convert tip.toml ./tip.toml",
    "tune t.toml --budget 4 --quiet --out t.toml",
    "tune t.toml --budget 4 --quiet --out ./t.toml",
    "tune t.toml --budget 4 --quiet --history t.parquet",
    "campaign report run/campaign.parquet --out merged.html",
    "campaign report run --out merged.html",
    "campaign report run --out part.html",
    "campaign report run --out plan.html",
    "campaign merge --out run --to plan.parquet",
    "campaign merge --out run --to run/shards/000000000-000000003.parquet",
    "campaign replay run --run 1 --trace plan.csv",
    "campaign replay run --run 1 --trace part.csv",
    "campaign replay run --run 1 --report merged.html",
    "campaign replay run --run 1 --trace new.csv --report plan.html",
];

/// Each was written over, with exit code 0.
#[test]
fn what_a_command_reads_is_not_written_over() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    done("init a.toml", folder);
    done("init --template tuning t.toml", folder);
    done("init --template fuzzy-system tip.toml", folder);
    done("init --template campaign c.toml", folder);
    done("campaign run c.toml --runs 4 --shard-runs 4 --quiet --out run", folder);
    for (link, file) in LINKS {
        symlink(file, folder.join(link)).expect("linked");
    }
    let files = ["a.toml", "t.toml", "tip.toml", PART, "run/campaign.json", "run/campaign.parquet"];
    let before = files.map(|name| fs::read(folder.join(name)).expect("a file"));
    for words in OVER {
        let (code, told) = run(words, folder);
        assert!(code == 2 && told.contains("one file"), "{words}: {code}: {told}");
    }
    let after = files.map(|name| fs::read(folder.join(name)).expect("a file"));
    assert!(before == after, "all are as they were");
    assert!(
        !folder.join("new.csv").exists() && !folder.join("new.xml").exists(),
        "nothing is written before all is known"
    );
}

#[test]
fn what_is_printed_into_a_file_is_not_written_over_and_writes_over_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    done("init a.toml", folder);
    let before = fs::read(folder.join("a.toml")).expect("a file");
    for line in ["simulate a.toml >> a.toml", "simulate a.toml --trace a.csv > a.csv"] {
        let line = format!("exec {} {line}", env!("CARGO_BIN_EXE_fspid"));
        let shell = Command::new("sh").args(["-c", &line]).current_dir(folder).output();
        let output = shell.expect("run");
        let told = text(&output.stderr);
        assert!(code(&output) == 2 && told.contains("standard output"), "{line}: {told}");
    }
    assert_eq!(fs::read(folder.join("a.toml")).expect("a file"), before);
}

/// What a shell makes of a line in a folder.
fn in_shell(line: &str, folder: &Path) -> (i32, String) {
    let program = env!("CARGO_BIN_EXE_fspid");
    let line = line.replace("fspid ", &format!("{program} "));
    let output = Command::new("sh").args(["-c", &line]).current_dir(folder).output().expect("run");
    (code(&output), text(&output.stderr))
}

/// The error as JSON was appended to the scenario.
#[test]
fn what_is_read_gets_no_error_either() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    done("init a.toml", folder);
    done("init --template rule-table rules.toml", folder);
    done("init --template campaign c.toml", folder);
    done("campaign run c.toml --runs 4 --shard-runs 4 --quiet --out run", folder);
    let a = fs::read_to_string(folder.join("a.toml")).expect("a file");
    let named = a.replace("table = \"mirrored\"", "table = \"rules.toml\"");
    fs::write(folder.join("named.toml"), named).expect("written");
    let appended = [
        ("a.toml", "fspid simulate a.toml --format json"),
        ("a.toml", "fspid simulate a.toml --no-such-option --format json"),
        ("a.toml", "fspid simulate --format=json --requirements=a.toml"),
        ("a.toml", "fspid check ./a.toml --format json"),
        ("rules.toml", "fspid simulate named.toml --format json"),
        ("rules.toml", "fspid simulate named.toml --trace -"),
        ("run/campaign.json", "fspid campaign report run --format json"),
        (PART, "fspid campaign report run --format json"),
        ("run/campaign.parquet", "fspid campaign report run --format json"),
    ];
    for (file, line) in appended {
        let before = fs::read(folder.join(file)).expect("a file");
        for stream in ["", "2"] {
            let (code, told) = in_shell(&format!("{line} {stream}>> {file}"), folder);
            let after = fs::read(folder.join(file)).expect("a file");
            assert!(after == before, "{line} {stream}>> {file}: {code}: {told}");
            assert!(code == 2 || stream == "2", "{line} >> {file}: {code}: {told}");
        }
    }
    let (code, told) = in_shell("fspid simulate a.toml --format json > a.toml", folder);
    assert!(code == 2 && told.contains("standard output would be written over"), "{told}");
    assert_eq!(fs::read(folder.join("a.toml")).expect("a file"), b"", "the shell emptied it");
    // What is no input has the error, as ever.
    let line = "fspid simulate none.toml --format json > told.json";
    assert_eq!(in_shell(line, folder).0, 2);
    assert!(fs::read_to_string(folder.join("told.json")).is_ok_and(|it| it.contains("\"error\"")));
}

/// Writes a large file until the process is killed, so that what it leaves has the name that the program gave it.
fn leftover(folder: &Path) -> std::path::PathBuf {
    let line = "fspid simulate a.toml --set loop.duration_s=400 --set loop.sample_period_s=0.001 --trace large.csv";
    let words: Vec<&str> = line.split(' ').skip(1).collect();
    let mut process = started(&words, folder);
    let is_left = |name: &String| name.starts_with(".fspid-");
    let found = loop {
        if let Some(name) = listed(folder).into_iter().find(is_left) {
            break name;
        }
        assert_eq!(process.try_wait().expect("a process"), None, "it ended before it was killed");
        std::thread::yield_now();
    };
    process.kill().expect("killed");
    process.wait().expect("it ends");
    assert!(!folder.join("large.csv").exists());
    folder.join(found)
}

/// `export` refused the folder as one with files of others; and what was left stayed for good.
#[test]
fn what_a_killed_process_left_keeps_nobody_out_and_is_cleared_by_every_command_that_writes() {
    let home = tempfile::tempdir().expect("a folder");
    let home = home.path();
    done("init a.toml", home);
    done("init --template tuning t.toml", home);
    done("init --template campaign c.toml", home);
    done("init --template contest who.toml", home);
    let left = leftover(home);
    let name = left.file_name().expect("a name").to_owned();
    let lines = [
        ("out", "export a.toml --controller PID --to c --samples 20 --out out"),
        ("out", "simulate a.toml --trace out/a.csv"),
        ("out", "certify a.toml --controller PID --out out"),
        ("out", "tune t.toml --budget 4 --quiet --out out/d.toml"),
        ("out", "contest who.toml --budget 4 --seeds 1 --quiet --out out"),
        ("out/shards", "campaign run c.toml --runs 4 --quiet --out out"),
        ("out", "campaign run c.toml --runs 4 --quiet --out out"),
    ];
    for (place, words) in lines {
        let place = home.join(place);
        fs::create_dir_all(&place).expect("made");
        fs::copy(&left, place.join(&name)).expect("copied");
        let (code, told) = run(words, home);
        assert!(code < 2, "{words}: {code}: {told}");
        let names = listed(&place);
        assert!(!names.iter().any(|it| it.starts_with(".fspid-")), "{words}: {names:?}");
        assert!(!names.is_empty(), "{words}");
        fs::remove_dir_all(home.join("out")).expect("removed");
    }
}

/// The lock of a search was taken from the scenario, which was removed in the end.
#[test]
fn a_file_that_is_called_like_one_of_the_programs_own_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    for name in ["d.toml.state.json.lock", "d.toml.state.json"] {
        let before = fspid(&["init", "--template", "tuning"], folder).stdout;
        fs::write(folder.join(name), &before).expect("written");
        let (code, told) = run(&format!("tune {name} --budget 4 --quiet --out d.toml"), folder);
        assert!(code == 2 || code == 4, "{name}: {code}: {told}");
        assert!(fs::read(folder.join(name)).is_ok_and(|it| it == before), "{name}: {told}");
        fs::remove_file(folder.join(name)).expect("removed");
    }
    done("init --template campaign c.toml", folder);
    done("campaign plan c.toml --runs 4 --out run", folder);
    let own = ["run/shards/Cargo.lock", "run/shards/.fspid-notes", "run/shards/a.csv"];
    own.iter().for_each(|name| fs::write(folder.join(name), "mine").expect("written"));
    done("campaign run c.toml --runs 4 --quiet --out run", folder);
    for name in own {
        assert!(fs::read_to_string(folder.join(name)).is_ok_and(|it| it == "mine"), "{name}");
    }
}

/// Files that a scenario names, and files that an option makes of a folder, are seen when they are read and written.
#[test]
fn what_a_scenario_names_is_not_written_over_either_nor_one_file_of_a_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    done("init --template rule-table rules.toml", folder);
    symlink("rules.toml", folder.join("rules.csv")).expect("linked");
    let starter = text(&fspid(&["init"], folder).stdout);
    let rules = fs::read(folder.join("rules.toml")).expect("a file");
    let named = starter.replace("table = \"mirrored\"", "table = \"rules.toml\"");
    assert_ne!(named, starter, "{starter}");
    fs::write(folder.join("a.toml"), named).expect("written");
    done("check a.toml", folder);
    let (code, told) = run("simulate a.toml --trace rules.csv", folder);
    assert!(code == 2 && told.contains("--trace rules.csv would be written over it"), "{told}");
    assert_eq!(fs::read(folder.join("rules.toml")).expect("a file"), rules);

    done("init b.toml", folder);
    fs::rename(folder.join("b.toml"), folder.join("pid.certificate.json")).expect("moved");
    let (code, told) = run("certify pid.certificate.json --controller PID --out .", folder);
    assert!(code == 2 && told.contains("which was read"), "{told}");
    assert!(fs::read_to_string(folder.join("pid.certificate.json")).is_ok_and(|it| it == starter));
}

/// Of `PID` and `pid`, and of others, one certificate was left, and both were said to be written.
#[test]
fn controllers_of_colliding_names_have_a_file_and_a_column_each() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let long = ["x".repeat(255), "X".repeat(255)];
    let names =
        ["PID", "pid", "ä", "ö", "a/b", "a.b", "a,b", "a_b", "..", "CON", &long[0], &long[1]];
    scenario(folder, "a.toml", &names);
    let (_, told) = run("certify a.toml --out proofs", folder);
    assert_eq!(listed(&folder.join("proofs")).len(), names.len(), "{told}");
    assert!(told.contains("\"ö\" is `"), "{told}");
    let (_, told) = run("simulate a.toml --trace a.csv", folder);
    let trace = fs::read_to_string(folder.join("a.csv")).expect("a trace");
    let mut columns: Vec<&str> = trace.lines().next().expect("a head").split(',').collect();
    assert!(columns.contains(&"a_b.kp") && columns.contains(&"a_b_2.kp"), "{columns:?}");
    let all = columns.len();
    columns.sort_unstable();
    columns.dedup();
    assert_eq!(columns.len(), all);
    assert!(told.contains("\"a,b\" is `a_b_2` in the name of its column"), "{told}");
}

#[test]
fn a_link_stays_a_link_and_what_it_leads_to_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    fs::create_dir(folder.join("deep")).expect("made");
    done("init a.toml", folder);
    for (link, target) in [("old.csv", "deep/old.csv"), ("new.csv", "deep/new.csv")] {
        symlink(target, folder.join(link)).expect("linked");
    }
    fs::write(folder.join("deep/old.csv"), "old").expect("written");
    for name in ["old.csv", "new.csv"] {
        done(&format!("simulate a.toml --trace {name}"), folder);
        assert!(folder.join(name).is_symlink(), "{name}");
        let found = fs::read_to_string(folder.join("deep").join(name)).expect("a file");
        assert!(found.starts_with("time_s"), "{found}");
    }
    assert_eq!(listed(&folder.join("deep")), ["new.csv", "old.csv"]);
    symlink("circle.csv", folder.join("circle.csv")).expect("linked");
    let (code, told) = run("simulate a.toml --trace circle.csv", folder);
    assert!(code == 4 && told.contains("lead in a circle"), "{told}");

    done("export a.toml --controller PID --to c --samples 20 --out code", folder);
    fs::rename(folder.join("code/vectors.csv"), folder.join("deep/v.csv")).expect("moved");
    symlink("../deep/v.csv", folder.join("code/vectors.csv")).expect("linked");
    done("export a.toml --controller PID --to c --samples 30 --force --out code", folder);
    assert!(folder.join("code/vectors.csv").is_symlink());
    let lines = fs::read_to_string(folder.join("deep/v.csv")).expect("a file").lines().count();
    assert!(lines >= 30, "{lines}");
}

/// The process was killed by the signal, and its temporary file stayed.
#[test]
fn a_file_that_grows_too_large_is_exit_4_with_the_old_one_left() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    done("init a.toml", folder);
    fs::write(folder.join("a.csv"), "old").expect("written");
    let line =
        format!("ulimit -f 8; exec {} simulate a.toml --trace a.csv", env!("CARGO_BIN_EXE_fspid"));
    let output = Command::new("sh").args(["-c", &line]).current_dir(folder).output().expect("run");
    let told = text(&output.stderr);
    assert_eq!(code(&output), 4, "{told}");
    assert!(told.contains("cannot write a.csv: files may not be so large here"), "{told}");
    assert!(fs::read_to_string(folder.join("a.csv")).is_ok_and(|found| found == "old"));
    assert_eq!(listed(folder), ["a.csv", "a.toml"]);
}

/// "cannot write the table: External: No space left on device (os error 28)".
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_with_the_file_and_a_device_or_pipe_among_an_exports_files_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    done("init --template tuning t.toml", folder);
    symlink("/dev/full", folder.join("h.parquet")).expect("linked");
    let (code, told) = run("tune t.toml --budget 4 --quiet --history h.parquet", folder);
    assert!(code == 4 && told.contains("cannot write h.parquet: the disk is full"), "{told}");

    done("init a.toml", folder);
    fs::create_dir(folder.join("code")).expect("made");
    let made = Command::new("mkfifo").arg(folder.join("code/vectors.csv")).status();
    assert!(made.expect("mkfifo").success());
    let words = "export a.toml --controller PID --to c --samples 20 --force --out code";
    let (code, told) = run(words, folder);
    assert!(code == 4 && told.contains("vectors.csv: it is no regular file"), "{code}: {told}");
    assert_eq!(listed(&folder.join("code")), ["vectors.csv"]);
}

/// Two of them wrote over each other's states, and the later one over the design.
#[test]
fn one_process_at_a_time_tunes_into_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    done("init --template tuning t.toml", folder);
    let words = ["tune", "t.toml", "--quiet", "--budget", "100000", "--out", "d.toml"];
    let mut first = started(&words, folder);
    let lock = folder.join("d.toml.state.json.lock");
    while !lock.exists() && first.try_wait().expect("a process").is_none() {
        std::thread::yield_now();
    }
    let (code, told) = run("tune t.toml --quiet --budget 8 --out d.toml", folder);
    first.kill().expect("killed");
    first.wait().expect("it ends");
    assert!(code == 2 && told.contains("another process is tuning there"), "{code}: {told}");
    let _ = fs::remove_file(folder.join("d.toml.state.json"));
    let (code, told) = run("tune t.toml --quiet --budget 8 --out d.toml", folder);
    assert!(code < 2, "the lock ends with the process: {told}");
    assert_eq!(listed(folder), ["d.toml", "t.toml"]);
}

/// Opening one waited for somebody who writes, for ever.
#[test]
fn a_pipe_named_as_a_file_of_a_campaign_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    done("init --template campaign c.toml", folder);
    done("campaign plan c.toml --runs 4 --out run", folder);
    let pipe = |name: &str| {
        let made = Command::new("mkfifo").arg(folder.join(name)).status().expect("mkfifo");
        assert!(made.success());
    };
    pipe("run/shards/000000000-000000003.parquet");
    pipe("pipe.parquet");
    for words in ["campaign merge --out run", "campaign report run", "campaign report pipe.parquet"]
    {
        let (code, told) = run(words, folder);
        assert!(code == 2 && told.contains("it is no regular file"), "{words}: {told}");
    }
    fs::remove_file(folder.join("run/lock")).expect("a lock");
    pipe("run/lock");
    let (code, told) = run("campaign merge --out run", folder);
    assert!(code == 4 && told.contains("it is no regular file"), "{told}");
}

//! Controllers that harm: what one does is charged to it alone, ends with it, and is never called good.

use std::io::Read as _;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};

use serde_json::Value;

use crate::common::{code, fspid, json, started, text};
use crate::external::{library, verdict};

/// A controller that flies well, but for what is put into it. Of its memory it writes the first half alone.
const SOURCE: &str = r#"
#include "fspid_external.h"
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
uint32_t fspid_external_version(void) { return FSPID_EXTERNAL_VERSION; }
double fspid_external_period_s(void) { return 0.0; }
size_t fspid_external_state_bytes(void) { return sizeof(int) + sizeof(float); }
/* How often it was started, kept in a file. */
static int starts(void)
{
    FILE *file = fopen("starts", "a+");
    fputc('x', file);
    int count = (int)ftell(file);
    fclose(file);
    return count;
}
static void note_pid(long pid)
{
    FILE *file = fopen("pid.part", "w");
    fprintf(file, "%ld", pid);
    fclose(file);
    rename("pid.part", "pid");
}
void fspid_external_reset(void *state) { *(int *)state = 0; RESET; }
void fspid_external_step(void *state, const fspid_external_sample *sample, fspid_external_answer *answer)
{
    int *k = state;
    answer->command_rad = 0.9 * (sample->setpoint_rad - sample->measurement_rad);
    if (++*k == 10) { STEP; }
    (void)note_pid; (void)starts;
}
__attribute__((destructor)) static void ends(void) { END; }
"#;

/// Builds `x.so`, which does these things in a scenario's folder.
fn build(folder: &Path, reset: &str, step: &str, end: &str) {
    std::fs::write(folder.join("fspid_external.h"), fspid_export::write::EXTERNAL_HEADER)
        .and_then(|()| std::fs::write(folder.join("x.c"), SOURCE))
        .expect("files");
    let defined = [("RESET", reset), ("STEP", step), ("END", end)];
    let defined = defined.map(|(name, does)| format!("{name}={does}"));
    library(folder, "x.so", &["x.c".into()], &defined.each_ref().map(String::as_str));
}

fn folder(template: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    assert_eq!(code(&fspid(&["init", "--template", template, "s.toml"], folder.path())), 0);
    folder
}

const SHORT: &str =
    "controller[]={ name = \"X\", kind = \"external\", library = \"x.so\", answer_limit_s = 0.3 }";

fn simulated(folder: &Path) -> Output {
    fspid(&["simulate", "s.toml", "--set", SHORT, "--format", "json"], folder)
}

/// A campaign of a few runs, which leaves its rows in a folder.
fn campaign(folder: &Path, out: &str, more: &[&str]) -> Output {
    let run = ["campaign", "run", "s.toml", "--runs", "6", "--threads", "1", "--quiet"];
    fspid(&[&run[..], &["--out", out], more].concat(), folder)
}

/// What the rows of a campaign tell of one of its controllers.
fn of(folder: &Path, campaign: &str, name: &str) -> Value {
    let rows = format!("{campaign}/campaign.parquet");
    let answer = json(&fspid(&["campaign", "report", &rows, "--format", "json"], folder));
    let all = answer["controllers"].as_array().expect("controllers");
    all.iter().find(|it| it["name"] == name).expect("the controller").clone()
}

#[test]
fn a_controller_that_does_not_always_start_fails_alone() {
    let folder = folder("campaign");
    build(folder.path(), "if (starts() % 3 == 0) abort()", "", "");
    let without = campaign(folder.path(), "without", &[]);
    let with = campaign(folder.path(), "with", &["--library", "x.so"]);
    assert_eq!((code(&without), code(&with)), (0, 0), "{}", text(&with.stderr));
    let of = |campaign, name| of(folder.path(), campaign, name);
    assert_eq!(of("with", "PID"), of("without", "PID"));
    let mine = of("with", "x.so").to_string();
    assert!(mine.contains("controller lost"), "{mine}");
}

#[test]
fn a_machine_that_cannot_start_controllers_leaves_no_rows() {
    let folder = folder("campaign");
    let asked = ["export", "s.toml", "--controller", "FSPID", "--to", "fmu2", "--out", "f"];
    assert_eq!(code(&fspid(&asked, folder.path())), 0);
    let run = ["campaign", "run", "s.toml", "--runs", "6", "--fmu", "f/fspid.fmu", "--out", "c"];
    let output = Command::new(env!("CARGO_BIN_EXE_fspid"))
        .args(run)
        .current_dir(folder.path())
        .env("TMPDIR", folder.path().join("nowhere"))
        .output()
        .expect("it starts");
    let told = text(&output.stderr);
    assert_eq!(code(&output), 2, "{told}");
    assert!(told.contains("could not be asked, which says nothing of it"), "{told}");
    assert!(!folder.path().join("c/campaign.parquet").exists());
}

#[test]
fn a_library_that_changes_while_a_campaign_flies_stops_it() {
    // In the third flight, and in the last.
    for starts in ["3", "6"] {
        let folder = folder("campaign");
        build(folder.path(), "", "", "");
        std::fs::rename(folder.path().join("x.so"), folder.path().join("y.so")).expect("moved");
        let step = format!("if (starts() == {starts}) rename(\"y.so\", \"x.so\")");
        build(folder.path(), "", &step, "");
        let output = campaign(folder.path(), "c", &["--library", "x.so"]);
        let told = text(&output.stderr);
        assert_eq!(code(&output), 2, "{told}");
        assert!(told.contains("has changed since it was read"), "{told}");
    }
}

#[test]
fn a_crash_before_the_first_sample_is_a_verdict_at_0_s() {
    let folder = folder("pitch-hold");
    build(folder.path(), "abort()", "", "");
    let output = simulated(folder.path());
    assert_eq!(code(&output), 1, "{}", text(&output.stderr));
    assert_eq!(verdict(&json(&output), "X"), "the controller crashed with SIGABRT at t = 0 s");
    assert_eq!(verdict(&json(&output), "PID"), "settled");
}

#[test]
fn memory_that_is_not_written_is_no_zero_and_what_lies_behind_it_is_not_the_controllers() {
    for (step, told) in [
        (
            "((int *)state)[2] = 0",
            "the controller wrote behind the memory that it asked for at t =",
        ),
        (
            "answer->command_rad = ((float *)state)[1]",
            "the controller answered a command that is not finite at t =",
        ),
    ] {
        let folder = folder("pitch-hold");
        build(folder.path(), "", step, "");
        let found = verdict(&json(&simulated(folder.path())), "X");
        assert!(found.starts_with(told), "{step}: {found}");
    }
}

#[test]
fn what_is_done_behind_the_last_sample_is_told_once_and_ends() {
    for (end, told) in [
        ("abort()", "crashed with SIGABRT, behind the last sample"),
        ("for (;;) { }", "did not end within 1.0 s and was ended"),
        ("char junk[99] = { 0 }; for (;;) if (write(0, junk, 99)) { }", "did not end within 1.0 s"),
    ] {
        let folder = folder("pitch-hold");
        build(folder.path(), "", "", end);
        let output = simulated(folder.path());
        assert_eq!(code(&output), 0, "{end}: {}", text(&output.stderr));
        assert_eq!(verdict(&json(&output), "X"), "not settled within 10 s", "{end}");
        assert!(text(&output.stderr).contains(told), "{end}: {}", text(&output.stderr));
    }
}

#[test]
fn an_answer_in_drops_is_no_answer_and_a_crash_is_told_though_a_child_holds_the_socket() {
    let drops = "for (;;) { if (write(0, \"\", 1)) { } usleep(20000); }";
    let leaves = "pid_t child = fork(); if (child == 0) for (;;) pause(); note_pid(child); abort()";
    for (step, told) in [
        (drops, "the controller gave no answer within 0.3 s at t = 0.09 s"),
        (leaves, "the controller crashed with SIGABRT at t = 0.09 s"),
    ] {
        let folder = folder("pitch-hold");
        build(folder.path(), "", step, "");
        let output = simulated(folder.path());
        assert_eq!(verdict(&json(&output), "X"), told);
        if step == leaves {
            wait_for_the_end_of(&std::fs::read_to_string(folder.path().join("pid")).expect("one"));
        }
    }
}

/// Until no such process runs; one that nobody has asked for how it ended does not.
fn wait_for_the_end_of(pid: &str) {
    loop {
        let asked = Command::new("ps").args(["-o", "stat=", "-p", pid]).output().expect("ps");
        let state = text(&asked.stdout);
        if state.trim().is_empty() || state.trim().starts_with('Z') {
            return;
        }
        std::thread::yield_now();
    }
}

fn end(child: &mut Child, signal: &str) {
    let ended = Command::new("kill").args([signal, &child.id().to_string()]).status();
    assert!(ended.is_ok_and(|status| status.success()));
    let _ = child.wait();
}

#[test]
fn a_controller_that_hangs_ends_with_the_program_however_that_ends() {
    let folder = folder("pitch-hold");
    build(folder.path(), "", "note_pid(getpid()); for (;;) { }", "");
    let long = SHORT.replace("0.3", "3000.0");
    for signal in ["-INT", "-KILL"] {
        let _ = std::fs::remove_file(folder.path().join("pid"));
        let mut child = started(&["simulate", "s.toml", "--set", &long], folder.path());
        while !folder.path().join("pid").exists() {
            std::thread::yield_now();
        }
        end(&mut child, signal);
        wait_for_the_end_of(&std::fs::read_to_string(folder.path().join("pid")).expect("one"));
    }
}

/// It stayed: the process of the controller left in order before it saw that nobody asked any more.
#[test]
fn what_a_controller_began_ends_with_the_program_however_that_ends() {
    let folder = folder("pitch-hold");
    let begins = "pid_t child = fork(); if (child == 0) for (;;) pause(); note_pid(child)";
    build(folder.path(), begins, "", "");
    let long = SHORT.replace("0.3", "3000.0");
    for signal in ["-INT", "-TERM", "-KILL"] {
        let _ = std::fs::remove_file(folder.path().join("pid"));
        let mut child = started(&["simulate", "s.toml", "--set", &long], folder.path());
        while !folder.path().join("pid").exists() {
            std::thread::yield_now();
        }
        end(&mut child, signal);
        let mut told = String::new();
        child.stderr.take().expect("a pipe").read_to_string(&mut told).expect("a text");
        assert!(!told.contains("this command is for"), "{signal}: {told}");
        wait_for_the_end_of(&std::fs::read_to_string(folder.path().join("pid")).expect("one"));
    }
}

#[test]
fn folders_of_fmus_go_with_the_program_however_that_ends() {
    let folder = folder("campaign");
    let asked = ["export", "s.toml", "--controller", "FSPID", "--to", "fmu2", "--out", "f"];
    assert_eq!(code(&fspid(&asked, folder.path())), 0);
    let temporary = folder.path().join("temporary");
    std::fs::create_dir(&temporary).expect("a folder");
    let folders = || std::fs::read_dir(&temporary).expect("a folder").filter_map(Result::ok);
    // A process is there before there is something in its folder; before that the folder would stay.
    let is_unpacked =
        || folders().any(|it| std::fs::read_dir(it.path()).is_ok_and(|within| within.count() > 0));
    let run = ["campaign", "run", "s.toml", "--runs", "100000", "--threads", "1", "--quiet"];
    let run = [&run[..], &["--fmu", "f/fspid.fmu", "--out", "c"]].concat();
    let mut child = Command::new(env!("CARGO_BIN_EXE_fspid"))
        .args(run)
        .current_dir(folder.path())
        .env("TMPDIR", &temporary)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("it starts");
    while !is_unpacked() {
        std::thread::yield_now();
    }
    end(&mut child, "-INT");
    while folders().count() > 0 {
        std::thread::yield_now();
    }
}

#[test]
fn the_own_word_of_a_controller_on_its_limits_meets_no_requirement() {
    let folder = folder("pitch-hold");
    build(folder.path(), "", "", "");
    let requirements = "[[requirement]]\nmeasure = \"saturated_pct\"\nmost = 50.0\n";
    std::fs::write(folder.path().join("r.toml"), requirements).expect("a file");
    let asked = ["verify", "s.toml", "--library", "x.so", "--requirements", "r.toml"];
    let output = fspid(&asked, folder.path());
    let told = text(&output.stdout);
    assert_eq!(code(&output), 1, "{told}");
    assert!(told.contains("its own word of what they cut is no measure"), "{told}");
}

#[test]
fn a_margin_that_ends_with_a_crash_says_so() {
    let folder = folder("pitch-hold");
    let crash = "} if (fabs(answer->command_rad) > 0.2) { abort()";
    build(folder.path(), "", crash, "");
    let output = fspid(&["analyse", "s.toml", "--fly", "--library", "x.so"], folder.path());
    let told = text(&output.stdout);
    assert!(told.contains("(the controller crashed with SIGABRT at t ="), "{told}");
}

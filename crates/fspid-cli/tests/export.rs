//! Exports: which folders are written into, what code is called, and what is refused.

use std::fs;
use std::path::Path;

use crate::common::{code, fspid, json, text};

/// A folder with the scenario that `init` writes.
fn started() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    assert_eq!(code(&fspid(&["init", "pitch.toml"], folder.path())), 0);
    folder
}

/// The exit code of an export, and what it tells people.
fn exported(folder: &Path, options: &str) -> (i32, String) {
    let mut all = vec!["export", "pitch.toml", "--controller", "FSPID", "--samples", "40"];
    all.extend(options.split_whitespace().map(|it| if it == "NOTHING" { "" } else { it }));
    let output = fspid(&all, folder);
    (code(&output), text(&output.stderr))
}

/// An empty name and a file were written over or into, a link to nothing was said to exist, and evidence lay where its code
/// lay.
#[test]
fn what_is_no_folder_of_its_own_is_refused_before_anything_is_written() {
    let folder = started();
    let folder = folder.path();
    fs::write(folder.join("afile"), "mine").expect("written");
    fs::create_dir(folder.join("full")).expect("a folder");
    fs::write(folder.join("full/fspid.c"), "mine").expect("written");
    #[cfg(unix)]
    std::os::unix::fs::symlink("nothing", folder.join("link")).expect("a link");
    for (options, words) in [
        ("--to c --out NOTHING", "a name is needed"),
        ("--to c --out afile", "--out needs a folder, and afile is a file"),
        ("--to c --out afile/below", "--out needs a folder"),
        #[cfg(unix)]
        ("--to c --out link", "a link to nothing"),
        ("--to c --out full", "full is not empty"),
        ("--to c --out new --evidence full", "full is not empty"),
        ("--to c --out new --evidence new", "needs a folder of its own"),
        ("--to c --out pack/code --evidence ./pack", "needs a folder of its own"),
        ("--to c --out new --evidence NOTHING", "a name is needed"),
    ] {
        let (code, told) = exported(folder, options);
        assert!(code == 2 && told.contains(words), "{options}: {code} {told}");
    }
    assert_eq!(fs::read_to_string(folder.join("full/fspid.c")).expect("a file"), "mine");
    assert!(!folder.join("new").exists() && !folder.join("pack").exists());
    assert_eq!(exported(folder, "--to c --out full --force").0, 0);
    // What the script of an earlier pack found would stand beside the README of another design.
    let pack = "--to c --out full --evidence pack --force";
    fs::create_dir_all(folder.join("pack/results")).expect("a folder");
    let (code, told) = exported(folder, pack);
    assert!(code == 2 && told.contains("results holds what the script"), "{code} {told}");
    let left = fs::read_dir(folder.join("full")).expect("listed").flatten();
    assert!(left.into_iter().all(|it| !it.file_name().to_string_lossy().starts_with('.')));
}

/// "A b" and "a-B" were both `a_b`; the error listed "PID, PID, own gains" of two controllers.
#[test]
fn controllers_of_a_scenario_are_told_apart_in_code_and_in_words() {
    let folder = started();
    let folder = folder.path();
    let scenario = fs::read_to_string(folder.join("pitch.toml")).expect("a scenario");
    let renamed = scenario.replace("\"FSPID\"", "\"a-B\"").replace("\"PID\"", "\"A b, c\"");
    fs::write(folder.join("pitch.toml"), &renamed).expect("written");
    let told = text(&fspid(&["export", "pitch.toml", "--to", "c", "--out", "x"], folder).stderr);
    assert!(told.contains("flies `A b, c`, a-B"), "{told}");
    let renamed = renamed.replace("A b, c", "A b");
    fs::write(folder.join("pitch.toml"), renamed).expect("written");
    for (name, more, prefix) in
        [("A b", &[][..], "a_b"), ("a-B", &[], "a_b_2"), ("a-B", &["--prefix", "second"], "second")]
    {
        let words = ["export", "pitch.toml", "--to", "c", "--samples", "9", "--format", "json"];
        let words = [&words[..], &["--controller", name, "--out", prefix], more].concat();
        let answer = json(&fspid(&words, folder));
        assert_eq!(answer["prefix"], prefix);
        assert!(folder.join(prefix).join(format!("{prefix}.c")).exists());
    }
    let wrong = ["export", "pitch.toml", "--to", "c", "--out", "x", "--prefix", "My check"];
    let told = text(&fspid(&wrong, folder).stderr);
    assert!(told.contains("`my_check_controller` is"), "{told}");
}

#[test]
fn what_a_target_has_no_use_for_is_refused() {
    let folder = started();
    let folder = folder.path();
    let long = "a".repeat(300);
    for (options, words) in [
        ("--to table --numbers double", "32 and 16 bits"),
        ("--to table --angles degrees", "the supervisor's own units"),
        (&format!("--to c --prefix {long}"), "too long for a file"),
        (&format!("--to matlab --prefix {}", &long[..60]), "allowed are 46 letters"),
        ("--to c --set controller.FSPID.supervisor.defuzzifier=\"vertices:26\"", "--to rust alone"),
    ] {
        let (code, told) = exported(folder, &format!("{options} --out x"));
        assert!(code == 2 && told.contains(words), "{options}: {code} {told}");
        assert!(!folder.join("x").exists(), "{options}");
    }
    let vertices =
        "--to rust --set controller.FSPID.supervisor.defuzzifier=\"vertices:26\" --out r";
    let (code, told) = exported(folder, vertices);
    assert_eq!(code, 0, "{told}");
    assert_eq!(exported(folder, "--to table --points 7 --out t").0, 0);
    let header = fs::read_to_string(folder.join("t/fspid_table.h")).expect("a header");
    assert!(header.contains("numbers of 32 and 16 bits, in its own units."), "{header}");
}

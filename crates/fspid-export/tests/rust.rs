//! The constant that is written in Rust compiles and answers what the controller answers, bit for bit.

use std::path::{Path, PathBuf};
use std::process::Command;

use fspid_core::Controller;
use fspid_export::vectors::vectors;
use fspid_export::write::{Heading, rust, rust_harness};
use fspid_export::{Angles, precision_of};
use fspid_numeric::Real;
use proptest::prelude::*;

/// The library that this test was built with, and the folder of what it needs in turn.
fn library() -> (PathBuf, PathBuf) {
    let this = std::env::current_exe().expect("this test");
    let folder = this.parent().expect("the folder of built crates").to_owned();
    let is_meant = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        name.starts_with("libfspid_core-") && name.ends_with(".rlib")
    };
    let built = folder.read_dir().expect("readable").map(|entry| entry.expect("a file").path());
    // Older ones may be of older sources.
    let age = |path: &PathBuf| path.metadata().and_then(|it| it.modified()).expect("a file");
    (built.filter(is_meant).max_by_key(age).expect("this test needs it"), folder)
}

fn compiled(folder: &Path) -> std::process::Output {
    let (core, needed) = library();
    Command::new(option_env!("RUSTC").unwrap_or("rustc"))
        .args(["--edition", "2024", "-D", "warnings", "--crate-type", "bin", "-o", "check"])
        .arg("--extern")
        .arg(format!("fspid_core={}", core.display()))
        .arg("-L")
        .arg(format!("dependency={}", needed.display()))
        .arg("pitch_check.rs")
        .current_dir(folder)
        .output()
        .expect("the compiler that built this test")
}

fn written<R: Real>(controller: &Controller<R>, angles: Angles, folder: &Path) -> String {
    let heading = Heading {
        name: "pitch",
        digest: "0",
        precision: precision_of::<R>(),
        angles: Some(angles),
        elevator: None,
    };
    let vectors = vectors(controller, angles, 1, 400);
    let check = rust_harness(controller, "pitch", &heading, &vectors);
    std::fs::write(folder.join("pitch_check.rs"), check).expect("a temporary file");
    let text = rust(controller, &heading);
    std::fs::write(folder.join("pitch.rs"), &text).expect("a temporary file");
    text
}

fn run<R: Real>(controller: &Controller<R>, angles: Angles, folder: &Path) -> String {
    let text = written(controller, angles, folder);
    let built = compiled(folder);
    assert!(built.status.success(), "{text}\n{}", String::from_utf8_lossy(&built.stderr));
    let ran = Command::new(folder.join("check")).output().expect("what was built");
    String::from_utf8_lossy(&ran.stdout).into_owned()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4, max_shrink_iters: 4, ..ProptestConfig::default() })]

    #[test]
    fn the_constant_of_any_controller_answers_as_the_controller_without_a_warning(
        controller in fspid_options::any_controller(),
        degrees in any::<bool>(),
    ) {
        let angles = if degrees { Angles::Degrees } else { Angles::Radians };
        let folder = tempfile::tempdir().expect("a temporary folder");
        prop_assert_eq!(run(&controller, angles, folder.path()), "400 samples, 0 different\n");
        if let Ok(single) = controller.rounded::<f32>() {
            prop_assert_eq!(run(&single, angles, folder.path()), "400 samples, 0 different\n");
        }
    }
}

#[test]
fn a_constant_with_a_period_below_zero_does_not_compile() {
    let gains = fspid_core::Gains { kp: 2.0, ki: 0.5, kd: 1.0 };
    let config = fspid_core::PidConfig::sampled_every(0.01);
    let pid = fspid_core::Pid::new(gains, config).expect("plain settings");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let text = written(&Controller::Fixed(pid), Angles::Radians, folder.path());
    let edited = text.replace("positive(0.01)", "positive(-0.01)");
    assert_ne!(text, edited);
    std::fs::write(folder.path().join("pitch.rs"), edited).expect("a temporary file");
    let built = compiled(folder.path());
    assert!(!built.status.success());
    assert!(String::from_utf8_lossy(&built.stderr).contains("assertion failed: value > 0.0"));
}

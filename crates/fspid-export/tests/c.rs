//! The C that is written answers what the controller answers, bit for bit.

use std::path::Path;
use std::process::Command;

use fspid_core::Controller;
use fspid_export::vectors::eventful;
use fspid_export::write::{Heading, c, c_harness};
use fspid_export::{Angles, program};
use fspid_numeric::Real;
use proptest::prelude::*;

fn run<R: Real>(controller: &Controller<R>, angles: Angles, folder: &Path) -> String {
    let program = program(controller, angles).expect("nothing here is refused");
    let heading = Heading { name: "pitch", digest: "0", precision: program.precision, angles };
    let files = c(&program, "pitch", &heading);
    let vectors = eventful(controller, angles, 1, 3000);
    let harness = c_harness(&program, "pitch", &vectors);
    for (name, text) in
        [("pitch.h", &files.header), ("pitch.c", &files.source), ("main.c", &harness)]
    {
        std::fs::write(folder.join(name), text).expect("a temporary file");
    }
    let built = Command::new("cc")
        .args([
            "-std=c99",
            "-O1",
            "-Wall",
            "-Wextra",
            "-Wconversion",
            "-Wfloat-equal",
            "-Werror",
            "-ffp-contract=off",
        ])
        .args(["pitch.c", "main.c", "-o", "main"])
        .current_dir(folder)
        .output()
        .expect("the compiler that links Rust");
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let ran = Command::new(folder.join("main")).output().expect("what was built");
    String::from_utf8_lossy(&ran.stdout).into_owned()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, max_shrink_iters: 8, ..ProptestConfig::default() })]

    #[test]
    fn the_c_of_any_controller_answers_as_the_controller_without_a_warning(
        controller in fspid_options::any_controller(),
        degrees in any::<bool>(),
    ) {
        let angles = if degrees { Angles::Degrees } else { Angles::Radians };
        let folder = tempfile::tempdir().expect("a temporary folder");
        prop_assert_eq!(run(&controller, angles, folder.path()), "3000 samples, 0 different\n");
        if let Ok(single) = controller.rounded::<f32>() {
            prop_assert_eq!(run(&single, angles, folder.path()), "3000 samples, 0 different\n");
        }
    }
}

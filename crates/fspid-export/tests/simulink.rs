//! The S-function answers what the controller answers, against a stub of Simulink's header.

use std::path::Path;
use std::process::Command;

use fspid_export::program::Precision;
use fspid_export::{Angles, Request, Target, export};
use proptest::prelude::*;

fn run(controller: &fspid_core::Controller<f64>, request: &Request<'_>, folder: &Path) -> String {
    let written = export(controller, request).expect("nothing here is refused");
    for file in written.files {
        std::fs::write(folder.join(&file.name), &file.bytes).expect("a temporary file");
    }
    let stubs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../checks/export/stubs/matlab");
    let number = if request.precision == Precision::Single { "float" } else { "double" };
    let built = Command::new("cc")
        .args(["-std=c99", "-O1", "-Wall", "-Wextra", "-Werror", "-ffp-contract=off"])
        .arg(format!("-DNUMBER={number}"))
        .arg("-I")
        .arg(stubs)
        .args(["pitch_sfun.c", "pitch.c", "-o", "sfun"])
        .current_dir(folder)
        .output()
        .expect("the compiler that links Rust");
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let ran = Command::new(folder.join("sfun")).current_dir(folder).output().expect("built");
    String::from_utf8_lossy(&ran.stdout).into_owned()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3, max_shrink_iters: 4, ..ProptestConfig::default() })]

    #[test]
    fn the_s_function_of_any_controller_answers_as_the_controller_without_a_warning(
        controller in fspid_options::any_controller(),
        is_single in any::<bool>(),
        degrees in any::<bool>(),
    ) {
        let request = Request {
            name: "pitch",
            target: Target::Simulink,
            precision: if is_single { Precision::Single } else { Precision::Double },
            angles: if degrees { Angles::Degrees } else { Angles::Radians },
            samples: 400,
            points: 7,
            digest: "0",
            elevator: None,
            its_loop: None,
            evidence: false,
        };
        let folder = tempfile::tempdir().expect("a temporary folder");
        let said = run(&controller, &request, folder.path());
        prop_assert_eq!(said, "400 samples, 0 different, a sample every 0.01 s\n");
    }
}

//! What holds of the repository as a whole.

use std::fs::read_dir;
use std::path::Path;

/// A file that `all.rs` does not name is not compiled, and its tests are gone without a word.
#[test]
fn every_file_of_integration_tests_is_in_the_binary_of_its_crate() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut named = 0;
    for crate_folder in read_dir(crates).expect("the crates") {
        let tests = crate_folder.expect("a crate").path().join("tests");
        let all = std::fs::read_to_string(tests.join("all.rs")).expect("all.rs");
        for entry in read_dir(&tests).expect("the tests") {
            let path = entry.expect("a file").path();
            let is_module =
                path.extension().is_some_and(|it| it == "rs") || path.join("mod.rs").exists();
            let name = path.file_stem().and_then(|it| it.to_str()).expect("a name");
            if is_module && name != "all" {
                assert!(
                    all.contains(&format!("mod {name};")),
                    "{} is not in all.rs",
                    path.display()
                );
                named += 1;
            }
        }
    }
    assert!(named > 100, "{named}");
}

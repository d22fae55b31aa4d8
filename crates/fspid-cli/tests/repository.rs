//! What holds of the repository as a whole.

use std::fs::read_dir;
use std::path::{Path, PathBuf};

/// A file that `all.rs` does not name is not compiled, and its tests are gone without a word.
#[test]
fn every_file_of_integration_tests_is_in_the_binary_of_its_crate() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut named = 0;
    for crate_folder in read_dir(crates).expect("the crates") {
        let tests = crate_folder.expect("a crate").path().join("tests");
        if !tests.exists() {
            continue;
        }
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

/// Documents of a folder and of all folders in it, but for what is built and hidden.
fn documents(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().and_then(|it| it.to_str()).unwrap_or_default();
        if path.is_dir() && name != "target" && !name.starts_with('.') {
            documents(&path, found);
        } else if path.extension().is_some_and(|it| it == "md") {
            found.push(path);
        }
    }
}

#[test]
fn every_link_from_a_document_to_a_file_leads_to_one() {
    let mut found = Vec::new();
    documents(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../.."), &mut found);
    let mut links = 0;
    for document in &found {
        let text = std::fs::read_to_string(document).expect("a text");
        for link in text.split("](").skip(1) {
            let target = link.split([')', '#', ' ']).next().unwrap_or_default();
            if target.is_empty() || target.contains("://") {
                continue;
            }
            let file = document.parent().expect("a folder").join(target);
            assert!(file.exists(), "{}: {target}", document.display());
            links += 1;
        }
    }
    assert!(found.len() > 30 && links > 100, "{} documents, {links} links", found.len());
}

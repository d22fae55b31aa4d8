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
        // Tests of the Python package are Python.
        if !tests.exists() || tests.join("conftest.py").exists() {
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

pub(crate) fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Folders whose content is built or fetched.
const NOT_OURS: [&str; 4] = ["target", "out", "node_modules", "dist"];

/// Files with an ending in a folder and in all folders in it, but for what is not ours, hidden or a symbolic link.
pub(crate) fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().and_then(|it| it.to_str()).unwrap_or_default();
        if path.is_symlink() || NOT_OURS.contains(&name) || name.starts_with('.') {
            continue;
        }
        if path.is_dir() {
            found.extend(files(&path, ending));
        } else if path.extension().is_some_and(|it| it == ending) {
            found.push(path);
        }
    }
    found
}

/// Where the links of a document lead, those to other places than files left out.
pub(crate) fn links(document: &Path) -> Vec<PathBuf> {
    let text = std::fs::read_to_string(document).expect("a text");
    let targets = text.split("](").skip(1).map(|it| it.split([')', '#', ' ']).next());
    let files = targets.flatten().filter(|it| !it.is_empty() && !it.contains("://"));
    files.map(|it| document.parent().expect("a folder").join(it)).collect()
}

#[test]
fn every_link_from_a_document_to_a_file_leads_to_one() {
    let found = files(&repository(), "md");
    let mut count = 0;
    for document in &found {
        for file in links(document) {
            assert!(file.exists(), "{}: {}", document.display(), file.display());
            count += 1;
        }
    }
    assert!(found.len() > 30 && count > 100, "{} documents, {count} links", found.len());
}

/// A page that the summary does not name is not in the book.
#[test]
fn the_summary_of_the_guide_names_each_page_once() {
    let guide = repository().join("docs/guide");
    let summary = guide.join("SUMMARY.md");
    let mut named = links(&summary);
    let mut pages = files(&guide, "md");
    pages.retain(|page| *page != summary);
    named.sort();
    pages.sort();
    assert_eq!(named, pages);
}

/// Names in a document that look like tests: words joined by underscores, between backticks.
fn named_tests(document: &str) -> Vec<String> {
    let text = std::fs::read_to_string(repository().join(document)).expect("a text");
    let words = text.split('`').skip(1).step_by(2);
    let is_test = |it: &&str| {
        it.matches('_').count() >= 3
            && it.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
    };
    words.filter(is_test).map(str::to_owned).collect()
}

#[test]
fn every_test_that_holds_an_erratum_or_the_cockpits_security_is_there() {
    let mut sources = String::new();
    for file in files(&repository().join("crates"), "rs") {
        sources += &std::fs::read_to_string(file).expect("a source");
    }
    for document in ["docs/errata.md", "docs/guide/cockpit.md"] {
        let named = named_tests(document);
        assert!(named.len() > 10, "{document}: {named:?}");
        for name in named {
            assert!(sources.contains(&format!("fn {name}()")), "{document}: no test {name}");
        }
    }
}

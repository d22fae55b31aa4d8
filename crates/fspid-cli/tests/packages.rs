//! Every crate can be packaged alone: its texts lie in its folder, and its manifest says what a registry asks.

use std::fs::read_to_string;
use std::path::{Path, PathBuf};

use crate::repository::{files, links, repository};

/// Folders of all packages of the workspace.
fn packages() -> Vec<PathBuf> {
    let crates = std::fs::read_dir(repository().join("crates")).expect("the crates");
    let crates = crates.map(|it| it.expect("a crate").path());
    crates.chain([repository().join("data")]).collect()
}

#[test]
fn every_package_has_what_a_registry_asks() {
    let packages = packages();
    for package in &packages {
        let manifest = read_to_string(package.join("Cargo.toml")).expect("a manifest");
        for key in ["description = ", "keywords = ", "categories = ", "readme = \"README.md\""] {
            assert!(manifest.contains(key), "{}: no {key}", package.display());
        }
        for key in ["version", "edition", "rust-version", "license", "authors"] {
            let line = format!("{key}.workspace = true");
            assert!(manifest.contains(&line), "{}: no {line}", package.display());
        }
        for file in ["README.md", "LICENSE-MIT", "LICENSE-APACHE"] {
            let text = read_to_string(package.join(file)).unwrap_or_default();
            assert!(text.len() > 200, "{}: {file}", package.display());
        }
    }
    assert!(packages.len() > 14, "{}", packages.len());
}

/// The front page is the README, so that its example runs with the tests of the documentation.
#[test]
fn every_library_begins_with_its_readme_and_says_what_is_absent() {
    for package in packages() {
        let roots = [package.join("src/lib.rs"), package.join("lib.rs")];
        let Some(text) = roots.iter().find_map(|it| read_to_string(it).ok()) else { continue };
        let name = package.display();
        let manifest = read_to_string(package.join("Cargo.toml")).expect("a manifest");
        if manifest.contains("crate-type = [\"cdylib\"]") {
            // Its front page is that of the Python package around it.
            let readme = read_to_string(package.join("README.md")).expect("a readme");
            assert!(readme.contains("```python\n"), "{name}: no example");
            continue;
        }
        assert!(text.starts_with("#![doc = include_str!(\""), "{name}");
        assert!(text.contains("Not here:") || text.contains("Not for "), "{name}");
        let readme = read_to_string(package.join("README.md")).expect("a readme");
        assert!(readme.contains("```rust\n"), "{name}: no example");
    }
}

/// Errata and assumptions named `claims.md`, which was not packed with them.
#[test]
fn documents_that_are_packed_with_the_data_lead_to_files() {
    let documents = repository().join("data/documents");
    let mut count = 0;
    for name in ["assumptions.md", "claims.md", "errata.md"] {
        for file in links(&documents.join(name)) {
            assert!(file.exists(), "{name}: {}", file.display());
            count += 1;
        }
    }
    assert!(count > 10, "{count}");
}

/// A library that includes a text from beside its folder builds here and nowhere else.
#[test]
fn no_library_includes_a_text_from_beside_its_package() {
    let mut included = 0;
    for package in packages() {
        for source in files(&package, "rs") {
            let from = source.strip_prefix(&package).expect("below");
            let text = read_to_string(&source).expect("a source");
            // Modules of tests stand at the foot of a file, or in files of their own.
            let text = text.split("#[cfg(test)]").next().unwrap_or_default();
            if is_test(from) {
                continue;
            }
            for call in text.split("include_").skip(1) {
                let path = call.split('"').nth(1).unwrap_or_default();
                let depth = from.components().count() - 1;
                let up = path.split('/').filter(|part| *part == "..").count();
                assert!(up <= depth, "{}: {path}", source.display());
                included += 1;
            }
        }
    }
    assert!(included > 15, "{included}");
}

fn is_test(path: &Path) -> bool {
    let name = path.to_string_lossy();
    name.starts_with("tests") || name.starts_with("benches") || name.contains("tests.rs")
}

/// Packages outside of the workspace are built by hand: a target of the fuzzer named a crate that its module had left.
#[test]
fn packages_outside_of_the_workspace_name_the_crates_that_they_use() {
    let mut used = 0;
    for folder in ["fuzz", "checks/no-panic", "checks/firmware", "checks/peers"] {
        let package = repository().join(folder);
        let manifest = read_to_string(package.join("Cargo.toml")).expect("a manifest");
        for source in files(&package, "rs") {
            let text = read_to_string(&source).expect("a source");
            for part in text.split("fspid_").skip(1) {
                let Some((name, _)) = part.split_once("::") else { continue };
                if !name.chars().all(|c| c.is_ascii_lowercase()) {
                    continue;
                }
                let named = manifest.contains(&format!("fspid-{name} = "));
                assert!(named, "{}: fspid-{name}", source.display());
                used += 1;
            }
        }
    }
    assert!(used > 5, "{used}");
}

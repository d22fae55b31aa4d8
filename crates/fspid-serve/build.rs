//! Puts the page of the cockpit into the crate, if it was built.
//!
//! It is looked for where `web/build.sh` writes it, or in the folder that `FSPID_WEB_DIST` names.

use std::fs;
use std::path::{Path, PathBuf};

fn main() {
    println!("cargo::rerun-if-env-changed=FSPID_WEB_DIST");
    println!("cargo::rerun-if-changed=build.rs");
    let dist = dist();
    // The folder is there in every clone: a path that is not there would have the crate built again each time.
    if dist.is_dir() {
        println!("cargo::rerun-if-changed={}", dist.display());
    }
    let site = files(&dist.join("site"), "")
        .into_iter()
        .map(|(name, path)| format!("    ({name:?}, include_bytes!({path:?}).as_slice()),\n"));
    let whole = dist.join("page.html");
    let whole = match whole.is_file() {
        true => format!("Some(include_bytes!({whole:?}).as_slice())"),
        false => "None".to_owned(),
    };
    let text = format!(
        "/// Every file of the page, by its name.\nstatic SITE: &[(&str, &[u8])] = &[\n{}];\n/// The page as one file.\nstatic WHOLE: Option<&[u8]> = {whole};\n",
        site.collect::<String>()
    );
    let out = std::env::var_os("OUT_DIR").map(PathBuf::from).expect("cargo sets it");
    fs::write(out.join("page.rs"), text).expect("the folder of the build can be written");
}

fn dist() -> PathBuf {
    let named = std::env::var_os("FSPID_WEB_DIST").map(PathBuf::from);
    let here = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from).expect("cargo sets it");
    named.unwrap_or_else(|| here.join("../../web/dist"))
}

/// The files below a folder with their names there, in the order of the names; none where there is no folder.
fn files(folder: &Path, above: &str) -> Vec<(String, PathBuf)> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut found: Vec<(String, PathBuf)> = Vec::new();
    for entry in entries {
        let name = format!("{above}{}", entry.file_name().to_string_lossy());
        let path = entry.path();
        match path.is_dir() {
            true => found.extend(files(&path, &format!("{name}/"))),
            false => found.push((name, path.canonicalize().expect("it was listed"))),
        }
    }
    found.sort();
    found
}

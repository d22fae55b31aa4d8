//! Tells the program which commit it is built from, for which machine, and by which compiler.

use std::path::Path;
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let compiler = std::env::var("RUSTC").ok().and_then(|rustc| said(&rustc, &["--version"]));
    let compiler = compiler.unwrap_or_else(|| "an unknown compiler".to_owned());
    let target = std::env::var("TARGET").expect("cargo sets it");
    println!("cargo::rustc-env=FSPID_COMMIT={}", commit());
    println!("cargo::rustc-env=FSPID_TARGET={target}");
    println!("cargo::rustc-env=FSPID_COMPILER={compiler}");
}

/// The commit in words: of a package the one that it was packed from, else that of the clone, where there is one.
fn commit() -> String {
    let packed = std::fs::read_to_string(".cargo_vcs_info.json").unwrap_or_default();
    if let Some(hash) = packed.split('"').find(|it| it.len() == 40 && hexadecimal(it)) {
        return format!("commit {}", &hash[..12]);
    }
    // Each commit and each change of branch adds a line there.
    if let Some(log) = said("git", &["rev-parse", "--git-path", "logs/HEAD"])
        && Path::new(&log).exists()
    {
        println!("cargo::rerun-if-changed={log}");
    }
    match said("git", &["rev-parse", "--short=12", "HEAD"]) {
        Some(hash) if hexadecimal(&hash) => {
            let changes = said("git", &["status", "--porcelain", "--untracked-files=no"]);
            let changed = changes.is_none_or(|changes| !changes.is_empty());
            format!("commit {hash}{}", if changed { " and changes" } else { "" })
        }
        _ => "of no known commit".to_owned(),
    }
}

fn hexadecimal(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_hexdigit())
}

/// What a program prints, if it is there and content.
fn said(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    let text = output.status.success().then(|| String::from_utf8(output.stdout).ok())??;
    Some(text.trim().to_owned())
}

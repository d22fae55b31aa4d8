//! The C compiler of the machine at hand: the only program that this crate runs.

use std::path::Path;
use std::process::Command;

use crate::file::File;

/// Products and sums are rounded one by one; no path, date or name of a build is kept in the library.
const FLAGS: [&str; 10] = [
    "-std=c99",
    "-O2",
    "-ffp-contract=off",
    "-fPIC",
    "-shared",
    "-fvisibility=hidden",
    "-ffunction-sections",
    "-s",
    "-Wl,--gc-sections",
    "-Wl,--build-id=none",
];
/// The linker of macOS knows the last three by other names.
const FLAGS_ELSEWHERE: usize = 7;

/// A shared library of these sources, or a sentence why there is none.
pub(crate) fn shared_library(files: &[File], sources: &[String]) -> Result<Vec<u8>, String> {
    let folder = tempfile::tempdir().map_err(|error| format!("no temporary folder: {error}"))?;
    for file in files {
        std::fs::write(folder.path().join(&file.name), &file.bytes)
            .map_err(|error| format!("the temporary folder cannot be written: {error}"))?;
    }
    built(folder.path(), sources)
}

fn built(folder: &Path, sources: &[String]) -> Result<Vec<u8>, String> {
    let compiler = std::env::var("CC").ok().filter(|named| !named.trim().is_empty());
    let compiler = compiler.unwrap_or_else(|| "cc".to_owned());
    // As make has it, the variable may hold options behind the program.
    let mut words = compiler.split_whitespace();
    let program = words.next().unwrap_or("cc");
    let flags = if cfg!(target_os = "linux") { &FLAGS[..] } else { &FLAGS[..FLAGS_ELSEWHERE] };
    let mut command = Command::new(program);
    command.args(words).args(flags).args(["-I.", "-o", "library"]).args(sources);
    let ran = command
        .current_dir(folder)
        .output()
        .map_err(|error| format!("the C compiler `{program}` does not start: {error}"))?;
    if !ran.status.success() {
        let said = String::from_utf8_lossy(&ran.stderr);
        let line = said.lines().find(|line| line.contains("error")).unwrap_or("no reason given");
        return Err(format!("the C compiler `{program}` refused the sources: {line}"));
    }
    std::fs::read(folder.join("library")).map_err(|error| format!("no library was built: {error}"))
}

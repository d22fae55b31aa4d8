//! Files that are read whole, standard input among them.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;
use std::sync::OnceLock;

use crate::apart;
use crate::keyed::document::FILE_LIMIT;

/// Why a file could not be read, in the same words everywhere.
#[must_use]
pub fn unread_in_words(reason: &std::io::Error) -> String {
    match reason.kind() {
        std::io::ErrorKind::NotFound => "there is no such file".to_owned(),
        std::io::ErrorKind::PermissionDenied => "it may not be read".to_owned(),
        std::io::ErrorKind::IsADirectory => "it is a folder".to_owned(),
        _ => reason.to_string(),
    }
}

/// The name that stands for standard input.
pub const STANDARD_INPUT: &str = "-";

/// What standard input holds. It is read once, for a scenario is asked for again and again.
fn standard_input() -> Result<Vec<u8>, String> {
    static READ: OnceLock<Result<Vec<u8>, String>> = OnceLock::new();
    let read = || {
        let mut bytes = Vec::new();
        let mut limited = std::io::stdin().lock().take(FILE_LIMIT + 1);
        limited.read_to_end(&mut bytes).map_err(|error| unread_in_words(&error))?;
        match bytes.len() as u64 > FILE_LIMIT {
            true => Err(format!("it is larger than {} MiB", FILE_LIMIT / (1024 * 1024))),
            false => Ok(bytes),
        }
    };
    READ.get_or_init(read).clone()
}

/// Largest program, in bytes: what is made by a compiler is larger than what people write.
const PROGRAM_LIMIT: u64 = 64 * 1024 * 1024;

/// The bytes of a regular file that is not too large.
pub fn read_regular(path: &Path) -> Result<Vec<u8>, String> {
    read_within(path, FILE_LIMIT)
}

/// The same of a library or an FMU.
pub(crate) fn read_program(path: &Path) -> Result<Vec<u8>, String> {
    read_within(path, PROGRAM_LIMIT)
}

/// Opens a regular file; of anything else, such as a pipe, one would wait for somebody who writes.
///
/// # Errors
/// A file that cannot be opened, and what is none.
pub fn open_regular(path: &Path) -> std::io::Result<File> {
    let metadata = std::fs::metadata(path)?;
    match metadata.is_file() {
        true => File::open(path),
        false => Err(std::io::Error::other("it is no regular file")),
    }
}

/// The text of a file that the program itself has written and may write anew, such as a state.
///
/// # Errors
/// As [`open_regular`]; a file that is not UTF-8, and one that was asked to be written.
pub fn read_own(path: &Path) -> std::io::Result<String> {
    let mut text = String::new();
    let mut file = open_regular(path)?;
    apart::reading_own(path).map_err(std::io::Error::other)?;
    file.read_to_string(&mut text)?;
    Ok(text)
}

fn read_within(path: &Path, limit: u64) -> Result<Vec<u8>, String> {
    let reason = |error: std::io::Error| unread_in_words(&error);
    if path == Path::new(STANDARD_INPUT) {
        return standard_input();
    }
    let file = open_regular(path).map_err(reason)?;
    apart::reading(path).map_err(|clash| clash.to_string())?;
    let metadata = file.metadata().map_err(reason)?;
    let too_large = || format!("it is larger than {} MiB", limit / (1024 * 1024));
    if metadata.len() > limit {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    let mut limited = file.take(limit + 1);
    limited.read_to_end(&mut bytes).map_err(reason)?;
    if bytes.len() as u64 > limit {
        return Err(too_large());
    }
    Ok(bytes)
}

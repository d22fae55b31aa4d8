//! Files that are read whole, standard input among them.

use std::io::Read as _;
use std::path::Path;
use std::sync::OnceLock;

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

fn read_within(path: &Path, limit: u64) -> Result<Vec<u8>, String> {
    let reason = |error: std::io::Error| unread_in_words(&error);
    if path == Path::new(STANDARD_INPUT) {
        return standard_input();
    }
    let metadata = std::fs::metadata(path).map_err(reason)?;
    if !metadata.is_file() {
        return Err("it is no regular file".to_owned());
    }
    let too_large = || format!("it is larger than {} MiB", limit / (1024 * 1024));
    if metadata.len() > limit {
        return Err(too_large());
    }
    let file = std::fs::File::open(path).map_err(reason)?;
    let mut bytes = Vec::new();
    let mut limited = file.take(limit + 1);
    limited.read_to_end(&mut bytes).map_err(reason)?;
    if bytes.len() as u64 > limit {
        return Err(too_large());
    }
    Ok(bytes)
}

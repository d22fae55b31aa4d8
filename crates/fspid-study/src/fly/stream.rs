//! The conversation itself, over any pair of streams.

use std::io::{self, BufRead, Write};

use super::line::LONGEST_LINE;
use super::pilot::Pilot;
use fspid_diagnostics::lines;

/// Why a conversation ended before its input.
#[derive(Debug, thiserror::Error)]
pub enum StreamError {
    /// No more lines could be read.
    #[error("cannot be read: {0}")]
    Reading(io::Error),
    /// The answers could not be written.
    #[error("cannot be written: {0}")]
    Writing(io::Error),
}

/// Answers every line as it comes until the input ends. An answer is on its way before anything is
/// told about it, and before the next line is waited for. Memory does not grow with the input.
///
/// # Errors
/// [`StreamError`].
pub fn fly(
    pilot: &mut Pilot,
    input: &mut impl BufRead,
    output: &mut impl Write,
    mut tell: impl FnMut(&str),
) -> Result<(), StreamError> {
    let (mut line, mut text) = (Vec::new(), String::new());
    while next_line(input, &mut line).map_err(StreamError::Reading)? {
        if let Some(answer) = pilot.answer(&line) {
            text.clear();
            lines::line(&mut text, format_args!("{answer}"));
            let written = output.write_all(text.as_bytes()).and_then(|()| output.flush());
            written.map_err(StreamError::Writing)?;
        }
        pilot.take_notes().iter().for_each(|note| tell(note));
    }
    Ok(())
}

/// Reads the next line, of one that is too long only as much as shows that; false at the end.
fn next_line(input: &mut impl BufRead, line: &mut Vec<u8>) -> io::Result<bool> {
    line.clear();
    let most = LONGEST_LINE + 1;
    let read = io::Read::take(&mut *input, most as u64).read_until(b'\n', line)?;
    if read == most && line.last() != Some(&b'\n') {
        input.skip_until(b'\n')?;
    }
    Ok(read > 0)
}

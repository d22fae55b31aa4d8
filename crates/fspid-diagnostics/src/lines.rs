//! Answers for a terminal, line by line.

use std::fmt::{Arguments, Write as _};

/// Adds a line: `line(&mut out, format_args!(…))`.
pub fn line(out: &mut String, text: Arguments<'_>) {
    add(out, text);
    out.push('\n');
}

/// Adds to the last line.
pub fn add(out: &mut String, text: Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = out.write_fmt(text);
}

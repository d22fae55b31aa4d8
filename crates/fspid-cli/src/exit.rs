//! How a command ends: exit codes, messages, and writing to standard output.
//!
//! With `--format json` standard output holds exactly one JSON object: the answer, or, where there is none, what went
//! wrong. Standard error holds words for people in any case.

use std::borrow::Cow;
use std::fmt::Display;
use std::io::{self, IsTerminal as _, Write as _};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use fspid_diagnostics::digits::counted;
use fspid_scenario::file::LoadError;
use fspid_study::json::with_null_reasons;
use fspid_study::output::OutputError;
use serde_json::{Value, json};

use crate::stream::Stream;

/// Version of the shape of an error as JSON.
const SCHEMA: u32 = 1;

/// Whether answers and errors are JSON.
static AS_JSON: AtomicBool = AtomicBool::new(false);
/// Whether standard output is a file that an option names `-`; answers go to standard error then.
static IS_FILE: AtomicBool = AtomicBool::new(false);
/// Whether an answer was printed.
static ANSWERED: AtomicBool = AtomicBool::new(false);

/// Why the program stops early; None where it is the user who wants it.
static REASON: Mutex<Option<String>> = Mutex::new(None);

/// Says why the program stops early, where it is not the user who wants it.
pub(crate) fn stops_for(reason: String) {
    if let Ok(mut told) = REASON.lock() {
        *told = Some(reason);
    }
}

/// Why the program stops early, where it is not the user who wants it.
pub(crate) fn reason() -> Option<String> {
    REASON.lock().ok().and_then(|told| told.clone())
}

/// What standard output is used for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Output {
    /// Answers and errors are JSON.
    pub(crate) as_json: bool,
    /// It is a file that an option names `-`.
    pub(crate) is_file: bool,
}

impl Output {
    /// Holds for all that is printed from here on.
    pub(crate) fn set(self) {
        AS_JSON.store(self.as_json, Ordering::Relaxed);
        IS_FILE.store(self.is_file, Ordering::Relaxed);
    }
}

/// Why a command did not end well.
#[derive(Debug)]
pub(crate) struct Failure {
    code: u8,
    message: String,
    /// What stands before the message.
    name: &'static str,
    /// Every problem of a file with its place.
    problems: Option<Value>,
}

/// Why keys of a problem are null.
const NULLS: [(&str, &str); 4] = [
    ("origin", "it stands in the file itself"),
    ("line", "the file is meant as a whole"),
    ("column", "the file is meant as a whole"),
    ("found", "no single value is wrong"),
];

impl Failure {
    /// A requirement or claim check was not met.
    pub(crate) const NOT_MET: u8 = 1;
    /// The input is wrong.
    pub(crate) const INPUT: u8 = 2;
    /// The output could not be written.
    pub(crate) const OUTPUT: u8 = 4;
    /// Interrupted by the user, as shells say it, or by what `--max-memory` allows.
    pub(crate) const INTERRUPTED: u8 = 130;

    fn new(code: u8, message: impl Display) -> Self {
        let message = message.to_string();
        // A list of located problems begins with its first place, so that editors can jump there.
        let name = if message.trim_end().contains('\n') { "" } else { "fspid: " };
        Self { code, message, name, problems: None }
    }

    /// A requirement or claim check that was not met.
    pub(crate) fn not_met(message: impl Display) -> Self {
        Self::new(Self::NOT_MET, message)
    }

    /// Requirements that are not met, of so many, and flights that failed; one of both is.
    pub(crate) fn not_met_of(unmet: usize, count: usize, flights: usize) -> Self {
        let requirements =
            (unmet > 0).then(|| format!("{unmet} of {} not met", counted(count, "requirement")));
        let flights = (flights > 0).then(|| format!("{} failed", counted(flights, "flight")));
        let words: Vec<String> = requirements.into_iter().chain(flights).collect();
        Self::not_met(words.join(", "))
    }

    /// Input that cannot be used.
    pub(crate) fn input(message: impl Display) -> Self {
        Self::new(Self::INPUT, message)
    }

    /// A command line that cannot be used.
    pub(crate) fn usage(message: impl Display) -> Self {
        Self { name: "fspid: ", ..Self::new(Self::INPUT, message) }
    }

    /// The help of the program in place of an answer.
    pub(crate) fn plain(message: impl Display) -> Self {
        Self { name: "", ..Self::new(Self::INPUT, message) }
    }

    /// A scenario that cannot be used, with every problem in it.
    pub(crate) fn load(error: LoadError) -> Self {
        let problems = match &error {
            LoadError::Problems(problems) => Some(problems.to_json()),
            LoadError::Unreadable { .. } => None,
        };
        Self { problems, ..Self::input(error) }
    }

    /// Input, of which problems are known where it is a scenario's.
    pub(crate) fn of_input(message: impl Display, problems: Option<Value>) -> Self {
        Self { problems, ..Self::input(message) }
    }

    /// Output that cannot be written.
    pub(crate) fn output(message: impl Display) -> Self {
        Self::new(Self::OUTPUT, message)
    }

    /// Work that the user has interrupted, or its memory, and how it goes on.
    pub(crate) fn interrupted(message: impl Display) -> Self {
        match reason() {
            Some(reason) => Self::new(Self::INTERRUPTED, format_args!("{reason}: {message}")),
            None => Self::new(Self::INTERRUPTED, message),
        }
    }

    /// Standard output that cannot be written; a reader that has gone away is no failure.
    pub(crate) fn of_writing(error: &io::Error) -> Result<(), Self> {
        if error.kind() == io::ErrorKind::BrokenPipe {
            return Ok(());
        }
        Err(Self::output(format_args!("cannot write to standard output: {error}")))
    }

    pub(crate) fn code(&self) -> u8 {
        self.code
    }

    /// Tells people, and programs where there is no answer; a closed stream is no reason to fail differently.
    pub(crate) fn tell(&self) {
        let message = self.message.trim_end();
        if AS_JSON.load(Ordering::Relaxed) && !ANSWERED.load(Ordering::Relaxed) {
            let _ = print(&format!("{:#}\n", self.json()));
        }
        if !message.is_empty() {
            note(format_args!("{}{message}", self.name));
        }
    }

    /// `{"schema": 1, "error": {"code": 2, "kind": "input", "message": "…", "problems": {…}}}`
    fn json(&self) -> Value {
        let kind = match self.code {
            Self::NOT_MET => "not met",
            Self::OUTPUT => "output",
            Self::INTERRUPTED => "interrupted",
            _ => "input",
        };
        let message = self.message.trim_end();
        let mut error = json!({ "code": self.code, "kind": kind, "message": message });
        if let Some(problems) = &self.problems {
            error["problems"] = problems.clone();
        }
        with_null_reasons(json!({ "schema": SCHEMA, "error": error }), &NULLS)
    }
}

impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Self {
        match error.reason.kind() {
            // The reader of a file that is `-` has gone away, as with `| head`.
            io::ErrorKind::BrokenPipe => Self::new(0, ""),
            _ if error.is_clash() => Self::input(error),
            _ => Self::output(error),
        }
    }
}

/// Writes data to standard output. A reader that has gone away (`| head`) is no failure.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    ANSWERED.store(true, Ordering::Relaxed);
    let stream = if IS_FILE.load(Ordering::Relaxed) { Stream::Error } else { Stream::Output };
    if stream.is_input() {
        return Ok(());
    }
    if stream == Stream::Error {
        let _ = io::stderr().write_all(text.as_bytes());
        return Ok(());
    }
    let mut out = io::stdout().lock();
    // Into a file or a program goes what was asked for, bit for bit.
    let text = if out.is_terminal() { visible(text) } else { Cow::Borrowed(text) };
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Ok(()) => Ok(()),
        Err(error) => Failure::of_writing(&error),
    }
}

/// Says that standard output holds a stream of lines, which no error may stand in.
pub(crate) fn stream() {
    ANSWERED.store(true, Ordering::Relaxed);
}

/// Tells people something that is no result.
pub(crate) fn note(text: impl Display) {
    if !Stream::Error.is_input() {
        let _ = writeln!(io::stderr(), "{}", visible(&text.to_string()));
    }
}

/// The text with what moves a terminal's cursor, or turns the text around, written out: names come from files of others.
fn visible(text: &str) -> Cow<'_, str> {
    let is_odd = |c: char| {
        let turns = matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        turns || (c.is_control() && !matches!(c, '\n' | '\t'))
    };
    if !text.contains(is_odd) {
        return Cow::Borrowed(text);
    }
    let written = |c: char| if is_odd(c) { c.escape_unicode().to_string() } else { c.to_string() };
    Cow::Owned(text.chars().map(written).collect())
}

/// Tells people where a file was written; standard output needs no telling.
pub(crate) fn wrote(path: &std::path::Path) {
    if !crate::argument::is_standard(path) {
        note(format_args!("wrote {}", path.display()));
    }
}

#[cfg(test)]
mod tests {
    use super::visible;

    /// A controller's name coloured the terminal, or cleared it.
    #[test]
    fn what_moves_a_terminals_cursor_is_written_out() {
        assert_eq!(visible("a\u{1b}[31mb\u{202e}c\rd\ne"), "a\\u{1b}[31mb\\u{202e}c\\u{d}d\ne");
        assert_eq!(visible("Regler für Höhe\n"), "Regler für Höhe\n");
    }
}

//! How a command ends: exit codes, messages, and writing to standard output.

use std::fmt::Display;
use std::io::{self, Write as _};

use fspid_study::output::OutputError;

/// Why a command did not end well.
#[derive(Debug)]
pub(crate) struct Failure {
    code: u8,
    message: String,
}

impl Failure {
    /// A requirement or claim check was not met.
    pub(crate) const NOT_MET: u8 = 1;
    /// The input is wrong.
    pub(crate) const INPUT: u8 = 2;
    /// The output could not be written.
    pub(crate) const OUTPUT: u8 = 4;

    /// A requirement or claim check that was not met.
    pub(crate) fn not_met(message: impl Display) -> Self {
        Self { code: Self::NOT_MET, message: message.to_string() }
    }

    /// Input that cannot be used.
    pub(crate) fn input(message: impl Display) -> Self {
        Self { code: Self::INPUT, message: message.to_string() }
    }

    /// Output that cannot be written.
    pub(crate) fn output(message: impl Display) -> Self {
        Self { code: Self::OUTPUT, message: message.to_string() }
    }

    /// Standard output that cannot be written; a reader that has gone away is no failure.
    pub(crate) fn of_writing(error: &io::Error) -> Result<(), Self> {
        if error.kind() == io::ErrorKind::BrokenPipe {
            return Ok(());
        }
        let message = format!("cannot write to standard output: {error}");
        Err(Self { code: Self::OUTPUT, message })
    }

    pub(crate) fn code(&self) -> u8 {
        self.code
    }

    /// Tells people; a closed standard error is no reason to fail differently.
    pub(crate) fn tell(&self) {
        let message = self.message.trim_end();
        // A list of located problems begins with its first place, so that editors can jump there.
        let name = if message.contains('\n') { "" } else { "fspid: " };
        let _ = writeln!(io::stderr(), "{name}{message}");
    }
}

impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Self {
        Self { code: Self::OUTPUT, message: error.to_string() }
    }
}

/// Writes data to standard output. A reader that has gone away (`| head`) is no failure.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Ok(()) => Ok(()),
        Err(error) => Failure::of_writing(&error),
    }
}

/// Tells people something that is no result.
pub(crate) fn note(text: impl Display) {
    let _ = writeln!(io::stderr(), "{text}");
}

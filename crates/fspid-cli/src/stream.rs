//! Standard output and standard error as the files that a shell may have made of them: what is read gets nothing.

use std::ffi::{OsStr, OsString};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use fspid_scenario::apart::{self, Identity, Named};

/// Where words go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stream {
    Output,
    Error,
}

/// Whether a stream is a file that the line names, of which is not known whether it is read.
static KEPT_OUT: [AtomicBool; 2] = [const { AtomicBool::new(false) }; 2];

impl Stream {
    fn kept_out(self) -> &'static AtomicBool {
        let [output, error] = &KEPT_OUT;
        match self {
            Self::Output => output,
            Self::Error => error,
        }
    }

    /// Which file it goes to, if it is one.
    #[cfg(unix)]
    fn identity(self) -> Option<Identity> {
        use std::os::fd::AsFd as _;
        let open = match self {
            Self::Output => io::stdout().as_fd().try_clone_to_owned(),
            Self::Error => io::stderr().as_fd().try_clone_to_owned(),
        };
        Identity::of_open(&open.ok()?.into())
    }

    #[cfg(not(unix))]
    fn identity(self) -> Option<Identity> {
        None
    }

    /// The file that it goes to, if it is one: what is printed would stand in it or be lost.
    pub(crate) fn named(self) -> Option<Named> {
        let argument = match self {
            Self::Output => "standard output",
            Self::Error => "standard error",
        };
        let identity = self.identity()?;
        Some(Named { argument: argument.to_owned(), path: PathBuf::new(), identity })
    }

    /// True where it is a file that is read: nothing is written into it, not even an error.
    pub(crate) fn is_input(self) -> bool {
        let was_read = || self.identity().is_some_and(|identity| apart::was_read(&identity));
        self.kept_out().load(Ordering::Relaxed) || was_read()
    }
}

/// Keeps errors out of every file that a word of the line names, `--option=FILE` among them.
pub(crate) fn keep_out_of(words: &[OsString]) {
    for stream in [Stream::Output, Stream::Error] {
        let Some(identity) = stream.identity() else { continue };
        let is_it = |name: &OsStr| Identity::of(Path::new(name)).as_ref() == Some(&identity);
        let is_named = |word: &OsString| {
            let value = word.to_str().and_then(|word| word.split_once('='));
            is_it(word) || value.is_some_and(|(_, value)| is_it(value.as_ref()))
        };
        stream.kept_out().store(words.iter().any(is_named), Ordering::Relaxed);
    }
}

//! What is written for each target: which files, under which names.
//!
//! A new target: a variant, its name, and a function in a file of its own that answers its files.

mod c;
mod lua;

use fspid_core::Controller;
use fspid_numeric::Real;

use crate::program::Program;
use crate::vectors::Vector;
use crate::write::Heading;

/// A language that a controller can be written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// C99.
    C,
    /// Lua 5.3.
    Lua,
}

impl Target {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::C, Self::Lua];

    /// Its name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::C => "c",
            Self::Lua => "lua",
        }
    }

    /// True if its vectors hold more than steps.
    pub(crate) const fn has_events(self) -> bool {
        matches!(self, Self::C | Self::Lua)
    }

    /// What is written for it.
    pub(crate) fn files<R: Real>(self, source: &Source<'_, R>) -> Vec<File> {
        match self {
            Self::C => c::files(source),
            Self::Lua => lua::files(source),
        }
    }
}

/// What a target is written from.
pub(crate) struct Source<'a, R> {
    pub(crate) program: &'a Program,
    pub(crate) controller: &'a Controller<R>,
    /// What every name begins with.
    pub(crate) prefix: &'a str,
    pub(crate) heading: &'a Heading<'a>,
    pub(crate) vectors: &'a [Vector<R>],
}

/// A file of an export.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Its name in the folder, with `/` before the name where it lies in a folder of that.
    pub name: String,
    /// What is in it.
    pub bytes: Vec<u8>,
}

impl File {
    pub(crate) fn text(name: impl Into<String>, text: String) -> Self {
        Self { name: name.into(), bytes: text.into_bytes() }
    }
}

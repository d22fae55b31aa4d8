//! What is written for each target: which files, under which names.
//!
//! A new target: a variant, its name, and a function in a file of its own that answers its files.

mod c;
mod fmu;
mod lua;
mod structured_text;

use fspid_numeric::Real;

use crate::program::{Precision, Program};
use crate::vectors::Vector;
use crate::write::Heading;
use crate::write::fmu::Version;

/// A language that a controller can be written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// C99.
    C,
    /// Lua 5.3.
    Lua,
    /// Structured Text of IEC 61131-3.
    StructuredText,
    /// A functional mock-up unit, FMI 2.0.
    Fmu2,
    /// A functional mock-up unit, FMI 3.0.
    Fmu3,
}

impl Target {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::C, Self::Lua, Self::StructuredText, Self::Fmu2, Self::Fmu3];

    /// Its name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::C => "c",
            Self::Lua => "lua",
            Self::StructuredText => "st",
            Self::Fmu2 => "fmu2",
            Self::Fmu3 => "fmu3",
        }
    }

    /// The digits that its users expect: those of a chip, or of a simulator.
    #[must_use]
    pub const fn usual_precision(self) -> Precision {
        match self {
            Self::C | Self::Lua | Self::StructuredText => Precision::Single,
            Self::Fmu2 | Self::Fmu3 => Precision::Double,
        }
    }

    /// What is written for it; what is to be told of it goes to the notes.
    pub(crate) fn files<R: Real>(
        self,
        source: &Source<'_, R>,
        notes: &mut Vec<String>,
    ) -> Vec<File> {
        match self {
            Self::C => c::files(source),
            Self::Lua => lua::files(source),
            Self::StructuredText => structured_text::files(source),
            Self::Fmu2 => fmu::files(source, Version::Two, notes),
            Self::Fmu3 => fmu::files(source, Version::Three, notes),
        }
    }
}

/// What a target is written from.
pub(crate) struct Source<'a, R> {
    pub(crate) program: &'a Program,
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

//! What is written for each target: which files, under which names.
//!
//! A new target: a variant, its name, and a function in a file of its own that answers its files.

mod c;
mod fmu;
mod lua;
mod matlab;
mod rust;
mod simulink;
mod structured_text;
mod table;

use fspid_core::Controller;
use fspid_numeric::Real;

use crate::compose::Refusal;
use crate::file::File;
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
    /// Rust, for `fspid-core`.
    Rust,
    /// The supervisor's surface as a table in C and CSV.
    Table,
    /// A function of MATLAB, and the supervisor as a `.fis`.
    Matlab,
    /// An S-function around the C.
    Simulink,
    /// A functional mock-up unit, FMI 2.0.
    Fmu2,
    /// A functional mock-up unit, FMI 3.0.
    Fmu3,
}

impl Target {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::C,
        Self::Lua,
        Self::StructuredText,
        Self::Rust,
        Self::Table,
        Self::Matlab,
        Self::Simulink,
        Self::Fmu2,
        Self::Fmu3,
    ];

    /// Its name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::C => "c",
            Self::Lua => "lua",
            Self::StructuredText => "st",
            Self::Rust => "rust",
            Self::Table => "table",
            Self::Matlab => "matlab",
            Self::Simulink => "simulink",
            Self::Fmu2 => "fmu2",
            Self::Fmu3 => "fmu3",
        }
    }

    /// The digits that its users expect: those of a chip, or of a simulator.
    #[must_use]
    pub const fn usual_precision(self) -> Precision {
        match self {
            Self::C | Self::Lua | Self::StructuredText | Self::Rust | Self::Table => {
                Precision::Single
            }
            Self::Matlab | Self::Simulink | Self::Fmu2 | Self::Fmu3 => Precision::Double,
        }
    }

    /// True if a page writes it too: what proves the bound of a table and what reads a `.fis` back would make the one file
    /// too large.
    #[must_use]
    pub const fn is_in_pages(self) -> bool {
        !matches!(self, Self::Matlab | Self::Table)
    }

    /// True if its vectors hold more than steps.
    pub(crate) const fn has_events(self) -> bool {
        matches!(self, Self::C | Self::Lua)
    }

    /// What is written for it.
    pub(crate) fn files<R: Real>(self, source: &Source<'_, R>) -> Result<Written, Refusal> {
        let files = match self {
            Self::C => c::files(source),
            Self::Lua => return Ok(lua::files(source)),
            Self::StructuredText => return Ok(structured_text::files(source)),
            Self::Rust => rust::files(source)?,
            Self::Simulink => simulink::files(source)?,
            _ if !self.is_in_pages() && cfg!(target_family = "wasm") => {
                return Err(Refusal::NotInPages);
            }
            Self::Matlab => return matlab::files(source),
            Self::Table => return table::files(source),
            Self::Fmu2 => return fmu::files(source, Version::Two),
            Self::Fmu3 => return fmu::files(source, Version::Three),
        };
        Ok(Written { files, notes: Vec::new() })
    }
}

/// What a target is written from.
pub(crate) struct Source<'a, R> {
    pub(crate) program: &'a Program,
    /// What every name begins with.
    pub(crate) prefix: &'a str,
    pub(crate) heading: &'a Heading<'a>,
    pub(crate) vectors: &'a [Vector<R>],
    /// What is exported, where that is a controller.
    pub(crate) flown: Option<Flown<'a, R>>,
}

/// A controller, and what is asked for that only a controller has.
pub(crate) struct Flown<'a, R> {
    pub(crate) controller: &'a Controller<R>,
    /// Its sample period as the scenario has it, s: what keeps time counts in 64 bits, whatever the controller does.
    pub(crate) period_s: f64,
    /// Points of a table along an input.
    pub(crate) points: usize,
}

/// What is written for a target, and what there is to say of it.
pub(crate) struct Written {
    pub(crate) files: Vec<File>,
    pub(crate) notes: Vec<String>,
}

#![doc = include_str!("../README.md")]
//!
//! Not here: scenarios and designs, which `fspid-scenario` reads; flights; the files' places.

mod compile;
mod compose;
mod evidence;
mod export;
mod file;
mod flat;
pub mod interpret;
mod names;
pub mod program;
mod systems;
pub mod table;
mod targets;
mod trace;
pub mod vectors;
pub mod write;
mod zip;

pub use compose::{Angles, Refusal, precision_of, program};
pub use export::{Export, ExportError, LoopWord, Request, export, export_called};
pub use file::File;
pub use fspid_core::Controller;
pub use names::{identifier, prefix, prefixes};
pub use systems::{
    NOT_FINITE, Names, OUT_OF_RANGE, SystemProgram, SystemRefusal, SystemRequest, export_system,
    source_code, system_program, system_vectors,
};
pub use targets::Target;
pub use zip::archive;

#![doc = include_str!("../README.md")]
//!
//! No features. Not here: any format, and any quantity; whoever reads says what is wrong.

pub mod attributes;
pub mod digits;
pub mod lines;
mod nearest;
mod note;
mod place;
mod problem;
mod report;

pub use nearest::{known_words, listed, nearest};
pub use note::Note;
pub use place::{LineStarts, Place};
pub use problem::{Problem, Problems, in_two};
pub use report::{Report, Span, excerpt};

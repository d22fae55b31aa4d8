//! What is wrong with a text: places, problems, and the word that was probably meant; numbers and lines in sentences.
//!
//! A reader goes on after a problem and tells all of them at once, each with its place, what was found and what
//! is allowed. [`Report`] collects them over several texts; [`Problems`] is what a caller is told.
//!
//! ```
//! use fspid_diagnostics::{Report, Span};
//! let mut report = Report::default();
//! let source = report.add_source(None, "kp = -1\n");
//! report.value(Span { source, start: 5, end: 7 }, "kp", "is below 0", "a number of at least 0");
//! let problems = report.finish("mine.toml").unwrap_err();
//! assert!(problems.to_string().starts_with("mine.toml:1:6: kp: is below 0\n    found: -1; allowed: a number"));
//! ```
//!
//! Not here: any format, and any quantity; whoever reads says what is wrong.

pub mod digits;
pub mod lines;
mod nearest;
mod note;
mod place;
mod problem;
mod report;

pub use nearest::{known_words, nearest};
pub use note::Note;
pub use place::{LineStarts, Place};
pub use problem::{Problem, Problems};
pub use report::{Report, Span, excerpt};

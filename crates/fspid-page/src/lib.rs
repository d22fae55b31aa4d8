#![doc = include_str!("../README.md")]
//!
//! No features. Not here: what is measured and judged (`fspid-study`), and how a line is drawn (`fspid-plot`).

pub mod analysis;
pub mod campaign;
pub mod columns;
pub mod html;
pub mod markdown;
pub mod number;
pub mod page;

#[doc(hidden)]
pub use minijinja;

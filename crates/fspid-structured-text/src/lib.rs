#![doc = include_str!("../README.md")]
//!
//! Not here: the rest of the language, a compiler, time, tasks and inputs of a PLC.

mod code;
mod compile;
mod instance;
mod lexer;
mod parser;
mod problem;
mod reserved;
mod syntax;
mod value;

pub use instance::{Instance, Library};
pub use problem::{Mistake, Problem};
pub use reserved::is_reserved;
pub use value::{Kind, Value};

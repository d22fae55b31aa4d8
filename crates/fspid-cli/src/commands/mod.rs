//! The commands, one file each.

pub(crate) mod check;
pub(crate) mod infer;
pub(crate) mod init;
pub(crate) mod reproduce;
pub(crate) mod schema;
pub(crate) mod simulate;

use clap::ValueEnum;

/// How an answer is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// For people.
    Text,
    /// For programs.
    Json,
}

/// Pretty JSON with a line end.
pub(crate) fn json_text(value: &serde_json::Value) -> String {
    format!("{value:#}\n")
}

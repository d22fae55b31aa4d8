//! Texts of tables with typed keys: what is written, what may be written, and what is left after the check.
//!
//! A key is a constant that knows the type of what it holds ([`Key`]); a [`Table`] lists its keys. From these rows come the
//! check, which collects all problems of a text with their places, the JSON Schema, the defaults, and the [`Section`] that
//! readers ask by the same constants. A key that is misspelt or asked for another type does not compile.
//!
//! Not here: any key, and what the values mean.

pub(crate) mod check;
pub(crate) mod document;
mod held;
mod key;
mod kind;
pub(crate) mod schema;
mod section;
mod table;
pub(crate) mod word;

pub(crate) use held::Rules;
pub(crate) use key::{Key, KeyName, KeyRow, defaulted, optional, required};
pub(crate) use kind::{
    Kind, KindOf, Range, boolean, carried, defuzzifier, file_path, finite, free_text, grid,
    interval, name_in, not_negative, number, number_grid, numbers, own, positive, rules, table,
    tables, text, whole, word,
};
pub(crate) use section::{Checked, Entry, Section, join};
pub(crate) use table::{Choice, Table, Variant, Way, one_of, plain};

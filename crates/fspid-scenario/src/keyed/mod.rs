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
mod syntax;
mod table;
pub(crate) mod word;

pub(crate) use held::Rules;
pub(crate) use key::{Key, KeyName, KeyRow, defaulted, optional, required};
pub(crate) use kind::{
    BOOLEAN, DEFUZZIFIER_NAME, FILE_PATH, FREE_TEXT, GRID, Kind, KindOf, NUMBER_GRID, Range, TEXT,
    carried, finite, interval, name_in, not_negative, number, numbers, own, positive, rules, table,
    tables, whole, word,
};
pub(crate) use section::{Checked, Entry, Section, join};
pub(crate) use table::{Choice, Table, Variant, Way, choosing, of_kinds, one_of, plain, variant};

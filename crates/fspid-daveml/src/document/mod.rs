//! A model as its file says it, before it is checked and compiled. It can also be put together without a file.

mod header;
mod shot;
mod table;
mod variable;

pub use crate::expression::Expression;
pub use crate::finding::Origin;
pub use header::{Author, Header, Modification, Provenance, Source};
pub use shot::{Shot, Signal};
pub use table::{Breakpoints, Extrapolate, FunctionInput, GridTable, Mention, TableFunction};
pub use variable::{Role, Variable};

/// Everything of a file that is kept.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// What the model is and where it comes from.
    pub header: Header,
    /// Variables in the order of the file.
    pub variables: Vec<Variable>,
    /// Breakpoints of tables.
    pub breakpoints: Vec<Breakpoints>,
    /// Tables; those written inside a function are here too.
    pub tables: Vec<GridTable>,
    /// Which table makes which variable of which others.
    pub functions: Vec<TableFunction>,
    /// Check cases.
    pub shots: Vec<Shot>,
}

//! General fuzzy systems for people: loading, asking, drawing, converting, explaining.
//!
//! One function per verb. A system comes from a file of any known format or is one of the shipped
//! rule tables; how it computes is `fspid-fuzzy`'s business, how other tools write it down
//! `fspid-formats`'.

mod answer;
mod audit;
mod convert;
mod explain;
mod load;
mod numbers;
mod scenario;
mod slice;
mod table;
mod toml_file;
mod words;

pub use fspid_formats::fcl::Dialect;
pub use fspid_fuzzy::system::{Parts, System};

pub use answer::{Asked, ask};
pub use audit::{Audit, Chapter, Finding, Mark, Question as AuditQuestion, audit};
pub use convert::{ConvertError, Converted, Target, convert, write_as};
pub use explain::{Basis, Explanation, Lack, Share, Shares, WhyNot, explain};
pub(crate) use load::other_kind;
pub use load::{
    Format, LoadError, Loaded, NUMBER_GRID, Options, is_rule_table_file, is_scenario, is_system,
    load, needs_range, read,
};
pub use numbers::{Numbers, numbers_of};
pub use slice::{Question as SliceQuestion, Slice, slice};
pub use table::SystemTable;
pub use toml_file::{parse, schema, write};

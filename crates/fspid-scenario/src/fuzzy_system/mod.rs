//! Fuzzy systems in files of any known format, the supervisors of scenarios, and the shipped rule tables.

mod convert;
mod load;
mod numbers;
mod scenario;
mod toml_file;

pub use fspid_formats::fcl::Dialect;
pub use fspid_fuzzy::system::{Parts, System};

pub use convert::{ConvertError, Converted, Target, convert, write_as};
pub(crate) use load::other_kind;
pub use load::{
    Format, LoadError, Loaded, NUMBER_GRID, Options, is_rule_table_file, is_scenario, is_system,
    load, needs_range, read,
};
pub use numbers::{Numbers, numbers_of};
pub use toml_file::{parse, schema, write};

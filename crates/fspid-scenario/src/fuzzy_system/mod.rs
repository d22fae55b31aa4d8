//! Fuzzy systems in files of any known format, the supervisors of scenarios, and the shipped rule tables.

mod convert;
mod load;
mod scenario;

pub use fspid_formats::fcl::Dialect;
pub use fspid_fuzzy::system::{Parts, System};

pub use crate::system_text::{
    Format, LoadError, Loaded, NUMBER_GRID, Numbers, Options, numbers_of, parse, read, schema,
    write,
};
pub use convert::{ConvertError, Converted, Target, convert, write_as};
pub use load::{digest, is_rule_table_file, is_scenario, is_system, load, needs_range};
pub use scenario::of_study;

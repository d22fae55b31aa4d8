//! The native module below the Python package `fspid`: scenarios, what is asked of them, and their answers.
//!
//! Answers cross over as JSON and as columns; everything that a person reads or types in Python is Python, in
//! `python/fspid`. No call holds the interpreter while it works.

mod aircraft;
mod answer;
mod array;
mod campaign;
mod certify;
mod contest;
mod controller;
mod crew;
mod environment;
mod error;
mod fuzzy;
mod interrupt;
mod lti;
mod origin;
mod scenario;
mod table;
mod tune;

/// The native part of fspid; private: use the package `fspid`.
#[pyo3::pymodule]
mod _core {
    #[pymodule_export]
    use super::aircraft::{aircraft, aircraft_list};
    #[pymodule_export]
    use super::answer::{Answer, Flight};
    #[pymodule_export]
    use super::array::Column;
    #[pymodule_export]
    use super::campaign::Campaign;
    #[pymodule_export]
    use super::certify::{check_certificate, read_certificate};
    #[pymodule_export]
    use super::controller::Controller;
    #[pymodule_export]
    use super::crew::Worker;
    #[pymodule_export]
    use super::environment::{Environment, Environments};
    #[pymodule_export]
    use super::fuzzy::{FuzzySystem, Supervisor};
    #[pymodule_export]
    use super::lti::margins;
    #[pymodule_export]
    use super::scenario::{Scenario, preset, preset_names};
    #[pymodule_export]
    use super::table::Table;

    /// Version of this build.
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}

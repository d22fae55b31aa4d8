//! What `fspid --version` says, which a report of a wrong verdict begins with.

/// The version, what was built and by what, and the versions of what is written and read. `build.rs` finds out the rest.
pub(crate) const LONG: &str = concat!(
    env!("CARGO_PKG_VERSION"),
    "\n",
    env!("FSPID_COMMIT"),
    "\nfor ",
    env!("FSPID_TARGET"),
    ", by ",
    env!("FSPID_COMPILER"),
    "\nscenarios of schema 1, certificates of schema 2, answers of schema 1"
);

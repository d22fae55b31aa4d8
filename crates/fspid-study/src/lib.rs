//! fspid-study

//! fspid-study

pub mod figure;

//! The controllers a loop can be flown with.

/// A controller of the loop; it sees radians and answers radians.
pub type Controller = fspid_core::Controller<f64>;

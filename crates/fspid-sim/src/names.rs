//! What other programs are called, wherever people are told of them.

/// JSBSim, which flies aircraft of its own.
pub(crate) const JSBSIM: &str = "JSBSim";

//! Points of the unit cube: what run *i* draws.

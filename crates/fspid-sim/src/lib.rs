//! fspid-sim

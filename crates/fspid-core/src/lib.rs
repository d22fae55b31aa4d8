//! fspid-core

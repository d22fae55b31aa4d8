//! fspid-fuzzy

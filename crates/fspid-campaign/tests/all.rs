//! All integration tests in one binary: linking one takes less than linking many.

mod campaign;
mod engine;
mod parts;
mod rare;
mod search;
mod statistics;
mod summary;
mod table;

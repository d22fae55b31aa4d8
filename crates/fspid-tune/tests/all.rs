//! All integration tests in one binary: linking one takes less than linking many.

mod adaptation;
mod anfis;
mod contest;
mod crew;
mod designs;
mod free_places;
mod limit;
mod problem;
mod rules;

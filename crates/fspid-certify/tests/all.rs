//! All integration tests in one binary: linking one takes less than linking many.

mod as_it_flies;
mod designs;
mod provable;

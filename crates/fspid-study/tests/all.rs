//! All integration tests in one binary: linking one takes less than linking many.

mod analysis;
mod as_read;
mod envelope;
mod fly;
mod flying;
mod fuzzy_system;
mod moment;
mod report;
mod requirements;
mod sound;
mod step_metrics;

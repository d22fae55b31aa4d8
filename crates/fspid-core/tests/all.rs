//! All integration tests in one binary: linking one takes less than linking many.

mod anti_windup;
mod asked;
mod bad_samples;
mod bad_settings;
mod common;
mod definitions;
mod no_heap;
mod self_tuning;
mod structures;
mod theory;
mod tracking;

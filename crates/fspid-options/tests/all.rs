//! All integration tests in one binary: linking one takes less than linking many.

mod hostile_samples;

//! All integration tests in one binary: linking one takes less than linking many.

mod paper;
mod report;
#[path = "../../fspid-study/tests/sound.rs"]
mod sound;

//! All integration tests in one binary: linking one takes less than linking many.

mod as_it_flies;
#[path = "../../fspid-study/tests/as_read.rs"]
mod as_read;
mod cases;
mod designs;
mod page;
mod provable;
#[path = "../../fspid-study/tests/sound.rs"]
mod sound;

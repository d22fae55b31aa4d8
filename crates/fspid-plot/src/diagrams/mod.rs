//! Drawings without data: axes and signs, and the loops as block diagrams (Figs 1 to 3 of the paper).

mod axes;
mod blocks;
mod loops;

pub use axes::aircraft_axes;
pub use loops::{pitch_loop, self_tuning_pid};

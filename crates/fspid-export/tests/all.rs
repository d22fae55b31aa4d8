//! All tests of this crate from outside, as one program.

mod c;
mod same_bits;
mod systems;

//! All tests of this crate from outside, as one program.

mod c;
mod rust;
mod same_bits;
mod structured_text;
mod systems;
mod table;

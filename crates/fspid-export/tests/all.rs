//! All tests of this crate from outside, as one program.

mod c;
mod evidence;
mod same_bits;
mod track;

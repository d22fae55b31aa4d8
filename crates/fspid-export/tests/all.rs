//! All tests of this crate from outside, as one program.

mod c;
mod fmu;
mod moved;
mod same_bits;
mod unpacked;

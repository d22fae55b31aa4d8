//! All tests of this crate from outside, as one program.

mod ardupilot;
mod c;
mod common;
mod evidence;
mod flips;
mod fmu;
mod fmu_system;
mod lua;
mod lua_interpreter;
mod moved;
mod rust;
mod same_bits;
mod simulink;
mod structured_text;
mod systems;
mod table;
mod track;
mod unpacked;

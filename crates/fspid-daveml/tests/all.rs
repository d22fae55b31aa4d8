//! All integration tests in one binary: linking one takes less than linking many.

mod abuse;
mod data_file;
mod flight;
mod jsbsim;
mod jsbsim_twice;
mod law;
mod refused;
mod toy;

//! All integration tests in one binary: linking one takes less than linking many.

mod abuse;
mod data_file;
mod flight;
mod jsbsim;
mod law;
mod refused;
mod toy;

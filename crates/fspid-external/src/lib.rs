#![doc = include_str!("../README.md")]
//!
//! A flight has a process of its own, so that nothing of a controller outlives it, its own static memory included: the
//! same flight has the same bits whoever flew before, on any number of threads.
//!
//! No features. Not here: what is made of the answers (`fspid-sim`, `fspid-study`).

#[cfg(unix)]
mod archive;
#[cfg(unix)]
mod description;
pub mod drive;
mod earth;
mod flight_stack;
#[cfg(unix)]
mod fmi;
#[cfg(unix)]
mod fmu;
#[cfg(unix)]
mod fmu_flight;
mod frame;
#[cfg(unix)]
mod library;
mod pace;
#[cfg(unix)]
mod process;
#[cfg(unix)]
mod serve;
#[cfg(unix)]
mod shown;
#[cfg(unix)]
mod simulator;
#[cfg(unix)]
mod timed;
#[cfg(unix)]
mod variables;
pub mod view;

#[cfg(unix)]
pub use process::ProcessHost;
#[cfg(unix)]
pub use serve::serve;
#[cfg(unix)]
pub use simulator::SimulatorHost;

#[cfg(not(unix))]
mod elsewhere;
#[cfg(not(unix))]
pub use elsewhere::{ProcessHost, SimulatorHost, serve};

#![doc = include_str!("../README.md")]
//!
//! ```text
//! page ─HTTP on loopback▶ seats ▶ guard ▶ routes ─▶ scenarios of the folder (read, saved)
//!                        64     403 401          ├▶ jobs on threads ─events▶ page
//!                                                └▶ telemetry by UDP (JSON, MAVLink) ─events▶ page
//! ```
//!
//! No features. Not here: any number of a flight (a job calls what the program's own commands call), the page itself
//! (`web`), what messages of MAVLink mean
//! (`fspid-mavlink`), and sentences for a terminal (`fspid-cli`).

#![cfg_attr(
    test,
    allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")
)]

mod answer;
mod app;
mod body;
mod first;
mod guard;
mod health;
mod jobs;
mod listen;
#[doc(hidden)]
pub mod offline;
mod page;
mod request;
mod routes;
mod scenarios;
mod server;
mod settings;
mod stream;
mod telemetry;
mod token;

pub use page::Page;
pub use routes::routes;
pub use server::{Server, StartError, leave_a_core};
pub use settings::{Limits, Opened, Settings};

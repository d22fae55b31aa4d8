//! All integration tests in one binary: linking one takes less than linking many. Each talks to a server on loopback.

mod common;
mod guard;
mod jobs;
mod load;
mod scenarios;
mod telemetry;

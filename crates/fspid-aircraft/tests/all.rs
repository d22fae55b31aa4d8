//! All integration tests in one binary: linking one takes less than linking many.

mod atmosphere;
mod classes;
mod derivation;
mod doubts;
mod enclosure;
mod envelope;
mod flight;
mod kinks;
mod loading;
mod motion;
mod qualities;
mod support;
mod trim_and_linearise;
mod tumbling_brick;
mod varied;

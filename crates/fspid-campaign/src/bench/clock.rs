//! The one place of this crate that reads a clock.

#![allow(
    clippy::disallowed_types,
    reason = "a measurement of time; nothing that is computed depends on it"
)]

use std::time::Instant;

/// Shorter times cannot be told apart from this one, s.
const SHORTEST_S: f64 = 1e-9;

/// What `work` answers, and how long it took by the wall, s; never zero.
pub(super) fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let answer = work();
    (answer, start.elapsed().as_secs_f64().max(SHORTEST_S))
}

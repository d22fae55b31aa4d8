//! Work beside the work: it shall take a small part of the time.

use std::time::{Duration, Instant};

/// How long it rests after each time at least, and how many times as long as it took.
const LEAST: Duration = Duration::from_millis(400);
const TIMES: u32 = 10;

/// When the next time may be.
#[derive(Debug)]
pub(super) struct Rest {
    begun: Instant,
    /// How long after the beginning; none before the first time.
    next: Option<Duration>,
}

impl Default for Rest {
    fn default() -> Self {
        Self { begun: Instant::now(), next: None }
    }
}

impl Rest {
    pub(super) fn new() -> Self {
        Self::default()
    }

    /// Works if it has rested long enough; the first time it has.
    pub(super) fn work(&mut self, work: impl FnOnce()) {
        let begun = self.begun;
        self.work_by(|| begun.elapsed(), work);
    }

    /// As `work`, by a clock that says how long ago the beginning was.
    fn work_by(&mut self, clock: impl Fn() -> Duration, work: impl FnOnce()) {
        let before = clock();
        if self.next.is_some_and(|next| before < next) {
            return;
        }
        work();
        let after = clock();
        self.next = Some(after + LEAST.max(after.saturating_sub(before) * TIMES));
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    #[test]
    fn work_that_took_long_rests_longer() {
        let passed = Cell::new(Duration::ZERO);
        let pass = |ms| passed.set(passed.get() + Duration::from_millis(ms));
        let mut rest = Rest::new();
        rest.work_by(|| passed.get(), || pass(60));
        pass(599);
        rest.work_by(|| passed.get(), || panic!("it rests for ten times as long"));
        pass(1);
        let again = Cell::new(false);
        rest.work_by(|| passed.get(), || again.set(true));
        assert!(again.get());
        pass(399);
        rest.work_by(|| passed.get(), || panic!("it rests for a moment at least"));
    }
}

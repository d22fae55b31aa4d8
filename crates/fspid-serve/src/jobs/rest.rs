//! Work beside the work: it shall take a small part of the time.

use std::time::{Duration, Instant};

/// How long it rests after each time at least, and how many times as long as it took.
const LEAST: Duration = Duration::from_millis(400);
const TIMES: u32 = 10;

/// When the next time may be.
#[derive(Debug, Default)]
pub(super) struct Rest(Option<Instant>);

impl Rest {
    pub(super) fn new() -> Self {
        Self::default()
    }

    /// Works if it has rested long enough; the first time it has.
    pub(super) fn work(&mut self, work: impl FnOnce()) {
        let begun = Instant::now();
        if self.0.is_some_and(|next| begun < next) {
            return;
        }
        work();
        self.0 = Some(Instant::now() + LEAST.max(begun.elapsed() * TIMES));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_that_took_long_rests_longer() {
        let mut rest = Rest::new();
        let begun = Instant::now();
        rest.work(|| std::thread::sleep(Duration::from_millis(60)));
        assert!(rest.0.is_some_and(|next| next >= begun + Duration::from_millis(660)));
        rest.work(|| panic!("it rests"));
    }
}

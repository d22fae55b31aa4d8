//! Work beside the work: it shall take a small part of the time.

use std::time::{Duration, Instant};

/// How long it rests after each time at least, and how many times as long as it took.
const LEAST: Duration = Duration::from_millis(400);
const TIMES: u32 = 10;

/// When the next time may be. Times are counted from its own beginning.
#[derive(Debug)]
pub(super) struct Rest {
    begun: Instant,
    /// None before the first time.
    over: Option<Duration>,
}

impl Rest {
    pub(super) fn new() -> Self {
        Self { begun: Instant::now(), over: None }
    }

    /// The time, if it has rested long enough; the first time it has.
    pub(super) fn is_over(&self) -> Option<Duration> {
        self.is_over_at(self.begun.elapsed())
    }

    /// Rests from now on, after work that began then.
    pub(super) fn begin(&mut self, work_began: Duration) {
        self.begin_at(work_began, self.begun.elapsed());
    }

    fn is_over_at(&self, now: Duration) -> Option<Duration> {
        self.over.is_none_or(|over| now >= over).then_some(now)
    }

    fn begin_at(&mut self, work_began: Duration, now: Duration) {
        self.over = Some(now + LEAST.max(now.saturating_sub(work_began) * TIMES));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_that_took_long_rests_longer() {
        let ms = Duration::from_millis;
        let mut rest = Rest::new();
        assert_eq!(rest.is_over_at(ms(5)), Some(ms(5)), "it has not worked yet");
        rest.begin_at(ms(5), ms(65));
        assert_eq!(rest.is_over_at(ms(664)), None, "ten times as long as it took");
        assert_eq!(rest.is_over_at(ms(665)), Some(ms(665)));
        rest.begin_at(ms(700), ms(701));
        assert_eq!(rest.is_over_at(ms(1100)), None, "and for a moment at least");
        assert_eq!(rest.is_over_at(ms(1101)), Some(ms(1101)));
    }
}

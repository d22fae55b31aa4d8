//! Flights in real time: each sample waits for its time, and those that come late are told.

use std::time::{Duration, Instant};

/// A sample that comes later than this is late: a thousandth of a second, which sleeping alone may take.
pub(crate) const LATE: Duration = Duration::from_millis(1);
/// Late samples that are told one by one.
const MOST_TOLD: usize = 20;

/// The pace of a flight, from its first sample on.
#[derive(Debug)]
pub(crate) struct Pace {
    begun: Instant,
    period_s: f64,
    samples: u64,
    late: Vec<(u64, Duration)>,
    lates: usize,
    latest: Duration,
    tell: fn(&str),
}

impl Pace {
    pub(crate) fn new(period_s: f64, tell: fn(&str)) -> Self {
        let (late, latest) = (Vec::new(), Duration::ZERO);
        Self { begun: Instant::now(), period_s, samples: 0, late, lates: 0, latest, tell }
    }

    /// Waits for the time of a sample; one that is late is noted, and nobody hurries behind it.
    pub(crate) fn wait(&mut self, sample: u64) {
        let at = Duration::from_secs_f64(sample as f64 * self.period_s);
        let past = self.begun.elapsed().saturating_sub(at);
        self.samples = sample;
        self.note(sample, past);
        std::thread::sleep(at.saturating_sub(self.begun.elapsed()));
    }

    fn note(&mut self, sample: u64, past: Duration) {
        if past > LATE {
            self.lates += 1;
            self.latest = self.latest.max(past);
            if self.late.len() < MOST_TOLD {
                self.late.push((sample, past));
            }
        }
    }

    fn words(&self) -> String {
        let milliseconds = |time: Duration| format!("{:.1} ms", time.as_secs_f64() * 1e3);
        if self.lates == 0 {
            return format!(
                "note: real time: {} samples, none late by more than 1 ms",
                self.samples
            );
        }
        let of = |(sample, past): &(u64, Duration)| {
            format!("t = {:.3} s by {}", *sample as f64 * self.period_s, milliseconds(*past))
        };
        let list: Vec<String> = self.late.iter().map(of).collect();
        let more = match self.lates - self.late.len() {
            0 => String::new(),
            more => format!(", and {more} more"),
        };
        format!(
            "note: real time: {} of {} samples late by more than 1 ms, the latest by {}: {}{more}",
            self.lates,
            self.samples,
            milliseconds(self.latest),
            list.join(", ")
        )
    }
}

impl Drop for Pace {
    fn drop(&mut self) {
        (self.tell)(&self.words());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_late_sample_is_counted_and_the_first_are_named() {
        let mut pace = Pace::new(0.01, |_| {});
        pace.note(1, Duration::from_micros(900));
        pace.samples = 1;
        assert_eq!(pace.words(), "note: real time: 1 samples, none late by more than 1 ms");
        for sample in 2..=31 {
            pace.note(sample, Duration::from_millis(sample));
        }
        pace.samples = 31;
        let words = pace.words();
        assert!(
            words.contains("30 of 31 samples late by more than 1 ms, the latest by 31.0 ms"),
            "{words}"
        );
        assert!(words.contains("t = 0.020 s by 2.0 ms, t = 0.030 s by 3.0 ms"), "{words}");
        assert!(words.ends_with("t = 0.210 s by 21.0 ms, and 10 more"), "{words}");
    }
}

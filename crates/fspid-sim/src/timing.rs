//! Samples and their times.

use crate::error::{SimError, positive};

/// Most rows a trace may have; nine columns of this length take 720 MB.
pub const MAX_ROWS: usize = 10_000_000;

/// Of a sample period: how far before a sample an event may lie and still count as on it. Absorbs
/// the rounding of times such as 0.7 s at 0.1 s a sample. The same in flight and in the loop around rest.
pub(crate) const SAME_SAMPLE: f64 = 1e-6;

/// How old a value is, in samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Age {
    /// Whole samples.
    pub(crate) whole: usize,
    /// Part of a sample beyond them; 0 for what rounding leaves.
    pub(crate) part: f64,
}

impl Age {
    /// An age of so many samples, which is not negative.
    pub(crate) fn of(samples: f64) -> Self {
        let whole = (samples + SAME_SAMPLE).floor();
        let part = (samples - whole).max(0.0);
        Self { whole: count(whole), part: if part <= SAME_SAMPLE { 0.0 } else { part } }
    }
}

/// A whole number of samples, 0 for a negative one.
pub(crate) fn count(samples: f64) -> usize {
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the cast saturates"
    )]
    let count = samples as usize;
    count
}

/// When samples are taken: at `k · dt_s` for k from 0 to `rows - 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    dt_s: f64,
    rows: usize,
}

impl Timing {
    /// round(`duration_s` / `dt_s`) + 1 samples.
    ///
    /// # Errors
    /// [`SimError`] for a period or duration that is not finite and positive, a duration shorter
    /// than one period, and more than [`MAX_ROWS`] samples.
    pub fn new(dt_s: f64, duration_s: f64) -> Result<Self, SimError> {
        let dt_s = positive("sample period, s", dt_s)?;
        let duration_s = positive("duration, s", duration_s)?;
        let samples = (duration_s / dt_s).round();
        // Written so that NaN fails.
        if !(samples + 1.0 <= MAX_ROWS as f64) {
            return Err(SimError::TooManySamples { found: samples + 1.0, most: MAX_ROWS });
        }
        if samples < 1.0 {
            let allowed = "at least one sample period";
            return Err(SimError::Number { what: "duration, s", found: duration_s, allowed });
        }
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 1 and MAX_ROWS, see above"
        )]
        let rows = samples as usize + 1;
        Ok(Self { dt_s, rows })
    }

    /// The shortest flight of this period.
    pub(crate) fn shortest(self) -> Self {
        Self { rows: 2, ..self }
    }

    /// Sample period, s.
    #[must_use]
    pub fn dt_s(&self) -> f64 {
        self.dt_s
    }

    /// Number of samples, first and last included.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Time of the last sample, s.
    #[must_use]
    pub fn end_s(&self) -> f64 {
        self.time_s(self.rows - 1)
    }

    /// Time of sample `k`, s: a product, never a running sum.
    #[must_use]
    pub fn time_s(&self, k: usize) -> f64 {
        k as f64 * self.dt_s
    }

    /// The first sample at or after `at_s`; `rows` if there is none.
    #[must_use]
    pub fn first_sample_at(&self, at_s: f64) -> usize {
        count((at_s / self.dt_s - SAME_SAMPLE).ceil().max(0.0)).min(self.rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trace_has_one_row_more_than_the_rounded_number_of_periods() {
        let rows = |dt_s, duration_s| Timing::new(dt_s, duration_s).map(|timing| timing.rows());
        assert_eq!(rows(0.01, 20.0), Ok(2001));
        assert_eq!(rows(0.1, 0.7), Ok(8));
        assert_eq!(rows(0.3, 1.0), Ok(4));
    }

    #[test]
    fn an_event_falls_on_its_sample_in_spite_of_rounding() {
        for k in 0..2000 {
            let timing = Timing::new(0.01, 20.0).expect("allowed");
            assert_eq!(timing.first_sample_at(f64::from(k) * 0.01), k as usize);
            assert_eq!(timing.first_sample_at(f64::from(k) / 100.0), k as usize);
        }
    }

    #[test]
    fn an_age_is_whole_where_only_rounding_says_otherwise() {
        let near = |found: Age, whole, part: f64| {
            assert!(found.whole == whole && (found.part - part).abs() < 1e-12, "{found:?}");
        };
        near(Age::of(0.07 / 0.01), 7, 0.0);
        near(Age::of(3.0 - 1e-9), 3, 0.0);
        near(Age::of(3.0 + 1e-9), 3, 0.0);
        near(Age::of(1.5), 1, 0.5);
        near(Age::of(0.0), 0, 0.0);
    }

    #[test]
    fn a_flight_beyond_memory_is_refused_before_it_starts() {
        assert!(matches!(Timing::new(1e-9, 1e3), Err(SimError::TooManySamples { .. })));
        for (dt_s, duration_s) in
            [(0.0, 1.0), (f64::NAN, 1.0), (1.0, f64::INFINITY), (-1.0, 1.0), (1.0, 0.1)]
        {
            assert!(Timing::new(dt_s, duration_s).is_err(), "{dt_s} {duration_s}");
        }
    }
}

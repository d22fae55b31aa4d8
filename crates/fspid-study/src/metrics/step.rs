//! Measures of a step response.
//!
//! With $y_i$ the set-point before the step, $y_f$ the one after it and
//! $y_n = (y - y_i) / (y_f - y_i)$; both are given, never guessed from the data. Crossings are
//! interpolated between samples. Definitions as in MATLAB's `stepinfo`, but for those two points, and that
//! a time to settle is one only where the window goes on for a tenth of it.

use fspid_scenario::measure::Measure;

use super::extreme::{all_finite, extreme};
use super::{Absent, Measured, Metric};

/// Risen is 90 % of the way.
const RISEN: f64 = 0.9;
/// Settled is within 2 % of the step.
pub(crate) const SETTLING_BAND: f64 = 0.02;

/// Of the time that it took to settle so much has to be flown after it, to call it settled. A choice: what leaves its band more
/// slowly is a matter of the loop at rest, which is asked for itself.
const STAYS: f64 = 0.1;

/// Whether a window goes on for long enough after the time that it took to settle, or to recover, to show that it stays.
pub(crate) fn is_seen_to_stay(settled_s: f64, window_s: f64) -> bool {
    // Written so that NaN, which no limit allows, is not refused.
    let ends_early = window_s - settled_s < STAYS * settled_s;
    !ends_early
}

/// A response after a step: samples in order of time, from the step to the next.
#[derive(Clone, Copy, Debug)]
pub struct StepWindow<'a> {
    /// Times, s; the first is that of the step.
    pub time_s: &'a [f64],
    /// The response.
    pub response: &'a [f64],
    /// Set-point before the step, $y_i$.
    pub from: f64,
    /// Set-point after the step, $y_f$.
    pub to: f64,
}

impl StepWindow<'_> {
    /// Time after the step at which the response first reaches this share of the way, interpolated;
    /// `None` if it never does or there is no step.
    #[must_use]
    pub fn first_crossing_s(&self, share: f64) -> Option<f64> {
        let step = self.to - self.from;
        let way: Vec<f64> = self.response.iter().map(|y| (y - self.from) / step).collect();
        Normalised { time_s: self.time_s, way: &way }.first_crossing_s(share)
    }
}

/// Measures of a step response, in seconds and in per cent of the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepMetrics {
    /// From the first crossing of 10 % to the first crossing of 90 % of the way, s.
    pub rise_time_s: Measured,
    /// First time after which the response stays within 2 % of the step about the new set-point, and is seen to stay
    /// there for a tenth of that time, s.
    pub settling_time_s: Measured,
    /// As settling, but within 2 % of the largest error, s.
    pub transient_time_s: Measured,
    /// How far it went beyond the new set-point: $\max(0, 100 \max(y_n - 1))$, %.
    pub overshoot_pct: Measured,
    /// How far it first went the wrong way: $\max(0, -100 \min y_n)$, %.
    pub undershoot_pct: Measured,
    /// Least $y_n$ after it first reached 90 %, as a fraction of the step.
    pub settling_min: Measured,
    /// Largest $y_n$ after it first reached 90 %, as a fraction of the step.
    pub settling_max: Measured,
    /// Largest $|y - y_i|$, by a parabola through the three highest neighbours, in response units.
    pub peak: Measured,
    /// Time of the peak after the step, s.
    pub peak_time_s: Measured,
    /// $100 (y_f - y) / |y_f - y_i|$ at the end of the window, %: positive below the set-point.
    pub final_error_pct: Measured,
}

impl StepMetrics {
    /// The value of a measure that can be asked for, or why there is none; there is no step that has one of a flight.
    ///
    /// # Errors
    /// The reason in the metrics.
    pub fn measured(&self, measure: Measure) -> Measured {
        Metric::asked_as(measure)
            .and_then(|metric| metric.of_step(self))
            .unwrap_or(Err(Absent::NoStep))
    }

    /// The same reason for every measure.
    #[must_use]
    pub fn absent(reason: Absent) -> Self {
        let none = Err(reason);
        Self {
            rise_time_s: none,
            settling_time_s: none,
            transient_time_s: none,
            overshoot_pct: none,
            undershoot_pct: none,
            settling_min: none,
            settling_max: none,
            peak: none,
            peak_time_s: none,
            final_error_pct: none,
        }
    }

    /// Measures the response in `window`.
    #[must_use]
    pub fn of(window: StepWindow<'_>) -> Self {
        let step = window.to - window.from;
        let usable = step != 0.0 && step.is_finite() && !window.response.is_empty();
        if !usable {
            return Self::absent(Absent::NoStep);
        }
        if !(all_finite(window.response) && all_finite(window.time_s)) {
            return Self::absent(Absent::NotFinite);
        }
        let way: Vec<f64> = window.response.iter().map(|y| (y - window.from) / step).collect();
        Normalised { time_s: window.time_s, way: &way }.measure(step)
    }
}

/// The response as the fraction of the way that it has come.
#[derive(Clone, Copy)]
struct Normalised<'a> {
    time_s: &'a [f64],
    way: &'a [f64],
}

impl Normalised<'_> {
    fn measure(&self, step: f64) -> StepMetrics {
        let highest = extreme(self.way, f64::NEG_INFINITY, f64::max);
        let lowest = extreme(self.way, f64::INFINITY, f64::min);
        let last = self.way.last().copied().unwrap_or(0.0);
        let largest_error = (highest - 1.0).abs().max((lowest - 1.0).abs());
        let risen = self.after_rise();
        let (peak, peak_time_s) = self.peak();
        StepMetrics {
            rise_time_s: self.rise_time_s(),
            settling_time_s: self.settling_time_s(SETTLING_BAND),
            transient_time_s: self.settling_time_s(SETTLING_BAND * largest_error),
            overshoot_pct: Ok((100.0 * (highest - 1.0)).max(0.0)),
            undershoot_pct: Ok((-100.0 * lowest).max(0.0)),
            // The crossing itself, at 90 %, is part of what follows it.
            settling_min: risen.map(|way| extreme(way, RISEN, f64::min)),
            settling_max: risen.map(|way| extreme(way, f64::NEG_INFINITY, f64::max)),
            peak: Ok(peak * step.abs()),
            peak_time_s: Ok(peak_time_s),
            final_error_pct: Ok(100.0 * (1.0 - last) * step.signum()),
        }
    }

    fn window_s(&self) -> f64 {
        self.time_s.last().copied().unwrap_or(0.0) - self.start_s()
    }

    fn start_s(&self) -> f64 {
        self.time_s.first().copied().unwrap_or(0.0)
    }

    /// Time after the step at which the way first reaches `level`.
    fn first_crossing_s(&self, level: f64) -> Option<f64> {
        let k = self.way.iter().position(|&way| way >= level)?;
        Some(self.crossing_s(k, level))
    }

    /// Time after the step at which the way passes `level` between samples `k - 1` and `k`.
    fn crossing_s(&self, k: usize, level: f64) -> f64 {
        let at = |k: usize| (self.time_s[k], self.way[k]);
        let (t1, y1) = at(k);
        let time_s = match k.checked_sub(1).map(at) {
            Some((t0, y0)) if y1 - y0 != 0.0 => t0 + (t1 - t0) * ((level - y0) / (y1 - y0)),
            _ => t1,
        };
        time_s - self.start_s()
    }

    fn rise_time_s(&self) -> Measured {
        match (self.first_crossing_s(0.1), self.first_crossing_s(RISEN)) {
            (Some(low), Some(high)) => Ok(high - low),
            _ => Err(Absent::NotRisen { window_s: self.window_s() }),
        }
    }

    /// First time after the step from which on the way stays within `band` of 1, if it is seen to: of a swing that goes on
    /// the last samples are in the band by chance.
    fn settling_time_s(&self, band: f64) -> Measured {
        // Written so that NaN counts as outside.
        let inside = |way: f64| (way - 1.0).abs() <= band;
        let Some(outside) = self.way.iter().rposition(|&way| !inside(way)) else {
            return Ok(0.0);
        };
        if outside + 1 == self.way.len() {
            return Err(Absent::NotSettled { window_s: self.window_s(), since_s: None });
        }
        let edge = if self.way[outside] > 1.0 { 1.0 + band } else { 1.0 - band };
        let (settled_s, window_s) = (self.crossing_s(outside + 1, edge), self.window_s());
        match is_seen_to_stay(settled_s, window_s) {
            true => Ok(settled_s),
            false => Err(Absent::NotSettled { window_s, since_s: Some(settled_s) }),
        }
    }

    fn after_rise(&self) -> Result<&[f64], Absent> {
        let k = self.way.iter().position(|&way| way >= RISEN);
        k.and_then(|k| self.way.get(k..)).ok_or(Absent::NotRisen { window_s: self.window_s() })
    }

    /// Largest distance from the start, and when, refined by a parabola where there are neighbours.
    fn peak(&self) -> (f64, f64) {
        let farthest = extreme(self.way, 0.0, |one, other| one.abs().max(other.abs()));
        let top = self.way.iter().position(|way| way.abs() >= farthest).unwrap_or(0);
        let plain = (self.way[top].abs(), self.time_s[top] - self.start_s());
        if top == 0 || top + 1 >= self.way.len() {
            return plain;
        }
        let [before, here, after] = [top - 1, top, top + 1].map(|k| self.way[k].abs());
        let curvature = before - 2.0 * here + after;
        if curvature >= 0.0 {
            return plain;
        }
        let shift = 0.5 * (before - after) / curvature;
        let spacing_s = self.time_s[top + 1] - self.time_s[top];
        (here - 0.25 * (before - after) * shift, plain.1 + shift * spacing_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples of `response` from 0 to `end_s`.
    fn sampled(end_s: f64, response: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        let time_s: Vec<f64> = (0..=20_000).map(|k| f64::from(k) * end_s / 20_000.0).collect();
        let response = time_s.iter().map(|&t| response(t)).collect();
        (time_s, response)
    }

    fn measure(from: f64, to: f64, end_s: f64, response: impl Fn(f64) -> f64) -> StepMetrics {
        let (time_s, response) = sampled(end_s, response);
        StepMetrics::of(StepWindow { time_s: &time_s, response: &response, from, to })
    }

    fn close(measured: Measured, expected: f64, tolerance: f64) -> bool {
        measured.is_ok_and(|value| (value - expected).abs() <= tolerance)
    }

    #[test]
    fn a_first_order_lag_rises_in_ln_9_and_settles_in_minus_ln_0_02() {
        let metrics = measure(0.0, 1.0, 10.0, |t| 1.0 - (-t).exp());
        assert!(close(metrics.rise_time_s, 9.0_f64.ln(), 1e-6), "{metrics:?}");
        assert!(close(metrics.settling_time_s, -0.02_f64.ln(), 1e-6), "{metrics:?}");
        assert_eq!(metrics.overshoot_pct, Ok(0.0));
        assert!(close(metrics.final_error_pct, 100.0 * (-10.0_f64).exp(), 1e-9));
    }

    #[test]
    fn a_response_that_turns_to_nan_has_no_metrics() {
        // A peer answers a settling time of 3.92 s and an overshoot of 0.
        let metrics =
            measure(0.0, 1.0, 10.0, |t| if t > 5.0 { f64::NAN } else { 1.0 - (-t).exp() });
        assert_eq!(metrics, StepMetrics::absent(Absent::NotFinite));
    }

    #[test]
    fn a_response_that_stops_half_way_is_not_risen() {
        // A peer raises an index error.
        let metrics = measure(0.0, 2.0, 10.0, |t| 1.0 - (-t).exp());
        assert_eq!(metrics.rise_time_s, Err(Absent::NotRisen { window_s: 10.0 }));
        let outside = Absent::NotSettled { window_s: 10.0, since_s: None };
        assert_eq!(metrics.settling_time_s, Err(outside));
        assert!(close(metrics.final_error_pct, 50.0, 0.01));
    }

    #[test]
    fn regulation_to_zero_is_measured_from_where_it_began() {
        // A peer, which takes 0 for "not given", answers an overshoot of 2 180 630 %.
        let metrics = measure(1.0, 0.0, 12.0, |t| (-t).exp());
        assert!(close(metrics.settling_time_s, -0.02_f64.ln(), 1e-6), "{metrics:?}");
        assert_eq!(metrics.overshoot_pct, Ok(0.0));
    }

    #[test]
    fn a_step_from_one_to_two_rises_as_one_from_zero_to_one() {
        // A peer, which starts every step at 0, answers 1.61 s.
        let metrics = measure(1.0, 2.0, 12.0, |t| 2.0 - (-t).exp());
        assert!(close(metrics.rise_time_s, 9.0_f64.ln(), 1e-6), "{metrics:?}");
    }

    #[test]
    fn a_downward_step_is_measured_like_an_upward_one() {
        let wave = |t: f64| 1.0 - (-t).exp() * ((3.0 * t).cos() - 0.2 * (3.0 * t).sin());
        let up = measure(0.0, 1.0, 12.0, wave);
        let down = measure(0.5, -1.5, 12.0, |t| 0.5 - 2.0 * wave(t));
        for (a, b) in [
            (up.rise_time_s, down.rise_time_s),
            (up.settling_time_s, down.settling_time_s),
            (up.overshoot_pct, down.overshoot_pct),
            (up.undershoot_pct, down.undershoot_pct),
            (up.peak_time_s, down.peak_time_s),
        ] {
            assert!(close(a, b.expect("measured"), 1e-9), "{a:?} {b:?}");
        }
    }

    #[test]
    fn the_final_error_is_what_is_missing_upwards_in_per_cent_of_the_step() {
        // It used to have the opposite sign on downward steps.
        let above = measure(1.0, -1.0, 10.0, |_| -0.9);
        assert!(close(above.final_error_pct, -5.0, 1e-9), "{above:?}");
        let below = measure(-1.0, 1.0, 10.0, |_| 0.9);
        assert!(close(below.final_error_pct, 5.0, 1e-9), "{below:?}");
    }

    #[test]
    fn a_response_inside_the_band_from_the_first_sample_is_settled_at_once() {
        // Another peer reports it as not settled.
        let metrics = measure(0.0, 1.0, 1.0, |_| 1.001);
        assert_eq!(metrics.settling_time_s, Ok(0.0));
    }

    /// A swing of 4 deg that never ends had settled after 1996.690 of 2000 s.
    #[test]
    fn a_swing_that_goes_on_has_no_time_to_settle_wherever_its_window_ends() {
        let swing = |t: f64| 1.0 + 0.5 * (core::f64::consts::TAU * t).cos();
        let mut late = 0;
        for thousandths in (20_000..21_000).step_by(7) {
            let metrics = measure(0.0, 1.0, f64::from(thousandths) / 1000.0, swing);
            for measured in [metrics.settling_time_s, metrics.transient_time_s] {
                match measured {
                    Err(Absent::NotSettled { since_s, .. }) => late += i32::from(since_s.is_some()),
                    other => panic!("{thousandths}: {other:?}"),
                }
            }
        }
        assert!(late > 0, "some of them end within the band");
        let metrics = measure(0.0, 1.0, 4.1, |t| 1.0 - (-t).exp());
        let why = metrics.settling_time_s.expect_err("too late").to_string();
        assert_eq!(
            why,
            "not settled within 4.1 s: in its band after 3.912 s, too late to see it stay"
        );
        let seen = measure(0.0, 1.0, 4.4, |t| 1.0 - (-t).exp());
        assert!(close(seen.settling_time_s, -0.02_f64.ln(), 1e-6), "{seen:?}");
    }

    #[test]
    fn a_window_without_a_step_or_without_samples_has_no_metrics() {
        assert_eq!(measure(1.0, 1.0, 1.0, |_| 1.0), StepMetrics::absent(Absent::NoStep));
        let empty = StepWindow { time_s: &[], response: &[], from: 0.0, to: 1.0 };
        assert_eq!(StepMetrics::of(empty), StepMetrics::absent(Absent::NoStep));
    }
}

//! Observation windows: is a flight long enough to show what a requirement asks?

use std::ops::RangeInclusive;

use super::{Flown, at_step};
use crate::judgement::{Case, NotEvaluated, StepAt};
use crate::metrics::{EdgeMetrics, is_seen_to_stay};
use fspid_scenario::requirement::Requirement;

/// Part of the time that a step has, or of what it took to rise, which is flown after what is seen. A choice, as of what has
/// settled.
const SEEN: f64 = 0.1;
/// Risen is 90 % of the way, as for the rise time.
const RISEN: f64 = 0.9;

impl Flown<'_> {
    /// An overshoot whose peak is seen: of a response that goes on at its last sample only the next one would tell how far.
    ///
    /// What has settled, and is seen to stay so, goes no further; and what is more than is allowed does not get less. Of a step
    /// that another one ends nothing more is flown, however long the flight is.
    pub(super) fn peaked(
        &self,
        case: Case,
        edge: &EdgeMetrics,
        most_pct: Option<f64>,
    ) -> Result<Case, NotEvaluated> {
        let is_too_much = most_pct.is_some_and(|most_pct| case.value > most_pct);
        let settled_s = edge.step.settling_time_s;
        let is_settled = settled_s.is_ok_and(|time_s| is_seen_to_stay(time_s, edge.window_s));
        let is_ended = self.window(edge).end() + 1 < self.trace.rows();
        if is_too_much || is_settled || is_ended || self.is_peak_seen(edge, most_pct) {
            return Ok(case);
        }
        Err(NotEvaluated::StillRising { window_s: edge.window_s, place: Box::new(case.place) })
    }

    /// Whether a tenth of the time to 90 % of the way is flown after the sample that went furthest, or the response goes on so
    /// slowly that for as long as it took to rise it stays within what is allowed.
    fn is_peak_seen(&self, edge: &EdgeMetrics, most_pct: Option<f64>) -> bool {
        let theta_rad = self.trace.theta_rad.get(self.window(edge)).unwrap_or_default();
        let way = |theta: &f64| (theta - edge.from_rad) / (edge.to_rad - edge.from_rad);
        let ways: Vec<f64> = theta_rad.iter().map(way).collect();
        let furthest = (0..ways.len()).max_by(|one, other| ways[*one].total_cmp(&ways[*other]));
        let risen = ways.iter().position(|way| *way >= RISEN).map(|samples| samples.max(1));
        let (Some(furthest), Some(risen), Some(last)) = (furthest, risen, ways.last()) else {
            return false;
        };
        let tenth = libm::ceil(SEEN * risen as f64);
        let before = ways.len().checked_sub(1 + tenth as usize).and_then(|place| ways.get(place));
        let pace = before.map_or(f64::INFINITY, |before| (last - before).max(0.0) / tenth);
        let goes_to = ways[furthest] + pace * risen as f64;
        let is_slow = most_pct.is_some_and(|most_pct| 100.0 * (goes_to - 1.0) <= most_pct);
        is_slow || (ways.len() - 1 - furthest) as f64 >= tenth
    }

    /// The error that a step leaves, if it has been no larger than it may be for a tenth of its time: the last sample of a swing
    /// lies within any limit by chance.
    pub(super) fn left(
        &self,
        case: Case,
        time: RangeInclusive<usize>,
        requirement: &Requirement,
        error: impl Fn(usize) -> f64,
    ) -> Result<Case, NotEvaluated> {
        let samples = time.end() - time.start();
        let first = time.end() - libm::floor(SEEN * samples as f64) as usize;
        let largest = (first..=*time.end()).map(|sample| error(sample).abs()).fold(0.0, f64::max);
        if requirement.is_met_by(case.value) && !requirement.is_met_by(largest) {
            let window_s = samples as f64 * self.timing.dt_s();
            let unit = requirement.measure.unit();
            return Err(NotEvaluated::NotLeft {
                largest,
                unit,
                window_s,
                place: Box::new(case.place),
            });
        }
        Ok(case)
    }

    /// The same of the error of a step in per cent of it.
    pub(super) fn left_pct(
        &self,
        case: Case,
        edge: &EdgeMetrics,
        requirement: &Requirement,
    ) -> Result<Case, NotEvaluated> {
        let per_rad = 100.0 / (edge.to_rad - edge.from_rad);
        self.left(case, self.window(edge), requirement, |sample| {
            per_rad * self.left_rad(edge, sample)
        })
    }

    /// What is left of a step at a sample, rad; NaN at one that was not flown.
    pub(super) fn left_rad(&self, edge: &EdgeMetrics, sample: usize) -> f64 {
        edge.to_rad - self.trace.theta_rad.get(sample).copied().unwrap_or(f64::NAN)
    }

    /// The same in degrees, of a step.
    pub(super) fn left_deg(
        &self,
        (step, edge): (StepAt, &EdgeMetrics),
        requirement: &Requirement,
    ) -> Result<Case, NotEvaluated> {
        let time = self.window(edge);
        let error = |sample: usize| fspid_scenario::units::degrees(self.left_rad(edge, sample));
        let case = Case { value: error(*time.end()).abs(), place: at_step(step) };
        self.left(case, time, requirement, error)
    }
}

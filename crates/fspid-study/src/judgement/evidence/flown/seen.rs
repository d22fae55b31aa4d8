//! Observation windows: is a flight long enough to show what a requirement asks?

use std::ops::RangeInclusive;

use super::{Flown, at_step};
use crate::judgement::{Case, NotEvaluated, StepAt};
use crate::metrics::{EdgeMetrics, SETTLING_BAND};
use fspid_scenario::requirement::Requirement;

/// Part of the time that a step has, over which an error has to be left, or of what it took to rise, over which the motion at the
/// end is taken. A choice, as of what has settled.
const SEEN: f64 = 0.1;
/// Risen is 90 % of the way, as for the rise time.
const RISEN: f64 = 0.9;

impl Flown<'_> {
    /// An overshoot that stays within what is allowed where the response goes on as it does at its end: only flying on would
    /// tell how far a response goes that still rises, in its first swing or in a later one.
    ///
    /// What is more than is allowed does not get less. Of a step that another one ends nothing more is flown, however long the
    /// flight is.
    pub(super) fn peaked(
        &self,
        case: Case,
        edge: &EdgeMetrics,
        most_pct: Option<f64>,
    ) -> Result<Case, NotEvaluated> {
        let is_too_much = most_pct.is_some_and(|most_pct| case.value > most_pct);
        let is_ended = self.window(edge).end() + 1 < self.trace.rows();
        let theta_rad = self.trace.theta_rad.get(self.window(edge)).unwrap_or_default();
        let way = |theta: &f64| (theta - edge.from_rad) / (edge.to_rad - edge.from_rad);
        let ways: Vec<f64> = theta_rad.iter().map(way).collect();
        // Where nothing is asked, what goes on within the band in which a step has settled is told as it is.
        let most_pct = most_pct.unwrap_or(case.value + 100.0 * SETTLING_BAND);
        let stays = goes_to(&ways).is_some_and(|way| 100.0 * (way - 1.0) <= most_pct);
        if is_too_much || is_ended || stays {
            return Ok(case);
        }
        Err(NotEvaluated::StillRising { window_s: edge.window_s, place: Box::new(case.place) })
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

/// How far a response comes that goes on as it does at its end, as a share of its way; none of one that has not risen.
///
/// A rise goes on for as long as it lasts already, since the step or since it last turned, or, where it slows down, as it does
/// so: each tenth of the time to 90 % of the way adds the same share of what the one before it added. A quick rise may just have
/// become a slow one there, so that the share is no less than that of a lag which rises in that time.
fn goes_to(ways: &[f64]) -> Option<f64> {
    let last = ways.len().checked_sub(1)?;
    let risen = ways.iter().position(|way| *way >= RISEN)?.max(1);
    let span = libm::ceil(SEEN * risen as f64) as usize;
    let ago = |spans: usize| last.checked_sub(spans * span).and_then(|at| ways.get(at)).copied();
    let (here, before) = (ago(0)?, ago(1)?);
    let rise = here - before;
    if rise <= 0.0 {
        return Some(here);
    }
    let turned = (1..=last / span).find(|spans| ago(*spans) >= ago(spans - 1));
    let rising = turned.map_or(last as f64 / span as f64, |spans| (spans - 1) as f64);
    let share = ago(2).map_or(f64::INFINITY, |earlier| rise / (before - earlier));
    let slowing = match (0.0..1.0).contains(&share) {
        true => share.max(libm::pow(1.0 - RISEN, span as f64 / risen as f64)),
        false => return Some(here + rise * rising),
    };
    Some(here + rise * rising.min(slowing / (1.0 - slowing)))
}

//! What a flight shows.

mod seen;

use std::ops::RangeInclusive;

use fspid_sim::air::WindKind;
use fspid_sim::{Timing, Trace};

use super::aircraft;
use crate::flight::ControllerResult;
use crate::judgement::{Case, CasePlace, NotEvaluated, StepAt};
use crate::metrics::{Absent, EdgeMetrics, FlightMetrics, is_seen_to_stay};
use fspid_scenario::file::Study;
use fspid_scenario::measure::{Family, Measure};
use fspid_scenario::requirement::{Air, Conditions, Requirement};
use fspid_scenario::units::degrees;

/// Cases of a measure of a flight.
pub(super) fn cases(
    study: &Study,
    result: &ControllerResult,
    requirement: &Requirement,
) -> Result<Vec<Case>, NotEvaluated> {
    check_air(study, &requirement.conditions)?;
    let flown =
        Flown { trace: &result.trace, metrics: &result.metrics, timing: study.scenario.timing };
    match (requirement.measure, requirement.measure.family()) {
        (_, Family::Aircraft) => {
            let time = flown.time(&requirement.conditions)?;
            flown.is_seen_to_stay(&requirement.conditions)?;
            aircraft::case(study, &result.trace, requirement, time).map(|case| vec![case])
        }
        (Measure::RecoveryTime, _) => flown.recovery(&requirement.conditions, requirement.most),
        (Measure::FinalErrorAngle, _) => flown.final_errors(requirement),
        (_, Family::Step) => flown.steps(requirement),
        _ => flown.whole(requirement).map(|case| vec![case]),
    }
}

/// Refuses flights that have no measures at all, such as those that diverged.
pub(super) fn require_measures(result: &ControllerResult) -> Result<(), NotEvaluated> {
    result.metrics.effort.map(|_| ()).map_err(NotEvaluated::from)
}

/// Refuses a flight in another air than the one that is asked for.
pub(in crate::judgement) fn check_air(
    study: &Study,
    conditions: &Conditions,
) -> Result<(), NotEvaluated> {
    let Some(asked) = conditions.air else {
        return Ok(());
    };
    let weather = study.scenario.surroundings.weather.as_ref();
    let turbulent = weather.is_some_and(|weather| weather.turbulence.is_some());
    let gusts = weather
        .is_some_and(|weather| weather.winds.iter().any(|wind| wind.kind() != WindKind::Steady));
    let found = match (asked, turbulent, gusts) {
        (Air::Smooth, true, _) => "turbulence",
        (Air::Smooth, false, true) => "gusts",
        (Air::Turbulent, false, _) => "no turbulence",
        _ => return Ok(()),
    };
    Err(NotEvaluated::OtherAir { asked, found })
}

/// Samples of the time that counts of a flight of so many; the whole flight where no end is given.
pub(in crate::judgement) fn time_that_counts(
    timing: Timing,
    rows: usize,
    conditions: &Conditions,
) -> Result<RangeInclusive<usize>, NotEvaluated> {
    let end_s = timing.end_s();
    let (from_s, to_s) = (conditions.from_s.unwrap_or(0.0), conditions.to_s.unwrap_or(end_s));
    let first = timing.first_sample_at(from_s);
    // The sample at the end counts, and none after it.
    let last = match conditions.to_s {
        Some(to_s) => sample_up_to(timing, to_s),
        None => Some(rows.saturating_sub(1)),
    };
    match last {
        // From the last sample on, unless it is asked for itself, nothing was flown.
        Some(last) if first == last && rows > 1 && conditions.to_s.is_none() => {
            Err(NotEvaluated::NotFlown { from_s, to_s, end_s })
        }
        Some(last) if first <= last && last < rows => Ok(first..=last),
        _ => Err(NotEvaluated::NotFlown { from_s, to_s, end_s }),
    }
}

/// The last sample that is not after a time; none for a time after the end of the flight.
fn sample_up_to(timing: Timing, time_s: f64) -> Option<usize> {
    let next = timing.first_sample_at(time_s);
    // A time a rounding before a sample is on it, as everywhere.
    let allowance_s = 1e-6 * timing.dt_s();
    match next < timing.rows() {
        true if timing.time_s(next) <= time_s + allowance_s => Some(next),
        true => next.checked_sub(1),
        false => None,
    }
}

struct Flown<'a> {
    trace: &'a Trace,
    metrics: &'a FlightMetrics,
    timing: Timing,
}

impl Flown<'_> {
    /// The steps of the command that count.
    fn counted(
        &self,
        conditions: &Conditions,
    ) -> Result<Vec<(StepAt, &EdgeMetrics)>, NotEvaluated> {
        let steps = (1..).zip(&self.metrics.edges).map(|(number, edge)| {
            let (from_deg, to_deg) = (degrees(edge.from_rad), degrees(edge.to_rad));
            (StepAt { number, at_s: edge.at_s, from_deg, to_deg }, edge)
        });
        let steps: Vec<_> = steps.collect();
        let sizes = || steps.iter().map(|(step, _)| step.to_deg - step.from_deg);
        let counted: Vec<_> = steps
            .iter()
            .filter(|(step, _)| conditions.counts_step(step.to_deg - step.from_deg))
            .copied()
            .collect();
        match (counted.is_empty(), conditions.step_deg) {
            (false, _) => Ok(counted),
            (true, Some(asked_deg)) => {
                Err(NotEvaluated::NoStepOf { asked_deg, found_deg: sizes().collect() })
            }
            (true, None) => Err(NotEvaluated::Absent(Absent::NoStep)),
        }
    }

    fn steps(&self, requirement: &Requirement) -> Result<Vec<Case>, NotEvaluated> {
        let steps = self.counted(&requirement.conditions)?;
        let case = |(step, edge): &(StepAt, &EdgeMetrics)| {
            let value = match edge.step.measured(requirement.measure) {
                // Whether it is seen to stay depends on the time that it may take.
                Err(Absent::NotSettled { since_s: Some(since_s), .. }) => since_s,
                measured => measured?,
            };
            let case = Case { value, place: at_step(*step) };
            match requirement.measure {
                // What has not come there has not gone beyond it either.
                Measure::Overshoot => {
                    edge.step.rise_time_s?;
                    self.peaked(case, edge, requirement.most)
                }
                Measure::FinalError => self.left_pct(case, edge, requirement),
                Measure::SettlingTime => self.lasting(case, edge.window_s, requirement.most),
                _ => Ok(case),
            }
        };
        steps.iter().map(case).collect()
    }

    /// A time after which a flight stays where it is, if that is flown: up to the longest time that is allowed, or for a
    /// tenth of that time after it.
    fn lasting(
        &self,
        case: Case,
        window_s: f64,
        most_s: Option<f64>,
    ) -> Result<Case, NotEvaluated> {
        let allowance_s = 1e-6 * self.timing.dt_s();
        let asked = most_s.is_some_and(|most_s| window_s + allowance_s >= most_s);
        if asked || is_seen_to_stay(case.value, window_s) {
            return Ok(case);
        }
        Err(NotEvaluated::TooShort { settled_s: case.value, window_s, place: Box::new(case.place) })
    }

    /// Samples from a step to the last one before the next.
    fn window(&self, edge: &EdgeMetrics) -> RangeInclusive<usize> {
        let start = self.timing.first_sample_at(edge.at_s);
        let later = self.metrics.edges.iter().map(|edge| self.timing.first_sample_at(edge.at_s));
        let next = later.filter(|sample| *sample > start).min();
        start..=next.unwrap_or(self.trace.rows()).saturating_sub(1)
    }

    /// Errors of some samples, rad.
    fn errors_rad(&self, time: RangeInclusive<usize>) -> Vec<f64> {
        let setpoints = self.trace.setpoint_rad.get(time.clone()).unwrap_or_default();
        let thetas = self.trace.theta_rad.get(time).unwrap_or_default();
        setpoints.iter().zip(thetas).map(|(setpoint, theta)| setpoint - theta).collect()
    }

    fn final_errors(&self, requirement: &Requirement) -> Result<Vec<Case>, NotEvaluated> {
        let last = self.trace.rows().saturating_sub(1);
        let conditions = &requirement.conditions;
        // A command that never moves is held from the start to the end.
        if self.metrics.edges.is_empty() && conditions.step_deg.is_none() {
            let errors = self.errors_rad(0..=last);
            let error = |sample: usize| degrees(errors.get(sample).copied().unwrap_or(f64::NAN));
            let place = CasePlace { at_s: Some(self.timing.time_s(last)), ..CasePlace::default() };
            let case = Case { value: error(last).abs(), place };
            return Ok(vec![self.left(case, 0..=last, requirement, error)?]);
        }
        let steps = self.counted(conditions)?.into_iter();
        steps.map(|step| self.left_deg(step, requirement)).collect()
    }

    fn time(&self, conditions: &Conditions) -> Result<RangeInclusive<usize>, NotEvaluated> {
        time_that_counts(self.timing, self.trace.rows(), conditions)
    }

    /// Refuses a time from some second to the end of the flight that is too short to show that something is held, unless its
    /// end is asked for by itself.
    fn is_seen_to_stay(&self, conditions: &Conditions) -> Result<(), NotEvaluated> {
        let end_s = self.timing.end_s();
        match conditions.from_s.filter(|_| conditions.to_s.is_none()) {
            Some(from_s) if !is_seen_to_stay(from_s, end_s + 1e-6 * self.timing.dt_s()) => {
                Err(NotEvaluated::LittleFlown { from_s, end_s })
            }
            _ => Ok(()),
        }
    }

    fn recovery(
        &self,
        conditions: &Conditions,
        most_s: Option<f64>,
    ) -> Result<Vec<Case>, NotEvaluated> {
        let within_deg = conditions.within_deg.unwrap_or(0.0);
        if let Some(from_s) = conditions.from_s {
            let place = CasePlace { at_s: Some(from_s), ..CasePlace::default() };
            let errors = self.errors_rad(self.time(conditions)?).into_iter().map(degrees);
            let errors: Vec<f64> = errors.collect();
            return Ok(vec![self.recovered(&errors, within_deg, most_s, place)?]);
        }
        let case = |(step, edge): &(StepAt, &EdgeMetrics)| {
            let theta = self.trace.theta_rad.get(self.window(edge)).unwrap_or_default();
            let errors: Vec<f64> = theta.iter().map(|theta| degrees(edge.to_rad - theta)).collect();
            self.recovered(&errors, within_deg, most_s, at_step(*step))
        };
        self.counted(conditions)?.iter().map(case).collect()
    }

    /// The time after the first of some errors from which on they stay within a band, between samples by a straight line.
    fn recovered(
        &self,
        errors_deg: &[f64],
        within_deg: f64,
        most_s: Option<f64>,
        place: CasePlace,
    ) -> Result<Case, NotEvaluated> {
        let window_s = errors_deg.len().saturating_sub(1) as f64 * self.timing.dt_s();
        // Written so that NaN is outside.
        let is_outside = |error: &f64| !(error.abs() <= within_deg);
        let Some(outside) = errors_deg.iter().rposition(is_outside) else {
            return self.undisturbed(place, window_s, most_s);
        };
        match errors_deg.get(outside..) {
            Some([before, after, ..]) => {
                let edge = within_deg.copysign(*before);
                let share = (before - edge) / (before - after);
                let value = (outside as f64 + share) * self.timing.dt_s();
                self.lasting(Case { value, place }, window_s, most_s)
            }
            _ => {
                let place = Box::new(place);
                Err(NotEvaluated::NotRecovered { within_deg, window_s, place })
            }
        }
    }

    /// An error that never left its band, which is seen to stay there for as long as it may take to come back.
    fn undisturbed(
        &self,
        place: CasePlace,
        window_s: f64,
        most_s: Option<f64>,
    ) -> Result<Case, NotEvaluated> {
        let allowance_s = 1e-6 * self.timing.dt_s();
        if most_s.is_none_or(|most_s| window_s + allowance_s >= most_s) {
            return Ok(Case { value: 0.0, place });
        }
        Err(NotEvaluated::TooShort { settled_s: 0.0, window_s, place: Box::new(place) })
    }

    /// A measure of the whole flight or of the time that counts, which is seen to stay so.
    fn whole(&self, requirement: &Requirement) -> Result<Case, NotEvaluated> {
        let time = self.time(&requirement.conditions)?;
        self.is_seen_to_stay(&requirement.conditions)?;
        let value = match requirement.measure {
            Measure::LargestError => return Ok(self.largest_error(time)),
            Measure::RmsError => self.rms_deg(time),
            measure => self.metrics.measured(measure)?,
        };
        Ok(Case { value, place: CasePlace::default() })
    }

    /// As in the metrics of a flight, in radians first.
    fn rms_deg(&self, time: RangeInclusive<usize>) -> f64 {
        let errors = self.errors_rad(time);
        let squares: f64 = errors.iter().map(|error| error * error).sum();
        degrees((squares / errors.len() as f64).sqrt())
    }

    fn largest_error(&self, time: RangeInclusive<usize>) -> Case {
        let first = *time.start();
        let mut largest = Case { value: 0.0, place: CasePlace::default() };
        for (sample, error_rad) in (first..).zip(self.errors_rad(time)) {
            let value = degrees(error_rad.abs());
            // Written so that NaN is the largest, whatever comes after it.
            if !(value <= largest.value || largest.value.is_nan()) {
                let place =
                    CasePlace { at_s: Some(self.timing.time_s(sample)), ..CasePlace::default() };
                largest = Case { value, place };
            }
        }
        largest
    }
}

fn at_step(step: StepAt) -> CasePlace {
    CasePlace { step: Some(step), ..CasePlace::default() }
}

#[cfg(test)]
mod tests;

//! Derivatives of measures with respect to each sample of a flight, and of
//! measures of the linear loop alone by differences.
//!
//! Every measure that is an integral, a sum of sizes or an extreme has a slope; at a corner (an error of zero, two samples
//! that are the largest) it is that of one side. Times have none worth following: they jump.

use std::ops::RangeInclusive;

use fspid_numeric::Scalar;
use fspid_scenario::file::Study;
use fspid_scenario::measure::{Family, Measure};
use fspid_scenario::requirement::Requirement;
use fspid_scenario::units::degrees;
use fspid_sim::Timing;
use fspid_sim::gradient::{Flown, Slopes, add_variation};
use fspid_sim::signal::Edge;

use super::NotEvaluated;
use super::evidence::{check_air, loop_cases, time_that_counts};
use super::judge::worst;

/// Where the slope of a measure comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SlopeOf {
    /// The samples of the flight: [`add_slopes`].
    Flight,
    /// Differences of the linear loop, which fly nothing: [`of_loop`].
    Loop,
    /// It is the same whatever the controller does.
    Nothing,
}

impl SlopeOf {
    /// Of a measure; none for one that jumps, or that only a nonlinear aircraft has.
    #[must_use]
    pub fn measure(measure: Measure) -> Option<Self> {
        match measure {
            Measure::RiseTime
            | Measure::SettlingTime
            | Measure::RecoveryTime
            | Measure::Saturated
            | Measure::FrozenStable
            | Measure::Certified => None,
            // A flight whose loop is unstable at rest is lost whatever else it is.
            Measure::Stable => Some(Self::Nothing),
            other => match other.family() {
                Family::Step | Family::Flight => Some(Self::Flight),
                Family::Loop | Family::Frozen => Some(Self::Loop),
                Family::Airframe => Some(Self::Nothing),
                Family::Aircraft | Family::Proof => None,
            },
        }
    }
}

/// True where a requirement says something of flights of a study: they are in the air that it asks for.
#[must_use]
pub fn is_of_this_air(study: &Study, requirement: &Requirement) -> bool {
    check_air(study, &requirement.conditions).is_ok()
}

/// A measure of the linear loop of a study's only controller: the worst of its plants, rests and gains.
///
/// # Errors
/// [`NotEvaluated`] where there is none.
pub fn of_loop(study: &Study, requirement: &Requirement) -> Result<f64, NotEvaluated> {
    let cases = loop_cases(study, requirement)?;
    worst(requirement, &cases).map(|case| requirement.measure.compared(case.value))
}

/// A flight of which slopes are asked.
#[derive(Clone, Copy, Debug)]
pub struct Sloped<'a> {
    /// As it was flown.
    pub flown: &'a Flown,
    /// The steps of its command.
    pub edges: &'a [Edge],
    /// Its samples.
    pub timing: Timing,
}

/// Adds what a little more of each sample changes of `weight` times a measure, in the measure's unit, and answers the
/// measure; nothing is added and answered for one without a value.
pub fn add_slopes(
    flight: Sloped<'_>,
    requirement: &Requirement,
    weight: f64,
    slopes: &mut Slopes,
) -> Option<f64> {
    let per_deg = degrees(weight);
    let Sloped { flown, timing, .. } = flight;
    let dt_s = timing.dt_s();
    let value = match requirement.measure {
        Measure::Overshoot | Measure::FinalError | Measure::FinalErrorAngle => {
            return flight.of_steps(requirement, weight, slopes);
        }
        Measure::ErrorIntegral | Measure::TimedErrorIntegral => {
            return Some(flight.integral(requirement.measure, per_deg, slopes));
        }
        Measure::RmsError | Measure::LargestError => {
            return flight.of_window(requirement, per_deg, slopes);
        }
        Measure::LargestCommand => {
            let (place, largest) = largest(flown.command_rad.iter().map(|it| it.abs()))?;
            slopes.command_rad[place] += per_deg * flown.command_rad[place].sign();
            largest
        }
        Measure::CommandVariation => {
            add_variation(&flown.command_rad, per_deg, &mut slopes.command_rad)
        }
        Measure::ElevatorTravel => {
            add_variation(&flown.elevator_rad, per_deg, &mut slopes.elevator_rad)
        }
        Measure::CommandRate => {
            fastest(&flown.command_rad, per_deg / dt_s, &mut slopes.command_rad)? / dt_s
        }
        Measure::ElevatorRate => {
            fastest(&flown.elevator_rad, per_deg / dt_s, &mut slopes.elevator_rad)? / dt_s
        }
        _ => return None,
    };
    Some(degrees(value))
}

impl Sloped<'_> {
    fn error_rad(&self, sample: usize) -> f64 {
        self.flown.setpoint_rad[sample] - self.flown.theta_rad[sample]
    }

    /// The steps that have a response, each with its samples.
    fn steps(&self) -> Vec<(&Edge, RangeInclusive<usize>)> {
        let rows = self.flown.theta_rad.len();
        let edges: Vec<&Edge> = self.edges.iter().filter(|edge| edge.sample + 1 < rows).collect();
        let ends = edges.iter().skip(1).map(|edge| edge.sample).chain([rows]);
        edges.iter().zip(ends).map(|(edge, end)| (*edge, edge.sample..=end - 1)).collect()
    }

    /// $T \sum |e_k|$ or, timed, $T \sum t_k |e_k|$ with time from the last step on, deg s or deg s².
    fn integral(&self, measure: Measure, per_deg: f64, slopes: &mut Slopes) -> f64 {
        let (dt_s, mut sum, mut from) = (self.timing.dt_s(), 0.0, 0);
        let mut steps = self.steps().into_iter().map(|(edge, _)| edge.sample).peekable();
        for sample in 0..self.flown.theta_rad.len() {
            from = steps.next_if(|start| *start <= sample).unwrap_or(from);
            let time = (sample - from) as f64 * dt_s;
            let weight = if measure == Measure::ErrorIntegral { dt_s } else { dt_s * time };
            let error_rad = self.error_rad(sample);
            sum += weight * error_rad.abs();
            slopes.theta_rad[sample] -= per_deg * weight * error_rad.sign();
        }
        degrees(sum)
    }

    /// Root mean square or largest size of the error in the time that counts, deg.
    fn of_window(
        &self,
        requirement: &Requirement,
        per_deg: f64,
        slopes: &mut Slopes,
    ) -> Option<f64> {
        let rows = self.flown.theta_rad.len();
        let time = time_that_counts(self.timing, rows, &requirement.conditions).ok()?;
        let first = *time.start();
        if requirement.measure == Measure::LargestError {
            let (place, value) = largest(time.map(|sample| self.error_rad(sample).abs()))?;
            slopes.theta_rad[first + place] -= per_deg * self.error_rad(first + place).sign();
            return Some(degrees(value));
        }
        let count = time.clone().count() as f64;
        let squares: f64 =
            time.clone().map(|sample| self.error_rad(sample) * self.error_rad(sample)).sum();
        let rms_rad = (squares / count).sqrt();
        if rms_rad > 0.0 {
            for sample in time {
                slopes.theta_rad[sample] -= per_deg * self.error_rad(sample) / (count * rms_rad);
            }
        }
        Some(degrees(rms_rad))
    }

    /// Overshoot or final error of the worst step that counts.
    fn of_steps(&self, requirement: &Requirement, weight: f64, slopes: &mut Slopes) -> Option<f64> {
        let steps = self.steps();
        let counted = steps.iter().filter(|(edge, _)| {
            requirement.conditions.counts_step(degrees(edge.to_rad) - degrees(edge.from_rad))
        });
        let found = counted.map(|(edge, time)| self.of_step(requirement.measure, edge, time));
        let found: Vec<Step> = found.collect();
        let slack = |step: &Step| requirement.slack(step.value);
        let worst = found
            .into_iter()
            .reduce(|worst, step| if slack(&step) < slack(&worst) { step } else { worst })?;
        slopes.theta_rad[worst.sample] += weight * worst.by_theta;
        Some(requirement.measure.compared(worst.value))
    }

    fn of_step(&self, measure: Measure, edge: &Edge, time: &RangeInclusive<usize>) -> Step {
        let theta_rad = &self.flown.theta_rad;
        let step_rad = edge.to_rad - edge.from_rad;
        let last = *time.end();
        let left_rad = edge.to_rad - theta_rad[last];
        match measure {
            Measure::Overshoot => {
                let way = |sample: usize| (theta_rad[sample] - edge.from_rad) / step_rad;
                let (place, highest) =
                    largest(time.clone().map(way)).unwrap_or((0, f64::NEG_INFINITY));
                let beyond = 100.0 * (highest - 1.0);
                let by_theta = if beyond > 0.0 { 100.0 / step_rad } else { 0.0 };
                Step { value: beyond.max(0.0), sample: time.start() + place, by_theta }
            }
            Measure::FinalError => {
                let per_rad = 100.0 / step_rad.abs();
                let by_theta = -per_rad * left_rad.sign();
                Step { value: per_rad * left_rad, sample: last, by_theta }
            }
            _ => {
                let by_theta = -degrees(left_rad.sign());
                Step { value: degrees(left_rad.abs()), sample: last, by_theta }
            }
        }
    }
}

/// A measure of a step, and the sample and slope that its size depends on.
struct Step {
    value: f64,
    sample: usize,
    by_theta: f64,
}

/// The first of the largest numbers, and its place.
fn largest(values: impl Iterator<Item = f64>) -> Option<(usize, f64)> {
    values.enumerate().reduce(|most, it| if it.1 > most.1 { it } else { most })
}

/// Adds the slope of the largest change from sample to sample, and answers it without the weight.
fn fastest(values: &[f64], weight: f64, slopes: &mut [f64]) -> Option<f64> {
    let (place, most) = largest(values.windows(2).map(|pair| (pair[1] - pair[0]).abs()))?;
    let by = weight * (values[place + 1] - values[place]).sign();
    slopes[place + 1] += by;
    slopes[place] -= by;
    Some(most)
}

//! All measures of one controller's flight, and its verdict.

use std::fmt;

use fspid_sim::signal::Edge;
use fspid_sim::stability::Unstable;
use fspid_sim::{EarlyEnd, Exit, Outcome, Timing, Trace};

use super::{
    Absent, CommandEffort, ErrorIntegrals, Measured, Metric, StepMetrics, StepWindow,
    largest_error_rad, left_validity,
};
use fspid_diagnostics::digits::to_digits;
use fspid_scenario::measure::Measure;

/// What a flight comes to, in one word.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// Every step of the command was settled, and seen to stay so for a tenth of the time that it took.
    Settled,
    /// Some step was not settled in its window.
    NotSettled {
        /// Length of that window, s.
        window_s: f64,
        /// From when on it was in its band after all, too late to be seen to stay there, s after the step.
        since_s: Option<f64>,
    },
    /// There was no step to settle.
    Flown,
    /// The flight ended before its last sample: it diverged, hit the ground, or lost its controller or its simulator.
    EndedEarly(EarlyEnd),
    /// The loop is unstable at the gains that it has at rest, although the flight did not diverge in its window.
    Unstable {
        /// Spectral radius of the sampled closed loop.
        spectral_radius: f64,
        /// Time in which what grows becomes twice as large, s.
        doubling_s: f64,
    },
    /// The autopilot waited in vain for a mode to begin. Its measures are there, and are not those of the flight that the
    /// scenario describes.
    ModeNeverBegan {
        /// Number of the mode, from 0.
        mode: usize,
    },
    /// It left the range of its aircraft's data, which its scenario does not allow. Its measures are there, and are of
    /// data that do not hold: [`Ending`](crate::flight::Ending) says it of a flight, its metrics never do.
    LeftRange(Exit),
}

impl Verdict {
    /// True for a loop that can be called good as far as the flight tells.
    #[must_use]
    pub fn is_good(self) -> bool {
        matches!(self, Self::Settled | Self::Flown)
    }

    /// True for a flight that fails by itself: it diverged, hit the ground, lost its controller, left the range of its data, waited in vain for
    /// a mode of its autopilot, or its loop is unstable at rest.
    #[must_use]
    pub fn is_failure(self) -> bool {
        match self {
            Self::Settled | Self::NotSettled { .. } | Self::Flown => false,
            Self::EndedEarly(_)
            | Self::Unstable { .. }
            | Self::ModeNeverBegan { .. }
            | Self::LeftRange(_) => true,
        }
    }

    /// Its kind in a word or two, for programs.
    #[must_use]
    pub fn kind(self) -> &'static str {
        match self {
            Self::Settled => "settled",
            Self::NotSettled { .. } => "not settled",
            Self::Flown => "flown",
            Self::EndedEarly(end) => end.cause.kind(),
            Self::Unstable { .. } => "unstable at rest",
            Self::ModeNeverBegan { .. } => "mode never began",
            Self::LeftRange(_) => "left the range",
        }
    }

    /// Why nothing can be measured, where that is so.
    fn absence(self) -> Option<Absent> {
        match self {
            Self::EndedEarly(end) => Some(Absent::EndedEarly(end)),
            Self::Unstable { spectral_radius, .. } => Some(Absent::Unstable { spectral_radius }),
            Self::Settled
            | Self::NotSettled { .. }
            | Self::Flown
            | Self::ModeNeverBegan { .. }
            | Self::LeftRange(_) => None,
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Settled => f.write_str("settled"),
            Self::NotSettled { window_s, since_s } => {
                Absent::NotSettled { window_s: *window_s, since_s: *since_s }.fmt(f)
            }
            Self::Flown => f.write_str("flown"),
            Self::EndedEarly(end) => Absent::EndedEarly(*end).fmt(f),
            Self::Unstable { spectral_radius, doubling_s } => {
                write!(f, "unstable at rest (")?;
                if doubling_s.is_finite() {
                    write!(f, "doubles every {} s, ", to_digits(*doubling_s, 3))?;
                }
                write!(f, "spectral radius {spectral_radius:.6})")
            }
            Self::ModeNeverBegan { mode } => {
                write!(f, "mode {} of the autopilot never began", mode + 1)
            }
            Self::LeftRange(exit) => f.write_str(&left_validity(exit)),
        }
    }
}

/// The measures of one step of the command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeMetrics {
    /// Time of the step, s.
    pub at_s: f64,
    /// Set-point before, rad.
    pub from_rad: f64,
    /// Set-point after, rad.
    pub to_rad: f64,
    /// Time from the step to the last sample before the next one, s.
    pub window_s: f64,
    /// Measures up to the next step.
    pub step: StepMetrics,
    /// When a disturbance first begins within that time or with the step, s: the measures are those of both.
    pub disturbed_from_s: Option<f64>,
}

/// The measures of one controller's flight.
#[derive(Clone, Debug, PartialEq)]
pub struct FlightMetrics {
    /// What it comes to.
    pub verdict: Verdict,
    /// Each step of the command, downward ones too.
    pub edges: Vec<EdgeMetrics>,
    /// Integrals of the error over the whole flight.
    pub integrals: Result<ErrorIntegrals, Absent>,
    /// Root mean square of the error over the samples of the whole flight, rad.
    pub rms_error_rad: Measured,
    /// Largest error, rad; of a flight that is lost, up to there.
    pub largest_error_rad: f64,
    /// Effort of the command over the whole flight.
    pub effort: Result<CommandEffort, Absent>,
    /// The same of the elevator.
    pub elevator: Result<CommandEffort, Absent>,
    /// Samples whose command was cut by the controller's own limits, as a share of those flown.
    pub saturated_share: Measured,
    /// True for a flight that is not good and whose first movement after its first step is steadily away from the
    /// new set-point, before anything but the command moves it: see `moves_away`. It is a question, and no failure.
    pub wrong_way: bool,
}

impl FlightMetrics {
    /// Measures a trace; `unstable` is what the linear loop says of itself, and `pushes_s` when something else than the
    /// command begins to move the aircraft ([`Scenario::pushes_s`](fspid_sim::Scenario::pushes_s)).
    #[must_use]
    pub fn of(
        trace: &Trace,
        edges: &[Edge],
        timing: Timing,
        unstable: Option<Unstable>,
        pushes_s: &[f64],
    ) -> Self {
        let failed = match (trace.outcome, unstable) {
            (Outcome::EndedEarly(end), _) => Some(Verdict::EndedEarly(end)),
            (Outcome::Completed | Outcome::ModeNeverBegan { .. }, Some(unstable)) => {
                Some(Verdict::Unstable {
                    spectral_radius: unstable.spectral_radius,
                    doubling_s: unstable.doubling_s,
                })
            }
            (Outcome::ModeNeverBegan { mode }, None) => Some(Verdict::ModeNeverBegan { mode }),
            (Outcome::Completed, None) => None,
        };
        let absence = failed.and_then(Verdict::absence);
        let first_push_s = pushes_s.first().copied().unwrap_or(f64::INFINITY);
        let quiet = timing.first_sample_at(first_push_s);
        let away =
            edges.first().is_some_and(|edge| moves_away(trace, edge, failed.is_some(), quiet));
        let edges = edge_metrics(trace, edges, timing, absence, pushes_s);
        let restarts: Vec<usize> =
            edges.iter().map(|edge| timing.first_sample_at(edge.at_s)).collect();
        let errors = trace.setpoint_rad.iter().zip(&trace.theta_rad).map(|(r, y)| r - y);
        let (integrals, squares) =
            ErrorIntegrals::with_sum_of_squares(errors, timing.dt_s(), &restarts);
        let measured = absence.map_or(Ok(()), Err);
        let verdict = failed.unwrap_or_else(|| verdict(&edges));
        Self {
            verdict,
            wrong_way: away && !verdict.is_good(),
            integrals: measured.map(|()| integrals),
            rms_error_rad: measured.map(|()| (squares / trace.rows() as f64).sqrt()),
            largest_error_rad: largest_error_rad(&trace.setpoint_rad, &trace.theta_rad),
            effort: measured.map(|()| CommandEffort::of(&trace.command_rad, timing.dt_s())),
            elevator: measured.map(|()| CommandEffort::of(&trace.elevator_rad, timing.dt_s())),
            saturated_share: measured
                .map(|()| trace.saturated_samples as f64 / trace.rows().max(1) as f64),
            edges,
        }
    }

    /// The measures of the first step of the command.
    #[must_use]
    pub fn first_step(&self) -> StepMetrics {
        match (self.edges.first(), self.verdict.absence()) {
            (Some(edge), _) => edge.step,
            (None, Some(reason)) => StepMetrics::absent(reason),
            (None, None) => StepMetrics::absent(Absent::NoStep),
        }
    }

    /// A measure that can be asked for, of one of a step in the first; there is no step to measure what is not one of
    /// [`METRICS`](super::METRICS).
    ///
    /// # Errors
    /// The reason in the metrics.
    pub fn measured(&self, measure: Measure) -> Measured {
        Metric::asked_as(measure).map_or(Err(Absent::NoStep), |metric| metric.of_flight(self))
    }

    /// A measure of the step number `index` from 0; absent where there is no such step.
    pub fn of_step(&self, index: usize, measure: impl Fn(&StepMetrics) -> Measured) -> Measured {
        self.edges.get(index).map_or(Err(Absent::NoStep), |edge| measure(&edge.step))
    }
}

/// Share of a step that counts as having moved towards the new set-point.
const TOWARDS: f64 = 0.02;
/// How far away a response counts as lost on the wrong side, as a share of the step.
const AWAY: f64 = 1.0;

/// True where a response is a whole step on the wrong side before it was a fiftieth of the step on the right one, or
/// leaves every range on that side. A loop whose aircraft dips before it rises turns back long before; one that is as
/// far away as the step was high does not. A flight that was not lost must end there too, so that a gust just after the
/// step is not taken for it; and the movement must be one of the first `quiet` samples, which nothing but the command
/// moves, so that a load is not.
fn moves_away(trace: &Trace, edge: &Edge, lost: bool, quiet: usize) -> bool {
    let step_rad = edge.to_rad - edge.from_rad;
    let response = trace.theta_rad.get(edge.sample..).unwrap_or_default();
    let Some(start_rad) = response.first() else {
        return false;
    };
    let way = response.iter().map(|theta_rad| (theta_rad - start_rad) / step_rad);
    let ends_away = way.clone().next_back().is_some_and(|way| way <= -AWAY);
    let first = (edge.sample..).zip(way).find(|(_, way)| *way >= TOWARDS || *way <= -AWAY);
    first.is_some_and(|(sample, way)| way < 0.0 && sample < quiet) && (lost || ends_away)
}

fn edge_metrics(
    trace: &Trace,
    edges: &[Edge],
    timing: Timing,
    absence: Option<Absent>,
    pushes_s: &[f64],
) -> Vec<EdgeMetrics> {
    // A step at the very last sample has no response to measure.
    let edges: Vec<&Edge> = edges.iter().filter(|edge| edge.sample + 1 < timing.rows()).collect();
    let ends = edges.iter().skip(1).map(|edge| edge.sample).chain([timing.rows()]);
    edges
        .iter()
        .zip(ends)
        .map(|(edge, end)| {
            let window = edge.sample..end.min(trace.rows());
            let last = edge.sample + window.len().saturating_sub(1);
            let window_s = timing.time_s(last) - timing.time_s(edge.sample);
            let step =
                match (absence, trace.time_s.get(window.clone()), trace.theta_rad.get(window)) {
                    (None, Some(time_s), Some(response)) => {
                        let (from, to) = (edge.from_rad, edge.to_rad);
                        StepMetrics::of(StepWindow { time_s, response, from, to })
                    }
                    (Some(reason), ..) => StepMetrics::absent(reason),
                    _ => StepMetrics::absent(Absent::NoStep),
                };
            let at_s = timing.time_s(edge.sample);
            let within = |push_s: &&f64| {
                let sample = timing.first_sample_at(**push_s);
                edge.sample <= sample && sample + 1 < end
            };
            let disturbed_from_s = pushes_s.iter().find(within).copied();
            let (from_rad, to_rad) = (edge.from_rad, edge.to_rad);
            EdgeMetrics { at_s, from_rad, to_rad, window_s, step, disturbed_from_s }
        })
        .collect()
}

fn verdict(edges: &[EdgeMetrics]) -> Verdict {
    if edges.is_empty() {
        return Verdict::Flown;
    }
    edges
        .iter()
        .find_map(|edge| match edge.step.settling_time_s {
            Err(Absent::NotSettled { window_s, since_s }) => {
                Some(Verdict::NotSettled { window_s, since_s })
            }
            _ => None,
        })
        .unwrap_or(Verdict::Settled)
}

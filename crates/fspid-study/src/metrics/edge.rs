//! The measures of the steps of a flight, and whether they are the step's own or those of a disturbance as well.

use std::ops::Range;

use fspid_sim::signal::Edge;
use fspid_sim::{Timing, Trace};

use super::{Absent, StepMetrics, StepWindow, Verdict};

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
    /// When a disturbance first begins, or moves on, within that time or with the step, s: the measures are those of both.
    pub disturbed_from_s: Option<f64>,
    /// That the step was not settled when the disturbance began, where that is so: how it goes on is not its own.
    pub unsettled: Option<Absent>,
}

impl EdgeMetrics {
    /// The verdict on a step that was not settled; none for one that was.
    pub(super) fn not_settled(&self) -> Option<Verdict> {
        let window_s = self.window_s;
        let not_settled = |since_s, disturbed_from_s| {
            Some(Verdict::NotSettled { window_s, since_s, disturbed_from_s })
        };
        match self.step.settling_time_s {
            Err(Absent::NotSettled { since_s, .. }) => not_settled(since_s, None),
            Err(Absent::Disturbed { from_s, since_s, .. }) => not_settled(since_s, Some(from_s)),
            _ => None,
        }
    }
}

/// The measures of each step of a flight; `absence` is why there are none, and `pushes_s` when something else than the command
/// moves the aircraft, ascending.
pub(super) fn edge_metrics(
    trace: &Trace,
    edges: &[Edge],
    timing: Timing,
    absence: Option<Absent>,
    pushes_s: &[f64],
) -> Vec<EdgeMetrics> {
    // A step at the very last sample has no response to measure.
    let edges: Vec<&Edge> = edges.iter().filter(|edge| edge.sample + 1 < timing.rows()).collect();
    let ends = edges.iter().skip(1).map(|edge| edge.sample).chain([timing.rows()]);
    let of_step = |(edge, end): (&&Edge, usize)| {
        let flown = end.min(trace.rows());
        let at_s = timing.time_s(edge.sample);
        let last = flown.saturating_sub(1).max(edge.sample);
        let window_s = timing.time_s(last) - at_s;
        let first = pushes_s.partition_point(|it| timing.first_sample_at(*it) < edge.sample);
        let is_within = |push_s: &f64| timing.first_sample_at(*push_s) + 1 < end;
        let disturbed_from_s = pushes_s.get(first).copied().filter(is_within);
        let mut step = measured(trace, edge, edge.sample..flown, absence);
        let unsettled = disturbed_from_s.and_then(|from_s| {
            // What begins at a sample moves the pitch angle after it.
            let own = edge.sample..flown.min(timing.first_sample_at(from_s) + 1);
            let before = measured(trace, edge, own, absence);
            step.without_disturbance(&before, Before { from_s, window_s })
        });
        let (from_rad, to_rad) = (edge.from_rad, edge.to_rad);
        EdgeMetrics { at_s, from_rad, to_rad, window_s, step, disturbed_from_s, unsettled }
    };
    edges.iter().zip(ends).map(of_step).collect()
}

/// The measures of a step by some samples of its response.
fn measured(
    trace: &Trace,
    edge: &Edge,
    samples: Range<usize>,
    absence: Option<Absent>,
) -> StepMetrics {
    match (absence, trace.time_s.get(samples.clone()), trace.theta_rad.get(samples)) {
        (None, Some(time_s), Some(response)) => {
            let (from, to) = (edge.from_rad, edge.to_rad);
            StepMetrics::of(StepWindow { time_s, response, from, to })
        }
        (Some(reason), ..) => StepMetrics::absent(reason),
        _ => StepMetrics::absent(Absent::NoStep),
    }
}

/// The time that a step has to itself.
#[derive(Clone, Copy)]
struct Before {
    /// When a disturbance begins, s.
    from_s: f64,
    /// How long the step has in all, s.
    window_s: f64,
}

impl StepMetrics {
    /// Takes out the times that a disturbance may have brought: to rise, of what had not risen `before` it began, and to
    /// settle, of what had not settled and was not seen to stay so. Answers the latter.
    fn without_disturbance(&mut self, before: &Self, time: Before) -> Option<Absent> {
        let left_pct = before.final_error_pct.ok()?;
        let Before { from_s, window_s } = time;
        let reason = |since_s| {
            let way_pct = 100.0 - left_pct;
            Absent::Disturbed { from_s, way_pct, since_s, window_s }
        };
        if before.rise_time_s.is_err() {
            self.rise_time_s = self.rise_time_s.and(Err(reason(None)));
        }
        let since_s = match before.settling_time_s {
            Ok(_) => return None,
            Err(Absent::NotSettled { since_s, .. }) => since_s,
            Err(_) => None,
        };
        let unsettled = reason(since_s);
        for time_s in [&mut self.settling_time_s, &mut self.transient_time_s] {
            if matches!(time_s, Ok(_) | Err(Absent::NotSettled { since_s: Some(_), .. })) {
                *time_s = Err(unsettled);
            }
        }
        Some(unsettled)
    }
}

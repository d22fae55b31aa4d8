//! Flights in words.

use fspid_sim::describing::{LimitCycle, LimitCycles};
use fspid_sim::flown::empirical::{EmpiricalAnswer, EmpiricalMargins};
use fspid_sim::flown::trajectory::TrajectoryLinearisation;
use fspid_sim::flown::{Failure, Margin};

use super::Flights;
use crate::analysis::decibels;
use fspid_scenario::units::degrees;

impl Flights {
    /// One line for each thing that flights say, a label and a sentence.
    #[must_use]
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let mut lines = empirical_lines(&self.empirical);
        lines.extend(cycles(&self.limit_cycles));
        lines.extend(self.along.as_ref().map(|along| ("along the flight", sentence(along))));
        lines
    }
}

/// The lines of what a flight bears.
pub(in crate::analysis) fn empirical_lines(
    answer: &EmpiricalAnswer,
) -> Vec<(&'static str, String)> {
    const LABEL: &str = "flown margins";
    match answer {
        EmpiricalAnswer::Margins(margins) => flown_margins(margins),
        EmpiricalAnswer::NominalFails { failure, .. } => {
            vec![(LABEL, format!("none: the flight itself does not hold ({failure})"))]
        }
        EmpiricalAnswer::NothingMoves => {
            vec![(LABEL, "none: nothing moves in this flight".to_owned())]
        }
    }
}

fn flown_margins(margins: &EmpiricalMargins) -> Vec<(&'static str, String)> {
    let db = |margin: &Margin, way| {
        between(margin, way, |factor| format!("{:+.2} dB", decibels(factor)))
    };
    let gain = format!("gain {}; {}", db(&margins.gain_down, "down"), db(&margins.gain_up, "up"));
    let delay = format!("delay {}", between(&margins.delay_s, "up", |s| format!("{s:.4} s")));
    let lag = margins.phase.iter().map(|phase| {
        let size = between(&phase.lag_rad, "up", |rad| format!("{:.1} deg", degrees(rad)));
        format!("lag at {:.3} rad/s {size}", phase.at_rad_s)
    });
    let rest: Vec<String> = std::iter::once(delay).chain(lag).collect();
    vec![("flown margins", format!("{gain} ({} flights)", margins.flights)), ("", rest.join("; "))]
}

/// Where a flight ceases to hold, in words; `way` is where it was looked for.
fn between(margin: &Margin, way: &str, shown: impl Fn(f64) -> String) -> String {
    match margin {
        Margin::Between { holds, fails, failure } => {
            // Who reads "fails" thinks of the loop.
            let lost = match failure {
                Failure::EndedEarly(end) if end.cause.loss_kind().is_some() => {
                    format!(" ({failure})")
                }
                _ => String::new(),
            };
            format!("holds at {}, fails at {}{lost}", shown(*holds), shown(*fails))
        }
        Margin::Beyond { held } => format!("holds {way} to {} and further", shown(*held)),
    }
}

fn cycles(found: &LimitCycles) -> Vec<(&'static str, String)> {
    const LABEL: &str = "limit cycles";
    match found {
        LimitCycles::NothingLimits => Vec::new(),
        LimitCycles::NoneFound { searched } => {
            let (least, most) = searched.amplitude_rad;
            let (from, to) = searched.frequency_rad_s;
            vec![(
                LABEL,
                format!(
                    "describing functions predict none for commands of {:.3} to {:.0} deg, {from:.3} to {to:.1} rad/s (an approximation)",
                    degrees(least),
                    degrees(most)
                ),
            )]
        }
        LimitCycles::Cycles(cycles) => {
            cycles.iter().map(|cycle| (LABEL, one_cycle(cycle))).collect()
        }
    }
}

fn one_cycle(cycle: &LimitCycle) -> String {
    let kind = if cycle.stable {
        "PREDICTED: an oscillation that sustains itself"
    } else {
        "predicted: a border beyond which oscillations grow"
    };
    format!(
        "{kind}, pitch {:.3} deg, elevator {:.3} deg, period {:.3} s (an approximation)",
        degrees(cycle.pitch_amplitude_rad),
        degrees(cycle.elevator_amplitude_rad),
        cycle.period_s
    )
}

fn sentence(along: &TrajectoryLinearisation) -> String {
    let worst = match (&along.worst_frozen, &along.worst) {
        (Some(frozen), Some(moving)) => format!(
            "largest spectral radius {:.6} at {:.2} s with gains frozen, {:.6} at {:.2} s with their derivatives",
            frozen.radius, frozen.time_s, moving.radius, moving.time_s
        ),
        _ => "every sample is limited".to_owned(),
    };
    let growth = along.growth;
    format!(
        "{worst}; a small disturbance grows by a factor of {:.3} at most ({:.2} s to {:.2} s), and over the whole flight by exp({:+.3} t)",
        growth.largest, growth.from_s, growth.to_s, growth.exponent_1_s
    )
}

//! Bandwidth and phase delay: how fast a pilot can follow an attitude before the loop through him swings.

use core::f64::consts::PI;

use fspid_lti::FrequencyResponse;

use super::absent::Absent;
use super::level::{Category, Confidence, Judgement, Level, Requirement};
use super::model::PitchModel;

/// Bandwidth and phase delay together.
pub(super) const BANDWIDTH: Requirement = Requirement {
    title: "pitch attitude bandwidth",
    clause: "MIL-STD-1797A 4.2.1.2, appendix A, section D",
    confidence: Confidence::Digitised,
    note: "edges of the chart of category A as read off by others; everything beyond level 2 counts as level 3, the chart ends there",
};

/// Least bandwidth in rad/s of level 1 by phase delay in s, category A.
const LEVEL_1: [(f64, f64); 9] = [
    (0.0, 6.5),
    (0.02, 6.5),
    (0.03, 6.54),
    (0.035, 6.6),
    (0.04, 6.8),
    (0.045, 7.08),
    (0.05, 7.6),
    (0.055, 8.16),
    (0.06, 8.8),
];

/// Least bandwidth in rad/s of level 2 by phase delay in s, category A.
const LEVEL_2: [(f64, f64); 8] = [
    (0.0, 1.0),
    (0.085, 1.0),
    (0.10, 1.16),
    (0.11, 1.40),
    (0.12, 1.76),
    (0.13, 2.08),
    (0.14, 2.6),
    (0.15, 3.4),
];

/// What bounds a bandwidth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BandwidthLimit {
    /// A phase margin of 45 degrees.
    Phase,
    /// A gain margin of 6 dB.
    Gain,
}

/// Bandwidth of the attitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bandwidth {
    /// Frequency at which the phase is −180 degrees.
    pub neutral_rad_s: f64,
    /// Highest frequency with a phase margin of 45 degrees.
    pub by_phase_rad_s: f64,
    /// Highest frequency with a gain margin of 6 dB.
    pub by_gain_rad_s: f64,
    /// Bandwidth: the lower of the two.
    pub bandwidth_rad_s: f64,
    /// Which of the two it is.
    pub limit: BandwidthLimit,
    /// Phase delay.
    pub phase_delay_s: f64,
    /// What the two are worth, if there is a chart.
    pub level: Result<Judgement, Absent>,
}

impl Bandwidth {
    /// Bandwidth of a model's response to a command, judged for a category.
    ///
    /// $$ \omega_{BW} = \min(\omega_{-135°}, \omega_{2 |G(\omega_{180})|}), \quad
    ///    \tau_p = -\frac{\varphi(2 \omega_{180}) + \pi}{2 \omega_{180}} $$
    ///
    /// Of several crossings those count that lie last before the phase falls below −180 degrees for good.
    ///
    /// # Source
    /// R. H. Hoh, D. G. Mitchell, J. Hodgkinson, Bandwidth: a criterion for highly augmented airplanes,
    /// AGARD CP-333 (1982), paper 9.
    ///
    /// # Errors
    /// A phase that never comes to −180 degrees, or never was above −135; a gain that never is twice the one there.
    pub fn of(model: &PitchModel, category: Category) -> Result<Self, Absent> {
        let response = model.response()?;
        let neutral_rad_s = last(response.phase_crossings(-PI)).ok_or(Absent::NoPhaseLimit)?;
        let before = |found: Vec<f64>| last(found.into_iter().filter(|&at| at < neutral_rad_s));
        let by_phase_rad_s =
            before(response.phase_crossings(-0.75 * PI)).ok_or(Absent::NoPhaseReserve)?;
        let twice = 2.0 * response.gain(neutral_rad_s);
        let by_gain_rad_s = before(response.gain_crossings(twice)).ok_or(Absent::NoGainReserve)?;
        let bandwidth_rad_s = by_phase_rad_s.min(by_gain_rad_s);
        let phase_delay_s = phase_delay_s(&response, neutral_rad_s);
        Ok(Self {
            neutral_rad_s,
            by_phase_rad_s,
            by_gain_rad_s,
            bandwidth_rad_s,
            limit: if by_phase_rad_s <= by_gain_rad_s {
                BandwidthLimit::Phase
            } else {
                BandwidthLimit::Gain
            },
            phase_delay_s,
            level: judge(bandwidth_rad_s, phase_delay_s, category),
        })
    }
}

fn last(found: impl IntoIterator<Item = f64>) -> Option<f64> {
    found.into_iter().last()
}

/// Slope of the phase beyond −180 degrees, as a time.
fn phase_delay_s(response: &FrequencyResponse, neutral_rad_s: f64) -> f64 {
    -(response.phase_rad(2.0 * neutral_rad_s) + PI) / (2.0 * neutral_rad_s)
}

fn judge(
    bandwidth_rad_s: f64,
    phase_delay_s: f64,
    category: Category,
) -> Result<Judgement, Absent> {
    if category == Category::A {
        let level = bandwidth_level(bandwidth_rad_s, phase_delay_s);
        Ok(Judgement::new(&BANDWIDTH, bandwidth_rad_s, level))
    } else {
        Err(Absent::NoChart(category))
    }
}

/// Level of a bandwidth and a phase delay in the chart of category A; a negative delay counts as none.
#[must_use]
pub fn bandwidth_level(bandwidth_rad_s: f64, phase_delay_s: f64) -> Level {
    let inside = |edge: &[(f64, f64)]| {
        least_bandwidth(edge, phase_delay_s).is_some_and(|least| bandwidth_rad_s >= least)
    };
    Level::best(|level| match level {
        0 => inside(&LEVEL_1),
        1 => inside(&LEVEL_2),
        _ => bandwidth_rad_s > 0.0,
    })
}

/// Edge of a chart at a delay, between its points by straight lines; none beyond its end.
fn least_bandwidth(edge: &[(f64, f64)], delay_s: f64) -> Option<f64> {
    let delay_s = delay_s.max(0.0);
    edge.windows(2).find(|pair| delay_s <= pair[1].0).map(|pair| {
        let part = (delay_s - pair[0].0) / (pair[1].0 - pair[0].0);
        pair[0].1 + part * (pair[1].1 - pair[0].1)
    })
}

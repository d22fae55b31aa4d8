//! Limit cycles that describing functions predict.

use super::search::Search;
use fspid_core::Gains;
use fspid_lti::modulus;

use super::scan::{DescribingTable, Zero};
use super::{LimitedPath, OpenLoop};
use crate::controller::Controller;
use crate::error::SimError;
use crate::flown::empirical::{gains_around_rest, plant_around_rest};
use crate::scenario::Scenario;

/// An oscillation that a describing function predicts to go on by itself. An approximation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitCycle {
    /// Amplitude of the pitch angle, rad.
    pub pitch_amplitude_rad: f64,
    /// Amplitude of the elevator's fundamental, rad.
    pub elevator_amplitude_rad: f64,
    /// Amplitude of the command before any limit, rad.
    pub command_amplitude_rad: f64,
    /// Frequency, rad/s.
    pub frequency_rad_s: f64,
    /// Period, s.
    pub period_s: f64,
    /// By Loeb's criterion a slightly larger oscillation shrinks and a smaller one grows. One that is
    /// not stable is a border: what is larger grows away from it.
    pub stable: bool,
    /// $|1 + N L|$ at the answer: 0 for a perfect solution of the approximate equation.
    pub residual: f64,
}

/// Limit cycles predicted by describing functions. An approximation: "none found" is no proof.
#[derive(Clone, Debug, PartialEq)]
pub enum LimitCycles {
    /// Nothing in the path of the command is limited.
    NothingLimits,
    /// None in what was searched.
    NoneFound {
        /// What was searched.
        searched: Search,
    },
    /// These.
    Cycles(Vec<LimitCycle>),
}

impl LimitCycles {
    /// The cycles.
    #[must_use]
    pub fn cycles(&self) -> &[LimitCycle] {
        match self {
            Self::Cycles(cycles) => cycles,
            Self::NothingLimits | Self::NoneFound { .. } => &[],
        }
    }
}

/// Limit cycles of a scenario's loop with a controller, at the gains that it has around rest. A
/// scenario whose plant changes is asked about its first plant, an aircraft about its trim.
///
/// # Errors
/// [`SimError`] where the plant cannot be sampled or the search makes no sense.
pub fn limit_cycles(
    scenario: &Scenario,
    controller: &Controller,
    search: &Search,
) -> Result<LimitCycles, SimError> {
    let gains = [gains_around_rest(controller)];
    let mut answers = limit_cycles_at(scenario, controller, &gains, search)?;
    Ok(answers.pop().unwrap_or(LimitCycles::NothingLimits))
}

/// As [`limit_cycles`] for each of a list of frozen gains, such as those that a supervisor produces.
///
/// # Errors
/// As [`limit_cycles`].
pub fn limit_cycles_at(
    scenario: &Scenario,
    controller: &Controller,
    gains: &[Gains<f64>],
    search: &Search,
) -> Result<Vec<LimitCycles>, SimError> {
    let searched = search.checked()?;
    let config = controller.config();
    let path = LimitedPath::of(scenario, config)?;
    if path.is_linear() {
        return Ok(vec![LimitCycles::NothingLimits; gains.len()]);
    }
    let plant = plant_around_rest(scenario)?;
    let mut table = DescribingTable::new(&path, searched);
    let answer = |gains: &Gains<f64>| {
        let open = OpenLoop::of(scenario, &plant, &controller.config_at(*gains), *gains)?;
        let zeros = table.zeros(&open);
        let cycles: Vec<LimitCycle> =
            zeros.iter().filter_map(|zero| cycle(&open, &path, zero)).collect();
        Ok(match cycles.is_empty() {
            true => LimitCycles::NoneFound { searched },
            false => LimitCycles::Cycles(cycles),
        })
    };
    gains.iter().map(answer).collect()
}

/// What a solution looks like.
///
/// # Stability
/// With $F = 1 + N L = U + j V$, a cycle that is larger by dA obeys
/// $F_A\ dA + F_\omega (d\omega - j \sigma) = 0$ with the growth σ, so that
/// $\sigma = -(U_A V_\omega - U_\omega V_A)\ dA / |F_\omega|^2$: the cycle is stable where the mapping
/// from (A, ω) to (U, V) keeps its sense of turning, which is Loeb's criterion.
fn cycle(open: &OpenLoop, path: &LimitedPath, zero: &Zero) -> Option<LimitCycle> {
    let Zero { amplitude_rad, frequency_rad_s, turns_forward } = *zero;
    let response = open.at(frequency_rad_s)?;
    let factor = path.describing_function(amplitude_rad, frequency_rad_s)?;
    let passed_rad = amplitude_rad * modulus(factor);
    Some(LimitCycle {
        pitch_amplitude_rad: passed_rad * modulus(response.pitch),
        elevator_amplitude_rad: passed_rad * modulus(response.deflection),
        command_amplitude_rad: amplitude_rad,
        frequency_rad_s,
        period_s: std::f64::consts::TAU / frequency_rad_s,
        stable: turns_forward,
        residual: modulus(factor * response.returned + 1.0),
    })
}

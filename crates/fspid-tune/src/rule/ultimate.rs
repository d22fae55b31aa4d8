//! The exact limit of stability of the proportional loop.

use core::f64::consts::TAU;

use fspid_lti::Stability;

use super::RuleError;
use super::process::Process;

/// Highest gain that is tried relative to the last limit, as in the analysis.
const TRIED: f64 = 1e6;
/// Fewer samples than this in an ultimate period: the limit is made by the sampling, not by the plant. Eight samples
/// are 45 deg each.
const SAMPLES_MIN: f64 = 8.0;

/// The proportional loop at its limit of stability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UltimatePoint {
    /// Gain at which the loop oscillates undamped, command per error: stable just below, unstable just above.
    pub gain: f64,
    /// Period of that oscillation, s.
    pub period_s: f64,
    /// Gain below which the loop is unstable too; none for a plant that needs no control.
    pub lowest_gain: Option<f64>,
}

impl UltimatePoint {
    /// Frequency of the oscillation, rad/s.
    #[must_use]
    pub fn frequency_rad_s(&self) -> f64 {
        TAU / self.period_s
    }

    /// The limit of the sampled loop, from its eigenvalues: the upper end of the lowest interval of stable gains.
    pub(super) fn of(process: &Process) -> Result<Self, RuleError> {
        let Some(inside) = stable_gain(process)? else {
            return Err(RuleError::NeverStable);
        };
        let Stability::Stable(margins) = process.scaled(inside)?.margins()? else {
            return Err(RuleError::NeverStable);
        };
        let limit = margins.gain_high.ok_or(RuleError::AlwaysStable { tried: inside * TRIED })?;
        let gain = inside * limit.factor;
        if !(limit.omega_rad_s > 0.0) {
            return Err(RuleError::NoUltimatePeriod { gain });
        }
        let lowest = margins.gain_low.map(|limit| inside * limit.factor);
        let lowest_gain = lowest.filter(|_| !process.is_stable());
        Ok(Self { gain, period_s: TAU / limit.omega_rad_s, lowest_gain })
    }

    /// What is to be said of the point.
    pub(super) fn warnings(&self, process: &Process) -> Vec<String> {
        let mut warnings = Vec::new();
        let samples = self.period_s / process.open.dt_s();
        if samples < SAMPLES_MIN {
            warnings.push(format!(
                "the ultimate period is {samples:.1} samples long: the limit comes from the sampling, and the rule's times mean little"
            ));
        }
        if let Some(lowest) = self.lowest_gain {
            warnings.push(format!(
                "the plant is unstable without control: the loop needs a gain above {lowest:.4} as well; the rule does not know that"
            ));
        }
        warnings
    }
}

/// A gain within the lowest interval of gains that hold the process.
fn stable_gain(process: &Process) -> Result<Option<f64>, RuleError> {
    let places = process.open.real_crossings()?;
    let gains = places.into_iter().map(|omega| -1.0 / process.at(omega).re);
    let mut limits: Vec<f64> = gains.filter(|gain| *gain > 0.0 && gain.is_finite()).collect();
    limits.sort_by(f64::total_cmp);
    let first = limits.first().map_or(1.0, |first| 0.5 * first);
    let last = limits.last().map(|last| 2.0 * last);
    let between = limits.windows(2).map(|pair| (pair.iter().product::<f64>()).sqrt());
    for gain in core::iter::once(first).chain(between).chain(last) {
        match process.scaled(gain)?.unstable_radius() {
            Ok(None) => return Ok(Some(gain)),
            Ok(Some(_)) => {}
            Err(error) if error.undecided_radius().is_some() => {}
            Err(error) => return Err(error.into()),
        }
    }
    Ok(None)
}

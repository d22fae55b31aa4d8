//! What came of a rule's gains.

use fspid_core::Gains;
use fspid_lti::Mode;
use fspid_study::analysis::{AnalysedLoop, PlantLoop};
use fspid_study::metrics::Absent;

use super::place::PlacedPoles;

/// What a closed loop amounts to, with the worst plant of its scenario.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// Stable, with margins of at least 6 dB and 45 deg: MIL-F-9490D, 3.1.3.6, in normal operation.
    WithMargins,
    /// Stable with smaller margins.
    Poor,
    /// Unstable, or too near to it to tell.
    NotHeld(Absent),
}

impl Verdict {
    pub(super) fn of(outcome: &AnalysedLoop) -> Self {
        match outcome.margins() {
            Err(reason) => Self::NotHeld(reason),
            // One plant with poor margins is enough, also where it is not the one of the smallest disk margin.
            Ok(_) if outcome.has_poor_margins() || !outcome.is_held() => Self::Poor,
            Ok(_) => Self::WithMargins,
        }
    }

    /// In words.
    #[must_use]
    pub fn sentence(&self) -> String {
        match self {
            Self::WithMargins => "stable, margins of at least 6 dB and 45 deg".to_owned(),
            Self::Poor => "stable, but margins below 6 dB or 45 deg".to_owned(),
            Self::NotHeld(reason) => format!("NOT HELD: {reason}"),
        }
    }

    /// In one word: `with-margins`, `poor`, `not-held`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::WithMargins => "with-margins",
            Self::Poor => "poor",
            Self::NotHeld(_) => "not-held",
        }
    }
}

/// Least damping of the modes of an automatic flight control system that are not structural: MIL-DTL-9490E.
const DAMPING_MIN: f64 = 0.3;

/// The oscillating mode of a closed loop with the least damping.
pub(super) fn least_damped(plant: &PlantLoop) -> Option<Mode> {
    let dt_s = plant.worst.open.dt_s();
    let oscillating = plant.worst.closed_poles.iter().filter(|pole| pole.im > 0.0);
    let modes = oscillating.filter_map(|pole| Mode::of_sampled_pole(*pole, dt_s).ok());
    modes.min_by(|one, other| one.damping_ratio.total_cmp(&other.damping_ratio))
}

/// What is to be said of the gains beside their loop.
pub(super) fn warnings(
    outcome: &AnalysedLoop,
    gains: Gains<f64>,
    poles: Option<&PlacedPoles>,
) -> Vec<String> {
    let mut warnings = Vec::new();
    let named = [("kp", gains.kp), ("ki", gains.ki), ("kd", gains.kd)];
    for (name, gain) in named.into_iter().filter(|(_, gain)| *gain < 0.0) {
        warnings.push(format!("{name} = {gain:.4} is negative: it works against the others"));
    }
    let least = outcome.plants.iter().filter_map(least_damped);
    let least = least.min_by(|one, other| one.damping_ratio.total_cmp(&other.damping_ratio));
    if let Some(mode) = least.filter(|mode| !(mode.damping_ratio >= DAMPING_MIN)) {
        warnings.push(format!(
            "a mode of the closed loop at {:.3} rad/s has a damping of {:.3}; MIL-DTL-9490E asks for {DAMPING_MIN}",
            mode.natural_frequency_rad_s, mode.damping_ratio
        ));
    }
    if let (Some(poles), Some(plant)) = (poles, outcome.plants.first()) {
        warnings.extend(poles.warnings(&plant.worst.closed_poles));
    }
    warnings
}

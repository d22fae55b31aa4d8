//! What is said of the loop at a point: the judgement of `analyse`.

use fspid_lti::modulus;

use crate::analysis::{AnalysedLoop, Stability};
use crate::metrics::Absent;

/// Largest gain margin that is told.
const MOST_DB: f64 = 40.0;

/// A sampled loop around rest, with the gains that it starts from there and without limits.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Loop {
    pub(super) stability: Stability,
    /// Why it is not stable, or stable without a margin.
    pub(super) reason: Option<String>,
    /// Of a loop that is known to be stable or not: how many times as large its slowest motion is a sample later.
    pub(super) spectral_radius: Option<f64>,
    /// How fast that motion dies out; negative if it grows.
    pub(super) decay_per_s: Option<f64>,
    /// Of a stable loop: how far the gains may rise or fall, whichever is less, before it is unstable.
    pub(super) gain_margin_db: Option<f64>,
}

impl Loop {
    /// Of a loop that could not be asked.
    pub(super) fn not_asked(reason: String) -> Self {
        Self {
            stability: Stability::Undecided,
            reason: Some(reason),
            spectral_radius: None,
            decay_per_s: None,
            gain_margin_db: None,
        }
    }

    pub(super) fn of(found: &AnalysedLoop, dt_s: f64) -> Self {
        let (stability, margins) = (found.stability(), found.margins());
        // What is not known to hold has no number that could be read as if it did: its pitch loop alone may have one.
        let radius = match stability {
            Stability::Stable => largest_pole(found).filter(|radius| *radius < 1.0),
            Stability::Unstable => match margins {
                Err(Absent::Unstable { spectral_radius }) => Some(spectral_radius),
                _ => None,
            },
            Stability::Undecided => None,
        };
        let spectral_radius = radius.filter(|radius| radius.is_finite());
        let decay = spectral_radius.map(|radius| -libm::log(radius) / dt_s);
        let gain_margin_db = margins.ok().filter(|_| stability == Stability::Stable);
        Self {
            stability,
            reason: reason(found),
            spectral_radius,
            decay_per_s: decay.filter(|decay| decay.is_finite()),
            gain_margin_db: gain_margin_db.map(|it| it.smaller_gain_margin_db().min(MOST_DB)),
        }
    }
}

/// The largest modulus of a pole of the closed loop, with the largest age of what sensors show.
fn largest_pole(found: &AnalysedLoop) -> Option<f64> {
    let poles = &found.worst()?.worst.closed_poles;
    poles.iter().map(|pole| modulus(*pole)).reduce(f64::max)
}

/// What keeps a loop from being called stable with a margin; nothing where it is.
fn reason(found: &AnalysedLoop) -> Option<String> {
    let margins = found.margins();
    match (found.stability(), found.doubt) {
        // The loop by itself holds; what is around it is in doubt.
        (Stability::Undecided, Some(doubt)) if Stability::of(&margins) == Stability::Stable => {
            Some(doubt.to_string())
        }
        _ => margins.err().map(|reason| match reason {
            Absent::Undecided(doubt) => doubt.to_string(),
            other => other.to_string(),
        }),
    }
}

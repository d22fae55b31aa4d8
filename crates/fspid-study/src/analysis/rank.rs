//! Margins as a verdict, and which of two loops is worse.

use fspid_lti::{LtiError, SampledLoop, SampledMargins, Stability};
use fspid_sim::{Doubt, SimError};

use super::answer::Margins;
use crate::metrics::Absent;

/// Margins of a loop. One that is not known to be stable has none, and neither has one whose peaks nothing bounds.
pub(super) fn judged(open: &SampledLoop) -> Result<Result<Box<SampledMargins>, Absent>, SimError> {
    let found = match open.margins() {
        Ok(Stability::Stable(margins)) => return Ok(Ok(margins)),
        Err(LtiError::Unproved { order }) => return Ok(Err(Absent::NotProved { order })),
        // Margins do not tell what is unstable from what is at the edge.
        Ok(Stability::Unstable { .. }) => open.unstable_radius(),
        Err(error) => Err(error),
    };
    match found {
        Ok(radius) => {
            Ok(Err(Absent::Unstable { spectral_radius: radius.unwrap_or(f64::INFINITY) }))
        }
        Err(error) => match error.undecided_radius() {
            Some(spectral_radius) => {
                Ok(Err(Absent::Undecided(Doubt::Rounding { spectral_radius })))
            }
            None => Err(error.into()),
        },
    }
}

/// How bad margins are: the smaller, the worse; unstable before all others.
pub(super) fn rank(margins: &Result<Margins, Absent>) -> f64 {
    match margins {
        Ok(margins) => margins.disk_margin,
        Err(reason) => rank_without_margins(*reason),
    }
}

/// How bad it is that there are no margins, below 0: a stable loop without proved margins, then what is not known, and
/// before all others what is known to be unstable, the faster the worse.
pub(super) fn rank_without_margins(reason: Absent) -> f64 {
    match reason {
        Absent::Unstable { spectral_radius } if spectral_radius.is_finite() => {
            -3.0 - spectral_radius
        }
        Absent::Unstable { .. } => f64::NEG_INFINITY,
        Absent::NotProved { .. } | Absent::OldestAge { .. } | Absent::AgesAsTheyCome { .. } => -1.0,
        _ => -2.0,
    }
}

//! Bracketing search for the largest perturbation that a flight tolerates: a ladder of sizes up to the first failure, then
//! bisection.

use super::Failure;
use crate::error::SimError;

/// Where a flight ceases to hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Margin {
    /// Between two sizes of the perturbation.
    Between {
        /// Up to here every size that was tried holds.
        holds: f64,
        /// The first size that fails.
        fails: f64,
        /// How it fails.
        failure: Failure,
    },
    /// Nowhere up to the largest size that is tried.
    Beyond {
        /// The largest size.
        held: f64,
    },
}

impl Margin {
    /// The largest perturbation that is known to hold.
    #[must_use]
    pub fn holds(&self) -> f64 {
        match *self {
            Self::Between { holds, .. } => holds,
            Self::Beyond { held } => held,
        }
    }

    /// The same in another unit.
    pub(super) fn map(self, unit: impl Fn(f64) -> f64) -> Self {
        match self {
            Self::Between { holds, fails, failure } => {
                Self::Between { holds: unit(holds), fails: unit(fails), failure }
            }
            Self::Beyond { held } => Self::Beyond { held: unit(held) },
        }
    }
}

/// The sizes that are tried.
pub(super) struct Ladder {
    /// Known to hold.
    pub(super) from: f64,
    /// In order of size.
    pub(super) rungs: Vec<f64>,
    /// Width of an answer that is narrow enough: this share of what fails …
    pub(super) tolerance: f64,
    /// … or this.
    pub(super) width: f64,
}

impl Ladder {
    /// The margin of a trial that answers why a size fails.
    pub(super) fn climb(
        &self,
        mut trial: impl FnMut(f64) -> Result<Option<Failure>, SimError>,
    ) -> Result<Margin, SimError> {
        let mut holds = self.from;
        for &rung in &self.rungs {
            if let Some(failure) = trial(rung)? {
                return self.halve(holds, rung, failure, trial);
            }
            holds = rung;
        }
        Ok(Margin::Beyond { held: holds })
    }

    fn halve(
        &self,
        mut holds: f64,
        mut fails: f64,
        mut failure: Failure,
        mut trial: impl FnMut(f64) -> Result<Option<Failure>, SimError>,
    ) -> Result<Margin, SimError> {
        while fails - holds > self.width.max(self.tolerance * fails) {
            let middle = 0.5 * (holds + fails);
            // Neighbours have nothing between them.
            if middle <= holds || middle >= fails {
                break;
            }
            match trial(middle)? {
                Some(reason) => (fails, failure) = (middle, reason),
                None => holds = middle,
            }
        }
        Ok(Margin::Between { holds, fails, failure })
    }
}

/// From `first` by a factor up to and with `bound`.
pub(super) fn geometric(first: f64, factor: f64, bound: f64) -> Vec<f64> {
    let mut rungs = Vec::new();
    let mut rung = first;
    while rung < bound {
        rungs.push(rung);
        rung *= factor;
    }
    rungs.push(bound);
    rungs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::{EarlyEnd, EndCause};

    const LATE: Failure = Failure::EndedEarly(EarlyEnd { at_s: 1.0, cause: EndCause::Diverged });

    fn ladder() -> Ladder {
        Ladder { from: 0.0, rungs: geometric(1.0, 2.0, 10.0), tolerance: 1e-6, width: 0.0 }
    }

    #[test]
    fn rungs_end_with_the_bound() {
        assert_eq!(ladder().rungs, [1.0, 2.0, 4.0, 8.0, 10.0]);
    }

    #[test]
    fn a_margin_lies_between_what_holds_and_what_fails() {
        let trial = |size: f64| Ok((size > 5.3).then_some(LATE));
        let margin = ladder().climb(trial).expect("no error");
        let Margin::Between { holds, fails, failure: LATE } = margin else {
            panic!("{margin:?}");
        };
        assert!(holds <= 5.3 && 5.3 < fails && fails - holds < 6e-6, "{margin:?}");
    }

    #[test]
    fn what_never_fails_is_beyond_the_last_rung() {
        assert_eq!(ladder().climb(|_| Ok(None)), Ok(Margin::Beyond { held: 10.0 }));
    }

    #[test]
    fn an_error_of_a_trial_ends_the_climb() {
        assert_eq!(ladder().climb(|_| Err(SimError::NotLinear)), Err(SimError::NotLinear));
    }
}

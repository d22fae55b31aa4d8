//! What a flight amounts to: measures of a response, each a value or the reason there is none.

mod effort;
mod exit;
mod extreme;
mod flight;
mod step;

pub use effort::{CommandEffort, ErrorIntegrals, largest_error_rad};
pub use exit::{LEFT_RANGE, left_validity};
pub use flight::{EdgeMetrics, FlightMetrics, Verdict};
pub use step::{StepMetrics, StepWindow};

use std::fmt;

use fspid_diagnostics::digits::without_zeros;

/// Why a measure has no value.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Absent {
    /// The flight left every reasonable range.
    Diverged {
        /// When, s.
        at_s: f64,
    },
    /// The aircraft came down to the ground.
    HitGround {
        /// When, s.
        at_s: f64,
    },
    /// The loop is unstable, whatever the window shows.
    Unstable {
        /// Spectral radius of the sampled closed loop.
        spectral_radius: f64,
    },
    /// A sample of the response is NaN or infinite.
    NotFinite,
    /// The response never came within a tenth of the new set-point.
    NotRisen {
        /// Length of the window, s.
        window_s: f64,
    },
    /// The response was outside the band at the end of the window.
    NotSettled {
        /// Length of the window, s.
        window_s: f64,
    },
    /// There is no step in the command to measure against.
    NoStep,
    /// Rounding may carry poles of the loop across the unit circle, so that nobody can tell.
    Undecided {
        /// Spectral radius of the sampled closed loop as computed.
        spectral_radius: f64,
    },
    /// The rules have a kink where the loop rests; on one side of it the loop is unstable, and no motion was seen to
    /// grow.
    OneSide,
    /// The loop has so many states that nothing bounds its peaks from above.
    NotProved {
        /// Number of states, samples of dead time included.
        order: usize,
    },
    /// The controller has no rate loop that could be broken.
    NoRateLoop,
    /// The gains move at rest, and nothing stops them.
    GainsDrift,
}

impl fmt::Display for Absent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Diverged { at_s } => write!(f, "diverged at t = {} s", short(*at_s)),
            Self::HitGround { at_s } => write!(f, "hit the ground at t = {} s", short(*at_s)),
            Self::Unstable { spectral_radius } => {
                write!(f, "the loop is unstable: spectral radius {spectral_radius:.6} of the sampled loop")
            }
            Self::NotFinite => f.write_str("the response is not finite"),
            Self::NotRisen { window_s } => {
                write!(f, "did not rise to 90 % within {} s", short(*window_s))
            }
            Self::NotSettled { window_s } => {
                write!(f, "not settled within {} s", short(*window_s))
            }
            Self::NoStep => f.write_str("the command has no step"),
            Self::Undecided { spectral_radius } => write!(
                f,
                "undecided: rounding may carry poles across the unit circle (spectral radius {spectral_radius:.9} as computed)"
            ),
            Self::OneSide => f.write_str(
                "undecided: unstable on one side of a kink that the rules have where the loop rests, and no motion was seen to grow",
            ),
            Self::NotProved { order } => write!(
                f,
                "no bound of its peaks is proved: {order} states, samples of dead time included"
            ),
            Self::NoRateLoop => f.write_str("the controller has no rate loop to break"),
            Self::GainsDrift => f.write_str(
                "the accumulating law moves the gains at rest without end, so that there is no equilibrium; gain_limits, dead_zone or leakage_per_s bound it",
            ),
        }
    }
}

impl std::error::Error for Absent {}

/// A measure, or why there is none.
pub type Measured = Result<f64, Absent>;

/// A time for people: at most six decimals, none that say nothing.
#[must_use]
pub fn short(value: f64) -> String {
    without_zeros(&format!("{value:.6}")).to_owned()
}

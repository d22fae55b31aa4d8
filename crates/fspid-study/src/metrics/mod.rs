//! What a flight amounts to: measures of a response, each a value or the reason there is none.

mod effort;
mod exit;
mod extreme;
mod flight;
mod metric;
mod step;

pub use effort::{CommandEffort, ErrorIntegrals, largest_error_rad};
pub use exit::{LEFT_RANGE, left_validity};
pub use flight::{EdgeMetrics, FlightMetrics, Verdict};
pub use metric::{Bad, METRICS, Metric};
pub(crate) use step::{SETTLING_BAND, is_seen_to_stay};
pub use step::{StepMetrics, StepWindow};

use std::fmt;

use fspid_diagnostics::digits::to_six_decimals;
use fspid_sim::{Doubt, EarlyEnd};

/// Why a measure has no value.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Absent {
    /// The flight ended before its last sample.
    #[error("{} at t = {} s", .0.cause, to_six_decimals(.0.at_s))]
    EndedEarly(EarlyEnd),
    /// The loop is unstable, whatever the window shows.
    #[error("the loop is unstable: spectral radius {spectral_radius:.6} of the sampled loop")]
    Unstable {
        /// Spectral radius of the sampled closed loop.
        spectral_radius: f64,
    },
    /// A sample of the response is NaN or infinite.
    #[error("the response is not finite")]
    NotFinite,
    /// The response never came within a tenth of the new set-point.
    #[error("did not rise to 90 % within {} s", to_six_decimals(*window_s))]
    NotRisen {
        /// Length of the window, s.
        window_s: f64,
    },
    /// The response was outside the band at the end of the window, or came into it too late to be seen to stay there.
    #[error("not settled within {} s{}", to_six_decimals(*window_s), too_late(*since_s))]
    NotSettled {
        /// Length of the window, s.
        window_s: f64,
        /// From when on it was in the band after all, s after the step.
        since_s: Option<f64>,
    },
    /// Only an external controller itself knows, and might say it wrongly.
    #[error("the limits of an external controller are not known here")]
    OwnWord,
    /// There is no step in the command to measure against.
    #[error("the command has no step")]
    NoStep,
    /// Nobody can tell whether the loop is stable.
    #[error("undecided: {0}")]
    Undecided(Doubt),
    /// A loop that holds while the ages of a sensor's values change has no margins at the largest of them.
    #[error(
        "none: margins are taken with the largest age of what a sensor with a clock of its own shows, with which the loop is unstable (spectral radius {spectral_radius:.6}); while ages change it is stable"
    )]
    OldestAge {
        /// Spectral radius of the sampled closed loop with the largest age.
        spectral_radius: f64,
    },
    /// Margins at the largest age of a sensor's values are not borne by the loop whose ages come as they do.
    #[error(
        "none: margins are taken with the largest age of what a sensor with a clock of its own shows, and with {within}, which they allow, the loop is unstable over the ages as they come"
    )]
    AgesAsTheyCome {
        /// What it does not bear.
        within: WithinMargins,
    },
    /// The loop has so many states that nothing bounds its peaks from above.
    #[error("no bound of its peaks is proved: {order} states, samples of dead time included")]
    NotProved {
        /// Number of states, samples of dead time included.
        order: usize,
    },
    /// The controller has no rate loop that could be broken.
    #[error("the controller has no rate loop to break")]
    NoRateLoop,
}

/// A change of the loop that margins allow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WithinMargins {
    /// A gain, dB.
    GainDb(f64),
    /// A dead time, s.
    DelayS(f64),
}

impl fmt::Display for WithinMargins {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::GainDb(gain_db) => write!(f, "{gain_db:+.1} dB of gain"),
            Self::DelayS(delay_s) => write!(f, "{delay_s:.3} s of dead time"),
        }
    }
}

/// What is added of a response that is in its band at the end of its window.
fn too_late(since_s: Option<f64>) -> String {
    let words = |since_s| format!(": in its band after {since_s:.3} s, too late to see it stay");
    since_s.map_or(String::new(), words)
}

/// A measure, or why there is none.
pub type Measured = Result<f64, Absent>;

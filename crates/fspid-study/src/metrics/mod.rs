//! What a flight amounts to: measures of a response, each a value or the reason there is none.

mod effort;
mod exit;
mod extreme;
mod flight;
mod step;

pub use effort::{CommandEffort, ErrorIntegrals, largest_error_rad};
pub use exit::{LEFT_RANGE, left_validity};
pub use flight::{EdgeMetrics, FlightMetrics, Verdict};
pub(crate) use step::is_seen_to_stay;
pub use step::{StepMetrics, StepWindow};

use fspid_diagnostics::digits::without_zeros;
use fspid_sim::loop_model::MOST_AS_STATES;
use fspid_sim::{ControllerLoss, PlantLoss};

/// Why a measure has no value.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Absent {
    /// The flight left every reasonable range.
    #[error("diverged at t = {} s", short(*at_s))]
    Diverged {
        /// When, s.
        at_s: f64,
    },
    /// The aircraft came down to the ground.
    #[error("hit the ground at t = {} s", short(*at_s))]
    HitGround {
        /// When, s.
        at_s: f64,
    },
    /// An external controller gave no answer.
    #[error("the controller {loss} at t = {} s", short(*at_s))]
    ControllerLost {
        /// When, s.
        at_s: f64,
        /// How it was lost.
        loss: ControllerLoss,
    },
    /// Another simulator gave no answer.
    #[error("the simulator {loss} at t = {} s", short(*at_s))]
    PlantLost {
        /// When, s.
        at_s: f64,
        /// How it was lost.
        loss: PlantLoss,
    },
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
    #[error("did not rise to 90 % within {} s", short(*window_s))]
    NotRisen {
        /// Length of the window, s.
        window_s: f64,
    },
    /// The response was outside the band at the end of the window.
    #[error("not settled within {} s", short(*window_s))]
    NotSettled {
        /// Length of the window, s.
        window_s: f64,
    },
    /// There is no step in the command to measure against.
    #[error("the command has no step")]
    NoStep,
    /// Rounding may carry poles of the loop across the unit circle, so that nobody can tell.
    #[error(
        "undecided: rounding may carry poles across the unit circle (spectral radius {spectral_radius:.9} as computed)"
    )]
    Undecided {
        /// Spectral radius of the sampled closed loop as computed.
        spectral_radius: f64,
    },
    /// The rules have a kink where the loop rests; on one side of it the loop is unstable, and no motion was seen to
    /// grow.
    #[error(
        "undecided: unstable on one side of a kink that the rules have where the loop rests (spectral radius {spectral_radius:.6} there), and no motion was seen to grow"
    )]
    OneSide {
        /// Spectral radius of the sampled closed loop on that side.
        spectral_radius: f64,
    },
    /// The rules have a kink where the loop rests, one side of it is unstable, and so much is on its way that no motion is
    /// followed.
    #[error(
        "undecided: unstable on one side of a kink that the rules have where the loop rests (spectral radius {spectral_radius:.6} there), and motions are not followed through so many samples on their way"
    )]
    LongWay {
        /// Spectral radius of the sampled closed loop on that side.
        spectral_radius: f64,
    },
    /// A sensor has a clock of its own, with one age of its values the loop is unstable, and no time is known after which all
    /// ages come again.
    #[error(
        "undecided: a sensor with a clock of its own shows values of changing age; with one of them, or over some samples, the loop is unstable, or there are too many of them to be asked in turn"
    )]
    ChangingAge {
        /// Spectral radius of the sampled closed loop with the age at which it is unstable.
        spectral_radius: f64,
    },
    /// A loop that holds while the ages of a sensor's values change has no margins at the largest of them.
    #[error(
        "none: margins are taken with the largest age of what a sensor with a clock of its own shows, with which the loop is unstable (spectral radius {spectral_radius:.6}); while ages change it is stable"
    )]
    OldestAge {
        /// Spectral radius of the sampled closed loop with the largest age.
        spectral_radius: f64,
    },
    /// Sensors or commands of a mode of the autopilot are so late that it is not asked for its poles.
    #[error(
        "undecided: more than {MOST_AS_STATES} samples are on their way in a mode of the autopilot"
    )]
    LongMode,
    /// The loop grows at a set-point that the loops around the pitch loop may command.
    #[error(
        "undecided: at a set-point that the loops around the pitch loop may command the loop is unstable (spectral radius {spectral_radius:.6})"
    )]
    Commanded {
        /// Spectral radius of the sampled closed loop there.
        spectral_radius: f64,
    },
    /// The aircraft of later in the flight is not shown to hold.
    #[error(
        "undecided: with its configuration or its fuel of later in the flight the aircraft has no trim at the speed and altitude of the start, or none that is shown to be stable"
    )]
    ChangedAircraft,
    /// The aircraft's roll, yaw or bank grows about its trim.
    #[error(
        "undecided: about the trim something grows that is no pitching (spectral radius {spectral_radius:.6}): roll, yaw or bank, with leveller and damper as they are"
    )]
    Wings {
        /// Spectral radius of all small motions, sample to sample.
        spectral_radius: f64,
    },
    /// A vertical gyro's erection makes small motions grow.
    #[error(
        "undecided: with the erection of the vertical gyro small motions grow (spectral radius {spectral_radius:.6}) until its bounded rate holds them, so that an oscillation stays"
    )]
    Erection {
        /// Spectral radius of all small motions, sample to sample.
        spectral_radius: f64,
    },
    /// The set-point of the end brings the aircraft to another airspeed, where the loop grows.
    #[error(
        "undecided: held on, the set-point of the end brings the aircraft with the throttle of its trim to another airspeed, at which the loop is unstable (spectral radius {spectral_radius:.6}): a longer flight shows it"
    )]
    HeldOn {
        /// Spectral radius of the sampled closed loop there.
        spectral_radius: f64,
    },
    /// The trim lies on a kink of the aircraft's data, or at a jump of its engine.
    #[error(
        "undecided: the trim lies right on a kink of the aircraft's data (a breakpoint of a table, a row of Mach numbers, a corner of a gearing, half the power of an engine that jumps there), where each side has slopes of its own: a trim a little beside it has one linear model"
    )]
    Kink,
    /// The aircraft moves faster than the steps of the integration follow.
    #[error(
        "undecided: about the trim the airframe has a motion that is too fast for the steps of the integration, which are the sample period and 0.01 s at most: with a shorter period they follow it"
    )]
    FastMotion,
    /// Gains of a loop around the pitch loop multiply what it holds while they move with its error.
    #[error(
        "undecided: gains of a loop around the pitch loop move with its error and multiply what it holds (a set-point weight other than 1, the literal integral, no integral), and what comes of that may grow"
    )]
    OuterGains,
    /// A plant that does not come to rest by itself is to be held where the limits leave too little for it.
    #[error(
        "undecided: the plant does not come to rest by itself, and at the end of the flight set-point and loads take more elevator than a limit leaves, or the command is at a limit and the error grows"
    )]
    BeyondLimits,
    /// The loop has so many states that nothing bounds its peaks from above.
    #[error("no bound of its peaks is proved: {order} states, samples of dead time included")]
    NotProved {
        /// Number of states, samples of dead time included.
        order: usize,
    },
    /// The controller has no rate loop that could be broken.
    #[error("the controller has no rate loop to break")]
    NoRateLoop,
    /// The gains move at rest, and nothing stops them.
    #[error(
        "the accumulating law moves the gains at rest without end, so that there is no equilibrium; gain_limits, dead_zone or leakage_per_s bound it"
    )]
    GainsDrift,
}

/// A measure, or why there is none.
pub type Measured = Result<f64, Absent>;

/// A time for people: at most six decimals, none that say nothing.
#[must_use]
pub fn short(value: f64) -> String {
    without_zeros(&format!("{value:.6}")).to_owned()
}

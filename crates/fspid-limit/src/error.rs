//! Why there is no limit to tell.

use fspid_lti::LtiError;
use fspid_proof::check::NotProved;
use fspid_sim::SimError;

/// A feature of a scenario for which no limit can be computed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Refusal {
    /// An aircraft in six degrees of freedom.
    #[error(
        "the aircraft is nonlinear: a limit is told of a linear plant; `--set aircraft.model=linear` asks it of the same flight with the linear model at the trim"
    )]
    Nonlinear,
    /// Another simulator.
    #[error("another simulator flies the aircraft, and has no equations here")]
    OtherSimulator,
    /// A plant that changes in flight.
    #[error("the plant changes in flight (plant_change): a limit is told of one plant that stays")]
    Changes,
    /// An autopilot, whose set-points depend on the flight.
    #[error(
        "an autopilot moves the set-point with the flight: a limit is told of one that is known"
    )]
    Autopilot,
    /// Play between actuator and surface.
    #[error(
        "the actuator has play (backlash_deg), through which the elevator does not follow linearly; leave it out for the limit without it"
    )]
    Play,
    /// A lag of second order with limits.
    #[error(
        "the actuator is of second order with a rate limit or stops (rate_limit_deg_s, travel_deg), which make of it no linear system that a bound is known of; give it a lag of first order, or leave them out"
    )]
    SecondOrderLimits,
    /// A rate limit or stops, where the command's way counts.
    #[error(
        "the actuator has a rate limit or stops (rate_limit_deg_s, travel_deg), and the command's way through them is not linear; count the elevator's: `--travel-of elevator`"
    )]
    CommandThroughLimits,
}

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LimitError {
    /// Parts of the scenario that no limit can be told of.
    #[error("no limit can be told of this scenario:{}", lines(.0))]
    Refused(Vec<Refusal>),
    /// The scenario cannot fly.
    #[error(transparent)]
    Scenario(#[from] SimError),
    /// The plant cannot be enclosed.
    #[error(transparent)]
    Plant(#[from] NotProved),
    /// Matrices that do not fit.
    #[error(transparent)]
    Matrix(#[from] LtiError),
    /// The solver did not come to an end.
    #[error("the solver found no answer ({status}); nothing is claimed")]
    Solver {
        /// What it says of itself.
        status: String,
    },
    /// The plant grows so fast that rounding leaves nothing of the adjoint.
    #[error(
        "the plant grows so fast over this flight that no bound of rounding could be proved; a shorter flight may have one"
    )]
    GrowsTooFast,
    /// No history keeps within the travel.
    #[error("no command keeps within this travel: what disturbs the elevator alone needs more")]
    TravelTooSmall,
    /// A flight of more samples than a programme is solved for.
    #[error(
        "the flight has {found} samples, and a limit is told of at most {most}: give it a shorter duration_s or a longer sample_period_s"
    )]
    TooLong {
        /// Samples of the flight.
        found: usize,
        /// Most samples.
        most: usize,
    },
    /// No travel to ask the limit at.
    #[error(
        "there is no travel to ask the limit at, since no controller of the scenario has one that counts; give some, e.g. `--travel-deg 8,10,15`:{}",
        .0.iter().map(|(name, why)| format!("\n    {name}: {why}")).collect::<String>()
    )]
    NoTravel(
        /// The controllers, and what each did instead.
        Vec<(String, String)>,
    ),
    /// Somebody did not want the answer any more.
    #[error("it was stopped before there was an answer")]
    Stopped,
}

fn lines(refusals: &[Refusal]) -> String {
    refusals.iter().map(|it| format!("\n    {it}")).collect()
}

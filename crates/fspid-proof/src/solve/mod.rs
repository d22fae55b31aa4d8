//! Looking for Lyapunov functions and for growing sequences of gains, in ordinary arithmetic.
//!
//! Nothing here is believed: what is found is handed to the re-check. So the searches aim for answers
//! well inside, whose inequalities hold with room for the enclosures of the re-check, and not for the
//! last digit of the best one.
//!
//! Everything is deterministic: no random numbers, no clock, sums in a fixed order.

mod barrier;
mod cells;
mod centres;
mod dense;
mod disturbed;
mod gain_family;
mod growth;
mod inequality;
mod instability;
mod lyapunov;
mod parameter_dependent;
mod stein;
mod symmetric;
mod widest;
mod words;

pub use cells::Part;
pub use disturbed::{
    CountedRow, DrivenCorner, DrivenProblem, driven_form, form_at, kept_of, least_gain,
};
pub use gain_family::GainFamily;
pub use growth::{Growth, growing_sequence};
pub use instability::{InstabilityForm, instability_form};
pub use lyapunov::{
    BestRate, Condition, LyapunovProblem, Solution, Verdict, best_rate, common_form,
    common_lyapunov, fast_form,
};
pub use parameter_dependent::{
    MovingForm, MovingProblem, MovingVerdict, fastest_moving_form, motions_from, moving_form,
    moving_form_over,
};
pub use stein::summed;
pub use widest::{WidestProblem, widest};

/// How much work a search may do.
#[derive(Debug, Clone, Copy)]
pub struct Effort {
    /// Newton steps of a search for a form.
    pub newton_steps: usize,
    /// Samples of each flight of a search for growth.
    pub flight_samples: usize,
    /// Asked between the steps of a search: one that is told to stop finds nothing. A plain function, since nothing else
    /// here knows of the world outside; once it says yes, it may not say no again.
    pub stops: fn() -> bool,
}

/// For whom nobody stops.
#[must_use]
pub const fn never() -> bool {
    false
}

impl Default for Effort {
    /// The loops of the tests need up to 160 steps for a form at rest and 500 for one that moves, and flights
    /// of some three of their slowest periods.
    fn default() -> Self {
        Self { newton_steps: 1000, flight_samples: 4000, stops: never }
    }
}

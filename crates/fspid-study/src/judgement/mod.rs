//! Whether requirements are met.
//!
//! [`Evidence`] answers a requirement from the flight, the linear loop or the aircraft itself, case by case: each step
//! of the command, each plant of a change in flight, each gain the supervisor can produce. A [`Judgement`] holds the
//! worst case. What cannot be evaluated is not met, and says why.

mod case;
mod evidence;
mod judge;
mod reason;
mod slopes;

pub use case::{Case, CasePlace, FrozenAt, PlantAt, StepAt};
pub use evidence::Evidence;
pub(crate) use judge::is_of_aircraft;
pub use judge::{AIRCRAFT, Judgement, judge};
pub use reason::NotEvaluated;
pub use slopes::{SlopeOf, Sloped, add_slopes, is_of_this_air, of_loop};

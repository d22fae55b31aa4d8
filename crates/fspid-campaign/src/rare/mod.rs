//! How often a requirement is not met where that is too rare to be counted: once in a million flights or in a thousand million.
//!
//! The same dispersions as a campaign's, and the same flights; what differs is which of them are flown. [`subset`] climbs from
//! flights that are nearer to the failure to flights that are nearer still, and [`importance`] draws where failures are.
//! Both know nothing of flights: they ask a [`LimitState`] for the scores of points, and are tested with such whose probability
//! is known. [`Target`] is the one of flights.
//!
//! The answer is a function of the scenario, the question and the seed. How many threads fly, and where it was interrupted,
//! never shows.

mod answer;
mod chains;
mod dice;
mod figure;
mod importance;
mod interval;
mod ladder;
mod point;
mod question;
mod record;
mod seldom;
mod subset;
mod target;
mod teams;
mod words;

pub use answer::{Found, Rare};
pub use chains::LimitState;
pub use importance::{Aim, Importance, LEAST_EFFECTIVE, importance};
pub use interval::{CONFIDENCE, Interval};
pub use ladder::{Ladder, LadderEnd, MOST_RUNGS, Rung, SHARE};
pub use point::{Air, Point, Shape, Steps};
pub use question::{Method, Question, rare};
pub use seldom::Seldom;
pub use subset::{Known, MOST_SPREAD, Subset, Unfinished, subset};
pub use target::Target;
pub use teams::{TEAMS, Teams};

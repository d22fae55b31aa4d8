//! Subset simulation: a small probability as a product of larger ones, with an interval that independent teams give it.

use super::chains::LimitState;
use super::interval::{self, Interval};
use super::ladder::{LadderEnd, Rung, SHARE, ladder};
use super::point::Point;
use super::teams::{TEAMS, Teams, climb};
use crate::statistics::binomial::{clopper_pearson, upper_bound};

/// Share of the flights that the first climber may take, and fewest and most points it has on a rung.
const AHEAD: u64 = 4;
const AHEAD_POINTS: [usize; 2] = [100, 1000];
/// Fewest points of a team on a rung: of fewer, some team would soon have nobody above.
const LEAST_POINTS: usize = 50;
/// Largest standard deviation of the logarithms of the teams' estimates that an interval is made of: coverage was checked up
/// to it.
pub const MOST_SPREAD: f64 = 1.5;

/// What is known of the probability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Known {
    /// It is in this interval.
    Within(Interval),
    /// It is at most this.
    Below {
        /// The bound.
        most: f64,
        /// Why it is no interval.
        why: Unfinished,
    },
}

impl Known {
    /// The same where so much more may fail.
    pub(super) fn raised(self, by: f64) -> Self {
        let raised = |high: f64| (high + by).min(1.0);
        match self {
            Self::Within(it) => Self::Within(Interval { high: raised(it.high), ..it }),
            Self::Below { most, why } => Self::Below { most: raised(most), why },
        }
    }
}

/// Why there is no interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unfinished {
    /// The flights were spent before failures were reached.
    Spent,
    /// Nothing that was varied led nearer to failure.
    Flat,
    /// Failures are rarer than can be told.
    Deep,
    /// A team found no way up.
    Lost,
    /// The teams' estimates are too far apart.
    Apart,
    /// Too few failures, or their weights too uneven.
    Uneven,
}

/// The answer of subset simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct Subset {
    /// What is known.
    pub known: Known,
    /// The rungs.
    pub rungs: Vec<Rung>,
    /// What the teams brought back.
    pub teams: Teams,
    /// Points that were asked for in all.
    pub asked: u64,
}

/// Estimates the probability that a score is above 0 with about `points` points.
///
/// # Errors
/// Those of the scores.
pub fn subset<L: LimitState>(state: &mut L, seed: u64, points: u64) -> Result<Subset, L::Error> {
    let most = points / AHEAD;
    let ahead = (points as usize / 100).clamp(AHEAD_POINTS[0], AHEAD_POINTS[1]);
    let ladder = ladder(state, seed, ahead, most)?;
    let left = points.saturating_sub(ladder.asked) as f64;
    let of_each = left / TEAMS as f64 / (1.0 + (1.0 - SHARE) * ladder.rungs.len() as f64);
    let count = (of_each as usize).max(LEAST_POINTS);
    let teams = climb(state, seed, &ladder.rungs, count)?;
    let known = known(&teams, ladder.end);
    let asked = ladder.asked + teams.asked;
    Ok(Subset { known, rungs: ladder.rungs, teams, asked })
}

/// The interval of failure, or else a bound of the last rung that every team has reached often enough.
fn known(teams: &Teams, end: LadderEnd) -> Known {
    let last = teams.shares.len();
    let found = within(teams, last);
    let why = match (end, found) {
        (LadderEnd::Failure, Some(interval)) if interval.spread <= MOST_SPREAD => {
            return Known::Within(interval);
        }
        // More failed than the first climber had hoped for, so that its end is no hindrance.
        (_, Some(interval)) if interval.spread <= MOST_SPREAD && teams.failing >= ENOUGH => {
            return Known::Within(interval);
        }
        (LadderEnd::Failure, Some(_)) => Unfinished::Apart,
        (LadderEnd::Failure, None) => Unfinished::Lost,
        (LadderEnd::Spent, _) => Unfinished::Spent,
        (LadderEnd::Flat, _) => Unfinished::Flat,
        (LadderEnd::Deep, _) => Unfinished::Deep,
    };
    let bounds = (1..last).filter_map(|rungs| within(teams, rungs));
    let narrow = bounds.filter(|interval| interval.spread <= MOST_SPREAD);
    let plain = plain(teams).map_or(1.0, |[_, high]| high);
    let most = narrow.map(|interval| interval.high).fold(plain, f64::min);
    Known::Below { most, why }
}

/// Failures from which on they were reached, whatever the first climber found.
const ENOUGH: u64 = 100;

/// The interval of the probability to be above the first rungs.
fn within(teams: &Teams, rungs: usize) -> Option<Interval> {
    let estimates = teams.estimates(rungs);
    if rungs > 1 {
        return interval::of_teams(&estimates);
    }
    // Nothing but independent points: their interval is exact.
    let [low, high] = plain(teams)?;
    let estimate = estimates.iter().sum::<f64>() / TEAMS as f64;
    (estimate > 0.0).then_some(Interval { estimate, low, high, spread: 0.0 })
}

/// The exact interval of the first share.
fn plain(teams: &Teams) -> Option<[f64; 2]> {
    let points = (TEAMS * teams.count) as u64;
    let share = teams.shares.first()?.iter().sum::<f64>() / TEAMS as f64;
    let above = libm::round(share * points as f64) as u64;
    if above == 0 {
        return Some([0.0, upper_bound(0, points, interval::CONFIDENCE).ok()?]);
    }
    clopper_pearson(above, points, interval::CONFIDENCE).ok()
}

/// The likeliest failure.
impl Subset {
    /// The likeliest failure that was found.
    #[must_use]
    pub fn likeliest(&self) -> Option<&Point> {
        self.teams.likeliest.as_ref()
    }
}

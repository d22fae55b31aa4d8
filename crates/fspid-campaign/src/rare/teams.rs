//! Independent repetitions (teams) of subset simulation: each gives an estimate, and their scatter the confidence interval.
//!
//! $$ \hat p = \prod_{j=1}^{m} \frac{n_j}{n} \cdot \frac{f}{n}, \qquad E[\hat p] = p $$
//!
//! with the $n_j$ of n points that are above level j and the f that fail. The levels are given, every point above a level has
//! the same number of points after it on average, and the moves keep the law of the points above the level; so the estimate
//! has no bias however badly the chains mix (it is that of sequential Monte Carlo for a normalising constant). What bad mixing
//! does is to spread the teams' estimates, and that is seen, because the teams know nothing of each other.
//!
//! # Source
//! S.-K. Au, J. L. Beck, "Estimation of small failure probabilities in high dimensions by subset simulation", Probabilistic
//! Engineering Mechanics 16 (2001) 263; P. Del Moral, *Feynman-Kac Formulae* (2004), for the bias.

use super::chains::{self, Chain, LimitState, Member, Moves};
use super::ladder::Rung;
use super::point::Point;

/// How many teams.
pub const TEAMS: usize = 10;

/// What the teams brought back.
#[derive(Clone, Debug, PartialEq)]
pub struct Teams {
    /// Of each rung, and of failure at last, the share of each team's points that were above it.
    pub shares: Vec<Vec<f64>>,
    /// Points of each team on each rung.
    pub count: usize,
    /// Share of the moves that were made above each rung.
    pub made: Vec<f64>,
    /// The likeliest failure.
    pub likeliest: Option<Point>,
    /// Points that failed, the same point in two places counted twice.
    pub failing: u64,
    /// Points that were asked for.
    pub asked: u64,
}

impl Teams {
    /// Each team's estimate of the probability to be above the first `rungs` rungs.
    #[must_use]
    pub fn estimates(&self, rungs: usize) -> Vec<f64> {
        let product = |team: usize| {
            let shares = self.shares.iter().take(rungs);
            shares.filter_map(|shares| shares.get(team)).product()
        };
        (0..TEAMS).map(product).collect()
    }
}

/// Sends the teams up the rungs with `count` points each. `to_failure` asks for those who fail above the last rung.
pub(super) fn climb<L: LimitState>(
    state: &mut L,
    seed: u64,
    rungs: &[Rung],
    count: usize,
) -> Result<Teams, L::Error> {
    let numbers = 1..TEAMS as u64 + 1;
    let mut teams = chains::drawn(state, seed, numbers.clone(), count)?;
    let mut found = Teams {
        shares: Vec::new(),
        count,
        made: Vec::new(),
        likeliest: None,
        failing: 0,
        asked: (TEAMS * count) as u64,
    };
    for (place, rung) in rungs.iter().enumerate() {
        found.take_shares(&teams, |score| score >= rung.level);
        let number = place as u64 + 1;
        let mut begun: Vec<Chain> = Vec::new();
        for (team, members) in numbers.clone().zip(teams) {
            let survivors =
                members.into_iter().filter(|member| member.score >= rung.level).collect();
            begun.extend(chains::begun(survivors, count, seed, team, number));
        }
        let mut moves = Moves::default();
        while begun.iter().any(|chain| chain.states.len() < chain.wanted) {
            moves.add(chains::step(state, seed, number, rung.level, rung.steps, &mut begun)?);
        }
        let tried = moves.tried.iter().sum::<u64>();
        found.asked += tried;
        found.made.push(moves.made.iter().sum::<u64>() as f64 / tried.max(1) as f64);
        teams = by_team(begun);
    }
    found.take_shares(&teams, |score| score > 0.0);
    let failures = || teams.iter().flatten().filter(|member| member.score > 0.0);
    found.failing = failures().count() as u64;
    let likeliest =
        failures().min_by(|a, b| a.point.distance_squared().total_cmp(&b.point.distance_squared()));
    found.likeliest = likeliest.map(|member| member.point.clone());
    Ok(found)
}

/// The points that chains left behind, each team's together.
fn by_team(chains: Vec<Chain>) -> Vec<Vec<Member>> {
    let mut teams: Vec<Vec<Member>> = vec![Vec::new(); TEAMS];
    for chain in chains {
        teams[chain.team as usize - 1].extend(chain.states);
    }
    teams
}

impl Teams {
    fn take_shares(&mut self, teams: &[Vec<Member>], is_above: impl Fn(f64) -> bool) {
        let share = |members: &Vec<Member>| {
            let above = members.iter().filter(|member| is_above(member.score)).count();
            above as f64 / self.count.max(1) as f64
        };
        self.shares.push(teams.iter().map(share).collect());
    }
}

//! Intermediate levels of subset simulation: each has a conditional probability of a fifth, set by a pilot team.
//!
//! Levels and lengths of steps are chosen here, from flights that count for nothing else. The teams that follow take both as
//! given, so that what they count is not biased by the choice.

use super::chains::{self, LimitState, Member, Moves};
use super::point::Steps;

/// Share of the points that is taken to the next level: between a tenth and three tenths the cost for a given surety
/// differs little (K. M. Zuev, J. L. Beck, S.-K. Au, L. S. Katafygiotis, "Bayesian post-processor and other enhancements of
/// subset simulation", Computers and Structures 92 (2012) 283).
pub const SHARE: f64 = 0.2;
/// Most rungs: $0.2^{18} = 3 \cdot 10^{-13}$, beyond which 53 binary digits of a coordinate have no numbers left.
pub const MOST_RUNGS: usize = 18;
/// Share of moves that shall be made: of random walks the best is between 0.2 and 0.5, and flat there.
const MADE: f64 = 0.4;
/// How fast the length of steps follows.
const GAIN: f64 = 1.0;
/// Shortest step: of moves of one in a thousand, nobody gets anywhere.
const SHORTEST: f64 = 1e-3;

/// A level and how points move above it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rung {
    /// Scores from here on are above.
    pub level: f64,
    /// How far moves go.
    pub steps: Steps,
}

/// Why a ladder ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LadderEnd {
    /// Failures are likely enough above its last rung.
    Failure,
    /// The flights were spent.
    Spent,
    /// Nothing leads higher: too many points have the same score.
    Flat,
    /// It has as many rungs as it may have.
    Deep,
}

/// The rungs, lowest first.
#[derive(Clone, Debug, PartialEq)]
pub struct Ladder {
    /// The rungs below failure.
    pub rungs: Vec<Rung>,
    /// Why it ends there.
    pub end: LadderEnd,
    /// Points that were asked for.
    pub asked: u64,
}

/// Climbs with `count` points until failures are likely enough, or `most` points were asked for.
pub(super) fn ladder<L: LimitState>(
    state: &mut L,
    seed: u64,
    count: usize,
    most: u64,
) -> Result<Ladder, L::Error> {
    let mut steps = Steps { normals: 0.9, airs: 0.9 };
    let mut members: Vec<Member> = chains::drawn(state, seed, 0..1, count)?.swap_remove(0);
    let mut asked = count as u64;
    let mut rungs: Vec<Rung> = Vec::new();
    let end = loop {
        let failing = members.iter().filter(|member| member.score > 0.0).count();
        if failing as f64 >= SHARE * members.len() as f64 {
            break LadderEnd::Failure;
        }
        if asked + count as u64 > most {
            break LadderEnd::Spent;
        }
        if rungs.len() >= MOST_RUNGS {
            break LadderEnd::Deep;
        }
        let before = rungs.last().map_or(f64::NEG_INFINITY, |rung| rung.level);
        let Some(level) = next_level(&members, before) else { break LadderEnd::Flat };
        members.retain(|member| member.score >= level);
        let number = rungs.len() as u64 + 1;
        let mut begun = chains::begun(members, count, seed, 0, number);
        while begun.iter().any(|chain| chain.states.len() < chain.wanted) {
            let moves = chains::step(state, seed, number, level, steps, &mut begun)?;
            asked += moves.tried.iter().sum::<u64>();
            steps = followed(steps, moves);
        }
        members = begun.into_iter().flat_map(|chain| chain.states).collect();
        rungs.push(Rung { level, steps });
    };
    Ok(Ladder { rungs, end, asked })
}

/// The score that a fifth of the points has reached, or the next one above it where too many share it; none where that
/// leads nowhere. Never above 0, which is failure.
fn next_level(members: &[Member], before: f64) -> Option<f64> {
    let mut scores: Vec<f64> = members.iter().map(|member| member.score).collect();
    scores.sort_by(|a, b| b.total_cmp(a));
    let kept = ((SHARE * scores.len() as f64).ceil() as usize).max(1);
    let level = *scores.get(kept - 1)?;
    let reached = scores.partition_point(|score| *score >= level);
    let above = scores.partition_point(|score| *score > level);
    // Of points of the same score, half must be left behind, or those above it are who goes on.
    let level =
        if 2 * reached > scores.len() && above > 0 { *scores.get(above - 1)? } else { level };
    (level.min(0.0) > before && (2 * reached <= scores.len() || above > 0))
        .then_some(level.min(0.0))
}

/// Longer steps where too many moves are made, shorter ones where too few are.
fn followed(steps: Steps, moves: Moves) -> Steps {
    let follow = |step: f64, part: usize| match moves.tried[part] {
        0 => step,
        tried => {
            let made = moves.made[part] as f64 / tried as f64;
            (step * libm::exp(GAIN * (made - MADE))).clamp(SHORTEST, 1.0)
        }
    };
    Steps { normals: follow(steps.normals, 0), airs: follow(steps.airs, 1) }
}

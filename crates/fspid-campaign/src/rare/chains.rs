//! Points above a level, made more by chains that never leave it.
//!
//! A chain begins at a point that is above the level and goes on by moves that keep the law of the whole space; a move that
//! falls below the level is not made. So the law of the points above the level is kept exactly (Metropolis), however far the
//! moves go: the length of a step is a matter of cost alone.

use super::dice::{Dice, Place};
use super::point::{Part, Point, Shape, Steps};

/// What decides whether a point fails, and how far it is from that.
pub trait LimitState {
    /// Why scores cannot be told.
    type Error;

    /// What points it takes.
    fn shape(&self) -> Shape;

    /// The score of each point: above 0 is a failure, and the higher the nearer or the worse.
    ///
    /// # Errors
    /// Why scores cannot be told; none for points that are of the shape, if it can be helped.
    fn scores(&mut self, points: &[Point]) -> Result<Vec<f64>, Self::Error>;
}

/// A point with its score.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Member {
    pub(super) point: Point,
    pub(super) score: f64,
}

/// A chain: where it is, what it left behind, and how many points it shall have in all.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    pub(super) team: u64,
    pub(super) number: u64,
    pub(super) states: Vec<Member>,
    pub(super) wanted: usize,
}

/// Moves that were tried and made: of numbers, of noises, of seeds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Moves {
    pub(super) tried: [u64; 3],
    pub(super) made: [u64; 3],
}

impl Moves {
    pub(super) fn add(&mut self, other: Self) {
        for part in 0..3 {
            self.tried[part] += other.tried[part];
            self.made[part] += other.made[part];
        }
    }
}

/// So many points of the whole space.
pub(super) fn drawn<L: LimitState>(
    state: &mut L,
    seed: u64,
    teams: std::ops::Range<u64>,
    count: usize,
) -> Result<Vec<Vec<Member>>, L::Error> {
    let shape = state.shape();
    let places = teams.clone().flat_map(|team| {
        (0..count as u64).map(move |member| Place { team, rung: 0, step: 0, member })
    });
    let points: Vec<Point> =
        places.map(|place| Point::drawn(shape, &mut Dice::at(seed, place))).collect();
    let scores = state.scores(&points)?;
    let mut members = points.into_iter().zip(scores).map(|(point, score)| Member { point, score });
    Ok(teams.map(|_| members.by_ref().take(count).collect()).collect())
}

/// One step of every chain that is not long enough: what was tried and made.
pub(super) fn step<L: LimitState>(
    state: &mut L,
    seed: u64,
    rung: u64,
    level: f64,
    steps: Steps,
    chains: &mut [Chain],
) -> Result<Moves, L::Error> {
    let mut active: Vec<&mut Chain> =
        chains.iter_mut().filter(|chain| chain.states.len() < chain.wanted).collect();
    let proposed: Vec<(Point, Part)> = active
        .iter()
        .filter_map(|chain| {
            let (team, member) = (chain.team, chain.number);
            let place = Place { team, rung, step: chain.states.len() as u64, member };
            let last = chain.states.last()?;
            Some(last.point.moved(steps, &mut Dice::at(seed, place)))
        })
        .collect();
    let (points, parts): (Vec<Point>, Vec<Part>) = proposed.into_iter().unzip();
    let scores = state.scores(&points)?;
    let mut moves = Moves::default();
    for (((chain, point), part), score) in active.iter_mut().zip(points).zip(parts).zip(scores) {
        let part = part as usize;
        moves.tried[part] += 1;
        // Not below, and NaN is.
        if score >= level {
            moves.made[part] += 1;
            chain.states.push(Member { point, score });
        } else if let Some(last) = chain.states.last().cloned() {
            chain.states.push(last);
        }
    }
    Ok(moves)
}

/// Chains from those who are above the level, as long as makes `count` points of them together: all as long as each other,
/// and those that are one point longer chosen by lot. So every one of them has as many points after it, on average.
pub(super) fn begun(
    survivors: Vec<Member>,
    count: usize,
    seed: u64,
    team: u64,
    rung: u64,
) -> Vec<Chain> {
    let (each, over) = (count / survivors.len().max(1), count % survivors.len().max(1));
    let place = Place { team, rung, step: 0, member: 0 };
    let order = Dice::at(seed, place).shuffled(survivors.len());
    let mut wanted = vec![each; survivors.len()];
    for place in order.into_iter().take(over) {
        wanted[place] += 1;
    }
    let begin = |((number, member), wanted): ((u64, Member), usize)| Chain {
        team,
        number,
        states: vec![member],
        wanted,
    };
    (0..).zip(survivors).zip(wanted).map(begin).collect()
}

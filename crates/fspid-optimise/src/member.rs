//! A point with its cost, and what every population does with one.

use serde::{Deserialize, Serialize};

use super::Start;
use super::random::Random;

/// A point of the unit cube and its cost.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Member {
    /// Coordinates, each in [0, 1].
    pub(super) point: Vec<f64>,
    /// Its cost, infinite while it is not known; written as nothing where it is infinite.
    #[serde(with = "finite_or_nothing")]
    pub(super) cost: f64,
}

impl Member {
    /// A point whose cost is not known.
    pub(super) fn unknown(point: Vec<f64>) -> Self {
        Self { point, cost: f64::INFINITY }
    }

    pub(super) fn borrowed(&self) -> (&[f64], f64) {
        (&self.point, self.cost)
    }

    /// Takes over a better point.
    pub(super) fn improve(&mut self, point: &[f64], cost: f64) -> bool {
        let better = cost < self.cost;
        if better {
            self.point = point.to_vec();
            self.cost = cost;
        }
        better
    }

    /// A point of the cube with `dimension` coordinates and a cost that is a number.
    pub(super) fn is_sound(&self, dimension: usize) -> bool {
        in_cube(&self.point, dimension) && !self.cost.is_nan()
    }
}

/// True for a point of the cube with `dimension` coordinates.
pub(super) fn in_cube(point: &[f64], dimension: usize) -> bool {
    point.len() == dimension && point.iter().all(|x| (0.0..=1.0).contains(x))
}

/// `count` costs: what is missing or not a number is infinite, minus infinity the least number.
pub(super) fn sane(told: &[f64], count: usize) -> Vec<f64> {
    let cost = |index| told.get(index).map_or(f64::INFINITY, |&cost| sane_cost(cost));
    (0..count).map(cost).collect()
}

pub(super) fn sane_cost(cost: f64) -> f64 {
    if cost.is_nan() { f64::INFINITY } else { cost.max(f64::MIN) }
}

/// The first points of a population.
pub(super) fn first_points(
    count: usize,
    dimension: usize,
    seed: u64,
    start: Start<'_>,
) -> Vec<Vec<f64>> {
    (0..count).map(|index| first_point(index, dimension, seed, start)).collect()
}

fn first_point(index: usize, dimension: usize, seed: u64, start: Start<'_>) -> Vec<f64> {
    let mut random = Random::of(seed, 0, index);
    match start {
        Start::Anywhere => (0..dimension).map(|_| random.unit()).collect(),
        Start::About(point, _) if index == 0 => fitted(point, dimension),
        Start::About(point, spread) => {
            let about = fitted(point, dimension).into_iter();
            about.map(|x| inside(x + spread * random.normal())).collect()
        }
    }
}

/// A start with as many coordinates as the cube has; where one is missing, the middle.
pub(super) fn fitted(point: &[f64], dimension: usize) -> Vec<f64> {
    (0..dimension).map(|axis| point.get(axis).map_or(0.5, |&x| inside(x))).collect()
}

/// The nearest coordinate in the cube; the middle for what is not a number.
fn inside(x: f64) -> f64 {
    if x.is_nan() { 0.5 } else { x.clamp(0.0, 1.0) }
}

/// Index of the least cost; 0 for none.
pub(super) fn least(members: &[Member]) -> usize {
    let costs = members.iter().enumerate();
    costs.min_by(|a, b| a.1.cost.total_cmp(&b.1.cost)).map_or(0, |(index, _)| index)
}

/// Largest width of the members along any axis.
pub(super) fn width(members: &[Member]) -> f64 {
    let dimension = members.first().map_or(0, |member| member.point.len());
    (0..dimension).map(|axis| width_along(members, axis)).fold(0.0, f64::max)
}

fn width_along(members: &[Member], axis: usize) -> f64 {
    let along = members.iter().map(|member| member.point[axis]);
    let (low, high) =
        along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    high - low
}

/// A coordinate that left the cube stops half way from where it was to the side.
pub(super) fn within(from: f64, to: f64) -> f64 {
    if to < 0.0 {
        0.5 * from
    } else if to > 1.0 {
        0.5 * (1.0 + from)
    } else {
        to
    }
}

/// JSON knows no infinity: an infinite cost is written as nothing.
pub(super) mod finite_or_nothing {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(in super::super) fn serialize<S: Serializer>(cost: &f64, to: S) -> Result<S::Ok, S::Error> {
        cost.is_finite().then_some(*cost).serialize(to)
    }

    pub(in super::super) fn deserialize<'a, D: Deserializer<'a>>(from: D) -> Result<f64, D::Error> {
        Ok(Option::<f64>::deserialize(from)?.unwrap_or(f64::INFINITY))
    }
}

/// The same for several costs.
pub(super) mod finite_or_nothing_each {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(in super::super) fn serialize<S: Serializer>(
        costs: &[f64],
        to: S,
    ) -> Result<S::Ok, S::Error> {
        costs.iter().map(|x| x.is_finite().then_some(*x)).collect::<Vec<_>>().serialize(to)
    }

    pub(in super::super) fn deserialize<'a, D: Deserializer<'a>>(
        from: D,
    ) -> Result<Vec<f64>, D::Error> {
        let costs = Vec::<Option<f64>>::deserialize(from)?;
        Ok(costs.into_iter().map(|x| x.unwrap_or(f64::INFINITY)).collect())
    }
}

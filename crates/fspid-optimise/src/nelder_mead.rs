//! The downhill simplex (Nelder and Mead, Computer Journal 7, 1965), with the coefficients of Gao
//! and Han (Computational Optimization and Applications 51, 2012), which depend on the dimension.

use serde::{Deserialize, Serialize};

use super::kind::{Plan, Snapshot};
use super::member::{Member, finite_or_nothing, first_points, in_cube, sane};
use super::random::Random;
use super::{Optimiser, Start, Stop, reflected};

/// First edge of the simplex, of the unit cube.
const FIRST_EDGE: f64 = 0.02;
/// A simplex smaller than this is started anew about its best corner.
const SMALLEST_EDGE: f64 = 1e-9;
/// The same where another begins somewhere else instead: wide, and given up earlier.
const ANEW_EDGE: f64 = 0.3;
const ANEW_SMALLEST_EDGE: f64 = 1e-6;
/// Restarts before it gives up.
const RESTARTS: usize = 8;

/// A simplex that rolls downhill.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct NelderMead {
    corners: Vec<Member>,
    move_: Move,
    asked: Vec<Vec<f64>>,
    restarts: usize,
    spent: usize,
    anew: Option<Anew>,
    /// Set while the cost of the first corner is asked for.
    unknown: bool,
}

/// How a search goes on with another simplex when one is done.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Anew {
    plan: Plan,
    simplex: u64,
    /// First edge of the present simplex.
    edge: f64,
    /// Best corner of the simplexes before.
    best: Member,
}

impl Anew {
    fn new(plan: Plan, edge: f64) -> Self {
        Self { plan, simplex: 0, edge, best: Member::unknown(vec![0.0; plan.dimension]) }
    }

    fn is_sound(&self, dimension: usize) -> bool {
        self.plan.dimension == dimension && self.edge.is_finite() && self.best.is_sound(dimension)
    }

    /// A point anywhere in the cube.
    fn next(&mut self) -> Vec<f64> {
        self.simplex += 1;
        self.edge = ANEW_EDGE;
        let mut random = Random::of(self.plan.seed, self.simplex, 0);
        (0..self.plan.dimension).map(|_| random.unit()).collect()
    }
}

/// What the candidates on their way are for.
#[derive(Clone, Debug, Serialize, Deserialize)]
enum Move {
    Build,
    Reflect,
    Expand {
        reflected: Member,
    },
    Contract {
        #[serde(with = "finite_or_nothing")]
        reached: f64,
    },
    Shrink,
}

impl NelderMead {
    /// A simplex about `start`, whose cost is known.
    #[must_use]
    pub fn new(start: &[f64], cost: f64) -> Self {
        Self {
            corners: vec![Member { point: start.to_vec(), cost }],
            move_: Move::Build,
            asked: Vec::new(),
            restarts: 0,
            spent: 0,
            anew: None,
            unknown: false,
        }
    }

    /// A simplex at a start whose cost is asked for first, as wide as the start's spread. When it has
    /// collapsed, another begins somewhere else, until the budget is spent.
    #[must_use]
    pub(super) fn from_unknown(plan: Plan, start: Start<'_>) -> Self {
        let points = first_points(1, plan.dimension, plan.seed, start);
        let first = Self::new(points.first().map_or(&[], Vec::as_slice), f64::INFINITY);
        let edge = match start {
            Start::About(_, spread) if spread > ANEW_SMALLEST_EDGE && spread <= 1.0 => spread,
            _ => ANEW_EDGE,
        };
        Self { anew: Some(Anew::new(plan, edge)), unknown: true, ..first }
    }

    pub(super) fn is_sound(&self) -> bool {
        let n = self.dimension();
        let corners = match self.move_ {
            Move::Build => 1,
            _ => n + 1,
        };
        let reflected = match &self.move_ {
            Move::Expand { reflected } => reflected.is_sound(n),
            _ => true,
        };
        self.corners.len() == corners
            && reflected
            && self.corners.iter().all(|corner| corner.is_sound(n))
            && self.asked.iter().all(|point| in_cube(point, n))
            && self.anew.as_ref().is_none_or(|anew| anew.is_sound(n))
    }

    fn dimension(&self) -> usize {
        self.corners.first().map_or(0, |corner| corner.point.len())
    }

    fn sort(&mut self) {
        self.corners.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    }

    /// From the worst corner through the middle of the others, `factor` times the distance beyond.
    fn through_middle(&self, factor: f64) -> Vec<f64> {
        let n = self.dimension();
        let Some((worst, others)) = self.corners.split_last() else {
            return Vec::new();
        };
        (0..n)
            .map(|j| {
                let middle = others.iter().map(|corner| corner.point[j]).sum::<f64>() / n as f64;
                reflected(middle + factor * (middle - worst.point[j]))
            })
            .collect()
    }

    fn size(&self) -> f64 {
        let Some((best, others)) = self.corners.split_first() else {
            return 0.0;
        };
        others
            .iter()
            .flat_map(|corner| corner.point.iter().zip(&best.point).map(|(a, b)| (a - b).abs()))
            .fold(0.0, f64::max)
    }

    fn first_edge(&self) -> f64 {
        self.anew.as_ref().map_or(FIRST_EDGE, |anew| anew.edge)
    }

    fn smallest_edge(&self) -> f64 {
        if self.anew.is_some() { ANEW_SMALLEST_EDGE } else { SMALLEST_EDGE }
    }

    fn most_restarts(&self) -> usize {
        if self.anew.is_some() { 0 } else { RESTARTS }
    }

    fn collapsed(&self) -> bool {
        matches!(self.move_, Move::Reflect) && !self.unknown && self.size() < self.smallest_edge()
    }

    /// Another simplex somewhere else.
    fn begin_anew(&mut self) -> Vec<Vec<f64>> {
        let Some(anew) = &mut self.anew else {
            return Vec::new();
        };
        if let Some(corner) = self.corners.first() {
            anew.best.improve(&corner.point, corner.cost);
        }
        let point = anew.next();
        self.corners = vec![Member::unknown(point.clone())];
        (self.move_, self.restarts, self.unknown) = (Move::Build, 0, true);
        self.asked = vec![point];
        self.asked.clone()
    }

    fn replace_worst(&mut self, point: Vec<f64>, cost: f64) {
        if let Some(worst) = self.corners.last_mut() {
            *worst = Member { point, cost };
        }
        self.move_ = Move::Reflect;
    }

    fn cost_at(&self, from_worst: usize) -> f64 {
        let index = self.corners.len().checked_sub(1 + from_worst);
        index.and_then(|index| self.corners.get(index)).map_or(f64::INFINITY, |corner| corner.cost)
    }

    fn reflected_answer(&mut self, point: Vec<f64>, cost: f64) {
        let best = self.corners.first().map_or(f64::INFINITY, |corner| corner.cost);
        if cost < best {
            self.move_ = Move::Expand { reflected: Member { point, cost } };
        } else if cost < self.cost_at(1) {
            self.replace_worst(point, cost);
        } else {
            let worst = self.cost_at(0);
            if cost < worst {
                self.replace_worst(point, cost);
            }
            self.move_ = Move::Contract { reached: cost.min(worst) };
        }
    }

    /// Candidates about the best corner, one along each axis.
    fn around_best(&self) -> Vec<Vec<f64>> {
        let best = self.corners.first().map_or(&[][..], |corner| &corner.point);
        (0..self.dimension())
            .map(|axis| {
                let mut corner = best.to_vec();
                corner[axis] = reflected(corner[axis] + self.first_edge());
                corner
            })
            .collect()
    }

    fn towards_best(&self) -> Vec<Vec<f64>> {
        let n = self.dimension() as f64;
        let Some((best, others)) = self.corners.split_first() else {
            return Vec::new();
        };
        let keep = 1.0 - 1.0 / n.max(2.0);
        others
            .iter()
            .map(|corner| {
                corner.point.iter().zip(&best.point).map(|(p, b)| b + keep * (p - b)).collect()
            })
            .collect()
    }
}

impl Optimiser for NelderMead {
    fn ask(&mut self) -> Vec<Vec<f64>> {
        if self.stop().is_some() {
            return Vec::new();
        }
        if !self.asked.is_empty() {
            return self.asked.clone();
        }
        if self.unknown {
            self.asked = self.corners.iter().map(|corner| corner.point.clone()).collect();
            return self.asked.clone();
        }
        if self.collapsed() {
            if self.restarts == self.most_restarts() {
                return self.begin_anew();
            }
            self.restarts += 1;
            self.corners.truncate(1);
            self.move_ = Move::Build;
        }
        let n = (self.dimension() as f64).max(2.0);
        self.asked = match self.move_ {
            Move::Build => self.around_best(),
            Move::Reflect => vec![self.through_middle(1.0)],
            Move::Expand { .. } => vec![self.through_middle(1.0 + 2.0 / n)],
            Move::Contract { .. } => vec![self.through_middle(-(0.75 - 0.5 / n))],
            Move::Shrink => self.towards_best(),
        };
        self.asked.clone()
    }

    fn tell(&mut self, costs: &[f64]) {
        let asked = std::mem::take(&mut self.asked);
        self.spent += costs.len().min(asked.len());
        let costs = sane(costs, asked.len());
        let answers = asked.into_iter().zip(costs).map(|(point, cost)| Member { point, cost });
        let mut answers: Vec<Member> = answers.collect();
        if std::mem::take(&mut self.unknown) {
            self.corners = answers;
            return;
        }
        match std::mem::replace(&mut self.move_, Move::Reflect) {
            Move::Build => self.corners.append(&mut answers),
            Move::Shrink => {
                self.corners.truncate(1);
                self.corners.append(&mut answers);
            }
            Move::Reflect => {
                if let Some(Member { point, cost }) = answers.pop() {
                    self.reflected_answer(point, cost);
                }
            }
            Move::Expand { reflected } => {
                let better = answers.pop().filter(|answer| answer.cost < reflected.cost);
                let Member { point, cost } = better.unwrap_or(reflected);
                self.replace_worst(point, cost);
            }
            Move::Contract { reached } => match answers.pop() {
                Some(Member { point, cost }) if cost < reached => self.replace_worst(point, cost),
                _ => self.move_ = Move::Shrink,
            },
        }
        self.sort();
    }

    fn best(&self) -> (&[f64], f64) {
        let here = self.corners.first().map_or((&[][..], f64::INFINITY), Member::borrowed);
        match &self.anew {
            Some(anew) if anew.best.cost < here.1 => anew.best.borrowed(),
            _ => here,
        }
    }

    fn spent(&self) -> usize {
        self.spent
    }

    fn stop(&self) -> Option<Stop> {
        let over = self.anew.as_ref().and_then(|anew| anew.plan.over(self.spent));
        let done = self.anew.is_none() && self.restarts == self.most_restarts() && self.collapsed();
        over.or(done.then_some(Stop::Collapsed))
    }

    fn snapshot(&self) -> Snapshot {
        Snapshot::NelderMead(self.clone())
    }
}

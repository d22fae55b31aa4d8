//! The downhill simplex (Nelder and Mead, Computer Journal 7, 1965), with the coefficients of Gao
//! and Han (Computational Optimization and Applications 51, 2012), which depend on the dimension.

use super::{Optimiser, reflected};

/// First edge of the simplex, of the unit cube.
const FIRST_EDGE: f64 = 0.02;
/// A simplex smaller than this is started anew about its best corner.
const SMALLEST_EDGE: f64 = 1e-9;
/// Restarts before it gives up.
const RESTARTS: usize = 8;

/// A simplex that rolls downhill.
#[derive(Clone, Debug)]
pub struct NelderMead {
    corners: Vec<(Vec<f64>, f64)>,
    move_: Move,
    asked: Vec<Vec<f64>>,
    restarts: usize,
}

/// What the candidates on their way are for.
#[derive(Clone, Debug)]
enum Move {
    Build,
    Reflect,
    Expand { reflected: (Vec<f64>, f64) },
    Contract { reached: f64 },
    Shrink,
}

impl NelderMead {
    /// A simplex about `start`, whose cost is known.
    #[must_use]
    pub fn new(start: &[f64], cost: f64) -> Self {
        Self {
            corners: vec![(start.to_vec(), cost)],
            move_: Move::Build,
            asked: Vec::new(),
            restarts: 0,
        }
    }

    fn dimension(&self) -> usize {
        self.corners.first().map_or(0, |(point, _)| point.len())
    }

    fn sort(&mut self) {
        self.corners.sort_by(|(_, a), (_, b)| a.total_cmp(b));
    }

    /// From the worst corner through the middle of the others, `factor` times the distance beyond.
    fn through_middle(&self, factor: f64) -> Vec<f64> {
        let n = self.dimension();
        let Some(((worst, _), others)) = self.corners.split_last() else {
            return Vec::new();
        };
        (0..n)
            .map(|j| {
                let middle = others.iter().map(|(point, _)| point[j]).sum::<f64>() / n as f64;
                reflected(middle + factor * (middle - worst[j]))
            })
            .collect()
    }

    fn size(&self) -> f64 {
        let Some(((best, _), others)) = self.corners.split_first() else {
            return 0.0;
        };
        others
            .iter()
            .flat_map(|(point, _)| point.iter().zip(best).map(|(a, b)| (a - b).abs()))
            .fold(0.0, f64::max)
    }

    fn replace_worst(&mut self, point: Vec<f64>, cost: f64) {
        if let Some(worst) = self.corners.last_mut() {
            *worst = (point, cost);
        }
        self.move_ = Move::Reflect;
    }

    fn cost_at(&self, from_worst: usize) -> f64 {
        let index = self.corners.len().checked_sub(1 + from_worst);
        index.and_then(|index| self.corners.get(index)).map_or(f64::INFINITY, |(_, cost)| *cost)
    }

    fn reflected_answer(&mut self, point: Vec<f64>, cost: f64) {
        let best = self.corners.first().map_or(f64::INFINITY, |(_, cost)| *cost);
        if cost < best {
            self.move_ = Move::Expand { reflected: (point, cost) };
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
        let best = self.best().0;
        (0..self.dimension())
            .map(|axis| {
                let mut corner = best.to_vec();
                corner[axis] = reflected(corner[axis] + FIRST_EDGE);
                corner
            })
            .collect()
    }

    fn towards_best(&self) -> Vec<Vec<f64>> {
        let n = self.dimension() as f64;
        let Some(((best, _), others)) = self.corners.split_first() else {
            return Vec::new();
        };
        let keep = 1.0 - 1.0 / n.max(2.0);
        others
            .iter()
            .map(|(point, _)| point.iter().zip(best).map(|(p, b)| b + keep * (p - b)).collect())
            .collect()
    }
}

impl Optimiser for NelderMead {
    fn ask(&mut self) -> Vec<Vec<f64>> {
        let n = (self.dimension() as f64).max(2.0);
        let collapsed = matches!(self.move_, Move::Reflect) && self.size() < SMALLEST_EDGE;
        if collapsed {
            if self.restarts == RESTARTS {
                return Vec::new();
            }
            self.restarts += 1;
            self.corners.truncate(1);
            self.move_ = Move::Build;
        }
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
        let mut answers = self.asked.drain(..).zip(costs.iter().copied()).collect::<Vec<_>>();
        match std::mem::replace(&mut self.move_, Move::Reflect) {
            Move::Build => self.corners.append(&mut answers),
            Move::Shrink => {
                self.corners.truncate(1);
                self.corners.append(&mut answers);
            }
            Move::Reflect => {
                if let Some((point, cost)) = answers.pop() {
                    self.reflected_answer(point, cost);
                }
            }
            Move::Expand { reflected } => {
                let better = answers.pop().filter(|(_, cost)| *cost < reflected.1);
                let (point, cost) = better.unwrap_or(reflected);
                self.replace_worst(point, cost);
            }
            Move::Contract { reached } => match answers.pop() {
                Some((point, cost)) if cost < reached => self.replace_worst(point, cost),
                _ => self.move_ = Move::Shrink,
            },
        }
        self.sort();
    }

    fn best(&self) -> (&[f64], f64) {
        self.corners.first().map_or((&[], f64::INFINITY), |(point, cost)| (point, *cost))
    }
}

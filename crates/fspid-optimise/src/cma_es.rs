//! CMA-ES: an evolution strategy that learns the covariance of successful steps (Hansen, The CMA
//! Evolution Strategy: A Tutorial, arXiv:1604.00772, 2016), with the negative weights of that text
//! and restarts (Auger and Hansen, IEEE CEC 2005; Hansen, GECCO 2009).
//!
//! Symbols as there: n dimension, λ candidates, m mean, σ step, C covariance, `p_σ` and `p_c` paths.
//! The cube is mirrored at its sides over and over: a coordinate that leaves is evaluated where it
//! reflects to, while mean and covariance know nothing of sides.

use serde::{Deserialize, Serialize};

use super::cma_strategy::Strategy;
use super::eigen;
use super::kind::{Plan, Snapshot};
use super::member::{Member, finite_or_nothing_each, fitted, in_cube, sane, sane_cost};
use super::random::Random;
use super::{Optimiser, Start, Stop, reflected};

/// First step where nothing is known, of the cube: the tutorial's 0.3 of the interval.
const FIRST_STEP: f64 = 0.3;
/// Steps below this, of the cube, do not change a design.
const SMALLEST_STEP: f64 = 1e-12;
/// Costs that differ by less than this over the whole history are flat.
const FLAT: f64 = 1e-12;
/// Condition of the covariance at which a double has no digits left for its least axis.
const WORST_CONDITION: f64 = 1e14;
/// A step grows at most by this factor in a generation; the tutorial has no limit, and it takes a
/// population of hundreds to reach this one.
const MOST_GROWTH: f64 = std::f64::consts::E;
/// Member whose random numbers place a restart: none of a population has so many.
const RESTART: usize = u32::MAX as usize;

/// What happens when a run has converged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Restarts {
    /// The search ends.
    Never,
    /// It begins anew somewhere else, each time with twice the candidates (IPOP).
    Growing,
    /// As growing, but with as many evaluations spent on small populations with small steps (BIPOP).
    GrowingAndSmall,
}

/// A normal distribution that follows the slope.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CmaEs {
    plan: Plan,
    restarts: Restarts,
    generation: u64,
    spent: usize,
    best: Member,
    /// The point the caller began from, until its cost is known.
    first: Option<Vec<f64>>,
    run: Run,
    asked: Vec<Candidate>,
    /// Candidates of the last growing run, evaluations spent on growing and on small runs.
    grown: usize,
    growing_spent: usize,
    small_spent: usize,
    stop: Option<Stop>,
}

/// One descent from a start until it has converged.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Run {
    lambda: usize,
    small: bool,
    /// Evaluations after which it ends in any case.
    allowance: usize,
    spent: usize,
    generations: u64,
    mean: Vec<f64>,
    step: f64,
    covariance: Vec<f64>,
    /// Square roots of the eigenvalues of the covariance, and its eigenvectors as columns.
    lengths: Vec<f64>,
    axes: Vec<f64>,
    path_step: Vec<f64>,
    path: Vec<f64>,
    /// Best costs of the last generations.
    #[serde(with = "finite_or_nothing_each")]
    history: Vec<f64>,
}

/// A step in the axes of the covariance and where it leads.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Candidate {
    normal: Vec<f64>,
    step: Vec<f64>,
    point: Vec<f64>,
}

impl CmaEs {
    /// A distribution about the start; 0.3 of the cube wide where nothing is known.
    #[must_use]
    pub fn new(plan: Plan, restarts: Restarts, start: Start<'_>) -> Self {
        let plan = Plan { population: plan.population.max(4), ..plan };
        let (mean, step) = match start {
            Start::Anywhere => (anywhere(plan, 0), FIRST_STEP),
            Start::About(point, spread) => {
                let useful = spread > 0.0 && spread.is_finite();
                (fitted(point, plan.dimension), if useful { spread } else { FIRST_STEP })
            }
        };
        let first = matches!(start, Start::About(..)).then(|| mean.clone());
        Self {
            plan,
            restarts,
            generation: 0,
            spent: 0,
            best: Member::unknown(mean.clone()),
            first,
            run: Run::new(mean, step, plan.population, false, plan.budget),
            asked: Vec::new(),
            grown: plan.population,
            growing_spent: 0,
            small_spent: 0,
            stop: None,
        }
    }

    pub(super) fn is_sound(&self) -> bool {
        let n = self.plan.dimension;
        let candidate =
            |c: &Candidate| c.normal.len() == n && c.step.len() == n && in_cube(&c.point, n);
        self.plan.population >= 4
            && self.best.is_sound(n)
            && self.first.as_ref().is_none_or(|point| in_cube(point, n))
            && self.run.is_sound(n)
            && self.asked.iter().all(candidate)
            && self.grown >= 4
    }

    /// Begins anew with another population, or ends.
    fn restart(&mut self, reason: Stop) {
        if self.run.small {
            self.small_spent += self.run.spent;
        } else {
            self.growing_spent += self.run.spent;
        }
        let mut random = Random::of(self.plan.seed, self.generation, RESTART);
        let begin = anywhere(self.plan, self.generation);
        let small = self.small_spent < self.growing_spent;
        self.run = match self.restarts {
            Restarts::Never => {
                self.stop = Some(reason);
                return;
            }
            Restarts::GrowingAndSmall if small && self.grown > self.plan.population => {
                // λ_s = λ (λ_l / 2 λ)^(u²), σ = σ0 10^(-2 u), u uniform: Hansen (2009), section 2.
                let ratio = 0.5 * self.grown as f64 / self.plan.population as f64;
                let share = libm::pow(ratio, random.unit() * random.unit());
                let lambda = (self.plan.population as f64 * share).max(4.0) as usize;
                let step = FIRST_STEP * libm::pow(10.0, -2.0 * random.unit());
                Run::new(begin, step, lambda, true, (self.growing_spent / 2).max(1))
            }
            Restarts::Growing | Restarts::GrowingAndSmall => {
                self.grown = self.grown.saturating_mul(2).min(self.plan.budget.max(4));
                Run::new(begin, FIRST_STEP, self.grown, false, self.plan.budget)
            }
        };
    }
}

/// A point anywhere in the cube.
fn anywhere(plan: Plan, generation: u64) -> Vec<f64> {
    let mut random = Random::of(plan.seed, generation, RESTART - 1);
    (0..plan.dimension).map(|_| random.unit()).collect()
}

impl Run {
    fn new(mean: Vec<f64>, step: f64, lambda: usize, small: bool, allowance: usize) -> Self {
        let n = mean.len();
        Self {
            lambda,
            small,
            allowance,
            spent: 0,
            generations: 0,
            mean,
            step,
            covariance: eigen::identity(n),
            lengths: vec![1.0; n],
            axes: eigen::identity(n),
            path_step: vec![0.0; n],
            path: vec![0.0; n],
            history: Vec::new(),
        }
    }

    fn is_sound(&self, n: usize) -> bool {
        let vectors = [&self.mean, &self.lengths, &self.path_step, &self.path];
        let matrices = [&self.covariance, &self.axes];
        let finite = |v: &&Vec<f64>| v.iter().all(|x| x.is_finite());
        vectors.iter().all(|v| v.len() == n && finite(v))
            && matrices.iter().all(|m| m.len() == n * n && finite(m))
            && self.step.is_finite()
            && self.lambda >= 4
    }

    fn candidate(&self, mut random: Random) -> Candidate {
        let n = self.mean.len();
        let normal: Vec<f64> = (0..n).map(|_| random.normal()).collect();
        let along = |i: usize| -> f64 {
            (0..n).map(|k| self.axes[i * n + k] * self.lengths[k] * normal[k]).sum()
        };
        let step: Vec<f64> = (0..n).map(along).collect();
        let moved = self.mean.iter().zip(&step).map(|(m, y)| reflected(m + self.step * y));
        Candidate { point: moved.collect(), normal, step }
    }

    /// Moves mean, paths, covariance and step after the candidates, best first.
    fn update(&mut self, ranked: &[&Candidate]) {
        let n = self.mean.len();
        let s = Strategy::new(n, self.lambda);
        let mean_of = |pick: fn(&Candidate) -> &Vec<f64>, i: usize| -> f64 {
            s.weights.iter().take(s.parents).zip(ranked).map(|(w, c)| w * pick(c)[i]).sum()
        };
        let step: Vec<f64> = (0..n).map(|i| mean_of(|c| &c.step, i)).collect();
        let normal: Vec<f64> = (0..n).map(|i| mean_of(|c| &c.normal, i)).collect();
        let spread = (s.c_sigma * (2.0 - s.c_sigma) * s.mass).sqrt();
        for (mean, y) in self.mean.iter_mut().zip(&step) {
            *mean += self.step * y;
        }
        for i in 0..n {
            // C^(-1/2) of the mean step is the mean normal turned into the axes.
            let turned: f64 = (0..n).map(|k| self.axes[i * n + k] * normal[k]).sum();
            self.path_step[i] = (1.0 - s.c_sigma) * self.path_step[i] + spread * turned;
        }
        self.generations += 1;
        let length = self.path_step.iter().map(|x| x * x).sum::<f64>().sqrt();
        let faded = libm::pow(1.0 - s.c_sigma, 2.0 * self.generations as f64);
        let steady = length / (1.0 - faded).sqrt() < (1.4 + 2.0 / (n as f64 + 1.0)) * s.chi;
        let gain = if steady { (s.c_c * (2.0 - s.c_c) * s.mass).sqrt() } else { 0.0 };
        for (path, y) in self.path.iter_mut().zip(&step) {
            *path = (1.0 - s.c_c) * *path + gain * y;
        }
        self.learn(&s, ranked, steady);
        self.step *= libm::exp((s.c_sigma / s.damping) * (length / s.chi - 1.0)).min(MOST_GROWTH);
        if self.generations.is_multiple_of(s.lazy) {
            self.decompose();
        }
    }

    /// Rank one and rank μ: $$ C \leftarrow (1 - c_1 - c_\mu \sum w) C + c_1 p p^T + c_\mu \sum w y y^T $$
    fn learn(&mut self, s: &Strategy, ranked: &[&Candidate], steady: bool) {
        let n = self.mean.len();
        let lost = if steady { 0.0 } else { s.c_c * (2.0 - s.c_c) };
        let sum: f64 = s.weights.iter().sum();
        let keep = 1.0 + s.c_1 * lost - s.c_1 - s.c_mu * sum;
        let scaled: Vec<f64> = s
            .weights
            .iter()
            .zip(ranked)
            .map(|(&w, c)| {
                let square: f64 = c.normal.iter().map(|z| z * z).sum();
                s.c_mu * if w < 0.0 { w * n as f64 / square.max(f64::MIN_POSITIVE) } else { w }
            })
            .collect();
        for i in 0..n {
            for j in 0..=i {
                let rank_mu: f64 =
                    scaled.iter().zip(ranked).map(|(w, c)| w * c.step[i] * c.step[j]).sum();
                let entry = keep * self.covariance[i * n + j]
                    + s.c_1 * self.path[i] * self.path[j]
                    + rank_mu;
                self.covariance[i * n + j] = entry;
                self.covariance[j * n + i] = entry;
            }
        }
    }

    fn decompose(&mut self) {
        let (values, axes) = eigen::symmetric(&self.covariance, self.mean.len());
        self.axes = axes;
        // Round-off may make the least of them negative; the condition ends the run then.
        self.lengths = values.iter().map(|value| value.max(0.0).sqrt()).collect();
    }

    /// Why the run is over, if it is.
    fn over(&self) -> Option<Stop> {
        let n = self.mean.len();
        let widest = self.lengths.iter().copied().fold(0.0, f64::max);
        let narrowest = self.lengths.iter().copied().fold(f64::INFINITY, f64::min);
        let wide = (0..n).map(|i| self.covariance[i * n + i].max(0.0).sqrt()).fold(0.0, f64::max);
        let still = !(self.step * wide > SMALLEST_STEP);
        let bad = !(widest * widest <= WORST_CONDITION * narrowest * narrowest);
        if still || bad || !self.step.is_finite() {
            return Some(Stop::Collapsed);
        }
        let exhausted = self.spent >= self.allowance;
        (exhausted || self.flat()).then_some(Stop::NoProgress)
    }

    /// Generations that tell whether anything still moves: 10 + 30 n / λ.
    fn memory(&self) -> usize {
        10 + (30 * self.mean.len()).div_ceil(self.lambda)
    }

    fn flat(&self) -> bool {
        let finite = self.history.iter().copied().filter(|cost| cost.is_finite());
        let low = finite.clone().fold(f64::INFINITY, f64::min);
        let high = self.history.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        self.history.len() >= self.memory() && high - low <= FLAT
    }
}

impl Optimiser for CmaEs {
    fn ask(&mut self) -> Vec<Vec<f64>> {
        if self.stop().is_some() {
            return Vec::new();
        }
        if let Some(first) = &self.first {
            return vec![first.clone()];
        }
        if self.asked.is_empty() {
            self.generation += 1;
            let random = |member| Random::of(self.plan.seed, self.generation, member);
            self.asked =
                (0..self.run.lambda).map(|member| self.run.candidate(random(member))).collect();
        }
        self.asked.iter().map(|candidate| candidate.point.clone()).collect()
    }

    fn tell(&mut self, costs: &[f64]) {
        if let Some(first) = self.first.take() {
            self.spent += 1;
            self.best.improve(&first, costs.first().map_or(f64::INFINITY, |&cost| sane_cost(cost)));
            return;
        }
        let asked = std::mem::take(&mut self.asked);
        let told = costs.len().min(asked.len());
        self.spent += told;
        self.run.spent += told;
        let costs = sane(costs, asked.len());
        let mut ranked: Vec<(&Candidate, f64)> = asked.iter().zip(costs).collect();
        // Equal costs keep the order of the candidates.
        ranked.sort_by(|a, b| a.1.total_cmp(&b.1));
        let Some(&(leader, cost)) = ranked.first() else {
            return;
        };
        self.best.improve(&leader.point, cost);
        self.run.history.push(cost);
        let excess = self.run.history.len().saturating_sub(self.run.memory());
        self.run.history.drain(..excess);
        // Where no cost is finite, there is no order to learn from.
        if cost.is_finite() {
            let ranked: Vec<&Candidate> = ranked.iter().map(|(candidate, _)| *candidate).collect();
            self.run.update(&ranked);
        }
        if let Some(reason) = self.run.over() {
            self.restart(reason);
        }
    }

    fn best(&self) -> (&[f64], f64) {
        self.best.borrowed()
    }

    fn spent(&self) -> usize {
        self.spent
    }

    fn stop(&self) -> Option<Stop> {
        self.plan.over(self.spent).or(self.stop)
    }

    fn snapshot(&self) -> Snapshot {
        Snapshot::CmaEs(self.clone())
    }
}

//! The worst that can be made of a bound in the loop's own equations: gains that move within what the law reaches, as fast
//! as the claim lets them, and the worst disturbance for that motion.

use fspid_core::Gains;
use fspid_lti::Matrix;
use fspid_proof::gain_set::IncrementMap;
use fspid_proof::{Certificate, Claim, Disturbed, Extent, Quantity, Way};
use fspid_sim::Controller;

/// Samples of a motion of the gains.
pub(crate) const SAMPLES: usize = 600;
/// Rounding of the equations, as a share.
const SHARE: f64 = 1.0 + 1e-9;

/// Corners of what the law reaches.
pub(crate) fn corners(certificate: &Certificate) -> Vec<[f64; 3]> {
    let Controller::SelfTuning(fspid) = &certificate.description.controller else {
        panic!("self-tuning")
    };
    let map = IncrementMap::of(fspid.tuner(), certificate.divisions).expect("bounded");
    let set = map.sampled_every(fspid.config().dt_s).gains(1.0);
    set.hull().into_iter().map(|Gains { kp, ki, kd }| [kp, ki, kd]).collect()
}

/// Gains that go from corner to corner in straight lines, as fast as the claim lets them, and stay at each for some
/// samples. All of it is in the convex body that the law reaches. `part` draws numbers from 0 to 1.
pub(crate) fn motion(
    certificate: &Certificate,
    corners: &[[f64; 3]],
    stay: usize,
    part: &mut dyn FnMut() -> f64,
) -> Vec<Gains<f64>> {
    let most = match &certificate.claim {
        Claim::BoundedRate(claim) => [0, 1, 2].map(|gain: usize| {
            let [lower, upper] = claim.ends[gain];
            0.5 * (upper - lower) * claim.changes[gain] * (1.0 - 1e-9)
        }),
        _ => [f64::INFINITY; 3],
    };
    let mut pick = || corners[(part() * corners.len() as f64) as usize];
    let (mut at, mut target, mut left) = (pick(), pick(), stay);
    if stay >= SAMPLES {
        target = at;
    }
    let mut gains = Vec::new();
    while gains.len() < SAMPLES {
        let [kp, ki, kd] = at;
        gains.push(Gains { kp, ki, kd });
        let way = [0, 1, 2].map(|gain: usize| target[gain] - at[gain]);
        let slowest = way.iter().zip(most).map(|(way, most)| way.abs() / most);
        let slowest = slowest.filter(|it| it.is_finite()).fold(0.0, f64::max);
        let share = if slowest > 1.0 { 1.0 / slowest } else { 1.0 };
        at = [0, 1, 2].map(|gain: usize| at[gain] + share * way[gain]);
        if share >= 1.0 {
            left -= 1;
            if left == 0 {
                (target, left) = (pick(), stay);
            }
        }
    }
    gains
}

/// The loop along a motion of its gains: its matrix at each sample, what is seen there, and how the elevator enters.
struct Along {
    matrices: Vec<Matrix>,
    seen: Vec<Vec<f64>>,
    entry: Matrix,
    dt_s: f64,
}

fn along(certificate: &Certificate, gains: &[Gains<f64>], of: (&Way, Quantity)) -> Along {
    let ((way, quantity), description) = (of, &certificate.description);
    let model = description.enclosed().expect("enclosed").midpoint();
    let plant = description.printed();
    let numerator = match way {
        Way::Elevator => None,
        Way::Air { numerator, .. } => Some(&numerator[..]),
    };
    let matrix = |gains: &Gains<f64>| model.closed_matrix(*gains).expect("a matrix");
    let row = |gains: &Gains<f64>| match quantity {
        Quantity::Command => model.command_row(*gains),
        _ => (0..model.size()).map(|state| f64::from(u8::from(state == 0))).collect(),
    };
    Along {
        matrices: gains.iter().map(matrix).collect(),
        seen: gains.iter().map(row).collect(),
        entry: plant.driven(numerator).expect("driven"),
        dt_s: plant.dt_s,
    }
}

fn times(matrix: &Matrix, vector: &[f64]) -> Vec<f64> {
    let row = |row: &[f64]| row.iter().zip(vector).map(|(a, b)| a * b).sum();
    matrix.data().chunks(matrix.columns()).map(row).collect()
}

fn transposed_times(matrix: &Matrix, vector: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; matrix.columns()];
    for (row, factor) in matrix.data().chunks(matrix.columns()).zip(vector) {
        sum.iter_mut().zip(row).for_each(|(sum, entry)| *sum += factor * entry);
    }
    sum
}

fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

impl Along {
    fn states(&self) -> usize {
        self.matrices[0].rows()
    }

    /// What u makes of what is seen, sample by sample.
    fn flown(&self, u: &[Vec<f64>]) -> Vec<f64> {
        let mut state = vec![0.0; self.states()];
        let mut seen = Vec::new();
        for ((matrix, row), u) in self.matrices.iter().zip(&self.seen).zip(u) {
            seen.push(dot(row, &state));
            state = times(matrix, &state);
            let added = times(&self.entry, u);
            state.iter_mut().zip(added).for_each(|(state, more)| *state += more);
        }
        seen
    }

    /// How weights on what is seen depend on u.
    fn back(&self, weights: &[f64]) -> Vec<Vec<f64>> {
        let mut after = vec![0.0; self.states()];
        let mut u = Vec::new();
        for ((matrix, row), weight) in self.matrices.iter().zip(&self.seen).zip(weights).rev() {
            u.push(transposed_times(&self.entry, &after[..self.entry.rows()]));
            after = transposed_times(matrix, &after);
            after.iter_mut().zip(row).for_each(|(sum, entry)| *sum += weight * entry);
        }
        u.reverse();
        u
    }

    /// The largest gain from energy to energy over the motion, from below: by powers.
    fn energy(&self) -> f64 {
        let size = |u: &[Vec<f64>]| u.iter().map(|it| dot(it, it)).sum::<f64>().sqrt();
        let mut u = vec![vec![1.0; self.entry.columns()]; self.matrices.len()];
        let mut gain = 0.0_f64;
        for _ in 0..60 {
            let seen = self.flown(&u);
            gain = gain.max((self.dt_s * dot(&seen, &seen)).sqrt() / size(&u));
            u = self.back(&seen);
            let length = size(&u);
            u.iter_mut().flatten().for_each(|it| *it /= length);
        }
        gain
    }

    /// The most that a disturbance of magnitude 1 makes of what is seen at the end.
    fn peak(&self) -> f64 {
        let mut weights = vec![0.0; self.matrices.len()];
        if let Some(last) = weights.last_mut() {
            *last = 1.0;
        }
        let each = self.back(&weights).into_iter();
        self.dt_s.sqrt() * each.map(|it| dot(&it, &it).sqrt()).sum::<f64>()
    }
}

/// The share of a bound that the worst disturbance of a motion comes to.
pub(crate) fn share(certificate: &Certificate, bound: &Disturbed, gains: &[Gains<f64>]) -> f64 {
    let along = along(certificate, gains, (&bound.way, bound.quantity));
    let reached = match bound.extent {
        Extent::Energy => along.energy(),
        Extent::Peak => along.peak(),
    };
    reached / (bound.per_unit * SHARE)
}

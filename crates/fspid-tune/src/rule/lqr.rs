//! Least quadratic cost with what is measured.
//!
//! The full state of plant and servo is not measured, so that state feedback cannot be flown. Measured are pitch, pitch
//! rate and the integral of the error: constant gains on these are what a PI controller with a rate loop is. Their cost
//! is computed exactly for the sampled loop, and the least is searched from the state feedback of a model whose states
//! are all measured.

use fspid_core::{Gains, IntegralForm, PidConfig};
use fspid_lti::{Matrix, regulator};
use fspid_optimise::{Parameter, Scale, Space, polish};
use fspid_sim::loop_model::Memory;
use serde::Serialize;

use super::RuleError;
use super::json::start_gains;
use super::model::Model;
use super::options::LqrOptions;
use super::process::Process;

/// Evaluations of a descent; three gains need some 150.
const EVALUATIONS: usize = 400;
/// Descents, each from where the last one ended: a simplex that has collapsed begins anew.
const DESCENTS: usize = 3;
/// Each gain is searched between the start over this and times this.
const REACH: f64 = 100.0;
/// Doublings of the sum of a cost: up to 2⁴⁰ samples.
const DOUBLINGS: usize = 40;
/// Share of the ultimate gain from which the search begins where the model's gains do not hold the loop.
const CALM: [f64; 2] = [0.2, 0.02];

/// Rate and proportional gains that are tried last, three a decade; the integral's is a tenth.
const DAMPED: [f64; 10] = [0.03, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0];

/// How the least cost was found.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LqrSearch {
    /// Proportional gain, integral gain and rate gain that the search began with.
    #[serde(serialize_with = "start_gains")]
    pub start: [f64; 3],
    /// Their cost, after a pitch error of 1 rad.
    pub start_cost: f64,
    /// Least cost.
    pub cost: f64,
    /// Costs that were computed.
    pub evaluations: usize,
}

/// Gains of the state feedback $u = -k_\theta \theta - k_q q + k_i \int (-\theta) dt$ of least cost for the model
///
/// $$ \dot \theta = q, \quad T_2 \dot q = -q + K' u $$
///
/// without its dead time: proportional, integral and rate gain. Without T2 the rate is no state and has no gain.
pub(super) fn state_feedback(model: &Model, weights: LqrOptions) -> Result<[f64; 3], RuleError> {
    let LqrOptions { error, rate, integral, command } = weights;
    let r = Matrix::from_rows(&[[command]])?;
    match *model {
        Model::IntegratorLag { slope, time_s, .. } if time_s > 0.0 => {
            let a =
                Matrix::from_rows(&[[0.0, 1.0, 0.0], [0.0, -1.0 / time_s, 0.0], [-1.0, 0.0, 0.0]])?;
            let b = Matrix::from_rows(&[[0.0], [slope / time_s], [0.0]])?;
            let q =
                Matrix::from_rows(&[[error, 0.0, 0.0], [0.0, rate, 0.0], [0.0, 0.0, integral]])?;
            let gain = regulator(&a, &b, &q, &r)?.gain;
            let at = |column| gain.get(0, column).unwrap_or(0.0);
            Ok([at(0), -at(2), at(1)])
        }
        Model::Integrator { slope, .. } | Model::IntegratorLag { slope, .. } => {
            let a = Matrix::from_rows(&[[0.0, 0.0], [-1.0, 0.0]])?;
            let b = Matrix::from_rows(&[[slope], [0.0]])?;
            // The rate is K' u, so that its weight is one of the command.
            let r = Matrix::from_rows(&[[command + rate * slope * slope]])?;
            let q = Matrix::from_rows(&[[error, 0.0], [0.0, integral]])?;
            let gain = regulator(&a, &b, &q, &r)?.gain;
            let at = |column| gain.get(0, column).unwrap_or(0.0);
            Ok([at(0), -at(1), 0.0])
        }
        Model::Lag { .. } | Model::TwoLags { .. } => Err(RuleError::NoStart),
    }
}

/// Cost of proportional, integral and rate gain in the sampled loop, from a pitch error of 1 rad with everything else
/// at rest, the set-point at zero; infinite where they do not hold it.
///
/// $$ J = \sum_k T \left( w_e \theta_k^2 + w_q q_k^2 + w_I I_k^2 + w_u u_k^2 \right) = x_0^T P x_0, \quad
/// P = \sum_k (M^T)^k W M^k $$
///
/// P is summed by doubling: $P_{2n} = P_n + (M^n)^T P_n M^n$.
pub(super) fn cost(
    process: &Process,
    weights: LqrOptions,
    [kp, ki, rate_gain_s]: [f64; 3],
) -> Result<f64, RuleError> {
    // The literal integral remembers the sum of errors, whatever its gain.
    let config = PidConfig { rate_gain_s, integral: IntegralForm::Literal, ..process.config };
    let memory = Memory { integral: true, derivative: false, previous: false };
    let model = process.model(&config, memory)?;
    let gains = Gains { kp, ki, kd: 0.0 };
    let [error, _] = model.error_rows();
    let mut rate = vec![0.0; model.size()];
    for (to, from) in rate.iter_mut().zip(&model.plant().rate) {
        *to = *from;
    }
    let integral = model.integral_row(Gains { ki: 1.0, ..gains });
    let rows = [
        (weights.error, error),
        (weights.rate, rate),
        (weights.integral, integral),
        (weights.command, model.command_row(gains)),
    ];
    let weight = weighted(&rows, config.dt_s)?;
    let start = model.pitch_off(1.0);
    Ok(summed(model.closed_matrix(gains)?, weight, &start)?.unwrap_or(f64::INFINITY))
}

/// $\sum w c^T c T$ over rows c with their weights.
fn weighted(rows: &[(f64, Vec<f64>)], dt_s: f64) -> Result<Matrix, RuleError> {
    let size = rows.first().map_or(0, |(_, row)| row.len());
    let mut sum = Matrix::zeros(size, size);
    for (weight, row) in rows {
        let row = Matrix::from_rows(&[row])?;
        sum = sum.sum(&row.transpose().product(&row)?.scaled(weight * dt_s))?;
    }
    Ok(sum)
}

/// $x_0^T P x_0$; none if the sum does not end.
fn summed(mut step: Matrix, mut sum: Matrix, start: &[f64]) -> Result<Option<f64>, RuleError> {
    let start = Matrix::from_rows(&[start])?;
    for _ in 0..DOUBLINGS {
        let added = step.transpose().product(&sum)?.product(&step)?;
        sum = sum.sum(&added)?;
        // Written so that NaN does not end it well.
        if !(added.norm_one() < 1e100) {
            return Ok(None);
        }
        if added.norm_one() <= f64::EPSILON * sum.norm_one() {
            return Ok(start.product(&sum)?.product(&start.transpose())?.get(0, 0));
        }
        step = step.product(&step)?;
    }
    Ok(None)
}

/// Gains of least cost, searched from the first of some starts that holds the loop.
pub(super) fn least_cost(
    process: &Process,
    weights: LqrOptions,
    starts: &[[f64; 3]],
) -> Result<([f64; 3], LqrSearch), RuleError> {
    let mut begun = None;
    for start in starts {
        let found = cost(process, weights, *start)?;
        if found.is_finite() {
            begun = Some((*start, found));
            break;
        }
    }
    let (start, start_cost) = begun.ok_or(RuleError::NoStart)?;
    let (mut best, mut least, mut evaluations) = (start, start_cost, 0);
    for _ in 0..DESCENTS {
        let (gains, found, spent) = descend(process, weights, best, least);
        evaluations += spent;
        if found < least {
            (best, least) = (gains, found);
        }
    }
    Ok((best, LqrSearch { start, start_cost, cost: least, evaluations }))
}

fn descend(
    process: &Process,
    weights: LqrOptions,
    from: [f64; 3],
    known: f64,
) -> ([f64; 3], f64, usize) {
    // A gain of zero has no decades around it.
    let floor = from.iter().fold(0.0, |most: f64, gain| most.max(gain.abs())) / REACH;
    let middle = from.map(|gain| gain.max(floor));
    let names = ["kp", "ki", "rate_gain"];
    let parameters = names.into_iter().zip(middle).map(|(name, middle)| Parameter {
        name,
        lower: middle / REACH,
        upper: middle * REACH,
        scale: Scale::Logarithmic,
    });
    let space = Space::new(parameters.collect());
    let value = |point: &[f64]| match point {
        [kp, ki, rate] => cost(process, weights, [*kp, *ki, *rate]).unwrap_or(f64::INFINITY),
        _ => f64::INFINITY,
    };
    let at_middle = value(&middle);
    let known = if at_middle.is_finite() { at_middle } else { known };
    let found = polish(&space, (&middle, known), EVALUATIONS, 0.0, value);
    match found.point.as_slice() {
        [kp, ki, rate] => ([*kp, *ki, *rate], found.cost, found.evaluations),
        _ => (from, known, found.evaluations),
    }
}

/// Gains far below an ultimate gain, for a loop that the model's gains do not hold.
pub(super) fn calm_start(ultimate_gain: f64) -> [f64; 3] {
    let [proportional, integral] = CALM;
    [proportional * ultimate_gain, integral * ultimate_gain, 0.0]
}

/// Gains with a rate loop, small ones first, for a loop that no proportional gain holds.
pub(super) fn damped_starts() -> impl Iterator<Item = [f64; 3]> {
    DAMPED.into_iter().map(|gain| [gain, 0.1 * gain, gain])
}

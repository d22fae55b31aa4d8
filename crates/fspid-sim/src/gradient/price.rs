//! Costs of a flight (error and travel), and their derivatives with respect to each of its samples.

use fspid_numeric::{InstructionSet, Scalar};

use super::flight::differentiate_prices;
use crate::batch::{Entrant, Refusal};

/// A flight as it was flown, sample by sample.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Flown {
    /// Commanded pitch, rad.
    pub setpoint_rad: Vec<f64>,
    /// Pitch, rad.
    pub theta_rad: Vec<f64>,
    /// Elevator in the plant's own sign, rad.
    pub elevator_rad: Vec<f64>,
    /// The controller's command, nose up positive, rad.
    pub command_rad: Vec<f64>,
}

/// Derivative of the cost with respect to each sample of a flight; samples missing from a column count as zero.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Slopes {
    /// By pitch, for each rad.
    pub theta_rad: Vec<f64>,
    /// By the elevator.
    pub elevator_rad: Vec<f64>,
    /// By the command.
    pub command_rad: Vec<f64>,
}

impl Slopes {
    /// Slopes of nothing, for so many samples.
    #[must_use]
    pub fn zero(rows: usize) -> Self {
        let zero = || vec![0.0; rows];
        Self { theta_rad: zero(), elevator_rad: zero(), command_rad: zero() }
    }
}

/// Weights of a flight's cost: a weighted sum of its measures.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Weights {
    /// Of $T \sum |r_k - \theta_k|$, rad s.
    pub iae_rad_s: f64,
    /// Of $T \sum (r_k - \theta_k)^2$, rad² s.
    pub ise_rad2_s: f64,
    /// Of the elevator's travel $\sum |\delta_k - \delta_{k-1}|$, rad.
    pub travel_rad: f64,
}

/// A flight's costs and what every number of its controller is worth.
#[derive(Clone, Debug, PartialEq)]
pub struct Differentiated {
    /// $T \sum |r_k - \theta_k|$, rad s.
    pub iae_rad_s: f64,
    /// $T \sum (r_k - \theta_k)^2$, rad² s.
    pub ise_rad2_s: f64,
    /// The elevator's travel, rad.
    pub travel_rad: f64,
    /// Derivative of the weighted sum by each number, as [`numbers`](super::numbers()) has them.
    pub gradient: Vec<f64>,
}

/// Costs of up to `W` flights and their gradients; none for a flight that diverges, or in which a sample is held.
///
/// # Errors
/// [`Refusal`] for flights that have no gradient here, or that differ in their structure.
pub fn differentiate<const W: usize>(
    flights: &[Entrant<'_>],
    weights: &[Weights],
) -> Result<Vec<Option<Differentiated>>, Refusal> {
    differentiate_by::<W>(InstructionSet::best(), flights, weights)
}

/// [`differentiate`] by instructions of choice: the bits are the same.
///
/// # Errors
/// As [`differentiate`].
pub fn differentiate_by<const W: usize>(
    instructions: InstructionSet,
    flights: &[Entrant<'_>],
    weights: &[Weights],
) -> Result<Vec<Option<Differentiated>>, Refusal> {
    let mut costs = vec![[0.0; 3]; flights.len()];
    let found = differentiate_prices::<W>(instructions, flights, |flight, flown| {
        let dt_s = flights[flight].prepared.timing().dt_s();
        let (cost, slopes) = weights.get(flight).copied().unwrap_or_default().of(flown, dt_s);
        costs[flight] = cost;
        slopes
    })?;
    let differentiated = found.into_iter().zip(costs).map(|(gradient, cost)| {
        let [iae_rad_s, ise_rad2_s, travel_rad] = cost;
        gradient.map(|gradient| Differentiated { iae_rad_s, ise_rad2_s, travel_rad, gradient })
    });
    Ok(differentiated.collect())
}

impl Weights {
    /// What a flight has of each, and its slopes.
    pub(super) fn of(&self, flown: &Flown, dt_s: f64) -> ([f64; 3], Slopes) {
        let mut slopes = Slopes::zero(flown.theta_rad.len());
        let (mut iae, mut ise) = (0.0, 0.0);
        let errors = flown.setpoint_rad.iter().zip(&flown.theta_rad).map(|(r, theta)| r - theta);
        for (slope, error_rad) in slopes.theta_rad.iter_mut().zip(errors) {
            iae += error_rad.abs();
            ise += error_rad * error_rad;
            let by_error = self.iae_rad_s * error_rad.sign() + 2.0 * self.ise_rad2_s * error_rad;
            *slope = -dt_s * by_error;
        }
        let travel_rad =
            add_variation(&flown.elevator_rad, self.travel_rad, &mut slopes.elevator_rad);
        ([iae * dt_s, ise * dt_s, travel_rad], slopes)
    }
}

/// Adds the slopes of $w \sum |x_k - x_{k-1}|$, and answers the sum without the weight.
pub fn add_variation(values: &[f64], weight: f64, slopes: &mut [f64]) -> f64 {
    let mut sum = 0.0;
    for (k, pair) in values.windows(2).enumerate() {
        let moved = pair[1] - pair[0];
        sum += moved.abs();
        let by = weight * moved.sign();
        slopes[k + 1] += by;
        slopes[k] -= by;
    }
    sum
}

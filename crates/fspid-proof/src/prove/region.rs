//! How far a flight may begin from rest so that a law keeps its gains to a rate, in ordinary arithmetic.

use fspid_core::SelfTuner;
use fspid_lti::Matrix;

use super::Prover;
use crate::certificate::{BoundedRate, Certificate, Claim};
use crate::gain_set::{GainSet, IncrementSlopes};
use crate::limits;
use crate::recheck::{Recheck, input_rows, moved_inputs};

/// Of what ordinary arithmetic finds, so much is claimed.
const CLAIMED: f64 = 1.0 - 1e-6;
/// Halvings of the interval, by its logarithm, in which the largest level is looked for.
const HALVINGS: usize = 5;

/// What an ellipsoid has to keep clear of at the gains of one corner, for a level of 1.
struct Reach {
    /// Square of the largest error and of the largest change, supervisor units.
    inputs: [f64; 2],
    /// Squares and product of what a sample adds to them.
    moved: [f64; 3],
    /// The largest level for the limits.
    within_limits: f64,
}

/// The ellipsoids of a moving form.
pub(super) struct Region<'a> {
    tuner: &'a SelfTuner<f64>,
    reaches: Vec<Reach>,
    /// Numbers of the gains whose rate counts, with scale and the most that each may change by.
    allowed: Vec<(usize, f64, f64)>,
}

/// A certificate of the claim alone.
fn certificate(prover: &Prover<'_>, factor: f64, claim: &BoundedRate) -> Certificate {
    Certificate {
        description: prover.description.clone(),
        output_factor: factor,
        divisions: prover.effort.divisions,
        range: prover.range,
        left_out: prover.asked.left_out.clone(),
        claim: Claim::BoundedRate(claim.clone()),
        steps: None,
        commanded: None,
        family: None,
        disturbances: Vec::new(),
        nonlinear: None,
        level: None,
    }
}

impl<'a> Region<'a> {
    pub(super) fn of(
        prover: &'a Prover<'_>,
        set: &GainSet,
        factor: f64,
        claim: &BoundedRate,
    ) -> Option<Self> {
        let fspid = prover.tuned()?;
        let certificate = certificate(prover, factor, claim);
        let recheck =
            Recheck::with(&certificate, prover.enclosed.clone(), set.clone(), &prover.slopes)
                .ok()?;
        let rest = prover.rest(set).ok()?;
        let decrease = recheck.moving_decrease(claim).ok()?;
        let inputs = input_rows(&prover.model, fspid);
        let corners = decrease.corners(claim).ok()?;
        let reach = |corner: &crate::recheck::Corner| {
            let gains = corner.gains_middle();
            let moved = moved_inputs(&inputs, &prover.model.closed(gains));
            let form = corner.form.midpoint();
            let [error, change] = inputs.each_ref().map(|row| product(&form, row, row));
            let [by_error, by_change] = &moved;
            let limits = limits::rows(prover.description, &prover.model, gains, &rest);
            let within = limits.iter().map(|(row, limit)| {
                if !(*limit > 0.0) {
                    return Some(0.0);
                }
                let size = product(&form, row, row)?;
                Some(if size > 0.0 { limit * limit / size } else { f64::INFINITY })
            });
            Some(Reach {
                inputs: [error?, change?],
                moved: [
                    product(&form, by_error, by_error)?,
                    product(&form, by_error, by_change)?,
                    product(&form, by_change, by_change)?,
                ],
                within_limits: within
                    .collect::<Option<Vec<f64>>>()?
                    .into_iter()
                    .fold(f64::INFINITY, f64::min),
            })
        };
        let reaches = corners.iter().map(reach).collect::<Option<Vec<Reach>>>()?;
        let scale = fspid.tuner().settings().output_scale;
        let scales = [scale.kp, scale.ki, scale.kd].map(|scale| (factor * scale).abs());
        let allowed = decrease.allowed(claim).into_iter();
        let allowed = allowed.filter(|(gain, _)| scales[*gain] > 0.0);
        let allowed = allowed.map(|(gain, most)| (gain, scales[gain], most.lower())).collect();
        Some(Self { tuner: fspid.tuner(), reaches, allowed })
    }

    /// The largest level within which no limit acts.
    pub(super) fn within_limits(&self) -> Option<f64> {
        let level = self.reaches.iter().map(|reach| reach.within_limits);
        let level = CLAIMED * level.fold(f64::INFINITY, f64::min);
        (level > 0.0 && level.is_finite()).then_some(level)
    }

    /// A large level within which a memoryless law keeps to the rate, and the bounds of error and change
    /// there; within the limits too if that is asked for.
    ///
    /// The higher the level, the wider the inputs and the larger the slopes over them.
    pub(super) fn keeping_to_the_rate(&self, within_limits: bool) -> Option<(f64, [f64; 2])> {
        let limit = if within_limits { self.within_limits()? } else { f64::INFINITY };
        let mut best: Option<(f64, [f64; 2])> = None;
        let mut note = |inputs: [f64; 2], most: f64| -> Option<f64> {
            let slopes = IncrementSlopes::of(self.tuner, inputs).ok()?;
            let level = most.min(self.level_for(&slopes));
            if level > 0.0 && best.is_none_or(|(known, _)| level > known) {
                best = Some((level, inputs));
            }
            Some(level)
        };
        // With the slopes at rest no level is too low.
        let at_rest = IncrementSlopes::of(self.tuner, [0.0; 2]).ok()?;
        let mut high = limit.min(self.level_for(&at_rest));
        if !(high > 0.0 && high.is_finite()) {
            return None;
        }
        let mut low = note(self.inputs_at(high), high)?;
        for _ in 0..HALVINGS {
            let middle = (low * high).sqrt();
            if !(low > 0.0 && low < 0.98 * high) {
                break;
            }
            let found = note(self.inputs_at(middle), middle)?;
            if found < middle {
                high = middle;
            } else {
                low = middle;
            }
        }
        best
    }

    /// Bounds of error and change within a level.
    fn inputs_at(&self, level: f64) -> [f64; 2] {
        [0, 1].map(|input: usize| {
            let reaches = self.reaches.iter().map(|reach| reach.inputs[input]);
            (level * reaches.fold(0.0, f64::max)).sqrt() / CLAIMED
        })
    }

    /// The largest level within which gains with these slopes keep to the rate.
    fn level_for(&self, known: &IncrementSlopes) -> f64 {
        let mut level = f64::INFINITY;
        for &(gain, scale, most) in &self.allowed {
            let most = most / scale - known.off;
            let steepest = known.slopes[gain].map(|slope| [slope.lower(), slope.upper()]);
            for reach in &self.reaches {
                let [error, both, change] = reach.moved;
                let square = |by_error: f64, by_change: f64| {
                    by_error * by_error * error
                        + 2.0 * by_error * by_change * both
                        + by_change * by_change * change
                };
                for by_error in steepest[0] {
                    for by_change in steepest[1] {
                        let square = square(by_error, by_change);
                        if !(most > 0.0) {
                            return 0.0;
                        }
                        if square > 0.0 {
                            level = level.min(most * most / square);
                        }
                    }
                }
            }
        }
        CLAIMED * level
    }
}

/// $r P^{-1} s^T$.
fn product(form: &Matrix, row: &[f64], other: &[f64]) -> Option<f64> {
    let column = Matrix::from_rows(&other.iter().map(|value| [*value]).collect::<Vec<_>>()).ok()?;
    let solved = form.solve(&column).ok()?;
    Some(row.iter().zip(solved.data()).map(|(r, x)| r * x).sum())
}

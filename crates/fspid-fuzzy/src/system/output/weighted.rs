//! Weighted averages and sums of conclusions: Takagi–Sugeno, Tsukamoto, singletons.

use super::super::build::System;
use super::super::defuzzifier::{Defuzzifier, SetReading};
use super::super::parts::{Conclusion, Membership, Output};
use super::super::workspace::Workspace;
use super::joined::scale;

impl System {
    /// $\sum w_i z_i / \sum w_i$ or $\sum w_i z_i$ over the conclusions about an output; nothing if
    /// none fires.
    pub(super) fn weighted(
        &self,
        index: usize,
        output: &Output,
        method: Defuzzifier,
        workspace: &mut Workspace,
    ) -> Option<f64> {
        let (reading, averages) = match method {
            Defuzzifier::WeightedAverage(reading) => (reading, true),
            Defuzzifier::WeightedSum(reading) => (reading, false),
            _ => return None,
        };
        let Workspace { inputs, degrees, scratch, .. } = workspace;
        let conclusions = &self.outputs.get(index)?.conclusions;
        let strongest = conclusions.iter().filter_map(|&own| degrees.get(own)).copied();
        let scale = scale(strongest.fold(0.0, f64::max))?;
        let (mut sum, mut weights) = (0.0_f64, 0.0_f64);
        for &position in conclusions {
            let (resolved, &weight) = (self.conclusions.get(position)?, degrees.get(position)?);
            if weight > 0.0 {
                let conclusion = &output.terms.get(resolved.term)?.conclusion;
                let value = value(conclusion, reading, weight, inputs, &mut scratch.room);
                sum += weight * scale * value;
                weights += weight * scale;
            }
        }
        Some(if averages { sum / weights } else { sum / scale })
    }
}

/// The number that a conclusion stands for at a strength.
pub(crate) fn value(
    conclusion: &Conclusion,
    reading: SetReading,
    strength: f64,
    inputs: &[f64],
    room: &mut [f64],
) -> f64 {
    match conclusion {
        Conclusion::Constant(constant) => *constant,
        Conclusion::Interval([lower, upper]) => 0.5 * lower + 0.5 * upper,
        Conclusion::Linear { coefficients, constant } => {
            coefficients.iter().zip(inputs).fold(*constant, |sum, (c, x)| sum + c * x)
        }
        Conclusion::Formula(formula) => formula.evaluate(inputs),
        Conclusion::Set { membership, .. } => match (reading, membership) {
            (SetReading::InverseTsukamoto, _) => membership.grade(strength, inputs, room),
            (SetReading::Tsukamoto, Membership::Shape { kind, params, height }) => {
                // A set is asked no higher than it reaches.
                let grade = (strength / height).min(1.0);
                kind.inverse(params, grade).unwrap_or(0.0)
            }
            // Refused when the system is built.
            (SetReading::Tsukamoto, Membership::Formula { .. }) => 0.0,
        },
    }
}

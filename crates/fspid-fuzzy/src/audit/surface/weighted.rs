//! Outputs that average or add the conclusions of rules: Takagi–Sugeno, Tsukamoto, singletons.

use alloc::vec::Vec;

use super::firing::{Firing, Slope, unknown_slope};
use super::masses::average_bounds;
use crate::system::{Conclusion, Defuzzifier, Membership, SetReading};
use fspid_numeric::scalar::{Interval, Scalar};

/// Room for the computation.
#[derive(Clone, Debug, Default)]
pub(super) struct Weighted {
    /// What each rule says and how strongly.
    terms: Vec<(Slope, Slope)>,
    masses: Vec<(Interval, Interval)>,
}

impl Weighted {
    /// Bounds of the output's number, its slope, and the least sum of the strengths.
    ///
    /// $$ z = \frac{\sum w_i z_i}{\sum w_i}, \qquad
    ///    z' = \frac{\sum (z_i - z) w_i' + w_i z_i'}{\sum w_i} $$
    pub(super) fn enclose(&mut self, firing: &mut Firing<'_>, index: usize) -> (Slope, f64) {
        let system = firing.system;
        let (Some(output), Some(resolved)) =
            (system.parts.outputs.get(index), system.outputs.get(index))
        else {
            return (unknown_slope(Interval::ENTIRE), 0.0);
        };
        let (reading, averages) = match output.defuzzifier {
            Defuzzifier::WeightedAverage(reading) => (reading, true),
            Defuzzifier::WeightedSum(reading) => (reading, false),
            _ => return (unknown_slope(Interval::ENTIRE), 0.0),
        };
        self.terms.clear();
        for &position in &resolved.conclusions {
            let (Some(conclusion), Some(&weight)) =
                (system.conclusions.get(position), firing.degrees.get(position))
            else {
                continue;
            };
            let term = output.terms.get(conclusion.term);
            if let Some(term) = term.filter(|_| weight.value.upper() > 0.0) {
                let said = firing.said(&term.conclusion, reading, weight);
                self.terms.push((said, weight));
            }
        }
        let sum = self.terms.iter().fold(Interval::ZERO, |sum, (_, weight)| sum + weight.value);
        let added =
            || self.terms.iter().fold(Slope::zero(), |sum, &(said, weight)| sum + said * weight);
        match averages {
            true => (self.average(sum), sum.lower()),
            false => (added(), sum.lower()),
        }
    }

    fn average(&mut self, sum: Interval) -> Slope {
        self.masses.clear();
        self.masses.extend(self.terms.iter().map(|(said, weight)| (said.value, weight.value)));
        let hull = self.masses.iter().map(|(said, _)| *said).reduce(Interval::hull);
        let hull = hull.unwrap_or(Interval::ENTIRE);
        if sum.lower() <= 0.0 {
            return unknown_slope(hull);
        }
        let bounds = average_bounds(&self.masses, sum.lower());
        let average = bounds.intersection(hull).unwrap_or(hull);
        let turn = self.terms.iter().fold(Interval::ZERO, |turn, (said, weight)| {
            let ([said_slope], [weight_slope]) = (said.derivative, weight.derivative);
            turn + (said.value - average) * weight_slope + weight.value * said_slope
        });
        Slope { value: average, derivative: [turn / sum] }
    }
}

impl Firing<'_> {
    /// The number that a conclusion stands for at a strength.
    fn said(&mut self, conclusion: &Conclusion, reading: SetReading, strength: Slope) -> Slope {
        match conclusion {
            Conclusion::Constant(constant) => Slope::constant(*constant),
            // Which number stands for the interval is left open.
            Conclusion::Interval([lower, upper]) => {
                unknown_slope(Interval::between(*lower, *upper))
            }
            Conclusion::Linear { coefficients, constant } => coefficients
                .iter()
                .zip(&self.inputs)
                .fold(Slope::constant(*constant), |sum, (&c, &x)| sum + Slope::constant(c) * x),
            Conclusion::Formula(formula) => {
                let values: Vec<Interval> = self.inputs.iter().map(|it| it.value).collect();
                // Without a value nobody knows what is answered in its place.
                if !formula.has_value(&values) {
                    return unknown_slope(Interval::ENTIRE);
                }
                let value = formula.evaluate(&self.inputs);
                if formula.is_continuous() { value } else { unknown_slope(value.value) }
            }
            Conclusion::Set { lower: Some(_), .. } => unknown_slope(Interval::ENTIRE),
            Conclusion::Set { membership, lower: None } => {
                let said = match (reading, membership) {
                    (SetReading::InverseTsukamoto, Membership::Formula { .. }) => {
                        unknown_slope(Interval::UNIT)
                    }
                    (SetReading::InverseTsukamoto, _) => self.grade_in(membership, strength),
                    (SetReading::Tsukamoto, Membership::Shape { kind, params, height }) => {
                        let grade = (strength / Slope::constant(*height)).smaller(Slope::one());
                        let params: Vec<Slope> =
                            params.iter().map(|&p| Slope::constant(p)).collect();
                        kind.inverse(&params, grade).unwrap_or(Slope::zero())
                    }
                    (SetReading::Tsukamoto, Membership::Formula { .. }) => Slope::zero(),
                };
                // A set may jump, and its inverse may be steeper than anything.
                unknown_slope(said.value)
            }
        }
    }
}

//! How gusts enter a linear plant.

use crate::error::{SimError, finite};

/// Transfer functions from the motion of the air to pitch angle, over the plant's denominator.
///
/// $$ \theta = \frac{N_\delta \delta + N_u u_g + N_w w_g + N_q q_g}{D} $$
///
/// with $u_g$, $w_g$ the air's velocity forward and down, m/s, and $q_g$ its angular velocity,
/// rad/s, in the sense of [`air`](crate::air). The pitch angle's rate cannot jump with a gust, so
/// that each numerator is shorter than the denominator by two coefficients.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct GustEntry {
    /// Monic denominator without its leading 1.
    denominator: Vec<f64>,
    /// For u, w, q: coefficients of $s^{n-1}$ (which are 0) to $s^0$ over the monic denominator.
    numerators: [Vec<f64>; 3],
}

impl GustEntry {
    /// From numerators for u, w and q, highest power first; an empty one for no effect.
    pub(crate) fn new(denominator: &[f64], numerators: [&[f64]; 3]) -> Result<Self, SimError> {
        let Some((&lead, rest)) = denominator.split_first() else {
            return Err(SimError::NotStrictlyProper);
        };
        let monic = |coefficients: &[f64]| -> Result<Vec<f64>, SimError> {
            coefficients.iter().map(|c| finite("gust numerator", c / lead)).collect()
        };
        let padded = |numerator: &[f64]| -> Result<Vec<f64>, SimError> {
            if numerator.len() + 1 > rest.len() && !numerator.is_empty() {
                return Err(SimError::GustMovesRate {
                    found: numerator.len(),
                    most: rest.len().saturating_sub(1),
                });
            }
            let mut padded = vec![0.0; rest.len() - numerator.len()];
            padded.extend(monic(numerator)?);
            Ok(padded)
        };
        let [u, w, q] = numerators;
        let numerators = [padded(u)?, padded(w)?, padded(q)?];
        Ok(Self { denominator: monic(rest)?, numerators })
    }

    /// For u, w, q: coefficients of $s^{n-1}$ to $s^0$ over the denominator with a leading 1.
    pub(crate) fn numerators(&self) -> &[Vec<f64>; 3] {
        &self.numerators
    }

    /// Input columns of u, w, q over the states of the plant, which are pitch angle and its
    /// derivatives: the Markov parameters $h_k = c_k - \sum_{i<k} a_i h_{k-i}$.
    pub(crate) fn columns(&self) -> [Vec<f64>; 3] {
        self.numerators.each_ref().map(|numerator| {
            let mut markov: Vec<f64> = Vec::with_capacity(numerator.len());
            for coefficient in numerator {
                let earlier = markov.iter().rev().zip(&self.denominator);
                let value = earlier.fold(*coefficient, |value, (h, a)| value - a * h);
                markov.push(value);
            }
            markov
        })
    }

    /// The entry a `fraction` of the way from `before` to this one; no entry has no effect.
    pub(crate) fn between(before: Option<&Self>, after: Option<&Self>, share: f64) -> Option<Self> {
        let shape = after.or(before)?;
        let zeros = vec![0.0; shape.denominator.len()];
        let blend = |from: &[f64], to: &[f64]| -> Vec<f64> {
            from.iter().zip(to).map(|(a, b)| a + share * (b - a)).collect()
        };
        let part = |entry: Option<&Self>, input: usize| -> Vec<f64> {
            entry.and_then(|e| e.numerators.get(input)).unwrap_or(&zeros).clone()
        };
        let denominator = |entry: Option<&Self>| entry.unwrap_or(shape).denominator.clone();
        Some(Self {
            denominator: blend(&denominator(before), &denominator(after)),
            numerators: [0, 1, 2].map(|input| blend(&part(before, input), &part(after, input))),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_numerator_that_moves_the_pitch_rate_at_once_is_refused() {
        let denominator = [2.0, 1.0, 3.0];
        let refused = GustEntry::new(&denominator, [&[], &[1.0, 1.0], &[]]);
        assert_eq!(refused, Err(SimError::GustMovesRate { found: 2, most: 1 }));
        assert!(GustEntry::new(&denominator, [&[f64::NAN], &[], &[]]).is_err());
        assert!(GustEntry::new(&[1.0, 1.0], [&[], &[1.0], &[]]).is_err());
    }

    /// 2/(2 s³ + 4 s² + 6 s + 8): 0, 1/(s²)'s coefficient 0, then 1, -2, ... by long division.
    #[test]
    fn columns_are_the_markov_parameters() {
        let entry = GustEntry::new(&[2.0, 4.0, 6.0, 8.0], [&[2.0, 2.0], &[], &[2.0]]);
        let [u, w, q] = entry.expect("allowed").columns();
        assert_eq!((u, w, q), (vec![0.0, 1.0, -1.0], vec![0.0; 3], vec![0.0, 0.0, 1.0]));
    }
}

//! Gain and phase of a polynomial on the imaginary axis as polynomials of the frequency's square.

use crate::complex::modulus;
use crate::error::LtiError;
use crate::polynomial::Polynomial;

/// Coefficients by rising powers of $w = \omega^2$.
type Powers = Vec<f64>;

/// $P(j\omega) = E(w) + j \omega O(w)$: squared gain and slope of the phase.
///
/// $$ |P|^2 = E^2 + w O^2, \quad \frac{d \angle P}{d \omega} = \frac{E (O + 2 w O') - 2 w E' O}{|P|^2} $$
pub(super) struct Parts {
    squared_gain: Powers,
    /// Numerator of the slope.
    turning: Powers,
}

impl Parts {
    pub(super) fn of(polynomial: &Polynomial) -> Self {
        let (even, odd) = (every_other(polynomial, 0), every_other(polynomial, 1));
        let squared_gain = sum(&product(&even, &even), &raised(&product(&odd, &odd)));
        let ahead = product(&even, &sum(&odd, &scaled(&raised(&derivative(&odd)), 2.0)));
        let behind = scaled(&raised(&product(&derivative(&even), &odd)), -2.0);
        Self { squared_gain, turning: sum(&ahead, &behind) }
    }
}

/// Frequencies at which the gain of a quotient has no slope.
pub(super) fn gain_turns(numerator: &Parts, denominator: &Parts) -> Result<Vec<f64>, LtiError> {
    let (over, under) = (&numerator.squared_gain, &denominator.squared_gain);
    let slope = difference(&product(&derivative(over), under), &product(over, &derivative(under)));
    frequencies(slope)
}

/// Frequencies at which the phase of a quotient with a dead time has no slope.
pub(super) fn phase_turns(
    numerator: &Parts,
    denominator: &Parts,
    delay_s: f64,
) -> Result<Vec<f64>, LtiError> {
    let (over, under) = (&numerator.squared_gain, &denominator.squared_gain);
    let leads = product(&numerator.turning, under);
    let lags = sum(&product(&denominator.turning, over), &scaled(&product(over, under), delay_s));
    frequencies(difference(&leads, &lags))
}

/// Square roots of the sizes of all roots: those of the real positive ones and others, which do no harm.
fn frequencies(powers: Powers) -> Result<Vec<f64>, LtiError> {
    let falling: Vec<f64> = powers.into_iter().rev().skip_while(|&value| value == 0.0).collect();
    if falling.len() < 2 {
        return Ok(Vec::new());
    }
    let roots = Polynomial::new(&falling)?.roots()?;
    let mut found: Vec<f64> = roots.into_iter().map(|root| modulus(root).sqrt()).collect();
    found.retain(|&frequency| frequency > 0.0);
    found.sort_by(f64::total_cmp);
    Ok(found)
}

/// Coefficients of even or odd powers, with the signs that powers of j bring.
fn every_other(polynomial: &Polynomial, first: usize) -> Powers {
    let rising = polynomial.coefficients().iter().rev().skip(first).step_by(2);
    rising.enumerate().map(|(k, value)| if k % 2 == 0 { *value } else { -value }).collect()
}

fn product(left: &[f64], right: &[f64]) -> Powers {
    let mut result = vec![0.0; (left.len() + right.len()).saturating_sub(1)];
    for (i, left) in left.iter().enumerate() {
        for (j, right) in right.iter().enumerate() {
            result[i + j] += left * right;
        }
    }
    result
}

fn sum(left: &[f64], right: &[f64]) -> Powers {
    let at = |powers: &[f64], index: usize| powers.get(index).copied().unwrap_or(0.0);
    (0..left.len().max(right.len())).map(|index| at(left, index) + at(right, index)).collect()
}

fn difference(left: &[f64], right: &[f64]) -> Powers {
    sum(left, &scaled(right, -1.0))
}

fn scaled(powers: &[f64], factor: f64) -> Powers {
    powers.iter().map(|value| factor * value).collect()
}

/// Times w.
fn raised(powers: &[f64]) -> Powers {
    core::iter::once(0.0).chain(powers.iter().copied()).collect()
}

fn derivative(powers: &[f64]) -> Powers {
    powers.iter().enumerate().skip(1).map(|(power, value)| power as f64 * value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pair_of_poles_resonates_where_textbooks_say() {
        let unit = Parts::of(&Polynomial::new(&[1.0]).expect("one"));
        let pair = Parts::of(&Polynomial::new(&[1.0, 0.4, 1.0]).expect("a pair"));
        let turns = gain_turns(&unit, &pair).expect("roots");
        // ω² = 1 − 2 ζ² with ζ = 0.2.
        assert!(turns.iter().any(|turn| (turn - 0.92_f64.sqrt()).abs() < 1e-14), "{turns:?}");
        // The phase of a pair only falls: what is found are no real turns.
        let pair_phase = phase_turns(&unit, &pair, 0.0).expect("roots");
        assert!(pair_phase.len() <= 2, "{pair_phase:?}");
    }
}

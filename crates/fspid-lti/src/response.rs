//! The answer of a system to a step, exact at its samples.

use crate::error::LtiError;
use crate::hold::zero_order_hold;
use crate::matrix::Matrix;
use crate::transfer_function::TransferFunction;

/// Output at $0, T, 2T, \dots$ after a unit step at time 0, from rest: `samples` values.
///
/// $$ x_{k+1} = e^{A T} x_k + \int_0^T e^{A \tau} B \ d\tau, \quad y_k = C x_k + D $$
///
/// # Errors
/// A sample period that is not above zero and finite, a system that overflows within it.
pub fn step_response(
    system: &TransferFunction,
    dt_s: f64,
    samples: usize,
) -> Result<Vec<f64>, LtiError> {
    let model = system.to_state_space();
    let (a, b) = zero_order_hold(model.a(), model.b(), dt_s)?;
    let mut state = Matrix::zeros(model.states(), 1);
    let mut output = Vec::with_capacity(samples);
    for _ in 0..samples {
        let shown = model.c().product(&state)?.sum(model.d())?;
        output.extend_from_slice(shown.data());
        state = a.product(&state)?.sum(&b)?;
    }
    Ok(output)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lag_rises_as_an_exponential() {
        let lag = TransferFunction::new(&[2.0], &[1.0, 2.0]).expect("a lag");
        let found = step_response(&lag, 0.25, 5).expect("a response");
        for (index, value) in found.iter().enumerate() {
            let expected = 1.0 - libm::exp(-0.5 * index as f64);
            assert!((value - expected).abs() < 1e-15, "{value} {expected}");
        }
    }

    #[test]
    fn a_gain_answers_at_once() {
        let gain = TransferFunction::new(&[3.0], &[2.0]).expect("a gain");
        assert_eq!(step_response(&gain, 0.1, 3), Ok(vec![1.5; 3]));
        assert!(step_response(&gain, 0.0, 3).is_err());
    }
}

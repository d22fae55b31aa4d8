//! Ordinary differential equations, step by step, without the heap and with the same bits from run to run.
//!
//! [`rk4::step`] for a fixed step, as a flight at a sample rate needs it; [`dormand_prince`] for an error bound, values
//! between steps and [`event`]s. Not for stiff systems.

pub mod dormand_prince;
pub mod event;
pub mod rk4;
mod tableau;

/// Sum of a state and multiples of rates: $x + \sum_i c_i k_i$, added in order.
pub(crate) fn advanced<const N: usize, const K: usize>(
    state: &[f64; N],
    factors: &[f64; K],
    rates: &[[f64; N]; K],
) -> [f64; N] {
    let mut sum = *state;
    for (factor, rate) in factors.iter().zip(rates) {
        for (value, rate) in sum.iter_mut().zip(rate) {
            *value += factor * rate;
        }
    }
    sum
}

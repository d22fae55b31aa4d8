//! The classical method of Runge and Kutta with a fixed step.

use crate::integrate::advanced;

/// State after one step of `dt_s` from `time_s`; its error over a fixed time falls with the fourth power of the step.
///
/// $$ x_{k+1} = x_k + \tfrac{h}{6} (k_1 + 2 k_2 + 2 k_3 + k_4) $$
///
/// # Source
/// E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd edition, table II.1.2.
pub fn step<const N: usize>(
    rate: impl Fn(f64, &[f64; N]) -> [f64; N],
    time_s: f64,
    state: &[f64; N],
    dt_s: f64,
) -> [f64; N] {
    let half_s = 0.5 * dt_s;
    let k1 = rate(time_s, state);
    let k2 = rate(time_s + half_s, &advanced(state, &[half_s], &[k1]));
    let k3 = rate(time_s + half_s, &advanced(state, &[half_s], &[k2]));
    let k4 = rate(time_s + dt_s, &advanced(state, &[dt_s], &[k3]));
    let weights = [dt_s / 6.0, dt_s / 3.0, dt_s / 3.0, dt_s / 6.0];
    advanced(state, &weights, &[k1, k2, k3, k4])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Error at t = 2 of x' = −2 t x², x(0) = 1, whose solution is 1/(1 + t²).
    fn error(steps: u32) -> f64 {
        let dt_s = 2.0 / f64::from(steps);
        let end = (0..steps).fold([1.0], |state, index| {
            let time_s = f64::from(index) * dt_s;
            step(
                |time_s, state: &[f64; 1]| [-2.0 * time_s * state[0] * state[0]],
                time_s,
                &state,
                dt_s,
            )
        });
        (end[0] - 0.2).abs()
    }

    #[test]
    fn half_the_step_leaves_a_sixteenth_of_the_error() {
        for steps in [40, 80, 160] {
            let ratio = error(steps) / error(2 * steps);
            assert!((ratio - 16.0).abs() < 1.0, "{steps} steps: {ratio}");
        }
    }

    #[test]
    fn a_cubic_in_time_is_integrated_without_error() {
        let end = step(|time_s, _: &[f64; 1]| [4.0 * time_s * time_s * time_s], 0.0, &[0.0], 2.0);
        assert!((end[0] - 16.0).abs() < 1e-14);
    }
}

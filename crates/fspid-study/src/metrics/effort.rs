//! Integrals of the error, and the effort of the command.
//!
//! By the rectangle rule over all samples, $\int f \ dt \approx T \sum_k f_k$; the time in the
//! weighted integrals starts anew at each step of the command.

use super::extreme::{extreme, largest_of_both};

/// $\max |r_k - \theta_k|$, rad; NaN is passed over, but no sample of a trace is NaN.
#[must_use]
pub fn largest_error_rad(setpoint_rad: &[f64], theta_rad: &[f64]) -> f64 {
    largest_of_both(setpoint_rad, theta_rad, |setpoint, theta| (setpoint - theta).abs())
}

/// Integrals of the error $e = r - \theta$, as sums over all samples.
///
/// The first and the last sample count in whole, where the trapezoid rule counts half of each. A step of size $a$ has
/// $T a / 2$ more of $\int |e| \ dt$ than by that rule: some per cent of a quick step that is sampled 20 times a second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorIntegrals {
    /// $T \sum |e_k|$, rad s.
    pub iae_rad_s: f64,
    /// $T \sum t_k |e_k|$, rad s².
    pub itae_rad_s2: f64,
    /// $T \sum e_k^2$, rad² s.
    pub ise_rad2_s: f64,
    /// $T \sum t_k e_k^2$, rad² s².
    pub itse_rad2_s2: f64,
}

impl ErrorIntegrals {
    /// Of the errors of samples `dt_s` apart; `restarts` are the samples at which time starts anew.
    #[must_use]
    pub fn of(errors_rad: impl Iterator<Item = f64>, dt_s: f64, restarts: &[usize]) -> Self {
        Self::with_sum_of_squares(errors_rad, dt_s, restarts).0
    }

    /// As [`of`](Self::of), with $\sum e_k^2$, rad².
    pub(super) fn with_sum_of_squares(
        errors_rad: impl Iterator<Item = f64>,
        dt_s: f64,
        restarts: &[usize],
    ) -> (Self, f64) {
        let mut sums = [0.0; 4];
        let mut start = 0;
        let mut restarts = restarts.iter().copied();
        let mut next = restarts.next().unwrap_or(usize::MAX);
        for (k, error) in errors_rad.enumerate() {
            if k >= next {
                start = next;
                next = restarts.next().unwrap_or(usize::MAX);
            }
            let time_s = (k - start) as f64 * dt_s;
            let square = error * error;
            let terms = [error.abs(), time_s * error.abs(), square, time_s * square];
            for (sum, term) in sums.iter_mut().zip(terms) {
                *sum += term;
            }
        }
        let [.., squares, _] = sums;
        let [iae_rad_s, itae_rad_s2, ise_rad2_s, itse_rad2_s2] = sums.map(|sum| sum * dt_s);
        (Self { iae_rad_s, itae_rad_s2, ise_rad2_s, itse_rad2_s2 }, squares)
    }
}

/// What the command costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommandEffort {
    /// $\sum_{k \ge 1} |u_k - u_{k-1}|$, rad; the jump at the first sample does not count.
    pub variation_rad: f64,
    /// $\max |u_k|$, rad.
    pub largest_rad: f64,
    /// $\max |u_k - u_{k-1}| / T$, rad/s.
    pub fastest_rad_s: f64,
}

impl CommandEffort {
    /// Of the commands of samples `dt_s` apart.
    #[must_use]
    pub fn of(commands_rad: &[f64], dt_s: f64) -> Self {
        let change = |before: f64, after: f64| (after - before).abs();
        let after = commands_rad.get(1..).unwrap_or_default();
        Self {
            variation_rad: commands_rad.iter().zip(after).map(|(u, next)| change(*u, *next)).sum(),
            largest_rad: extreme(commands_rad, 0.0, |largest, u| u.abs().max(largest.abs())),
            fastest_rad_s: largest_of_both(commands_rad, after, change) / dt_s,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrals_of_a_decaying_error_tend_to_their_closed_forms() {
        let dt_s = 1e-4;
        let errors = (0..400_000).map(|k| (-f64::from(k) * dt_s).exp());
        let integrals = ErrorIntegrals::of(errors, dt_s, &[0]);
        // The rectangle rule is off by half a sample of the first value.
        assert!((integrals.iae_rad_s - 1.0).abs() < 1e-4, "{integrals:?}");
        assert!((integrals.ise_rad2_s - 0.5).abs() < 1e-4, "{integrals:?}");
        assert!((integrals.itae_rad_s2 - 1.0).abs() < 1e-4, "{integrals:?}");
        assert!((integrals.itse_rad2_s2 - 0.25).abs() < 1e-4, "{integrals:?}");
    }

    #[test]
    fn time_in_the_weighted_integrals_starts_anew_at_each_step() {
        let errors = || [1.0_f64; 8].into_iter();
        let whole = ErrorIntegrals::of(errors(), 1.0, &[0]);
        let halves = ErrorIntegrals::of(errors(), 1.0, &[0, 4]);
        assert_eq!((whole.itae_rad_s2, halves.itae_rad_s2), (28.0, 12.0));
    }

    #[test]
    fn the_jump_of_the_first_command_does_not_count_as_variation() {
        let effort = CommandEffort::of(&[5.0, 5.0, 4.0, 6.0], 0.5);
        assert_eq!(
            (effort.variation_rad, effort.largest_rad, effort.fastest_rad_s),
            (3.0, 6.0, 4.0)
        );
    }
}

//! Integrals of the error, and the effort of the command.
//!
//! By the rectangle rule over all samples, $\int f \, dt \approx T \sum_k f_k$; the time in the
//! weighted integrals starts anew at each step of the command.

/// Integrals of the error $e = r - \theta$.
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
        let mut sums = [0.0; 4];
        let mut start = 0;
        let mut restarts = restarts.iter().copied().peekable();
        for (k, error) in errors_rad.enumerate() {
            if let Some(restart) = restarts.next_if(|&restart| restart <= k) {
                start = restart;
            }
            let time_s = (k - start) as f64 * dt_s;
            let square = error * error;
            let terms = [error.abs(), time_s * error.abs(), square, time_s * square];
            for (sum, term) in sums.iter_mut().zip(terms) {
                *sum += term;
            }
        }
        let [iae_rad_s, itae_rad_s2, ise_rad2_s, itse_rad2_s2] = sums.map(|sum| sum * dt_s);
        Self { iae_rad_s, itae_rad_s2, ise_rad2_s, itse_rad2_s2 }
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
        let changes = || commands_rad.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        Self {
            variation_rad: changes().sum(),
            largest_rad: commands_rad.iter().fold(0.0, |largest, u| u.abs().max(largest)),
            fastest_rad_s: changes().fold(0.0, f64::max) / dt_s,
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

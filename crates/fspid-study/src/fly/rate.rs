//! The pitch rate where a client does not send one.

/// Time constant of the estimate, in sample periods: 1/3 of the noise of a plain difference, and
/// at 0.01 s a lag of 0.02 s, a tenth of a radian where the loop crosses over at 5 rad/s.
const FILTER_PERIODS: f64 = 2.0;

/// The rate of the measurement, filtered as a controller's derivative is:
///
/// $$ \hat q_k = \frac{T_f \hat q_{k-1} + y_k - y_{k-1}}{T_f + T}, \qquad T_f = 2 T $$
///
/// and $\hat q_0 = 0$. It begins again from the last measured rate where one was sent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RateFilter {
    dt_s: f64,
    last: Option<Last>,
}

/// The last sample that was good.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Last {
    measurement_rad: f64,
    rate_rad_s: f64,
}

impl RateFilter {
    /// Before the first sample.
    pub(super) fn new(dt_s: f64) -> Self {
        Self { dt_s, last: None }
    }

    /// True before the first good sample.
    pub(super) fn is_fresh(&self) -> bool {
        self.last.is_none()
    }

    /// Its time constant, s.
    pub(super) fn time_constant_s(&self) -> f64 {
        FILTER_PERIODS * self.dt_s
    }

    /// What the rate would be at this measurement, rad/s.
    pub(super) fn estimate_rad_s(&self, measurement_rad: f64) -> f64 {
        let filter_s = self.time_constant_s();
        self.last.map_or(0.0, |last| {
            let difference_rad = measurement_rad - last.measurement_rad;
            (filter_s * last.rate_rad_s + difference_rad) / (filter_s + self.dt_s)
        })
    }

    /// Remembers a good sample with its rate, measured or estimated.
    pub(super) fn remember(&mut self, measurement_rad: f64, rate_rad_s: f64) {
        self.last = Some(Last { measurement_rad, rate_rad_s });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_steady_rate_is_found_and_what_is_left_of_the_error_shrinks_by_a_third_each_sample() {
        let (dt_s, rate_rad_s) = (0.5, 0.25);
        let mut filter = RateFilter::new(dt_s);
        assert!(filter.is_fresh());
        let mut left = 1.0;
        for k in 0..30 {
            let measurement_rad = f64::from(k) * dt_s * rate_rad_s;
            let estimate = filter.estimate_rad_s(measurement_rad);
            // A geometric series with ratio Tf / (Tf + T) = 2/3, rounded.
            assert!((estimate - rate_rad_s * (1.0 - left)).abs() < 1e-15, "{k}: {estimate}");
            filter.remember(measurement_rad, estimate);
            left *= 2.0 / 3.0;
        }
    }

    #[test]
    fn an_estimate_begins_where_the_measured_rate_ended() {
        let mut filter = RateFilter::new(0.01);
        filter.remember(0.1, 0.3);
        assert!((filter.estimate_rad_s(0.103) - 0.3).abs() < 1e-12);
    }
}

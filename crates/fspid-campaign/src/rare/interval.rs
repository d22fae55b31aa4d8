//! How sure the mean of some independent estimates of a probability is.
//!
//! A product of many shares is nearly log-normal, so that the interval is that of the mean of a log-normal distribution
//! (Cox's method with Student's t):
//!
//! $$ \exp \left( \bar y + \frac{s^2}{2} \pm t_{R-1} \sqrt{\frac{s^2}{R} + \frac{s^4}{2 (R - 1)}} \right) $$
//!
//! with mean $\bar y$ and variance $s^2$ of the logarithms of R estimates. Without the second part of each term it would be
//! the interval of the median, which is below the probability.
//!
//! # Source
//! U. Olsson, "Confidence intervals for the mean of a log-normal distribution", Journal of Statistics Education 13 (2005).

/// The confidence of all intervals here.
pub const CONFIDENCE: f64 = 0.95;

/// Student's t at 0.975 with 9 degrees of freedom (tables; R: `qt(0.975, 9)`).
const T_9: f64 = 2.262_157_162_740_992;

/// A probability with its interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The estimate.
    pub estimate: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Standard deviation of the logarithms of the single estimates.
    pub spread: f64,
}

/// Of ten independent estimates without bias; none where one of them is 0.
pub(super) fn of_teams(estimates: &[f64]) -> Option<Interval> {
    let count = estimates.len() as f64;
    if estimates.len() != super::teams::TEAMS || !estimates.iter().all(|it| *it > 0.0) {
        return None;
    }
    let logs: Vec<f64> = estimates.iter().map(|it| libm::log(*it)).collect();
    let mean = logs.iter().sum::<f64>() / count;
    let variance = logs.iter().map(|log| (log - mean) * (log - mean)).sum::<f64>() / (count - 1.0);
    let error = libm::sqrt(variance / count + variance * variance / (2.0 * (count - 1.0)));
    let at = |sign: f64| libm::exp(mean + variance / 2.0 + sign * T_9 * error).min(1.0);
    let (low, high) = (at(-1.0), at(1.0));
    // The mean of the estimates has no bias; it may lie beside an interval about that of the logarithms.
    let estimate = (estimates.iter().sum::<f64>() / count).clamp(low, high);
    Some(Interval { estimate, low, high, spread: libm::sqrt(variance) })
}

//! Random choices that are the same on every machine.

use fspid_scenario::dispersion::standard_normal;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng as _, SeedableRng as _};

/// Random numbers of one seed and one stream: the same everywhere.
pub(crate) struct Draw(ChaCha8Rng);

impl Draw {
    pub(crate) fn of(seed: u64, stream: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(stream);
        Self(generator)
    }

    /// In 0..`count`; 0 for a count of 0.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        let unit = (self.0.next_u64() >> 11) as f64 / 9_007_199_254_740_992.0;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "not negative, and less than count"
        )]
        let index = (unit * count as f64) as usize;
        index
    }

    /// Normally distributed, mean 0, standard deviation 1.
    pub(crate) fn normal(&mut self) -> f64 {
        standard_normal::quantile(self.inside())
    }

    /// In (0, 1), in the middle of its step: the ends, whose quantiles are infinite, are never met.
    fn inside(&mut self) -> f64 {
        ((self.0.next_u64() >> 12) as f64 + 0.5) / 4_503_599_627_370_496.0
    }

    /// Chi-squared over its degrees of freedom, of which there are two or more: of mean 1.
    ///
    /// # Source
    /// G. Marsaglia, W. W. Tsang, *A simple method for generating gamma variables*, ACM Transactions on Mathematical Software
    /// 26 (2000) 363.
    pub(crate) fn chi_squared_share(&mut self, freedom: f64) -> f64 {
        // Symbols as in the source: a gamma variable of shape a is d v.
        let d = freedom / 2.0 - 1.0 / 3.0;
        let c = 1.0 / libm::sqrt(9.0 * d);
        loop {
            let x = self.normal();
            let v = 1.0 + c * x;
            let v = v * v * v;
            let u = self.inside();
            if v > 0.0 && libm::log(u) < 0.5 * x * x + d - d * v + d * libm::log(v) {
                return 2.0 * d * v / freedom;
            }
        }
    }

    /// Places in an order in which each is as likely as any other (Fisher and Yates).
    pub(crate) fn order(&mut self, count: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..count).collect();
        for last in (1..count).rev() {
            order.swap(last, self.below(last + 1));
        }
        order
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drawn_numbers_have_the_means_and_scatter_of_their_distributions() {
        let mut random = Draw::of(1, 0);
        let mut moments = |mut one: Box<dyn FnMut(&mut Draw) -> f64>| {
            let values: Vec<f64> = (0..20_000).map(|_| one(&mut random)).collect();
            let mean = values.iter().sum::<f64>() / 2e4;
            (mean, values.iter().map(|it| (it - mean) * (it - mean)).sum::<f64>() / 2e4)
        };
        // Four standard errors: 0.028 of a mean of variance 1, 0.04 of that variance; chi-squared over ν has the variance
        // 2 / ν, itself with an error of about 0.05 (ν = 2, kurtosis 9) at the most.
        let (mean, variance) = moments(Box::new(Draw::normal));
        assert!(mean.abs() < 0.03 && (variance - 1.0).abs() < 0.04, "{mean} {variance}");
        for freedom in [2.0, 3.7, 20.0] {
            let (mean, variance) = moments(Box::new(move |it| it.chi_squared_share(freedom)));
            let expected = 2.0 / freedom;
            assert!((mean - 1.0).abs() < 0.03, "{freedom}: {mean}");
            assert!((variance / expected - 1.0).abs() < 0.1, "{freedom}: {variance}");
        }
    }
}

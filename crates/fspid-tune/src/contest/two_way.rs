//! How sure a difference is where flights share their case or their design.

use super::student;

/// A difference with what is known of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoWay {
    /// The mean difference of the logarithms: the logarithm of the mean ratio.
    pub estimate: f64,
    /// Its standard error; `None` for fewer than three cases.
    pub error: Option<f64>,
    /// Degrees of freedom of the error.
    pub freedom: f64,
}

/// Fewest cases from which an error is told.
const FEWEST: usize = 3;

impl TwoWay {
    /// Of the logarithms of what two controllers came to, `[design][case]`, with the same cases in the same order.
    ///
    /// Cases are common to all designs, and designs to all cases: flights of one case or of one design are not
    /// independent. The error therefore has a part for each, as if both were drawn from many:
    ///
    /// $$ v = \frac{s_c^2}{K} + \frac{s_1^2}{S_1} + \frac{s_2^2}{S_2}, \quad
    /// \nu = v^2 \Big/ \left(\frac{(s_c^2 / K)^2}{K - 1} + \sum_i \frac{(s_i^2 / S_i)^2}{S_i - 1}\right) $$
    ///
    /// with the variance $s_c^2$ over the K cases of the differences that are averaged over designs, and the
    /// variances $s_i^2$ over the designs of a controller of its values that are averaged over cases. A controller
    /// that was not tuned has one design and no such part. What is peculiar to a flight is in every part, so that
    /// the error is somewhat too large rather than too small: intervals at 95 % held the true ratio in 93.9 to 96.1 % of
    /// 4000 simulated contests of 6 to 30 cases and 1 to 10 designs where cases or designs scatter, and in 96.2 to 99.4 %
    /// where single flights alone do (`oracles/make_contest.py --simulate`).
    ///
    /// # Source
    /// Crossed random effects: S. R. Searle, G. Casella, C. E. McCulloch, *Variance Components* (1992), 4.2; A. B.
    /// Owen, *The pigeonhole bootstrap*, Annals of Applied Statistics 1 (2007), on counting the flight's own part in
    /// every term. Degrees of freedom: F. E. Satterthwaite, *An approximate distribution of estimates of variance
    /// components*, Biometrics Bulletin 2 (1946).
    #[must_use]
    pub fn of(mine: &[Vec<f64>], theirs: &[Vec<f64>]) -> Option<Self> {
        let count = mine.first()?.len();
        let of_cases = |designs: &[Vec<f64>]| -> Vec<f64> {
            (0..count).map(|case| mean(designs.iter().map(|it| it[case]))).collect()
        };
        let differences: Vec<f64> =
            of_cases(mine).iter().zip(of_cases(theirs)).map(|(a, b)| a - b).collect();
        let estimate = mean(differences.iter().copied());
        if !estimate.is_finite() {
            return None;
        }
        if count < FEWEST {
            return Some(Self { estimate, error: None, freedom: 0.0 });
        }
        let of_designs = |designs: &[Vec<f64>]| -> Vec<f64> {
            designs.iter().map(|it| mean(it.iter().copied())).collect()
        };
        let parts = [differences, of_designs(mine), of_designs(theirs)];
        Some(Self::of_parts(estimate, parts.iter().map(Vec::as_slice)))
    }

    /// Of an estimate to which several draws contribute, each by the mean of its values: the error and the degrees of
    /// freedom of [`TwoWay::of`]. A part of one value is known, and adds nothing.
    pub(crate) fn of_parts<'a>(
        estimate: f64,
        parts: impl Iterator<Item = &'a [f64]> + Clone,
    ) -> Self {
        let (mut whole, mut weighted) = (0.0, 0.0);
        for part in parts.clone().filter(|part| part.len() > 1) {
            let share = variance(part) / part.len() as f64;
            whole += share;
            weighted += share * share / (part.len() - 1) as f64;
        }
        // Where nothing scatters, the first part, the cases, says how often that was seen.
        let count = parts.map(<[f64]>::len).next().unwrap_or(0);
        let freedom =
            if weighted > 0.0 { whole * whole / weighted } else { count.saturating_sub(1) as f64 };
        Self { estimate, error: Some(whole.sqrt()), freedom }
    }

    /// Two-sided p-value of "no difference"; 1 where nothing is known of the error.
    #[must_use]
    pub fn p(&self) -> f64 {
        match self.error {
            None => 1.0,
            _ if self.estimate == 0.0 => 1.0,
            Some(error) if error > 0.0 => student::two_sided(self.estimate / error, self.freedom),
            Some(_) => 0.0,
        }
    }

    /// Ends of its interval; `None` where nothing is known of the error.
    #[must_use]
    pub fn interval(&self, confidence: f64) -> Option<[f64; 2]> {
        let error = self.error?;
        let reach = match error > 0.0 {
            true => error * student::beyond(1.0 - confidence, self.freedom),
            false => 0.0,
        };
        Some([self.estimate - reach, self.estimate + reach])
    }
}

/// P-values for several comparisons at once: the chance that any of them is called different is kept.
///
/// # Source
/// S. Holm, *A simple sequentially rejective multiple test procedure*, Scandinavian Journal of Statistics 6 (1979).
#[must_use]
pub fn holm(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut adjusted = vec![1.0; values.len()];
    let mut least: f64 = 0.0;
    for (rank, index) in order.into_iter().enumerate() {
        least = least.max((values.len() - rank) as f64 * values[index]).min(1.0);
        adjusted[index] = least;
    }
    adjusted
}

pub(crate) fn mean(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count().max(1);
    values.sum::<f64>() / count as f64
}

fn variance(values: &[f64]) -> f64 {
    let middle = mean(values.iter().copied());
    let squares: f64 = values.iter().map(|value| (value - middle) * (value - middle)).sum();
    squares / (values.len().max(2) - 1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holm_keeps_the_order_and_never_exceeds_one() {
        // Holm (1979), by hand: 4 x 0.01, 3 x 0.02, 2 x 0.03 and 0.04, none below the one before.
        let found = holm(&[0.04, 0.01, 0.03, 0.02]);
        let expected = [0.06, 0.04, 0.06, 0.06];
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?}");
        assert_eq!(holm(&[0.9, 0.8]), [1.0, 1.0]);
        assert!(holm(&[]).is_empty());
    }

    #[test]
    fn designs_that_scatter_are_less_sure_than_designs_that_agree() {
        let agreeing = vec![vec![1.0, 2.0, 3.0, 4.1]; 5];
        let theirs = vec![vec![0.9, 1.8, 2.9, 4.0]; 5];
        let shifted = [-0.2, 0.1, 0.0, 0.2, -0.1];
        let scattering: Vec<Vec<f64>> = agreeing
            .iter()
            .zip(shifted)
            .map(|(it, by)| it.iter().map(|value| value + by).collect())
            .collect();
        let sure = TwoWay::of(&agreeing, &theirs).expect("a difference");
        let unsure = TwoWay::of(&scattering, &theirs).expect("a difference");
        assert!((sure.estimate - unsure.estimate).abs() < 1e-12);
        assert!(sure.p() < 0.05 && unsure.p() > 0.05, "{} {}", sure.p(), unsure.p());
    }

    #[test]
    fn designs_that_differ_nowhere_and_designs_that_differ_everywhere_alike() {
        let mine = vec![vec![1.0, 2.0, 3.0, 4.0]; 2];
        let alike = TwoWay::of(&mine, &mine).expect("a difference");
        assert_eq!((alike.p(), alike.freedom, alike.error), (1.0, 3.0, Some(0.0)));
        assert_eq!(alike.interval(0.95), Some([0.0, 0.0]));
        let apart = TwoWay { estimate: 0.5, ..alike };
        assert_eq!((apart.p(), apart.interval(0.95)), (0.0, Some([0.5, 0.5])));
    }
}

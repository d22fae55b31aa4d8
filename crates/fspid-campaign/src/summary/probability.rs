//! Probabilities behind counts.

use super::data::Probability;
use crate::statistics::{StatisticsError, binomial};

impl Probability {
    /// Of something seen in `count` of so many runs.
    ///
    /// # Errors
    /// The confidence is not inside (0, 1), or `count` is above `of`.
    pub fn of(count: u64, of: u64, confidence: f64) -> Result<Self, StatisticsError> {
        let at_most = binomial::upper_bound(count, of, confidence)?;
        let at_least = binomial::lower_bound(count, of, confidence)?;
        let [lower, upper] = binomial::clopper_pearson(count, of, confidence)?;
        Ok(Self {
            count,
            of,
            estimate: (of > 0).then(|| count as f64 / of as f64),
            lower,
            upper,
            at_most: (of > 0 && count == 0).then_some(at_most),
            at_least: (of > 0 && count == of).then_some(at_least),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_sided_bounds_are_stated_where_all_or_none_were_seen() {
        let none = Probability::of(0, 300, 0.95).expect("counts");
        assert!(
            (none.at_most.expect("a bound") - (1.0 - libm::pow(0.05, 1.0 / 300.0))).abs() < 1e-15
        );
        assert_eq!((none.at_least, none.estimate), (None, Some(0.0)));
        let all = Probability::of(300, 300, 0.95).expect("counts");
        assert!((all.at_least.expect("a bound") - libm::pow(0.05, 1.0 / 300.0)).abs() < 1e-15);
        assert_eq!(all.at_most, None);
        let some = Probability::of(1, 2, 0.95).expect("counts");
        assert_eq!((some.at_most, some.at_least), (None, None));
    }

    #[test]
    fn without_runs_there_is_no_estimate() {
        let nothing = Probability::of(0, 0, 0.95).expect("counts");
        assert_eq!((nothing.estimate, nothing.at_most, nothing.at_least), (None, None, None));
        assert_eq!([nothing.lower, nothing.upper], [0.0, 1.0]);
        assert!(Probability::of(1, 2, 1.0).is_err());
    }
}

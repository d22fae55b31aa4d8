//! A sum that keeps what rounding would lose.

/// Compensated sum: its error does not grow with the number of terms, as long as they do not overflow.
///
/// # Source
/// A. Neumaier, *Rundungsfehleranalyse einiger Verfahren zur Summation endlicher Summen*, ZAMM 54 (1974), algorithm IV.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sum {
    rounded: f64,
    lost: f64,
}

impl Sum {
    /// Adds a term.
    pub(super) fn add(&mut self, term: f64) {
        let next = self.rounded + term;
        self.lost += if self.rounded.abs() >= term.abs() {
            (self.rounded - next) + term
        } else {
            (term - next) + self.rounded
        };
        self.rounded = next;
    }

    /// The sum so far; NaN if it overflowed.
    pub(super) fn value(self) -> f64 {
        self.rounded + self.lost
    }
}

impl FromIterator<f64> for Sum {
    fn from_iter<I: IntoIterator<Item = f64>>(terms: I) -> Self {
        let mut sum = Self::default();
        for term in terms {
            sum.add(term);
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::Sum;

    #[test]
    fn small_terms_beside_a_large_one_are_not_lost() {
        let terms = [1.0, 1e100, 1.0, -1e100];
        assert_eq!(Sum::from_iter(terms).value(), 2.0);
    }

    #[test]
    fn an_overflow_gives_nan_and_not_a_number_that_looks_right() {
        assert!(Sum::from_iter([f64::MAX, f64::MAX]).value().is_nan());
    }
}

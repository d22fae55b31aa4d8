//! The noise of a seed, and noises that are mixed of several.
//!
//! $$ n_k = \sum_i w_i n_k^{(i)}, \qquad \sum_i w_i^2 = 1 $$
//!
//! is a standard normal number for each k, independent of the others, as the noise of each seed is. So air can be moved a
//! little and stays air: that is what a search for rare failures does.

use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

use super::noise::standard_normal;

/// Where the random numbers of turbulence come from.
#[derive(Clone, Debug, PartialEq)]
pub enum Noise {
    /// A seed.
    Seed(u64),
    /// Seeds with weights whose squares sum to 1.
    Mixed(Arc<[(u64, f64)]>),
}

/// Most seeds of a mixture: each is drawn for every number.
const MOST_TERMS: usize = 1024;
/// How far the sum of the squares may be from 1: weights may be written with seven digits.
const SQUARES_TOL: f64 = 1e-6;

/// Why seeds and weights are no mixture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoMixture {
    reason: String,
}

impl fmt::Display for NoMixture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}; allowed are 1 to {MOST_TERMS} seeds with weights whose squares sum to 1, such as 7*0.8 + 9*0.6",
            self.reason
        )
    }
}

impl std::error::Error for NoMixture {}

impl From<u64> for Noise {
    fn from(seed: u64) -> Self {
        Self::Seed(seed)
    }
}

impl Noise {
    /// The mixture of seeds with weights.
    ///
    /// # Errors
    /// [`NoMixture`] for no seeds or too many, and for weights whose squares do not sum to 1.
    pub fn mixed(terms: &[(u64, f64)]) -> Result<Self, NoMixture> {
        let refused = |reason: String| Err(NoMixture { reason });
        if !(1..=MOST_TERMS).contains(&terms.len()) {
            return refused(format!("there are {} seeds", terms.len()));
        }
        let squares: f64 = terms.iter().map(|(_, weight)| weight * weight).sum();
        // NaN is no sum.
        if !((squares - 1.0).abs() <= SQUARES_TOL) {
            return refused(format!("the squares of the weights sum to {squares}"));
        }
        match *terms {
            [(seed, 1.0)] => Ok(Self::Seed(seed)),
            _ => Ok(Self::Mixed(terms.into())),
        }
    }

    /// The standard normal number of a sample of a stream.
    pub(crate) fn normal(&self, stream: u64, k: usize) -> f64 {
        match self {
            Self::Seed(seed) => standard_normal(*seed, stream, k),
            Self::Mixed(terms) => {
                let term = |&(seed, weight): &(u64, f64)| weight * standard_normal(seed, stream, k);
                terms.iter().map(term).sum()
            }
        }
    }
}

/// `7*0.8 + 9*0.6`, every digit of the weights.
impl fmt::Display for Noise {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Seed(seed) => write!(f, "{seed}*1"),
            Self::Mixed(terms) => {
                let words = terms.iter().map(|(seed, weight)| format!("{seed}*{weight:?}"));
                f.write_str(&words.collect::<Vec<_>>().join(" + "))
            }
        }
    }
}

/// As it is displayed; blanks may be left out.
impl FromStr for Noise {
    type Err = NoMixture;

    fn from_str(text: &str) -> Result<Self, NoMixture> {
        let term = |part: &str| {
            let found = part.split_once('*').and_then(|(seed, weight)| {
                Some((seed.trim().parse().ok()?, weight.trim().parse().ok()?))
            });
            found
                .ok_or_else(|| NoMixture { reason: format!("`{}` is no seed*weight", part.trim()) })
        };
        let terms: Vec<(u64, f64)> = text.split('+').map(term).collect::<Result<_, _>>()?;
        Self::mixed(&terms)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mixture_of_one_seed_is_the_noise_of_the_seed() {
        let one: Noise = "7*1".parse().expect("a mixture");
        assert_eq!(one, Noise::Seed(7));
        assert_eq!(one.normal(3, 5).to_bits(), standard_normal(7, 3, 5).to_bits());
    }

    #[test]
    fn a_mixture_is_read_back_as_it_was_written() {
        let weight = (1.0_f64 / 3.0).sqrt();
        let mixed =
            Noise::mixed(&[(1, weight), (u64::MAX, -weight), (3, weight)]).expect("allowed");
        assert_eq!(mixed.to_string().parse(), Ok(mixed.clone()));
        assert!(matches!(mixed, Noise::Mixed(_)));
    }

    #[test]
    fn a_mixture_has_the_moments_of_the_normal_distribution_and_leans_on_its_seeds() {
        let mixed: Noise = "7*0.8 + 9*0.6".parse().expect("allowed");
        let n = 100_000;
        let mean = |of: &dyn Fn(usize) -> f64| (0..n).map(of).sum::<f64>() / n as f64;
        let at = |k: usize| mixed.normal(0, k);
        // Four standard errors: 1/sqrt(n), sqrt(2/n), and of the product sqrt((1 + 0.64)/n).
        assert!(mean(&at).abs() < 0.0127);
        assert!((mean(&|k| at(k) * at(k)) - 1.0).abs() < 0.0179);
        assert!((mean(&|k| at(k) * standard_normal(7, 0, k)) - 0.8).abs() < 0.0163);
        assert!(mean(&|k| at(k) * at(k + 1)).abs() < 0.0127);
    }

    #[test]
    fn what_is_no_mixture_is_refused_with_what_is_allowed() {
        for text in ["", "7", "7*", "*1", "7*0.5", "7*nan", "-1*1", "7*0.8 +", "7*inf", "7*1 + 8*1"]
        {
            let refused = text.parse::<Noise>().expect_err(text).to_string();
            assert!(refused.contains("allowed are 1 to 1024 seeds"), "{refused}");
        }
    }
}

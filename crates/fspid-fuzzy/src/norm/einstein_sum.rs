//! Einstein sum.

use super::SNorm;
use fspid_numeric::scalar::Scalar;

/// $a \oplus b = \frac{a + b}{1 + ab}$
///
/// # Source
/// fuzzylite's `EinsteinSum`.
#[derive(Clone, Copy, Debug)]
pub enum EinsteinSum {}

impl SNorm for EinsteinSum {
    const NAME: &'static str = "einstein-sum";

    #[inline]
    fn apply<S: Scalar>(a: S, b: S) -> S {
        let sum = (a + b) / (S::one() + a * b);
        sum.larger(a.larger(b)).smaller(S::one())
    }
}

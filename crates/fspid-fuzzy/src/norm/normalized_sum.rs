//! Normalized sum.

use super::SNorm;
use fspid_numeric::scalar::Scalar;

/// $a \oplus b = \frac{a + b}{\max(1, a + b)}$
///
/// Of two numbers it is the bounded sum. What IEC 61131-7 calls `NSUM` divides a whole set by the
/// largest sum in it, which no function of two numbers can say.
///
/// # Source
/// fuzzylite's `NormalizedSum`.
#[derive(Clone, Copy, Debug)]
pub enum NormalizedSum {}

impl SNorm for NormalizedSum {
    const NAME: &'static str = "normalized-sum";

    #[inline]
    fn apply<S: Scalar>(a: S, b: S) -> S {
        let sum = a + b;
        (sum / sum.larger(S::one())).smaller(S::one())
    }
}

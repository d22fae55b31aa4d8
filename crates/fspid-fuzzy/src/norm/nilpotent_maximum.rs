//! Nilpotent maximum.

use super::SNorm;
use fspid_numeric::scalar::Scalar;

/// $a \oplus b = \max(a, b)$ if $a + b < 1$, else 1
///
/// Asked as $\min < 1 - \max$, so that $a \oplus 0 = a$ for the largest grade.
///
/// # Source
/// Fodor, 1995; fuzzylite's `NilpotentMaximum`.
#[derive(Clone, Copy, Debug)]
pub enum NilpotentMaximum {}

impl SNorm for NilpotentMaximum {
    const NAME: &'static str = "nilpotent-maximum";

    #[inline]
    fn apply<S: Scalar>(a: S, b: S) -> S {
        let (lower, upper) = (a.smaller(b), a.larger(b));
        lower.if_less(S::one() - upper, upper, S::one())
    }
}

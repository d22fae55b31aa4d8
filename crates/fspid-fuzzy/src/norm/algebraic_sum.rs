//! Algebraic sum.

use super::SNorm;
use fspid_numeric::scalar::Scalar;

/// $a \oplus b = a + b - ab$
///
/// MATLAB's `probor`. Computed as $\max + \min (1 - \max)$, so that $a \oplus 0 = a$ to the last bit.
///
/// # Source
/// Zadeh, 1965.
#[derive(Clone, Copy, Debug)]
pub enum AlgebraicSum {}

impl SNorm for AlgebraicSum {
    const NAME: &'static str = "algebraic-sum";

    #[inline]
    fn apply<S: Scalar>(a: S, b: S) -> S {
        let (lower, upper) = (a.smaller(b), a.larger(b));
        (upper + lower * (S::one() - upper)).smaller(S::one())
    }
}

//! Nilpotent minimum.

use super::{SNormKind, TNorm};
use fspid_numeric::scalar::Scalar;

/// $a \otimes b = \min(a, b)$ if $a + b > 1$, else 0
///
/// Asked as $1 - \max < \min$, so that $a \otimes 1 = a$ for the smallest grade.
///
/// # Source
/// Fodor, 1995; fuzzylite's `NilpotentMinimum`.
#[derive(Clone, Copy, Debug)]
pub enum NilpotentMinimum {}

impl TNorm for NilpotentMinimum {
    const NAME: &'static str = "nilpotent-minimum";
    const DUAL: SNormKind = SNormKind::NilpotentMaximum;

    #[inline]
    fn apply<S: Scalar>(a: S, b: S) -> S {
        let (lower, upper) = (a.smaller(b), a.larger(b));
        (S::one() - upper).if_less(lower, lower, S::zero())
    }
}

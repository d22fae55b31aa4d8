//! Bounded difference.

use super::{SNormKind, TNorm};
use fspid_numeric::scalar::Scalar;

/// $a \otimes b = \max(0, a + b - 1)$
///
/// Łukasiewicz's t-norm. Computed as $\min - (1 - \max)$, so that $a \otimes 1 = a$ to the last bit.
///
/// # Source
/// IEC 61131-7, `BDIF`.
#[derive(Clone, Copy, Debug)]
pub enum BoundedDifference {}

impl TNorm for BoundedDifference {
    const NAME: &'static str = "bounded-difference";
    const DUAL: SNormKind = SNormKind::BoundedSum;

    #[inline]
    fn apply<S: Scalar>(a: S, b: S) -> S {
        let (lower, upper) = (a.smaller(b), a.larger(b));
        (lower - (S::one() - upper)).larger(S::zero())
    }
}

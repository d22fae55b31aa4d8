//! Bounded sum.

use super::SNorm;
use fspid_numeric::scalar::Scalar;

/// $a \oplus b = \min(1, a + b)$
///
/// Łukasiewicz's s-norm.
///
/// # Source
/// IEC 61131-7, `BSUM`.
#[derive(Clone, Copy, Debug)]
pub enum BoundedSum {}

impl SNorm for BoundedSum {
    const NAME: &'static str = "bounded-sum";

    #[inline]
    fn apply<S: Scalar>(a: S, b: S) -> S {
        (a + b).smaller(S::one())
    }
}

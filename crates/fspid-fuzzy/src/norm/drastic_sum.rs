//! Drastic sum.

use super::SNorm;
use fspid_numeric::scalar::Scalar;

/// $a \oplus b = \max(a, b)$ if $\min(a, b) = 0$, else 1
///
/// The largest s-norm of all.
///
/// # Source
/// fuzzylite's `DrasticSum`.
#[derive(Clone, Copy, Debug)]
pub enum DrasticSum {}

impl SNorm for DrasticSum {
    const NAME: &'static str = "drastic-sum";

    #[inline]
    fn apply<S: Scalar>(a: S, b: S) -> S {
        S::zero().if_less(a.smaller(b), S::one(), a.larger(b))
    }
}

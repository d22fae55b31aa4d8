//! Hamacher sum.

use super::{SNorm, not_zero};
use fspid_numeric::scalar::Scalar;

/// $a \oplus b = \frac{a + b - 2ab}{1 - ab}$, and $1 \oplus 1 = 1$
///
/// Computed as $\max + \min (1 - \max) \frac{1 - \max}{1 - \min\max}$, which does not cancel.
///
/// # Source
/// fuzzylite's `HamacherSum`.
#[derive(Clone, Copy, Debug)]
pub enum HamacherSum {}

impl SNorm for HamacherSum {
    const NAME: &'static str = "hamacher-sum";

    #[inline]
    fn apply<S: Scalar>(a: S, b: S) -> S {
        let (lower, upper) = (a.smaller(b), a.larger(b));
        let rest = S::one() - upper;
        let share = rest / not_zero(S::one() - lower * upper);
        (upper + lower * rest * share).smaller(S::one())
    }
}

//! Hamacher product.

use super::{SNormKind, TNorm, not_zero};
use fspid_numeric::scalar::Scalar;

/// $a \otimes b = \frac{ab}{a + b - ab}$, and $0 \otimes 0 = 0$
///
/// Computed as $\min \cdot \frac{\max}{\max + \min (1 - \max)}$, which neither cancels nor underflows.
///
/// # Source
/// fuzzylite's `HamacherProduct`.
#[derive(Clone, Copy, Debug)]
pub enum HamacherProduct {}

impl TNorm for HamacherProduct {
    const NAME: &'static str = "hamacher-product";
    const DUAL: SNormKind = SNormKind::HamacherSum;

    #[inline]
    fn apply<S: Scalar>(a: S, b: S) -> S {
        let (lower, upper) = (a.smaller(b), a.larger(b));
        let sum = upper + lower * (S::one() - upper);
        (lower * (upper / not_zero(sum))).smaller(lower)
    }
}

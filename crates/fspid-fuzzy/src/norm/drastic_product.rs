//! Drastic product.

use super::{SNormKind, TNorm};
use fspid_numeric::scalar::Scalar;

/// $a \otimes b = \min(a, b)$ if $\max(a, b) = 1$, else 0
///
/// The smallest t-norm of all.
///
/// # Source
/// fuzzylite's `DrasticProduct`.
#[derive(Clone, Copy, Debug)]
pub enum DrasticProduct {}

impl TNorm for DrasticProduct {
    const NAME: &'static str = "drastic-product";
    const DUAL: SNormKind = SNormKind::DrasticSum;

    #[inline]
    fn apply<S: Scalar>(a: S, b: S) -> S {
        a.larger(b).if_less(S::one(), S::zero(), a.smaller(b))
    }
}

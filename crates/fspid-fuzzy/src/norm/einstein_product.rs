//! Einstein product.

use super::{SNormKind, TNorm};
use fspid_numeric::scalar::Scalar;

/// $a \otimes b = \frac{ab}{2 - (a + b - ab)}$
///
/// The denominator is written $1 + (1 - a)(1 - b)$, which is the same.
///
/// # Source
/// fuzzylite's `EinsteinProduct`.
#[derive(Clone, Copy, Debug)]
pub enum EinsteinProduct {}

impl TNorm for EinsteinProduct {
    const NAME: &'static str = "einstein-product";
    const DUAL: SNormKind = SNormKind::EinsteinSum;

    #[inline]
    fn apply<S: Scalar>(a: S, b: S) -> S {
        let product = a * b / (S::one() + (S::one() - a) * (S::one() - b));
        product.smaller(a.smaller(b))
    }
}

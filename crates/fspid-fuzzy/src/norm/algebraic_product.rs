//! Algebraic product.

use super::{SNormKind, TNorm};
use fspid_numeric::scalar::Scalar;

/// $a \otimes b = ab$
///
/// # Source
/// Zadeh, 1965.
#[derive(Clone, Copy, Debug)]
pub enum AlgebraicProduct {}

impl TNorm for AlgebraicProduct {
    const NAME: &'static str = "algebraic-product";
    const DUAL: SNormKind = SNormKind::AlgebraicSum;

    #[inline]
    fn apply<S: Scalar>(a: S, b: S) -> S {
        a * b
    }
}

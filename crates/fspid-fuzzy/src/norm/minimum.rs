//! Minimum.

use super::{SNormKind, TNorm};
use fspid_numeric::scalar::Scalar;

/// $a \otimes b = \min(a, b)$
///
/// The largest t-norm of all.
///
/// # Source
/// Zadeh, *Fuzzy Sets*, 1965.
#[derive(Clone, Copy, Debug)]
pub enum Minimum {}

impl TNorm for Minimum {
    const NAME: &'static str = "minimum";
    const DUAL: SNormKind = SNormKind::Maximum;

    #[inline]
    fn apply<S: Scalar>(a: S, b: S) -> S {
        a.smaller(b)
    }
}

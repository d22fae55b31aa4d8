//! Maximum.

use super::SNorm;
use fspid_numeric::scalar::Scalar;

/// $a \oplus b = \max(a, b)$
///
/// The smallest s-norm of all.
///
/// # Source
/// Zadeh, *Fuzzy Sets*, 1965.
#[derive(Clone, Copy, Debug)]
pub enum Maximum {}

impl SNorm for Maximum {
    const NAME: &'static str = "maximum";

    #[inline]
    fn apply<S: Scalar>(a: S, b: S) -> S {
        a.larger(b)
    }
}

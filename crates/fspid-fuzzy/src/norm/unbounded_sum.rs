//! Unbounded sum.

use super::SNorm;
use fspid_numeric::scalar::Scalar;

/// $a \oplus b = a + b$
///
/// Not an s-norm: it leaves [0, 1]. For aggregations that add areas.
///
/// # Source
/// fuzzylite's `UnboundedSum`, MATLAB's `sum`.
#[derive(Clone, Copy, Debug)]
pub enum UnboundedSum {}

impl SNorm for UnboundedSum {
    const NAME: &'static str = "unbounded-sum";

    #[inline]
    fn apply<S: Scalar>(a: S, b: S) -> S {
        a + b
    }
}

//! Numbers that a model can be computed with.

use fspid_numeric::scalar::{Dual, Scalar};

/// A number with a plain value, by which cases are chosen and tables are searched.
///
/// With `f64` a model answers values; with [`Dual`] also their exact derivatives with respect to the inputs. At a kink (a
/// breakpoint, a limit, the border of a case) the derivative is that of the side that gives the value.
pub trait Number: Scalar {
    /// The value without derivatives.
    fn value(self) -> f64;
}

impl Number for f64 {
    #[inline]
    fn value(self) -> f64 {
        self
    }
}

impl<const N: usize> Number for Dual<f64, N> {
    #[inline]
    fn value(self) -> f64 {
        self.value
    }
}

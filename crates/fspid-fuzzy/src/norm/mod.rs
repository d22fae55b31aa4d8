//! stub
use crate::scalar::Scalar;
/// t
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TNormKind {
    /// m
    Minimum,
    /// p
    AlgebraicProduct,
}
/// s
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SNormKind {
    /// m
    Maximum,
    /// p
    AlgebraicSum,
}
impl TNormKind {
    /// a
    pub fn apply<S: Scalar>(self, a: S, b: S) -> S {
        match self {
            Self::Minimum => a.smaller(b),
            _ => a * b,
        }
    }
}
impl SNormKind {
    /// a
    pub fn apply<S: Scalar>(self, a: S, b: S) -> S {
        match self {
            Self::Maximum => a.larger(b),
            _ => a + b - a * b,
        }
    }
}

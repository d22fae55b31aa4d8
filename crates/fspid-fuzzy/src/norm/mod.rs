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

impl TNormKind {
    /// all
    pub const ALL: &[Self] = &[Self::Minimum, Self::AlgebraicProduct];
    /// n
    pub const fn name(self) -> &'static str {
        match self {
            Self::Minimum => "minimum",
            Self::AlgebraicProduct => "algebraic-product",
        }
    }
    /// f
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|k| k.name() == name)
    }
}
impl SNormKind {
    /// all
    pub const ALL: &[Self] = &[Self::Maximum, Self::AlgebraicSum];
    /// n
    pub const fn name(self) -> &'static str {
        match self {
            Self::Maximum => "maximum",
            Self::AlgebraicSum => "algebraic-sum",
        }
    }
    /// f
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|k| k.name() == name)
    }
}

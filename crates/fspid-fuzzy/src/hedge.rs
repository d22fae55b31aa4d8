//! stub
use crate::scalar::Scalar;
/// h
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hedge {
    /// n
    Not,
}
impl Hedge {
    /// a
    pub fn apply<S: Scalar>(&self, a: S) -> S {
        S::one() - a
    }
}

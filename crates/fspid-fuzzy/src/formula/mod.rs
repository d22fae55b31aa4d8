//! stub
use crate::scalar::Scalar;
/// f
#[derive(Clone, Debug, PartialEq)]
pub struct Formula {
    text: alloc::string::String,
}
impl Formula {
    /// a
    pub fn evaluate<S: Scalar>(&self, v: &[S]) -> S {
        v.first().copied().unwrap_or(S::zero())
    }
    /// t
    pub fn text(&self) -> &str {
        &self.text
    }
}

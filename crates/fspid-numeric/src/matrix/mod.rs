//! What small dense matrices need in more than one crate, over slices: square matrices row after row.
//!
//! Each loop stands here once. Where callers differ in a rule (what counts as negligible, when a pivot is refused), the
//! rule is a function of theirs: the bits of every stored result rest on it.
//!
//! Not here: a type of matrix, solvers, eigenvalues of general matrices (`fspid-lti`).

mod balance;
mod cholesky;
mod jacobi;

pub use balance::{balance, is_worthwhile};
pub use cholesky::{Entry, Stopped, cholesky, definite};
pub use jacobi::{Jacobi, Turn};

/// The entries of the identity.
pub fn identity(size: usize) -> impl Iterator<Item = f64> {
    (0..size * size).map(move |at| if at % (size + 1) == 0 { 1.0 } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_identity_has_ones_on_its_diagonal() {
        assert!(identity(2).eq([1.0, 0.0, 0.0, 1.0]));
        assert!(identity(0).eq([]));
    }
}

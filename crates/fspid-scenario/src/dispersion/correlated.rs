//! Normal numbers that depend on each other.

use super::cholesky::triangle;
use super::error::DispersionError;
use super::normal::Normal;
use super::standard_normal::quantile;

/// Several normal distributions, truncated or not, joined by a Gaussian copula.
///
/// $$ z = L \Phi^{-1}(u), \qquad L L^T = C, \qquad x_i = F_i^{-1}(\Phi(z_i)) $$
///
/// with the correlation matrix C and the distribution $F_i$ of each entry. Each entry alone has
/// exactly its own distribution, limits included. Without limits C is the correlation of the
/// numbers. With limits it is that of the z, of which every number is a growing function: ranks are
/// kept, and with them Spearman's correlation, $\frac{6}{\pi} \arcsin \frac{\rho}{2}$, while the
/// correlation of the numbers themselves can only be nearer to 0 (Lancaster 1957).
///
/// The first entry takes the first coordinate as it is; the others mix several, so that strata
/// are kept exactly in the first only.
#[derive(Clone, Debug, PartialEq)]
pub struct Correlated {
    entries: Vec<Normal>,
    /// L, row after row, each up to its diagonal.
    triangle: Vec<Vec<f64>>,
}

impl Correlated {
    /// Distributions and the correlation of each with each, row after row.
    ///
    /// # Errors
    /// [`DispersionError`] for no entries, and for a matrix that is not one of correlations between
    /// them: not square, not symmetric, not 1 on its diagonal, not between -1 and 1 elsewhere, or
    /// with correlations that contradict each other.
    pub fn new(entries: Vec<Normal>, correlation: &[Vec<f64>]) -> Result<Self, DispersionError> {
        if entries.is_empty() {
            return Err(DispersionError::NoValues);
        }
        let triangle = triangle(entries.len(), correlation)?;
        Ok(Self { entries, triangle })
    }

    /// The distribution of each entry alone.
    #[must_use]
    pub fn entries(&self) -> &[Normal] {
        &self.entries
    }

    /// The values at a point of the open unit cube.
    pub(super) fn values(&self, u: &[f64]) -> Vec<f64> {
        let independent: Vec<f64> = u.iter().map(|u| quantile(*u)).collect();
        let rows = self.entries.iter().zip(&self.triangle);
        rows.map(|(entry, row)| {
            entry.at(row.iter().zip(&independent).map(|(factor, x)| factor * x).sum())
        })
        .collect()
    }
}

//! Small dense real matrices, row after row.
//!
//! For models of some ten states that are prepared before a flight. Not a linear algebra library: no views, no blocks,
//! no vector instructions, so that every sum is added in the order in which it is written.

use fspid_numeric::matrix::identity;

use crate::error::LtiError;

/// A dense real matrix; zero rows or columns are allowed, for systems without states.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix {
    rows: usize,
    columns: usize,
    data: Vec<f64>,
}

impl Matrix {
    /// Matrix of zeros.
    #[must_use]
    pub fn zeros(rows: usize, columns: usize) -> Self {
        Self { rows, columns, data: vec![0.0; rows * columns] }
    }

    /// Square matrix with ones on the diagonal.
    #[must_use]
    pub fn identity(size: usize) -> Self {
        Self { rows: size, columns: size, data: identity(size).collect() }
    }

    /// Matrix with these rows.
    ///
    /// # Errors
    /// Rows of different length, an entry that is not finite.
    pub fn from_rows<R: AsRef<[f64]>>(rows: &[R]) -> Result<Self, LtiError> {
        let columns = rows.first().map_or(0, |row| row.as_ref().len());
        let mut data = Vec::with_capacity(rows.len() * columns);
        for (row, entries) in rows.iter().map(AsRef::as_ref).enumerate() {
            if entries.len() != columns {
                return Err(LtiError::RaggedRows { row, found: entries.len(), allowed: columns });
            }
            data.extend_from_slice(entries);
        }
        LtiError::unless_finite("matrix", &data)?;
        Ok(Self { rows: rows.len(), columns, data })
    }

    /// Matrix whose entry at (row, column) is what the function returns there.
    pub(crate) fn from_function(
        rows: usize,
        columns: usize,
        entry: impl Fn(usize, usize) -> f64,
    ) -> Self {
        let entries = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
        Self { rows, columns, data: entries.map(|(row, column)| entry(row, column)).collect() }
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// All entries, row after row.
    #[must_use]
    pub fn data(&self) -> &[f64] {
        &self.data
    }

    /// All entries, row after row, to be worn down.
    pub(crate) fn into_data(self) -> Vec<f64> {
        self.data
    }

    /// Entry at a row and column counted from 0; `None` outside.
    #[must_use]
    pub fn get(&self, row: usize, column: usize) -> Option<f64> {
        self.contains(row, column).then(|| self.at(row, column))
    }

    /// Replaces one entry; the value is not checked, as results of arithmetic are not.
    ///
    /// # Errors
    /// A position outside.
    pub fn set(&mut self, row: usize, column: usize, value: f64) -> Result<(), LtiError> {
        if !self.contains(row, column) {
            return Err(LtiError::OutOfBounds {
                row,
                column,
                rows: self.rows,
                columns: self.columns,
            });
        }
        *self.at_mut(row, column) = value;
        Ok(())
    }

    fn contains(&self, row: usize, column: usize) -> bool {
        row < self.rows && column < self.columns
    }

    /// Entry at a position that the caller knows to exist.
    pub(crate) fn at(&self, row: usize, column: usize) -> f64 {
        self.data[row * self.columns + column]
    }

    /// As [`Matrix::at`], to be changed.
    pub(crate) fn at_mut(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self.data[row * self.columns + column]
    }

    /// Entries of a row that the caller knows to exist.
    pub(crate) fn row(&self, row: usize) -> &[f64] {
        &self.data[row * self.columns..(row + 1) * self.columns]
    }

    pub(crate) fn swap_rows(&mut self, first: usize, second: usize) {
        for column in 0..self.columns {
            self.data.swap(first * self.columns + column, second * self.columns + column);
        }
    }

    /// Product of two matrices.
    ///
    /// # Errors
    /// A right factor whose rows are not as many as this one's columns.
    pub fn product(&self, right: &Self) -> Result<Self, LtiError> {
        right.require_shape("right factor", self.columns, right.columns)?;
        Ok(Self::from_function(self.rows, right.columns, |row, column| {
            self.row(row)
                .iter()
                .enumerate()
                .fold(0.0, |sum, (k, value)| sum + value * right.at(k, column))
        }))
    }

    /// Sum of two matrices.
    ///
    /// # Errors
    /// A second term of another shape.
    pub fn sum(&self, right: &Self) -> Result<Self, LtiError> {
        right.require_shape("second term", self.rows, self.columns)?;
        let data = self.data.iter().zip(&right.data).map(|(left, right)| left + right).collect();
        Ok(Self { rows: self.rows, columns: self.columns, data })
    }

    /// Every entry times a factor.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        self.map(|value| factor * value)
    }

    /// Every entry after a function.
    pub(crate) fn map(&self, function: impl Fn(f64) -> f64) -> Self {
        Self {
            rows: self.rows,
            columns: self.columns,
            data: self.data.iter().map(|&value| function(value)).collect(),
        }
    }

    /// Matrix with rows and columns exchanged.
    #[must_use]
    pub fn transpose(&self) -> Self {
        Self::from_function(self.columns, self.rows, |row, column| self.at(column, row))
    }

    /// Largest column sum of absolute values; NaN where an entry is.
    ///
    /// $$ \lVert A \rVert_1 = \max_j \sum_i |a_{ij}| $$
    #[must_use]
    pub fn norm_one(&self) -> f64 {
        let sums = (0..self.columns).map(|column| self.column_norm(column));
        sums.fold(0.0, |norm, sum| if norm > sum || norm.is_nan() { norm } else { sum })
    }

    /// Sum of the absolute values of one column.
    pub(crate) fn column_norm(&self, column: usize) -> f64 {
        (0..self.rows).fold(0.0, |sum, row| sum + self.at(row, column).abs())
    }

    /// Matrix times a vector, written into `out` without allocation.
    ///
    /// # Errors
    /// An `x` that is not as long as a row, an `out` that is not as long as a column.
    pub fn apply(&self, x: &[f64], out: &mut [f64]) -> Result<(), LtiError> {
        require_length("vector", x.len(), self.columns)?;
        require_length("result vector", out.len(), self.rows)?;
        for (row, value) in out.iter_mut().enumerate() {
            *value = self.row(row).iter().zip(x).fold(0.0, |sum, (entry, x)| sum + entry * x);
        }
        Ok(())
    }

    /// `Ok` when the matrix has this shape.
    pub(crate) fn require_shape(
        &self,
        what: &'static str,
        rows: usize,
        columns: usize,
    ) -> Result<(), LtiError> {
        let (found, allowed) = ((self.rows, self.columns), (rows, columns));
        if found == allowed { Ok(()) } else { Err(LtiError::Shape { what, found, allowed }) }
    }

    /// `Ok` when the matrix is square and all its entries are finite.
    pub(crate) fn require_square_and_finite(&self, what: &'static str) -> Result<(), LtiError> {
        self.require_shape(what, self.rows, self.rows)?;
        LtiError::unless_finite(what, &self.data)
    }
}

fn require_length(what: &'static str, found: usize, allowed: usize) -> Result<(), LtiError> {
    if found == allowed {
        Ok(())
    } else {
        Err(LtiError::Shape { what, found: (found, 1), allowed: (allowed, 1) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(rows: &[&[f64]]) -> Matrix {
        Matrix::from_rows(rows).expect("a test matrix is well formed")
    }

    #[test]
    fn ragged_rows_and_entries_that_are_not_finite_are_refused() {
        let ragged = Matrix::from_rows(&[vec![1.0, 2.0], vec![3.0]]);
        assert_eq!(ragged, Err(LtiError::RaggedRows { row: 1, found: 1, allowed: 2 }));
        let broken = Matrix::from_rows(&[[1.0, 2.0], [3.0, f64::NAN]]);
        assert!(matches!(broken, Err(LtiError::NotFinite { what: "matrix", index: 3, .. })));
    }

    #[test]
    fn products_and_sums_agree_with_hand_calculation() {
        let (left, right) = (
            matrix(&[&[1.0, 2.0], &[3.0, 4.0], &[5.0, 6.0]]),
            matrix(&[&[1.0, 0.0], &[-1.0, 2.0]]),
        );
        assert_eq!(
            left.product(&right),
            Matrix::from_rows(&[[-1.0, 4.0], [-1.0, 8.0], [-1.0, 12.0]])
        );
        assert_eq!(left.sum(&left), Ok(left.scaled(2.0)));
        assert_eq!(left.transpose(), matrix(&[&[1.0, 3.0, 5.0], &[2.0, 4.0, 6.0]]));
        assert_eq!(left.norm_one().to_bits(), 12.0_f64.to_bits());
        let mut out = [0.0; 3];
        assert_eq!(left.apply(&[1.0, -1.0], &mut out), Ok(()));
        assert_eq!(out.to_vec(), vec![-1.0; 3]);
    }

    #[test]
    fn shapes_that_do_not_fit_are_refused() {
        let (tall, wide) = (Matrix::zeros(3, 2), Matrix::zeros(2, 3));
        let expected = LtiError::Shape { what: "right factor", found: (3, 2), allowed: (2, 2) };
        assert_eq!(tall.product(&tall), Err(expected));
        assert!(tall.sum(&wide).is_err());
        assert!(tall.apply(&[0.0; 3], &mut [0.0; 3]).is_err());
        assert!(tall.apply(&[0.0; 2], &mut [0.0; 2]).is_err());
    }

    #[test]
    fn entries_outside_are_none_to_read_and_an_error_to_write() {
        let mut matrix = Matrix::zeros(2, 3);
        assert_eq!(matrix.set(1, 2, 7.0), Ok(()));
        assert_eq!((matrix.get(1, 2), matrix.get(2, 0), matrix.get(0, 3)), (Some(7.0), None, None));
        assert_eq!(
            matrix.set(0, 3, 1.0),
            Err(LtiError::OutOfBounds { row: 0, column: 3, rows: 2, columns: 3 })
        );
    }

    #[test]
    fn a_matrix_without_rows_multiplies_to_zeros() {
        let product = Matrix::zeros(1, 0).product(&Matrix::zeros(0, 1));
        assert_eq!(product, Ok(Matrix::zeros(1, 1)));
        assert_eq!(Matrix::zeros(0, 0).norm_one().to_bits(), 0.0_f64.to_bits());
    }

    #[test]
    fn a_norm_does_not_hide_a_nan() {
        let mut matrix = Matrix::identity(2);
        matrix.set(0, 0, f64::NAN).expect("the entry exists");
        assert!(matrix.norm_one().is_nan());
    }
}

//! Matrices whose entries are known within bounds.

use fspid_lti::{LtiError, Matrix};
use fspid_numeric::rounding::{exact_sum, sum_up, times_power};
use fspid_numeric::scalar::Interval;

use super::product;

/// A dense matrix of intervals: all real matrices whose entries lie within a radius of a middle.
///
/// $$ \lbrace A : |a_{ij} - m_{ij}| \le r_{ij} \rbrace $$
///
/// Sums, products and scalings hold every result that matrices inside can have, rounding included.
/// An entry without bounds (after an overflow, or from NaN) has an infinite radius and is passed on;
/// whatever proves something refuses it.
///
/// # Source
/// S. M. Rump, *Fast and parallel interval arithmetic*, BIT 39 (1999) 534: middle and radius. The
/// product of two wide matrices can be half as wide again as need be; that of two points is exact to
/// one rounding.
#[derive(Clone, Debug, PartialEq)]
pub struct IntervalMatrix {
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) middle: Vec<f64>,
    /// Not negative, not NaN; infinite where there is no bound.
    pub(super) radius: Vec<f64>,
}

impl IntervalMatrix {
    /// Matrix of zeros.
    #[must_use]
    pub fn zeros(rows: usize, columns: usize) -> Self {
        let zeros = || vec![0.0; rows * columns];
        Self { rows, columns, middle: zeros(), radius: zeros() }
    }

    /// Square matrix with ones on the diagonal.
    #[must_use]
    pub fn identity(size: usize) -> Self {
        Self::from(&Matrix::identity(size))
    }

    /// Matrix with these rows.
    ///
    /// # Errors
    /// Rows of different length.
    pub fn from_rows<R: AsRef<[Interval]>>(rows: &[R]) -> Result<Self, LtiError> {
        let columns = rows.first().map_or(0, |row| row.as_ref().len());
        let mut entries = Vec::with_capacity(rows.len() * columns);
        for (row, values) in rows.iter().map(AsRef::as_ref).enumerate() {
            if values.len() != columns {
                return Err(LtiError::RaggedRows { row, found: values.len(), allowed: columns });
            }
            entries.extend_from_slice(values);
        }
        Ok(Self::from_entries(rows.len(), columns, entries))
    }

    /// Matrix of entries that the caller knows to be as many as it needs.
    pub(super) fn from_entries(
        rows: usize,
        columns: usize,
        entries: impl IntoIterator<Item = Interval>,
    ) -> Self {
        let (middle, radius) = entries.into_iter().map(middle_and_radius).unzip();
        Self { rows, columns, middle, radius }
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

    /// Entry at a row and column counted from 0; `None` outside.
    #[must_use]
    pub fn get(&self, row: usize, column: usize) -> Option<Interval> {
        let inside = row < self.rows && column < self.columns;
        inside.then(|| self.entry(row * self.columns + column))
    }

    /// All entries, row after row.
    pub fn entries(&self) -> impl ExactSizeIterator<Item = Interval> + '_ {
        (0..self.middle.len()).map(|place| self.entry(place))
    }

    fn entry(&self, place: usize) -> Interval {
        let (middle, radius) = (self.middle[place], self.radius[place]);
        if radius == 0.0 {
            return Interval::point(middle);
        }
        let (middle, radius) = (Interval::point(middle), Interval::point(radius));
        let (lower, upper) = ((middle - radius).lower(), (middle + radius).upper());
        Interval::new(lower, upper).unwrap_or(Interval::ENTIRE)
    }

    /// The matrix in the middle.
    #[must_use]
    pub fn midpoint(&self) -> Matrix {
        let mut middle = Matrix::zeros(self.rows, self.columns);
        for (place, &value) in self.middle.iter().enumerate() {
            // The place exists: both are of one size.
            let _ = middle.set(place / self.columns, place % self.columns, value);
        }
        middle
    }

    /// The largest radius of an entry.
    #[must_use]
    pub fn max_radius(&self) -> f64 {
        self.radius.iter().copied().fold(0.0, f64::max)
    }

    /// True if every matrix of `other` lies inside.
    #[must_use]
    pub fn encloses(&self, other: &Self) -> bool {
        (self.rows, self.columns) == (other.rows, other.columns)
            && self.entries().zip(other.entries()).all(|(own, other)| own.encloses(other))
    }

    /// True if the matrix with these entries lies inside; false for NaN.
    #[must_use]
    pub fn contains(&self, matrix: &Matrix) -> bool {
        (self.rows, self.columns) == (matrix.rows(), matrix.columns())
            && self.entries().zip(matrix.data()).all(|(own, &value)| own.contains(value))
    }

    /// Product of two matrices.
    ///
    /// # Errors
    /// A right factor whose rows are not as many as this one's columns.
    pub fn product(&self, right: &Self) -> Result<Self, LtiError> {
        right.require_shape("right factor", self.columns, right.columns)?;
        Ok(product::product(self, right))
    }

    /// Sum of two matrices.
    ///
    /// # Errors
    /// A second term of another shape.
    pub fn sum(&self, right: &Self) -> Result<Self, LtiError> {
        right.require_shape("second term", self.rows, self.columns)?;
        Ok(self.plus(right))
    }

    /// Difference of two matrices.
    ///
    /// # Errors
    /// A second term of another shape.
    pub fn difference(&self, right: &Self) -> Result<Self, LtiError> {
        right.require_shape("second term", self.rows, self.columns)?;
        Ok(self.combined(right, |left, right| exact_sum(left, -right)))
    }

    /// Sum of two matrices that the caller knows to be of one shape.
    pub(super) fn plus(&self, right: &Self) -> Self {
        self.combined(right, exact_sum)
    }

    /// Entry by entry the exact sum of two middles; what does not fit adds to the radius.
    fn combined(&self, right: &Self, middles: impl Fn(f64, f64) -> (f64, f64)) -> Self {
        let mut result = self.clone();
        for (place, (middle, radius)) in
            result.middle.iter_mut().zip(&mut result.radius).enumerate()
        {
            let (sum, error) = middles(*middle, right.middle[place]);
            let radii = sum_up(*radius, right.radius[place]);
            (*middle, *radius) = bounded(sum, sum_up(radii, error.abs()));
        }
        result
    }

    /// Every entry times a factor; an entry without bounds keeps none.
    #[must_use]
    pub fn scaled(&self, factor: Interval) -> Self {
        let mut result = self.clone();
        for (middle, radius) in result.middle.iter_mut().zip(&mut result.radius) {
            let (product, own) = middle_and_radius(Interval::point(*middle) * factor);
            let spread = (Interval::point(*radius) * Interval::point(factor.magnitude())).upper();
            let known = radius.is_finite();
            let whole = if known { sum_up(own, spread) } else { f64::INFINITY };
            (*middle, *radius) = bounded(product, whole);
        }
        result
    }

    /// Row i times $2^{r_i}$ and column j times $2^{c_j}$, which is exact within the range of floats.
    pub(super) fn rescaled(
        &self,
        row_exponent: impl Fn(usize) -> i32,
        column_exponent: impl Fn(usize) -> i32,
    ) -> Self {
        let mut result = self.clone();
        for (place, (middle, radius)) in
            result.middle.iter_mut().zip(&mut result.radius).enumerate()
        {
            let exponent =
                row_exponent(place / self.columns) + column_exponent(place % self.columns);
            let (value, error) = times_power(*middle, exponent);
            let (spread, more) = times_power(*radius, exponent);
            (*middle, *radius) = bounded(value, sum_up(sum_up(spread, more), error));
        }
        result
    }

    /// Matrix with rows and columns exchanged.
    #[must_use]
    pub fn transpose(&self) -> Self {
        let mut result = Self::zeros(self.columns, self.rows);
        for (place, (&middle, &radius)) in self.middle.iter().zip(&self.radius).enumerate() {
            let other = place % self.columns * self.rows + place / self.columns;
            (result.middle[other], result.radius[other]) = (middle, radius);
        }
        result
    }

    /// Largest absolute value of each entry, rounded up.
    pub(super) fn magnitudes(&self) -> Vec<f64> {
        let pairs = self.middle.iter().zip(&self.radius);
        pairs.map(|(middle, &radius)| sum_up(middle.abs(), radius)).collect()
    }

    /// `Ok` when the matrix has this shape.
    pub(super) fn require_shape(
        &self,
        what: &'static str,
        rows: usize,
        columns: usize,
    ) -> Result<(), LtiError> {
        let (found, allowed) = ((self.rows, self.columns), (rows, columns));
        if found == allowed { Ok(()) } else { Err(LtiError::Shape { what, found, allowed }) }
    }
}

impl From<&Matrix> for IntervalMatrix {
    /// Nothing but this matrix; entries that are not finite have no bounds.
    fn from(matrix: &Matrix) -> Self {
        let mut result = Self::zeros(matrix.rows(), matrix.columns());
        for (place, &value) in matrix.data().iter().enumerate() {
            (result.middle[place], result.radius[place]) = bounded(value, 0.0);
        }
        result
    }
}

/// The pair itself if both are finite, else nothing known.
pub(super) fn bounded(middle: f64, radius: f64) -> (f64, f64) {
    let known = middle.is_finite() && radius < f64::INFINITY;
    if known { (middle, radius) } else { (0.0, f64::INFINITY) }
}

/// Middle and radius of an interval, the radius rounded up.
fn middle_and_radius(entry: Interval) -> (f64, f64) {
    if !entry.is_bounded() {
        return (0.0, f64::INFINITY);
    }
    let middle = entry.midpoint();
    let to = |bound: f64| (Interval::point(bound) - Interval::point(middle)).magnitude();
    bounded(middle, to(entry.lower()).max(to(entry.upper())))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn interval(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).expect("ordered")
    }

    #[test]
    fn ragged_rows_are_refused_and_shapes_must_fit() {
        let ragged = IntervalMatrix::from_rows(&[vec![Interval::ONE; 2], vec![Interval::ONE]]);
        assert_eq!(ragged, Err(LtiError::RaggedRows { row: 1, found: 1, allowed: 2 }));
        let (tall, wide) = (IntervalMatrix::zeros(3, 2), IntervalMatrix::zeros(2, 3));
        assert!(tall.sum(&wide).is_err() && tall.difference(&wide).is_err());
        assert!(tall.product(&tall).is_err() && tall.product(&wide).is_ok());
        assert_eq!((tall.get(2, 1), tall.get(3, 0)), (Some(Interval::ZERO), None));
    }

    #[test]
    fn an_entry_keeps_its_bounds_inside() {
        let entries = [
            interval(0.1, 0.3),
            interval(-1e-300, 1e300),
            interval(1.0, 1.0_f64.next_up()),
            interval(-5e-324, 5e-324),
        ];
        let matrix = IntervalMatrix::from_rows(&[&entries[..2], &entries[2..]]).expect("square");
        for (kept, entry) in matrix.entries().zip(entries) {
            assert!(kept.encloses(entry), "{kept:?} {entry:?}");
            assert!(kept.width() <= entry.width() * (1.0 + 1e-15) + 4.0 * f64::EPSILON);
        }
        assert_eq!(matrix.transpose().get(0, 1), matrix.get(1, 0));
        assert!(matrix.encloses(&matrix) && matrix.contains(&matrix.midpoint()));
    }

    #[test]
    fn what_is_not_finite_has_no_bounds_and_keeps_none() {
        let mut broken = Matrix::identity(2);
        broken.set(0, 1, f64::NAN).expect("the entry exists");
        broken.set(1, 0, f64::INFINITY).expect("the entry exists");
        let broken = IntervalMatrix::from(&broken);
        assert_eq!(broken.get(0, 1), Some(Interval::ENTIRE));
        assert_eq!(broken.get(1, 0), Some(Interval::ENTIRE));
        assert!(!broken.contains(&Matrix::identity(2).scaled(f64::NAN)));
        let zero = broken.difference(&broken).expect("the same shape");
        assert_eq!(zero.get(0, 1), Some(Interval::ENTIRE));
        assert_eq!(broken.scaled(Interval::ZERO).get(1, 0), Some(Interval::ENTIRE));
        let square = broken.product(&broken).expect("square");
        assert!(square.entries().all(|entry| !entry.is_bounded()));
        let unbounded = interval(0.0, f64::INFINITY);
        let matrix = IntervalMatrix::from_rows(&[[unbounded]]).expect("square");
        assert_eq!(matrix.get(0, 0), Some(Interval::ENTIRE));
        let huge = IntervalMatrix::from_rows(&[[Interval::point(f64::MAX)]]).expect("square");
        assert!(!huge.sum(&huge).expect("one shape").get(0, 0).expect("exists").is_bounded());
    }

    #[test]
    fn powers_of_two_scale_exactly_unless_they_leave_the_range() {
        let matrix = IntervalMatrix::from_rows(&[[interval(0.1, 0.2), Interval::point(0.3)]]);
        let matrix = matrix.expect("one row");
        let scaled = matrix.rescaled(|_| 3, |column| if column == 0 { -5 } else { 7 });
        assert_eq!(scaled.get(0, 1), Some(Interval::point(0.3 * 1024.0)));
        assert_eq!(scaled.rescaled(|_| -3, |column| if column == 0 { 5 } else { -7 }), matrix);
        let tiny = matrix.rescaled(|_| -1073, |_| 0).get(0, 1).expect("exists");
        assert!(tiny.lower() <= 0.0 && tiny.upper() > 0.0);
        assert!(!matrix.rescaled(|_| 1030, |_| 0).get(0, 0).expect("exists").is_bounded());
    }
}

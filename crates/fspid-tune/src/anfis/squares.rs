//! Least squares, row by row.

/// The triangle of a least-squares problem: $\min_c \sum_k (\varphi_k c - t_k)^2 + \sum_j (d_j c_j)^2$.
///
/// Each row is rotated into the triangle $R c = z$ as it comes (Givens), so that nothing is squared and no row is kept.
///
/// # Source
/// G. H. Golub and C. F. Van Loan, Matrix Computations, 4th ed., section 6.5.3 (appending a row).
#[derive(Clone, Debug)]
pub(super) struct Triangle {
    size: usize,
    /// Row after row, with zeros below the diagonal.
    factor: Vec<f64>,
    right: Vec<f64>,
}

impl Triangle {
    /// Without data: each unknown is drawn to 0 with its weight $d_j$, which is above 0.
    pub(super) fn new(weights: &[f64]) -> Self {
        let size = weights.len();
        let mut factor = vec![0.0; size * size];
        for (index, &weight) in weights.iter().enumerate() {
            if let Some(place) = factor.get_mut(index * size + index) {
                *place = weight;
            }
        }
        Self { size, factor, right: vec![0.0; size] }
    }

    /// Adds a row; it is used up.
    pub(super) fn add(&mut self, row: &mut [f64], mut target: f64) {
        let size = self.size;
        for (index, (own, right)) in
            self.factor.chunks_exact_mut(size.max(1)).zip(&mut self.right).enumerate()
        {
            let (Some(own), Some(row)) = (own.get_mut(index..), row.get_mut(index..)) else {
                return;
            };
            let (Some(&diagonal), Some(&first)) = (own.first(), row.first()) else {
                return;
            };
            if !(first.abs() > 0.0) {
                continue;
            }
            let length = (diagonal * diagonal + first * first).sqrt();
            let (cosine, sine) = (diagonal / length, first / length);
            for (own, row) in own.iter_mut().zip(row) {
                let (above, below) = (*own, *row);
                *own = cosine * above + sine * below;
                *row = cosine * below - sine * above;
            }
            let above = *right;
            *right = cosine * above + sine * target;
            target = cosine * target - sine * above;
        }
    }

    /// The unknowns; `None` if they are not all finite.
    pub(super) fn solution(&self) -> Option<Vec<f64>> {
        let mut unknowns = vec![0.0; self.size];
        for index in (0..self.size).rev() {
            let row = self.factor.get(index * self.size..(index + 1) * self.size)?;
            let known = row.iter().zip(&unknowns).skip(index + 1);
            let sum: f64 = known.map(|(factor, unknown)| factor * unknown).sum();
            let found = (self.right.get(index)? - sum) / row.get(index)?;
            *unknowns.get_mut(index)? = found;
        }
        unknowns.iter().all(|unknown| unknown.is_finite()).then_some(unknowns)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_through_three_points_is_the_one_of_the_textbook() {
        // Normal equations of (0, 1), (1, 3), (2, 4): intercept 7/6, slope 3/2.
        let mut triangle = Triangle::new(&[1e-12, 1e-12]);
        for (x, y) in [(0.0, 1.0), (1.0, 3.0), (2.0, 4.0)] {
            triangle.add(&mut [1.0, x], y);
        }
        let found = triangle.solution().expect("finite");
        assert!(
            (found[0] - 7.0 / 6.0).abs() < 1e-14 && (found[1] - 1.5).abs() < 1e-14,
            "{found:?}"
        );
    }

    #[test]
    fn the_weights_draw_to_zero_as_ridge_regression_does() {
        // (Σ x² + d²) c = Σ x y.
        let mut triangle = Triangle::new(&[2.0]);
        for (x, y) in [(1.0, 3.0), (2.0, 1.0)] {
            triangle.add(&mut [x], y);
        }
        let found = triangle.solution().expect("finite");
        assert!((found[0] - 5.0 / 9.0).abs() < 1e-15, "{found:?}");
    }

    #[test]
    fn unknowns_that_no_row_asks_for_stay_at_zero_and_overflow_is_told() {
        let mut triangle = Triangle::new(&[1e-6, 1e-6]);
        triangle.add(&mut [1.0, 0.0], 2.0);
        let found = triangle.solution().expect("finite");
        assert!((found[0] - 2.0).abs() < 1e-11);
        assert_eq!(found[1], 0.0);
        triangle.add(&mut [1e200, 1e200], 1e200);
        assert_eq!(triangle.solution(), None);
    }
}

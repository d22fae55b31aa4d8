//! A state that moves nothing: the last measurement, of which a supervisor takes the change of the error.
//!
//! A form that is made as wide as it can be has next to no weight on it, and in a form that is nearly flat no fall is proved.
//! So the form is made of the other states, and the square of the one is added with a weight that takes little of the fall:
//! with $x^+ = M x$, $s^+ = r x$ and P of the others,
//!
//! $$ \epsilon (r x)^2 \le \epsilon \, r P^{-1} r^T \; x^T P x $$

use fspid_lti::Matrix;

/// Of what a form falls in a sample, so much is left to the state.
const TAKEN: f64 = 0.02;

/// Which state moves nothing, if one does.
pub(super) struct Idle {
    place: Option<usize>,
}

impl Idle {
    /// The last state that neither a loop nor a row makes anything of.
    pub(super) fn among(matrices: &[Matrix], rows: &[Vec<f64>]) -> Self {
        let size = matrices.first().map_or(0, Matrix::columns);
        let is_nothing = |entry: f64| entry.abs() <= 0.0;
        let moves_nothing = |place: &usize| {
            let of_loops = matrices.iter().flat_map(|matrix| {
                (0..size).map(move |row| matrix.get(row, *place).unwrap_or(f64::NAN))
            });
            let of_rows = rows.iter().map(|row| row[*place]);
            of_loops.chain(of_rows).all(is_nothing)
        };
        Self { place: (0..size).rev().find(moves_nothing) }
    }

    fn kept(&self, size: usize) -> impl Iterator<Item = usize> + Clone {
        let place = self.place;
        (0..size).filter(move |it| Some(*it) != place)
    }

    /// A matrix of the other states.
    pub(super) fn less(&self, matrix: &Matrix) -> Option<Matrix> {
        let size = matrix.rows();
        let row = |row: usize| -> Option<Vec<f64>> {
            self.kept(size).map(|column| matrix.get(row, column)).collect()
        };
        Matrix::from_rows(&self.kept(size).map(row).collect::<Option<Vec<_>>>()?).ok()
    }

    /// The same of several.
    pub(super) fn without(&self, matrices: &[Matrix]) -> Option<Vec<Matrix>> {
        matrices.iter().map(|matrix| self.less(matrix)).collect()
    }

    /// Rows over the other states.
    pub(super) fn cut(&self, rows: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let cut = |row: &Vec<f64>| self.kept(row.len()).map(|place| row[place]).collect();
        rows.iter().map(cut).collect()
    }

    /// A form of the others with the state added to it.
    pub(super) fn more(&self, form: Matrix, matrices: &[Matrix], rate: f64) -> Option<Matrix> {
        let Some(place) = self.place else { return Some(form) };
        let mut most = matrices.iter().map(|matrix| {
            let size = matrix.columns();
            let row: Option<Vec<f64>> =
                self.kept(size).map(|column| matrix.get(place, column)).collect();
            let row = row?;
            let column: Vec<[f64; 1]> = row.iter().map(|entry| [*entry]).collect();
            let solved = form.solve(&Matrix::from_rows(&column).ok()?).ok()?;
            let terms = row.iter().enumerate().map(|(at, by)| Some(by * solved.get(at, 0)?));
            terms.sum::<Option<f64>>()
        });
        let most = most.try_fold(0.0, |most: f64, it| Some(most.max(it?)))?;
        let weight = TAKEN * (1.0 - rate) / most;
        let size = form.rows() + 1;
        // Where a state of the whole is among the others.
        let other = |at: usize| at - usize::from(at > place);
        let entry = |row: usize, column: usize| match (row == place, column == place) {
            (true, true) => Some(weight),
            (false, false) => form.get(other(row), other(column)),
            _ => Some(0.0),
        };
        let rows = (0..size).map(|row| (0..size).map(|column| entry(row, column)).collect());
        Matrix::from_rows(&rows.collect::<Option<Vec<Vec<f64>>>>()?).ok()
    }
}

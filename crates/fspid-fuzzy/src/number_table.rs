//! Rules that conclude numbers: a zero-order system of Takagi and Sugeno over the same seven by seven cells.

use crate::error::FuzzyError;
use crate::inference::Increments;
use crate::label::LABEL_COUNT;
use crate::rule_table::Output;
use fspid_numeric::Real;

/// One output's numbers: rows are the error from `NB` to `PB`, columns its change.
pub type NumberGrid<R> = [[R; LABEL_COUNT]; LABEL_COUNT];

/// Steps from the middle set to the outermost.
const LAST_STEP: f64 = 3.0;

/// What each gain is moved by at each pair of set centres, in the units of the supervisor's range.
///
/// The rule of cell (i, j) says: where the error is in set i and its change in set j, the increment is
/// $n_{ij}$. The sets are triangles with centres evenly over the range, each reaching to its neighbours, so
/// that the grades of an input sum to one; *and* is the product. Then the weighted mean needs no quotient,
///
/// $$ \Delta k = \frac{\sum_{ij} \mu_i(e) \mu_j(\dot e) n_{ij}}{\sum_{ij} \mu_i(e) \mu_j(\dot e)}
///    = \sum_{ij} \mu_i(e) \mu_j(\dot e) n_{ij}, $$
///
/// because the sum of products is the product of the sums, $1 \cdot 1$; and of the 49 products four at most are
/// not zero: the answer is the bilinear interpolation of the numbers. It lies between the least and the
/// greatest number of the cell. After T. Takagi and M. Sugeno, Fuzzy identification of systems and its
/// applications to modeling and control, IEEE Transactions on Systems, Man, and Cybernetics 15 (1985),
/// with conclusions of order zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NumberTable<R> {
    grids: [NumberGrid<R>; 3],
}

impl<R: Real> NumberTable<R> {
    /// The table of three grids, in the order of [`Output::ALL`].
    ///
    /// # Errors
    /// [`FuzzyError::Number`] for the first number that is not finite.
    pub fn new(grids: [NumberGrid<R>; 3]) -> Result<Self, FuzzyError> {
        let table = Self { grids };
        match table.first(|number| !number.is_finite()) {
            None => Ok(table),
            Some((output, row, column, found)) => {
                let allowed = f64::MAX;
                Err(FuzzyError::Number { output, row, column, found: found.to_f64(), allowed })
            }
        }
    }

    /// The table of the grids of one that was built, as a constant; nothing is checked.
    #[must_use]
    pub const fn new_unchecked(grids: [NumberGrid<R>; 3]) -> Self {
        Self { grids }
    }

    /// The numbers of one output.
    #[must_use]
    pub const fn grid(&self, output: Output) -> &NumberGrid<R> {
        &self.grids[output as usize]
    }

    /// Refuses a number beyond the range, where no answer of labels would lie.
    pub(crate) fn check_within(&self, range: R) -> Result<(), FuzzyError> {
        match self.first(|number| !(number.abs() <= range)) {
            None => Ok(()),
            Some((output, row, column, found)) => {
                let (found, allowed) = (found.to_f64(), range.to_f64());
                Err(FuzzyError::Number { output, row, column, found, allowed })
            }
        }
    }

    /// The first number of a kind; row and column count from 1.
    fn first(&self, is_meant: impl Fn(R) -> bool) -> Option<(Output, usize, usize, R)> {
        let cells = Output::ALL.into_iter().flat_map(|output| {
            self.grid(output).iter().zip(1..).flat_map(move |(row, i)| {
                row.iter().zip(1..).map(move |(number, j)| (output, i, j, *number))
            })
        });
        cells.into_iter().find(|(.., number)| is_meant(*number))
    }

    /// The answer for inputs in spacings of the sets, each from -3 to 3.
    #[inline(always)]
    pub(crate) fn interpolated(&self, error: R, change: R) -> Increments<R> {
        let (rows, columns) = (Neighbours::of(error), Neighbours::of(change));
        let [kp, ki, kd] = self.grids.each_ref().map(|grid| {
            let along = |row: usize| {
                let at = |column: usize| {
                    let row = grid.get(row).unwrap_or(&grid[0]);
                    *row.get(column).unwrap_or(&row[0])
                };
                columns.lower_grade * at(columns.lower)
                    + columns.upper_grade * at(columns.lower + 1)
            };
            rows.lower_grade * along(rows.lower) + rows.upper_grade * along(rows.lower + 1)
        });
        Increments { kp, ki, kd }
    }
}

/// The two sets between whose centres an input lies.
struct Neighbours<R> {
    /// Number of the lower one, 0 to 5.
    lower: usize,
    lower_grade: R,
    upper_grade: R,
}

impl<R: Real> Neighbours<R> {
    /// Of an input in spacings, from -3 to 3.
    ///
    /// Centres are whole numbers and so exact. Mirrored inputs have mirrored grades to the last bit, and
    /// sums of two products do not depend on their order: symmetric numbers answer symmetrically.
    #[inline(always)]
    fn of(input: R) -> Self {
        let (mut index, mut lower) = (0, R::from_f64(-LAST_STEP));
        for step in [-2.0, -1.0, 0.0, 1.0, 2.0].map(R::from_f64) {
            if input >= step {
                (index, lower) = (index + 1, step);
            }
        }
        let upper_grade = R::ONE - ((lower + R::ONE) - input);
        Self { lower: index, lower_grade: R::ONE - (input - lower), upper_grade }
    }
}

/// Grade of an input in a set with its centre at `step`, both in spacings.
#[inline(always)]
pub(crate) fn triangle<R: Real>(input: R, step: R) -> R {
    (R::ONE - (input - step).abs()).larger(R::ZERO)
}

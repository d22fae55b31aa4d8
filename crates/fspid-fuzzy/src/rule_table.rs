//! The 49 rules: which label each gain takes for each pair of input labels.

use core::fmt;

use crate::error::FuzzyError;
use crate::label::{LABEL_COUNT, Label};

/// One output's labels: rows are the error from `NB` to `PB`, columns its change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid([[Label; LABEL_COUNT]; LABEL_COUNT]);

/// Which gain a grid belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Output {
    /// Increment of the proportional gain.
    DeltaKp,
    /// Increment of the integral gain.
    DeltaKi,
    /// Increment of the derivative gain.
    DeltaKd,
}

impl Output {
    /// The three outputs in order.
    pub const ALL: [Self; 3] = [Self::DeltaKp, Self::DeltaKi, Self::DeltaKd];

    /// Name in files and answers.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::DeltaKp => "delta_kp",
            Self::DeltaKi => "delta_ki",
            Self::DeltaKd => "delta_kd",
        }
    }
}

/// Why a text is no rule grid. Rows and columns count from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum GridError {
    /// A cell holds no label.
    UnknownLabel {
        /// Row of the cell.
        row: usize,
        /// Column of the cell.
        column: usize,
    },
    /// A row has too few or too many cells.
    RowLength {
        /// Row in question.
        row: usize,
        /// Cells found in it.
        found: usize,
    },
    /// There are too few or too many rows.
    RowCount {
        /// Rows found.
        found: usize,
    },
}

impl fmt::Display for GridError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownLabel { row, column } => write!(
                f,
                "row {row} (error {}), column {column} (change {}) holds no label; allowed are NB NM NS ZO PS PM PB",
                Label::ALL[row - 1],
                Label::ALL[column - 1]
            ),
            Self::RowLength { row, found } => write!(
                f,
                "row {row} (error {}) has {found} cells; allowed are {LABEL_COUNT}, one for each change from NB to PB",
                Label::ALL[row - 1]
            ),
            Self::RowCount { found } => {
                write!(
                    f,
                    "{found} rows; allowed are {LABEL_COUNT}, one for each error from NB to PB"
                )
            }
        }
    }
}

impl core::error::Error for GridError {}

impl Grid {
    /// The grid with these labels, rows by error, columns by change of error.
    #[must_use]
    pub const fn new(rows: [[Label; LABEL_COUNT]; LABEL_COUNT]) -> Self {
        Self(rows)
    }

    /// Reads seven lines of seven labels separated by blanks; empty lines are passed over.
    ///
    /// # Errors
    /// A hole, a word that is no label, a line too many: [`GridError`] with row and column.
    pub fn parse(text: &str) -> Result<Self, GridError> {
        let mut rows = [[Label::ZO; LABEL_COUNT]; LABEL_COUNT];
        let lines = || text.lines().filter(|line| !line.trim().is_empty());
        for (index, line) in lines().enumerate().take(LABEL_COUNT) {
            rows[index] = parse_row(index + 1, line)?;
        }
        match lines().count() {
            LABEL_COUNT => Ok(Self(rows)),
            found => Err(GridError::RowCount { found }),
        }
    }

    /// The label for an error label and a change label.
    #[must_use]
    pub const fn at(&self, error: Label, change: Label) -> Label {
        self.0[error.index()][change.index()]
    }

    /// The grid that answers a fall as the printed one answers a rise.
    ///
    /// Rows of negative error are kept, and a row of positive error is the opposite row read
    /// backwards; in the `ZO` row the half of negative changes stands on both sides. Not in the
    /// paper: its table is odd in the error although its rule 1 speaks of the size of the error.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let last = LABEL_COUNT - 1;
        let centre = Label::ZO.index();
        let mut rows = self.0;
        for (i, row) in rows.iter_mut().enumerate() {
            for (j, cell) in row.iter_mut().enumerate() {
                *cell = if i < centre || (i == centre && j <= centre) {
                    self.0[i][j]
                } else {
                    self.0[last - i][last - j]
                };
            }
        }
        Self(rows)
    }
}

fn parse_row(row: usize, line: &str) -> Result<[Label; LABEL_COUNT], GridError> {
    let mut labels = [Label::ZO; LABEL_COUNT];
    let found = line.split_whitespace().count();
    if found != LABEL_COUNT {
        return Err(GridError::RowLength { row, found });
    }
    for (index, word) in line.split_whitespace().enumerate() {
        labels[index] =
            Label::from_name(word).ok_or(GridError::UnknownLabel { row, column: index + 1 })?;
    }
    Ok(labels)
}

/// The rule base: one grid for each gain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RuleTable {
    grids: [Grid; 3],
}

impl RuleTable {
    /// The rule base of three grids, in the order of [`Output::ALL`].
    #[must_use]
    pub const fn new(grids: [Grid; 3]) -> Self {
        Self { grids }
    }

    /// Reads three grids, in the order of [`Output::ALL`].
    ///
    /// # Errors
    /// [`FuzzyError::Grid`] names the output, row and column of the first fault.
    pub fn parse(texts: [&str; 3]) -> Result<Self, FuzzyError> {
        let read = |output: Output, text| {
            Grid::parse(text).map_err(|error| FuzzyError::Grid { output, error })
        };
        Ok(Self {
            grids: [
                read(Output::DeltaKp, texts[0])?,
                read(Output::DeltaKi, texts[1])?,
                read(Output::DeltaKd, texts[2])?,
            ],
        })
    }

    /// The grid of one output.
    #[must_use]
    pub const fn grid(&self, output: Output) -> &Grid {
        &self.grids[output as usize]
    }

    /// The rule base with every grid [mirrored](Grid::mirrored).
    #[must_use]
    pub fn mirrored(&self) -> Self {
        Self { grids: self.grids.map(|grid| grid.mirrored()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::string::ToString;

    const ROW: &str = "NB NM NS ZO PS PM PB\n";

    #[test]
    fn a_hole_in_a_grid_is_refused_with_its_row() {
        let text = [ROW, ROW, "NB NM NS PS PM PB\n", ROW, ROW, ROW, ROW].concat();
        assert_eq!(Grid::parse(&text), Err(GridError::RowLength { row: 3, found: 6 }));
    }

    #[test]
    fn an_unknown_label_is_refused_with_its_cell() {
        let text = [ROW, "NB NM NS ZO PS XX PB\n", ROW, ROW, ROW, ROW, ROW].concat();
        let error = Grid::parse(&text).expect_err("XX is no label");
        assert_eq!(error, GridError::UnknownLabel { row: 2, column: 6 });
        assert!(error.to_string().contains("(error NM), column 6 (change PM)"));
    }

    #[test]
    fn too_few_and_too_many_rows_are_refused_with_their_number() {
        assert_eq!(Grid::parse(""), Err(GridError::RowCount { found: 0 }));
        assert_eq!(Grid::parse(&ROW.repeat(9)), Err(GridError::RowCount { found: 9 }));
    }

    #[test]
    fn a_mirrored_grid_answers_opposite_inputs_alike() {
        let rows = "NB NB NM NM NS ZO ZO\nNB NM NM NS NS ZO PS\nNM NM NS NS ZO PS PS\n\
                    NM NS NS ZO PS PS PM\nNS NS ZO PS PS PM PM\nNS ZO PS PS PM PM PB\nZO ZO PS PM PM PB PB\n";
        let grid = Grid::parse(rows).expect("seven rows of seven").mirrored();
        for error in Label::ALL {
            for change in Label::ALL {
                let opposite = grid.at(error.mirrored(), change.mirrored());
                assert_eq!(grid.at(error, change), opposite, "{error} {change}");
            }
        }
    }
}

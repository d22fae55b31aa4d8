//! What can be wrong with a distribution.

use std::fmt;

use fspid_diagnostics::digits::shortest;

/// Why a distribution could not be built, or nothing be drawn from it. Rows, columns, entries and
/// values of lists count from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum DispersionError {
    /// A number that is NaN or infinite.
    NotFinite {
        /// Which number.
        what: &'static str,
        /// What was found.
        value: f64,
    },
    /// A standard deviation that is not positive.
    StandardDeviation {
        /// What was found.
        value: f64,
    },
    /// Limits that are equal or the wrong way round.
    EmptyRange {
        /// The lower limit.
        lower: f64,
        /// The upper limit.
        upper: f64,
    },
    /// Values that no 64-bit floating point number holds.
    BeyondRange {
        /// Of which distribution.
        what: &'static str,
    },
    /// Limits between which there is nothing to draw.
    NothingInside {
        /// Mean of the distribution.
        mean: f64,
        /// Its standard deviation.
        standard_deviation: f64,
        /// The lower limit, or minus infinity.
        lower: f64,
        /// The upper limit, or infinity.
        upper: f64,
        /// The share of the distribution between them, as computed.
        probability: f64,
    },
    /// Limits of a logarithmic distribution that are not of one sign.
    TwoSigns {
        /// The lower limit.
        lower: f64,
        /// The upper limit.
        upper: f64,
    },
    /// A choice among no values.
    NoValues,
    /// More or fewer weights than values.
    Weights {
        /// Weights given.
        found: usize,
        /// Number of values.
        allowed: usize,
    },
    /// A weight that is negative or not finite.
    Weight {
        /// Of which value.
        index: usize,
        /// What was found.
        value: f64,
    },
    /// Weights that are all 0.
    NoWeight,
    /// A correlation matrix with another number of rows than there are entries.
    Rows {
        /// Rows given.
        found: usize,
        /// Number of entries.
        allowed: usize,
    },
    /// A row of the correlation matrix that is too long or too short.
    Columns {
        /// Which row.
        row: usize,
        /// Its length.
        found: usize,
        /// Number of entries.
        allowed: usize,
    },
    /// An entry of the diagonal that is not 1.
    Diagonal {
        /// Which one.
        row: usize,
        /// What was found.
        value: f64,
    },
    /// Something that is not a correlation.
    Correlation {
        /// Row in the matrix.
        row: usize,
        /// Column in the matrix.
        column: usize,
        /// What was found.
        value: f64,
    },
    /// Two entries of the matrix that should be the same.
    NotSymmetric {
        /// Row of the one, column of the other.
        row: usize,
        /// Column of the one, row of the other.
        column: usize,
        /// The one.
        value: f64,
        /// The other.
        mirrored: f64,
    },
    /// A correlation that contradicts others: the matrix is not positive semidefinite.
    Contradiction {
        /// Row in the matrix.
        row: usize,
        /// Column in the matrix, before the diagonal.
        column: usize,
        /// What was found.
        value: f64,
        /// The smallest value that goes with the rows above and with the columns before.
        lowest: f64,
        /// The largest one.
        highest: f64,
    },
    /// A point with another number of coordinates than the distribution takes.
    Coordinates {
        /// Coordinates given.
        found: usize,
        /// Coordinates that it takes.
        allowed: usize,
    },
    /// A coordinate outside the open unit interval.
    Coordinate {
        /// Which one.
        index: usize,
        /// What was found.
        value: f64,
    },
}

/// An end that is open stays what it is called in files.
fn told(value: f64) -> String {
    if value.is_finite() { shortest(value) } else { value.to_string() }
}

impl fmt::Display for DispersionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotFinite { what, value } => {
                write!(f, "the {what} is {value}; it must be a finite number")
            }
            Self::StandardDeviation { value } => {
                write!(f, "the standard deviation is {}; it must be above 0", shortest(value))
            }
            Self::EmptyRange { lower, upper } => {
                let [lower, upper] = [lower, upper].map(shortest);
                write!(f, "the limits are {lower} and {upper}; the lower one must come first")
            }
            Self::BeyondRange { what } => write!(
                f,
                "some values of the {what} lie beyond the range of 64-bit floating point numbers"
            ),
            Self::NothingInside { mean, standard_deviation, lower, upper, probability } => {
                let [mean, standard_deviation, lower, upper] =
                    [mean, standard_deviation, lower, upper].map(told);
                write!(
                    f,
                    "of a normal distribution with mean {mean} and standard deviation {standard_deviation} the share between {lower} and {upper} is {probability:e}; to be drawn from it must be at least {:e}",
                    super::standard_normal::LEAST_INSIDE
                )
            }
            Self::TwoSigns { lower, upper } => {
                let [lower, upper] = [lower, upper].map(shortest);
                write!(
                    f,
                    "the limits are {lower} and {upper}; for a logarithm both must be above 0 or both below"
                )
            }
            Self::NoValues => f.write_str("there is no value to choose; at least one is needed"),
            Self::Weights { found, allowed } => {
                write!(f, "there are {found} weights for {allowed} values; each needs one")
            }
            Self::Weight { index, value } => {
                write!(f, "weight {index} is {value}; it must be a finite number, 0 or above")
            }
            Self::NoWeight => f.write_str("all weights are 0; at least one must be above"),
            Self::Rows { .. }
            | Self::Columns { .. }
            | Self::Diagonal { .. }
            | Self::Correlation { .. }
            | Self::NotSymmetric { .. }
            | Self::Contradiction { .. } => self.of_the_matrix(f),
            Self::Coordinates { found, allowed } => {
                write!(f, "the point has {found} coordinates; {allowed} are needed")
            }
            Self::Coordinate { index, value } => {
                write!(
                    f,
                    "coordinate {index} is {value}; it must be between 0 and 1, both excluded"
                )
            }
        }
    }
}

impl DispersionError {
    /// What is wrong with a correlation matrix.
    fn of_the_matrix(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Rows { found, allowed } => write!(
                f,
                "the correlation matrix has {found} rows; the {allowed} entries need {allowed}"
            ),
            Self::Columns { row, found, allowed } => write!(
                f,
                "row {row} of the correlation matrix has {found} numbers; the {allowed} entries need {allowed}"
            ),
            Self::Diagonal { row, value } => {
                write!(f, "the correlation of entry {row} with itself is {value}; it must be 1")
            }
            Self::Correlation { row, column, value } => write!(
                f,
                "the correlation of entries {row} and {column} is {value}; it must be between -1 and 1"
            ),
            Self::NotSymmetric { row, column, value, mirrored } => write!(
                f,
                "the correlation of entries {row} and {column} is {value} in row {row} and {mirrored} in row {column}; both must be the same"
            ),
            Self::Contradiction { row, column, value, lowest, highest } => write!(
                f,
                "the correlation of entries {row} and {column} is {value}; with the rows above and the columns before it must be between {lowest:.6} and {highest:.6}"
            ),
            _ => Ok(()),
        }
    }
}

impl std::error::Error for DispersionError {}

#[cfg(test)]
mod tests {
    use super::super::{Choice, Correlated, Distribution, LogUniform, Normal, Uniform};
    use super::*;

    /// What was refused, as a sentence.
    fn refused<T>(built: Result<T, DispersionError>) -> String {
        built.err().unwrap().to_string()
    }

    fn standard() -> Normal {
        Normal::new(0.0, 1.0).unwrap()
    }

    fn joined(matrix: &[&[f64]]) -> Result<Correlated, DispersionError> {
        let matrix: Vec<Vec<f64>> = matrix.iter().map(|row| row.to_vec()).collect();
        Correlated::new(vec![standard(); 2], &matrix)
    }

    #[test]
    fn numbers_of_a_normal_distribution_are_refused_with_what_is_allowed() {
        for [mean, deviation] in [[f64::NAN, 1.0], [f64::INFINITY, 1.0], [0.0, f64::NAN]] {
            assert!(refused(Normal::new(mean, deviation)).contains("must be a finite number"));
        }
        for deviation in [0.0, -1.0] {
            let message = refused(Normal::new(0.0, deviation));
            assert_eq!(
                message,
                format!("the standard deviation is {deviation}; it must be above 0")
            );
        }
        assert!(refused(Normal::new(1e308, 1e307)).contains("beyond the range"));
        assert!(refused(standard().truncated(Some(f64::NAN), None)).contains("lower limit is NaN"));
        assert!(refused(standard().truncated(None, Some(f64::INFINITY))).contains("upper limit"));
        let message = refused(standard().truncated(Some(1.0), Some(1.0)));
        assert_eq!(message, "the limits are 1 and 1; the lower one must come first");
    }

    #[test]
    fn limits_with_nothing_between_them_are_refused_with_their_share() {
        let message = refused(standard().truncated(Some(40.0), Some(41.0)));
        let expected = "of a normal distribution with mean 0 and standard deviation 1 the share between 40 and 41 is 0e0; to be drawn from it must be at least 1e-300";
        assert_eq!(message, expected);
        assert!(refused(standard().truncated(None, Some(-38.0))).contains("between -inf and -38"));
        // Narrower than the digits of the shares.
        assert!(refused(standard().truncated(Some(-1e-17), Some(1e-17))).contains("is 0e0"));
    }

    #[test]
    fn limits_of_uniform_distributions_are_refused_with_what_is_allowed() {
        assert!(refused(Uniform::new(f64::NAN, 1.0)).contains("lower limit is NaN"));
        assert!(refused(Uniform::new(0.0, f64::NAN)).contains("upper limit is NaN"));
        assert!(refused(Uniform::new(2.0, 1.0)).contains("the limits are 2 and 1"));
        assert!(refused(Uniform::new(-1e308, 1e308)).contains("uniform distribution lie beyond"));
        assert!(refused(LogUniform::new(2.0, 1.0)).contains("the limits are 2 and 1"));
        for [lower, upper] in [[0.0, 1.0], [-1.0, 0.0], [-1.0, 1.0]] {
            let message = refused(LogUniform::new(lower, upper));
            let end = "for a logarithm both must be above 0 or both below";
            assert_eq!(message, format!("the limits are {lower} and {upper}; {end}"));
        }
        assert!(refused(LogUniform::new(5e-324, 1e308)).contains("beyond the range"));
    }

    #[test]
    fn weights_are_refused_with_what_is_allowed() {
        assert!(refused(Choice::new(0, None)).contains("at least one is needed"));
        let message = refused(Choice::new(3, Some(&[1.0])));
        assert_eq!(message, "there are 1 weights for 3 values; each needs one");
        for weight in [-1.0, f64::NAN, f64::INFINITY] {
            let message = refused(Choice::new(2, Some(&[1.0, weight])));
            let end = "it must be a finite number, 0 or above";
            assert_eq!(message, format!("weight 1 is {weight}; {end}"));
        }
        assert!(refused(Choice::new(2, Some(&[0.0, 0.0]))).contains("all weights are 0"));
        assert!(refused(Choice::new(2, Some(&[1e308, 1e308]))).contains("sum of the weights"));
    }

    #[test]
    fn a_matrix_that_is_none_of_correlations_is_refused_with_its_place() {
        let cases: [(&[&[f64]], &str); 8] = [
            (&[&[1.0, 0.0]], "the correlation matrix has 1 rows; the 2 entries need 2"),
            (
                &[&[1.0, 0.0], &[0.0]],
                "row 1 of the correlation matrix has 1 numbers; the 2 entries need 2",
            ),
            (
                &[&[1.0, 0.0], &[0.0, 2.0]],
                "the correlation of entry 1 with itself is 2; it must be 1",
            ),
            (
                &[&[f64::NAN, 0.0], &[0.0, 1.0]],
                "the correlation of entry 0 with itself is NaN; it must be 1",
            ),
            (
                &[&[1.0, 0.1], &[1.5, 1.0]],
                "the correlation of entries 1 and 0 is 1.5; it must be between -1 and 1",
            ),
            (
                &[&[1.0, f64::NAN], &[0.0, 1.0]],
                "the correlation of entries 0 and 1 is NaN; it must be between -1 and 1",
            ),
            (
                &[&[1.0, 0.1], &[0.2, 1.0]],
                "the correlation of entries 1 and 0 is 0.2 in row 1 and 0.1 in row 0; both must be the same",
            ),
            (
                &[&[1.0, 0.0, 0.0], &[0.0, 1.0]],
                "row 0 of the correlation matrix has 3 numbers; the 2 entries need 2",
            ),
        ];
        for (matrix, expected) in cases {
            assert_eq!(refused(joined(matrix)), expected);
        }
        assert!(refused(Correlated::new(Vec::new(), &[])).contains("at least one is needed"));
        let three = [vec![1.0, 0.9, -0.9], vec![0.9, 1.0, 0.9], vec![-0.9, 0.9, 1.0]];
        let message = refused(Correlated::new(vec![standard(); 3], &three));
        let expected = "the correlation of entries 2 and 1 is 0.9; with the rows above and the columns before it must be between -1.000000 and -0.620000";
        assert_eq!(message, expected);
    }

    #[test]
    fn a_point_outside_the_cube_is_refused_and_nothing_is_drawn() {
        let matrix: [&[f64]; 2] = [&[1.0, 0.5], &[0.5, 1.0]];
        let two = Distribution::Correlated(joined(&matrix).unwrap());
        let mut into = Vec::new();
        for u in [&[][..], &[0.5], &[0.5; 3]] {
            let message = refused(two.draw(u, &mut into));
            assert_eq!(message, format!("the point has {} coordinates; 2 are needed", u.len()));
        }
        for u in [0.0, 1.0, -0.1, f64::NAN] {
            let message = refused(two.draw(&[0.5, u], &mut into));
            let end = "it must be between 0 and 1, both excluded";
            assert_eq!(message, format!("coordinate 1 is {u}; {end}"));
        }
        assert!(into.is_empty());
    }
}

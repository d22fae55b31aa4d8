//! From first-order equations to the transfer function that books print.

use fspid_lti::{LtiError, Matrix, StateSpace, TransferFunction};

use crate::error::AircraftError;

/// Leading coefficients of a numerator below this part of what their terms could add up to are rounding.
const ROUNDING: f64 = 1e-13;

/// Transfer function from one input to one output, with a denominator that begins with 1.
///
/// $$ G(s) = \frac{C \operatorname{adj}(s I - A) B}{\det(s I - A)} + D $$
///
/// Both polynomials come from one recursion, so they agree with each other to rounding. Meant for some ten states:
/// with more, the coefficients of low powers lose digits. Leading coefficients of the numerator that are nothing but
/// rounding are dropped.
///
/// # Source
/// D. K. Faddeev and V. N. Faddeeva, Computational Methods of Linear Algebra, section 47 (method of Leverrier).
///
/// # Errors
/// An input or output that the system does not have; an output that the input does not reach.
pub fn transfer_function(
    system: &StateSpace,
    input: usize,
    output: usize,
) -> Result<TransferFunction, AircraftError> {
    let states = system.states();
    let column = part(system.b(), (0..states).map(|row| (row, input)), states, 1)?;
    let row = part(system.c(), (0..states).map(|column| (output, column)), 1, states)?;
    let gain = entry(system.d(), output, input)?;
    let mut denominator = vec![1.0];
    let mut numerator = vec![gain];
    let mut adjugate = Matrix::identity(states);
    for power in 1..=states {
        numerator.push(row.product(&adjugate)?.product(&column)?.data()[0]);
        let product = system.a().product(&adjugate)?;
        let coefficient = -trace(&product) / power as f64;
        adjugate = product.sum(&Matrix::identity(states).scaled(coefficient))?;
        denominator.push(coefficient);
        numerator[power] += gain * coefficient;
    }
    let reach = row.transpose().norm_one() * column.norm_one();
    let first = first_coefficient(&numerator, reach, system.a().norm_one());
    Ok(TransferFunction::new(&numerator[first..], &denominator)?)
}

fn part(
    matrix: &Matrix,
    positions: impl Iterator<Item = (usize, usize)>,
    rows: usize,
    columns: usize,
) -> Result<Matrix, LtiError> {
    let mut result = Matrix::zeros(rows, columns);
    for (index, (row, column)) in positions.enumerate() {
        result.set(index / columns, index % columns, entry(matrix, row, column)?)?;
    }
    Ok(result)
}

fn entry(matrix: &Matrix, row: usize, column: usize) -> Result<f64, LtiError> {
    let (rows, columns) = (matrix.rows(), matrix.columns());
    matrix.get(row, column).ok_or(LtiError::OutOfBounds { row, column, rows, columns })
}

fn trace(matrix: &Matrix) -> f64 {
    (0..matrix.rows())
        .filter_map(|index| matrix.get(index, index))
        .fold(0.0, |sum, value| sum + value)
}

/// Position of the first coefficient that is more than rounding; the last one if none is.
fn first_coefficient(numerator: &[f64], reach: f64, norm: f64) -> usize {
    let mut scale = 0.0;
    for (power, coefficient) in numerator.iter().enumerate() {
        if coefficient.abs() > ROUNDING * scale {
            return power;
        }
        scale = if power == 0 { reach } else { scale * norm };
    }
    numerator.len() - 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plant_survives_the_way_to_states_and_back() {
        let plant = TransferFunction::new(
            &[-1.69144, -0.84341, -0.0099096],
            &[1.0, 1.17103, 1.55405, 0.012538, 0.0072771],
        )
        .expect("the paper's 747");
        let back = transfer_function(&plant.to_state_space(), 0, 0).expect("one input, one output");
        assert_eq!(back.numerator().degree(), 2);
        let near = |found: &[f64], expected: &[f64]| {
            found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-14)
        };
        assert!(near(back.numerator().coefficients(), plant.numerator().coefficients()));
        assert!(near(back.denominator().coefficients(), plant.denominator().coefficients()));
    }

    #[test]
    fn a_feedthrough_is_part_of_the_numerator() {
        let lead = TransferFunction::new(&[2.0, 3.0], &[1.0, 5.0]).expect("a lead");
        let back = transfer_function(&lead.to_state_space(), 0, 0).expect("one input, one output");
        assert_eq!(back.numerator().coefficients(), [2.0, 3.0]);
    }

    #[test]
    fn inputs_that_are_not_there_or_reach_nothing_are_refused() {
        let a = Matrix::from_rows(&[[-1.0, 0.0], [0.0, -2.0]]).expect("square");
        let b = Matrix::from_rows(&[[1.0], [0.0]]).expect("a column");
        let system = StateSpace::new(a, b, Matrix::identity(2), Matrix::zeros(2, 1)).expect("fits");
        assert!(transfer_function(&system, 1, 0).is_err());
        assert!(transfer_function(&system, 0, 2).is_err());
        assert!(transfer_function(&system, 0, 1).is_err());
        assert!(transfer_function(&system, 0, 0).is_ok());
    }
}

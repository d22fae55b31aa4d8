//! Enclosures of the matrix exponential: against 120-digit values and laws of the exponential.

use fspid_lti::Matrix;
use fspid_numeric::scalar::Interval;
use fspid_proof::check::{IntervalMatrix, NotProved, exponential, held};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Half-widths that are allowed, as a part of the largest entry.
const WIDTH: f64 = 1e-13;

/// A matrix of the table with its exponential, rounded down.
struct Reference {
    name: String,
    inputs: usize,
    time_s: f64,
    entries: Vec<f64>,
    down: Vec<(f64, bool)>,
}

impl Reference {
    fn size(&self) -> usize {
        self.entries.len().isqrt()
    }

    fn part(&self, columns: std::ops::Range<usize>) -> IntervalMatrix {
        let states = self.size() - self.inputs;
        let rows: Vec<&[f64]> = self.entries.chunks(self.size()).take(states).collect();
        let rows: Vec<&[f64]> = rows.into_iter().map(|row| &row[columns.clone()]).collect();
        point(&Matrix::from_rows(&rows).expect("the table holds numbers"))
    }

    fn largest(&self) -> f64 {
        self.down.iter().fold(0.0, |largest, (down, _)| down.abs().max(largest))
    }

    /// Whether an entry lies where the table says that the true value lies.
    fn holds(&self, entry: Interval, row: usize, column: usize) -> bool {
        let (down, exact) = self.down[row * self.size() + column];
        let up = if exact { down } else { down.next_up() };
        entry.lower() <= down && entry.upper() >= up
    }
}

fn table() -> Vec<Reference> {
    let mut found: Vec<Reference> = Vec::new();
    for line in include_str!("data/exponential.csv").lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |field: usize| fields[field].parse::<f64>().expect("the table holds numbers");
        if found.last().is_none_or(|last| last.name != fields[0]) {
            found.push(Reference {
                name: fields[0].to_owned(),
                inputs: fields[1].parse().expect("a count"),
                time_s: number(2),
                entries: Vec::new(),
                down: Vec::new(),
            });
        }
        let last = found.last_mut().expect("just pushed");
        last.entries.push(number(5));
        last.down.push((number(6), fields[7] == "1"));
    }
    found
}

fn point(matrix: &Matrix) -> IntervalMatrix {
    IntervalMatrix::from(matrix)
}

#[test]
fn every_reference_exponential_is_enclosed_within_a_tenth_of_a_trillionth() {
    let table = table();
    assert_eq!(table.len(), 21);
    for reference in &table {
        let size = reference.size();
        let rows: Vec<&[f64]> = reference.entries.chunks(size).collect();
        let generator = point(&Matrix::from_rows(&rows).expect("the table holds numbers"));
        let found = exponential(&generator.scaled(Interval::point(reference.time_s)));
        let found = found.expect("within the range of floats");
        for (place, entry) in found.entries().enumerate() {
            let (row, column) = (place / size, place % size);
            let name = &reference.name;
            assert!(reference.holds(entry, row, column), "{name} {row} {column} {entry:?}");
        }
        let part = found.max_radius() / reference.largest();
        assert!(part < WIDTH, "{}: {part:e}", reference.name);
    }
}

#[test]
fn held_inputs_give_the_columns_of_the_exponential_in_relation_to_themselves() {
    for reference in table().iter().filter(|reference| reference.inputs == 1) {
        let states = reference.size() - 1;
        let (a, b) = (reference.part(0..states), reference.part(states..states + 1));
        let (phi, gamma) =
            held(&a, &b, Interval::point(reference.time_s)).expect("within the range of floats");
        for (matrix, from) in [(&phi, 0), (&gamma, states)] {
            let columns = matrix.columns();
            for (place, entry) in matrix.entries().enumerate() {
                let (row, column) = (place / columns, from + place % columns);
                let name = &reference.name;
                assert!(reference.holds(entry, row, column), "{name} {row} {column} {entry:?}");
            }
            let largest =
                matrix.entries().fold(0.0, |largest, entry| entry.magnitude().max(largest));
            assert!(matrix.max_radius() < WIDTH * largest, "{}", reference.name);
        }
    }
}

#[test]
fn a_zero_matrix_has_the_identity_and_a_zero_input_stays_zero() {
    let zeros = IntervalMatrix::zeros(3, 3);
    assert_eq!(exponential(&zeros), Ok(IntervalMatrix::identity(3)));
    let none = exponential(&IntervalMatrix::zeros(0, 0));
    assert_eq!(none, Ok(IntervalMatrix::zeros(0, 0)));
    let input = IntervalMatrix::zeros(3, 1);
    let (_, gamma) = held(&zeros, &input, Interval::ONE).expect("small");
    assert_eq!(gamma, input);
}

#[test]
fn what_has_no_bounds_or_no_square_shape_is_refused() {
    for bad in [f64::NAN, f64::INFINITY, 1e300] {
        let mut matrix = Matrix::identity(2);
        matrix.set(1, 0, bad).expect("the entry exists");
        let mut transposed = matrix.transpose();
        transposed.set(1, 0, bad).expect("the entry exists");
        let found = exponential(&point(&transposed));
        assert!(matches!(found, Err(NotProved::Unbounded { .. })), "{bad} {found:?}");
    }
    let overflow = exponential(&point(&Matrix::identity(1)).scaled(Interval::point(1e4)));
    assert!(matches!(overflow, Err(NotProved::Unbounded { .. })));
    assert!(matches!(exponential(&IntervalMatrix::zeros(2, 3)), Err(NotProved::Shape(_))));
    let a = IntervalMatrix::zeros(2, 2);
    assert!(held(&a, &IntervalMatrix::zeros(1, 1), Interval::ONE).is_err());
    assert!(held(&a, &IntervalMatrix::zeros(2, 1), Interval::point(f64::NAN)).is_err());
    let ones = IntervalMatrix::identity(2);
    assert!(held(&ones, &IntervalMatrix::zeros(2, 1), Interval::ENTIRE).is_err());
}

#[test]
fn an_uncertain_time_encloses_the_exponentials_at_both_ends_and_between() {
    let a = point(&Matrix::from_rows(&[[0.0, 1.0], [-4.0, -0.4]]).expect("square"));
    let whole = exponential(&a.scaled(Interval::between(0.1, 0.1001))).expect("small");
    for time_s in [0.1, 0.10003, 0.1001] {
        let inner = exponential(&a.scaled(Interval::point(time_s))).expect("small");
        assert!(whole.encloses(&inner), "{time_s}");
    }
    assert!(whole.max_radius() < 1e-3);
}

#[test]
fn inputs_of_any_size_are_held_as_small_ones_are_to_the_bit() {
    let a = point(&Matrix::from_rows(&[[0.0, 1.0], [-4.0, -0.4]]).expect("square"));
    let b = Matrix::from_rows(&[[0.3, 0.0], [0.7, 0.0]]).expect("finite");
    let (_, small) = held(&a, &point(&b), Interval::point(0.1)).expect("small");
    for exponent in [-60.0, 20.0, 60.0, 300.0] {
        let factor = libm::exp2(exponent);
        let (_, found) = held(&a, &point(&b.scaled(factor)), Interval::point(0.1)).expect("finite");
        assert_eq!(found, small.scaled(Interval::point(factor)), "{exponent}");
    }
}

#[test]
fn a_motion_is_enclosed_up_to_sixty_squarings_and_refused_beyond() {
    let shear = |size: f64| Matrix::from_rows(&[[0.0, size], [0.0, 0.0]]).expect("finite");
    let largest = libm::exp2(57.0);
    let found = exponential(&point(&shear(largest))).expect("sixty squarings");
    let expected = Matrix::from_rows(&[[1.0, largest], [0.0, 1.0]]).expect("finite");
    assert!(found.contains(&expected), "{found:?}");
    let beyond = exponential(&point(&shear(2.0 * largest)));
    assert!(matches!(beyond, Err(NotProved::Unbounded { .. })), "{beyond:?}");
    let gone = exponential(&point(&Matrix::identity(1).scaled(-1e21)));
    assert!(matches!(gone, Err(NotProved::Unbounded { .. })), "{gone:?}");
}

fn repeatable() -> ProptestConfig {
    ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(2026),
        cases: 200,
        ..ProptestConfig::default()
    }
}

fn square() -> impl Strategy<Value = Matrix> {
    (1_usize..7, -3.0..3.0_f64).prop_flat_map(|(size, power)| {
        let scale = libm::exp10(power) / size as f64;
        prop::collection::vec(-scale..scale, size * size).prop_map(move |entries| {
            let rows: Vec<&[f64]> = entries.chunks(size).collect();
            Matrix::from_rows(&rows).expect("finite")
        })
    })
}

proptest! {
    #![proptest_config(repeatable())]

    #[test]
    fn the_exponential_times_that_of_the_negative_holds_the_identity(matrix in square()) {
        // Beyond that a product of both says nothing any more.
        prop_assume!(matrix.norm_one() < 20.0);
        let forth = exponential(&point(&matrix)).expect("small");
        let back = exponential(&point(&matrix.scaled(-1.0))).expect("small");
        let product = forth.product(&back).expect("square");
        prop_assert!(product.encloses(&IntervalMatrix::identity(matrix.rows())), "{product:?}");
    }

    #[test]
    fn the_exponential_in_floats_lies_inside_but_for_its_own_rounding(matrix in square()) {
        prop_assume!(matrix.norm_one() < 100.0);
        let found = exponential(&point(&matrix)).expect("within range");
        let float = fspid_lti::exponential(&matrix).expect("within range");
        let largest = float.data().iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        // The backward error of the Padé fraction, 2^-53 of the norm, moves a mode by that much.
        let own = 1e-15 * largest * (1.0 + 10.0 * matrix.norm_one());
        for (entry, value) in found.entries().zip(float.data()) {
            let near = entry.lower() <= value + own && entry.upper() >= value - own;
            prop_assert!(near, "{entry:?} {value}");
        }
    }

    #[test]
    fn a_wide_matrix_encloses_the_exponential_of_a_matrix_inside(
        matrix in square(), parts in prop::collection::vec(0.0..=1.0_f64, 36)
    ) {
        prop_assume!(matrix.norm_one() < 20.0);
        let spread = |value: &f64| Interval::between(0.99 * value, value + 1e-3);
        let size = matrix.rows();
        let wide: Vec<Vec<Interval>> =
            matrix.data().chunks(size).map(|row| row.iter().map(spread).collect()).collect();
        let inside: Vec<f64> = wide.iter().flatten().zip(&parts)
            .map(|(entry, part)| entry.lower().max(entry.upper().min(entry.lower() + part * entry.width())))
            .collect();
        let rows: Vec<&[f64]> = inside.chunks(size).collect();
        let inside = exponential(&point(&Matrix::from_rows(&rows).expect("finite"))).expect("small");
        let whole = exponential(&IntervalMatrix::from_rows(&wide).expect("square")).expect("small");
        // Both hold the true exponential of the matrix inside.
        for (whole, inside) in whole.entries().zip(inside.entries()) {
            prop_assert!(whole.intersection(inside).is_some());
        }
        prop_assert!(whole.encloses(&inside));
    }

    #[test]
    fn twice_the_time_is_the_square(matrix in square()) {
        prop_assume!(matrix.norm_one() < 10.0);
        let once = exponential(&point(&matrix)).expect("small");
        let twice = exponential(&point(&matrix.scaled(2.0))).expect("small");
        for (square, twice) in once.product(&once).expect("square").entries().zip(twice.entries()) {
            prop_assert!(square.intersection(twice).is_some(), "{square:?} {twice:?}");
        }
    }
}

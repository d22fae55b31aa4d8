//! Rules that conclude numbers: by hand, against the general engine, and what is refused.
#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

#[cfg(feature = "alloc")]
use fspid_fuzzy::system::{Parts, System};
use fspid_fuzzy::{
    FuzzyError, Increments, LABEL_COUNT, NumberGrid, NumberTable, OutOfRange, Output, Supervisor,
};

const ZEROS: NumberGrid<f64> = [[0.0; LABEL_COUNT]; LABEL_COUNT];

/// Numbers that look as if they were drawn, from -3 to 3; each cell has its own.
fn drawn(seed: usize) -> NumberGrid<f64> {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            (((i * 7 + j) * 7919 + seed * 104_729) % 6001) as f64 / 1000.0 - 3.0
        })
    })
}

fn supervisor(grids: [NumberGrid<f64>; 3], policy: OutOfRange) -> Supervisor<f64> {
    let table = NumberTable::new(grids).expect("finite");
    Supervisor::of_numbers(&table, 3.0, policy).expect("allowed")
}

fn delta(supervisor: &Supervisor<f64>, error: f64, change: f64) -> [f64; 3] {
    let Increments { kp, ki, kd } = supervisor.infer(error, change).expect("finite").delta;
    [kp, ki, kd]
}

#[test]
fn an_answer_is_the_bilinear_interpolation_of_the_four_numbers_around() {
    let mut kp = ZEROS;
    // Between NS and ZO of the error (-1 and 0), PS and PM of the change (1 and 2).
    (kp[2][4], kp[2][5], kp[3][4], kp[3][5]) = (1.0, 2.0, -1.0, 3.0);
    let supervisor = supervisor([kp, ZEROS, drawn(1)], OutOfRange::Clamp);
    // By hand: along the change 0.75*1 + 0.25*2 = 1.25 and 0.75*-1 + 0.25*3 = 0; 0.5*1.25 + 0.5*0.
    assert_eq!(delta(&supervisor, -0.5, 1.25)[..2], [0.625, 0.0]);
    // Next door each of them fades on its own: 0.5 * (0.5 * 2) from cell (NS, PM) alone.
    assert_eq!(delta(&supervisor, -1.5, 2.5)[0], 0.5);
}

#[test]
fn at_the_centres_of_sets_the_answer_is_the_number_of_the_cell() {
    let grids = [drawn(1), drawn(2), drawn(3)];
    let supervisor = supervisor(grids, OutOfRange::Clamp);
    for i in 0..LABEL_COUNT {
        for j in 0..LABEL_COUNT {
            let (error, change) = (i as f64 - 3.0, j as f64 - 3.0);
            assert_eq!(delta(&supervisor, error, change), grids.map(|grid| grid[i][j]));
        }
    }
}

#[cfg(feature = "alloc")]
#[test]
fn numbers_answer_as_the_same_system_of_takagi_and_sugeno_in_the_general_engine() {
    for policy in OutOfRange::ALL {
        let fixed = supervisor([drawn(4), drawn(5), drawn(6)], policy);
        let general = System::new(Parts::try_from(&fixed).expect("rules")).expect("allowed");
        let mut workspace = general.workspace();
        for n in 0..2000 {
            let reach = if policy == OutOfRange::Error { 3.0 } else { 4.0 };
            let error = reach * libm::sin(f64::from(n) * 0.37);
            let change = reach * libm::cos(f64::from(n) * 0.73 + 1.0);
            let answers = general.evaluate(&[error, change], &mut workspace).expect("finite");
            for (answer, own) in answers.iter().zip(delta(&fixed, error, change)) {
                let general = answer.value.expect("rules fire");
                // Grades are rounded differently; 1e-12 is some thousand times that, at numbers to 3.
                assert!((general - own).abs() < 1e-12, "{error} {change}: {general} {own}");
            }
        }
    }
}

#[test]
fn symmetric_numbers_answer_opposite_inputs_with_the_same_bits() {
    let mut grid = drawn(7);
    for i in 0..LABEL_COUNT {
        for j in 0..LABEL_COUNT {
            grid[6 - i][6 - j] = grid[i][j];
        }
    }
    let supervisor = supervisor([grid; 3], OutOfRange::Clamp);
    for n in 0..1000 {
        let (error, change) = (3.3 * libm::sin(f64::from(n)), 3.3 * libm::cos(f64::from(2 * n)));
        assert_eq!(delta(&supervisor, error, change), delta(&supervisor, -error, -change));
    }
}

#[test]
fn beyond_the_range_the_outermost_sets_are_level_or_the_input_is_refused() {
    let grids = [drawn(1), drawn(2), drawn(3)];
    let inside = delta(&supervisor(grids, OutOfRange::Clamp), 3.0, -1.3);
    for (policy, clamped) in [(OutOfRange::Clamp, true), (OutOfRange::Evaluate, false)] {
        let answer = supervisor(grids, policy).infer(1e300, -1.3).expect("finite");
        assert_eq!([answer.delta.kp, answer.delta.ki, answer.delta.kd], inside);
        assert_eq!((answer.clamped, answer.underflowed), (clamped, false));
    }
    assert!(supervisor(grids, OutOfRange::Error).infer(3.1, 0.0).is_err());
    for policy in OutOfRange::ALL {
        assert!(supervisor(grids, policy).infer(f64::NAN, 0.0).is_err());
    }
}

#[test]
fn the_grades_of_an_input_sum_to_one_and_only_neighbours_have_any() {
    let supervisor = supervisor([ZEROS; 3], OutOfRange::Clamp);
    assert_eq!(supervisor.grades(-1.25), [0.0, 0.25, 0.75, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!(supervisor.grades(7.0), [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
}

/// Doubling is exact: over twice the range the same cells answer twice the inputs, to the bit.
#[test]
fn over_twice_the_range_twice_the_inputs_have_the_same_grades_and_the_same_answer() {
    let grids = [drawn(1), drawn(2), drawn(3)];
    let table = NumberTable::new(grids).expect("finite");
    let narrow = supervisor(grids, OutOfRange::Clamp);
    let wide = Supervisor::of_numbers(&table, 6.0, OutOfRange::Clamp).expect("allowed");
    for n in 0..1000 {
        let (error, change) = (3.3 * libm::sin(f64::from(n)), 3.3 * libm::cos(f64::from(2 * n)));
        assert_eq!(wide.grades(2.0 * error), narrow.grades(error), "{error}");
        assert_eq!(delta(&wide, 2.0 * error, 2.0 * change), delta(&narrow, error, change));
    }
}

#[test]
fn rules_that_conclude_numbers_tell_them_and_no_labels() {
    let table = NumberTable::new([drawn(1), drawn(2), drawn(3)]).expect("finite");
    let supervisor = Supervisor::of_numbers(&table, 3.0, OutOfRange::Clamp).expect("allowed");
    assert_eq!(supervisor.numbers(), Some(&table));
    assert!(supervisor.table().is_none() && supervisor.network().is_none());
    assert!(!supervisor.has_labels());
}

#[test]
fn numbers_that_are_none_or_beyond_the_range_are_refused_with_their_cell() {
    for bad in [f64::NAN, f64::INFINITY] {
        let mut grid = ZEROS;
        grid[1][4] = bad;
        let error = NumberTable::new([ZEROS, grid, ZEROS]).expect_err("not finite").to_string();
        assert!(error.starts_with("delta_ki: the number in row 2, column 5 is "), "{error}");
    }
    let mut grid = ZEROS;
    grid[6][0] = -3.5;
    let table = NumberTable::new([ZEROS, ZEROS, grid]).expect("finite");
    let (output, row, column, found, allowed) = (Output::DeltaKd, 7, 1, -3.5, 3.0);
    assert_eq!(
        Supervisor::of_numbers(&table, 3.0, OutOfRange::Clamp),
        Err(FuzzyError::Number { output, row, column, found, allowed })
    );
    assert!(Supervisor::of_numbers(&table, 3.5, OutOfRange::Clamp).is_ok());
    assert!(Supervisor::of_numbers(&table, f64::NAN, OutOfRange::Clamp).is_err());
}

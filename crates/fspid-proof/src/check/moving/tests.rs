//! Scalar loops and forms, whose decrease is known in closed form.

use super::*;

fn scalars(values: &[f64]) -> Vec<Matrix> {
    values.iter().map(|&value| Matrix::identity(1).scaled(value)).collect()
}

/// Cells and matrices of a scalar loop $m_0 + \sum m_j \kappa_j$ with a form of the same shape.
fn prove(loops: &[f64], forms: &[f64], changes: &[f64]) -> Result<MovingProof, NotProvedAt> {
    let loops: Vec<IntervalMatrix> = scalars(loops).iter().map(IntervalMatrix::from).collect();
    let forms = scalars(forms);
    let moving = Moving { loops: &loops, forms: &forms, changes, rate: 1.0 };
    falls_while_moving(&moving, |cell| Some(cell.clone()))
}

#[test]
fn weights_are_those_of_the_powers_between_the_ends() {
    // (x + 2)³ between -0.5 and 0.25: the polar form is the product of (x_i + 2).
    let table = weights([-0.5, 0.25]);
    for (b, product) in [1.5 * 1.5 * 1.5, 1.5 * 1.5 * 2.25, 1.5 * 2.25 * 2.25, 2.25 * 2.25 * 2.25]
        .into_iter()
        .enumerate()
    {
        let found = 8.0 * table[0][b] + 12.0 * table[1][b] + 6.0 * table[2][b] + table[3][b];
        assert!((found - 3.0 * product).abs() < 1e-14, "{found} {product}");
    }
}

#[test]
fn a_scalar_loop_falls_where_its_modulus_is_below_one() {
    assert!(prove(&[0.0, 0.999], &[1.0, 0.0], &[1.0]).is_ok());
    let failed = prove(&[0.0, 1.001], &[1.0, 0.0], &[1.0]).expect_err("grows at the ends");
    assert!(failed.gains[0].abs() > 0.9, "{failed:?}");
    assert!(prove(&[0.0, 0.4, 0.3, -0.2], &[1.0; 1], &[0.1]).is_err());
    assert!(prove(&[0.0, 0.4, 0.3, -0.2], &[1.0, 0.0, 0.0, 0.0], &[0.1; 3]).is_ok());
}

#[test]
fn a_form_that_moves_too_much_for_the_motion_does_not_fall() {
    // 1 + 0.9 κ rises from 0.1 to 0.37 as κ leaves -1 by 0.3, and the loop keeps 0.94 of it.
    assert!(prove(&[0.97, 0.0], &[1.0, 0.9], &[0.0]).is_ok());
    assert!(prove(&[0.97, 0.0], &[1.0, 0.9], &[0.003]).is_ok());
    assert!(prove(&[0.97, 0.0], &[1.0, 0.9], &[0.3]).is_err());
}

#[test]
fn a_form_that_is_not_positive_somewhere_is_refused() {
    assert!(prove(&[0.1, 0.0], &[1.0, 1.01], &[0.0]).is_err());
    assert!(prove(&[0.1, 0.0], &[1.0, 0.99], &[0.0]).is_ok());
}

#[test]
fn gains_outside_of_the_set_are_not_asked_for() {
    let loops: Vec<IntervalMatrix> =
        scalars(&[0.5, 0.6]).iter().map(IntervalMatrix::from).collect();
    let forms = scalars(&[1.0, 0.0]);
    let moving = Moving { loops: &loops, forms: &forms, changes: &[2.0], rate: 1.0 };
    assert!(falls_while_moving(&moving, |cell| Some(cell.clone())).is_err());
    let below = |most: f64| {
        move |cell: &Ends| (cell[0][0] <= most).then(|| vec![[cell[0][0], cell[0][1].min(most)]])
    };
    let proof = falls_while_moving(&moving, below(0.83)).expect("0.5 + 0.6 * 0.83 = 0.998");
    let most = proof.cells.iter().map(|cell| cell[0][1]).fold(-1.0, f64::max);
    assert!((0.83..0.8303).contains(&most), "{most}");
    assert!(falls_while_moving(&moving, below(0.834)).is_err(), "1.0004");
}

#[test]
fn what_does_not_fit_is_refused() {
    for changes in [vec![f64::NAN], vec![-0.1], vec![], vec![0.1, 0.1]] {
        assert!(prove(&[0.5, 0.0], &[1.0, 0.0], &changes).is_err(), "{changes:?}");
    }
    assert!(prove(&[f64::NAN, 0.0], &[1.0, 0.0], &[0.1]).is_err());
    assert!(prove(&[0.5, 0.0], &[1.0, f64::INFINITY], &[0.1]).is_err());
    assert!(prove(&[0.5, 0.0], &[-1.0, 0.0], &[0.1]).is_err());
}

/// The same with a rate and a set.
fn prove_part(
    (loops, forms, changes): (&[f64], &[f64], &[f64]),
    rate: f64,
    part: impl Fn(&Ends) -> Option<Ends>,
) -> Result<MovingProof, NotProvedAt> {
    let loops: Vec<IntervalMatrix> = scalars(loops).iter().map(IntervalMatrix::from).collect();
    let forms = scalars(forms);
    falls_while_moving(&Moving { loops: &loops, forms: &forms, changes, rate }, part)
}

#[test]
fn the_form_must_fall_by_the_rate_that_is_claimed() {
    let still = (&[0.9, 0.0][..], &[1.0, 0.0][..], &[0.1][..]);
    assert!(prove_part(still, 0.91, |cell| Some(cell.clone())).is_ok());
    assert!(prove_part(still, 0.89, |cell| Some(cell.clone())).is_err());
}

#[test]
fn a_form_that_is_negative_shows_nothing_of_a_loop_that_grows() {
    // From -1 to -0.75 the form is -1 to -0.5, and four times as much after a step is less.
    let below =
        |cell: &Ends| (cell[0][0] <= -0.75).then(|| vec![[cell[0][0], cell[0][1].min(-0.75)]]);
    let found = prove_part((&[2.0, 0.0], &[1.0, 2.0], &[0.0]), 1.0, below);
    assert!(found.is_err(), "{found:?}");
}

#[test]
fn both_ends_of_every_gain_count() {
    for gain in 1..=3 {
        for side in [0.51, -0.51] {
            let mut loops = [0.5, 0.0, 0.0, 0.0];
            loops[gain] = side;
            let found = prove(&loops, &[1.0, 0.0, 0.0, 0.0], &[0.1; 3]);
            assert!(found.is_err(), "1.01 at one end of gain {gain}");
            loops[gain] = 0.98 * side;
            assert!(prove(&loops, &[1.0, 0.0, 0.0, 0.0], &[0.1; 3]).is_ok(), "0.9998");
        }
    }
}

#[test]
fn gains_may_move_all_at_once_each_to_either_side() {
    // At the corner where the form is 0.1 each move adds its part; only all together add too much for half of it.
    let m = 0.5_f64.sqrt();
    for signs in 0..4 {
        let side = |gain: usize| if signs >> gain & 1 == 1 { -0.45 } else { 0.45 };
        let forms = [1.0, side(0), side(1)];
        assert!(prove(&[m, 0.0, 0.0], &forms, &[0.1; 2]).is_ok());
        assert!(prove(&[m, 0.0, 0.0], &forms, &[0.16; 2]).is_err(), "{forms:?}");
    }
    for signs in 0..8 {
        let side = |gain: usize| if signs >> gain & 1 == 1 { -0.3 } else { 0.3 };
        let forms = [1.0, side(0), side(1), side(2)];
        assert!(prove(&[m, 0.0, 0.0, 0.0], &forms, &[0.1; 3]).is_ok());
        assert!(prove(&[m, 0.0, 0.0, 0.0], &forms, &[0.14; 3]).is_err(), "{forms:?}");
    }
}

#[test]
fn a_gain_that_may_move_by_half_a_width_jumps() {
    // From -1, where the form is 0.5, to 1, where it is 1.5, and 0.4 of it after the step.
    let m = 0.4_f64.sqrt();
    assert!(prove(&[m, 0.0], &[1.0, 0.5], &[0.99]).is_ok(), "to 0 at most");
    for change in [1.0, 2.0, f64::INFINITY] {
        assert!(prove(&[m, 0.0], &[1.0, 0.5], &[change]).is_err(), "{change}");
        assert!(prove(&[0.57, 0.0], &[1.0, 0.5], &[change]).is_ok(), "a third of it");
    }
}

#[test]
fn cells_are_halved_until_they_hold_little_but_the_set() {
    // The loop is 0.5 where both gains are equal, and grows where they are 0.56 apart.
    let equal = |cell: &Ends| {
        let both = [cell[0][0].max(cell[1][0]), cell[0][1].min(cell[1][1])];
        (both[0] < both[1]).then(|| vec![both; 2])
    };
    let proof = prove_part((&[0.5, 0.9, -0.9], &[1.0, 0.0, 0.0], &[0.1; 2]), 1.0, equal);
    let mut cells = proof.expect("0.95 at most in a quarter of the box").cells;
    cells.sort_by(|one, other| one[0][0].total_cmp(&other[0][0]));
    let quarter = |lower: f64| vec![[lower, lower + 0.5]; 2];
    assert_eq!(cells, [-1.0, -0.5, 0.0, 0.5].map(quarter));
}

#[test]
fn a_proof_counts_its_matrices_and_a_failure_names_the_middle_of_its_cell() {
    // Form and coefficients at 2 ends, at 4 coefficients; then at 4 corners and 16.
    let one = prove(&[0.5, 0.1], &[1.0, 0.0], &[0.1]).expect("small");
    assert_eq!((one.cells.len(), one.inequalities), (1, 2 + 4 * 2));
    let two = prove(&[0.5, 0.1, 0.1], &[1.0, 0.0, 0.0], &[0.1; 2]).expect("small");
    assert_eq!((two.cells.len(), two.inequalities), (1, 4 + 16 * 4));
    let equal = |cell: &Ends| {
        let both = [cell[0][0].max(cell[1][0]), cell[0][1].min(cell[1][1])];
        (both[0] < both[1]).then(|| vec![both; 2])
    };
    let four = prove_part((&[0.5, 0.9, -0.9], &[1.0, 0.0, 0.0], &[0.1; 2]), 1.0, equal);
    assert_eq!(four.expect("halved").inequalities, 4 * (4 + 16 * 4));
    // 1.001 at the end, and less than 1 in the middle of the last cell before it, which is 1/64 wide.
    let failed = prove(&[0.0, 1.001], &[1.0, 0.0], &[0.1]).expect_err("grows at the end");
    assert_eq!(failed.gains, [1.0 - 1.0 / 128.0]);
}

#[test]
fn what_is_needed_of_a_cell_lies_on_the_grid_and_within_the_cell() {
    let whole = vec![[0.0, 1.0]];
    assert_eq!(on_grid(&whole, &vec![[0.25, 0.5]]), [[0.25, 0.5]]);
    let outward = [1024.0 / 4096.0, 2049.0 / 4096.0];
    assert_eq!(on_grid(&whole, &vec![[0.2501, 0.5001]]), [outward]);
    for other in [[-0.5, 0.5], [0.5, 1.5], [f64::NAN, 0.5], [0.5, f64::NAN]] {
        assert_eq!(on_grid(&whole, &vec![other]), whole, "{other:?}");
    }
    assert_eq!(on_grid(&whole, &Vec::new()), whole);
}

#[test]
fn fewer_cells_are_looked_at_of_larger_loops() {
    assert_eq!(most_cells(3, 1), MOST_CELLS);
    assert_eq!(most_cells(3, 40), 4_000_000_000 / (64 * 64_000));
    assert_eq!((most_cells(3, 10_000), most_cells(3, usize::MAX)), (1, 1));
}

#[test]
fn parts_that_are_not_as_many_as_the_gains_are_refused() {
    let refused = |loops: usize, forms: usize, gains: usize| {
        let (loops, forms) = (vec![0.1; loops], vec![1.0; forms]);
        prove(&loops, &forms, &vec![0.1; gains]).expect_err("refused").reason
    };
    for (loops, forms, gains) in [(3, 2, 1), (2, 3, 1), (1, 2, 1), (2, 1, 1), (5, 5, 4)] {
        let (found, allowed) = ((loops, forms), (gains + 1, gains + 1));
        let expected = LtiError::Shape { what: "loops and forms", found, allowed };
        assert_eq!(refused(loops, forms, gains), NotProved::Shape(expected));
    }
}

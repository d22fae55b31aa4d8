//! What a disturbance adds within a sample, against signals that are computed.

use fspid_lti::Matrix;
use fspid_numeric::scalar::Interval;
use fspid_proof::check::{IntervalMatrix, NotProved, driven, exponential};

const DT_S: f64 = 0.02;
/// Parts of a sample, each with its own value.
const PARTS: usize = 400;

fn points(rows: &[Vec<f64>]) -> IntervalMatrix {
    let rows: Vec<Vec<Interval>> =
        rows.iter().map(|row| row.iter().map(|it| Interval::point(*it)).collect()).collect();
    IntervalMatrix::from_rows(&rows).expect("a matrix")
}

/// Pitch and its derivatives of the paper's Navion, and what its elevator adds to them.
fn plant() -> (IntervalMatrix, IntervalMatrix) {
    let a = [vec![0.0, 1.0, 0.0], vec![0.0, 0.0, 1.0], vec![0.0, -12.941, -4.9676]];
    let b = [vec![0.0], vec![-11.7304], vec![35.69]];
    (points(&a), points(&b))
}

/// What each part of a sample adds to the state at its end, from the first on, per unit of the disturbance.
fn additions() -> Vec<Matrix> {
    let (a, b) = plant();
    let length_s = DT_S / PARTS as f64;
    let add = |part: usize| {
        // In the middle of the part: off by its square.
        let left_s = DT_S - (part as f64 + 0.5) * length_s;
        let moved = exponential(&a.scaled(Interval::point(left_s))).expect("a motion");
        moved.product(&b).expect("fits").midpoint().scaled(length_s)
    };
    (0..PARTS).map(add).collect()
}

/// $|u|^2$ of what a signal adds, over its energy.
fn share(factor: &Matrix, signal: &[f64], additions: &[Matrix]) -> f64 {
    let mut sum = [0.0; 3];
    for (value, column) in signal.iter().zip(additions) {
        sum.iter_mut().zip(column.data()).for_each(|(sum, it)| *sum += value * it);
    }
    let column: Vec<[f64; 1]> = sum.iter().map(|it| [*it]).collect();
    let u = factor.solve(&Matrix::from_rows(&column).expect("finite")).expect("regular");
    let energy = signal.iter().map(|it| it * it).sum::<f64>() * DT_S / PARTS as f64;
    u.data().iter().map(|it| it * it).sum::<f64>() / energy
}

#[test]
fn no_signal_within_a_sample_adds_more_than_its_energy_and_the_worst_nearly_as_much() {
    let (a, b) = plant();
    let factor = driven(&a, &b, Interval::point(DT_S)).expect("proved");
    let additions = additions();
    let at = |part: usize| (part as f64 + 0.5) / PARTS as f64;
    let mut shares = Vec::new();
    for power in 0..4 {
        let signal: Vec<f64> =
            (0..PARTS).map(|part| libm::pow(at(part), f64::from(power))).collect();
        shares.push(share(&factor, &signal, &additions));
        let waves = f64::from(1 + 3 * power);
        let signal: Vec<f64> =
            (0..PARTS).map(|part| libm::sin(core::f64::consts::TAU * waves * at(part))).collect();
        shares.push(share(&factor, &signal, &additions));
        let signal: Vec<f64> = (0..PARTS).map(|part| f64::from(u8::from(part % 40 < 7))).collect();
        shares.push(share(&factor, &signal, &additions));
    }
    // Along each state the signal that adds most to it is the way from the disturbance to that state.
    for state in 0..3 {
        let signal: Vec<f64> = additions.iter().map(|it| it.data()[state]).collect();
        let worst = share(&factor, &signal, &additions);
        assert!(worst > 0.99, "{worst}");
        shares.push(worst);
    }
    // What parts in the middle leave is below a millionth.
    assert!(shares.iter().all(|share| *share <= 1.0 + 1e-6), "{shares:?}");
}

#[test]
fn a_disturbance_without_a_way_in_and_what_has_no_bounds_are_refused() {
    let (a, b) = plant();
    let time = Interval::point(DT_S);
    let none = driven(&a, &points(&[vec![0.0], vec![0.0], vec![0.0]]), time);
    assert!(matches!(none, Err(NotProved::Number { .. })), "{none:?}");
    assert!(driven(&a, &points(&[vec![1.0], vec![0.0]]), time).is_err());
    assert!(driven(&b, &b, time).is_err());
    assert!(driven(&a, &points(&[vec![f64::NAN], vec![0.0], vec![0.0]]), time).is_err());
    assert!(driven(&a, &b, Interval::ENTIRE).is_err());
    assert!(driven(&a, &b, Interval::point(DT_S).hull(Interval::point(1.001 * DT_S))).is_err());
}

#[test]
fn units_of_states_change_what_is_added_and_nothing_else() {
    let (a, b) = plant();
    let time = Interval::point(DT_S);
    let unit = [libm::exp2(-15.0), 1.0, libm::exp2(15.0)];
    let rows = |matrix: &IntervalMatrix, over: &dyn Fn(usize) -> f64| -> Vec<Vec<f64>> {
        let rows = matrix.midpoint();
        let entry = |row: usize, column: usize| {
            rows.get(row, column).expect("exists") * unit[row] / over(column)
        };
        (0..3).map(|row| (0..matrix.columns()).map(|column| entry(row, column)).collect()).collect()
    };
    let (turned_a, turned_b) = (points(&rows(&a, &|at| unit[at])), points(&rows(&b, &|_| 1.0)));
    let plain = driven(&a, &b, time).expect("proved");
    let turned = driven(&turned_a, &turned_b, time).expect("proved");
    for (place, (plain, turned)) in plain.data().iter().zip(turned.data()).enumerate() {
        let expected = plain * unit[place / 3];
        let largest = plain.abs().max(1e-12) * unit[place / 3];
        assert!((turned - expected).abs() <= 1e-6 * largest, "{place} {turned:e} {expected:e}");
    }
}

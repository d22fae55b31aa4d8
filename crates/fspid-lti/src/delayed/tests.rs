//! Loops whose dead times are states, beside the same without.

use super::*;
use crate::eigenvalues::eigenvalues;
use crate::modulus;

/// Numbers of a counter between -1 and 1.
struct Drawn(u64);

impl Drawn {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// A loop of a few states near 1, as a plant that is sampled fast has, and ways back.
fn drawn(
    drawn: &mut Drawn,
    order: usize,
    samples: &[usize],
) -> (Matrix, Vec<f64>, Vec<DelayedPath>) {
    let (spread, own) = (0.3 * drawn.next().abs(), 0.99 * drawn.next().abs());
    let entries: Vec<f64> = (0..order * order).map(|_| spread * drawn.next()).collect();
    let a = Matrix::from_function(order, order, |row, column| {
        entries[row * order + column] + if row == column { own } else { 0.0 }
    });
    let b = (0..order).map(|_| drawn.next()).collect();
    let gain = 0.5 * drawn.next().abs();
    let path = |&samples: &usize| DelayedPath {
        row: (0..order).map(|_| gain * drawn.next()).collect(),
        samples,
    };
    (a, b, samples.iter().map(path).collect())
}

/// The loop with a state for each sample of each way back.
fn with_states(a: &Matrix, b: &[f64], paths: &[DelayedPath]) -> Matrix {
    let order = a.rows();
    let size = order + paths.iter().map(|path| path.samples).sum::<usize>();
    let mut rows = vec![vec![0.0; size]; size];
    for (place, row) in rows.iter_mut().enumerate().take(order) {
        row[..order].copy_from_slice(a.row(place));
    }
    let mut first = order;
    for path in paths {
        for place in first..first + path.samples {
            match place == first {
                true => rows[place][..order].copy_from_slice(&path.row),
                false => rows[place][place - 1] = 1.0,
            }
        }
        first += path.samples;
        for (row, b) in rows.iter_mut().zip(b) {
            match path.samples {
                0 => row.iter_mut().zip(&path.row).for_each(|(entry, by)| *entry += b * by),
                _ => row[first - 1] += b,
            }
        }
    }
    Matrix::from_rows(&rows).expect("a matrix")
}

#[test]
fn poles_are_counted_as_eigenvalues_count_them_and_the_outermost_is_theirs() {
    let mut numbers = Drawn(20_261_123);
    let (mut unstable, mut stable) = (0, 0);
    for draw in 0..120 {
        let samples = [[0, 3], [7, 8], [12, 2], [5, 5]][draw % 4];
        let (a, b, paths) = drawn(&mut numbers, 1 + draw % 4, &samples);
        let found = DelayedLoop::new(&a, &b, &paths).expect("a loop");
        let poles = eigenvalues(&with_states(&a, &b, &paths)).expect("eigenvalues");
        let radius = poles.iter().fold(0.0, |size, &pole| f64::max(size, modulus(pole)));
        for circle in [0.8, 1.0, 1.05] {
            let near = poles.iter().any(|&pole| (modulus(pole) - circle).abs() < 1e-6);
            let outside = poles.iter().filter(|&&pole| modulus(pole) > circle).count();
            assert!(near || found.poles_outside(circle) == Ok(outside), "{draw} {circle}");
        }
        match found.unstable_radius().expect("decided") {
            Some(found) => {
                unstable += 1;
                assert!((found - radius).abs() < 1e-9 * radius, "{draw}: {found} {radius}");
            }
            None => {
                stable += 1;
                assert!(radius < 1.0, "{draw}: {radius}");
            }
        }
    }
    assert!(unstable > 20 && stable > 20, "{unstable} {stable}");
}

/// An integrator that is fed back late: $z - 1 + g z^{-n}$ has its first pole on the circle at
/// $g = 2 \sin (\pi / (4 n + 2))$ (R. Levin, D. May, 1976).
fn integrator(gain: f64, samples: usize) -> DelayedLoop {
    let path = DelayedPath { row: vec![-gain], samples };
    DelayedLoop::new(&Matrix::identity(1), &[1.0], &[path]).expect("a loop")
}

fn limit(samples: usize) -> f64 {
    2.0 * libm::sin(core::f64::consts::PI / (4.0 * samples as f64 + 2.0))
}

#[test]
fn the_limit_of_an_integrator_behind_a_long_dead_time_is_that_of_the_closed_form() {
    for samples in [1, 10, 401, 10_000, 100_000] {
        let limit = limit(samples);
        // What moves the pole by 10⁻⁹ of the circle is decided, to either side.
        assert_eq!(integrator(0.999 * limit, samples).unstable_radius(), Ok(None), "{samples}");
        let found = integrator(1.001 * limit, samples).unstable_radius();
        assert!(matches!(found, Ok(Some(radius)) if radius > 1.0 && radius < 1.001), "{found:?}");
        assert!(integrator(limit, samples).unstable_radius().is_err(), "{samples}");
    }
}

#[test]
fn a_loop_that_nothing_closes_is_at_the_edge_with_an_integrator() {
    let found = integrator(0.0, 10_000).unstable_radius().expect_err("an integrator");
    assert!(found.undecided_radius().is_some(), "{found}");
}

#[test]
fn work_grows_with_the_samples_and_not_with_their_cube() {
    let arcs = |samples: usize| {
        let open = integrator(0.9 * limit(samples), samples);
        open.characteristic.turns(1.0).expect("counted").arcs
    };
    let (few, many) = (arcs(100), arcs(10_000));
    assert!(many < 200 * few && many < 50_000, "{few} {many}");
}

/// A delay of 10 000 samples around a lag turns all along the circle: the most work there is.
#[test]
fn a_lag_behind_ten_thousand_samples_has_all_of_them_outside_above_its_gain() {
    let lag = Matrix::from_rows(&[[0.5]]).expect("a lag");
    let behind = |gain: f64| {
        let path = DelayedPath { row: vec![-0.5 * gain], samples: 10_000 };
        DelayedLoop::new(&lag, &[1.0], &[path]).expect("a loop")
    };
    // At a gain of 4 the path is larger than the lag at every frequency: all 10 001 poles are outside.
    assert_eq!(behind(4.0).poles_outside(1.0), Ok(10_001));
    assert_eq!(behind(0.9).poles_outside(1.0), Ok(0));
    let turns = behind(0.9).characteristic.turns(1.0).expect("counted");
    assert!(turns.arcs < 400_000, "{}", turns.arcs);
}

#[test]
fn what_is_no_loop_is_refused_by_what_is_wrong() {
    let one = Matrix::identity(1);
    let path = |row: Vec<f64>| [DelayedPath { row, samples: 3 }];
    let refused = |found: Result<DelayedLoop, LtiError>| found.expect_err("refused").to_string();
    assert!(refused(DelayedLoop::new(&one, &[1.0], &path(vec![f64::NAN]))).contains("finite"));
    assert!(
        refused(DelayedLoop::new(&one, &[1.0, 2.0], &path(vec![1.0]))).contains("input vector")
    );
    assert!(refused(DelayedLoop::new(&one, &[1.0], &path(vec![]))).contains("output vector"));
    let many = Matrix::identity(DelayedLoop::MOST_STATES + 1);
    let wide = vec![0.0; DelayedLoop::MOST_STATES + 1];
    assert!(refused(DelayedLoop::new(&many, &wide, &path(wide.clone()))).contains("dead times"));
}

//! Falling Lyapunov functions: closed forms, exact counterexamples, refusals.

use fspid_lti::Matrix;
use fspid_numeric::scalar::Interval;
use fspid_proof::check::{
    IntervalMatrix, NotProved, Relaxation, decreases, decreases_between, inside_limit,
    inside_limits, is_positive, reach,
};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn repeatable() -> ProptestConfig {
    ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(2026),
        cases: 300,
        ..ProptestConfig::default()
    }
}

fn matrix(size: usize, entries: &[f64]) -> Matrix {
    let rows: Vec<&[f64]> = entries.chunks(size).collect();
    Matrix::from_rows(&rows).expect("a test matrix is well formed")
}

fn point(matrix: &Matrix) -> IntervalMatrix {
    IntervalMatrix::from(matrix)
}

fn relaxation(weight: f64, matrix: &IntervalMatrix) -> Option<Relaxation<'_>> {
    Some(Relaxation { weight, matrix })
}

/// A loop whose Lyapunov function is known in closed form. With T unit upper triangular and D
/// diagonal, of whole numbers and halves,
///
/// $$ M = T D T^{-1}, \quad P = T^{-T} T^{-1}, \quad M^T P M = T^{-T} D^2 T^{-1} $$
///
/// so that V falls by the rate ρ if and only if ρ is above every |d|.
#[derive(Clone, Debug)]
struct Known {
    size: usize,
    /// $T^{-1}$, then T.
    inverse: Vec<i64>,
    basis: Vec<i64>,
    /// Diagonal, in units of 2^-10.
    modes: Vec<i64>,
}

impl Known {
    fn new(inverse: &[i64], modes: &[i64]) -> Self {
        let size = modes.len();
        let mut basis = vec![0; size * size];
        for j in 0..size {
            basis[j * size + j] = 1;
            for i in (0..j).rev() {
                let known: i64 =
                    (i + 1..=j).map(|k| inverse[i * size + k] * basis[k * size + j]).sum();
                basis[i * size + j] = -known;
            }
        }
        Self { size, inverse: inverse.to_vec(), basis, modes: modes.to_vec() }
    }

    fn from_upper(size: usize, upper: &[i64], modes: &[i64]) -> Self {
        let entry = |place: usize| match (place / size, place % size) {
            (i, j) if i == j => 1,
            (i, j) if i < j => upper[i * size + j],
            _ => 0,
        };
        Self::new(&(0..size * size).map(entry).collect::<Vec<i64>>(), modes)
    }

    fn product(&self, entry: impl Fn(usize, usize, usize) -> i64) -> Matrix {
        let size = self.size;
        let sum =
            |place: usize| (0..size).map(|k| entry(place / size, place % size, k)).sum::<i64>();
        let entries: Vec<f64> = (0..size * size).map(|place| exact(sum(place))).collect();
        matrix(size, &entries)
    }

    fn p(&self) -> Matrix {
        self.product(|i, j, k| self.inverse[k * self.size + i] * self.inverse[k * self.size + j])
    }

    fn m(&self) -> Matrix {
        let entry = |i: usize, j: usize, k: usize| {
            self.basis[i * self.size + k] * self.modes[k] * self.inverse[k * self.size + j]
        };
        self.product(entry).scaled(libm::exp2(-10.0))
    }

    fn slowest(&self) -> f64 {
        let most = self.modes.iter().map(|mode| mode.abs()).max().expect("not empty");
        exact(most) * libm::exp2(-10.0)
    }
}

/// A whole number of at most 53 bits.
#[allow(clippy::cast_precision_loss, reason = "checked")]
fn exact(value: i64) -> f64 {
    assert!(value.abs() <= 1 << 53, "{value}");
    value as f64
}

fn known() -> impl Strategy<Value = Known> {
    (1_usize..7, 0_i64..6).prop_flat_map(|(size, skew)| {
        let upper = prop::collection::vec(-skew..=skew, size * size);
        (upper, prop::collection::vec(-1024_i64..=1024, size))
            .prop_map(move |(upper, modes)| Known::from_upper(size, &upper, &modes))
    })
}

proptest! {
    #![proptest_config(repeatable())]

    #[test]
    fn the_rate_that_is_proved_is_that_of_the_slowest_mode_and_never_less(known in known()) {
        let (p, m, slowest) = (known.p(), point(&known.m()), known.slowest());
        // At the slowest mode's own rate the difference is singular, below it indefinite.
        prop_assert!(decreases(&p, slowest, &m, None).is_err());
        prop_assert!(decreases(&p, slowest * (1.0 - 1e-15), &m, None).is_err());
        prop_assert!(decreases(&p, slowest * (1.0 - 1e-6), &m, None).is_err());
        // Condition numbers up to some 10^9, whose root times rounding is below this.
        let above = slowest + 1e-8;
        prop_assume!(above <= 1.0);
        prop_assert_eq!(decreases(&p, above, &m, None), Ok(()));
    }

    #[test]
    fn what_a_relaxation_takes_away_counts_to_the_last_digits(known in known(), share in 0.0..1.0_f64) {
        // With Q = P the rate and the weight of the relaxation add up: ρ² - τ > d².
        let (p, m, slowest) = (known.p(), point(&known.m()), known.slowest());
        prop_assume!(slowest < 1.0 - 1e-6);
        let weight = share * (1.0 - slowest * slowest);
        let relaxed = |tau: f64| decreases(&p, 1.0, &m, relaxation(tau, &point(&p)));
        let largest = 1.0 - slowest * slowest;
        prop_assert!(relaxed(largest * (1.0 + 1e-15)).is_err() && relaxed(largest).is_err());
        prop_assert_eq!(relaxed((weight - 1e-8).max(0.0)), Ok(()));
    }

    #[test]
    fn a_form_that_is_larger_after_the_step_needs_a_faster_loop(known in known(), half in any::<bool>()) {
        // P after the step 4 times (or a quarter of) that before it: the modes count twice (half).
        let factor = if half { 0.25 } else { 4.0 };
        let (p, m) = (known.p(), point(&known.m()));
        let needed = known.slowest() * libm::sqrt(factor);
        prop_assume!(needed > 0.0 && needed <= 1.0 - 1e-8);
        let next = p.scaled(factor);
        prop_assert!(decreases_between(&p, &next, needed, &m, None).is_err());
        prop_assert_eq!(decreases_between(&p, &next, needed + 1e-8, &m, None), Ok(()));
    }

    #[test]
    fn every_matrix_inside_must_fall(known in known(), place in 0_usize..36, reach in 0.0..2.0_f64) {
        // One entry is uncertain; at its ends the loop is what ordinary arithmetic says.
        let (p, m, size) = (known.p(), known.m(), known.size);
        let place = place % (size * size);
        let at = |part: f64| {
            let mut moved = m.clone();
            let value = m.data()[place] + part * reach;
            moved.set(place / size, place % size, value).expect("the entry exists");
            moved
        };
        let ends = [at(-1.0), at(1.0)];
        let entries = ends[0].data().iter().zip(ends[1].data());
        let entries: Vec<Interval> = entries.map(|(&low, &high)| Interval::between(low, high)).collect();
        let rows: Vec<&[Interval]> = entries.chunks(size).collect();
        let wide = IntervalMatrix::from_rows(&rows).expect("square");
        if decreases(&p, 1.0, &wide, None).is_ok() {
            for part in [-1.0, -0.5, 0.0, 0.5, 1.0] {
                prop_assert_eq!(decreases(&p, 1.0, &point(&at(part)), None), Ok(()));
                prop_assert!(fspid_lti::spectral_radius(&at(part)).expect("found") < 1.0 + 1e-9);
            }
        }
    }
}

/// Whole matrices P, in units of 2^-24, and M, in units of 2^-12, of a stable loop with a Lyapunov
/// function from the sum $\sum_k (M^T)^k M^k$, rounded.
fn rounded_loop() -> impl Strategy<Value = (usize, Vec<i64>, Vec<i64>)> {
    (2_usize..6).prop_flat_map(|size| {
        prop::collection::vec(-4096_i64..=4096, size * size).prop_filter_map(
            "too slow a loop",
            move |entries| {
                let m: Vec<i64> = entries.iter().map(|entry| 2 * entry / size as i64).collect();
                let float: Vec<f64> = m.iter().map(|&e| exact(e) * libm::exp2(-12.0)).collect();
                let p = lyapunov(&matrix(size, &float))?;
                let unit = libm::exp2(24.0);
                #[allow(clippy::cast_possible_truncation, reason = "below 2^34")]
                let p: Vec<i64> =
                    p.data().iter().map(|entry| (unit * entry).round() as i64).collect();
                let symmetric = (0..size * size).map(|place| {
                    let (i, j) = (place / size, place % size);
                    p[i.min(j) * size + i.max(j)]
                });
                Some((size, symmetric.collect(), m))
            },
        )
    })
}

/// $\sum_k (M^T)^k M^k$, by doubling, if it is below 1000.
fn lyapunov(m: &Matrix) -> Option<Matrix> {
    let (mut sum, mut power) = (Matrix::identity(m.rows()), m.clone());
    for _ in 0..12 {
        let more = power.transpose().product(&sum).ok()?.product(&power).ok()?;
        sum = sum.sum(&more).ok()?;
        power = power.product(&power).ok()?;
    }
    (sum.norm_one() < 1000.0 && power.norm_one() < 1e-20).then_some(sum)
}

/// $v^T A w$ of whole numbers, exactly.
fn form(size: usize, a: &[i64], v: &[i128], w: &[i128]) -> i128 {
    (0..size * size).map(|place| v[place / size] * i128::from(a[place]) * w[place % size]).sum()
}

/// A whole vector near the direction in which $S = P - M^T P M$ is least, by inverse iteration.
fn worst_direction(size: usize, p: &Matrix, m: &Matrix) -> Vec<i128> {
    let after = m.transpose().product(p).and_then(|mp| mp.product(m)).expect("square");
    let decrease = p.sum(&after.scaled(-1.0)).expect("one shape");
    let mut v = matrix(1, &vec![1.0; size]);
    for _ in 0..60 {
        v = decrease.solve(&v).expect("regular");
        let largest = v.data().iter().fold(0.0_f64, |most, entry| most.max(entry.abs()));
        v = v.scaled(1.0 / largest);
    }
    #[allow(clippy::cast_possible_truncation, reason = "at most 2^14")]
    let whole = |entry: &f64| (16384.0 * entry).round() as i128;
    v.data().iter().map(whole).collect()
}

proptest! {
    #![proptest_config(repeatable())]

    /// τ is chosen so that $v^T (P - M^T P M - \tau I) v \le 0$ holds exactly for a known v, by less
    /// than 2^-40 of P: an exact counterexample.
    #[test]
    fn a_condition_that_fails_by_a_trillionth_is_never_proved((size, p, m) in rounded_loop()) {
        let float = |entries: &[i64], bits: f64| {
            let scaled: Vec<f64> = entries.iter().map(|&e| exact(e) * libm::exp2(-bits)).collect();
            matrix(size, &scaled)
        };
        let (p_float, m_float) = (float(&p, 24.0), float(&m, 12.0));
        let v = worst_direction(size, &p_float, &m_float);
        // In units of 2^-48.
        let moved: Vec<i128> = (0..size)
            .map(|i| (0..size).map(|j| i128::from(m[i * size + j]) * v[j]).sum())
            .collect();
        let decrease = (form(size, &p, &v, &v) << 24) - form(size, &p, &moved, &moved);
        let length: i128 = v.iter().map(|x| x * x).sum();
        prop_assume!(decrease > 0);
        // The least weight, in units of 2^-48, at which the difference is not above zero along v.
        let weight = (decrease + length - 1) / length;
        prop_assert!(decrease - weight * length <= 0);
        let tau = exact(i64::try_from(weight).expect("P is below 1000")) * libm::exp2(-48.0);
        let loops = point(&m_float);
        let identity = Matrix::identity(size);
        let relaxed = |tau: f64| decreases(&p_float, 1.0, &loops, relaxation(tau, &point(&identity)));
        prop_assert!(relaxed(tau).is_err());
        prop_assert!(relaxed(tau * (1.0 + 1e-12)).is_err());
        // The direction is off by 2^-14, the least value by its square times the spread of S.
        let spread = 1e3 * libm::exp2(-28.0) * 4.0;
        prop_assert_eq!(relaxed((tau * (1.0 - 1e-9) - spread).max(0.0)), Ok(()), "{}", tau);
    }

    /// The same with P changed along one entry until the condition fails.
    #[test]
    fn a_lyapunov_matrix_that_is_wrong_in_one_entry_is_never_accepted(
        (size, p, m) in rounded_loop(), place in 0_usize..25, amount in -(1_i64 << 36)..1 << 36, cut in 0_u32..36
    ) {
        let (i, j) = (place / 5 % size, place % size);
        let mut wrong = p.clone();
        wrong[i * size + j] += amount >> cut;
        if i != j {
            wrong[j * size + i] += amount >> cut;
        }
        let float = |entries: &[i64], bits: f64| {
            let scaled: Vec<f64> = entries.iter().map(|&e| exact(e) * libm::exp2(-bits)).collect();
            matrix(size, &scaled)
        };
        let accepted = decreases(&float(&wrong, 24.0), 1.0, &point(&float(&m, 12.0)), None).is_ok();
        if accepted {
            // No whole vector of small numbers shows the contrary.
            let all = 5_usize.pow(u32::try_from(size).expect("small"));
            for code in 1..all {
                let digit = |k: usize| i128::try_from(code / 5_usize.pow(k as u32) % 5).expect("small") - 2;
                let v: Vec<i128> = (0..size).map(digit).collect();
                let moved: Vec<i128> = (0..size)
                    .map(|i| (0..size).map(|j| i128::from(m[i * size + j]) * v[j]).sum())
                    .collect();
                let (now, next) = (form(size, &wrong, &v, &v), form(size, &wrong, &moved, &moved));
                let rest = v.iter().all(|&x| x == 0);
                prop_assert!(rest || (now > 0 && (now << 24) > next), "{v:?}");
            }
        }
    }

    /// $z^T P z \le c$ with $P = T^{-T} T^{-1}$: the largest $|r z|$ is $\sqrt c |r T|$.
    #[test]
    fn the_limit_that_is_proved_is_the_largest_value_on_the_ellipsoid(
        known in known(), row in prop::collection::vec(-9_i64..=9, 6), level in 0.01..100.0_f64
    ) {
        let size = known.size;
        let through = |j: usize| (0..size).map(|k| row[k] * known.basis[k * size + j]).sum::<i64>();
        let square: i64 = (0..size).map(|j| through(j) * through(j)).sum();
        prop_assume!(square > 0);
        let largest = libm::sqrt(level * exact(square));
        let row: Vec<Interval> = row[..size].iter().map(|&entry| Interval::point(exact(entry))).collect();
        let p = known.p();
        prop_assert!(inside_limit(&p, level, &row, largest * (1.0 - 1e-12)).is_err());
        prop_assert_eq!(inside_limit(&p, level, &row, largest * (1.0 + 1e-7)), Ok(()));
    }
}

/// The condition number of P, in units that make its diagonal 1, is at least the largest product of
/// diagonal entries of P and of its inverse $T T^T$. What is lost grows with its root only.
#[test]
fn forms_with_a_condition_number_of_ten_to_the_twelfth_are_checked_to_a_millionth() {
    for (skew, condition) in [(30, 5e5), (200, 1e9), (1100, 1e12)] {
        let upper: Vec<i64> =
            (0..9).map(|place| if place % 3 == 2 { skew } else { 1 - skew }).collect();
        let known = Known::from_upper(3, &upper, &[900, -512, 1000]);
        let inverse = known.product(|i, j, k| known.basis[i * 3 + k] * known.basis[j * 3 + k]);
        let (p, m) = (known.p(), point(&known.m()));
        let products = (0..3).map(|i| p.data()[4 * i] * inverse.data()[4 * i]);
        let least = products.fold(0.0, f64::max);
        assert!(least > condition, "{skew}: {least:e}");
        assert_eq!(decreases(&p, known.slowest() + 1e-6, &m, None), Ok(()), "{skew}");
        assert!(decreases(&p, known.slowest(), &m, None).is_err());
    }
}

/// The states in units a billion times a billion apart: the same answers.
#[test]
fn badly_scaled_states_are_harmless() {
    let known = Known::from_upper(3, &[0, 2, -1, 0, 0, 3, 0, 0, 0], &[900, -512, 1000]);
    let powers = [-60, 0, 61];
    let scale = |from: &Matrix, by: &dyn Fn(usize, usize) -> i32| {
        let entries: Vec<f64> = from
            .data()
            .iter()
            .enumerate()
            .map(|(place, &entry)| libm::scalbn(entry, by(place / 3, place % 3)))
            .collect();
        matrix(3, &entries)
    };
    let p = scale(&known.p(), &|i, j| -powers[i] - powers[j]);
    let m = point(&scale(&known.m(), &|i, j| powers[i] - powers[j]));
    assert_eq!(decreases(&p, known.slowest() + 1e-8, &m, None), Ok(()));
    assert!(decreases(&p, known.slowest(), &m, None).is_err());
    assert_eq!(is_positive(&p), Ok(()));
}

#[test]
fn a_relaxation_helps_on_its_cone_only() {
    // z1 grows, z2 falls: V = |z|² falls where |z2| is at least as large as |z1|.
    let (p, m) = (Matrix::identity(2), point(&matrix(2, &[1.1, 0.0, 0.0, 0.5])));
    let cone = matrix(2, &[-1.0, 0.0, 0.0, 1.0]);
    assert!(decreases(&p, 1.0, &m, None).is_err());
    assert_eq!(decreases(&p, 1.0, &m, relaxation(0.5, &point(&cone))), Ok(()));
    assert!(decreases(&p, 1.0, &m, relaxation(0.5, &point(&cone.scaled(-1.0)))).is_err());
    // A negative weight would turn the cone around.
    let turned = decreases(&p, 1.0, &m, relaxation(-0.5, &point(&cone.scaled(-1.0))));
    assert!(matches!(turned, Err(NotProved::Number { .. })));
}

#[test]
fn a_form_that_is_not_positive_proves_nothing() {
    // M² is zero and P negative: P - Mᵀ P M would fall, and says nothing.
    let m = point(&matrix(2, &[2.0, 0.0, 0.0, 2.0]));
    let negative = Matrix::identity(2).scaled(-1.0);
    assert!(decreases(&negative, 1.0, &m, None).is_err() && is_positive(&negative).is_err());
    let indefinite = matrix(2, &[1.0, 2.0, 2.0, 1.0]);
    assert!(is_positive(&indefinite).is_err());
    assert!(inside_limit(&indefinite, 1.0, &[Interval::ZERO; 2], 1.0).is_err());
    assert_eq!(is_positive(&matrix(2, &[2.0, 1.0, 1.0, 2.0])), Ok(()));
}

/// With $b^2 - 1 = (b - 1)(b + 1)$ the determinant of P is -1: indefinite, though rounding lets it have
/// a Cholesky factor. The loop runs away along the direction in which P is negative, where V falls.
#[test]
fn a_form_that_is_indefinite_by_less_than_rounding_proves_nothing() {
    for step in 0..400 {
        let b = libm::exp2(40.0 + f64::from(step % 10)) + 12_345.0 * f64::from(step) + 1.0;
        let p = matrix(2, &[b - 1.0, b, b, b + 1.0]);
        let (v, w) = ([b, 1.0 - b], libm::exp2(-20.0));
        let runaway = matrix(2, &[v[0] * w, -v[0] * w, v[1] * w, -v[1] * w]);
        assert!(decreases(&p, 1.0, &point(&runaway), None).is_err(), "{b}");
        assert!(is_positive(&p).is_err(), "{b}");
    }
}

#[test]
fn numbers_that_are_not_finite_or_not_allowed_are_refused_everywhere() {
    let (p, m) = (Matrix::identity(2), Matrix::identity(2).scaled(0.5));
    let loops = point(&m);
    let row = [Interval::ONE, Interval::ZERO];
    assert_eq!(decreases(&p, 0.9, &loops, relaxation(0.1, &point(&p))), Ok(()));
    assert_eq!(inside_limit(&p, 1.0, &row, 1.5), Ok(()));
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for place in 0..4 {
            let broken = |from: &Matrix| {
                let mut broken = from.clone();
                broken.set(place / 2, place % 2, bad).expect("the entry exists");
                broken
            };
            let (broken_p, broken_m) = (broken(&p), point(&broken(&m)));
            assert!(is_positive(&broken_p).is_err());
            assert!(decreases(&broken_p, 0.9, &loops, None).is_err());
            assert!(decreases(&p, 0.9, &broken_m, None).is_err());
            assert!(decreases(&p, 0.9, &loops, relaxation(0.0, &point(&broken_p))).is_err());
            assert!(decreases_between(&broken_p, &p, 0.9, &loops, None).is_err());
            assert!(decreases_between(&p, &broken_p, 0.9, &loops, None).is_err());
            assert!(inside_limit(&broken_p, 1.0, &row, 1.5).is_err());
        }
        assert!(decreases(&p, bad, &loops, None).is_err());
        assert!(decreases(&p, 0.9, &loops, relaxation(bad, &point(&p))).is_err());
        assert!(inside_limit(&p, bad, &row, 1.5).is_err());
        assert!(inside_limit(&p, 1.0, &row, bad).is_err());
        assert!(inside_limit(&p, 1.0, &[Interval::point(bad), Interval::ZERO], 1.5).is_err());
    }
    for rate in [1.0_f64.next_up(), -1e-300, 2.0] {
        assert!(
            matches!(decreases(&p, rate, &loops, None), Err(NotProved::Number { .. })),
            "{rate}"
        );
    }
    for level in [0.0, -1.0] {
        assert!(inside_limit(&p, level, &row, 1.5).is_err());
        assert!(inside_limit(&p, 1.0, &row, level).is_err());
    }
}

/// Of $P = T^T D T$ with T unit upper triangular, $r P^{-1} r^T$ is the sum of $(r T^{-1})_i^2 / d_i$.
#[test]
fn no_reach_falls_short_of_the_exact_one_however_ill_the_form_is_conditioned() {
    let d = [3.0, 7.0, 11.0];
    // In the last the factor as computed falls short by some 10⁻⁵, and the form in its basis says so.
    let shapes =
        [[0.0; 3], [5.0, -2.0, 3.0], [4e3, 77.0, -1e3], [985_724.0, -133_038.0, 648_242.0]];
    for [a, b, c] in shapes {
        // T is [1 a b; 0 1 c; 0 0 1]; all is whole and below 2⁵³.
        let p = [
            d[0],
            d[0] * a,
            d[0] * b,
            d[0] * a,
            d[0] * a * a + d[1],
            d[0] * a * b + d[1] * c,
            d[0] * b,
            d[0] * a * b + d[1] * c,
            d[0] * b * b + d[1] * c * c + d[2],
        ];
        let p = matrix(3, &p);
        for [x, y, z] in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, -1.0, 2.0]] {
            // r T⁻¹, from left to right.
            let turned = [x, y - a * x, z - b * x - c * (y - a * x)];
            let squares = turned.iter().zip(d).map(|(value, d)| value * value / d);
            let exact = 2.25 * squares.sum::<f64>();
            let found =
                reach(&p, 2.25, &[x, y, z].map(Interval::point)).expect("positive definite");
            assert!(found * found >= exact * (1.0 - 1e-15), "{a} {x} {y} {z}: {found} {exact}");
            assert!(found * found <= exact * (1.0 + 1e-3), "{a} {x} {y} {z}: {found} {exact}");
        }
    }
}

#[test]
fn nothing_is_reached_on_an_ellipsoid_of_no_size() {
    assert_eq!(reach(&Matrix::identity(2), 0.0, &[Interval::ONE; 2]), Ok(0.0));
}

#[test]
fn a_row_between_bounds_reaches_as_far_as_the_longest_of_them() {
    let row = [Interval::between(-3.0, 1.0), Interval::between(0.0, 4.0)];
    let found = reach(&Matrix::identity(2), 4.0, &row).expect("positive definite");
    assert!((10.0..10.0001).contains(&found), "{found}");
}

/// Forms from [0.9 -0.2; -0.2 0.9] to [1.1 0.2; 0.2 1.1], the least eigenvalue of which is 0.7, along (1, 1).
#[test]
fn limits_hold_for_every_form_inside_and_each_for_its_row() {
    let (on, off) = (Interval::between(0.9, 1.1), Interval::between(-0.2, 0.2));
    let forms = IntervalMatrix::from_rows(&[[on, off], [off, on]]).expect("square");
    let along = vec![Interval::ONE; 2];
    let only = vec![Interval::ONE, Interval::ZERO];
    // |r z|² ≤ 2 level / 0.7; of the first state alone Gershgorin's bound is level / 0.7.
    for level in [1.0, 4.0] {
        let most = f64::sqrt(2.0 * level / 0.7);
        let with = |limit: f64| inside_limits(&forms, level, &[(along.clone(), limit)]);
        assert_eq!(with(1.0001 * most), Ok(()));
        let found = with(0.9999 * most);
        assert!(matches!(found, Err(NotProved::BeyondLimit { row: 0, .. })), "{found:?}");
        let rows = [(only.clone(), most), (along.clone(), 0.9999 * most)];
        let found = inside_limits(&forms, level, &rows);
        assert!(matches!(found, Err(NotProved::BeyondLimit { row: 1, .. })), "{found:?}");
        assert_eq!(inside_limits(&forms, level, &rows[..1]), Ok(()));
    }
    assert_eq!(inside_limits(&forms, 1.0, &[]), Ok(()));
}

#[test]
fn limits_of_many_rows_are_refused_where_numbers_or_shapes_are_not_allowed() {
    let forms = IntervalMatrix::identity(2);
    let row = |limit: f64| vec![(vec![Interval::ONE, Interval::ZERO], limit)];
    assert_eq!(inside_limits(&forms, 1.0, &row(1.5)), Ok(()));
    for bad in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
        assert!(inside_limits(&forms, bad, &row(1.5)).is_err(), "{bad}");
        assert!(inside_limits(&forms, 1.0, &row(bad)).is_err(), "{bad}");
        assert!(reach(&Matrix::identity(2), bad, &[Interval::ONE; 2]).is_err() || bad == 0.0);
    }
    for columns in [1, 3] {
        let found = inside_limits(&forms, 1.0, &[(vec![Interval::ZERO; columns], 1.5)]);
        assert!(matches!(found, Err(NotProved::Shape(_))), "{found:?}");
        let found = reach(&Matrix::identity(2), 1.0, &vec![Interval::ZERO; columns]);
        assert!(matches!(found, Err(NotProved::Shape(_))), "{found:?}");
    }
    let unknown = vec![(vec![Interval::ENTIRE, Interval::ZERO], 1e300)];
    assert!(inside_limits(&forms, 1.0, &unknown).is_err());
    let indefinite = point(&matrix(2, &[1.0, 2.0, 2.0, 1.0]));
    assert!(inside_limits(&indefinite, 1.0, &row(1.5)).is_err());
    assert!(inside_limits(&IntervalMatrix::zeros(2, 3), 1.0, &row(1.5)).is_err());
    assert!(reach(&matrix(2, &[1.0, 2.0, 2.0, 1.0]), 1.0, &[Interval::ONE; 2]).is_err());
}

#[test]
fn an_entry_without_bounds_is_named_by_its_place() {
    let mut p = Matrix::identity(3);
    for (row, column) in [(1, 2), (2, 1)] {
        p.set(row, column, f64::NAN).expect("the entry exists");
    }
    let expected = NotProved::Unbounded { what: "Lyapunov matrix", row: 1, column: 2 };
    assert_eq!(is_positive(&p), Err(expected.clone()));
    assert_eq!(decreases(&p, 1.0, &IntervalMatrix::zeros(3, 3), None), Err(expected));
}

#[test]
fn matrices_that_are_not_symmetric_or_do_not_fit_are_refused() {
    let (p, loops) = (Matrix::identity(2), IntervalMatrix::zeros(2, 2));
    let skewed = matrix(2, &[1.0, 1e-16, 0.0, 1.0]);
    assert!(matches!(decreases(&skewed, 1.0, &loops, None), Err(NotProved::NotSymmetric { .. })));
    assert!(decreases(&p, 1.0, &loops, relaxation(0.1, &point(&skewed))).is_err());
    assert!(decreases_between(&p, &skewed, 1.0, &loops, None).is_err());
    let (wide, three) = (Matrix::zeros(2, 3), Matrix::identity(3));
    assert!(matches!(decreases(&wide, 1.0, &loops, None), Err(NotProved::Shape(_))));
    assert!(decreases(&three, 1.0, &loops, None).is_err());
    assert!(decreases(&p, 1.0, &IntervalMatrix::zeros(2, 3), None).is_err());
    assert!(decreases(&p, 1.0, &loops, relaxation(0.1, &point(&three))).is_err());
    assert!(decreases_between(&p, &three, 1.0, &loops, None).is_err());
    assert!(inside_limit(&p, 1.0, &[Interval::ONE], 1.0).is_err());
    assert!(is_positive(&wide).is_err());
}

//! The norm of a form, and by how much a sample can make a ball of it grow.
//!
//! What rounding leaves, and what old unknowns have become, is no longer told apart: it lies within a ball of the norm
//! $|z|_P = \sqrt{z^T P z}$. A sample without limits shrinks the ball by the rate of the form. With limits the ball goes
//! through a matrix between those of all limits acting or not, and the norm is convex.

use std::collections::BTreeMap;

use fspid_lti::Matrix;
use fspid_numeric::Scalar;
use fspid_numeric::scalar::Interval;

use super::affine::raised;
use super::sample::PLACES;
use crate::check::{IntervalMatrix, NotProved, decreases, decreases_between, reach};

/// Factors that are tried: the rate, 1, and so many, of which each is twice as far beyond 1 as the one before.
const FACTORS: i32 = 24;
const FINEST: f64 = 0.0005;
/// Binary exponents between which a factor from norm to norm is looked for.
const LEAST: i32 = -60;
const MOST: i32 = 120;

/// The norm of a form.
#[derive(Clone, Debug)]
pub(super) struct Norm {
    form: Matrix,
    rate: f64,
    /// Norms of the unit vectors, from above.
    pub(super) units: Vec<f64>,
}

impl Norm {
    pub(super) fn of(form: &Matrix, rate: f64) -> Self {
        let unit = |place: usize| {
            let entry = form.get(place, place).unwrap_or(f64::INFINITY);
            Interval::point(entry.max(0.0)).sqrt().upper()
        };
        Self { form: form.clone(), rate, units: (0..form.rows()).map(unit).collect() }
    }

    /// Largest deviation of each state where the norm is 1.
    pub(super) fn reach(&self) -> Result<Vec<f64>, NotProved> {
        let size = self.form.rows();
        let unit = |place: usize| -> Vec<Interval> {
            (0..size).map(|at| if at == place { Interval::ONE } else { Interval::ZERO }).collect()
        };
        (0..size).map(|place| reach(&self.form, 1.0, &unit(place))).collect()
    }

    /// The norm of a vector of plain numbers, from above.
    pub(super) fn size_of(&self, vector: &[f64]) -> f64 {
        let rows = self.form.data().chunks(vector.len().max(1));
        let (mut square, mut sizes) = (0.0, 0.0);
        for (row, value) in rows.zip(vector) {
            let (mut product, mut size) = (0.0, 0.0);
            for (p, z) in row.iter().zip(vector) {
                product += p * z;
                size += (p * z).abs();
            }
            square += product * value;
            sizes += size * value.abs();
        }
        let terms = vector.len() * 2;
        let rounding = raised(sizes * f64::EPSILON * (terms as f64 + 2.0), 2 * terms);
        raised(libm::sqrt(raised(square.max(0.0) + rounding, 2)), 8)
    }

    /// How many times its own norm that of another form is at most; infinite where that is not found.
    pub(super) fn factor_into(&self, other: &Self) -> f64 {
        let one = IntervalMatrix::identity(self.form.rows());
        let within = |factor: &f64| {
            let smaller = one.scaled(Interval::ONE / Interval::point(*factor));
            decreases_between(&self.form, &other.form, 1.0, &smaller, None).is_ok()
        };
        let mut factors = LEAST..MOST;
        factors
            .find_map(|power| Some(libm::ldexp(1.0, power)).filter(within))
            .unwrap_or(f64::INFINITY)
    }

    /// The norm of everything that is as far off as this at most, from above.
    pub(super) fn of_box(&self, off: &[f64]) -> f64 {
        let sum = off.iter().zip(&self.units).map(|(off, unit)| off * unit).sum();
        raised(sum, off.len() + 4)
    }

    /// A factor that the norm grows by at most with a matrix, proved.
    fn factor(&self, matrix: &IntervalMatrix) -> f64 {
        let beyond = (0..FACTORS).map(|power| 1.0 + libm::ldexp(FINEST, power));
        let mut factors = [self.rate, 1.0].into_iter().chain(beyond);
        let holds = |factor: &f64| {
            let slowed = matrix.scaled(Interval::ONE / Interval::point(*factor));
            decreases(&self.form, 1.0, &slowed, None).is_ok()
        };
        factors.find(holds).unwrap_or(f64::INFINITY)
    }
}

/// Factors by which a sample makes the ball grow, for each choice of what is cut.
#[derive(Clone, Debug, Default)]
pub(super) struct Growth {
    known: BTreeMap<usize, f64>,
}

impl Growth {
    /// The factor where nothing is cut is known.
    pub(super) fn with_rate(rate: f64) -> Self {
        Self { known: BTreeMap::from([((1 << PLACES) - 1, rate)]) }
    }

    /// The factor of a sample, from its shares: the largest of all choices that are left open.
    pub(super) fn of(
        &mut self,
        norm: &Norm,
        shares: [f64; PLACES],
        mut matrices: impl FnMut([f64; PLACES]) -> Vec<IntervalMatrix>,
    ) -> f64 {
        let mut most = 0.0_f64;
        for choice in 0..1_usize << PLACES {
            let whole = |place: usize| choice >> place & 1 == 1;
            let open = (0..PLACES).all(|place| match shares[place] {
                share if share >= 1.0 => whole(place),
                share if share <= 0.0 => !whole(place),
                _ => true,
            });
            if !open {
                continue;
            }
            let factor = *self.known.entry(choice).or_insert_with(|| {
                let mut shares = [0.0; PLACES];
                (0..PLACES).for_each(|place| shares[place] = if whole(place) { 1.0 } else { 0.0 });
                let factors = matrices(shares).into_iter().map(|matrix| norm.factor(&matrix));
                factors.fold(0.0, f64::max)
            });
            most = most.max(factor);
        }
        most
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rest::drawn::Dice;
    use crate::steps::sample::FREE;

    fn norm<const N: usize>(rows: &[[f64; N]]) -> Norm {
        Norm::of(&Matrix::from_rows(rows).unwrap(), 0.9)
    }

    /// So many times the identity.
    fn round(size: usize, by: f64) -> Norm {
        let identity = Matrix::identity(size);
        let rows: Vec<Vec<f64>> = identity
            .data()
            .chunks(size)
            .map(|row| row.iter().map(|it| it * by).collect())
            .collect();
        Norm::of(&Matrix::from_rows(&rows).unwrap(), 0.9)
    }

    fn times(factor: f64) -> IntervalMatrix {
        IntervalMatrix::identity(2).scaled(Interval::point(factor))
    }

    /// In whole numbers, which are exact.
    #[test]
    fn the_norm_of_a_vector_is_the_root_of_its_form_from_above() {
        let norm = norm(&[[2.0, 1.0, 0.0], [1.0, 3.0, -1.0], [0.0, -1.0, 4.0]]);
        for at in 0..64_usize {
            let z = [0, 2, 4].map(|bits| [-2.0, 0.0, 1.0, 3.0][at >> bits & 3]);
            let [x, y, w] = z;
            let square = 2.0 * x * x + 3.0 * y * y + 4.0 * w * w + 2.0 * (x * y - y * w);
            let exact = libm::sqrt(square);
            let found = norm.size_of(&z);
            assert!(found >= exact && found <= exact * (1.0 + 1e-13) + 1e-150, "{z:?}: {found}");
        }
    }

    /// A form that is all but singular, along what it hardly sees: all digits that are left are those of rounding.
    #[test]
    fn the_norm_of_a_vector_that_a_form_hardly_sees_holds_what_rounding_takes() {
        let whole = |value: f64, power: i32| libm::ldexp(value, power) as i128;
        for seed in 0..500 {
            let dice = &mut Dice::new(seed);
            let across = f64::from(dice.part() as f32) * 1e-6 - 1.0;
            let across = libm::ldexp(whole(across, 50) as f64, -50);
            let norm = norm(&[[1.0, across], [across, 1.0]]);
            let x = libm::ldexp(libm::floor(libm::ldexp(0.5 + 0.5 * dice.part(), 32)), -32);
            let y = x + libm::ldexp(libm::floor(libm::ldexp(dice.part(), 6)), -32);
            let [a, b] = [x, y].map(|it| whole(it, 32));
            let exact = ((a * a + b * b) << 50) + 2 * whole(across, 50) * a * b;
            let exact = libm::ldexp(exact as f64, -114);
            let found = norm.size_of(&[x, y]);
            let sizes = x * x + y * y - 2.0 * across * x * y;
            let most = exact + 7.1 * f64::EPSILON * sizes;
            let square = found * found;
            assert!(
                square >= exact && square <= most * (1.0 + 1e-13),
                "{seed}: {square:e} {exact:e}"
            );
        }
    }

    /// Where all is cancelled, what is left is twice the worst of rounding: two operations for each of the terms.
    #[test]
    fn what_rounding_may_take_of_a_norm_grows_with_its_terms() {
        for size in 2..12_usize {
            let rows: Vec<Vec<f64>> = (0..size)
                .map(|row| {
                    (0..size).map(|it| if (row + it) % 2 == 0 { 1.0 } else { -1.0 }).collect()
                })
                .collect();
            let norm = Norm::of(&Matrix::from_rows(&rows).unwrap(), 0.9);
            let found = norm.size_of(&vec![1.0; size]);
            // With an odd number of them one is left.
            let (left, sizes) = ((size % 2) as f64, (size * size) as f64);
            let taken = found * found - left;
            let worst = 2.0 * size as f64 * f64::EPSILON * sizes;
            assert!(taken >= worst + f64::EPSILON * sizes, "{size}: {taken:e} {worst:e}");
            let most = worst + 2.1 * f64::EPSILON * sizes + 80.0 * f64::EPSILON * left;
            assert!(taken <= most, "{size}: {taken:e} {most:e}");
        }
    }

    #[test]
    fn the_norm_of_a_box_is_that_of_its_sides_together() {
        let norm = norm(&[[4.0, 1.0], [1.0, 9.0]]);
        for (off, exact) in [([1.0, 0.0], 2.0), ([0.0, 1.0], 3.0), ([0.5, 2.0], 7.0)] {
            let found = norm.of_box(&off);
            assert!(found >= exact && found <= exact * (1.0 + 1e-14), "{off:?}: {found}");
        }
        // Each of them is dropped by rounding, half a digit of the first.
        for size in [2, 5, 50] {
            let mut off = vec![0.5 * f64::EPSILON; size];
            off[0] = 1.0;
            let beyond = (round(size, 1.0).of_box(&off) - 1.0) / (0.5 * f64::EPSILON);
            let most = size as f64;
            assert!(beyond >= most && beyond <= 4.0 * most + 40.0, "{size}: {beyond}");
        }
        assert!(norm.of_box(&[0.0, 0.0]) < 1e-300);
    }

    /// The next power of two: a norm that is half of another is not proved to be no more than that.
    #[test]
    fn a_norm_is_held_against_another_by_powers_of_two() {
        let one = round(2, 1.0);
        for (by, factor) in [(0.24, 0.5), (0.9, 1.0), (1.1, 2.0), (60.0, 8.0), (1e-6, 1.0 / 512.0)]
        {
            let found = one.factor_into(&round(2, by));
            assert_eq!(found.to_bits(), f64::to_bits(factor), "{by}: {found}");
            let turned = round(2, by).factor_into(&one);
            let exact = 1.0 / libm::sqrt(by);
            assert!(turned > exact && turned <= 2.0 * exact, "{by}: {turned}");
        }
        assert!(one.factor_into(&round(3, 1.0)).is_infinite(), "another size");
    }

    #[test]
    fn a_norm_grows_by_the_least_factor_that_holds() {
        let norm = norm(&[[2.0, 0.5], [0.5, 1.0]]);
        let beyond = |power: i32| 1.0 + libm::ldexp(0.0005, power);
        for (grows, factor) in [
            (0.5, 0.9),
            (0.95, 1.0),
            (-0.95, 1.0),
            (1.0001, beyond(0)),
            (1.2, beyond(9)),
            (-3.0, beyond(12)),
            (4000.0, beyond(23)),
            (5000.0, f64::INFINITY),
        ] {
            let found = norm.factor(&times(grows));
            assert_eq!(found.to_bits(), factor.to_bits(), "{grows}: {found} {factor}");
        }
    }

    /// The choices that are asked for, and the factor of a growth by what each place adds.
    fn grown(growth: &mut Growth, shares: [f64; PLACES]) -> (Vec<[f64; PLACES]>, f64) {
        let mut asked = Vec::new();
        let factor = growth.of(&round(2, 1.0), shares, |shares| {
            asked.push(shares);
            let by = shares.iter().zip([0.0, 1.0, 2.0, 4.0]).map(|(share, by)| share * by);
            vec![times(0.5), times(1.2 + by.sum::<f64>()), times(0.1)]
        });
        (asked, factor)
    }

    #[test]
    fn a_sample_grows_by_the_largest_factor_of_all_that_may_be_cut() {
        let factor = |by: f64| {
            let factors = (0..FACTORS).map(|power| 1.0 + libm::ldexp(FINEST, power));
            factors.into_iter().find(|factor| *factor > by).unwrap().to_bits()
        };
        let all = |[a, b]: [[f64; PLACES]; 2]| vec![a, b];
        for (shares, asked, most) in [
            (FREE, vec![FREE], 8.2),
            ([0.0; PLACES], vec![[0.0; PLACES]], 1.2),
            ([0.0, 1.0, 0.0, 0.0], vec![[0.0, 1.0, 0.0, 0.0]], 2.2),
            ([1.0, 0.5, 0.0, 1.0], all([[1.0, 0.0, 0.0, 1.0], [1.0, 1.0, 0.0, 1.0]]), 6.2),
            ([0.0, 0.0, 1e-9, 0.0], all([[0.0; PLACES], [0.0, 0.0, 1.0, 0.0]]), 3.2),
        ] {
            let mut growth = Growth::default();
            let found = grown(&mut growth, shares);
            assert_eq!((&found.0, found.1.to_bits()), (&asked, factor(most)), "{shares:?}");
            let again = grown(&mut growth, shares);
            assert_eq!((again.0.len(), again.1.to_bits()), (0, factor(most)), "known");
        }
    }

    #[test]
    fn what_a_sample_without_cuts_grows_by_is_the_rate_where_that_is_known() {
        let mut growth = Growth::with_rate(0.7);
        let (asked, factor) = grown(&mut growth, FREE);
        assert_eq!((asked.len(), factor.to_bits()), (0, 0.7_f64.to_bits()));
        let (asked, factor) = grown(&mut growth, [0.5, 1.0, 1.0, 1.0]);
        assert_eq!(asked, [[0.0, 1.0, 1.0, 1.0]], "the other is known");
        assert!(factor > 8.2 && factor < 2.0 * 8.2, "{factor}");
    }
}

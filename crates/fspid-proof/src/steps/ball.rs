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

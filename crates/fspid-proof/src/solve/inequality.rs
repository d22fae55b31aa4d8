//! Linear matrix inequalities in unknown symmetric matrices, built from two kinds of terms.
//!
//! A system is a list of symmetric matrices that are linear in the unknowns and must all become positive
//! definite:
//!
//! $$ F_i(x) = \sum_f s_f U_f \Bigl( \sum_j w_{fj} X_j \Bigr) U_f^T + \sum_g s_g \tau_g A_g \succ 0 $$
//!
//! with symmetric $X_j$, all of one size, and numbers $\tau_g$ as unknowns. The factor $s_f$ is the level
//! $\lambda = \rho^2$ for a rated term and 1 otherwise: the level says how fast the form must decrease.

use core::ops::Range;

use super::dense::Dense;
use super::symmetric::{packed_len, unpack};

/// The factor U of a term.
#[derive(Debug, Clone)]
pub(super) enum Factor {
    Identity,
    Matrix(Dense),
}

impl Factor {
    /// $Z U$.
    pub(super) fn after(&self, z: &Dense) -> Dense {
        match self {
            Self::Identity => z.clone(),
            Self::Matrix(matrix) => z.times(matrix),
        }
    }

    /// $U^T Z$.
    pub(super) fn before(&self, z: &Dense) -> Dense {
        match self {
            Self::Identity => z.clone(),
            Self::Matrix(matrix) => matrix.transpose_times(z),
        }
    }

    /// $U X U^T$.
    fn around(&self, x: &Dense) -> Dense {
        match self {
            Self::Identity => x.clone(),
            Self::Matrix(matrix) => x.congruence(&matrix.transpose()),
        }
    }
}

/// Symmetric unknowns by number, each with the factor that multiplies it.
pub(super) type Weights = Vec<(usize, f64)>;

/// $s U (\sum_j w_j X_j) U^T$.
#[derive(Debug, Clone)]
pub(super) struct Form {
    pub(super) factor: Factor,
    /// Whether s is the level or 1.
    pub(super) rated: bool,
    pub(super) weights: Weights,
}

/// One matrix that must become positive definite.
#[derive(Debug, Clone, Default)]
pub(super) struct Inequality {
    pub(super) size: usize,
    pub(super) forms: Vec<Form>,
    /// Number of the multiplier and the matrix it multiplies.
    pub(super) multipliers: Vec<(usize, Dense)>,
    /// The same, times the level.
    pub(super) rated_multipliers: Vec<(usize, Dense)>,
}

impl Inequality {
    /// $\sum_j w_j X_j \succ 0$.
    pub(super) fn positive(size: usize, weights: Weights) -> Self {
        let forms = vec![Form { factor: Factor::Identity, rated: false, weights }];
        Self { size, forms, ..Self::default() }
    }

    /// $\lambda \sum_j w_j X_j - M^T \bigl( \sum_j v_j X_j \bigr) M \succ 0$.
    pub(super) fn decrease(matrix: &Dense, now: Weights, next: &[(usize, f64)]) -> Self {
        let negative = next.iter().map(|&(unknown, weight)| (unknown, -weight)).collect();
        let after = Factor::Matrix(matrix.transpose());
        let forms = vec![
            Form { factor: Factor::Identity, rated: true, weights: now },
            Form { factor: after, rated: false, weights: negative },
        ];
        Self { size: matrix.rows, forms, ..Self::default() }
    }
}

/// A weighted sum of symmetric unknowns that is kept near its present value.
#[derive(Debug, Clone)]
pub(super) struct Measure {
    pub(super) weights: Weights,
    pub(super) multiplicity: f64,
}

/// All inequalities, and what fixes the size of the unknowns.
///
/// The vector of unknowns holds the packed matrices one after the other, then the multipliers.
#[derive(Debug, Clone)]
pub(super) struct System {
    /// Rows of each unknown matrix.
    pub(super) size: usize,
    /// Number of unknown matrices.
    pub(super) matrices: usize,
    /// Number of unknown multipliers.
    pub(super) multipliers: usize,
    pub(super) inequalities: Vec<Inequality>,
    pub(super) measures: Vec<Measure>,
}

impl System {
    /// Places of one matrix in the vector of unknowns.
    pub(super) fn matrix_place(&self, number: usize) -> Range<usize> {
        let len = packed_len(self.size);
        number * len..(number + 1) * len
    }

    /// Place of one multiplier in the vector of unknowns.
    pub(super) fn multiplier_place(&self, number: usize) -> usize {
        self.matrices * packed_len(self.size) + number
    }

    /// Length of the vector of unknowns.
    pub(super) fn len(&self) -> usize {
        self.multiplier_place(self.multipliers)
    }

    /// Sum of the sizes of the inequalities: the degree of the product of their determinants.
    pub(super) fn degree(&self) -> f64 {
        self.inequalities.iter().map(|inequality| inequality.size as f64).sum()
    }

    /// Weighted sum of matrices.
    pub(super) fn weighted(&self, weights: &[(usize, f64)], x: &[f64]) -> Dense {
        let mut sum = vec![0.0; packed_len(self.size)];
        for &(number, weight) in weights {
            super::dense::add_scaled(&mut sum, weight, &x[self.matrix_place(number)]);
        }
        unpack(&sum, self.size)
    }

    /// $F_i$ at these unknowns, for this level.
    pub(super) fn value(&self, inequality: &Inequality, x: &[f64], level: f64) -> Dense {
        let mut value = Dense::zeros(inequality.size, inequality.size);
        for form in &inequality.forms {
            let scale = if form.rated { level } else { 1.0 };
            value.add(scale, &form.factor.around(&self.weighted(&form.weights, x)));
        }
        for (number, matrix) in &inequality.multipliers {
            value.add(x[self.multiplier_place(*number)], matrix);
        }
        for (number, matrix) in &inequality.rated_multipliers {
            value.add(level * x[self.multiplier_place(*number)], matrix);
        }
        value
    }

    /// What the level multiplies in $F_i$; `None` where that is nothing.
    pub(super) fn rated_part(&self, inequality: &Inequality, x: &[f64]) -> Option<Dense> {
        let forms = inequality.forms.iter().filter(|form| form.rated);
        let forms = forms.map(|form| form.factor.around(&self.weighted(&form.weights, x)));
        let multipliers = inequality.rated_multipliers.iter();
        let multipliers =
            multipliers.map(|(number, matrix)| matrix.scaled(x[self.multiplier_place(*number)]));
        forms.chain(multipliers).reduce(|sum, part| sum.plus(1.0, &part))
    }
}

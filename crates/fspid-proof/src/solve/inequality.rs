//! Linear matrix inequalities in unknown matrices, built from a few kinds of terms.
//!
//! A system is a list of symmetric matrices that are linear in the unknowns and must all become positive
//! definite:
//!
//! $$ F_i(x) = \sum_f s_f \, U_f \Bigl( \sum_j w_{fj} X_j \Bigr) U_f^T
//!   + \sum_c \bigl( U_c Y V_c^T + V_c Y^T U_c^T \bigr) + \sum_g \tau_g A_g \succ 0 $$
//!
//! with symmetric $X_j$, a general Y and numbers $\tau_g$ as unknowns. The factor $s_f$ is the level
//! $\lambda = \rho^2$ for a rated term and 1 otherwise: the level says how fast the form must fall.

use core::ops::Range;

use super::dense::{Dense, add_scaled};
use super::symmetric::{packed_len, unpack};

/// Kind and size of one unknown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Unknown {
    /// Symmetric matrix of this size, packed.
    Symmetric(usize),
    /// Square matrix of this size, row after row.
    General(usize),
    /// A number.
    Scalar,
}

impl Unknown {
    fn len(self) -> usize {
        match self {
            Self::Symmetric(size) => packed_len(size),
            Self::General(size) => size * size,
            Self::Scalar => 1,
        }
    }
}

/// A factor U of a term.
#[derive(Debug, Clone)]
pub(super) enum Factor {
    /// Columns of the identity: `size` of them from this one on.
    Unit { start: usize, size: usize },
    /// Any matrix.
    Matrix(Dense),
}

impl Factor {
    /// $U X V^T$ added to a matrix, times a number.
    fn add_product(&self, scale: f64, x: &Dense, right: &Self, target: &mut Dense) {
        let product = self.times(&right.times(&x.transpose()).transpose());
        target.add(scale, &product.widened(self, right, target));
    }

    /// U X, or X itself where U only places it.
    fn times(&self, x: &Dense) -> Dense {
        match self {
            Self::Unit { .. } => x.clone(),
            Self::Matrix(matrix) => matrix.times(x),
        }
    }

    /// Z U.
    pub(super) fn after(&self, z: &Dense) -> Dense {
        match *self {
            Self::Unit { start, size } => {
                Dense::from_function(z.rows, size, |row, column| z[(row, start + column)])
            }
            Self::Matrix(ref matrix) => z.times(matrix),
        }
    }

    /// $U^T Z$.
    pub(super) fn before(&self, z: &Dense) -> Dense {
        match *self {
            Self::Unit { start, size } => {
                let data = z.data[start * z.columns..(start + size) * z.columns].to_vec();
                Dense { rows: size, columns: z.columns, data }
            }
            Self::Matrix(ref matrix) => matrix.transpose_times(z),
        }
    }

    fn start(&self) -> usize {
        if let Self::Unit { start, .. } = *self { start } else { 0 }
    }
}

impl Dense {
    /// The product put where factors that are columns of the identity place it.
    fn widened(self, left: &Factor, right: &Factor, target: &Self) -> Self {
        if self.rows == target.rows && self.columns == target.columns {
            return self;
        }
        let mut wide = Self::zeros(target.rows, target.columns);
        for row in 0..self.rows {
            let at = (left.start() + row) * wide.columns + right.start();
            add_scaled(&mut wide.data[at..at + self.columns], 1.0, self.row(row));
        }
        wide
    }
}

/// $s\, U (\sum_j w_j X_j) U^T$.
#[derive(Debug, Clone)]
pub(super) struct Form {
    /// Number of U in the list of the inequality.
    pub(super) factor: usize,
    /// Whether s is the level or 1.
    pub(super) rated: bool,
    /// Unknown and weight, one by one.
    pub(super) weights: Vec<(usize, f64)>,
}

/// $U Y V^T + V Y^T U^T$.
#[derive(Debug, Clone)]
pub(super) struct Cross {
    pub(super) unknown: usize,
    /// Number of U in the list of the inequality.
    pub(super) left: usize,
    /// Number of V in the list of the inequality.
    pub(super) right: usize,
}

/// One matrix that must become positive definite.
#[derive(Debug, Clone, Default)]
pub(super) struct Inequality {
    pub(super) size: usize,
    pub(super) factors: Vec<Factor>,
    pub(super) forms: Vec<Form>,
    /// At most one, and not beside scalars.
    pub(super) cross: Option<Cross>,
    /// Unknown number and the matrix it multiplies.
    pub(super) scalars: Vec<(usize, Dense)>,
}

/// A weighted sum of symmetric unknowns that is kept near its present value.
#[derive(Debug, Clone)]
pub(super) struct Measure {
    pub(super) weights: Vec<(usize, f64)>,
    pub(super) multiplicity: f64,
}

/// All inequalities, and what fixes the size of the unknowns.
#[derive(Debug, Clone)]
pub(super) struct System {
    pub(super) unknowns: Vec<Unknown>,
    pub(super) inequalities: Vec<Inequality>,
    pub(super) measures: Vec<Measure>,
}

impl System {
    /// Places of one unknown in the vector of all.
    pub(super) fn place(&self, unknown: usize) -> Range<usize> {
        let start = self.unknowns[..unknown].iter().map(|unknown| unknown.len()).sum();
        start..start + self.unknowns[unknown].len()
    }

    /// Length of the vector of all unknowns.
    pub(super) fn len(&self) -> usize {
        self.unknowns.iter().map(|unknown| unknown.len()).sum()
    }

    /// Sum of the sizes of the inequalities: the degree of the product of their determinants.
    pub(super) fn degree(&self) -> f64 {
        self.inequalities.iter().map(|inequality| inequality.size as f64).sum()
    }

    /// Weighted sum of symmetric unknowns.
    pub(super) fn weighted(&self, weights: &[(usize, f64)], x: &[f64]) -> Dense {
        let mut sum: Option<Dense> = None;
        for &(unknown, weight) in weights {
            let matrix = self.symmetric(unknown, x).scaled(weight);
            sum = Some(sum.map_or(matrix.clone(), |sum| sum.plus(1.0, &matrix)));
        }
        sum.unwrap_or_else(|| Dense::zeros(0, 0))
    }

    fn symmetric(&self, unknown: usize, x: &[f64]) -> Dense {
        let Unknown::Symmetric(size) = self.unknowns[unknown] else { return Dense::zeros(0, 0) };
        unpack(&x[self.place(unknown)], size)
    }

    /// $F_i$ at these unknowns, for this level.
    pub(super) fn value(&self, inequality: &Inequality, x: &[f64], level: f64) -> Dense {
        let mut value = self.rated_part(inequality, x).scaled(level);
        self.add_forms(inequality, x, false, &mut value);
        if let Some(cross) = &inequality.cross {
            let (left, right) = (&inequality.factors[cross.left], &inequality.factors[cross.right]);
            let y = self.general(cross.unknown, x);
            left.add_product(1.0, &y, right, &mut value);
            right.add_product(1.0, &y.transpose(), left, &mut value);
        }
        for (unknown, matrix) in &inequality.scalars {
            value.add(x[self.place(*unknown).start], matrix);
        }
        value
    }

    /// What the level multiplies in $F_i$.
    pub(super) fn rated_part(&self, inequality: &Inequality, x: &[f64]) -> Dense {
        let mut value = Dense::zeros(inequality.size, inequality.size);
        self.add_forms(inequality, x, true, &mut value);
        value
    }

    fn add_forms(&self, inequality: &Inequality, x: &[f64], rated: bool, value: &mut Dense) {
        for form in inequality.forms.iter().filter(|form| form.rated == rated) {
            let factor = &inequality.factors[form.factor];
            factor.add_product(1.0, &self.weighted(&form.weights, x), factor, value);
        }
    }

    fn general(&self, unknown: usize, x: &[f64]) -> Dense {
        let Unknown::General(size) = self.unknowns[unknown] else { return Dense::zeros(0, 0) };
        Dense { rows: size, columns: size, data: x[self.place(unknown)].to_vec() }
    }
}

//! A quadratic form that moves with the gains, for gains that move no faster than a bound.

use fspid_lti::Matrix;

use super::Effort;
use super::centres::{Chart, Goal, descend, rated_room};
use super::dense::Dense;
use super::inequality::{Factor, Form, Inequality, Measure, System, Unknown};
use super::lyapunov::closest_form;
use super::symmetric::{pack, packed_len, unpack};

/// Most gains that may move.
const GAINS_MAX: usize = 3;
/// How far the loop at a corner may be from affine, relative to its largest entry.
const AFFINE_TOLERANCE: f64 = 1e-9;
/// Smallest margin that counts: below it rounding in the differences decides.
const MARGIN_MIN: f64 = 1e-12;

/// One sample of a loop that is affine in gains between -1 and 1.
#[derive(Debug, Clone, PartialEq)]
pub struct GainFamily {
    /// $M_0$, then $M_j$ for each gain.
    parts: Vec<Dense>,
}

impl GainFamily {
    /// Family through the loops at the corners of the box of gains.
    #[must_use]
    pub fn from_corners(corners: &[Matrix]) -> Option<Self> {
        let gains = (0..=GAINS_MAX).find(|&gains| 1 << gains == corners.len())?;
        let corners: Vec<Dense> = corners.iter().map(Dense::from).collect();
        let size = corners.first()?.rows;
        let fits = |corner: &Dense| {
            corner.rows == size && corner.columns == size && corner.is_finite()
        };
        if size == 0 || !corners.iter().all(fits) {
            return None;
        }
        let share = 1.0 / corners.len() as f64;
        let mut parts = vec![Dense::zeros(size, size); gains + 1];
        for (number, corner) in corners.iter().enumerate() {
            for (part, sign) in parts.iter_mut().zip(signs(number, gains)) {
                part.add(share * sign, corner);
            }
        }
        let family = Self { parts };
        let affine = corners.iter().enumerate().all(|(number, corner)| {
            let error = family.at(&signs(number, gains)[1..]).plus(-1.0, corner).norm();
            error <= AFFINE_TOLERANCE * corner.norm()
        });
        affine.then_some(family)
    }

    /// Number of gains that move.
    #[must_use]
    pub fn gains(&self) -> usize {
        self.parts.len() - 1
    }

    fn at(&self, gains: &[f64]) -> Dense {
        combination(&self.parts, gains)
    }

    fn size(&self) -> usize {
        self.parts[0].rows
    }
}

/// 1, then -1 or 1 for each gain of the corner.
fn signs(corner: usize, gains: usize) -> Vec<f64> {
    let sign = |gain: usize| if corner >> gain & 1 == 1 { 1.0 } else { -1.0 };
    core::iter::once(1.0).chain((0..gains).map(sign)).collect()
}

/// $A_0 + \sum_j \kappa_j A_j$.
fn combination(parts: &[Dense], gains: &[f64]) -> Dense {
    let mut sum = parts[0].clone();
    for (part, gain) in parts[1..].iter().zip(gains) {
        sum.add(*gain, part);
    }
    sum
}

/// Gains now and one sample later, in half widths of the box.
pub type GainPair = (Vec<f64>, Vec<f64>);

/// A moving form that was found. Nothing here is proved: the numbers are rounded.
#[derive(Debug, Clone, PartialEq)]
pub struct MovingForm {
    /// $P_0$, then $P_j$ for each gain; symmetric bit for bit, with 1 as the largest diagonal entry of $P_0$.
    pub forms: Vec<Matrix>,
    /// By how much $\rho^2$ could fall before a block matrix at a corner becomes singular.
    pub margin: f64,
    /// Newton steps taken.
    pub steps: usize,
}

/// Whether a moving form was found.
#[derive(Debug, Clone, PartialEq)]
pub enum MovingVerdict {
    /// All block matrices are positive definite, as far as rounded arithmetic can tell.
    Found(MovingForm),
    /// The search ended without one, which proves nothing.
    NotFound {
        /// Largest margin that any form reached; minus infinity where the numbers of gains and changes differ.
        best_margin: f64,
    },
}

/// Looks for a form
#[must_use]
pub fn moving_form(
    family: &GainFamily,
    changes: &[f64],
    rate: f64,
    effort: &Effort,
) -> MovingVerdict {
    let missing = MovingVerdict::NotFound { best_margin: f64::NEG_INFINITY };
    let level = rate * rate;
    let Some(mut search) = Search::start(family, changes, effort) else { return missing };
    let goal = Goal::Below(level);
    let Some(descent) = descend(&mut search, goal, effort.newton_steps) else { return missing };
    match search.solution(level, descent.steps) {
        Some(form) if form.margin > MARGIN_MIN => MovingVerdict::Found(form),
        _ => MovingVerdict::NotFound { best_margin: level - descent.bound },
    }
}

/// The problem in coordinates z with x = T z, in which $P_0$ is the identity.
struct Search {
    family: GainFamily,
    pairs: Vec<GainPair>,
    transform: Dense,
    inverse: Dense,
    forms: Vec<Dense>,
}

impl Search {
    /// Starts from the form without motion that comes nearest.
    fn start(family: &GainFamily, changes: &[f64], effort: &Effort) -> Option<Self> {
        if changes.len() != family.gains() {
            return None;
        }
        let corners: Vec<Matrix> = (0..1 << family.gains())
            .map(|corner| family.at(&signs(corner, family.gains())[1..]).to_matrix())
            .collect::<Option<_>>()?;
        let size = family.size();
        let lower = closest_form(&corners, effort)?.cholesky()?;
        let mut forms = vec![Dense::zeros(size, size); family.gains() + 1];
        forms[0] = Dense::identity(size);
        let mut pairs = vec![];
        let grid: Vec<f64> = std::env::var("GRID").unwrap_or("-1,1".to_string()).split(',').map(|s| s.parse().unwrap()).collect();
        let g = grid.len();
        for k in 0..g*g*g { for d in 0..8 {
            let now = vec![grid[k%g], grid[k/g%g], grid[k/g/g]];
            let next: Vec<f64> = (0..3).map(|j| { let s = if d>>j&1==1 {1.0} else {-1.0}; if changes[j] < 1.0 { now[j] + s * changes[j] } else { s } }).collect();
            pairs.push((now, next));
        }}
        Some(Self {
            family: family.clone(),
            pairs,
            transform: lower.lower_inverse().transpose(),
            inverse: lower.transpose(),
            forms,
        })
    }

    /// The block matrices, for a family in any coordinates.
    fn system_of(&self, family: &GainFamily) -> System {
        let (size, gains) = (family.size(), family.gains());
        let unknowns = vec![Unknown::Symmetric(size); gains + 1];
        let mut system = System { unknowns, inequalities: vec![], measures: vec![] };
        for (now, next) in &self.pairs {
            let matrix = family.at(now);
            system.inequalities.push(Inequality {
        size,
        factors: vec![Factor::Unit { start: 0, size }, Factor::Matrix(matrix.transpose())],
        forms: vec![
            Form { factor: 0, rated: true, weights: weights(now, 1.0) },
            Form { factor: 1, rated: false, weights: weights(next, -1.0) },
        ],
        cross: None,
        scalars: vec![],
            });
            system.inequalities.push(Inequality {
        size,
        factors: vec![Factor::Unit { start: 0, size }],
        forms: vec![
            Form { factor: 0, rated: false, weights: weights(next, 1.0) },
        ],
        cross: None,
        scalars: vec![],
            });
            for gains in [now] {
                system.measures.push(Measure { weights: weights(gains, 1.0), multiplicity: 1.0 });
            }
        }
        system
    }

    fn solution(&self, level: f64, steps: usize) -> Option<MovingForm> {
        let size = Dense::identity(self.inverse.rows).congruence(&self.inverse).diagonal_max();
        let back = |form: &Dense| form.congruence(&self.inverse).scaled(1.0 / size);
        let forms: Vec<Dense> = self.forms.iter().map(back).collect();
        let system = self.system_of(&self.family);
        let x: Vec<f64> = forms.iter().flat_map(pack).collect();
        let margin = rated_room(&system, &x, level)?;
        let forms = forms.iter().map(Dense::to_matrix).collect::<Option<_>>()?;
        Some(MovingForm { forms, margin, steps })
    }
}

fn weights(gains: &[f64], sign: f64) -> Vec<(usize, f64)> {
    let moving = gains.iter().enumerate().map(|(gain, value)| (gain + 1, sign * value));
    core::iter::once((0, sign)).chain(moving).collect()
}

impl Chart for Search {
    fn system(&self) -> System {
        let turned = |part: &Dense| self.inverse.times(part).times(&self.transform);
        self.system_of(&GainFamily { parts: self.family.parts.iter().map(turned).collect() })
    }

    fn point(&self) -> Vec<f64> {
        self.forms.iter().flat_map(pack).collect()
    }

    fn accept(&mut self, x: &[f64]) {
        let size = self.transform.rows;
        let forms: Vec<Dense> =
            x.chunks(packed_len(size)).map(|form| unpack(form, size)).collect();
        if let Some(lower) = forms[0].cholesky() {
            let turn = lower.lower_inverse().transpose();
            self.transform = self.transform.times(&turn);
            self.inverse = lower.transpose().times(&self.inverse);
            self.forms = forms.iter().map(|form| form.congruence(&turn)).collect();
        }
    }
}

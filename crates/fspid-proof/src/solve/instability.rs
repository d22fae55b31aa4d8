//! A form that grows under an unstable matrix: the Lyapunov function of instability.

use fspid_lti::{Matrix, eigenvalues, modulus};

use super::dense::Dense;
use super::stein::{solution, stable_sum};
use super::symmetric::Spectrum;

/// The decay of the coordinates against the spectral radius.
const LOSS: f64 = 1.05;

/// An indefinite form that proves growth without knowing an eigenvalue.
///
/// $$ M^T P M - \sigma^2 P \succ 0, \quad x^T P x > 0, \quad \sigma \ge 1 $$
///
/// Then $V = x^T P x$ grows by more than $\sigma^2$ at every application of M from x on and
/// stays positive: the states leave every bound. With $\sigma = 1$ too, since $M^T P M - P \succeq \varepsilon I$
/// makes V grow by the factor $1 + \varepsilon / \lVert P \rVert$ at least.
#[derive(Debug, Clone, PartialEq)]
pub struct InstabilityForm {
    /// P, symmetric, with 1 as its entry of largest modulus.
    pub p: Matrix,
    /// State x of unit length in which the form is positive.
    pub direction: Vec<f64>,
    /// Factor $\sigma$, at least 1.
    pub factor: f64,
    /// Smallest eigenvalue of the difference in coordinates in which M is about as long as its
    /// spectral radius, relative to the largest of the form.
    pub margin: f64,
}

/// A form that proves that a matrix is unstable; `None` when its spectral radius is not above 1.
///
/// The factor lies half way, in proportion, between the largest eigenvalues and the next smaller ones, or 1
/// where these are stable: there the equation $M^T P M - \sigma^2 P = W$ is best conditioned.
///
/// # Source
/// The theorem of inertia for the discrete Lyapunov equation: H. K. Wimmer, On the Ostrowski–Schneider
/// inertia theorem, J. Mathematical Analysis and Applications 41 (1973) 164.
#[must_use]
pub fn instability_form(matrix: &Matrix) -> Option<InstabilityForm> {
    let mut moduli: Vec<f64> = eigenvalues(matrix).ok()?.into_iter().map(modulus).collect();
    moduli.sort_by(|left, right| right.total_cmp(left));
    let radius = moduli.first().copied().filter(|&radius| radius > 1.0)?;
    let mut best: Option<InstabilityForm> = None;
    // Below which eigenvalue the circle passes: the widest gap gives the largest margin.
    for pair in moduli.windows(2).map(|pair| (pair[0], pair[1])).chain([(radius, 1.0)]) {
        let (outer, inner) = (pair.0, pair.1.max(1.0));
        if outer > inner
            && let Some(form) = form_for(matrix, radius, (outer * inner).sqrt())
            && best.as_ref().is_none_or(|best| form.margin > best.margin)
        {
            best = Some(form);
        }
    }
    best
}

fn form_for(matrix: &Matrix, radius: f64, factor: f64) -> Option<InstabilityForm> {
    let (matrix, size) = (Dense::from(matrix), matrix.rows());
    let identity = Dense::identity(size);
    // Coordinates in which M is hardly longer than its spectral radius.
    let lower = stable_sum(&matrix.scaled(1.0 / (LOSS * radius)), &identity)?.cholesky()?;
    let upper = lower.transpose();
    let back = lower.lower_inverse().transpose();
    let turned = upper.times(&matrix).times(&back);
    let form = solution(&turned, factor * factor, &identity)?;
    let spectrum = Spectrum::of(&form);
    let largest = spectrum.largest().max(-spectrum.smallest());
    let gain = Spectrum::of(&form.congruence(&turned).plus(-factor * factor, &form)).smallest();
    if !(gain > 0.0 && spectrum.largest() > 0.0) {
        return None;
    }
    let direction = back.times_vector(&spectrum.vector(size - 1));
    let length = direction.iter().fold(0.0, |sum, x| sum + x * x).sqrt();
    let p = form.congruence(&upper);
    let entry = p.data.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    Some(InstabilityForm {
        p: p.scaled(1.0 / entry).to_matrix()?,
        direction: direction.iter().map(|value| value / length).collect(),
        factor,
        margin: gain / largest,
    })
}

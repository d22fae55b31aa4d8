//! Where a closed-loop response has a given size, as eigenvalues of a Hamiltonian matrix.

use core::f64::consts::SQRT_2;

use super::quick::quick_eigenvalues;
use super::reduced::Reduced;
use crate::error::LtiError;
use crate::matrix::Matrix;

/// A response at Nyquist's frequency, or at rest, is far enough from a level if its square differs by this much of it.
const CLEAR: f64 = 1e-3;
/// A map whose matrix is larger has a pole too near to the place that it sends to infinity.
const LARGE: f64 = 1e4;
/// What a difference from a level is taken for where it is smaller, relative to the level.
const LEAST: f64 = 1e-12;

/// $T = L / (1 + L)$ as a continuous system, $D + C (s I - A)^{-1} B$.
///
/// $$ s = \frac{z - 1}{z + 1} = j \tan \frac{\omega T}{2}, \quad A = (2 I + E)^{-1} E, \quad
/// B = \sqrt{2} (2 I + E)^{-1} b, \quad C = \sqrt{2} c (2 I + E)^{-1}, \quad D = -c (2 I + E)^{-1} b $$
///
/// with $E = A_z - b c - I$. A stable loop has no closed-loop pole at $z = -1$, however singular its state matrix and
/// whatever integrators it has. The other map, $1/s$, exchanges rest and Nyquist's frequency.
pub(super) struct Mapped {
    a: Matrix,
    b: Matrix,
    c: Matrix,
    d: f64,
    inverse: bool,
}

impl Mapped {
    /// The two maps of a stable loop, or one, should the other be singular.
    pub(super) fn both(reduced: &Reduced) -> Result<Vec<Self>, LtiError> {
        match (Self::new(reduced, false), Self::new(reduced, true)) {
            (Ok(first), Ok(second)) => Ok(vec![first, second]),
            (Ok(map), Err(_)) | (Err(_), Ok(map)) => Ok(vec![map]),
            (Err(error), Err(_)) => Err(error),
        }
    }

    fn new(reduced: &Reduced, inverse: bool) -> Result<Self, LtiError> {
        let order = reduced.order();
        let e = reduced.closed(1.0);
        let shifted = Matrix::from_function(order, order, |row, column| {
            e.at(row, column) + if row == column { 2.0 } else { 0.0 }
        });
        // z to −z: the same formulas for −A, b and −c.
        let (over, under) = if inverse { (shifted, e) } else { (e, shifted) };
        let joined = Matrix::from_function(order, order + 1, |row, column| {
            if column < order { over.at(row, column) } else { reduced.b()[row] }
        });
        let solved = under.solve(&joined)?;
        let last = |row: usize, _| if row + 1 == order { reduced.gamma() } else { 0.0 };
        let output = under.transpose().solve(&Matrix::from_function(order, 1, last))?;
        let scale = if inverse { -SQRT_2 } else { SQRT_2 };
        Ok(Self {
            a: Matrix::from_function(order, order, |row, column| solved.at(row, column)),
            b: Matrix::from_function(order, 1, |row, _| scale * solved.at(row, order)),
            c: output.scaled(SQRT_2).transpose(),
            d: -reduced.gamma() * solved.at(order - 1, order),
            inverse,
        })
    }

    /// Relative distance of $|T - t_0|^2$ from $\gamma^2$ at the place that is sent to infinity.
    fn distance(&self, centre: f64, value: f64) -> f64 {
        let d = (self.d - centre) / value;
        (1.0 - d) * (1.0 + d)
    }

    /// Angles near which $|T - t_0|$ has a value, and others, for a real $t_0$.
    ///
    /// $$ \gamma^2 - |T - t_0|^2 = 0 \iff j \tan \frac{\omega T}{2} \in \operatorname{eig} \begin{pmatrix}
    /// A + B \tilde D C / R & B B^T / R \cr -\gamma^2 C^T C / R & -(A + B \tilde D C / R)^T \end{pmatrix}, \quad
    /// \tilde D = D - t_0, \quad R = \gamma^2 - \tilde D^2 $$
    ///
    /// Of the maps the first that is far from trouble at its blind place, or the one that is farthest.
    pub(super) fn angles_of_distance(
        maps: &[Self],
        centre: f64,
        value: f64,
    ) -> Result<Vec<f64>, LtiError> {
        let room = |map: &Self| {
            (map.distance(centre, value).abs() / CLEAR).min(LARGE / map.a.norm_one()).min(1.0)
        };
        let mut best: Option<&Self> = None;
        for map in maps {
            if best.is_none_or(|best| room(map) > room(best)) {
                best = Some(map);
            }
        }
        let Some(map) = best else { return Ok(Vec::new()) };
        let found = quick_eigenvalues(&map.hamiltonian(centre, value)?)?;
        Ok(found.into_iter().filter(|s| s.im > 0.0).map(|s| map.angle_rad(s.im)).collect())
    }

    /// All in units of the value, so that γ = 1.
    fn hamiltonian(&self, centre: f64, value: f64) -> Result<Matrix, LtiError> {
        let order = self.a.rows();
        let distance = self.distance(centre, value);
        let r = if distance.abs() < LEAST { LEAST } else { distance };
        let through = (self.d - centre) / value;
        let corner = self.a.sum(&self.b.product(&self.c)?.scaled(through / (r * value)))?;
        Ok(Matrix::from_function(2 * order, 2 * order, |row, column| {
            let (i, j) = (row % order, column % order);
            match (row < order, column < order) {
                (true, true) => corner.at(i, j),
                (true, false) => self.b.at(i, 0) * self.b.at(j, 0) / (r * value),
                (false, true) => -self.c.at(0, i) * self.c.at(0, j) / (r * value),
                (false, false) => -corner.at(j, i),
            }
        }))
    }

    /// Angle $\omega T$ of a place on the imaginary axis.
    fn angle_rad(&self, s: f64) -> f64 {
        if self.inverse { 2.0 * libm::atan2(1.0, s.abs()) } else { 2.0 * libm::atan(s.abs()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::complex::modulus;
    use crate::sampled::zeta;

    #[test]
    fn either_map_finds_every_angle_at_which_the_distance_has_a_value() {
        // (z − 0.2)/((z − 0.9)(z − 0.5)) times 0.4.
        let a = Matrix::from_rows(&[[0.0, 1.0], [-0.45, 1.4]]).expect("a matrix");
        let reduced = Reduced::new(&a, &[0.0, 1.0], &[-0.08, 0.4]);
        let distance =
            |angle_rad: f64, centre: f64| modulus(reduced.at(zeta(angle_rad)).closed_less(centre));
        for (centre, angle_rad) in [(1.0, 0.4), (1.0, 2.0), (0.0, 0.7), (0.5, 1.1), (0.5, 2.9)] {
            let value = distance(angle_rad, centre);
            for map in Mapped::both(&reduced).expect("two maps") {
                let inverse = map.inverse;
                let found = Mapped::angles_of_distance(&[map], centre, value).expect("converges");
                let near = |at: &f64| (distance(*at, centre) / value - 1.0).abs() < 1e-9;
                assert!(
                    found.iter().any(|at| (at - angle_rad).abs() < 1e-7),
                    "{inverse} {found:?}"
                );
                let on_axis = found.iter().filter(|at| near(at)).count();
                assert!(on_axis > 0, "{inverse} {centre} {angle_rad}: {found:?}");
            }
        }
    }
}

//! The loop seen from the imaginary axis, where questions about the unit circle become eigenvalue problems.

use core::f64::consts::SQRT_2;

use super::reduced::Reduced;
use crate::complex::{Complex, modulus, reciprocal};
use crate::eigenvalues::eigenvalues;
use crate::error::LtiError;
use crate::matrix::Matrix;

/// A response at Nyquist's frequency, or at rest, is far enough from a level if it differs by this much of it.
const CLEAR: f64 = 1e-3;
/// What a difference from a level is taken for where it is smaller, relative to the level.
const LEAST: f64 = 1e-12;

/// $T_f = L / (1 + f L)$ as a continuous system, $D + C (s I - A)^{-1} B$, for a factor f of 1 or −1.
///
/// $$ s = \frac{z - 1}{z + 1} = j \tan \frac{\omega T}{2}, \quad A = (2 I + E)^{-1} E, \quad
/// B = \sqrt{2} (2 I + E)^{-1} b, \quad C = \sqrt{2}\, c\, (2 I + E)^{-1}, \quad D = -c (2 I + E)^{-1} b $$
///
/// with $E = A_z - f b c - I$. The loop closed around L has no pole at $z = -1$ when it is stable, however singular
/// the state matrix and whatever integrators L has. The other map, $1/s$, exchanges rest and Nyquist's frequency.
pub(super) struct Bilinear {
    a: Matrix,
    b: Matrix,
    c: Matrix,
    d: f64,
    factor: f64,
    inverse: bool,
}

impl Bilinear {
    fn new(reduced: &Reduced, factor: f64, inverse: bool) -> Result<Self, LtiError> {
        let order = reduced.order();
        let e = reduced.closed(factor);
        let shifted = Matrix::from_function(order, order, |row, column| {
            e.at(row, column) + if row == column { 2.0 } else { 0.0 }
        });
        // z to −z: the same formulas for −A, b and −c.
        let (over, under) = if inverse { (shifted, e) } else { (e, shifted) };
        let joined = Matrix::from_function(order, order + 1, |row, column| {
            if column < order { over.at(row, column) } else { reduced.b()[row] }
        });
        let solved = under.solve(&joined)?;
        let output =
            Matrix::from_function(
                order,
                1,
                |row, _| {
                    if row + 1 == order { reduced.gamma() } else { 0.0 }
                },
            );
        let output = under.transpose().solve(&output)?;
        let scale = if inverse { -SQRT_2 } else { SQRT_2 };
        Ok(Self {
            a: Matrix::from_function(order, order, |row, column| solved.at(row, column)),
            b: Matrix::from_function(order, 1, |row, _| scale * solved.at(row, order)),
            c: output.scaled(SQRT_2).transpose(),
            d: -reduced.gamma() * solved.at(order - 1, order),
            factor,
            inverse,
        })
    }

    /// The first of the four choices that is far from trouble at the end where the map is blind, or the best of them.
    fn choose(
        reduced: &Reduced,
        factors: &[f64],
        distance: impl Fn(&Self) -> f64,
    ) -> Result<Self, LtiError> {
        let mut best: Result<Self, LtiError> =
            Err(LtiError::NotConverged { what: "choice of a map", iterations: 0 });
        let mut best_distance = -1.0;
        for inverse in [false, true] {
            for &factor in factors {
                match Self::new(reduced, factor, inverse) {
                    Ok(map) => {
                        let own = distance(&map);
                        if own > CLEAR {
                            return Ok(map);
                        }
                        if own > best_distance || best.is_err() {
                            (best, best_distance) = (Ok(map), own);
                        }
                    }
                    Err(error) if best.is_err() => best = Err(error),
                    Err(_) => {}
                }
            }
        }
        best
    }

    /// Angles near which $|L| = 1$, that is $\operatorname{Re} T_f = f / 2$, and others.
    ///
    /// The even part of $T_f$ is a system in $w = s^2$ of the order of the loop:
    ///
    /// $$ \operatorname{Re} T_f - \frac{f}{2} = R + C A (w I - A^2)^{-1} B, \quad R = D - \frac{f}{2}, \quad
    /// w \in \operatorname{eig}(A^2 - B C A / R) $$
    pub(super) fn angles_of_unit_gain(reduced: &Reduced) -> Result<Vec<f64>, LtiError> {
        let distance = |map: &Self| (map.d - 0.5 * map.factor).abs() / (map.d.abs() + 0.5);
        let map = Self::choose(reduced, &[1.0, -1.0], distance)?;
        let at_end = away_from_zero(map.d - 0.5 * map.factor, map.d.abs() + 0.5);
        let square = map.a.product(&map.a)?;
        let output = map.c.product(&map.a)?;
        let closed = square.sum(&map.b.product(&output)?.scaled(-1.0 / at_end))?;
        Ok(map.angles_of_squares(&eigenvalues(&closed)?))
    }

    /// Angles near which L is real, that is $\operatorname{Im} T_f = 0$, and others; without 0 and π.
    ///
    /// The odd part of $T_f$ over s is $G(w) = C (w I - A^2)^{-1} B$ with $w = s^2$. Its zeros are those of its image under
    /// $w = w_0 + 1/p$, with $M = (A^2 - w_0 I)^{-1}$:
    ///
    /// $$ p \in \operatorname{eig}\left(M - \frac{M B\, C M}{C M B}\right) $$
    ///
    /// Once with $w_0$ near the slow modes, once near the fast ones, because zeros far from it are not found well.
    pub(super) fn angles_of_real_values(reduced: &Reduced) -> Result<Vec<f64>, LtiError> {
        let map = Self::choose(reduced, &[1.0, -1.0], |_| 1.0)?;
        let square = map.a.product(&map.a)?;
        let poles = eigenvalues(&square)?;
        let sizes = || poles.iter().map(|&pole| modulus(pole)).filter(|&size| size > 0.0);
        let ends = [sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max)];
        let mut angles = Vec::new();
        for end in ends {
            let size = if end.is_normal() { end } else { 1.0 };
            angles.extend(map.zeros_about(&square, clear_of(&poles, size))?);
        }
        Ok(angles)
    }

    fn zeros_about(&self, square: &Matrix, centre: f64) -> Result<Vec<f64>, LtiError> {
        let order = square.rows();
        let identity = Matrix::identity(order);
        let m = square.sum(&identity.scaled(-centre))?.solve(&identity)?;
        let (input, output) = (m.product(&self.b)?, self.c.product(&m)?);
        let value = output.product(&self.b)?.at(0, 0);
        if value == 0.0 {
            return Ok(Vec::new());
        }
        let zeros = eigenvalues(&m.sum(&input.product(&output)?.scaled(-1.0 / value))?)?;
        let finite = zeros.into_iter().filter(|&p| modulus(p) > 0.0);
        let squares: Vec<Complex> = finite.map(|p| reciprocal(p) + centre).collect();
        Ok(self.angles_of_squares(&squares))
    }

    /// Angles near which $|T - t_0|$ has a value, and others, for a real $t_0$.
    ///
    /// $$ \gamma^2 - |T - t_0|^2 = 0 \iff j \tan \frac{\omega T}{2} \in \operatorname{eig} \begin{pmatrix}
    /// A + B \tilde D C / R & B B^T / R \\ -\gamma^2 C^T C / R & -(A + B \tilde D C / R)^T \end{pmatrix}, \quad
    /// \tilde D = D - t_0, \quad R = \gamma^2 - \tilde D^2 $$
    pub(super) fn angles_of_distance(
        reduced: &Reduced,
        centre: f64,
        value: f64,
    ) -> Result<Vec<f64>, LtiError> {
        let at_end = |map: &Self| {
            let d = map.d - centre;
            (value - d) * (value + d) / (value * value)
        };
        let map = Self::choose(reduced, &[1.0], |map| at_end(map).abs())?;
        let r = away_from_zero(at_end(&map), 1.0);
        let scale = 1.0 / value;
        // All in units of the value, so that γ = 1.
        let (order, d) = (reduced.order(), (map.d - centre) * scale);
        let corner = map.a.sum(&map.b.product(&map.c)?.scaled(d / r * scale))?;
        let hamiltonian = Matrix::from_function(2 * order, 2 * order, |row, column| {
            let (i, j) = (row % order, column % order);
            match (row < order, column < order) {
                (true, true) => corner.at(i, j),
                (true, false) => map.b.at(i, 0) * map.b.at(j, 0) * scale / r,
                (false, true) => -map.c.at(0, i) * map.c.at(0, j) * scale / r,
                (false, false) => -corner.at(j, i),
            }
        });
        let found = eigenvalues(&hamiltonian)?;
        Ok(found.into_iter().filter(|s| s.im > 0.0).map(|s| map.angle_rad(s.im)).collect())
    }

    /// Angle $\omega T$ of a place on the imaginary axis.
    fn angle_rad(&self, s: f64) -> f64 {
        if self.inverse { 2.0 * libm::atan2(1.0, s.abs()) } else { 2.0 * libm::atan(s.abs()) }
    }

    /// Angles that belong to squares of s: the exact ones are real and negative, the others do no harm.
    fn angles_of_squares(&self, squares: &[Complex]) -> Vec<f64> {
        let s = squares.iter().map(|&w| (0.5 * (modulus(w) - w.re)).sqrt());
        s.filter(|&s| s > 0.0).map(|s| self.angle_rad(s)).collect()
    }
}

/// A value, or the smallest one of its sign that is still safe to divide by.
fn away_from_zero(value: f64, scale: f64) -> f64 {
    if value.abs() >= LEAST * scale { value } else { LEAST * scale }
}

/// A positive number of about this size that is no eigenvalue and not near one.
fn clear_of(eigenvalues: &[Complex], size: f64) -> f64 {
    let distance = |place: f64| {
        let distances = eigenvalues.iter().map(|&value| modulus(value - place));
        distances.fold(f64::INFINITY, f64::min) / place
    };
    let places = [1.0, 1.7, 0.6, 3.0, 0.3, 5.0].map(|step| step * size);
    places.into_iter().max_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or(size)
}

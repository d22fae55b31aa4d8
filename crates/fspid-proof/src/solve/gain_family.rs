//! One sample of a loop as an affine function of gains in a box.

use fspid_lti::Matrix;

use super::dense::Dense;

/// Most gains that may move.
const GAINS_MAX: usize = 3;
/// How far the loop at a corner may be from affine, relative to its largest entry.
const AFFINE_TOLERANCE: f64 = 1e-9;

/// One sample of a loop that is affine in gains, which are counted in half widths of their box.
///
/// $$ M(\kappa) = M_0 + \sum_j \kappa_j M_j, \quad \kappa_j \in [-1, 1] $$
#[derive(Debug, Clone, PartialEq)]
pub struct GainFamily {
    /// $M_0$, then $M_j$ for each gain.
    pub(super) parts: Vec<Dense>,
}

impl GainFamily {
    /// Family through the loops at the corners of the box of gains.
    ///
    /// There are $2^g$ corners for g gains, at most three; in the corner with number c the gain j is at its
    /// upper end when bit j of c is set. `None` for another number, for matrices that do not fit each other
    /// or are not finite, and for corners that no affine family goes through.
    #[must_use]
    pub fn from_corners(corners: &[Matrix]) -> Option<Self> {
        let gains = (0..=GAINS_MAX).find(|&gains| 1 << gains == corners.len())?;
        let corners: Vec<Dense> = corners.iter().map(Dense::from).collect();
        let size = corners.first()?.rows;
        let fits =
            |corner: &Dense| corner.rows == size && corner.columns == size && corner.is_finite();
        if size == 0 || !corners.iter().all(fits) {
            return None;
        }
        let share = 1.0 / corners.len() as f64;
        let mut parts = vec![Dense::zeros(size, size); gains + 1];
        for (number, corner) in corners.iter().enumerate() {
            let signs = corner_gains(number, gains);
            for (part, sign) in parts.iter_mut().zip([1.0].iter().chain(&signs)) {
                part.add(share * sign, corner);
            }
        }
        let family = Self { parts };
        let affine = corners.iter().enumerate().all(|(number, corner)| {
            let error = family.at(&corner_gains(number, gains)).plus(-1.0, corner).norm();
            error <= AFFINE_TOLERANCE * corner.norm()
        });
        affine.then_some(family)
    }

    /// Number of gains that move.
    #[must_use]
    pub fn gains(&self) -> usize {
        self.parts.len() - 1
    }

    /// Number of states.
    pub(super) fn size(&self) -> usize {
        self.parts[0].rows
    }

    pub(super) fn at(&self, gains: &[f64]) -> Dense {
        combination(&self.parts, gains)
    }
}

/// -1 or 1 for each gain of the corner with this number.
pub(super) fn corner_gains(number: usize, gains: usize) -> Vec<f64> {
    (0..gains).map(|gain| if number >> gain & 1 == 1 { 1.0 } else { -1.0 }).collect()
}

/// $A_0 + \sum_j \kappa_j A_j$.
pub(super) fn combination(parts: &[Dense], gains: &[f64]) -> Dense {
    let mut sum = parts[0].clone();
    for (part, gain) in parts[1..].iter().zip(gains) {
        sum.add(*gain, part);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scalar(value: f64) -> Matrix {
        Matrix::from_rows(&[[value]]).unwrap()
    }

    #[test]
    fn a_family_goes_through_its_corners() {
        let corners = [1.0, 3.0, 5.0, 7.0].map(scalar);
        let family = GainFamily::from_corners(&corners).unwrap();
        assert_eq!(family.gains(), 2);
        assert!((family.at(&[0.5, -1.0])[(0, 0)] - 2.5).abs() < 1e-15);
        assert!((family.at(&corner_gains(2, family.gains()))[(0, 0)] - 5.0).abs() < 1e-15);
    }

    #[test]
    fn corners_that_are_not_affine_or_of_another_number_are_refused() {
        assert_eq!(GainFamily::from_corners(&[1.0, 3.0, 5.0, 7.1].map(scalar)), None);
        assert_eq!(GainFamily::from_corners(&[1.0, 3.0, 5.0].map(scalar)), None);
        assert_eq!(GainFamily::from_corners(&[]), None);
        assert_eq!(GainFamily::from_corners(&[scalar(1.0), Matrix::identity(2)]), None);
    }
}

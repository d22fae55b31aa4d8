//! Partition of the supervisor's input plane into double cones.

use core::f64::consts::PI;

use fspid_numeric::scalar::Interval;

use super::{GainCell, GainSet};

/// How far an input may be moved by the rounding of its computation, as a share of the coordinates
/// at hand: $2^{-40}$. Cells reach so much further here.
const ROUNDING: f64 = 1.0 / (1_u64 << 40) as f64;

/// A double cone with its tip at the origin of the supervisor's inputs $x$ = (error, change).
///
/// $$ (n_1 \cdot x) (n_2 \cdot x) \ge 0 $$
///
/// It is the same for either sign of the inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Cone {
    /// Normals of the two lines that bound it, pointing inward in the same half.
    pub normals: [[f64; 2]; 2],
    /// The cells whose gains may be in force in it.
    pub cells: Vec<usize>,
}

impl GainSet {
    /// Divides the plane of the supervisor's inputs into `count` double cones of equal angles; at
    /// least one, which is the whole plane.
    ///
    /// Every point lies in a cone, and where a point of a cone lies in a cell, the cone names the
    /// cell: also on borders, and also if both are moved by rounding.
    #[must_use]
    pub fn cones(&self, count: usize) -> Vec<Cone> {
        let count = count.max(1);
        let normal = |index: usize| {
            // Exactly the first one turned round, so that the cones close.
            if index == count {
                return [0.0, -1.0];
            }
            let angle = PI * index as f64 / count as f64;
            [-libm::sin(angle), libm::cos(angle)]
        };
        let cone = |index: usize| {
            let [x, y] = normal(index + 1);
            let normals = [normal(index), [-x, -y]];
            let cells = self.cells.iter().enumerate();
            let meeting = cells.filter(|(_, cell)| meets(cell, normals)).map(|(index, _)| index);
            Cone { normals, cells: meeting.collect() }
        };
        (0..count).map(cone).collect()
    }
}

/// Whether a cell and a double cone have a point in common.
///
/// They have none if and only if all of the cell lies between the two halves, where the two
/// products are of opposite and everywhere the same signs. Over a box a linear form takes just the
/// values of its interval.
fn meets(cell: &GainCell, normals: [[f64; 2]; 2]) -> bool {
    let [error, change] = [cell.error, cell.change].map(widened);
    let [one, other] =
        normals.map(|[x, y]| Interval::point(x) * error + Interval::point(y) * change);
    let apart = |one: Interval, other: Interval| one.lower() > 0.0 && other.upper() < 0.0;
    !(apart(one, other) || apart(other, one))
}

fn widened([lower, upper]: [f64; 2]) -> Interval {
    let side = Interval::new(lower, upper).unwrap_or(Interval::ENTIRE);
    let ends = [lower, upper].map(f64::abs).into_iter().filter(|end| end.is_finite());
    let slack = ROUNDING * ends.fold(0.0, f64::max);
    side + Interval::between(-slack, slack)
}

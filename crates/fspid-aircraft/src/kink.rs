//! Kinks of an aircraft's data right at a trim, where small motions are others on each side.
//!
//! Tables are straight between their breakpoints, and gearings have corners. A difference across such a place is the mean
//! of two slopes, which is the slope of nothing that flies: poles, margins and modes that rest on it are those of no
//! aircraft. Beside the place everything is smooth.

use crate::aerodynamics::ForceModel;
use crate::aircraft::Aircraft;
use crate::controls::CONTROLS;
use crate::linearise::{STATES, half_width};
use crate::trim::Trim;

/// States and controls.
const COLUMNS: usize = STATES + CONTROLS;
/// Slopes on both sides that differ by no more than this, and this share of their sizes, are one: what rounding and a bent
/// curve leave. In the units of the motion, 1/s: by less than this nothing grows that a flight shows.
const SAME_SLOPE: f64 = 1e-4;
/// Over a quarter of the width a bent curve shows a quarter of the difference, a kink that lies in it most of it, and one that
/// lies beside it nothing.
const QUARTER: f64 = 0.25;
const BENT: core::ops::RangeInclusive<f64> = 0.15..=0.4;
/// u, w, theta and q with the altitude, elevator and throttle.
const LONGITUDINAL: [usize; 7] = [2, 3, 5, 7, 10, STATES, STATES + 3];
/// v, phi, p and r, aileron and rudder.
const LATERAL: [usize; 6] = [4, 6, 9, 11, STATES + 1, STATES + 2];

impl<M: ForceModel> Aircraft<M> {
    /// True where the aircraft's data have a kink at a trim: the slopes on both sides of a state or a control are two.
    ///
    /// What sideways motions do to those in the plane of symmetry is left out: it comes back in nothing, so that the drag of
    /// a sideslip may have its corner at 0.
    #[must_use]
    pub fn has_kink_at(&self, trim: &Trim) -> bool {
        let (at, rate) = self.rates_about(trim);
        let rest = rate(&at);
        let slopes = |column: usize, width: f64| {
            let moved = |by: f64| {
                let mut values = at;
                values[column] += by;
                rate(&values)
            };
            let (more, less) = (moved(width), moved(-width));
            let slope =
                |row: usize| [(more[row] - rest[row]) / width, (rest[row] - less[row]) / width];
            core::array::from_fn::<_, STATES, _>(slope)
        };
        let of = |rows: &[usize]| {
            rows.iter().any(|&column| {
                let width = half_width(at[column]);
                let wide = slopes(column, width);
                let rows = rows.iter().copied().filter(|row| *row < STATES);
                let differing: Vec<usize> = rows.filter(|row| differ(wide[*row])).collect();
                if differing.is_empty() {
                    return false;
                }
                let near = slopes(column, QUARTER * width);
                differing.iter().any(|&row| !is_bent(wide[row], near[row]))
            })
        };
        of(&LONGITUDINAL) || of(&LATERAL)
    }
}

const _: () = assert!(LONGITUDINAL.len() + LATERAL.len() + 3 == COLUMNS);

/// Written so that NaN differs.
fn differ([ahead, behind]: [f64; 2]) -> bool {
    !((ahead - behind).abs() <= SAME_SLOPE * (1.0 + ahead.abs() + behind.abs()))
}

/// True for the slopes of a smooth curve over a width and over a quarter of it.
fn is_bent(wide: [f64; 2], near: [f64; 2]) -> bool {
    BENT.contains(&((near[0] - near[1]) / (wide[0] - wide[1])))
}

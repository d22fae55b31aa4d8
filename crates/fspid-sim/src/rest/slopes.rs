//! Linearisation of the rules: slopes of the gains over what the supervisor sees, on every side of a kink at an equilibrium.

use core::f64::consts::PI;

use fspid_core::{Change, SecondInput};

use super::Holding;
use crate::math::sin_cos;

/// Directions around a place in which slopes are taken, evenly: kinks of triangles and of the smaller of two grades
/// lie along the axes and at multiples of an eighth of a turn, between two of these.
pub(super) const DIRECTIONS: usize = 16;
/// How far from rest, and how far apart the two values of a difference, as shares of the supervisor's range. Values
/// are good to some $10^{-13}$ of it, so that slopes are to $10^{-6}$; [`SAME`] is a hundred times that.
const AROUND: f64 = 1e-5;
const APART: f64 = 1e-7;
/// Slopes that differ by less are the same.
const SAME: f64 = 1e-4;

/// Slopes of the gains along the first and the second input, in units of the loop.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Slopes {
    pub(super) kp: [f64; 2],
    pub(super) ki: [f64; 2],
    pub(super) kd: [f64; 2],
}

impl Slopes {
    fn all(&self) -> impl Iterator<Item = &f64> {
        self.kp.iter().chain(&self.ki).chain(&self.kd)
    }

    pub(super) fn is_near(&self, other: &Self) -> bool {
        self.all().zip(other.all()).all(|(one, two)| {
            (one - two).abs() <= SAME * (one.abs() + two.abs()) + f64::MIN_POSITIVE
        })
    }
}

/// The direction in which one motion leaves a place, of [`DIRECTIONS`].
pub(super) fn direction([first, second]: [f64; 2]) -> usize {
    let turns = libm::atan2(second, first) / (2.0 * PI);
    let turns = if turns < 0.0 { turns + 1.0 } else { turns };
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and the number of directions"
    )]
    let index = (turns * DIRECTIONS as f64) as usize;
    index.min(DIRECTIONS - 1)
}

impl Holding<'_> {
    /// Slopes in each direction from a place, in the supervisor's units, outside of any dead zone.
    pub(super) fn slopes_around(&self, centre: [f64; 2]) -> [Slopes; DIRECTIONS] {
        let supervisor = self.fspid.tuner().supervisor();
        let away = AROUND * supervisor.range();
        let is_inside = centre.iter().all(|seen| seen.abs() + away < supervisor.range());
        if supervisor.network().is_some() && is_inside {
            // A network has no kinks but at the ends of its range, and at rest its slopes are zero.
            return [self.slopes_at(centre); DIRECTIONS];
        }
        core::array::from_fn(|index| {
            let turns = (index as f64 + 0.5) / DIRECTIONS as f64;
            let (sine, cosine) = sin_cos(2.0 * PI * turns);
            self.slopes_at([centre[0] + away * cosine, centre[1] + away * sine])
        })
    }

    fn slopes_at(&self, place: [f64; 2]) -> Slopes {
        let tuner = self.fspid.tuner();
        let apart = APART * tuner.supervisor().range();
        let per_unit = self.seen_per_unit();
        let mut slopes = Slopes::default();
        for input in 0..2 {
            let moved = |by: f64| {
                let mut place = place;
                place[input] += by;
                self.gains_at(place)
            };
            let (more, less) = (moved(apart), moved(-apart));
            let by = per_unit[input] / (2.0 * apart);
            slopes.kp[input] = by * (more.kp - less.kp);
            slopes.ki[input] = by * (more.ki - less.ki);
            slopes.kd[input] = by * (more.kd - less.kd);
        }
        slopes
    }

    /// What the supervisor sees of a unit of error, and of a unit of what stands beside it.
    pub(super) fn seen_per_unit(&self) -> [f64; 2] {
        let settings = self.fspid.tuner().settings();
        let scale = settings.input_scale;
        let time_s = match (settings.second_input, settings.change) {
            (SecondInput::Change, Change::Rate) => self.fspid.config().dt_s,
            _ => 1.0,
        };
        [self.sign() * scale.error_per_rad, self.sign() * scale.change_per_rad / time_s]
    }
}

//! Where an aircraft comes to whose pitch is held elsewhere while nobody moves the throttle.

use fspid_lti::Matrix;

use super::{Search, Trim, TrimPoint, TrimTarget};
use crate::aerodynamics::ForceModel;
use crate::aircraft::Aircraft;

/// The pitch is moved in steps of no more than this, rad: each begins near where the last one ended.
const STEP_RAD: f64 = 0.02;
/// Newton steps for each; from so near it takes three or four.
const NEWTON_STEPS: usize = 12;

/// What is looked for.
#[derive(Debug, Clone, Copy)]
struct Unknowns {
    airspeed_m_s: f64,
    alpha_rad: f64,
    elevator_rad: f64,
}

impl Unknowns {
    fn to_array(self) -> [f64; 3] {
        [self.airspeed_m_s, self.alpha_rad, self.elevator_rad]
    }

    fn from_array([airspeed_m_s, alpha_rad, elevator_rad]: [f64; 3]) -> Self {
        Self { airspeed_m_s, alpha_rad, elevator_rad }
    }
}

impl<M: ForceModel> Aircraft<M> {
    /// The straight flight that a trim comes to when its pitch angle is held `by_rad` higher with its throttle: airspeed and
    /// path are others, and the air is that of its altitude, $\gamma = \theta - \alpha$. None where there is no such flight
    /// within the limits of the data and the stops, or none that is found on the way there.
    #[must_use]
    pub fn at_held_pitch(&self, trim: &Trim, by_rad: f64) -> Option<Trim> {
        let theta_rad = trim.point.alpha_rad + trim.target.flight_path_rad;
        let mut at = Unknowns {
            airspeed_m_s: trim.target.airspeed_m_s,
            alpha_rad: trim.point.alpha_rad,
            elevator_rad: trim.point.elevator_rad,
        };
        let steps = (by_rad.abs() / STEP_RAD).ceil();
        let mut step = 0.0;
        // Written so that NaN takes none.
        while step < steps {
            step += 1.0;
            at = self.held_at(trim, theta_rad + by_rad * step / steps, at)?;
        }
        let (target, point) = meant(trim, theta_rad + by_rad, at);
        let residual = self.trim_residual(target, point);
        let is_within = self.trim_departures(target, &point).is_empty();
        let found = Search { target, point, residual, iterations: NEWTON_STEPS };
        (residual.accepted() && is_within).then(|| self.trim_at(found))
    }

    /// Newton's method from near.
    fn held_at(&self, trim: &Trim, theta_rad: f64, from: Unknowns) -> Option<Unknowns> {
        let left = |at: [f64; 3]| {
            let (target, point) = meant(trim, theta_rad, Unknowns::from_array(at));
            self.trim_residual(target, point)
        };
        let mut at = from.to_array();
        for _ in 0..NEWTON_STEPS {
            let residual = left(at);
            if residual.accepted() {
                break;
            }
            let mut jacobian = Matrix::zeros(3, 3);
            for column in 0..3 {
                let width = super::search::step_size(at[column]);
                let beside = |by: f64| {
                    let mut moved = at;
                    moved[column] += by;
                    left(moved).to_array()
                };
                let (ahead, behind) = (beside(width), beside(-width));
                for row in 0..3 {
                    jacobian.set(row, column, (ahead[row] - behind[row]) / (2.0 * width)).ok()?;
                }
            }
            let rest = residual.to_array().map(|value| [-value]);
            let step = jacobian.solve(&Matrix::from_rows(&rest).ok()?).ok()?;
            at.iter_mut().zip(step.data()).for_each(|(value, step)| *value += step);
            // Written so that NaN ends it.
            if !(at[0] > 0.0) {
                return None;
            }
        }
        left(at).accepted().then(|| Unknowns::from_array(at))
    }
}

fn meant(trim: &Trim, theta_rad: f64, at: Unknowns) -> (TrimTarget, TrimPoint) {
    let Unknowns { airspeed_m_s, alpha_rad, elevator_rad } = at;
    let flight_path_rad = theta_rad - alpha_rad;
    let target = TrimTarget { airspeed_m_s, flight_path_rad, ..trim.target };
    (target, TrimPoint { alpha_rad, elevator_rad, throttle: trim.point.throttle })
}

//! Where an aircraft comes to whose pitch or path is held elsewhere, with its throttle as it stands or at another airspeed.

use fspid_lti::Matrix;

use super::{Search, Trim, TrimPoint, TrimTarget};
use crate::aerodynamics::ForceModel;
use crate::aircraft::Aircraft;

/// What is held is moved in steps of no more than this, and shorter ones where it takes them: each begins near where the last one
/// ended. Angles in rad, airspeed as a part of itself, the throttle in its measure.
const STEP: f64 = 0.02;
/// The same of altitude, m, which moves little beside.
const STEP_M: f64 = 100.0;
/// More steps lead nowhere that an aircraft flies.
const MOST_STEPS: f64 = 2000.0;
/// Shortest step, as a part of the longest: where the thrust is hardly more than the least drag, a small change of the path is a
/// large one of airspeed.
const SHORTEST: f64 = 1.0 / 1024.0;
/// Largest change of airspeed from step to step, as a part of it: beyond may lie another flight that has the same path.
const NEAR: f64 = 0.05;
/// Newton steps for each; from so near it takes three or four.
const NEWTON_STEPS: usize = 12;
/// What is held is held to this, rad, m/s or in the measure of the throttle.
const HELD_TO: f64 = 1e-10;

/// What makes the airspeed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Power {
    /// A throttle that nobody moves, in the measure of the model.
    Throttle(f64),
    /// An airspeed that somebody holds with the throttle, m/s.
    Airspeed(f64),
}

/// What makes the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Path {
    /// A pitch angle that is held, rad.
    Pitch(f64),
    /// An angle over the horizon that is held, climbing positive, rad.
    FlightPath(f64),
    /// A vertical speed that is held, climbing positive, m/s.
    VerticalSpeed(f64),
    /// An airspeed that is held with the path, m/s.
    Airspeed(f64),
}

/// What is held of a straight flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Held {
    /// What makes its airspeed.
    pub power: Power,
    /// What makes its path.
    pub path: Path,
    /// Its altitude, m.
    pub altitude_m: f64,
}

/// What is looked for.
#[derive(Debug, Clone, Copy)]
struct Unknowns {
    airspeed_m_s: f64,
    alpha_rad: f64,
    elevator_rad: f64,
    throttle: f64,
    flight_path_rad: f64,
}

/// On the way to what is held: what power, path and altitude are there.
#[derive(Debug, Clone, Copy)]
struct OnTheWay {
    held: Held,
    values: [f64; 2],
    altitude_m: f64,
}

impl Unknowns {
    fn of(trim: &Trim) -> Self {
        Self {
            airspeed_m_s: trim.target.airspeed_m_s,
            alpha_rad: trim.point.alpha_rad,
            elevator_rad: trim.point.elevator_rad,
            throttle: trim.point.throttle,
            flight_path_rad: trim.target.flight_path_rad,
        }
    }

    fn to_array(self) -> [f64; 5] {
        let Self { airspeed_m_s, alpha_rad, elevator_rad, throttle, flight_path_rad } = self;
        [airspeed_m_s, alpha_rad, elevator_rad, throttle, flight_path_rad]
    }

    fn from_array(values: [f64; 5]) -> Self {
        let [airspeed_m_s, alpha_rad, elevator_rad, throttle, flight_path_rad] = values;
        Self { airspeed_m_s, alpha_rad, elevator_rad, throttle, flight_path_rad }
    }

    /// True for one that is not far from it, as the next on the way is.
    fn is_near(&self, next: &Self) -> bool {
        (next.airspeed_m_s / self.airspeed_m_s - 1.0).abs() <= NEAR
    }

    /// What it means at an altitude.
    fn meant(self, altitude_m: f64) -> (TrimTarget, TrimPoint) {
        let Self { airspeed_m_s, alpha_rad, elevator_rad, throttle, flight_path_rad } = self;
        let target = TrimTarget { airspeed_m_s, flight_path_rad, altitude_m };
        (target, TrimPoint { alpha_rad, elevator_rad, throttle })
    }

    /// What power and path are in it.
    fn found(self, held: &Held) -> [f64; 2] {
        let power = match held.power {
            Power::Throttle(_) => self.throttle,
            Power::Airspeed(_) => self.airspeed_m_s,
        };
        let path = match held.path {
            Path::Pitch(_) => self.alpha_rad + self.flight_path_rad,
            Path::FlightPath(_) => self.flight_path_rad,
            Path::VerticalSpeed(_) => self.airspeed_m_s * libm::sin(self.flight_path_rad),
            Path::Airspeed(_) => self.airspeed_m_s,
        };
        [power, path]
    }
}

impl Held {
    /// What power and path are to be.
    fn wanted(&self) -> [f64; 2] {
        let (Power::Throttle(power) | Power::Airspeed(power)) = self.power;
        let (Path::Pitch(path)
        | Path::FlightPath(path)
        | Path::VerticalSpeed(path)
        | Path::Airspeed(path)) = self.path;
        [power, path]
    }

    /// How long the steps of power and path may be, beside an airspeed.
    fn steps(&self, airspeed_m_s: f64) -> [f64; 2] {
        let by_airspeed = STEP * airspeed_m_s;
        let power = match self.power {
            Power::Throttle(_) => STEP,
            Power::Airspeed(_) => by_airspeed,
        };
        let path = match self.path {
            Path::Pitch(_) | Path::FlightPath(_) => STEP,
            Path::VerticalSpeed(_) | Path::Airspeed(_) => by_airspeed,
        };
        [power, path]
    }
}

impl<M: ForceModel> Aircraft<M> {
    /// The straight flight that a trim comes to when its pitch angle is held `by_rad` higher with its throttle: airspeed and
    /// path are others, and the air is that of its altitude, $\gamma = \theta - \alpha$. None as of [`at_held`](Self::at_held).
    #[must_use]
    pub fn at_held_pitch(&self, trim: &Trim, by_rad: f64) -> Option<Trim> {
        let theta_rad = trim.point.alpha_rad + trim.target.flight_path_rad;
        let held = Held {
            power: Power::Throttle(trim.point.throttle),
            path: Path::Pitch(theta_rad + by_rad),
            altitude_m: trim.target.altitude_m,
        };
        self.at_held(trim, &held)
    }

    /// The straight flight that a trim comes to when this is held. None where there is no such flight within the limits of
    /// the data and the stops, or none that is found on the way there.
    #[must_use]
    pub fn at_held(&self, trim: &Trim, held: &Held) -> Option<Trim> {
        let mut at = Unknowns::of(trim);
        let (first, last) = (at.found(held), held.wanted());
        let climbs_m = held.altitude_m - trim.target.altitude_m;
        let mut steps = (climbs_m.abs() / STEP_M).ceil().max(1.0);
        for ((first, last), longest) in
            first.iter().zip(&last).zip(held.steps(trim.target.airspeed_m_s))
        {
            steps += ((last - first).abs() / longest).ceil();
        }
        // Written so that NaN leads nowhere.
        if !(steps <= MOST_STEPS) {
            return None;
        }
        let longest = 1.0 / steps;
        let (mut part, mut step) = (0.0, longest);
        while part < 1.0 {
            let next: f64 = if part + step < 1.0 - SHORTEST * longest { part + step } else { 1.0 };
            let between = |place: usize| first[place] + next * (last[place] - first[place]);
            let values = if next < 1.0 { [between(0), between(1)] } else { last };
            let altitude_m = trim.target.altitude_m + next * climbs_m;
            let found = self.held_at(&OnTheWay { held: *held, values, altitude_m }, at);
            match found.filter(|it| at.is_near(it)) {
                Some(found) => (at, part, step) = (found, next, (2.0 * step).min(longest)),
                None if step > SHORTEST * longest => step = 0.5 * (next - part),
                None => return None,
            }
        }
        let (target, point) = at.meant(held.altitude_m);
        let residual = self.trim_residual(target, point);
        let is_within = self.trim_departures(target, &point).is_empty();
        let found = Search { target, point, residual, iterations: NEWTON_STEPS };
        (residual.accepted() && is_within).then(|| self.trim_at(found))
    }

    /// Newton's method from near.
    fn held_at(&self, way: &OnTheWay, from: Unknowns) -> Option<Unknowns> {
        let left = |at: [f64; 5]| {
            let at = Unknowns::from_array(at);
            let (target, point) = at.meant(way.altitude_m);
            let [power, path] = at.found(&way.held);
            let beside = [power - way.values[0], path - way.values[1]];
            (self.trim_residual(target, point), beside)
        };
        let is_held = |at: [f64; 5]| {
            let (residual, beside) = left(at);
            residual.accepted() && beside.iter().all(|by| by.abs() <= HELD_TO)
        };
        let all = |at: [f64; 5]| {
            let (residual, [power, path]) = left(at);
            let [forward, downward, pitch] = residual.to_array();
            [forward, downward, pitch, power, path]
        };
        let mut at = from.to_array();
        for _ in 0..NEWTON_STEPS {
            if is_held(at) {
                break;
            }
            let mut jacobian = Matrix::zeros(5, 5);
            for column in 0..5 {
                let width = super::search::step_size(at[column]);
                let beside = |by: f64| {
                    let mut moved = at;
                    moved[column] += by;
                    all(moved)
                };
                let (ahead, behind) = (beside(width), beside(-width));
                for row in 0..5 {
                    jacobian.set(row, column, (ahead[row] - behind[row]) / (2.0 * width)).ok()?;
                }
            }
            let rest = all(at).map(|value| [-value]);
            let step = jacobian.solve(&Matrix::from_rows(&rest).ok()?).ok()?;
            at.iter_mut().zip(step.data()).for_each(|(value, step)| *value += step);
            // Written so that NaN ends it.
            if !(at[0] > 0.0) {
                return None;
            }
        }
        is_held(at).then(|| Unknowns::from_array(at))
    }
}

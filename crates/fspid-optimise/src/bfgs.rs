//! Downhill by slopes: the method of Broyden, Fletcher, Goldfarb and Shanno within the unit cube, for costs with corners.
//!
//! The direction is $-H g$ over the coordinates that are not held at a side of the cube (Bertsekas 1982); the step along it
//! is bracketed until it is both low enough and long enough (weak conditions of Wolfe, by doubling and halving). With that
//! search the method also finds the bottom of valleys whose slopes jump, where a step of steepest descent would bounce from
//! side to side: the jump becomes a large curvature in $H$ (Lewis and Overton 2013).
//!
//! $$ f(x + t d) \le f + c_1 t \ g^T d, \qquad g(x + t d)^T d \ge c_2 \ g^T d $$
//!
//! # Source
//! A. S. Lewis and M. L. Overton, "Nonsmooth optimization via quasi-Newton methods", *Mathematical Programming* 141 (2013);
//! D. P. Bertsekas, "Projected Newton methods for optimization problems with simple constraints", *SIAM Journal on Control
//! and Optimization* 20 (1982).

use serde::{Deserialize, Serialize};

use super::member::{in_cube, sane_cost};
use super::random::Random;
use super::reflected;

/// The $c_1$ and $c_2$ of the step: what Lewis and Overton use.
const LOW_ENOUGH: f64 = 1e-4;
const LONG_ENOUGH: f64 = 0.5;
/// Length of the first step, and the longest one, of any coordinate of the cube.
const FIRST: f64 = 0.03;
const LONGEST: f64 = 0.25;
/// Candidates of a step before it is given up.
const TRIES: u32 = 16;
/// A descent is over when so many steps save less than this share of the cost.
const PATIENCE: u32 = 6;
const SAVES: f64 = 1e-5;

/// A point with its cost and its slope.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Place {
    point: Vec<f64>,
    cost: f64,
    slope: Vec<f64>,
}

/// One descent from one point. Plain data: written, read and gone on with, it has the same bits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bfgs {
    /// Where it stands; none before the first answer.
    here: Option<Place>,
    /// Row by row, an estimate of the inverse of the matrix of second derivatives.
    inverse: Vec<f64>,
    /// Whether that was ever more than a guess.
    is_learned: bool,
    direction: Vec<f64>,
    /// The candidate on its way, and how far along the direction it is.
    asked: Vec<f64>,
    step: f64,
    /// The longest step known to be low enough, where it leads, and the shortest one known not to be.
    below: f64,
    lowest: Option<Place>,
    above: Option<f64>,
    tries: u32,
    /// Steps in a row that saved next to nothing.
    idle: u32,
    is_over: bool,
}

impl Bfgs {
    /// A descent that begins at a point of the cube.
    #[must_use]
    pub fn at(point: &[f64]) -> Self {
        Self {
            here: None,
            inverse: identity(point.len(), 1.0),
            is_learned: false,
            direction: vec![0.0; point.len()],
            asked: point.to_vec(),
            step: 1.0,
            below: 0.0,
            lowest: None,
            above: None,
            tries: 0,
            idle: 0,
            is_over: false,
        }
    }

    /// A point near another one: normally distributed about it with this standard deviation, by the seed and a number.
    #[must_use]
    pub fn near(point: &[f64], spread: f64, seed: u64, number: u64) -> Vec<f64> {
        let mut random = Random::of(seed, number, 0);
        point.iter().map(|x| reflected(x + spread * random.normal())).collect()
    }

    /// A point anywhere in the cube, by the seed and a number.
    #[must_use]
    pub fn anywhere(dimension: usize, seed: u64, number: u64) -> Vec<f64> {
        let mut random = Random::of(seed, number, 0);
        (0..dimension).map(|_| random.unit()).collect()
    }

    /// The next candidate, the same until it is told.
    #[must_use]
    pub fn ask(&self) -> &[f64] {
        &self.asked
    }

    /// True where the candidate's slope is needed, and not its cost alone.
    #[must_use]
    pub fn wants_slope(&self, cost: f64) -> bool {
        let cost = sane_cost(cost);
        cost.is_finite() && self.here.as_ref().is_none_or(|here| self.is_low(here, cost))
    }

    /// The best point so far and its cost; none before the first answer.
    #[must_use]
    pub fn best(&self) -> Option<(&[f64], f64)> {
        self.here.as_ref().map(|here| (here.point.as_slice(), here.cost))
    }

    /// True where there is nothing left to gain from here.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.is_over
    }

    /// True for a state that a descent of so many coordinates can have been in.
    #[must_use]
    pub fn is_sound(&self, dimension: usize) -> bool {
        let place = |it: &Place| {
            in_cube(&it.point, dimension)
                && it.slope.len() == dimension
                && it.slope.iter().chain([&it.cost]).all(|it| it.is_finite())
        };
        in_cube(&self.asked, dimension)
            && self.inverse.len() == dimension * dimension
            && self.inverse.iter().chain(&self.direction).all(|it| it.is_finite())
            && self.direction.len() == dimension
            && self.here.iter().chain(&self.lowest).all(place)
            && [self.step, self.below].iter().all(|it| it.is_finite())
    }

    /// Takes the candidate's cost, and its slope where [`wants_slope`](Self::wants_slope); without one it counts as
    /// lost.
    pub fn tell(&mut self, cost: f64, slope: Option<Vec<f64>>) {
        let cost = sane_cost(cost);
        let sound =
            |it: &Vec<f64>| it.len() == self.asked.len() && it.iter().all(|x| x.is_finite());
        let slope = slope.filter(|it| cost.is_finite() && sound(it));
        let found = slope.map(|slope| Place { point: self.asked.clone(), cost, slope });
        let Some(here) = self.here.clone() else {
            match found {
                Some(place) => self.begin(place),
                None => self.is_over = true,
            }
            return;
        };
        self.tries += 1;
        match found.filter(|_| self.is_low(&here, cost)) {
            None => self.above = Some(self.step),
            Some(place) if self.is_long(&here, &place) => return self.go_to(&here, place),
            Some(place) => {
                self.below = self.step;
                self.lowest = Some(place);
            }
        }
        self.search_on(&here);
    }

    fn begin(&mut self, place: Place) {
        self.here = Some(place);
        self.aim();
    }

    /// Another step along the same direction, or what has come of it.
    fn search_on(&mut self, here: &Place) {
        self.step = match self.above {
            Some(above) => 0.5 * (self.below + above),
            None => 2.0 * self.step,
        };
        self.asked = self.along(here, self.step);
        let same = |other: &[f64]| self.asked == other;
        let is_done = self.tries >= TRIES
            || same(&here.point)
            || self.lowest.as_ref().is_some_and(|it| same(&it.point));
        if !is_done {
            return;
        }
        match self.lowest.take() {
            Some(lowest) => self.go_to(here, lowest),
            // Once more by the slope alone, then it is over.
            None if self.is_learned => {
                (self.inverse, self.is_learned) = (identity(here.point.len(), 1.0), false);
                self.aim();
            }
            None => self.is_over = true,
        }
    }

    /// Stands there now, and knows more of the curvature.
    fn go_to(&mut self, here: &Place, place: Place) {
        self.learn(here, &place);
        let saved = here.cost - place.cost;
        self.idle = if saved > SAVES * place.cost.abs() { 0 } else { self.idle + 1 };
        self.here = Some(place);
        match self.idle >= PATIENCE {
            true => self.is_over = true,
            false => self.aim(),
        }
    }

    /// Sets off in the direction downhill.
    fn aim(&mut self) {
        let Some(here) = self.here.clone() else { return };
        let mut direction = self.downhill(&here);
        if !(dot(&direction, &here.slope) < 0.0) {
            (self.inverse, self.is_learned) = (identity(here.point.len(), 1.0), false);
            direction = self.downhill(&here);
        }
        let length = direction.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
        if !(length > 0.0) || !length.is_finite() {
            self.is_over = true;
            return;
        }
        let most = if self.is_learned { LONGEST.min(length) } else { FIRST };
        self.direction = direction.iter().map(|it| it * (most / length)).collect();
        (self.step, self.below, self.tries) = (1.0, 0.0, 0);
        (self.lowest, self.above) = (None, None);
        self.asked = self.along(&here, self.step);
    }

    /// $-H g$ over the coordinates that are free to move.
    fn downhill(&self, here: &Place) -> Vec<f64> {
        let is_held = |x: f64, by: f64| (x <= 0.0 && by < 0.0) || (x >= 1.0 && by > 0.0);
        let coordinates = || here.point.iter().zip(&here.slope);
        let held: Vec<bool> = coordinates().map(|(x, slope)| is_held(*x, -slope)).collect();
        let free = |values: &[f64]| -> Vec<f64> {
            values.iter().zip(&held).map(|(it, held)| if *held { 0.0 } else { *it }).collect()
        };
        let slope = free(&here.slope);
        let rows = self.inverse.chunks_exact(slope.len().max(1));
        let direction: Vec<f64> = rows.map(|row| -dot(row, &slope)).collect();
        let direction = free(&direction);
        let stays = |(x, by): (&f64, &f64)| if is_held(*x, *by) { 0.0 } else { *by };
        here.point.iter().zip(&direction).map(stays).collect()
    }

    /// The point a step along the direction, within the cube.
    fn along(&self, here: &Place, step: f64) -> Vec<f64> {
        let ahead = here.point.iter().zip(&self.direction);
        ahead.map(|(x, by)| (x + step * by).clamp(0.0, 1.0)).collect()
    }

    /// Low enough for the step that was taken.
    fn is_low(&self, here: &Place, cost: f64) -> bool {
        let moved = difference(&self.asked, &here.point);
        cost <= here.cost + LOW_ENOUGH * dot(&here.slope, &moved)
    }

    /// Long enough: the slope along the way has flattened, or a coordinate has gone as far as any may.
    fn is_long(&self, here: &Place, place: &Place) -> bool {
        let goes = |(x, by): (&f64, &f64)| {
            let stays = (*x <= 0.0 && *by < 0.0) || (*x >= 1.0 && *by > 0.0);
            if stays { 0.0 } else { *by }
        };
        let onwards: Vec<f64> = place.point.iter().zip(&self.direction).map(goes).collect();
        let far = self.direction.iter().any(|by| self.step * by.abs() >= LONGEST);
        far || dot(&place.slope, &onwards) >= LONG_ENOUGH * dot(&here.slope, &self.direction)
    }

    /// $H \leftarrow (I - \rho s y^T) H (I - \rho y s^T) + \rho s s^T$, with s the step, y the change of the slope and
    /// $\rho = 1 / s^T y$.
    fn learn(&mut self, here: &Place, place: &Place) {
        let s = difference(&place.point, &here.point);
        let y = difference(&place.slope, &here.slope);
        let (sy, yy) = (dot(&s, &y), dot(&y, &y));
        let lengths = dot(&s, &s).sqrt() * yy.sqrt();
        if !(sy > 1e-12 * lengths && sy.is_finite() && yy.is_finite()) {
            return;
        }
        if !self.is_learned {
            self.inverse = identity(s.len(), sy / yy);
            self.is_learned = true;
        }
        let hy: Vec<f64> = self.inverse.chunks_exact(s.len()).map(|row| dot(row, &y)).collect();
        let scale = (1.0 + dot(&y, &hy) / sy) / sy;
        for (i, row) in self.inverse.chunks_exact_mut(s.len()).enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry += scale * s[i] * s[j] - (hy[i] * s[j] + s[i] * hy[j]) / sy;
            }
        }
    }
}

fn identity(size: usize, scale: f64) -> Vec<f64> {
    let mut rows = vec![0.0; size * size];
    rows.iter_mut().step_by(size + 1).for_each(|it| *it = scale);
    rows
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cost and slope of points of the cube, stretched to [-2, 2].
    type Valley = fn(&[f64]) -> (f64, Vec<f64>);

    fn stretched(unit: &[f64]) -> Vec<f64> {
        unit.iter().map(|u| 4.0 * u - 2.0).collect()
    }

    fn rosenbrock(x: &[f64]) -> (f64, Vec<f64>) {
        let (mut cost, mut slope) = (0.0, vec![0.0; x.len()]);
        for i in 1..x.len() {
            let (bend, rest) = (x[i] - x[i - 1] * x[i - 1], 1.0 - x[i - 1]);
            cost += 100.0 * bend * bend + rest * rest;
            slope[i] += 200.0 * bend;
            slope[i - 1] -= 400.0 * bend * x[i - 1] + 2.0 * rest;
        }
        (cost, slope)
    }

    /// 8 |x² - y| + (1 - x)²: the valley of Lewis and Overton, whose bottom is a corner.
    fn with_a_corner(x: &[f64]) -> (f64, Vec<f64>) {
        let (bend, rest) = (x[0] * x[0] - x[1], 1.0 - x[0]);
        let sign = if bend > 0.0 { 1.0 } else { -1.0 };
        let slope = vec![16.0 * sign * x[0] - 2.0 * rest, -8.0 * sign];
        (8.0 * bend.abs() + rest * rest, slope)
    }

    /// Least at a side: x₀ wants below -2, x₁ to 0.5.
    fn beyond_a_side(x: &[f64]) -> (f64, Vec<f64>) {
        let [a, b] = [x[0] + 3.0, x[1] - 0.5];
        (a * a + 5.0 * b * b + a * b, vec![2.0 * a + b, 10.0 * b + a])
    }

    /// Candidates asked for, slopes asked for, and the best.
    fn descended(valley: Valley, from: &[f64]) -> (usize, usize, Vec<f64>, f64) {
        let mut descent = Bfgs::at(from);
        let (mut candidates, mut slopes) = (0, 0);
        while !descent.is_over() && candidates < 5000 {
            let unit = descent.ask().to_vec();
            assert!(in_cube(&unit, from.len()));
            let (cost, slope) = valley(&stretched(&unit));
            candidates += 1;
            let wanted = descent.wants_slope(cost);
            slopes += usize::from(wanted);
            let slope = slope.iter().map(|it| 4.0 * it).collect();
            descent.tell(cost, wanted.then_some(slope));
            // What is written and read goes on with the same bits.
            let text = serde_json::to_string(&descent).expect("plain data");
            let read: Bfgs = serde_json::from_str(&text).expect("its own text");
            assert!(read == descent && read.is_sound(from.len()));
        }
        let (point, cost) = descent.best().expect("a place");
        (candidates, slopes, stretched(point), cost)
    }

    #[test]
    fn it_comes_down_a_curved_valley_in_few_steps() {
        let (candidates, slopes, at, cost) = descended(rosenbrock, &[0.2, 0.8, 0.3, 0.6]);
        assert!(cost < 1e-8 && at.iter().all(|x| (x - 1.0).abs() < 1e-3), "{at:?} {cost}");
        assert!(candidates < 150 && slopes <= candidates, "{candidates} {slopes}");
    }

    #[test]
    fn a_valley_whose_bottom_is_a_corner_does_not_stop_it() {
        let (candidates, _, at, cost) = descended(with_a_corner, &[0.2, 0.8]);
        assert!(cost < 1e-4, "{candidates} {at:?} {cost}");
    }

    #[test]
    fn at_a_side_of_the_cube_it_goes_on_along_it() {
        let (candidates, _, at, cost) = descended(beyond_a_side, &[0.9, 0.1]);
        // At x₀ = -2: 1 + 5 b² + b is least at b = -0.1.
        assert_eq!(at[0], -2.0);
        assert!((at[1] - 0.4).abs() < 1e-4 && (cost - 0.95).abs() < 1e-8, "{at:?} {cost}");
        assert!(candidates < 40, "{candidates}");
    }

    #[test]
    fn candidates_that_are_lost_shorten_the_step_and_a_lost_start_ends_it() {
        fn with_a_wall(x: &[f64]) -> (f64, Vec<f64>) {
            if x[0] < 0.0 { (f64::INFINITY, vec![f64::NAN; 2]) } else { beyond_a_side(x) }
        }
        let (_, _, at, _) = descended(with_a_wall, &[0.9, 0.1]);
        assert!(at[0] >= 0.0 && at[0] < 0.01, "{at:?}");
        let mut lost = Bfgs::at(&[0.5]);
        lost.tell(f64::NAN, None);
        assert!(lost.is_over() && lost.best().is_none());
    }

    #[test]
    fn a_state_that_no_descent_can_have_been_in_is_known() {
        let descent = Bfgs::at(&[0.5, 0.5]);
        assert!(descent.is_sound(2) && !descent.is_sound(3));
        assert!(!Bfgs { asked: vec![1.5, 0.0], ..descent.clone() }.is_sound(2));
        assert!(!Bfgs { inverse: vec![f64::NAN; 4], ..descent.clone() }.is_sound(2));
        assert!(!Bfgs { step: f64::INFINITY, ..descent }.is_sound(2));
    }
}

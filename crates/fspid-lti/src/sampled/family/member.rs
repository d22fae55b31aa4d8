//! One loop of a family: its response on the grid, and where it crosses.

use core::f64::consts::PI;

use super::grid::{Known, turns_far};
use super::place;
use super::{LoopFamily, bowl};
use crate::complex::{Complex, modulus};
use crate::sampled::crossings::{excess, sine};
use crate::sampled::reduced::Response;
use crate::sampled::scan;

/// Between two places the numerator may turn by an angle of this tangent, squared, some 50 degrees; a notch turns it
/// further.
const TURN_SQR: f64 = 1.4;
/// Halvings of a step in which the numerator turns further.
const HALVINGS: usize = 24;
/// A function that goes from one sign to the other without values below this size jumps.
const JUMP: f64 = 1e-3;
/// Closed-loop poles are looked at more closely if their distance from the circle is less than this part of their
/// angle; the peaks of others are wider than the steps of the grid.
const NARROW: f64 = 0.4;

/// A loop with its gains.
pub(super) struct Member<'a> {
    family: &'a LoopFamily,
    gains: &'a [f64],
    coefficients: Vec<f64>,
}

/// The response at a place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample {
    pub(super) place: f64,
    pub(super) response: Response,
}

impl<'a> Member<'a> {
    pub(super) fn new(family: &'a LoopFamily, gains: &'a [f64]) -> Self {
        Self { family, gains, coefficients: family.control.coefficients(gains) }
    }

    /// Poles of the closed loop less 1; `None` if they are not found.
    pub(super) fn poles(&self) -> Option<Vec<Complex>> {
        self.family.chain.closed_poles(&self.family.control, &self.coefficients)
    }

    /// A spectral radius that is not exceeded, whatever error the poles have; infinite or NaN where two coincide.
    ///
    /// With the characteristic polynomial p of degree n, whose leading coefficient is 1, all zeros lie in the disks
    ///
    /// $$ |z - z_i| \leq n \left| \frac{p(z_i)}{\prod_{j \neq i} (z_i - z_j)} \right| $$
    ///
    /// # Source
    /// B. T. Smith, Error bounds for zeros of a polynomial based upon Gerschgorin's theorems, J. ACM 17 (1970) 661.
    pub(super) fn radius_bound(&self, poles: &[Complex]) -> f64 {
        let mut bound = 0.0;
        for (index, &zeta) in poles.iter().enumerate().filter(|(_, zeta)| zeta.im >= 0.0) {
            let others = poles.iter().enumerate().filter(|(other, _)| *other != index);
            let product =
                others.fold(Complex::new(1.0, 0.0), |product, (_, other)| product * (zeta - other));
            let response = self.at_zeta(zeta);
            let value = response.over + response.under;
            let disk = poles.len() as f64 * modulus(value) / modulus(product);
            let reach = modulus(zeta + 1.0) + disk;
            // Not f64::max, which would pass over a NaN.
            bound = if reach <= bound { bound } else { reach };
        }
        bound
    }

    /// The response at a place.
    pub(super) fn at(&self, place: f64) -> Response {
        self.at_zeta(place::zeta(place))
    }

    /// The response; over and under are polynomials, and the leading coefficient of the second is 1.
    fn at_zeta(&self, zeta: Complex) -> Response {
        let parts = self.family.chain.at(zeta);
        let (over, under) = self.family.control.at(&self.coefficients, zeta);
        Response { over: parts.fixed * under + parts.measured * over, under: parts.under * under }
    }

    fn sample(&self, place: f64) -> Sample {
        Sample { place, response: self.at(place) }
    }

    /// Responses on the grid, and around poles of the closed loop that are too lightly damped for it.
    pub(super) fn samples(&self, poles: &[Complex]) -> Vec<Sample> {
        let on_grid = |known: &Known| {
            let mut over = known.over[0];
            for (gain, part) in self.gains.iter().zip(&known.over[1..]) {
                over += part * *gain;
            }
            Sample { place: known.place, response: Response { over, under: known.under } }
        };
        let mut samples: Vec<Sample> = self.family.grid.known.iter().map(on_grid).collect();
        for &pole in poles.iter().filter(|pole| pole.im > 0.0) {
            let angle_rad = libm::atan2(pole.im, 1.0 + pole.re);
            let damping = 1.0 - modulus(pole + 1.0);
            if damping < NARROW * angle_rad {
                let angles = [angle_rad - damping, angle_rad, (angle_rad + damping).min(PI)];
                samples.extend(angles.map(|angle| self.sample(place::of_angle(angle))));
            }
        }
        samples.sort_by(|one, other| one.place.total_cmp(&other.place));
        samples.dedup_by(|one, other| one.place <= other.place);
        samples
    }

    /// Places where the gain is 1.
    pub(super) fn unit_gain_places(&self, samples: &[Sample]) -> Vec<f64> {
        self.sign_changes(samples, excess)
    }

    /// Places where the response is real, without the ends.
    pub(super) fn real_places(&self, samples: &[Sample]) -> Vec<f64> {
        self.sign_changes(samples, sine)
    }

    fn sign_changes(&self, samples: &[Sample], function: impl Fn(Response) -> f64) -> Vec<f64> {
        let value = |place: f64| function(self.at(place));
        let inner = samples.get(1..samples.len() - 1).unwrap_or_default();
        let values: Vec<f64> = inner.iter().map(|sample| function(sample.response)).collect();
        let mut found = Vec::new();
        for index in 1..inner.len() {
            let (from, to) = (&inner[index - 1], &inner[index]);
            if turns_far(from.response.over, to.response.over, TURN_SQR) {
                self.divided(&function, (*from, *to), HALVINGS, &mut found);
                continue;
            }
            let ends = ((from.place, values[index - 1]), (to.place, values[index]));
            if ends.0.1 * ends.1.1 <= 0.0 {
                found.extend(crossing(&value, ends));
            } else if let Some(after) = inner.get(index + 1)
                && may_touch([ends.0.1, ends.1.1, values[index + 1]])
            {
                let points = [ends.0, ends.1, (after.place, values[index + 1])];
                found.extend(touching(&value, points).into_iter().flatten());
            }
        }
        found
    }

    /// Sign changes between two places between which the numerator turns far.
    fn divided(
        &self,
        function: &impl Fn(Response) -> f64,
        (from, to): (Sample, Sample),
        halvings: usize,
        found: &mut Vec<f64>,
    ) {
        if halvings > 0 && turns_far(from.response.over, to.response.over, TURN_SQR) {
            let middle = self.sample(scan::middle(from.place, to.place));
            self.divided(function, (from, middle), halvings - 1, found);
            self.divided(function, (middle, to), halvings - 1, found);
            return;
        }
        let ends = ((from.place, function(from.response)), (to.place, function(to.response)));
        if ends.0.1 * ends.1.1 <= 0.0 {
            found.extend(crossing(&|place| function(self.at(place)), ends));
        }
    }
}

/// Whether a function with these values at three places may be zero twice between them.
fn may_touch(values: [f64; 3]) -> bool {
    let [before, here, after] = values.map(f64::abs);
    // A parabola reaches a quarter of the larger rise below its middle value at most.
    here < before
        && here <= after
        && values[2] * values[1] > 0.0
        && here < (before - here).max(after - here)
}

/// The zeros of a function that comes near to zero between three places.
fn touching(function: &impl Fn(f64) -> f64, points: [bowl::Point; 3]) -> [Option<f64>; 2] {
    let sign = if points[1].1 < 0.0 { -1.0 } else { 1.0 };
    let upright = points.map(|(place, value)| (place, sign * value));
    let (place, value) = bowl::lowest(|place| sign * function(place), upright, 0.0);
    if value < 0.0 {
        let lowest = (place, sign * value);
        [crossing(function, (points[0], lowest)), crossing(function, (lowest, points[2]))]
    } else {
        [None, None]
    }
}

/// The zero between two values of which one is above and one below, unless the function jumps.
fn crossing(function: &impl Fn(f64) -> f64, (from, to): (bowl::Point, bowl::Point)) -> Option<f64> {
    if from.1 == 0.0 {
        return Some(from.0);
    }
    if !(from.1 * to.1 < 0.0) {
        return None;
    }
    let (place, value) = scan::root(function, from, to);
    (value.abs() < JUMP).then_some(place)
}

/// How far T is from a real value, squared and inverted: lowest at a peak.
pub(super) fn nearness(response: Response, centre: f64) -> f64 {
    let sum = response.over + response.under;
    sum.norm_sqr() / (response.over - sum * centre).norm_sqr()
}

/// Size of $T - t_0$ at a place.
pub(super) fn height(response: Response, centre: f64) -> f64 {
    modulus(response.closed_less(centre))
}

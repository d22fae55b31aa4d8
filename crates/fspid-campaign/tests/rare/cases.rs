//! Limit states whose probability of failure is known in closed form.

use std::convert::Infallible;

use fspid_campaign::rare::{LimitState, Point, Shape};
use fspid_scenario::dispersion::standard_normal::{above, quantile};

/// A limit state by its formula.
pub struct Case {
    pub name: &'static str,
    pub probability: f64,
    shape: Shape,
    score: Box<dyn Fn(&Point) -> f64>,
    /// Points that were asked for.
    pub asked: u64,
}

impl LimitState for Case {
    type Error = Infallible;

    fn shape(&self) -> Shape {
        self.shape
    }

    fn scores(&mut self, points: &[Point]) -> Result<Vec<f64>, Infallible> {
        self.asked += points.len() as u64;
        Ok(points.iter().map(|point| (self.score)(point)).collect())
    }
}

fn case(
    name: &'static str,
    probability: f64,
    (normals, airs): (usize, usize),
    score: impl Fn(&Point) -> f64 + 'static,
) -> Case {
    let shape = Shape { normals, airs, seeds: 0 };
    Case { name, probability, shape, score: Box::new(score), asked: 0 }
}

/// A sum of so many numbers is beyond its limit.
pub fn linear(normals: usize, probability: f64) -> Case {
    let (limit, root) = (-quantile(probability), (normals as f64).sqrt());
    let name = if normals > 50 { "sum of 100 numbers" } else { "sum of 5 numbers" };
    case(name, probability, (normals, 0), move |point| {
        point.normals.iter().sum::<f64>() / root - limit
    })
}

/// Outside of a circle: of two numbers the squared distance is exponential with mean 2.
pub fn circle(probability: f64) -> Case {
    let limit = -2.0 * libm::log(probability);
    case("outside of a circle", probability, (2, 0), move |point| point.distance_squared() - limit)
}

/// On either side of a band, as limits from below and above are.
pub fn two_sided(probability: f64) -> Case {
    let limit = -quantile(probability / 2.0);
    case("outside of a band", probability, (3, 0), move |point| point.normals[0].abs() - limit)
}

/// Two regions that are no mirror images, one of them ten times as likely: the numbers are independent.
pub fn two_regions(probability: f64) -> Case {
    let (near, far) = (-quantile(probability / 1.1), -quantile(probability / 11.0));
    let exact = above(near) + above(far) - above(near) * above(far);
    // The score of the far region grows with another slope.
    case("in one of two regions", exact, (4, 0), move |point| {
        (point.normals[0] - near).max(2.0 * (point.normals[1] - far))
    })
}

/// What a first-order lag makes of a noise of 20 numbers, which is a normal number.
pub fn lag_in_noise(probability: f64) -> Case {
    let limit = -quantile(probability);
    case("lag behind noise", probability, (0, 1), move |point| lagged(point) - limit)
}

/// The same with a number of the dispersions beside it.
pub fn lag_and_number(probability: f64) -> Case {
    let limit = -quantile(probability);
    case("number and lag behind noise", probability, (1, 1), move |point| {
        (point.normals[0] + lagged(point)) * std::f64::consts::FRAC_1_SQRT_2 - limit
    })
}

/// $\sum a^k n_k$ over its standard deviation.
fn lagged(point: &Point) -> f64 {
    let weights: Vec<f64> = (0..20).map(|k| libm::pow(0.8, f64::from(k))).collect();
    let deviation = weights.iter().map(|weight| weight * weight).sum::<f64>().sqrt();
    let noise = |k: usize| -> f64 {
        let terms = &point.airs[0].terms;
        terms.iter().map(|&(seed, weight)| weight * number(seed, k)).sum()
    };
    weights.iter().enumerate().map(|(k, weight)| weight * noise(k)).sum::<f64>() / deviation
}

/// The standard normal number k of a seed, by `SplitMix64`.
fn number(seed: u64, k: usize) -> f64 {
    let mut bits = seed.wrapping_add(0x9e37_79b9_7f4a_7c15_u64.wrapping_mul(k as u64 + 1));
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^= bits >> 31;
    quantile(((bits >> 12) * 2 + 1) as f64 * libm::scalbn(1.0, -53))
}

/// What does not fail, however far its number is out.
pub fn never() -> Case {
    case("never", 0.0, (1, 0), |point| point.normals[0].min(1.0) - 2.0)
}

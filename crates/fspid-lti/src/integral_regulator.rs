//! Optimal feedback with integral action for a damped integrator: the equation of Riccati in closed form.

use crate::error::LtiError;

/// Most steps of Newton's iteration; from the bound that it starts at, fewer than ten are usual.
const STEPS_MAX: usize = 60;

/// A position moved through a damped rate: $\dot x = v, \ \dot v = -a v + b u$.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DampedIntegrator {
    /// Damping $a$ of the rate, 1/s; negative for a rate that grows by itself.
    pub damping_per_s: f64,
    /// Acceleration $b$ per input, 1/s² where input and position have the same unit.
    pub power_per_s2: f64,
}

/// Weights of the quadratic cost, beside 1 for the input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntegralWeights {
    /// Of the integral of the position, 1/s².
    pub integral_per_s2: f64,
    /// Of the position.
    pub position: f64,
    /// Of the rate, s².
    pub rate_s2: f64,
}

/// The feedback $u = -k_i \int x \ dt - k_x x - k_v v$.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntegralRegulator {
    /// Gain $k_i$ of the integral, 1/s.
    pub integral_per_s: f64,
    /// Gain $k_x$ of the position.
    pub position: f64,
    /// Gain $k_v$ of the rate, s.
    pub rate_s: f64,
}

/// The feedback that makes the least of integral, position, rate and input.
///
/// $$ \min_u \int_0^\infty w_i z^2 + w_x x^2 + w_v v^2 + u^2 \ dt, \quad \dot z = x, \ \dot x = v, \ \dot v = -a v + b u $$
///
/// The closed loop $p(s) = s^3 + c_2 s^2 + c_1 s + c_0$ is the stable factor of (Kalman 1964)
///
/// $$ p(s) p(-s) = d(s) d(-s) + b^2 (w_i - w_x s^2 + w_v s^4), \quad d(s) = s^2 (s + a) $$
///
/// whose coefficients give $k_i = \sqrt{w_i}$, $c_2^2 = a^2 + b^2 w_v + 2 b k_x$, $k_v = (c_2 - a) / b$ and one equation
///
/// $$ k_x^2 = w_x + 2 \sqrt{w_i} c_2(k_x) / b $$
///
/// Left less right is convex and below 0 at $k_x = 0$: there is one root, and Newton's iteration falls onto it from above.
///
/// # Source
/// R. E. Kalman, When is a linear control system optimal?, J. Basic Engineering 86 (1964) 51, for the factorisation.
///
/// # Errors
/// [`LtiError::NotPositive`] for a weight or a power that is not a number above 0, [`LtiError::NotFinite`] for the
/// damping, [`LtiError::OutOfRange`] where a gain overflows or vanishes.
pub fn integral_regulator(
    model: DampedIntegrator,
    weights: IntegralWeights,
) -> Result<IntegralRegulator, LtiError> {
    // Symbols as above: a [1/s], b [1/s²], root = √wi [1/s], gain = kx, pole_sum = c2 [1/s].
    let (a, b) = (model.damping_per_s, positive("power, 1/s²", model.power_per_s2)?);
    LtiError::unless_finite("damping, 1/s", &[a])?;
    let root = positive("weight of the integral, 1/s²", weights.integral_per_s2)?.sqrt();
    let position = positive("weight of the position", weights.position)?;
    let rate = positive("weight of the rate, s²", weights.rate_s2)?;
    let pole_sum = PoleSum { still: a * a + b * b * rate, b };
    let gain = position_gain(pole_sum, position, 2.0 * root / b);
    let sum = pole_sum.at(gain);
    // Each form of c2 - a where it does not cancel.
    let rate_s = match a > 0.0 {
        true => (b * rate + 2.0 * gain) / (sum + a),
        false => (sum - a) / b,
    };
    let found = IntegralRegulator { integral_per_s: root, position: gain, rate_s };
    // Written so that NaN fails.
    let good = [root, gain, rate_s].iter().all(|gain| *gain > 0.0 && gain.is_finite());
    if good { Ok(found) } else { Err(LtiError::OutOfRange { what: "gain of the regulator" }) }
}

/// $c_2(k) = \sqrt{s + 2 b k}$, 1/s, with $s$ its square without the gain.
#[derive(Clone, Copy)]
struct PoleSum {
    still: f64,
    b: f64,
}

impl PoleSum {
    fn at(self, gain: f64) -> f64 {
        (self.still + 2.0 * self.b * gain).sqrt()
    }
}

/// The root of $k^2 - w - f c_2(k)$, from a bound above it downwards.
fn position_gain(pole_sum: PoleSum, weight: f64, factor: f64) -> f64 {
    let PoleSum { still, b } = pole_sum;
    // √(still + 2 b k) is at most √still + √(2 b k). Where k² is at least three times each of the three terms that the
    // right side then has, it is at least their sum.
    let bounds = [
        (3.0 * weight).sqrt(),
        (3.0 * factor * still.sqrt()).sqrt(),
        libm::cbrt(18.0 * factor * factor * b),
    ];
    let mut gain = bounds.into_iter().fold(0.0, f64::max);
    for _ in 0..STEPS_MAX {
        let sum = pole_sum.at(gain);
        let slope = 2.0 * gain - factor * b / sum;
        let next = gain - (gain * gain - weight - factor * sum) / slope;
        // Rounding ends the fall.
        if !(next < gain) {
            break;
        }
        gain = next;
    }
    gain
}

fn positive(what: &'static str, value: f64) -> Result<f64, LtiError> {
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(LtiError::NotPositive { what, value })
    }
}

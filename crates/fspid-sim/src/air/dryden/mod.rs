//! Continuous random turbulence of the form of Dryden, MIL-F-8785C and MIL-HDBK-1797.
//!
//! # Spectra
//! Over the spatial frequency $\Omega$, one-sided: the integral from 0 is the variance.
//!
//! $$ \Phi_u = \frac{2 L_u \sigma_u^2}{\pi} \frac{1}{1 + (L_u \Omega)^2}, \qquad
//! \Phi_w = \frac{L_w \sigma_w^2}{\pi} \frac{1 + 3 (L_w \Omega)^2}{(1 + (L_w \Omega)^2)^2} $$
//! $$ \Phi_p = \frac{\sigma_w^2}{L_w} \frac{0.8 (\pi L_w / 4 b)^{1/3}}{1 + (4 b \Omega / \pi)^2},
//! \quad \Phi_q = \frac{\Omega^2}{1 + (4 b \Omega / \pi)^2} \Phi_w, \quad
//! \Phi_r = \frac{\Omega^2}{1 + (3 b \Omega / \pi)^2} \Phi_v $$
//!
//! with $\Phi_v$ as $\Phi_w$ and b the wing span.
//!
//! # Shaping filters
//! For white noise of autocorrelation $\delta$, with $\tau = L / V$:
//!
//! $$ H_u = \frac{\sigma_u \sqrt{2 \tau_u}}{1 + \tau_u s}, \quad
//! H_w = \sigma_w \sqrt{\tau_w} \frac{1 + \sqrt 3 \tau_w s}{(1 + \tau_w s)^2}, \quad
//! H_p = \sigma_w \sqrt{\frac{0.8 \pi}{V}} \frac{(\pi / 4 b)^{1/6}}{L_w^{1/3} (1 + \tau_p s)} $$
//! $$ H_q = -\frac{s / V}{1 + \tau_p s} H_w, \quad H_r = \frac{s / V}{1 + \tau_r s} H_v, \qquad
//! \tau_p = \frac{4 b}{\pi V}, \quad \tau_r = \frac{3 b}{\pi V} $$
//!
//! Texts whose noise has a spectrum of 1 over the angular frequency carry another $1 / \sqrt \pi$;
//! here the variance of u, v and w is exactly $\sigma^2$. The signs of q and r are those of
//! [`air`](super).
//!
//! # Random streams
//! Of the seed, one stream for each state, from [`STREAM`] on: u 0; v 4 and 5, r 6; w 8 and 9, q 10;
//! p 12. r and q follow v and w and take one stream more for what their own lag adds. No component
//! changes another, and time k of the [grid](super::GRID_S) takes number k of its streams, whatever the loop's period.
//!
//! # Not here
//! Velocities are taken along body axes at all heights; MIL-F-8785C aligns u and v with the mean
//! wind near the ground. Height and airspeed are those of the start throughout, or follow the flight ([`Follows`]).

mod intensity;
mod scales;
mod shaped_noise;
mod shaping;

pub(crate) use intensity::interpolated;
pub use intensity::{Intensity, Severity};
pub use scales::{Scales, Specification};
pub(crate) use shaping::Shaping;

use super::wind::AirMotion;
use crate::error::{SimError, finite, positive};
use crate::signal::Noise;
use shaped_noise::{ShapedNoise, Source};

/// Number of the first random stream of turbulence; disturbances count theirs from 0.
pub const STREAM: u64 = 1 << 32;
const STREAM_U: u64 = STREAM;
const STREAM_V: u64 = STREAM + 4;
const STREAM_W: u64 = STREAM + 8;
const STREAM_P: u64 = STREAM + 12;

/// Which turbulence, and at what condition it is flown through.
#[derive(Clone, Debug, PartialEq)]
pub struct Turbulence {
    /// Document that scale lengths are stated by.
    pub specification: Specification,
    /// How strong.
    pub intensity: Intensity,
    /// Height above the ground, m.
    pub height_m: f64,
    /// True airspeed V, m/s.
    pub airspeed_m_s: f64,
    /// Wing span b, m.
    pub wing_span_m: f64,
    /// Where its random numbers come from; the same seed gives the same turbulence.
    pub noise: Noise,
    /// Whether height and airspeed stay those above.
    pub follows: Follows,
    /// From then on nothing drives it any more, s, so that it dies away; infinity for never.
    pub driven_until_s: f64,
}

/// Whose height and airspeed scale lengths and intensities have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Follows {
    /// Those of the start, all through the flight.
    #[default]
    Start,
    /// Those of the aircraft at each time of the grid.
    Flight,
}

/// Turbulence prepared for one sample period.
#[derive(Clone, Debug, PartialEq)]
pub struct Dryden {
    noise: Noise,
    /// Periods after it drive nothing.
    last_driven: usize,
    along: ShapedNoise<1>,
    /// Two states of the velocity, then that of the rate.
    across: ShapedNoise<3>,
    vertical: ShapedNoise<3>,
    roll: ShapedNoise<1>,
    across_output: RateOutput,
    vertical_output: RateOutput,
}

/// Where the turbulence is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrydenState {
    along: [f64; 1],
    across: [f64; 3],
    vertical: [f64; 3],
    roll: [f64; 1],
}

impl Dryden {
    /// Turbulence sampled every `dt_s`. Its covariance does not depend on `dt_s`.
    ///
    /// # Errors
    /// [`SimError::Number`] for an airspeed, span or period that is not positive or a height that is
    /// not finite, [`SimError::Linear`] where the filters cannot be sampled.
    pub fn new(turbulence: &Turbulence, dt_s: f64) -> Result<Self, SimError> {
        let airspeed_m_s = positive("airspeed, m/s", turbulence.airspeed_m_s)?;
        let span_m = positive("wing span, m", turbulence.wing_span_m)?;
        let height_m = finite("height, m", turbulence.height_m)?;
        let dt_s = positive("sample period, s", dt_s)?;
        let specification = turbulence.specification;
        let scales = Scales::at(specification, turbulence.intensity, height_m);
        let [along_m, across_m, vertical_m] = scales.length_m;
        let [sigma_u, sigma_v, sigma_w] = scales.sigma_m_s;
        let (across_m, vertical_m) =
            (across_m * specification.length_factor(), vertical_m * specification.length_factor());
        let rate_lag_s = |spans: f64| spans * span_m / (std::f64::consts::PI * airspeed_m_s);
        let second = |sigma: f64, length_m: f64, spans: f64| {
            second_order(sigma, length_m / airspeed_m_s, rate_lag_s(spans), dt_s)
        };
        let sigma_p = roll_sigma_rad_s(sigma_w, vertical_m, span_m);
        Ok(Self {
            noise: turbulence.noise.clone(),
            // Infinity is every period.
            last_driven: (turbulence.driven_until_s / dt_s) as usize,
            along: first_order(sigma_u, along_m / airspeed_m_s, dt_s)?,
            across: second(sigma_v, across_m, 3.0)?,
            vertical: second(sigma_w, vertical_m, 4.0)?,
            roll: first_order(sigma_p, rate_lag_s(4.0), dt_s)?,
            across_output: RateOutput { per_m: 1.0 / (airspeed_m_s * rate_lag_s(3.0)) },
            vertical_output: RateOutput { per_m: -1.0 / (airspeed_m_s * rate_lag_s(4.0)) },
        })
    }

    /// The turbulence of period 0, from the stationary distribution.
    #[must_use]
    pub fn start(&self) -> DrydenState {
        DrydenState {
            along: self.along.start(self.source(STREAM_U)),
            across: self.across.start(self.source(STREAM_V)),
            vertical: self.vertical.start(self.source(STREAM_W)),
            roll: self.roll.start(self.source(STREAM_P)),
        }
    }

    /// From period `k - 1` to period `k`; they count up by one from the start's 0.
    pub fn advance(&self, state: &mut DrydenState, k: usize) {
        self.along.advance(&mut state.along, self.source(STREAM_U), k);
        self.across.advance(&mut state.across, self.source(STREAM_V), k);
        self.vertical.advance(&mut state.vertical, self.source(STREAM_W), k);
        self.roll.advance(&mut state.roll, self.source(STREAM_P), k);
    }

    /// How the air moves in this state: body velocities u, v, w and rates p, q, r.
    #[must_use]
    pub fn motion(&self, state: &DrydenState) -> AirMotion {
        let ([u], [p]) = (state.along, state.roll);
        let (v, r) = self.across_output.of(state.across);
        let (w, q) = self.vertical_output.of(state.vertical);
        AirMotion { body_m_s: [u, v, w], body_rad_s: [p, q, r], ..AirMotion::default() }
    }

    fn source(&self, stream: u64) -> Source<'_> {
        Source { noise: &self.noise, stream, last: self.last_driven }
    }
}

/// Velocity and rate of the states of [`second_order`].
#[derive(Clone, Copy, Debug, PartialEq)]
struct RateOutput {
    /// Rate per difference of velocity and lagged velocity, 1/m, with its sign.
    per_m: f64,
}

impl RateOutput {
    /// $w = x_0 + x_1$ and $\pm (w - x_2) / V \tau_p$, the lagged derivative of w.
    fn of(self, [direct, lagged, follower]: [f64; 3]) -> (f64, f64) {
        let velocity = direct + lagged;
        (velocity, self.per_m * (velocity - follower))
    }
}

/// $\sigma \sqrt{2 \tau} / (1 + \tau s)$.
fn first_order(sigma: f64, lag_s: f64, dt_s: f64) -> Result<ShapedNoise<1>, SimError> {
    ShapedNoise::new([[-1.0 / lag_s]], [sigma * (2.0 / lag_s).sqrt()], dt_s)
}

/// $\sigma \sqrt \tau (1 + \sqrt 3 \tau s) / (1 + \tau s)^2$ in partial fractions, and its lag.
///
/// $$ H = \sigma \sqrt \tau \left( \frac{\sqrt 3}{1 + \tau s} +
/// \frac{1 - \sqrt 3}{(1 + \tau s)^2} \right), \qquad \tau_p \dot x_2 = x_0 + x_1 - x_2 $$
fn second_order(
    sigma: f64,
    lag_s: f64,
    rate_lag_s: f64,
    dt_s: f64,
) -> Result<ShapedNoise<3>, SimError> {
    let root = 3.0_f64.sqrt();
    let (pole, follow) = (1.0 / lag_s, 1.0 / rate_lag_s);
    // The second fraction is the first through another lag, times (1 - √3)/√3.
    let a =
        [[-pole, 0.0, 0.0], [pole * (1.0 - root) / root, -pole, 0.0], [follow, follow, -follow]];
    ShapedNoise::new(a, [sigma * root / lag_s.sqrt(), 0.0, 0.0], dt_s)
}

/// Root mean square of p: $\sigma_p^2 = \int_0^\infty \Phi_p \ d\Omega
/// = 0.8 \frac{\sigma_w^2}{L_w} \left( \frac{\pi L_w}{4 b} \right)^{1/3} \frac{\pi^2}{8 b}$.
fn roll_sigma_rad_s(sigma_w: f64, length_m: f64, span_m: f64) -> f64 {
    let pi = std::f64::consts::PI;
    let slender = libm::cbrt(pi * length_m / (4.0 * span_m));
    sigma_w * (0.8 / length_m * slender * pi * pi / (8.0 * span_m)).sqrt()
}

#[cfg(test)]
mod tests;

//! Dominant poles where they are asked for, exactly, in the sampled loop.

use fspid_core::Gains;
use fspid_lti::{Complex, Matrix, modulus, quotient};
use serde::Serialize;

use super::options::PoleOptions;
use super::process::Process;
use super::{Form, RuleError};

/// Where the poles were put.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlacedPoles {
    /// Damping of the pair.
    pub damping: f64,
    /// Undamped frequency of the pair, rad/s.
    pub frequency_rad_s: f64,
    /// The third pole, 1/s; none for `pi`.
    pub third_per_s: Option<f64>,
    /// The pair in the z-plane, and the third pole.
    #[serde(skip)]
    pub z: Vec<Complex>,
}

/// Gains for which the pair, and for `pid` the third pole, are poles of the sampled closed loop:
///
/// $$ k_p + k_i \frac{T z}{z - 1} + k_d \frac{z - 1}{(T_f + T) z - T_f} = -\frac{1}{P(z)},
/// \quad z = e^{s T}, \ s = -\zeta \omega \pm j \omega \sqrt{1 - \zeta^2}, \ -\alpha \omega $$
///
/// which is linear in the gains.
pub(super) fn placed(
    process: &Process,
    options: PoleOptions,
    form: Form,
    omega: f64,
    filter_s: f64,
) -> Result<(Gains<f64>, PlacedPoles), RuleError> {
    let dt_s = process.open.dt_s();
    let (damping, third) = (options.damping, options.third * omega);
    let radius = libm::exp(-damping * omega * dt_s);
    let (sine, cosine) = libm::sincos(omega * (1.0 - damping * damping).sqrt() * dt_s);
    let pair = Complex::new(radius * cosine, radius * sine);
    let real = Complex::new(libm::exp(-third * dt_s), 0.0);
    let terms = |z: Complex| {
        let integral = quotient(z * dt_s, z - 1.0);
        let derivative = quotient(z - 1.0, z * (filter_s + dt_s) - filter_s);
        [Complex::new(1.0, 0.0), integral, derivative]
    };
    let wanted = |z: Complex| quotient(Complex::new(-1.0, 0.0), process.open.at_z(z));
    let gains = if form == Form::Pid { 3 } else { 2 };
    let row = |part: fn(Complex) -> f64, z: Complex| -> (Vec<f64>, Vec<f64>) {
        (terms(z).into_iter().take(gains).map(part).collect(), vec![part(wanted(z))])
    };
    let rows = [row(|v| v.re, pair), row(|v| v.im, pair), row(|v| v.re, real)];
    let (left, right): (Vec<_>, Vec<_>) = rows.into_iter().take(gains).unzip();
    let nowhere = RuleError::NotPlaceable { frequency_rad_s: omega };
    let solve = || Matrix::from_rows(&left)?.solve(&Matrix::from_rows(&right)?);
    let found = solve().map_err(|_| nowhere)?;
    let gain = |place: usize| found.get(place, 0).unwrap_or(0.0);
    let mut z = vec![pair, pair.conj()];
    z.extend((form == Form::Pid).then_some(real));
    let third_per_s = (form == Form::Pid).then_some(-third);
    let poles = PlacedPoles { damping, frequency_rad_s: omega, third_per_s, z };
    Ok((Gains { kp: gain(0), ki: gain(1), kd: gain(2) }, poles))
}

impl PlacedPoles {
    /// What is to be said of the closed loop's other poles: the largest of them against the pair.
    pub(super) fn warnings(&self, closed: &[Complex]) -> Vec<String> {
        let mut others = closed.to_vec();
        for placed in &self.z {
            let distance = |pole: &Complex| modulus(pole - placed);
            let near = others.iter().enumerate();
            let nearest = near.min_by(|(_, a), (_, b)| distance(a).total_cmp(&distance(b)));
            if let Some((place, _)) = nearest {
                others.swap_remove(place);
            }
        }
        let rest = others.into_iter().map(modulus).fold(0.0, f64::max);
        let pair = self.z.first().copied().map_or(0.0, modulus);
        if rest < pair {
            return Vec::new();
        }
        vec![format!(
            "the pair does not dominate: another pole of the closed loop has modulus {rest:.6} in the z-plane, the pair {pair:.6}"
        )]
    }
}

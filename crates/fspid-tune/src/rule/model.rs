//! Simple models of a process, fitted to its frequency response, and how badly they fit.

use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use fspid_lti::{Complex, modulus, quotient};
use serde::Serialize;

use super::process::Process;
use super::ultimate::UltimatePoint;
use super::{ProcessKind, RuleError};

/// Points of the band in which a fit is judged: some 0.03 decades each.
const POINTS: usize = 33;
/// The band begins this far below the ultimate frequency: a decade, in which loops tuned by these rules cross over.
const BAND: f64 = 10.0;
/// A fit this far off is warned of: a disk of ± 30 % is what loops with a disk margin of 0.6 bear at most.
const POOR: f64 = 0.3;
/// Steps per octave in which the phase is followed down from the ultimate frequency.
const STEPS: f64 = 32.0;
/// Octaves in which it is followed.
const OCTAVES: f64 = 14.0;
/// Halvings of a step; doubles have no more digits.
const HALVINGS: usize = 60;

/// A simple model of the process from command to seen pitch. The dead time holds half a sample period of the hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Model {
    /// $K e^{-L s} / (T s + 1)$
    Lag {
        /// Steady gain K.
        gain: f64,
        /// Time constant T, s.
        time_s: f64,
        /// Dead time L, s.
        dead_s: f64,
    },
    /// $K e^{-L s} / ((T_1 s + 1)(T_2 s + 1))$
    TwoLags {
        /// Steady gain K.
        gain: f64,
        /// Time constants, s, the longer first.
        time_s: [f64; 2],
        /// Dead time L, s.
        dead_s: f64,
    },
    /// $K' e^{-L s} / s$
    Integrator {
        /// Steady rate per command K', 1/s.
        slope: f64,
        /// Dead time L, s.
        dead_s: f64,
    },
    /// $K' e^{-L s} / (s (T_2 s + 1))$
    IntegratorLag {
        /// Steady rate per command K', 1/s.
        slope: f64,
        /// Time constant T2, s.
        time_s: f64,
        /// Dead time L, s.
        dead_s: f64,
    },
}

impl Model {
    /// Its equation.
    #[must_use]
    pub fn equation(&self) -> &'static str {
        match self {
            Self::Lag { .. } => "K e^(-L s) / (T s + 1)",
            Self::TwoLags { .. } => "K e^(-L s) / ((T1 s + 1)(T2 s + 1))",
            Self::Integrator { .. } => "K' e^(-L s) / s",
            Self::IntegratorLag { .. } => "K' e^(-L s) / (s (T2 s + 1))",
        }
    }

    /// Its parameters, as its equation names them.
    #[must_use]
    pub fn parameters(&self) -> Vec<ModelParameter> {
        let one = |name, value, unit| ModelParameter { name, value, unit };
        match *self {
            Self::Lag { gain, time_s, dead_s } => {
                vec![one("K", gain, ""), one("T", time_s, "s"), one("L", dead_s, "s")]
            }
            Self::TwoLags { gain, time_s: [first, second], dead_s } => vec![
                one("K", gain, ""),
                one("T1", first, "s"),
                one("T2", second, "s"),
                one("L", dead_s, "s"),
            ],
            Self::Integrator { slope, dead_s } => {
                vec![one("K'", slope, "1/s"), one("L", dead_s, "s")]
            }
            Self::IntegratorLag { slope, time_s, dead_s } => {
                vec![one("K'", slope, "1/s"), one("T2", time_s, "s"), one("L", dead_s, "s")]
            }
        }
    }

    /// Dead time L, s.
    #[must_use]
    pub fn dead_s(&self) -> f64 {
        match *self {
            Self::Lag { dead_s, .. }
            | Self::TwoLags { dead_s, .. }
            | Self::Integrator { dead_s, .. }
            | Self::IntegratorLag { dead_s, .. } => dead_s,
        }
    }

    /// Relative dead time $L / (L + T)$ of a lag: 0 where the lag dominates, 1 where the dead time does.
    #[must_use]
    pub fn relative_dead_time(&self) -> Option<f64> {
        match *self {
            Self::Lag { time_s, dead_s, .. } => Some(dead_s / (dead_s + time_s)),
            _ => None,
        }
    }

    /// Value at a frequency, rad/s.
    #[must_use]
    pub fn at(&self, omega_rad_s: f64) -> Complex {
        let lag = |time_s: f64| Complex::new(1.0, omega_rad_s * time_s);
        let integrator = Complex::new(0.0, omega_rad_s);
        let (gain, below) = match *self {
            Self::Lag { gain, time_s, .. } => (gain, lag(time_s)),
            Self::TwoLags { gain, time_s: [first, second], .. } => (gain, lag(first) * lag(second)),
            Self::Integrator { slope, .. } => (slope, integrator),
            Self::IntegratorLag { slope, time_s, .. } => (slope, integrator * lag(time_s)),
        };
        let (sine, cosine) = libm::sincos(-omega_rad_s * self.dead_s());
        quotient(Complex::new(gain * cosine, gain * sine), below)
    }
}

/// A number in the equation of a model.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ModelParameter {
    /// Its letter in the equation.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// Its unit; empty where there is none.
    pub unit: &'static str,
}

/// A model with what it was fitted to.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedModel {
    /// The model.
    pub model: Model,
    /// What it was fitted to.
    pub how: &'static str,
    /// Largest distance from the process over the band, relative to the process.
    pub fit_error: f64,
    /// The band, rad/s: a decade below the ultimate frequency.
    pub band_rad_s: [f64; 2],
}

impl FittedModel {
    /// What is to be said of the fit.
    pub(super) fn warnings(&self) -> Vec<String> {
        if self.fit_error <= POOR {
            return Vec::new();
        }
        let [low, high] = self.band_rad_s;
        vec![format!(
            "the model is off by up to {:.0} % between {low:.3} and {high:.3} rad/s: the rule was made for processes that it fits",
            100.0 * self.fit_error
        )]
    }
}

/// What a model is fitted to: the point at −180 deg, and others where it has more parameters.
pub(super) struct Fit<'a> {
    process: &'a Process,
    /// Frequency and gain at −180 deg.
    ultimate: (f64, f64),
    /// Frequency and gain at −135 deg below it.
    halfway: Option<(f64, f64)>,
}

impl<'a> Fit<'a> {
    pub(super) fn of(process: &'a Process, ultimate: &UltimatePoint) -> Self {
        let omega = ultimate.frequency_rad_s();
        let halfway = phase_below(process, omega, -PI + FRAC_PI_4);
        let halfway = halfway.map(|omega| (omega, modulus(process.at(omega))));
        Self { process, ultimate: (omega, 1.0 / ultimate.gain), halfway }
    }

    /// A model of first order of the kind that is asked for.
    pub(super) fn first_order(&self, kind: ProcessKind) -> Result<FittedModel, RuleError> {
        self.of_kind(kind, Self::lag, Self::integrator)
    }

    /// A model of second order; one of first order where no second time constant fits, or where it fits worse.
    pub(super) fn second_order(&self, kind: ProcessKind) -> Result<FittedModel, RuleError> {
        let second = self.of_kind(kind, Self::two_lags, Self::integrator_lag)?;
        let first = self.first_order(kind)?;
        Ok(if second.fit_error <= first.fit_error { second } else { first })
    }

    fn of_kind(
        &self,
        kind: ProcessKind,
        lag: fn(&Self) -> Option<(Model, &'static str)>,
        integrator: fn(&Self) -> (Model, &'static str),
    ) -> Result<FittedModel, RuleError> {
        let lag = || lag(self).map(|found| self.judged(found));
        let integrator = || self.judged(integrator(self));
        match kind {
            ProcessKind::Integrating => Ok(integrator()),
            ProcessKind::Lag => lag().ok_or(RuleError::NoModel { kind: "lag", other: "at rest" }),
            ProcessKind::Auto if self.process.integrators > 0 => Ok(integrator()),
            ProcessKind::Auto => {
                let (first, second) = (lag(), integrator());
                Ok(first.filter(|lag| lag.fit_error <= second.fit_error).unwrap_or(second))
            }
        }
    }

    /// K from the steady state; T and L from gain and phase at −180 deg:
    ///
    /// $$ T = \frac{\sqrt{(K/g)^2 - 1}}{\omega}, \quad L = \frac{\pi - \arctan \omega T}{\omega} $$
    fn lag(&self) -> Option<(Model, &'static str)> {
        let (omega, size) = self.ultimate;
        let gain = self.process.steady.filter(|_| self.process.integrators == 0)?;
        let ratio = gain / size;
        if !(ratio > 1.0) {
            return None;
        }
        let time_s = (ratio * ratio - 1.0).sqrt() / omega;
        let dead_s = (PI - libm::atan(omega * time_s)) / omega;
        let how = "steady gain, and gain and phase at -180 deg";
        Some((Model::Lag { gain, time_s, dead_s }, how))
    }

    /// $L = \pi / (2 \omega)$, $K' = g \omega$ at −180 deg.
    fn integrator(&self) -> (Model, &'static str) {
        let (omega, size) = self.ultimate;
        let model = Model::Integrator { slope: size * omega, dead_s: FRAC_PI_2 / omega };
        (model, "gain and phase at -180 deg")
    }

    /// With the gains g at −135 and −180 deg the sum s and product p of the squares of the time constants are
    ///
    /// $$ (K / g)^2 - 1 = \omega^2 s + \omega^4 p $$
    fn two_lags(&self) -> Option<(Model, &'static str)> {
        let (lag, how) = self.lag()?;
        let two = || {
            let gain = self.process.steady?;
            let excess = |size: f64| (gain / size) * (gain / size) - 1.0;
            let (high, low) = (self.ultimate, self.halfway?);
            let [sum, product] = straight(low, high, excess)?;
            let root = (0.25 * sum * sum - product).sqrt();
            let squares = [0.5 * sum + root, 0.5 * sum - root];
            // Written so that NaN, two complex time constants, is none.
            if !squares.iter().all(|square| *square >= 0.0) {
                return None;
            }
            let time_s = squares.map(f64::sqrt);
            let lag = time_s.iter().map(|time_s| libm::atan(high.0 * time_s)).sum::<f64>();
            let dead_s = (PI - lag) / high.0;
            (dead_s >= 0.0).then_some(Model::TwoLags { gain, time_s, dead_s })
        };
        let how_two = "steady gain, gains at -135 and -180 deg, phase at -180 deg";
        Some(two().map_or((lag, how), |model| (model, how_two)))
    }

    /// With the gains g at −135 and −180 deg, or with K' and one of them,
    ///
    /// $$ \frac{1}{g^2} = \frac{\omega^2}{K'^2} + \omega^4 \frac{T_2^2}{K'^2} $$
    fn integrator_lag(&self) -> (Model, &'static str) {
        let (omega, size) = self.ultimate;
        let steady = self.process.steady.filter(|_| self.process.integrators == 1);
        let (terms, how) = match steady {
            Some(slope) => {
                let first = 1.0 / (slope * slope);
                let square = omega * omega;
                let second = (1.0 / (size * size * square) - first) / square;
                (Some([first, second]), "steady rate, and gain and phase at -180 deg")
            }
            None => {
                let low = self.halfway;
                let terms = |low| straight(low, self.ultimate, |size| 1.0 / (size * size));
                (low.and_then(terms), "gains at -135 and -180 deg, phase at -180 deg")
            }
        };
        // Written so that NaN is no model.
        let good = terms.filter(|[first, second]| *first > 0.0 && *second >= 0.0);
        let model = good.map(|[first, second]| {
            let time_s = (second / first).sqrt();
            let dead_s = (FRAC_PI_2 - libm::atan(omega * time_s)) / omega;
            Model::IntegratorLag { slope: 1.0 / first.sqrt(), time_s, dead_s }
        });
        model.map_or_else(|| self.integrator(), |model| (model, how))
    }

    fn judged(&self, (model, how): (Model, &'static str)) -> FittedModel {
        let (high, _) = self.ultimate;
        let low = high / BAND;
        let off = |index: usize| {
            let omega = low * libm::pow(BAND, index as f64 / (POINTS - 1) as f64);
            let process = self.process.at(omega);
            modulus(model.at(omega) - process) / modulus(process)
        };
        let errors = (0..POINTS).map(off);
        let fit_error = errors.fold(0.0, |most, off| if off <= most { most } else { off });
        FittedModel { model, how, fit_error, band_rad_s: [low, high] }
    }
}

/// a and b of $f(g) = \omega^2 a + \omega^4 b$ through two points of frequency and gain.
fn straight(low: (f64, f64), high: (f64, f64), value: impl Fn(f64) -> f64) -> Option<[f64; 2]> {
    let [(x_low, y_low), (x_high, y_high)] = [low, high].map(|(omega, size)| {
        let square = omega * omega;
        (square, value(size) / square)
    });
    let slope = (y_high - y_low) / (x_high - x_low);
    let start = y_low - slope * x_low;
    (slope.is_finite() && start.is_finite()).then_some([start, slope])
}

/// The highest frequency below one at which the phase is what is asked for, rad/s.
fn phase_below(process: &Process, from_rad_s: f64, phase_rad: f64) -> Option<f64> {
    let below = |omega: f64| process.open.phase_rad(omega) < phase_rad;
    let mut high = from_rad_s;
    for _ in 0..(STEPS * OCTAVES) as usize {
        let low = high * libm::exp2(-1.0 / STEPS);
        if !below(low) {
            let (mut above, mut under) = (low, high);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (above + under);
                if below(middle) { under = middle } else { above = middle }
            }
            return Some(above);
        }
        high = low;
    }
    None
}

//! Lyapunov function for the terminal set of a step: an ellipsoid, as large as possible, in which no limit is active.
//!
//! With the gains at rest, with rows $r_i$ to everything that is limited by $L_i$, and rows $s_j$ to what each gain
//! multiplies,
//!
//! $$ P = \sum_{k \ge 0} \rho^{-2k} (M^T)^k \Big( \sum_i \frac{r_i^T r_i}{L_i^2} + \lambda \sum_j s_j^T s_j + \epsilon I
//! \Big) M^k $$
//!
//! counts how near to its limits the loop comes from now on: where it is 1 or less, none acts. The second sum makes room for
//! gains that are somewhat off those at rest; the smaller the ellipsoid, the less they are. Ordinary arithmetic finds it; that
//! it decreases for all gains near rest, and that no limit acts there, is proved as of any other form. Of gains that remember
//! see [`super::wide`].

use fspid_core::Gains;
use fspid_lti::Matrix;
use fspid_numeric::scalar::Interval;
use fspid_sim::Controller;
use fspid_sim::loop_model::LoopModel;

use crate::certificate::Certificate;
use crate::check::{IntervalMatrix, decreases};
use crate::gain_set::{GainSet, HeldGains};
use crate::limits;
use crate::rest::Rest;
use crate::solve;

use super::near::corners_within;
use super::tuned::Tuner;
use super::wide::Wide;

/// Part of the way from the slowest mode to 1 at which the form still decreases.
const SLOWER: f64 = 0.5;
/// What every state adds to the form, as a share of what limits add.
const REGULAR: f64 = 1e-9;
/// Weights of what gains multiply, against that of the limits.
const WEIGHTS: [f64; 6] = [0.0, 0.01, 0.1, 1.0, 10.0, 100.0];
/// Levels are tried so many times, each a quarter of the one before.
const QUARTERS: i32 = 9;
/// Largest error, rad, near rest that is tried for gains that remember, how much smaller each is than the one before, and how
/// many there are.
const LARGEST_ERROR_RAD: f64 = 0.1;
const SMALLER: f64 = 0.7;
const ERRORS: u8 = 26;
/// Of the widest ellipsoid that is found one with more room for gains may have so much.
const ENOUGH: f64 = 0.4;

/// A form near rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Terminal {
    /// P.
    pub form: Matrix,
    /// ρ, below 1.
    pub rate: f64,
    /// c.
    pub level: f64,
    /// Of gains that remember, where they have to be.
    pub gains: Option<NearGains>,
}

/// Gains near rest that remember, and what has become of their reference model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearGains {
    /// Least and most of kp, ki and kd: a box that they stay in.
    pub gains: [[f64; 2]; 3],
    /// Most that the reference model is off the set-point from then on, rad; 0 without one.
    pub model_rad: f64,
}

impl NearGains {
    /// The box; one whose ends are not in order is that of zeros alone, and is proved or refused as such.
    pub(crate) fn bounds(&self) -> [Interval; 3] {
        self.gains.map(|[least, most]| Interval::new(least, most).unwrap_or(Interval::ZERO))
    }
}

/// A loop of which a form near rest is looked for.
pub(super) struct NearRest<'a> {
    pub(super) certificate: &'a Certificate,
    pub(super) enclosed: &'a LoopModel<Interval>,
    /// All gains, with what they make of the command that is held.
    pub(super) held: &'a GainSet,
    pub(super) rest: &'a Rest,
}

impl NearRest<'_> {
    /// The form with the largest ellipsoid that is found.
    pub(super) fn found(&self, stops: fn() -> bool) -> Option<Terminal> {
        let tuner = match &self.certificate.description.controller {
            Controller::Fixed(_) => None,
            Controller::SelfTuning(fspid) => Tuner::of(fspid),
        };
        let Some(tuner) = tuner else {
            return self.largest();
        };
        let wide = Wide::of(self, &tuner, stops)?;
        // The larger the error, the more gains may still be off those at rest, and the earlier a flight is near.
        let errors = (0..ERRORS).map(|power| LARGEST_ERROR_RAD * libm::pow(SMALLER, power.into()));
        let found = errors.filter_map(|error_rad| {
            let terminal = wide.within(error_rad)?;
            let within = limits::pitch_within(self.enclosed, &terminal.form, terminal.level)?;
            self.holds(&terminal).then_some((within, terminal))
        });
        let found: Vec<(f64, Terminal)> = found.collect();
        let widest = found.iter().map(|(within, _)| *within).fold(0.0, f64::max);
        found.into_iter().find(|(within, _)| *within >= ENOUGH * widest).map(|(_, it)| it)
    }

    /// The form with the largest ellipsoid, of gains that do not remember.
    fn largest(&self) -> Option<Terminal> {
        let [kp, ki, kd] = self.held.rest.map(Interval::midpoint);
        let gains = Gains { kp, ki, kd };
        let model = self.enclosed.midpoint();
        let mut best: Option<(f64, Terminal)> = None;
        for weight in WEIGHTS {
            let Some(terminal) = self.weighted(&model, gains, weight) else { continue };
            // Compared by how far the pitch angle may be off.
            let within = limits::pitch_within(self.enclosed, &terminal.form, terminal.level);
            let within = within.unwrap_or(0.0);
            if best.as_ref().is_none_or(|(most, _)| within > *most) {
                best = Some((within, terminal));
            }
        }
        best.map(|(_, terminal)| terminal)
    }

    fn weighted(&self, model: &LoopModel<f64>, gains: Gains<f64>, weight: f64) -> Option<Terminal> {
        let description = &self.certificate.description;
        let matrix = model.closed_matrix(gains).ok()?;
        let radius = fspid_lti::spectral_radius(&matrix).ok()?;
        let rate = radius + SLOWER * (1.0 - radius);
        let size = matrix.rows();
        let mut sum = vec![vec![0.0; size]; size];
        let mut add = |row: &[f64], factor: f64| {
            for (by_row, own) in sum.iter_mut().zip(row) {
                by_row
                    .iter_mut()
                    .zip(row)
                    .for_each(|(entry, other)| *entry += factor * own * other);
            }
        };
        let limited = limits::rows(description, model, gains, self.rest);
        let narrowest = limited.iter().map(|(_, limit)| *limit).fold(f64::INFINITY, f64::min);
        limited.iter().for_each(|(row, limit)| add(row, 1.0 / (limit * limit)));
        // What each gain lets into the command.
        let none = model.command_row(Gains::ZERO);
        for one in [
            Gains { kp: gains.kp, ..Gains::ZERO },
            Gains { ki: gains.ki, ..Gains::ZERO },
            Gains { kd: gains.kd, ..Gains::ZERO },
        ] {
            let row = model.command_row(one);
            let row: Vec<f64> =
                row.iter().zip(&none).map(|(with, without)| with - without).collect();
            add(&row, weight / (narrowest * narrowest));
        }
        let most = (0..size).map(|place| sum[place][place]).fold(0.0, f64::max);
        (0..size).for_each(|place| sum[place][place] += REGULAR * most);
        let form = solve::summed(&matrix.scaled(1.0 / rate), &Matrix::from_rows(&sum).ok()?)?;
        // A little above what the form was made for, so that the difference stands clear of rounding.
        let rate = rate + 0.5 * (1.0 - rate);
        let corner = HeldGains { gains, change_gain: 0.0, remembered: None };
        let most =
            limits::level([(&form, limits::rows_held(description, model, &corner, self.rest))])?;
        let levels = (0..QUARTERS).map(|quarter| most * 0.95 * libm::ldexp(1.0, -2 * quarter));
        (rate < 1.0).then_some(())?;
        let terminals =
            levels.map(|level| Terminal { form: form.clone(), rate, level, gains: None });
        let mut terminals = terminals.filter(|terminal| self.holds(terminal));
        terminals.next()
    }

    /// Whether a form decreases, and no limit acts, for all gains within its ellipsoid.
    fn holds(&self, terminal: &Terminal) -> bool {
        let Terminal { form, rate, level, .. } = terminal;
        let (rate, level) = (*rate, *level);
        let description = &self.certificate.description;
        let corners = corners_within(description, self.enclosed, self.held, terminal);
        corners.is_ok_and(|corners| {
            corners.iter().all(|HeldGains { gains, change_gain, remembered: _ }| {
                let model = self.enclosed.with_change_gain(Interval::point(*change_gain));
                let Gains { kp, ki, kd } = *gains;
                let [kp, ki, kd] = [kp, ki, kd].map(Interval::point);
                let at = Gains { kp, ki, kd };
                let rows = limits::rows(description, &model, at, self.rest);
                IntervalMatrix::from_rows(&model.closed(at))
                    .is_ok_and(|matrix| decreases(form, rate, &matrix, None).is_ok())
                    && limits::prove(&rows, form, level).is_ok()
            })
        })
    }
}

#[cfg(test)]
pub(super) mod tests;

//! Terminal set for gains that remember: the ellipsoid that reaches furthest along the incoming trajectories.
//!
//! First comes the largest error near rest. While the error keeps to it, gains stay in a box, and the form falls at every
//! corner of that box; neither a limit nor a larger error lies in its ellipsoid, and what is left of the flight of a step
//! as far in it as it can be.

use fspid_core::Gains;
use fspid_lti::Matrix;
use fspid_numeric::scalar::Interval;
use fspid_sim::loop_model::LoopModel;

use crate::check::reach;
use crate::gain_set::HeldGains;
use crate::limits;
use crate::solve::{self, WidestProblem};

use super::near::boxed;
use super::terminal::{NearGains, NearRest, Terminal};
use super::tuned::Tuner;
use super::work::MOST_SAMPLES;

/// A sample takes from the form this share of what it takes from the slowest mode of all corners.
const SLOWER: f64 = 0.25;
/// Of the level that the form is made for, so much is claimed.
const CLAIMED: f64 = 0.98;
/// Of the largest error near rest the reference model may still be off so much.
const MODEL: f64 = 0.25;
/// What is left of a step after so many seconds is to be far in the ellipsoid.
const AFTER_S: [f64; 5] = [4.0, 8.0, 16.0, 32.0, 64.0];
/// The box is so much wider, of all gains, than where they tend to.
const SLACK: f64 = 1.0 / 64.0;

/// The end of a step, of a loop whose gains remember.
pub(super) struct Wide<'a> {
    near: &'a NearRest<'a>,
    tuner: &'a Tuner<'a>,
    model: LoopModel<f64>,
    /// Of what is seen beside the error, in the units of [`Tuner::keeps`], so much for each rad of it.
    second_per_rad: f64,
    /// How far the reference model is off its set-point, in units of the error.
    model_off: f64,
    effort: solve::Effort,
}

impl<'a> Wide<'a> {
    /// What is seen beside the error is a change that is to it as one bound is to the other in a form that falls at rest, or
    /// the error of a model that has all but come to its set-point.
    pub(super) fn of(
        near: &'a NearRest<'a>,
        tuner: &'a Tuner<'a>,
        stops: fn() -> bool,
    ) -> Option<Self> {
        let model = near.enclosed.midpoint();
        let effort = solve::Effort { stops, ..solve::Effort::default() };
        let (second_per_rad, model_off) = match tuner.change_divisor() {
            None => (1.0 + MODEL, MODEL),
            Some(divisor) => {
                let at_rest = closed_at(&model, &corners(near.held.rest))?;
                let form = solve::common_form(&at_rest, slower(&at_rest)?, &effort)?;
                let [error, change] = near.enclosed.error_rows().map(|row| reach(&form, 1.0, &row));
                (change.ok()? / (error.ok()? * divisor), 0.0)
            }
        };
        Some(Self { near, tuner, model, second_per_rad, model_off, effort })
    }

    /// A form whose ellipsoid is wide, in which the error is at most so large, rad.
    pub(super) fn within(&self, error_rad: f64) -> Option<Terminal> {
        let Self { near, model, effort, .. } = self;
        let bounds = self.gains(error_rad);
        let corners = corners(bounds);
        let matrices = closed_at(model, &corners)?;
        let rate = slower(&matrices)?;
        let start = solve::common_form(&matrices, rate, effort)?;
        let mut rows = self.shown(error_rad);
        for gains in &corners {
            let limited = limits::rows(&near.certificate.description, model, *gains, near.rest);
            rows.extend(limited.iter().map(|(row, limit)| over(row, *limit)));
        }
        let directions = self.directions(&matrices, &start)?;
        let problem =
            WidestProblem { matrices: &matrices, rows: &rows, directions: &directions, rate };
        let form = solve::widest(&problem, &start, effort)?;
        let gains = bounds.map(|it| [it.lower(), it.upper()]);
        let gains = Some(NearGains { gains, model_rad: self.model_off * error_rad });
        // A little above the rate that the form was made for, so that the difference stands clear of rounding.
        Some(Terminal { form, rate: rate + 0.5 * (1.0 - rate), level: CLAIMED, gains })
    }

    /// Where gains come to while the error is no larger, and somewhat more.
    fn gains(&self, error_rad: f64) -> [Interval; 3] {
        let held = self.near.held;
        let whole = held.bounds();
        let targets = self.tuner.targets([error_rad, self.second_per_rad * error_rad]);
        [0, 1, 2].map(|gain: usize| {
            let slack = SLACK * whole[gain].width();
            let wider = targets[gain].hull(held.rest[gain]) + Interval::between(-slack, slack);
            wider.intersection(whole[gain]).unwrap_or(whole[gain])
        })
    }

    /// Rows from the state to what the supervisor is shown, each over the most that it may be.
    fn shown(&self, error_rad: f64) -> Vec<Vec<f64>> {
        let [error, change] = self.model.error_rows();
        let most = |divisor: f64| self.second_per_rad * error_rad * divisor;
        let of_change = self.tuner.change_divisor().map(|divisor| over(&change, most(divisor)));
        [over(&error, error_rad)].into_iter().chain(of_change).collect()
    }

    /// Where a flight comes from: what is left of a deviation after some time, at the least and the largest gains, each as
    /// long as the others in the form.
    fn directions(&self, matrices: &[Matrix], form: &Matrix) -> Option<Vec<Vec<f64>>> {
        let dt_s = self.near.certificate.description.controller.config().dt_s;
        let ends = matrices.first().into_iter().chain(matrices.last());
        let mut found = Vec::new();
        for matrix in ends {
            let (mut state, mut sample) = (self.model.pitch_off(1.0), 0_usize);
            for after_s in AFTER_S {
                while sample as f64 * dt_s < after_s && sample < MOST_SAMPLES {
                    state = times(matrix, &state)?;
                    sample += 1;
                }
                let squared: f64 = state.iter().zip(times(form, &state)?).map(|(x, y)| x * y).sum();
                if squared > 0.0 && squared.is_finite() {
                    found.push(over(&state, squared.sqrt()));
                }
            }
        }
        Some(found)
    }
}

fn corners(bounds: [Interval; 3]) -> Vec<Gains<f64>> {
    boxed(bounds).into_iter().map(|HeldGains { gains, .. }| gains).collect()
}

fn closed_at(model: &LoopModel<f64>, corners: &[Gains<f64>]) -> Option<Vec<Matrix>> {
    corners.iter().map(|gains| model.closed_matrix(*gains).ok()).collect()
}

/// A rate below 1 that leaves room for one form; nothing where a loop grows.
fn slower(matrices: &[Matrix]) -> Option<f64> {
    let radii = matrices.iter().map(|it| fspid_lti::spectral_radius(it).ok());
    let slowest = radii.collect::<Option<Vec<f64>>>()?.into_iter().fold(0.0, f64::max);
    let rate = 1.0 - SLOWER * (1.0 - slowest);
    (rate < 1.0).then_some(rate)
}

fn over(row: &[f64], limit: f64) -> Vec<f64> {
    row.iter().map(|entry| entry / limit).collect()
}

fn times(matrix: &Matrix, state: &[f64]) -> Option<Vec<f64>> {
    let mut next = vec![0.0; state.len()];
    matrix.apply(state, &mut next).ok()?;
    Some(next)
}

#[cfg(test)]
mod tests;

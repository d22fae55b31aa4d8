//! The form for the end of a step of gains that remember, whose ellipsoid reaches furthest along the flights that come to it.
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
use crate::solve::{self, Condition, LyapunovProblem, Verdict, WidestProblem};

use super::near::boxed;
use super::terminal::{NearGains, NearRest, Terminal};
use super::tuned::Tuner;

/// The form falls at least by this share of what the slowest corner of the box does.
const SLOWER: f64 = 0.25;
/// Of the level that the form is made for, so much is claimed.
const CLAIMED: f64 = 0.98;
/// Of the largest error near rest the reference model may still be off so much.
const MODEL: f64 = 0.25;
/// What is left of a step after so many samples is to be far in the ellipsoid.
const SAMPLES: [usize; 5] = [400, 800, 1600, 3200, 6400];
/// The box is so much wider, of all gains, than where they tend to.
const SLACK: f64 = 1.0 / 64.0;

/// What a supervisor may be shown near rest, and what has become of its reference model.
#[derive(Clone, Copy)]
struct Shown {
    error_rad: f64,
    /// What is seen beside it, in the units of [`Tuner::keeps`].
    second: f64,
    model_rad: f64,
}

impl Shown {
    /// With an error up to a size: a change that is to it as one bound is to the other in a form that falls at rest, or the
    /// error of a model that has all but come to its set-point.
    fn of(near: &NearRest<'_>, tuner: &Tuner<'_>, error_rad: f64) -> Option<Self> {
        let Some(divisor) = tuner.change_divisor() else {
            let model_rad = MODEL * error_rad;
            return Some(Self { error_rad, second: error_rad + model_rad, model_rad });
        };
        let at_rest = closed_at(&near.enclosed.midpoint(), &corners(near.held.rest))?;
        let form = start(&at_rest, slower(&at_rest)?)?;
        let [error, change] = near.enclosed.error_rows().map(|row| reach(&form, 1.0, &row));
        let second = error_rad * change.ok()? / (error.ok()? * divisor);
        Some(Self { error_rad, second, model_rad: 0.0 })
    }

    /// Where gains come to while no more than that is shown, and somewhat more.
    fn gains(&self, near: &NearRest<'_>, tuner: &Tuner<'_>) -> [Interval; 3] {
        let whole = near.held.bounds();
        let targets = tuner.targets([self.error_rad, self.second]);
        [0, 1, 2].map(|gain: usize| {
            let slack = SLACK * whole[gain].width();
            let wider = targets[gain].hull(near.held.rest[gain]) + Interval::between(-slack, slack);
            wider.intersection(whole[gain]).unwrap_or(whole[gain])
        })
    }

    /// Rows from the state that may not come to more than 1.
    fn rows(&self, near: &NearRest<'_>, tuner: &Tuner<'_>) -> Vec<Vec<f64>> {
        let [error, change] = near.enclosed.midpoint().error_rows();
        let of_change = tuner.change_divisor().map(|divisor| over(&change, self.second * divisor));
        [over(&error, self.error_rad)].into_iter().chain(of_change).collect()
    }
}

/// A form whose ellipsoid is wide, in which the error is at most so large, rad.
pub(super) fn wide(
    near: &NearRest<'_>,
    tuner: &Tuner<'_>,
    error_rad: f64,
    stops: fn() -> bool,
) -> Option<Terminal> {
    let model = near.enclosed.midpoint();
    let shown = Shown::of(near, tuner, error_rad)?;
    let bounds = shown.gains(near, tuner);
    let corners = corners(bounds);
    let matrices = closed_at(&model, &corners)?;
    let rate = slower(&matrices)?;
    let start = start(&matrices, rate)?;
    let limited = corners
        .iter()
        .flat_map(|gains| limits::rows(&near.certificate.description, &model, *gains, near.rest));
    let mut rows = shown.rows(near, tuner);
    rows.extend(limited.map(|(row, limit)| over(&row, limit)));
    let directions = directions(&model.pitch_off(1.0), &matrices, &start);
    let problem = WidestProblem { matrices: &matrices, rows: &rows, directions: &directions, rate };
    let effort = solve::Effort { stops, ..solve::Effort::default() };
    let form = solve::widest(&problem, &start, &effort)?;
    let gains = bounds.map(|it| [it.lower(), it.upper()]);
    let gains = Some(NearGains { gains, model_rad: shown.model_rad });
    // A little above the rate that the form was made for, so that the difference stands clear of rounding.
    Some(Terminal { form, rate: rate + 0.5 * (1.0 - rate), level: CLAIMED, gains })
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

/// A form that falls at every corner.
fn start(matrices: &[Matrix], rate: f64) -> Option<Matrix> {
    let conditions: Vec<Condition<'_>> =
        matrices.iter().map(|matrix| Condition { matrix, cone: None }).collect();
    let problem = LyapunovProblem { conditions: &conditions, cones: &[], rate };
    match solve::common_lyapunov(&problem, &solve::Effort::default()) {
        Verdict::Found(solution) => Some(solution.p),
        Verdict::NotFound { .. } => None,
    }
}

/// Where a flight comes from: what is left of a deviation after some time, at the least and the largest gains, each as long
/// as the others in the form.
fn directions(begun: &[f64], matrices: &[Matrix], form: &Matrix) -> Vec<Vec<f64>> {
    let ends = matrices.first().into_iter().chain(matrices.last());
    let mut found = Vec::new();
    for matrix in ends {
        let (mut state, mut sample) = (begun.to_vec(), 0);
        for next in SAMPLES {
            for _ in sample..next {
                state = times(matrix, &state);
            }
            sample = next;
            let size = dot(&state, &times(form, &state)).sqrt();
            if size > 0.0 && size.is_finite() {
                found.push(over(&state, size));
            }
        }
    }
    found
}

fn times(matrix: &Matrix, state: &[f64]) -> Vec<f64> {
    matrix.data().chunks(state.len()).map(|row| dot(row, state)).collect()
}

fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}

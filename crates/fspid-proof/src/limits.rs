//! Ellipsoidal region of attraction in which no limit is active, so that the linear proof holds for the loop with its limits.
//!
//! Where $z^T P z$ decreases, a state that is inside of $z^T P z \le c$ stays inside. With
//!
//! $$ c \le \frac{L^2}{r P^{-1} r^T} $$
//!
//! for every row r that some gain gives a limited quantity $r z$, $|r z| \le L$ holds at every sample.

use core::borrow::Borrow;
use core::fmt;

use fspid_core::{AntiWindup, Gains, Limits};
use fspid_lti::Matrix;
use fspid_numeric::Scalar;
use fspid_numeric::scalar::{Base, Interval};
use fspid_sim::loop_model::LoopModel;

use crate::check::{ActuatorLag, IntervalMatrix, NotProved, inside_limit};
use crate::description::LoopDescription;
use crate::gain_set::HeldGains;
use crate::rest::Rest;
use crate::scope::Range;

/// Of the largest level that ordinary arithmetic finds, so much is claimed.
const CLAIMED: f64 = 1.0 - 1e-6;
/// Of a limit rest may take so much. A rest that is closer to a limit is linear around it, but only for motions that are
/// too small to be of use: a set-point of 40.21 deg with a sample guard at 40.23 deg was proved, and every flight to it
/// met the guard on its way. A tenth is what motions are left; how large they may be is told beside the proof.
const TAKEN_BY_REST: f64 = 0.9;

/// Why no ellipsoid is claimed although something is limited.
pub(crate) fn not_covered(description: &LoopDescription) -> Option<&'static str> {
    let actuator = &description.actuator;
    let limited = actuator.rate_limit_rad_s().is_some() || actuator.travel_rad().is_some();
    match ActuatorLag::from(actuator.lag()) {
        ActuatorLag::Second { .. } if limited => Some(
            "between samples an actuator of second order may move further than at them, so that its limits are not covered",
        ),
        ActuatorLag::None if actuator.rate_limit_rad_s().is_some() => {
            Some("the rate limit of an actuator without lag is not covered")
        }
        _ if actuator.bias_rad() != 0.0 => {
            Some("with a bias of the actuator, rest is not in the middle of the limits")
        }
        // The loop then has no row for what is seen of it.
        _ if description.is_guarded() && description.only_supervisor_sees_rate() => {
            Some("the sample guard on a pitch rate that the supervisor alone sees is not covered")
        }
        _ => None,
    }
}

/// Rest that something limited does not leave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtLimit {
    /// Set-points and loads, at the largest of which it is.
    pub range: Range,
    /// What is limited, in words.
    pub what: &'static str,
    /// What rest asks of it, rad; infinite where nothing bounds that.
    pub needed_rad: f64,
    /// What it allows, rad.
    pub allowed_rad: f64,
}

impl fmt::Display for AtLimit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { range: Range { setpoint_rad, load_rad }, what, needed_rad, allowed_rad } = self;
        write!(f, "rest at {:.2} deg", setpoint_rad.to_degrees())?;
        if *load_rad > 0.0 {
            write!(f, " under a load of {:.2} deg", load_rad.to_degrees())?;
        }
        if needed_rad.is_finite() {
            write!(f, " needs {:.2} deg", needed_rad.to_degrees())?;
        } else {
            f.write_str(" needs more than anything allows")?;
        }
        let left = 100.0 * (1.0 - TAKEN_BY_REST);
        write!(f, ", and {what} is at {:.2} deg", allowed_rad.to_degrees())?;
        write!(f, ", of which {left:.0} % have to be left for motions")
    }
}

/// Whether nothing is at its limit at rest, or so close to it that motions have no room. At a limit the error would not
/// come to zero, or the linear loop around rest would not be the one that flies; rates are zero at rest, so that their
/// limits ask nothing.
pub(crate) fn within_at_rest(
    description: &LoopDescription,
    rest: &Rest,
    range: Range,
) -> Result<(), AtLimit> {
    let config = description.controller.config();
    let actuator = &description.actuator;
    let integral = match &config.anti_windup {
        AntiWindup::Clamping(limits) => Some(around_zero(limits)),
        AntiWindup::None | AntiWindup::Conditional | AntiWindup::BackCalculation { .. } => None,
    };
    let nearer = |(least, most): (f64, f64)| (-least).min(most);
    let guard = description.is_guarded().then(|| config.guard.limit_rad());
    let of_command = rest.command_rad;
    let asked = [
        ("the controller's output limit", of_command, config.limits.as_ref().map(around_zero)),
        ("the limit of the integral", rest.integral_rad, integral),
        ("the servo's command limit", of_command, actuator.command_limits_rad().map(nearer)),
        ("the end of the actuator's travel", of_command, actuator.travel_rad().map(nearer)),
        ("the controller's sample guard", rest.seen_rad, guard),
    ];
    for (what, needed_rad, allowed_rad) in asked {
        let Some(allowed_rad) = allowed_rad else { continue };
        // Written so that NaN is at the limit.
        if !(needed_rad <= TAKEN_BY_REST * allowed_rad) {
            return Err(AtLimit { range, what, needed_rad, allowed_rad });
        }
    }
    Ok(())
}

/// Rows from the state to everything that is limited, each with its limit, at some gains.
///
/// Of each limit so much is left for motions as rest itself does not take, with the resolution of the sensors
/// that may show in the command at once.
pub(crate) fn rows<T: Base + Magnitude>(
    description: &LoopDescription,
    model: &LoopModel<T>,
    gains: Gains<T>,
    rest: &Rest,
) -> Vec<(Vec<T>, f64)> {
    let config = description.controller.config();
    let actuator = &description.actuator;
    let mut rows = Vec::new();
    let command = || model.command_row(gains);
    let blur_rad = description.blur_of_command(model, gains);
    let around_rest = |limit: f64| less(limit, rest.command_rad, blur_rad);
    if let Some(limits) = &config.limits {
        rows.push((command(), around_rest(around_zero(limits))));
    }
    if let Some(slew_rad_s) = config.slew_rad_s {
        // Two commands that are both within half of it differ by no more.
        rows.push((command(), less(0.5 * slew_rad_s * config.dt_s, 0.0, blur_rad)));
    }
    if let AntiWindup::Clamping(limits) = &config.anti_windup {
        let [blur_of_pitch, _] = description.blurs();
        let by_pitch = Interval::point(gains.ki.largest()) * Interval::point(config.dt_s);
        let blur_rad = (by_pitch * Interval::point(blur_of_pitch)).upper();
        let limit = less(around_zero(limits), rest.integral_rad, blur_rad);
        rows.push((model.integral_row(gains), limit));
    }
    if let Some((least, most)) = actuator.command_limits_rad() {
        rows.push((command(), around_rest((-least).min(most))));
    }
    let deflection = || -> Vec<T> {
        let place = model.plant().states - 1;
        let unit = |column| if column == place { T::one() } else { T::zero() };
        (0..model.size()).map(unit).collect()
    };
    if let Some((least, most)) = actuator.travel_rad() {
        // A lag of first order stays between where it is and where it is told to go.
        let limit = around_rest((-least).min(most));
        rows.push((deflection(), limit));
        rows.push((command(), limit));
    }
    if let (Some(rate_rad_s), Some(time_s)) =
        (actuator.rate_limit_rad_s(), actuator.lag().time_constant_s())
    {
        // The rate is largest right after a new command: gap over time constant.
        let arriving = model.arriving_row(gains).into_iter().zip(deflection());
        let limit = less(rate_rad_s * time_s, 0.0, blur_rad);
        rows.push((arriving.map(|(v, x)| v - x).collect(), limit));
    }
    if description.is_guarded() {
        let limit_rad = config.guard.limit_rad();
        let [pitch, rate] = model.seen_rows();
        let [blur_of_pitch, blur_of_rate] = description.blurs();
        rows.push((pitch, less(limit_rad, rest.seen_rad, blur_of_pitch)));
        if model.settings().uses_rate() {
            rows.push((rate, less(limit_rad, 0.0, blur_of_rate)));
        }
    }
    rows
}

/// What is left of a limit, rounded down; not positive where nothing is.
fn less(limit: f64, rest: f64, blur: f64) -> f64 {
    (Interval::point(limit) - Interval::point(rest) - Interval::point(blur)).lower()
}

/// A number whose size is known.
pub(crate) trait Magnitude {
    /// The largest magnitude that it may have.
    fn largest(&self) -> f64;
}

impl Magnitude for f64 {
    fn largest(&self) -> f64 {
        self.abs()
    }
}

impl Magnitude for Interval {
    fn largest(&self) -> f64 {
        self.magnitude()
    }
}

impl LoopDescription {
    /// How far the resolution of the sensors may take seen pitch and seen rate off, rad and rad/s.
    pub(crate) fn blurs(&self) -> [f64; 2] {
        let rate = if self.controller.uses_rate() { 0.5 * self.rate.resolution } else { 0.0 };
        [0.5 * self.pitch.resolution, rate]
    }

    /// True if a sensor that the controller sees resolves in steps.
    pub(crate) fn resolves_in_steps(&self) -> bool {
        self.blurs().iter().any(|blur| *blur > 0.0)
    }

    /// How far it may take the command off at once, rad.
    fn blur_of_command<T: Base + Magnitude>(&self, model: &LoopModel<T>, gains: Gains<T>) -> f64 {
        let sizes = model.command_by_seen(gains).map(|entry| Interval::point(entry.largest()));
        let [by_pitch, by_rate] = sizes;
        let [pitch, rate] = self.blurs().map(Interval::point);
        (by_pitch * pitch + by_rate * rate).upper()
    }
}

fn around_zero(limits: &Limits<f64>) -> f64 {
    (-limits.lower()).min(limits.upper())
}

/// The [`rows`] of gains with what a held command makes of them.
pub(crate) fn rows_held(
    description: &LoopDescription,
    model: &LoopModel<f64>,
    held: &HeldGains,
    rest: &Rest,
) -> Vec<(Vec<f64>, f64)> {
    rows(description, &model.with_change_gain(held.change_gain), held.gains, rest)
}

/// The largest level for which ordinary arithmetic finds no limit at work, of forms each with the [`rows`] at its gains; none
/// without limits, or where rest is at one or the resolution of the sensors alone may bring one about.
pub(crate) fn level<F: Borrow<Matrix>>(
    places: impl IntoIterator<Item = (F, Vec<(Vec<f64>, f64)>)>,
) -> Option<f64> {
    let mut level = f64::INFINITY;
    for (form, rows) in places {
        for (row, limit) in rows {
            if !(limit > 0.0) {
                return None;
            }
            let column = Matrix::from_rows(&row.iter().map(|value| [*value]).collect::<Vec<_>>());
            let solved = form.borrow().solve(&column.ok()?).ok()?;
            let size: f64 = row.iter().zip(solved.data()).map(|(r, x)| r * x).sum();
            if size > 0.0 {
                level = level.min(CLAIMED * limit * limit / size);
            }
        }
    }
    (level > 0.0 && level.is_finite()).then_some(level)
}

/// Proves that no limit acts within a level; answers how many inequalities that took.
pub(crate) fn prove(
    rows: &[(Vec<Interval>, f64)],
    form: &Matrix,
    level: f64,
) -> Result<usize, NotProved> {
    for (row, limit) in rows {
        inside_limit(form, level, row, *limit)?;
    }
    Ok(rows.len())
}

/// How far the pitch angle may be off, everything else at rest, to lie within a level, rad.
#[must_use]
pub fn pitch_within(model: &LoopModel<Interval>, form: &Matrix, level: f64) -> Option<f64> {
    pitch_within_all(model, core::iter::once(&IntervalMatrix::from(form)), level)
}

/// As [`pitch_within`] for all of some forms.
pub(crate) fn pitch_within_all<'a>(
    model: &LoopModel<Interval>,
    forms: impl Iterator<Item = &'a IntervalMatrix>,
    level: f64,
) -> Option<f64> {
    let state = model.pitch_off(Interval::ONE);
    let size = |form: &IntervalMatrix| -> Interval {
        let rows = form.entries().enumerate();
        rows.fold(Interval::ZERO, |sum, (place, entry)| {
            let (row, column) = (place / state.len(), place % state.len());
            sum + state[row] * entry * state[column]
        })
    };
    let largest = forms.map(|form| size(form).upper()).fold(f64::NAN, f64::max);
    let pitch = (Interval::point(level) / Interval::point(largest)).sqrt().lower();
    (pitch > 0.0 && pitch.is_finite()).then_some(pitch)
}

//! Gains that a tuner attains at given inputs, computed by its own arithmetic; inner points of the gain set.

use fspid_core::{GainLimits, Gains, Law, Limits, SelfTuner};

use super::{array, gains};

/// The gains that a tuner answers where its supervisor sees `error` and `change`, in supervisor
/// units and with its sign.
///
/// With the memoryless law these are the controller's very bits. With the accumulating law they are
/// those that it tends to while the inputs stay: $k' + s \Delta k / \lambda$, or, if nothing leaks,
/// the limits (without limits, where it is after a second). Inputs that the supervisor refuses
/// leave the nominal gains, as at the first sample.
#[must_use]
pub fn producible(tuner: &SelfTuner<f64>, error: f64, change: f64) -> Gains<f64> {
    let increments = match tuner.increments_where_seen(error, change) {
        Some(increments) if !is_silent(tuner, [error, change]) => array(increments),
        _ => return tuner.nominal(),
    };
    let (nominal, settings) = (array(tuner.nominal()), tuner.settings());
    let limits = settings.gain_limits.map(sides);
    gains([0, 1, 2].map(|gain: usize| {
        let (nominal, increment) = (nominal[gain], increments[gain]);
        let limits = limits.map(|limits| limits[gain]);
        let free = match settings.law {
            Law::Memoryless => nominal + increment,
            Law::Accumulating { leakage_per_s } if leakage_per_s > 0.0 => {
                nominal + increment / leakage_per_s
            }
            Law::Accumulating { .. } => drifted(nominal, increment, limits),
        };
        limits.map_or(free, |limits| limits.clamp(free))
    }))
}

/// The gains that are produced at `count` by `count` points, evenly spaced over the range of the
/// supervisor: error, change (both in supervisor units) and the gains of [`producible`], error by
/// error.
#[must_use]
pub fn grid(tuner: &SelfTuner<f64>, count: usize) -> Vec<(f64, f64, Gains<f64>)> {
    let range = tuner.supervisor().range();
    let at = |point: usize| match count.saturating_sub(1) {
        0 => 0.0,
        last => range * (2.0 * point as f64 / last as f64 - 1.0),
    };
    let points = (0..count).flat_map(|error| (0..count).map(move |change| (error, change)));
    let answer =
        |(error, change)| (at(error), at(change), producible(tuner, at(error), at(change)));
    points.map(answer).collect()
}

/// Whether the dead zone keeps the supervisor from being asked.
fn is_silent(tuner: &SelfTuner<f64>, inputs: [f64; 2]) -> bool {
    let settings = tuner.settings();
    settings.dead_zone.is_some_and(|zone| {
        let scale = settings.input_scale;
        let sides = [scale.error_per_rad * zone.error_rad, scale.change_per_rad * zone.change_rad];
        inputs.iter().zip(sides).all(|(input, side)| input.abs() <= side.abs())
    })
}

fn sides(limits: GainLimits<f64>) -> [Limits<f64>; 3] {
    [limits.kp, limits.ki, limits.kd]
}

/// Where a gain is after a long time of one increment and no leakage.
fn drifted(nominal: f64, increment: f64, limits: Option<Limits<f64>>) -> f64 {
    match limits {
        Some(limits) if increment > 0.0 && limits.upper().is_finite() => limits.upper(),
        Some(limits) if increment < 0.0 && limits.lower().is_finite() => limits.lower(),
        _ => nominal + increment,
    }
}

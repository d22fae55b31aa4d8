//! Trajectory of a flight in the plane of the supervisor's inputs.

use fspid_core::{Change, ErrorSign, SecondInput};
use fspid_sim::{Controller, simulate};

use fspid_scenario::file::Study;

/// Error and change at each sample of a controller's flight, in the supervisor's units and within its
/// range; nothing for fixed gains, a supervisor that sees something else, or a flight that cannot be
/// flown.
#[must_use]
pub fn flown_inputs(study: &Study, name: &str) -> Vec<(f64, f64)> {
    let scenario = &study.scenario;
    let named = scenario.controllers.iter().position(|named| named.name == name);
    let Some((index, named)) = named.and_then(|at| Some((at, scenario.controllers.get(at)?)))
    else {
        return Vec::new();
    };
    let Controller::SelfTuning(fspid) = &named.controller else {
        return Vec::new();
    };
    if fspid.tuner().settings().second_input != SecondInput::Change {
        return Vec::new();
    }
    let mut alone = scenario.clone();
    alone.externals.clear();
    alone.controllers = scenario.controllers.get(index..=index).unwrap_or_default().to_vec();
    let Ok(flight) = simulate(&alone) else {
        return Vec::new();
    };
    let Some(trace) = flight.traces.first() else {
        return Vec::new();
    };
    let (settings, range) = (fspid.tuner().settings(), fspid.tuner().supervisor().range());
    let sign = match settings.error_sign {
        ErrorSign::SetpointMinusMeasurement => 1.0,
        ErrorSign::MeasurementMinusSetpoint => -1.0,
    };
    let time_s = match settings.change {
        Change::Rate => fspid.config().dt_s,
        Change::Delta => 1.0,
    };
    let scale = settings.input_scale;
    let mut previous: Option<f64> = None;
    let errors = trace.setpoint_rad.iter().zip(&trace.theta_rad).map(|(r, y)| r - y);
    errors
        .map(|error| {
            let change = previous.map_or(0.0, |before| error - before);
            previous = Some(error);
            let seen = |value: f64| (sign * value).clamp(-range, range);
            (seen(scale.error_per_rad * error), seen(scale.change_per_rad * change / time_s))
        })
        .collect()
}

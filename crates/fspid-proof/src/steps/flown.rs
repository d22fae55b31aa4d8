//! The loop of a description as its samples are flown.

use fspid_fuzzy::system::System;
use fspid_numeric::scalar::Interval;
use fspid_sim::loop_model::LoopModel;
use fspid_sim::{Actuator, Controller};

use super::gains::SeenGains;
use super::sample::{Flown, Layout, Row};
use super::servo::Curve;
use super::tuned::{LEFT, Tuner};
use crate::check::NotProved;
use crate::description::LoopDescription;
use crate::gain_set::GainSet;

/// The loop as its samples are flown.
pub(super) fn flown<'a>(
    description: &'a LoopDescription,
    model: &LoopModel<Interval>,
    set: &GainSet,
    system: Option<&'a System>,
) -> Result<Flown<'a>, NotProved> {
    let settings = model.settings();
    let config = settings.config;
    let uses_rate = config.rate_gain_s != 0.0;
    let plant = model.plant();
    let remembered = |sensing: &fspid_sim::loop_model::Sensing| {
        sensing.samples + usize::from(sensing.part > 0.0)
    };
    let queue = settings.delay_samples;
    let pitch = remembered(&settings.pitch);
    let rate = if uses_rate { remembered(&settings.rate) } else { 0 };
    let mut size = plant.states + queue + pitch + rate;
    let mut place = |there: bool| {
        there.then(|| {
            size += 1;
            size - 1
        })
    };
    let memory = settings.memory;
    let [integral, derivative, previous] =
        [memory.integral, memory.derivative, memory.previous].map(&mut place);
    let layout =
        Layout { plant: plant.states, queue, pitch, rate, integral, derivative, previous, size };
    let sparse = |row: &[Interval]| -> Row {
        let entries = row.iter().copied().enumerate();
        entries.filter(|(_, entry)| entry.magnitude() > 0.0).collect()
    };
    let [seen_pitch, seen_rate] = model.seen_rows();
    let actuator = &description.actuator;
    let fspid = match &description.controller {
        Controller::Fixed(_) => None,
        Controller::SelfTuning(fspid) => Some(fspid),
    };
    Ok(Flown {
        plant: plant.rows.chunks(plant.states + 1).map(<[Interval]>::to_vec).collect(),
        seen: [sparse(&seen_pitch), sparse(&seen_rate)],
        rate: sparse(&plant.rate),
        config,
        gains: SeenGains::of(set, fspid, system),
        tuner: fspid.and_then(Tuner::of),
        rested: around(set, LEFT),
        followers: settings.followers,
        curve: Curve::of(description)?,
        arriving: arriving(actuator),
        travel: actuator.travel_rad(),
        lag_order: actuator.lag().order(),
        reach: vec![0.0; size],
        layout,
    })
}

/// Limits of what arrives; without a lag an end of the travel is one of them.
fn arriving(actuator: &Actuator) -> Option<(f64, f64)> {
    let lag_order = actuator.lag().order();
    match (actuator.command_limits_rad(), actuator.travel_rad()) {
        (Some((a, b)), Some((c, d))) if lag_order == 0 => Some((a.max(c), b.min(d))),
        (None, travel) if lag_order == 0 => travel,
        (limits, _) => limits,
    }
}

/// A box around the gains at rest with a share of all gains.
pub(super) fn around(set: &GainSet, share: f64) -> [Interval; 3] {
    let bounds = set.bounds();
    [0, 1, 2].map(|gain: usize| {
        let (rest, whole) = (set.rest[gain], bounds[gain]);
        if share >= 1.0 {
            return whole.hull(rest);
        }
        let between = |end: f64, rest: f64| rest + share * (end - rest);
        rest.hull(Interval::between(
            between(whole.lower(), rest.lower()),
            between(whole.upper(), rest.upper()),
        ))
    })
}

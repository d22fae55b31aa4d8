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
    let plant = model.plant();
    let remembered = |sensing: &fspid_sim::loop_model::Sensing| {
        sensing.samples + usize::from(sensing.part > 0.0)
    };
    let queue = settings.delay_samples;
    let pitch = remembered(&settings.pitch);
    let rate = if settings.uses_rate() { remembered(&settings.rate) } else { 0 };
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

#[cfg(test)]
mod tests {
    use fspid_core::Gains;
    use fspid_sim::Scenario;
    use fspid_sim::actuator::Lag;
    use fspid_sim::loop_model::Sensing;

    use super::*;
    use crate::rest::drawn::{self, Dice};
    use crate::steps::affine::Affine;
    use crate::steps::flights::{Beginning, begun};
    use crate::steps::gains::Between;
    use crate::steps::not_covered;
    use crate::steps::sample::{FREE, Judge, Moment};

    /// A drawn loop that sees pitch and rate late, by samples and parts of one.
    fn seen_late(seed: u64) -> Option<LoopDescription> {
        let dice = &mut Dice::new(seed);
        let drawn: fn(&mut Dice) -> Scenario = match seed % 3 {
            0 => drawn::with_limits,
            1 => drawn::remembering_with_limits,
            _ => drawn::scenario,
        };
        let scenario = drawn(dice);
        let plant = scenario.plant.linear().expect("linear");
        let controller = &scenario.controllers[0].controller;
        let mut description = LoopDescription::of(&scenario, plant, controller).ok()?;
        let sensing = |dice: &mut Dice| {
            let part = if dice.part() < 0.5 { dice.part() } else { 0.0 };
            let samples = (3.0 * dice.part()) as usize;
            Sensing { scale: dice.between(0.8, 1.2), samples, part, ..Sensing::DIRECT }
        };
        (description.pitch, description.rate) = (sensing(dice), sensing(dice));
        not_covered(&description).is_none().then_some(description)
    }

    /// Samples without limits are those of the model, whatever of the loop is late: of drawn states. Answers what the loop
    /// remembers of commands, pitch and rate, and whether it sees a rate by what follows kd alone.
    fn is_the_model(seed: u64) -> Option<([usize; 3], bool)> {
        let description = seen_late(seed)?;
        let model = description.enclosed().ok()?;
        let all = [1.0, 0.5, 0.25].map(Interval::point);
        let set = GainSet::boxed(Gains { kp: 1.0, ki: 0.5, kd: 0.25 }, all, all);
        let loop_ = flown(&description, &model, &set, None).expect("flown");
        assert_eq!(loop_.layout.size, model.size(), "seed {seed}");
        let gains = Between { middle: [1.3, 0.4, 0.7], radius: [0.0; 3] };
        let [kp, ki, kd] = gains.middle.map(Interval::point);
        let rows = model.closed(Gains { kp, ki, kd });
        let dice = &mut Dice::new(seed);
        for _ in 0..3 {
            let state: Vec<f64> = rows.iter().map(|_| dice.between(-1.0, 1.0)).collect();
            let mut flight = begun(&loop_, Beginning::Rest);
            let values = state.iter().map(|value| Affine::constant(Interval::point(*value)));
            flight.values = values.collect();
            let passed = loop_.pass(&flight, Moment::Later, Judge::Forced(FREE, gains));
            let passed = passed.expect("nothing is judged").flight;
            for (place, (row, value)) in rows.iter().zip(&passed.values).enumerate() {
                let terms = row.iter().zip(&state).map(|(entry, at)| entry.midpoint() * at);
                let (next, found) = (terms.sum::<f64>(), value.range().midpoint());
                let off = (next - found).abs();
                assert!(off <= 1e-9 * (1.0 + next.abs()), "seed {seed}, {place}: {next} {found}");
            }
        }
        let layout = &loop_.layout;
        let follows = model.settings().config.rate_gain_s.abs() <= 0.0 && layout.rate > 0;
        Some(([layout.queue, layout.pitch, layout.rate], follows))
    }

    #[test]
    fn samples_without_limits_are_those_of_the_model_whatever_is_seen_late() {
        let (mut compared, mut all, mut following) = (0, 0, 0);
        for seed in 0..150 {
            let Some((remembered, follows)) = is_the_model(seed) else { continue };
            compared += 1;
            all += usize::from(remembered.iter().all(|count| *count > 0));
            following += usize::from(follows);
        }
        assert!(compared > 60 && all > 5 && following > 5, "{compared} {all} {following}");
    }

    #[test]
    fn what_arrives_is_limited_by_the_command_and_without_a_lag_by_the_travel() {
        let lag = Lag::first_order(0.1).expect("allowed");
        let (limits, travel) = ((-0.3, 0.2), (-0.25, 0.4));
        for (lag, limited, both, travelled) in [
            (Lag::NONE, Some(limits), Some((-0.25, 0.2)), Some(travel)),
            (lag, Some(limits), Some(limits), None),
        ] {
            let of = |commands: bool, travels: bool| {
                let mut actuator = Actuator::new(lag);
                if commands {
                    actuator = actuator.with_command_limits(limits.0, limits.1).expect("allowed");
                }
                if travels {
                    actuator = actuator.with_travel(travel.0, travel.1).expect("allowed");
                }
                arriving(&actuator)
            };
            let found = [of(true, false), of(true, true), of(false, true), of(false, false)];
            let expected = [limited, both, travelled, None];
            for (found, expected) in found.into_iter().zip(expected) {
                let bits = |ends: Option<(f64, f64)>| ends.map(|(a, b)| [a.to_bits(), b.to_bits()]);
                assert_eq!(bits(found), bits(expected), "{found:?} {expected:?}");
            }
        }
    }

    #[test]
    fn a_box_around_the_gains_at_rest_reaches_its_share_of_the_way_to_either_end() {
        let rest = [Interval::between(1.0, 1.1), Interval::point(0.7), Interval::point(-0.3)];
        let whole =
            [Interval::between(0.5, 3.1), Interval::point(0.7), Interval::between(-2.3, -0.3)];
        let set = GainSet { rest, ..GainSet::boxed(Gains::ZERO, rest, whole) };
        assert_eq!(around(&set, 1.0), whole);
        assert_eq!(around(&set, 0.0), rest);
        let expected = [[0.9, 1.5], [0.7, 0.7], [-0.7, -0.3]];
        for (found, [lower, upper]) in around(&set, 0.2).into_iter().zip(expected) {
            let off = (found.lower() - lower).abs().max((found.upper() - upper).abs());
            assert!(off < 1e-12, "{found:?}");
        }
        // Gains at rest beside all others are in it all the same.
        let beside = GainSet { rest: [Interval::point(9.0); 3], ..set };
        assert!(around(&beside, 1.0).iter().all(|gain| gain.contains(9.0)));
    }
}

//! Sets of flights hold what the simulator flies.

use core::ops::ControlFlow;

use fspid_sim::signal::{Disturbance, Entry, Profile, Shape};
use fspid_sim::{Scenario, Timing, fly};

use super::*;
use crate::gain_set::IncrementMap;
use crate::rest::drawn;
use crate::steps::flights::{Beginning, Patch, Way};
use crate::steps::joined::{Joined, narrowed};
use crate::steps::sample::{Judge, Moment};

pub(super) mod allowed;
mod every_structure;
pub(super) mod navion;

/// Samples of a flight, and what rounding of the simulator's own may be off, rad.
const SAMPLES: usize = 160;
const ROUNDING: f64 = 1e-9;

/// The pitch angle of a flight, sample by sample.
fn flown(scenario: &Scenario, [setpoint_rad, load_rad]: [f64; 2], at: usize) -> Vec<f64> {
    let dt_s = scenario.timing.dt_s();
    let at_s = at as f64 * dt_s;
    let mut scenario = scenario.clone();
    scenario.timing = Timing::new(dt_s, (SAMPLES + at) as f64 * dt_s).expect("allowed");
    scenario.setpoint = Profile::new(setpoint_rad, Shape::Step { at_s }).expect("allowed");
    let load = Disturbance::new(Entry::Elevator, load_rad, Shape::Step { at_s });
    scenario.disturbances = vec![load.expect("allowed")];
    pitch_angles(&scenario).split_off(at)
}

/// All gains of a controller.
fn all_gains(controller: &Controller) -> GainSet {
    match controller {
        Controller::Fixed(pid) => GainSet::fixed(pid.gains()),
        Controller::SelfTuning(fspid) => {
            IncrementMap::of(fspid.tuner(), 12).expect("bounded").gains(1.0)
        }
    }
}

/// How many samples of a set hold those of three flights in it, as long as it says something, and what it has come to.
fn held(
    loop_: &sample::Flown<'_>,
    scenario: &Scenario,
    patch: Patch,
    (from, at): (Beginning, usize),
) -> (usize, sample::Flight) {
    let flights: Vec<Vec<f64>> = [0.0, 0.4, 1.0]
        .map(|share: f64| {
            let between = |[a, b]: [f64; 2]| a + share * (b - a);
            flown(scenario, [between(patch.setpoint), between(patch.load)], at)
        })
        .to_vec();
    let commands = Commands::step();
    let way = Way { commands: &commands, patch, from };
    let mut set = flights::begun(loop_, from);
    for sample in 0..SAMPLES {
        flights::commanded(loop_, &mut set, &way, sample);
        let range = set.values[0].range();
        for flight in &flights {
            let theta = flight[sample];
            let inside = theta >= range.lower() - ROUNDING && theta <= range.upper() + ROUNDING;
            let name = &scenario.name;
            assert!(inside, "{name} {from:?}, sample {sample}: {theta:e} {range:?}");
        }
        let begins = sample == 0 && from == Beginning::Controller;
        let moment = if begins { Moment::First } else { Moment::Later };
        let Ok(passage) = loop_.pass(&set, moment, Judge::Measured) else { return (sample, set) };
        set = passage.flight;
        let remembered = set.tuned.iter().flat_map(tuned::Tuned::each);
        let parts = set.values.iter().chain(remembered).flat_map(|value| value.parts.each());
        let denormal = parts.filter(|part| part.is_subnormal()).count();
        assert_eq!(denormal, 0, "{}: sample {sample}", scenario.name);
        // Sets so wide say nothing any more.
        if set.symbols > 800 || range.width() > 1.0 {
            return (sample, set);
        }
    }
    (SAMPLES, set)
}

#[test]
fn a_set_of_flights_holds_every_flight_of_a_self_tuner_that_remembers() {
    let (compared, limited, moved) = held_while_gains_move(drawn::remembering_with_limits);
    assert!(compared > 3000 && limited > 15, "{compared} samples, {limited} sets at limits");
    assert!(moved > 0.1, "gains moved by {moved} of themselves at most");
}

#[test]
fn a_set_of_flights_holds_every_flight_of_a_network_that_remembers() {
    let (compared, limited, moved) = held_while_gains_move(drawn::remembering_network_with_limits);
    assert!(compared > 3000 && limited > 15, "{compared} samples, {limited} sets at limits");
    assert!(moved > 0.1, "gains moved by {moved} of themselves at most");
}

/// Drawn self-tuners that remember, each flown as a set and at three points of it: from the controller's first sample, and
/// from a rest as long as the claim asks for. Answers samples that were compared, sets that met a limit, and how far gains
/// moved at most, in parts of themselves.
fn held_while_gains_move(drawn: fn(&mut drawn::Dice) -> Scenario) -> (usize, usize, f64) {
    let (mut compared, mut limited, mut moved) = (0, 0, 0.0_f64);
    for seed in 0..60 {
        let mut scenario = drawn(&mut drawn::Dice::new(seed));
        scenario.name = format!("seed {seed}");
        scenario.surroundings.pitch_sensor = None;
        let plant = scenario.plant.linear().expect("linear");
        let controller = &scenario.controllers[0].controller;
        let Ok(description) = LoopDescription::of(&scenario, plant, controller) else { continue };
        let Controller::SelfTuning(fspid) = controller else { continue };
        if !remembers(&description) {
            continue;
        }
        if let Some(what) = not_covered(&description) {
            assert!(what.contains("literal") || what.contains("lag"), "{seed}: {what}");
            continue;
        }
        let Ok(model) = description.enclosed() else { continue };
        let set = IncrementMap::of(fspid.tuner(), 12).expect("bounded").gains(1.0);
        let loop_ = flown::flown(&description, &model, &set, None).expect("enclosed");
        let tuner = loop_.tuner.as_ref().expect("remembers");
        let rest = (tuner.rests_s() / scenario.timing.dt_s()).ceil() as usize;
        let most = 0.02 + 0.1 * (seed % 7) as f64;
        let patch = Patch { setpoint: [most, most * 1.001], load: [0.0, 0.0] };
        for (first, at) in [(Beginning::Controller, 0), (Beginning::Rest, rest)] {
            let begun = flights::begun(&loop_, first);
            let tuned = begun.tuned.as_ref().expect("remembers");
            // What is left of one gain's way says nothing of another's.
            let own = |gain: usize, symbol: usize| tuned.gains[gain].parts.of(symbol) > 0.0;
            let shared = |symbol: &usize| (0..3).filter(|gain| own(*gain, *symbol)).count() > 1;
            assert_eq!((0..begun.symbols).find(shared), None, "{seed} {first:?}");
            let (samples, ended) = held(&loop_, &scenario, patch, (first, at));
            compared += samples;
            limited += usize::from(ended.limited);
            let ended = tuner.ranges(ended.tuned.as_ref().expect("remembers"));
            for (one, other) in tuner.ranges(tuned).into_iter().zip(ended) {
                let apart = (one.midpoint() - other.midpoint()).abs();
                moved = moved.max(apart / one.magnitude().max(1e-9));
            }
        }
    }
    (compared, limited, moved)
}

/// Drawn loops with every limit there is, each flown as a set and at three points of it.
#[test]
fn a_set_of_flights_holds_every_flight_of_the_simulator() {
    let (mut compared, mut limited) = (0, 0);
    for seed in 0..100 {
        let dice = &mut drawn::Dice::new(seed);
        let mut scenario = match seed % 2 {
            0 => drawn::scenario(dice),
            _ => drawn::with_limits(dice),
        };
        scenario.name = format!("seed {seed}");
        // Bias and resolution are no part of a claim about steps.
        scenario.surroundings.pitch_sensor = None;
        let plant = scenario.plant.linear().expect("linear");
        let controller = &scenario.controllers[0].controller;
        let Ok(description) = LoopDescription::of(&scenario, plant, controller) else { continue };
        if not_covered(&description).is_some() || description.limits().is_empty() {
            continue;
        }
        let Ok(model) = description.enclosed() else { continue };
        let set = all_gains(controller);
        let rules = system(&description);
        let loop_ = flown::flown(&description, &model, &set, rules.as_ref()).expect("enclosed");
        let most = 0.02 + 0.1 * (seed % 7) as f64;
        let patch = Patch { setpoint: [most, most * 1.001], load: [-0.01, -0.0099] };
        for moment in [(Beginning::Controller, 0), (Beginning::Rest, 3)] {
            let (samples, ended) = held(&loop_, &scenario, patch, moment);
            compared += samples;
            limited += usize::from(ended.limited);
            // Where nothing is cut and gains stand still, set-point and load are all that is not known.
            let free = !ended.limited && matches!(controller, Controller::Fixed(_));
            assert!(!free || ended.symbols == sample::OWN, "{seed}: {} unknowns", ended.symbols);
        }
    }
    assert!(compared > 1000 && limited > 15, "{compared} samples, {limited} sets at limits");
}

/// When the load steps, and the set-point goes up, samples; and how long each half of its doublet is.
const LOADED: usize = 3;
const UP: usize = 40;
const HALF: usize = 30;

/// A load at servo or elevator, and then a doublet of the set-point.
fn with_commands(scenario: &mut Scenario, entry: Entry, [setpoint_rad, load_rad]: [f64; 2]) {
    let dt_s = scenario.timing.dt_s();
    let at = |sample: usize| sample as f64 * dt_s;
    scenario.timing = Timing::new(dt_s, at(SAMPLES)).expect("allowed");
    let doublet = Shape::Doublet { at_s: at(UP), width_s: at(HALF) };
    scenario.setpoint = Profile::new(setpoint_rad, doublet).expect("allowed");
    let load = Disturbance::new(entry, load_rad, Shape::Step { at_s: at(LOADED) });
    scenario.disturbances = vec![load.expect("allowed")];
}

fn pitch_angles(scenario: &Scenario) -> Vec<f64> {
    let prepared = scenario.prepare().expect("prepared");
    let mut theta = Vec::new();
    fly(&prepared, &scenario.controllers[0].controller, |instant| {
        theta.push(instant.theta_rad);
        ControlFlow::Continue(())
    })
    .expect("flies");
    theta
}

/// A sample of a set; nothing where it says nothing any more.
fn later(
    loop_: &sample::Flown<'_>,
    way: &Way<'_>,
    mut set: sample::Flight,
    sample: usize,
) -> Option<sample::Flight> {
    flights::commanded(loop_, &mut set, way, sample);
    let moment = if sample == 0 { Moment::First } else { Moment::Later };
    let set = loop_.pass(&set, moment, Judge::Measured).ok()?.flight;
    (set.symbols <= 3000 && set.values[0].range().width() < 1.0).then_some(set)
}

/// Parts of a set by shares of the largest set-point and load, with flights in them: one within it, one of a single flight, and
/// one that reaches beyond it.
const PARTS: [(Patch, [(f64, f64); 4]); 3] = [
    (
        Patch { setpoint: [0.9996, 0.9998], load: [0.25, 0.5] },
        [(0.9998, 0.5), (0.9996, 0.25), (0.9997, 0.4), (0.9996, 0.5)],
    ),
    (Patch { setpoint: [0.9997; 2], load: [0.4; 2] }, [(0.9997, 0.4); 4]),
    (
        Patch { setpoint: [0.9998, 1.0002], load: [0.5, 1.5] },
        [(0.9998, 0.5), (1.0, 1.0), (0.9998, 1.0), (1.0, 0.7)],
    ),
];

/// Flights of a set from where the set-point goes up, each of so much of set-point and load, and all of what is commanded.
struct Doublets<'a, 'f> {
    loop_: &'a sample::Flown<'f>,
    name: &'a str,
    commands: &'a Commands,
    patch: Patch,
    flights: [Vec<f64>; 4],
}

impl Doublets<'_, '_> {
    /// A set that holds them, from a sample on: how many samples, and what it has come to.
    fn are_held(&self, mut set: sample::Flight, from: usize) -> (usize, sample::Flight) {
        let Self { loop_, name, commands, patch, flights } = self;
        let way = Way { commands, patch: *patch, from: Beginning::Controller };
        for sample in from..SAMPLES {
            let range = set.values[0].range();
            for theta in flights.each_ref().map(|flight| flight[sample]) {
                let inside = theta >= range.lower() - ROUNDING && theta <= range.upper() + ROUNDING;
                assert!(inside, "{name}, {patch:?}, sample {sample}: {theta:e} {range:?}");
            }
            let Some(next) = later(loop_, &way, set.clone(), sample) else {
                return (sample + 1 - from, set);
            };
            set = next;
        }
        (SAMPLES - from, set)
    }
}

/// Two sets under loads of either sign, joined where the set-point goes up, and held against four flights from there on, and
/// parts of one of them, taken there and in the middle of the doublet, against four of their own: how many samples each, and
/// what the joined set has come to. Nothing where the two say nothing any more.
fn joined_and_held(
    loop_: &sample::Flown<'_>,
    scenario: &Scenario,
    entry: Entry,
    [most, load_rad]: [f64; 2],
) -> Option<([usize; 2], sample::Flight)> {
    let commanding = |sizes: [f64; 2]| {
        let mut scenario = scenario.clone();
        with_commands(&mut scenario, entry, sizes);
        scenario
    };
    let commands = Commands::of(&commanding([most, load_rad])).expect("flown").expect("something");
    let (setpoint, from) = ([0.9995 * most, most], Beginning::Controller);
    let part = |load: [f64; 2]| {
        let way = Way { commands: &commands, patch: Patch { setpoint, load }, from };
        let begun = flights::begun(loop_, from);
        let flown = (0..UP).try_fold(begun, |set, sample| later(loop_, &way, set, sample))?;
        Some((way.patch, flown))
    };
    let [one, other] = [part([-load_rad, 0.0])?, part([0.0, load_rad])?];
    let patch = Patch { setpoint, load: [-load_rad, load_rad] };
    let joined = Joined::of(loop_, &[&one, &other]).expect("two");
    let of = |points: [(f64, f64); 4]| {
        points.map(|(step, load)| pitch_angles(&commanding([step * most, load * load_rad])))
    };
    let doublets = |patch: Patch, points: [(f64, f64); 4]| Doublets {
        loop_,
        name: &scenario.name,
        commands: &commands,
        patch,
        flights: of(points),
    };
    let all = [(1.0, 1.0), (0.9997, -1.0), (0.9995, 0.3), (1.0, -0.01)];
    let begun = joined.flight(&one.1, &commands, patch, UP);
    let (samples, joint) = doublets(patch, all).are_held(begun, UP);
    let mut alone = 0;
    for from in [UP, UP + HALF / 2] {
        let way = Way { commands: &commands, patch: other.0, from: Beginning::Controller };
        let begun = other.1.clone();
        let flown = (UP..from).try_fold(begun, |set, sample| later(loop_, &way, set, sample));
        let Some(flown) = flown else { continue };
        let whole = (other.0, flown);
        for (Patch { setpoint, load }, points) in PARTS {
            let part = Patch {
                setpoint: setpoint.map(|it| it * most),
                load: load.map(|it| it * load_rad),
            };
            alone += doublets(part, points).are_held(narrowed(&whole, part), from).0;
        }
        let middle = narrowed(&whole, Patch { load: [0.4 * load_rad, 0.5 * load_rad], ..whole.0 });
        for (value, whole) in middle.values.iter().zip(&whole.1.values) {
            let [width, most] = [value, whole].map(|value| value.range().width());
            assert!(width <= most * (1.0 + 1e-9) + 1e-12, "{}: {width} of {most}", scenario.name);
        }
    }
    Some(([samples, alone], joint))
}

/// Drawn loops with every limit there is, under a load of either sign that enters before or behind the servo, two sets joined
/// to one, and then with a doublet of the set-point: at every sample the joined set holds the flights of the simulator, and
/// parts of one of the two, flown on alone, hold those of their own.
#[test]
fn joined_sets_hold_every_flight_of_what_is_commanded() {
    let (mut compared, mut alone, mut limited, mut tuned) = (0, 0, 0, 0);
    for seed in 0..90 {
        let dice = &mut drawn::Dice::new(seed);
        let mut scenario = match (seed % 3, seed % 2) {
            (0, _) => drawn::scenario(dice),
            (1, _) => drawn::with_limits(dice),
            (_, 0) => drawn::remembering_with_limits(dice),
            _ => drawn::remembering_network_with_limits(dice),
        };
        scenario.name = format!("seed {seed}");
        scenario.surroundings.pitch_sensor = None;
        let plant = scenario.plant.linear().expect("linear").clone();
        let controller = scenario.controllers[0].controller;
        let Ok(description) = LoopDescription::of(&scenario, &plant, &controller) else { continue };
        if not_covered(&description).is_some() || description.limits().is_empty() {
            continue;
        }
        let Ok(model) = description.enclosed() else { continue };
        let entry = if seed % 2 == 0 { Entry::Servo } else { Entry::Elevator };
        let load_rad = 0.003 + 0.001 * (seed % 5) as f64;
        if entry == Entry::Elevator && sees_loads_at_once(&model, load_rad) {
            continue;
        }
        let set = all_gains(&controller);
        let rules = system(&description);
        let loop_ = flown::flown(&description, &model, &set, rules.as_ref()).expect("enclosed");
        let most = 0.02 + 0.05 * (seed % 7) as f64;
        let Some(([samples, of_part], joint)) =
            joined_and_held(&loop_, &scenario, entry, [most, load_rad])
        else {
            continue;
        };
        compared += samples;
        alone += of_part;
        limited += usize::from(joint.limited);
        tuned += usize::from(joint.tuned.is_some());
    }
    assert!(compared > 1500 && limited > 10 && tuned > 8, "{compared} {limited} {tuned}");
    assert!(alone > 30_000, "{alone}");
}

//! Samples that go to the places where something may be wrong.

use fspid_core::equations::LawKind;
use fspid_core::{Controller, Fspid, Limits, SecondInput};
use fspid_numeric::Real;

use super::drawn::{BAD, Draw};
use super::{Event, Flight, Remembered, Vector};
use crate::precision_of;

/// Errors from a tenth of a degree to more than a quarter turn, rad.
const SIZES_RAD: [f64; 6] = [0.002, 0.01, 0.05, 0.2, 0.6, 1.7];
/// Samples after which a wind-up has come as far as it will be looked at.
const LONG: usize = 300;
const REST: [f64; 3] = [0.0; 3];

pub(super) fn fly<R: Real>(flight: &mut Flight<'_, R>) {
    flight.reset(REST);
    if let Controller::SelfTuning(fspid) = flight.controller {
        rules(flight, fspid);
        zone(flight, fspid);
    }
    errors(flight);
    bad(flight);
    taking_over(flight);
    memories(flight);
    edges(flight);
    winding_up(flight);
    if let Controller::SelfTuning(fspid) = flight.controller
        && fspid.tuner_equations().structure.law == LawKind::Accumulating
    {
        gains(flight, fspid);
        gain_limits(flight, fspid);
        low_gains(flight, fspid);
    }
    if let Controller::SelfTuning(fspid) = flight.controller {
        anywhere(flight, fspid);
    }
}

/// What the supervisor of a self-tuner is to see: the error and what stands beside it, in its units.
fn seek<R: Real>(flight: &mut Flight<'_, R>, fspid: &Fspid<R>, seen: [f64; 2]) {
    seek_with(flight, fspid, seen, Event::Step);
}

/// The same, with what is done at the sample at which it sees that.
fn seek_with<R: Real>(
    flight: &mut Flight<'_, R>,
    fspid: &Fspid<R>,
    [error, second]: [f64; 2],
    event: Event<R>,
) {
    let numbers = fspid.tuner_equations().numbers.map(|number| number.to_f64());
    let error_rad = error / (numbers.sign * numbers.error_per_rad);
    let second_rad = second / (numbers.sign * numbers.change_per_rad);
    match fspid.tuner().settings().second_input {
        SecondInput::Change => {
            flight.reset([error_rad - second_rad * numbers.change_divisor, 0.0, 0.0]);
            flight.event(event, [error_rad, 0.0, 0.0]);
        }
        SecondInput::Rate => {
            flight.reset(REST);
            flight.event(event, [error_rad, 0.0, -second_rad]);
        }
        SecondInput::ModelError(_) => {
            flight.reset(REST);
            let model_rad = flight.state.memory().map_or(0.0, |memory| memory.model_rad.to_f64());
            let pitch_rad = model_rad - second_rad;
            flight.event(event, [pitch_rad + error_rad, pitch_rad, 0.0]);
        }
    }
}

/// Places of an input: set centres from NB to PB, then those half way between them, then outside.
fn places<R: Real>(fspid: &Fspid<R>, of_error: bool) -> Vec<f64> {
    let range = fspid.tuner().supervisor().range().to_f64();
    let sets = fspid.tuner().settings().input_sets;
    let centres = if of_error { sets.error } else { sets.change };
    let (small, medium) = centres.map_or((1.0 / 3.0, 2.0 / 3.0), |centres| {
        (centres.small().to_f64(), centres.medium().to_f64())
    });
    let centres: Vec<f64> =
        [-1.0, -medium, -small, 0.0, small, medium, 1.0].map(|part| part * range).into();
    let between = centres.windows(2).map(|pair| 0.55 * pair[0] + 0.45 * pair[1]);
    let outside = [-1.3 * range, 1.2 * range];
    centres.iter().copied().chain(between).chain(outside).collect()
}

/// Every rule where it is the strongest, and where its neighbours are.
fn rules<R: Real>(flight: &mut Flight<'_, R>, fspid: &Fspid<R>) {
    let (errors, seconds) = (places(fspid, true), places(fspid, false));
    for error in &errors {
        for second in &seconds {
            seek(flight, fspid, [*error, *second]);
        }
    }
    // Close to the centres, on both sides.
    let range = fspid.tuner().supervisor().range().to_f64();
    for (error, second) in errors.iter().zip(&seconds).take(7) {
        for near in [0.0004 * range, 0.000_05 * range] {
            for side in [[near, near], [-near, -near], [near, -near], [-near, near]] {
                seek(flight, fspid, [error + side[0], second + side[1]]);
            }
        }
    }
}

/// Close to half way between two centres, where two rules are about as strong, at every centre of the other input.
fn halves<R: Real>(flight: &mut Flight<'_, R>, fspid: &Fspid<R>, event: Event<R>) {
    let (errors, seconds) = (places(fspid, true), places(fspid, false));
    for part in [0.4999, 0.5, 0.5001] {
        let half = |pair: &[f64]| part * pair[0] + (1.0 - part) * pair[1];
        for error in errors[..7].windows(2).map(half) {
            seconds[..7]
                .iter()
                .for_each(|second| seek_with(flight, fspid, [error, *second], event));
        }
        for second in seconds[..7].windows(2).map(half) {
            errors[..7].iter().for_each(|error| seek_with(flight, fspid, [*error, second], event));
        }
    }
}

/// So many views around the place where a Gaussian grade passes from one power of two to the next.
const AROUND_POWERS: usize = 16;

/// Where the exponent of a grade is half of the logarithm of 2, and the sum behind it has the most to do.
fn powers<R: Real>(flight: &mut Flight<'_, R>, fspid: &Fspid<R>, event: Event<R>) {
    let supervisor = fspid.tuner().supervisor();
    if !supervisor.has_labels() {
        return;
    }
    let [.., [spacing, sigma], _, _] = supervisor.sets().map(|set| set.map(Real::to_f64));
    let distance = core::f64::consts::LN_2.sqrt() * sigma / spacing;
    let (errors, seconds) = (places(fspid, true), places(fspid, false));
    for (pair, near) in errors[..7].windows(2).zip(seconds.windows(2)) {
        for part in 0..AROUND_POWERS {
            let beside = (1.0 + 0.0005 * (part as f64 / 8.0 - 1.0)) * distance;
            for (from, to, second) in [(pair[0], pair[1], near[0]), (pair[1], pair[0], near[1])] {
                seek_with(flight, fspid, [from + beside * (to - from), second], event);
            }
        }
    }
}

/// What gives the derivative's gain the most digits before a sample.
fn finest<R: Real>(flight: &Flight<'_, R>, fspid: &Fspid<R>) -> Event<R> {
    let equations = fspid.tuner_equations();
    if equations.structure.law != LawKind::Accumulating || !flight.has_events {
        return Event::Step;
    }
    Event::Memory(Remembered::Gain(2), R::from_f64(low_gain(flight, fspid, 2, 1.1)))
}

/// A gain so small, above its limit by some of what a rule adds at most.
fn low_gain<R: Real>(flight: &Flight<'_, R>, fspid: &Fspid<R>, gain: usize, part: f64) -> f64 {
    let numbers = fspid.tuner_equations().gains[gain].map(|it| it.to_f64());
    let lower = Some(numbers.lower).filter(|it| it.is_finite()).unwrap_or(0.0);
    lower + part * numbers.scale.abs() * flight.controller.config().dt_s.to_f64()
}

/// So many views that nobody has chosen.
const VIEWS: usize = 400;

/// Views between and a little outside of all places.
fn anywhere<R: Real>(flight: &mut Flight<'_, R>, fspid: &Fspid<R>) {
    let event = finest(flight, fspid);
    halves(flight, fspid, event);
    powers(flight, fspid, event);
    let (mut draw, range) = (Draw(49), fspid.tuner().supervisor().range().to_f64());
    for _ in 0..VIEWS {
        seek_with(flight, fspid, [draw.around(1.05 * range), draw.around(1.05 * range)], event);
    }
}

/// Every rule from gains so small that what it adds in one sample has the most digits.
fn low_gains<R: Real>(flight: &mut Flight<'_, R>, fspid: &Fspid<R>) {
    let (errors, seconds) = (places(fspid, true), places(fspid, false));
    for gain in 0..3 {
        for part in [1.1, 1.73] {
            let value = low_gain(flight, fspid, gain, part);
            let event = Event::Memory(Remembered::Gain(gain), R::from_f64(value));
            for error in &errors[..7] {
                seconds[..7].iter().for_each(|it| seek_with(flight, fspid, [*error, *it], event));
            }
        }
    }
}

/// Gains that no step has left, beyond both of their limits and at the edge of overflow.
fn gains<R: Real>(flight: &mut Flight<'_, R>, fspid: &Fspid<R>) {
    let good = [0.05, 0.02, 0.01];
    for (gain, numbers) in fspid.tuner_equations().gains.iter().enumerate() {
        let [lower, upper] = [numbers.lower, numbers.upper].map(Real::to_f64);
        let beyond = [lower - 1.0, upper + 1.0, lower + 1e-4, upper - 1e-4];
        let largest = largest::<R>();
        for value in beyond.into_iter().chain([-largest, largest]).filter(|it| it.is_finite()) {
            flight.reset(good);
            flight.event(Event::Memory(Remembered::Gain(gain), R::from_f64(value)), good);
            flight.step(good);
        }
    }
}

/// Both sides of the ends of the dead zone.
fn zone<R: Real>(flight: &mut Flight<'_, R>, fspid: &Fspid<R>) {
    let Some(zone) = fspid.tuner().settings().dead_zone else { return };
    let numbers = fspid.tuner_equations().numbers.map(|number| number.to_f64());
    let (error, change) = (zone.error_rad.to_f64(), zone.change_rad.to_f64());
    let (error, change) = (error * numbers.error_per_rad, change * numbers.change_per_rad);
    for part in [0.0, 0.5, 0.998, 1.0, 1.0005, 1.002, 1.5] {
        for sign in [-1.0, 1.0] {
            for [error, change] in
                [[part * error, 0.0], [0.0, part * change], [part * error, 0.9 * change]]
            {
                seek(flight, fspid, [sign * error, sign * change]);
            }
        }
    }
}

/// Long at the rules that move a gain furthest up, and furthest down, from where all inputs are.
fn gain_limits<R: Real>(flight: &mut Flight<'_, R>, fspid: &Fspid<R>) {
    let (errors, seconds) = (places(fspid, true), places(fspid, false));
    let cells = || errors[..7].iter().flat_map(|error| seconds[..7].iter().map(|it| [*error, *it]));
    for gain in 0..3 {
        for sign in [-1.0, 1.0] {
            let moves = |at: &[f64; 2]| {
                let [error, second] = at.map(R::from_f64);
                let added = fspid.tuner().increments_where_seen(error, second);
                sign * added.map_or(0.0, |it| [it.kp, it.ki, it.kd][gain].to_f64())
            };
            let furthest = cells().max_by(|a, b| moves(a).total_cmp(&moves(b)));
            let Some(furthest) = furthest else { continue };
            seek(flight, fspid, furthest);
            let start = flight.vectors.len();
            let mut ways = [[0.0; 3]; 2];
            if let [.., before, last] = flight.vectors.as_slice() {
                let radians = flight.angles.radians().unwrap_or(1.0);
                let radians = |it: &Vector<R>| [0, 1, 2].map(|k| it.sample[k].to_f64() * radians);
                ways = [before, last].map(radians);
            }
            while flight.vectors.len() < start + LONG && !flight.is_full() {
                stay(flight, fspid, furthest, ways);
            }
        }
    }
}

/// One more sample at which the supervisor sees about the same.
fn stay<R: Real>(
    flight: &mut Flight<'_, R>,
    fspid: &Fspid<R>,
    [error, second]: [f64; 2],
    ways: [[f64; 3]; 2],
) {
    let numbers = fspid.tuner_equations().numbers.map(|number| number.to_f64());
    let error_rad = error / (numbers.sign * numbers.error_per_rad);
    let second_rad = second / (numbers.sign * numbers.change_per_rad);
    match fspid.tuner().settings().second_input {
        // There and back: every second sample sees it.
        SecondInput::Change => ways.into_iter().for_each(|sample| flight.step(sample)),
        SecondInput::Rate => flight.step([error_rad, 0.0, -second_rad]),
        SecondInput::ModelError(_) => {
            let model_rad = flight.state.memory().map_or(0.0, |memory| memory.model_rad.to_f64());
            let pitch_rad = model_rad - second_rad;
            flight.step([pitch_rad + error_rad, pitch_rad, 0.0]);
        }
    }
}

/// Errors of every size that stand, with a rate, and go away again.
fn errors<R: Real>(flight: &mut Flight<'_, R>) {
    for size in SIZES_RAD {
        for sign in [-1.0, 1.0] {
            flight.reset([0.1 * size, 0.0, 0.0]);
            for k in 0..12 {
                let rate = 0.02 * f64::from(k % 5) * sign;
                flight.step([sign * size, 0.3 * size, rate]);
            }
            for _ in 0..4 {
                flight.step([0.0, 0.001 * sign, 0.0]);
            }
        }
    }
    for size in SIZES_RAD {
        flight.reset(REST);
        for sign in [-1.0, 1.0] {
            (0..4).for_each(|_| flight.step([sign * size, 0.0, 0.0]));
        }
    }
}

/// What is no pitch, at each place; and the ends of the guard.
fn bad<R: Real>(flight: &mut Flight<'_, R>) {
    let guard = flight.controller.config().guard.limit_rad().to_f64();
    let ends = [1.0, -1.0].map(|sign| [0.9999, 1.0, 1.0001].map(|part| sign * part * guard));
    let good = [0.05, 0.02, 0.01];
    let largest = largest::<R>();
    let ends = ends.into_iter().flatten().chain([largest, -largest]);
    for value in BAD.into_iter().chain(ends) {
        for place in 0..3 {
            let mut sample = good;
            sample[place] = value;
            flight.reset(good);
            flight.step(sample);
            flight.step(good);
            flight.event(Event::Faults, good);
        }
    }
    flight.reset([f64::NAN, 0.0, 0.0]);
    flight.step(good);
    overflow_at_first(flight);
}

/// The first sample that is believed overflows: it is answered with the nominal gains, as there are no others.
fn overflow_at_first<R: Real>(flight: &mut Flight<'_, R>) {
    if !flight.has_events {
        return;
    }
    let [_, most] = fspid_core::largest_remembered::<R>().map(R::to_f64);
    let good = [0.05, 0.02, 0.01];
    for sign in [-1.0, 1.0] {
        flight.reset([f64::NAN, 0.0, 0.0]);
        let beyond = R::from_f64(2.0 * sign * most);
        flight.event(Event::Memory(Remembered::Integral, beyond), good);
        flight.event(Event::Reset, good);
    }
}

/// Another commands: within and beyond every limit, and hands over.
fn taking_over<R: Real>(flight: &mut Flight<'_, R>) {
    let guard = flight.controller.config().guard.limit_rad().to_f64();
    let good = [0.08, 0.03, 0.02];
    for command in [0.0, 0.05, -0.05, 0.4, -0.4, 3.0, -3.0, guard * 1.001, -guard * 1.001] {
        flight.reset(good);
        (0..3).for_each(|_| flight.step(good));
        flight.track(command, good);
        flight.track(command, [-0.02, 0.03, -0.01]);
        (0..3).for_each(|_| flight.step(good));
        flight.event(Event::Hold, good);
    }
    for command in BAD.into_iter().chain([largest::<R>(), -largest::<R>(), guard, -guard]) {
        flight.reset(good);
        flight.track(command, good);
        flight.event(Event::Faults, good);
        flight.step(good);
    }
    let largest = largest::<R>();
    let ends = [f64::INFINITY, largest, guard * 1.001, guard];
    let ends = ends.into_iter().flat_map(|end| [end, -end]).chain([f64::NAN]);
    for (place, bad) in ends.flat_map(|bad| (0..3).map(move |it| (it, bad))) {
        let mut sample = good;
        sample[place] = bad;
        flight.reset(good);
        flight.track(0.1, sample);
        // A fault that is latched is no reason not to go on.
        flight.track(0.07, good);
        flight.event(Event::Faults, good);
    }
    flight.reset(good);
    flight.event(Event::Hold, good);
}

/// The largest finite number.
fn largest<R: Real>() -> f64 {
    precision_of::<R>().largest()
}

/// Memories that no step has written: at the edge of overflow, beyond it, and outside of the limits.
fn memories<R: Real>(flight: &mut Flight<'_, R>) {
    let [_, most] = fspid_core::largest_remembered::<R>().map(R::to_f64);
    let largest = 0.25 * largest::<R>();
    let good = [0.05, 0.02, 0.01];
    for size in [1.0, 0.9995 * most, most, 1.0005 * most, 3.6 * largest, 3.999 * largest] {
        for value in [-size, size] {
            for which in [Remembered::Integral, Remembered::Command] {
                flight.reset(good);
                flight.event(Event::Memory(which, R::from_f64(value)), good);
                flight.track(0.1, good);
                flight.event(Event::Memory(which, R::from_f64(value)), [f64::NAN; 3]);
                flight.step(good);
            }
        }
    }
}

/// So many numbers of the memory, each half as far from where a sample is held as the one before.
const HALVINGS: usize = 28;

/// From 0 to an end at which samples are held, ever closer to where that begins, on both sides of it.
fn edge<R: Real>(flight: &mut Flight<'_, R>, end: f64, probe: impl Fn(&mut Flight<'_, R>, f64)) {
    let (mut good, mut held) = (0.0, end);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (good + held);
        probe(flight, middle);
        let is_held = flight.vectors.last().is_some_and(|it| it.marks[1] != 0);
        *if is_held { &mut held } else { &mut good } = middle;
    }
}

/// The largest numbers that are remembered: the integral beside a derivative that takes it out of the command again,
/// and the reference model.
fn edges<R: Real>(flight: &mut Flight<'_, R>) {
    let [rate, integral] = fspid_core::largest_remembered::<R>().map(R::to_f64);
    let good = [0.05, 0.02, 0.01];
    let write = |flight: &mut Flight<'_, R>, which, value| {
        flight.event(Event::Memory(which, R::from_f64(value)), good);
    };
    let kd = flight.controller.nominal().kd.to_f64().abs().max(1e-6);
    let end = (4.0 * integral / kd).min(0.2 * largest::<R>());
    for sign in [-1.0, 1.0] {
        edge(flight, end, |flight, value| {
            flight.reset(good);
            write(flight, Remembered::Derivative, -sign * value);
            write(flight, Remembered::Integral, sign * integral);
        });
        if !has_model(flight) {
            continue;
        }
        let members = [Remembered::Model, Remembered::ModelRate];
        // From two memories, since not every one comes to the very end.
        for (which, other) in members.into_iter().zip(members.into_iter().rev()) {
            for part in [0.0, 0.3] {
                edge(flight, 2.0 * rate, |flight, value| {
                    flight.reset(good);
                    write(flight, other, part * rate);
                    write(flight, which, sign * value);
                });
            }
        }
        // It comes to the edge while another commands, where nothing was latched before.
        flight.reset(good);
        write(flight, Remembered::ModelRate, 0.99 * sign * rate);
        write(flight, Remembered::Model, 0.97 * sign * rate);
        (0..8).for_each(|_| flight.track(0.1, good));
    }
}

fn has_model<R: Real>(flight: &Flight<'_, R>) -> bool {
    matches!(flight.controller, Controller::SelfTuning(fspid)
        if matches!(fspid.tuner().settings().second_input, SecondInput::ModelError(_)))
}

/// Long against the limits, and out of it.
fn winding_up<R: Real>(flight: &mut Flight<'_, R>) {
    let ends = |limits: &Limits<R>| [limits.lower().to_f64(), limits.upper().to_f64()];
    let [lower, upper] = flight.controller.config().limits.as_ref().map_or([-0.5, 0.5], ends);
    let kp = flight.controller.nominal().kp.to_f64().abs().max(0.05);
    for end in [lower, upper] {
        // First so that the command is near the end and the integral does the rest.
        for factor in [0.9, 1.5] {
            flight.reset(REST);
            let error = (factor * end / kp).clamp(-1.5, 1.5);
            (0..LONG).for_each(|_| flight.step([error, 0.0, 0.0]));
            (0..LONG / 3).for_each(|_| flight.step([-0.2 * error, 0.0, 0.0]));
        }
    }
}

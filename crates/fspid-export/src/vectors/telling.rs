//! Few samples that tell of many numbers, for who has no room for all of them.

use std::collections::BTreeSet;

use fspid_core::Controller;
use fspid_numeric::Real;

use super::{Event, Flight, flown};
use crate::Angles;
use crate::interpret::{Cell, Machine};
use crate::program::{Part, Program};

/// Samples from a reset on.
pub type Stretch<R> = Vec<Vec<R>>;

/// So many samples are looked through.
const SEARCHED: usize = 20_000;
/// How much of a stretch is looked at, in turn: what a short one tells needs no long one.
const LENGTHS: [usize; 3] = [3, 20, 150];
/// A number is turned by so much; a smaller error is found by whoever asks all samples.
const TURN: f64 = 1.5;

/// Samples, `most` at most, from resets on, that tell of each number of the configuration that the vectors of a controller
/// tell of by steps and resets alone. What room is left is filled with the first that come.
#[must_use]
pub fn telling<R: Real>(
    controller: &Controller<R>,
    program: &Program,
    (angles, seed): (Angles, u64),
    most: usize,
) -> Vec<Stretch<R>> {
    let all = stretches(controller, angles, seed);
    let mut machine = Machine::new(program);
    let mut turned = turned(program);
    let (mut chosen, mut room) = (Vec::new(), most);
    for length in LENGTHS {
        // Many begin alike: what is written over behind a step is no business of this.
        let mut asked = BTreeSet::new();
        for stretch in &all {
            if turned.is_empty() || room == 0 {
                break;
            }
            let seen = stretch.get(..length.min(room)).unwrap_or(stretch);
            if !asked.insert(bits(seen)) {
                continue;
            }
            let answers = answers(&mut machine, program, seen, &[]).1;
            let mut used = 0;
            turned.retain_mut(|other| {
                let (first, _) = self::answers(other, program, seen, &answers);
                used = used.max(first.map_or(0, |first| first + 1));
                first.is_none()
            });
            chosen.extend(seen.get(..used).filter(|it| !it.is_empty()).map(<[_]>::to_vec));
            room -= used;
        }
    }
    let mut asked = BTreeSet::new();
    for stretch in all.iter().filter(|stretch| asked.insert(bits(stretch))) {
        let more = stretch.get(..room).unwrap_or(stretch);
        room -= more.len();
        chosen.extend(Some(more).filter(|it| !it.is_empty()).map(<[_]>::to_vec));
    }
    chosen
}

/// What a controller's vectors have between a reset and what is neither that nor a step, but for numbers that are none.
fn stretches<R: Real>(controller: &Controller<R>, angles: Angles, seed: u64) -> Vec<Stretch<R>> {
    let vectors = flown(Flight::new(controller, angles, true, SEARCHED), seed);
    let (mut stretches, mut goes_on) = (Vec::<Stretch<R>>::new(), false);
    for vector in vectors {
        match vector.event {
            Event::Reset => {
                stretches.push(Vec::new());
                goes_on = true;
            }
            Event::Step => {}
            _ => goes_on = false,
        }
        let is_finite = vector.sample.iter().all(|value| value.is_finite());
        if let Some(last) = stretches.last_mut().filter(|_| goes_on && is_finite) {
            last.push(vector.sample);
        }
    }
    stretches.retain(|stretch| !stretch.is_empty());
    stretches
}

fn bits<R: Real>(stretch: &[Vec<R>]) -> Vec<u64> {
    stretch.iter().flatten().map(|value| value.to_f64().to_bits()).collect()
}

/// The program with one number of its configuration turned, for each of them.
fn turned<'a, R: Real>(program: &'a Program) -> Vec<Machine<'a, R>> {
    let mut all = Vec::new();
    for member in program.members(Part::Configuration) {
        let mut add = |cell| {
            let mut machine = Machine::new(program);
            machine.set(Part::Configuration, &member.name, cell);
            all.push(machine);
        };
        match Machine::new(program).member(Part::Configuration, &member.name) {
            Some(Cell::Real(value)) => add(Cell::Real(other(*value))),
            Some(Cell::Reals(values)) => {
                each(values, |it| other(*it)).for_each(|it| add(Cell::Reals(it)))
            }
            Some(Cell::Bytes(labels)) => {
                each(labels, |it| (it + 1) % 7).for_each(|it| add(Cell::Bytes(it)));
            }
            _ => {}
        }
    }
    all
}

fn other<R: Real>(value: R) -> R {
    if value == R::ZERO { R::from_f64(0.5) } else { value * R::from_f64(TURN) }
}

/// The list with one of its values changed, for each of them.
fn each<T: Clone>(values: &[T], change: impl Fn(&T) -> T) -> impl Iterator<Item = Vec<T>> {
    (0..values.len()).map(move |index| {
        let mut values = values.to_vec();
        values[index] = change(&values[index]);
        values
    })
}

/// The answers to a stretch, up to the first that is another than expected, and where that is.
fn answers<R: Real>(
    machine: &mut Machine<'_, R>,
    program: &Program,
    stretch: &[Vec<R>],
    expected: &[Vec<Cell<R>>],
) -> (Option<usize>, Vec<Vec<Cell<R>>>) {
    machine.run("reset");
    let mut answers = Vec::new();
    for (sample, index) in stretch.iter().zip(0..) {
        for (member, value) in program.members(Part::Sample).iter().zip(sample) {
            machine.set(Part::Sample, &member.name, Cell::Real(*value));
        }
        machine.run(program.entry());
        let members = program.members(Part::Answer).iter();
        let answer: Vec<Cell<R>> =
            members.filter_map(|it| machine.member(Part::Answer, &it.name).cloned()).collect();
        if expected.get(index).is_some_and(|expected| *expected != answer) {
            return (Some(index), answers);
        }
        answers.push(answer);
    }
    (None, answers)
}

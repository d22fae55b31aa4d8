//! Drawn inputs, good and bad ones, and what a fuzzy system answers to them.

use fspid_fuzzy::OutOfRange;
use fspid_fuzzy::system::{Answer, Input, Membership, Source, System};
use fspid_numeric::Real;

use super::{Names, SystemProgram};
use crate::interpret::{Cell, Machine};
use crate::program::Part;
use crate::vectors::{Draw, Event, Vector};

/// The bit of an input that is not finite.
pub const NOT_FINITE: u8 = 1;
/// The bit of an input outside of a range that may not be left.
pub const OUT_OF_RANGE: u8 = 2;

/// The code of where a value comes from.
#[must_use]
pub const fn source_code(source: Source) -> u8 {
    match source {
        Source::Nothing => 0,
        Source::Rules => 1,
        Source::Middle => 2,
        Source::Default => 3,
        Source::Previous => 4,
    }
}

/// What a system answers to `count` inputs that are drawn from a seed, as `fspid-fuzzy` says it.
///
/// Inputs lie within their ranges and beyond, on the ends, on the numbers that sets are made of, and are now and then no
/// finite numbers.
#[must_use]
pub fn system_vectors(system: &System, seed: u64, count: usize) -> Vec<Vector<f64>> {
    let mut workspace = system.workspace();
    let mut previous = Vec::new();
    let answered = |inputs: Vec<f64>| {
        let outputs = system.parts().outputs.len();
        let faults = faults(system, &inputs);
        let nothing = Answer { value: None, error_bound: 0.0, source: Source::Nothing };
        let answers = match system.evaluate_after(&inputs, &previous, &mut workspace) {
            Ok(answers) => {
                previous = answers.iter().map(|it| it.value).collect();
                answers.to_vec()
            }
            Err(_) => vec![nothing; outputs],
        };
        let mut marks: Vec<u8> = answers.iter().map(|it| source_code(it.source)).collect();
        marks.push(faults);
        let answer = answers.iter().map(|it| it.value.unwrap_or(0.0)).collect();
        Vector { event: Event::Step, sample: inputs, answer, marks }
    };
    inputs(system, seed, count).into_iter().map(answered).collect()
}

/// The same inputs rounded to 32 bits, and what the program with numbers of 32 bits answers.
pub(super) fn single_vectors(
    system: &System,
    program: &SystemProgram,
    seed: u64,
    count: usize,
) -> Vec<Vector<f32>> {
    let mut machine = Machine::<f32>::new(&program.program);
    let Names { inputs: names, outputs, sources, faults } = &program.names;
    let answered = |inputs: Vec<f64>| {
        let sample: Vec<f32> = inputs.into_iter().map(f32::from_f64).collect();
        for (name, value) in names.iter().zip(&sample) {
            machine.set(Part::Sample, name, Cell::Real(*value));
        }
        machine.run("infer");
        let real = |name: &String| match machine.member(Part::Answer, name) {
            Some(Cell::Real(value)) => *value,
            _ => f32::NAN,
        };
        let byte = |name: &String| match machine.member(Part::Answer, name) {
            Some(Cell::Byte(value)) => *value,
            _ => u8::MAX,
        };
        let answer = outputs.iter().map(real).collect();
        let marks = sources.iter().chain([faults]).map(byte).collect();
        Vector { event: Event::Step, sample, answer, marks }
    };
    inputs(system, seed, count).into_iter().map(answered).collect()
}

/// How far answers of 32 bits are from those of 64 to the same inputs: the largest difference of each output, and how many
/// answers come from somewhere else.
pub(super) fn difference(system: &System, single: &[Vector<f32>]) -> (Vec<f64>, usize) {
    let mut workspace = system.workspace();
    let mut largest = vec![0.0_f64; system.parts().outputs.len()];
    let (mut elsewhere, mut previous) = (0, Vec::new());
    for vector in single {
        let inputs: Vec<f64> = vector.sample.iter().map(|value| f64::from(*value)).collect();
        let answers = system.evaluate_after(&inputs, &previous, &mut workspace);
        let Ok(answers) = answers else { continue };
        previous = answers.iter().map(|it| it.value).collect();
        for (index, answer) in answers.iter().enumerate() {
            if vector.marks[index] != source_code(answer.source) {
                elsewhere += 1;
            } else if let Some(value) = answer.value {
                largest[index] =
                    largest[index].max((f64::from(vector.answer[index]) - value).abs());
            }
        }
    }
    (largest, elsewhere)
}

fn faults(system: &System, inputs: &[f64]) -> u8 {
    let of = |(input, &value): (&Input, &f64)| match input.universe {
        _ if !value.is_finite() => NOT_FINITE,
        Some(universe) if input.out_of_range == OutOfRange::Error && !universe.contains(value) => {
            OUT_OF_RANGE
        }
        _ => 0,
    };
    system.parts().inputs.iter().zip(inputs).map(of).fold(0, |all, one| all | one)
}

/// Inputs of every kind.
fn inputs(system: &System, seed: u64, count: usize) -> Vec<Vec<f64>> {
    let mut draw = Draw(seed);
    let parts = system.parts();
    let marks: Vec<Vec<f64>> = parts.inputs.iter().map(marks).collect();
    let mut row = || {
        let mut values: Vec<f64> = marks.iter().map(|marks| one(&mut draw, marks)).collect();
        if draw.unit() < 0.02 {
            let place = (draw.unit() * values.len() as f64) as usize % values.len();
            values[place] = draw.bad();
        }
        values
    };
    (0..count).map(|_| row()).collect()
}

/// Between the ends with a tenth beyond, or on one of the marks.
fn one(draw: &mut Draw, marks: &[f64]) -> f64 {
    let (lower, upper) = (marks[0], marks[1]);
    if draw.unit() < 0.15 {
        return marks[(draw.unit() * marks.len() as f64) as usize % marks.len()];
    }
    let span = upper - lower;
    let beyond = if draw.unit() < 0.1 { 0.5 * span } else { 0.0 };
    lower - beyond + draw.unit() * (span + 2.0 * beyond)
}

/// The ends of an input's range, then the numbers that its sets are made of.
fn marks(input: &Input) -> Vec<f64> {
    let mut numbers: Vec<f64> = Vec::new();
    for term in &input.terms {
        if let Membership::Shape { params, .. } = &term.membership {
            numbers.extend(params.iter().filter(|value| value.is_finite()));
        }
    }
    let known = || numbers.iter().copied();
    let (lowest, highest) = (known().reduce(f64::min), known().reduce(f64::max));
    let ends = match (input.universe, lowest, highest) {
        (Some(universe), _, _) => [universe.lower, universe.upper],
        (None, Some(lowest), Some(highest)) if lowest < highest => [lowest, highest],
        _ => [-1.0, 1.0],
    };
    ends.into_iter().chain(numbers).collect()
}

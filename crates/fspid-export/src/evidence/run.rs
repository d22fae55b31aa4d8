//! A program asked for the answers to vectors.

use fspid_numeric::Real;

use crate::interpret::{Branch, Cell, Machine};
use crate::program::{Part, Program};
use crate::vectors::{Event, Vector};

/// What a program did.
pub(super) struct Ran {
    pub(super) branches: Vec<Branch>,
    /// Vectors with other answers.
    pub(super) different: usize,
}

pub(super) fn run<R: Real>(program: &Program, vectors: &[Vector<R>]) -> Ran {
    let mut asked = Asked::new(program);
    let different = vectors.iter().filter(|vector| !asked.answers(vector)).count();
    Ran { branches: asked.machine.branches(), different }
}

/// The first vector with another answer, from 1.
pub(super) fn first_different<R: Real>(program: &Program, vectors: &[Vector<R>]) -> Option<usize> {
    let mut asked = Asked::new(program);
    vectors.iter().position(|vector| !asked.answers(vector)).map(|place| place + 1)
}

struct Asked<'a, R> {
    machine: Machine<'a, R>,
    sample: Vec<&'a str>,
    command: &'a str,
    latched: u8,
}

impl<'a, R: Real> Asked<'a, R> {
    fn new(program: &'a Program) -> Self {
        let mut machine = Machine::new(program);
        machine.run("reset");
        let sample = program.members(Part::Sample).iter().map(|member| member.name.as_str());
        let command = program.members(Part::Answer).first().map_or("", |member| &member.name);
        Self { machine, sample: sample.collect(), command, latched: 0 }
    }

    /// True if the answer to the next vector is the one that it holds.
    fn answers(&mut self, vector: &Vector<R>) -> bool {
        for (name, value) in self.sample.iter().zip(&vector.sample) {
            self.machine.set(Part::Sample, name, Cell::Real(*value));
        }
        let given = Cell::Real(vector.event.given());
        let machine = &mut self.machine;
        // What nobody writes is not what it should be.
        machine.set(Part::Answer, "saturated", Cell::Truth(true));
        machine.set(Part::Answer, "faults", Cell::Byte(u8::MAX));
        let mut good = true;
        match vector.event {
            Event::Hold => drop(machine.ask("hold", &[Cell::Byte(1)])),
            Event::Track(_) => drop(machine.ask("track", &[given])),
            event => {
                match event {
                    Event::Reset => machine.run("reset"),
                    Event::Faults => {
                        good = machine.ask("faults", &[]) == Some(Cell::Byte(self.latched));
                    }
                    Event::Memory(..) => machine.set(Part::State, event.name(), given),
                    Event::Step | Event::Hold | Event::Track(_) => {}
                }
                machine.run("step");
            }
        }
        self.latched = vector.marks[1];
        let names = [self.command, "kp", "ki", "kd"];
        let saturated = machine.ask("saturated", &[]) == Some(Cell::Truth(vector.marks[0] == 1));
        let faults = machine.member(Part::Answer, "faults") == Some(&Cell::Byte(vector.marks[1]));
        let same = |(name, expected): (&str, &R)| match machine.member(Part::Answer, name) {
            Some(Cell::Real(found)) => found.to_f64().to_bits() == expected.to_f64().to_bits(),
            _ => false,
        };
        good && saturated && faults && names.into_iter().zip(&vector.answer).all(same)
    }
}

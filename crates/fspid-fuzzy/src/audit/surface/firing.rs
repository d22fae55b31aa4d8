//! How strongly everything fires over a box of inputs, and how fast that changes.

use alloc::vec;
use alloc::vec::Vec;

use super::continuity::{Continuity, Jumps};
use crate::scalar::{Dual, Interval, Scalar};
use crate::supervisor::OutOfRange;
use crate::system::{Activation, Membership, STACK, System, Variable, hedged};

/// All values over a box, and all slopes along one input.
pub(super) type Slope = Dual<Interval, 1>;

/// Nothing is known of the slope.
pub(super) fn unknown_slope(value: Interval) -> Slope {
    Slope { value, derivative: [Interval::ENTIRE] }
}

/// Everything that is computed of a system's rules over a box.
#[derive(Clone, Debug)]
pub(super) struct Firing<'a> {
    pub(super) system: &'a System,
    continuity: Continuity,
    pub(super) inputs: Vec<Slope>,
    room: Vec<Slope>,
    stack: Vec<Slope>,
    grades: Vec<Slope>,
    strengths: Vec<Slope>,
    /// Strength of each rule as it acts, weight and activation included.
    pub(super) acting: Vec<Slope>,
    /// Strength of each conclusion.
    pub(super) degrees: Vec<Slope>,
    /// For each rule the statements it joins by *min*, if it is so plain.
    atoms: Vec<u128>,
    /// Of these, the ones that may be the least in the box; 0 if nothing is known.
    least: Vec<u128>,
}

impl<'a> Firing<'a> {
    pub(super) fn new(system: &'a System) -> Self {
        let zero = Slope::zero();
        let rules = system.rules.len();
        let atoms: Vec<u128> = (0..rules).map(|rule| system.plain_minimum(rule)).collect();
        Self {
            system,
            continuity: Continuity::of(system),
            inputs: vec![zero; system.parts.inputs.len()],
            room: vec![zero; system.room()],
            stack: vec![zero; STACK],
            grades: vec![zero; system.program.statements.len()],
            strengths: vec![zero; rules],
            acting: vec![zero; rules],
            degrees: vec![zero; system.conclusions.len()],
            least: vec![0; rules],
            atoms,
        }
    }

    /// Fires the rules over a box; slopes are those along the input `along`.
    pub(super) fn fire(&mut self, cell: &[Interval], along: Option<usize>) {
        self.take_inputs(cell, along);
        self.grade(cell);
        self.strengthen();
        self.act();
        let conclusions = self.system.conclusions.iter();
        for (place, conclusion) in self.degrees.iter_mut().zip(conclusions) {
            let strength = self.acting.get(conclusion.rule).copied().unwrap_or(Slope::zero());
            *place = within_unit(hedged(&conclusion.hedges, strength));
        }
    }

    pub(super) fn take_inputs(&mut self, cell: &[Interval], along: Option<usize>) {
        let parts = self.system.parts.inputs.iter();
        for (index, ((place, &values), input)) in
            self.inputs.iter_mut().zip(cell).zip(parts).enumerate()
        {
            let derivative = if along == Some(index) { Interval::ONE } else { Interval::ZERO };
            *place = Slope { value: values, derivative: [derivative] };
            let universe = input.universe.filter(|_| input.out_of_range == OutOfRange::Clamp);
            if let Some(u) = universe
                && !(values.lower() >= u.lower && values.upper() <= u.upper)
            {
                *place = place.larger(Slope::constant(u.lower)).smaller(Slope::constant(u.upper));
            }
        }
    }

    fn grade(&mut self, cell: &[Interval]) {
        let statements = self.system.program.statements.iter();
        for (place, (statement, jumps)) in
            self.grades.iter_mut().zip(statements.zip(&self.continuity.statements))
        {
            // What an output has been concluded so far is not followed.
            if matches!(statement.variable, Variable::Output(_)) {
                *place = unknown_slope(Interval::UNIT);
                continue;
            }
            let grade = self.system.input_grade(statement, &self.inputs, &mut self.room);
            *place = within_unit(grade);
            let Variable::Input(input) = statement.variable else { continue };
            match jumps {
                Jumps::Anywhere => *place = unknown_slope(place.value.hull(Interval::ZERO)),
                Jumps::At(places) => {
                    let jumps = |values: &Interval| places.iter().any(|&p| values.contains(p));
                    if cell.get(input).is_some_and(jumps) {
                        place.derivative = [Interval::ENTIRE];
                    }
                }
            }
        }
    }

    fn strengthen(&mut self) {
        for rule in 0..self.strengths.len() {
            let strength =
                self.system.rule_strength(rule, &mut self.stack, |s| grade_of(&self.grades, s));
            let least = self.least_atoms(rule);
            if let (Some(place), Some(mask), Some(known)) = (
                self.strengths.get_mut(rule),
                self.least.get_mut(rule),
                self.system.rules.get(rule),
            ) {
                *place = within_unit(strength);
                *mask = least;
                if self.continuity.blocks.get(known.block) != Some(&true) {
                    *place = unknown_slope(place.value.hull(Interval::ZERO));
                }
            }
        }
    }

    /// Those statements of a plain rule whose grade may be the least somewhere in the box.
    fn least_atoms(&self, rule: usize) -> u128 {
        let atoms = self.atoms.get(rule).copied().unwrap_or(0);
        let grades = || bits(atoms).filter_map(|atom| Some((atom, self.grades.get(atom)?.value)));
        let bound = grades().fold(f64::INFINITY, |bound, (_, grade)| bound.min(grade.upper()));
        grades()
            .filter(|(_, grade)| grade.lower() <= bound)
            .fold(0, |mask, (atom, _)| mask | (1 << atom))
    }

    /// Grade of `x` in a set.
    pub(super) fn grade_in(&mut self, set: &Membership, x: Slope) -> Slope {
        set.grade(x, &self.inputs, &mut self.room)
    }

    fn act(&mut self) {
        let system = self.system;
        for (rules, block) in system.block_rules.iter().zip(&system.parts.blocks) {
            let (Some(strengths), Some(acting)) =
                (self.strengths.get(rules.clone()), self.acting.get_mut(rules.clone()))
            else {
                continue;
            };
            activate(block.activation, strengths, acting);
        }
    }

    /// True if, everywhere in the box, the first rule acts no more strongly than the second.
    pub(super) fn never_stronger(&self, rule: usize, other: usize) -> bool {
        let strength = |rule: usize| self.acting.get(rule).map(|s| s.value);
        let (Some(left), Some(right)) = (strength(rule), strength(other)) else { return false };
        if left.upper() <= right.lower() {
            return true;
        }
        // The other's strength is its least grade; each of them is one of ours or above all of us.
        let mask = |rule: usize| self.least.get(rule).copied().unwrap_or(0);
        let (ours, theirs) = (mask(rule), mask(other));
        let known = ours != 0 && theirs != 0;
        known
            && bits(theirs & !ours)
                .all(|atom| grade_of(&self.grades, atom).value.lower() >= left.upper())
    }
}

fn grade_of(grades: &[Slope], statement: usize) -> Slope {
    grades.get(statement).copied().unwrap_or(Slope::zero())
}

/// The positions of the bits that are set.
fn bits(mut mask: u128) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let next = (mask != 0).then(|| mask.trailing_zeros() as usize);
        mask &= mask.wrapping_sub(1);
        next
    })
}

/// A grade cannot leave `[0, 1]`, whatever the width of its enclosure.
fn within_unit(grade: Slope) -> Slope {
    let value = grade.value.intersection(Interval::UNIT).unwrap_or(Interval::UNIT);
    Slope { value, ..grade }
}

/// How strongly the rules of a block act.
fn activate(activation: Activation, strengths: &[Slope], acting: &mut [Slope]) {
    match activation {
        Activation::General => acting.copy_from_slice(strengths),
        Activation::Proportional => {
            let sum = strengths.iter().fold(Slope::zero(), |sum, &strength| sum + strength);
            for (place, &strength) in acting.iter_mut().zip(strengths) {
                *place = within_unit(strength / sum);
            }
        }
        // A rule acts as strongly as it fires, or not at all.
        _ => {
            for (place, &strength) in acting.iter_mut().zip(strengths) {
                *place = unknown_slope(strength.value.hull(Interval::ZERO));
            }
        }
    }
}

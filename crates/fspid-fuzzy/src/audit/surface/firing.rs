//! How strongly everything fires over a box of inputs, and how fast that changes.

use alloc::collections::BTreeSet;
use alloc::vec;
use alloc::vec::Vec;

use super::continuity::{Continuity, Jumps};
use super::ties::Ties;
use crate::membership::Vertex;
use crate::norm::SNormKind;
use crate::supervisor::OutOfRange;
use crate::system::{
    Activation, Membership, RuleBlock, STACK, Statement, System, Variable, hedged,
};
use fspid_numeric::scalar::{Dual, Interval, Scalar};

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
    /// Whether what is asked about outputs [may be above 1](asks_beyond_unit).
    asks_beyond_unit: bool,
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
    ties: Ties,
    /// For each statement, those whose grade is known to be at least as large.
    above: Vec<u128>,
}

impl<'a> Firing<'a> {
    pub(super) fn new(system: &'a System) -> Self {
        let zero = Slope::zero();
        let rules = system.rules.len();
        let atoms: Vec<u128> = (0..rules).map(|rule| system.plain_minimum(rule)).collect();
        Self {
            system,
            continuity: Continuity::of(system),
            asks_beyond_unit: asks_beyond_unit(system),
            inputs: vec![zero; system.parts.inputs.len()],
            room: vec![zero; system.room()],
            stack: vec![zero; STACK],
            grades: vec![zero; system.program.statements.len()],
            strengths: vec![zero; rules],
            acting: vec![zero; rules],
            degrees: vec![zero; system.conclusions.len()],
            least: vec![0; rules],
            ties: Ties::of(system),
            above: vec![0; system.program.statements.len()],
            atoms,
        }
    }

    /// Fires the rules over a box; slopes are those along the input `along`.
    pub(super) fn fire(&mut self, cell: &[Interval], along: Option<usize>) {
        self.prepare(cell, along, false);
        self.ties.relate(cell, &mut self.above);
        self.conclude();
    }

    /// Grades a box. Answers in how many ways lines on which grades tie may divide it, for
    /// [`fire_way`](Self::fire_way); if `strips`, strips along those lines are left out.
    pub(super) fn prepare(&mut self, cell: &[Interval], along: Option<usize>, strips: bool) -> u32 {
        self.take_inputs(cell, along);
        self.grade(cell);
        self.ties.place(cell, strips);
        self.ties.ways()
    }

    /// Fires the rules over a part of the box that was prepared; false if the part is empty.
    pub(super) fn fire_way(&mut self, way: u32, cell: &[Interval]) -> bool {
        let possible = self.ties.choose(way, cell);
        if possible {
            self.ties.relate(cell, &mut self.above);
            self.conclude();
        }
        possible
    }

    fn conclude(&mut self) {
        self.strengthen();
        self.act();
        let conclusions = self.system.conclusions.iter();
        for (place, conclusion) in self.degrees.iter_mut().zip(conclusions) {
            let strength = self.acting.get(conclusion.rule).copied().unwrap_or(Slope::zero());
            let degree = hedged(&conclusion.hedges, strength);
            // What does not fire concludes nothing, whatever its hedges make of nothing.
            let may_not_fire = strength.value.lower() <= 0.0;
            let of_nothing = hedged(&conclusion.hedges, Slope::zero()).value;
            let degree = match may_not_fire && of_nothing.upper() > 0.0 {
                true => unknown_slope(degree.value.hull(Interval::ZERO)),
                false => degree,
            };
            let bounded = keeps_to_unit(self.system, conclusion.block, self.asks_beyond_unit);
            *place = if bounded { within_unit(degree) } else { degree };
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
                let beyond = self.asks_beyond_unit;
                *place = unknown_slope(if beyond { Interval::ENTIRE } else { Interval::UNIT });
                continue;
            }
            let grade = match straight_grade(self.system, statement, &self.inputs, &mut self.room) {
                Some(grade) => grade,
                None => self.system.input_grade(statement, &self.inputs, &mut self.room),
            };
            *place = within_unit(grade);
            let Variable::Input(input) = statement.variable else { continue };
            let has_value = has_grade(self.system, statement, &self.inputs);
            match jumps {
                // Without a value it is 0, of which hedges may make anything.
                _ if !has_value && !statement.hedges.is_empty() => {
                    *place = unknown_slope(Interval::UNIT);
                }
                Jumps::Anywhere => *place = unknown_slope(place.value.hull(Interval::ZERO)),
                Jumps::At(_) if !has_value => {
                    *place = unknown_slope(place.value.hull(Interval::ZERO));
                }
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
            let least = self.least_atoms(rule);
            let strength = if least == 0 { self.joined(rule) } else { self.minimum(rule, least) };
            if let (Some(place), Some(mask)) =
                (self.strengths.get_mut(rule), self.least.get_mut(rule))
            {
                (*place, *mask) = (strength, least);
            }
        }
    }

    /// Strength of any rule.
    fn joined(&mut self, rule: usize) -> Slope {
        let strength =
            self.system.rule_strength(rule, &mut self.stack, |s| grade_of(&self.grades, s));
        let block = self.system.rules.get(rule).map(|rule| rule.block);
        let beyond = self.asks_beyond_unit;
        let bounded = block.is_some_and(|block| keeps_to_unit(self.system, block, beyond));
        let strength = if bounded { within_unit(strength) } else { strength };
        match block.and_then(|block| self.continuity.blocks.get(block)) {
            Some(true) => strength,
            _ => unknown_slope(strength.value.hull(Interval::ZERO)),
        }
    }

    /// Strength of a plain rule: the least of its grades, with the slopes of those that may be it.
    fn minimum(&self, rule: usize, least: u128) -> Slope {
        let atoms = self.atoms.get(rule).copied().unwrap_or(0);
        let grades = bits(atoms).map(|atom| grade_of(&self.grades, atom).value);
        let value = grades.reduce(Interval::smaller).unwrap_or(Interval::UNIT);
        let slopes = bits(least).map(|atom| {
            let [slope] = grade_of(&self.grades, atom).derivative;
            slope
        });
        let slope = slopes.reduce(Interval::hull).unwrap_or(Interval::ENTIRE);
        Slope { value, derivative: [slope] }
    }

    /// Those statements of a plain rule whose grade may be the least somewhere in the box: all but
    /// those with another that is never larger.
    fn least_atoms(&self, rule: usize) -> u128 {
        let atoms = self.atoms.get(rule).copied().unwrap_or(0);
        let beaten = |one: usize| {
            bits(atoms).any(|other| {
                let smaller = other != one && self.grade_below(other, one);
                smaller && (other < one || !self.grade_below(one, other))
            })
        };
        bits(atoms).filter(|&one| !beaten(one)).fold(0, |mask, one| mask | (1 << one))
    }

    /// True if the first grade is nowhere in the box above the second.
    fn grade_below(&self, one: usize, other: usize) -> bool {
        let known = self.above.get(one).copied().unwrap_or(0);
        let value = |statement: usize| grade_of(&self.grades, statement).value;
        known >> other & 1 == 1 || nowhere_above(value(one), value(other))
    }

    /// The largest grade of some statements over a box.
    pub(super) fn largest_grade(
        &mut self,
        cell: &[Interval],
        along: Option<usize>,
        statements: &BTreeSet<usize>,
    ) -> Slope {
        self.prepare(cell, along, false);
        let grades = statements.iter().map(|&statement| grade_of(&self.grades, statement));
        grades.reduce(Scalar::larger).unwrap_or(Slope::zero())
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
            activate(block, self.asks_beyond_unit, strengths, acting);
        }
    }

    /// True if, everywhere in the box, the first rule acts no more strongly than the second.
    pub(super) fn never_stronger(&self, rule: usize, other: usize) -> bool {
        let strength = |rule: usize| self.acting.get(rule).map(|s| s.value);
        let (Some(left), Some(right)) = (strength(rule), strength(other)) else { return false };
        if nowhere_above(left, right) {
            return true;
        }
        // The other's strength is its least grade; each of them is above one of ours.
        let mask = |rule: usize| self.least.get(rule).copied().unwrap_or(0);
        let (ours, theirs) = (mask(rule), mask(other));
        let covered = |atom: usize| {
            ours >> atom & 1 == 1
                || grade_of(&self.grades, atom).value.lower() >= left.upper()
                || bits(ours).any(|own| self.grade_below(own, atom))
        };
        ours != 0 && theirs != 0 && bits(theirs & !ours).all(covered)
    }
}

fn grade_of(grades: &[Slope], statement: usize) -> Slope {
    grades.get(statement).copied().unwrap_or(Slope::zero())
}

/// True if a statement has two grades: only the upper ones are followed here, which says little of how
/// strongly rules fire.
pub(super) fn has_two_grades(system: &System) -> bool {
    let mut terms = system.parts.inputs.iter().flat_map(|input| &input.terms);
    terms.any(|term| term.lower.is_some())
}

/// True if a statement is known to have a grade everywhere in a box.
fn has_grade(system: &System, statement: &Statement, inputs: &[Slope]) -> bool {
    let Variable::Input(index) = statement.variable else { return false };
    let input = system.parts.inputs.get(index);
    let term = statement.term.and_then(|term| input?.terms.get(term));
    term.is_none_or(|term| has_value(&term.membership, index, inputs))
}

/// True if a set of an input is known to have a grade everywhere in a box.
pub(super) fn has_value(set: &Membership, input: usize, inputs: &[Slope]) -> bool {
    let Membership::Formula { formula, .. } = set else { return true };
    let own = inputs.get(input).map_or(Interval::ENTIRE, |it| it.value);
    let values: Vec<Interval> = [own].into_iter().chain(inputs.iter().map(|it| it.value)).collect();
    formula.has_value(&values)
}

/// Grade of a statement about a piecewise-linear set, with the slopes of just those pieces that reach
/// into the box: a corner on its face does not count.
fn straight_grade(
    system: &System,
    statement: &Statement,
    inputs: &[Slope],
    room: &mut [Slope],
) -> Option<Slope> {
    let Variable::Input(index) = statement.variable else { return None };
    let (input, &x) = (system.parts.inputs.get(index)?, inputs.get(index)?);
    let set = &input.terms.get(statement.term?)?.membership;
    let Membership::Shape { kind, params, height } = set else { return None };
    if !input.enabled || !kind.is_piecewise_linear() || x.value.is_point() {
        return None;
    }
    let mut slopes: Option<Interval> = None;
    let mut last: Option<Vertex> = None;
    let mut add = |slope: Interval| slopes = Some(slopes.map_or(slope, |s| s.hull(slope)));
    kind.vertices(params, &mut |vertex| {
        match last {
            None if x.value.lower() < vertex.x => add(Interval::ZERO),
            Some(before) if x.value.lower() < vertex.x && before.x < x.value.upper() => {
                let point = Interval::point;
                add((point(vertex.grade) - point(before.grade))
                    / (point(vertex.x) - point(before.x)));
            }
            _ => {}
        }
        last = Some(vertex);
    });
    if x.value.upper() > last?.x {
        add(Interval::ZERO);
    }
    let [along] = x.derivative;
    let derivative = [slopes? * Interval::point(*height) * along];
    Some(hedged(&statement.hedges, Slope { derivative, ..set.grade(x, inputs, room) }))
}

/// True if the first is nowhere larger. A tie of two single numbers is a kink that was hit exactly:
/// both sides count.
fn nowhere_above(one: Interval, other: Interval) -> bool {
    let tie = one.is_point() && other.is_point() && one.upper() >= other.lower();
    one.upper() <= other.lower() && !tie
}

/// The positions of the bits that are set.
fn bits(mut mask: u128) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let next = (mask != 0).then(|| mask.trailing_zeros() as usize);
        mask &= mask.wrapping_sub(1);
        next
    })
}

/// A grade cannot leave `[0, 1]`, whatever the width of its enclosure; nor can the strength of a rule
/// whose block [keeps to it](keeps_to_unit).
fn within_unit(grade: Slope) -> Slope {
    let value = grade.value.intersection(Interval::UNIT).unwrap_or(Interval::UNIT);
    Slope { value, ..grade }
}

/// Whether rules of a block act no more strongly than 1: sums without a bound may go above it.
fn keeps_to_unit(system: &System, block: usize, asks_beyond_unit: bool) -> bool {
    !asks_beyond_unit && system.parts.blocks.get(block).is_some_and(is_bounded)
}

fn is_bounded(block: &RuleBlock) -> bool {
    !block.or.is(SNormKind::UnboundedSum)
}

/// Whether some rule asks an output how strongly it has been concluded that may have been so more
/// strongly than 1. Nothing at all is known of the answer: hedges and norms mean nothing there.
pub(super) fn asks_beyond_unit(system: &System) -> bool {
    let adds_up = |output: usize| {
        let output = system.parts.outputs.get(output);
        output.is_some_and(|output| output.aggregation.is(SNormKind::UnboundedSum))
    };
    let bounded = system.parts.blocks.iter().all(is_bounded);
    system.program.statements.iter().any(|statement| match statement.variable {
        Variable::Output(output) => !bounded || adds_up(output),
        Variable::Input(_) => false,
    })
}

/// How strongly the rules of a block act.
fn activate(block: &RuleBlock, asks_beyond_unit: bool, strengths: &[Slope], acting: &mut [Slope]) {
    match block.activation {
        Activation::General => acting.copy_from_slice(strengths),
        Activation::Proportional => {
            let sum = strengths.iter().fold(Slope::zero(), |sum, &strength| sum + strength);
            let bounded = !asks_beyond_unit && is_bounded(block);
            for (place, &strength) in acting.iter_mut().zip(strengths) {
                let share = strength / sum;
                *place = match (bounded, sum.value.lower() > 0.0) {
                    (true, _) => within_unit(share),
                    (false, true) => share,
                    // Where nothing is left over, nothing acts.
                    (false, false) => unknown_slope(Interval::ENTIRE),
                };
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

//! From inputs to firing strengths.

use core::ops::Range;

use super::build::System;
use super::parts::{Activation, Comparison, Membership, Statement, Variable};
use super::program::{self, Form};
use super::workspace::Workspace;
use crate::hedge::Hedge;
use crate::norm::TNormKind;
use fspid_numeric::scalar::Scalar;

impl Membership {
    /// Grade of `x`. `inputs` are those of the system (for formulas); `room` holds at least as many
    /// numbers as the shape has parameters, and one more than the system has inputs.
    #[inline]
    pub fn grade<S: Scalar>(&self, x: S, inputs: &[S], room: &mut [S]) -> S {
        match self {
            Self::Shape { kind, params, height } => {
                scaled(kind.grade(S::lift(params, room), x), *height)
            }
            Self::Formula { formula, height } => {
                let variables = [x].into_iter().chain(inputs.iter().copied());
                let count = room.len().min(inputs.len() + 1);
                for (place, value) in room.iter_mut().zip(variables) {
                    *place = value;
                }
                let values = room.get(..count).unwrap_or_default();
                scaled(formula.evaluate(values).unit(), *height)
            }
        }
    }

    /// How much room [`grade`](Self::grade) needs with so many inputs.
    pub(crate) fn room(&self, inputs: usize) -> usize {
        match self {
            Self::Shape { params, .. } => params.len(),
            Self::Formula { .. } => inputs + 1,
        }
    }
}

#[inline]
fn scaled<S: Scalar>(grade: S, height: f64) -> S {
    if height < 1.0 { grade * S::constant(height) } else { grade }
}

/// The hedges of a statement acting on a grade, the last one first.
#[inline]
pub(crate) fn hedged<S: Scalar>(hedges: &[Hedge], grade: S) -> S {
    hedges.iter().rev().fold(grade, |grade, hedge| hedge.apply(grade))
}

impl System {
    /// Grade of a statement about an input.
    #[inline]
    pub(crate) fn input_grade<S: Scalar>(
        &self,
        statement: &Statement,
        inputs: &[S],
        room: &mut [S],
    ) -> S {
        let Variable::Input(index) = statement.variable else { return S::zero() };
        let (Some(input), Some(&x)) = (self.parts.inputs.get(index), inputs.get(index)) else {
            return S::zero();
        };
        if !input.enabled {
            return S::zero();
        }
        let grade = match statement.term.and_then(|term| input.terms.get(term)) {
            Some(term) => term.membership.grade(x, inputs, room),
            None => S::one(),
        };
        hedged(&statement.hedges, grade)
    }

    /// Strength of a rule, weight included, given the grades of statements.
    #[inline]
    pub(crate) fn rule_strength<S: Scalar>(
        &self,
        rule: usize,
        stack: &mut [S],
        grade: impl FnMut(usize) -> S,
    ) -> S {
        let Some(resolved) = self.rules.get(rule) else { return S::zero() };
        let Some(block) = self.parts.blocks.get(resolved.block) else { return S::zero() };
        let strength = match &resolved.form {
            Form::All(chain) => {
                let operands = self.program.operands(chain.clone());
                if block.and.is(TNormKind::Minimum) {
                    program::chain(operands, S::smaller, grade)
                } else {
                    program::chain(operands, |a, b| block.and.apply(a, b), grade)
                }
            }
            Form::Any(chain) => {
                let operands = self.program.operands(chain.clone());
                program::chain(operands, |a, b| block.or.apply(a, b), grade)
            }
            Form::Other => {
                let steps = self.program.steps.get(resolved.steps.clone()).unwrap_or_default();
                program::strength(steps, block, stack, grade)
            }
        };
        if resolved.weight < 1.0 { strength * S::constant(resolved.weight) } else { strength }
    }

    /// Grades, strengths and degrees at the inputs in the workspace.
    pub(crate) fn fire(&self, workspace: &mut Workspace) {
        let Workspace { inputs, grades, stack, strengths, acting, degrees, scratch, .. } =
            workspace;
        for (grade, statement) in grades.iter_mut().zip(&self.program.statements) {
            *grade = self.input_grade(statement, inputs, &mut scratch.room);
        }
        for (rules, block) in self.block_rules.iter().zip(&self.parts.blocks) {
            if self.chained {
                self.fire_in_turn(rules.clone(), grades, stack, strengths, degrees);
            } else if let Some(strengths) = strengths.get_mut(rules.clone()) {
                for (rule, place) in rules.clone().zip(strengths) {
                    *place = self.rule_strength(rule, stack, |statement| {
                        grades.get(statement).copied().unwrap_or(0.0)
                    });
                }
            }
            if let (Some(strengths), Some(acting)) =
                (strengths.get(rules.clone()), acting.get_mut(rules.clone()))
            {
                activate(block.activation, strengths, acting);
            }
            self.conclude(rules.clone(), acting, degrees);
        }
    }

    /// Fires rules of which some ask how strongly an output has been concluded so far.
    fn fire_in_turn(
        &self,
        rules: Range<usize>,
        grades: &[f64],
        stack: &mut [f64],
        strengths: &mut [f64],
        degrees: &mut [f64],
    ) {
        for rule in rules {
            let strength = self.rule_strength(rule, stack, |statement| {
                self.statement_grade(statement, rule, grades, degrees)
            });
            if let Some(place) = strengths.get_mut(rule) {
                *place = strength;
            }
            self.conclude(rule..rule + 1, strengths, degrees);
        }
    }

    /// Grade of a statement for a rule: those about inputs are known, those about outputs depend on
    /// what the rules before have concluded.
    #[inline]
    fn statement_grade(
        &self,
        statement: usize,
        rule: usize,
        grades: &[f64],
        degrees: &[f64],
    ) -> f64 {
        let known = grades.get(statement).copied().unwrap_or(0.0);
        match self.program.statements.get(statement) {
            Some(Statement { variable: Variable::Output(output), term, hedges }) => {
                hedged(hedges, self.concluded(*output, *term, rule, degrees))
            }
            _ => known,
        }
    }

    /// How strongly the rules before `rule` have concluded a term of an output; without a term, 1.
    fn concluded(&self, output: usize, term: Option<usize>, rule: usize, degrees: &[f64]) -> f64 {
        let (Some(term), Some(resolved), Some(part)) =
            (term, self.outputs.get(output), self.parts.outputs.get(output))
        else {
            return 1.0;
        };
        if !part.enabled {
            return 0.0;
        }
        let before = resolved.conclusions.iter().filter(|&&index| {
            self.conclusions.get(index).is_some_and(|c| c.rule < rule && c.term == term)
        });
        before
            .filter_map(|&index| degrees.get(index))
            .fold(0.0, |joined, &degree| part.aggregation.apply(joined, degree))
    }

    /// Degrees of the conclusions of some rules from the strengths of all.
    fn conclude(&self, rules: Range<usize>, strengths: &[f64], degrees: &mut [f64]) {
        let (Some(resolved), Some(strengths)) =
            (self.rules.get(rules.clone()), strengths.get(rules))
        else {
            return;
        };
        for (rule, &strength) in resolved.iter().zip(strengths) {
            let Some(degrees) = degrees.get_mut(rule.conclusions.clone()) else { continue };
            degrees.fill(strength);
            // A rule that does not fire concludes nothing, not even `not`.
            if self.hedged
                && strength > 0.0
                && let Some(conclusions) = self.conclusions.get(rule.conclusions.clone())
            {
                for (degree, conclusion) in degrees.iter_mut().zip(conclusions) {
                    *degree = hedged(&conclusion.hedges, strength);
                }
            }
        }
    }
}

/// Which rules of a block act, and how strongly.
fn activate(activation: Activation, strengths: &[f64], acting: &mut [f64]) {
    match activation {
        Activation::General => acting.copy_from_slice(strengths),
        Activation::First { count, threshold } => {
            keep(strengths, acting, |_, s| s > 0.0 && s >= threshold, count);
        }
        Activation::Last { count, threshold } => {
            let fires = |s: f64| s > 0.0 && s >= threshold;
            let total = strengths.iter().filter(|&&s| fires(s)).count();
            let skip = total.saturating_sub(count as usize);
            let mut seen = 0;
            for (place, &strength) in acting.iter_mut().zip(strengths) {
                let acts = fires(strength) && seen >= skip;
                seen += usize::from(fires(strength));
                *place = if acts { strength } else { 0.0 };
            }
        }
        Activation::Highest { count } => ranked(strengths, acting, count, |a, b| a > b),
        Activation::Lowest { count } => ranked(strengths, acting, count, |a, b| a < b),
        Activation::Proportional => {
            let sum: f64 = strengths.iter().sum();
            for (place, &strength) in acting.iter_mut().zip(strengths) {
                *place = if sum > 0.0 { strength / sum } else { 0.0 };
            }
        }
        Activation::Threshold { comparison, threshold } => {
            keep(strengths, acting, |_, s| compares(s, comparison, threshold), u32::MAX);
        }
    }
}

/// Keeps the first `count` rules that `acts` allows.
fn keep(strengths: &[f64], acting: &mut [f64], acts: impl Fn(usize, f64) -> bool, count: u32) {
    let mut left = count;
    for (index, (place, &strength)) in acting.iter_mut().zip(strengths).enumerate() {
        let chosen = left > 0 && acts(index, strength);
        left -= u32::from(chosen);
        *place = if chosen { strength } else { 0.0 };
    }
}

/// Keeps the `count` best of the rules that fire; of equals the first.
fn ranked(strengths: &[f64], acting: &mut [f64], count: u32, better: fn(f64, f64) -> bool) {
    acting.fill(0.0);
    for _ in 0..count {
        let mut best: Option<(usize, f64)> = None;
        for (index, (&strength, &taken)) in strengths.iter().zip(acting.iter()).enumerate() {
            let free = strength > 0.0 && taken <= 0.0;
            if free && best.is_none_or(|(_, found)| better(strength, found)) {
                best = Some((index, strength));
            }
        }
        let Some((index, strength)) = best else { return };
        if let Some(place) = acting.get_mut(index) {
            *place = strength;
        }
    }
}

#[allow(clippy::float_cmp, reason = "equality is what the file asked for")]
fn compares(strength: f64, comparison: Comparison, threshold: f64) -> bool {
    match comparison {
        Comparison::Less => strength < threshold,
        Comparison::AtMost => strength <= threshold,
        Comparison::Equal => strength == threshold,
        Comparison::Unequal => strength != threshold,
        Comparison::AtLeast => strength >= threshold,
        Comparison::Greater => strength > threshold,
    }
}

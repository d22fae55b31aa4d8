//! Interval type-2 systems: every grade is known only to lie between two bounds.
//!
//! Strengths are carried through the rules as pairs of bounds; norms and hedges are monotone, and a
//! negation exchanges the two. Each output is then the interval between the smallest and the largest
//! centroid (or weighted average) that the bounds allow, exactly
//! ([`karnik_mendel`](crate::karnik_mendel)), and its answer is the middle of that interval.

use alloc::format;
use alloc::vec;
use alloc::vec::Vec;

use super::build::{ResolvedOutput, System};
use super::defuzzifier::{Defuzzifier, Sampling, SetReading};
use super::error::{SystemError, SystemProblem};
use super::firing::hedged;
use super::norms::{SNorm, TNorm};
use super::output::{AggregatedSet, Outline, Room, roomy_clone, smaller_set, value};
use super::parts::{
    Activation, Conclusion, Membership, Output, Parts, RuleBlock, Statement, Variable,
};
use super::program::{STACK, Step};
use super::workspace::Workspace;
use crate::defuzzifier::SampleGrid;
use crate::hedge::Hedge;
use crate::karnik_mendel::{Straight, WeightedPoint, average_end_points, centroid_end_points};

/// Smallest and largest value.
pub(crate) type Bounds = [f64; 2];

/// What an interval type-2 system needs beside its ordinary parts.
#[derive(Clone, Debug)]
pub(crate) struct Type2 {
    /// Of each output, the outlines of the lower and of the upper sets.
    outlines: Vec<[Option<Outline>; 2]>,
}

/// Memory for evaluations of an interval type-2 system.
#[derive(Debug, Default)]
pub(crate) struct Type2Room {
    grades: Vec<Bounds>,
    stack: Vec<Bounds>,
    strengths: Vec<Bounds>,
    degrees: Vec<Bounds>,
    /// Lower ends of `degrees`.
    lower: Vec<f64>,
    outline: Room,
    straight: [Vec<Straight>; 2],
    points: Vec<WeightedPoint>,
    pub(crate) intervals: Vec<Option<Bounds>>,
}

impl Clone for Type2Room {
    fn clone(&self) -> Self {
        Self {
            grades: self.grades.clone(),
            stack: roomy_clone(&self.stack),
            strengths: self.strengths.clone(),
            degrees: self.degrees.clone(),
            lower: self.lower.clone(),
            outline: self.outline.clone(),
            straight: self.straight.each_ref().map(roomy_clone),
            points: roomy_clone(&self.points),
            intervals: self.intervals.clone(),
        }
    }
}

impl Parts {
    /// True if some set has a lower membership function, or a conclusion is an interval.
    #[must_use]
    pub fn is_interval_type2(&self) -> bool {
        let of_inputs =
            self.inputs.iter().flat_map(|input| &input.terms).any(|t| t.lower.is_some());
        let wide = |conclusion: &Conclusion| {
            matches!(conclusion, Conclusion::Set { lower: Some(_), .. } | Conclusion::Interval(_))
        };
        of_inputs || self.outputs.iter().flat_map(|o| &o.terms).any(|term| wide(&term.conclusion))
    }
}

/// Bounds are joined with bounds, which is right of norms that rise with both of what they join; a formula need not.
const FORMULA: (&str, &str) =
    ("a norm that is a formula, in an interval type-2 system,", "one of the norms that have names");

/// Why an output or its rules cannot be interval type-2, if they cannot.
pub(crate) fn conflict(output: &Output) -> Option<(&'static str, &'static str)> {
    let straight =
        |m: &Membership| matches!(m, Membership::Shape { kind, .. } if kind.is_piecewise_linear());
    let all_straight = output.terms.iter().all(|term| match &term.conclusion {
        Conclusion::Set { membership, lower } => {
            straight(membership) && lower.as_ref().is_none_or(straight)
        }
        _ => true,
    });
    let reads_sets = output.terms.iter().any(|t| matches!(t.conclusion, Conclusion::Set { .. }));
    match output.defuzzifier {
        // A number for each strength between two bounds: more than an interval of numbers.
        Defuzzifier::WeightedAverage(_) | Defuzzifier::WeightedSum(_) if reads_sets => Some((
            "a set that is read by its rule's strength, in an interval type-2 system,",
            "numbers, intervals, planes or formulas in its place, or the defuzzifier centroid",
        )),
        _ if matches!(output.aggregation, SNorm::Formula(_)) => Some(FORMULA),
        Defuzzifier::Centroid(Sampling::Exact) if !all_straight => Some((
            "the exact centroid of interval type-2 sets",
            "piecewise-linear sets, or a sampled rule such as endpoints:101",
        )),
        Defuzzifier::Centroid(Sampling::Vertices(_)) => {
            Some(("the rule `vertices` for interval type-2 sets", "another rule"))
        }
        Defuzzifier::Centroid(_)
        | Defuzzifier::WeightedAverage(_)
        | Defuzzifier::WeightedSum(_) => None,
        _ => Some(("an interval type-2 output", "centroid, weighted-average or weighted-sum")),
    }
}

/// Outputs with an exact centroid whose sets do not stay straight where they are shaped or joined:
/// their interval has no closed form.
pub(crate) fn without_outline(system: &System) -> Vec<SystemError> {
    let outlines = system.type2.iter().flat_map(|type2| &type2.outlines);
    let exact = |output: &Output| output.defuzzifier == Defuzzifier::Centroid(Sampling::Exact);
    let lacking = system.parts.outputs.iter().zip(outlines);
    let lacking =
        lacking.filter(|(output, both)| exact(output) && both.iter().any(Option::is_none));
    let error = |(output, _): (&Output, _)| SystemError {
        place: format!("output `{}`", output.name),
        problem: SystemProblem::Conflict {
            what: "the exact centroid of interval type-2 sets",
            needs: "the aggregation maximum, bounded-sum, normalized-sum or unbounded-sum and the \
                    implication minimum or algebraic-product, or a sampled rule such as \
                    endpoints:101",
        },
    };
    lacking.map(error).collect()
}

/// As [`conflict`], for a block of rules.
pub(crate) fn block_conflict(block: &RuleBlock) -> Option<(&'static str, &'static str)> {
    let asks_output = block.rules.iter().any(|rule| rule.antecedent.asks_outputs());
    let is_formula = |norm: &TNorm| matches!(norm, TNorm::Formula(_));
    if [&block.and, &block.implication].into_iter().any(is_formula)
        || matches!(block.or, SNorm::Formula(_))
    {
        Some(FORMULA)
    } else if block.activation != Activation::General {
        Some(("an interval type-2 system", "the activation `general`"))
    } else if asks_output {
        Some(("an interval type-2 system", "rules that ask about inputs only"))
    } else {
        None
    }
}

impl Type2 {
    /// What the system needs, if it is interval type-2.
    pub(crate) fn of(parts: &Parts, outputs: &[ResolvedOutput]) -> Option<Self> {
        let outlines = |(output, resolved): (&Output, &ResolvedOutput)| {
            [true, false].map(|lowered| Outline::of(&ordinary(output, lowered), &resolved.actors))
        };
        parts
            .is_interval_type2()
            .then(|| Self { outlines: parts.outputs.iter().zip(outputs).map(outlines).collect() })
    }

    /// Memory for evaluations.
    pub(crate) fn room(&self, system: &System) -> Type2Room {
        let most = system.outputs.iter().map(|o| o.conclusions.len()).max().unwrap_or(0);
        let sampled = system.parts.outputs.iter().filter_map(samples).map(|grid| grid.count).max();
        let mut outline = Room::default();
        for (output, both) in system.outputs.iter().zip(&self.outlines) {
            for each in both.iter().flatten() {
                each.reserve(&output.actors, &mut outline);
            }
        }
        let pieces = outline.joined.capacity();
        Type2Room {
            grades: vec![[0.0; 2]; system.program.statements.len()],
            stack: vec![[0.0; 2]; STACK],
            strengths: vec![[0.0; 2]; system.rules.len()],
            degrees: vec![[0.0; 2]; system.conclusions.len()],
            lower: vec![0.0; system.conclusions.len()],
            outline,
            straight: [Vec::with_capacity(pieces), Vec::with_capacity(pieces)],
            points: Vec::with_capacity(most.max(sampled.unwrap_or(0) as usize)),
            intervals: vec![None; system.parts.outputs.len()],
        }
    }
}

impl System {
    /// Bounds of grades, strengths and degrees at the inputs in the workspace.
    pub(crate) fn fire_bounds(&self, workspace: &mut Workspace) {
        let Workspace { inputs, scratch, type2: Some(room), degrees, .. } = workspace else {
            return;
        };
        for (grade, statement) in room.grades.iter_mut().zip(&self.program.statements) {
            *grade = self.input_bounds(statement, inputs, &mut scratch.room);
        }
        for (strength, rule) in room.strengths.iter_mut().zip(&self.rules) {
            let steps = self.program.steps.get(rule.steps.clone()).unwrap_or_default();
            let Some(block) = self.parts.blocks.get(rule.block) else { continue };
            let bounds = strength_bounds(steps, block, &room.grades, &mut room.stack);
            *strength = bounds.map(|end| if rule.weight < 1.0 { end * rule.weight } else { end });
        }
        for (index, conclusion) in self.conclusions.iter().enumerate() {
            let strength = room.strengths.get(conclusion.rule).copied().unwrap_or_default();
            let bounds = concluded_bounds(&conclusion.hedges, strength);
            let places =
                (room.degrees.get_mut(index), room.lower.get_mut(index), degrees.get_mut(index));
            if let (Some(both), Some(lower), Some(upper)) = places {
                (*both, *lower, *upper) = (bounds, bounds[0], bounds[1]);
            }
        }
    }

    fn input_bounds(&self, statement: &Statement, inputs: &[f64], room: &mut [f64]) -> Bounds {
        let Variable::Input(index) = statement.variable else { return [0.0; 2] };
        let (Some(input), Some(&x)) = (self.parts.inputs.get(index), inputs.get(index)) else {
            return [0.0; 2];
        };
        if !input.enabled {
            return [0.0; 2];
        }
        let Some(term) = statement.term.and_then(|term| input.terms.get(term)) else {
            return hedged_bounds(&statement.hedges, [1.0; 2]);
        };
        let upper = term.membership.grade(x, inputs, room);
        let lower = term.lower.as_ref().map_or(upper, |lower| lower.grade(x, inputs, room));
        hedged_bounds(&statement.hedges, [lower.min(upper), upper])
    }

    /// The middle of an output's interval, which is kept in the workspace; nothing if no rule fires.
    pub(crate) fn middle_of_interval(
        &self,
        index: usize,
        output: &Output,
        workspace: &mut Workspace,
    ) -> Option<f64> {
        let interval = self.interval(index, output, workspace);
        if let Some(place) = workspace.type2.as_mut().and_then(|room| room.intervals.get_mut(index))
        {
            *place = interval;
        }
        interval.map(|[lower, upper]| 0.5 * lower + 0.5 * upper)
    }

    fn interval(&self, index: usize, output: &Output, workspace: &mut Workspace) -> Option<Bounds> {
        match output.defuzzifier {
            Defuzzifier::WeightedAverage(reading) => {
                self.concluded_points(index, output, reading, workspace)?;
                average_end_points(&workspace.type2.as_ref()?.points)
            }
            Defuzzifier::WeightedSum(reading) => {
                self.concluded_points(index, output, reading, workspace)?;
                sum_end_points(&workspace.type2.as_ref()?.points)
            }
            _ => match samples(output) {
                Some(grid) => {
                    self.sampled_points(index, output, grid, workspace)?;
                    average_end_points(&workspace.type2.as_ref()?.points)
                }
                None => self.exact_interval(index, workspace),
            },
        }
    }

    fn exact_interval(&self, index: usize, workspace: &mut Workspace) -> Option<Bounds> {
        let ResolvedOutput { actors, conclusions, .. } = self.outputs.get(index)?;
        let outlines = self.type2.as_ref()?.outlines.get(index)?;
        let Workspace { scratch, type2, degrees, .. } = workspace;
        let Type2Room { lower, outline, straight, .. } = type2.as_mut()?;
        let ends = [lower.as_slice(), degrees.as_slice()];
        for ((own, degrees), straight) in outlines.iter().zip(ends).zip(straight.iter_mut()) {
            let levels = actors.levels(conclusions, degrees, &mut scratch.levels);
            own.as_ref()?.join(actors, levels, outline);
            copy(&outline.joined, straight);
        }
        centroid_end_points(&straight[0], &straight[1])
    }

    /// One point for each conclusion that fires.
    fn concluded_points(
        &self,
        index: usize,
        output: &Output,
        reading: SetReading,
        workspace: &mut Workspace,
    ) -> Option<()> {
        let Workspace { inputs, scratch, type2, .. } = workspace;
        let room = type2.as_mut()?;
        room.points.clear();
        for &position in &self.outputs.get(index)?.conclusions {
            let term = output.terms.get(self.conclusions.get(position)?.term)?;
            let weight = *room.degrees.get(position)?;
            if weight[1] > 0.0 {
                let value = match &term.conclusion {
                    Conclusion::Interval(ends) => *ends,
                    other => [value(other, reading, weight[1], inputs, &mut scratch.room); 2],
                };
                room.points.push(WeightedPoint { value, weight });
            }
        }
        Some(())
    }

    /// One point for each sample of the universe.
    fn sampled_points(
        &self,
        index: usize,
        output: &Output,
        grid: SampleGrid,
        workspace: &mut Workspace,
    ) -> Option<()> {
        let universe = output.universe?;
        let Workspace { inputs, scratch, type2, .. } = workspace;
        let room = type2.as_mut()?;
        room.points.clear();
        for n in 0..grid.count {
            let (x, counts) = grid.at(n, [universe.lower, universe.upper]);
            let mut weight = [0.0; 2];
            for &position in &self.outputs.get(index)?.conclusions {
                let resolved = self.conclusions.get(position)?;
                let block = self.parts.blocks.get(resolved.block)?;
                let Conclusion::Set { membership, lower } =
                    &output.terms.get(resolved.term)?.conclusion
                else {
                    continue;
                };
                let upper = membership.grade(x, inputs, &mut scratch.room);
                let lower = lower.as_ref().map_or(upper, |l| l.grade(x, inputs, &mut scratch.room));
                let degree = room.degrees.get(position)?;
                for ((joined, &degree), grade) in
                    weight.iter_mut().zip(degree).zip([lower.min(upper), upper])
                {
                    let shaped = block.implication.apply(degree, grade);
                    *joined = output.aggregation.apply(*joined, shaped);
                }
            }
            let weight = weight.map(|w| counts * w);
            room.points.push(WeightedPoint { value: [x; 2], weight });
        }
        Some(())
    }
}

/// The output with its lower or its upper sets only; an upper set stands where its lower one is above it.
fn ordinary(output: &Output, lowered: bool) -> Output {
    let mut ordinary = output.clone();
    for term in &mut ordinary.terms {
        if let Conclusion::Set { membership, lower } = &mut term.conclusion
            && let (Some(lower), true) = (lower.take(), lowered)
        {
            *membership = smaller_set(&lower, membership).unwrap_or(lower);
        }
    }
    ordinary
}

/// The samples of a sampled centroid.
fn samples(output: &Output) -> Option<SampleGrid> {
    match output.defuzzifier {
        Defuzzifier::Centroid(sampling) => sampling.samples(),
        _ => None,
    }
}

fn copy(joined: &AggregatedSet, straight: &mut Vec<Straight>) {
    straight.clear();
    let pieces = joined.pieces().iter();
    straight.extend(pieces.map(|piece| Straight { x: piece.x, grade: piece.grade }));
}

/// The hedges of a statement acting on both bounds: those that fall exchange them.
fn hedged_bounds(hedges: &[Hedge], bounds: Bounds) -> Bounds {
    let [a, b] = bounds.map(|end| hedged(hedges, end));
    [a.min(b), a.max(b)]
}

/// The hedges of a conclusion acting on a rule's strength: a rule that does not fire concludes nothing,
/// not even `not`.
fn concluded_bounds(hedges: &[Hedge], [lower, upper]: Bounds) -> Bounds {
    let bounds = hedged_bounds(hedges, [lower, upper]);
    match (lower > 0.0, upper > 0.0) {
        (true, _) => bounds,
        (false, true) => [0.0, bounds[1]],
        (false, false) => [0.0; 2],
    }
}

/// Smallest and largest $\sum w_i z_i$.
fn sum_end_points(points: &[WeightedPoint]) -> Option<Bounds> {
    if points.is_empty() {
        return None;
    }
    let ends = |point: &WeightedPoint| {
        let products = point.value.map(|z| point.weight.map(|w| w * z));
        let all = products.as_flattened();
        [
            all.iter().copied().fold(f64::INFINITY, f64::min),
            all.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        ]
    };
    Some(points.iter().map(ends).fold([0.0; 2], |[a, b], [c, d]| [a + c, b + d]))
}

/// Bounds of the strength of an antecedent.
fn strength_bounds(
    steps: &[Step],
    block: &RuleBlock,
    grades: &[Bounds],
    stack: &mut Vec<Bounds>,
) -> Bounds {
    stack.clear();
    for &step in steps {
        let next = match step {
            Step::Statement(index) => grades.get(index).copied().unwrap_or_default(),
            Step::Always => [1.0; 2],
            Step::Not => {
                let [lower, upper] = stack.pop().unwrap_or_default();
                [1.0 - upper, 1.0 - lower]
            }
            Step::And | Step::Or => {
                let (right, left) =
                    (stack.pop().unwrap_or_default(), stack.pop().unwrap_or_default());
                let join = |end: usize| match step {
                    Step::And => block.and.apply(left[end], right[end]),
                    _ => block.or.apply(left[end], right[end]),
                };
                [join(0), join(1)]
            }
        };
        // Never beyond the capacity: the depth was checked when the system was built.
        stack.push(next);
    }
    stack.pop().unwrap_or_default()
}

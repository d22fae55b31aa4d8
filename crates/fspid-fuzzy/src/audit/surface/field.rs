//! The surfaces of a system as functions of boxes.

use alloc::vec::Vec;

use super::envelope::{Bounds, Envelope};
use super::firing::{Firing, Slope, asks_beyond_unit, has_two_grades, unknown_slope};
use super::gradient::{self, Gradient, Known, Level};
use super::layers::Layers;
use super::masses::Masses;
use super::weighted::Weighted;
use crate::norm::TNormKind;
use crate::system::{Activation, FallbackValue, Output, Program, Step, System};
use fspid_numeric::scalar::{Interval, Scalar};

/// How an output is enclosed.
#[derive(Clone, Debug)]
enum Method {
    Layers(Layers, Vec<Level>),
    Masses(Masses),
    Weighted,
    /// Nothing is known.
    Unknown,
}

/// All outputs of a system as functions of boxes, with room for the computation.
pub(super) struct Field<'a> {
    pub(super) firing: Firing<'a>,
    methods: Vec<Method>,
    weighted: Weighted,
    low: Envelope,
    high: Envelope,
    levels: [Vec<f64>; 2],
    gradient: Gradient,
    /// In some box that was asked for, perhaps no rule fires.
    pub(super) may_be_silent: bool,
    /// Boxes that were looked at so far.
    pub(super) boxes: u64,
}

impl<'a> Field<'a> {
    pub(super) fn new(system: &'a System) -> Self {
        let methods = (0..system.parts.outputs.len()).map(|output| method(system, output));
        Self {
            firing: Firing::new(system),
            methods: methods.collect(),
            weighted: Weighted::default(),
            low: Envelope::default(),
            high: Envelope::default(),
            levels: [Vec::new(), Vec::new()],
            gradient: Gradient::default(),
            may_be_silent: false,
            boxes: 0,
        }
    }

    /// All values of an output over a box, and all its slopes along an input if one is named.
    pub(super) fn ask(&mut self, index: usize, cell: &[Interval], along: Option<usize>) -> Slope {
        self.firing.fire(cell, along);
        self.answer(index, along)
    }

    /// All slopes of an output over a box but for strips along lines on which grades tie.
    pub(super) fn slope(&mut self, index: usize, cell: &[Interval], along: usize) -> Interval {
        let ways = self.firing.prepare(cell, Some(along), true);
        let mut hull: Option<Interval> = None;
        for way in 0..ways {
            if self.firing.fire_way(way, cell) {
                let [slope] = self.answer(index, Some(along)).derivative;
                hull = Some(hull.map_or(slope, |hull| hull.hull(slope)));
            }
        }
        hull.unwrap_or_else(|| {
            let [slope] = self.ask(index, cell, Some(along)).derivative;
            slope
        })
    }

    /// What the rules that were fired say about an output.
    pub(super) fn answer(&mut self, index: usize, along: Option<usize>) -> Slope {
        let Some(output) = self.firing.system.parts.outputs.get(index) else {
            return unknown_slope(Interval::ENTIRE);
        };
        let (answer, least) = match self.methods.get_mut(index) {
            Some(Method::Layers(layers, levels)) => {
                let room =
                    Room { low: &mut self.low, high: &mut self.high, ends: &mut self.levels };
                let gradient = along.map(|_| &mut self.gradient);
                from_layers(&self.firing, layers, levels, room, gradient)
            }
            Some(Method::Masses(masses)) => masses.enclose(&mut self.firing, index),
            Some(Method::Weighted) => self.weighted.enclose(&mut self.firing, index),
            _ => (unknown_slope(Interval::ENTIRE), 0.0),
        };
        let answer = if output.enabled && least > 2.0 * f64::MIN_POSITIVE {
            answer
        } else {
            self.may_be_silent = true;
            with_fallback(output, answer)
        };
        clamped(output, answer)
    }
}

fn method(system: &System, index: usize) -> Method {
    let Some(output) = system.parts.outputs.get(index) else { return Method::Unknown };
    if has_two_grades(system) {
        return Method::Unknown;
    }
    if output.defuzzifier.sampling().is_none() {
        return Method::Weighted;
    }
    if asks_beyond_unit(system) {
        return Method::Unknown;
    }
    match Layers::of(system, index) {
        Some(layers) => {
            let levels = gradient::room(&layers);
            Method::Layers(layers, levels)
        }
        None => Masses::of(system, index).map_or(Method::Unknown, Method::Masses),
    }
}

/// What an answer by layers is computed in.
struct Room<'a> {
    low: &'a mut Envelope,
    high: &'a mut Envelope,
    /// Lower and upper ends of the levels.
    ends: &'a mut [Vec<f64>; 2],
}

fn from_layers(
    firing: &Firing<'_>,
    layers: &Layers,
    levels: &mut [Level],
    room: Room<'_>,
    gradient: Option<&mut Gradient>,
) -> (Slope, f64) {
    let Room { low, high, ends } = room;
    let slack = 2.0 * layers.slack;
    for (level, layer) in levels.iter_mut().zip(&layers.layers) {
        let strength = firing.strongest(&layer.conclusions, &mut level.tops);
        let [slope] = strength.derivative;
        let fires = strength.value.upper() > 0.0;
        level.lower = (strength.value.lower() - slack).max(0.0);
        level.upper = if fires { strength.value.upper() + slack } else { 0.0 };
        level.slope = slope;
    }
    let [lowers, uppers] = ends;
    lowers.clear();
    lowers.extend(levels.iter().map(|level| level.lower));
    uppers.clear();
    uppers.extend(levels.iter().map(|level| level.upper));
    low.trace(layers, lowers);
    high.trace(layers, uppers);
    let bounds = Bounds::between(layers, low, high);
    let value = Interval::point(layers.middle) + bounds.centre;
    let slope = gradient.map_or(Interval::ENTIRE, |gradient| {
        let below = |one: usize, other: usize| match (levels.get(one), levels.get(other)) {
            (Some(one), Some(other)) => firing.all_below(&one.tops, &other.tops),
            _ => false,
        };
        gradient.slope(&Known { layers, levels, bounds: &bounds, below })
    });
    (Slope { value, derivative: [slope] }, bounds.area.lower())
}

impl Firing<'_> {
    /// The strongest of some conclusions; `tops` become those of them that are it somewhere in the
    /// box.
    pub(super) fn strongest(&self, conclusions: &[usize], tops: &mut Vec<usize>) -> Slope {
        let degree = |c: usize| self.degrees.get(c).copied().unwrap_or(Slope::zero());
        let least = conclusions.iter().map(|&c| degree(c).value.lower()).fold(0.0, f64::max);
        tops.clear();
        let mut value = Interval::ZERO;
        for &one in conclusions.iter().filter(|&&c| degree(c).value.upper() >= least) {
            value = value.larger(degree(one).value);
            if !tops.iter().any(|&other| self.conclusion_below(one, other)) {
                tops.retain(|&other| !self.conclusion_below(other, one));
                tops.push(one);
            }
        }
        let slopes = tops.iter().map(|&c| {
            let [slope] = degree(c).derivative;
            slope
        });
        let slope = slopes.reduce(Interval::hull).unwrap_or(Interval::ZERO);
        Slope { value, derivative: [slope] }
    }

    /// True if the first conclusion is nowhere in the box stronger than the second.
    fn conclusion_below(&self, one: usize, other: usize) -> bool {
        let conclusions = &self.system.conclusions;
        let (Some(one), Some(other)) = (conclusions.get(one), conclusions.get(other)) else {
            return false;
        };
        let plain = one.hedges.is_empty() && other.hedges.is_empty();
        plain && self.never_stronger(one.rule, other.rule)
    }

    /// True if each of some conclusions is nowhere stronger than one of the others.
    fn all_below(&self, ones: &[usize], others: &[usize]) -> bool {
        ones.iter().all(|&one| others.iter().any(|&other| self.conclusion_below(one, other)))
    }
}

/// The answer where perhaps no rule fires.
fn with_fallback(output: &Output, answer: Slope) -> Slope {
    let value = match (output.fallback.value, output.universe) {
        (FallbackValue::Middle, Some(universe)) => Some(universe.middle()),
        (FallbackValue::Number(value), _) => Some(value),
        _ => None,
    };
    match value.map(Interval::point) {
        Some(value) if !output.enabled => Slope::fixed(value),
        Some(value) => unknown_slope(answer.value.hull(value)),
        None => unknown_slope(answer.value),
    }
}

fn clamped(output: &Output, answer: Slope) -> Slope {
    match output.universe.filter(|_| output.clamp) {
        Some(u) if !(answer.value.lower() >= u.lower && answer.value.upper() <= u.upper) => {
            answer.larger(Slope::constant(u.lower)).smaller(Slope::constant(u.upper))
        }
        _ => answer,
    }
}

impl System {
    /// How many lifted numbers the membership functions need.
    pub(super) fn room(&self) -> usize {
        let inputs = self.parts.inputs.len();
        let of_inputs = self.parts.inputs.iter().flat_map(|i| &i.terms).map(|t| &t.membership);
        let of_outputs = self.parts.outputs.iter().flat_map(|o| &o.terms);
        let of_outputs = of_outputs.filter_map(|term| match &term.conclusion {
            crate::system::Conclusion::Set { membership, .. } => Some(membership),
            _ => None,
        });
        let room = of_inputs.chain(of_outputs).map(|membership| membership.room(inputs)).max();
        room.unwrap_or(0).max(inputs + 1)
    }

    /// The statements that a rule joins by the minimum, if it does nothing else.
    pub(super) fn plain_minimum(&self, rule: usize) -> u128 {
        let Some(resolved) = self.rules.get(rule) else { return 0 };
        let block = self.parts.blocks.get(resolved.block);
        let minimum = block.is_some_and(|block| {
            block.and.is(TNormKind::Minimum) && block.activation == Activation::General
        });
        let steps = self.program.steps.get(resolved.steps.clone()).unwrap_or_default();
        if !minimum || resolved.weight < 1.0 {
            return 0;
        }
        statements(&self.program, steps).unwrap_or(0)
    }
}

fn statements(program: &Program, steps: &[Step]) -> Option<u128> {
    steps.iter().try_fold(0_u128, |mask, step| match *step {
        Step::Statement(index) if index < 128 && index < program.statements.len() => {
            Some(mask | (1 << index))
        }
        Step::And => Some(mask),
        _ => None,
    })
}

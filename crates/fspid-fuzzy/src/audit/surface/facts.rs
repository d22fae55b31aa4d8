//! The facts of one output.

use alloc::vec::Vec;

use super::field::Field;
use super::objective::{Departure, Image, Secant, SlopeAlong, Value};
use super::options::SurfaceOptions;
use super::symmetry::Mirror;
use super::{AlongInput, Counterexample, Monotone, OutputSurface, Symmetry, coverage, ends};
use crate::audit::Statement;
use crate::audit::search::{self, Effort, Extreme, Magnitude, Objective, maximum, minimum, signs};
use fspid_numeric::scalar::Interval;

/// What the halving of boxes may lose of a share by rounding.
const SHARE_ROUNDING: f64 = 1e-9;
/// Distances between the two points of a counterexample, as shares of the domain.
const STEPS: [f64; 4] = [1e-3, 1e-4, 1e-5, 1e-6];

/// A field, and where and how hard to look at it.
struct Question<'q, 'a> {
    field: &'q mut Field<'a>,
    output: usize,
    domain: &'q [Interval],
    rest: &'q [f64],
    options: &'q SurfaceOptions,
}

pub(super) fn of_output(
    field: &mut Field<'_>,
    output: usize,
    domain: &[Interval],
    rest: &[f64],
    options: &SurfaceOptions,
) -> OutputSurface {
    field.may_be_silent = false;
    let mut question = Question { field, output, domain, rest, options };
    let [least, most] = question.range();
    let at_rest = question.value_at_rest();
    let along = (0..domain.len()).map(|input| question.along(input, at_rest)).collect();
    let exchange = question.exchanges();
    OutputSurface {
        least,
        most,
        at_rest: ends(at_rest),
        along,
        odd: question.symmetry(Image::Opposite, true),
        even: question.symmetry(Image::Opposite, false),
        exchange,
        coverage: coverage::of_output(question.field, output, domain, options),
        may_fall_back: question.field.may_be_silent,
    }
}

/// The smallest and the largest slope of an output along an input.
pub(super) fn slopes(
    field: &mut Field<'_>,
    output: usize,
    input: usize,
    domain: &[Interval],
    options: &SurfaceOptions,
) -> [Extreme; 2] {
    let effort = Effort { tolerance: options.slope_tolerance, boxes: options.boxes };
    let mut slope = SlopeAlong { field, output, input };
    [minimum(&mut slope, domain, effort), maximum(&mut slope, domain, effort)]
}

impl Question<'_, '_> {
    fn value_effort(&self) -> Effort {
        Effort { tolerance: self.options.value_tolerance, boxes: self.options.boxes }
    }

    fn slope_effort(&self) -> Effort {
        Effort { tolerance: self.options.slope_tolerance, boxes: self.options.boxes }
    }

    fn counted(&mut self, extreme: Extreme) -> Extreme {
        self.field.boxes += extreme.boxes;
        extreme
    }

    fn range(&mut self) -> [Extreme; 2] {
        let (effort, domain) = (self.value_effort(), self.domain);
        let mut value = Value { field: self.field, output: self.output };
        let both = [minimum(&mut value, domain, effort), maximum(&mut value, domain, effort)];
        both.map(|extreme| self.counted(extreme))
    }

    fn value_at_rest(&mut self) -> Interval {
        let point: Vec<Interval> = self.rest.iter().copied().map(Interval::point).collect();
        self.field.ask(self.output, &point, None).value
    }

    fn along(&mut self, input: usize, at_rest: Interval) -> AlongInput {
        let (effort, domain) = (self.slope_effort(), self.domain);
        let mut slope = SlopeAlong { field: self.field, output: self.output, input };
        let least = minimum(&mut slope, domain, effort);
        let most = maximum(&mut slope, domain, effort);
        let point: Vec<Interval> = self.rest.iter().copied().map(Interval::point).collect();
        let slope_at_rest = ends(slope.enclose(&point, None));
        let (least_slope, most_slope) = (self.counted(least), self.counted(most));
        let largest = |end: fn([f64; 2]) -> f64, other: fn([f64; 2]) -> f64| {
            (-end(least_slope.bounds)).max(other(most_slope.bounds)).max(0.0)
        };
        let lipschitz = [largest(|b| b[1], |b| b[0]), largest(|b| b[0], |b| b[1])];
        let monotone = self.monotone(input, &least_slope, &most_slope);
        let sector = self.sector(input, at_rest);
        AlongInput { least_slope, most_slope, lipschitz, slope_at_rest, monotone, sector }
    }

    fn monotone(&mut self, input: usize, least: &Extreme, most: &Extreme) -> Monotone {
        let effort = Effort { tolerance: self.options.share_tolerance, boxes: self.options.boxes };
        let mut slope = SlopeAlong { field: self.field, output: self.output, input };
        let shares = signs(&mut slope, self.domain, effort);
        self.field.boxes += shares.boxes;
        let rises = shares.above >= shares.below;
        let (steepest, bounds) =
            if rises { (least, least.bounds.map(|bound| -bound)) } else { (most, most.bounds) };
        let [low, high] = if rises { [bounds[1], bounds[0]] } else { bounds };
        let wrong = if rises { shares.below } else { shares.above };
        let none = high <= 0.0;
        let statement = match (none, self.counterexample(input, &steepest.at, rises)) {
            (true, _) => Statement::Proved,
            (false, Some(counterexample)) => Statement::Refuted(counterexample),
            (false, None) => Statement::Open,
        };
        let share = [(wrong - SHARE_ROUNDING).max(0.0), wrong + shares.open + SHARE_ROUNDING];
        Monotone {
            rises,
            statement,
            worst: [low.max(0.0), high.max(0.0)],
            wrong_share: if none { [0.0; 2] } else { share },
        }
    }

    /// Two points near `at` between which the output surely goes the wrong way.
    fn counterexample(&mut self, input: usize, at: &[f64], rises: bool) -> Option<Counterexample> {
        let side = *self.domain.get(input)?;
        STEPS.iter().find_map(|share| {
            let [mut from, mut to] = [at.to_vec(), at.to_vec()];
            let reach = 0.5 * share * side.width();
            *from.get_mut(input)? = (at.get(input)? - reach).max(side.lower());
            *to.get_mut(input)? = (at.get(input)? + reach).min(side.upper());
            let [before, after] = [&from, &to].map(|point| {
                let cell: Vec<Interval> = point.iter().copied().map(Interval::point).collect();
                self.field.ask(self.output, &cell, None).value
            });
            let change = after - before;
            let wrong = if rises { change.upper() < 0.0 } else { change.lower() > 0.0 };
            wrong.then(|| Counterexample { from, to, change: ends(change) })
        })
    }

    fn sector(&mut self, input: usize, at_rest: Interval) -> [Extreme; 2] {
        let (rest, effort) = (self.rest, self.slope_effort());
        let origin = rest.get(input).copied().unwrap_or(0.0);
        let side = self.domain.get(input).copied().unwrap_or(Interval::ZERO);
        let distances = [side - Interval::point(origin)];
        let value = Value { field: self.field, output: self.output };
        let mut secant = Secant { value, rest, at_rest, input };
        let both =
            [minimum(&mut secant, &distances, effort), maximum(&mut secant, &distances, effort)];
        both.map(|extreme| self.counted(extreme))
    }

    fn exchanges(&mut self) -> Vec<([usize; 2], Symmetry)> {
        let inputs = self.domain.len();
        let pairs = (0..inputs).flat_map(|j| (0..j).map(move |i| [i, j]));
        let alike: Vec<[usize; 2]> =
            pairs.filter(|&[i, j]| self.domain.get(i) == self.domain.get(j)).collect();
        alike.into_iter().map(|pair| (pair, self.symmetry(Image::Exchanged(pair), false))).collect()
    }

    fn symmetry(&mut self, image: Image, odd: bool) -> Symmetry {
        let effort = Effort { tolerance: self.options.slope_tolerance, boxes: self.options.boxes };
        let universe = self.field.firing.system.parts.outputs.get(self.output);
        let middle = universe.and_then(|output| output.universe).map_or(0.0, |u| u.middle());
        let about = odd.then_some(middle);
        let mirror = Mirror { image, domain: self.domain, about };
        if mirror.keeps(&self.field.firing.system.parts, self.output) {
            let at = search::middle(self.domain);
            let departure = Extreme { bounds: [0.0; 2], at, boxes: 0, settled: true };
            return Symmetry { departure, statement: Statement::Proved };
        }
        let half = half(self.domain, image);
        let value = Value { field: self.field, output: self.output };
        let mut departure = Departure { value, domain: self.domain, image, about };
        let departure = maximum(&mut Magnitude(&mut departure), &half, effort);
        let departure = self.counted(departure);
        let [low, high] = departure.bounds;
        let statement = if high <= 0.0 {
            Statement::Proved
        } else if low > 0.0 {
            Statement::Refuted(departure.at.clone())
        } else {
            Statement::Open
        };
        Symmetry { departure, statement }
    }
}

/// Of mirror images one half is enough.
fn half(domain: &[Interval], image: Image) -> Vec<Interval> {
    let mut half = domain.to_vec();
    if let (Image::Opposite, Some(side)) = (image, half.first_mut()) {
        *side = Interval::between(side.lower(), side.midpoint().next_up());
    }
    half
}

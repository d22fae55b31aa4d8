//! Objective functions of the audit's global search: output values, slopes, deviations from symmetry, quotients.

use alloc::collections::BTreeSet;
use alloc::vec::Vec;

use super::super::search::Objective;
use super::field::Field;
use fspid_numeric::scalar::{Interval, Scalar};

/// An output.
pub(super) struct Value<'f, 'a> {
    pub(super) field: &'f mut Field<'a>,
    pub(super) output: usize,
}

impl Value<'_, '_> {
    fn value(&mut self, cell: &[Interval]) -> Interval {
        self.field.ask(self.output, cell, None).value
    }

    fn slope(&mut self, cell: &[Interval], input: usize) -> Interval {
        let [slope] = self.field.ask(self.output, cell, Some(input)).derivative;
        slope
    }
}

impl Objective for Value<'_, '_> {
    fn enclose(&mut self, cell: &[Interval], slopes: Option<&mut [Interval]>) -> Interval {
        let Some(slopes) = slopes else { return self.value(cell) };
        let mut value = None;
        for (input, place) in slopes.iter_mut().enumerate() {
            // Across a side without width nothing changes.
            let flat = cell.get(input).is_none_or(|side| side.is_point());
            let along = (!flat).then_some(input);
            if flat && value.is_some() {
                *place = Interval::ZERO;
                continue;
            }
            let answer = self.field.ask(self.output, cell, along);
            let [slope] = answer.derivative;
            *place = if flat { Interval::ZERO } else { slope };
            value = Some(answer.value);
        }
        value.unwrap_or(Interval::ENTIRE)
    }
}

/// The slope of an output along an input.
pub(super) struct SlopeAlong<'f, 'a> {
    pub(super) field: &'f mut Field<'a>,
    pub(super) output: usize,
    pub(super) input: usize,
}

impl Objective for SlopeAlong<'_, '_> {
    fn enclose(&mut self, cell: &[Interval], _: Option<&mut [Interval]>) -> Interval {
        self.field.slope(self.output, cell, self.input)
    }

    fn has_slopes(&self) -> bool {
        false
    }
}

/// A mirroring of the inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Image {
    /// $x \to 2m - x$ about the middle $m$ of the domain.
    Opposite,
    /// $x_i \leftrightarrow x_j$.
    Exchanged([usize; 2]),
}

impl Image {
    fn of(self, cell: &[Interval], domain: &[Interval]) -> Vec<Interval> {
        match self {
            Self::Opposite => {
                let ends =
                    |side: &Interval| Interval::point(side.lower()) + Interval::point(side.upper());
                cell.iter().zip(domain).map(|(side, whole)| ends(whole) - *side).collect()
            }
            Self::Exchanged([i, j]) => {
                let mut image = cell.to_vec();
                image.swap(i, j);
                image
            }
        }
    }

    /// The input along which the image moves when `input` does.
    pub(super) fn input(self, input: usize) -> usize {
        match self {
            Self::Exchanged([i, j]) if input == i => j,
            Self::Exchanged([i, j]) if input == j => i,
            _ => input,
        }
    }
}

/// $f(x) - f(x')$ or $f(x) + f(x') - 2 f_0$ with the mirror image $x'$ of $x$.
pub(super) struct Departure<'f, 'a> {
    pub(super) value: Value<'f, 'a>,
    pub(super) domain: &'f [Interval],
    pub(super) image: Image,
    /// The output is mirrored too, about this.
    pub(super) about: Option<f64>,
}

impl Objective for Departure<'_, '_> {
    fn enclose(&mut self, cell: &[Interval], slopes: Option<&mut [Interval]>) -> Interval {
        let image = self.image.of(cell, self.domain);
        let (here, there) = (self.value.value(cell), self.value.value(&image));
        for (input, place) in slopes.into_iter().flatten().enumerate() {
            if cell.get(input).is_none_or(|side| side.is_point()) {
                *place = Interval::ZERO;
                continue;
            }
            let here = self.value.slope(cell, input);
            let there = self.value.slope(&image, self.image.input(input));
            // An even number of sign changes adds.
            let opposite = self.image == Image::Opposite;
            let adds = opposite != self.about.is_some();
            *place = if adds { here + there } else { here - there };
        }
        match self.about {
            Some(about) => here + there - Interval::point(2.0 * about),
            None => here - there,
        }
    }
}

/// $\frac{f(r + t e_i) - f(r)}{t}$ as a function of $t$, for a rest point $r$ along input $i$.
///
/// Near $t = 0$ the mean value theorem bounds it by the slopes between.
pub(super) struct Secant<'f, 'a> {
    pub(super) value: Value<'f, 'a>,
    pub(super) rest: &'f [f64],
    pub(super) at_rest: Interval,
    pub(super) input: usize,
}

impl Objective for Secant<'_, '_> {
    fn enclose(&mut self, cell: &[Interval], _: Option<&mut [Interval]>) -> Interval {
        let &[distance] = cell else { return Interval::ENTIRE };
        let mut place: Vec<Interval> = self.rest.iter().copied().map(Interval::point).collect();
        let Some(side) = place.get_mut(self.input) else { return Interval::ENTIRE };
        let rest = *side;
        *side = rest + distance.hull(Interval::ZERO);
        let slope = self.value.field.slope(self.value.output, &place, self.input);
        if distance.contains(0.0) {
            return slope;
        }
        if let Some(side) = place.get_mut(self.input) {
            *side = rest + distance;
        }
        let quotient = (self.value.value(&place) - self.at_rest) / distance;
        quotient.intersection(slope).unwrap_or(quotient)
    }

    fn has_slopes(&self) -> bool {
        false
    }
}

/// How strongly the strongest of some rules acts.
pub(super) struct Coverage<'f, 'a> {
    pub(super) field: &'f mut Field<'a>,
    pub(super) rules: &'f [usize],
}

impl Objective for Coverage<'_, '_> {
    fn enclose(&mut self, cell: &[Interval], slopes: Option<&mut [Interval]>) -> Interval {
        let Some(slopes) = slopes else {
            return self.field.firing.coverage(cell, None, self.rules).value;
        };
        let mut value = Interval::ENTIRE;
        for (input, place) in slopes.iter_mut().enumerate() {
            let strongest = self.field.firing.coverage(cell, Some(input), self.rules);
            [*place] = strongest.derivative;
            value = strongest.value;
        }
        value
    }
}

/// The largest grade of some statements.
pub(super) struct StrongestGrade<'f, 'a> {
    pub(super) field: &'f mut Field<'a>,
    pub(super) statements: &'f BTreeSet<usize>,
}

impl Objective for StrongestGrade<'_, '_> {
    fn enclose(&mut self, cell: &[Interval], slopes: Option<&mut [Interval]>) -> Interval {
        let firing = &mut self.field.firing;
        let mut largest = firing.largest_grade(cell, None, self.statements);
        for (input, place) in slopes.into_iter().flatten().enumerate() {
            largest = firing.largest_grade(cell, Some(input), self.statements);
            [*place] = largest.derivative;
        }
        largest.value
    }
}

impl super::firing::Firing<'_> {
    fn coverage(
        &mut self,
        cell: &[Interval],
        along: Option<usize>,
        rules: &[usize],
    ) -> super::firing::Slope {
        self.fire(cell, along);
        let acting = rules.iter().filter_map(|&rule| self.acting.get(rule).copied());
        acting.reduce(Scalar::larger).unwrap_or(super::firing::Slope::zero())
    }
}

//! Outputs whose numbers are read off places: samples as other tools take them, or narrow slices of
//! the universe where nothing better is known.
//!
//! A place is an interval, a single number for a sample; its grade is enclosed over all of it. The
//! bounds are those of [`Bounds`](super::envelope::Bounds) with sums instead of integrals.

use alloc::vec::Vec;

use super::continuity::{Jumps, continuous_join, jumps_of};
use super::firing::{Firing, Slope, unknown_slope};
use crate::norm::{SNormKind, TNormKind};
use crate::system::{Conclusion, Defuzzifier, Membership, Output, SNorm, Sampling, System, TNorm};
use fspid_numeric::scalar::{Interval, Scalar};

/// Slices of the universe where an integral is enclosed piece by piece.
const SLICES: u32 = 256;
/// Steps towards a bound.
const STEPS: usize = 30;

/// A sample, or a slice.
#[derive(Clone, Debug)]
struct MassPlace {
    at: Interval,
    /// What it counts: 1 or ½ for a sample, the width of a slice.
    weight: Interval,
    /// Grade of each term's set; entire for sets that depend on the inputs.
    grades: Vec<Option<Interval>>,
}

/// An output read off places.
#[derive(Clone, Debug)]
pub(super) struct Masses {
    places: Vec<MassPlace>,
    reading: Reading,
    smooth: bool,
    universe: Interval,
    /// Bounds of the grade of the joined set at each place, and of its slope.
    joined: Vec<Slope>,
    terms: Vec<Slope>,
    /// Conclusions of one term can be joined before the set is cut.
    layered: bool,
}

/// Which number is read off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Reading {
    Centroid,
    Bisector,
    Maximum,
    /// Nothing is known but the universe.
    Unknown,
}

impl Masses {
    pub(super) fn of(system: &System, index: usize) -> Option<Self> {
        let (output, resolved) = (system.parts.outputs.get(index)?, system.outputs.get(index)?);
        let universe = output.universe?;
        let universe = Interval::new(universe.lower, universe.upper)?;
        let sampling = output.defuzzifier.sampling()?;
        let reading = reading(output.defuzzifier, sampling);
        let sets = output.terms.iter().map(|term| match &term.conclusion {
            Conclusion::Set { membership, lower: None } => Some(membership),
            _ => None,
        });
        let sets: Option<Vec<_>> = sets.collect();
        let reading = if sets.is_some() && joins_by_norms(system, output, index) {
            reading
        } else {
            Reading::Unknown
        };
        let spots =
            if reading == Reading::Unknown { Vec::new() } else { spots(universe, sampling) };
        let sets = sets.unwrap_or_default();
        let places = spots.into_iter().map(|(at, weight)| MassPlace {
            at,
            weight,
            grades: sets.iter().map(|set| grade(system, set, at)).collect(),
        });
        let blocks = resolved.conclusions.iter().filter_map(|&c| system.conclusions.get(c));
        let mut blocks = blocks.filter_map(|c| system.parts.blocks.get(c.block));
        let first = blocks.next();
        let alike = blocks.all(|block| first.is_some_and(|f| f.implication == block.implication));
        Some(Self {
            places: places.collect(),
            reading,
            smooth: smooth(system, index),
            universe,
            joined: Vec::new(),
            terms: Vec::new(),
            layered: alike && output.aggregation.is(SNormKind::Maximum),
        })
    }

    /// Bounds of the output's number, its slope, and the least total there may be.
    pub(super) fn enclose(&mut self, firing: &mut Firing<'_>, index: usize) -> (Slope, f64) {
        if self.reading == Reading::Unknown {
            return (unknown_slope(self.universe), 0.0);
        }
        self.join(firing, index);
        match self.reading {
            Reading::Centroid => self.centroid(),
            Reading::Bisector => self.bisector(),
            _ => self.maximum(),
        }
    }

    fn join(&mut self, firing: &mut Firing<'_>, index: usize) {
        self.joined.clear();
        let Some(output) = firing.system.parts.outputs.get(index) else { return };
        if self.layered {
            strongest(firing, index, output, &mut self.terms);
        }
        for place in &self.places {
            let joined = if self.layered {
                join_terms(firing.system, index, place, &self.terms)
            } else {
                join_all(firing.system, index, output, place, &firing.degrees)
            };
            let value = joined.value.larger(Interval::ZERO);
            self.joined.push(if self.smooth {
                Slope { value, ..joined }
            } else {
                unknown_slope(value)
            });
        }
    }

    fn masses(&self) -> impl Iterator<Item = (Interval, Slope)> {
        self.places.iter().zip(&self.joined).map(|(place, joined)| {
            let mass = Slope::fixed(place.weight) * *joined;
            (place.at, mass)
        })
    }

    fn total(&self) -> Interval {
        self.masses().fold(Interval::ZERO, |sum, (_, mass)| sum + mass.value)
    }

    fn centroid(&self) -> (Slope, f64) {
        let total = self.total();
        if total.lower() <= 0.0 {
            return (unknown_slope(self.universe), 0.0);
        }
        let masses: Vec<(Interval, Interval)> =
            self.masses().map(|(at, mass)| (at, mass.value)).collect();
        let centre = average_bounds(&masses, total.lower());
        let centre = centre.intersection(self.universe).unwrap_or(self.universe);
        let turn = self.masses().fold(Interval::ZERO, |sum, (at, mass)| {
            let [slope] = mass.derivative;
            sum + (at - centre) * slope
        });
        (Slope { value: centre, derivative: [turn / total] }, total.lower())
    }

    /// The point is beyond a place where even the largest area before it and the least behind it
    /// leave more behind.
    fn bisector(&self) -> (Slope, f64) {
        let total = self.total();
        let (mut lower, mut upper) = (self.universe.lower(), self.universe.upper());
        let mut before = Interval::ZERO;
        let mut behind: Vec<Interval> = Vec::new();
        let mut sum = Interval::ZERO;
        for (_, mass) in self.masses().collect::<Vec<_>>().into_iter().rev() {
            sum = sum + mass.value;
            behind.push(sum);
        }
        for ((at, mass), behind) in self.masses().zip(behind.iter().rev()) {
            let rest = *behind;
            if before.upper() <= rest.lower() {
                lower = at.lower();
            }
            if before.lower() >= rest.upper() {
                upper = upper.min(at.upper());
            }
            before = before + mass.value;
        }
        let value = Interval::new(lower, upper).unwrap_or(self.universe);
        (unknown_slope(value), total.lower())
    }

    /// Every place whose grade may be the highest.
    fn maximum(&self) -> (Slope, f64) {
        let height = |bound: fn(Interval) -> f64| {
            self.joined.iter().map(move |grade| bound(grade.value)).fold(0.0, f64::max)
        };
        let least = height(Interval::lower);
        let places = self.places.iter().zip(&self.joined);
        let highest = places.filter(|(_, grade)| grade.value.upper() >= least);
        let hull = highest.map(|(place, _)| place.at).reduce(Interval::hull);
        (unknown_slope(hull.unwrap_or(self.universe)), least)
    }
}

/// Bounds of $\sum m_n x_n / \sum m_n$ over all masses and places within bounds.
pub(super) fn average_bounds(masses: &[(Interval, Interval)], least_total: f64) -> Interval {
    let lower = -upper_average(masses.iter().map(|&(at, mass)| (-at, mass)), least_total);
    let upper = upper_average(masses.iter().copied(), least_total);
    Interval::new(lower, upper).unwrap_or(Interval::ENTIRE)
}

/// With the masses that count against a guess $c$ at their least and the others at their most, what
/// is left of the moment over the least total is how far the average may be above $c$.
fn upper_average(
    masses: impl Iterator<Item = (Interval, Interval)> + Clone,
    least_total: f64,
) -> f64 {
    let mut guess = f64::NEG_INFINITY;
    for _ in 0..STEPS {
        let (mut total, mut moment) = (0.0, 0.0);
        for (at, mass) in masses.clone() {
            let chosen = if at.upper() > guess { mass.upper() } else { mass.lower() };
            (total, moment) = (total + chosen, moment + chosen * at.upper());
        }
        let next: f64 = moment / total;
        if !next.is_finite() || next <= guess {
            break;
        }
        guess = next;
    }
    let about = Interval::point(guess);
    let rest = masses.fold(Interval::ZERO, |sum, (at, mass)| {
        let arm = Interval::point(at.upper()) - about;
        sum + arm * mass
    });
    let excess = Interval::point(rest.upper().max(0.0)) / Interval::point(least_total);
    (about + excess).upper()
}

fn reading(defuzzifier: Defuzzifier, sampling: Sampling) -> Reading {
    let exact = sampling == Sampling::Exact;
    match defuzzifier {
        Defuzzifier::Centroid(Sampling::Vertices(_)) => Reading::Unknown,
        Defuzzifier::Centroid(_) => Reading::Centroid,
        Defuzzifier::Bisector(_) if exact => Reading::Bisector,
        Defuzzifier::SmallestOfMaximum(_)
        | Defuzzifier::MeanOfMaximum(_)
        | Defuzzifier::LargestOfMaximum(_)
            if exact =>
        {
            Reading::Maximum
        }
        _ => Reading::Unknown,
    }
}

/// The samples with their weights, or slices with their widths.
fn spots(universe: Interval, sampling: Sampling) -> Vec<(Interval, Interval)> {
    let (count, cells, offset, end_weight) = match sampling {
        Sampling::Endpoints(n) => (n, n - 1, 0.0, 1.0),
        Sampling::Trapezoid(n) => (n, n - 1, 0.0, 0.5),
        Sampling::Midpoint(n) => (n, n, 0.5, 1.0),
        Sampling::LeftEnd(n) => (n, n, 0.0, 1.0),
        Sampling::Exact | Sampling::Vertices(_) => (SLICES, SLICES, f64::NAN, 1.0),
    };
    let ends = [universe.lower(), universe.upper()].map(Interval::point);
    let cell = (ends[1] - ends[0]) / Interval::point(f64::from(cells));
    let at = |n: f64| ends[0] + Interval::point(n) * cell;
    let spot = |n: u32| {
        let number = f64::from(n);
        if offset.is_nan() {
            return (at(number).hull(at(number + 1.0)), cell);
        }
        let weight = if n == 0 || n + 1 == count { end_weight } else { 1.0 };
        (at(number + offset), Interval::point(weight))
    };
    (0..count).map(spot).collect()
}

fn grade(system: &System, set: &Membership, at: Interval) -> Option<Interval> {
    let mut room = alloc::vec![Interval::ZERO; system.room()];
    let grade = set.grade(at, &[], &mut room);
    match set {
        Membership::Shape { .. } => {
            Some(grade.intersection(Interval::UNIT).unwrap_or(Interval::UNIT))
        }
        // It may depend on the inputs.
        Membership::Formula { .. } => None,
    }
}

/// True if all that is concluded is shaped and joined by norms: a formula may make something of nothing.
fn joins_by_norms(system: &System, output: &Output, index: usize) -> bool {
    let conclusions = system.conclusions.iter().filter(|it| it.output == index);
    let mut blocks = conclusions.filter_map(|it| system.parts.blocks.get(it.block));
    matches!(output.aggregation, SNorm::Kind(_))
        && blocks.all(|block| matches!(block.implication, TNorm::Kind(_)))
}

/// True if the joined set cannot jump with the strengths.
fn smooth(system: &System, index: usize) -> bool {
    let (Some(output), Some(resolved)) =
        (system.parts.outputs.get(index), system.outputs.get(index))
    else {
        return false;
    };
    let shapes = output.terms.iter().all(|term| match &term.conclusion {
        Conclusion::Set { membership, .. } => jumps_of(membership) != Jumps::Anywhere,
        _ => false,
    });
    let conclusions = resolved.conclusions.iter().filter_map(|&c| system.conclusions.get(c));
    let mut blocks = conclusions.filter_map(|c| system.parts.blocks.get(c.block));
    let implications = blocks.all(|block| match &block.implication {
        TNorm::Kind(kind) => {
            !matches!(kind, TNormKind::DrasticProduct | TNormKind::NilpotentMinimum)
        }
        TNorm::Formula(_) => false,
    });
    shapes && implications && continuous_join(&output.aggregation)
}

/// The strongest conclusion of each term.
fn strongest(firing: &Firing<'_>, index: usize, output: &Output, terms: &mut Vec<Slope>) {
    terms.clear();
    terms.resize(output.terms.len(), Slope::zero());
    let system = firing.system;
    let conclusions = system.outputs.get(index).map_or(&[][..], |o| &o.conclusions);
    for (term, place) in terms.iter_mut().enumerate() {
        let own: Vec<usize> = conclusions
            .iter()
            .copied()
            .filter(|&c| system.conclusions.get(c).is_some_and(|found| found.term == term))
            .collect();
        *place = firing.strongest(&own, &mut Vec::new());
    }
}

fn join_terms(system: &System, index: usize, place: &MassPlace, terms: &[Slope]) -> Slope {
    let first = system.outputs.get(index).and_then(|o| o.conclusions.first());
    let block = first.and_then(|&c| system.parts.blocks.get(system.conclusions.get(c)?.block));
    let Some(block) = block else { return Slope::zero() };
    let each = terms.iter().zip(&place.grades).map(|(&strength, grade)| {
        let grade = Slope::fixed(grade.unwrap_or(Interval::UNIT));
        if strength.value.upper() > 0.0 {
            block.implication.apply(strength, grade)
        } else {
            Slope::zero()
        }
    });
    each.fold(Slope::zero(), Scalar::larger)
}

fn join_all(
    system: &System,
    index: usize,
    output: &Output,
    place: &MassPlace,
    degrees: &[Slope],
) -> Slope {
    let mut joined = Slope::zero();
    for &position in system.outputs.get(index).map_or(&[][..], |o| &o.conclusions) {
        let (Some(resolved), Some(&degree)) =
            (system.conclusions.get(position), degrees.get(position))
        else {
            continue;
        };
        let Some(block) = system.parts.blocks.get(resolved.block) else { continue };
        let grade = place.grades.get(resolved.term).copied().flatten().unwrap_or(Interval::UNIT);
        let shaped = block.implication.apply(degree, Slope::fixed(grade));
        joined = output.aggregation.apply(joined, shaped);
    }
    joined
}

//! The joined set as a function that can be asked with any kind of number.

use alloc::vec;
use alloc::vec::Vec;

use super::super::norms::{SNorm, TNorm};
use super::super::parts::{Conclusion, Membership};
use super::actors::Activation;
use super::sampled::Concluded;
use crate::norm::{SNormKind, TNormKind};
use fspid_numeric::quadrature::Curve;
use fspid_numeric::scalar::{Interval, Jet, Scalar};

/// Parameters and variables that need no heap.
const ROOM: usize = 8;

/// The joined set, scaled.
#[derive(Clone, Copy)]
pub(super) struct JoinedCurve<'a> {
    concluded: Concluded<'a>,
    /// Activations that fire, those of one term from strong to weak.
    order: &'a [usize],
    /// A power of two.
    scale: f64,
}

impl<'a> JoinedCurve<'a> {
    /// `order` is memory for as many numbers as there are actors.
    pub(super) fn new(concluded: Concluded<'a>, order: &'a mut Vec<usize>, scale: f64) -> Self {
        let Concluded { actors, levels, .. } = concluded;
        let strength = |&own: &usize| levels.get(own).map_or(0.0, |level| level.strength);
        let term = |&own: &usize| actors.list().get(own).map_or(0, |actor| actor.term);
        order.clear();
        order.extend((0..actors.len()).filter(|own| strength(own) > 0.0));
        order.sort_unstable_by(|a, b| {
            let stronger = strength(b).total_cmp(&strength(a));
            term(a).cmp(&term(b)).then(stronger).then(a.cmp(b))
        });
        Self { concluded, order, scale }
    }

    /// An actor and what implication leaves of its set.
    fn implied<S: Scalar, J: Joining<S>>(&self, own: usize, x: S) -> Option<(&'a Activation, S)> {
        let Concluded { output, actors, levels, inputs } = self.concluded;
        let (actor, level) = (actors.list().get(own)?, levels.get(own)?);
        match &output.terms.get(actor.term)?.conclusion {
            Conclusion::Set { membership, .. } => {
                let grade = J::grade(grade(membership, x, inputs));
                Some((actor, J::imply(&actor.implication, S::constant(level.strength), grade)))
            }
            _ => None,
        }
    }

    fn joined<S: Scalar, J: Joining<S>>(&self, x: S) -> S {
        let norm = &self.concluded.output.aggregation;
        let (mut joined, mut last): (Option<S>, Option<(&Activation, S)>) = (None, None);
        for (actor, grade) in self.order.iter().filter_map(|&own| self.implied::<S, J>(own, x)) {
            last = match last {
                Some((before, strong)) if before == actor => {
                    Some((actor, J::aggregate_ordered(norm, strong, grade)))
                }
                Some((_, done)) => {
                    joined = Some(joined.map_or(done, |joined| J::aggregate(norm, joined, done)));
                    Some((actor, grade))
                }
                None => Some((actor, begin(norm, grade))),
            };
        }
        let joined = match (joined, last) {
            (Some(joined), Some((_, done))) => J::aggregate(norm, joined, done),
            (None, Some((_, done))) => done,
            (_, None) => S::zero(),
        };
        joined * S::constant(self.scale)
    }

    /// All grades in a part. No norm of the family falls with its arguments, so that the grades at
    /// the ends of theirs are enough. The equations alone say too much where an argument stands in
    /// them twice: $a + b (1 - a)$ of a set that jumps would reach above every grade it has.
    pub(super) fn range(&self, x: Interval) -> Interval {
        self.joined::<Interval, Rising>(x)
    }

    /// True if the curve is proved to have one height in a part, whatever rounding makes of its slope.
    pub(super) fn is_flat(&self, x: Interval) -> bool {
        let norm = &self.concluded.output.aggregation;
        let mut joined: Option<Height> = None;
        for &own in self.order {
            let Some(next) = self.height(own, x) else { return false };
            joined = Some(joined.map_or(next, |joined| joined.join(norm, next)));
        }
        joined.is_some_and(|joined| joined.constant)
    }

    /// What implication leaves of a set in a part.
    fn height(&self, own: usize, x: Interval) -> Option<Height> {
        let Concluded { output, actors, levels, inputs } = self.concluded;
        let (actor, level) = (actors.list().get(own)?, levels.get(own)?);
        let Conclusion::Set { membership, .. } = &output.terms.get(actor.term)?.conclusion else {
            return None;
        };
        let series = grade(membership, Jet::<Interval, 2>::variable(x), inputs);
        let implied = imply(&actor.implication, Jet::constant(level.strength), series);
        let level_slope = |series: &Jet<Interval, 2>| series.coefficients()[1].magnitude() <= 0.0;
        let grade = series.value().intersection(Interval::UNIT)?;
        let strength = Interval::point(level.strength);
        let full = level.strength >= 1.0 && grade.lower() >= 1.0;
        let cut = actor.implication.is(TNormKind::Minimum) && grade.lower() >= level.strength;
        Some(Height {
            value: Rising::imply(&actor.implication, strength, grade),
            constant: cut || level_slope(&series) || level_slope(&implied),
            one: full && matches!(actor.implication, TNorm::Kind(_)),
        })
    }
}

impl Curve for JoinedCurve<'_> {
    fn at<S: Scalar>(&self, x: S) -> S {
        self.joined::<S, Plain>(x)
    }
}

/// What is known of how high a set is in a part.
#[derive(Clone, Copy)]
struct Height {
    value: Interval,
    /// The same everywhere in the part.
    constant: bool,
    /// 1 everywhere, in which most norms take up whatever is joined to it.
    one: bool,
}

impl Height {
    fn join(self, norm: &SNorm, other: Self) -> Self {
        let least = self.value.lower().min(other.value.lower());
        let sum = (self.value.lower() + other.value.lower()).next_down();
        let fills = match norm {
            SNorm::Kind(SNormKind::UnboundedSum) | SNorm::Formula(_) => false,
            SNorm::Kind(SNormKind::DrasticSum) if least > 0.0 => true,
            SNorm::Kind(SNormKind::BoundedSum | SNormKind::NormalizedSum) if sum >= 1.0 => true,
            SNorm::Kind(SNormKind::NilpotentMaximum) if sum > 1.0 => true,
            SNorm::Kind(_) => self.one || other.one,
        };
        let wins = |one: Self, other: Self| {
            let above = one.value.lower() >= other.value.upper();
            norm.is(SNormKind::Maximum) && one.constant && above
        };
        // What is nowhere above 0 adds nothing.
        let alone = |one: Self, other: Self| {
            matches!(norm, SNorm::Kind(_)) && one.constant && other.value.upper() <= 0.0
        };
        let either = |of: &dyn Fn(Self, Self) -> bool| of(self, other) || of(other, self);
        Self {
            value: Rising::aggregate(norm, self.value, other.value),
            constant: fills || (self.constant && other.constant) || either(&wins) || either(&alone),
            one: fills,
        }
    }
}

/// How grades are implied and joined.
trait Joining<S> {
    /// The grade of a set.
    fn grade(grade: S) -> S;
    /// See [`imply`].
    fn imply(norm: &TNorm, strength: S, grade: S) -> S;
    /// See [`aggregate`].
    fn aggregate(norm: &SNorm, joined: S, grade: S) -> S;
    /// See [`aggregate_ordered`].
    fn aggregate_ordered(norm: &SNorm, strong: S, weak: S) -> S;
}

/// By the equations, for every kind of number.
enum Plain {}

impl<S: Scalar> Joining<S> for Plain {
    fn grade(grade: S) -> S {
        grade
    }

    fn imply(norm: &TNorm, strength: S, grade: S) -> S {
        imply(norm, strength, grade)
    }

    fn aggregate(norm: &SNorm, joined: S, grade: S) -> S {
        aggregate(norm, joined, grade)
    }

    fn aggregate_ordered(norm: &SNorm, strong: S, weak: S) -> S {
        aggregate_ordered(norm, strong, weak)
    }
}

/// By the ends of intervals.
enum Rising {}

impl Joining<Interval> for Rising {
    fn grade(grade: Interval) -> Interval {
        grade.intersection(Interval::UNIT).unwrap_or(grade)
    }

    fn imply(norm: &TNorm, strength: Interval, grade: Interval) -> Interval {
        let of = |strength, grade| imply(norm, strength, grade);
        match norm {
            TNorm::Kind(_) => rising(of, Interval::UNIT, [strength, grade]),
            TNorm::Formula(_) => of(strength, grade),
        }
    }

    fn aggregate(norm: &SNorm, joined: Interval, grade: Interval) -> Interval {
        let of = |joined, grade| aggregate(norm, joined, grade);
        sum_of(norm).map_or_else(|| of(joined, grade), |sum| rising(of, sum, [joined, grade]))
    }

    fn aggregate_ordered(norm: &SNorm, strong: Interval, weak: Interval) -> Interval {
        let of = |strong, weak| aggregate_ordered(norm, strong, weak);
        sum_of(norm).map_or_else(|| of(strong, weak), |sum| rising(of, sum, [strong, weak]))
    }
}

/// What a norm may make of grades; nothing for a formula, which may also fall.
fn sum_of(norm: &SNorm) -> Option<Interval> {
    match norm {
        SNorm::Kind(SNormKind::UnboundedSum) => Some(Interval::between(0.0, 2.0)),
        SNorm::Kind(_) => Some(Interval::UNIT),
        SNorm::Formula(_) => None,
    }
}

/// All values of a norm that falls with neither argument and keeps within `values`. That is known
/// of grades up to 1; sums of more than that are left to the equation.
fn rising(
    norm: impl Fn(Interval, Interval) -> Interval,
    values: Interval,
    [left, right]: [Interval; 2],
) -> Interval {
    let direct = norm(left, right);
    if !(Interval::UNIT.encloses(left) && Interval::UNIT.encloses(right)) {
        return direct;
    }
    let at =
        |end: fn(Interval) -> f64| norm(Interval::point(end(left)), Interval::point(end(right)));
    let ends = at(Interval::lower).hull(at(Interval::upper));
    let value = direct.intersection(ends).unwrap_or(direct);
    value.intersection(values).unwrap_or(value)
}

/// What implication leaves of a grade; the strength is above 0.
///
/// The norms of the family are arranged to keep identities to the last bit, for which they choose
/// between values that are equal but for rounding. Here such choices would look like kinks
/// everywhere, so the same functions are written without them.
fn imply<S: Scalar>(norm: &TNorm, strength: S, grade: S) -> S {
    let product = strength * grade;
    match norm {
        TNorm::Kind(TNormKind::EinsteinProduct) => {
            product / (S::one() + (S::one() - strength) * (S::one() - grade))
        }
        TNorm::Kind(TNormKind::HamacherProduct) => {
            product / (strength + grade * (S::one() - strength))
        }
        TNorm::Kind(TNormKind::BoundedDifference) => {
            (grade - (S::one() - strength)).larger(S::zero())
        }
        _ => norm.apply(strength, grade),
    }
}

/// What joining makes of the first grade.
fn begin<S: Scalar>(norm: &SNorm, grade: S) -> S {
    match norm {
        SNorm::Kind(_) => grade,
        SNorm::Formula(_) => norm.apply(S::zero(), grade),
    }
}

/// What joining makes of two grades.
fn aggregate<S: Scalar>(norm: &SNorm, joined: S, grade: S) -> S {
    let sum = joined + grade;
    match norm {
        SNorm::Kind(SNormKind::AlgebraicSum) => joined + grade * (S::one() - joined),
        SNorm::Kind(SNormKind::EinsteinSum) => sum / (S::one() + joined * grade),
        SNorm::Kind(SNormKind::BoundedSum | SNormKind::NormalizedSum) => sum.smaller(S::one()),
        SNorm::Kind(SNormKind::UnboundedSum) => sum,
        _ => norm.apply(joined, grade),
    }
}

/// What joining makes of two grades of one set, of which the weaker is nowhere above the stronger:
/// to ask which is larger would be a kink wherever both follow the set.
fn aggregate_ordered<S: Scalar>(norm: &SNorm, strong: S, weak: S) -> S {
    let rest = S::one() - strong;
    match norm {
        SNorm::Kind(SNormKind::DrasticSum) => S::zero().if_less(weak, S::one(), strong),
        SNorm::Kind(SNormKind::NilpotentMaximum) => weak.if_less(rest, strong, S::one()),
        SNorm::Kind(SNormKind::HamacherSum) => {
            let both = (S::one() - weak * strong).larger(S::constant(f64::MIN_POSITIVE));
            strong + weak * rest * (rest / both)
        }
        _ => aggregate(norm, strong, weak),
    }
}

fn grade<S: Scalar>(membership: &Membership, x: S, inputs: &[f64]) -> S {
    match membership {
        Membership::Shape { kind, params, height } => {
            let grade = with_room(params.len(), |room| kind.grade(S::lift(params, room), x));
            if *height < 1.0 { grade * S::constant(*height) } else { grade }
        }
        Membership::Formula { formula, height } => {
            let grade = with_room(inputs.len() + 1, |room| {
                let variables = [x].into_iter().chain(inputs.iter().map(|&v| S::constant(v)));
                room.iter_mut().zip(variables).for_each(|(place, variable)| *place = variable);
                formula.evaluate(room).unit()
            });
            if *height < 1.0 { grade * S::constant(*height) } else { grade }
        }
    }
}

/// Calls with so much room; from the heap only if it is more than usual.
fn with_room<S: Scalar>(count: usize, call: impl FnOnce(&mut [S]) -> S) -> S {
    let mut usual = [S::zero(); ROOM];
    match usual.get_mut(..count) {
        Some(room) => call(room),
        None => call(&mut vec![S::zero(); count]),
    }
}

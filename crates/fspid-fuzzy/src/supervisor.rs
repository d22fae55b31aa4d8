//! The fuzzy supervisor: error and change of error in, increments of the three gains out.
//!
//! Mamdani inference as in the paper: Gaussian input sets whose neighbours cross at 0.5, `min` for
//! *and* and for implication, `max` over the rules of one label, centroid. Inputs and outputs have
//! the same half range. Or rules that conclude numbers in place of labels, over triangular sets:
//! [`NumberTable`]. Or no rules at all, but a small neural network: [`Network`].

use crate::centroid::{centroid, exact};
use crate::consequents::{Consequents, Firing};
use crate::defuzzifier::Defuzzifier;
use crate::error::FuzzyError;
use crate::inference::{Increments, Inference, InferenceError};
use crate::label::LABEL_COUNT;
use crate::membership::{Gaussian, SIGMA_PER_SPACING, Shape};
use crate::network::Network;
use crate::number_table::{self, NumberTable};
use crate::rule_table::{Output, RuleTable};
use fspid_numeric::Real;
#[cfg(feature = "batch")]
use fspid_numeric::lanes::Lanes;
use fspid_numeric::lanes::{One, Two};

/// Half ranges outside this interval would overflow or underflow inside.
const RANGE_LIMITS: core::ops::RangeInclusive<f64> = 1e-100..=1e100;
/// Half ranges that a supervisor may have with numbers of 32 bits; outside they would overflow or underflow inside.
pub const RANGE_LIMITS_F32: core::ops::RangeInclusive<f64> = 1e-12..=1e12;

/// What to do with an input beyond the half range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum OutOfRange {
    /// Move it to the nearest end of the range.
    #[default]
    Clamp,
    /// Evaluate it as it is; where every rule has underflowed, answer as for the clamped input. With
    /// rules that conclude numbers the outermost sets are level beyond the range, and so is a network, so
    /// that the answer is that for the clamped input everywhere.
    Evaluate,
    /// Refuse it.
    Error,
}

impl OutOfRange {
    /// All policies.
    pub const ALL: [Self; 3] = [Self::Clamp, Self::Evaluate, Self::Error];

    /// Name in files and options.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Clamp => "clamp",
            Self::Evaluate => "evaluate",
            Self::Error => "error",
        }
    }
}

/// The fuzzy supervisor. Immutable; building it may fail, and so may an inference that is asked to
/// refuse inputs out of range, but nothing else.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Supervisor<R> {
    rules: Rules<R>,
    /// Centre and sigma of each input set; of a triangle centre and half the base.
    sets: [[R; 2]; LABEL_COUNT],
    range: R,
    spacing: R,
    defuzzifier: Defuzzifier,
    out_of_range: OutOfRange,
}

/// The numbers of a supervisor, as one that was built has them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupervisorNumbers<R> {
    /// Centre and sigma of each input set; of a triangle centre and half the base.
    pub sets: [[R; 2]; LABEL_COUNT],
    /// Half range of inputs and outputs.
    pub range: R,
    /// Distance of the sets' centres.
    pub spacing: R,
    /// The rule for the centre of gravity.
    pub defuzzifier: Defuzzifier,
    /// What happens to an input beyond the range.
    pub out_of_range: OutOfRange,
}

/// What the rules conclude.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(
    clippy::large_enum_variant,
    reason = "there is no heap, and a supervisor is built once and then borrowed"
)]
enum Rules<R> {
    Labels([Consequents; 3]),
    Numbers(NumberTable<R>),
    Network(Network<R>),
}

/// What has the same equations in every lane.
#[cfg(feature = "batch")]
pub(crate) enum Beside<'a, R> {
    /// Rules that conclude labels.
    Labels(&'a [Consequents; 3]),
    /// A network.
    Network(&'a Network<R>),
}

impl<R: Real> Supervisor<R> {
    /// A supervisor with `table` over `[-range, range]` for both inputs and all outputs.
    ///
    /// # Errors
    /// [`FuzzyError::Range`] for a range that is not finite and positive (or absurdly small or
    /// large), [`FuzzyError::SampleCount`] for a centroid without a usable number of samples.
    pub fn new(
        table: &RuleTable,
        range: R,
        defuzzifier: Defuzzifier,
        out_of_range: OutOfRange,
    ) -> Result<Self, FuzzyError> {
        let rules = Rules::Labels(Output::ALL.map(|output| Consequents::new(table.grid(output))));
        let defuzzifier = defuzzifier.checked()?;
        let width = R::from_f64(SIGMA_PER_SPACING);
        Self::built(rules, range, width, defuzzifier, out_of_range)
    }

    /// A supervisor whose rules conclude numbers, over `[-range, range]` for both inputs; they lie within
    /// the range as the answers of labels do, so that factors behind the supervisor mean the same.
    ///
    /// # Errors
    /// [`FuzzyError::Range`] as for [`new`](Self::new), [`FuzzyError::Number`] for a number beyond the
    /// range.
    pub fn of_numbers(
        table: &NumberTable<R>,
        range: R,
        out_of_range: OutOfRange,
    ) -> Result<Self, FuzzyError> {
        let rules = Rules::Numbers(*table);
        let built = Self::built(rules, range, R::ONE, Defuzzifier::Exact, out_of_range)?;
        table.check_within(range)?;
        Ok(built)
    }

    /// A supervisor that is a network, over `[-range, range]` for both inputs; its answers lie within the range as
    /// those of rules do.
    ///
    /// # Errors
    /// [`FuzzyError::Range`] as for [`new`](Self::new).
    pub fn of_network(
        network: &Network<R>,
        range: R,
        out_of_range: OutOfRange,
    ) -> Result<Self, FuzzyError> {
        let rules = Rules::Network(*network);
        Self::built(rules, range, R::ONE, Defuzzifier::Exact, out_of_range)
    }

    /// A supervisor of labels as a constant, of the [numbers](Self::parts) of one that was built; nothing is checked.
    #[must_use]
    pub const fn new_unchecked(table: &RuleTable, parts: SupervisorNumbers<R>) -> Self {
        let [kp, ki, kd] = Output::ALL;
        let grids = [table.grid(kp), table.grid(ki), table.grid(kd)];
        let [kp, ki, kd] = grids;
        let sorted = [Consequents::new(kp), Consequents::new(ki), Consequents::new(kd)];
        Self::of_parts(Rules::Labels(sorted), parts)
    }

    /// As [`new_unchecked`](Self::new_unchecked) for rules that conclude numbers.
    #[must_use]
    pub const fn of_numbers_unchecked(table: NumberTable<R>, parts: SupervisorNumbers<R>) -> Self {
        Self::of_parts(Rules::Numbers(table), parts)
    }

    /// As [`new_unchecked`](Self::new_unchecked) for a network.
    #[must_use]
    pub const fn of_network_unchecked(network: Network<R>, parts: SupervisorNumbers<R>) -> Self {
        Self::of_parts(Rules::Network(network), parts)
    }

    const fn of_parts(rules: Rules<R>, parts: SupervisorNumbers<R>) -> Self {
        let SupervisorNumbers { sets, range, spacing, defuzzifier, out_of_range } = parts;
        Self { rules, sets, range, spacing, defuzzifier, out_of_range }
    }

    /// Everything but the rules, in numbers.
    pub fn parts(&self) -> SupervisorNumbers<R> {
        let Self { rules: _, sets, range, spacing, defuzzifier, out_of_range } = *self;
        SupervisorNumbers { sets, range, spacing, defuzzifier, out_of_range }
    }

    /// A supervisor whose sets have this width in spacings.
    fn built(
        rules: Rules<R>,
        range: R,
        width: R,
        defuzzifier: Defuzzifier,
        out_of_range: OutOfRange,
    ) -> Result<Self, FuzzyError> {
        let found = range.to_f64();
        let limits =
            if R::MIN_POSITIVE.to_f64() > 1e-100 { RANGE_LIMITS_F32 } else { RANGE_LIMITS };
        if !limits.contains(&found) {
            return Err(FuzzyError::Range { found });
        }
        let spacing = range / R::from_f64(3.0);
        let width = spacing * width;
        let mut sets = [[R::ZERO, width]; LABEL_COUNT];
        for (steps, set) in (-3_i8..).zip(&mut sets) {
            *set = [spacing * R::from_f64(f64::from(steps)), width];
        }
        Ok(Self { rules, sets, range, spacing, defuzzifier, out_of_range })
    }

    /// Half range of inputs and outputs.
    #[inline]
    pub fn range(&self) -> R {
        self.range
    }

    /// Centre and sigma of the Gaussian input sets, from `NB` to `PB`; where rules conclude numbers, centre
    /// of the triangles and their distance. Of no meaning for a network, which has no sets.
    pub fn sets(&self) -> &[[R; 2]; LABEL_COUNT] {
        &self.sets
    }

    /// The rules; `None` where they conclude numbers, and for a network.
    pub fn table(&self) -> Option<RuleTable> {
        match &self.rules {
            Rules::Labels(consequents) => {
                Some(RuleTable::new(consequents.each_ref().map(Consequents::grid)))
            }
            Rules::Numbers(_) | Rules::Network(_) => None,
        }
    }

    /// The numbers that the rules conclude; `None` where they conclude labels, and for a network.
    pub fn numbers(&self) -> Option<&NumberTable<R>> {
        match &self.rules {
            Rules::Labels(_) | Rules::Network(_) => None,
            Rules::Numbers(table) => Some(table),
        }
    }

    /// The network; `None` where there are rules.
    pub fn network(&self) -> Option<&Network<R>> {
        match &self.rules {
            Rules::Labels(_) | Rules::Numbers(_) => None,
            Rules::Network(network) => Some(network),
        }
    }

    /// True where rules conclude labels; without them the answer beyond the range is that at its border.
    pub fn has_labels(&self) -> bool {
        match &self.rules {
            Rules::Labels(_) => true,
            Rules::Numbers(_) | Rules::Network(_) => false,
        }
    }

    /// The rule for the centre of gravity; of no meaning where rules do not conclude labels.
    pub fn defuzzifier(&self) -> Defuzzifier {
        self.defuzzifier
    }

    /// What happens to an input beyond the range.
    #[inline]
    pub fn out_of_range(&self) -> OutOfRange {
        self.out_of_range
    }

    /// Grades of an input in its seven sets, from `NB` to `PB`; zeros for a network, which has none.
    pub fn grades(&self, input: R) -> [R; LABEL_COUNT] {
        match &self.rules {
            Rules::Labels(_) => self.sets.map(|set| Gaussian::grade(&set, input)),
            Rules::Numbers(_) => {
                let input = input.limited(-self.range, self.range) / self.spacing;
                [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0]
                    .map(|step| number_table::triangle(input, R::from_f64(step)))
            }
            Rules::Network(_) => [R::ZERO; LABEL_COUNT],
        }
    }

    /// Increments of the gains for an error and its change.
    ///
    /// # Errors
    /// [`InferenceError`] for an input that is not finite, and under [`OutOfRange::Error`] for one
    /// beyond the range.
    #[inline]
    pub fn infer(&self, error: R, change: R) -> Result<Inference<R>, InferenceError> {
        if self.holds(error) && self.holds(change) {
            return Ok(self.infer_inside(error, change));
        }
        self.infer_outside(error, change)
    }

    /// True for an input within the range.
    #[inline]
    pub(crate) fn holds(&self, input: R) -> bool {
        input.abs() <= self.range
    }

    /// The answer within the range, where some rule always fires at 0.5 or nearly so.
    fn infer_inside(&self, error: R, change: R) -> Inference<R> {
        let delta = match &self.rules {
            Rules::Labels(consequents) => self.concluded(consequents, error, change),
            Rules::Numbers(table) => self.interpolated(table, error, change),
            Rules::Network(network) => {
                let [kp, ki, kd] = network.increments(self.range, [error, change]);
                Increments { kp, ki, kd }
            }
        };
        Inference { delta, clamped: false, underflowed: false }
    }

    /// Increments by numbers, within the range.
    #[inline]
    pub(crate) fn interpolated(
        &self,
        table: &NumberTable<R>,
        error: R,
        change: R,
    ) -> Increments<R> {
        let last = R::from_f64(3.0);
        // The quotient of the range may be rounded beyond three.
        let [error, change] = [error, change].map(|x| (x / self.spacing).limited(-last, last));
        table.interpolated(error, change)
    }

    /// Increments by labels, within the range.
    #[inline(always)]
    fn concluded(&self, consequents: &[Consequents; 3], error: R, change: R) -> Increments<R> {
        let mut grades = self.exponents(error, change);
        for grade in &mut grades.0 {
            // No input is more than six spacings from the centre of a set: these are -99.9 to 0.
            *grade = R::exp_inside_of(*grade);
        }
        self.increments(consequents, &grades)
    }

    #[cold]
    fn infer_outside(&self, error: R, change: R) -> Result<Inference<R>, InferenceError> {
        self.refuse_any(error, change)?;
        let evaluates = self.out_of_range == OutOfRange::Evaluate;
        if evaluates && let Rules::Labels(consequents) = &self.rules {
            let mut grades = self.exponents(error, change);
            for grade in &mut grades.0 {
                *grade = R::exp_of(*grade);
            }
            // Below the normal range the quotient of moments would lose its digits, and further out
            // be 0/0.
            if grades.strongest_rule() >= R::MIN_POSITIVE {
                let delta = self.increments(consequents, &grades);
                return Ok(Inference { delta, clamped: false, underflowed: false });
            }
        }
        let ends = |input: R| input.limited(-self.range, self.range);
        let inference = self.infer_inside(ends(error), ends(change));
        let underflowed = evaluates && self.has_labels();
        Ok(Inference { clamped: !evaluates, underflowed, ..inference })
    }

    /// An error for the first of two inputs that has no answer.
    pub(crate) fn refuse_any(&self, error: R, change: R) -> Result<(), InferenceError> {
        self.refuse("error", error)?;
        self.refuse("change", change)
    }

    fn refuse(&self, input: &'static str, value: R) -> Result<(), InferenceError> {
        let allowed = value.is_finite()
            && (self.out_of_range != OutOfRange::Error || value.abs() <= self.range);
        if allowed {
            return Ok(());
        }
        Err(InferenceError { input, found: value.to_f64(), range: self.range.to_f64() })
    }

    /// What the grades of two inputs are the exponentials of.
    #[inline(always)]
    fn exponents(&self, error: R, change: R) -> Grades<R> {
        let mut exponents = Grades([One(R::ZERO); 2 * LABEL_COUNT]);
        let (of_change, of_error) = exponents.0.split_at_mut(LABEL_COUNT);
        for (set, (of_change, of_error)) in self.sets.iter().zip(of_change.iter_mut().zip(of_error))
        {
            *of_change = Gaussian::exponent(*set, One(change));
            *of_error = Gaussian::exponent(*set, One(error));
        }
        exponents
    }

    /// Increments of the gains for grades of which some make a rule fire.
    #[inline(always)]
    fn increments(&self, consequents: &[Consequents; 3], grades: &Grades<R>) -> Increments<R> {
        let [c0, c1, c2, c3, c4, c5, c6, e0, e1, e2, e3, e4, e5, e6] = grades.0;
        let firing = Firing::new(&[e0, e1, e2, e3, e4, e5, e6], &[c0, c1, c2, c3, c4, c5, c6]);
        let [kp, ki, kd] = consequents;
        let (kp, ki, kd) = (kp.strengths(&firing), ki.strengths(&firing), kd.strengths(&firing));
        if self.defuzzifier != Defuzzifier::Exact {
            return self.sampled(&[kp, ki, kd]);
        }
        // Two outputs side by side in a vector of the oldest x86-64, without a way through memory.
        let beside = |label: usize| Two(kp[label].0, ki[label].0);
        let two = [beside(0), beside(1), beside(2), beside(3), beside(4), beside(5), beside(6)];
        let Two(kp, ki) = exact(&two, Two(R::ZERO, R::ZERO)) * Two(self.spacing, self.spacing);
        let One(kd) = exact(&kd, One(R::ZERO)) * One(self.spacing);
        Increments { kp, ki, kd }
    }

    /// What is evaluated side by side; `None` where rules conclude numbers, which are looked up.
    #[cfg(feature = "batch")]
    #[inline]
    pub(crate) fn beside(&self) -> Option<Beside<'_, R>> {
        match &self.rules {
            Rules::Labels(consequents) => Some(Beside::Labels(consequents)),
            Rules::Numbers(_) => None,
            Rules::Network(network) => Some(Beside::Network(network)),
        }
    }

    /// As within [`infer_inside`](Self::infer_inside), in each lane.
    #[cfg(feature = "batch")]
    #[inline(always)]
    pub(crate) fn increments_in_lanes<L: Lanes<Number = R>>(
        &self,
        beside: &Beside<'_, R>,
        error: L,
        change: L,
    ) -> [L; 3] {
        let consequents = match beside {
            Beside::Labels(consequents) => consequents,
            Beside::Network(network) => {
                return network.increments_in_lanes(self.range, [error, change]);
            }
        };
        let (mut error_grades, mut change_grades) = ([error; LABEL_COUNT], [change; LABEL_COUNT]);
        for (grade, set) in error_grades.iter_mut().zip(&self.sets) {
            *grade = R::exp_inside_of(Gaussian::exponent(*set, error));
        }
        for (grade, set) in change_grades.iter_mut().zip(&self.sets) {
            *grade = R::exp_inside_of(Gaussian::exponent(*set, change));
        }
        let firing = Firing::new(&error_grades, &change_grades);
        let mut increments = [error; 3];
        for (increment, consequents) in increments.iter_mut().zip(*consequents) {
            let centre =
                centroid(self.defuzzifier, &consequents.strengths(&firing), error.same(R::ZERO));
            *increment = centre * error.same(self.spacing);
        }
        increments
    }

    /// Increments by a sampled centroid.
    #[inline(never)]
    fn sampled(&self, strengths: &[[One<R>; LABEL_COUNT]; 3]) -> Increments<R> {
        let [kp, ki, kd] = strengths.each_ref().map(|strengths| {
            let One(centre) = centroid(self.defuzzifier, strengths, One(R::ZERO));
            centre * self.spacing
        });
        Increments { kp, ki, kd }
    }
}

/// Grades of a change of the error in its seven sets, then those of the error.
struct Grades<R>([One<R>; 2 * LABEL_COUNT]);

impl<R: Real> Grades<R> {
    /// Strength of the rule that joins the two strongest grades.
    fn strongest_rule(&self) -> R {
        let strongest = |grades: &[One<R>]| {
            grades.iter().fold(R::ZERO, |strongest, &One(grade)| strongest.larger(grade))
        };
        let (change, error) = self.0.split_at(LABEL_COUNT);
        strongest(error).smaller(strongest(change))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::label::Label;
    use crate::rule_table::Grid;

    #[test]
    fn a_supervisor_tells_the_rules_and_choices_it_was_built_of() {
        // Each label alone in some grid, and all of them in rows that are not in their order.
        let mixed = Grid::parse(
            "PB NB ZO PM NS NM PS\nZO ZO ZO ZO ZO ZO ZO\nNB NM NS ZO PS PM PB\nPB PM PS ZO NS NM NB\n\
             NS PS NS PS NS PS NS\nPM NM PM NM PM NM PM\nNB PB NB PB NB PB NB\n",
        );
        let mixed = mixed.expect("seven rows of seven");
        for label in Label::ALL {
            let alone = Grid::new([[label; LABEL_COUNT]; LABEL_COUNT]);
            let table = RuleTable::new([mixed, alone, mixed.mirrored()]);
            let (rule, policy) = (Defuzzifier::Midpoint(100), OutOfRange::Error);
            let supervisor = Supervisor::new(&table, 5.0_f64, rule, policy).expect("allowed");
            assert_eq!(supervisor.table(), Some(table));
            assert_eq!((supervisor.defuzzifier(), supervisor.out_of_range()), (rule, policy));
        }
    }

    /// Scenarios are full of them: a word that changes makes files of before unreadable.
    #[test]
    fn policies_are_called_in_files_as_ever() {
        assert_eq!(OutOfRange::ALL.map(OutOfRange::name), ["clamp", "evaluate", "error"]);
    }
}

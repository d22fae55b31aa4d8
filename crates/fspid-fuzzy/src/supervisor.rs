//! The fuzzy supervisor: error and change of error in, increments of the three gains out.
//!
//! Mamdani inference as in the paper: Gaussian input sets whose neighbours cross at 0.5, `min` for
//! *and* and for implication, `max` over the rules of one label, centroid. Inputs and outputs have
//! the same half range.

use core::fmt;

use crate::centroid::centroid;
use crate::defuzzifier::Defuzzifier;
use crate::error::FuzzyError;
use crate::label::{LABEL_COUNT, Label};
use crate::membership::{Gaussian, SIGMA_PER_SPACING, Shape};
use crate::real::Real;
use crate::rule_table::{Grid, Output, RuleTable};

/// Rules in the base.
const RULE_COUNT: usize = LABEL_COUNT * LABEL_COUNT;
/// Half ranges outside this interval would overflow or underflow inside.
const RANGE_LIMITS: core::ops::RangeInclusive<f64> = 1e-100..=1e100;
/// As [`RANGE_LIMITS`] for `f32`.
const RANGE_LIMITS_F32: core::ops::RangeInclusive<f64> = 1e-12..=1e12;

/// What to do with an input beyond the half range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum OutOfRange {
    /// Move it to the nearest end of the range.
    #[default]
    Clamp,
    /// Evaluate it as it is; where every rule has underflowed, answer as for the clamped input.
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

/// Increments of the three gains, in the supervisor's own units (before the output factors).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Increments<R> {
    /// For the proportional gain.
    pub kp: R,
    /// For the integral gain.
    pub ki: R,
    /// For the derivative gain.
    pub kd: R,
}

/// An answer of the supervisor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inference<R> {
    /// Increments of the gains.
    pub delta: Increments<R>,
    /// An input lay outside the range and was moved to its end.
    pub clamped: bool,
    /// Every rule underflowed, and the answer is that of the clamped inputs.
    pub underflowed: bool,
}

/// Why an input has no answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InferenceError {
    /// `error` or `change`.
    pub input: &'static str,
    /// What was given.
    pub found: f64,
    /// Half range of the input.
    pub range: f64,
}

impl fmt::Display for InferenceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { input, found, range } = self;
        if found.is_finite() {
            write!(f, "{input} is {found:?}; allowed is -{range:?} to {range:?}")
        } else {
            write!(f, "{input} is {found:?}; allowed is a finite number")
        }
    }
}

impl core::error::Error for InferenceError {}

/// The rules of one output, sorted by label: cell numbers, and where each label's cells end.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Consequents {
    cells: [u8; RULE_COUNT],
    ends: [u8; LABEL_COUNT],
}

impl Consequents {
    fn new(table: &RuleTable, output: Output) -> Self {
        let grid = table.grid(output);
        let mut sorted = Self { cells: [0; RULE_COUNT], ends: [0; LABEL_COUNT] };
        let mut filled = 0_u8;
        for label in Label::ALL {
            for (cell, (error, change)) in (0_u8..).zip(pairs()) {
                if grid.at(error, change) == label {
                    sorted.cells[usize::from(filled)] = cell;
                    filled += 1;
                }
            }
            sorted.ends[label.index()] = filled;
        }
        sorted
    }

    /// The grid that was sorted.
    fn grid(&self) -> Grid {
        let mut rows = [[Label::ZO; LABEL_COUNT]; LABEL_COUNT];
        let mut begin = 0;
        for (label, &end) in Label::ALL.into_iter().zip(&self.ends) {
            let end = usize::from(end);
            for &cell in self.cells.get(begin..end).unwrap_or_default() {
                if let Some(place) = rows.as_flattened_mut().get_mut(usize::from(cell)) {
                    *place = label;
                }
            }
            begin = end;
        }
        Grid::new(rows)
    }

    /// Firing strength of each label: the strongest of its rules.
    fn strengths<R: Real>(&self, firing: &[R; 64]) -> [R; LABEL_COUNT] {
        let mut strengths = [R::ZERO; LABEL_COUNT];
        let mut begin = 0;
        for (strength, &end) in strengths.iter_mut().zip(&self.ends) {
            let end = usize::from(end);
            for &cell in self.cells.get(begin..end).unwrap_or_default() {
                // 64 places for 49 rules: the mask spares the bounds check.
                *strength = firing[usize::from(cell & 63)].larger(*strength);
            }
            begin = end;
        }
        strengths
    }
}

/// All pairs of input labels, in the order of the cells.
fn pairs() -> impl Iterator<Item = (Label, Label)> {
    Label::ALL
        .into_iter()
        .flat_map(|error| Label::ALL.into_iter().map(move |change| (error, change)))
}

/// The fuzzy supervisor. Immutable; building it may fail, and so may an inference that is asked to
/// refuse inputs out of range, but nothing else.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Supervisor<R> {
    consequents: [Consequents; 3],
    /// Centre and sigma of each input set.
    sets: [[R; 2]; LABEL_COUNT],
    range: R,
    spacing: R,
    defuzzifier: Defuzzifier,
    out_of_range: OutOfRange,
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
        let found = range.to_f64();
        let limits =
            if R::MIN_POSITIVE.to_f64() > 1e-100 { RANGE_LIMITS_F32 } else { RANGE_LIMITS };
        if !limits.contains(&found) {
            return Err(FuzzyError::Range { found });
        }
        let spacing = range / R::from_f64(3.0);
        let sigma = spacing * R::from_f64(SIGMA_PER_SPACING);
        let mut sets = [[R::ZERO, sigma]; LABEL_COUNT];
        for (steps, set) in (-3_i8..).zip(&mut sets) {
            *set = [spacing * R::from_f64(f64::from(steps)), sigma];
        }
        Ok(Self {
            consequents: Output::ALL.map(|output| Consequents::new(table, output)),
            sets,
            range,
            spacing,
            defuzzifier: defuzzifier.checked()?,
            out_of_range,
        })
    }

    /// Half range of inputs and outputs.
    pub fn range(&self) -> R {
        self.range
    }

    /// Centre and sigma of the Gaussian input sets, from `NB` to `PB`.
    pub fn sets(&self) -> &[[R; 2]; LABEL_COUNT] {
        &self.sets
    }

    /// The rules.
    pub fn table(&self) -> RuleTable {
        RuleTable::new(self.consequents.each_ref().map(Consequents::grid))
    }

    /// The rule for the centre of gravity.
    pub fn defuzzifier(&self) -> Defuzzifier {
        self.defuzzifier
    }

    /// What happens to an input beyond the range.
    pub fn out_of_range(&self) -> OutOfRange {
        self.out_of_range
    }

    /// Grades of an input in its seven sets, from `NB` to `PB`.
    pub fn grades(&self, input: R) -> [R; LABEL_COUNT] {
        self.sets.map(|set| Gaussian::grade(&set, input))
    }

    /// Increments of the gains for an error and its change.
    ///
    /// # Errors
    /// [`InferenceError`] for an input that is not finite, and under [`OutOfRange::Error`] for one
    /// beyond the range.
    #[inline]
    pub fn infer(&self, error: R, change: R) -> Result<Inference<R>, InferenceError> {
        let inside = error.abs() <= self.range && change.abs() <= self.range;
        if inside {
            return Ok(self.evaluate(error, change).unwrap_or_else(|| self.at_rest()));
        }
        self.infer_outside(error, change)
    }

    #[cold]
    fn infer_outside(&self, error: R, change: R) -> Result<Inference<R>, InferenceError> {
        self.refuse("error", error)?;
        self.refuse("change", change)?;
        if self.out_of_range == OutOfRange::Evaluate
            && let Some(inference) = self.evaluate(error, change)
        {
            return Ok(inference);
        }
        let ends = |input: R| input.limited(-self.range, self.range);
        let inference = self.evaluate(ends(error), ends(change)).unwrap_or_else(|| self.at_rest());
        let underflowed = self.out_of_range == OutOfRange::Evaluate;
        Ok(Inference { clamped: !underflowed, underflowed, ..inference })
    }

    fn refuse(&self, input: &'static str, value: R) -> Result<(), InferenceError> {
        let allowed = value.is_finite()
            && (self.out_of_range != OutOfRange::Error || value.abs() <= self.range);
        if allowed {
            return Ok(());
        }
        Err(InferenceError { input, found: value.to_f64(), range: self.range.to_f64() })
    }

    /// The answer at finite inputs, unless every rule has underflowed.
    fn evaluate(&self, error: R, change: R) -> Option<Inference<R>> {
        let (error_grades, change_grades) = (self.grades(error), self.grades(change));
        let mut firing = [R::ZERO; 64];
        let (mut strongest_error, mut strongest_change) = (R::ZERO, R::ZERO);
        for (row, &error_grade) in firing.chunks_exact_mut(LABEL_COUNT).zip(&error_grades) {
            strongest_error = strongest_error.larger(error_grade);
            for (cell, &change_grade) in row.iter_mut().zip(&change_grades) {
                *cell = error_grade.smaller(change_grade);
            }
        }
        for &grade in &change_grades {
            strongest_change = strongest_change.larger(grade);
        }
        // The strongest rule joins the strongest grades; below the normal range its quotient of
        // moments would lose its digits, and further out be 0/0.
        if strongest_error.smaller(strongest_change) < R::MIN_POSITIVE {
            return None;
        }
        // By reference and without an index: with one, a bounds check stays in the optimised code.
        let [kp, ki, kd] = self.consequents.each_ref().map(|consequents| {
            let strengths = consequents.strengths(&firing);
            centroid(self.defuzzifier, &strengths) * self.spacing
        });
        let delta = Increments { kp, ki, kd };
        Some(Inference { delta, clamped: false, underflowed: false })
    }

    /// No increments. Inside the range some rule always fires at 0.5 or more, so this never answers
    /// a question; it is here so that an inference cannot panic.
    fn at_rest(&self) -> Inference<R> {
        let delta = Increments { kp: R::ZERO, ki: R::ZERO, kd: R::ZERO };
        Inference { delta, clamped: false, underflowed: true }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
            assert_eq!(supervisor.table(), table);
            assert_eq!((supervisor.defuzzifier(), supervisor.out_of_range()), (rule, policy));
        }
    }
}

//! Evaluation of a fuzzy system at one input vector.

use core::fmt;

use super::build::System;
use super::parts::{FallbackValue, Output};
use super::workspace::Workspace;
use crate::supervisor::OutOfRange;

/// The answer of one output.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// The number, if there is one.
    pub value: Option<f64>,
    /// The value differs from the method's true value by no more than this, rounding aside; 0 for
    /// closed forms and for methods that are defined by their samples.
    pub error_bound: f64,
    /// Where the value comes from.
    pub source: Source,
}

/// Where an answer comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The rules.
    Rules,
    /// The rules gave nothing; the previous answer stands.
    Previous,
    /// The rules gave nothing; the middle of the universe.
    Middle,
    /// The rules gave nothing; the output's default.
    Default,
    /// The rules gave nothing, and there is nothing to fall back on.
    Nothing,
}

/// Why a question has no answers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum InputError {
    /// Not as many values as the system has inputs.
    Count {
        /// How many were given.
        found: usize,
        /// How many are needed.
        expected: usize,
    },
    /// A value that is not finite, or outside a universe that may not be left.
    Value {
        /// Position of the input.
        input: usize,
        /// What was given.
        found: f64,
        /// The universe, if it matters.
        universe: Option<[f64; 2]>,
    },
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Count { found, expected } => {
                write!(f, "{found} values for {expected} inputs")
            }
            Self::Value { input, found, universe: Some([lower, upper]) } => {
                write!(f, "input {} is {found:?}; allowed is {lower:?} to {upper:?}", input + 1)
            }
            Self::Value { input, found, universe: None } => {
                write!(f, "input {} is {found:?}; allowed is a finite number", input + 1)
            }
        }
    }
}

impl core::error::Error for InputError {}

impl System {
    /// The answers at these inputs, one for each output, without a memory of earlier ones.
    ///
    /// # Errors
    /// [`InputError`] for too few or too many inputs, one that is not finite, or one outside a
    /// universe that may not be left.
    pub fn evaluate<'w>(
        &self,
        inputs: &[f64],
        workspace: &'w mut Workspace,
    ) -> Result<&'w [Answer], InputError> {
        self.evaluate_after(inputs, &[], workspace)
    }

    /// As [`evaluate`](Self::evaluate), with the previous answers for outputs that keep theirs
    /// where no rule fires (`lock-previous` of fuzzylite, `NC` of FCL), and for formulas that name
    /// outputs. Outputs are answered in their order: a formula finds the new answers of the outputs
    /// before its own and the previous ones of the others; one that finds none has no value.
    ///
    /// # Errors
    /// As [`evaluate`](Self::evaluate).
    pub fn evaluate_after<'w>(
        &self,
        inputs: &[f64],
        previous: &[Option<f64>],
        workspace: &'w mut Workspace,
    ) -> Result<&'w [Answer], InputError> {
        self.take_inputs(inputs, workspace)?;
        for (index, place) in workspace.before.iter_mut().enumerate() {
            *place = previous.get(index).copied().flatten().unwrap_or(f64::NAN);
        }
        self.look_from(0, workspace);
        self.fire(workspace);
        self.fire_bounds(workspace);
        for (index, output) in self.parts.outputs.iter().enumerate() {
            let previous = previous.get(index).copied().flatten();
            self.look_from(index, workspace);
            let answer = self.answer(index, output, previous, workspace);
            if let Some(place) = workspace.answers.get_mut(index) {
                *place = answer;
            }
        }
        Ok(&workspace.answers)
    }

    /// Gives formulas the answers that there are while the output at `index` is answered.
    pub(crate) fn look_from(&self, index: usize, workspace: &mut Workspace) {
        let Workspace { inputs, before, answers, .. } = workspace;
        let places = inputs.iter_mut().skip(self.parts.inputs.len());
        for (at, (place, (answer, &before))) in places.zip(answers.iter().zip(&*before)).enumerate()
        {
            *place = if at < index { answer.value.unwrap_or(f64::NAN) } else { before };
        }
    }

    fn take_inputs(&self, values: &[f64], workspace: &mut Workspace) -> Result<(), InputError> {
        let (found, expected) = (values.len(), self.parts.inputs.len());
        if found != expected {
            return Err(InputError::Count { found, expected });
        }
        let places = workspace.inputs.iter_mut().zip(&mut workspace.outside);
        for (index, ((input, &value), (place, outside))) in
            self.parts.inputs.iter().zip(values).zip(places).enumerate()
        {
            if !value.is_finite() {
                return Err(InputError::Value { input: index, found: value, universe: None });
            }
            (*place, *outside) = (value, false);
            let Some(universe) = input.universe.filter(|u| !u.contains(value)) else { continue };
            *outside = true;
            match input.out_of_range {
                OutOfRange::Evaluate => {}
                OutOfRange::Clamp => *place = value.clamp(universe.lower, universe.upper),
                OutOfRange::Error => {
                    let universe = Some([universe.lower, universe.upper]);
                    return Err(InputError::Value { input: index, found: value, universe });
                }
            }
        }
        Ok(())
    }

    fn answer(
        &self,
        index: usize,
        output: &Output,
        previous: Option<f64>,
        workspace: &mut Workspace,
    ) -> Answer {
        let from_rules =
            if output.enabled { self.defuzzified(index, output, workspace) } else { None };
        let answer = match from_rules.filter(|(value, _)| value.is_finite()) {
            Some((value, error_bound)) => {
                Answer { value: Some(value), error_bound, source: Source::Rules }
            }
            None => fallback(output, previous.filter(|value| value.is_finite())),
        };
        let clamp = |value: f64| match output.universe {
            Some(universe) if output.clamp => value.clamp(universe.lower, universe.upper),
            _ => value,
        };
        Answer { value: answer.value.map(clamp), ..answer }
    }
}

/// The answer where the rules give none.
fn fallback(output: &Output, previous: Option<f64>) -> Answer {
    let answer = |value, source| Answer { value, error_bound: 0.0, source };
    match (previous.filter(|_| output.fallback.previous), output.fallback.value, output.universe) {
        (Some(value), _, _) => answer(Some(value), Source::Previous),
        (None, FallbackValue::Middle, Some(universe)) => {
            answer(Some(universe.middle()), Source::Middle)
        }
        (None, FallbackValue::Number(value), _) => answer(Some(value), Source::Default),
        (None, _, _) => answer(None, Source::Nothing),
    }
}

//! How an answer changes with the inputs and with every number in the system: exact derivatives.
//!
//! Derivatives are carried back from the answer to what it came from: from the number to the joined
//! set, to the strengths of the conclusions, to the rules, to the statements, and from there to
//! inputs and parameters. For a centroid $y = M / A$
//!
//! $$ \frac{\partial y}{\partial p} = \frac1A \int (x - y) \frac{\partial \mu(x)}{\partial p} dx, $$
//!
//! an integral whose value is known exactly where the set is piecewise linear, because each piece
//! is then a quadratic in $x$. At a kink (two sets of one height, a grade at a corner) there is no
//! derivative; what is answered there is that of one side.

mod back;
mod nodes;
mod parameter;

use alloc::collections::BTreeMap;
use alloc::vec;
use alloc::vec::Vec;
use core::fmt;

pub use parameter::Parameter;

use super::build::System;
use super::defuzzifier::{Defuzzifier, Sampling};
use super::evaluate::{InputError, Source};
use super::workspace::Workspace;
use back::Adjoint;

/// The answer of one output and its derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradient {
    /// The answer.
    pub value: f64,
    /// Derivative with respect to each input; 0 for one that was moved into its universe.
    pub inputs: Vec<f64>,
    /// Derivative with respect to each of [`Differentiator::parameters`].
    pub parameters: Vec<f64>,
}

/// Why there are no derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum GradientError {
    /// The inputs have no answers.
    Input(InputError),
    /// There is no output at that position.
    Output {
        /// What was given.
        found: usize,
        /// How many there are.
        count: usize,
    },
    /// The rules give no answer here.
    NoAnswer,
    /// The answer moves in jumps.
    Jumps {
        /// Why.
        because: &'static str,
    },
}

impl fmt::Display for GradientError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(error) => error.fmt(f),
            Self::Output { found, count } => {
                write!(f, "output number {} is asked for, but there are {count}", found + 1)
            }
            Self::NoAnswer => f.write_str("no rule fires here, so there is nothing to derive"),
            Self::Jumps { because } => write!(f, "there is no derivative: {because}"),
        }
    }
}

impl core::error::Error for GradientError {}

/// Derives the answers of a system.
#[derive(Clone, Debug)]
pub struct Differentiator<'s> {
    pub(crate) system: &'s System,
    parameters: Vec<Parameter>,
    position: BTreeMap<Parameter, usize>,
}

impl System {
    /// What derives the answers of this system.
    #[must_use]
    pub fn differentiator(&self) -> Differentiator<'_> {
        let parameters = self.parts.parameters();
        let position = parameters.iter().enumerate().map(|(index, &p)| (p, index)).collect();
        Differentiator { system: self, parameters, position }
    }
}

impl Differentiator<'_> {
    /// The parameters that answers are derived with respect to, in order.
    #[must_use]
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    fn position(&self, parameter: Parameter) -> Option<usize> {
        self.position.get(&parameter).copied()
    }

    /// The answer of an output at these inputs with its derivatives.
    ///
    /// # Errors
    /// [`GradientError`] where the inputs are refused, no rule fires, the output's method answers in
    /// jumps (a sampled bisector or maximum, cut points as samples), or rules ask about outputs.
    pub fn gradient(
        &self,
        inputs: &[f64],
        output: usize,
        workspace: &mut Workspace,
    ) -> Result<Gradient, GradientError> {
        let system = self.system;
        let answers = system.evaluate(inputs, workspace).map_err(GradientError::Input)?;
        let count = answers.len();
        let answer = answers.get(output).ok_or(GradientError::Output { found: output, count })?;
        let (Some(value), Source::Rules) = (answer.value, answer.source) else {
            return Err(GradientError::NoAnswer);
        };
        if system.chained {
            return Err(jumps("rules that ask about outputs are not derived"));
        }
        if system.parts.formulas_name_outputs() {
            return Err(jumps("formulas that name outputs are not derived"));
        }
        if system.type2.is_some() {
            return Err(jumps("interval type-2 systems are not derived"));
        }
        let mut adjoint = Adjoint::new(self, inputs.len());
        if !self.is_clamped(output, value) {
            self.through_answer(output, value, workspace, &mut adjoint)?;
            adjoint.through_rules(workspace);
        }
        for (derivative, (input, &outside)) in
            adjoint.inputs.iter_mut().zip(system.parts.inputs.iter().zip(workspace.outside()))
        {
            if outside && input.out_of_range == crate::OutOfRange::Clamp {
                *derivative = 0.0;
            }
        }
        Ok(Gradient { value, inputs: adjoint.inputs, parameters: adjoint.parameters })
    }

    /// True if the answer was moved to an end of its universe.
    #[allow(clippy::float_cmp, reason = "a clamped answer is the end itself")]
    fn is_clamped(&self, output: usize, value: f64) -> bool {
        self.system.parts.outputs.get(output).is_some_and(|output| {
            output.clamp && output.universe.is_some_and(|u| value == u.lower || value == u.upper)
        })
    }

    fn through_answer(
        &self,
        index: usize,
        value: f64,
        workspace: &mut Workspace,
        adjoint: &mut Adjoint<'_>,
    ) -> Result<(), GradientError> {
        let Some(output) = self.system.parts.outputs.get(index) else { return Ok(()) };
        let method = output.defuzzifier;
        match method {
            Defuzzifier::WeightedAverage(_) | Defuzzifier::WeightedSum(_) => {
                adjoint.through_average(index, output, value, workspace);
                Ok(())
            }
            _ if method.sampling().is_some_and(|s| matches!(s, Sampling::Vertices(_))) => {
                Err(jumps("the samples of `vertices` move with the strengths; ask for `exact`"))
            }
            Defuzzifier::Centroid(_) => {
                let nodes = self.centroid_nodes(index, output, value, workspace)?;
                adjoint.through_joined(index, output, &nodes, workspace);
                Ok(())
            }
            Defuzzifier::Bisector(Sampling::Exact) => {
                let nodes = self.bisector_nodes(index, output, value, workspace)?;
                adjoint.through_joined(index, output, &nodes, workspace);
                Ok(())
            }
            Defuzzifier::SmallestOfMaximum(Sampling::Exact)
            | Defuzzifier::MeanOfMaximum(Sampling::Exact)
            | Defuzzifier::LargestOfMaximum(Sampling::Exact) => {
                let ends = self.top(index, workspace)?;
                adjoint.through_top(index, output, method, &ends, workspace);
                Ok(())
            }
            Defuzzifier::Bisector(_)
            | Defuzzifier::SmallestOfMaximum(_)
            | Defuzzifier::MeanOfMaximum(_)
            | Defuzzifier::LargestOfMaximum(_) => {
                Err(jumps("the answer is one of the samples; ask for `exact`"))
            }
        }
    }
}

pub(crate) fn jumps(because: &'static str) -> GradientError {
    GradientError::Jumps { because }
}

/// A list of zeros.
pub(crate) fn zeros(count: usize) -> Vec<f64> {
    vec![0.0; count]
}

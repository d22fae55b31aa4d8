//! The memory that an evaluation needs, allocated once.

use alloc::vec;
use alloc::vec::Vec;

use super::build::System;
use super::evaluate::{Answer, Source};
use super::output::Scratch;
use super::program::STACK;
use super::type2::{Type2, Type2Room};

/// Room for one evaluation at a time of the system that it was made for.
///
/// What it holds after an evaluation can be read: inputs as they were used, grades, strengths. It
/// carries nothing from one evaluation to the next.
#[derive(Clone, Debug)]
pub struct Workspace {
    /// What formulas may name: the inputs as used, after clamping, then the outputs' last answers.
    pub(crate) inputs: Vec<f64>,
    /// The answers before this evaluation; NaN where there is none.
    pub(crate) before: Vec<f64>,
    /// Which inputs lay outside their universe.
    pub(crate) outside: Vec<bool>,
    /// Grades of the program's statements.
    pub(crate) grades: Vec<f64>,
    pub(crate) stack: Vec<f64>,
    /// Strength of each rule as it fires, weight included.
    pub(crate) strengths: Vec<f64>,
    /// Strength of each rule as it acts: after the block's activation.
    pub(crate) acting: Vec<f64>,
    /// Strength of each conclusion: after the hedges of its consequent.
    pub(crate) degrees: Vec<f64>,
    pub(crate) scratch: Scratch,
    /// Of interval type-2 systems only.
    pub(crate) type2: Option<Type2Room>,
    pub(crate) answers: Vec<Answer>,
}

impl System {
    /// Room for evaluations of this system.
    #[must_use]
    pub fn workspace(&self) -> Workspace {
        let nothing = Answer { value: None, error_bound: 0.0, source: Source::Nothing };
        Workspace {
            inputs: vec![0.0; self.parts.inputs.len() + self.parts.outputs.len()],
            before: vec![f64::NAN; self.parts.outputs.len()],
            outside: vec![false; self.parts.inputs.len()],
            grades: vec![0.0; self.program.statements.len()],
            stack: vec![0.0; STACK],
            strengths: vec![0.0; self.rules.len()],
            acting: vec![0.0; self.rules.len()],
            degrees: vec![0.0; self.conclusions.len()],
            scratch: Scratch::for_outputs(self),
            type2: self.type2.as_ref().map(|type2| Type2::room(type2, self)),
            answers: vec![nothing; self.parts.outputs.len()],
        }
    }
}

impl Workspace {
    /// The inputs of the last evaluation as they were used: those to be clamped are clamped.
    #[must_use]
    pub fn inputs(&self) -> &[f64] {
        self.inputs.get(..self.outside.len()).unwrap_or_default()
    }

    /// What formulas were given in the last evaluation: the inputs as they were used, then for each
    /// output the last answer that there was for the output that was looked at last, NaN for none.
    #[must_use]
    pub fn variables(&self) -> &[f64] {
        &self.inputs
    }

    /// Which inputs of the last evaluation lay outside their universe.
    #[must_use]
    pub fn outside(&self) -> &[bool] {
        &self.outside
    }

    /// The interval of an output of an interval type-2 system: from the smallest to the largest
    /// centroid that the bounds of the grades allow. The answer is its middle.
    #[must_use]
    pub fn interval(&self, output: usize) -> Option<[f64; 2]> {
        self.type2.as_ref()?.intervals.get(output).copied().flatten()
    }

    /// The answers of the last evaluation, one for each output.
    #[must_use]
    pub fn answers(&self) -> &[Answer] {
        &self.answers
    }
}

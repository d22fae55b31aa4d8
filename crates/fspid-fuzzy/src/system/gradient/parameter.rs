//! The numbers of a system that can be tuned, each with an address.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use super::super::parts::{Conclusion, Membership, Parts};

/// A number in a system that answers depend on smoothly.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Parameter {
    /// A parameter of a membership function of an input.
    InputShape {
        /// Position of the input.
        input: usize,
        /// Position of the term.
        term: usize,
        /// Position among the parameters.
        index: usize,
    },
    /// Largest grade of a term of an input.
    InputHeight {
        /// Position of the input.
        input: usize,
        /// Position of the term.
        term: usize,
    },
    /// A parameter of a membership function of an output.
    OutputShape {
        /// Position of the output.
        output: usize,
        /// Position of the term.
        term: usize,
        /// Position among the parameters.
        index: usize,
    },
    /// Largest grade of a term of an output.
    OutputHeight {
        /// Position of the output.
        output: usize,
        /// Position of the term.
        term: usize,
    },
    /// The number that a term of an output stands for, or the constant of its sum.
    Constant {
        /// Position of the output.
        output: usize,
        /// Position of the term.
        term: usize,
    },
    /// The coefficient of an input in a term of an output.
    Coefficient {
        /// Position of the output.
        output: usize,
        /// Position of the term.
        term: usize,
        /// Position of the input.
        input: usize,
    },
    /// The weight of a rule.
    Weight {
        /// Position of the rule block.
        block: usize,
        /// Position of the rule in its block.
        rule: usize,
    },
}

impl Parts {
    /// Every parameter, terms of inputs first, then terms of outputs, then weights of rules.
    #[must_use]
    pub fn parameters(&self) -> Vec<Parameter> {
        let mut all = Vec::new();
        for (input, variable) in self.inputs.iter().enumerate() {
            for (term, found) in variable.terms.iter().enumerate() {
                all.extend((0..found.membership.count()).map(|index| Parameter::InputShape {
                    input,
                    term,
                    index,
                }));
                all.push(Parameter::InputHeight { input, term });
            }
        }
        for (output, variable) in self.outputs.iter().enumerate() {
            for (term, found) in variable.terms.iter().enumerate() {
                of_conclusion(output, term, &found.conclusion, &mut all);
            }
        }
        for (block, rules) in self.blocks.iter().enumerate() {
            all.extend((0..rules.rules.len()).map(|rule| Parameter::Weight { block, rule }));
        }
        all
    }

    /// The value of a parameter; nothing if there is none at that address.
    #[must_use]
    pub fn parameter(&self, parameter: Parameter) -> Option<f64> {
        // Reading goes through the same places as writing, on a borrowed copy of nothing.
        match parameter {
            Parameter::InputShape { input, term, index } => {
                self.inputs.get(input)?.terms.get(term)?.membership.parameter(index)
            }
            Parameter::InputHeight { input, term } => {
                Some(self.inputs.get(input)?.terms.get(term)?.membership.height())
            }
            Parameter::Weight { block, rule } => {
                Some(self.blocks.get(block)?.rules.get(rule)?.weight)
            }
            Parameter::OutputShape { output, term, .. }
            | Parameter::OutputHeight { output, term }
            | Parameter::Constant { output, term }
            | Parameter::Coefficient { output, term, .. } => {
                let conclusion = &self.outputs.get(output)?.terms.get(term)?.conclusion;
                match (parameter, conclusion) {
                    (Parameter::OutputShape { index, .. }, Conclusion::Set { membership, .. }) => {
                        membership.parameter(index)
                    }
                    (Parameter::OutputHeight { .. }, Conclusion::Set { membership, .. }) => {
                        Some(membership.height())
                    }
                    (
                        Parameter::Constant { .. },
                        Conclusion::Constant(constant) | Conclusion::Linear { constant, .. },
                    ) => Some(*constant),
                    (
                        Parameter::Coefficient { input, .. },
                        Conclusion::Linear { coefficients, .. },
                    ) => coefficients.get(input).copied(),
                    _ => None,
                }
            }
        }
    }

    /// Gives a parameter another value; answers whether there is one at that address.
    pub fn set_parameter(&mut self, parameter: Parameter, value: f64) -> bool {
        let place = self.place(parameter);
        let found = place.is_some();
        if let Some(place) = place {
            *place = value;
        }
        found
    }

    fn place(&mut self, parameter: Parameter) -> Option<&mut f64> {
        match parameter {
            Parameter::InputShape { input, term, index } => {
                self.inputs.get_mut(input)?.terms.get_mut(term)?.membership.place(index)
            }
            Parameter::InputHeight { input, term } => {
                Some(self.inputs.get_mut(input)?.terms.get_mut(term)?.membership.height_place())
            }
            Parameter::Weight { block, rule } => {
                Some(&mut self.blocks.get_mut(block)?.rules.get_mut(rule)?.weight)
            }
            Parameter::OutputShape { output, term, .. }
            | Parameter::OutputHeight { output, term }
            | Parameter::Constant { output, term }
            | Parameter::Coefficient { output, term, .. } => {
                let conclusion = &mut self.outputs.get_mut(output)?.terms.get_mut(term)?.conclusion;
                match (parameter, conclusion) {
                    (Parameter::OutputShape { index, .. }, Conclusion::Set { membership, .. }) => {
                        membership.place(index)
                    }
                    (Parameter::OutputHeight { .. }, Conclusion::Set { membership, .. }) => {
                        Some(membership.height_place())
                    }
                    (
                        Parameter::Constant { .. },
                        Conclusion::Constant(constant) | Conclusion::Linear { constant, .. },
                    ) => Some(constant),
                    (
                        Parameter::Coefficient { input, .. },
                        Conclusion::Linear { coefficients, .. },
                    ) => coefficients.get_mut(input),
                    _ => None,
                }
            }
        }
    }

    /// A parameter in words: `service.poor[1]`, `weight of rule 3`.
    #[must_use]
    pub fn parameter_name(&self, parameter: Parameter) -> String {
        let input_term = |input: usize, term: usize| {
            let variable = self.inputs.get(input);
            let name = variable.and_then(|v| v.terms.get(term)).map_or("?", |t| &t.name);
            format!("{}.{name}", variable.map_or("?", |v| &v.name))
        };
        let output_term = |output: usize, term: usize| {
            let variable = self.outputs.get(output);
            let name = variable.and_then(|v| v.terms.get(term)).map_or("?", |t| &t.name);
            format!("{}.{name}", variable.map_or("?", |v| &v.name))
        };
        match parameter {
            Parameter::InputShape { input, term, index } => {
                let known = self.inputs.get(input).and_then(|v| v.terms.get(term));
                let name = known.and_then(|t| t.membership.parameter_name(index)).unwrap_or("?");
                format!("{}.{name}", input_term(input, term))
            }
            Parameter::InputHeight { input, term } => {
                format!("{}.height", input_term(input, term))
            }
            Parameter::OutputShape { output, term, index } => {
                let known = self.outputs.get(output).and_then(|v| v.terms.get(term));
                let name = known
                    .and_then(|t| match &t.conclusion {
                        Conclusion::Set { membership, .. } => membership.parameter_name(index),
                        _ => None,
                    })
                    .unwrap_or("?");
                format!("{}.{name}", output_term(output, term))
            }
            Parameter::OutputHeight { output, term } => {
                format!("{}.height", output_term(output, term))
            }
            Parameter::Constant { output, term } => {
                format!("{}.constant", output_term(output, term))
            }
            Parameter::Coefficient { output, term, input } => {
                let name = self.inputs.get(input).map_or("?", |v| &v.name);
                format!("{}.coefficient of {name}", output_term(output, term))
            }
            Parameter::Weight { block, rule } if self.blocks.len() < 2 => {
                let _ = block;
                format!("weight of rule {}", rule + 1)
            }
            Parameter::Weight { block, rule } => {
                format!("weight of rule {} of block {}", rule + 1, block + 1)
            }
        }
    }
}

fn of_conclusion(output: usize, term: usize, found: &Conclusion, all: &mut Vec<Parameter>) {
    match found {
        Conclusion::Set { membership, .. } => {
            all.extend((0..membership.count()).map(|index| Parameter::OutputShape {
                output,
                term,
                index,
            }));
            all.push(Parameter::OutputHeight { output, term });
        }
        Conclusion::Constant(_) => all.push(Parameter::Constant { output, term }),
        Conclusion::Linear { coefficients, .. } => {
            all.extend((0..coefficients.len()).map(|input| Parameter::Coefficient {
                output,
                term,
                input,
            }));
            all.push(Parameter::Constant { output, term });
        }
        Conclusion::Interval(_) | Conclusion::Formula(_) => {}
    }
}

impl Membership {
    /// How many parameters the shape has; a formula has none.
    fn count(&self) -> usize {
        match self {
            Self::Shape { params, .. } => params.len(),
            Self::Formula { .. } => 0,
        }
    }

    fn parameter(&self, index: usize) -> Option<f64> {
        match self {
            Self::Shape { params, .. } => params.get(index).copied(),
            Self::Formula { .. } => None,
        }
    }

    fn place(&mut self, index: usize) -> Option<&mut f64> {
        match self {
            Self::Shape { params, .. } => params.get_mut(index),
            Self::Formula { .. } => None,
        }
    }

    fn parameter_name(&self, index: usize) -> Option<&'static str> {
        let Self::Shape { kind, .. } = self else { return None };
        let names = kind.params();
        let within = if kind.repeats() { index % names.len().max(1) } else { index };
        names.get(within).map(|param| param.name)
    }

    /// Largest grade.
    #[must_use]
    pub fn height(&self) -> f64 {
        let (Self::Shape { height, .. } | Self::Formula { height, .. }) = self;
        *height
    }

    fn height_place(&mut self) -> &mut f64 {
        let (Self::Shape { height, .. } | Self::Formula { height, .. }) = self;
        height
    }
}

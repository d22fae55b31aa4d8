//! The forward pass: what rules conclude, by least squares.

use fspid_fuzzy::system::{
    Conclusion, Defuzzifier, Output, Parameter, Parts, Source, System, Workspace,
};

use super::data::{Data, DataRow};
use super::error::AnfisError;
use super::squares::Triangle;

/// Most numbers that are concluded about an output; their triangle is then 32 MB.
const UNKNOWNS_LIMIT: usize = 2000;

/// The numbers that the rules conclude about an output.
#[derive(Clone, Debug)]
struct Unknowns {
    /// For each term the position of its first number; none where no rule concludes it.
    begins: Vec<Option<usize>>,
    /// Addresses, in order: coefficients of a term first, then its constant.
    parameters: Vec<Parameter>,
}

/// What is learned by least squares: everything that rules conclude.
#[derive(Clone, Debug)]
pub(super) struct Consequents {
    outputs: Vec<Unknowns>,
    /// For each output the weights that draw its numbers to 0.
    weights: Vec<Vec<f64>>,
}

impl Consequents {
    /// Those of a system, to be learned from such data.
    ///
    /// # Errors
    /// [`AnfisError::NotSugeno`], [`AnfisError::TooMany`].
    pub(super) fn of(parts: &Parts, data: &Data, regularisation: f64) -> Result<Self, AnfisError> {
        let mut outputs = Vec::new();
        for (index, output) in parts.outputs.iter().enumerate() {
            check(output)?;
            outputs.push(unknowns(parts, index, output)?);
        }
        let mut sizes = vec![0.0; parts.inputs.len()];
        for row in data.rows() {
            for (size, input) in sizes.iter_mut().zip(row.inputs) {
                *size = input.abs().max(*size);
            }
        }
        // In the unit of the answer: a coefficient counts as what it adds at its largest input.
        let strength = (regularisation * data.len() as f64).sqrt();
        let weight = |parameter: &Parameter| match parameter {
            Parameter::Coefficient { input, .. } => match sizes.get(*input) {
                Some(&size) if size > 0.0 => strength * size,
                _ => strength,
            },
            _ => strength,
        };
        let weights =
            outputs.iter().map(|found| found.parameters.iter().map(weight).collect()).collect();
        Ok(Self { outputs, weights })
    }

    /// The system with these premises whose conclusions fit the data best.
    ///
    /// # Errors
    /// A system that is wrong, a row that it refuses or does not cover, an overflow.
    pub(super) fn fitted(&self, premises: &Parts, data: &Data) -> Result<System, AnfisError> {
        let system = System::new(premises.clone()).map_err(AnfisError::System)?;
        let mut triangles: Vec<Triangle> =
            self.weights.iter().map(|weights| Triangle::new(weights)).collect();
        let mut workspace = system.workspace();
        let mut line = Vec::new();
        for row in data.rows() {
            let refused = |reason| AnfisError::Input { row: row.number, reason };
            system.evaluate(row.inputs, &mut workspace).map_err(refused)?;
            let unknowns = self.outputs.iter().zip(&mut triangles).zip(row.outputs);
            for (index, ((unknowns, triangle), &target)) in unknowns.enumerate() {
                unknowns
                    .fill(&mut line, &system, index, &mut workspace)
                    .ok_or(AnfisError::NotCovered { row: row.number })?;
                triangle.add(&mut line, target);
            }
        }
        let mut parts = premises.clone();
        for (unknowns, triangle) in self.outputs.iter().zip(&triangles) {
            let solution = triangle.solution().ok_or(AnfisError::Overflow)?;
            for (&parameter, value) in unknowns.parameters.iter().zip(solution) {
                parts.set_parameter(parameter, value);
            }
        }
        System::new(parts).map_err(AnfisError::System)
    }
}

impl Unknowns {
    /// The factors of the unknowns in the answer of the last evaluation; `None` where no rule fires.
    ///
    /// $$ y = \sum_i \bar w_i (c_i^T x + d_i), \quad \bar w_i = w_i / \sum_j w_j $$
    ///
    /// and without the division for a weighted sum.
    fn fill(
        &self,
        line: &mut Vec<f64>,
        system: &System,
        index: usize,
        workspace: &mut Workspace,
    ) -> Option<()> {
        let fired = system.contributions(index, workspace);
        let sum: f64 = fired.iter().map(|fired| fired.degree).sum();
        if !(sum > 0.0) {
            return None;
        }
        let output = system.parts().outputs.get(index)?;
        let share = match output.defuzzifier {
            Defuzzifier::WeightedAverage(_) => 1.0 / sum,
            _ => 1.0,
        };
        line.clear();
        line.resize(self.parameters.len(), 0.0);
        for fired in fired.iter().filter(|fired| fired.degree > 0.0) {
            let begin = self.begins.get(fired.term).copied().flatten()?;
            let places = line.get_mut(begin..)?;
            let factors: &[f64] = match output.terms.get(fired.term)?.conclusion {
                Conclusion::Linear { .. } => workspace.inputs(),
                _ => &[],
            };
            for (place, factor) in places.iter_mut().zip(factors.iter().chain(&[1.0])) {
                *place += share * fired.degree * factor;
            }
        }
        line.iter().all(|factor| factor.is_finite()).then_some(())
    }
}

/// Squared errors of the answers, summed over outputs and rows.
///
/// # Errors
/// A row that the system refuses or does not cover.
pub(super) fn squared_error(system: &System, data: &Data) -> Result<f64, AnfisError> {
    let mut workspace = system.workspace();
    let mut sum = 0.0;
    for row in data.rows() {
        sum += row_error(system, row, &mut workspace)?;
    }
    Ok(sum)
}

fn row_error(
    system: &System,
    row: DataRow<'_>,
    workspace: &mut Workspace,
) -> Result<f64, AnfisError> {
    let refused = |reason| AnfisError::Input { row: row.number, reason };
    let answers = system.evaluate(row.inputs, workspace).map_err(refused)?;
    let mut sum = 0.0;
    for (answer, target) in answers.iter().zip(row.outputs) {
        match (answer.value, answer.source) {
            (Some(value), Source::Rules) => sum += (value - target) * (value - target),
            _ => return Err(AnfisError::NotCovered { row: row.number }),
        }
    }
    Ok(sum)
}

fn check(output: &Output) -> Result<(), AnfisError> {
    let refuse = |because| {
        let place = format!("output `{}`", output.name);
        Err(AnfisError::NotSugeno { place, because })
    };
    if !output.enabled {
        return refuse("it is switched off");
    }
    if !matches!(output.defuzzifier, Defuzzifier::WeightedAverage(_) | Defuzzifier::WeightedSum(_))
    {
        return refuse("its conclusions are not joined by a weighted average or sum");
    }
    let is_number = |conclusion: &Conclusion| {
        matches!(conclusion, Conclusion::Constant(_) | Conclusion::Linear { .. })
    };
    if !output.terms.iter().all(|term| is_number(&term.conclusion)) {
        return refuse("a term is neither a number nor linear in the inputs");
    }
    Ok(())
}

/// What rules that are switched on conclude about an output.
fn unknowns(parts: &Parts, index: usize, output: &Output) -> Result<Unknowns, AnfisError> {
    let mut used = vec![false; output.terms.len()];
    let rules = parts.blocks.iter().filter(|block| block.enabled).flat_map(|block| &block.rules);
    for consequent in rules.filter(|rule| rule.enabled).flat_map(|rule| &rule.consequents) {
        if let Some(place) = used.get_mut(consequent.term)
            && consequent.output == index
        {
            *place = true;
        }
    }
    let (mut begins, mut parameters) = (Vec::new(), Vec::new());
    for (term, (found, used)) in output.terms.iter().zip(used).enumerate() {
        begins.push(used.then_some(parameters.len()));
        if !used {
            continue;
        }
        if let Conclusion::Linear { coefficients, .. } = &found.conclusion {
            let coefficient = |input| Parameter::Coefficient { output: index, term, input };
            parameters.extend((0..coefficients.len()).map(coefficient));
        }
        parameters.push(Parameter::Constant { output: index, term });
    }
    if parameters.len() > UNKNOWNS_LIMIT {
        return Err(AnfisError::TooMany { found: parameters.len(), allowed: UNKNOWNS_LIMIT });
    }
    Ok(Unknowns { begins, parameters })
}

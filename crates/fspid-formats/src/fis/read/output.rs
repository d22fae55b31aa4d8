//! `[Output1]`: sets, numbers and linear functions.

use fspid_fuzzy::SNormKind;
use fspid_fuzzy::system::{Conclusion, Defuzzifier, Fallback, FallbackValue, Output, OutputTerm};

use super::membership::Written;
use super::value::Number;
use super::variable::{Set, Variable};
use crate::fis::word::Engine;
use crate::report::{Report, wrong};
use fspid_diagnostics::Problem;

/// What the system says about every output.
#[derive(Clone, Copy, Debug)]
pub(super) struct Method {
    pub(super) engine: Engine,
    pub(super) aggregation: SNormKind,
    pub(super) defuzzifier: Defuzzifier,
    /// How many inputs a linear function has.
    pub(super) inputs: usize,
}

impl Method {
    /// True if conclusions are weighted rather than joined.
    fn weighs(&self) -> bool {
        self.defuzzifier.sampling().is_none()
    }
}

/// The variable as an output.
pub(super) fn output(variable: Variable, method: &Method, report: &mut Report) -> Output {
    let terms = variable.sets.iter().map(|set| term(set, method, report)).collect();
    if variable.universe.is_none() && !method.weighs() {
        let message = "has no finite range, but its sets are integrated over it";
        report.problem(variable.place, &variable.name, message, "`Range=[lower upper]`");
    }
    let value = match variable.universe {
        Some(_) => FallbackValue::Middle,
        None => FallbackValue::Nothing,
    };
    Output {
        name: variable.name,
        description: String::new(),
        enabled: variable.enabled,
        universe: variable.universe,
        clamp: false,
        terms,
        aggregation: method.aggregation.into(),
        defuzzifier: method.defuzzifier,
        fallback: Fallback { previous: false, value },
    }
}

fn term(set: &Set, method: &Method, report: &mut Report) -> OutputTerm {
    let number = set.upper.as_ref().and_then(|written| {
        let number = number(written, method).transpose()?;
        // A pair of numbers has no meaning in any dialect; one number is not asked for its pair.
        Some(report.keep(number).unwrap_or(Conclusion::Constant(0.0)))
    });
    let conclusion = number.unwrap_or_else(|| as_set(set, method, report));
    OutputTerm { name: set.label.clone(), conclusion }
}

fn as_set(set: &Set, method: &Method, report: &mut Report) -> Conclusion {
    let (membership, lower) = set.memberships(report);
    if let Some(written) = set.upper.as_ref().filter(|_| method.engine == Engine::Sugeno) {
        let message = "a fuzzy set in a Sugeno system";
        report.problem(written.place, &written.name, message, "`constant` or `linear`");
    }
    Conclusion::Set { membership, lower }
}

/// The conclusion that `constant` and `linear` stand for; nothing for any other word.
fn number(written: &Written, method: &Method) -> Result<Option<Conclusion>, Problem> {
    let values: Vec<f64> = written.numbers.iter().map(|number| number.value).collect();
    let conclusion = match written.name.to_ascii_lowercase().as_str() {
        "constant" => constant(written, &values)?,
        "linear" => linear(written, &values, method.inputs)?,
        _ => return Ok(None),
    };
    written.numbers.iter().try_for_each(finite)?;
    if method.weighs() {
        return Ok(Some(conclusion));
    }
    let message = "stands for a number, which cannot be joined and integrated";
    let expected = "a fuzzy set, or `Type='sugeno'` with `DefuzzMethod='wtaver'`";
    Err(wrong(written.place, &written.name, message, expected))
}

fn constant(written: &Written, values: &[f64]) -> Result<Conclusion, Problem> {
    match *values {
        [value] => Ok(Conclusion::Constant(value)),
        [lower, upper] if lower.to_bits() == upper.to_bits() => Ok(Conclusion::Constant(lower)),
        [lower, upper] if lower < upper => Ok(Conclusion::Interval([lower, upper])),
        _ => Err(miscounted(written, "`[number]`, or `[lower upper]` for an interval".into())),
    }
}

fn linear(written: &Written, values: &[f64], inputs: usize) -> Result<Conclusion, Problem> {
    match values.split_last() {
        Some((&constant, coefficients)) if coefficients.len() == inputs => {
            Ok(Conclusion::Linear { coefficients: coefficients.to_vec(), constant })
        }
        _ => {
            let count = inputs + 1;
            let expected = format!("{count}: a coefficient for each input, then the constant");
            Err(miscounted(written, expected))
        }
    }
}

fn miscounted(written: &Written, expected: String) -> Problem {
    let message = format!("has {} parameters", written.numbers.len());
    wrong(written.place, &written.name, message, expected)
}

fn finite(number: &Number) -> Result<(), Problem> {
    if number.value.is_finite() {
        return Ok(());
    }
    Err(wrong(number.place, number.word, "an infinity is not allowed here", "a finite number"))
}

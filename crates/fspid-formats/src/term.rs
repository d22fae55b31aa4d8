//! Membership functions from a word and numbers, as fuzzylite and jFuzzyLogic write them.

use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::{Conclusion, Membership};
use fspid_fuzzy::{Formula, FuzzyError};

use crate::lexer::Token;
use crate::number;
use crate::report::Report;
use crate::vocabulary::shapes::ToolShape;
use fspid_diagnostics::Place;

/// A number with its place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Number<'a> {
    pub(crate) value: f64,
    pub(crate) text: &'a str,
    pub(crate) place: Place,
}

/// The number that a token stands for, infinities included; what is wrong is reported.
pub(crate) fn number<'a>(token: Token<'a>, report: &mut Report) -> Option<Number<'a>> {
    let (text, place) = (token.text, token.place());
    match number::ordered(text) {
        Ok(value) => Some(Number { value, text, place }),
        Err(refused) => {
            report.problem(place, text, refused.to_string(), "a number");
            None
        }
    }
}

/// The same without infinities.
pub(crate) fn finite<'a>(token: Token<'a>, report: &mut Report) -> Option<Number<'a>> {
    let number = number(token, report)?;
    if !number.value.is_finite() {
        report.problem(number.place, number.text, "an infinity is not allowed here", "");
    }
    number.value.is_finite().then_some(number)
}

/// A row's shape with these parameters; one number more is the height.
pub(crate) fn shape(
    row: &ToolShape,
    word: Token,
    numbers: &[Number],
    report: &mut Report,
) -> Option<Membership> {
    let (numbers, height) = without_height(row.kind, numbers, report)?;
    let params = row.ours(numbers.iter().map(|number| number.value).collect());
    match row.kind.check(&params) {
        Ok(()) => Some(Membership::Shape { kind: row.kind, params, height }),
        Err(error) => {
            refuse(row, word, numbers, &error, report);
            None
        }
    }
}

fn without_height<'n, 'a>(
    kind: ShapeKind,
    numbers: &'n [Number<'a>],
    report: &mut Report,
) -> Option<(&'n [Number<'a>], f64)> {
    let own = kind.params().len();
    let more = if kind.repeats() { numbers.len() % own == 1 } else { numbers.len() == own + 1 };
    match numbers.split_last() {
        Some((height, rest)) if more => Some((rest, checked_height(height, report)?)),
        _ => Some((numbers, 1.0)),
    }
}

fn checked_height(height: &Number, report: &mut Report) -> Option<f64> {
    let allowed = height.value > 0.0 && height.value <= 1.0;
    if !allowed {
        let expected = "a number above 0, at most 1";
        report.problem(height.place, height.text, "not a height", expected);
    }
    allowed.then_some(height.value)
}

/// Says what is wrong with parameters, at the number that is wrong if it can be found.
fn refuse(
    row: &ToolShape,
    word: Token,
    numbers: &[Number],
    error: &FuzzyError,
    report: &mut Report,
) {
    match error {
        FuzzyError::Parameter { name, found, allowed } => {
            let same = |number: &&Number| number.value.to_bits() == found.to_bits();
            let place = numbers.iter().find(same).map(|number| (number.place, number.text));
            let (place, text) = place.unwrap_or((word.place(), word.text));
            report.problem(
                place,
                text,
                format!("not allowed as `{name}` of {}", row.word),
                *allowed,
            );
        }
        FuzzyError::ParameterCount { found, expected, repeats, .. } => {
            let several = if *repeats { "any multiple of " } else { "" };
            let message = format!("{} has {found} parameters", row.word);
            let expected = format!("{several}{expected}, and perhaps a height");
            report.problem(word.place(), word.text, message, expected);
        }
        other => report.problem(word.place(), word.text, other.to_string(), ""),
    }
}

/// What a reader is told of a system with such formulas.
pub(crate) const OUTPUTS_IN_FORMULAS: &str = "formulas that name an output find its new answer where it \
     stands before their own, else the answer before; without one they have no value";

/// Most variables of a formula: each of its names is looked for among them.
const MOST_NAMES: usize = 1000;

/// A formula in variables of these names; what is wrong is reported where it stands.
pub(crate) fn formula(text: Token, names: &[&str], report: &mut Report) -> Option<Formula> {
    if names.len() > MOST_NAMES {
        let message = format!("a formula in a system of {} variables", names.len());
        report.problem(text.place(), "", message, format!("at most {MOST_NAMES}"));
        return None;
    }
    match Formula::parse(text.text, names) {
        Ok(formula) => Some(formula),
        Err(error) => {
            let mut at = text.start;
            let end = text.start.rest().len() - error.position.min(text.text.len());
            while at.rest().len() > end && at.bump().is_some() {}
            report.problem(at.place(), "", format!("in the formula: {}", error.kind), "");
            None
        }
    }
}

/// $c_0$ last, a coefficient for each input before.
pub(crate) fn linear(
    word: Token,
    numbers: &[Number],
    inputs: usize,
    report: &mut Report,
) -> Option<Conclusion> {
    let values: Vec<f64> = numbers.iter().map(|number| number.value).collect();
    match values.split_last() {
        Some((&constant, coefficients)) if coefficients.len() == inputs => {
            Some(Conclusion::Linear { coefficients: coefficients.to_vec(), constant })
        }
        _ => {
            let message = format!("{} has {} numbers", word.text, values.len());
            let expected = format!("{}: one for each input, and the constant", inputs + 1);
            report.problem(word.place(), word.text, message, expected);
            None
        }
    }
}

/// A single number.
pub(crate) fn constant(word: Token, numbers: &[Number], report: &mut Report) -> Option<Conclusion> {
    if let [only] = numbers {
        return Some(Conclusion::Constant(only.value));
    }
    let message = format!("{} has {} numbers", word.text, numbers.len());
    report.problem(word.place(), word.text, message, "1");
    None
}

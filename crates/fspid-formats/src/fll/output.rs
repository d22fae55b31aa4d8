//! Output variables.

use fspid_fuzzy::system::{
    Conclusion, Defuzzifier, Fallback, FallbackValue, Membership, Output, OutputTerm, Sampling,
    SetReading,
};
use fspid_fuzzy::{MAX_SAMPLES, SNormKind};

use super::RESOLUTION;
use super::lines::{Line, numbers, whole};
use super::sections::{FllSection, defuzzifiers};
use super::term::{TermLine, membership, needs, terms};
use crate::lexer::{Kind, Token};
use crate::report::Report;
use crate::term;
use crate::tokens::Tokens;
use crate::vocabulary::norms::{self, S_NORMS};
use crate::vocabulary::{known, methods};

/// What the conclusions of an output may name.
#[derive(Clone, Copy)]
pub(super) struct Known<'k> {
    /// `x`, the inputs, the outputs.
    pub(super) with_x: &'k [&'k str],
    /// How many of them are inputs.
    pub(super) inputs: usize,
}

pub(super) fn read(section: &FllSection, known: Known, report: &mut Report) -> Option<Output> {
    let method = method(section, report);
    let integrates = method.is_none_or(|(method, _)| method.sampling().is_some());
    let mut found = Vec::new();
    for term in terms(section, report) {
        let conclusion = conclusion(&term, integrates, known, report);
        let name = term.name.text.into();
        found.extend(conclusion.map(|conclusion| OutputTerm { name, conclusion }));
    }
    let defuzzifier = method.map(|(method, kind)| resolved(method, kind, &found));
    let value = match section.default {
        default if default.is_nan() => FallbackValue::Nothing,
        default => FallbackValue::Number(default),
    };
    Some(Output {
        name: section.heading.text().into(),
        description: section.description.clone(),
        enabled: section.enabled,
        universe: section.universe,
        clamp: section.lock_range,
        aggregation: aggregation(section, integrates && method.is_some(), report).into(),
        terms: found,
        defuzzifier: defuzzifier.unwrap_or_default(),
        fallback: Fallback { previous: section.lock_previous, value },
    })
}

/// Weighted methods may do without; equal conclusions then add up.
fn aggregation(section: &FllSection, integrates: bool, report: &mut Report) -> SNormKind {
    if section.aggregation.is_none() && integrates {
        let message = "has no aggregation, but its defuzzifier integrates";
        needs(section.heading, message, norms::classes(S_NORMS), report);
    }
    section.aggregation.unwrap_or(SNormKind::UnboundedSum)
}

/// How a weighted defuzzifier is told to read fuzzy sets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Weighted {
    Automatic,
    TakagiSugeno,
    Tsukamoto,
}

/// Types of weighted defuzzifiers.
const TYPES: [(&str, Weighted); 3] = [
    ("Automatic", Weighted::Automatic),
    ("TakagiSugeno", Weighted::TakagiSugeno),
    ("Tsukamoto", Weighted::Tsukamoto),
];

fn method(section: &FllSection, report: &mut Report) -> Option<(Defuzzifier, Weighted)> {
    let Some(line) = section.defuzzifier.filter(|line| !line.is_none()) else {
        needs(section.heading, "has no defuzzifier", methods::classes(), report);
        return None;
    };
    let mut tokens = line.tokens();
    let class = tokens.advance();
    let Some(row) = methods::of_class(class.text) else {
        let expected = defuzzifiers(class.text);
        report.problem(class.place(), class.text, "not known as a defuzzifier", expected);
        return None;
    };
    if row.method.sampling().is_some() {
        let sampling = Sampling::Midpoint(resolution(line, tokens, report)?);
        return Some((row.method.with_sampling(sampling), Weighted::Automatic));
    }
    Some((row.method, weighted(tokens, report)?))
}

fn resolution(line: Line, tokens: Tokens, report: &mut Report) -> Option<u32> {
    let found = numbers(tokens, report)?;
    let count = match found[..] {
        [] => Some(RESOLUTION),
        [only] => whole(only.value).filter(|count| (1..=MAX_SAMPLES).contains(count)),
        _ => None,
    };
    if count.is_none() {
        let expected = format!("one whole number from 1 to {MAX_SAMPLES}");
        line.wrong("not a resolution", &expected, report);
    }
    count
}

fn weighted(mut tokens: Tokens, report: &mut Report) -> Option<Weighted> {
    if tokens.next.kind == Kind::End {
        return Some(Weighted::Automatic);
    }
    let word = tokens.advance();
    let found = TYPES.iter().find(|row| word.is(row.0));
    match (found, tokens.next.kind) {
        (Some(row), Kind::End) => Some(row.1),
        _ => {
            let expected = known(TYPES.iter().map(|row| row.0), word.text);
            report.problem(word.place(), word.text, "not a type of this defuzzifier", expected);
            None
        }
    }
}

/// The method with its reading of sets, which only matters if there are any.
fn resolved(method: Defuzzifier, kind: Weighted, terms: &[OutputTerm]) -> Defuzzifier {
    let mut sets = terms.iter().filter_map(|term| match &term.conclusion {
        Conclusion::Set { membership, .. } => Some(membership),
        _ => None,
    });
    let inverse = match kind {
        Weighted::Tsukamoto => false,
        Weighted::TakagiSugeno => sets.next().is_some(),
        Weighted::Automatic => !sets.all(is_monotone),
    };
    let reading = if inverse { SetReading::InverseTsukamoto } else { SetReading::Tsukamoto };
    match method {
        Defuzzifier::WeightedAverage(_) => Defuzzifier::WeightedAverage(reading),
        Defuzzifier::WeightedSum(_) => Defuzzifier::WeightedSum(reading),
        other => other,
    }
}

/// True for sets that rise or fall throughout.
pub(crate) fn is_monotone(membership: &Membership) -> bool {
    match membership {
        Membership::Shape { kind, params, .. } => kind.inverse(params, 0.5_f64).is_some(),
        Membership::Formula { .. } => false,
    }
}

fn conclusion(
    term: &TermLine,
    integrates: bool,
    variables: Known,
    report: &mut Report,
) -> Option<Conclusion> {
    let TermLine { class, mut rest, .. } = *term;
    let Known { with_x, inputs } = variables;
    if class.is("Constant") {
        return term::constant(class, &finite(rest, report)?, report);
    }
    if class.is("Linear") {
        return term::linear(class, &finite(rest, report)?, inputs, report);
    }
    if class.is("Function") && !integrates {
        return term::formula(rest.take_raw('\n'), with_x.get(1..).unwrap_or_default(), report)
            .map(Conclusion::Formula);
    }
    let membership = membership(term, with_x, report)?;
    Some(Conclusion::Set { membership, lower: None })
}

fn finite<'a>(mut tokens: Tokens<'a>, report: &mut Report) -> Option<Vec<term::Number<'a>>> {
    let mut found = Some(Vec::new());
    while tokens.next.kind != Kind::End {
        let token: Token = tokens.advance();
        found = found.zip(term::finite(token, report)).map(|(mut found, number)| {
            found.push(number);
            found
        });
    }
    found
}

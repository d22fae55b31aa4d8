//! From text to the parts of a system.

use std::collections::BTreeMap;

use fspid_formats::rule_text::RuleReader;
use fspid_fuzzy::system::{
    Defuzzifier, Fallback, FallbackValue, Input, Output, Parts, RuleBlock, Sampling, System,
    SystemError, Universe,
};

use super::conclusion::{self, Variables};
use super::fields::any_number;
use super::rules::Vocabulary;
use super::spec::{self as keys, FUZZY_SYSTEM, fallback_in_words, sampling_in_words};
use super::{activation, membership, norm, rules};
use crate::keyed::Section;
use crate::keyed::check;
use crate::keyed::document::{self, Value as Written};
use fspid_diagnostics::{Problems, Report, Span, in_two};

/// Where the things of a file stand, by what [`System::new`] calls them.
type Places = BTreeMap<String, Span>;

/// Reads a system from a text that is called `name` in messages.
///
/// # Errors
/// Everything that is wrong with it.
pub fn parse(text: &str, name: &str) -> Result<System, Problems> {
    let mut report = Report::default();
    let system = read(&mut report, text);
    report.finish(name)?;
    // Without a problem there is a system; the other case would be a mistake in this module.
    system.ok_or_else(|| Problems::new(name, Vec::new(), 0))
}

fn read(report: &mut Report, text: &str) -> Option<System> {
    let document = document::read(report, None, text)?;
    let section = check::table(report, &FUZZY_SYSTEM, &document, "")?;
    let mut places = Places::new();
    let parts = parts(report, &section, &mut places)?;
    if report.count() > 0 {
        return None;
    }
    let whole = section.place;
    System::new(parts).map_err(|errors| tell(report, &errors, &places, whole)).ok()
}

/// Problems of the parts among each other, told where the parts stand.
fn tell(report: &mut Report, errors: &[SystemError], places: &Places, whole: Span) {
    for error in errors {
        let place = places.get(&error.place).copied().unwrap_or(whole);
        let text = error.problem.to_string();
        let (message, allowed) = in_two(&text);
        report.missing(place, &error.place, message, allowed);
    }
}

fn parts(report: &mut Report, section: &Section, places: &mut Places) -> Option<Parts> {
    let named = |kind| section.sections(kind).iter().map(|s| s.get(keys::NAME).unwrap_or_default());
    let names: Vec<&str> = named(keys::INPUT).collect();
    let of_values: Vec<&str> = names.iter().copied().chain(named(keys::OUTPUT)).collect();
    let of_sets: Vec<&str> = std::iter::once("x").chain(of_values.iter().copied()).collect();
    let variables = Variables { inputs: &names, of_values: &of_values, of_sets: &of_sets };
    let mut found = (Vec::new(), Vec::new(), Vec::new());
    for part in section.sections(keys::INPUT) {
        found.0.extend(input(report, part, &of_sets, places));
    }
    for part in section.sections(keys::OUTPUT) {
        found.1.extend(output(report, part, variables, places));
    }
    let (inputs, outputs, mut blocks) = found;
    let complete =
        inputs.len() == names.len() && outputs.len() == section.sections(keys::OUTPUT).len();
    // Rules about variables that could not be read would only echo their problems.
    if complete {
        let reader = RuleReader::new(&inputs, &outputs);
        let vocabulary = Vocabulary { inputs: &inputs, outputs: &outputs, reader: &reader };
        let sections = section.sections(keys::RULES);
        for (index, part) in sections.iter().enumerate() {
            blocks.extend(block(report, part, vocabulary, (index, sections.len()), places));
        }
    }
    let text = |key| section.get::<str>(key).unwrap_or_default().to_owned();
    Some(Parts {
        name: text(keys::SYSTEM_NAME),
        description: text(keys::DESCRIPTION),
        inputs,
        outputs,
        blocks,
    })
}

fn universe(section: &Section) -> Option<Universe> {
    section.get(keys::RANGE).map(|(lower, upper)| Universe { lower, upper })
}

fn description(section: &Section) -> String {
    section.get(keys::DESCRIPTION).unwrap_or_default().to_owned()
}

fn input(
    report: &mut Report,
    section: &Section,
    of_sets: &[&str],
    places: &mut Places,
) -> Option<Input> {
    let name = section.get(keys::NAME)?.to_owned();
    let place = format!("input `{name}`");
    places.insert(place.clone(), section.at(keys::NAME));
    let path = section.path(keys::INPUT_TERMS);
    let terms =
        membership::terms(report, section.get(keys::INPUT_TERMS), &path, of_sets, |term, item| {
            places.insert(format!("{place}, term `{term}`"), item.place);
        });
    Some(Input {
        name,
        description: description(section),
        enabled: section.get(keys::ENABLED)?,
        universe: universe(section),
        out_of_range: section.get(keys::OUT_OF_RANGE)?,
        terms: terms?,
    })
}

fn output(
    report: &mut Report,
    section: &Section,
    variables: Variables<'_>,
    places: &mut Places,
) -> Option<Output> {
    let name = section.get(keys::NAME)?.to_owned();
    let place = format!("output `{name}`");
    places.insert(place.clone(), section.at(keys::NAME));
    let path = section.path(keys::OUTPUT_TERMS);
    let terms = conclusion::terms(
        report,
        section.get(keys::OUTPUT_TERMS),
        &path,
        variables,
        |term, item| {
            places.insert(format!("{place}, term `{term}`"), item.place);
        },
    );
    let aggregation =
        norm::read_or(report, section.get(keys::AGGREGATION), &section.path(keys::AGGREGATION));
    let defuzzifier = defuzzifier(report, section);
    let value = fallback(report, section);
    Some(Output {
        name,
        description: description(section),
        enabled: section.get(keys::ENABLED)?,
        universe: universe(section),
        clamp: section.get(keys::CLAMP)?,
        terms: terms?,
        aggregation: aggregation?,
        defuzzifier: defuzzifier?,
        fallback: Fallback { previous: section.get(keys::KEEP_PREVIOUS)?, value: value? },
    })
}

fn defuzzifier(report: &mut Report, section: &Section) -> Option<Defuzzifier> {
    let reading = section.get(keys::SET_READING)?;
    let method = match Defuzzifier::from_name(section.get(keys::DEFUZZIFIER)?)? {
        Defuzzifier::WeightedAverage(_) => Defuzzifier::WeightedAverage(reading),
        Defuzzifier::WeightedSum(_) => Defuzzifier::WeightedSum(reading),
        integral => integral,
    };
    let Some(item) = section.get(keys::SAMPLING) else { return Some(method) };
    let path = section.path(keys::SAMPLING);
    if method.sampling().is_none() {
        let message = format!("not together with {}, which has no integral", method.name());
        report.missing(item.place, &path, message, "no such key");
        return None;
    }
    let text = if let Written::Text(text) = &item.value { text } else { "" };
    let sampling: Option<Sampling> = text.parse().ok();
    if sampling.is_none() {
        report.value(item.place, &path, "unknown rule", sampling_in_words());
    }
    sampling.map(|sampling| method.with_sampling(sampling))
}

fn fallback(report: &mut Report, section: &Section) -> Option<FallbackValue> {
    let Some(item) = section.get(keys::FALLBACK) else { return Some(FallbackValue::Nothing) };
    let found = match &item.value {
        Written::Text(text) if text == "none" => Some(FallbackValue::Nothing),
        Written::Text(text) if text == "middle" => Some(FallbackValue::Middle),
        _ => any_number(item).filter(|number| number.is_finite()).map(FallbackValue::Number),
    };
    if found.is_none() {
        report.value(item.place, &section.path(keys::FALLBACK), "not allowed", fallback_in_words());
    }
    found
}

fn block(
    report: &mut Report,
    section: &Section,
    vocabulary: Vocabulary<'_>,
    (index, count): (usize, usize),
    places: &mut Places,
) -> Option<RuleBlock> {
    let and = norm::read_and(report, section.get(keys::AND), &section.path(keys::AND));
    let or = norm::read_or(report, section.get(keys::OR), &section.path(keys::OR));
    let path = section.path(keys::IMPLICATION);
    let implication = norm::read_and(report, section.get(keys::IMPLICATION), &path);
    let path = section.path(keys::ACTIVATION);
    let activation = activation::read(report, section.get(keys::ACTIVATION), &path);
    let rules = rules::read(report, section, vocabulary)?;
    let name = section.get(keys::NAME).unwrap_or_default().to_owned();
    places.insert(format!("rule block {}", index + 1), section.place);
    for (number, (_, place)) in (1..).zip(&rules) {
        // In the words of `System::new`.
        let words = match (count, name.as_str()) {
            (1, _) => format!("rule {number}"),
            (_, "") => format!("rule block {}, rule {number}", index + 1),
            (_, name) => format!("rule block `{name}`, rule {number}"),
        };
        places.insert(words, *place);
    }
    Some(RuleBlock {
        name,
        description: description(section),
        enabled: section.get(keys::ENABLED)?,
        and: and?,
        or: or?,
        implication: implication?,
        activation: activation?,
        rules: rules.into_iter().map(|(rule, _)| rule).collect(),
    })
}

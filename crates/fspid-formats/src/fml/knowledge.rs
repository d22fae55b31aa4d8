//! The knowledge base: variables with their terms.

use std::collections::BTreeSet;

use fspid_fuzzy::system::{
    Conclusion, Defuzzifier, Fallback, FallbackValue, Input, Membership, Output, OutputTerm, Term,
    Universe,
};
use fspid_fuzzy::{OutOfRange, SNormKind};

use super::document::{Context, Element};
use super::shape;
use super::words::{DEFUZZIFIERS, S_NORMS};
use crate::hedged;
use crate::names::{Index, Names};

/// Elements of variables.
const VARIABLES: [&str; 3] = ["fuzzyVariable", "tskVariable", "tsukamotoVariable"];

/// What the variables are, and what rules need to know of them beside.
#[derive(Default)]
pub(super) struct Knowledge {
    pub(super) inputs: Vec<Input>,
    pub(super) outputs: Vec<Output>,
    /// Inputs and terms that are complements: position of the input, then of the term.
    pub(super) complements: BTreeSet<(usize, usize)>,
}

impl Knowledge {
    /// The names that rules may use.
    pub(super) fn names(&self) -> Names {
        let mut names = Names::empty(true);
        for input in &self.inputs {
            let terms: Index = input.terms.iter().map(|term| term.name.as_str()).collect();
            names.push(&input.name, false, terms);
        }
        for output in &self.outputs {
            let terms: Index = output.terms.iter().map(|term| term.name.as_str()).collect();
            names.push(&output.name, true, terms);
        }
        names
    }

    /// The inputs, with each complemented set under the name of what it holds: the file's term is *not* it, and a rule
    /// that names the term has that `not` before it.
    pub(super) fn named_inputs(&mut self) -> Vec<Input> {
        let mut inputs = std::mem::take(&mut self.inputs);
        for &(input, term) in &self.complements {
            let Some(term) = inputs.get_mut(input).and_then(|it| it.terms.get_mut(term)) else {
                continue;
            };
            term.name = format!("complement of {}", term.name);
        }
        inputs
    }
}

/// Reads the knowledge base.
pub(super) fn read(base: Element<'_, '_>, context: &mut Context<'_>) -> Knowledge {
    context.only(base, &[]);
    let mut knowledge = Knowledge::default();
    let mut seen = BTreeSet::new();
    let mut variables = Vec::new();
    for element in base.children() {
        if !element.is_any(&VARIABLES) {
            refuse(element, context);
            continue;
        }
        let name = context.name(element);
        if !name.is_empty() && !seen.insert(name.clone()) {
            context.problem(element.place_of("name"), &name, "is there twice", "names that differ");
        }
        variables.push((element, name, is_output(element, context)));
    }
    for (element, name, _) in variables.iter().filter(|variable| !variable.2) {
        let position = knowledge.inputs.len();
        let found = input(*element, name, position, &mut knowledge.complements, context);
        knowledge.inputs.push(found);
    }
    let inputs = knowledge.inputs.len();
    for (element, name, _) in variables.iter().filter(|variable| variable.2) {
        knowledge.outputs.push(output(*element, name, inputs, context));
    }
    knowledge
}

fn refuse(element: Element<'_, '_>, context: &mut Context<'_>) {
    let message = match element.name().to_ascii_lowercase().as_str() {
        "aggregatedfuzzyvariable" => "a variable that is put together from others is not read",
        "anyadatacloud" => "clouds of data (AnYa) are not read",
        _ => return context.refuse(element, "knowledgeBase", &VARIABLES),
    };
    context.problem(element.start(), element.name(), message, "");
}

/// A fuzzy variable is an input unless it says otherwise, the others are outputs.
fn is_output(element: Element<'_, '_>, context: &mut Context<'_>) -> bool {
    const TYPES: [(&str, bool); 2] = [("input", false), ("output", true)];
    let fuzzy = element.is("fuzzyVariable");
    let output = context.choice(element, "type", &TYPES).unwrap_or(!fuzzy);
    if !output && !fuzzy {
        let message = format!("a <{}> is an output", element.name());
        context.problem(element.place_of("type"), "input", message, "`output`");
    }
    output || !fuzzy
}

/// From `domainleft` to `domainright`.
fn universe(element: Element<'_, '_>, context: &mut Context<'_>) -> Option<Universe> {
    if let Some(scale) = element.attribute("scale").filter(|scale| *scale != "null") {
        let message = format!("the scale `{}` is not kept", crate::report::clipped(scale));
        context.note(element.place_of("scale"), message);
    }
    let lower = context.number(element, "domainleft");
    let upper = context.number(element, "domainright");
    let (Some(lower), Some(upper)) = (lower, upper) else {
        if element.attribute("domainleft").is_some() != element.attribute("domainright").is_some() {
            let expected = "`domainleft` and `domainright`";
            context.problem(element.start(), "", "has one end of a domain only", expected);
        }
        return None;
    };
    if lower < upper && (upper - lower).is_finite() {
        return Some(Universe { lower, upper });
    }
    let word = element.attribute("domainright").unwrap_or_default();
    let expected = "two finite numbers in ascending order";
    context.problem(element.place_of("domainright"), word, "not a domain", expected);
    None
}

const OF_INPUTS: [&str; 5] = ["name", "scale", "domainleft", "domainright", "type"];
const OF_OUTPUTS: [&str; 8] = [
    "name",
    "scale",
    "domainleft",
    "domainright",
    "type",
    "accumulation",
    "defuzzifier",
    "defaultValue",
];

fn input(
    element: Element<'_, '_>,
    name: &str,
    position: usize,
    complements: &mut BTreeSet<(usize, usize)>,
    context: &mut Context<'_>,
) -> Input {
    // Inputs are written with the attributes of outputs too; they say nothing there.
    context.only(element, &OF_OUTPUTS);
    for unused in OF_OUTPUTS.iter().filter(|name| !OF_INPUTS.contains(name)) {
        if element.attribute(unused).is_some() {
            let message = format!("`{unused}` of an input has no effect");
            context.note_once(element.place_of(unused), &message);
        }
    }
    let mut terms = Vec::new();
    for (term, complement) in fuzzy_terms(element, context) {
        let label = context.name(term);
        if complement {
            complements.insert((position, terms.len()));
        }
        let membership = shape::read(term, context).unwrap_or_else(placeholder);
        terms.push(Term { name: label, membership, lower: None });
    }
    Input {
        name: name.to_owned(),
        description: String::new(),
        enabled: true,
        universe: universe(element, context),
        out_of_range: OutOfRange::Evaluate,
        terms,
    }
}

/// Never handed out: a problem has been reported.
fn placeholder() -> Membership {
    let kind = fspid_fuzzy::membership::ShapeKind::Triangle;
    Membership::Shape { kind, params: kind.example().to_vec(), height: 1.0 }
}

/// The terms of a fuzzy variable, and which are complements.
fn fuzzy_terms<'x, 'i>(
    variable: Element<'x, 'i>,
    context: &mut Context<'_>,
) -> Vec<(Element<'x, 'i>, bool)> {
    const TERMS: [&str; 2] = ["fuzzyTerm", "tsukamotoTerm"];
    const TRUTHS: [(&str, bool); 4] = [("true", true), ("false", false), ("1", true), ("0", false)];
    let mut found = Vec::new();
    for term in variable.children() {
        if term.is_any(&TERMS) {
            context.only(term, &["name", "complement"]);
            let complement = context.choice(term, "complement", &TRUTHS).unwrap_or(false);
            found.push((term, complement));
        } else {
            context.refuse(term, variable.name(), &TERMS);
        }
    }
    let places = found.iter().map(|(term, _)| *term);
    distinct(places.collect(), context);
    found
}

fn distinct(terms: Vec<Element<'_, '_>>, context: &mut Context<'_>) {
    let mut seen = BTreeSet::new();
    for term in terms {
        let name = term.attribute("name").unwrap_or_default();
        if !name.is_empty() && !seen.insert(name) {
            context.problem(term.place_of("name"), name, "is there twice", "names that differ");
        }
    }
}

fn output(
    element: Element<'_, '_>,
    name: &str,
    inputs: usize,
    context: &mut Context<'_>,
) -> Output {
    let weighted = !element.is("fuzzyVariable");
    let (aggregation, defuzzifier) =
        if weighted { weighs(element, context) } else { joins(element, context) };
    let terms = match element.is("tskVariable") {
        true => numbers(element, inputs, context),
        false => sets(element, context),
    };
    Output {
        name: name.to_owned(),
        description: String::new(),
        enabled: true,
        universe: universe(element, context),
        clamp: false,
        terms,
        aggregation: aggregation.into(),
        defuzzifier,
        fallback: Fallback { previous: false, value: default(element, context) },
    }
}

/// Fuzzy conclusions are joined, and a number is read off.
fn joins(element: Element<'_, '_>, context: &mut Context<'_>) -> (SNormKind, Defuzzifier) {
    context.only(element, &OF_OUTPUTS);
    let defuzzifier = context.choice(element, "defuzzifier", DEFUZZIFIERS);
    let accumulation = context.choice(element, "accumulation", S_NORMS);
    for (name, assumed) in [("defuzzifier", "COG"), ("accumulation", "MAX")] {
        if element.attribute(name).is_none() {
            let message = format!("no {name} is given; `{assumed}` is assumed");
            context.note_once(element.start(), &message);
        }
    }
    (accumulation.unwrap_or(SNormKind::Maximum), defuzzifier.unwrap_or_default())
}

/// Numbers are weighted: `WA` is the only way that the standard has.
fn weighs(element: Element<'_, '_>, context: &mut Context<'_>) -> (SNormKind, Defuzzifier) {
    const AVERAGE: [(&str, ()); 1] = [("WA", ())];
    context.only(
        element,
        &[
            "name",
            "scale",
            "domainleft",
            "domainright",
            "type",
            "combination",
            "defuzzifier",
            "defaultValue",
        ],
    );
    context.choice(element, "combination", &AVERAGE);
    context.choice(element, "defuzzifier", &AVERAGE);
    (SNormKind::UnboundedSum, Defuzzifier::WeightedAverage(Default::default()))
}

/// `NaN` is how our own files say that there is none.
fn default(element: Element<'_, '_>, context: &mut Context<'_>) -> FallbackValue {
    match element.attribute("defaultValue") {
        Some("NaN") => FallbackValue::Nothing,
        Some(_) => context
            .number(element, "defaultValue")
            .map_or(FallbackValue::Nothing, FallbackValue::Number),
        None => {
            context.note_once(element.start(), "no defaultValue is given; 0 is assumed");
            FallbackValue::Number(0.0)
        }
    }
}

fn sets(element: Element<'_, '_>, context: &mut Context<'_>) -> Vec<OutputTerm> {
    let mut terms = Vec::new();
    for (term, complement) in fuzzy_terms(element, context) {
        let name = context.name(term);
        let mut membership = shape::read(term, context).unwrap_or_else(placeholder);
        if complement {
            match hedged::set(&membership, None, true) {
                Some(other) => membership = other,
                None => {
                    let message = "the complement of such a set is not read in an output";
                    context.problem(term.place_of("complement"), "true", message, "`false`");
                }
            }
        }
        terms.push(OutputTerm { name, conclusion: Conclusion::Set { membership, lower: None } });
    }
    terms
}

/// Numbers and planes: the constant stands last.
fn numbers(element: Element<'_, '_>, inputs: usize, context: &mut Context<'_>) -> Vec<OutputTerm> {
    let mut terms = Vec::new();
    for term in element.children() {
        if !term.is("tskTerm") {
            context.refuse(term, element.name(), &["tskTerm"]);
            continue;
        }
        context.only(term, &["name", "order"]);
        let name = context.name(term);
        let conclusion = plane(term, inputs, context).unwrap_or(Conclusion::Constant(0.0));
        terms.push(OutputTerm { name, conclusion });
    }
    distinct(element.children().filter(|term| term.is("tskTerm")).collect(), context);
    terms
}

fn plane(term: Element<'_, '_>, inputs: usize, context: &mut Context<'_>) -> Option<Conclusion> {
    let mut values = Vec::new();
    for value in term.children() {
        if !value.is("tskValue") {
            context.refuse(value, term.name(), &["tskValue"]);
            return None;
        }
        values.push(context.finite(value.start(), &value.text())?);
    }
    const ORDERS: [(&str, bool); 2] = [("0", false), ("1", true)];
    let linear = context.choice(term, "order", &ORDERS).unwrap_or(values.len() > 1);
    let wanted = if linear { inputs + 1 } else { 1 };
    if values.len() != wanted {
        let message = format!("the term has {} values", values.len());
        let expected = match linear {
            true => format!("{wanted}: one for each input, then the constant"),
            false => "1 for the order 0".to_owned(),
        };
        context.problem(
            term.start(),
            term.attribute("name").unwrap_or_default(),
            message,
            expected,
        );
        return None;
    }
    let constant = values.pop()?;
    if !linear {
        return Some(Conclusion::Constant(constant));
    }
    let message =
        "the last value of a term of order 1 is read as its constant; some tools begin with it";
    context.note_once(term.start(), message);
    Some(Conclusion::Linear { coefficients: values, constant })
}

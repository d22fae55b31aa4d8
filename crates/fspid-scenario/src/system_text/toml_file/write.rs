//! From the parts of a system to text: everything can be said, with the shortest digits that read
//! back as the same numbers. What is as the defaults have it is left out.

use fspid_fuzzy::OutOfRange;
use fspid_fuzzy::norm::{SNormKind, TNormKind};
use fspid_fuzzy::system::{
    Activation, Conclusion, Defuzzifier, FallbackValue, Input, Membership, Output, Parts,
    RuleBlock, Sampling, SetReading, Universe,
};

use super::{activation, norm, rules};
use crate::toml_text::{key, quoted};

/// The text of a system's file.
#[must_use]
pub fn write(parts: &Parts) -> String {
    let mut out = Writer::default();
    out.line("schema = 1");
    out.line("kind = \"fuzzy-system\"");
    out.text("name", &parts.name);
    out.text("description", &parts.description);
    for input in &parts.inputs {
        out.input(input);
    }
    for output in &parts.outputs {
        out.output(output, parts);
    }
    for block in &parts.blocks {
        out.block(block, parts);
    }
    out.0
}

/// Lines of a file.
#[derive(Default)]
struct Writer(String);

impl Writer {
    fn line(&mut self, line: &str) {
        self.0.push_str(line);
        self.0.push('\n');
    }

    fn heading(&mut self, heading: &str) {
        self.0.push('\n');
        self.line(heading);
    }

    fn pair(&mut self, name: &str, value: &str) {
        self.line(&format!("{name} = {value}"));
    }

    fn text(&mut self, name: &str, text: &str) {
        if !text.is_empty() {
            self.pair(name, &quoted(text));
        }
    }

    fn pair_if(&mut self, given: bool, name: &str, value: &str) {
        if given {
            self.pair(name, value);
        }
    }

    fn variable(&mut self, name: &str, description: &str, enabled: bool, range: Option<Universe>) {
        self.pair("name", &quoted(name));
        self.text("description", description);
        self.pair_if(!enabled, "enabled", "false");
        if let Some(Universe { lower, upper }) = range {
            self.pair("range", &numbers(&[lower, upper]));
        }
    }

    fn input(&mut self, input: &Input) {
        self.heading("[[input]]");
        self.variable(&input.name, &input.description, input.enabled, input.universe);
        let policy = input.out_of_range;
        self.pair_if(policy != OutOfRange::Evaluate, "out_of_range", &quoted(policy.name()));
        self.terms(
            "[input.terms]",
            input
                .terms
                .iter()
                .map(|term| (term.name.as_str(), set(&term.membership, term.lower.as_ref()))),
        );
    }

    fn output(&mut self, output: &Output, parts: &Parts) {
        self.heading("[[output]]");
        self.variable(&output.name, &output.description, output.enabled, output.universe);
        self.pair_if(output.clamp, "clamp", "true");
        self.defuzzifier(output.defuzzifier);
        let joined = &output.aggregation;
        self.pair_if(!joined.is(SNormKind::Maximum), "aggregation", &norm::write_or(joined));
        self.pair_if(output.fallback.previous, "keep_previous", "true");
        match output.fallback.value {
            FallbackValue::Nothing => {}
            FallbackValue::Middle => self.pair("fallback", "\"middle\""),
            FallbackValue::Number(value) => self.pair("fallback", &number(value)),
        }
        self.terms(
            "[output.terms]",
            output
                .terms
                .iter()
                .map(|term| (term.name.as_str(), conclusion(&term.conclusion, parts))),
        );
    }

    fn defuzzifier(&mut self, method: Defuzzifier) {
        self.pair("defuzzifier", &quoted(method.name()));
        if let Some(sampling) = method.sampling().filter(|s| *s != Sampling::Exact) {
            self.pair("sampling", &quoted(&sampling.to_string()));
        }
        if let Defuzzifier::WeightedAverage(reading) | Defuzzifier::WeightedSum(reading) = method {
            let inverse = reading == SetReading::InverseTsukamoto;
            self.pair_if(inverse, "set_reading", "\"inverse-tsukamoto\"");
        }
    }

    fn terms<'a>(&mut self, heading: &str, terms: impl Iterator<Item = (&'a str, String)>) {
        let mut terms = terms.peekable();
        if terms.peek().is_some() {
            self.heading(heading);
        }
        for (name, value) in terms {
            self.pair(&key(name), &value);
        }
    }

    fn block(&mut self, block: &RuleBlock, parts: &Parts) {
        self.heading("[[rules]]");
        self.text("name", &block.name);
        self.text("description", &block.description);
        self.pair_if(!block.enabled, "enabled", "false");
        self.pair_if(!block.and.is(TNormKind::Minimum), "and", &norm::write_and(&block.and));
        self.pair_if(!block.or.is(SNormKind::Maximum), "or", &norm::write_or(&block.or));
        let shaped = &block.implication;
        self.pair_if(!shaped.is(TNormKind::Minimum), "implication", &norm::write_and(shaped));
        let acting = block.activation;
        self.pair_if(acting != Activation::General, "activation", &activation::write(acting));
        self.0.push_str(&rules::write(block, parts));
    }
}

/// A fuzzy set as an inline table.
fn set(membership: &Membership, lower: Option<&Membership>) -> String {
    let mut pairs = membership_pairs(membership);
    pairs
        .extend(lower.map(|lower| format!("lower = {{ {} }}", membership_pairs(lower).join(", "))));
    format!("{{ {} }}", pairs.join(", "))
}

fn membership_pairs(membership: &Membership) -> Vec<String> {
    let (mut pairs, height) = match membership {
        Membership::Formula { formula, height } => {
            (vec![format!("formula = {}", quoted(formula.text()))], *height)
        }
        Membership::Shape { kind, params, height } => {
            let mut pairs = vec![format!("shape = {}", quoted(kind.name()))];
            if kind.repeats() {
                let rows: Vec<String> =
                    params.chunks(kind.params().len().max(1)).map(numbers).collect();
                pairs.push(format!("points = [{}]", rows.join(", ")));
            } else {
                let named = kind.params().iter().zip(params);
                pairs.extend(
                    named.map(|(param, value)| format!("{} = {}", param.name, number(*value))),
                );
            }
            (pairs, *height)
        }
    };
    if height < 1.0 {
        pairs.push(format!("height = {}", number(height)));
    }
    pairs
}

fn conclusion(conclusion: &Conclusion, parts: &Parts) -> String {
    match conclusion {
        Conclusion::Set { membership, lower } => set(membership, lower.as_ref()),
        Conclusion::Constant(value) => number(*value),
        Conclusion::Interval(ends) => format!("{{ between = {} }}", numbers(ends)),
        Conclusion::Formula(formula) => format!("{{ value = {} }}", quoted(formula.text())),
        Conclusion::Linear { coefficients, constant } => {
            let slopes: Vec<String> = parts
                .inputs
                .iter()
                .zip(coefficients)
                .filter(|(_, slope)| slope.to_bits() != 0)
                .map(|(input, slope)| format!("{} = {}", key(&input.name), number(*slope)))
                .collect();
            let slopes = match slopes.is_empty() {
                true => "{}".to_owned(),
                false => format!("{{ {} }}", slopes.join(", ")),
            };
            format!("{{ constant = {}, slopes = {slopes} }}", number(*constant))
        }
    }
}

/// The shortest digits that read back as the same number.
pub(super) fn number(value: f64) -> String {
    format!("{value:?}")
}

fn numbers(values: &[f64]) -> String {
    let written: Vec<String> = values.iter().map(|value| number(*value)).collect();
    format!("[{}]", written.join(", "))
}

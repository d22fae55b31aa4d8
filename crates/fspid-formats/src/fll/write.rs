//! Writing.

use fspid_fuzzy::system::{
    Conclusion, Defuzzifier, FallbackValue, Input, Membership, Output, Parts, RuleBlock, SNorm,
    Sampling, SetReading, TNorm, Universe,
};
use fspid_fuzzy::{OutOfRange, SNormKind};

use super::{RESOLUTION, activation, readable};
use crate::loss::Loss;
use crate::note::{WriteOptions, Writing};
use crate::number::{written as number, written_all};
use crate::rule::{self, Style};
use crate::vocabulary::shapes::{self, FUZZYLITE};
use crate::vocabulary::{methods, norms};
use crate::{adapt, identifiers};
use fspid_diagnostics::Problems;

/// Writes a system in the FuzzyLite Language, with every digit that a number needs.
///
/// # Errors
/// What the language has no words for, unless `options` allow a loss; parts that are no system.
pub fn write(parts: &Parts, options: WriteOptions) -> Result<Writing, Problems> {
    let mut loss = Loss::new(parts, options)?;
    let adapted = adapted(parts, &mut loss);
    let text = Writer { parts: &adapted, loss: &mut loss }.text();
    loss.finish(text, parts, &adapted)
}

const NAMES: identifiers::Rule = identifiers::Rule {
    readable,
    documented: |name| name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_'),
    description: "letters, digits and underscores",
};

/// The nearest system that the language can say.
fn adapted(parts: &Parts, loss: &mut Loss) -> Parts {
    let mut parts = parts.clone();
    NAMES.apply(&mut parts, loss);
    adapt::without_disabled_rules(&mut parts, loss);
    adapt::without_rule_names(&mut parts, loss);
    rule::arrange(&mut parts, loss);
    one_line(&mut parts, loss);
    for input in &mut parts.inputs {
        if input.out_of_range == OutOfRange::Error {
            loss.lose(&input.name, "refuses values outside its range", "no such check");
            input.out_of_range = OutOfRange::Evaluate;
        }
    }
    for output in &mut parts.outputs {
        adapt::numbered_fallback(output);
        adapt::sampled(output, loss, Sampling::Midpoint(RESOLUTION), |sampling| {
            matches!(sampling, Sampling::Midpoint(_))
        });
    }
    parts
}

/// Texts end with their line, and at a `#`.
fn one_line(parts: &mut Parts, loss: &mut Loss) {
    let Parts { name, description, inputs, outputs, blocks } = parts;
    let texts = [name, description].into_iter();
    let texts = texts.chain(inputs.iter_mut().map(|input| &mut input.description));
    let texts = texts.chain(outputs.iter_mut().map(|output| &mut output.description));
    let texts = texts.chain(blocks.iter_mut().flat_map(|b| [&mut b.name, &mut b.description]));
    for text in texts {
        let line = |c: char| if c.is_control() || c == '#' { ' ' } else { c };
        let new: String = text.chars().map(line).collect::<String>().trim().into();
        if new != *text {
            loss.note(format!("a text is written on one line and without `#`: `{new}`"));
            *text = new;
        }
    }
}

struct Writer<'w> {
    parts: &'w Parts,
    loss: &'w mut Loss,
}

impl Writer<'_> {
    fn text(&mut self) -> String {
        let parts = self.parts;
        let mut text = format!("Engine: {}\n", parts.name);
        if !parts.description.is_empty() {
            text += &format!("description: {}\n", parts.description);
        }
        parts.inputs.iter().for_each(|input| text += &self.input(input));
        parts.outputs.iter().for_each(|output| text += &self.output(output));
        parts.blocks.iter().for_each(|block| text += &self.block(block));
        text
    }

    fn input(&mut self, input: &Input) -> String {
        let mut text = heading("InputVariable", &input.name, &input.description, input.enabled);
        text += &property("range", &range(input.universe));
        text += &property("lock-range", &(input.out_of_range == OutOfRange::Clamp).to_string());
        for term in &input.terms {
            let what = format!("{}.{}", input.name, term.name);
            let class = self.set(&what, &term.membership, term.lower.as_ref());
            text += &property("term", &format!("{} {class}", term.name));
        }
        text
    }

    fn output(&mut self, output: &Output) -> String {
        let mut text = heading("OutputVariable", &output.name, &output.description, output.enabled);
        let default = match output.fallback.value {
            FallbackValue::Number(value) => value,
            FallbackValue::Middle | FallbackValue::Nothing => f64::NAN,
        };
        let properties = [
            ("range", range(output.universe)),
            ("lock-range", output.clamp.to_string()),
            ("aggregation", self.aggregation(output)),
            ("defuzzifier", defuzzifier(output)),
            ("default", number(default)),
            ("lock-previous", output.fallback.previous.to_string()),
        ];
        text.extend(properties.iter().map(|(key, value)| property(key, value)));
        for term in &output.terms {
            let what = format!("{}.{}", output.name, term.name);
            let class = self.conclusion(&what, &term.conclusion);
            text += &property("term", &format!("{} {class}", term.name));
        }
        text
    }

    fn aggregation(&mut self, output: &Output) -> String {
        let none = output.defuzzifier.sampling().is_none()
            && output.aggregation.is(SNormKind::UnboundedSum);
        if none { "none".into() } else { self.s_norm(&output.name, &output.aggregation) }
    }

    fn conclusion(&mut self, name: &str, conclusion: &Conclusion) -> String {
        match conclusion {
            Conclusion::Set { membership, lower } => self.set(name, membership, lower.as_ref()),
            Conclusion::Constant(value) => format!("Constant {}", number(*value)),
            Conclusion::Linear { coefficients, constant } => {
                format!("Linear {}", written_all(&[coefficients, &[*constant][..]].concat()))
            }
            Conclusion::Formula(formula) => {
                let names = adapt::formula_names(self.parts);
                adapt::check_formula(name, formula, &names, self.loss);
                format!("Function {}", formula.text())
            }
            Conclusion::Interval(_) => {
                self.loss.cannot(name, "an interval has no words in FLL", adapt::TYPE_1);
                String::new()
            }
        }
    }

    fn set(&mut self, name: &str, membership: &Membership, lower: Option<&Membership>) -> String {
        if lower.is_some() {
            self.loss.cannot(name, "a type-2 set has no words in FLL", adapt::TYPE_1);
        }
        match membership {
            Membership::Formula { formula, height } => {
                let inputs = adapt::formula_names(self.parts);
                let names: Vec<&str> = ["x"].into_iter().chain(inputs).collect();
                adapt::check_formula(name, formula, &names, self.loss);
                if *height < 1.0 {
                    format!("Function {} * ({})", number(*height), formula.text())
                } else {
                    format!("Function {}", formula.text())
                }
            }
            Membership::Shape { kind, params, height } => {
                let own = shapes::of_kind(FUZZYLITE, *kind).map(|row| row.theirs(params));
                let class = own.zip(shapes::of_kind(FUZZYLITE, *kind).map(|row| row.word));
                let class = class.or_else(|| alias(*kind, params));
                let Some((numbers, word)) = class else {
                    let message = format!("{} has no class in fuzzylite", kind.name());
                    self.loss.cannot(name, message, "a shape of fuzzylite, such as `points`");
                    return String::new();
                };
                let height = (*height < 1.0).then(|| format!(" {}", number(*height)));
                format!("{word} {}{}", written_all(&numbers), height.unwrap_or_default())
            }
        }
    }

    fn block(&mut self, block: &RuleBlock) -> String {
        let mut text = heading("RuleBlock", &block.name, &block.description, block.enabled);
        let properties = [
            ("conjunction", self.t_norm(&block.name, &block.and)),
            ("disjunction", self.s_norm(&block.name, &block.or)),
            ("implication", self.t_norm(&block.name, &block.implication)),
            ("activation", activation::written(block.activation)),
        ];
        text.extend(properties.iter().map(|(key, value)| property(key, value)));
        for (index, rule) in block.rules.iter().enumerate() {
            match rule::written(rule, self.parts, STYLE) {
                Ok(rule) => text += &property("rule", &rule),
                Err(message) => self.loss.cannot(&format!("rule {}", index + 1), message, ""),
            }
        }
        text
    }

    fn t_norm(&mut self, name: &str, norm: &TNorm) -> String {
        let class = match norm {
            TNorm::Kind(kind) => norms::row_of(norms::T_NORMS, kind).map(|row| row.class),
            TNorm::Formula(_) => None,
        };
        self.class(name, class)
    }

    fn s_norm(&mut self, name: &str, norm: &SNorm) -> String {
        let class = match norm {
            SNorm::Kind(kind) => norms::row_of(norms::S_NORMS, kind).map(|row| row.class),
            SNorm::Formula(_) => None,
        };
        self.class(name, class)
    }

    fn class(&mut self, name: &str, class: Option<&'static str>) -> String {
        if class.is_none() {
            self.loss.cannot(name, "a norm in a formula has no words in FLL", "a norm with a name");
        }
        class.unwrap_or_default().into()
    }
}

/// Hedges are written as words; a negation is one of them.
const STYLE: Style =
    Style { upper: false, negation: false, hedges: true, carries: true, between: " and " };

fn alias(
    kind: fspid_fuzzy::membership::ShapeKind,
    params: &[f64],
) -> Option<(Vec<f64>, &'static str)> {
    let (kind, params) = shapes::alias(kind, params)?;
    shapes::of_kind(FUZZYLITE, kind).map(|row| (row.theirs(&params), row.word))
}

fn heading(key: &str, name: &str, description: &str, enabled: bool) -> String {
    let mut text = format!("{}\n", format!("{key}: {name}").trim_end());
    if !description.is_empty() {
        text += &property("description", description);
    }
    text + &property("enabled", &enabled.to_string())
}

fn property(key: &str, value: &str) -> String {
    format!("  {key}: {value}\n")
}

fn range(universe: Option<Universe>) -> String {
    let ends = universe.map_or([f64::NEG_INFINITY, f64::INFINITY], |u| [u.lower, u.upper]);
    written_all(&ends)
}

fn defuzzifier(output: &Output) -> String {
    let method = output.defuzzifier;
    let class = methods::row_of(method).map_or("", |row| row.class);
    let sets = output.terms.iter().any(|t| matches!(t.conclusion, Conclusion::Set { .. }));
    match method {
        Defuzzifier::WeightedAverage(SetReading::Tsukamoto)
        | Defuzzifier::WeightedSum(SetReading::Tsukamoto)
            if sets =>
        {
            format!("{class} Tsukamoto")
        }
        Defuzzifier::WeightedAverage(_) | Defuzzifier::WeightedSum(_) => {
            format!("{class} TakagiSugeno")
        }
        integral => match integral.sampling() {
            Some(Sampling::Midpoint(count)) => format!("{class} {count}"),
            _ => class.into(),
        },
    }
}

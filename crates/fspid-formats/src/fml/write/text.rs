//! The text of a document.

use fspid_fuzzy::system::{
    Antecedent, Conclusion, FallbackValue, Input, Membership, Output, Parts, Rule, RuleBlock,
    SNorm, Statement, TNorm, Universe, Variable,
};
use fspid_fuzzy::{Hedge, SNormKind, TNormKind};

use super::Kind;
use crate::fml::shape;
use crate::fml::words::{DEFUZZIFIERS, MODIFIERS, S_NORMS, T_NORMS, word_of};
use crate::loss::Loss;
use crate::number::written as number;

pub(super) struct Writer<'w> {
    pub(super) parts: &'w Parts,
    pub(super) loss: &'w mut Loss,
}

/// Elements of rules by the kind of what they conclude.
const ELEMENTS: [(Kind, [&str; 5]); 3] = [
    (Kind::Mamdani, ["mamdaniRuleBase", "rule", "consequent", "then", "clause"]),
    (Kind::Tsk, ["tskRuleBase", "tskRule", "tskConsequent", "tskThen", "tskClause"]),
    (
        Kind::Tsukamoto,
        [
            "tsukamotoRuleBase",
            "tsukamotoRule",
            "tsukamotoConsequent",
            "tsukamotoThen",
            "tsukamotoClause",
        ],
    ),
];

impl Writer<'_> {
    pub(super) fn text(&mut self) -> String {
        let parts = self.parts;
        let mut text = format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
             <fuzzySystem xmlns=\"http://www.ieee1855.org\" name=\"{}\">\n  <knowledgeBase>\n",
            escaped(&parts.name)
        );
        parts.inputs.iter().for_each(|input| text += &self.input(input));
        parts.outputs.iter().for_each(|output| text += &self.output(output));
        text += "  </knowledgeBase>\n";
        for block in &parts.blocks {
            for (kind, elements) in &ELEMENTS {
                text += &self.base(block, *kind, elements);
            }
        }
        text + "</fuzzySystem>\n"
    }

    fn input(&mut self, input: &Input) -> String {
        let head = format!(
            "    <fuzzyVariable name=\"{}\"{} type=\"input\">\n",
            escaped(&input.name),
            Self::domain(input.universe)
        );
        let terms: String = input
            .terms
            .iter()
            .map(|term| fuzzy_term("fuzzyTerm", &term.name, &term.membership))
            .collect();
        format!("{head}{terms}    </fuzzyVariable>\n")
    }

    fn domain(universe: Option<Universe>) -> String {
        match universe {
            Some(Universe { lower, upper }) => {
                format!(" domainleft=\"{}\" domainright=\"{}\"", number(lower), number(upper))
            }
            // Outputs alone: a number needs none, and the range of a set is asked for before.
            None => String::new(),
        }
    }

    fn output(&mut self, output: &Output) -> String {
        let kind = Kind::of(output);
        let (element, term) = match kind {
            Kind::Mamdani => ("fuzzyVariable", "fuzzyTerm"),
            Kind::Tsk => ("tskVariable", "tskTerm"),
            Kind::Tsukamoto => ("tsukamotoVariable", "tsukamotoTerm"),
        };
        let default = match output.fallback.value {
            FallbackValue::Number(value) => number(value),
            FallbackValue::Middle | FallbackValue::Nothing => "NaN".into(),
        };
        let domain = Self::domain(output.universe);
        let method = match kind {
            Kind::Mamdani => self.method(output),
            Kind::Tsk | Kind::Tsukamoto => " combination=\"WA\"".to_owned(),
        };
        let mut text = format!(
            "    <{element} name=\"{}\"{domain} type=\"output\"{method} defaultValue=\"{default}\">\n",
            escaped(&output.name)
        );
        for found in &output.terms {
            text += &match &found.conclusion {
                Conclusion::Set { membership, .. } => fuzzy_term(term, &found.name, membership),
                other => number_term(&found.name, other),
            };
        }
        format!("{text}    </{element}>\n")
    }

    fn method(&self, output: &Output) -> String {
        let method = output.defuzzifier;
        let defuzzifier = word_of(DEFUZZIFIERS, &method).unwrap_or("COG");
        let accumulation = s_word(&output.aggregation);
        format!(" accumulation=\"{accumulation}\" defuzzifier=\"{defuzzifier}\"")
    }

    /// The rules of a block that conclude outputs of one kind; nothing if there are none.
    fn base(&mut self, block: &RuleBlock, kind: Kind, elements: &[&str; 5]) -> String {
        let [base, ..] = elements;
        let mut rules = String::new();
        for (index, rule) in block.rules.iter().enumerate() {
            match self.rule(rule, index, kind, elements) {
                Ok(text) => rules += &text,
                Err(message) => {
                    let name = format!("rule {}", index + 1);
                    self.loss.cannot(&name, message, "a .toml file");
                }
            }
        }
        if rules.is_empty() {
            return String::new();
        }
        let (and, or) = (t_word(&block.and), s_word(&block.or));
        let activation = match kind {
            Kind::Tsk => String::new(),
            _ => format!(" activationMethod=\"{}\"", t_word(&block.implication)),
        };
        format!(
            "  <{base} name=\"{}\"{activation} andMethod=\"{and}\" orMethod=\"{or}\">\n{rules}  </{base}>\n",
            escaped(&block.name)
        )
    }

    fn rule(
        &mut self,
        rule: &Rule,
        index: usize,
        kind: Kind,
        elements: &[&str; 5],
    ) -> Result<String, String> {
        let [_, element, consequent, then, clause] = elements;
        let outputs = &self.parts.outputs;
        let mut conclusions = String::new();
        for found in &rule.consequents {
            let Some(output) = outputs.get(found.output).filter(|out| Kind::of(out) == kind) else {
                continue;
            };
            if !found.hedges.is_empty() {
                return Err("a hedge of a conclusion's strength has no words in FML".into());
            }
            let term = output.terms.get(found.term).map_or("", |term| &term.name);
            conclusions += &clause_text(clause, 10, None, &output.name, term);
        }
        if conclusions.is_empty() {
            return Ok(String::new());
        }
        let name =
            if rule.name.is_empty() { format!("rule{}", index + 1) } else { rule.name.clone() };
        let (any, statements) = flat(&rule.antecedent)?;
        let connector = if any { "or" } else { "and" };
        let weight = number(rule.weight);
        let mut text = format!(
            "    <{element} name=\"{}\" connector=\"{connector}\" weight=\"{weight}\">\n      <antecedent>\n",
            escaped(&name)
        );
        for statement in &statements {
            text += &self.statement(statement)?;
        }
        Ok(format!(
            "{text}      </antecedent>\n      <{consequent}>\n        <{then}>\n\
             {conclusions}        </{then}>\n      </{consequent}>\n    </{element}>\n"
        ))
    }

    fn statement(&mut self, statement: &Statement) -> Result<String, String> {
        let Parts { inputs, outputs, .. } = self.parts;
        let names: Option<(&str, Vec<&str>)> = match statement.variable {
            Variable::Input(index) => inputs.get(index).map(|input| {
                (input.name.as_str(), input.terms.iter().map(|term| term.name.as_str()).collect())
            }),
            Variable::Output(index) => outputs.get(index).map(|output| {
                (output.name.as_str(), output.terms.iter().map(|term| term.name.as_str()).collect())
            }),
        };
        let (variable, terms) = names.ok_or("a statement is about a variable that is not there")?;
        // A bare `any` is `any` of some term.
        let term = terms.get(statement.term.unwrap_or(0));
        let term = term.ok_or("`any` of a variable without terms has no words in FML")?;
        let mut hedges = statement.hedges.clone();
        if statement.term.is_none() && hedges.last() != Some(&Hedge::Any) {
            return Err("this statement has no words in FML".into());
        }
        // What `any` is asked of makes no difference.
        if let Some(at) = hedges.iter().rposition(|hedge| *hedge == Hedge::Any) {
            hedges.truncate(at + 1);
        }
        let modifier = match hedges[..] {
            [] => None,
            [hedge] => Some(self.modifier(hedge)?),
            _ => return Err("several hedges of one statement have no words in FML".into()),
        };
        Ok(clause_text("clause", 8, modifier, variable, term))
    }

    fn modifier(&mut self, hedge: Hedge) -> Result<&'static str, String> {
        let row = MODIFIERS.iter().find(|row| row.1.0 == hedge);
        let &(word, (_, agreed)) =
            row.ok_or_else(|| format!("the hedge `{}` has no words in FML", hedge.name()))?;
        if !agreed {
            self.loss.note(format!("`{word}` is written, which tools read in different ways"));
        }
        Ok(word)
    }
}

/// The statements of a condition that one connector joins, and whether that is *or*.
fn flat(antecedent: &Antecedent) -> Result<(bool, Vec<Statement>), String> {
    let one = |part: &Antecedent| match part {
        Antecedent::Is(statement) => Ok(statement.clone()),
        Antecedent::Not(inner) => match &**inner {
            Antecedent::Is(statement) => {
                let mut statement = statement.clone();
                statement.hedges.insert(0, Hedge::Not);
                Ok(statement)
            }
            _ => Err("a negated bracket has no words in FML".to_owned()),
        },
        _ => Err("a condition with both `and` and `or` has no words in FML".to_owned()),
    };
    match antecedent {
        Antecedent::Always => Ok((false, Vec::new())),
        Antecedent::All(parts) => Ok((false, parts.iter().map(one).collect::<Result<_, _>>()?)),
        Antecedent::Any(parts) => {
            if parts.is_empty() {
                return Err("a condition of nothing has no words in FML".into());
            }
            Ok((true, parts.iter().map(one).collect::<Result<_, _>>()?))
        }
        other => Ok((false, vec![one(other)?])),
    }
}

fn clause_text(
    element: &str,
    indent: usize,
    modifier: Option<&str>,
    variable: &str,
    term: &str,
) -> String {
    let blank = " ".repeat(indent);
    let modifier = modifier.map(|word| format!(" modifier=\"{word}\"")).unwrap_or_default();
    format!(
        "{blank}<{element}{modifier}>\n{blank}  <variable>{}</variable>\n{blank}  <term>{}</term>\n{blank}</{element}>\n",
        escaped(variable),
        escaped(term)
    )
}

fn fuzzy_term(element: &str, name: &str, set: &Membership) -> String {
    let head = format!("      <{element} name=\"{}\" complement=\"false\">\n", escaped(name));
    format!("{head}{}      </{element}>\n", shape_text(set))
}

fn shape_text(set: &Membership) -> String {
    let Some((element, params)) = shape::written(set) else { return points_text(set) };
    let mut text = format!("        <{element}");
    for (index, value) in params.iter().enumerate() {
        text += &format!(" param{}=\"{}\"", index + 1, number(*value));
    }
    text + "/>\n"
}

fn points_text(set: &Membership) -> String {
    let Membership::Shape { params, .. } = set else { return String::new() };
    let mut text = String::from("        <pointSetShape interpolationMethod=\"linear\">\n");
    for pair in params.chunks_exact(2) {
        if let &[x, y] = pair {
            text += &format!("          <point x=\"{}\" y=\"{}\"/>\n", number(x), number(y));
        }
    }
    text + "        </pointSetShape>\n"
}

fn number_term(name: &str, conclusion: &Conclusion) -> String {
    let (order, values) = match conclusion {
        Conclusion::Constant(value) => (0, vec![*value]),
        Conclusion::Linear { coefficients, constant } => {
            (1, [&coefficients[..], &[*constant]].concat())
        }
        // Refused while adapting.
        _ => (0, Vec::new()),
    };
    let values: String = values
        .iter()
        .map(|value| format!("        <tskValue>{}</tskValue>\n", number(*value)))
        .collect();
    format!(
        "      <tskTerm name=\"{}\" order=\"{order}\">\n{values}      </tskTerm>\n",
        escaped(name)
    )
}

fn s_word(norm: &SNorm) -> &'static str {
    let maximum = SNormKind::Maximum;
    let kind = if let SNorm::Kind(kind) = norm { kind } else { &maximum };
    word_of(S_NORMS, kind).unwrap_or("MAX")
}

fn t_word(norm: &TNorm) -> &'static str {
    let minimum = TNormKind::Minimum;
    let kind = if let TNorm::Kind(kind) = norm { kind } else { &minimum };
    word_of(T_NORMS, kind).unwrap_or("MIN")
}

/// Signs that mean something in XML as references.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for found in text.chars() {
        match found {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            other => out.push(other),
        }
    }
    out
}

//! Writing a rule.

use fspid_fuzzy::Hedge;
use fspid_fuzzy::system::{Antecedent, Consequent, Parts, Rule, Statement, Variable};

use super::carry;
use crate::number::written as number;

/// How a tool wants its rules.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Style {
    /// Keywords in upper case.
    pub(crate) upper: bool,
    /// Whether `not` may stand before a bracket or statement; else it is written as a hedge.
    pub(crate) negation: bool,
    /// Whether hedges other than `not` may be written.
    pub(crate) hedges: bool,
    /// Whether a hedge of a conclusion goes on to those behind it, as in fuzzylite.
    pub(crate) carries: bool,
    /// What separates conclusions.
    pub(crate) between: &'static str,
}

/// The text of a rule from `if` on.
///
/// # Errors
/// What the style has no words for.
pub(crate) fn written(rule: &Rule, parts: &Parts, style: Style) -> Result<String, String> {
    let writer = Writer { parts, style };
    let condition = writer.condition(&rule.antecedent, Level::Whole)?;
    let hedges: Vec<&[Hedge]> = match style.carries {
        true => carry::own(&rule.consequents, &parts.outputs),
        false => rule.consequents.iter().map(|own| own.hedges.as_slice()).collect(),
    };
    let conclusions = rule.consequents.iter().zip(hedges);
    let conclusions: Result<Vec<_>, _> =
        conclusions.map(|(consequent, hedges)| writer.conclusion(consequent, hedges)).collect();
    let [begin, then, with] = ["if", "then", "with"].map(|word| writer.keyword(word));
    let mut text = format!("{begin} {condition} {then} {}", conclusions?.join(style.between));
    if rule.weight < 1.0 {
        text = format!("{text} {with} {}", number(rule.weight));
    }
    Ok(text)
}

/// What surrounds a condition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Level {
    Whole,
    Operand,
}

struct Writer<'p> {
    parts: &'p Parts,
    style: Style,
}

impl Writer<'_> {
    fn keyword(&self, word: &str) -> String {
        if self.style.upper { word.to_uppercase() } else { word.into() }
    }

    fn condition(&self, antecedent: &Antecedent, around: Level) -> Result<String, String> {
        match antecedent {
            Antecedent::Always => self.always(),
            Antecedent::Is(statement) => self.statement(statement),
            Antecedent::Any(parts) => self.joined(parts, "or", around),
            Antecedent::All(parts) => self.joined(parts, "and", around),
            Antecedent::Not(part) => self.negated(part),
        }
    }

    /// A join within another stands in brackets: tools disagree about the rank of *and* and *or*.
    fn joined(&self, parts: &[Antecedent], word: &str, around: Level) -> Result<String, String> {
        if let [only] = parts {
            return self.condition(only, around);
        }
        if parts.is_empty() {
            return self.always();
        }
        let written: Result<Vec<_>, _> =
            parts.iter().map(|part| self.condition(part, Level::Operand)).collect();
        let text = written?.join(&format!(" {} ", self.keyword(word)));
        Ok(if around == Level::Operand { format!("({text})") } else { text })
    }

    /// A condition that always holds: `any` of an input.
    fn always(&self) -> Result<String, String> {
        match self.parts.inputs.iter().find(|input| input.enabled) {
            Some(input) if self.style.hedges => {
                Ok(format!("{} {} any", input.name, self.keyword("is")))
            }
            _ => Err("a rule without a condition has no words here".into()),
        }
    }

    fn negated(&self, part: &Antecedent) -> Result<String, String> {
        let not = self.keyword("not");
        if self.style.negation {
            return Ok(format!("{not} {}", self.condition(part, Level::Operand)?));
        }
        let Antecedent::Is(statement) = part else {
            let advice = "a negated bracket has no words here; negate its statements instead";
            return Err(advice.into());
        };
        let mut statement = statement.clone();
        statement.hedges.insert(0, Hedge::Not);
        self.statement(&statement)
    }

    fn statement(&self, statement: &Statement) -> Result<String, String> {
        let Parts { inputs, outputs, .. } = self.parts;
        let (variable, term) = match statement.variable {
            Variable::Input(index) => inputs.get(index).map(|input| {
                (&input.name, statement.term.and_then(|t| input.terms.get(t)).map(|t| &t.name))
            }),
            Variable::Output(index) => outputs.get(index).map(|output| {
                (&output.name, statement.term.and_then(|t| output.terms.get(t)).map(|t| &t.name))
            }),
        }
        .ok_or("a statement is about a variable that is not there")?;
        match (statement.term, term) {
            (None, _) if statement.hedges.last() == Some(&Hedge::Any) => {
                self.clause(variable, &statement.hedges, None)
            }
            (Some(_), Some(term)) => self.clause(variable, &statement.hedges, Some(term)),
            _ => Err(format!("a statement about `{variable}` has no term")),
        }
    }

    fn conclusion(&self, consequent: &Consequent, hedges: &[Hedge]) -> Result<String, String> {
        let output = self.parts.outputs.get(consequent.output);
        let term = output.and_then(|output| output.terms.get(consequent.term));
        let (Some(output), Some(term)) = (output, term) else {
            return Err("a conclusion is about a term that is not there".into());
        };
        self.clause(&output.name, hedges, Some(&term.name))
    }

    fn clause(
        &self,
        variable: &str,
        hedges: &[Hedge],
        term: Option<&String>,
    ) -> Result<String, String> {
        let words: Result<Vec<_>, _> = hedges.iter().map(|&hedge| self.hedge(hedge)).collect();
        let words = words?.into_iter().chain(term.cloned()).collect::<Vec<_>>().join(" ");
        Ok(format!("{variable} {} {words}", self.keyword("is")))
    }

    fn hedge(&self, hedge: Hedge) -> Result<String, String> {
        match hedge {
            Hedge::Not => Ok(self.keyword("not")),
            _ if !self.style.hedges => {
                Err(format!("the hedge `{}` has no word here", hedge.name()))
            }
            Hedge::Power(power) => power_words(power),
            named => Ok(named.name().into()),
        }
    }
}

/// `very` squares and `somewhat` takes the root: powers of two have words.
fn power_words(power: f64) -> Result<String, String> {
    let (exponent, fraction) = ((power.to_bits() >> 52) as i64 - 1023, power.to_bits() << 12);
    if fraction != 0 || exponent == 0 || exponent.abs() > 16 {
        return Err(format!("the hedge of power {} has no word here", number(power)));
    }
    let word = if exponent > 0 { "very" } else { "somewhat" };
    Ok(vec![word; exponent.unsigned_abs() as usize].join(" "))
}

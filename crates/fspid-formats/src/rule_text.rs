//! Single rules in words, for formats that are not ours to define but write rules as FCL does.

use fspid_fuzzy::system::{Input, Output, Parts, Rule};

use crate::cursor::Cursor;
use crate::lexer::Lexer;
use crate::names::Names;
use crate::report::Report;
use crate::rule::{self, Reader, Style, written};
use crate::tokens::Tokens;
use fspid_diagnostics::{Problem, Problems};

/// Reads rules about the variables of one system; case matters in names, not in keywords.
#[derive(Debug)]
pub struct RuleReader {
    names: Names,
}

impl RuleReader {
    /// For rules about these variables.
    #[must_use]
    pub fn new(inputs: &[Input], outputs: &[Output]) -> Self {
        let mut names = Names::empty(true);
        for input in inputs {
            let terms = input.terms.iter().map(|term| term.name.as_str());
            names.push(&input.name, false, terms.collect());
        }
        for output in outputs {
            let terms = output.terms.iter().map(|term| term.name.as_str());
            names.push(&output.name, true, terms.collect());
        }
        Self { names }
    }

    /// The rule `if … then …`, perhaps with a weight.
    ///
    /// # Errors
    /// What is wrong, with its line and column in the text.
    pub fn read(&self, text: &str) -> Result<Rule, Problems> {
        let cursor = Cursor::new(text).map_err(|problem| Problems::of_text(vec![problem]))?;
        let mut report = Report::default();
        let tokens = Tokens::new(Lexer::words(cursor));
        let mut reader = Reader::new(tokens, &self.names, &mut report, rule::LINE);
        let rule = reader.rule();
        let rest = reader.tokens.next;
        if rule.is_some() && !rest.text.is_empty() {
            let expected = "`with` and a weight, or the end of the rule";
            report.problem(rest.place(), rest.text, "does not fit here", expected);
        }
        report.finish()?;
        rule.ok_or_else(|| Problems::of_text(vec![no_rule()]))
    }
}

/// Without a problem there is a rule; the other case would be a mistake in the reader.
fn no_rule() -> Problem {
    Problem::whole("no rule", "if … then …")
}

/// The rule in words, from `if` on.
///
/// # Errors
/// What there are no words for.
pub fn write(rule: &Rule, parts: &Parts) -> Result<String, String> {
    let style =
        Style { upper: false, negation: true, hedges: true, carries: false, between: " and " };
    written(rule, parts, style)
}

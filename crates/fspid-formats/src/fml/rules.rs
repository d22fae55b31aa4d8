//! Rule bases.

use std::collections::BTreeMap;

use fspid_fuzzy::system::{
    Activation, Antecedent, Conclusion, Consequent, OutputTerm, Rule, RuleBlock, Statement,
    Variable,
};
use fspid_fuzzy::{Hedge, SNormKind, TNormKind};

use super::document::{Context, Element};
use super::knowledge::Knowledge;
use super::words::{self, MODIFIERS, OF_SETS, S_NORMS, T_NORMS};
use crate::hedged;
use crate::names::{Found, Index, Names};
use crate::vocabulary::known;

/// Elements with rules; the last one is of the time before the standard.
pub(super) const BASES: [&str; 4] =
    ["mamdaniRuleBase", "tskRuleBase", "tsukamotoRuleBase", "RuleBase"];
const RULES: [&str; 4] = ["rule", "mamdaniRule", "tskRule", "tsukamotoRule"];
const CONSEQUENTS: [&str; 3] = ["consequent", "tskConsequent", "tsukamotoConsequent"];
const THEN: [&str; 3] = ["then", "tskThen", "tsukamotoThen"];
const CLAUSES: [&str; 3] = ["clause", "tskClause", "tsukamotoClause"];

/// Reads rules. A method that answers `None` has reported why.
pub(super) struct Reader<'r, 'i> {
    pub(super) names: &'r Names,
    pub(super) knowledge: &'r mut Knowledge,
    pub(super) context: &'r mut Context<'i>,
    /// Sets that a modifier in a conclusion has made: output, term, modifier.
    pub(super) made: BTreeMap<(usize, usize, &'static str), usize>,
}

/// A clause.
struct Clause {
    position: usize,
    term: usize,
    modifier: Option<(&'static str, Hedge)>,
    start: usize,
}

impl Reader<'_, '_> {
    /// The rules of a base; those with norms of their own are blocks of their own.
    pub(super) fn base(&mut self, base: Element<'_, '_>) -> Vec<RuleBlock> {
        self.context.only(base, &["name", "type", "activationMethod", "andMethod", "orMethod"]);
        const TYPES: [(&str, ()); 2] = [("mamdani", ()), ("tsk", ())];
        if base.is("RuleBase") {
            self.context.choice(base, "type", &TYPES);
        }
        let activation = self.context.choice(base, "activationMethod", T_NORMS);
        let norms = self.norms(base, (TNormKind::Minimum, SNormKind::Maximum));
        let name = base.attribute("name").unwrap_or_default();
        let mut blocks = vec![block(name, norms, activation)];
        let mut last = norms;
        for (index, element) in base.children().enumerate() {
            if self.context.report.is_full() {
                break;
            }
            if !element.is_any(&RULES) {
                self.context.refuse(element, base.name(), &["rule"]);
                continue;
            }
            let own = self.norms(element, norms);
            let Some(rule) = self.rule(element, index) else { continue };
            if own != last {
                last = own;
                blocks.push(block(name, own, activation));
            }
            if let Some(block) = blocks.last_mut() {
                block.rules.push(rule);
            }
        }
        if blocks.len() > 1 {
            let message = "rules with methods of their own are read as rule blocks of their own";
            self.context.note(base.start(), message);
            blocks.retain(|block| !block.rules.is_empty());
        }
        blocks
    }

    fn norms(
        &mut self,
        element: Element<'_, '_>,
        (and, or): (TNormKind, SNormKind),
    ) -> (TNormKind, SNormKind) {
        let own_and = self.context.choice(element, "andMethod", T_NORMS);
        let own_or = self.context.choice(element, "orMethod", S_NORMS);
        (own_and.unwrap_or(and), own_or.unwrap_or(or))
    }

    fn rule(&mut self, element: Element<'_, '_>, index: usize) -> Option<Rule> {
        const PARTS: [&str; 4] = ["name", "connector", "weight", "andMethod"];
        const CONNECTORS: [(&str, bool); 2] = [("and", false), ("or", true)];
        self.context.only(element, &[&PARTS[..], &["orMethod"]].concat());
        let any = self.context.choice(element, "connector", &CONNECTORS).unwrap_or(false);
        let weight = self.weight(element)?;
        let (mut statements, mut consequents) = (None, None);
        for part in element.children() {
            if part.is("antecedent") && statements.is_none() {
                statements = Some(self.antecedent(part));
            } else if part.is_any(&CONSEQUENTS) && consequents.is_none() {
                consequents = Some(self.consequent(part));
            } else {
                self.context.refuse(part, element.name(), &["antecedent", "consequent"]);
            }
        }
        let Some(consequents) = consequents else {
            let message = "the rule concludes nothing";
            self.context.problem(element.start(), "", message, "`<consequent>`");
            return None;
        };
        let antecedent = match statements {
            Some(statements) => joined(statements?, any),
            None => Antecedent::Always,
        };
        let name = element.attribute("name").unwrap_or_default();
        // A number that only counts is no name.
        let name = if name == format!("rule{}", index + 1) { "" } else { name };
        let consequents = consequents?;
        Some(Rule { name: name.to_owned(), enabled: true, antecedent, consequents, weight })
    }

    fn weight(&mut self, element: Element<'_, '_>) -> Option<f64> {
        if element.attribute("weight").is_none() {
            return Some(1.0);
        }
        let weight = self.context.number(element, "weight")?;
        if (0.0..=1.0).contains(&weight) {
            return Some(weight);
        }
        let word = element.attribute("weight").unwrap_or_default();
        let at = element.place_of("weight");
        self.context.problem(at, word, "not a weight", "a number from 0 to 1");
        None
    }

    fn antecedent(&mut self, element: Element<'_, '_>) -> Option<Vec<Antecedent>> {
        self.context.only(element, &[]);
        let mut found = Some(Vec::new());
        for part in element.children() {
            let statement = self.clause(part, element.name()).map(|clause| self.statement(&clause));
            found = found.zip(statement).map(|(mut all, one)| {
                all.push(one);
                all
            });
        }
        found
    }

    fn statement(&self, clause: &Clause) -> Antecedent {
        let variable = self.names.variable(clause.position);
        let complement = match variable {
            Variable::Input(input) => {
                self.knowledge.complements.contains(&(input, clause.term)).then_some(Hedge::Not)
            }
            Variable::Output(_) => None,
        };
        let hedges =
            clause.modifier.map(|(_, hedge)| hedge).into_iter().chain(complement).collect();
        Antecedent::Is(Statement { variable, term: Some(clause.term), hedges })
    }

    fn consequent(&mut self, element: Element<'_, '_>) -> Option<Vec<Consequent>> {
        self.context.only(element, &[]);
        let mut found = Some(Vec::new());
        for part in element.children() {
            let clauses: Vec<_> = if part.is_any(&THEN) {
                part.children().map(|clause| (clause, part)).collect()
            } else if part.name().to_ascii_lowercase().ends_with("else") {
                let message = "what follows if a rule does not hold (`else`) is not read";
                self.context.problem(part.start(), part.name(), message, "a rule of its own");
                return None;
            } else {
                vec![(part, element)]
            };
            for (clause, within) in clauses {
                let one =
                    self.clause(clause, within.name()).and_then(|found| self.concluded(&found));
                found = found.zip(one).map(|(mut all, one)| {
                    all.push(one);
                    all
                });
            }
        }
        if found.as_ref().is_some_and(Vec::is_empty) {
            let message = "the rule concludes nothing";
            self.context.problem(element.start(), "", message, "`<clause>`");
            return None;
        }
        found
    }

    fn concluded(&mut self, clause: &Clause) -> Option<Consequent> {
        let Variable::Output(output) = self.names.variable(clause.position) else {
            let name = self.names.variables.name(clause.position);
            let expected = known(self.names.outputs(), name);
            self.context.problem(clause.start, name, "an input cannot be concluded", expected);
            return None;
        };
        let term = match clause.modifier {
            None => clause.term,
            Some((word, hedge)) => self.made(clause, output, word, hedge)?,
        };
        Some(Consequent { output, term, hedges: Vec::new() })
    }

    /// The set that a modifier makes of a term of an output.
    fn made(
        &mut self,
        clause: &Clause,
        output: usize,
        word: &'static str,
        hedge: Hedge,
    ) -> Option<usize> {
        if let Some(&made) = self.made.get(&(output, clause.term, word)) {
            return Some(made);
        }
        let terms = &mut self.knowledge.outputs.get_mut(output)?.terms;
        let (power, negated) = match hedge {
            Hedge::Not => (None, true),
            Hedge::Very => (Some(2.0), false),
            Hedge::Somewhat => (Some(0.5), false),
            Hedge::Power(power) => (Some(power), false),
            Hedge::Any | Hedge::Extremely | Hedge::Seldom => (None, false),
        };
        let base = terms.get(clause.term)?;
        let set = match &base.conclusion {
            Conclusion::Set { membership, .. } if power.is_some() || negated => {
                hedged::set(membership, power, negated)
            }
            _ => None,
        };
        let Some(membership) = set else {
            let message = "this modifier of such a term is not read in a conclusion";
            let expected = "`not`, `very` or another power of a fuzzy set";
            self.context.problem(clause.start, word, message, expected);
            return None;
        };
        let mut name = format!("{word} {}", base.name);
        while terms.iter().any(|term| term.name == name) {
            name.push('\'');
        }
        let conclusion = Conclusion::Set { membership, lower: None };
        terms.push(OutputTerm { name, conclusion });
        let made = terms.len() - 1;
        self.made.insert((output, clause.term, word), made);
        Some(made)
    }

    /// A variable, its term, and perhaps a modifier.
    fn clause(&mut self, element: Element<'_, '_>, within: &str) -> Option<Clause> {
        if !element.is_any(&CLAUSES) {
            self.context.refuse(element, within, &["clause"]);
            return None;
        }
        self.context.only(element, &["modifier"]);
        let modifier = match element.attribute("modifier") {
            Some(word) => Some(self.modifier(element, word)?),
            None => None,
        };
        let names = self.names;
        let (variable, word) = self.part(element, "variable")?;
        let position =
            self.look_up(&names.variables, variable, &word, "no variable has this name")?;
        let (term, word) = self.part(element, "term")?;
        let message = format!("no term of `{}` has this name", names.variables.name(position));
        let term = self.look_up(names.terms(position)?, term, &word, &message)?;
        Some(Clause { position, term, modifier, start: element.start() })
    }

    fn part<'x, 'i>(
        &mut self,
        clause: Element<'x, 'i>,
        name: &str,
    ) -> Option<(Element<'x, 'i>, String)> {
        let found = clause.child(&[name]);
        if found.is_none() {
            let message = format!("the clause has no <{name}>");
            self.context.problem(clause.start(), "", message, format!("`<{name}>`"));
        }
        found.map(|found| (found, found.text()))
    }

    fn look_up(
        &mut self,
        index: &Index,
        element: Element<'_, '_>,
        word: &str,
        message: &str,
    ) -> Option<usize> {
        if let Found::Exact(position) = index.find(word) {
            return Some(position);
        }
        self.context.problem(element.start(), word, message, known(index.all(), word));
        None
    }

    fn modifier(&mut self, element: Element<'_, '_>, word: &str) -> Option<(&'static str, Hedge)> {
        let at = element.place_of("modifier");
        let found = MODIFIERS.iter().find(|row| row.0.eq_ignore_ascii_case(word));
        let Some(&(name, (hedge, agreed))) = found else {
            let of_set = OF_SETS.iter().any(|known| known.eq_ignore_ascii_case(word));
            let message = match of_set {
                true => "a modifier of a whole set is not computed here",
                false => "not known as a modifier",
            };
            let expected = known(MODIFIERS.iter().map(|row| row.0), word);
            self.context.problem(at, word, message, expected);
            return None;
        };
        if !agreed {
            let meaning = words::meaning(hedge);
            let message = format!("`{name}` is read as {meaning}; tools differ about it");
            self.context.note_once(at, &message);
        }
        Some((name, hedge))
    }
}

fn block(
    name: &str,
    (and, or): (TNormKind, SNormKind),
    implication: Option<TNormKind>,
) -> RuleBlock {
    RuleBlock {
        name: name.to_owned(),
        description: String::new(),
        enabled: true,
        and: and.into(),
        or: or.into(),
        implication: implication.unwrap_or(TNormKind::Minimum).into(),
        activation: Activation::General,
        rules: Vec::new(),
    }
}

fn joined(mut statements: Vec<Antecedent>, any: bool) -> Antecedent {
    match (statements.len(), any) {
        (0, _) => Antecedent::Always,
        (1, _) => statements.remove(0),
        (_, false) => Antecedent::All(statements),
        (_, true) => Antecedent::Any(statements),
    }
}

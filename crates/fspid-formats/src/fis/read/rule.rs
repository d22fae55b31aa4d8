//! Rules: rows checked against the variables.

use std::collections::BTreeMap;

use fspid_fuzzy::Hedge;
use fspid_fuzzy::system::{
    Antecedent, Conclusion, Consequent, Input, Output, OutputTerm, Rule, Statement, Variable,
};

use super::row::{Index, RuleRow, row};
use super::source::Source;
use crate::fis::hedge::{Coded, NONE, of_code};
use crate::hedged;
use crate::number::written;
use crate::report::{Report, wrong};
use fspid_diagnostics::{Place, Problem};

/// Every rule of the file that can be read; the others are noted down as problems. A hedge in a
/// conclusion adds a term to its output.
pub(super) fn rules(
    source: &Source,
    inputs: &[Input],
    outputs: &mut [Output],
    report: &mut Report,
) -> Vec<Rule> {
    if source.rules.is_none() {
        report.whole("there is no section `[Rules]`");
    }
    let counts: Vec<usize> = outputs.iter().map(|output| output.terms.len()).collect();
    let mut conclusions = Conclusions { outputs, counts, made: BTreeMap::new() };
    let rules = source.rows.iter().map_while(|line| {
        if report.is_full() {
            return None;
        }
        let rule = row(*line).and_then(|row| rule(&row, inputs, &mut conclusions, report));
        Some(report.keep(rule).flatten())
    });
    rules.flatten().collect()
}

fn rule(
    row: &RuleRow,
    inputs: &[Input],
    conclusions: &mut Conclusions,
    report: &mut Report,
) -> Result<Option<Rule>, Problem> {
    counted(row.place, row.inputs.len(), inputs.len(), "inputs")?;
    counted(row.place, row.outputs.len(), conclusions.outputs.len(), "outputs")?;
    let statements = row.inputs.iter().zip(inputs).enumerate();
    let statements: Vec<_> = statements
        .filter_map(|(position, (index, input))| {
            statement(index, position, input, report).transpose()
        })
        .collect::<Result<_, _>>()?;
    let consequents = row.outputs.iter().enumerate();
    let consequents: Vec<_> = consequents
        .filter_map(|(position, index)| conclusions.one(index, position, report).transpose())
        .collect::<Result<_, _>>()?;
    if consequents.is_empty() {
        report.note(row.place, "a rule without a conclusion has no effect and is left out");
        return Ok(None);
    }
    let antecedent = antecedent(row, statements, report);
    Ok(Some(Rule {
        name: String::new(),
        enabled: true,
        antecedent,
        consequents,
        weight: row.weight,
    }))
}

fn counted(place: Place, found: usize, wanted: usize, what: &str) -> Result<(), Problem> {
    if found == wanted {
        return Ok(());
    }
    let message = format!("the rule has {found} {what}");
    Err(wrong(place, "", message, format!("{wanted}, one index for each")))
}

fn antecedent(row: &RuleRow, mut statements: Vec<Antecedent>, report: &mut Report) -> Antecedent {
    match (statements.len(), row.any) {
        (0, false) => {
            report.note(row.place, "a rule without a condition always fires");
            Antecedent::Always
        }
        (0, true) => {
            report.note(row.place, "a rule without a condition never fires when `2`, or, joins it");
            Antecedent::Not(Box::new(Antecedent::Always))
        }
        (1, _) => statements.remove(0),
        (_, false) => Antecedent::All(statements),
        (_, true) => Antecedent::Any(statements),
    }
}

fn statement(
    index: &Index,
    position: usize,
    input: &Input,
    report: &mut Report,
) -> Result<Option<Antecedent>, Problem> {
    let Some(term) = within(index, &input.name, input.terms.len())? else { return Ok(None) };
    let hedge = of_code(index.coded.code);
    if let Some(meaning) = disputed(index.coded.code) {
        report.note(index.place, format!("`.{:02}` is {meaning}", index.coded.code));
    }
    let negation = index.coded.negated.then_some(Hedge::Not);
    let hedges = negation.into_iter().chain(hedge).collect();
    let variable = Variable::Input(position);
    Ok(Some(Antecedent::Is(Statement { variable, term: Some(term), hedges })))
}

/// Codes that tools read in different ways, and how they are read here.
fn disputed(code: u8) -> Option<&'static str> {
    match code {
        1 => Some("read as fuzzylite's `seldom`; Octave would take the power 0.1"),
        30 => Some("read as the power 3; fuzzylite's `extremely` is another function"),
        99 => Some("read as fuzzylite's `any`; Octave would take the power 9.9"),
        _ => None,
    }
}

/// Conclusions, and the sets that hedges in them have made.
struct Conclusions<'o> {
    outputs: &'o mut [Output],
    /// How many terms each output has in the file.
    counts: Vec<usize>,
    /// By output, term and what is made of it.
    made: BTreeMap<(usize, usize, bool, u8), usize>,
}

impl Conclusions<'_> {
    fn one(
        &mut self,
        index: &Index,
        position: usize,
        report: &mut Report,
    ) -> Result<Option<Consequent>, Problem> {
        let Some(output) = self.outputs.get(position) else { return Ok(None) };
        let count = self.counts.get(position).copied().unwrap_or_default();
        let Some(term) = within(index, &output.name, count)? else { return Ok(None) };
        let Coded { negated, code } = index.coded;
        // .10 is the power 1.
        let plain = !negated && matches!(code, NONE | 10);
        let term = if plain { term } else { self.hedged(index, (position, term), report)? };
        Ok(Some(Consequent { output: position, term, hedges: Vec::new() }))
    }

    /// The set that a hedge makes of a set, as Octave does: its grades to a power, then one minus them.
    fn hedged(
        &mut self,
        index: &Index,
        (position, term): (usize, usize),
        report: &mut Report,
    ) -> Result<usize, Problem> {
        let Coded { negated, code } = index.coded;
        let key = (position, term, negated, code);
        if let Some(&made) = self.made.get(&key) {
            return Ok(made);
        }
        let power = (!matches!(code, NONE | 10)).then(|| f64::from(code) / 10.0);
        let terms = self.outputs.get_mut(position).map(|output| &mut output.terms);
        let found = terms.and_then(|terms| {
            let base = terms.get(term)?;
            let Conclusion::Set { membership, lower: None } = &base.conclusion else { return None };
            let membership = hedged::set(membership, power, negated)?;
            let name = name_of(&base.name, power, negated, terms);
            Some((terms, name, membership))
        });
        let Some((terms, name, membership)) = found else {
            let message = "a hedge or `not` in a conclusion about such a term is not read";
            return Err(wrong(index.place, index.word, message, "the index of a set alone"));
        };
        let message = format!("a hedge in a conclusion changes the set, as in Octave: `{name}`");
        report.note(index.place, message);
        terms.push(OutputTerm { name, conclusion: Conclusion::Set { membership, lower: None } });
        self.made.insert(key, terms.len() - 1);
        Ok(terms.len() - 1)
    }
}

/// `not fast^2`, or longer if that name is taken.
fn name_of(base: &str, power: Option<f64>, negated: bool, taken: &[OutputTerm]) -> String {
    let not = if negated { "not " } else { "" };
    let power = power.map(|power| format!("^{}", written(power))).unwrap_or_default();
    let mut name = format!("{not}{base}{power}");
    while taken.iter().any(|term| term.name == name) {
        name.push('\'');
    }
    name
}

/// The position of the set, if the variable is used.
fn within(index: &Index, variable: &str, count: usize) -> Result<Option<usize>, Problem> {
    if index.set > count {
        let variable = crate::report::clipped(variable);
        let message = format!("`{variable}` has {count} membership functions");
        return Err(wrong(index.place, index.word, message, format!("at most {count}")));
    }
    Ok(index.set.checked_sub(1))
}

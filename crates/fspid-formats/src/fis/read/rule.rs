//! Rules: rows checked against the variables.

use fspid_fuzzy::Hedge;
use fspid_fuzzy::system::{Antecedent, Consequent, Input, Output, Rule, Statement, Variable};

use super::row::{Index, Row, row};
use super::source::Source;
use crate::fis::hedge::{NONE, of_code};
use crate::note::{Place, Problem};
use crate::report::{Report, wrong};

/// Every rule of the file that can be read; the others are noted down as problems.
pub(super) fn rules(
    source: &Source,
    inputs: &[Input],
    outputs: &[Output],
    report: &mut Report,
) -> Vec<Rule> {
    if source.rules.is_none() {
        report.whole("there is no section `[Rules]`");
    }
    let rules = source.rows.iter().map_while(|line| {
        if report.is_full() {
            return None;
        }
        let rule = row(*line).and_then(|row| rule(&row, inputs, outputs, report));
        Some(report.keep(rule).flatten())
    });
    rules.flatten().collect()
}

fn rule(
    row: &Row,
    inputs: &[Input],
    outputs: &[Output],
    report: &mut Report,
) -> Result<Option<Rule>, Problem> {
    counted(row.place, row.inputs.len(), inputs.len(), "inputs")?;
    counted(row.place, row.outputs.len(), outputs.len(), "outputs")?;
    let statements = row.inputs.iter().zip(inputs).enumerate();
    let statements: Vec<_> = statements
        .filter_map(|(position, (index, input))| {
            statement(index, position, input, report).transpose()
        })
        .collect::<Result<_, _>>()?;
    let consequents = row.outputs.iter().zip(outputs).enumerate();
    let consequents: Vec<_> = consequents
        .filter_map(|(position, (index, output))| consequent(index, position, output).transpose())
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

fn antecedent(row: &Row, mut statements: Vec<Antecedent>, report: &mut Report) -> Antecedent {
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

fn consequent(
    index: &Index,
    position: usize,
    output: &Output,
) -> Result<Option<Consequent>, Problem> {
    let Some(term) = within(index, &output.name, output.terms.len())? else { return Ok(None) };
    let message = match index.coded {
        coded if coded.negated => "`not` in a conclusion is not read",
        coded if coded.code != NONE => "a hedge in a conclusion is not read",
        _ => return Ok(Some(Consequent { output: position, term, hedges: Vec::new() })),
    };
    Err(wrong(index.place, index.word, message, "the index of a set alone"))
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

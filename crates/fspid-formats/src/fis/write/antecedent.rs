//! Antecedents as rows: one index for each input, joined by one connective.
//!
//! What is nested is rewritten where the other form is equal: negations move inwards by De Morgan
//! where *and* and *or* mirror each other, and an *or* inside splits a rule in two where strengths
//! are joined by the maximum anyway.

use fspid_fuzzy::Hedge;
use fspid_fuzzy::system::{Antecedent, Statement, Variable};

use super::method::Methods;

/// Most rows that one rule may become.
const MOST_ROWS: usize = 64;

/// What a row asks of the inputs.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct AntecedentRow {
    /// Statements about different inputs.
    pub(super) statements: Vec<Statement>,
    /// Whether they are joined by *or*.
    pub(super) any: bool,
}

/// An antecedent without negations but in statements.
#[derive(Clone, Debug)]
enum Plain {
    Always,
    Never,
    Is(Statement),
    All(Vec<Plain>),
    Any(Vec<Plain>),
}

/// The rows of an antecedent; each fires on its own.
///
/// # Errors
/// Why there are none that say the same.
pub(super) fn rows(
    antecedent: &Antecedent,
    methods: &Methods,
) -> Result<Vec<AntecedentRow>, &'static str> {
    let plain = plain(antecedent, false, methods)?;
    let flat = |any, parts: &[Plain]| {
        let statements = parts.iter().map(statement).collect::<Option<Vec<_>>>()?;
        once(&statements).then(|| vec![AntecedentRow { statements, any }])
    };
    let whole = match &plain {
        Plain::Any(parts) => flat(true, parts),
        Plain::All(parts) => flat(false, parts),
        Plain::Is(_) => flat(false, std::slice::from_ref(&plain)),
        Plain::Always => Some(vec![AntecedentRow { statements: Vec::new(), any: false }]),
        Plain::Never => Some(vec![AntecedentRow { statements: Vec::new(), any: true }]),
    };
    match whole {
        Some(rows) => Ok(rows),
        None if methods.splits_or() => split(&plain),
        None => Err("a nested condition cannot be written with these norms"),
    }
}

fn statement(part: &Plain) -> Option<Statement> {
    if let Plain::Is(statement) = part { Some(statement.clone()) } else { None }
}

/// True if every input is asked about at most once.
fn once(statements: &[Statement]) -> bool {
    let mut inputs: Vec<_> = statements.iter().filter_map(|s| input(s.variable)).collect();
    inputs.sort_unstable();
    inputs.windows(2).all(|pair| pair.first() != pair.last())
}

/// The position of an input.
pub(super) fn input(variable: Variable) -> Option<usize> {
    if let Variable::Input(position) = variable { Some(position) } else { None }
}

/// One row for each alternative.
fn split(plain: &Plain) -> Result<Vec<AntecedentRow>, &'static str> {
    let rows: Vec<_> = alternatives(plain)?
        .into_iter()
        .map(|statements| AntecedentRow { statements, any: false })
        .collect();
    if rows.iter().all(|row| once(&row.statements)) {
        return Ok(rows);
    }
    Err("a condition asks twice about the same input, which a row cannot do")
}

/// The alternatives, each a list of statements that must all hold.
fn alternatives(plain: &Plain) -> Result<Vec<Vec<Statement>>, &'static str> {
    let found = match plain {
        Plain::Always => vec![Vec::new()],
        Plain::Never => Vec::new(),
        Plain::Is(statement) => vec![vec![statement.clone()]],
        Plain::Any(parts) => {
            let parts = parts.iter().map(alternatives).collect::<Result<Vec<_>, _>>()?;
            parts.concat()
        }
        Plain::All(parts) => parts.iter().try_fold(vec![Vec::new()], |before, part| {
            let next = alternatives(part)?;
            fits(before.len() * next.len())?;
            let pairs = before.iter().flat_map(|left| next.iter().map(move |right| (left, right)));
            Ok::<_, &'static str>(pairs.map(|(l, r)| [l.as_slice(), r].concat()).collect())
        })?,
    };
    fits(found.len())?;
    Ok(found)
}

fn fits(rows: usize) -> Result<(), &'static str> {
    if rows <= MOST_ROWS { Ok(()) } else { Err("a nested condition would need more than 64 rules") }
}

/// The antecedent, or one minus it, with negations in its statements only.
fn plain(antecedent: &Antecedent, negated: bool, methods: &Methods) -> Result<Plain, &'static str> {
    match antecedent {
        Antecedent::Always => Ok(if negated { Plain::Never } else { Plain::Always }),
        Antecedent::Is(statement) => about(statement, negated),
        Antecedent::Not(part) => plain(part, !negated, methods),
        // Without any part they hold always.
        Antecedent::All(parts) | Antecedent::Any(parts) if parts.is_empty() => {
            plain(&Antecedent::Always, negated, methods)
        }
        Antecedent::All(parts) | Antecedent::Any(parts) if parts.len() == 1 => {
            parts.first().map_or(Ok(Plain::Always), |part| plain(part, negated, methods))
        }
        Antecedent::All(_) | Antecedent::Any(_) if negated && !methods.mirrors() => {
            Err("`not` before several statements cannot be written with these norms")
        }
        Antecedent::All(parts) => Ok(joined(parts, negated, negated, methods)?),
        Antecedent::Any(parts) => Ok(joined(parts, !negated, negated, methods)?),
    }
}

/// A statement about an input; `any` without a set always holds.
fn about(statement: &Statement, negated: bool) -> Result<Plain, &'static str> {
    if input(statement.variable).is_none() {
        return Err("a condition about an output cannot be written");
    }
    let nots = statement.hedges.iter().take_while(|hedge| **hedge == Hedge::Not).count();
    let certain = statement.hedges.get(nots) == Some(&Hedge::Any) || statement.term.is_none();
    if certain {
        return Ok(if negated == (nots % 2 == 1) { Plain::Always } else { Plain::Never });
    }
    let mut statement = statement.clone();
    if negated {
        statement.hedges.insert(0, Hedge::Not);
    }
    Ok(Plain::Is(statement))
}

/// Parts joined by *or* if `any`, nested ones of the same kind taken in; what is certain is
/// neutral to one connective and decides the other.
fn joined(
    parts: &[Antecedent],
    any: bool,
    negated: bool,
    methods: &Methods,
) -> Result<Plain, &'static str> {
    let mut flat = Vec::new();
    for part in parts {
        match (plain(part, negated, methods)?, any) {
            (Plain::Always, false) | (Plain::Never, true) => {}
            (Plain::Always, true) => return Ok(Plain::Always),
            (Plain::Never, false) => return Ok(Plain::Never),
            (Plain::All(inner), false) | (Plain::Any(inner), true) => flat.extend(inner),
            (other, _) => flat.push(other),
        }
    }
    Ok(match (flat.len(), any) {
        (0, true) => Plain::Never,
        (0, false) => Plain::Always,
        (1, _) => flat.remove(0),
        (_, true) => Plain::Any(flat),
        (_, false) => Plain::All(flat),
    })
}

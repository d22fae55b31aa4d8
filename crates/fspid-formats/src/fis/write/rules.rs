//! `[Rules]`: each rule as one row, or as several that come to the same.

use fspid_fuzzy::Hedge;
use fspid_fuzzy::system::{Consequent, Parts, Rule, Statement};

use super::antecedent::{AntecedentRow, input, rows};
use super::losses::Losses;
use super::method::{Methods, acts};
use crate::fis::hedge::{Coded, NONE, of_code, to_code};
use crate::number::written;

/// Every row, line by line.
pub(super) fn lines(parts: &Parts, methods: &Methods, losses: &mut Losses) -> Vec<String> {
    let mut writer = Writer { parts, losses, lines: Vec::new(), place: String::new() };
    let blocks = parts.blocks.iter().filter(|block| acts(block));
    for (rule, number) in blocks.flat_map(|block| &block.rules).zip(1..) {
        writer.place = format!("rule {number}");
        match rows(&rule.antecedent, methods) {
            Ok(rows) => writer.rule(rule, &rows),
            Err(message) => writer.losses.never(format!("{}: {message}", writer.place)),
        }
    }
    writer.lines
}

struct Writer<'a> {
    parts: &'a Parts,
    losses: &'a mut Losses,
    lines: Vec<String>,
    /// The rule at hand, for messages.
    place: String,
}

impl Writer<'_> {
    fn rule(&mut self, rule: &Rule, rows: &[AntecedentRow]) {
        let place = &self.place;
        if rows.len() > 1 {
            let count = rows.len();
            self.losses.note(format!("{place} is written as {count} rules that come to the same"));
        }
        if !rule.enabled {
            self.losses.note(format!("{place} is switched off and written with the weight 0"));
        }
        let weight = written(if rule.enabled { rule.weight } else { 0.0 });
        for row in rows {
            let left = self.inputs(row);
            let connective = if row.any { 2 } else { 1 };
            for right in self.outputs(&rule.consequents) {
                self.lines.push(format!("{left}, {right} ({weight}) : {connective}"));
            }
        }
    }

    fn inputs(&mut self, row: &AntecedentRow) -> String {
        let mut indices = vec![String::from("0"); self.parts.inputs.len()];
        for statement in &row.statements {
            let index = self.index(statement);
            if let Some(place) = input(statement.variable).and_then(|at| indices.get_mut(at)) {
                *place = index;
            }
        }
        indices.join(" ")
    }

    fn index(&mut self, statement: &Statement) -> String {
        let Coded { negated, code } = coded(&self.place, &statement.hedges, self.losses);
        let sign = if negated { "-" } else { "" };
        let set = statement.term.map_or(0, |term| term + 1);
        if code == NONE { format!("{sign}{set}") } else { format!("{sign}{set}.{code:02}") }
    }

    /// The conclusions as rows of indices; several about one output take a row each.
    fn outputs(&mut self, consequents: &[Consequent]) -> Vec<String> {
        let mut rows: Vec<Vec<usize>> = Vec::new();
        for consequent in consequents {
            if !consequent.hedges.is_empty() {
                let place = &self.place;
                self.losses.never(format!("{place}: a hedge in a conclusion cannot be written"));
            }
            conclude(&mut rows, consequent, self.parts.outputs.len());
        }
        let text =
            |row: Vec<usize>| row.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
        rows.into_iter().map(text).collect()
    }
}

/// Puts a conclusion into the first row that has none about its output.
fn conclude(rows: &mut Vec<Vec<usize>>, consequent: &Consequent, outputs: usize) {
    let is_free = |row: &&mut Vec<usize>| row.get(consequent.output) == Some(&0);
    if rows.iter_mut().find(is_free).is_none() {
        rows.push(vec![0; outputs]);
    }
    let free = rows.iter_mut().find(is_free);
    if let Some(index) = free.and_then(|row| row.get_mut(consequent.output)) {
        *index = consequent.term + 1;
    }
}

/// The hedges as a code, if need be the nearest one.
fn coded(place: &str, hedges: &[Hedge], losses: &mut Losses) -> Coded {
    to_code(hedges).unwrap_or_else(|| {
        let (coded, error) = nearest(hedges);
        let code = coded.code;
        losses.lost(format!(
            "{place}: no code says these hedges; `.{code:02}` differs by up to {error:.3}"
        ));
        coded
    })
}

fn nearest(hedges: &[Hedge]) -> (Coded, f64) {
    let error = |coded: Coded| {
        let grades = (0..=100_u8).map(|step| f64::from(step) / 100.0);
        let difference = grades.map(|grade| {
            let wanted = hedges.iter().rev().fold(grade, |grade, hedge| hedge.apply(grade));
            let found = of_code(coded.code).map_or(grade, |hedge| hedge.apply(grade));
            (if coded.negated { 1.0 - found } else { found }) - wanted
        });
        (coded, difference.map(f64::abs).fold(0.0, f64::max))
    };
    let codes = [false, true]
        .into_iter()
        .flat_map(|negated| (0..=99).map(move |code| Coded { negated, code }));
    let plain = Coded { negated: false, code: NONE };
    codes.map(error).min_by(|(_, a), (_, b)| a.total_cmp(b)).unwrap_or((plain, 1.0))
}

//! Rules as grids: for every pair of terms of two inputs the term of each output.

use fspid_fuzzy::system::{
    Antecedent, Consequent, Input, Parts, Rule, RuleBlock, Statement, Variable,
};

use super::super::fields::{Fields, below, in_order, word};
use super::super::spec::{CELLS, COLUMNS, ROWS};
use super::Vocabulary;
use crate::keyed::document::{Item, Value as Written};
use crate::keyed::{Key, Section};
use crate::toml_text::{key, quoted};
use fspid_diagnostics::{Report, Span};

/// The cell that stands for no rule.
const NO_RULE: &str = "-";

/// The position of a rule table's input.
fn axis(report: &mut Report, table: &Section, key: Key<str>, inputs: &[Input]) -> Option<usize> {
    let name = table.get(key)?;
    let known: Vec<&str> = inputs.iter().map(|input| input.name.as_str()).collect();
    let at = (table.at(key), table.path(key));
    word(report, (at.0, &at.1), name, ("input", &known))?;
    known.iter().position(|known| *known == name)
}

pub(super) fn read(
    report: &mut Report,
    table: &Section,
    vocabulary: Vocabulary<'_>,
) -> Option<Vec<(Rule, Span)>> {
    let rows = axis(report, table, ROWS, vocabulary.inputs);
    let columns = axis(report, table, COLUMNS, vocabulary.inputs);
    let (rows, columns) = (rows?, columns?);
    if rows == columns {
        let message = "the same input as `rows`";
        table.wrong(report, COLUMNS, message, "another input");
        return None;
    }
    let before = report.count();
    let size = [rows, columns].map(|n| vocabulary.inputs.get(n).map_or(0, |i| i.terms.len()));
    let path = table.path(CELLS);
    let fields = Fields::of(report, table.get(CELLS)?, &path, &in_words())?;
    let (members, report) = (fields.members, fields.report);
    let mut grids = Vec::new();
    for member in in_order(members) {
        let path = below(&path, &member.name);
        let known: Vec<&str> = vocabulary.outputs.iter().map(|o| o.name.as_str()).collect();
        let found = word(report, (member.place, &path), &member.name, ("output", &known));
        let position = found.and_then(|name| known.iter().position(|known| *known == name));
        let Some(output) = position else { continue };
        let terms = vocabulary.outputs.get(output).map_or(&[][..], |output| &output.terms);
        let terms: Vec<&str> = terms.iter().map(|term| term.name.as_str()).collect();
        if let Some(cells) = cells(report, &member.item, &path, (size, &terms)) {
            grids.push((output, cells));
        }
    }
    (report.count() == before).then(|| expand([rows, columns], size, &grids))
}

/// A cell: the position of its term, if it holds a rule, and its place.
type Cell = (Option<usize>, Span);

/// A rule for each pair of terms of which some output has a cell, row by row.
fn expand(axes: [usize; 2], size: [usize; 2], grids: &[(usize, Vec<Cell>)]) -> Vec<(Rule, Span)> {
    let pairs = (0..size[0]).flat_map(|row| (0..size[1]).map(move |column| [row, column]));
    pairs
        .enumerate()
        .filter_map(|(cell, pair)| {
            let consequents: Vec<(Consequent, Span)> = grids
                .iter()
                .filter_map(|(output, cells)| {
                    let (term, place) = *cells.get(cell)?;
                    Some((consequent(*output, term?), place))
                })
                .collect();
            let place = consequents.first()?.1;
            let consequents = consequents.into_iter().map(|(found, _)| found).collect();
            Some((pair_rule(axes, pair, consequents), place))
        })
        .collect()
}

fn consequent(output: usize, term: usize) -> Consequent {
    Consequent { output, term, hedges: Vec::new() }
}

/// The rule of a cell of a rule table.
fn pair_rule(axes: [usize; 2], terms: [usize; 2], consequents: Vec<Consequent>) -> Rule {
    let [row, column] = [0, 1].map(|n: usize| {
        let (input, term) = (axes.get(n).copied(), terms.get(n).copied());
        let variable = Variable::Input(input.unwrap_or_default());
        Antecedent::Is(Statement { variable, term, hedges: Vec::new() })
    });
    Rule {
        name: String::new(),
        enabled: true,
        antecedent: Antecedent::All(vec![row, column]),
        consequents,
        weight: 1.0,
    }
}

/// The cells of one output, row by row.
fn cells(
    report: &mut Report,
    item: &Item,
    path: &str,
    ([rows, columns], terms): ([usize; 2], &[&str]),
) -> Option<Vec<Cell>> {
    let Written::Text(_) = &item.value else {
        let message = format!("expected a text, not {}", item.value.type_name());
        report.value(item.place, path, message, in_words());
        return None;
    };
    let before = report.count();
    let lines = lines_of(report.text(item.place), item.place);
    if lines.len() != rows {
        let message = format!("{} lines for {rows} terms of the input of the rows", lines.len());
        report.missing(item.place, path, message, format!("{rows} lines"));
    }
    let mut known = terms.to_vec();
    known.push(NO_RULE);
    let mut found = Vec::new();
    for (place, line) in lines {
        let words: Vec<(usize, String)> =
            words_of(&line).map(|(at, word)| (at, word.to_owned())).collect();
        if words.len() != columns {
            let message =
                format!("{} words for {columns} terms of the input of the columns", words.len());
            report.line(place, message);
            continue;
        }
        for (at, text) in words {
            let start = place.start + at;
            let place = Span { start, end: start + text.len(), ..place };
            let term = word(report, (place, path), &text, ("term", &known));
            found.push((term.and_then(|t| terms.iter().position(|known| *known == t)), place));
        }
    }
    (report.count() == before).then_some(found)
}

/// The lines of a text in the file that are not empty, with their places.
pub(super) fn lines_of(written: &str, whole: Span) -> Vec<(Span, String)> {
    let inner = written.trim_start_matches(['"', '\'']);
    let mut start = whole.start + (written.len() - inner.len());
    let inner = inner.trim_end_matches(['"', '\'']);
    let mut lines = Vec::new();
    for line in inner.split_inclusive('\n') {
        let text = line.trim_end_matches(['\n', '\r']);
        if !text.trim().is_empty() {
            let place = Span { start, end: start + text.len(), ..whole };
            lines.push((place, text.to_owned()));
        }
        start += line.len();
    }
    lines
}

/// The words of a line, each with the byte where it begins.
fn words_of(line: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut rest = line;
    let mut at = 0;
    std::iter::from_fn(move || {
        let begin = rest.find(|c: char| !c.is_whitespace())?;
        let tail = rest.get(begin..)?;
        let length = tail.find(char::is_whitespace).unwrap_or(tail.len());
        let word = tail.get(..length)?;
        let start = at + begin;
        at = start + length;
        rest = tail.get(length..)?;
        Some((start, word))
    })
}

/// The rules of a block as grids, if that is all they are: a rule without name for every pair of
/// terms of two inputs, row by row, with the same outputs in each.
pub(super) fn write(block: &RuleBlock, parts: &Parts) -> Option<String> {
    let axes = axes(block)?;
    let [rows, columns] = axes.map(|axis| parts.inputs.get(axis));
    let (rows, columns) = (rows?, columns?);
    let size = [rows.terms.len(), columns.terms.len()];
    let pairs = (0..size[0]).flat_map(|row| (0..size[1]).map(move |column| [row, column]));
    let concluded: Vec<usize> = block.rules.first()?.consequents.iter().map(|c| c.output).collect();
    let as_pairs = pairs.zip(&block.rules).all(|(pair, rule)| {
        let outputs = rule.consequents.iter().map(|consequent| consequent.output);
        outputs.eq(concluded.iter().copied())
            && *rule == pair_rule(axes, pair, rule.consequents.clone())
            && rule.consequents.iter().all(|consequent| consequent.hedges.is_empty())
    });
    if !as_pairs || size[0] * size[1] != block.rules.len() || size.contains(&1) {
        return None;
    }
    let mut out = format!(
        "\n[rules.table]\nrows = {}\ncolumns = {}\n\n[rules.table.cells]\n",
        quoted(&rows.name),
        quoted(&columns.name)
    );
    for (position, output) in concluded.iter().enumerate() {
        let output = parts.outputs.get(*output)?;
        let words = block.rules.iter().map(|rule| {
            let consequent = rule.consequents.get(position)?;
            Some(output.terms.get(consequent.term)?.name.as_str())
        });
        let words: Vec<&str> = words.collect::<Option<_>>()?;
        out.push_str(&format!(
            "{} = \"\"\"\n{}\"\"\"\n",
            key(&output.name),
            lines(&words, size[1])?
        ));
    }
    Some(out)
}

/// The inputs of the rows and columns, by the first rule; each output may be concluded only once.
fn axes(block: &RuleBlock) -> Option<[usize; 2]> {
    let first = block.rules.first()?;
    let Antecedent::All(pair) = &first.antecedent else { return None };
    let input = |antecedent: &Antecedent| match antecedent {
        Antecedent::Is(Statement { variable: Variable::Input(input), .. }) => Some(*input),
        _ => None,
    };
    let mut outputs: Vec<usize> = first.consequents.iter().map(|c| c.output).collect();
    outputs.sort_unstable();
    let repeats = outputs.windows(2).any(|pair| pair.first() == pair.last());
    match pair.as_slice() {
        [row, column] if !repeats && input(row)? != input(column)? => {
            Some([input(row)?, input(column)?])
        }
        _ => None,
    }
}

/// Words in rows and aligned columns; nothing if one of them cannot stand in a grid.
fn lines(words: &[&str], columns: usize) -> Option<String> {
    let fits = |word: &&str| {
        *word != NO_RULE
            && !word.is_empty()
            && !word.contains(|c: char| c.is_whitespace() || c.is_control() || "\"\\'".contains(c))
    };
    if !words.iter().all(fits) {
        return None;
    }
    let width = words.iter().map(|word| word.chars().count()).max().unwrap_or(0);
    let line = |row: &[&str]| {
        let cells: Vec<String> = row.iter().map(|word| format!("{word:width$}")).collect();
        format!("{}\n", cells.join(" ").trim_end())
    };
    Some(words.chunks(columns.max(1)).map(line).collect())
}

pub(in super::super) fn in_words() -> String {
    "for each output a text with a line for each row and a term (or `-`) for each column".to_owned()
}

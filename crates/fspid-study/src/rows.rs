//! Tables of questions, answered row by row in constant memory.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Write};
use std::path::Path;

use fspid_scenario::file::unread_in_words;

/// Most problems that are told of one table.
const MOST_PROBLEMS: usize = 20;
/// Longest line, bytes.
const LONGEST_LINE: u64 = 1 << 20;

/// Why not every row was answered.
#[derive(Debug, thiserror::Error)]
pub enum RowsError {
    /// The table is wrong.
    #[error("{}\n{}", problems.join("\n"), in_words(*answered))]
    Problems {
        /// What is wrong, each with its line.
        problems: Vec<String>,
        /// How many rows had been answered before the first problem; `None` where the table was
        /// checked before.
        answered: Option<u64>,
    },
    /// The table could not be read to its end.
    #[error("{0}")]
    Reading(io::Error),
    /// The answers could not be written.
    #[error("cannot be written: {0}")]
    Writing(io::Error),
}

/// How many rows were answered before the first problem.
fn in_words(answered: Option<u64>) -> String {
    match answered {
        None => "no row was answered".to_owned(),
        Some(1) => "1 row was answered before the first problem".to_owned(),
        Some(n) => format!("{n} rows were answered before the first problem"),
    }
}

/// Something that answers rows of numbers.
pub trait RowAnswers {
    /// Names of the columns that a row is read from.
    fn inputs(&self) -> Vec<&str>;
    /// Names of the columns of the answers.
    fn outputs(&self) -> Vec<&str>;
    /// Whether the row may be asked.
    ///
    /// # Errors
    /// What is wrong with it.
    fn check(&self, row: &[f64]) -> Result<(), String>;
    /// Appends a line with the row and its answers.
    ///
    /// # Errors
    /// What is wrong with the row.
    fn answer(&mut self, row: &[f64], line: &mut String) -> Result<(), String>;
    /// What is to be known of the answers so far, which their lines do not say.
    fn remarks(&self) -> Vec<String> {
        Vec::new()
    }
}

/// Answers every row of a CSV file, as [`answer_rows`] does. A regular file is checked from end to
/// end before, so that nothing is written if any of its rows is wrong.
///
/// # Errors
/// [`RowsError`]; each problem begins with the path.
pub fn answer_file(
    table: &mut impl RowAnswers,
    path: &Path,
    out: &mut impl Write,
) -> Result<u64, RowsError> {
    let named = |error| named(&path.display().to_string(), error);
    let open = || File::open(path).map(BufReader::new).map_err(RowsError::Reading);
    let is_regular = path.metadata().map_err(RowsError::Reading).map_err(named)?.is_file();
    if is_regular {
        open().and_then(|mut rows| check_rows(table, &mut rows)).map_err(named)?;
    }
    open().and_then(|mut rows| answer_rows(table, &mut rows, out)).map_err(named)
}

/// The error with the table's name before each of its problems.
#[must_use]
pub fn named(name: &str, error: RowsError) -> RowsError {
    match error {
        RowsError::Problems { problems, answered } => {
            let is_placed = |problem: &String| problem.starts_with(|c: char| c.is_ascii_digit());
            let place = |problem: String| match is_placed(&problem) {
                true => format!("{name}:{problem}"),
                false => problem,
            };
            RowsError::Problems { problems: problems.into_iter().map(place).collect(), answered }
        }
        RowsError::Reading(error) => {
            let reason = unread_in_words(&error);
            RowsError::Reading(io::Error::new(
                error.kind(),
                format!("{name}: cannot be read: {reason}"),
            ))
        }
        writing @ RowsError::Writing(_) => writing,
    }
}

/// Answers every row of a CSV table: a column for each input, found by its name; other columns are
/// passed over. Each answer is a row of the inputs and then the outputs; an output without an
/// answer is left empty. Memory does not grow with the table.
///
/// After the first row that is wrong nothing more is written, but the rest is still checked, so
/// that the first problems are told together.
///
/// # Errors
/// [`RowsError`].
pub fn answer_rows(
    table: &mut impl RowAnswers,
    rows: &mut impl BufRead,
    out: &mut impl Write,
) -> Result<u64, RowsError> {
    let mut reader = Reader::new(rows, &table.inputs())?;
    let mut line = format!("{}\n", heading(table));
    let mut answered = 0;
    let mut problems = Vec::new();
    loop {
        if problems.is_empty() {
            out.write_all(line.as_bytes()).map_err(RowsError::Writing)?;
        }
        line.clear();
        match reader.next()? {
            None => break,
            Some(Ok(row)) => {
                let found = match problems.is_empty() {
                    true => table.answer(row, &mut line),
                    false => table.check(row),
                };
                answered += u64::from(problems.is_empty() && found.is_ok());
                problems.extend(found.err().map(|problem| reader.placed(&problem)));
            }
            Some(Err(problem)) => problems.push(problem),
        }
        if problems.len() >= MOST_PROBLEMS {
            problems.push("and perhaps more".to_owned());
            break;
        }
    }
    out.flush().map_err(RowsError::Writing)?;
    finish(problems, Some(answered)).map(|()| answered)
}

/// Checks every row without answering any.
///
/// # Errors
/// [`RowsError`].
pub fn check_rows(table: &impl RowAnswers, rows: &mut impl BufRead) -> Result<(), RowsError> {
    let mut reader = Reader::new(rows, &table.inputs())?;
    let mut problems = Vec::new();
    while let Some(row) = reader.next()? {
        match row {
            Ok(row) => {
                let found = table.check(row).err();
                problems.extend(found.map(|problem| reader.placed(&problem)));
            }
            Err(problem) => problems.push(problem),
        }
        if problems.len() >= MOST_PROBLEMS {
            problems.push("and perhaps more".to_owned());
            break;
        }
    }
    finish(problems, None)
}

fn finish(problems: Vec<String>, answered: Option<u64>) -> Result<(), RowsError> {
    if problems.is_empty() { Ok(()) } else { Err(RowsError::Problems { problems, answered }) }
}

fn heading(table: &impl RowAnswers) -> String {
    let names = table.inputs().into_iter().chain(table.outputs());
    names.map(quoted).collect::<Vec<_>>().join(",")
}

/// A name as a cell of CSV.
pub(crate) fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", name.replace('"', "\"\""))
    } else {
        name.to_owned()
    }
}

/// Reads rows of numbers out of a table, one line at a time.
struct Reader<'r, R> {
    rows: &'r mut R,
    names: Vec<String>,
    /// For each input the number of its column.
    columns: Vec<usize>,
    line: Vec<u8>,
    number: u64,
    row: Vec<f64>,
}

impl<'r, R: BufRead> Reader<'r, R> {
    fn new(rows: &'r mut R, names: &[&str]) -> Result<Self, RowsError> {
        let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        let row = vec![0.0; names.len()];
        let mut reader =
            Self { rows, names, columns: Vec::new(), line: Vec::new(), number: 0, row };
        reader.advance()?;
        let text = String::from_utf8_lossy(&reader.line).into_owned();
        reader.find_columns(text.trim_start_matches('\u{feff}').trim_end())?;
        Ok(reader)
    }

    fn find_columns(&mut self, heading: &str) -> Result<(), RowsError> {
        let words = cells(heading);
        let wrong = |problem| RowsError::Problems { problems: vec![problem], answered: None };
        if let Some((one, other, name)) = named_twice(&words) {
            let (one, other) = (one + 1, other + 1);
            return Err(wrong(format!(
                "1: columns {one} and {other} are both named `{name}`; names of columns must differ"
            )));
        }
        let column = |name: &String| words.iter().position(|word| word == name);
        if let Some(columns) = self.names.iter().map(column).collect() {
            self.columns = columns;
            return Ok(());
        }
        let shown: String = heading.chars().take(80).collect();
        let needed = self.names.join(" and ");
        Err(wrong(format!("1: the heading is `{shown}`; it must name the columns {needed}")))
    }

    /// Reads the next line; false at the end.
    fn advance(&mut self) -> Result<bool, RowsError> {
        self.line.clear();
        self.number += 1;
        let mut limited = io::Read::take(&mut *self.rows, LONGEST_LINE);
        limited.read_until(b'\n', &mut self.line).map_err(RowsError::Reading)?;
        if self.line.len() as u64 == LONGEST_LINE {
            let problem = self.placed(&format!("a line of more than {LONGEST_LINE} bytes"));
            return Err(RowsError::Problems { problems: vec![problem], answered: None });
        }
        Ok(!self.line.is_empty())
    }

    /// The next row that is not empty, or what is wrong with it; nothing at the end.
    fn next(&mut self) -> Result<Option<Result<&[f64], String>>, RowsError> {
        loop {
            if !self.advance()? {
                return Ok(None);
            }
            if !self.line.trim_ascii().is_empty() {
                break;
            }
        }
        let Self { line, columns, row, names, number, .. } = self;
        let found =
            parse(line, columns, names, row).map_err(|problem| format!("{number}: {problem}"));
        Ok(Some(found.map(|()| row.as_slice())))
    }

    /// A problem with the number of the line at hand.
    fn placed(&self, problem: &str) -> String {
        format!("{}: {problem}", self.number)
    }
}

/// The first name that stands over two columns, with their places; columns without a name are nobody's.
fn named_twice(words: &[String]) -> Option<(usize, usize, &String)> {
    let mut places = BTreeMap::new();
    let named = words.iter().enumerate().filter(|(_, word)| !word.is_empty());
    named.into_iter().find_map(|(other, word)| Some((places.insert(word, other)?, other, word)))
}

fn parse(line: &[u8], columns: &[usize], names: &[String], row: &mut [f64]) -> Result<(), String> {
    let line = std::str::from_utf8(line).map_err(|_| "not UTF-8".to_owned())?.trim_end();
    let quoted = line.contains('"').then(|| cells(line));
    for ((place, &column), name) in row.iter_mut().zip(columns).zip(names) {
        let word = match &quoted {
            Some(cells) => cells.get(column).map_or("", String::as_str),
            None => line.split(',').nth(column).unwrap_or(""),
        };
        *place = word
            .trim()
            .parse()
            .map_err(|_| format!("{name} is `{}`; allowed is a number", word.trim()))?;
    }
    Ok(())
}

/// The cells of a line of CSV; in quotes a comma does not end one.
fn cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut in_quotes = false;
    let mut characters = line.chars().peekable();
    while let Some(c) = characters.next() {
        match c {
            '"' if in_quotes && characters.peek() == Some(&'"') => {
                characters.next();
                push(&mut cells, '"');
            }
            '"' => in_quotes = !in_quotes,
            ',' if !in_quotes => cells.push(String::new()),
            c => push(&mut cells, c),
        }
    }
    cells.iter().map(|cell| cell.trim().to_owned()).collect()
}

fn push(cells: &mut [String], c: char) {
    if let Some(cell) = cells.last_mut() {
        cell.push(c);
    }
}

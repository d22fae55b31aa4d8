//! A file taken apart into sections, keys and values; what they mean is settled later.

use std::collections::BTreeMap;

use crate::cursor::Cursor;
use crate::report::{Report, one_of, wrong};
use fspid_diagnostics::{Place, Problem};

/// `key = value`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry<'a> {
    pub(super) key: &'a str,
    pub(super) place: Place,
    /// Begins with the first character of the value.
    pub(super) value: Cursor<'a>,
}

/// A section of keys and values.
#[derive(Debug)]
pub(super) struct FisSection<'a> {
    pub(super) place: Place,
    pub(super) entries: Vec<Entry<'a>>,
}

/// A file.
#[derive(Debug, Default)]
pub(super) struct Source<'a> {
    pub(super) system: BTreeMap<usize, FisSection<'a>>,
    pub(super) inputs: BTreeMap<usize, FisSection<'a>>,
    pub(super) outputs: BTreeMap<usize, FisSection<'a>>,
    /// Where `[Rules]` stands.
    pub(super) rules: Option<Place>,
    /// The lines of `[Rules]`.
    pub(super) rows: Vec<Cursor<'a>>,
}

/// Where the lines that follow belong.
#[derive(Clone, Copy)]
enum Open {
    /// Before the first section.
    Nowhere,
    /// To a section that has been refused.
    Refused,
    System,
    Input(usize),
    Output(usize),
    Rules,
}

/// Sections, as an unknown one is answered with.
const SECTIONS: [&str; 4] = ["[System]", "[Input1]", "[Output1]", "[Rules]"];

impl<'a> Source<'a> {
    /// Takes a text apart.
    pub(super) fn of(mut text: Cursor<'a>, report: &mut Report) -> Self {
        let mut source = Self::default();
        let mut open = Open::Nowhere;
        while let Some(line) = text.take_line().filter(|_| !report.is_full()) {
            let mut line = line.trimmed_end();
            line.skip_blanks();
            match line.peek() {
                None | Some('%' | '#') => {}
                Some('[') => open = source.section(line, report),
                _ => source.line(&mut open, line, report),
            }
        }
        source
    }

    fn section(&mut self, line: Cursor<'a>, report: &mut Report) -> Open {
        let place = line.place();
        let found = header(line).and_then(|open| self.begin(open, line));
        let Some(open) = report.keep(found) else { return Open::Refused };
        if let Some((sections, number)) = self.family(open) {
            sections.insert(number, FisSection { place, entries: Vec::new() });
        } else {
            self.rules = Some(place);
        }
        open
    }

    /// Refuses a section that is there already.
    fn begin(&mut self, open: Open, line: Cursor) -> Result<Open, Problem> {
        let before = match self.family(open) {
            Some((sections, number)) => sections.get(&number).map(|section| section.place),
            None => self.rules,
        };
        match before {
            None => Ok(open),
            Some(Place { line: first, .. }) => {
                let message = format!("stands here again; the first is in line {first}");
                Err(wrong(line.place(), line.rest(), message, "each section once"))
            }
        }
    }

    fn family(&mut self, open: Open) -> Option<(&mut BTreeMap<usize, FisSection<'a>>, usize)> {
        match open {
            Open::System => Some((&mut self.system, 1)),
            Open::Input(number) => Some((&mut self.inputs, number)),
            Open::Output(number) => Some((&mut self.outputs, number)),
            _ => None,
        }
    }

    fn line(&mut self, open: &mut Open, line: Cursor<'a>, report: &mut Report) {
        match *open {
            Open::Nowhere => {
                let expected = "`[System]` before anything else";
                report.problem(line.place(), line.rest(), "stands outside every section", expected);
                *open = Open::Refused;
            }
            Open::Refused => {}
            Open::Rules => self.rows.push(line),
            section => {
                let Some(entry) = report.keep(entry(line)) else { return };
                if let Some((sections, number)) = self.family(section) {
                    sections.entry(number).and_modify(|found| found.entries.push(entry));
                }
            }
        }
    }
}

fn entry(mut line: Cursor) -> Result<Entry, Problem> {
    let (place, whole) = (line.place(), line.rest());
    let key = line.take_while(|next| next != '=').trim_end();
    if !line.eat('=') {
        return Err(wrong(place, whole, "is no key with a value", "`Key=value`"));
    }
    line.skip_blanks();
    Ok(Entry { key, place, value: line })
}

/// `[System]`, `[Input1]`, …; blanks and capitals do not matter.
fn header(line: Cursor) -> Result<Open, Problem> {
    let inside = line.rest().strip_prefix('[').and_then(|rest| rest.split_once(']'));
    let behind = inside.map_or("", |(_, behind)| behind.trim_start());
    let unknown = || {
        let expected = one_of(SECTIONS.into_iter(), line.rest());
        wrong(line.place(), line.rest(), "unknown section", expected)
    };
    let (name, _) = inside
        .filter(|_| behind.is_empty() || behind.starts_with(['%', '#']))
        .ok_or_else(unknown)?;
    let name = name.trim();
    let digits = name.trim_start_matches(|next: char| !next.is_ascii_digit());
    let word = name.strip_suffix(digits).unwrap_or(name).trim_end();
    let number = digits.parse().ok().filter(|number| *number > 0);
    let is = |known: &str| word.eq_ignore_ascii_case(known);
    match number {
        None if digits.is_empty() && is("System") => Ok(Open::System),
        None if digits.is_empty() && is("Rules") => Ok(Open::Rules),
        Some(number) if is("Input") => Ok(Open::Input(number)),
        Some(number) if is("Output") => Ok(Open::Output(number)),
        _ => Err(unknown()),
    }
}

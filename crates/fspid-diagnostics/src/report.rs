//! The texts that are being read and the problems found in them so far.

use std::sync::Arc;

use crate::place::{LineStarts, Place};
use crate::problem::{Problem, Problems};

/// Longest excerpt of a file in a message, in characters.
const EXCERPT: usize = 60;

/// Most problems that are kept while reading; the rest is only counted.
const MOST: usize = 200;

/// A stretch of one of the texts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// Which text: 0 is the file itself.
    pub source: usize,
    /// First byte.
    pub start: usize,
    /// Byte after the last.
    pub end: usize,
}

/// A text and what it is called; `None` for the file itself.
#[derive(Clone, Debug)]
struct Source {
    origin: Option<String>,
    text: String,
    lines: LineStarts,
}

/// What is known about the files so far.
#[derive(Clone, Debug, Default)]
pub struct Report {
    sources: Vec<Arc<Source>>,
    /// With the number of the text that each is in.
    problems: Vec<(usize, Problem)>,
    omitted: usize,
    warnings: Vec<String>,
}

impl Report {
    /// Adds a text and returns its number.
    pub fn add_source(&mut self, origin: Option<String>, text: &str) -> usize {
        let (lines, text) = (LineStarts::of(text), text.to_owned());
        self.sources.push(Arc::new(Source { origin, text, lines }));
        self.sources.len() - 1
    }

    /// The text of a stretch.
    pub fn text(&self, place: Span) -> &str {
        let source = self.sources.get(place.source);
        source.and_then(|source| source.text.get(place.start..place.end)).unwrap_or_default()
    }

    /// Where a stretch begins, in people's terms.
    pub fn place(&self, place: Span) -> Option<Place> {
        let source = self.sources.get(place.source)?;
        Some(source.lines.place(&source.text, place.start))
    }

    /// What the text of a stretch is called; `None` for the file itself.
    fn origin(&self, place: Span) -> Option<&str> {
        self.sources.get(place.source)?.origin.as_deref()
    }

    /// How many problems there are so far.
    pub fn count(&self) -> usize {
        self.problems.len() + self.omitted
    }

    /// True when further problems are only counted.
    pub fn is_full(&self) -> bool {
        self.problems.len() >= MOST
    }

    /// A problem with a value, which is quoted.
    pub fn value(
        &mut self,
        place: Span,
        path: &str,
        message: impl Into<String>,
        allowed: impl Into<String>,
    ) {
        let found = excerpt(self.text(place));
        self.push(place, path, message.into(), found, allowed.into());
    }

    /// A problem with something that is not there or too long to quote.
    pub fn missing(
        &mut self,
        place: Span,
        path: &str,
        message: impl Into<String>,
        allowed: impl Into<String>,
    ) {
        self.push(place, path, message.into(), String::new(), allowed.into());
    }

    /// A problem with the line in which a place lies.
    pub fn line(&mut self, place: Span, message: String) {
        let source = self.sources.get(place.source);
        let text = source.map(|source| source.text.as_str()).unwrap_or_default();
        let before = text.get(..place.start).unwrap_or_default();
        let begin = before.rfind('\n').map_or(0, |at| at + 1);
        let line = text.get(begin..).and_then(|rest| rest.lines().next());
        let found = excerpt(line.unwrap_or_default().trim());
        self.push(place, "", message, found, String::new());
    }

    fn push(&mut self, place: Span, path: &str, message: String, found: String, allowed: String) {
        if self.is_full() {
            self.omitted += 1;
            return;
        }
        let (origin, at) = (self.origin(place).map(str::to_owned), self.place(place));
        let path = path.to_owned();
        let problem = Problem { origin, path, place: at, message, found, allowed };
        self.problems.push((place.source, problem));
    }

    /// Something that is allowed and probably not meant.
    pub fn warn(&mut self, warning: String) {
        self.warnings.push(warning);
    }

    /// The same of a stretch: its line, or what it was written in, comes first.
    pub fn warn_at(&mut self, place: Span, warning: &str) {
        let line = self.place(place).map_or(1, |place| place.line);
        let stands = match self.origin(place) {
            Some(origin) if origin.starts_with("--set") => origin.to_owned(),
            Some(file) => format!("{file}:{line}"),
            None => format!("line {line}"),
        };
        self.warn(format!("{stands}: {warning}"));
    }

    /// The warnings, or the problems if there are any: in the order of the texts, each once.
    pub fn finish(mut self, file: &str) -> Result<Vec<String>, Problems> {
        if self.problems.is_empty() {
            return Ok(self.warnings);
        }
        let place = |(source, problem): &(usize, Problem)| (*source, problem.place);
        self.problems.sort_by_key(place);
        let mut list: Vec<Problem> = Vec::with_capacity(self.problems.len());
        for (_, problem) in self.problems {
            if !list.contains(&problem) {
                list.push(problem);
            }
        }
        Err(Problems::new(file, list, self.omitted))
    }
}

/// The first line of a text, shortened; control characters are made visible.
pub fn excerpt(text: &str) -> String {
    let line = text.lines().next().unwrap_or_default();
    let mut short: String = line
        .chars()
        .take(EXCERPT)
        .flat_map(|c| {
            let visible = !c.is_control() || c == '\t';
            if visible { vec![c] } else { c.escape_unicode().collect() }
        })
        .collect();
    if line.chars().nth(EXCERPT).is_some() || text.trim_end().contains('\n') {
        short.push('…');
    }
    short
}

//! The elements of a document, with their places.

use std::collections::BTreeSet;

use roxmltree::{Attribute, Document, Node, ParsingOptions};

use super::{MAX_DEPTH, MAX_NODES};
use crate::note::MAX_INPUT_BYTES;
use crate::number;
use crate::report::{Report, wrong};
use crate::vocabulary::known;
use crate::work;
use fspid_diagnostics::{Place, Problem, attributes};

/// An element. Names of elements and attributes are found in any case.
#[derive(Clone, Copy)]
pub(super) struct Element<'x, 'i>(Node<'x, 'i>);

/// The document of a text.
pub(super) fn parse(text: &str) -> Result<Document<'_>, Problem> {
    if text.len() > MAX_INPUT_BYTES {
        let message = format!("the text has {} bytes", text.len());
        let expected = format!("at most {MAX_INPUT_BYTES}");
        return Err(Problem::whole(message, expected));
    }
    work::add(text.len());
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    attributes::too_many(text).map_or(Ok(()), Err)?;
    let options =
        ParsingOptions { allow_dtd: false, nodes_limit: MAX_NODES, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).map_err(|error| {
        let at = error.pos();
        let place = Place { line: at.row as usize, column: at.col as usize };
        if matches!(error, roxmltree::Error::DtdDetected) {
            let message = "a document type is not read, nor what it declares";
            return wrong(place, "<!DOCTYPE", message, "a document without one");
        }
        let sentence = error.to_string();
        let sentence = sentence.split(" at ").next().unwrap_or_default();
        wrong(place, "", format!("this is not well-formed XML: {sentence}"), "")
    })
}

impl<'x, 'i> Element<'x, 'i> {
    /// The element around everything.
    pub(super) fn root(document: &'x Document<'i>) -> Self {
        Self(document.root_element())
    }

    /// Its name without the prefix of a namespace.
    pub(super) fn name(self) -> &'x str {
        self.0.tag_name().name()
    }

    pub(super) fn is(self, name: &str) -> bool {
        self.name().eq_ignore_ascii_case(name)
    }

    pub(super) fn is_any(self, names: &[&str]) -> bool {
        names.iter().any(|name| self.is(name))
    }

    /// Where it begins.
    pub(super) fn start(self) -> usize {
        self.0.range().start
    }

    /// The elements inside.
    pub(super) fn children(self) -> impl Iterator<Item = Self> {
        self.0.children().filter(Node::is_element).map(|node| {
            work::add(1);
            Self(node)
        })
    }

    /// The first element inside with one of these names.
    pub(super) fn child(self, names: &[&str]) -> Option<Self> {
        self.children().find(|child| child.is_any(names))
    }

    /// The text inside, without blanks around it.
    pub(super) fn text(self) -> String {
        let texts = self.0.children().filter(Node::is_text).filter_map(|node| node.text());
        texts.collect::<String>().trim().to_owned()
    }

    fn find(self, name: &str) -> Option<Attribute<'x, 'i>> {
        self.0.attributes().find(|found| {
            work::add(1);
            found.namespace().is_none() && found.name().eq_ignore_ascii_case(name)
        })
    }

    /// An attribute, if it is there and says something.
    pub(super) fn attribute(self, name: &str) -> Option<&'x str> {
        self.find(name).map(|found| found.value().trim()).filter(|value| !value.is_empty())
    }

    /// Where an attribute stands, or the element if it is not there.
    pub(super) fn place_of(self, name: &str) -> usize {
        self.find(name).map_or(self.start(), |found| found.range().start)
    }

    /// The first element with more than the allowed number of elements around it.
    pub(super) fn too_deep(self) -> Option<Self> {
        let (mut node, mut depth) = (self.0, 1);
        loop {
            work::add(1);
            if let Some(child) = node.first_element_child() {
                (node, depth) = (child, depth + 1);
                if depth > MAX_DEPTH {
                    return Some(Self(node));
                }
                continue;
            }
            while node.next_sibling_element().is_none() {
                (node, depth) = (node.parent_element()?, depth - 1);
                if node == self.0 {
                    return None;
                }
            }
            node = node.next_sibling_element()?;
        }
    }
}

/// Problems and notes by byte, told by line and column.
pub(super) struct Context<'i> {
    text: &'i str,
    /// The byte at which each line begins.
    lines: Vec<usize>,
    pub(super) report: Report,
    /// What has been noted and need not be again.
    told: BTreeSet<String>,
}

impl<'i> Context<'i> {
    pub(super) fn of(text: &'i str) -> Self {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let bytes = text.as_bytes();
        let ends = bytes.iter().enumerate().filter(|(index, byte)| {
            **byte == b'\n' || (**byte == b'\r' && bytes.get(index + 1) != Some(&b'\n'))
        });
        let lines = [0].into_iter().chain(ends.map(|(index, _)| index + 1)).collect();
        Self { text, lines, report: Report::default(), told: BTreeSet::new() }
    }

    fn place(&self, byte: usize) -> Place {
        let line = self.lines.partition_point(|start| *start <= byte).max(1);
        let start = self.lines.get(line - 1).copied().unwrap_or_default();
        let before = self.text.get(start..byte).unwrap_or_default();
        work::add(before.len());
        Place { line, column: before.chars().count() + 1 }
    }

    /// A word at a byte is wrong. The place is only looked for while it is told.
    pub(super) fn problem(
        &mut self,
        byte: usize,
        word: &str,
        message: impl Into<String>,
        expected: impl Into<String>,
    ) {
        let full = self.report.is_full();
        let place = if full { Place { line: 1, column: 1 } } else { self.place(byte) };
        self.report.problem(place, word, message, expected);
    }

    /// Something worth knowing about a place.
    pub(super) fn note(&mut self, byte: usize, message: impl Into<String>) {
        let place =
            if self.report.takes_notes() { self.place(byte) } else { Place { line: 1, column: 1 } };
        self.report.note(place, message);
    }

    /// The same, the first time that it comes up.
    pub(super) fn note_once(&mut self, byte: usize, message: &str) {
        if self.told.insert(message.to_owned()) {
            self.note(byte, message);
        }
    }

    /// An element that has no place inside of another.
    pub(super) fn refuse(&mut self, element: Element<'_, '_>, within: &str, expected: &[&str]) {
        let message = format!("not an element of <{within}>");
        let expected = known(expected.iter().copied(), element.name());
        self.problem(element.start(), element.name(), message, expected);
    }

    /// Refuses attributes that are not among the known; an address is noted and not used.
    pub(super) fn only(&mut self, element: Element<'_, '_>, names: &[&str]) {
        for attribute in element.0.attributes().filter(|found| found.namespace().is_none()) {
            let is = |name: &&str| attribute.name().eq_ignore_ascii_case(name);
            let start = attribute.range().start;
            if ["networkAddress", "ip"].iter().any(is) {
                self.note_once(start, "a network address is not used");
            } else if !names.iter().any(is) {
                let message = format!("not an attribute of <{}>", element.name());
                let expected = known(names.iter().copied(), attribute.name());
                self.problem(start, attribute.name(), message, expected);
            }
        }
    }

    /// The number in an attribute, if it is there; infinities and NaN are none.
    pub(super) fn number(&mut self, element: Element<'_, '_>, name: &str) -> Option<f64> {
        let text = element.attribute(name)?;
        self.finite(element.place_of(name), text)
    }

    /// A finite number, or a problem.
    pub(super) fn finite(&mut self, byte: usize, text: &str) -> Option<f64> {
        match number::finite(text) {
            Ok(value) => Some(value),
            Err(refused) => {
                self.problem(byte, text, refused.to_string(), "a finite number");
                None
            }
        }
    }

    /// A name in an attribute that must be there; empty if it is not.
    pub(super) fn name(&mut self, element: Element<'_, '_>) -> String {
        let name = element.attribute("name").unwrap_or_default();
        if name.is_empty() {
            let message = format!("<{}> has no name", element.name());
            self.problem(element.start(), "", message, "`name=\"…\"`");
        }
        name.to_owned()
    }

    /// The meaning of a word by a table; an unknown one is reported, a missing one is `None`.
    pub(super) fn choice<T: Copy>(
        &mut self,
        element: Element<'_, '_>,
        name: &str,
        table: &[(&'static str, T)],
    ) -> Option<T> {
        let word = element.attribute(name)?;
        let found = table.iter().find(|row| row.0.eq_ignore_ascii_case(word));
        if found.is_none() {
            let custom = word.to_ascii_lowercase().starts_with("custom");
            let message = match custom {
                true => "a method of one's own is never run".to_owned(),
                false => format!("not known as {name}"),
            };
            let expected = known(table.iter().map(|row| row.0), word);
            self.problem(element.place_of(name), word, message, expected);
        }
        found.map(|row| row.1)
    }
}

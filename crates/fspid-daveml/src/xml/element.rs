//! An element with the questions that readers ask.

use roxmltree::{Document as Tree, Node};

use crate::MAX_MAGNITUDE;
use crate::finding::{Findings, Origin};
use crate::xml::arithmetic::arithmetic;

/// An element of the file.
#[derive(Clone, Copy)]
pub(crate) struct Element<'a, 'i> {
    node: Node<'a, 'i>,
}

impl<'a, 'i> Element<'a, 'i> {
    pub(crate) fn root(tree: &'a Tree<'i>) -> Self {
        Self { node: tree.root_element() }
    }

    /// Name without the prefix of its namespace.
    pub(crate) fn name(self) -> &'a str {
        self.node.tag_name().name()
    }

    pub(crate) fn origin(self) -> Origin {
        Origin(Some(self.node.range().start))
    }

    /// The first element that has more than `limit` elements around it and itself.
    pub(crate) fn deeper_than(self, limit: usize) -> Option<Self> {
        let (mut node, mut depth) = (self.node, 1);
        loop {
            if let Some(child) = node.first_element_child() {
                (node, depth) = (child, depth + 1);
                if depth > limit {
                    return Some(Self { node });
                }
                continue;
            }
            while node.next_sibling_element().is_none() {
                (node, depth) = (node.parent_element()?, depth - 1);
            }
            node = node.next_sibling_element()?;
        }
    }

    /// The elements inside; text between them is a problem.
    pub(crate) fn children(self, findings: &mut Findings) -> Vec<Self> {
        for text in self.node.children().filter(Node::is_text) {
            let word = text.text().unwrap_or_default().trim();
            if !word.is_empty() {
                let origin = Origin(Some(text.range().start));
                let message = format!("text inside of <{}>", self.name());
                findings.problem(origin, word, message, "elements only");
            }
        }
        self.elements().collect()
    }

    /// The elements inside.
    pub(crate) fn elements(self) -> impl Iterator<Item = Self> {
        self.node.children().filter(Node::is_element).map(|node| Self { node })
    }

    /// This element and every element inside of it, at any depth, in the order of the file.
    pub(crate) fn descendants(self) -> impl Iterator<Item = Self> {
        self.node.descendants().filter(Node::is_element).map(|node| Self { node })
    }

    /// The first element inside with that name.
    pub(crate) fn child(self, name: &str) -> Option<Self> {
        self.elements().find(|child| child.name() == name)
    }

    /// All text inside, without comments and elements; pieces that a comment parts stay apart.
    pub(crate) fn text(self) -> String {
        let texts = self.node.children().filter(Node::is_text).filter_map(|node| node.text());
        texts.collect::<Vec<_>>().join(" ")
    }

    /// Text as prose: white space made single.
    pub(crate) fn prose(self) -> String {
        self.text().split_whitespace().collect::<Vec<_>>().join(" ")
    }

    /// Prose of the element with that name inside; empty if there is none.
    pub(crate) fn prose_of(self, name: &str) -> String {
        self.child(name).map(Self::prose).unwrap_or_default()
    }

    /// An attribute without its prefix; empty if it is not there.
    pub(crate) fn optional(self, name: &str) -> String {
        self.attribute(name).unwrap_or_default().trim().to_owned()
    }

    pub(crate) fn attribute(self, name: &str) -> Option<&'a str> {
        let found = self.node.attributes().find(|attribute| attribute.name() == name);
        found.map(|attribute| attribute.value())
    }

    /// An attribute that has to be there.
    pub(crate) fn required(self, name: &str, findings: &mut Findings) -> String {
        let value = self.optional(name);
        if value.is_empty() {
            let message = format!("the attribute {name} is missing");
            findings.problem(self.origin(), self.name(), message, format!("{name}=\"…\""));
        }
        value
    }

    /// Notes or refuses attributes that are not among the known.
    pub(crate) fn only(self, known: &[&str], findings: &mut Findings) {
        for attribute in self.node.attributes() {
            if !known.contains(&attribute.name()) {
                let message = format!("unknown attribute of <{}>", self.name());
                let origin = Origin(Some(attribute.range().start));
                findings.problem(origin, attribute.name(), message, known.join(", "));
            }
        }
    }

    /// A number in an attribute, if it is there.
    pub(crate) fn number(self, name: &str, findings: &mut Findings) -> Option<f64> {
        let text = self.attribute(name)?;
        number(text, self.origin(), findings)
    }

    /// The only number in the text.
    pub(crate) fn single(self, findings: &mut Findings) -> f64 {
        number(&self.text(), self.origin(), findings).unwrap_or(0.0)
    }

    /// Numbers between white space and commas.
    pub(crate) fn numbers(self, findings: &mut Findings) -> Vec<f64> {
        let mut values = Vec::new();
        for piece in self.node.children().filter(Node::is_text) {
            let (text, start) = (piece.text().unwrap_or_default(), piece.range().start);
            let plain = text.len() == piece.range().len();
            for (offset, word) in words(text) {
                let at = if plain { start + offset } else { start };
                values.extend(number(word, Origin(Some(at)), findings));
            }
        }
        values
    }

    /// Refuses this element, with what can stand inside of `parent`.
    pub(crate) fn refuse(self, parent: &str, expected: &str, findings: &mut Findings) {
        let message = format!("<{}> inside of <{parent}> is not supported", self.name());
        findings.problem(self.origin(), self.name(), message, expected);
    }

    /// Notes that this element is left out.
    pub(crate) fn leave_out(self, why: &str, findings: &mut Findings) {
        findings.note(self.origin(), format!("<{}> is left out: {why}", self.name()));
    }
}

/// Words between white space and commas with the byte at which each begins.
fn words(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let apart = |character: char| character.is_whitespace() || character == ',';
    let begin = text.as_ptr() as usize;
    text.split(apart)
        .filter(|word| !word.is_empty())
        .map(move |word| (word.as_ptr() as usize - begin, word))
}

/// A finite number, or a problem.
pub(crate) fn number(text: &str, at: Origin, findings: &mut Findings) -> Option<f64> {
    let text = text.trim();
    let value = text.parse::<f64>().ok().or_else(|| {
        let value = arithmetic(text)?;
        findings.note(at, format!("`{text}` is read as {value}"));
        Some(value)
    });
    match value {
        Some(value) if value.abs() <= MAX_MAGNITUDE => Some(value),
        _ => {
            let expected = format!(
                "a number such as -0.5, 1e-3 or (2/5)pi, at most {MAX_MAGNITUDE:e} in magnitude"
            );
            findings.problem(at, text, "this is not a number that can be used", expected);
            None
        }
    }
}

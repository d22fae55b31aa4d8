//! Terms of a variable.

use std::collections::BTreeSet;

use fspid_fuzzy::system::Membership;

use super::lines::{Line, numbers};
use super::readable;
use super::sections::FllSection;
use crate::cursor::Cursor;
use crate::lexer::{Kind, Token};
use crate::report::Report;
use crate::term::{formula, shape};
use crate::tokens::Tokens;
use crate::vocabulary::known;
use crate::vocabulary::shapes::{self, FUZZYLITE};

/// A term's line: its name, its class, and what follows.
#[derive(Clone, Copy)]
pub(super) struct TermLine<'a> {
    pub(super) name: Token<'a>,
    pub(super) class: Token<'a>,
    pub(super) rest: Tokens<'a>,
}

/// The terms of a section; lines without name and class are reported.
pub(super) fn terms<'a>(section: &FllSection<'a>, report: &mut Report) -> Vec<TermLine<'a>> {
    let mut found = Vec::new();
    for line in &section.terms {
        let mut rest = line.tokens();
        let (name, class) = (rest.advance(), rest.advance());
        if class.kind == Kind::End {
            line.wrong("not a term", "a name, a class and its parameters", report);
        } else {
            found.push(TermLine { name, class, rest });
        }
    }
    distinct(found.iter().map(|term| only(term.name)), report);
    found
}

/// A fuzzy set: a shape, or a function of `x`, the inputs and the outputs.
pub(super) fn membership(
    term: &TermLine,
    with_x: &[&str],
    report: &mut Report,
) -> Option<Membership> {
    let TermLine { class, mut rest, .. } = *term;
    if class.is("Function") {
        let formula = formula(rest.take_raw('\n'), with_x, report)?;
        return Some(Membership::Formula { formula, height: 1.0 });
    }
    let Some(row) = shapes::of_word(FUZZYLITE, class.text) else {
        let expected = known(FUZZYLITE.iter().map(|row| row.word).chain(["Function"]), class.text);
        report.problem(class.place(), class.text, "not known as a fuzzy set", expected);
        return None;
    };
    shape(row, class, &numbers(rest, report)?, report)
}

/// A norm is missing.
pub(super) fn needs(
    heading: Line,
    message: &str,
    words: impl Iterator<Item = &'static str> + Clone,
    report: &mut Report,
) {
    report.problem(heading.start.place(), heading.text(), message, known(words, ""));
}

/// Names that are there twice, and names that no rule could use.
pub(super) fn distinct<'a>(names: impl Iterator<Item = Cursor<'a>>, report: &mut Report) {
    let mut seen = BTreeSet::new();
    for name in names {
        let text = name.rest();
        if !readable(text) {
            let expected = "one word without brackets and commas that means nothing in rules";
            report.problem(name.place(), text, "cannot be a name", expected);
        } else if !seen.insert(text) {
            report.problem(name.place(), text, "is there twice", "names that differ");
        }
    }
}

/// The token alone, without what follows it.
fn only(token: Token) -> Cursor {
    let mut after = token.start;
    after.take_while(|next| !next.is_whitespace() && next != '(' && next != ',');
    token.start.up_to(after)
}

//! Walking over a text statement by statement.

use super::draft::Draft;
use crate::cursor::Cursor;
use crate::lexer::{Kind, Lexer, Token};
use crate::report::Report;
use crate::tokens::Tokens;
use crate::vocabulary::known;
use fspid_diagnostics::Problems;

/// The parser of a text. A method that answers `None` has reported why.
pub(super) struct Parser<'a> {
    pub(super) tokens: Tokens<'a>,
    pub(super) draft: Draft<'a>,
    /// Position of the variable, or rule block, that the section at hand describes.
    pub(super) current: usize,
}

/// Keywords that begin or end a section: no statement goes beyond them.
const SECTIONS: [&str; 15] = [
    "FUNCTION_BLOCK",
    "END_FUNCTION_BLOCK",
    "VAR_INPUT",
    "VAR_OUTPUT",
    "VAR",
    "END_VAR",
    "FUZZIFY",
    "END_FUZZIFY",
    "DEFUZZIFY",
    "END_DEFUZZIFY",
    "RULEBLOCK",
    "END_RULEBLOCK",
    "RULE",
    "OPTION",
    "END_OPTION",
];

/// True for a word that can be no name, for a section or rule begins or ends with it.
pub(super) fn is_section_word(name: &str) -> bool {
    SECTIONS.iter().any(|word| word.eq_ignore_ascii_case(name))
}

/// Reads a text as far as it can be read, and what is wrong with it.
pub(super) fn parse<'a>(text: &'a str, block: Option<&str>) -> Result<Draft<'a>, Problems> {
    let cursor = Cursor::new(text).map_err(|problem| Problems::of_text(vec![problem]))?;
    let tokens = Tokens::new(Lexer::fcl(cursor));
    let mut parser = Parser { tokens, draft: Draft::default(), current: 0 };
    parser.text(block);
    let comments = parser.tokens.comments();
    if let Some(place) = comments.open {
        parser.draft.report.problem(place, "", "a comment has no end", "`*)` or `*/`");
    }
    parser.draft.evidence.comments(comments);
    Ok(parser.draft)
}

impl<'a> Parser<'a> {
    pub(super) fn next(&self) -> Token<'a> {
        self.tokens.next
    }

    pub(super) fn report(&mut self) -> &mut Report {
        &mut self.draft.report
    }

    fn text(&mut self, wanted: Option<&str>) {
        let mut seen: Vec<Token> = Vec::new();
        let mut found = false;
        while self.next().kind != Kind::End {
            if !self.tokens.eat("FUNCTION_BLOCK") {
                self.wrong(self.next(), "not the beginning of a system", "`FUNCTION_BLOCK`");
                self.skip_to("FUNCTION_BLOCK");
                continue;
            }
            let name = self.next();
            seen.push(name);
            if !found && wanted.is_none_or(|wanted| name.is(wanted)) {
                found = true;
                self.function_block();
            } else {
                self.skip_to("END_FUNCTION_BLOCK");
                self.tokens.advance();
            }
        }
        self.judge_blocks(&seen, wanted, found);
    }

    /// A text is one system, unless it is said which.
    fn judge_blocks(&mut self, seen: &[Token<'a>], wanted: Option<&str>, found: bool) {
        let names = seen.iter().map(|name| name.text);
        match (seen, wanted) {
            ([], _) => self.report().whole("the text has no FUNCTION_BLOCK"),
            (_, Some(wanted)) if !found => {
                let message =
                    format!("there is no function block `{wanted}`, but {}", known(names, wanted));
                self.report().whole(message);
            }
            ([_, second, ..], None) => {
                let message = "a second function block; ask for the one that is meant";
                let expected = known(names, "");
                self.wrong(*second, message, expected);
            }
            _ => {}
        }
    }

    fn skip_to(&mut self, word: &str) {
        while self.next().kind != Kind::End && !self.next().is(word) {
            self.tokens.advance();
        }
    }

    /// The statements of a section up to its end. Each statement passes at least one token.
    pub(super) fn body(&mut self, end: &str, statement: fn(&mut Self) -> Option<()>) {
        while !self.tokens.eat(end) {
            let next = self.next();
            let over = SECTIONS.iter().any(|word| next.is(word)) && !next.is("RULE");
            if over || next.kind == Kind::End {
                self.wrong(next, "a section has no end", format!("`{end}`"));
                return;
            }
            if statement(self).is_none() {
                self.recover();
            }
        }
    }

    /// Passes the rest of a statement that cannot be read.
    pub(super) fn recover(&mut self) {
        loop {
            let next = self.next();
            if next.kind == Kind::End || SECTIONS.iter().any(|word| next.is(word)) {
                return;
            }
            self.tokens.advance();
            if next.is(";") {
                return;
            }
        }
    }

    pub(super) fn wrong(&mut self, token: Token, message: &str, expected: impl Into<String>) {
        let ends = token.kind == Kind::End && !message.contains("no end");
        let message = if ends { "the text ends" } else { message };
        self.draft.report.problem(token.place(), token.text, message, expected);
    }

    pub(super) fn expect(&mut self, word: &str) -> Option<()> {
        if self.tokens.eat(word) {
            return Some(());
        }
        self.wrong(self.next(), "does not fit here", format!("`{word}`"));
        None
    }

    /// `:` or `:=`, whichever comes; jFuzzyLogic takes `=` as well.
    pub(super) fn assign(&mut self) -> Option<()> {
        if self.next().is("=") {
            let place = self.next().place();
            self.draft.evidence.jfuzzylogic(place, "`=` for `:=`");
        }
        if self.next().is_any(&[":", ":=", "="]) {
            self.tokens.advance();
            return Some(());
        }
        self.wrong(self.next(), "does not fit here", "`:` or `:=`");
        None
    }

    pub(super) fn end(&mut self) -> Option<()> {
        self.expect(";")
    }

    /// A name.
    pub(super) fn name(&mut self, what: &str) -> Option<Token<'a>> {
        let next = self.next();
        if next.kind == Kind::Word && !SECTIONS.iter().any(|word| next.is(word)) {
            return Some(self.tokens.advance());
        }
        self.wrong(next, &format!("not the name of {what}"), "letters, digits and `_`");
        None
    }

    /// The meaning of the next word by a table.
    pub(super) fn choice<T>(
        &mut self,
        find: impl Fn(&str) -> Option<T>,
        what: &str,
        words: impl Iterator<Item = &'static str> + Clone,
    ) -> Option<(T, Token<'a>)> {
        let next = self.next();
        let Some(found) = find(next.text) else {
            self.wrong(next, &format!("not known as {what}"), known(words, next.text));
            return None;
        };
        self.tokens.advance();
        Some((found, next))
    }

    pub(super) fn boolean(&mut self) -> Option<bool> {
        const ROWS: [(&str, bool); 2] = [("TRUE", true), ("FALSE", false)];
        let find = |word: &str| ROWS.iter().find(|row| row.0.eq_ignore_ascii_case(word));
        self.choice(|word| find(word).map(|row| row.1), "a truth", ROWS.iter().map(|row| row.0))
            .map(|(found, _)| found)
    }
}

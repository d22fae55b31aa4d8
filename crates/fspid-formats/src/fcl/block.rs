//! A function block and its declarations.

use super::draft::{Role, Variable};
use super::parser::{Parser, is_section_word};
use crate::lexer::{Kind, Token};
use crate::rule::RESERVED;
use crate::term;
use crate::vocabulary::known;

type Section = fn(&mut Parser);

/// Keywords of sections.
const SECTIONS: [(&str, Section); 7] = [
    ("VAR_INPUT", |parser| parser.declarations(Role::Input)),
    ("VAR_OUTPUT", |parser| parser.declarations(Role::Output)),
    ("VAR", |parser| parser.declarations(Role::Local)),
    ("FUZZIFY", |parser| parser.fuzzify()),
    ("DEFUZZIFY", |parser| parser.defuzzify()),
    ("RULEBLOCK", |parser| parser.rule_block()),
    ("OPTION", |parser| parser.options()),
];

/// Types of numbers in IEC 61131-3.
const TYPES: [&str; 10] =
    ["REAL", "LREAL", "SINT", "INT", "DINT", "LINT", "USINT", "UINT", "UDINT", "ULINT"];

impl<'a> Parser<'a> {
    /// From the name to the end.
    pub(super) fn function_block(&mut self) {
        let starts_section =
            |word: &str| SECTIONS.iter().any(|row| row.0.eq_ignore_ascii_case(word));
        if self.next().kind == Kind::Word && !starts_section(self.next().text) {
            self.draft.name = self.tokens.advance().text.into();
        }
        while !self.tokens.eat("END_FUNCTION_BLOCK") {
            let next = self.next();
            if next.kind == Kind::End || next.is("FUNCTION_BLOCK") {
                self.wrong(next, "a function block has no end", "`END_FUNCTION_BLOCK`");
                return;
            }
            self.tokens.advance();
            match SECTIONS.iter().find(|row| next.is(row.0)) {
                Some(row) => (row.1)(self),
                None => {
                    let expected = known(SECTIONS.iter().map(|row| row.0), next.text);
                    self.wrong(next, "not the beginning of a section", expected);
                    self.recover();
                }
            }
        }
    }

    fn declarations(&mut self, role: Role) {
        self.body(
            "END_VAR",
            match role {
                Role::Input => |parser| parser.declaration(Role::Input),
                Role::Output => |parser| parser.declaration(Role::Output),
                Role::Local => |parser| parser.declaration(Role::Local),
            },
        );
    }

    /// `a, b : REAL := 1;`
    fn declaration(&mut self, role: Role) -> Option<()> {
        let mut names = vec![self.variable_name()?];
        while self.tokens.eat(",") {
            names.push(self.variable_name()?);
        }
        self.expect(":")?;
        let find =
            |word: &str| TYPES.iter().any(|known| known.eq_ignore_ascii_case(word)).then_some(());
        let kind = self.choice(find, "a type of numbers", TYPES.into_iter());
        let mut value = None;
        if kind.is_some() && (self.tokens.eat(":=") || self.tokens.eat("=")) {
            value = Some(term::finite(self.tokens.advance(), self.report())?.value);
        }
        for name in names {
            match value {
                Some(value) if role == Role::Local => {
                    self.draft.constants.insert(name.text.to_lowercase(), value);
                }
                _ => self.declare(Variable::new(name, role)),
            }
        }
        // The names are known all the same.
        kind.and_then(|_| self.end())
    }

    /// A name that rules can use; a word that is none is passed, for a statement passes something.
    fn variable_name(&mut self) -> Option<Token<'a>> {
        let next = self.next();
        let name = self.name("a variable");
        if name.is_none() && (!is_section_word(next.text) || next.is("RULE")) {
            self.tokens.advance();
        }
        let name = name?;
        if name.is_any(&RESERVED) {
            let expected = "a word that means nothing in rules";
            self.wrong(name, "cannot be the name of a variable", expected);
            return None;
        }
        Some(name)
    }

    fn declare(&mut self, variable: Variable<'a>) {
        let name = variable.name;
        if !self.draft.names.add(name.text) {
            self.wrong(name, "is declared twice", "names that differ");
        }
        self.draft.variables.push(variable);
    }
}

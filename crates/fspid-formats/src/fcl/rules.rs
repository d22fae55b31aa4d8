//! `RULEBLOCK`.

use fspid_fuzzy::{SNormKind, TNormKind};

use super::connectives::Connective;
use super::draft::{Block, RuleText};
use super::parser::{Parser, is_section_word};
use crate::lexer::Kind;
use crate::vocabulary::norms::{self, S_NORMS, T_NORMS};

type Statement = fn(&mut Parser) -> Option<()>;

const STATEMENTS: &[(&str, Statement)] = &[
    ("AND", |parser| {
        let norm = parser.t_norm("a connective `and`")?;
        let block = parser.block()?;
        (block.and, block.last) = (norm, Some(Connective::And));
        Some(())
    }),
    ("OR", |parser| {
        let norm = parser.s_norm("a connective `or`")?;
        let block = parser.block()?;
        (block.or, block.last) = (norm, Some(Connective::Or));
        Some(())
    }),
    ("ACT", |parser| {
        let norm = parser.t_norm("an activation")?;
        parser.block()?.act = norm;
        Some(())
    }),
    ("ACCU", |parser| {
        let accu = parser.accu()?;
        parser.block()?.accu = accu;
        Some(())
    }),
    ("ENABLED", |parser| {
        let place = parser.next().place();
        parser.draft.evidence.fuzzylite(place, "ENABLED");
        parser.assign()?;
        parser.block()?.enabled = parser.boolean()?;
        parser.end()
    }),
    ("RULE", |parser| parser.rule()),
];

impl<'a> Parser<'a> {
    pub(super) fn rule_block(&mut self) {
        let start = self.next();
        let is_statement = STATEMENTS.iter().any(|row| start.is(row.0));
        let named = matches!(start.kind, Kind::Word | Kind::Number)
            && !is_statement
            && !is_section_word(start.text);
        let name = if named { self.tokens.advance().text.into() } else { String::new() };
        self.current = self.draft.blocks.len();
        self.draft.blocks.push(Block {
            name,
            start,
            enabled: true,
            and: None,
            or: None,
            last: None,
            act: None,
            accu: None,
            rules: Vec::new(),
        });
        self.body("END_RULEBLOCK", |parser| parser.statement(STATEMENTS));
    }

    fn block(&mut self) -> Option<&mut Block<'a>> {
        self.draft.blocks.get_mut(self.current)
    }

    /// `: norm;`, where `NONE` is none.
    fn t_norm(&mut self, what: &str) -> Option<Option<TNormKind>> {
        self.assign()?;
        let none = self.tokens.eat("NONE");
        let find = |word: &str| norms::of_word(T_NORMS, word);
        let words = norms::words(T_NORMS);
        let norm = if none { None } else { Some(self.choice(find, what, words)?.0) };
        self.end()?;
        Some(norm)
    }

    fn s_norm(&mut self, what: &str) -> Option<Option<SNormKind>> {
        self.assign()?;
        let none = self.tokens.eat("NONE");
        let find = |word: &str| norms::of_word(S_NORMS, word);
        let words = norms::words(S_NORMS);
        let norm = if none { None } else { Some(self.choice(find, what, words)?.0) };
        self.end()?;
        Some(norm)
    }

    /// `name : if …`, kept until all variables are known.
    fn rule(&mut self) -> Option<()> {
        let mut name = "";
        if !self.next().is(":") {
            name = self.tokens.advance().text;
        }
        self.expect(":")?;
        let tokens = self.tokens;
        self.block()?.rules.push(RuleText { name, tokens });
        self.recover();
        Some(())
    }
}

//! `OPTION`: what the standard has no words for.

use fspid_fuzzy::OutOfRange;
use fspid_fuzzy::system::Sampling;

use super::parser::Parser;
use crate::lexer::{Kind, Token};
use crate::vocabulary::known;

type Statement = fn(&mut Parser) -> Option<()>;

/// Our own statements, each about one variable.
const OWN: &[(&str, Statement)] = &[
    ("FSPID_RANGE", |parser| parser.range()),
    ("FSPID_SAMPLING", |parser| parser.sampling()),
    ("FSPID_OUT_OF_RANGE", |parser| parser.out_of_range()),
    ("FSPID_LIMIT", |parser| {
        parser.assign()?;
        parser.expect("RANGE")?;
        parser.variable()?.clamp = true;
        parser.end()
    }),
    (ADDS, |parser| {
        parser.assign()?;
        parser.expect("ADDED")?;
        parser.variable()?.adds = true;
        parser.end()
    }),
    ("FSPID_ENABLED", |parser| {
        parser.assign()?;
        parser.variable()?.enabled = parser.boolean()?;
        parser.end()
    }),
    ("FSPID_DEFAULT", |parser| parser.second_default()),
];

/// Equal conclusions about an output that weighs its terms are added up, where the standard joins them by `ACCU`.
pub(super) const ADDS: &str = "FSPID_EQUAL_CONCLUSIONS";

/// Words for what happens to a value outside its range.
pub(super) const OUT_OF_RANGE: [(&str, OutOfRange); 3] = [
    ("EVALUATE", OutOfRange::Evaluate),
    ("CLAMP", OutOfRange::Clamp),
    ("ERROR", OutOfRange::Error),
];

impl<'a> Parser<'a> {
    pub(super) fn options(&mut self) {
        self.body("END_OPTION", Self::option);
    }

    /// `FSPID_… variable : …;`; other vendors' are passed.
    fn option(&mut self) -> Option<()> {
        let keyword = self.tokens.advance();
        if let Some(row) = OWN.iter().find(|row| keyword.is(row.0)) {
            let name = self.name("a variable")?;
            self.current = self.declared(name)?;
            return (row.1)(self);
        }
        if keyword.text.to_ascii_uppercase().starts_with("FSPID_") {
            let expected = known(OWN.iter().map(|row| row.0), keyword.text);
            self.wrong(keyword, "not one of our options", expected);
            return None;
        }
        if !keyword.is(";") {
            let note = format!("the option `{}` is another tool's and is not used", keyword.text);
            self.report().note(keyword.place(), note);
            self.recover();
        }
        Some(())
    }

    /// `: endpoints 101;`
    fn sampling(&mut self) -> Option<()> {
        self.assign()?;
        let mut words: Vec<Token> = Vec::new();
        while matches!(self.next().kind, Kind::Word | Kind::Number) || self.next().is("-") {
            words.push(self.tokens.advance());
        }
        let count = words.last().filter(|word| word.kind == Kind::Number);
        let kind: String =
            words.iter().filter(|w| w.kind != Kind::Number).map(|w| w.text).collect();
        let kind = kind.to_ascii_lowercase().replace('_', "-");
        let text = count.map_or(kind.clone(), |count| format!("{kind}:{}", count.text));
        match text.parse() {
            Ok(sampling) => self.variable()?.sampling = Some(sampling),
            Err(_) => {
                let at = words.first().copied().unwrap_or(self.next());
                self.wrong(at, "not a way to compute integrals", Sampling::NAMES);
                return None;
            }
        }
        self.end()
    }

    fn out_of_range(&mut self) -> Option<()> {
        self.assign()?;
        let find = |word: &str| {
            OUT_OF_RANGE.iter().find(|row| row.0.eq_ignore_ascii_case(word)).map(|row| row.1)
        };
        let words = OUT_OF_RANGE.iter().map(|row| row.0);
        let (found, _) = self.choice(find, "a rule for values outside", words)?;
        self.variable()?.out_of_range = found;
        self.end()
    }

    /// `: MIDDLE;` or a number: the second choice where the first is `NC`.
    fn second_default(&mut self) -> Option<()> {
        self.assign()?;
        if self.tokens.eat("MIDDLE") {
            self.variable()?.middle = true;
        } else {
            let value = self.number()?.value;
            self.variable()?.default = Some(value);
        }
        self.end()
    }
}

//! `FUZZIFY` and `DEFUZZIFY`.

use fspid_fuzzy::system::Universe;

use super::draft::{Method, Role, Set, Term, Variable};
use super::parser::Parser;
use crate::lexer::{Kind, Token};
use crate::names::Found;
use crate::term;
use crate::vocabulary::norms::{self, S_NORMS};
use crate::vocabulary::{known, methods};

type Statement = fn(&mut Parser) -> Option<()>;

/// Statements about an input.
const FUZZIFY: &[(&str, Statement)] = &[
    ("TERM", |parser| parser.term()),
    ("RANGE", |parser| {
        let place = parser.next().place();
        parser.draft.evidence.fuzzylite(place, "RANGE in FUZZIFY");
        parser.range()
    }),
    ("ENABLED", |parser| parser.enabled()),
    ("LOCK", |parser| parser.lock()),
];

/// Statements about an output.
const DEFUZZIFY: &[(&str, Statement)] = &[
    ("TERM", |parser| parser.term()),
    ("RANGE", |parser| parser.range()),
    ("METHOD", |parser| parser.method()),
    ("DEFAULT", |parser| parser.default()),
    ("ACCU", |parser| parser.output_accu()),
    ("ENABLED", |parser| parser.enabled()),
    ("LOCK", |parser| parser.lock()),
];

impl<'a> Parser<'a> {
    pub(super) fn fuzzify(&mut self) {
        if self.describe(false).is_some() {
            self.body("END_FUZZIFY", |parser| parser.statement(FUZZIFY));
        } else {
            self.skip_section("END_FUZZIFY");
        }
    }

    pub(super) fn defuzzify(&mut self) {
        if self.describe(true).is_some() {
            self.body("END_DEFUZZIFY", |parser| parser.statement(DEFUZZIFY));
        } else {
            self.skip_section("END_DEFUZZIFY");
        }
    }

    /// Without a variable there is nothing to say.
    fn skip_section(&mut self, end: &str) {
        while !self.tokens.eat(end) {
            let next = self.next();
            let over = next.is_any(&["FUZZIFY", "DEFUZZIFY", "RULEBLOCK", "END_FUNCTION_BLOCK"]);
            if over || next.kind == Kind::End {
                return;
            }
            self.tokens.advance();
        }
    }

    /// The variable that a section is about becomes the current one.
    fn describe(&mut self, defuzzified: bool) -> Option<()> {
        let name = self.name("a variable")?;
        let position = self.declared(name)?;
        self.current = position;
        let variable = self.variable()?;
        let second = variable.section.replace(name.place());
        variable.defuzzified |= defuzzified;
        let wrong = match variable.role {
            Role::Input if defuzzified => Some("an input cannot be defuzzified"),
            Role::Output if !defuzzified => Some("an output cannot be fuzzified"),
            _ if second.is_some() => Some("is described twice"),
            _ => None,
        };
        match wrong {
            Some(message) => {
                self.wrong(name, message, "");
                None
            }
            None => Some(()),
        }
    }

    /// The position of a declared variable.
    pub(super) fn declared(&mut self, name: Token<'a>) -> Option<usize> {
        match self.draft.names.find(name.text) {
            Found::Exact(position) => Some(position),
            Found::Folded(position) => {
                let meant = self.draft.names.name(position);
                let note = format!("`{}` is read as `{meant}`, which differs in case", name.text);
                self.report().note(name.place(), note);
                Some(position)
            }
            Found::Nothing => {
                let expected = known(self.draft.names.all(), name.text);
                self.wrong(name, "no variable of this name is declared", expected);
                None
            }
        }
    }

    pub(super) fn variable(&mut self) -> Option<&mut Variable<'a>> {
        self.draft.variables.get_mut(self.current)
    }

    /// A statement by its keyword.
    pub(super) fn statement(&mut self, table: &[(&str, Statement)]) -> Option<()> {
        let keyword = self.tokens.advance();
        match table.iter().find(|row| keyword.is(row.0)) {
            Some(row) => (row.1)(self),
            None => {
                let expected = known(table.iter().map(|row| row.0), keyword.text);
                self.wrong(keyword, "not a statement of this section", expected);
                None
            }
        }
    }

    /// `name := set;`
    fn term(&mut self) -> Option<()> {
        let next = self.next();
        let name = if next.kind == Kind::Number { None } else { self.name("a term") };
        if next.kind == Kind::Number {
            self.wrong(next, "not the name of a term", "letters, digits and `_`");
        }
        let name = name?;
        let set = self.assign().and_then(|()| self.set());
        let failed = set.is_none();
        // The name is known all the same.
        self.variable()?.terms.push(Term { name, set: set.unwrap_or(Set::Unknown) });
        if failed { None } else { self.end() }
    }

    /// `:= (lower .. upper);`, without brackets too; two infinities are no universe.
    pub(super) fn range(&mut self) -> Option<()> {
        self.assign()?;
        let start = self.next();
        let bracket = self.tokens.eat("(");
        let lower = self.number()?.value;
        if !self.tokens.eat(",") {
            self.expect("..")?;
        }
        let upper = self.number()?.value;
        if bracket {
            self.expect(")")?;
        }
        let unbounded = lower == f64::NEG_INFINITY && upper == f64::INFINITY;
        let bounded = lower < upper && (upper - lower).is_finite();
        if !(unbounded || bounded) {
            self.wrong(start, "not a range", "two finite numbers in ascending order");
            return None;
        }
        self.variable()?.universe = bounded.then_some(Universe { lower, upper });
        self.end()
    }

    fn method(&mut self) -> Option<()> {
        self.assign()?;
        let (row, word) = self.choice(methods::of_word, "a method", methods::words())?;
        let class = row.class.eq_ignore_ascii_case(word.text);
        if class || row.word() == "COGSS" {
            self.draft.evidence.fuzzylite(word.place(), "the name of a method");
        }
        let mut resolution = None;
        if self.next().kind == Kind::Number {
            let token = self.tokens.advance();
            self.draft.evidence.fuzzylite(token.place(), "a resolution");
            resolution = token.text.parse().ok().filter(|count| *count > 0);
            if resolution.is_none() {
                self.wrong(token, "not a resolution", "a whole number above 0");
            }
        }
        self.variable()?.method = Some(Method { word, row, resolution });
        self.end()
    }

    /// `:= number | NC;`, either or both
    fn default(&mut self) -> Option<()> {
        self.assign()?;
        loop {
            let token = self.tokens.advance();
            if token.is("NC") {
                self.variable()?.previous = true;
            } else if token.is("nan") {
                self.draft.evidence.fuzzylite(token.place(), "a default of nan");
            } else if let Ok(value) = crate::number::finite(token.text) {
                self.variable()?.default = Some(value);
            } else {
                self.wrong(token, "not a default", "a number or `NC`");
                return None;
            }
            if !self.tokens.eat("|") {
                return self.end();
            }
            let place = self.next().place();
            self.draft.evidence.fuzzylite(place, "two defaults");
        }
    }

    fn output_accu(&mut self) -> Option<()> {
        let place = self.next().place();
        self.draft.evidence.fuzzylite(place, "ACCU in DEFUZZIFY");
        let accu = self.accu()?;
        self.variable()?.accu = accu;
        Some(())
    }

    /// `: norm;`
    pub(super) fn accu(
        &mut self,
    ) -> Option<Option<(fspid_fuzzy::SNormKind, fspid_diagnostics::Place)>> {
        self.assign()?;
        let place = self.next().place();
        let none = self.tokens.eat("NONE");
        let find = |word: &str| norms::of_word(S_NORMS, word);
        let found = if none {
            None
        } else {
            Some(self.choice(find, "an accumulation", norms::words(S_NORMS))?.0)
        };
        self.end()?;
        Some(found.map(|norm| (norm, place)))
    }

    fn enabled(&mut self) -> Option<()> {
        let place = self.next().place();
        self.draft.evidence.fuzzylite(place, "ENABLED");
        self.assign()?;
        self.variable()?.enabled = self.boolean()?;
        self.end()
    }

    /// `: PREVIOUS | RANGE;`, either or both
    fn lock(&mut self) -> Option<()> {
        let place = self.next().place();
        self.draft.evidence.fuzzylite(place, "LOCK");
        self.assign()?;
        loop {
            let find = |word: &str| {
                ["RANGE", "PREVIOUS"].iter().position(|known| known.eq_ignore_ascii_case(word))
            };
            let (which, _) = self.choice(find, "a lock", ["RANGE", "PREVIOUS"].into_iter())?;
            let variable = self.variable()?;
            match which {
                0 => {
                    variable.clamp = true;
                    variable.out_of_range = fspid_fuzzy::OutOfRange::Clamp;
                }
                _ => variable.previous = true,
            }
            if !self.tokens.eat("|") {
                return self.end();
            }
        }
    }

    /// A number, or a local variable that stands for one.
    pub(super) fn number(&mut self) -> Option<term::Number<'a>> {
        let token = self.tokens.advance();
        let (text, place) = (token.text, token.place());
        if let Some(&value) = self.draft.constants.get(&text.to_lowercase()) {
            return Some(term::Number { value, text, place });
        }
        term::number(token, self.report())
    }
}

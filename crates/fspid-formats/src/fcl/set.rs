//! What stands behind `TERM name :=`.

use fspid_fuzzy::Formula;
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::Membership;

use super::draft::Set;
use super::parser::Parser;
use crate::lexer::{Kind, Token};
use crate::number::written;
use crate::term::{self, Number};
use crate::vocabulary::known;
use crate::vocabulary::shapes::{self, FUZZYLITE, JFUZZYLOGIC, POINTS};

/// Words that are no shape.
const OTHERS: [&str; 3] = ["FUNCTION", "Constant", "Linear"];

impl<'a> Parser<'a> {
    pub(super) fn set(&mut self) -> Option<Set<'a>> {
        let next = self.next();
        if next.is("(") {
            return self.points();
        }
        let stands_for_number = self.draft.constants.contains_key(&next.text.to_lowercase());
        let number = next.kind == Kind::Number || next.is("inf") || next.is("nan");
        if number || stands_for_number {
            return self.number().map(|number| Set::Number(number.value));
        }
        let word = self.tokens.advance();
        self.named(word)
    }

    /// `(x, grade) (x, grade) …`
    fn points(&mut self) -> Option<Set<'a>> {
        let first = self.next();
        let mut numbers = Vec::new();
        while self.tokens.eat("(") {
            numbers.push(self.number()?);
            self.expect(",")?;
            numbers.push(self.number()?);
            self.expect(")")?;
            self.tokens.eat(",");
        }
        let shape = term::shape(&POINTS, first, &numbers, self.report())?;
        Some(Set::Fuzzy(recognised(shape)))
    }

    /// Both tools have a cosine; fuzzylite's is written as its class is: centre and width, where jFuzzyLogic has half of
    /// the width and the centre.
    fn named(&mut self, word: Token<'a>) -> Option<Set<'a>> {
        let is_class = FUZZYLITE.iter().any(|row| row.word == word.text);
        if let Some(row) = shapes::of_word(JFUZZYLOGIC, word.text).filter(|_| !is_class) {
            self.draft.evidence.jfuzzylogic(word.place(), "a word for a set");
            let numbers = self.numbers()?;
            let shape = term::shape(row, word, &numbers, self.report())?;
            return Some(Set::Fuzzy(self.cut(word, shape)));
        }
        if word.is("FUNCTION") {
            self.tokens.eat(":");
            return Some(Set::Formula(self.tokens.take_raw(';')));
        }
        if let Some(row) = shapes::of_word(FUZZYLITE, word.text) {
            self.draft.evidence.fuzzylite(word.place(), "the class of a set");
            let numbers = self.numbers()?;
            return term::shape(row, word, &numbers, self.report()).map(Set::Fuzzy);
        }
        self.other(word)
    }

    /// A `DSIGM` that would fall below 0, as the formula that jFuzzyLogic computes.
    fn cut(&mut self, word: Token<'a>, shape: Membership) -> Membership {
        let Membership::Shape { kind, params, height } = &shape else { return shape };
        if shapes::needs_no_cut(*kind, params) {
            return shape;
        }
        let Ok(formula) = Formula::parse(&cut_difference(params), &["x"]) else { return shape };
        let note = format!(
            "`{}` is cut at 0 where its second step is the higher one, as in jFuzzyLogic; it is read as a formula",
            word.text
        );
        self.report().note(word.place(), note);
        Membership::Formula { formula, height: *height }
    }

    fn other(&mut self, word: Token<'a>) -> Option<Set<'a>> {
        if word.is("Constant") || word.is("Linear") {
            self.draft.evidence.fuzzylite(word.place(), "the class of a set");
            let numbers = self.numbers()?;
            if word.is("Linear") {
                return Some(Set::Linear(word, numbers));
            }
            let [only] = numbers[..] else {
                self.wrong(word, "does not have one number", "`Constant` and a number");
                return None;
            };
            return Some(Set::Number(only.value));
        }
        let words = JFUZZYLOGIC.iter().chain(FUZZYLITE).map(|row| row.word).chain(OTHERS);
        let expected =
            format!("a number, points such as `(0, 0) (1, 1)`, or {}", known(words, word.text));
        self.wrong(word, "not known as a set", expected);
        None
    }

    /// Numbers with or without brackets and commas, up to `;`.
    fn numbers(&mut self) -> Option<Vec<Number<'a>>> {
        let bracket = self.tokens.eat("(");
        let mut numbers = Vec::new();
        while matches!(self.next().kind, Kind::Number | Kind::Word) {
            numbers.push(self.number()?);
            self.tokens.eat(",");
        }
        if bracket {
            self.expect(")")?;
        }
        Some(numbers)
    }
}

/// $\max(0, \sigma_l(x) - \sigma_r(x))$, the steps by centre and slope.
fn cut_difference(params: &[f64]) -> String {
    let steps: Vec<String> = params
        .chunks_exact(2)
        .filter_map(|step| match *step {
            [centre, slope] => {
                Some(format!("1 / (1 + exp(-({}) * (x - ({}))))", written(slope), written(centre)))
            }
            _ => None,
        })
        .collect();
    format!("max(0, {})", steps.join(" - "))
}

/// Points that are a triangle or a trapezoid are read as one.
fn recognised(points: Membership) -> Membership {
    let Membership::Shape { kind: ShapeKind::Points, params, height } = &points else {
        return points;
    };
    let places = || params.iter().step_by(2).copied().collect::<Vec<_>>();
    let grades: Vec<f64> = params.iter().skip(1).step_by(2).copied().collect();
    let kind = match grades[..] {
        [0.0, 1.0, 0.0] => ShapeKind::Triangle,
        [0.0, 1.0, 1.0, 0.0] => ShapeKind::Trapezoid,
        _ => return points,
    };
    let params = places();
    if kind.check(&params).is_err() {
        return points;
    }
    Membership::Shape { kind, params, height: *height }
}

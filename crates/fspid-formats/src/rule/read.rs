//! Reading a rule.

use fspid_fuzzy::Hedge;
use fspid_fuzzy::system::{Antecedent, Consequent, Rule, Statement, Variable};

use super::{MAX_DEPTH, RESERVED};
use crate::lexer::{Kind, Token};
use crate::names::{Found, Index, Names};
use crate::number;
use crate::report::Report;
use crate::tokens::Tokens;
use crate::vocabulary::known;
use fspid_diagnostics::Place;

/// How *and* and *or* stand beside each other where no brackets tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rank {
    /// *And* binds tighter, as in the standard and in fuzzylite.
    AndFirst,
    /// Both bind alike, from left to right, as in jFuzzyLogic.
    InTurn,
}

/// How a dialect reads rules.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Manner {
    /// Tells the words that no rule goes beyond.
    pub(crate) ends: fn(&str) -> bool,
    pub(crate) rank: Rank,
}

/// Reads rules from tokens. What it cannot read is reported; then it answers nothing.
pub(crate) struct Reader<'r, 'a> {
    pub(crate) tokens: Tokens<'a>,
    pub(crate) names: &'r Names,
    pub(crate) report: &'r mut Report,
    manner: Manner,
    /// First use of each of *and*, *or*.
    pub(crate) and: Option<Place>,
    pub(crate) or: Option<Place>,
}

/// A statement before it is known whether it is a condition or a conclusion.
struct Clause<'a> {
    variable: Token<'a>,
    position: usize,
    hedges: Vec<Hedge>,
    term: Option<usize>,
}

impl<'r, 'a> Reader<'r, 'a> {
    pub(crate) fn new(
        tokens: Tokens<'a>,
        names: &'r Names,
        report: &'r mut Report,
        manner: Manner,
    ) -> Self {
        Self { tokens, names, report, manner, and: None, or: None }
    }

    /// A rule from `if` up to its weight.
    pub(crate) fn rule(&mut self) -> Option<Rule> {
        let start = self.tokens.next;
        self.expect("if")?;
        let antecedent = self.condition(0)?;
        if depth(&antecedent) > MAX_DEPTH {
            self.wrong(start, too_deep(), "");
            return None;
        }
        self.expect("then")?;
        let consequents = self.conclusions()?;
        let weight = if self.tokens.eat("with") { self.weight()? } else { 1.0 };
        Some(Rule { name: String::new(), enabled: true, antecedent, consequents, weight })
    }

    fn condition(&mut self, depth: usize) -> Option<Antecedent> {
        match self.manner.rank {
            Rank::AndFirst => self.disjunction(depth),
            Rank::InTurn => self.in_turn(depth),
        }
    }

    /// `a and b or c and d` as `((a and b) or c) and d`.
    fn in_turn(&mut self, depth: usize) -> Option<Antecedent> {
        let mut found = self.operand(depth)?;
        let mut level = depth;
        while let Some(word) = ["and", "or"].into_iter().find(|word| self.tokens.next.is(word)) {
            if level > MAX_DEPTH {
                self.wrong(self.tokens.next, too_deep(), "");
                return None;
            }
            level += 1;
            let (first_use, join): (_, fn(_) -> _) = match word {
                "and" => (&mut self.and, Antecedent::All),
                _ => (&mut self.or, Antecedent::Any),
            };
            first_use.get_or_insert(self.tokens.next.place());
            let mut parts = vec![found];
            while self.tokens.eat(word) {
                parts.push(self.operand(depth)?);
            }
            found = joined(parts, join);
        }
        Some(found)
    }

    fn disjunction(&mut self, depth: usize) -> Option<Antecedent> {
        let mut parts = vec![self.conjunction(depth)?];
        while self.tokens.next.is("or") {
            self.or.get_or_insert(self.tokens.next.place());
            self.tokens.advance();
            parts.push(self.conjunction(depth)?);
        }
        Some(joined(parts, Antecedent::Any))
    }

    fn conjunction(&mut self, depth: usize) -> Option<Antecedent> {
        let mut parts = vec![self.operand(depth)?];
        while self.tokens.next.is("and") {
            self.and.get_or_insert(self.tokens.next.place());
            self.tokens.advance();
            parts.push(self.operand(depth)?);
        }
        Some(joined(parts, Antecedent::All))
    }

    fn operand(&mut self, depth: usize) -> Option<Antecedent> {
        let start = self.tokens.next;
        if depth > MAX_DEPTH {
            self.wrong(start, too_deep(), "");
            return None;
        }
        if self.tokens.eat("not") {
            return Some(Antecedent::Not(Box::new(self.operand(depth + 1)?)));
        }
        if self.tokens.eat("(") {
            let inner = self.condition(depth + 1)?;
            self.expect(")")?;
            return Some(inner);
        }
        let Clause { position, hedges, term, .. } = self.clause()?;
        let variable = self.names.variable(position);
        Some(Antecedent::Is(Statement { variable, term, hedges }))
    }

    fn conclusions(&mut self) -> Option<Vec<Consequent>> {
        let mut found = vec![self.conclusion()?];
        while self.tokens.next.is_any(&["and", ","]) {
            self.tokens.advance();
            found.push(self.conclusion()?);
        }
        Some(found)
    }

    fn conclusion(&mut self) -> Option<Consequent> {
        let bracket = self.tokens.eat("(");
        let Clause { variable, position, hedges, term } = self.clause()?;
        if bracket {
            self.expect(")")?;
        }
        match (self.names.variable(position), term) {
            (Variable::Output(output), Some(term)) => Some(Consequent { output, term, hedges }),
            (Variable::Output(_), None) => {
                self.wrong(variable, "nothing is concluded about it", "a term after the hedges");
                None
            }
            (Variable::Input(_), _) => {
                let expected = known(self.names.outputs(), variable.text);
                self.wrong(variable, "an input cannot be concluded", expected);
                None
            }
        }
    }

    /// `variable is hedges term`
    fn clause(&mut self) -> Option<Clause<'a>> {
        let variable = self.variable()?;
        let position =
            self.look_up(&self.names.variables, variable, "no variable has this name")?;
        self.expect("is")?;
        let words = self.words();
        let (hedges, term) = self.hedges_and_term(position, &words)?;
        Some(Clause { variable, position, hedges, term })
    }

    fn variable(&mut self) -> Option<Token<'a>> {
        let next = self.tokens.next;
        if self.is_name(&next) && !next.is_any(&RESERVED) {
            return Some(self.tokens.advance());
        }
        let expected = known(self.names.variables.all(), next.text);
        self.wrong(next, "not the name of a variable", expected);
        None
    }

    fn is_name(&self, token: &Token) -> bool {
        matches!(token.kind, Kind::Word | Kind::Number) && !(self.manner.ends)(token.text)
    }

    /// The words up to the next keyword or sign.
    fn words(&mut self) -> Vec<Token<'a>> {
        let mut words = Vec::new();
        let keywords = ["if", "is", "and", "or", "then", "with"];
        while self.is_name(&self.tokens.next) && !self.tokens.next.is_any(&keywords) {
            words.push(self.tokens.advance());
        }
        words
    }

    fn hedges_and_term(
        &mut self,
        position: usize,
        words: &[Token<'a>],
    ) -> Option<(Vec<Hedge>, Option<usize>)> {
        let names = self.names;
        let terms = names.terms(position)?;
        let Some((&last, before)) = words.split_last() else {
            self.wrong(self.tokens.next, "the term is missing", known(terms.all(), ""));
            return None;
        };
        let begun = before.iter().position(|word| terms.find(word.text) != Found::Nothing);
        if let (Some(term), Found::Nothing) = (begun, terms.find(last.text)) {
            let after = words.get(term + 1).copied().unwrap_or(last);
            self.wrong(
                after,
                "does not fit behind a term",
                "`and`, `or`, `then`, `with` or the end",
            );
            return None;
        }
        let hedges = before.iter().map(|&word| self.hedge(word)).collect::<Option<Vec<_>>>()?;
        if terms.find(last.text) == Found::Nothing && last.is("any") {
            return Some((hedges.into_iter().chain([Hedge::Any]).collect(), None));
        }
        let message = format!("no term of `{}` has this name", names.variables.name(position));
        let term = self.look_up(terms, last, &message)?;
        Some((hedges, Some(term)))
    }

    fn hedge(&mut self, word: Token<'a>) -> Option<Hedge> {
        let hedge = Hedge::from_name(&word.text.to_ascii_lowercase());
        if hedge.is_none() {
            let expected = known(Hedge::NAMED.iter().map(|hedge| hedge.name()), word.text);
            self.wrong(word, "not a hedge", expected);
        }
        hedge
    }

    /// The position of a name; one in another case is noted, or refused if case matters.
    fn look_up(&mut self, index: &Index, name: Token<'a>, message: &str) -> Option<usize> {
        match index.find(name.text) {
            Found::Exact(position) => Some(position),
            Found::Folded(position) if !self.names.case_matters => {
                let meant = index.name(position);
                let note = format!("`{}` is read as `{meant}`, which differs in case", name.text);
                self.report.note(name.place(), note);
                Some(position)
            }
            Found::Folded(_) | Found::Nothing => {
                self.wrong(name, message, known(index.all(), name.text));
                None
            }
        }
    }

    fn weight(&mut self) -> Option<f64> {
        let token = self.tokens.advance();
        match number::finite(token.text) {
            Ok(weight) if (0.0..=1.0).contains(&weight) => Some(weight),
            _ => {
                self.wrong(token, "not a weight", "a number from 0 to 1");
                None
            }
        }
    }

    fn expect(&mut self, word: &str) -> Option<()> {
        if self.tokens.eat(word) {
            return Some(());
        }
        self.wrong(self.tokens.next, "does not fit here", format!("`{word}`"));
        None
    }

    fn wrong(&mut self, token: Token, message: impl Into<String>, expected: impl Into<String>) {
        let over = token.kind == Kind::End || (self.manner.ends)(token.text);
        let message = if over { "the rule ends".into() } else { message.into() };
        self.report.problem(token.place(), token.text, message, expected);
    }
}

fn too_deep() -> String {
    format!("brackets and negations are nested more than {MAX_DEPTH} levels deep")
}

/// One part as it is, several joined.
fn joined(mut parts: Vec<Antecedent>, join: fn(Vec<Antecedent>) -> Antecedent) -> Antecedent {
    match parts.pop() {
        Some(only) if parts.is_empty() => only,
        last => join(parts.into_iter().chain(last).collect()),
    }
}

/// Levels below the first; what is read is at most three for each bracket.
/// How deeply a condition is nested.
pub(crate) fn depth(antecedent: &Antecedent) -> usize {
    match antecedent {
        Antecedent::Always | Antecedent::Is(_) => 0,
        Antecedent::All(parts) | Antecedent::Any(parts) => {
            1 + parts.iter().map(depth).max().unwrap_or(0)
        }
        Antecedent::Not(part) => 1 + depth(part),
    }
}

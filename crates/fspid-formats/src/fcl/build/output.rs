//! Outputs.

use fspid_fuzzy::SNormKind;
use fspid_fuzzy::system::{
    Conclusion, Defuzzifier, Fallback, FallbackValue, Membership, Output, OutputTerm, Sampling,
    Universe,
};

use super::{Builder, wrong};
use crate::fcl::connectives::accumulation_word;
use crate::fcl::draft::{Role, Set, Variable};
use crate::lexer::Token;
use crate::term;
use crate::vocabulary::norms::{S_NORMS, row_of};

impl<'a> Builder<'a> {
    pub(super) fn output(&mut self, index: usize, variable: &Variable<'a>) -> Output {
        let name = variable.name;
        if variable.role == Role::Local {
            self.report.note(
                name.place(),
                format!("the local variable `{}` is an output here", name.text),
            );
        }
        let defuzzifier = self.defuzzifier(variable);
        let integrates = defuzzifier.sampling().is_some();
        let mut terms = Vec::new();
        for term in &variable.terms {
            let conclusion = self.conclusion(&term.set, integrates);
            let name = term.name.text.into();
            terms.extend(conclusion.map(|conclusion| OutputTerm { name, conclusion }));
        }
        let universe = self.universe(variable, integrates);
        Output {
            name: name.text.into(),
            description: String::new(),
            enabled: variable.enabled,
            universe,
            clamp: variable.clamp,
            terms,
            aggregation: self.aggregation(index, variable, !integrates).into(),
            defuzzifier,
            fallback: fallback(variable),
        }
    }

    fn conclusion(&mut self, set: &Set<'a>, integrates: bool) -> Option<Conclusion> {
        match set {
            Set::Unknown => None,
            Set::Fuzzy(membership) => {
                Some(Conclusion::Set { membership: membership.clone(), lower: None })
            }
            Set::Number(value) => Some(Conclusion::Constant(*value)),
            Set::Linear(word, numbers) => {
                term::linear(*word, numbers, self.inputs, &mut self.report)
            }
            Set::Formula(text) if integrates => self
                .membership_formula(*text)
                .map(|membership| Conclusion::Set { membership, lower: None }),
            Set::Formula(text) => {
                term::formula(*text, &self.formula_names, &mut self.report).map(Conclusion::Formula)
            }
        }
    }

    /// The method with the dialect's way to integrate. Numbers have no area: the centre of gravity
    /// of numbers is their weighted mean.
    fn defuzzifier(&mut self, variable: &Variable<'a>) -> Defuzzifier {
        let numbers = variable.terms.iter().filter(|t| matches!(t.set, Set::Number(_))).count();
        let only_numbers = numbers > 0 && numbers == variable.terms.len();
        let weighted = Defuzzifier::WeightedAverage(Default::default());
        let Some(method) = variable.method else {
            let assumed = if only_numbers { weighted } else { Defuzzifier::default() };
            if variable.section.is_some() {
                let note = format!("no METHOD is given; {} is assumed", assumed.name());
                self.report.note(variable.name.place(), note);
            }
            return self.sampled(assumed, variable);
        };
        let found = method.row.method;
        if found.sampling().is_some() && numbers > 0 {
            if only_numbers && matches!(found, Defuzzifier::Centroid(_)) {
                let note = "the centre of gravity of numbers is read as COGS, their weighted mean";
                self.report.note(method.word.place(), note);
                return weighted;
            }
            wrong(
                &mut self.report,
                method.word,
                "integrates, but some terms are numbers",
                "`COGS`",
            );
        }
        if found.sampling().is_none() {
            self.check_weighted(variable, method.word);
        }
        self.sampled(found, variable)
    }

    fn check_weighted(&mut self, variable: &Variable<'a>, word: Token<'a>) {
        let blurred = |set: &Set| matches!(set, Set::Fuzzy(set) if !crate::fll::is_monotone(set));
        if let Some(term) = variable.terms.iter().find(|term| blurred(&term.set)) {
            let message = format!("weighs numbers, but `{}` is a fuzzy set", term.name.text);
            wrong(&mut self.report, word, &message, "`COG`, or terms that are numbers");
        }
    }

    fn sampled(&self, method: Defuzzifier, variable: &Variable) -> Defuzzifier {
        let resolution = variable.method.and_then(|method| method.resolution);
        let by_resolution = resolution.map(Sampling::Midpoint);
        let sampling = variable.sampling.or(by_resolution).unwrap_or(self.dialect.sampling());
        method.with_sampling(sampling)
    }

    /// The range, or what bounded terms span.
    fn universe(&mut self, variable: &Variable<'a>, needed: bool) -> Option<Universe> {
        if variable.universe.is_some() || !needed || variable.terms.is_empty() {
            return variable.universe;
        }
        let spanned = variable.terms.iter().map(|term| span(&term.set));
        let spanned = spanned.reduce(|all, one| {
            all.zip(one).map(|((lower, upper), (a, b))| (lower.min(a), upper.max(b)))
        });
        let place = variable.name.place();
        match spanned.flatten().filter(|(lower, upper)| lower < upper) {
            Some((lower, upper)) => {
                let note = format!("no RANGE is given; the terms span {lower:?} to {upper:?}");
                self.report.note(place, note);
                Some(Universe { lower, upper })
            }
            None => {
                let message = "has no RANGE, and its terms have no ends";
                wrong(&mut self.report, variable.name, message, "`RANGE := (lower .. upper);`");
                None
            }
        }
    }

    /// `ACCU` of the output, or of the blocks that conclude it.
    fn aggregation(&mut self, index: usize, variable: &Variable<'a>, weighs: bool) -> SNormKind {
        let of_blocks = self.accus.get(index).into_iter().flatten().copied();
        let named: Vec<_> = variable.accu.into_iter().chain(of_blocks).collect();
        let Some(&(first, _)) = named.first() else {
            let assumed = self.dialect.accumulation();
            let word = accumulation_word(&assumed.into()).unwrap_or_default();
            let what = match weighs {
                true => "rules that conclude the same are added up".into(),
                false => format!("{word} is assumed"),
            };
            let note = format!("no ACCU is given for `{}`; {what}", variable.name.text);
            self.report.note(variable.name.place(), note);
            return assumed;
        };
        if let Some(&(other, place)) = named.iter().find(|(norm, _)| *norm != first) {
            let word = |norm| row_of(S_NORMS, &norm).map_or("", |row| row.word());
            let name = variable.name.text;
            let message = format!("`{name}` is accumulated by {} elsewhere", word(first));
            self.report.problem(place, word(other), message, "the same everywhere");
        }
        first
    }
}

fn fallback(variable: &Variable) -> Fallback {
    let number = variable.default.map_or(FallbackValue::Nothing, FallbackValue::Number);
    let value = if variable.middle { FallbackValue::Middle } else { number };
    Fallback { previous: variable.previous, value }
}

/// The ends of a set, if it has any.
fn span(set: &Set) -> Option<(f64, f64)> {
    let Set::Fuzzy(Membership::Shape { kind, params, .. }) = set else { return None };
    let mut ends: Option<(f64, f64)> = None;
    kind.vertices(params, &mut |vertex| {
        let (lower, upper) = ends.unwrap_or((vertex.x, vertex.x));
        ends = Some((lower.min(vertex.x), upper.max(vertex.x)));
    });
    ends
}

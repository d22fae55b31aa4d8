//! Checking parts and resolving them into a system.

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use super::defuzzifier::Defuzzifier;
use super::error::{SystemError, SystemProblem};
use super::output::{Activations, Outline, Plan};
use super::parts::{
    Antecedent, Conclusion, Input, Membership, Output, Parts, Rule, RuleBlock, Statement, Universe,
    Variable,
};
use super::program::{Form, MAX_DEPTH, Program};
use super::type2::{self, Type2};
use crate::hedge::Hedge;

/// Most rules of a system.
const MAX_RULES: usize = 1_000_000;
/// Most problems that are told at once.
const MAX_PROBLEMS: usize = 100;

/// A fuzzy system, checked and resolved: every answer it can be asked for exists.
#[derive(Clone, Debug)]
pub struct System {
    pub(crate) parts: Parts,
    pub(crate) program: Program,
    /// Rules that are switched on, in the order of their evaluation.
    pub(crate) rules: Vec<ResolvedRule>,
    /// What the rules conclude, in the order of the rules.
    pub(crate) conclusions: Vec<ResolvedConclusion>,
    pub(crate) outputs: Vec<ResolvedOutput>,
    /// The rules of each block.
    pub(crate) block_rules: Vec<Range<usize>>,
    /// True if some rule asks about an output.
    pub(crate) chained: bool,
    /// What an interval type-2 system needs beside.
    pub(crate) type2: Option<Type2>,
    /// True if some conclusion has a hedge.
    pub(crate) hedged: bool,
}

#[derive(Clone, Debug)]
pub(crate) struct ResolvedRule {
    pub(crate) block: usize,
    /// Position in the block.
    pub(crate) rule: usize,
    /// Its steps in the program.
    pub(crate) steps: Range<usize>,
    pub(crate) form: Form,
    pub(crate) weight: f64,
    /// Its conclusions.
    pub(crate) conclusions: Range<usize>,
}

#[derive(Clone, Debug)]
pub(crate) struct ResolvedConclusion {
    pub(crate) block: usize,
    /// Position in [`System::rules`].
    pub(crate) rule: usize,
    pub(crate) output: usize,
    pub(crate) term: usize,
    pub(crate) hedges: Vec<Hedge>,
}

#[derive(Clone, Debug)]
pub(crate) struct ResolvedOutput {
    /// Positions of its conclusions, in the order of the rules.
    pub(crate) conclusions: Vec<usize>,
    pub(crate) plan: Plan,
    /// Who concludes what about it.
    pub(crate) actors: Activations,
    /// Its sets, if they make a polygon.
    pub(crate) outline: Option<Outline>,
}

impl System {
    /// Checks the parts and resolves every name and position.
    ///
    /// # Errors
    /// Every problem there is (up to a hundred), each with its place.
    pub fn new(parts: Parts) -> Result<Self, Vec<SystemError>> {
        let mut check =
            Check { parts: &parts, type2: parts.is_interval_type2(), errors: Vec::new() };
        check.all();
        let errors = check.errors;
        if !errors.is_empty() {
            return Err(errors);
        }
        let system = Self::resolved(parts);
        let errors = type2::without_outline(&system);
        if errors.is_empty() { Ok(system) } else { Err(errors) }
    }

    /// What the system consists of.
    #[must_use]
    pub fn parts(&self) -> &Parts {
        &self.parts
    }

    fn resolved(parts: Parts) -> Self {
        let mut resolver = Resolver::default();
        for (block_index, block) in parts.blocks.iter().enumerate() {
            resolver.block(block_index, block);
        }
        let Resolver { program, rules, conclusions, block_rules } = resolver;
        let mut by_output = vec![Vec::new(); parts.outputs.len()];
        for (index, conclusion) in conclusions.iter().enumerate() {
            if let Some(own) = by_output.get_mut(conclusion.output) {
                own.push(index);
            }
        }
        let outputs = parts.outputs.iter().zip(by_output).map(|(output, own)| {
            let resolved: Vec<_> = own.iter().filter_map(|&i| conclusions.get(i)).collect();
            let blocks = resolved.iter().filter_map(|c| parts.blocks.get(c.block));
            let blocks: Vec<_> = blocks.collect();
            let actors = Activations::of(output, &resolved, &blocks);
            let outline = Outline::of(output, &actors);
            let plan = Plan::new(output, &actors, outline.as_ref());
            ResolvedOutput { plan, actors, outline, conclusions: own }
        });
        let outputs: Vec<_> = outputs.collect();
        let type2 = Type2::of(&parts, &outputs);
        let chained = program.statements.iter().any(|s| matches!(s.variable, Variable::Output(_)));
        let hedged = conclusions.iter().any(|conclusion| !conclusion.hedges.is_empty());
        Self { parts, program, rules, conclusions, outputs, block_rules, chained, hedged, type2 }
    }
}

/// Collects what [`System`] needs, rule by rule.
#[derive(Default)]
struct Resolver {
    program: Program,
    rules: Vec<ResolvedRule>,
    conclusions: Vec<ResolvedConclusion>,
    block_rules: Vec<Range<usize>>,
}

impl Resolver {
    fn block(&mut self, block_index: usize, block: &RuleBlock) {
        let begin = self.rules.len();
        for (index, rule) in block.rules.iter().enumerate() {
            if block.enabled && rule.enabled {
                self.rule(block_index, index, rule);
            }
        }
        self.block_rules.push(begin..self.rules.len());
    }

    fn rule(&mut self, block: usize, index: usize, rule: &Rule) {
        let begin = self.conclusions.len();
        for consequent in &rule.consequents {
            self.conclusions.push(ResolvedConclusion {
                block,
                rule: self.rules.len(),
                output: consequent.output,
                term: consequent.term,
                hedges: consequent.hedges.clone(),
            });
        }
        let conclusions = begin..self.conclusions.len();
        let steps = self.program.append(&rule.antecedent);
        let form = self.program.form(steps.clone());
        self.rules.push(ResolvedRule {
            block,
            rule: index,
            steps,
            form,
            weight: rule.weight,
            conclusions,
        });
    }
}

/// Walks over the parts and collects what is wrong.
struct Check<'a> {
    parts: &'a Parts,
    type2: bool,
    errors: Vec<SystemError>,
}

impl Check<'_> {
    fn say(&mut self, place: impl FnOnce() -> String, problem: impl Into<SystemProblem>) {
        if self.errors.len() < MAX_PROBLEMS {
            self.errors.push(SystemError { place: place(), problem: problem.into() });
        }
    }

    fn all(&mut self) {
        let parts = self.parts;
        let whole = || String::from("the system");
        if parts.inputs.is_empty() {
            self.say(whole, SystemProblem::Missing { what: "input" });
        }
        // Without rules there is nothing to conclude: such a system grades its inputs.
        let rules = parts.blocks.iter().any(|block| !block.rules.is_empty());
        if parts.outputs.is_empty() && (rules || parts.inputs.is_empty()) {
            self.say(whole, SystemProblem::Missing { what: "output" });
        }
        self.names(
            "the system",
            parts.inputs.iter().map(|i| &i.name).chain(parts.outputs.iter().map(|o| &o.name)),
        );
        for input in &parts.inputs {
            self.input(input);
        }
        for output in &parts.outputs {
            self.output(output);
        }
        self.blocks();
    }

    fn names<'n>(&mut self, place: &str, names: impl Iterator<Item = &'n String>) {
        let mut seen = BTreeSet::new();
        for name in names {
            if name.trim().is_empty() {
                self.say(|| place.into(), SystemProblem::NoName);
            } else if !seen.insert(name) {
                self.say(|| place.into(), SystemProblem::Duplicate { name: name.clone() });
            }
        }
    }

    fn universe(&mut self, place: &str, universe: Option<Universe>) {
        let Some(Universe { lower, upper }) = universe else { return };
        let usable = lower < upper && (upper - lower).is_finite();
        if !usable {
            self.say(|| place.into(), SystemProblem::Universe { lower, upper });
        }
    }

    fn input(&mut self, input: &Input) {
        let place = format!("input `{}`", input.name);
        self.universe(&place, input.universe);
        self.names(&place, input.terms.iter().map(|t| &t.name));
        for term in &input.terms {
            let place = || format!("{place}, term `{}`", term.name);
            for membership in [Some(&term.membership), term.lower.as_ref()].into_iter().flatten() {
                self.membership(place, membership);
            }
        }
    }

    fn membership(&mut self, place: impl Fn() -> String, membership: &Membership) {
        let (Membership::Shape { height, .. } | Membership::Formula { height, .. }) = membership;
        if !(*height > 0.0 && *height <= 1.0) {
            let allowed = "a number above 0, at most 1";
            self.say(&place, SystemProblem::Number { what: "height", found: *height, allowed });
        }
        if let Membership::Shape { kind, params, .. } = membership
            && let Err(error) = kind.check(params)
        {
            self.say(&place, error);
        }
    }

    fn output(&mut self, output: &Output) {
        let place = format!("output `{}`", output.name);
        self.universe(&place, output.universe);
        self.names(&place, output.terms.iter().map(|t| &t.name));
        let integrates = output.defuzzifier.sampling().is_some();
        let sets =
            output.terms.iter().filter(|t| matches!(t.conclusion, Conclusion::Set { .. })).count();
        if integrates && output.universe.is_none() {
            let (what, needs) = (output.defuzzifier.name(), "a universe to integrate over");
            self.say(|| place.clone(), SystemProblem::Conflict { what, needs });
        }
        if integrates && sets < output.terms.len() {
            let (what, needs) = (output.defuzzifier.name(), "terms that are all fuzzy sets");
            self.say(|| place.clone(), SystemProblem::Conflict { what, needs });
        }
        if let Some(Err(error)) = output.defuzzifier.sampling().map(|s| s.checked()) {
            self.say(|| place.clone(), error);
        }
        if let super::FallbackValue::Number(found) = output.fallback.value
            && !found.is_finite()
        {
            let allowed = "a finite number";
            self.say(
                || place.clone(),
                SystemProblem::Number { what: "the default", found, allowed },
            );
        }
        if let Some((what, needs)) = self.type2.then(|| type2::conflict(output)).flatten() {
            self.say(|| place.clone(), SystemProblem::Conflict { what, needs });
        }
        for term in &output.terms {
            let place = || format!("{place}, term `{}`", term.name);
            self.conclusion(place, output, &term.conclusion);
        }
    }

    fn conclusion(&mut self, place: impl Fn() -> String, output: &Output, found: &Conclusion) {
        let mut finite = |what, number: f64| {
            if !number.is_finite() {
                let allowed = "a finite number";
                self.say(&place, SystemProblem::Number { what, found: number, allowed });
            }
        };
        match found {
            Conclusion::Constant(number) => finite("the constant", *number),
            Conclusion::Interval(ends) => {
                ends.iter().for_each(|&end| finite("an end of the interval", end));
                let [lower, upper] = *ends;
                if lower > upper {
                    self.say(&place, SystemProblem::Universe { lower, upper });
                }
            }
            Conclusion::Linear { coefficients, constant } => {
                coefficients.iter().for_each(|&c| finite("a coefficient", c));
                finite("the constant", *constant);
                let (found, count) = (coefficients.len(), self.parts.inputs.len());
                if found != count {
                    self.say(
                        &place,
                        SystemProblem::TooMany { what: "coefficients", found, most: count },
                    );
                }
            }
            Conclusion::Set { membership, lower } => {
                for membership in [Some(membership), lower.as_ref()].into_iter().flatten() {
                    self.membership(&place, membership);
                }
                self.monotone(&place, output.defuzzifier, membership);
            }
            Conclusion::Formula(_) => {}
        }
    }

    /// Tsukamoto's method asks a set for the place of a grade.
    fn monotone(
        &mut self,
        place: impl Fn() -> String,
        method: Defuzzifier,
        membership: &Membership,
    ) {
        let reading = match method {
            Defuzzifier::WeightedAverage(reading) | Defuzzifier::WeightedSum(reading) => reading,
            _ => return,
        };
        let inverse = match membership {
            Membership::Shape { kind, params, .. } => kind.inverse(params, 0.5_f64),
            Membership::Formula { .. } => None,
        };
        if reading == super::SetReading::Tsukamoto && inverse.is_none() {
            let (what, needs) = (method.name(), "sets that rise or fall throughout (Tsukamoto)");
            self.say(place, SystemProblem::Conflict { what, needs });
        }
    }

    fn blocks(&mut self) {
        let parts = self.parts;
        let found: usize = parts.blocks.iter().map(|block| block.rules.len()).sum();
        if found > MAX_RULES {
            let place = || String::from("the system");
            self.say(place, SystemProblem::TooMany { what: "rules", found, most: MAX_RULES });
        }
        for (block_index, block) in parts.blocks.iter().enumerate() {
            if let Some((what, needs)) = self.type2.then(|| type2::block_conflict(block)).flatten()
            {
                let place = || format!("rule block {}", block_index + 1);
                self.say(place, SystemProblem::Conflict { what, needs });
            }
            for (rule_index, rule) in block.rules.iter().enumerate() {
                let place = || match (parts.blocks.len(), block.name.as_str()) {
                    (1, _) => format!("rule {}", rule_index + 1),
                    (_, "") => format!("rule block {}, rule {}", block_index + 1, rule_index + 1),
                    (_, name) => format!("rule block `{name}`, rule {}", rule_index + 1),
                };
                if !(0.0..=1.0).contains(&rule.weight) {
                    let allowed = "a number from 0 to 1";
                    let found = rule.weight;
                    self.say(place, SystemProblem::Number { what: "the weight", found, allowed });
                }
                if rule.consequents.is_empty() {
                    self.say(place, SystemProblem::Missing { what: "conclusion" });
                }
                self.antecedent(&place, &rule.antecedent, 0);
                for consequent in &rule.consequents {
                    let Some(output) = parts.outputs.get(consequent.output) else {
                        let (found, count) = (consequent.output, parts.outputs.len());
                        self.say(place, SystemProblem::Position { what: "output", found, count });
                        continue;
                    };
                    let (found, count) = (consequent.term, output.terms.len());
                    if found >= count {
                        self.say(
                            place,
                            SystemProblem::Position { what: "output term", found, count },
                        );
                    }
                }
            }
        }
    }

    fn antecedent(&mut self, place: &impl Fn() -> String, part: &Antecedent, depth: usize) {
        if depth > MAX_DEPTH {
            self.say(place, SystemProblem::Depth { most: MAX_DEPTH });
            return;
        }
        match part {
            Antecedent::Always => {}
            Antecedent::Is(statement) => self.statement(place, statement),
            Antecedent::All(parts) | Antecedent::Any(parts) => {
                for part in parts {
                    self.antecedent(place, part, depth + 1);
                }
            }
            Antecedent::Not(part) => self.antecedent(place, part, depth + 1),
        }
    }

    fn statement(&mut self, place: &impl Fn() -> String, statement: &Statement) {
        let (what, found, variables, terms) = match statement.variable {
            Variable::Input(index) => {
                let terms = self.parts.inputs.get(index).map(|input| input.terms.len());
                ("input", index, self.parts.inputs.len(), terms)
            }
            Variable::Output(index) => {
                let terms = self.parts.outputs.get(index).map(|output| output.terms.len());
                ("output", index, self.parts.outputs.len(), terms)
            }
        };
        match (terms, statement.term) {
            (None, _) => self.say(place, SystemProblem::Position { what, found, count: variables }),
            (Some(count), Some(found)) if found >= count => {
                self.say(place, SystemProblem::Position { what: "term", found, count });
            }
            _ => {}
        }
    }
}

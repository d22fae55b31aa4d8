//! From inputs to the degrees of conclusions, as `system/firing.rs` of `fspid-fuzzy`.

use fspid_fuzzy::hedge::Hedge;
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::{
    Activation, Antecedent, Membership, Parts, Rule, RuleBlock, Statement as Condition, Universe,
    Variable,
};
use fspid_fuzzy::{OutOfRange, SNormKind};
use fspid_numeric::Real;

use super::activation::{acting, activate};
use super::library::used;
use super::{Composer, SystemRefusal, Trouble, at, put};
use crate::program::{
    Expression, Operator, Part, Statement, Value, local, member, member_element, number, whole,
};

/// A rule that is switched on, by its place in the file.
#[derive(Clone, Copy)]
pub(super) struct Fired {
    block: usize,
    rule: usize,
}

impl<R: Real> Composer<'_, R> {
    pub(super) fn refuse_what_has_no_program(&self) -> Result<(), SystemRefusal> {
        let parts = self.system.parts();
        let whole = |problem, possible| Err(Trouble::Said(problem, possible).at("the system"));
        if parts.outputs.is_empty() {
            return whole("it has no output", "possible is a system with rules and outputs");
        }
        if parts.is_interval_type2() {
            return whole(
                "interval type-2 sets are reduced by an iteration whose number of steps depends on the inputs",
                "possible is the same system with the upper sets alone",
            );
        }
        Ok(())
    }

    /// Inputs as they are used, and what is wrong with them.
    pub(super) fn inputs(&mut self) {
        let parts = self.system.parts();
        self.body.push(Statement::Array("inputs".to_owned(), parts.inputs.len()));
        let names = self.names.inputs.clone();
        let largest = number(crate::compose::precision_of::<R>().largest());
        let mut finite = Vec::new();
        let mut inside = Vec::new();
        for (index, (input, name)) in parts.inputs.iter().zip(names).enumerate() {
            let value = member(Part::Sample, &name);
            finite.push(value.clone().magnitude().at_most(largest.clone()));
            let range = input.universe.map(|universe| self.range(&name, universe));
            let used = match (input.out_of_range, range) {
                (OutOfRange::Clamp, Some([lower, upper])) => clamped(value, lower, upper),
                (OutOfRange::Error, Some([lower, upper])) => {
                    let not_finite = value.clone().magnitude().at_most(largest.clone()).negated();
                    let within = lower.at_most(value.clone()).and(value.clone().at_most(upper));
                    inside.push(not_finite.or(within));
                    value
                }
                _ => value,
            };
            self.body.push(put("inputs", index, used));
        }
        let fault = |body: &mut Vec<Statement>, good: Vec<Expression>, bit| {
            if let Some(good) = good.into_iter().reduce(Expression::and) {
                let faults = Expression::Byte(bit);
                let both = Expression::binary(Operator::BitOr, local("fault"), faults);
                body.push(Statement::when(good.negated(), vec![Statement::set("fault", both)]));
            }
        };
        self.body.push(Statement::Let(
            "fault".into(),
            crate::program::Kind::Byte,
            Expression::Byte(0),
        ));
        fault(&mut self.body, finite, super::NOT_FINITE);
        fault(&mut self.body, inside, super::OUT_OF_RANGE);
        self.leave_where_faulty();
    }

    fn leave_where_faulty(&mut self) {
        let answer = |name: &str, value| Statement::set_member(Part::Answer, name, value);
        self.body.push(answer(&self.names.faults, local("fault")));
        let nothing = |name: &String| answer(name, number(0.0));
        let unsaid = |name: &String| answer(name, Expression::Byte(0));
        self.body.extend(self.names.outputs.iter().map(nothing));
        self.body.extend(self.names.sources.iter().map(unsaid));
        let is_bad =
            Expression::binary(Operator::Equal, local("fault"), Expression::Byte(0)).negated();
        self.body.push(Statement::when(is_bad, vec![Statement::Return(None)]));
    }

    /// The ends of a universe, read from the configuration.
    pub(super) fn range(&mut self, name: &str, universe: Universe) -> [Expression; 2] {
        let called = self.member(&format!("range {name}"), &format!("{name}_range"));
        let ends = Value::Reals(vec![universe.lower, universe.upper]);
        self.configuration.add(&called, &format!("Range of {name}, lower and upper end."), ends);
        [0, 1].map(|end| member_element(Part::Configuration, &called, whole(end)))
    }

    /// The grade of `x` in a set; its parameters become a member of that name.
    pub(super) fn graded(
        &mut self,
        name: &str,
        set: &Membership,
        x: Expression,
    ) -> Result<Expression, Trouble> {
        let Membership::Shape { kind, params, height } = set else {
            return Err(Trouble::Said(
                "a membership function that is a formula cannot be exported",
                "possible is a shape of the family",
            ));
        };
        let given = self.parameters(name, (*kind, params), *height);
        let grade = self.library.grade::<R>((*kind, params), given, x)?;
        Ok(match *height < 1.0 {
            true => grade * self.parameter(name, used(*kind, params).len()),
            false => grade,
        })
    }

    fn parameter(&self, name: &str, index: usize) -> Expression {
        member_element(Part::Configuration, name, super::index_of(index))
    }

    /// Parameters of a set as a member of the configuration.
    pub(super) fn parameters(
        &mut self,
        name: &str,
        (kind, params): (ShapeKind, &[f64]),
        height: f64,
    ) -> Vec<Expression> {
        let used = used(kind, params);
        let mut numbers: Vec<f64> = used.iter().map(|&position| params[position]).collect();
        let count = numbers.len();
        let names: Vec<&str> = kind.params().iter().map(|param| param.name).collect();
        let mut words: Vec<&str> = used.iter().filter_map(|it| names.get(*it).copied()).collect();
        if height < 1.0 {
            numbers.push(height);
            words.push("height");
        }
        if !numbers.is_empty() {
            let doc = format!("A {}: {}.", kind.name(), words.join(", "));
            self.configuration.add(name, &doc, Value::Reals(numbers));
        }
        (0..count).map(|index| self.parameter(name, index)).collect()
    }

    /// Grades of all statements about inputs, each once.
    pub(super) fn grades(&mut self) -> Result<(), SystemRefusal> {
        let conditions = self.conditions.clone();
        self.body.push(Statement::Array("grades".to_owned(), conditions.len().max(1)));
        for (index, condition) in conditions.iter().enumerate() {
            let Variable::Input(input) = condition.variable else { continue };
            let Some(variable) = self.system.parts().inputs.get(input) else { continue };
            let term = condition.term.and_then(|term| variable.terms.get(term));
            let place = || match term {
                Some(term) => format!("input `{}`, term `{}`", variable.name, term.name),
                None => format!("input `{}`", variable.name),
            };
            let grade = match term {
                _ if !variable.enabled => Ok(number(0.0)),
                None => Ok(number(1.0)),
                Some(term) => {
                    let wanted = format!("{}_{}", self.names.inputs[input], term.name);
                    let name =
                        self.member(&format!("input {input} term {:?}", condition.term), &wanted);
                    self.graded(&name, &term.membership, at("inputs", input))
                }
            };
            let grade = match variable.enabled {
                true => grade.and_then(|grade| self.library.hedged::<R>(&condition.hedges, grade)),
                false => grade,
            };
            self.body.push(put("grades", index, grade.map_err(|trouble| trouble.at(place()))?));
        }
        Ok(())
    }

    /// Strengths of all rules, and the degrees of what they conclude.
    pub(super) fn rules(&mut self) -> Result<(), SystemRefusal> {
        let blocks = &self.system.parts().blocks;
        let fired = self.fired.clone();
        let degrees = self.conclusions.len();
        self.body.push(Statement::Array("strengths".to_owned(), fired.len().max(1)));
        self.body.push(Statement::Array("degrees".to_owned(), degrees.max(1)));
        if blocks.iter().any(|block| block.activation != Activation::General) {
            self.body.push(Statement::Array("acting".to_owned(), fired.len().max(1)));
        }
        for (block_index, block) in blocks.iter().enumerate() {
            let own: Vec<usize> =
                (0..fired.len()).filter(|&rule| fired[rule].block == block_index).collect();
            for &rule in &own {
                let strength = self.strength(block, fired[rule], rule);
                let place =
                    || format!("rule {} of block {}", fired[rule].rule + 1, block_index + 1);
                let strength = strength.map_err(|trouble| trouble.at(place()))?;
                self.body.push(put("strengths", rule, strength));
                if self.chained {
                    self.conclude(rule, "strengths").map_err(|trouble| trouble.at(place()))?;
                }
            }
            let (Some(&first), Some(&last)) = (own.first(), own.last()) else { continue };
            activate(&mut self.body, block.activation, [first, last]);
            if !self.chained || block.activation != Activation::General {
                for &rule in &own {
                    let place =
                        || format!("rule {} of block {}", fired[rule].rule + 1, block_index + 1);
                    let strengths = acting(block.activation);
                    self.conclude(rule, strengths).map_err(|trouble| trouble.at(place()))?;
                }
            }
        }
        Ok(())
    }

    fn strength(
        &mut self,
        block: &RuleBlock,
        Fired { block: index, rule }: Fired,
        own: usize,
    ) -> Result<Expression, Trouble> {
        let Some(rule) = self.system.parts().blocks[index].rules.get(rule) else {
            return Ok(number(0.0));
        };
        let (antecedent, weight) = (&rule.antecedent, rule.weight);
        let strength = self.antecedent(antecedent, block, own)?;
        Ok(if weight < 1.0 {
            let name = format!("rule_{}_weight", own + 1);
            let doc = format!("Weight of rule {}.", own + 1);
            strength * self.configuration.real(&name, &doc, weight)
        } else {
            strength
        })
    }

    fn antecedent(
        &mut self,
        antecedent: &Antecedent,
        block: &RuleBlock,
        own: usize,
    ) -> Result<Expression, Trouble> {
        match antecedent {
            Antecedent::Always => Ok(number(1.0)),
            Antecedent::Is(condition) => self.condition(condition, own),
            Antecedent::Not(part) => Ok(number(1.0) - self.antecedent(part, block, own)?),
            Antecedent::All(all) | Antecedent::Any(all) => {
                let is_and = matches!(antecedent, Antecedent::All(_));
                let mut joined: Option<Expression> = None;
                for part in all {
                    let part = self.antecedent(part, block, own)?;
                    let part = self.operand(part);
                    joined = Some(match joined {
                        None => part,
                        Some(joined) if is_and => {
                            self.library.t_norm::<R>(&block.and, joined, part)?
                        }
                        Some(joined) => self.library.s_norm::<R>(&block.or, joined, part)?,
                    });
                }
                Ok(joined.unwrap_or(number(1.0)))
            }
        }
    }

    /// An operand that is called for has a name first: where calls are written out, as in Structured Text, a function has
    /// one set of values.
    fn operand(&mut self, value: Expression) -> Expression {
        if !matches!(value, Expression::Call(..)) {
            return value;
        }
        self.operands += 1;
        let name = format!("operand_{}", self.operands);
        self.body.push(Statement::real(&name, value));
        local(&name)
    }

    fn condition(&mut self, condition: &Condition, own: usize) -> Result<Expression, Trouble> {
        let Variable::Output(output) = condition.variable else {
            let index = self.conditions.iter().position(|known| known == condition).unwrap_or(0);
            return Ok(at("grades", index));
        };
        let variable = &self.system.parts().outputs[output];
        let grade = match condition.term {
            None => number(1.0),
            Some(_) if !variable.enabled => number(0.0),
            Some(term) => {
                let before = (0..self.conclusions.len()).filter(|&index| {
                    let [rule, concerned, concluded] = self.conclusions[index];
                    rule < own && concerned == output && concluded == term
                });
                let before: Vec<usize> = before.collect();
                let mut joined = number(0.0);
                for index in before {
                    joined = self.library.s_norm::<R>(
                        &variable.aggregation,
                        joined,
                        at("degrees", index),
                    )?;
                }
                joined
            }
        };
        self.library.hedged::<R>(&condition.hedges, grade)
    }

    fn hedges(&self, own: usize) -> Vec<Vec<Hedge>> {
        let blocks = &self.system.parts().blocks;
        let Fired { block, rule } = self.fired[own];
        blocks[block].rules[rule].consequents.iter().map(|it| it.hedges.clone()).collect()
    }

    /// Degrees of what a rule concludes, from its strength.
    fn conclude(&mut self, own: usize, strengths: &str) -> Result<(), Trouble> {
        let first = self.conclusions.iter().position(|[rule, ..]| *rule == own).unwrap_or(0);
        for (index, hedges) in (first..).zip(self.hedges(own)) {
            let strength = || at(strengths, own);
            let degree = match hedges.is_empty() {
                true => strength(),
                false => {
                    // A rule that does not fire concludes nothing, not even `not`.
                    let hedged = self.library.hedged::<R>(&hedges, strength())?;
                    number(0.0).less(strength()).select(hedged, strength())
                }
            };
            self.body.push(put("degrees", index, degree));
        }
        Ok(())
    }

    /// The level of each actor of an output: the degree of its strongest conclusion.
    pub(super) fn levels(&mut self, output: usize) -> Result<(), Trouble> {
        let maximum = SNormKind::Maximum.into();
        for (index, actor) in self.system.actors(output).iter().enumerate() {
            self.body.push(put("levels", index, number(0.0)));
            for &conclusion in &actor.conclusions {
                let degree = at("degrees", conclusion);
                let larger = self.library.s_norm::<R>(&maximum, degree, at("levels", index))?;
                self.body.push(put("levels", index, larger));
            }
        }
        Ok(())
    }
}

/// The number moved between two others.
pub(super) fn clamped(value: Expression, lower: Expression, upper: Expression) -> Expression {
    let above = upper.clone().less(value.clone()).select(upper, value.clone());
    value.less(lower.clone()).select(lower, above)
}

/// What of the rules is asked again and again.
pub(super) struct Rules {
    pub(super) fired: Vec<Fired>,
    pub(super) conditions: Vec<Condition>,
    pub(super) conclusions: Vec<[usize; 3]>,
    pub(super) chained: bool,
}

impl Rules {
    pub(super) fn of(parts: &Parts) -> Self {
        let mut own = Self {
            fired: Vec::new(),
            conditions: Vec::new(),
            conclusions: Vec::new(),
            chained: false,
        };
        for (block, it) in parts.blocks.iter().enumerate().filter(|(_, it)| it.enabled) {
            for (rule, it) in it.rules.iter().enumerate().filter(|(_, it)| it.enabled) {
                own.rule(Fired { block, rule }, it);
            }
        }
        own
    }

    fn rule(&mut self, fired: Fired, rule: &Rule) {
        let own = self.fired.len();
        self.fired.push(fired);
        self.conclusions.extend(rule.consequents.iter().map(|it| [own, it.output, it.term]));
        let mut all = Vec::new();
        collect(&rule.antecedent, &mut all);
        for condition in all {
            let is_input = matches!(condition.variable, Variable::Input(_));
            self.chained |= !is_input;
            if is_input && !self.conditions.contains(condition) {
                self.conditions.push(condition.clone());
            }
        }
    }
}

fn collect<'a>(antecedent: &'a Antecedent, all: &mut Vec<&'a Condition>) {
    match antecedent {
        Antecedent::Always => {}
        Antecedent::Is(condition) => all.push(condition),
        Antecedent::Not(part) => collect(part, all),
        Antecedent::All(parts) | Antecedent::Any(parts) => {
            parts.iter().for_each(|part| collect(part, all));
        }
    }
}

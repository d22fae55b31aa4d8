//! What every value of a program may be: any samples, from any memory that the program itself has written.
//!
//! The program is run with intervals of floats in place of numbers, both ways where both are possible. What it may
//! remember is joined and widened until a step, a hold, taking over and reading the faults add nothing: so it holds for
//! ever. The numbers of the configuration are those of the design.
//!
//! Three things are taken on trust, since intervals do not see them. The exponential of what is not above 0 lies in
//! 0 to 1 (`sweep.c` asks all numbers). The centre of gravity of triangles between ends at ±3 lies between the centres
//! of the outermost halves, at ±8/3, and rounding moves it by less than 0.03. One rule at least is as strong as where two sets cross,
//! so that the area is not below that of an outermost half that is cut there.

mod joined;
mod known;

use std::collections::BTreeMap;

use crate::program::{Argument, Expression, Function, Operator, Part, Place, Program, Statement};
use joined::{bytes, fetched, store, wholes};
use known::Truth;
pub(super) use known::{Known, Range, above, rounded};

/// The centre of gravity in spacings, at most.
const CENTRE: f64 = 2.7;
/// Area under the rules in spacings: at least, where an input is within its range, and at most.
const AREA: [f64; 2] = [0.3, 7.0];

type Members<'p> = BTreeMap<(u8, &'p str), Known>;

/// What is known at a place of the program.
#[derive(Clone, Debug)]
struct Env<'p> {
    locals: BTreeMap<&'p str, Known>,
    members: Members<'p>,
    /// Values that are copies of a member of the sample, which nobody writes.
    copies: BTreeMap<&'p str, &'p str>,
}

/// What is known of expressions, by where they stand in the program.
pub(super) struct Ranges<'p> {
    program: &'p Program,
    seen: BTreeMap<usize, Known>,
    /// Facts are of the last round alone.
    is_quiet: bool,
    /// The area under the rules is kept from being small, also where a change has taken that away.
    keeps_area: bool,
}

/// What a program may remember.
#[derive(Clone, Debug)]
pub(super) struct Memory(BTreeMap<String, Known>, bool);

#[cfg(test)]
impl Memory {
    /// True if a member may be that number.
    pub(super) fn holds(&self, name: &str, value: f64) -> bool {
        matches!(self.0.get(name), Some(Known::Real(it)) if it.low <= value && value <= it.high)
    }
}

type Ends<'p> = Vec<(Env<'p>, Option<Known>)>;

fn joined<K: Ord + Copy>(a: BTreeMap<K, Known>, b: &BTreeMap<K, Known>) -> BTreeMap<K, Known> {
    let both = a.into_iter().filter_map(|(name, it)| b.get(&name).map(|b| (name, it.joined(b))));
    both.collect()
}

fn either<'p>(a: Option<Env<'p>>, b: Option<Env<'p>>) -> Option<Env<'p>> {
    match (a, b) {
        (Some(a), Some(b)) => Some(Env {
            locals: joined(a.locals, &b.locals),
            members: joined(a.members, &b.members),
            copies: a.copies.into_iter().chain(b.copies).collect(),
        }),
        (a, b) => a.or(b),
    }
}

/// What the program may remember, if that could be bounded.
pub(super) fn memory(program: &Program) -> Option<Memory> {
    let keeps_area = program.function("centroid").is_some_and(keeps_area);
    let mut ranges = Ranges { keeps_area, ..Ranges::none(program) };
    let mut state = of_state(&ranges.asked("reset", ranges.outside(None))?);
    for round in 0..600 {
        let start = Memory(state.clone(), ranges.keeps_area);
        let mut grown = state.clone();
        for name in ENTRIES {
            if let Some(after) = ranges.asked(name, ranges.outside(Some(&start))) {
                for (name, known) in of_state(&after) {
                    let before = grown.entry(name).or_insert_with(|| known.clone());
                    *before = before.joined(&known);
                }
            }
        }
        if grown.iter().all(|(name, known)| state.get(name).is_some_and(|it| known.is_within(it))) {
            return Some(start);
        }
        for (name, known) in grown {
            let before = state.entry(name).or_insert_with(|| known.clone());
            *before = if round < 3 { before.joined(&known) } else { before.widened(&known) };
        }
    }
    None
}

/// What others call, but for `reset`.
const ENTRIES: [&str; 4] = ["step", "hold", "track", "faults"];

fn of_state(members: &Members<'_>) -> BTreeMap<String, Known> {
    let state = members.iter().filter(|((part, _), _)| *part == Part::State as u8);
    state.map(|((_, name), known)| ((*name).to_owned(), known.clone())).collect()
}

/// What is known of every expression from such a memory on.
pub(super) fn facts<'p>(program: &'p Program, memory: &Memory) -> Ranges<'p> {
    let mut ranges = Ranges { is_quiet: false, keeps_area: memory.1, ..Ranges::none(program) };
    ranges.asked("reset", ranges.outside(None));
    for name in ENTRIES.into_iter().chain(["saturated"]) {
        ranges.asked(name, ranges.outside(Some(memory)));
    }
    ranges
}

impl<'p> Ranges<'p> {
    /// What is known of an expression of the program, where it is ever computed.
    pub(super) fn of(&self, expression: &Expression) -> Option<&Known> {
        self.seen.get(&std::ptr::from_ref(expression).addr())
    }

    /// Nothing at all.
    pub(super) fn none(program: &'p Program) -> Self {
        Self { program, seen: BTreeMap::new(), is_quiet: true, keeps_area: false }
    }

    fn outside(&self, memory: Option<&Memory>) -> Members<'p> {
        let program = self.program;
        let mut members = Members::new();
        for part in [Part::Configuration, Part::State, Part::Sample, Part::Answer] {
            for member in program.members(part) {
                let remembered = memory.and_then(|it| it.0.get(&member.name)).cloned();
                let known = match part {
                    Part::Configuration => Known::exactly(&member.value, program.precision),
                    Part::State => remembered.unwrap_or_else(|| Known::anything(&member.value)),
                    Part::Sample | Part::Answer => Known::anything(&member.value),
                };
                members.insert((part as u8, member.name.as_str()), known);
            }
        }
        members
    }

    /// The members behind a function that is given anything.
    fn asked(&mut self, name: &str, members: Members<'p>) -> Option<Members<'p>> {
        let function = self.program.function(name)?;
        let given = function.parameters.iter().map(|parameter| match parameter.kind {
            crate::program::Kind::Byte => Known::Byte(None),
            _ => Known::Real(Range::ANY),
        });
        let given = given.collect();
        self.called(function, given, members).0.map(|env| env.members)
    }

    /// What is known behind a call, its values among it, and what it answers.
    fn called(
        &mut self,
        function: &'p Function,
        given: Vec<Known>,
        members: Members<'p>,
    ) -> (Option<Env<'p>>, Option<Known>) {
        let names = function.parameters.iter().map(|parameter| parameter.name);
        let locals = names.zip(given).collect();
        let env = Env { locals, members, copies: BTreeMap::new() };
        let mut ends = Vec::new();
        let last = self.block(function, Some(env), &function.body, &mut ends);
        let answer = ends.iter().filter_map(|(_, answer)| answer.clone());
        let answer = answer.reduce(|a, b| a.joined(&b));
        let env = ends.into_iter().fold(last, |env, (end, _)| either(env, Some(end)));
        (env, answer)
    }

    fn block(
        &mut self,
        function: &'p Function,
        mut env: Option<Env<'p>>,
        body: &'p [Statement],
        ends: &mut Ends<'p>,
    ) -> Option<Env<'p>> {
        for statement in body {
            env = self.statement(function, env?, statement, ends);
        }
        env
    }

    fn statement(
        &mut self,
        function: &'p Function,
        mut env: Env<'p>,
        statement: &'p Statement,
        ends: &mut Ends<'p>,
    ) -> Option<Env<'p>> {
        match statement {
            Statement::Remark(_) => {}
            Statement::Let(name, _, value) => {
                let is_centre = self.keeps_area && function.name == "centroid" && name == "centre";
                if is_centre {
                    env.locals.insert("area", Known::Real(Range::between(AREA[0], AREA[1])));
                }
                let mut known = self.value(&mut env, value);
                if let (true, Known::Real(it)) = (is_centre, &mut known) {
                    *it = it.cut(-CENTRE, CENTRE);
                }
                env.locals.insert(name, known);
                if let Expression::Read(Place::Member(Part::Sample, member)) = value {
                    env.copies.insert(name, member);
                }
            }
            Statement::Array(name, count) => {
                env.locals.insert(name, Known::Reals(vec![Range::point(0.0); *count]));
            }
            Statement::Set(place, value) => {
                let known = self.value(&mut env, value);
                self.put(&mut env, place, known);
            }
            Statement::If(condition, then, otherwise) => {
                let truth = self.truth(&mut env, condition);
                let [held, failed] = [(truth.yes, true), (truth.no, false)].map(|(may, holds)| {
                    let env = may.then(|| env.clone())?;
                    self.assumed(env, condition, holds)
                });
                let held = self.block(function, held, then, ends);
                let failed = self.block(function, failed, otherwise, ends);
                return either(held, failed);
            }
            Statement::For(name, first, last, body) => {
                let mut now = Some(env);
                for index in *first..=*last {
                    now.as_mut()?.locals.insert(name, Known::Whole([index, index]));
                    now = self.block(function, now, body, ends);
                }
                return now;
            }
            Statement::Call(name, given) => {
                self.call(&mut env, name, given)?;
            }
            Statement::Return(value) => {
                let answer = value.as_ref().map(|value| self.value(&mut env, value));
                ends.push((env, answer));
                return None;
            }
        }
        Some(env)
    }

    /// What a call answers, if it comes back; what it did is in the environment.
    fn call(
        &mut self,
        env: &mut Env<'p>,
        name: &str,
        given: &'p [Argument],
    ) -> Option<Option<Known>> {
        let function = self.program.function(name)?;
        let values = given.iter().map(|argument| match argument {
            Argument::Value(value) => self.value(env, value),
            Argument::Array(array) => {
                env.locals.get(array.as_str()).cloned().unwrap_or(Known::Truth(Truth::ANY))
            }
        });
        let values: Vec<Known> = values.collect();
        let is_power = function.name == "exponential"
            && matches!(values.first(), Some(Known::Real(it)) if it.high <= 0.0 && !it.nan);
        let (after, answer) = self.called(function, values, std::mem::take(&mut env.members));
        let after = after?;
        for (argument, parameter) in given.iter().zip(&function.parameters) {
            if let Argument::Array(array) = argument
                && let Some(written) = after.locals.get(parameter.name)
            {
                env.locals.insert(array, written.clone());
            }
        }
        env.members = after.members;
        let power = || Known::Real(Range::between(0.0, 1.0));
        Some(if is_power { Some(power()) } else { answer })
    }

    fn put(&mut self, env: &mut Env<'p>, place: &'p Place, known: Known) {
        match place {
            Place::Local(name) => {
                env.copies.remove(name.as_str());
                env.locals.insert(name, known);
            }
            Place::Member(part, name) => {
                env.members.insert((*part as u8, name), known);
            }
            Place::Element(name, index) => {
                let index = self.value(env, index);
                store(env.locals.get_mut(name.as_str()), &index, known);
            }
            Place::MemberElement(part, name, index) => {
                let index = self.value(env, index);
                store(env.members.get_mut(&(*part as u8, name.as_str())), &index, known);
            }
        }
    }

    fn read(&mut self, env: &mut Env<'p>, place: &'p Place) -> Known {
        let unknown = || Known::Real(Range::ANY);
        match place {
            Place::Local(name) => env.locals.get(name.as_str()).cloned().unwrap_or_else(unknown),
            Place::Member(part, name) => {
                env.members.get(&(*part as u8, name.as_str())).cloned().unwrap_or_else(unknown)
            }
            Place::Element(name, index) => {
                let index = self.value(env, index);
                fetched(env.locals.get(name.as_str()), &index)
            }
            Place::MemberElement(part, name, index) => {
                let index = self.value(env, index);
                fetched(env.members.get(&(*part as u8, name.as_str())), &index)
            }
        }
    }

    fn truth(&mut self, env: &mut Env<'p>, value: &'p Expression) -> Truth {
        match self.value(env, value) {
            Known::Truth(truth) => truth,
            _ => Truth::ANY,
        }
    }

    fn real(&mut self, env: &mut Env<'p>, value: &'p Expression) -> Range {
        match self.value(env, value) {
            Known::Real(range) => range,
            _ => Range::ANY,
        }
    }

    fn value(&mut self, env: &mut Env<'p>, value: &'p Expression) -> Known {
        let known = self.computed(env, value);
        if !self.is_quiet {
            let place = self.seen.entry(std::ptr::from_ref(value).addr());
            place.and_modify(|it| *it = it.joined(&known)).or_insert_with(|| known.clone());
        }
        known
    }

    fn computed(&mut self, env: &mut Env<'p>, value: &'p Expression) -> Known {
        let precision = self.program.precision;
        match value {
            Expression::Number(value) => Known::Real(Range::point(rounded(precision, *value))),
            Expression::Whole(value) => Known::Whole([*value, *value]),
            Expression::Byte(value) => Known::Byte(Some(*value)),
            Expression::Truth(value) => Known::Truth(Truth::of(*value)),
            Expression::Read(place) => self.read(env, place),
            Expression::Negative(value) => Known::Real(self.real(env, value).negative()),
            Expression::Magnitude(value) => Known::Real(self.real(env, value).magnitude()),
            Expression::Not(value) => Known::Truth(self.truth(env, value).negated()),
            Expression::Binary(operator, left, right) => self.binary(env, *operator, left, right),
            Expression::Select(condition, then, otherwise) => {
                let truth = self.truth(env, condition);
                let ways = [(truth.yes, true, then), (truth.no, false, otherwise)];
                let ways = ways.map(|(may, holds, way)| {
                    let mut env = self.assumed(may.then(|| env.clone())?, condition, holds)?;
                    Some(self.value(&mut env, way))
                });
                let known = ways.into_iter().flatten().reduce(|a, b| a.joined(&b));
                known.unwrap_or(Known::Real(Range::ANY))
            }
            Expression::ToReal(value) => match self.value(env, value) {
                Known::Whole([low, high]) => {
                    Known::Real(Range::between(f64::from(low), f64::from(high)))
                }
                _ => Known::Real(Range::ANY),
            },
            Expression::PowerOfTwo(value) => {
                let Range { low, high, nan, .. } = self.real(env, value);
                Known::Real(Range { nan, ..Range::between(low.exp2(), high.exp2()) })
            }
            Expression::Call(name, given) => {
                let answer = self.call(env, name, given).flatten();
                answer.unwrap_or(Known::Real(Range::ANY))
            }
        }
    }

    fn binary(
        &mut self,
        env: &mut Env<'p>,
        operator: Operator,
        left: &'p Expression,
        right: &'p Expression,
    ) -> Known {
        let precision = self.program.precision;
        if matches!(operator, Operator::And | Operator::Or) {
            return Known::Truth(self.both(env, operator == Operator::And, left, right));
        }
        let same = left == right;
        match (self.value(env, left), self.value(env, right)) {
            (Known::Real(a), Known::Real(b)) => match operator {
                Operator::Less => Known::Truth(a.less(b, false)),
                Operator::LessOrEqual => Known::Truth(a.less(b, true)),
                Operator::Equal | Operator::NotEqual => Known::Truth(Truth::ANY),
                Operator::Multiply if same => Known::Real(a.squared(precision)),
                Operator::Subtract if same && a.is_finite() => Known::Real(Range::point(0.0)),
                _ => Known::Real(a.computed(operator, b, precision)),
            },
            (Known::Whole(a), Known::Whole(b)) => wholes(operator, a, b),
            (Known::Byte(a), Known::Byte(b)) => bytes(operator, a, b),
            _ => Known::Truth(Truth::ANY),
        }
    }

    fn both(
        &mut self,
        env: &mut Env<'p>,
        and: bool,
        left: &'p Expression,
        right: &'p Expression,
    ) -> Truth {
        let first = self.truth(env, left);
        // The second is asked only where it matters.
        let asked = if and { first.yes } else { first.no };
        let after = asked.then(|| env.clone()).and_then(|env| self.assumed(env, left, and));
        let Some(mut after) = after else { return Truth::of(!and) };
        let second = self.truth(&mut after, right);
        if and {
            Truth { yes: second.yes, no: first.no || second.no }
        } else {
            Truth { yes: first.yes || second.yes, no: second.no }
        }
    }

    /// What is known where a condition holds, or does not; none where that cannot be.
    fn assumed(
        &mut self,
        mut env: Env<'p>,
        condition: &'p Expression,
        holds: bool,
    ) -> Option<Env<'p>> {
        match condition {
            Expression::Not(inner) => return self.assumed(env, inner, !holds),
            Expression::Binary(Operator::And, left, right) if holds => {
                let env = self.assumed(env, left, true)?;
                return self.assumed(env, right, true);
            }
            Expression::Binary(Operator::Or, left, right) if !holds => {
                let env = self.assumed(env, left, false)?;
                return self.assumed(env, right, false);
            }
            Expression::Read(place) => {
                if let Some(known @ Known::Truth(_)) = slot(&mut env, place) {
                    *known = Known::Truth(Truth::of(holds));
                }
            }
            Expression::Binary(Operator::Equal, left, right) if holds => {
                if let (Expression::Read(place), Expression::Byte(byte)) = (&**left, &**right)
                    && let Some(known @ Known::Byte(_)) = slot(&mut env, place)
                {
                    *known = Known::Byte(Some(*byte));
                }
            }
            Expression::Binary(Operator::Less, left, right) => {
                self.ordered(&mut env, [left, right], true, holds);
            }
            Expression::Binary(Operator::LessOrEqual, left, right) => {
                self.ordered(&mut env, [left, right], false, holds);
            }
            _ => {}
        }
        Some(env)
    }

    /// What a comparison says of both of its sides.
    fn ordered(
        &mut self,
        env: &mut Env<'p>,
        sides: [&'p Expression; 2],
        strict: bool,
        holds: bool,
    ) {
        let precision = self.program.precision;
        let was_quiet = std::mem::replace(&mut self.is_quiet, true);
        let [left, right] = sides.map(|side| self.real(env, side));
        self.is_quiet = was_quiet;
        let below = |it: f64| -above(precision, -it);
        if holds {
            let most = if strict { below(right.high) } else { right.high };
            let least = if strict { above(precision, left.low) } else { left.low };
            narrow(env, sides[0], |it| it.cut(f64::NEG_INFINITY, most));
            narrow(env, sides[1], |it| it.cut(least, f64::INFINITY));
        } else if !left.nan && !right.nan {
            let least = if strict { right.low } else { above(precision, right.low) };
            let most = if strict { left.high } else { below(left.high) };
            narrow_plain(env, sides[0], |it| it.cut(least, f64::INFINITY));
            narrow_plain(env, sides[1], |it| it.cut(f64::NEG_INFINITY, most));
        }
    }
}

/// Narrows what is read, also through a magnitude, which is only ever bounded from above.
fn narrow<'p>(env: &mut Env<'p>, side: &'p Expression, cut: impl Fn(Range) -> Range) {
    if let Expression::Magnitude(inner) = side {
        let most = cut(Range::ANY).high;
        return narrow_plain(env, inner, |it| it.cut(-most, most));
    }
    narrow_plain(env, side, cut);
}

fn narrow_plain<'p>(env: &mut Env<'p>, side: &'p Expression, cut: impl Fn(Range) -> Range) {
    let Expression::Read(place) = side else { return };
    let copied = match place {
        Place::Local(name) => env.copies.get(name.as_str()).copied(),
        _ => None,
    };
    let of = copied.and_then(|it| env.members.get_mut(&(Part::Sample as u8, it)));
    if let Some(Known::Real(known)) = of {
        *known = cut(*known);
    }
    if let Some(Known::Real(known)) = slot(env, place) {
        let narrowed = cut(*known);
        if narrowed.low <= narrowed.high {
            *known = narrowed;
        }
    }
}

fn slot<'a, 'p>(env: &'a mut Env<'p>, place: &'p Place) -> Option<&'a mut Known> {
    match place {
        Place::Local(name) => env.locals.get_mut(name.as_str()),
        Place::Member(part, name) => env.members.get_mut(&(*part as u8, name.as_str())),
        Place::Element(..) | Place::MemberElement(..) => None,
    }
}

/// True for the centre of gravity in closed form whose area is kept from being small.
fn keeps_area(function: &Function) -> bool {
    let over_gaps = |it: &Statement| matches!(it, Statement::For(name, ..) if name == "gap");
    let is_kept = |it: &Statement| match it {
        Statement::Let(name, _, Expression::Binary(Operator::Divide, _, area)) => {
            name == "centre" && matches!(**area, Expression::Select(..))
        }
        _ => false,
    };
    function.body.iter().any(over_gaps) && function.body.iter().any(is_kept)
}

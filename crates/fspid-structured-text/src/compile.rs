//! From what a text says to what can run: names become slots, types are held against each other.

use crate::code::{Act, Action, Code, Element, Home, Known, Node, Slot};
use crate::problem::{Mistake, Problem};
use crate::syntax::{
    Expression, Function, Operator, Place, Section, Shape, Statement, Unit, Variable, What,
};
use crate::value::{Kind, Value};

/// All units; one may hold instances of those that stand before it.
pub(crate) fn compile(units: &[Unit]) -> Result<Vec<Code>, Problem> {
    let mut codes: Vec<Code> = Vec::new();
    for unit in units {
        if codes.iter().any(|known| known.name == unit.name) {
            return Err(Mistake::Twice(unit.name.clone()).at(0));
        }
        let mut compiler = Compiler { codes: &codes, variables: Vec::new(), counters: Vec::new() };
        codes.push(compiler.unit(unit)?);
    }
    Ok(codes)
}

struct Compiler<'a> {
    codes: &'a [Code],
    variables: Vec<Known>,
    /// Counters of the loops that are open; nothing else may write to them.
    counters: Vec<usize>,
}

type Compiled<T> = Result<T, Mistake>;

impl Compiler<'_> {
    fn unit(&mut self, unit: &Unit) -> Result<Code, Problem> {
        let mut code = Code {
            name: unit.name.clone(),
            variables: Vec::new(),
            first: Vec::new(),
            temporary: 0,
            instances: Vec::new(),
            body: Vec::new(),
        };
        let is_temporary = |variable: &&Variable| variable.section == Section::Temporary;
        let (temporary, kept): (Vec<_>, Vec<_>) = unit.variables.iter().partition(is_temporary);
        for variable in &kept {
            self.declare(variable, &mut code).map_err(|it| it.at(variable.line))?;
        }
        code.temporary = code.first.len();
        for variable in &temporary {
            self.declare(variable, &mut code).map_err(|it| it.at(variable.line))?;
        }
        code.first.iter_mut().skip(code.temporary).for_each(|slot| *slot = None);
        code.body = self.body(&unit.body)?;
        code.variables = std::mem::take(&mut self.variables);
        Ok(code)
    }

    fn declare(&mut self, variable: &Variable, code: &mut Code) -> Compiled<()> {
        let Variable { name, section, shape, first, .. } = variable;
        let is_unit = self.codes.iter().any(|unit| unit.name == *name) || code.name == *name;
        if is_unit || self.variables.iter().any(|known| known.name == *name) {
            return Err(Mistake::Twice(name.clone()));
        }
        let base = code.first.len();
        let home = match shape {
            Shape::One(kind) => {
                code.first.extend(begun(name, *kind, 1, first)?);
                Home::Slot(base, *kind)
            }
            Shape::List(kind, count) => {
                code.first.extend(begun(name, *kind, *count, first)?);
                Home::Slots { base, count: *count, kind: *kind }
            }
            Shape::Instance(unit) => {
                let known = self.codes.iter().position(|code| code.name == *unit);
                let unit = known.ok_or_else(|| Mistake::Undeclared(unit.clone()))?;
                code.instances.push(unit);
                Home::Instance(code.instances.len() - 1, unit)
            }
        };
        self.variables.push(Known { name: name.clone(), section: *section, home });
        Ok(())
    }

    fn known(&self, name: &str) -> Compiled<&Known> {
        let known = self.variables.iter().find(|known| known.name == name);
        known.ok_or_else(|| Mistake::Undeclared(name.to_owned()))
    }

    fn body(&mut self, body: &[Statement]) -> Result<Vec<Action>, Problem> {
        let mut actions = Vec::new();
        for Statement { line, what } in body {
            let at = |mistake: Mistake| mistake.at(*line);
            let act = match what {
                What::Return => Act::Return,
                What::Assign(place, value) => self.assigned(place, value).map_err(at)?,
                What::Call(name, inputs) => self.called(name, inputs).map_err(at)?,
                What::If(condition, then, otherwise) => {
                    let condition = self.of_kind(condition, Kind::Bool).map_err(at)?;
                    Act::If(condition, self.body(then)?, self.body(otherwise)?)
                }
                What::For(name, first, last, body) => {
                    let slot = self.counter(name).map_err(at)?;
                    self.counters.push(slot);
                    let body = self.body(body)?;
                    self.counters.pop();
                    Act::For(slot, *first, *last, body)
                }
            };
            actions.push(Action { line: *line, act });
        }
        Ok(actions)
    }

    fn counter(&self, name: &str) -> Compiled<usize> {
        match self.writable(name)?.home {
            Home::Slot(slot, Kind::Dint) => Ok(slot),
            Home::Slot(_, kind) => Err(Mistake::Type(Kind::Dint, kind)),
            _ => Err(Mistake::Use(name.to_owned())),
        }
    }

    fn writable(&self, name: &str) -> Compiled<&Known> {
        let known = self.known(name)?;
        let is_counter = matches!(known.home, Home::Slot(slot, _) if self.counters.contains(&slot));
        if is_counter || matches!(known.section, Section::Input | Section::Constant) {
            return Err(Mistake::ReadOnly(name.to_owned()));
        }
        Ok(known)
    }

    fn assigned(&self, place: &Place, value: &Expression) -> Compiled<Act> {
        match place {
            Place::One(name) => match self.writable(name)?.home {
                Home::Slot(slot, kind) => Ok(Act::Set(slot, self.of_kind(value, kind)?)),
                _ => Err(Mistake::Use(name.clone())),
            },
            Place::Element(name, index) => {
                self.writable(name)?;
                let (element, kind) = self.element(name, index)?;
                Ok(Act::SetElement(element, self.of_kind(value, kind)?))
            }
            Place::Member(name, _) => Err(Mistake::ReadOnly(name.clone())),
        }
    }

    fn called(&self, name: &str, inputs: &[(String, Expression)]) -> Compiled<Act> {
        let Home::Instance(instance, unit) = self.known(name)?.home else {
            return Err(Mistake::Use(name.to_owned()));
        };
        let variables = &self.codes[unit].variables;
        let mut given = Vec::new();
        for Known { name: input, home, .. } in
            variables.iter().filter(|known| known.section == Section::Input)
        {
            let mut values = inputs.iter().filter(|(name, _)| name == input);
            match (home, values.next(), values.next()) {
                (Home::Slot(slot, kind), Some((_, value)), None) => {
                    given.push((*slot, self.of_kind(value, *kind)?));
                }
                _ => return Err(Mistake::Inputs(name.to_owned())),
            }
        }
        if given.len() != inputs.len() {
            return Err(Mistake::Inputs(name.to_owned()));
        }
        Ok(Act::Call(instance, unit, given))
    }

    fn element(&self, name: &str, index: &Expression) -> Compiled<(Element, Kind)> {
        let Home::Slots { base, count, kind } = self.known(name)?.home else {
            return Err(Mistake::Use(name.to_owned()));
        };
        let index = self.of_kind(index, Kind::Dint)?;
        Ok((Element { name: name.to_owned(), base, count, index }, kind))
    }

    fn of_kind(&self, value: &Expression, kind: Kind) -> Compiled<Node> {
        let (node, found) = self.value(value)?;
        if found == kind { Ok(node) } else { Err(Mistake::Type(kind, found)) }
    }

    fn value(&self, value: &Expression) -> Compiled<(Node, Kind)> {
        match value {
            Expression::Literal(value) => Ok((Node::Literal(*value), value.kind())),
            Expression::Read(place) => self.read(place),
            Expression::Not(of) => {
                Ok((Node::Not(Box::new(self.of_kind(of, Kind::Bool)?)), Kind::Bool))
            }
            Expression::Negative(of) => match self.value(of)? {
                (node, kind @ (Kind::Real | Kind::Lreal)) => {
                    Ok((Node::Negative(Box::new(node)), kind))
                }
                (_, kind) => Err(Mistake::Operation(kind, "-")),
            },
            Expression::Function(function, of) => self.function(*function, of),
            Expression::Binary(operator, left, right) => {
                let (left, kind) = self.value(left)?;
                let right = self.of_kind(right, kind)?;
                let answers = answered(*operator, kind)?;
                Ok((Node::Binary(*operator, Box::new(left), Box::new(right)), answers))
            }
        }
    }

    fn read(&self, place: &Place) -> Compiled<(Node, Kind)> {
        match place {
            Place::One(name) => match self.known(name)?.home {
                Home::Slot(slot, kind) => Ok((Node::Slot(slot, name.clone()), kind)),
                _ => Err(Mistake::Use(name.clone())),
            },
            Place::Element(name, index) => {
                let (element, kind) = self.element(name, index)?;
                Ok((Node::Element(Box::new(element)), kind))
            }
            Place::Member(name, member) => {
                let Home::Instance(instance, unit) = self.known(name)?.home else {
                    return Err(Mistake::Use(name.clone()));
                };
                let mut outputs = self.codes[unit].variables.iter();
                let output = outputs.find(|it| it.section == Section::Output && it.name == *member);
                match output.map(|known| known.home) {
                    Some(Home::Slot(slot, kind)) => Ok((Node::Member(instance, slot), kind)),
                    _ => Err(Mistake::Undeclared(format!("{name}.{member}"))),
                }
            }
        }
    }

    fn function(&self, function: Function, of: &Expression) -> Compiled<(Node, Kind)> {
        let (node, kind) = self.value(of)?;
        let node = Box::new(node);
        let from =
            |wanted: Kind| if kind == wanted { Ok(()) } else { Err(Mistake::Type(wanted, kind)) };
        match function {
            Function::Abs if matches!(kind, Kind::Real | Kind::Lreal) => {
                Ok((Node::Magnitude(node), kind))
            }
            Function::Abs => Err(Mistake::Operation(kind, "ABS")),
            Function::UsintToDint => from(Kind::Usint).map(|()| (Node::Whole(node), Kind::Dint)),
            Function::DintToReal => from(Kind::Dint).map(|()| (Node::ToReal(node), Kind::Real)),
            Function::DintToLreal => from(Kind::Dint).map(|()| (Node::ToLreal(node), Kind::Lreal)),
        }
    }
}

/// The type that an operation on two values of a type answers.
fn answered(operator: Operator, kind: Kind) -> Compiled<Kind> {
    let is_real = matches!(kind, Kind::Real | Kind::Lreal);
    let (is_possible, answers) = match operator {
        Operator::Add | Operator::Subtract | Operator::Multiply => {
            (is_real || kind == Kind::Dint, kind)
        }
        Operator::Divide => (is_real, kind),
        Operator::Less | Operator::LessOrEqual => (is_real || kind == Kind::Dint, Kind::Bool),
        Operator::Equal | Operator::NotEqual => (kind != Kind::Usint, Kind::Bool),
        Operator::And | Operator::Or => (matches!(kind, Kind::Bool | Kind::Byte), kind),
    };
    if is_possible { Ok(answers) } else { Err(Mistake::Operation(kind, operator.sign())) }
}

/// The slots of a variable as they begin.
fn begun(name: &str, kind: Kind, count: usize, first: &[Value]) -> Compiled<Vec<Slot>> {
    if let Some(other) = first.iter().find(|value| value.kind() != kind) {
        return Err(Mistake::Type(kind, other.kind()));
    }
    match first.len() {
        0 => Ok(vec![Some(kind.zero()); count]),
        given if given == count => Ok(first.iter().copied().map(Some).collect()),
        given => Err(Mistake::Length(name.to_owned(), count, given)),
    }
}

//! Units whose names are resolved and whose types agree, and how they run.

use crate::problem::{Mistake, Problem};
use crate::syntax::{Operator, Section};
use crate::value::{Kind, Value};

/// A unit that can run.
#[derive(Clone, Debug)]
pub(crate) struct Code {
    pub(crate) name: String,
    pub(crate) variables: Vec<Known>,
    /// What the slots hold before the first call; nothing in those of temporary variables.
    pub(crate) first: Vec<Slot>,
    /// From where on slots are temporary: they lie behind all others.
    pub(crate) temporary: usize,
    /// Which units its instances are of.
    pub(crate) instances: Vec<usize>,
    pub(crate) body: Vec<Action>,
}

/// A declared variable.
#[derive(Clone, Debug)]
pub(crate) struct Known {
    pub(crate) name: String,
    pub(crate) section: Section,
    pub(crate) home: Home,
}

/// Where a variable lives.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Home {
    Slot(usize, Kind),
    Slots {
        base: usize,
        count: usize,
        kind: Kind,
    },
    /// A place in the list of instances, and its unit.
    Instance(usize, usize),
}

pub(crate) type Slot = Option<Value>;

/// What one instance remembers.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    pub(crate) slots: Vec<Slot>,
    pub(crate) instances: Vec<Frame>,
}

impl Frame {
    pub(crate) fn new(codes: &[Code], code: &Code) -> Self {
        let instances = code.instances.iter().filter_map(|unit| codes.get(*unit));
        Self {
            slots: code.first.clone(),
            instances: instances.map(|code| Self::new(codes, code)).collect(),
        }
    }
}

/// A part of a list, checked while it runs.
#[derive(Clone, Debug)]
pub(crate) struct Element {
    pub(crate) name: String,
    pub(crate) base: usize,
    pub(crate) count: usize,
    pub(crate) index: Node,
}

#[derive(Clone, Debug)]
pub(crate) struct Action {
    pub(crate) line: usize,
    pub(crate) act: Act,
}

#[derive(Clone, Debug)]
pub(crate) enum Act {
    Set(usize, Node),
    SetElement(Element, Node),
    If(Node, Vec<Action>, Vec<Action>),
    For(usize, i32, i32, Vec<Action>),
    /// An instance, its unit, and what goes into its slots.
    Call(usize, usize, Vec<(usize, Node)>),
    Return,
}

#[derive(Clone, Debug)]
pub(crate) enum Node {
    Literal(Value),
    /// A slot, and what it is called.
    Slot(usize, String),
    Element(Box<Element>),
    Member(usize, usize),
    Negative(Box<Node>),
    Not(Box<Node>),
    Magnitude(Box<Node>),
    Whole(Box<Node>),
    ToReal(Box<Node>),
    ToLreal(Box<Node>),
    Binary(Operator, Box<Node>, Box<Node>),
}

/// Whether the statements behind go on.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Flow {
    On,
    Ended,
}

impl Code {
    /// One call of an instance.
    pub(crate) fn run(&self, codes: &[Self], frame: &mut Frame) -> Result<(), Problem> {
        let result = run(&self.body, codes, frame);
        // What is temporary is forgotten between calls.
        frame.slots.iter_mut().skip(self.temporary).for_each(|slot| *slot = None);
        result.map(|_| ())
    }
}

fn run(body: &[Action], codes: &[Code], frame: &mut Frame) -> Result<Flow, Problem> {
    for Action { line, act } in body {
        let at = |mistake: Mistake| mistake.at(*line);
        match act {
            Act::Set(slot, value) => {
                let value = value.of(frame).map_err(at)?;
                put(frame, *slot, value);
            }
            Act::SetElement(element, value) => {
                let value = value.of(frame).map_err(at)?;
                let slot = element.slot(frame).map_err(at)?;
                put(frame, slot, value);
            }
            Act::If(condition, then, otherwise) => {
                let holds = condition.of(frame).map_err(at)? == Value::Bool(true);
                if run(if holds { then } else { otherwise }, codes, frame)? == Flow::Ended {
                    return Ok(Flow::Ended);
                }
            }
            Act::For(slot, first, last, body) => {
                for index in *first..=*last {
                    put(frame, *slot, Value::Dint(index));
                    if run(body, codes, frame)? == Flow::Ended {
                        return Ok(Flow::Ended);
                    }
                }
                // What a counter holds behind its loop differs from compiler to compiler.
                frame.slots[*slot] = None;
            }
            Act::Call(instance, unit, inputs) => {
                call(frame, codes, *instance, *unit, inputs, *line)?
            }
            Act::Return => return Ok(Flow::Ended),
        }
    }
    Ok(Flow::On)
}

fn put(frame: &mut Frame, slot: usize, value: Value) {
    frame.slots[slot] = Some(value);
}

fn call(
    frame: &mut Frame,
    codes: &[Code],
    instance: usize,
    unit: usize,
    inputs: &[(usize, Node)],
    line: usize,
) -> Result<(), Problem> {
    for (slot, value) in inputs {
        let value = value.of(frame).map_err(|mistake| mistake.at(line))?;
        put(&mut frame.instances[instance], *slot, value);
    }
    codes[unit].run(codes, &mut frame.instances[instance])
}

impl Element {
    fn slot(&self, frame: &Frame) -> Result<usize, Mistake> {
        let Value::Dint(index) = self.index.of(frame)? else { return Err(Mistake::Overflow) };
        match usize::try_from(index) {
            Ok(place) if place < self.count => Ok(self.base + place),
            _ => Err(Mistake::Index(self.name.clone(), index, self.count - 1)),
        }
    }
}

impl Node {
    fn of(&self, frame: &Frame) -> Result<Value, Mistake> {
        let read = |slot: usize, name: &String| {
            frame.slots[slot].ok_or_else(|| Mistake::Unset(name.clone()))
        };
        Ok(match self {
            Self::Literal(value) => *value,
            Self::Slot(slot, name) => read(*slot, name)?,
            Self::Element(element) => read(element.slot(frame)?, &element.name)?,
            Self::Member(instance, slot) => {
                frame.instances[*instance].slots[*slot].unwrap_or(Value::Bool(false))
            }
            Self::Binary(operator, left, right) => {
                return joined(*operator, left.of(frame)?, right.of(frame)?);
            }
            Self::Negative(of) => match of.of(frame)? {
                Value::Real(value) => Value::Real(-value),
                Value::Lreal(value) => Value::Lreal(-value),
                other => other,
            },
            Self::Not(of) => match of.of(frame)? {
                Value::Bool(value) => Value::Bool(!value),
                other => other,
            },
            // As a compiler may write it: a negative zero stays one.
            Self::Magnitude(of) => match of.of(frame)? {
                Value::Real(value) => Value::Real(if value < 0.0 { -value } else { value }),
                Value::Lreal(value) => Value::Lreal(if value < 0.0 { -value } else { value }),
                other => other,
            },
            Self::Whole(of) => match of.of(frame)? {
                Value::Usint(value) => Value::Dint(i32::from(value)),
                other => other,
            },
            #[allow(clippy::cast_precision_loss, reason = "to the nearest, as the language says")]
            Self::ToReal(of) => match of.of(frame)? {
                Value::Dint(value) => Value::Real(value as f32),
                other => other,
            },
            Self::ToLreal(of) => match of.of(frame)? {
                Value::Dint(value) => Value::Lreal(f64::from(value)),
                other => other,
            },
        })
    }
}

/// Both of one type, which has the operation: that was seen to before.
fn joined(operator: Operator, left: Value, right: Value) -> Result<Value, Mistake> {
    match (left, right) {
        (Value::Real(left), Value::Real(right)) => Ok(match operator {
            Operator::Add => Value::Real(left + right),
            Operator::Subtract => Value::Real(left - right),
            Operator::Multiply => Value::Real(left * right),
            Operator::Divide => Value::Real(left / right),
            other => compared(other, &left, &right),
        }),
        (Value::Lreal(left), Value::Lreal(right)) => Ok(match operator {
            Operator::Add => Value::Lreal(left + right),
            Operator::Subtract => Value::Lreal(left - right),
            Operator::Multiply => Value::Lreal(left * right),
            Operator::Divide => Value::Lreal(left / right),
            other => compared(other, &left, &right),
        }),
        (Value::Dint(left), Value::Dint(right)) => {
            let whole = match operator {
                Operator::Add => left.checked_add(right),
                Operator::Subtract => left.checked_sub(right),
                Operator::Multiply => left.checked_mul(right),
                other => return Ok(compared(other, &left, &right)),
            };
            whole.map(Value::Dint).ok_or(Mistake::Overflow)
        }
        (Value::Byte(left), Value::Byte(right)) => Ok(match operator {
            Operator::And => Value::Byte(left & right),
            Operator::Or => Value::Byte(left | right),
            other => compared(other, &left, &right),
        }),
        (Value::Bool(left), Value::Bool(right)) => Ok(Value::Bool(match operator {
            Operator::And => left && right,
            Operator::Or => left || right,
            Operator::Equal => left == right,
            _ => left != right,
        })),
        (left, right) => Err(Mistake::Type(left.kind(), right.kind())),
    }
}

fn compared<T: PartialOrd>(operator: Operator, left: &T, right: &T) -> Value {
    Value::Bool(match operator {
        Operator::Less => left < right,
        Operator::LessOrEqual => left <= right,
        Operator::Equal => left == right,
        _ => left != right,
    })
}

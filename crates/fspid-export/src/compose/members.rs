//! The configuration as it is collected.

use crate::program::{Expression, Member, Part, Value, member};
use crate::trace::Traced;

/// Members of the configuration, each once.
#[derive(Default)]
pub(crate) struct Configuration {
    members: Vec<Member>,
}

impl Configuration {
    /// The members in the order in which they were named.
    pub(crate) fn members(self) -> Vec<Member> {
        self.members
    }

    /// A member of that name; another one with the same name must hold the same.
    pub(crate) fn add(&mut self, name: &str, doc: &str, value: Value) -> Expression {
        match self.members.iter().find(|known| known.name == name) {
            Some(known) => debug_assert_eq!(known.value, value, "two members are called {name}"),
            None => self.members.push(Member { name: name.to_owned(), doc: doc.to_owned(), value }),
        }
        member(Part::Configuration, name)
    }

    /// A real.
    pub(crate) fn real(&mut self, name: &str, doc: &str, value: f64) -> Expression {
        self.add(name, doc, Value::Real(value))
    }

    /// A number of an equation; an infinite one does nothing and is no member.
    pub(crate) fn traced(&mut self, name: &str, doc: &str, value: f64) -> Traced {
        if value.is_infinite() {
            return Traced::configured(value, Expression::Number(0.0));
        }
        let read = self.real(name, doc.replace('`', "").trim(), value);
        Traced::configured(value, read)
    }
}

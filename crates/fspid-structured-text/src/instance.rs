//! Units by their names, and instances of them.

use crate::code::{Code, Frame, Home, Known};
use crate::compile::compile;
use crate::parser::parse;
use crate::problem::{Mistake, Problem};
use crate::syntax::Section;
use crate::value::{Kind, Value};

/// The function blocks and programs of a text.
#[derive(Clone, Debug)]
pub struct Library {
    codes: Vec<Code>,
}

impl Library {
    /// Reads a text; several files one behind the other are one text.
    ///
    /// # Errors
    /// [`Problem`] with the first mistake and its line.
    pub fn read(text: &str) -> Result<Self, Problem> {
        Ok(Self { codes: compile(&parse(text)?)? })
    }

    /// The names of its function blocks and programs in their order, in capitals.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.codes.iter().map(|code| code.name.as_str())
    }

    /// A new instance of a function block or program, in any case of its letters.
    ///
    /// # Errors
    /// [`Mistake::Undeclared`] if there is none of that name.
    pub fn instance(&self, name: &str) -> Result<Instance<'_>, Problem> {
        let wanted = name.to_ascii_uppercase();
        let code = self.codes.iter().find(|code| code.name == wanted);
        let code = code.ok_or_else(|| Mistake::Undeclared(wanted).at(0))?;
        Ok(Instance { codes: &self.codes, code, frame: Frame::new(&self.codes, code) })
    }
}

/// An instance with its memory.
#[derive(Clone, Debug)]
pub struct Instance<'a> {
    codes: &'a [Code],
    code: &'a Code,
    frame: Frame,
}

impl Instance<'_> {
    /// Puts a value into an input, or, as a person at a PLC may, into a variable that it keeps.
    ///
    /// # Errors
    /// [`Mistake::Undeclared`] or [`Mistake::Type`] if it has no such variable.
    pub fn set(&mut self, name: &str, value: Value) -> Result<(), Problem> {
        match self.slot(name, &[Section::Input, Section::Kept])? {
            (slot, kind) if kind == value.kind() => {
                self.frame.slots[slot] = Some(value);
                Ok(())
            }
            (_, kind) => Err(Mistake::Type(kind, value.kind()).at(0)),
        }
    }

    /// The type of a variable.
    ///
    /// # Errors
    /// [`Mistake::Undeclared`] if it has no such variable.
    pub fn kind(&self, name: &str) -> Result<Kind, Problem> {
        self.slot(name, &[]).map(|(_, kind)| kind)
    }

    /// What a variable holds.
    ///
    /// # Errors
    /// [`Mistake::Undeclared`] if it has no such variable, [`Mistake::Unset`] if that is a temporary one.
    pub fn get(&self, name: &str) -> Result<Value, Problem> {
        let (slot, _) = self.slot(name, &[])?;
        self.frame.slots[slot].ok_or_else(|| Mistake::Unset(name.to_owned()).at(0))
    }

    /// Runs its body once.
    ///
    /// # Errors
    /// [`Problem`] with what a PLC would not have survived, or not alike: an index outside of its list, a value that
    /// was never written.
    pub fn call(&mut self) -> Result<(), Problem> {
        self.code.run(self.codes, &mut self.frame)
    }

    fn slot(&self, name: &str, sections: &[Section]) -> Result<(usize, Kind), Problem> {
        let wanted = name.to_ascii_uppercase();
        let is_meant = |known: &&Known| {
            known.name == wanted && (sections.is_empty() || sections.contains(&known.section))
        };
        match self.code.variables.iter().find(is_meant).map(|known| known.home) {
            Some(Home::Slot(slot, kind)) => Ok((slot, kind)),
            _ => Err(Mistake::Undeclared(wanted).at(0)),
        }
    }
}

//! Names that a format can write.

use std::collections::BTreeSet;

use fspid_fuzzy::system::Parts;

use crate::loss::Loss;

/// Which names a format has.
#[derive(Clone, Copy)]
pub(crate) struct Rule {
    /// Names that our reader reads back.
    pub(crate) readable: fn(&str) -> bool,
    /// Names that the format's documentation allows; others are written with a note.
    pub(crate) documented: fn(&str) -> bool,
    /// What the documentation says.
    pub(crate) description: &'static str,
}

impl Rule {
    /// Replaces names of variables and terms that cannot be read back, if losses are allowed.
    pub(crate) fn apply(self, parts: &mut Parts, loss: &mut Loss) {
        let inputs = parts.inputs.iter_mut().map(|input| &mut input.name);
        let outputs = parts.outputs.iter_mut().map(|output| &mut output.name);
        self.distinct(inputs.chain(outputs).collect(), loss);
        for input in &mut parts.inputs {
            self.distinct(input.terms.iter_mut().map(|term| &mut term.name).collect(), loss);
        }
        for output in &mut parts.outputs {
            self.distinct(output.terms.iter_mut().map(|term| &mut term.name).collect(), loss);
        }
    }

    fn distinct(self, names: Vec<&mut String>, loss: &mut Loss) {
        let mut taken: BTreeSet<String> = names.iter().map(|name| (**name).clone()).collect();
        for name in names {
            if !(self.readable)(name) {
                let new = self.replacement(name, &taken);
                let message = format!("not a name here; names are {}", self.description);
                loss.lose(name, &message, &new);
                taken.insert(new.clone());
                *name = new;
            } else if !(self.documented)(name) {
                loss.note(format!("`{name}` is written, but names are {}", self.description));
            }
        }
    }

    /// Underscores for what is not allowed, and a number if that name is taken.
    fn replacement(self, name: &str, taken: &BTreeSet<String>) -> String {
        let allowed = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
        let cleaned: String = name.chars().map(allowed).collect();
        let base = if (self.readable)(&cleaned) { cleaned } else { format!("n_{cleaned}") };
        let numbered = (2_u32..).map(|number| format!("{base}_{number}"));
        let mut candidates = std::iter::once(base.clone()).chain(numbered);
        candidates.find(|candidate| !taken.contains(candidate)).unwrap_or(base)
    }
}

/// Letters, digits and underscores of ASCII, not beginning with a digit.
pub(crate) fn is_plain(name: &str) -> bool {
    let fits = |c: char| c.is_ascii_alphanumeric() || c == '_';
    name.chars().all(fits) && !name.starts_with(|c: char| c.is_ascii_digit()) && !name.is_empty()
}

//! A general system as something that answers the rows of a table.

use fspid_fuzzy::system::{System, Workspace};

use super::answer::{Roughness, check, evaluate};
use crate::rows::RowAnswers;
use fspid_diagnostics::lines::add;

/// A general system with its memory.
#[derive(Debug)]
pub struct SystemTable<'a> {
    system: &'a System,
    workspace: Workspace,
    /// The answers of the row before, for outputs that keep them.
    previous: Vec<Option<f64>>,
    roughness: Roughness,
}

impl<'a> SystemTable<'a> {
    /// Questions to this system.
    #[must_use]
    pub fn new(system: &'a System) -> Self {
        let previous = vec![None; system.parts().outputs.len()];
        Self { system, workspace: system.workspace(), previous, roughness: Roughness::default() }
    }
}

impl RowAnswers for SystemTable<'_> {
    fn inputs(&self) -> Vec<&str> {
        self.system.parts().inputs.iter().map(|input| input.name.as_str()).collect()
    }

    fn outputs(&self) -> Vec<&str> {
        self.system.parts().outputs.iter().map(|output| output.name.as_str()).collect()
    }

    fn check(&self, row: &[f64]) -> Result<(), String> {
        let mut inputs = self.system.parts().inputs.iter().zip(row);
        inputs.try_for_each(|(input, value)| check(input, *value))
    }

    fn answer(&mut self, row: &[f64], line: &mut String) -> Result<(), String> {
        let Self { system, workspace, previous, roughness } = self;
        if system.evaluate_after(row, previous, workspace).is_err() {
            return evaluate(system, row, workspace);
        }
        roughness.count(system, workspace.answers());
        for (index, value) in row.iter().enumerate() {
            let comma = if index > 0 { "," } else { "" };
            add(line, format_args!("{comma}{value:?}"));
        }
        for (answer, previous) in workspace.answers().iter().zip(previous) {
            match answer.value {
                Some(value) => add(line, format_args!(",{value:?}")),
                None => line.push(','),
            }
            *previous = answer.value;
        }
        line.push('\n');
        Ok(())
    }

    fn remarks(&self) -> Vec<String> {
        let all: Vec<usize> = (0..self.system.parts().outputs.len()).collect();
        self.roughness.in_words(self.system, &all)
    }
}

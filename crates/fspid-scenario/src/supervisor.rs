//! A supervisor by the name of its rule table.

use fspid_core::fuzzy::{Defuzzifier, OutOfRange, Supervisor};

use crate::file;
pub use crate::refused::Refused;

/// A supervisor as it is named on the command line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Question<'a> {
    /// Name of a shipped rule table, or a file.
    pub table: &'a str,
    /// Half range of inputs and outputs.
    pub range: f64,
    /// Name of the centroid rule.
    pub defuzzifier: &'a str,
    /// Name of the policy for inputs beyond the range.
    pub out_of_range: &'a str,
}

impl Question<'_> {
    /// The supervisor in question.
    ///
    /// # Errors
    /// [`Refused`] with every problem of the question at once.
    pub fn supervisor(&self) -> Result<Supervisor<f64>, Refused> {
        let mut problems = Vec::new();
        let table = file::load_rule_table(self.table, None).map_err(|found| {
            let known = file::rule_table_names().join(", ");
            problems.push(format!("--table: known are {known}, or a readable .toml file\n{found}"));
        });
        let defuzzifier = self.defuzzifier.parse::<Defuzzifier>().map_err(|problem| {
            problems.push(format!("--defuzzifier {}: {problem}", self.defuzzifier));
        });
        let policy = OutOfRange::ALL.into_iter().find(|p| p.name() == self.out_of_range);
        if policy.is_none() {
            let known = OutOfRange::ALL.map(OutOfRange::name).join(", ");
            problems.push(format!("--out-of-range {}: known are {known}", self.out_of_range));
        }
        let usable_range = self.range.is_finite() && self.range > 0.0;
        if !usable_range {
            problems
                .push(format!("--range is {:?}; allowed is a finite number above 0", self.range));
        }
        let (Ok(table), Ok(defuzzifier), Some(policy), true) =
            (table, defuzzifier, policy, usable_range)
        else {
            return Err(Refused::all(problems));
        };
        Supervisor::new(&table, self.range, defuzzifier, policy)
            .map_err(|problem| Refused::one(problem.to_string()))
    }
}

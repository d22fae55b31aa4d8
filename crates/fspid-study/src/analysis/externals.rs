//! Controllers without equations: of them flights alone speak.

use fspid_sim::flown::empirical::{EmpiricalAnswer, EmpiricalOptions, flown_margins};
use fspid_sim::{NamedExternal, Respondent, Scenario, SimError};

use super::flights::{empirical_json, empirical_lines};
use super::{AnalysedLoop, Question};
use serde_json::{Value, json};

/// Why there is no loop.
const NO_LOOP: &str = "external, without equations here: there is no loop to analyse";
/// What would speak of it.
const FLY: &str = "--fly says how much gain, delay and lag its flight bears";

/// What is said of an external controller.
#[derive(Clone, Debug)]
pub struct FlownExternal {
    /// Its name.
    pub name: String,
    /// How much gain, delay and lag its flight bears, where it was flown.
    pub margins: Option<EmpiricalAnswer>,
}

impl FlownExternal {
    /// Of a scenario's controller; lags are flown at the gain crossovers of the first of the loops that has any.
    ///
    /// # Errors
    /// [`SimError`] where it cannot be flown.
    pub(super) fn of(
        scenario: &Scenario,
        named: &NamedExternal,
        question: &Question,
        loops: &[AnalysedLoop],
    ) -> Result<Self, SimError> {
        let margins = question.flies().then(|| {
            let crossovers_rad_s = Some(crossovers_rad_s(loops));
            let options = EmpiricalOptions { crossovers_rad_s, ..EmpiricalOptions::default() };
            flown_margins(scenario, Respondent::External(&named.external), &options)
        });
        Ok(Self { name: named.name.clone(), margins: margins.transpose()? })
    }

    /// True unless its flight does not hold.
    pub(super) fn is_held(&self) -> bool {
        !matches!(self.margins, Some(EmpiricalAnswer::NominalFails { .. }))
    }

    /// The lines of the answer for people.
    pub(super) fn text(&self, width: usize) -> String {
        let mut out = format!("\n{:width$}  {NO_LOOP}\n", self.name);
        match &self.margins {
            None => out.push_str(&format!("  {FLY}\n")),
            Some(margins) => {
                for (label, sentence) in empirical_lines(margins) {
                    out.push_str(&format!("  {label:17}  {sentence}\n"));
                }
            }
        }
        out
    }

    /// The answer for programs.
    pub(super) fn json(&self) -> Value {
        let margins = self.margins.as_ref().map(empirical_json);
        json!({ "name": self.name, "absent": NO_LOOP, "flown_margins": margins })
    }
}

fn crossovers_rad_s(loops: &[AnalysedLoop]) -> Vec<f64> {
    let mut flown = loops.iter().filter_map(|found| match &found.flights.as_ref()?.empirical {
        EmpiricalAnswer::Margins(margins) if !margins.phase.is_empty() => Some(margins),
        _ => None,
    });
    flown.next().map_or(Vec::new(), |margins| margins.phase.iter().map(|at| at.at_rad_s).collect())
}

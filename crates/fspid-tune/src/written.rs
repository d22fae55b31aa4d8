//! Whether a scenario is right in all that it says of flights: as it stands, as its dispersions draw it, and as each of the
//! cases makes it that it is tuned on and judged by.

use std::collections::BTreeSet;
use std::fmt;
use std::path::Path;

use fspid_certify::CasesError;
use fspid_diagnostics::digits::counted;
use fspid_scenario::file::{Extra, LoadError, Problems, Template, TunedIn};
use serde_json::Value;

use crate::error::WrongCase;
use crate::source::cases;
use crate::wrong_cases::{MOST_CASES, problems_of_cases};

/// The text of a scenario, with what belongs to it.
#[derive(Clone, Copy, Debug)]
pub struct Written<'a> {
    /// The text.
    pub text: &'a str,
    /// What it is called in messages.
    pub name: &'a str,
    /// From where it names files; one without a folder can name none.
    pub folder: Option<&'a Path>,
    /// Changes, as `--set` takes them.
    pub overrides: &'a [String],
}

impl Written<'_> {
    /// The scenario as it stands.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn template(&self) -> Result<Template, Problems> {
        self.changed(&[])
    }

    /// Checks everything that it says.
    ///
    /// # Errors
    /// What is wrong with the scenario as it stands, or else with what it makes of itself.
    pub fn check(&self) -> Result<(), NotRight> {
        self.check_beyond(&self.template().map_err(NotRight::Scenario)?)
    }

    /// As [`check`](Self::check) of one that is right as it stands.
    ///
    /// # Errors
    /// What is wrong with it as its dispersions draw it, what is free there and gets its value from a dispersion or a case,
    /// or else what is wrong with it as its cases make it.
    pub fn check_beyond(&self, template: &Template) -> Result<(), NotRight> {
        let study = template.study();
        if !study.dispersions.is_empty() {
            template.check_dispersions().map_err(NotRight::Scenario)?;
        }
        template
            .check_free(&study.tunable_parameters, TunedIn::Contest)
            .map_err(NotRight::Scenario)?;
        let wrong = self.wrong_cases(template);
        if wrong.is_empty() { Ok(()) } else { Err(NotRight::Cases(wrong)) }
    }

    /// What is wrong with the cases of its tuning and its contest, in their order; of cases that are wrong in the same way
    /// the first.
    fn wrong_cases(&self, template: &Template) -> Vec<WrongCase> {
        let mut known = BTreeSet::new();
        let wrong = cases(template.study()).filter_map(|case| {
            let marks = &template.study().tunable_parameters;
            let changed = self.changed(&case.set);
            // A case may draw what is free by its changes.
            let free = changed.and_then(|case| case.check_free(marks, TunedIn::AsWritten));
            let problems = free.err()?;
            let is_new = known.insert(problems.to_string());
            let case = case.name.clone();
            is_new.then_some(WrongCase { case, problems: LoadError::Problems(problems) })
        });
        wrong.collect()
    }

    fn changed(&self, more: &[String]) -> Result<Template, Problems> {
        let overrides: Vec<String> = self.overrides.iter().chain(more).cloned().collect();
        let extra = Extra { overrides: &overrides, ..Extra::default() };
        Template::parse(self.text, self.name, self.folder, &extra)
    }
}

/// What is wrong with a scenario.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NotRight {
    /// The scenario, as it stands or as its dispersions draw it.
    Scenario(Problems),
    /// Cases of its tuning or its contest; never empty.
    Cases(Vec<WrongCase>),
}

impl fmt::Display for NotRight {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let wrong = match self {
            Self::Scenario(problems) => return problems.fmt(f),
            Self::Cases(wrong) => wrong,
        };
        let mut told: Vec<String> =
            wrong.iter().take(MOST_CASES).map(ToString::to_string).collect();
        if wrong.len() > MOST_CASES {
            told.push(format!("and {} more", counted(wrong.len() - MOST_CASES, "wrong case")));
        }
        f.write_str(&told.join("\n"))
    }
}

impl std::error::Error for NotRight {}

impl NotRight {
    /// The problems as JSON, as [`Problems::to_json`] has them; those of a case have its name as `case`.
    #[must_use]
    pub fn to_json(&self) -> Value {
        let wrong = match self {
            Self::Scenario(problems) => return problems.to_json(),
            Self::Cases(wrong) => wrong,
        };
        // What a text makes wrong was read.
        problems_of_cases(wrong.iter().map(WrongCase::told)).unwrap_or_default()
    }
}

/// What is wrong with cases that are to be certified, as [`NotRight::to_json`] has it.
#[must_use]
pub fn problems_of_certified(error: &CasesError) -> Option<Value> {
    match error {
        CasesError::Scenario(wrong) => {
            problems_of_cases(wrong.iter().map(|(case, reason)| (case.as_str(), reason)))
        }
        CasesError::NoCases(_) | CasesError::Plant(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    const SCENARIO: &str = include_str!("../../fspid-scenario/src/file/starter.toml");

    fn checked(more: &str) -> Result<(), NotRight> {
        let text = format!("{SCENARIO}{more}");
        Written { text: &text, name: "mine.toml", folder: None, overrides: &[] }.check()
    }

    fn case(name: &str, set: &str) -> String {
        format!("\n[[tuning.case]]\nname = \"{name}\"\nset = [\"{set}\"]\n")
    }

    #[test]
    fn a_problem_of_a_case_has_its_name_and_the_same_problem_is_told_once() {
        assert_eq!(checked(""), Ok(()));
        let objective = "\n[[tuning.objective]]\nmeasure = \"iae_deg_s\"\n";
        let first = case("misspelt", "plant.presett=navion-paper");
        let again = case("again", "plant.presett=navion-paper");
        let other = case("backwards", "loop.duration_s=-1");
        let wrong = checked(&format!("{objective}{first}{again}{other}")).expect_err("wrong");
        let told = wrong.to_json();
        let names: Vec<&Value> =
            told["problems"].as_array().expect("a list").iter().map(|it| &it["case"]).collect();
        assert_eq!((&told["file"], &told["omitted"]), (&json!("mine.toml"), &json!(0)));
        assert_eq!(names, ["misspelt", "backwards"], "{told:#}");
        assert_eq!(told["problems"][0]["path"], "plant.presett");
        let said = wrong.to_string();
        assert!(said.contains("case \"misspelt\" makes the scenario wrong"), "{said}");
        assert!(said.contains("loop.duration_s") && !said.contains("again"), "{said}");
    }

    #[test]
    fn of_many_wrong_cases_ten_are_told_and_the_rest_is_counted() {
        let objective = "\n[[tuning.objective]]\nmeasure = \"iae_deg_s\"\n".to_owned();
        let cases = (1..=12).map(|at| case(&format!("{at}"), &format!("loop.duration_s=-{at}")));
        let wrong = checked(&(objective + &cases.collect::<String>())).expect_err("wrong");
        let told = wrong.to_json();
        assert_eq!(told["problems"].as_array().map(Vec::len), Some(MOST_CASES));
        assert_eq!(told["omitted"], 2);
        assert!(wrong.to_string().ends_with("and 2 wrong cases more"), "{wrong}");
    }

    #[test]
    fn what_dispersions_draw_is_checked_as_well() {
        let drawn = "\n[[dispersion]]\nname = \"end\"\npath = \"loop.duration_s\"\ndistribution = \"uniform\"\nlower = -1.0\nupper = 1.0\n";
        let wrong = checked(drawn).expect_err("wrong");
        assert!(matches!(wrong, NotRight::Scenario(_)), "{wrong}");
    }
}

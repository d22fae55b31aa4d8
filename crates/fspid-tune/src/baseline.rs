//! A classical rule for a controller of a scenario, and the scenario with what the rule gave.

use std::path::Path;

use fspid_core::PidConfig;
use fspid_scenario::file::{Extra, SettingPath, Template};
use fspid_scenario::tuning::Free;
use fspid_sim::Controller;
use serde_json::{Value, json};

use crate::design::{text_of, with_changes};
use crate::error::TuneError;
use crate::problem::chosen;
use crate::rule::{self, Design, Options, Rule};
use crate::source::{Source, folder_of};

/// What a rule makes of the loop of a scenario.
#[derive(Clone, Debug)]
pub struct Baseline {
    /// The controller whose filters, limits and rate loop stay.
    pub controller: String,
    /// What the rule gave.
    pub design: Design,
    /// The other controllers of the scenario, which stay as they are.
    pub others: Vec<String>,
    /// Whether a supervisor tunes it, which no rule knows of.
    pub is_self_tuning: bool,
}

impl Baseline {
    /// By a rule for the controller of that name, or the first one.
    ///
    /// # Errors
    /// A scenario that is wrong, a controller that there is not, or a rule that gives no gains.
    pub fn of(
        source: &Source,
        controller: Option<&str>,
        rule: Rule,
        options: &Options,
    ) -> Result<Self, TuneError> {
        let template = source.template()?;
        let study = template.study();
        let controller = chosen(study, controller)?;
        if study.derived_gains.iter().any(|derived| derived.controller == controller) {
            return Err(TuneError::Value {
                what: "the controller",
                found: format!("\"{controller}\", whose gains come from a schedule or a regulator"),
                allowed: "one whose gains stand in the scenario as they fly".to_owned(),
            });
        }
        let found = study.scenario.controllers.iter().find(|named| named.name == controller);
        let config = found.map(|named| *config_of(&named.controller));
        let options = Options { config, ..*options };
        let is_self_tuning =
            found.is_some_and(|named| matches!(named.controller, Controller::SelfTuning(_)));
        let names = study.scenario.controllers.iter().map(|named| named.name.clone());
        let others = names.filter(|name| *name != controller).collect();
        let design = rule::design(study, rule, &options)?;
        Ok(Self { controller, design, others, is_self_tuning })
    }

    /// Whose gains these are, and what of that controller the rule does not use.
    fn whose(&self) -> Vec<String> {
        let mut lines = Vec::new();
        if !self.others.is_empty() {
            lines.push(format!(
                "for \"{}\": its filters, limits and rate loop; {} as before (--controller names another)",
                self.controller,
                match self.others.as_slice() {
                    [one] => format!("\"{one}\" stays"),
                    many => format!("{} others stay", many.len()),
                }
            ));
        }
        if self.is_self_tuning {
            lines.push(format!(
                "\"{}\" is self-tuning: these are its nominal gains, standing still; its supervisor is not used, and what it adds is in none of these numbers",
                self.controller
            ));
        }
        lines
    }

    /// The answer for people: whose gains, then what the rule gave.
    #[must_use]
    pub fn answer(&self) -> String {
        let whose = self.whose();
        let (head, rest) = self.design.text().split_once('\n').map_or_else(
            || (self.design.text(), String::new()),
            |(head, rest)| (head.to_owned(), rest.to_owned()),
        );
        let lines = whose.iter().map(|line| format!("  {line}\n")).collect::<String>();
        let text = format!("{head}\n{lines}{rest}");
        match self.is_self_tuning {
            true => text.replacen(
                "\nFor the scenario's controller:\n",
                "\nFor the scenario's controller, under `nominal`:\n",
                1,
            ),
            false => text,
        }
    }

    /// The answer for programs: that of the rule, with the controller.
    #[must_use]
    pub fn json(&self) -> Value {
        const NOT_USED: &str = "not used: the gains are the nominal ones, standing still";
        let mut answer = self.design.json();
        answer["controller"] = json!(self.controller);
        answer["other_controllers"] = json!(self.others);
        answer["supervisor"] = json!(self.is_self_tuning.then_some(NOT_USED));
        if !self.is_self_tuning {
            answer["null"]["supervisor"] = json!("the controller has none");
        }
        answer
    }

    /// The scenario with the rule's numbers for its controller. A number that is marked free stays free, and
    /// begins where the rule says, if that lies within its bounds.
    ///
    /// # Errors
    /// A controller that has not all the numbers that the rule gave.
    pub fn text(
        &self,
        source: &Source,
        out: &Path,
        heading: &[String],
    ) -> Result<String, TuneError> {
        let text = text_of(source)?;
        let mut changes = source.overrides.clone();
        let template = source.template()?;
        changes.extend(self.changes(&template));
        let design = with_changes(&text, heading, &changes);
        let name = out.display().to_string();
        Template::parse(&design, &name, Some(folder_of(out)), &Extra::default())?;
        Ok(design)
    }

    fn changes(&self, template: &Template) -> Vec<String> {
        let Design { gains, config, given, .. } = &self.design;
        let nominal = match template
            .study()
            .scenario
            .controllers
            .iter()
            .find(|it| it.name == self.controller)
        {
            Some(named) if matches!(named.controller, Controller::SelfTuning(_)) => "nominal.",
            _ => "",
        };
        let mut numbers = vec![(format!("{nominal}kp"), gains.kp)];
        let others = [("ki", gains.ki), ("kd", gains.kd)];
        numbers.extend(others.map(|(key, gain)| (format!("{nominal}{key}"), gain)));
        // A proportional controller has no other gains, and needs none that are 0.
        numbers
            .retain(|(key, gain)| key.ends_with("kp") || *gain != 0.0 || self.has(template, key));
        if given.rate_gain {
            numbers.push(("rate_gain".to_owned(), config.rate_gain_s));
        }
        if given.derivative_filter {
            numbers.push(("derivative_filter_s".to_owned(), config.derivative.filter_s));
        }
        if given.setpoint_weights {
            let weights = config.setpoint_weights;
            numbers.push(("setpoint_weights.proportional".to_owned(), weights.proportional));
            numbers.push(("setpoint_weights.derivative".to_owned(), weights.derivative));
        }
        numbers.iter().map(|(key, number)| self.change(template, key, *number)).collect()
    }

    fn path(&self, key: &str) -> String {
        format!("controller.\"{}\".{key}", self.controller)
    }

    fn has(&self, template: &Template, key: &str) -> bool {
        let path = SettingPath::parse(&self.path(key));
        path.is_some_and(|path| template.number_at(&path).is_some())
    }

    /// The change that brings a number in: as the start of a mark where its bounds hold it, else as it is.
    fn change(&self, template: &Template, key: &str, number: f64) -> String {
        let is_start = template.study().tunable_parameters.iter().any(|mark| {
            let holds = match &mark.free {
                Free::Number(free) => (free.lower..=free.upper).contains(&number),
                Free::Grid(_) | Free::Numbers(_) => false,
            };
            let is_it = mark.path.text().ends_with(&format!(".{key}"));
            mark.controller() == Some(&self.controller) && is_it && holds
        });
        format!("{}{}={number:?}", self.path(key), if is_start { ".start" } else { "" })
    }
}

fn config_of(controller: &Controller) -> &PidConfig<f64> {
    match controller {
        Controller::Fixed(pid) => pid.config(),
        Controller::SelfTuning(fspid) => fspid.config(),
    }
}

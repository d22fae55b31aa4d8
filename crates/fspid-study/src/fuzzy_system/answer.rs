//! One question to a system: values by name in, answers by name out.

use fspid_fuzzy::system::{Answer, Defuzzifier, Output, Source, System, Universe, Workspace};
use serde_json::{Map, Value, json};

use crate::json::{finite, merged, present};
use fspid_diagnostics::known_words;
use fspid_scenario::supervisor::Refused;

/// A question with its answers.
#[derive(Clone, Debug)]
pub struct Asked<'a> {
    pub(super) system: &'a System,
    pub(super) workspace: Workspace,
}

/// Asks a system; `values` are `name=value`.
///
/// # Errors
/// [`Refused`] with every value that is wrong and every one that is missing.
pub fn ask<'a>(system: &'a System, values: &[String]) -> Result<Asked<'a>, Refused> {
    let inputs = inputs(system, values)?;
    let mut workspace = system.workspace();
    evaluate(system, &inputs, &mut workspace).map_err(Refused::one)?;
    Ok(Asked { system, workspace })
}

/// Evaluates, with the inputs' names in what may go wrong.
pub(super) fn evaluate(
    system: &System,
    inputs: &[f64],
    workspace: &mut Workspace,
) -> Result<(), String> {
    system.evaluate(inputs, workspace).map(|_| ()).map_err(|_| {
        let wrong = inputs.iter().zip(&system.parts().inputs);
        let told = wrong.filter_map(|(value, input)| check(input, *value).err());
        told.collect::<Vec<_>>().join("\n")
    })
}

/// Whether an input may have this value.
pub(super) fn check(input: &fspid_fuzzy::system::Input, value: f64) -> Result<(), String> {
    let name = &input.name;
    if !value.is_finite() {
        return Err(format!("{name} is {value:?}; allowed is a finite number"));
    }
    match input.universe {
        Some(Universe { lower, upper })
            if input.out_of_range == fspid_fuzzy::OutOfRange::Error
                && !(lower..=upper).contains(&value) =>
        {
            Err(format!("{name} is {value:?}; allowed is {lower:?} to {upper:?}"))
        }
        _ => Ok(()),
    }
}

/// A value for each input, out of `name=value`.
pub(super) fn inputs(system: &System, values: &[String]) -> Result<Vec<f64>, Refused> {
    let mut problems = Vec::new();
    let given = named(system, values, &mut problems);
    let mut inputs = Vec::new();
    for (input, value) in system.parts().inputs.iter().zip(given) {
        match value.map(|value| check(input, value).map(|()| value)) {
            Some(Ok(value)) => inputs.push(value),
            Some(Err(problem)) => problems.push(problem),
            None => problems
                .push(format!("{name} has no value; add --input {name}=…", name = input.name)),
        }
    }
    if problems.is_empty() { Ok(inputs) } else { Err(Refused::all(problems)) }
}

/// The values that are given, for each input.
pub(super) fn named(
    system: &System,
    values: &[String],
    problems: &mut Vec<String>,
) -> Vec<Option<f64>> {
    let known: Vec<&str> = system.parts().inputs.iter().map(|i| i.name.as_str()).collect();
    let mut given = vec![None; known.len()];
    for text in values {
        let Some((name, number)) = text.rsplit_once('=') else {
            problems.push(format!("`{text}` is no name=value, such as {}=1", known.join("=1 ")));
            continue;
        };
        let place = known.iter().position(|known| *known == name.trim());
        match (place.and_then(|place| given.get_mut(place)), number.trim().parse::<f64>()) {
            (Some(place), Ok(value)) if place.is_none() => *place = Some(value),
            (Some(_), Ok(_)) => problems.push(format!("{name} has two values")),
            (Some(_), Err(_)) => {
                problems.push(format!("{name} is `{number}`; allowed is a number"));
            }
            (None, _) => {
                let known = known_words(name, &known);
                problems.push(format!("there is no input `{name}`{known}"));
            }
        }
    }
    given
}

/// The rule by which an output answers: `centroid, exact`.
pub(super) fn rule(output: &Output) -> String {
    let method = output.defuzzifier;
    match method.sampling() {
        Some(sampling) => format!("{}, {sampling}", method.name()),
        None => format!("{}{}", method.name(), reading(method)),
    }
}

fn reading(method: Defuzzifier) -> &'static str {
    use fspid_fuzzy::system::SetReading::InverseTsukamoto;
    match method {
        Defuzzifier::WeightedAverage(InverseTsukamoto)
        | Defuzzifier::WeightedSum(InverseTsukamoto) => ", inverse Tsukamoto",
        _ => "",
    }
}

/// Where an answer comes from, for programs.
pub(super) const fn source(source: Source) -> &'static str {
    match source {
        Source::Rules => "rules",
        Source::Previous => "previous",
        Source::Middle => "middle",
        Source::Default => "default",
        Source::Nothing => "nothing",
    }
}

/// What stands in place of an answer that the rules did not give.
const fn substitute(source: Source) -> Option<&'static str> {
    match source {
        Source::Rules => None,
        Source::Previous => Some("; the previous answer"),
        Source::Middle => Some("; the middle of the range"),
        Source::Default => Some("; the output's default"),
        Source::Nothing => Some(", and there is no default"),
    }
}

impl<'a> Asked<'a> {
    /// The system that was asked.
    #[must_use]
    pub fn system(&self) -> &'a System {
        self.system
    }

    /// The workspace as the evaluation left it.
    #[must_use]
    pub fn workspace(&self) -> &Workspace {
        &self.workspace
    }

    /// The outputs with their answers.
    pub fn answers(&self) -> impl Iterator<Item = (&Output, &Answer)> {
        self.system.parts().outputs.iter().zip(self.workspace.answers())
    }

    /// Why the rules did not give the answer of an output, for one that they did not give.
    fn reason(&self, index: usize, output: &Output) -> &'static str {
        match (output.enabled, self.system.is_concluded(index, &self.workspace)) {
            (false, _) => "the output is switched off",
            (true, false) => "no rule fired",
            // A formula without a finite value, or a set without an area.
            (true, true) => "the rules gave no number",
        }
    }

    /// Names of the inputs that lay outside of their ranges, and whether each was moved.
    fn outside(&self) -> impl Iterator<Item = (&str, bool)> {
        let inputs = self.system.parts().inputs.iter().zip(self.workspace.outside());
        inputs.filter(|(_, outside)| **outside).map(|(input, _)| {
            (input.name.as_str(), input.out_of_range == fspid_fuzzy::OutOfRange::Clamp)
        })
    }

    /// The answers as JSON, by the names of the outputs.
    #[must_use]
    pub fn json(&self) -> Value {
        let inputs = self.system.parts().inputs.iter().zip(self.workspace.inputs());
        let inputs: Map<String, Value> =
            inputs.map(|(input, value)| (input.name.clone(), json!(value))).collect();
        let answers = self.answers().enumerate();
        let outputs: Map<String, Value> = answers
            .map(|(index, (output, answer))| {
                (output.name.clone(), self.answer(index, output, answer))
            })
            .collect();
        let names = |clamped: bool| -> Option<Vec<&str>> {
            let names = self.outside().filter(|found| found.1 == clamped).map(|found| found.0);
            Some(names.collect::<Vec<_>>()).filter(|names| !names.is_empty())
        };
        present(json!({
            "system": self.system.parts().name,
            "inputs": inputs,
            "outputs": outputs,
            "clamped": names(true),
            "outside": names(false),
        }))
    }

    fn answer(&self, index: usize, output: &Output, answer: &Answer) -> Value {
        let is_of_rules = answer.source == Source::Rules;
        merged([
            json!({ "value": answer.value.map(finite), "rule": rule(output), "source": source(answer.source) }),
            present(json!({
                "error_bound": Some(answer.error_bound).filter(|bound| *bound > 0.0).map(finite),
                "interval": self.workspace.interval(index),
                "reason": (!is_of_rules).then(|| self.reason(index, output)),
            })),
        ])
    }

    /// The answers for people.
    #[must_use]
    pub fn text(&self) -> String {
        let names = self.system.parts().outputs.iter().map(|output| output.name.chars().count());
        let width = names.max().unwrap_or(0);
        let mut out = String::new();
        if self.system.parts().outputs.is_empty() {
            out.push_str("the system has no output: nothing is concluded\n");
        }
        for (index, (output, answer)) in self.answers().enumerate() {
            let interval = self.workspace.interval(index);
            let between = interval.map(|[from, to]| format!(", middle of {from:.6} to {to:.6}"));
            let between = between.unwrap_or_default();
            let number = answer.value.map_or("none".to_owned(), in_words);
            let name = &output.name;
            let remarks = match substitute(answer.source) {
                Some(substitute) => format!("{}{substitute}", self.reason(index, output)),
                None => remarks(output, answer),
            };
            out.push_str(&format!("{name:width$} {number:>20}  {remarks}{between}\n"));
        }
        for (name, moved) in self.outside() {
            let done = if moved { "moved to the end of its range" } else { "used as it is" };
            out.push_str(&format!("{name} lies outside of its range; {done}\n"));
        }
        out
    }
}

/// A number with its digits; in words where the rules conclude one that is infinite.
fn in_words(value: f64) -> String {
    match value {
        f64::INFINITY => "infinite".to_owned(),
        f64::NEG_INFINITY => "-infinite".to_owned(),
        value if value.is_nan() => "no number".to_owned(),
        value => format!("{value:.12}"),
    }
}

/// An answer that may be off by more than this share of its range is hardly one.
const ROUGH: f64 = 1e-6;

/// Why an answer can be rough.
const WHY_ROUGH: &str = "the set has a gap where it is halved, or could not be integrated";

/// The error bound of an answer that is hardly one.
pub(super) fn rough_bound(output: &Output, answer: &Answer) -> Option<f64> {
    let range = output.universe.map_or(f64::INFINITY, |it| it.upper - it.lower);
    Some(answer.error_bound).filter(|bound| *bound > ROUGH * range)
}

/// The rule of an answer, and its error bound.
fn remarks(output: &Output, answer: &Answer) -> String {
    let mut text = rule(output);
    if let Some(bound) = rough_bound(output, answer) {
        text.push_str(&format!(", KNOWN ONLY WITHIN {bound:.1e}: {WHY_ROUGH}"));
    } else if answer.error_bound > 0.0 {
        text.push_str(&format!(", within {:.1e}", answer.error_bound));
    }
    text
}

/// How many answers of each output were rough, and how rough, among many that are written without their bounds.
#[derive(Clone, Debug, Default)]
pub(super) struct Roughness(Vec<(usize, f64)>);

impl Roughness {
    /// Counts the answers of all outputs to one question.
    pub(super) fn count(&mut self, system: &System, answers: &[Answer]) {
        self.0.resize(system.parts().outputs.len(), (0, 0.0));
        let outputs = system.parts().outputs.iter().zip(answers);
        for ((rough, worst), (output, answer)) in self.0.iter_mut().zip(outputs) {
            if let Some(bound) = rough_bound(output, answer) {
                *rough += 1;
                *worst = bound.max(*worst);
            }
        }
    }

    /// How many answers of an output were rough, and the worst bound.
    pub(super) fn of(&self, output: usize) -> Option<(usize, f64)> {
        self.0.get(output).copied().filter(|(rough, _)| *rough > 0)
    }

    /// A sentence for each of these outputs that had rough answers.
    pub(super) fn in_words(&self, system: &System, asked: &[usize]) -> Vec<String> {
        let sentence = |&index: &usize| {
            let ((rough, worst), output) = (self.of(index)?, system.parts().outputs.get(index)?);
            let answers =
                if rough == 1 { "1 answer".to_owned() } else { format!("{rough} answers") };
            let name = &output.name;
            Some(format!("{answers} of `{name}` KNOWN ONLY WITHIN {worst:.1e}: {WHY_ROUGH}"))
        };
        asked.iter().filter_map(sentence).collect()
    }
}

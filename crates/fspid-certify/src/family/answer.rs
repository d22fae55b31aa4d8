//! A family in sentences and for programs.

use fspid_diagnostics::digits::to_six_decimals;
use fspid_proof::{Family, FamilyVerdict, Pace, Parameter};
use serde_json::{Value, json};

use super::FamilyAnswer;

/// A number between two ends, in the words of the scenario.
fn between(parameter: &Parameter, [from, to]: [f64; 2]) -> String {
    let Parameter { name, paths, relative, .. } = parameter;
    let place = paths.join(", ");
    let times = if *relative { " times as large" } else { "" };
    format!("{name} ({place}) from {} to {}{times}", to_six_decimals(from), to_six_decimals(to))
}

fn all_between(parameters: &[Parameter], ends: impl Iterator<Item = [f64; 2]>) -> String {
    let each = parameters.iter().zip(ends).map(|(parameter, ends)| between(parameter, ends));
    each.collect::<Vec<_>>().join("; ")
}

/// The whole box.
pub(in super::super) fn box_in_words(parameters: &[Parameter]) -> String {
    all_between(parameters, parameters.iter().map(|one| one.ends))
}

/// What a proved family says, sentence by sentence.
fn proved(family: &Family) -> Vec<String> {
    let some = |count: usize, what: &str| match count {
        1 => format!("one {what}"),
        _ => format!("{count} {what}s"),
    };
    let how = format!("{}, {}", some(family.parts.len(), "part"), some(family.forms(), "form"));
    let standing = format!(
        "every loop in all of this, each standing still, returns to its trim where the set-point is and no load acts, as long as no limit acts ({how}): {}",
        box_in_words(&family.parameters)
    );
    let moving = family.pace.as_ref().map(at_a_pace);
    let changing = family.scales_may_change().then(|| SCALES_MAY_CHANGE.to_owned());
    let rest = "all else here is about the loop as it is".to_owned();
    [Some(standing), moving, changing, Some(rest)].into_iter().flatten().collect()
}

fn at_a_pace(pace: &Pace) -> String {
    let how_fast = match pace.crosses_in_s {
        time_s if time_s > 0.0 => {
            format!("each at no more than the rate of its whole range in {time_s} s")
        }
        _ => "each as fast as it likes".to_owned(),
    };
    format!(
        "the numbers may move in flight, all at the same time and {how_fast}: the motion about the trim of the moment comes to rest, and what the change does by itself is left out (the trim that moves with the numbers, a moment of inertia that changes)"
    )
}

const SCALES_MAY_CHANGE: &str = "the scales of sensors may change in flight, beside a plant that stands still, from sample to sample, each by itself and as fast as it likes, so that a sensor whose line is bent is covered as long as what it shows of the way from the trim is within these scales of it";

/// Sentences about a family whose certificate is there.
pub(in super::super) fn sentences(family: &Family) -> Vec<String> {
    proved(family)
}

impl FamilyAnswer {
    /// The answer in capitals, and why.
    pub(in super::super) fn text(&self) -> String {
        match self {
            Self::NominalNotProved => {
                "OPEN: the loop as it is is not proved, so nothing is said of others".to_owned()
            }
            Self::None(reason) => format!("OPEN: {reason}"),
            Self::Verdict { parameters, verdict } => match &**verdict {
                FamilyVerdict::Proved(family) => {
                    format!("PROVED: {}", proved(family).join("; "))
                }
                FamilyVerdict::Refuted { at, .. } => {
                    let set = at.iter().zip(parameters).map(|(at, one)| setting(one, *at));
                    format!(
                        "REFUTED: with gains that the controller has, standing still, the loop grows at {}",
                        set.collect::<Vec<_>>().join("; ")
                    )
                }
                FamilyVerdict::Open { ends, because } => format!(
                    "OPEN: not proved at {}: {because}",
                    all_between(parameters, ends.iter().copied())
                ),
            },
        }
    }
}

/// The answer in capitals, and why.
pub(in super::super) fn in_words(answer: &FamilyAnswer) -> String {
    answer.text()
}

/// A member's number.
fn setting(parameter: &Parameter, value: f64) -> String {
    let times = if parameter.relative { " times as large" } else { "" };
    format!("{} ({}) {}{times}", parameter.name, parameter.paths.join(", "), to_six_decimals(value))
}

/// The answer for programs.
pub(in super::super) fn in_json(answer: &FamilyAnswer) -> Value {
    let places = |parameters: &[Parameter], ends: &mut dyn Iterator<Item = Value>| -> Value {
        let each = parameters.iter().zip(ends).map(|(one, at)| {
            json!({ "name": one.name, "paths": one.paths, "relative": one.relative, "at": at })
        });
        each.collect()
    };
    let (verdict, at, parts) = match answer {
        FamilyAnswer::NominalNotProved | FamilyAnswer::None(_) => ("open", Value::Null, None),
        FamilyAnswer::Verdict { parameters, verdict } => match &**verdict {
            FamilyVerdict::Proved(family) => {
                let mut ends = parameters.iter().map(|one| json!(one.ends));
                ("proved", places(parameters, &mut ends), Some(family.parts.len()))
            }
            FamilyVerdict::Refuted { at, .. } => {
                let mut at = at.iter().map(|at| json!(at));
                ("refuted", places(parameters, &mut at), None)
            }
            FamilyVerdict::Open { ends, .. } => {
                let mut ends = ends.iter().map(|ends| json!(ends));
                ("open", places(parameters, &mut ends), None)
            }
        },
    };
    let scales_may_change = answer.proved().map(Family::scales_may_change);
    let crosses_in_s =
        answer.proved().and_then(|family| family.pace.as_ref()).map(|it| it.crosses_in_s);
    json!({
        "verdict": verdict,
        "at": at,
        "parts": parts,
        "scales_may_change": scales_may_change,
        "numbers_may_cross_in_s": crosses_in_s,
        "in_words": answer.text(),
    })
}

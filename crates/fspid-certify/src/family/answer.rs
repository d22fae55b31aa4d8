//! A family in sentences and for programs.

use fspid_diagnostics::digits::to_six_decimals;
use fspid_proof::{Family, FamilyVerdict, Pace, Parameter};
use serde_json::{Value, json};

use super::{AsFlown, FamilyAnswer};
use crate::scope::NOT_IN_CLAIM;
use crate::text::Line;
use fspid_study::json::{merged, present};

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
    /// That a member does not hold as it flies, and what is proved then.
    fn trouble(&self) -> Option<String> {
        let Self::Verdict { parameters, .. } = self else { return None };
        let (at, because) = self.not_held()?;
        let member = member_in_words(parameters, at);
        Some(format!(
            "NOT PROVED as it flies: at {member}: {because}; proved are the pitch loops alone"
        ))
    }

    /// What stands beside the sentences of a certificate, in which a proved family is: that it is not proved, or of what that is
    /// not a proof.
    pub(in super::super) fn beside_the_claim(&self) -> Option<Line> {
        match self {
            Self::Verdict { as_flown: AsFlown::NotHeld { .. }, .. } => {
                self.trouble().map(|it| ("family", it))
            }
            Self::Verdict { as_flown, .. } if self.is_proved() => {
                as_flown.not_proved_between().map(|it| (NOT_IN_CLAIM, it))
            }
            _ => Some(("family", self.text())),
        }
    }

    /// The answer in capitals, and why.
    pub(in super::super) fn text(&self) -> String {
        match self {
            Self::NominalNotProved => {
                "OPEN: the loop as it is is not proved, so nothing is said of others".to_owned()
            }
            Self::None(reason) => format!("OPEN: {reason}"),
            Self::Verdict { parameters, verdict, as_flown } => match &**verdict {
                FamilyVerdict::Proved(family) => {
                    let claim = proved(family).join("; ");
                    match (self.trouble(), as_flown.not_proved_between()) {
                        (Some(trouble), _) => format!("{trouble}: {claim}"),
                        (None, Some(between)) => format!("PROVED: {claim}. {between}"),
                        (None, None) => format!("PROVED: {claim}"),
                    }
                }
                FamilyVerdict::Refuted { at, .. } => {
                    format!(
                        "REFUTED: with gains that the controller has, standing still, the loop grows at {}",
                        member_in_words(parameters, at)
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

/// A member by its numbers.
pub(in super::super) fn member_in_words(parameters: &[Parameter], at: &[f64]) -> String {
    let set = at.iter().zip(parameters).map(|(at, one)| setting(one, *at));
    set.collect::<Vec<_>>().join("; ")
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
        FamilyAnswer::Verdict { parameters, verdict, as_flown } => match (&**verdict, as_flown) {
            (FamilyVerdict::Proved(family), AsFlown::NotHeld { at, .. }) => {
                let mut at = at.iter().map(|at| json!(at));
                let verdict = "not proved as it flies";
                (verdict, places(parameters, &mut at), Some(family.parts.len()))
            }
            (FamilyVerdict::Proved(family), _) => {
                let mut ends = parameters.iter().map(|one| json!(one.ends));
                ("proved", places(parameters, &mut ends), Some(family.parts.len()))
            }
            (FamilyVerdict::Refuted { at, .. }, _) => {
                let mut at = at.iter().map(|at| json!(at));
                ("refuted", places(parameters, &mut at), None)
            }
            (FamilyVerdict::Open { ends, .. }, _) => {
                let mut ends = ends.iter().map(|ends| json!(ends));
                ("open", places(parameters, &mut ends), None)
            }
        },
    };
    let scales_may_change = answer.proved().map(Family::scales_may_change);
    let crosses_in_s =
        answer.proved().and_then(|family| family.pace.as_ref()).map(|it| it.crosses_in_s);
    let members_asked = match answer {
        FamilyAnswer::Verdict { as_flown: AsFlown::Held { members, .. }, .. } => Some(*members),
        _ => None,
    };
    let told = json!({
        "verdict": verdict,
        "at": at,
        "parts": parts,
        "scales_may_change": scales_may_change,
        "numbers_may_cross_in_s": crosses_in_s,
        "in_words": answer.text(),
    });
    let not_held = answer.not_held().map(|(_, because)| because);
    merged([told, present(json!({ "not_held": not_held, "members_asked": members_asked }))])
}

//! The verbs: one function each, one row in the list.

mod compare;
mod export;
mod figure;
mod fly;
mod judge;
mod open;
mod shape;

use fspid_scenario::file::changed_text;
use fspid_study::moment::Moment;
use serde_json::json;

use crate::Answer;
use crate::question::{Question, wrong};

/// An answer, or one that says why there is none.
type Answered = Result<Answer, Answer>;
/// A verb: its name and what answers it.
type Verb = (&'static str, fn(&Question) -> Answered);

/// What can be asked.
const VERBS: [Verb; 13] = [
    ("shipped", |_| Ok(open::shipped())),
    ("open", open::open),
    ("set", set),
    ("fly", fly::fly),
    ("judge", judge::judge),
    ("verify", judge::verify),
    ("interval", judge::interval),
    ("certify", judge::certify),
    ("shape", shape::shape),
    ("explain", explain),
    ("figure", figure::figure),
    ("compare", compare::compare),
    ("export", export::export),
];

pub(crate) fn answer(question: &Question) -> Answer {
    let asked = question.optional("verb");
    match VERBS.iter().find(|(name, _)| *name == asked) {
        Some((_, verb)) => verb(question).unwrap_or_else(|refused| refused),
        None => {
            let known = VERBS.map(|(name, _)| name).join(", ");
            Answer::refused(format_args!("there is no verb `{asked}`; known are {known}"))
        }
    }
}

/// The text with one value changed.
fn set(question: &Question) -> Answered {
    let [text, path, value] = ["text", "path", "value"].map(|key| question.text(key));
    let text = changed_text(text?, path?, value?).map_err(|found| wrong(&found))?;
    Ok(Answer::of(json!({ "text": text })))
}

/// An instant of a flight.
fn explain(question: &Question) -> Answered {
    let study = question.study()?;
    let (controller, at_s) = (question.text("controller")?, question.number("at_s")?);
    let moment = Moment::of(&study, controller, at_s).map_err(Answer::refused)?;
    Ok(Answer::of(moment.json()))
}

//! A controller in another language, as one archive.

use fspid_export::{Target, archive};
use fspid_study::export::{Question as Asked, export as exported};
use serde_json::{Value, json};

use super::Answered;
use crate::Answer;
use crate::question::Question;

/// The files of `fspid export --to TARGET` in an archive that is called after their names' beginning.
pub(super) fn export(question: &Question) -> Answered {
    let (study, name) = (question.study()?, question.text("controller")?);
    let word = question.text("target")?;
    let target = Target::ALL.into_iter().find(|target| target.name() == word);
    let target = target.ok_or_else(|| {
        let known = Target::ALL.map(Target::name).join(", ");
        Answer::refused(format_args!("there is no target `{word}`; known are {known}"))
    })?;
    let asked = Asked { controller: Some(name), ..Asked::of(target) };
    let made = exported(&study, &asked).map_err(Answer::refused)?;
    let bytes = archive(&made.files);
    let mut answer = Answer::of(Value::Null);
    answer.json = json!({
        "name": format!("{}-{word}.zip", made.prefix),
        "files": made.files.iter().map(|it| &it.name).collect::<Vec<_>>(),
        "notes": made.notes,
        "archive": { "bytes": bytes.len(), "at": answer.keep_bytes(&bytes) },
    });
    Ok(answer)
}

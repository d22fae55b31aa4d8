//! Margins, requirements, certificates.

use std::path::Path;

use fspid_certify::{self as certify, Certification, Effort};
use fspid_scenario::count::MAP_POINTS;
use fspid_study::analysis::{Analysis, Columns, Question as Asked};
use fspid_study::verify::interval::{self, IntervalError};
use fspid_study::verify::{self, verify_text};
use serde_json::{Value, json};

use super::Answered;
use crate::Answer;
use crate::question::{NAME, Question, wrong};

/// The loops of a question's scenario, with a map of frozen gains of `map` points to a side.
pub(super) fn analysed(question: &Question) -> Result<Analysis, Answer> {
    let study = question.study()?;
    let map_points = question.count("map");
    MAP_POINTS.check(map_points).map_err(Answer::refused)?;
    let asked = Asked { map_points, ..Asked::default() };
    Analysis::of(&study, asked).map_err(Answer::refused)
}

/// The answer of `analyse --format json`, and its curves as columns.
pub(super) fn judge(question: &Question) -> Answered {
    let analysis = analysed(question)?;
    let mut answer = Answer::of(Value::Null);
    let loops = curves(&mut answer, analysis.open_loops());
    let poles = curves(&mut answer, analysis.poles().map_err(Answer::refused)?);
    answer.json = json!({
        "analysis": analysis.json(), "held": analysis.all_held(), "loops": loops, "poles": poles,
    });
    Ok(answer)
}

fn curves(answer: &mut Answer, all: Vec<(String, Columns)>) -> Vec<Value> {
    let one = |(name, columns): (String, Columns)| {
        let columns = columns.into_iter();
        let columns =
            columns.map(|(name, values)| json!({ "name": name, "at": answer.keep(values) }));
        json!({ "name": name, "columns": columns.collect::<Vec<_>>() })
    };
    all.into_iter().map(one).collect()
}

/// The answer of `verify --format json`.
pub(super) fn verify(question: &Question) -> Answered {
    let settings = question.texts("sets");
    let asked =
        verify::Question { path: Path::new(NAME), settings: &settings, requirement_files: &[] };
    match verify_text(question.text("text")?.to_owned(), &asked, &[]) {
        Ok(found) => {
            Ok(Answer::of(json!({ "verification": found.json(None), "met": found.all_met() })))
        }
        Err(verify::VerifyError::NothingRequired { .. }) => {
            Ok(Answer::of(json!({ "nothing_required": true })))
        }
        Err(verify::VerifyError::Load(fspid_scenario::file::LoadError::Problems(found))) => {
            Err(wrong(&found))
        }
        Err(error) => Err(Answer::refused(error)),
    }
}

/// In which interval a number keeps the requirements met, those of ready sets that are ticked among them.
pub(super) fn interval(question: &Question) -> Answered {
    let (text, path) = (question.text("text")?, question.text("path")?);
    let sets = question.texts("sets");
    let asked = interval::Question { text, name: NAME, folder: None, path, sets: &sets };
    match interval::interval(&asked) {
        Ok(found) => Ok(Answer::of(json!({ "interval": found.json() }))),
        Err(IntervalError::Problems(found)) => Err(wrong(&found)),
        Err(error) => Err(Answer::refused(error)),
    }
}

/// The answer of `certify --format json`, and the certificates.
pub(super) fn certify(question: &Question) -> Answered {
    let study = question.study()?;
    let only = question.optional("controller");
    let only = (!only.is_empty()).then_some(only);
    let found = Certification::of(&study, only, &Effort::default()).map_err(Answer::refused)?;
    // They are not read again, as `certificate_files` does: what reads them takes 84 kB of the page.
    let files = found.results.iter().filter_map(|it| {
        let text = certify::to_text(it.certificate()?, &it.origin);
        Some(json!({ "name": found.file_name(it), "text": text }))
    });
    Ok(Answer::of(json!({
        "certification": found.json(), "text": found.text(), "proved": found.all_proved(),
        "files": files.collect::<Vec<_>>(),
    })))
}

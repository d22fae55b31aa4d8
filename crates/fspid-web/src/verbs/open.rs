//! What there is to begin with, and what a scenario holds.

use fspid_export::Target;
use fspid_scenario::file::{self, STARTERS, Study, paths_json, paths_of};
use fspid_sim::{Controller, Flyer};
use serde_json::{Value, json};

use super::Answered;
use crate::Answer;
use crate::question::{NAME, Question, wrong};

/// Scenarios that come with the crates, each with its name, what it is about, and its text.
pub(super) fn shipped() -> Answer {
    let starters = STARTERS.iter().map(|it| (format!("init/{}", it.name), it.about, it.text));
    let paper = fspid_data::PAPER.into_iter().filter_map(|(name, text)| {
        Some((format!("paper/{}", name.strip_suffix(".toml")?), "", text))
    });
    let list = starters.chain(paper).filter(|(.., text)| flies(text));
    let list =
        list.map(|(name, about, text)| json!({ "name": name, "about": about, "text": text }));
    Answer::of(json!({ "scenarios": list.collect::<Vec<_>>() }))
}

/// True for a scenario among what there is to begin with: rule tables and fuzzy systems have no loop. To read them all
/// would take longer than to fly one.
fn flies(text: &str) -> bool {
    text.contains("\n[loop]")
}

/// What a scenario holds: its controllers, every place that can be changed, what is required of it.
pub(super) fn open(question: &Question) -> Answered {
    let study = question.study()?;
    let rows = paths_of(question.text("text")?, NAME, None, &[]).map_err(|found| wrong(&found))?;
    let (scenario, timing) = (&study.scenario, study.scenario.timing);
    let places = paths_json(&rows);
    let controllers = scenario.flyers().map(|flyer| controller(flyer, &places));
    Ok(Answer::of(json!({
        "name": scenario.name,
        "digest": study.digest,
        "warnings": study.warnings,
        "controllers": controllers.collect::<Vec<_>>(),
        "sample_period_s": timing.dt_s(),
        "duration_s": timing.end_s(),
        "requirements": requirements(&study),
        "paths": places["paths"],
        "targets": Target::ALL.into_iter().filter(|it| it.is_in_pages()).map(Target::name).collect::<Vec<_>>(),
    })))
}

fn controller(flyer: Flyer<'_>, places: &Value) -> Value {
    let kind = match flyer.controller() {
        None => "external",
        Some(Controller::Fixed(_)) => "fixed",
        Some(Controller::SelfTuning(_)) => "self-tuning",
    };
    json!({ "name": flyer.name(), "kind": kind, "path": path_of(flyer.name(), places) })
}

/// Where the keys of a controller are.
pub(super) fn path_of(name: &str, places: &Value) -> Option<String> {
    let mut rows = places["paths"].as_array()?.iter();
    rows.find_map(|row| {
        let path = row["path"].as_str()?.strip_suffix(".name")?;
        (path.starts_with("controller") && row["value"] == name).then(|| path.to_owned())
    })
}

fn requirements(study: &Study) -> Vec<Value> {
    let one = |it: &file::Requirement| {
        json!({
            "id": it.id, "measure": it.measure.name(), "controller": it.controller,
            "limits": it.limits_in_words(),
        })
    };
    study.requirements.iter().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scenario_that_is_shipped_is_good_without_a_file_beside_it() {
        let Answer { json, .. } = shipped();
        let all = json["scenarios"].as_array().expect("a list");
        assert!(all.len() > 20, "{}", all.len());
        for it in all {
            let text = it["text"].as_str().expect("a text");
            assert!(file::parse(text, NAME, None, &[]).is_ok(), "{}", it["name"]);
        }
    }
}

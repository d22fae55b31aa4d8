//! What is asked, and how it is answered: in a folder that keeps what was flown, or without one.

use std::path::PathBuf;

use fspid_scenario::count::RARE_FLIGHTS;
use fspid_scenario::file::read_text;
use fspid_study::output;
use serde_json::{Value, json};

use super::answer::{Found, Rare};
use super::importance::importance;
use super::record::Record;
use super::subset::subset;
use super::target::Target;
use crate::campaign::{Campaign, Progress};
use crate::error::CampaignError;
use crate::folder::Folder;
use crate::plan::Plan;
use crate::table::Digest;

/// Version of the files.
const SCHEMA: u64 = 1;

/// How rare failures are looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Subset simulation.
    Subset,
    /// Importance sampling by cross-entropy.
    Importance,
    /// Both, each with half of the flights, and whether they agree.
    Both,
}

impl Method {
    /// The word in files and answers.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Subset => "subset",
            Self::Importance => "importance",
            Self::Both => "both",
        }
    }
}

/// What is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// Id of the requirement that is not met.
    pub fails: String,
    /// The controller; the one that the requirement concerns, or the first, if none is named.
    pub controller: Option<String>,
    /// How it is looked for.
    pub method: Method,
    /// About how many flights may be flown.
    pub flights: u64,
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// Probability that it shall be below, if any is required.
    pub most: Option<f64>,
}

/// Answers a question on all threads of the pool that this is called in. In a folder, what was flown is kept, and read when the
/// same is asked again.
///
/// # Errors
/// A requirement or controller that there is not or that flights do not answer; another question or another process in the
/// folder; files that cannot be read or written.
pub fn rare(
    campaign: &Campaign,
    question: &Question,
    folder: Option<&Folder>,
    progress: &Progress,
) -> Result<Rare, CampaignError> {
    RARE_FLIGHTS.check(question.flights)?;
    if question.method == Method::Importance && question.most.is_some() {
        let reason = "importance sampling alone says nothing of regions that it did not find, so that it shows no probability to be below one that is required; take the method `subset` or `both`";
        return Err(CampaignError::NotOfFlights { reason: reason.to_owned() });
    }
    let target = || Target::of(campaign, progress, &question.fails, question.controller.as_deref());
    let asked = target()?;
    let json = asked_json(campaign, question, asked.controller());
    let id = Digest::of_texts([json.to_string().as_str()]).to_string();
    let _lock = folder.map(|folder| begin(folder, &json)).transpose()?;
    let of_method = |method: Method| match question.method {
        Method::Both => Some(question.flights / 2),
        asked => (asked == method).then_some(question.flights),
    };
    // One record after the other, so that parts have the same numbers each time.
    let mut record = Record::new(target()?, folder, &id);
    let climbed = of_method(Method::Subset);
    let climbed = climbed.map(|flights| subset(&mut record, question.seed, flights)).transpose()?;
    let aimed = of_method(Method::Importance);
    let aimed = aimed.map(|flights| importance(&mut record, question.seed, flights)).transpose()?;
    let found = Found { subset: climbed, importance: aimed };
    let answer = Rare::new(campaign, question, (record.target(), record.undecided()), found);
    if let Some(folder) = folder {
        let files = [
            (folder.path().join("answer.json"), format!("{:#}\n", answer.json())),
            (folder.path().join("levels.svg"), answer.figure()),
        ];
        let parts: Vec<(PathBuf, &[u8])> =
            files.iter().map(|(path, text)| (path.clone(), text.as_bytes())).collect();
        output::write_all(&parts)?;
    }
    Ok(answer)
}

/// Makes the folder this question's, or finds that it is.
fn begin(folder: &Folder, json: &Value) -> Result<crate::folder::Lock, CampaignError> {
    output::make_folder(&folder.flights_path())?;
    let lock = folder.lock(true)?;
    let path = folder.path().join("question.json");
    if folder.plan_path().exists() {
        let difference = "it is one of `fspid campaign run`".to_owned();
        return Err(CampaignError::OtherCampaign { path: folder.plan_path(), difference });
    }
    if !path.exists() {
        output::write(&path, format!("{json:#}\n"))?;
        return Ok(lock);
    }
    let found: Value = serde_json::from_str(&read_text(&path)?)
        .map_err(|error| CampaignError::Plan { path: path.clone(), reason: error.to_string() })?;
    match difference(&found, json) {
        None => Ok(lock),
        Some(difference) => Err(CampaignError::OtherCampaign { path, difference }),
    }
}

/// The question as a file has it: everything that decides about the flights.
fn asked_json(campaign: &Campaign, question: &Question, controller: &str) -> Value {
    let plan = campaign.plan();
    json!({
        "schema": SCHEMA,
        "program": Plan::this_program(),
        "fails": question.fails,
        "controller": controller,
        "method": question.method.name(),
        "flights": question.flights,
        // As text: JSON readers round whole numbers beyond 2^53.
        "seed": question.seed.to_string(),
        "scenario": { "digest": plan.scenario_digest, "changes": plan.overrides },
    })
}

/// The first key in which two questions differ, in words.
fn difference(found: &Value, asked: &Value) -> Option<String> {
    let keys = ["schema", "program", "fails", "controller", "method", "flights", "seed"];
    for key in keys {
        let (there, here) = (&found[key], &asked[key]);
        if there != here {
            return Some(format!("{key}: {there} there, {here} here"));
        }
    }
    (found != asked).then(|| "the scenario or its changes differ".to_owned())
}

//! What a campaign is: a scenario, how many runs, which seed, and how runs are cut into shards.
//!
//! A plan is a file `campaign.json` in the campaign's folder. Everything that decides about results
//! goes into [`Plan::id`]; the size of shards does not.

use std::path::{Path, PathBuf};

use fspid_scenario::count;
use fspid_scenario::file::{Extra, Template};
use serde_json::{Value, json};

use crate::error::CampaignError;
use crate::range::Range;
use crate::rows;
use crate::sample::Sampling;
use crate::table::Digest;

/// Version of the plan's format.
const SCHEMA: u64 = 1;
/// Most runs of a campaign.
pub const MOST_RUNS: u64 = count::RUNS.most;
/// Most runs of a shard, whose rows are in memory together: some 100 MB.
pub const MOST_SHARD_RUNS: u64 = count::SHARD_RUNS.most;
/// Runs of a shard where nothing else is asked for: a second or two of flights in lanes.
pub const SHARD_RUNS: u64 = 8192;
/// The same for flights that are flown one by one.
pub const SLOW_SHARD_RUNS: u64 = 256;

/// A campaign as it is planned.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plan {
    /// The scenario's text.
    pub scenario_text: String,
    /// What the scenario is called in messages and commands: its path, as it was given.
    pub scenario_path: String,
    /// Folder that the scenario's files are relative to, seen from the campaign's folder.
    pub scenario_folder: PathBuf,
    /// Digest of the scenario with its changes and everything it refers to.
    pub scenario_digest: String,
    /// Changes `path=value`.
    pub overrides: Vec<String>,
    /// How points are chosen.
    pub sampling: Sampling,
    /// How many runs.
    pub runs: u64,
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// Runs of each shard but the last.
    pub shard_runs: u64,
    /// Program and version that made the plan.
    pub program: String,
}

impl Plan {
    /// Name of the program and its version, as plans and results carry it.
    #[must_use]
    pub fn this_program() -> String {
        concat!("fspid ", env!("CARGO_PKG_VERSION")).to_owned()
    }

    /// What names the campaign: a digest of everything that decides about its results.
    #[must_use]
    pub fn id(&self) -> String {
        let numbers = [self.runs.to_string(), self.seed.to_string(), rows::FORMAT.to_string()];
        let texts = [self.scenario_digest.as_str(), self.sampling.name(), self.program.as_str()];
        Digest::of_texts(texts.into_iter().chain(numbers.iter().map(String::as_str))).to_string()
    }

    /// How many shards.
    #[must_use]
    pub fn shards(&self) -> u64 {
        self.runs.div_ceil(self.shard_runs.max(1))
    }

    /// The runs of shard `number`, from 0; `None` for a shard that there is not.
    #[must_use]
    pub fn shard(&self, number: u64) -> Option<Range> {
        let first = number.checked_mul(self.shard_runs)?;
        let end = first.checked_add(self.shard_runs)?.min(self.runs);
        (first < self.runs).then_some(Range { first, end })
    }

    /// The scenario, read again from the plan in `folder`.
    ///
    /// # Errors
    /// A scenario that is wrong, or whose files have changed since the plan.
    pub fn template(&self, folder: &Path) -> Result<Template, CampaignError> {
        let files = folder.join(&self.scenario_folder);
        let extra = Extra { overrides: &self.overrides, ..Extra::default() };
        let template =
            Template::parse(&self.scenario_text, &self.scenario_path, Some(&files), &extra)
                .map_err(CampaignError::Scenario)?;
        if template.study().digest != self.scenario_digest {
            return Err(CampaignError::Changed { path: self.scenario_path.clone() });
        }
        Ok(template)
    }

    /// The plan as a file has it.
    #[must_use]
    pub fn json(&self) -> Value {
        json!({
            "schema": SCHEMA,
            "campaign": self.id(),
            "program": self.program,
            "runs": self.runs,
            // As text: JSON readers round whole numbers beyond 2^53.
            "seed": self.seed.to_string(),
            "sampling": self.sampling.name(),
            "shard_runs": self.shard_runs,
            "scenario": {
                "path": self.scenario_path,
                "folder": self.scenario_folder.to_string_lossy(),
                "digest": self.scenario_digest,
                "changes": self.overrides,
                "text": self.scenario_text,
            },
        })
    }

    /// Reads a plan from the text of a file.
    ///
    /// # Errors
    /// The first thing that is wrong with it, in words.
    pub fn from_json(text: &str) -> Result<Self, String> {
        let value: Value = serde_json::from_str(text).map_err(|error| error.to_string())?;
        let at = |path: &str| value.pointer(path);
        let number = |path: &str| {
            let found = at(path).and_then(Value::as_u64);
            found.ok_or_else(|| format!("{path} is no whole number"))
        };
        let word = |path: &str| {
            let found = at(path).and_then(Value::as_str).map(str::to_owned);
            found.ok_or_else(|| format!("{path} is no text"))
        };
        if number("/schema")? != SCHEMA {
            return Err(format!("/schema is not {SCHEMA}"));
        }
        let changes = at("/scenario/changes").and_then(Value::as_array);
        let changes = changes.ok_or("/scenario/changes is no list")?;
        let overrides: Option<Vec<String>> =
            changes.iter().map(|change| change.as_str().map(str::to_owned)).collect();
        let sampling = word("/sampling")?;
        let plan = Self {
            scenario_text: word("/scenario/text")?,
            scenario_path: word("/scenario/path")?,
            scenario_folder: PathBuf::from(word("/scenario/folder")?),
            scenario_digest: word("/scenario/digest")?,
            overrides: overrides.ok_or("/scenario/changes holds what is no text")?,
            sampling: Sampling::from_name(&sampling)
                .ok_or_else(|| format!("/sampling is \"{sampling}\", which is unknown"))?,
            runs: number("/runs")?,
            seed: word("/seed")?.parse().map_err(|_| "/seed is no whole number".to_owned())?,
            shard_runs: number("/shard_runs")?,
            program: word("/program")?,
        };
        let numbers =
            [("/runs", plan.runs, MOST_RUNS), ("/shard_runs", plan.shard_runs, MOST_SHARD_RUNS)];
        for (path, found, most) in numbers {
            if !(1..=most).contains(&found) {
                return Err(format!("{path} is {found}; it must be from 1 to {most}"));
            }
        }
        if word("/campaign")? != plan.id() {
            return Err(
                "/campaign is not the digest of the rest: it was changed by hand".to_owned()
            );
        }
        Ok(plan)
    }
}

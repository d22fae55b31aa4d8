//! What lies in the folder of a campaign: one run as a scenario of its own, and the report.

use fspid_campaign::report::{self as page, Settings};
use fspid_campaign::summary::SummarySettings;
use fspid_campaign::{Campaign, CampaignError, Folder, replay};
use fspid_scenario::file::{changed_text, parse};
use serde_json::{Value, json};

use super::job::Job;
use crate::answer::Refusal;

/// The folder of a campaign that has begun.
fn folder(job: &Job) -> Result<Folder, Refusal> {
    if job.kind() != "campaign" {
        return Err(Refusal::missing(format_args!("a {} has no runs", job.kind())));
    }
    let found = job.folder().map(Folder::new);
    found.ok_or_else(|| Refusal::missing("the campaign has not begun yet"))
}

/// Run `number` of a campaign as a scenario: `{run, changes, text}`.
pub(crate) fn run(job: &Job, number: &str) -> Result<Value, Refusal> {
    let number: u64 =
        number.parse().map_err(|_| Refusal::missing("runs have numbers, from 0 on"))?;
    let folder = folder(job)?;
    let plan = folder.plan().map_err(Refusal::missing)?;
    let runs = plan.runs;
    if number >= runs {
        let most = CampaignError::NoRun { found: number, most: runs.saturating_sub(1) };
        return Err(Refusal::missing(most));
    }
    let campaign = Campaign::new(plan, folder.path()).map_err(Refusal::wrong)?;
    let changes = replay::changes(&campaign, &campaign.drawn(number));
    let plan = campaign.plan();
    let mut all = plan.overrides.iter().chain(&changes);
    let text = all.try_fold(plan.scenario_text.clone(), |text, change| {
        let (path, value) = change.split_once('=').unwrap_or((change, ""));
        changed_text(&text, path, value)
    });
    let text = text.map_err(|problems| Refusal::wrong(&problems))?;
    // A text is given away only if it says the same as the changes do.
    let folder = folder.path().join(&plan.scenario_folder);
    let told = parse(&text, &plan.scenario_path, Some(&folder), &[]);
    let told = told.map_err(|problems| Refusal::wrong(&problems))?;
    let meant = campaign.study(&campaign.drawn(number)).map_err(Refusal::wrong)?;
    match told.scenario == meant.scenario {
        true => Ok(json!({ "run": number, "changes": changes, "text": text })),
        false => Err(Refusal::wrong(format_args!(
            "run {number} cannot be written as a scenario; the command is: {}",
            replay::command(&campaign, &changes)
        ))),
    }
}

/// The report of a campaign as one page, of the runs that there are.
pub(crate) fn report(job: &Job) -> Result<String, Refusal> {
    let folder = folder(job)?;
    let merged = folder.merged_path();
    let path = if merged.exists() { merged.as_path() } else { folder.path() };
    let summary = SummarySettings { incomplete: true, ..SummarySettings::default() };
    let settings = Settings { summary, folder: None };
    page::page(path, &settings).map_err(Refusal::missing)
}

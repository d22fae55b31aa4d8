//! One run of a campaign flown again by itself, as `simulate` flies it.

use fspid_study::file::Study;
use fspid_study::simulation::Simulation;

use crate::campaign::Campaign;
use crate::engine;
use crate::error::CampaignError;
use crate::rows::Run;

/// A run flown again.
#[derive(Clone, Debug)]
pub struct Replay {
    /// Number of the run.
    pub number: u64,
    /// The changes that make the campaign's scenario this run's, as `--set` takes them.
    pub changes: Vec<String>,
    /// The run's scenario.
    pub study: Study,
    /// Its flight, with traces.
    pub simulation: Simulation,
    /// What the campaign keeps of it.
    pub run: Run,
}

/// Flies run `number` again.
///
/// # Errors
/// No such run; a run whose numbers make no scenario, or one that cannot be flown.
pub fn replay(campaign: &Campaign, number: u64) -> Result<Replay, CampaignError> {
    let most = campaign.plan().runs.saturating_sub(1);
    if number > most {
        return Err(CampaignError::NoRun { found: number, most });
    }
    let drawn = campaign.drawn(number);
    let refused = |reason| CampaignError::Refused { run: number, reason };
    let study = campaign.study(&drawn).map_err(refused)?;
    let simulation = Simulation::of(&study).map_err(|error| refused(error.to_string()))?;
    let flown = engine::fly(std::slice::from_ref(&study)).pop();
    let flights = match flown {
        Some(Ok(flights)) => Ok(flights),
        Some(Err(error)) => Err(error.to_string()),
        None => Ok(Vec::new()),
    };
    let changes = changes(campaign, &campaign.drawn(number));
    Ok(Replay { number, changes, study, simulation, run: Run { number, drawn, flights } })
}

/// What draws change in the scenario, as `--set` takes it.
#[must_use]
pub fn changes(campaign: &Campaign, drawn: &[fspid_study::dispersion::Drawn]) -> Vec<String> {
    let values = campaign.values(drawn);
    values.iter().map(|(path, value)| format!("{}={value}", path.text())).collect()
}

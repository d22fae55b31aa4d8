//! One run of a campaign flown again by itself, as `simulate` flies it.

use fspid_scenario::dispersion::Drawn;
use fspid_scenario::file::Study;
use fspid_study::shell;
use fspid_study::simulation::Simulation;
use serde_json::{Value, json};

use crate::campaign::Campaign;
use crate::error::CampaignError;

/// A run flown again.
#[derive(Clone, Debug)]
pub struct Replay {
    /// Number of the run.
    pub number: u64,
    /// What it draws.
    pub drawn: Vec<Drawn>,
    /// The changes that make the campaign's scenario this run's, as `--set` takes them.
    pub changes: Vec<String>,
    /// The run's scenario.
    pub study: Study,
    /// Its flight, with traces.
    pub simulation: Simulation,
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
    let changes = changes(campaign, &drawn);
    Ok(Replay { number, drawn, changes, study, simulation })
}

impl Replay {
    /// The answer for people: what was drawn, the command that flies it alone, and its measures.
    #[must_use]
    pub fn text(&self, campaign: &Campaign) -> String {
        let mut out = format!("run {} of {}\n", self.number, campaign.plan().scenario_path);
        for (name, drawn) in names(campaign).zip(&self.drawn) {
            out.push_str(&format!("  {name} = {}\n", shown(drawn)));
        }
        // A campaign of standard input has a scenario, but no file.
        let alone = match campaign.plan().scenario_path.as_str() {
            "-" => "alone, with the scenario on standard input",
            _ => "alone",
        };
        out.push_str(&format!(
            "  {alone}: {}\n\n{}",
            command(campaign, &self.changes),
            self.simulation.text()
        ));
        out
    }

    /// The answer for programs.
    #[must_use]
    pub fn json(&self, campaign: &Campaign) -> Value {
        let drawn = names(campaign).zip(&self.drawn).map(|(name, drawn)| {
            let value = match drawn {
                Drawn::Number(number) => json!(number),
                Drawn::Whole(whole) => json!(whole),
                Drawn::Text(text) => json!(text),
            };
            (name.to_owned(), value)
        });
        json!({
            "schema": 1,
            "run": self.number,
            "campaign": campaign.plan().id(),
            "parameters": drawn.collect::<serde_json::Map<_, _>>(),
            "changes": self.changes,
            "command": command(campaign, &self.changes),
            "simulation": self.simulation.json(),
        })
    }
}

/// The command that flies a campaign's scenario with changes, without the campaign.
#[must_use]
pub fn command(campaign: &Campaign, changes: &[String]) -> String {
    let plan = campaign.plan();
    let mut command = format!("fspid simulate {}", shell::word(&plan.scenario_path));
    for change in plan.overrides.iter().chain(changes) {
        command.push_str(&format!(" --set {}", shell::word(change)));
    }
    command
}

/// Names of what is drawn.
fn names(campaign: &Campaign) -> impl Iterator<Item = &str> {
    campaign.template().study().dispersions.iter().flat_map(|dispersion| dispersion.names())
}

fn shown(drawn: &Drawn) -> String {
    match drawn {
        Drawn::Number(number) => format!("{number:?}"),
        Drawn::Whole(whole) => whole.to_string(),
        Drawn::Text(text) => text.clone(),
    }
}

/// What draws change in the scenario, as `--set` takes it.
#[must_use]
pub fn changes(campaign: &Campaign, drawn: &[Drawn]) -> Vec<String> {
    let values = campaign.draws().values(drawn);
    values.iter().map(|(path, value)| format!("{}={value}", path.text())).collect()
}

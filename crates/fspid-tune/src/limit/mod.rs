//! How good could any controller be: the limit of a scenario's flight over travel, and how near its controllers come.
//!
//! The limit itself, its proof and its history of commands are those of `fspid-limit`. Here it is asked along a ladder of
//! travels and at the travel that each controller took, and told.

mod json;
mod near;
mod page;
mod rung;
mod text;
mod words;

use fspid_diagnostics::digits::rounded;
use fspid_limit::{Assumed, Question, SaidBeside, Still, measured};
pub use fspid_limit::{LimitError, Measure, Travel};
use fspid_scenario::file::Study;
use fspid_scenario::units::{degrees, radians};
use fspid_sim::Scenario;
use fspid_study::simulation::{ControllerResult, Simulation};
pub use near::NearLimit;
pub(crate) use near::{Shares, refusal, shares};
use rung::Asker;
pub use rung::{Causal, Rung};
pub(crate) use words::proved_percent;

/// Rungs of a ladder that nobody gave.
const RUNGS: i32 = 7;
/// Its ends beside the least and the most travel of the controllers.
const ENDS: [f64; 2] = [0.5, 2.0];
/// Commands of actuators without limits are taken to be within these, deg, or within as many times twice that as a
/// controller needs.
const WITHIN_DEG: f64 = 90.0;

/// The travel at which the limit is asked beside a flight of this travel, rad: what is flown is rounded, and this is
/// certainly not less.
pub(crate) fn unrounded(travel_rad: f64) -> f64 {
    travel_rad * (1.0 + 1e-9) + 1e-12
}

/// At which travels the limit is asked beside those of the controllers.
#[derive(Clone, Debug, PartialEq)]
pub enum Ladder {
    /// At some around those of the controllers.
    Around,
    /// At these, deg.
    Given(Vec<f64>),
    /// At no others.
    None,
}

/// What is told of a controller that took no travel.
const STILL: &str = "did not move the elevator";

/// A controller's name, and what it reached and took, rad, or why that cannot be compared.
type Compared = (String, Result<(f64, f64), String>);

/// What is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Of the error.
    pub measure: Measure,
    /// Whose way counts.
    pub travel: Travel,
    /// Which travels.
    pub ladder: Ladder,
    /// Whether commands may move before anything has happened.
    pub anticipate: bool,
    /// Whether what is reached without knowledge of the future is told, too.
    pub causal: bool,
}

/// The answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// Name of the scenario.
    pub scenario: String,
    /// What was asked.
    pub options: Options,
    /// Length of the flight and sample period, s.
    pub times_s: (f64, f64),
    /// The ladder, by travel.
    pub rungs: Vec<Rung>,
    /// The controllers, in the file's order.
    pub controllers: Vec<Standing>,
    /// What is said beside the answer.
    pub beside: Vec<SaidBeside>,
    /// Digest of the scenario.
    pub digest: String,
}

/// A controller beside the limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Standing {
    /// Its name.
    pub name: String,
    /// What it reached and took, rad; or in words why that cannot be compared.
    pub flown: Result<(f64, f64), String>,
    /// The limit at its travel.
    pub rung: Option<Rung>,
}

impl Standing {
    /// At least so much of what is possible at its travel it reaches, %: the proved limit as a share of its measure.
    #[must_use]
    pub fn share_pct(&self) -> Option<f64> {
        let (measure, _) = self.flown.as_ref().ok()?;
        let limit = self.rung.as_ref()?.limit.as_ref().ok()?;
        (*measure > 0.0).then(|| 100.0 * limit.proved / measure)
    }
}

impl Answer {
    /// Of a study; `told` hears what is being worked at, and `stop` is asked whether to go on.
    ///
    /// # Errors
    /// [`LimitError`]: everything that no limit can be told of, at once; no travel to begin with.
    pub fn of(
        study: &Study,
        options: Options,
        told: &dyn Fn(&str),
        stop: fn() -> bool,
    ) -> Result<Self, LimitError> {
        let (measure, travel) = (options.measure, options.travel);
        // What is refused is refused before anything flies.
        Question::of(&study.scenario, travel, Assumed::within(radians(WITHIN_DEG)))?;
        told("flying the controllers");
        let simulation = Simulation::of(study)?;
        let commands = simulation.results.iter().map(|it| it.trace.command_rad.as_slice());
        let assumed = assumed(&study.scenario, commands, options.anticipate);
        let question = Question::of(&study.scenario, travel, assumed)?;
        let flown: Vec<Compared> = simulation
            .results
            .iter()
            .map(|it| (it.name.clone(), compared(it, (measure, travel), question.dt_s())))
            .collect();
        let travels_rad = ladder(&options.ladder, &flown);
        if travels_rad.is_empty() && options.ladder != Ladder::None {
            let why = |it: Result<_, String>| it.err().unwrap_or_else(|| STILL.to_owned());
            return Err(LimitError::NoTravel(
                flown.into_iter().map(|(name, it)| (name, why(it))).collect(),
            ));
        }
        let mut asker = Asker::new(study, &question, &options, &flown, stop);
        let (count, whole) = (travels_rad.len(), travels_rad.len() + flown.len());
        let mut rungs = Vec::with_capacity(count);
        for (place, travel_rad) in travels_rad.into_iter().enumerate() {
            told(&format!("limit {} of {whole}", place + 1));
            rungs.push(asker.ask(travel_rad)?);
        }
        let mut controllers: Vec<Standing> = Vec::with_capacity(flown.len());
        for (place, (name, flown)) in flown.into_iter().enumerate() {
            told(&format!("limit {} of {whole}", count + place + 1));
            let way = flown.as_ref().ok().map(|(_, way)| unrounded(*way));
            let rung = way.map(|way| asker.ask(way)).transpose()?;
            controllers.push(Standing { name, flown, rung });
        }
        // What was flown for one rung serves all others.
        let rungs = rungs.into_iter().map(|it| asker.with_flights(it)).collect();
        for it in &mut controllers {
            it.rung = it.rung.take().map(|rung| asker.with_flights(rung));
        }
        let timing = study.scenario.timing;
        Ok(Self {
            scenario: study.scenario.name.clone(),
            times_s: (timing.end_s(), timing.dt_s()),
            beside: question.beside().to_vec(),
            digest: study.digest.clone(),
            options,
            rungs,
            controllers,
        })
    }

    /// For people.
    #[must_use]
    pub fn text(&self) -> String {
        text::text(self)
    }

    /// The table of the controllers with what is said beside it, for people.
    #[must_use]
    pub fn controllers_text(&self) -> String {
        text::controllers_with_beside(self)
    }

    /// For programs.
    #[must_use]
    pub fn json(&self) -> serde_json::Value {
        json::json(self)
    }

    /// The limit and who flies, as a chapter of another page.
    #[must_use]
    pub fn chapter(&self) -> fspid_page::analysis::Chapter {
        page::beside_flights(self)
    }

    /// As one HTML file; `command` is what made it.
    #[must_use]
    pub fn page(&self, command: &str) -> String {
        page::page(self, command)
    }
}

/// What commands are taken to be, so that those of all these flights are among them: within 90 deg, or the double of that,
/// and so on; and as still as they are until something happens, unless they may anticipate.
pub(crate) fn assumed<'a>(
    scenario: &Scenario,
    flown: impl Iterator<Item = &'a [f64]> + Clone,
    anticipate: bool,
) -> Assumed {
    let largest = flown.clone().flatten().fold(0.0_f64, |most, u| most.max(u.abs()));
    let mut within_rad = radians(WITHIN_DEG);
    while within_rad < largest && within_rad.is_finite() {
        within_rad *= 2.0;
    }
    let still = if anticipate { None } else { Still::of(scenario, flown) };
    Assumed { within_rad, still }
}

/// What a flight reached and took, rad, or why that is nothing to be compared.
fn compared(
    result: &ControllerResult,
    asked: (Measure, Travel),
    dt_s: f64,
) -> Result<(f64, f64), String> {
    let verdict = result.verdict();
    if verdict.is_failure() {
        return Err(verdict.to_string());
    }
    let trace = &result.trace;
    Ok(measured(
        asked,
        (&trace.setpoint_rad, &trace.theta_rad),
        (&trace.command_rad, &trace.elevator_rad),
        dt_s,
    ))
}

/// The travels that are asked for, rad, ascending.
fn ladder(asked: &Ladder, flown: &[Compared]) -> Vec<f64> {
    let mut travels: Vec<f64> = match asked {
        Ladder::None => Vec::new(),
        Ladder::Given(travels_deg) => travels_deg.iter().map(|it| radians(*it)).collect(),
        Ladder::Around => around(flown),
    };
    travels.sort_by(f64::total_cmp);
    travels.dedup_by(|one, other| (*one - *other).abs() <= 0.0);
    travels
}

/// From half of the least travel of a controller to twice the most, rad, in equal ratios, of two digits.
fn around(flown: &[Compared]) -> Vec<f64> {
    let ways = || flown.iter().filter_map(|(_, it)| it.as_ref().ok()).map(|(_, way)| *way);
    let least = ways().filter(|way| *way > 0.0).fold(f64::INFINITY, f64::min);
    let most = ways().fold(0.0, f64::max);
    if !(least <= most) {
        return Vec::new();
    }
    let (low, high) = (ENDS[0] * least, ENDS[1] * most);
    let step = libm::log(high / low) / f64::from(RUNGS - 1);
    let rung = |n: i32| rounded(degrees(low * libm::exp(step * f64::from(n))), 2);
    (0..RUNGS).map(|n| radians(rung(n))).collect()
}

//! A travel and what is possible within it. Every flight that was flown for one rung serves all that allow its travel.

use fspid_limit::{Limit, LimitError, Planner, Question, Reached, fly_commands, limit};
use fspid_scenario::file::Study;

use super::{Compared, Options};

/// A travel and what is possible within it.
#[derive(Clone, Debug, PartialEq)]
pub struct Rung {
    /// The travel, rad.
    pub travel_rad: f64,
    /// The limit, or why there is none.
    pub limit: Result<Limit, LimitError>,
    /// The best that was flown within the travel, by anybody; none where nobody kept to it.
    pub reached: Option<Reached>,
    /// What was reached without knowledge of the future; none where it was not asked or is not told.
    pub causal: Option<Causal>,
}

/// What somebody reached who knows no future: who plans, who flies in the scenario, or who gives no command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Causal {
    /// How often the planner planned.
    pub plans: usize,
    /// The best of what was flown within the travel.
    pub reached: Reached,
}

/// Asks for limits, and keeps what was flown.
pub(super) struct Asker<'a> {
    study: &'a Study,
    question: &'a Question,
    options: &'a Options,
    stop: fn() -> bool,
    planner: Option<Planner<'a>>,
    /// By commands that know the future.
    foreseeing: Vec<Reached>,
    /// By the scenario's controllers, and without a command.
    flown: Vec<Reached>,
}

impl<'a> Asker<'a> {
    pub(super) fn new(
        study: &'a Study,
        question: &'a Question,
        options: &'a Options,
        compared: &[Compared],
        stop: fn() -> bool,
    ) -> Self {
        let asked = (options.measure, options.travel);
        let scenario = &study.scenario;
        let planner = options.causal.then(|| Planner::new(scenario, question, asked, stop));
        let own = compared.iter().filter_map(|(_, it)| it.as_ref().ok());
        let own = own.map(|(measure, way)| Reached { measure: *measure, travel_rad: *way });
        // Where doing nothing loses the aircraft, it reaches nothing.
        let nothing = fly_commands(scenario, &[], asked).ok();
        let nothing = nothing.as_ref().map(Reached::from);
        Self {
            study,
            question,
            options,
            stop,
            planner: planner.flatten(),
            foreseeing: Vec::new(),
            flown: own.chain(nothing).collect(),
        }
    }

    /// The limit at a travel, rad, and flights for it; what ends all of the work is an error.
    pub(super) fn ask(&mut self, travel_rad: f64) -> Result<Rung, LimitError> {
        let asked = (self.options.measure, self.options.travel);
        let limit = limit(&self.study.scenario, self.question, asked, travel_rad, self.stop);
        match &limit {
            Err(LimitError::Stopped) => return Err(LimitError::Stopped),
            Err(_) => {}
            Ok(limit) => {
                self.foreseeing.extend(limit.reached.as_ref().map(Reached::from));
                if let Some(planner) = &mut self.planner {
                    planner.search(travel_rad)?;
                }
            }
        }
        Ok(Rung { travel_rad, limit, reached: None, causal: None })
    }

    /// With the best of all that was flown for any rung.
    pub(super) fn with_flights(&self, rung: Rung) -> Rung {
        let travel_rad = rung.travel_rad;
        let planned = || self.planner.iter().flat_map(Planner::reached);
        let causal = || planned().chain(self.flown.iter().copied());
        let all = causal().chain(self.foreseeing.iter().copied());
        let reached = Reached::least_within(travel_rad, all);
        let limit = match rung.limit {
            // Somebody did what a solver calls impossible.
            Err(LimitError::TravelTooSmall)
                if reached.is_some_and(|it| it.travel_rad <= travel_rad) =>
            {
                let status = "it finds none within a travel that was flown".to_owned();
                Err(LimitError::Solver { status })
            }
            limit => limit,
        };
        let told = limit != Err(LimitError::TravelTooSmall);
        let plans = self.planner.as_ref().map(Planner::plans);
        let best = plans.zip(Reached::least_within(travel_rad, causal()));
        Rung {
            travel_rad,
            limit,
            reached: reached.filter(|_| told),
            causal: best.filter(|_| told).map(|(plans, reached)| Causal { plans, reached }),
        }
    }
}

//! How near what a search found comes to the limit, flight by flight.

use fspid_scenario::file::Study;
use fspid_study::simulation::Simulation;

use crate::error::TuneError;
use crate::limit::{NearLimit, Shares, refusal, shares};
use crate::problem::TuningProblem;

impl TuningProblem {
    /// How much of what is possible at its own travel a candidate reaches in each flight that it is tuned on.
    ///
    /// # Errors
    /// [`TuneError::Stopped`].
    pub fn near_limit(
        &self,
        point: &[f64],
        told: &dyn Fn(&str),
        stop: fn() -> bool,
    ) -> Result<NearLimit, TuneError> {
        let flights = self.its_flights();
        let (mut shares, mut cases, mut beside) = (Vec::new(), Vec::new(), Vec::new());
        for (place, (case, run)) in flights.jobs().enumerate() {
            told(&format!("limit of flight {} of {}", place + 1, flights.count()));
            let share = match flights.study(point, case, run) {
                Ok(study) => self.share(&study, stop)?,
                Err(why) => Err(why),
            };
            let name = match case.runs() {
                1 => case.name.clone(),
                runs => format!("{}, draw {} of {runs}", case.name, run + 1),
            };
            cases.push((name, share.as_ref().err().cloned()));
            let (share, said) = share.unwrap_or_default();
            shares.push(share.into_iter().next().flatten());
            beside.push(said);
        }
        Ok(NearLimit { controllers: vec![(self.controller().to_owned(), shares)], cases, beside })
    }

    /// The share of a flight with what is said beside it, or why there is none.
    fn share(
        &self,
        study: &Study,
        stop: fn() -> bool,
    ) -> Result<Result<Shares, String>, TuneError> {
        if let Some(why) = refusal(&study.scenario) {
            return Ok(Err(why));
        }
        let simulation = match Simulation::of(study) {
            Ok(simulation) => simulation,
            Err(error) => return Ok(Err(error.to_string())),
        };
        let Some(own) = simulation.results.into_iter().find(|it| it.name == self.controller())
        else {
            return Ok(Err("nobody flies".to_owned()));
        };
        let verdict = own.verdict();
        if verdict.is_failure() {
            return Ok(Err(verdict.to_string()));
        }
        shares(&study.scenario, &[Some(own.trace)], stop)
    }
}

//! How near the best designs of a contest come to the limit, case by case.

use fspid_sim::{Trace, simulate};

use super::{Contest, Judged, Outcome};
use crate::error::TuneError;
use crate::limit::{NearLimit, Shares, refusal, shares};

impl Contest {
    /// The limit of every case of which one can be told, at the travel of every controller's best design.
    ///
    /// # Errors
    /// [`TuneError::Stopped`]; a case that cannot be read.
    pub fn near_limit(
        &self,
        outcome: &Outcome,
        told: &dyn Fn(&str),
        stop: fn() -> bool,
    ) -> Result<NearLimit, TuneError> {
        let judged = &outcome.judged;
        let best: Vec<usize> = judged.contestants.iter().map(Judged::best).collect();
        let mut controllers: Vec<(String, Vec<Option<f64>>)> =
            judged.contestants.iter().map(|it| (it.name.clone(), Vec::new())).collect();
        let (mut cases, mut beside) = (Vec::new(), Vec::new());
        for (place, case) in self.rules.cases.iter().enumerate() {
            told(&format!("limit of case {} of {}", place + 1, self.rules.cases.len()));
            let shares = match self.rules.runs {
                0 => self.shares(place, (outcome, &best), stop)?,
                _ => Err("its aircraft are drawn".to_owned()),
            };
            cases.push((case.name.clone(), shares.as_ref().err().cloned()));
            let (shares, said) = shares.unwrap_or_else(|_| (vec![None; best.len()], Vec::new()));
            beside.push(said);
            controllers.iter_mut().zip(shares).for_each(|((_, mine), share)| mine.push(share));
        }
        Ok(NearLimit { controllers, cases, beside })
    }

    /// The shares of the best designs in a case, or why there are none.
    fn shares(
        &self,
        place: usize,
        (outcome, best): (&Outcome, &[usize]),
        stop: fn() -> bool,
    ) -> Result<Result<Shares, String>, TuneError> {
        let template = self.source.case(&self.rules.cases[place])?;
        let scenario = &template.study().scenario;
        // What is refused is refused before anything flies.
        if let Some(why) = refusal(scenario) {
            return Ok(Err(why));
        }
        let traces: Vec<Option<Trace>> =
            (0..best.len()).map(|who| self.flown_again(outcome, (who, best[who]), place)).collect();
        shares(scenario, &traces, stop)
    }

    /// The flight of a design in a case, unless it was lost.
    fn flown_again(
        &self,
        outcome: &Outcome,
        (who, design): (usize, usize),
        place: usize,
    ) -> Option<Trace> {
        let design = outcome.judged.contestants.get(who)?.designs.get(design)?;
        let before: usize = outcome.judged.cases.iter().take(place).map(|it| it.runs).sum();
        let is_lost = design.flights.get(before).is_none_or(|flight| flight.lost);
        let entrant = self.entrants.get(who).filter(|_| !is_lost)?;
        let point = design.found.as_ref().map_or(&[][..], |found| found.point.as_slice());
        let study = entrant.flights.study(point, entrant.flights.cases().get(place)?, 0).ok()?;
        let named = study.scenario.flyers().position(|it| it.name() == entrant.name)?;
        simulate(&study.scenario).ok()?.traces.into_iter().nth(named)
    }
}

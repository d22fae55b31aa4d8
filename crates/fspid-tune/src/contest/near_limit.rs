//! How near the best designs come to the limit, case by case, at the travel that each took.
//!
//! One programme serves flights of like travels: its multipliers make a bound at every travel, and near their own a good
//! one, since the limit is a convex function of the travel and they are its slope.

use fspid_limit::{
    Assumed, LimitError, Measure, Multipliers, Programme, Question, Travel, measured, prove,
};
use fspid_page::columns::{Align, Columns};
use fspid_page::number::fixed;
use fspid_sim::{Trace, simulate};
use serde_json::{Value, json};

use super::words::cut;
use super::{Contest, Judged, Outcome};
use crate::error::TuneError;
use crate::limit::{assumed, unrounded};

/// Travels within this factor share a programme.
const NEAR: f64 = 1.1;

/// How near a contest's best designs come to the limit.
#[derive(Clone, Debug, PartialEq)]
pub struct NearLimit {
    /// The controllers, in the order of the scenario, each with a share for each case, of 1: the proved limit over what it
    /// reached; none where it was lost or there is no limit.
    pub controllers: Vec<(String, Vec<Option<f64>>)>,
    /// Names of the cases, each with why it has no limit, where it has none.
    pub cases: Vec<(String, Option<String>)>,
}

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
        let mut cases = Vec::new();
        for (place, case) in self.rules.cases.iter().enumerate() {
            told(&format!("limit of case {} of {}", place + 1, self.rules.cases.len()));
            let shares = match self.rules.runs {
                0 => self.shares(place, (outcome, &best), stop)?,
                _ => Err("its aircraft are drawn".to_owned()),
            };
            cases.push((case.name.clone(), shares.as_ref().err().cloned()));
            let shares = shares.unwrap_or_else(|_| vec![None; best.len()]);
            controllers.iter_mut().zip(shares).for_each(|((_, mine), share)| mine.push(share));
        }
        Ok(NearLimit { controllers, cases })
    }

    /// The shares of the best designs in a case, or why there are none.
    fn shares(
        &self,
        place: usize,
        (outcome, best): (&Outcome, &[usize]),
        stop: fn() -> bool,
    ) -> Result<Result<Vec<Option<f64>>, String>, TuneError> {
        let template = self.source.case(&self.rules.cases[place])?;
        let scenario = &template.study().scenario;
        // What is refused is refused before anything flies.
        if let Err(error) = Question::of(scenario, Travel::Elevator, Assumed::within(1.0)) {
            return Ok(Err(reason(&error)));
        }
        let traces: Vec<Option<Trace>> =
            (0..best.len()).map(|who| self.flown_again(outcome, (who, best[who]), place)).collect();
        let commands = traces.iter().flatten().map(|it| it.command_rad.as_slice());
        let assumed = assumed(scenario, commands, false);
        let question = match Question::of(scenario, Travel::Elevator, assumed) {
            Ok(question) => question,
            Err(error) => return Ok(Err(reason(&error))),
        };
        let mut asker = Asker { question: &question, solved: Vec::new(), stop };
        let share = |trace: &Option<Trace>| match trace {
            Some(trace) => asker.share(trace),
            None => Ok(None),
        };
        traces.iter().map(share).collect::<Result<Vec<_>, TuneError>>().map(Ok)
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

/// Bounds of one case, by as few programmes as will do.
struct Asker<'a> {
    question: &'a Question,
    solved: Vec<(f64, Multipliers)>,
    stop: fn() -> bool,
}

impl Asker<'_> {
    /// The proved limit at a flight's own travel over its own error.
    fn share(&mut self, trace: &Trace) -> Result<Option<f64>, TuneError> {
        let asked = (Measure::Iae, Travel::Elevator);
        let (iae, way) = measured(
            asked,
            (&trace.setpoint_rad, &trace.theta_rad),
            (&trace.command_rad, &trace.elevator_rad),
            self.question.dt_s(),
        );
        let travel_rad = unrounded(way);
        let is_near = |at: f64| at / travel_rad < NEAR && travel_rad / at < NEAR;
        if !self.solved.iter().any(|(at, _)| is_near(*at)) {
            match Programme::new(self.question, asked.0).solve(travel_rad, self.stop) {
                Ok(solution) => self.solved.push((travel_rad, solution.multipliers)),
                Err(LimitError::Stopped) => return Err(TuneError::Stopped),
                Err(_) => {}
            }
        }
        let bounds = self.solved.iter().filter_map(|(_, multipliers)| {
            prove(self.question, asked.0, travel_rad, multipliers).ok()
        });
        let proved = bounds.fold(0.0, f64::max);
        Ok((iae > 0.0).then(|| proved / iae))
    }
}

/// Why a case has no limit, in a few words.
fn reason(error: &LimitError) -> String {
    match error {
        LimitError::Refused(refusals) => {
            let first = refusals.first().map(ToString::to_string).unwrap_or_default();
            first.split(':').next().unwrap_or_default().to_owned()
        }
        other => other.to_string(),
    }
}

impl NearLimit {
    /// Means of the shares over the cases that all have one, geometric, of 1, and how many cases these are.
    #[must_use]
    pub fn means(&self) -> (Vec<f64>, usize) {
        let all = |case: &usize| {
            self.controllers.iter().all(|(_, shares)| {
                shares.get(*case).copied().flatten().is_some_and(|share| share > 0.0)
            })
        };
        let cases: Vec<usize> = (0..self.cases.len()).filter(all).collect();
        let mean = |(_, shares): &(String, Vec<Option<f64>>)| {
            let logs = cases.iter().filter_map(|case| shares.get(*case).copied().flatten());
            libm::exp(logs.map(libm::log).sum::<f64>() / cases.len().max(1) as f64)
        };
        (self.controllers.iter().map(mean).collect(), cases.len())
    }

    /// For people.
    #[must_use]
    pub fn text(&self) -> String {
        let (means, count) = self.means();
        let mut out = format!(
            "\nOf what is possible at its own travel, proved; its best design, over {count} of {} cases:\n",
            self.cases.len()
        );
        let mut rows = Columns::new(&[
            ("controller", Align::Left),
            ("mean [%]", Align::Right),
            ("least [%]", Align::Right),
            ("most [%]", Align::Right),
        ]);
        for ((name, shares), mean) in self.controllers.iter().zip(means) {
            let shares = || shares.iter().flatten().copied();
            let least = shares().fold(f64::INFINITY, f64::min);
            let most = shares().fold(f64::NEG_INFINITY, f64::max);
            let mean = if count > 0 { mean } else { f64::NAN };
            let percent = |share: f64| fixed(100.0 * share, 0);
            rows.row(vec![cut(name, 40), percent(mean), percent(least), percent(most)]);
        }
        out.push_str(&rows.to_string());
        let mut reasons: Vec<(&str, usize)> = Vec::new();
        for why in self.cases.iter().filter_map(|(_, why)| why.as_deref()) {
            match reasons.iter_mut().find(|(known, _)| *known == why) {
                Some((_, count)) => *count += 1,
                None => reasons.push((why, 1)),
            }
        }
        for (why, count) in reasons {
            out.push_str(&format!("  no limit of {count} cases: {why}\n"));
        }
        out
    }

    /// For programs.
    #[must_use]
    pub fn json(&self) -> Value {
        let (means, count) = self.means();
        let percent = |share: f64| (count > 0).then_some(100.0 * share);
        let controllers = self.controllers.iter().zip(means).map(|((name, shares), mean)| {
            let each: Vec<Option<f64>> =
                shares.iter().map(|it| it.map(|share| 100.0 * share)).collect();
            json!({ "name": name, "of_possible_pct": percent(mean), "by_case_pct": each })
        });
        let cases = self.cases.iter().map(|(name, why)| json!({ "name": name, "why_none": why }));
        json!({
            "controllers": controllers.collect::<Vec<_>>(),
            "cases": cases.collect::<Vec<_>>(),
            "cases_of_mean": count,
        })
    }
}

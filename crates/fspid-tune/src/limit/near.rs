//! How near flights come to the limit, case by case, each at the travel that it took.
//!
//! One programme serves flights of like travels: its multipliers make a bound at every travel, and near their own a good
//! one, since the limit is a convex function of the travel and they are its slope.

use fspid_limit::{
    Assumed, LimitError, Measure, Multipliers, Programme, Question, SaidBeside, Travel, measured,
    prove,
};
use fspid_page::columns::{Align, Columns, cut};
use fspid_sim::{Scenario, Trace};
use serde_json::{Value, json};

use super::words::{beside_cases, proved_percent};
use super::{assumed, unrounded};
use crate::error::TuneError;

/// Travels within this factor share a programme.
const NEAR: f64 = 1.1;

/// How near the best designs come to the limit.
#[derive(Clone, Debug, PartialEq)]
pub struct NearLimit {
    /// The controllers, in the order of the scenario, each with a share for each case, of 1: the proved limit over what it
    /// reached; none where it was lost or there is no limit.
    pub controllers: Vec<(String, Vec<Option<f64>>)>,
    /// Names of the cases, each with why it has no limit, where it has none.
    pub cases: Vec<(String, Option<String>)>,
    /// What is taken of commands and flights in each case that has a limit, and said beside it.
    pub beside: Vec<Vec<SaidBeside>>,
}

/// Shares of the limit of a case, and what is said beside them.
pub(crate) type Shares = (Vec<Option<f64>>, Vec<SaidBeside>);

/// What cannot be asked of a scenario whatever flies there, in a few words.
pub(crate) fn refusal(scenario: &Scenario) -> Option<String> {
    Question::of(scenario, Travel::Elevator, Assumed::within(1.0)).err().map(|it| reason(&it))
}

/// The proved limit of a scenario over what each of some flights of it reached, at its own travel; none for a flight that is
/// none. In words why there is no limit.
///
/// # Errors
/// [`TuneError::Stopped`].
pub(crate) fn shares(
    scenario: &Scenario,
    traces: &[Option<Trace>],
    stop: fn() -> bool,
) -> Result<Result<Shares, String>, TuneError> {
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
    let found = traces.iter().map(share).collect::<Result<Vec<_>, TuneError>>()?;
    Ok(Ok((found, question.beside().to_vec())))
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

    /// The means, %; none where no case serves all.
    #[must_use]
    pub fn of_possible_pct(&self) -> Vec<Option<f64>> {
        let (means, count) = self.means();
        means.into_iter().map(|mean| (count > 0).then_some(100.0 * mean)).collect()
    }

    /// What is said beside the limits of all these, a sentence each.
    pub(crate) fn said_beside<'a>(all: impl Iterator<Item = &'a Self>) -> Vec<String> {
        let cases: Vec<Vec<SaidBeside>> = all.flat_map(|it| it.beside.iter().cloned()).collect();
        beside_cases(&cases)
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
            let shares = [mean, least, most].map(|share| proved_percent(100.0 * share));
            rows.row([vec![cut(name, 40)], shares.to_vec()].concat());
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
        for sentence in beside_cases(&self.beside) {
            out.push_str(&format!("  {sentence}\n"));
        }
        out
    }

    /// For programs.
    #[must_use]
    pub fn json(&self) -> Value {
        let (_, count) = self.means();
        let means = self.of_possible_pct();
        let controllers = self.controllers.iter().zip(means).map(|((name, shares), mean)| {
            let each: Vec<Option<f64>> =
                shares.iter().map(|it| it.map(|share| 100.0 * share)).collect();
            json!({ "name": name, "of_possible_pct": mean, "by_case_pct": each })
        });
        let cases = self.cases.iter().map(|(name, why)| json!({ "name": name, "why_none": why }));
        json!({
            "controllers": controllers.collect::<Vec<_>>(),
            "cases": cases.collect::<Vec<_>>(),
            "cases_of_mean": count,
            "beside": beside_cases(&self.beside),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// They were rounded to the nearest: 61.845 % proved were told as 62.
    #[test]
    fn shares_that_are_proved_are_never_told_as_more() {
        let share = 0.618_45;
        let near = NearLimit {
            controllers: vec![("PID".to_owned(), vec![Some(share), Some(share)])],
            cases: vec![("one".to_owned(), None), ("two".to_owned(), None)],
            beside: Vec::new(),
        };
        let text = near.text();
        assert_eq!((text.matches("61").count(), text.matches("62").count()), (3, 0), "{text}");
        assert_eq!(proved_percent(61.999), "61");
    }

    /// They stood beside the answers of `limit` alone.
    #[test]
    fn what_is_taken_of_commands_is_said_once_with_how_many_cases_it_is_of() {
        let still = |within_rad: f64| {
            SaidBeside::Still(fspid_limit::Still { until: 10, until_s: 1.0, within_rad })
        };
        let near = NearLimit {
            controllers: vec![("PID".to_owned(), vec![Some(0.5); 3])],
            cases: ["one", "two", "three"].map(|name| (name.to_owned(), None)).to_vec(),
            beside: vec![
                vec![still(0.01), SaidBeside::Air],
                vec![still(0.02)],
                vec![SaidBeside::Within(1.6)],
            ],
        };
        let text = near.text();
        let sentences: Vec<&str> = text.lines().filter(|it| it.contains("taken")).collect();
        assert_eq!(sentences.len(), 3, "{text}");
        assert!(sentences[0].starts_with("  2 of 3 cases: Until something happens"), "{text}");
        assert!(sentences[0].contains("within ± 1.146 deg"), "the most of both: {text}");
        assert!(
            sentences[1].starts_with("  1 of 3 cases: ") && sentences[1].contains("air"),
            "{text}"
        );
        assert!(sentences[2].contains("± 91.67 deg"), "{text}");
        assert_eq!(near.json()["beside"].as_array().map(Vec::len), Some(3));
    }
}

//! What keeps a win from being one, as in a contest: loops that are unstable at rest, or of which nobody can tell, and flights
//! that fail.

use fspid_campaign::engine::{FlightResult, Memory};
use fspid_campaign::rows::UNDECIDED;
use fspid_scenario::file::Study;

use super::flown::{Value, Watch, judged};
use crate::contest::{
    Bar, Case, Contestant, Count, Design, Flight, Judged, barred, measured, some_of,
};
use crate::error::TuneError;

/// A flight that is asked what a contest asks.
pub(super) struct Contested {
    pub(super) value: Value,
    /// None where it could not be flown.
    pub(super) result: Option<FlightResult>,
    pub(super) flight: Flight,
}

impl Contested {
    /// Flies a study as a contest does.
    pub(super) fn of(
        memory: &mut Memory,
        study: &Study,
        watch: Watch<'_>,
    ) -> Result<Self, TuneError> {
        let mut asked = study.clone();
        asked.requirements.extend(measured(&[]));
        let result = judged(memory, std::slice::from_ref(&asked), watch)?.pop().flatten();
        let Some(mut result) = result else {
            let flight = Flight::refused("it cannot be flown".to_owned());
            return Ok(Self { value: Value::LOST, result: None, flight });
        };
        let flight = Flight::of(&result, &[], study.scenario.timing.end_s());
        // What the contest asks beside the requirements breaks none of them.
        result.judgements.pop();
        let mut value = Value::of(&result);
        if flight.unstable {
            value.stability = Some(UNSTABLE);
        }
        Ok(Self { value, result: Some(result), flight })
    }
}

/// The word of loops that are unstable at rest.
pub(super) const UNSTABLE: &str = "unstable";

/// How many of some flights are of loops with such a stability; none where nobody was asked.
pub(super) fn count<'a>(flown: impl Iterator<Item = &'a Value> + Clone, word: &str) -> Option<u64> {
    let is_asked = flown.clone().any(|it| it.stability.is_some());
    is_asked.then(|| flown.filter(|it| it.stability == Some(word)).count() as u64)
}

/// A controller with its flights, of each case one.
#[derive(Default)]
pub(super) struct Flier {
    pub(super) name: String,
    pub(super) values: Vec<Value>,
    pub(super) flights: Vec<Flight>,
}

impl Flier {
    /// What of its flights says nothing of who is better.
    fn doubt(&self) -> Option<String> {
        let some = |word: &str, what: &str| {
            let found = count(self.values.iter(), word).filter(|it| *it > 0)?;
            Some(format!("{} of loops {what}", some_of(found, self.values.len() as u64)))
        };
        let is_unstable = some(UNSTABLE, "that are unstable at rest");
        is_unstable
            .or_else(|| some(UNDECIDED, "of which nobody can tell whether they are stable at rest"))
    }

    fn contestant(self) -> Contestant {
        let design = Design { found: None, flights: self.flights };
        Contestant { name: self.name, is_tuned: false, designs: vec![design] }
    }
}

/// Why there is no win, in a sentence; of the self-tuner, and of the one that it is compared with.
pub(super) fn bar(own: Flier, other: Option<Flier>) -> Option<String> {
    let by = format!("Nothing is won by {}", own.name);
    if let Some(doubt) = own.doubt() {
        return Some(format!("{by}: {doubt}."));
    }
    if let Some((name, doubt)) = other.as_ref().and_then(|it| Some((&it.name, it.doubt()?))) {
        return Some(format!("Nothing is won over {name}: {doubt}."));
    }
    let beside = other.as_ref().map(|it| it.name.clone());
    let case = Case {
        name: String::new(),
        group: String::new(),
        set: Vec::new(),
        weight: 1.0,
        runs: 1,
        draws_seed: None,
        mirror_of: None,
    };
    let cases = vec![case; own.flights.len()];
    let contestants = [Some(own), other].into_iter().flatten().map(Flier::contestant).collect();
    let judged = Judged::new(contestants, cases, 0);
    let found = barred(&judged, 0, judged.contestants.len() - 1)?;
    let count = |it: &Contestant| judged.count(it, &judged.all());
    let [mine, theirs] = [judged.contestants.first()?, judged.contestants.last()?].map(count);
    let failing = |it: Count| format!("{} of {}", it.failed, it.of);
    Some(match (found, beside) {
        (Bar::FailsMore, Some(beside)) => format!(
            "{by}: {} of its flights fail, and {} of those of {beside}.",
            failing(mine),
            failing(theirs)
        ),
        _ => format!("{by}: all of its flights fail."),
    })
}

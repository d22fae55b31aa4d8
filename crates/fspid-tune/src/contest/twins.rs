//! Cases that fly the same, if for longer or later: what a contest counts as evidence twice, or has been tuned on.

use fspid_scenario::dispersion::Dispersion;
use fspid_scenario::file::{Study, Template};
use fspid_sim::Scenario;

use crate::error::TuneError;
use crate::source::Source;

/// What is wrong with the cases that are judged on, each with its name: one that flies what an earlier one flies, and one that
/// flies what a case of the tuning flies, however both are written. `runs` of each case are drawn.
pub(super) fn problems<'a>(
    source: &Source,
    study: &Study,
    runs: u64,
    judged: impl Iterator<Item = (&'a str, &'a Template)>,
) -> Result<Vec<String>, TuneError> {
    let trained = trained(source, study)?;
    let (mut problems, mut before) = (Vec::<String>::new(), Vec::<(&str, Flown)>::new());
    for (name, template) in judged {
        let flown = Flown::of(template.study(), runs);
        if let Some((twin, other)) = trained.iter().find(|(_, other)| other.is_as(&flown)) {
            let when = flown.when_beside(other);
            problems.push(format!(
                "case \"{name}\" flies what \"{twin}\" of the tuning flies{when}; judge on what nobody was tuned on"
            ));
        }
        if let Some((twin, other)) = before.iter().find(|(_, other)| other.is_as(&flown)) {
            let when = flown.when_beside(other);
            problems.push(format!(
                "case \"{name}\" flies what case \"{twin}\" flies{when}, and would count twice; leave one of them out"
            ));
        }
        before.push((name, flown));
    }
    Ok(problems)
}

/// What each case of the tuning flies; the scenario as it is written where it has none.
fn trained(source: &Source, study: &Study) -> Result<Vec<(String, Flown)>, TuneError> {
    let Some(tuning) = &study.tuning else {
        return Ok(Vec::new());
    };
    if tuning.cases.is_empty() {
        return Ok(vec![("the scenario as written".to_owned(), Flown::of(study, tuning.runs))]);
    }
    let mut trained = Vec::new();
    for case in &tuning.cases {
        match source.case(case) {
            Ok(template) => {
                trained.push((case.name.clone(), Flown::of(template.study(), tuning.runs)))
            }
            // It is told by those who tune on it.
            Err(TuneError::Case(_)) => {}
            Err(error) => return Err(error),
        }
    }
    Ok(trained)
}

/// All that decides about the flights of a case.
struct Flown {
    /// Without a name.
    scenario: Scenario,
    dispersions: Vec<Dispersion>,
    /// The same whenever it is flown, and what of it acts within its time; nothing where aircraft are drawn.
    whenever: Option<[Scenario; 2]>,
}

impl Flown {
    fn of(study: &Study, runs: u64) -> Self {
        // What it is called changes nothing.
        let scenario = Scenario { name: String::new(), ..study.scenario.clone() };
        // Cases that draw fly aircraft of their own; of others how long they are and when they begin changes nothing, nor do
        // dispersions of which nothing is drawn.
        let draws = runs > 0 && !study.dispersions.is_empty();
        let whenever =
            (!draws).then(|| [scenario.whenever(), scenario.within_its_time().whenever()]);
        Self { scenario, dispersions: study.dispersions.clone(), whenever }
    }

    /// True where one flies what the other flies, as far as both go.
    fn is_as(&self, other: &Self) -> bool {
        let is_written_so =
            || self.scenario == other.scenario && self.dispersions == other.dispersions;
        let is_so_at_other_times = || {
            let pair = self.whenever.as_ref().zip(other.whenever.as_ref());
            pair.is_some_and(|(own, other)| own.iter().zip(other).any(|(own, other)| own == other))
        };
        is_written_so() || is_so_at_other_times()
    }

    /// How two such flights differ, behind a comma; nothing where they do not.
    fn when_beside(&self, other: &Self) -> &'static str {
        let [own, other] = [self, other].map(|it| &it.scenario);
        let begins_alike = own.setpoint == other.setpoint && own.disturbances == other.disturbances;
        match (own.timing == other.timing, begins_alike) {
            (true, true) => "",
            (false, true) => ", for another time",
            (true, false) => ", at another time",
            (false, false) => ", at and for another time",
        }
    }
}

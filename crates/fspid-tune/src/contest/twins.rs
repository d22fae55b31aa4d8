//! Cases that fly the same, if for longer or later: what a contest counts as evidence twice, or has been tuned on.

use fspid_scenario::dispersion::Dispersion;
use fspid_scenario::file::{Study, Template};
use fspid_sim::signal::Profile;
use fspid_sim::{Scenario, Timing};

use crate::error::TuneError;
use crate::source::Source;

/// What is wrong with the cases that are judged on, each with its name: one that flies what an earlier one flies, and one that
/// flies what a case of the tuning flies, however both are written.
pub(super) fn problems<'a>(
    source: &Source,
    study: &Study,
    judged: impl Iterator<Item = (&'a str, &'a Template)>,
) -> Result<Vec<String>, TuneError> {
    let trained = trained(source, study)?;
    let (mut problems, mut before) = (Vec::<String>::new(), Vec::<(&str, Flown)>::new());
    for (name, template) in judged {
        let flown = Flown::of(template.study());
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
        return Ok(vec![("the scenario as written".to_owned(), Flown::of(study))]);
    }
    let mut trained = Vec::new();
    for case in &tuning.cases {
        match source.case(case) {
            Ok(template) => trained.push((case.name.clone(), Flown::of(template.study()))),
            // It is told by those who tune on it.
            Err(TuneError::Case(_)) => {}
            Err(error) => return Err(error),
        }
    }
    Ok(trained)
}

/// All that decides about the flights of a case.
struct Flown {
    /// Without a name, and whenever it is flown.
    scenario: Scenario,
    dispersions: Vec<Dispersion>,
    timing: Timing,
    setpoint: Profile,
}

impl Flown {
    fn of(study: &Study) -> Self {
        let Scenario { timing, ref setpoint, .. } = study.scenario;
        // Cases that draw fly aircraft of their own; of others how long they are and when they begin changes nothing.
        let flown = match study.dispersions.is_empty() {
            true => study.scenario.whenever(),
            false => study.scenario.clone(),
        };
        // Nor does what it is called.
        let scenario = Scenario { name: String::new(), ..flown };
        Self {
            scenario,
            dispersions: study.dispersions.clone(),
            timing,
            setpoint: setpoint.clone(),
        }
    }

    /// True where one flies what the other flies, as far as both go.
    fn is_as(&self, other: &Self) -> bool {
        self.scenario == other.scenario && self.dispersions == other.dispersions
    }

    /// How two such flights differ, behind a comma; nothing where they do not.
    fn when_beside(&self, other: &Self) -> &'static str {
        match (self.timing == other.timing, self.setpoint == other.setpoint) {
            (true, true) => "",
            (false, true) => ", for another time",
            (true, false) => ", at another time",
            (false, false) => ", at and for another time",
        }
    }
}

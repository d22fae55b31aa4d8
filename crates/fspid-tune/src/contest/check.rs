//! Whether a contest can be held, and fairly: everything that is wrong is told at once.

use fspid_campaign::engine::{Judging, Stability};
use fspid_scenario::count::{BUDGET, SEEDS};
use fspid_scenario::file::{Study, Template, TunedIn};
use fspid_scenario::tuning::{Contest as Rules, Tuning};

use super::{Contest, Entrant, Options, flight, mirror, twins};
use crate::crew::Part;
use crate::error::{TuneError, WrongCase};
use crate::flights::{Asked, Dispersed, Flights, FlownCase, Seeds, flown_case};
use crate::flyer::Flyer;
use crate::problem::{TuningProblem, tunable_parameters_of};
use crate::search::Effort;
use crate::source::Source;
use crate::space::Space;

/// What is told of a scenario without a contest.
const NO_CASES: &str = "it has no [[contest.case]]: what the controllers are judged on, for instance\n\n        [[contest.case]]\n        name = \"2 deg\"\n        set = [\"setpoint.amplitude_deg=2.0\"]\n\n    a whole scenario: fspid init --template contest";

pub(super) fn checked(source: &Source, options: &Options) -> Result<Contest, TuneError> {
    let template = source.template()?;
    let study = template.study();
    let mut problems = Vec::new();
    let names: Vec<String> = study.scenario.flyers().map(|flyer| flyer.name().to_owned()).collect();
    if names.len() < 2 {
        let found = names.len();
        problems.push(format!("it has {found} controller; a contest needs two or more"));
    }
    problems.extend(study.scenario.start_externals().err().map(|error| error.to_string()));
    let Some(rules) = study.contest.clone() else {
        problems.push(NO_CASES.to_owned());
        return Err(refused(source, problems, Vec::new()));
    };
    let tuning = study.tuning.clone();
    let efforts = efforts(tuning.as_ref(), &rules, options, &mut problems);
    let (cases, wrong_cases) = templates(source, &rules)?;
    if cases.len() == rules.cases.len() {
        problems.extend(mirror::problems(&rules, &cases));
    }
    let is_right = |name: &&str| wrong_cases.iter().all(|it| it.case != **name);
    let right = rules.cases.iter().map(|case| case.name.as_str()).filter(is_right);
    problems.extend(twins::problems(source, study, rules.runs, right.zip(&cases))?);
    let unfree = template.check_free(&study.tunable_parameters, TunedIn::Contest).err();
    let mut entrants = Vec::new();
    for name in &names {
        match entrant(source, study, name, &cases, &rules) {
            Ok(entrant) => entrants.push(entrant),
            // It is told of all controllers together.
            Err(TuneError::Scenario(_)) if unfree.is_some() => {}
            Err(error) => problems.push(format!("controller \"{name}\": {error}")),
        }
    }
    problems.extend(unfree.map(|problems| problems.to_string()));
    if !problems.is_empty() || !wrong_cases.is_empty() {
        return Err(refused(source, problems, wrong_cases));
    }
    let against = rules.against.as_ref();
    let against = against.and_then(|name| names.iter().position(|it| it == name)).unwrap_or(0);
    Ok(Contest {
        source: source.clone(),
        name: study.scenario.name.clone(),
        digest: study.digest.clone(),
        tuning,
        rules,
        efforts,
        entrants,
        against,
    })
}

fn refused(source: &Source, problems: Vec<String>, wrong_cases: Vec<WrongCase>) -> TuneError {
    TuneError::Contest { path: source.path.display().to_string(), problems, wrong_cases }
}

/// Everybody is measured as it flew, and asked what a constant load does.
const JUDGING: Judging = Judging { stability: Stability::AsFlown, loads: true };

fn efforts(
    tuning: Option<&Tuning>,
    rules: &Rules,
    options: &Options,
    problems: &mut Vec<String>,
) -> Vec<Effort> {
    let seeds = options.seeds.unwrap_or(rules.seeds);
    let limits = (SEEDS.check(seeds), options.budget.map_or(Ok(()), |budget| BUDGET.check(budget)));
    problems
        .extend([limits.0, limits.1].into_iter().filter_map(Result::err).map(|it| it.to_string()));
    let Some(tuning) = tuning else {
        return Vec::new();
    };
    let budget = options.budget.unwrap_or(tuning.budget);
    let effort = |number: u64| Effort {
        optimiser: tuning.optimiser.clone(),
        budget,
        seed: tuning.seed.wrapping_add(number),
        population: None,
        anywhere: false,
    };
    (0..seeds.min(SEEDS.most)).map(effort).collect()
}

/// The scenario with the changes of each case, and the cases that make it wrong.
fn templates(source: &Source, rules: &Rules) -> Result<(Vec<Template>, Vec<WrongCase>), TuneError> {
    let (mut templates, mut wrong) = (Vec::new(), Vec::new());
    for case in &rules.cases {
        match source.case(case) {
            Ok(template) => templates.push(template),
            Err(TuneError::Case(it)) => wrong.push(*it),
            Err(error) => return Err(error),
        }
    }
    Ok((templates, wrong))
}

fn entrant(
    source: &Source,
    study: &Study,
    name: &str,
    cases: &[Template],
    rules: &Rules,
) -> Result<Entrant, TuneError> {
    let parameters = tunable_parameters_of(study, name);
    let problem = match parameters.is_empty() {
        true => None,
        false => Some(TuningProblem::new(source, Some(name))?),
    };
    let dispersed =
        Dispersed { key: "contest.runs", runs: rules.runs, seeds: Seeds::OfEach(rules.run_seed) };
    let flyer = Flyer { controller: name, free: &parameters };
    let flown = cases
        .iter()
        .zip(&rules.cases)
        .map(|(template, case)| flown_case(template, Some(case), flyer, dispersed));
    let flown: Vec<FlownCase> = flown.collect::<Result<_, _>>()?;
    let objectives = study.tuning.as_ref().map_or(&[][..], |tuning| &tuning.objectives);
    let measured = flight::measured(objectives);
    let asked = Asked { controller: name.to_owned(), part: Part::Judging, judging: JUDGING };
    let flights = Flights::new(asked, Space::new(parameters), flown, measured);
    Ok(Entrant { name: name.to_owned(), problem, flights })
}

//! What is flown for a candidate, and what it is worth.

use std::path::{Path, PathBuf};

use fspid_campaign::Draws;
use fspid_campaign::engine::{self, Memory};
use fspid_campaign::sample::Sampling;
use fspid_study::dispersion::Drawn;
use fspid_study::file::{Study, Template};
use fspid_study::tuning::{Case, Mark, Tuning};
use rayon::prelude::*;
use sha2::{Digest as _, Sha256};

use crate::error::TuneError;
use crate::score::{FlightScore, Score};
use crate::space::Space;

/// A scenario file with changes from outside.
#[derive(Clone, Debug)]
pub struct Source {
    /// Path of the scenario.
    pub path: PathBuf,
    /// Changes, as `--set` takes them.
    pub overrides: Vec<String>,
}

impl Source {
    /// Reads the scenario.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn template(&self) -> Result<Template, TuneError> {
        Ok(Template::load(&self.path, &self.overrides)?)
    }

    fn case(&self, case: &Case) -> Result<Template, TuneError> {
        let mut overrides = self.overrides.clone();
        overrides.extend(case.set.iter().cloned());
        Template::load(&self.path, &overrides).map_err(|problems| TuneError::Case {
            case: case.name.clone(),
            problems: Box::new(problems),
        })
    }
}

/// A case that is flown: its scenario with one controller, and what each of its runs draws.
#[derive(Clone, Debug)]
struct FlownCase {
    name: String,
    weight: f64,
    template: Template,
    digest: String,
    draws: Option<Draws>,
    /// Draws of each run; a single empty one for the scenario as written.
    runs: Vec<Vec<Drawn>>,
}

/// Everything that decides what a candidate is worth.
#[derive(Clone, Debug)]
pub struct Problem {
    controller: String,
    space: Space,
    tuning: Tuning,
    cases: Vec<FlownCase>,
    at_once: usize,
    digest: String,
}

/// Name of the only case of a scenario that lists none.
const AS_WRITTEN: &str = "as written";

impl Problem {
    /// The tuning of one controller of a scenario; of the one that has marks where none is named.
    ///
    /// # Errors
    /// No objective, nothing free, or cases, draws or bounds that make the scenario wrong.
    pub fn new(source: &Source, controller: Option<&str>) -> Result<Self, TuneError> {
        let template = source.template()?;
        let path = || source.path.display().to_string();
        let study = template.study();
        let Some(tuning) = study.tuning.clone() else {
            return Err(TuneError::NoObjective { path: path() });
        };
        let named = controller.or(tuning.controller.as_deref());
        let controller = chosen(study, named)?;
        let marks = marks_of(study, &controller);
        if marks.is_empty() {
            return Err(TuneError::NothingFree { path: path(), controller });
        }
        template.only(&controller)?.check_marks()?;
        let space = Space::new(marks);
        let cases = flown_cases(source, &template, &controller, &tuning)?;
        let at_once = cases.first().map_or(1, |case| engine::at_once(case.template.study()));
        let digest = digest(&template, &controller, &cases);
        Ok(Self { controller, space, tuning, cases, at_once, digest })
    }

    /// Name of the controller.
    #[must_use]
    pub fn controller(&self) -> &str {
        &self.controller
    }

    /// What is searched.
    #[must_use]
    pub fn space(&self) -> &Space {
        &self.space
    }

    /// What the scenario says of its tuning.
    #[must_use]
    pub fn tuning(&self) -> &Tuning {
        &self.tuning
    }

    /// Digest of everything that decides what a candidate is worth.
    #[must_use]
    pub fn digest(&self) -> String {
        self.digest.clone()
    }

    /// How many flights a candidate takes.
    #[must_use]
    pub fn flights(&self) -> usize {
        self.cases.iter().map(|case| case.runs.len()).sum()
    }

    /// What candidates are worth, in their order, on all threads of the pool that this is called in.
    #[must_use]
    pub fn scores(&self, points: &[Vec<f64>]) -> Vec<Score> {
        let flights = self.flown(points);
        let weights: Vec<f64> = self.jobs().map(|(case, _)| case.weight).collect();
        let judged = (self.tuning.over, self.tuning.objectives.as_slice());
        flights.iter().map(|mine| Score::over(mine, &weights, judged)).collect()
    }

    /// Why flights of a candidate have no value, each with its case.
    #[must_use]
    pub fn reasons_of_loss(&self, point: &[f64]) -> Vec<String> {
        self.reasons_where(point, |flight| flight.values.is_empty())
    }

    /// Why flights of a candidate have no value or break requirements, each with its case.
    #[must_use]
    pub fn reasons(&self, point: &[f64]) -> Vec<String> {
        self.reasons_where(point, |_| true)
    }

    fn reasons_where(&self, point: &[f64], tells: fn(&FlightScore) -> bool) -> Vec<String> {
        let flights = self.flown(std::slice::from_ref(&point.to_vec()));
        let mut told = Vec::new();
        for ((case, run), flight) in self.jobs().zip(flights.into_iter().flatten()) {
            let which = match case.runs.len() {
                1 => case.name.clone(),
                _ => format!("{}, run {run}", case.name),
            };
            if tells(&flight) {
                told.extend(flight.reasons.iter().map(|reason| format!("    {which}: {reason}")));
            }
        }
        told
    }

    /// Every flight of a candidate: its case and the number of its run.
    fn jobs(&self) -> impl Iterator<Item = (&FlownCase, usize)> {
        self.cases.iter().flat_map(|case| (0..case.runs.len()).map(move |run| (case, run)))
    }

    /// All flights of each candidate.
    fn flown(&self, points: &[Vec<f64>]) -> Vec<Vec<FlightScore>> {
        // Flights of one case fly best together: plants of the same order, the same steps.
        let jobs: Vec<_> = self
            .jobs()
            .flat_map(|(case, run)| points.iter().map(move |point| (point, case, run)))
            .collect();
        let groups = jobs.par_chunks(self.at_once.max(1));
        let fly = |memory: &mut Memory, group: &[(&Vec<f64>, &FlownCase, usize)]| {
            let studies = group.iter().map(|&(point, case, run)| self.study(point, case, run));
            self.fly(memory, studies.collect())
        };
        let flown: Vec<Vec<FlightScore>> = groups.map_init(Memory::default, fly).collect();
        let mut of_point = vec![Vec::with_capacity(self.flights()); points.len()];
        for (index, flight) in flown.into_iter().flatten().enumerate() {
            of_point[index % points.len()].push(flight);
        }
        of_point
    }

    fn study(&self, point: &[f64], case: &FlownCase, run: usize) -> Result<Study, String> {
        let mut values = self.space.values(point);
        if let (Some(draws), Some(drawn)) = (&case.draws, case.runs.get(run)) {
            values.extend(draws.values(drawn));
        }
        let built = case.template.with(&values);
        let mut study = built.map_err(|problems| problems.first_in_a_line())?;
        let objectives = self.tuning.objectives.iter().map(|it| it.requirement.clone());
        study.requirements.extend(objectives);
        Ok(study)
    }

    fn fly(&self, memory: &mut Memory, studies: Vec<Result<Study, String>>) -> Vec<FlightScore> {
        let mut scores = Vec::with_capacity(studies.len());
        let mut sound = Vec::with_capacity(studies.len());
        for study in studies {
            match study {
                Ok(study) => {
                    sound.push(study);
                    scores.push(None);
                }
                Err(reason) => scores.push(Some(FlightScore::refused(reason))),
            }
        }
        let objectives = self.tuning.objectives.len();
        let flown = engine::fly_with(memory, &sound).into_iter().zip(&sound);
        let mut flown = flown.map(|(flights, study)| {
            let duration_s = study.scenario.timing.end_s();
            let first = flights.map(|flights| {
                flights.first().map(|flight| FlightScore::of(flight, objectives, duration_s))
            });
            match first {
                Ok(Some(score)) => score,
                Ok(None) => FlightScore::refused("nobody flies".to_owned()),
                Err(error) => FlightScore::refused(error.to_string()),
            }
        });
        let nothing = || FlightScore::refused("nobody flies".to_owned());
        scores
            .into_iter()
            .map(|score| score.or_else(|| flown.next()).unwrap_or_else(nothing))
            .collect()
    }
}

/// The controller of that name, or the one that has marks.
pub(crate) fn chosen(study: &Study, named: Option<&str>) -> Result<String, TuneError> {
    let names: Vec<&str> =
        study.scenario.controllers.iter().map(|named| named.name.as_str()).collect();
    if let Some(name) = named {
        return match names.contains(&name) {
            true => Ok(name.to_owned()),
            false => Err(TuneError::Value {
                what: "the controller",
                found: format!("\"{name}\""),
                allowed: names.join(", "),
            }),
        };
    }
    let own = |name: &str| study.marks.iter().any(|mark| mark.controller() == Some(name));
    let marked: Vec<&str> = names.iter().copied().filter(|name| own(name)).collect();
    match marked[..] {
        [] => Ok(names.first().copied().unwrap_or_default().to_owned()),
        [one] => Ok(one.to_owned()),
        _ => Err(TuneError::WhichController {
            names: marked.into_iter().map(str::to_owned).collect(),
        }),
    }
}

/// The marks of a controller, and those that belong to none.
fn marks_of(study: &Study, controller: &str) -> Vec<Mark> {
    let concerns = |mark: &&Mark| mark.controller().is_none_or(|name| name == controller);
    study.marks.iter().filter(concerns).cloned().collect()
}

fn flown_cases(
    source: &Source,
    template: &Template,
    controller: &str,
    tuning: &Tuning,
) -> Result<Vec<FlownCase>, TuneError> {
    if tuning.cases.is_empty() {
        return Ok(vec![flown_case(template, (AS_WRITTEN, 1.0), controller, tuning)?]);
    }
    let case = |case: &Case| {
        let template = source.case(case)?;
        flown_case(&template, (&case.name, case.weight), controller, tuning)
    };
    tuning.cases.iter().map(case).collect()
}

fn flown_case(
    template: &Template,
    (name, weight): (&str, f64),
    controller: &str,
    tuning: &Tuning,
) -> Result<FlownCase, TuneError> {
    let digest = template.study().digest.clone();
    let template = template.only(controller)?;
    let draws = match tuning.runs {
        0 => None,
        runs if template.study().dispersions.is_empty() => {
            return Err(TuneError::Value {
                what: "tuning.runs",
                found: runs.to_string(),
                allowed: "0 where the scenario has no [[dispersion]]".to_owned(),
            });
        }
        runs => Some(Draws::new(&template, Sampling::LatinHypercube, runs, tuning.run_seed)?),
    };
    let runs = match &draws {
        None => vec![Vec::new()],
        Some(draws) => (0..tuning.runs).map(|run| draws.drawn(run)).collect(),
    };
    Ok(FlownCase { name: name.to_owned(), weight, template, digest, draws, runs })
}

fn digest(template: &Template, controller: &str, cases: &[FlownCase]) -> String {
    let mut all = format!("{}\n{controller}\n", template.study().digest);
    cases.iter().for_each(|case| all.push_str(&format!("{}\n", case.digest)));
    let bytes = Sha256::digest(all.as_bytes());
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The folder that paths in a scenario are relative to.
pub(crate) fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

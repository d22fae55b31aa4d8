//! Points of a space flown on cases: what tuning and contest have in common.

use std::ops::Range;

use fspid_campaign::Draws;
use fspid_campaign::engine::{self, FlightResult, Judging, Memory};
use fspid_campaign::sample::Sampling;
use fspid_scenario::dispersion::Drawn;
use fspid_scenario::file::{LoadError, Study, Template, TunedIn};
use fspid_scenario::requirement::{AskedIn, Requirement};
use fspid_scenario::tuning::Case;
use fspid_study::memory::Needed;
use rayon::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use sha2::{Digest as _, Sha256};

use crate::crew::{Crew, Order, Part};
use crate::error::{TuneError, WrongCase};
use crate::flyer::Flyer;
use crate::own_draws::OwnDraws;
use crate::source::Source;
use crate::space::Space;

/// Name of the only case of a scenario that lists none.
const AS_WRITTEN: &str = "as written";

/// How many draws each case has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dispersed {
    /// The key that says so, for messages.
    pub(crate) key: &'static str,
    pub(crate) runs: u64,
    pub(crate) seeds: Seeds,
}

/// Of which seed a case draws.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Seeds {
    /// All cases of one, as a campaign of the scenario with it.
    OfAll(u64),
    /// Each case of its own, which comes of this one and its name.
    OfEach(u64),
}

impl Seeds {
    /// The seed of a case, by the name that it [draws by](drawn_as); as written without a name.
    ///
    /// Draws that all cases share would be in the error of every case and in none of their differences. And what was tuned on the
    /// draws of a seed is not judged on them. Of a case its seed is the first 53 bits of the SHA-256 of `contest draws`, of the
    /// decimals of the contest's seed and of the case's name, with a line feed between each.
    pub(crate) fn of(self, case: Option<&str>) -> u64 {
        match self {
            Self::OfAll(seed) => seed,
            Self::OfEach(seed) => {
                let name = case.unwrap_or_default();
                let digest = Sha256::digest(format!("contest draws\n{seed}\n{name}"));
                let (first, _) = digest.split_first_chunk().unwrap_or((&[0; 8], &[]));
                u64::from_be_bytes(*first) >> 11
            }
        }
    }
}

/// By which name a case draws: its own, or that of the case that it mirrors, whose aircraft it flies.
pub(crate) fn drawn_as(case: &Case) -> &str {
    case.mirror_of.as_ref().unwrap_or(&case.name)
}

/// A case that is flown: its scenario with one controller, and what each of its runs draws.
#[derive(Clone, Debug)]
pub(crate) struct FlownCase {
    pub(crate) name: String,
    /// None for the scenario as it is written, which is no case.
    group: Option<String>,
    pub(crate) weight: f64,
    /// What is allowed there and probably not meant.
    pub(crate) warnings: Vec<String>,
    /// Digest of the scenario with the changes of the case and one controller.
    pub(crate) digest: String,
    template: Template,
    draws: Option<OwnDraws>,
    /// Draws of each run; a single empty one for the scenario as written.
    runs: Vec<Vec<Drawn>>,
}

impl FlownCase {
    /// All that decides about its flights.
    pub(crate) fn fingerprint(&self) -> String {
        let Self { name, group, weight, digest, runs, draws, .. } = self;
        let mut all = format!("{name:?} {group:?} {weight:?} {digest} {runs:?}\n");
        // Only where it matters, so that a search that was kept goes on.
        let factors = draws.iter().flat_map(OwnDraws::factors);
        factors.for_each(|path| all.push_str(&format!("a factor of what is tuned: {path}\n")));
        all
    }

    /// How often it is flown.
    pub(crate) fn runs(&self) -> usize {
        self.runs.len()
    }
}

/// Who flights are flown for.
#[derive(Clone, Debug)]
pub(crate) struct Asked {
    /// Name of the controller.
    pub(crate) controller: String,
    pub(crate) part: Part,
    pub(crate) judging: Judging,
}

/// All flights that a point of a space has.
#[derive(Clone, Debug)]
pub(crate) struct Flights {
    asked: Asked,
    space: Space,
    cases: Vec<FlownCase>,
    /// Judged with the scenario's own, after them.
    measured: Vec<Requirement>,
    at_once: usize,
    digest: String,
}

/// A flight: its point, its case and the number of its run.
type Job<'a> = (&'a [f64], &'a FlownCase, usize);

impl Flights {
    pub(crate) fn new(
        asked: Asked,
        space: Space,
        cases: Vec<FlownCase>,
        measured: Vec<Requirement>,
    ) -> Self {
        let at_once = cases.first().map_or(1, |case| engine::at_once(case.template.study()));
        let free: Vec<_> = space.parameters().iter().map(|it| (it.path.text(), &it.free)).collect();
        let mut all = format!("{asked:?}\n{free:?}\n{measured:?}\n");
        cases.iter().for_each(|case| all.push_str(&case.fingerprint()));
        let digest = hex_digest(&all);
        Self { asked, space, cases, measured, at_once, digest }
    }

    /// Digest of everything that decides about the flights but the points.
    pub(crate) fn digest(&self) -> &str {
        &self.digest
    }

    /// Name of the controller, and what is flown for.
    pub(crate) fn asked_by(&self) -> (&str, Part) {
        (&self.asked.controller, self.asked.part)
    }

    /// How many flights fly best together.
    pub(crate) fn at_once(&self) -> usize {
        self.at_once.max(1)
    }

    /// True where loops are asked what a constant load does to them.
    pub(crate) fn judges_loads(&self) -> bool {
        self.asked.judging.loads
    }

    pub(crate) fn space(&self) -> &Space {
        &self.space
    }

    pub(crate) fn cases(&self) -> &[FlownCase] {
        &self.cases
    }

    /// What cases warn of, as often as they do.
    pub(crate) fn warnings(&self) -> impl Iterator<Item = &String> {
        self.cases.iter().flat_map(|case| &case.warnings)
    }

    /// Memory that they hold at once on so many threads, and their cases.
    pub(crate) fn needed(&self, threads: usize) -> Needed {
        let samples = |it: &FlownCase| it.template.study().scenario.timing.rows();
        let longest = self.cases.iter().map(samples).max().unwrap_or(0);
        Needed::for_flights(longest, threads).with_cases(self.cases.len())
    }

    /// How many flights a point has.
    pub(crate) fn count(&self) -> usize {
        self.cases.iter().map(FlownCase::runs).sum()
    }

    /// Every flight of a point: its case and the number of its run.
    pub(crate) fn jobs(&self) -> impl Iterator<Item = (&FlownCase, usize)> {
        self.cases.iter().flat_map(|case| (0..case.runs.len()).map(move |run| (case, run)))
    }

    /// What a function reads off all flights of each point. It is given the flight, or why there is none, and how long it
    /// should have been, s. Others who fly read the same.
    ///
    /// # Errors
    /// [`TuneError::Stopped`], and others who could not fly.
    pub(crate) fn flown<T: Send + Clone + Serialize + DeserializeOwned>(
        &self,
        points: &[Vec<f64>],
        read: &(impl Fn(Result<&FlightResult, String>, f64) -> T + Sync),
        crew: Crew<'_>,
    ) -> Result<Vec<Vec<T>>, TuneError> {
        let all = 0..self.count() * points.len();
        let flown: Vec<T> = match crew {
            Crew::Here(stops) => self.block(points, all, read, stops)?,
            // Nothing to fly is nobody's task.
            Crew::Others(_) if all.is_empty() => Vec::new(),
            Crew::Others(engine) => {
                let order = Order::of(self, points);
                order.taken_in(engine.fly(&order)?)?
            }
        };
        let mut of_point = vec![Vec::with_capacity(self.count()); points.len()];
        for (index, flight) in flown.into_iter().enumerate() {
            of_point[index % points.len()].push(flight);
        }
        Ok(of_point)
    }

    /// The same of some flights in the order in which they are flown: every point on the first run of the first case,
    /// then on the next run.
    ///
    /// # Errors
    /// [`TuneError::Stopped`].
    pub(crate) fn block<T: Send>(
        &self,
        points: &[Vec<f64>],
        flights: Range<usize>,
        read: &(impl Fn(Result<&FlightResult, String>, f64) -> T + Sync),
        stops: &(dyn Fn() -> bool + Sync),
    ) -> Result<Vec<T>, TuneError> {
        // Flights of one case fly best together: plants of the same order, the same steps.
        let jobs = self
            .jobs()
            .flat_map(|(case, run)| points.iter().map(move |point| (point.as_slice(), case, run)));
        let jobs: Vec<Job<'_>> = jobs.skip(flights.start).take(flights.len()).collect();
        let fly = |memory: &mut Memory, group: &[Job<'_>]| {
            if stops() {
                return Err(TuneError::Stopped);
            }
            let studies = group.iter().map(|&(point, case, run)| self.study(point, case, run));
            Ok(fly(memory, studies.collect(), self.asked.judging, read))
        };
        let groups = jobs.par_chunks(self.at_once()).map_init(Memory::default, fly);
        let flown: Vec<Vec<T>> = groups.collect::<Result<_, _>>()?;
        Ok(flown.into_iter().flatten().collect())
    }

    /// The scenario of one flight, or why there is none.
    pub(crate) fn study(
        &self,
        point: &[f64],
        case: &FlownCase,
        run: usize,
    ) -> Result<Study, String> {
        let mut values = self.space.values(point);
        if let (Some(draws), Some(drawn)) = (&case.draws, case.runs.get(run)) {
            let drawn = draws.values(drawn, &case.template, &values);
            values.extend(drawn);
        }
        let built = case.template.with(&values);
        let mut study = built.map_err(|problems| problems.first_in_a_line())?;
        if let Some(group) = &case.group {
            study = study.in_case(&case.name, group);
        }
        study.requirements.extend(self.measured.iter().cloned());
        Ok(study)
    }
}

/// SHA-256 of a text, in hexadecimal digits.
pub(crate) fn hex_digest(text: &str) -> String {
    Sha256::digest(text.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect()
}

fn fly<T>(
    memory: &mut Memory,
    studies: Vec<Result<Study, String>>,
    judging: Judging,
    read: &impl Fn(Result<&FlightResult, String>, f64) -> T,
) -> Vec<T> {
    let mut answers = Vec::with_capacity(studies.len());
    let mut sound = Vec::with_capacity(studies.len());
    for study in studies {
        match study {
            Ok(study) => {
                sound.push(study);
                answers.push(None);
            }
            Err(reason) => answers.push(Some(read(Err(reason), 0.0))),
        }
    }
    let nobody = || "nobody flies".to_owned();
    let flown = engine::fly_judging(memory, &sound, judging).into_iter().zip(&sound);
    let mut flown = flown.map(|(flights, study)| {
        let duration_s = study.scenario.timing.end_s();
        match &flights {
            Ok(flights) => read(flights.first().ok_or_else(nobody), duration_s),
            Err(error) => read(Err(error.to_string()), duration_s),
        }
    });
    let nothing = || read(Err(nobody()), 0.0);
    answers
        .into_iter()
        .map(|answer| answer.or_else(|| flown.next()).unwrap_or_else(nothing))
        .collect()
}

/// The cases with one controller; the scenario itself where there are none.
///
/// # Errors
/// The first case that makes the scenario wrong.
pub(crate) fn flown_cases(
    source: &Source,
    flyer: Flyer<'_>,
    cases: &[Case],
    dispersed: Dispersed,
) -> Result<Vec<FlownCase>, TuneError> {
    if cases.is_empty() {
        let template = source.template()?;
        return Ok(vec![flown_case(&template, None, flyer, dispersed)?]);
    }
    let case = |case: &Case| {
        let template = source.case(case)?;
        flown_case(&template, Some(case), flyer, dispersed)
    };
    cases.iter().map(case).collect()
}

/// A case of a scenario that was read with its changes; without one the scenario as it is written.
///
/// # Errors
/// Draws without dispersions, or of what is free; or a scenario that is wrong with this controller alone.
pub(crate) fn flown_case(
    whole: &Template,
    case: Option<&Case>,
    flyer: Flyer<'_>,
    dispersed: Dispersed,
) -> Result<FlownCase, TuneError> {
    check_free(whole, case, flyer)?;
    let warnings = warnings(whole.study(), case.is_some());
    let template = whole.only(flyer.controller)?;
    let digest = template.study().digest.clone();
    let draws = match dispersed.runs {
        0 => None,
        runs if whole.study().dispersions.is_empty() => {
            return Err(TuneError::Value {
                what: dispersed.key,
                found: runs.to_string(),
                allowed: "0 where the scenario has no [[dispersion]]".to_owned(),
            });
        }
        // Of the whole scenario: everybody gets the same draws, and a campaign of it with this seed as well.
        runs => {
            let seed = dispersed.seeds.of(case.map(drawn_as));
            Some(Draws::new(whole, Sampling::LatinHypercube, runs, seed)?)
        }
    };
    let runs = match &draws {
        None => vec![Vec::new()],
        Some(draws) => (0..dispersed.runs).map(|run| draws.drawn(run)).collect(),
    };
    let draws = draws.map(|draws| OwnDraws::of(draws, whole, flyer));
    let name = case.map_or(AS_WRITTEN, |case| &case.name).to_owned();
    let (group, weight) = (case.map(|case| case.group.clone()), case.map_or(1.0, |it| it.weight));
    Ok(FlownCase { name, group, weight, warnings, template, digest, draws, runs })
}

/// Refuses draws of what is free that are no factors of it, which a case may have by its changes.
fn check_free(whole: &Template, case: Option<&Case>, flyer: Flyer<'_>) -> Result<(), TuneError> {
    let checked = whole.check_free(flyer.free, TunedIn::AsWritten);
    checked.map_err(|problems| match case {
        None => TuneError::Scenario(problems),
        Some(case) => {
            let (case, problems) = (case.name.clone(), LoadError::Problems(problems));
            TuneError::Case(Box::new(WrongCase { case, problems }))
        }
    })
}

/// What a study warns of; in a case it is no news that some requirements are asked in cases alone.
fn warnings(study: &Study, is_case: bool) -> Vec<String> {
    let tells = |it: &&String| !(is_case && it.ends_with(AskedIn::NOT_AS_WRITTEN));
    study.warnings.iter().filter(tells).cloned().collect()
}

/// Warnings of many cases, each once.
pub(crate) fn each_once<'a>(warnings: impl Iterator<Item = &'a String>) -> Vec<String> {
    let mut once: Vec<String> = Vec::new();
    for warning in warnings {
        if !once.contains(warning) {
            once.push(warning.clone());
        }
    }
    once
}

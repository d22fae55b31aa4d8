//! What is flown for a candidate, and what it is worth.

use std::ops::Range;

use fspid_campaign::engine::{FlightResult, Judging, Stability};
use fspid_scenario::file::{Study, TunedIn};
use fspid_scenario::requirement::Requirement;
use fspid_scenario::tuning::{TunableParameter, Tuning};
use fspid_sim::Controller;
use fspid_study::analysis::AtRest;
use fspid_study::memory::Needed;
use fspid_study::output::{Names, Place};

use crate::crew::{Crew, Part};
use crate::design::{self, Original};
use crate::error::TuneError;
use crate::flights::{
    Asked, Dispersed, Flights, FlownCase, Seeds, each_once, flown_cases, hex_digest,
};
use crate::flyer::Flyer;
use crate::score::{FlightScore, Score};
use crate::source::Source;
use crate::space::Space;

/// Everything that decides what a candidate is worth.
#[derive(Clone, Debug)]
pub struct TuningProblem {
    controller: String,
    tuning: Tuning,
    flights: Flights,
    digest: String,
    file_name: String,
    original: Original,
}

impl TuningProblem {
    /// The tuning of one controller of a scenario; of the one that has parameters where none is named.
    ///
    /// # Errors
    /// No objective, nothing free, what is free and has its value from a case or a draw, or cases, draws or bounds that make
    /// the scenario wrong.
    pub fn new(source: &Source, controller: Option<&str>) -> Result<Self, TuneError> {
        let (original, template) = Original::read(source)?;
        let path = || source.path.display().to_string();
        let study = template.study();
        let Some(tuning) = study.tuning.clone() else {
            let is_marked = !study.tunable_parameters.is_empty();
            return Err(TuneError::NoObjective { path: path(), is_marked });
        };
        let named = controller.or(tuning.controller.as_deref());
        let controller = chosen(study, named)?;
        let parameters = tunable_parameters_of(study, &controller);
        if parameters.is_empty() {
            return Err(TuneError::NothingFree { path: path(), controller });
        }
        template.check_free(&parameters, TunedIn::Tuning)?;
        template.only(&controller)?.check_marks()?;
        let dispersed = Dispersed {
            key: "tuning.runs",
            runs: tuning.runs,
            seeds: Seeds::OfAll(tuning.run_seed),
        };
        let flyer = Flyer { controller: &controller, free: &parameters };
        let cases = flown_cases(source, flyer, &tuning.cases, dispersed)?;
        let digest = digest(&parameters, &tuning, &cases);
        let all = study.scenario.controllers.iter().map(|named| &named.name);
        let file_name = Names::of(Place::File, all).name(&controller);
        let measured = measured(&tuning);
        let loads = tuning.removes_constant_load && has_integral(study, &controller);
        let judging = Judging { stability: Stability::Analysed, loads };
        let asked = Asked { controller: controller.clone(), part: Part::Tuning, judging };
        let flights = Flights::new(asked, Space::new(parameters), cases, measured);
        // What cannot be written is not searched.
        design::text(&original, flights.space(), &flights.space().start(), &[])?;
        Ok(Self { controller, tuning, flights, digest, file_name, original })
    }

    /// Name of the controller.
    #[must_use]
    pub fn controller(&self) -> &str {
        &self.controller
    }

    /// Its name in those of files, which no other controller of the scenario has.
    #[must_use]
    pub fn file_name(&self) -> &str {
        &self.file_name
    }

    /// The scenario, as it was when the search began, with the values of a point in place of its marks; `heading` comes
    /// first, as comments.
    ///
    /// # Errors
    /// A text that would not be a scenario.
    pub fn design(&self, point: &[f64], heading: &[String]) -> Result<String, TuneError> {
        design::text(&self.original, self.space(), point, heading)
    }

    /// What is searched.
    #[must_use]
    pub fn space(&self) -> &Space {
        self.flights.space()
    }

    /// What the scenario says of its tuning.
    #[must_use]
    pub fn tuning(&self) -> &Tuning {
        &self.tuning
    }

    /// True where candidates must remove a constant load.
    #[must_use]
    pub fn removes_constant_load(&self) -> bool {
        self.flights.judges_loads()
    }

    /// Digest of everything that decides what a candidate is worth.
    #[must_use]
    pub fn digest(&self) -> String {
        self.digest.clone()
    }

    /// Memory that its flights hold at once on so many threads.
    #[must_use]
    pub fn needed(&self, threads: usize) -> Needed {
        self.flights.needed(threads)
    }

    /// What is allowed in the scenario and its cases and probably not meant, each once.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        each_once(self.flights.warnings())
    }

    /// How many flights a candidate takes.
    #[must_use]
    pub fn flights(&self) -> usize {
        self.flights.count()
    }

    /// What candidates are worth, in their order, on all threads of the pool that this is called in.
    #[must_use]
    pub fn scores(&self, points: &[Vec<f64>]) -> Vec<Score> {
        // Nobody stops these threads, so that there is no error.
        self.scores_by(points, Crew::UNSTOPPED).unwrap_or_default()
    }

    /// What candidates are worth, in their order, whoever flies them.
    ///
    /// # Errors
    /// [`TuneError::Stopped`], and others who could not fly.
    pub fn scores_by(&self, points: &[Vec<f64>], crew: Crew<'_>) -> Result<Vec<Score>, TuneError> {
        let flights = self.flights_of(points, crew)?;
        Ok(flights.iter().map(|mine| self.score(mine)).collect())
    }

    /// What each flight of candidates is worth, in their order, whoever flies them.
    pub(crate) fn flights_of(
        &self,
        points: &[Vec<f64>],
        crew: Crew<'_>,
    ) -> Result<Vec<Vec<FlightScore>>, TuneError> {
        self.flights.flown(points, &|flight, s| self.read(flight, s), crew)
    }

    /// What a candidate with these flights is worth.
    pub(crate) fn score(&self, flights: &[FlightScore]) -> Score {
        let weights: Vec<f64> = self.flights.jobs().map(|(case, _)| case.weight).collect();
        Score::over(flights, &weights, &self.tuning)
    }

    /// Some flights of candidates, for whoever asks.
    pub(crate) fn block(
        &self,
        points: &[Vec<f64>],
        flights: Range<usize>,
    ) -> Result<Vec<FlightScore>, TuneError> {
        self.flights.block(points, flights, &|flight, s| self.read(flight, s), &|| false)
    }

    /// The flights of its candidates.
    pub(crate) fn its_flights(&self) -> &Flights {
        &self.flights
    }

    /// What is said of a candidate's loop at rest, as often as it differs: its gains there, a constant load that it does not
    /// remove, and why nobody can tell whether it is stable, there or where its flights lead, with the cases of which that is so.
    #[must_use]
    pub fn at_rest(&self, point: &[f64]) -> Vec<String> {
        let mut told: Vec<String> = Vec::new();
        let mut doubts: Vec<(String, Vec<&str>)> = Vec::new();
        for (case, run) in self.flights.jobs() {
            let Ok(study) = self.flights.study(point, case, run) else { continue };
            let Some(named) = study.scenario.controllers.first() else { continue };
            let at_rest = AtRest::of(&study.scenario, &named.controller);
            let load = at_rest.load_in_words(study.scenario.timing.end_s());
            let load = load.map(|words| format!("{}: {words}", case.name));
            let not_asked = at_rest.not_asked_in_words();
            for words in at_rest.gains_in_words().into_iter().chain(load).chain(not_asked) {
                if !told.contains(&words) {
                    told.push(words);
                }
            }
            let Some(doubt) = at_rest.as_flown(&study.scenario, named).undecided_in_words() else {
                continue;
            };
            let place = doubts.iter().position(|(words, _)| *words == doubt);
            let place = place.unwrap_or_else(|| {
                doubts.push((doubt, Vec::new()));
                doubts.len() - 1
            });
            if !doubts[place].1.contains(&case.name.as_str()) {
                doubts[place].1.push(&case.name);
            }
        }
        let doubted = doubts.into_iter().map(|(words, cases)| match cases.as_slice() {
            [first, others @ ..] if !others.is_empty() => {
                format!("{first} and {} more: {words}", others.len())
            }
            cases => format!("{}: {words}", cases.concat()),
        });
        told.extend(doubted);
        told
    }

    /// Why flights of a candidate have no value, each with its case.
    ///
    /// # Errors
    /// As those of [`scores_by`](Self::scores_by).
    pub fn reasons_of_loss(&self, point: &[f64], crew: Crew<'_>) -> Result<Vec<String>, TuneError> {
        self.reasons_where(point, |flight| flight.values.is_empty(), crew)
    }

    /// Why flights of a candidate have no value or break requirements, each with its case.
    ///
    /// # Errors
    /// As those of [`scores_by`](Self::scores_by).
    pub fn reasons(&self, point: &[f64], crew: Crew<'_>) -> Result<Vec<String>, TuneError> {
        self.reasons_where(point, |_| true, crew)
    }

    fn reasons_where(
        &self,
        point: &[f64],
        tells: fn(&FlightScore) -> bool,
        crew: Crew<'_>,
    ) -> Result<Vec<String>, TuneError> {
        let points = [point.to_vec()];
        let flights = self.flights_of(&points, crew)?;
        let mut told = Vec::new();
        for ((case, run), flight) in self.flights.jobs().zip(flights.into_iter().flatten()) {
            let which = match case.runs() {
                1 => case.name.clone(),
                _ => format!("{}, run {run}", case.name),
            };
            if tells(&flight) {
                told.extend(flight.reasons.iter().map(|reason| format!("    {which}: {reason}")));
            }
        }
        Ok(told)
    }

    /// What a flight is worth, or why there is none.
    fn read(&self, flight: Result<&FlightResult, String>, duration_s: f64) -> FlightScore {
        let measured = self.tuning.objectives.len() + self.tuning.limits.len();
        match flight {
            Ok(flight) => {
                let asked = flight.judgements.len().saturating_sub(measured);
                let score = FlightScore::of(flight, flight.judgements.split_at(asked), duration_s);
                score.with_load(flight, duration_s)
            }
            Err(reason) => FlightScore::refused(reason),
        }
    }
}

/// True for a controller that is meant to have an integral: one that tunes itself, or whose own ki is not 0.
fn has_integral(study: &Study, controller: &str) -> bool {
    let named = study.scenario.controllers.iter().find(|named| named.name == controller);
    named.is_some_and(|named| match &named.controller {
        Controller::SelfTuning(_) => true,
        Controller::Fixed(pid) => pid.gains().ki != 0.0,
    })
}

/// What is measured of each flight beside its requirements: objectives, then what is limited on average.
fn measured(tuning: &Tuning) -> Vec<Requirement> {
    let objectives = tuning.objectives.iter().map(|it| &it.requirement);
    objectives.chain(&tuning.limits).cloned().collect()
}

/// Every controller that has free numbers of its own, in the order of the scenario; all of them where only numbers
/// are free that belong to none.
///
/// # Errors
/// Everything that is wrong with the scenario.
pub fn controllers_with_marks(source: &Source) -> Result<Vec<String>, TuneError> {
    let template = source.template()?;
    let study = template.study();
    let names = study.scenario.controllers.iter().map(|named| named.name.clone());
    let own =
        |name: &String| study.tunable_parameters.iter().any(|mark| mark.controller() == Some(name));
    Ok(names.filter(own).collect())
}

/// The controller of that name, or the one that has parameters.
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
    let own =
        |name: &str| study.tunable_parameters.iter().any(|mark| mark.controller() == Some(name));
    let marked: Vec<&str> = names.iter().copied().filter(|name| own(name)).collect();
    match marked[..] {
        [] => Ok(names.first().copied().unwrap_or_default().to_owned()),
        [one] => Ok(one.to_owned()),
        _ => Err(TuneError::WhichController {
            names: marked.into_iter().map(str::to_owned).collect(),
        }),
    }
}

/// The parameters of a controller, and those that belong to none.
pub(crate) fn tunable_parameters_of(study: &Study, controller: &str) -> Vec<TunableParameter> {
    let concerns =
        |mark: &&TunableParameter| mark.controller().is_none_or(|name| name == controller);
    study.tunable_parameters.iter().filter(concerns).cloned().collect()
}

/// Of what is free, what makes a flight good, and what is flown; not of other controllers, nor of the cases that a
/// contest judges on, so that these can change and nothing is searched again. Every requirement of the controller is part
/// of it, also one that is asked in cases of the contest alone.
fn digest(parameters: &[TunableParameter], tuning: &Tuning, cases: &[FlownCase]) -> String {
    let Tuning { over, objectives, limits, removes_constant_load, .. } = tuning;
    // Not where in the text they stand.
    let free: Vec<_> = parameters.iter().map(|it| (it.path.text(), &it.free)).collect();
    // In the words of the first version, so that a search that was kept goes on.
    let free = ["Number", "Numbers", "Grid"].iter().fold(format!("{free:?}"), |text, kind| {
        text.replace(&format!("Tunable{kind} {{"), &format!("{kind}Mark {{"))
    });
    let mut all = format!("{free}\n{over:?}\n{objectives:?}\n{limits:?}\n");
    if *removes_constant_load {
        all.push_str("a constant load is removed\n");
    }
    cases.iter().for_each(|case| all.push_str(&case.fingerprint()));
    hex_digest(&all)
}

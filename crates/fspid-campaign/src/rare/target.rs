//! The limit-state function of rare-event estimation: how far a flight is from violating a requirement.

use fspid_scenario::dispersion::{Dispersion, Distribution, Drawn, SEED_LIMIT, standard_normal};
use fspid_scenario::file::{NewValue, SettingPath, Study, known_words};
use fspid_scenario::measure::Family;
use fspid_scenario::requirement::Requirement;
use fspid_sim::signal::Noise;
use rayon::prelude::*;

use super::chains::LimitState;
use super::point::{Point, Shape};
use crate::campaign::{Campaign, Progress};
use crate::engine::{self, FlightResult, Memory};
use crate::error::CampaignError;
use crate::plan::{SHARD_RUNS, SLOW_SHARD_RUNS};
use crate::rows::UNDECIDED;

/// Score of a flight that fails before anything of it is measured; lost earlier is higher.
const LOST: f64 = 1e300;
/// Score of a flight of which the requirement cannot be told, and that therefore does not meet it.
const ABSENT: f64 = 1e200;
/// Lost flights are in order of time; no flight lasts this long.
const LONGEST_S: f64 = 1e12;

/// What a coordinate of the dispersions is drawn from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Axis {
    #[default]
    Normal,
    /// Turbulence, which can be mixed.
    Air,
    /// Another seed.
    Seed,
}

/// What a flight says of its point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scored {
    /// Above 0 where it fails.
    pub(super) score: f64,
    /// Whether it does not fail, and nobody can tell whether its loop is stable at rest.
    pub(super) is_undecided: bool,
}

impl Scored {
    const LOST: Self = Self { score: LOST, is_undecided: false };

    fn of(flight: &FlightResult, score: f64) -> Self {
        let is_undecided = flight.at_rest.stability_word() == Some(UNDECIDED);
        Self { score, is_undecided: is_undecided && !(score > 0.0) }
    }
}

/// The place of the seed that can be mixed, and of the mixture.
const SEED_OF_AIR: &str = "turbulence.seed";
const MIXTURE_OF_AIR: &str = "turbulence.mixture";

/// Flights of one controller, asked for one requirement.
#[derive(Debug)]
pub struct Target<'a> {
    campaign: &'a Campaign,
    progress: &'a Progress,
    controller: String,
    requirement: Requirement,
    axes: Vec<Axis>,
    /// Where a mixture of air goes.
    mixture: Option<SettingPath>,
}

impl<'a> Target<'a> {
    /// Of a requirement by its id, and of a controller by its name: the only one that it concerns, or the first.
    ///
    /// # Errors
    /// A requirement or a controller that there is not; a requirement that is not of flights, or not of the controller.
    pub fn of(
        campaign: &'a Campaign,
        progress: &'a Progress,
        fails: &str,
        controller: Option<&str>,
    ) -> Result<Self, CampaignError> {
        let study = campaign.template().study();
        let requirement = required(study, fails)?;
        let names: Vec<&str> = study.scenario.flyers().map(|flyer| flyer.name()).collect();
        let asked = controller.or(requirement.controller.as_deref());
        let name = match asked {
            None => names.first().copied(),
            Some(name) => names.iter().copied().find(|known| *known == name),
        };
        let Some(name) = name else {
            return Err(unknown("controller", asked.unwrap_or_default(), &names));
        };
        if let Some(only) = requirement.controller.as_ref().filter(|only| *only != name) {
            let (id, only) = (&requirement.id, only.as_str());
            let reason = format!("`{id}` is required of {only} alone, and not of {name}");
            return Err(CampaignError::NotOfFlights { reason });
        }
        let axes = campaign.draws().in_cube(axes);
        let controller = name.to_owned();
        let mixture = SettingPath::parse(MIXTURE_OF_AIR);
        Ok(Self { campaign, progress, controller, requirement, axes, mixture })
    }

    /// The controller.
    #[must_use]
    pub fn controller(&self) -> &str {
        &self.controller
    }

    /// The requirement.
    #[must_use]
    pub fn requirement(&self) -> &Requirement {
        &self.requirement
    }

    /// Whether anything that is drawn is a seed.
    pub(super) fn draws_seeds(&self) -> bool {
        self.axes.contains(&Axis::Seed)
    }

    /// How many points are kept together: a second or two of flights side by side, fewer of those flown one by one.
    pub(super) fn part(&self) -> usize {
        let scenario = &self.campaign.template().study().scenario;
        let side_by_side = scenario.flies_side_by_side() && scenario.externals.is_empty();
        (if side_by_side { SHARD_RUNS } else { SLOW_SHARD_RUNS }) as usize
    }

    /// Tells of flights that had been flown before.
    pub(super) fn found(&self, flights: u64) {
        self.progress.add_found(flights);
    }

    /// What is drawn at a point, but for mixtures: of those the newest seed.
    fn drawn(&self, point: &Point) -> Vec<Drawn> {
        let (mut normals, mut seeds) = (point.normals.iter(), point.seeds.iter());
        let mut airs = point.airs.iter();
        // The middle of what a seed stands for: both are exact.
        let of_seed = |seed: u64| (seed as f64 + 0.5) / SEED_LIMIT as f64;
        let coordinate = |axis: &Axis| match axis {
            Axis::Normal => in_unit(standard_normal::below(normals.next().copied().unwrap_or(0.0))),
            Axis::Air => {
                of_seed(airs.next().and_then(|air| air.terms.last()).map_or(0, |term| term.0))
            }
            Axis::Seed => of_seed(seeds.next().copied().unwrap_or(0)),
        };
        let cube: Vec<f64> = self.axes.iter().map(coordinate).collect();
        self.campaign.draws().drawn_at(&cube)
    }

    /// What a point changes in the scenario, as `--set` takes it.
    #[must_use]
    pub fn changes(&self, point: &Point) -> Vec<String> {
        let drawn = self.drawn(point);
        let values = self.values(&drawn, point);
        values.iter().map(|(path, value)| format!("{}={value}", path.text())).collect()
    }

    fn values(&self, drawn: &[Drawn], point: &Point) -> Vec<(&SettingPath, NewValue)> {
        let mut values = self.campaign.draws().values(drawn);
        // All that draw a seed of turbulence set the same one place, the last of them for good.
        let mixed = point.airs.last().filter(|air| air.terms.len() > 1);
        let noise = mixed.and_then(|air| Noise::mixed(&air.terms).ok());
        if let (Some(path), Some(noise)) = (&self.mixture, noise) {
            values.push((path, NewValue::Text(noise.to_string())));
        }
        values
    }

    /// The scenario of a point, with the one controller.
    fn study(&self, point: &Point) -> Result<Study, String> {
        let drawn = self.drawn(point);
        let built = self.campaign.template().with(&self.values(&drawn, point));
        let mut study = built.map_err(|problems| problems.first_in_a_line())?;
        study.scenario.controllers.retain(|it| it.name == self.controller);
        study.scenario.externals.retain(|it| it.name == self.controller);
        Ok(study)
    }

    /// What the flights of points say.
    pub(super) fn scored(&self, points: &[Point]) -> Result<Vec<Scored>, CampaignError> {
        let at_once = engine::at_once(self.campaign.template().study());
        let parts: Vec<Result<Vec<Scored>, CampaignError>> = points
            .par_chunks(at_once)
            .map_init(Memory::default, |memory, points| self.flown(memory, points))
            .collect();
        let mut scored = Vec::with_capacity(points.len());
        for part in parts {
            scored.extend(part?);
        }
        Ok(scored)
    }

    fn flown(&self, memory: &mut Memory, points: &[Point]) -> Result<Vec<Scored>, CampaignError> {
        if self.progress.is_stopped() {
            return Err(CampaignError::Stopped);
        }
        let studies: Vec<Result<Study, String>> = points.iter().map(|it| self.study(it)).collect();
        let sound: Vec<Study> = studies.iter().filter_map(|it| it.as_ref().ok().cloned()).collect();
        let mut flown = engine::fly_with(memory, &sound).into_iter();
        let scores = studies.iter().map(|study| {
            let flights = if study.is_ok() { flown.next() } else { None };
            match flights {
                Some(Err(error)) if error.is_of_host() => Err(error.into()),
                Some(Ok(flights)) => {
                    Ok(flights.first().map_or(Scored::LOST, |it| Scored::of(it, self.score(it))))
                }
                // Numbers that make no scenario, or one that cannot be flown: refused runs fail in campaigns too.
                _ => Ok(Scored::LOST),
            }
        });
        let scores: Result<Vec<Scored>, CampaignError> = scores.collect();
        self.progress.add_flown(points.len() as u64);
        scores
    }

    /// Above 0 for a flight that does not meet the requirement or fails by itself, and the higher the worse.
    fn score(&self, flight: &FlightResult) -> f64 {
        if let Some(at_s) = flight.diverged_at_s().or_else(|| flight.hit_ground_at_s()) {
            return LOST * (1.0 - at_s / LONGEST_S);
        }
        if !flight.ending().failures().is_empty() {
            return LOST * 0.5;
        }
        let mut judgements = flight.judgements.iter();
        let judgement = judgements.find(|it| it.requirement.id == self.requirement.id);
        let Some(judgement) = judgement else { return ABSENT };
        let slack = judgement.found.as_ref().map(|case| self.requirement.slack(case.value));
        match slack {
            Ok(slack) if judgement.met => (-slack).clamp(-ABSENT, 0.0),
            Ok(slack) if slack < 0.0 => (-slack).min(ABSENT),
            _ => ABSENT,
        }
    }
}

impl LimitState for Target<'_> {
    type Error = CampaignError;

    fn shape(&self) -> Shape {
        let count = |of: Axis| self.axes.iter().filter(|axis| **axis == of).count();
        Shape { normals: count(Axis::Normal), airs: count(Axis::Air), seeds: count(Axis::Seed) }
    }

    fn scores(&mut self, points: &[Point]) -> Result<Vec<f64>, CampaignError> {
        Ok(self.scored(points)?.iter().map(|it| it.score).collect())
    }
}

/// What the coordinates of a dispersion are drawn from.
fn axes(dispersion: &Dispersion) -> Vec<Axis> {
    let is_air = |path: &SettingPath| path.text() == SEED_OF_AIR;
    let mut paths = dispersion.targets.iter().flat_map(|target| &target.paths);
    match &dispersion.distribution {
        Distribution::Seed if paths.all(is_air) => vec![Axis::Air],
        Distribution::Seed => vec![Axis::Seed],
        other => vec![Axis::Normal; other.dimensions()],
    }
}

/// The requirement of this id, if flights answer it.
fn required(study: &Study, id: &str) -> Result<Requirement, CampaignError> {
    let of_flights = |requirement: &&Requirement| {
        matches!(requirement.measure.family(), Family::Step | Family::Flight)
    };
    let Some(requirement) = study.requirements.iter().find(|it| it.id == id) else {
        let ids: Vec<&str> =
            study.requirements.iter().filter(of_flights).map(|it| it.id.as_str()).collect();
        if study.requirements.is_empty() {
            let reason = "the scenario has no requirement; add what shall hold, for instance:\n\n        [[requirement]]\n        measure = \"overshoot_pct\"\n        most = 35.0\n";
            return Err(CampaignError::NotOfFlights { reason: reason.to_owned() });
        }
        return Err(unknown("requirement", id, &ids));
    };
    if !of_flights(&requirement) {
        let measure = requirement.measure.name();
        let reason = format!(
            "`{id}` asks for {measure}, which is of the linear loop and not of a flight; `fspid campaign run` counts it"
        );
        return Err(CampaignError::NotOfFlights { reason });
    }
    Ok(requirement.clone())
}

fn unknown(what: &'static str, found: &str, known: &[&str]) -> CampaignError {
    CampaignError::Unknown { what, found: found.to_owned(), known: known_words(found, known) }
}

/// Strictly between 0 and 1.
fn in_unit(share: f64) -> f64 {
    share.clamp(f64::MIN_POSITIVE, 1.0 - f64::EPSILON / 2.0)
}

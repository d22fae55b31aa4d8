//! The worst case inside the box of the dispersions, looked for on purpose.
//!
//! A search by differential evolution over the same unit cube that campaigns draw from, then downhill
//! by a simplex. Distributions without limits are searched within three standard deviations. What is
//! found is a flight, and so a proof that it is that bad; that nothing is worse is not proved.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use fspid_optimise::{LShade, NelderMead, Optimiser, Start, minimise};
use fspid_scenario::count::FLIGHTS;
use fspid_scenario::dispersion::{Dispersion, Distribution, Drawn, standard_normal};
use fspid_scenario::file::known_words;
use fspid_scenario::requirement::Requirement;
use rayon::prelude::*;
use serde_json::{Value, json};

use crate::campaign::Campaign;
use crate::engine::{self, FlightResult};
use crate::error::CampaignError;
use crate::replay::{changes, command};
use crate::rows::{Bad, LEFT_VALIDITY_AT, bad_side, is_of_size, measure_names, measured};

/// How far distributions without limits are searched, in standard deviations.
const FARTHEST: f64 = 3.0;
/// Nearest to the ends of the cube, where no distribution is defined.
const NEAREST: f64 = 1.0 / (1_u64 << 53) as f64;
/// Cost of a flight that has no such measure, and of one that is lost: below every number that a measure has.
const ABSENT: f64 = -1e200;
const LOST: f64 = -1e300;
/// Share of that which one has that leaves the range of its aircraft's data, and one that fails without an end.
const LEFT: f64 = 0.7;
const FAILED: f64 = 0.5;
/// Cost of a requirement that was not evaluated: worse than every one that is met, and better than every one that is not.
const NOT_EVALUATED: f64 = -f64::MIN_POSITIVE;
/// Of lost flights those count as worse that are lost earlier; no flight lasts this long.
const LONGEST_S: f64 = 1e12;

/// What is looked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Question {
    /// A measure, by the name of its column, or the id of a requirement.
    pub measure: String,
    /// True where low values are bad; otherwise that side is which is known of the measure ([`bad_side`]), the size of one
    /// that is asked for by its size, and the high side of the rest. A requirement knows itself.
    pub lowest: bool,
    /// The controller; the first one if none is named.
    pub controller: Option<String>,
    /// How many flights may be flown.
    pub budget: usize,
    /// Seed of the search.
    pub seed: u64,
}

/// The worst case that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    /// The controller.
    pub controller: String,
    /// The measure or requirement.
    pub measure: String,
    /// What is drawn there.
    pub drawn: Vec<Drawn>,
    /// The changes that make the scenario this one, as `--set` takes them.
    pub changes: Vec<String>,
    /// Value of the measure there; `None` for a flight that is lost or has none.
    pub value: Option<f64>,
    /// Value of the scenario as it is written.
    pub nominal: Option<f64>,
    /// Why the flight fails; empty where it does not.
    pub reasons: Vec<String>,
    /// Why nobody can tell whether its loop is stable at rest, where that is so.
    pub undecided: Option<String>,
    /// How many flights were flown.
    pub flown: usize,
    /// What came of them beside the measure.
    pub counts: Counts,
}

/// How many of the flights of a search came to what no measure tells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// They fail, by themselves or by a requirement.
    pub failed: usize,
    /// It is undecided whether their loop is stable at rest.
    pub undecided: usize,
    /// Their numbers make no scenario, so that nothing was flown.
    pub refused: usize,
}

/// Looks for the worst case of a campaign's scenario.
///
/// # Errors
/// A measure or a controller that there is not, no budget, or a scenario that cannot be flown.
pub fn search(campaign: &Campaign, question: &Question) -> Result<Worst, CampaignError> {
    let mut target = Target::of(campaign, question)?;
    let dimension = campaign.draws().dimensions();
    let polish = question.budget / 5;
    let population = (10 * dimension).clamp(24, 200).min(question.budget.max(4));
    let global = question.budget - polish;
    let mut wide = LShade::new(dimension, population, global, question.seed, Start::Anywhere);
    let mut flown = target.search(&mut wide, global);
    let (point, cost) = wide.best();
    let mut downhill = NelderMead::new(point, cost);
    flown += target.search(&mut downhill, polish);
    if let Some(error) = target.failed.take() {
        return Err(error);
    }
    let (point, _) = downhill.best();
    let drawn = campaign.draws().drawn_at(&target.inside(point));
    let nominal = target.flight_of(vec![campaign.template().study().clone()]).pop().flatten();
    let worst = target.flight(&drawn);
    let changes = changes(campaign, &drawn);
    Ok(Worst {
        controller: target.controller.clone(),
        measure: question.measure.clone(),
        value: worst.as_ref().and_then(|flight| target.value(flight)),
        undecided: worst.as_ref().and_then(|flight| flight.at_rest.undecided_in_words()),
        reasons: worst.map_or(Vec::new(), |flight| flight.reasons()),
        counts: target.tally.counts(),
        nominal: nominal.and_then(|flight| target.value(&flight)),
        changes,
        drawn,
        flown,
    })
}

/// What is made worse.
struct Target<'a> {
    campaign: &'a Campaign,
    question: &'a Question,
    controller: String,
    place: usize,
    is_requirement: bool,
    /// Which values are bad; those of a large size where neither side is.
    bad: Option<Bad>,
    /// Share of each coordinate that is left out at its lower and upper end.
    tails: Vec<[f64; 2]>,
    /// What kept a flight from being flown that is not of the flight.
    failed: OnceLock<CampaignError>,
    tally: Tally,
}

/// [`Counts`] that grow on all threads at once.
#[derive(Default)]
struct Tally {
    failed: AtomicUsize,
    undecided: AtomicUsize,
    refused: AtomicUsize,
}

impl Tally {
    fn add(&self, flight: Option<&FlightResult>) {
        let one = |count: &AtomicUsize, is_one: bool| {
            count.fetch_add(usize::from(is_one), Ordering::Relaxed);
        };
        one(&self.failed, flight.is_some_and(FlightResult::is_failed));
        one(&self.undecided, flight.is_some_and(|it| it.at_rest.undecided.is_some()));
        one(&self.refused, flight.is_none());
    }

    fn counts(&self) -> Counts {
        let [failed, undecided, refused] = [&self.failed, &self.undecided, &self.refused]
            .map(|count| count.load(Ordering::Relaxed));
        Counts { failed, undecided, refused }
    }
}

impl<'a> Target<'a> {
    fn of(campaign: &'a Campaign, question: &'a Question) -> Result<Self, CampaignError> {
        let study = campaign.template().study();
        let names: Vec<&str> = study.scenario.flyers().map(|flyer| flyer.name()).collect();
        let place = match &question.controller {
            None => Some(0),
            Some(name) => names.iter().position(|known| known == name),
        };
        let unknown = |what, found: &str, known: Vec<&str>| CampaignError::Unknown {
            what,
            found: found.to_owned(),
            known: known_words(found, &known),
        };
        let Some((place, name)) = place.and_then(|place| Some((place, *names.get(place)?))) else {
            let found = question.controller.as_deref().unwrap_or_default();
            return Err(unknown("controller", found, names));
        };
        // One of another controller is asked of none of these flights.
        let mine = |it: &&Requirement| it.controller.as_ref().is_none_or(|of| of == name);
        let ids: Vec<&str> =
            study.requirements.iter().filter(mine).map(|it| it.id.as_str()).collect();
        let is_requirement = ids.contains(&question.measure.as_str());
        if !is_requirement && !measure_names().any(|(name, _)| name == question.measure) {
            // A requirement may be called as its measure is.
            let ids = ids.into_iter().filter(|id| !measure_names().any(|(name, _)| name == *id));
            let known = measure_names().map(|(name, _)| name).chain(ids).collect();
            return Err(unknown("measure", &question.measure, known));
        }
        FLIGHTS.check(question.budget)?;
        let controller = name.to_owned();
        let tails = campaign.draws().in_cube(tails);
        let (failed, tally) = (OnceLock::new(), Tally::default());
        let measure = &question.measure;
        let bad = match bad_side(measure) {
            _ if question.lowest => Some(Bad::Low),
            None if !is_of_size(measure) => Some(Bad::High),
            known => known,
        };
        Ok(Self {
            campaign,
            question,
            controller,
            place,
            is_requirement,
            bad,
            tails,
            failed,
            tally,
        })
    }

    /// Makes it as bad as can be found; flights flown.
    fn search(&self, optimiser: &mut dyn Optimiser, budget: usize) -> usize {
        let at_once = engine::at_once(self.campaign.template().study());
        minimise(optimiser, budget, f64::NEG_INFINITY, |points| {
            points.par_chunks(at_once).flat_map_iter(|points| self.costs(points)).collect()
        });
        optimiser.spent()
    }

    fn costs(&self, points: &[Vec<f64>]) -> Vec<f64> {
        let drawn = points.iter().map(|point| self.campaign.draws().drawn_at(&self.inside(point)));
        let runs = self.campaign.fly_together((0..).zip(drawn)).unwrap_or_else(|error| {
            let _ = self.failed.set(error);
            Vec::new()
        });
        runs.iter()
            .map(|run| {
                let flights = run.flights.as_ref().ok();
                let flight = flights.and_then(|flights| flights.get(self.place));
                self.tally.add(flight);
                // No scenario, no worst case of one.
                flight.map_or(f64::INFINITY, |flight| self.cost(flight))
            })
            .chain(std::iter::repeat(f64::INFINITY))
            .take(points.len())
            .collect()
    }

    /// A point of the searched box as one of the open unit cube.
    fn inside(&self, point: &[f64]) -> Vec<f64> {
        let at = |(x, [lower, upper]): (&f64, &[f64; 2])| {
            (lower + x * (1.0 - lower - upper)).clamp(NEAREST, 1.0 - NEAREST)
        };
        point.iter().zip(&self.tails).map(at).collect()
    }

    /// Low for bad flights.
    fn cost(&self, flight: &FlightResult) -> f64 {
        let earlier = |at_s: f64| 1.0 - at_s / LONGEST_S;
        if let Some(at_s) = flight.diverged_at_s().or_else(|| flight.hit_ground_at_s()) {
            return LOST * earlier(at_s);
        }
        let ending = flight.ending();
        if let Some(exit) = ending.failing_exit() {
            return LOST * LEFT * earlier(exit.at_s);
        }
        if ending.measured.is_failure() {
            return LOST * FAILED;
        }
        let towards = |value: f64| match self.bad {
            Some(Bad::Low) => value,
            Some(Bad::High) => -value,
            None => -value.abs(),
        };
        let (cost, absent) = match self.is_requirement {
            true => (self.slack(flight), NOT_EVALUATED),
            // Who never leaves the range is none of those who do.
            false if self.question.measure == LEFT_VALIDITY_AT => {
                (self.value(flight).map(towards), -ABSENT)
            }
            false => (self.value(flight).map(towards), ABSENT),
        };
        cost.filter(|cost| !cost.is_nan()).unwrap_or(absent)
    }

    fn value(&self, flight: &FlightResult) -> Option<f64> {
        if !self.is_requirement {
            return measured(flight, &self.question.measure);
        }
        let mut judgements = flight.judgements.iter();
        let judgement = judgements.find(|it| it.requirement.id == self.question.measure)?;
        judgement.found.as_ref().ok().map(|case| case.value)
    }

    fn slack(&self, flight: &FlightResult) -> Option<f64> {
        let mut judgements = flight.judgements.iter();
        let judgement = judgements.find(|it| it.requirement.id == self.question.measure)?;
        Some(judgement.requirement.slack(judgement.found.as_ref().ok()?.value))
    }

    fn flight(&self, drawn: &[Drawn]) -> Option<FlightResult> {
        let study = self.campaign.study(drawn).ok()?;
        self.flight_of(vec![study]).pop().flatten()
    }

    fn flight_of(&self, studies: Vec<fspid_scenario::file::Study>) -> Vec<Option<FlightResult>> {
        let flown = engine::fly(&studies).into_iter();
        flown.map(|flights| flights.ok()?.into_iter().nth(self.place)).collect()
    }
}

/// What is left out at the ends of each coordinate of a dispersion: the sides on which there is no limit.
fn tails(dispersion: &Dispersion) -> Vec<[f64; 2]> {
    let tail = standard_normal::below(-FARTHEST);
    let without = |limit: Option<f64>| if limit.is_none() { tail } else { 0.0 };
    match &dispersion.distribution {
        Distribution::Normal(normal) => vec![[without(normal.lower()), without(normal.upper())]],
        // The coordinates are those of independent normals, whatever limits their mixtures have.
        Distribution::Correlated(correlated) => vec![[tail; 2]; correlated.entries().len()],
        other => vec![[0.0; 2]; other.dimensions()],
    }
}

impl Counts {
    /// " Of all that were asked 46 fail; 3 are undecided: …"; nothing where there are none.
    fn in_words(self) -> String {
        let told = [
            (self.failed, "fail"),
            (self.undecided, "are undecided: nobody can tell whether their loop is stable at rest"),
            (self.refused, "make no scenario, and count as none"),
        ];
        let told = told.iter().filter(|(count, _)| *count > 0);
        let told: Vec<String> = told.map(|(count, what)| format!("{count} {what}")).collect();
        if told.is_empty() {
            String::new()
        } else {
            format!(" Of all that were asked {}.", told.join("; "))
        }
    }
}

impl Worst {
    /// The answer for people.
    #[must_use]
    pub fn text(&self, campaign: &Campaign) -> String {
        let shown = |value: Option<f64>| {
            value.map_or_else(|| "none".to_owned(), |value| format!("{value:.6}"))
        };
        let unit = match measure_names().find(|(name, _)| *name == self.measure) {
            Some((_, "")) | None => String::new(),
            Some((_, unit)) => format!(" {unit}"),
        };
        let mut out = format!(
            "{}: worst {} found in {} flights: {}{unit} (as written: {}{unit})\n",
            self.controller,
            self.measure,
            self.flown,
            shown(self.value),
            shown(self.nominal),
        );
        for reason in &self.reasons {
            out.push_str(&format!("  fails: {reason}\n"));
        }
        if let Some(undecided) = &self.undecided {
            out.push_str(&format!("  {undecided}\n"));
        }
        for change in &self.changes {
            out.push_str(&format!("  {change}\n"));
        }
        out.push_str(&format!("  again: {}\n", command(campaign, &self.changes)));
        out.push_str("This flight is that bad; that none is worse is not proved.");
        out.push_str(&self.counts.in_words());
        out.push('\n');
        out
    }

    /// The answer for programs.
    #[must_use]
    pub fn json(&self, campaign: &Campaign) -> Value {
        json!({
            "schema": 1,
            "controller": self.controller,
            "measure": self.measure,
            "value": self.value,
            "nominal": self.nominal,
            "reasons": self.reasons,
            "changes": self.changes,
            "flights": self.flown,
            "failed": self.counts.failed,
            "undecided": self.counts.undecided,
            "refused": self.counts.refused,
            "worst_undecided": self.undecided,
            "command": command(campaign, &self.changes),
        })
    }
}

//! The answer: what is known of the probability, what it took, and the likeliest failure.

use fspid_scenario::requirement::Requirement;
use serde_json::{Value, json};

use super::figure;
use super::importance::Importance;
use super::interval::{CONFIDENCE, Interval};
use super::point::Point;
use super::question::{Method, Question};
use super::seldom::Seldom;
use super::subset::{Known, Subset};
use super::target::Target;
use super::teams::TEAMS;
use crate::campaign::Campaign;
use crate::replay::command;

/// What the methods found, as far as they were asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Subset simulation.
    pub subset: Option<Subset>,
    /// Importance sampling.
    pub importance: Option<Importance>,
}

/// The answer to a question.
#[derive(Clone, Debug, PartialEq)]
pub struct Rare {
    /// The question.
    pub question: Question,
    /// The controller.
    pub controller: String,
    /// The requirement.
    pub requirement: Requirement,
    /// How long a flight is, s.
    pub flight_s: f64,
    /// What was found.
    pub found: Found,
    /// The likeliest failure.
    pub likeliest: Option<Likeliest>,
    /// Whether a seed is drawn.
    pub draws_seeds: bool,
    /// Combinations of chosen values that independent flights have met too seldom for anybody to know what they do: all of
    /// their probability counts in every upper end.
    pub hardly_flown: Seldom,
    /// Flights that do not fail, and of whose loop nobody can tell whether it is stable at rest.
    pub undecided: u64,
}

/// A failure, as it can be flown again.
#[derive(Clone, Debug, PartialEq)]
pub struct Likeliest {
    /// Changes of the scenario, as `--set` takes them.
    pub changes: Vec<String>,
    /// The command that flies it.
    pub command: String,
    /// How far its numbers are from their middle, in standard deviations; none where seeds alone are drawn.
    pub distance: Option<f64>,
}

/// Standard normal quantile at 0.975.
const Z: f64 = 1.959_963_984_540_054;

impl Rare {
    pub(super) fn new(
        campaign: &Campaign,
        question: &Question,
        (target, undecided): (&Target<'_>, u64),
        mut found: Found,
    ) -> Self {
        let independent = match (&found.subset, &found.importance) {
            (Some(subset), _) => (TEAMS * subset.teams.count) as f64,
            (None, Some(importance)) => importance.independent,
            (None, None) => question.flights as f64,
        };
        let study = campaign.template().study();
        let hardly_flown = Seldom::of(&study.dispersions, independent);
        if let Some(subset) = &mut found.subset {
            subset.known = subset.known.raised(hardly_flown.share);
        }
        if let Some(importance) = &mut found.importance {
            importance.known = importance.known.raised(hardly_flown.share);
        }
        let of_subset = found.subset.as_ref().and_then(Subset::likeliest);
        let of_importance = found.importance.as_ref().and_then(|it| it.likeliest.as_ref());
        let nearest = of_subset
            .into_iter()
            .chain(of_importance)
            .min_by(|a, b| a.distance_squared().total_cmp(&b.distance_squared()));
        let likeliest = |point: &Point| {
            let changes = target.changes(point);
            let command = command(campaign, &changes);
            let has_numbers = !point.normals.is_empty();
            let distance = has_numbers.then(|| libm::sqrt(point.distance_squared()));
            Likeliest { changes, command, distance }
        };
        Self {
            hardly_flown,
            undecided,
            question: question.clone(),
            controller: target.controller().to_owned(),
            requirement: target.requirement().clone(),
            flight_s: study.scenario.timing.end_s(),
            likeliest: nearest.map(likeliest),
            draws_seeds: target.draws_seeds(),
            found,
        }
    }

    /// What each method that was asked knows.
    #[must_use]
    pub fn known(&self) -> Vec<(Method, Known)> {
        let subset = self.found.subset.as_ref().map(|it| (Method::Subset, it.known));
        let importance = self.found.importance.as_ref().map(|it| (Method::Importance, it.known));
        subset.into_iter().chain(importance).collect()
    }

    /// Whether two methods with intervals agree: whether those have a number in common.
    #[must_use]
    pub fn agree(&self) -> Option<bool> {
        match self.known().as_slice() {
            [(_, Known::Within(one)), (_, Known::Within(other))] => {
                Some(one.low <= other.high && other.low <= one.high)
            }
            [(_, Known::Within(one)), (_, Known::Below { most, .. })]
            | [(_, Known::Below { most, .. }), (_, Known::Within(one))] => Some(one.low <= *most),
            _ => None,
        }
    }

    /// The interval that stands for the answer: the first method's, or else the other's, unless they disagree.
    #[must_use]
    pub fn interval(&self) -> Option<Interval> {
        if self.agree() == Some(false) {
            return None;
        }
        self.known().into_iter().find_map(|(_, known)| match known {
            Known::Within(interval) => Some(interval),
            Known::Below { .. } => None,
        })
    }

    /// The largest probability that is left: the upper end of the interval; without one, the bound; of methods that disagree
    /// the larger.
    #[must_use]
    pub fn at_most(&self) -> f64 {
        if let Some(interval) = self.interval() {
            return interval.high;
        }
        let bounds = self.known().into_iter().map(|(_, known)| match known {
            Known::Within(interval) => interval.high,
            Known::Below { most, .. } => most,
        });
        let disagree = self.agree() == Some(false);
        bounds.fold(if disagree { 0.0 } else { 1.0 }, if disagree { f64::max } else { f64::min })
    }

    /// Whether the probability is known to be below what is required, if that is asked: not where nobody can tell whether what
    /// was flown is stable.
    #[must_use]
    pub fn is_allowed(&self) -> Option<bool> {
        self.question.most.map(|most| self.at_most() <= most && self.undecided == 0)
    }

    /// Flights that were asked for.
    #[must_use]
    pub fn flights(&self) -> u64 {
        let subset = self.found.subset.as_ref().map_or(0, |it| it.asked);
        subset + self.found.importance.as_ref().map_or(0, |it| it.asked)
    }

    /// Flights that plain sampling would take for an interval as narrow, in ratio:
    /// $n = (z / h)^2 (1 - p) / p$ with half its width h in the logarithm.
    #[must_use]
    pub fn plain_flights(&self) -> Option<f64> {
        let Interval { estimate, low, high, .. } = self.interval()?;
        let half = 0.5 * libm::log(high / low);
        (half > 0.0).then(|| Z / half * (Z / half) * (1.0 - estimate) / estimate)
    }

    /// As a rate in an hour of flights that follow each other: $-\ln(1 - p) / T$.
    #[must_use]
    pub fn per_hour(&self, probability: f64) -> f64 {
        -libm::log1p(-probability) * 3600.0 / self.flight_s
    }

    /// The levels as a figure; empty where only importance sampling was asked.
    #[must_use]
    pub fn figure(&self) -> String {
        figure::levels(self)
    }

    /// The answer for programs.
    #[must_use]
    pub fn json(&self) -> Value {
        let interval = self.interval();
        let hours = |interval: Interval| {
            json!({
                "estimate": self.per_hour(interval.estimate),
                "low": self.per_hour(interval.low),
                "high": self.per_hour(interval.high),
                "flight_s": self.flight_s,
            })
        };
        json!({
            "schema": 1,
            "controller": self.controller,
            "fails": self.requirement.id,
            "required": self.requirement.limits_in_words(),
            "method": self.question.method.name(),
            "seed": self.question.seed.to_string(),
            "confidence": CONFIDENCE,
            "probability": interval.map(interval_json),
            "at_most": self.at_most(),
            "per_hour": interval.map(hours),
            "flights": self.flights(),
            "plain_flights": self.plain_flights(),
            "agree": self.agree(),
            "most": self.question.most,
            "allowed": self.is_allowed(),
            "undecided": self.undecided,
            "subset": self.found.subset.as_ref().map(subset_json),
            "importance": self.found.importance.as_ref().map(importance_json),
            "likeliest": self.likeliest.as_ref().map(|it| json!({
                "changes": it.changes,
                "command": it.command,
                "standard_deviations": it.distance,
            })),
            "notes": self.notes(),
        })
    }
}

fn interval_json(interval: Interval) -> Value {
    let Interval { estimate, low, high, .. } = interval;
    json!({ "estimate": estimate, "low": low, "high": high })
}

fn known_json(known: Known) -> Value {
    match known {
        Known::Within(interval) => json!({ "probability": interval_json(interval) }),
        Known::Below { most, why } => json!({ "at_most": most, "why": why.in_words() }),
    }
}

fn subset_json(subset: &Subset) -> Value {
    let rungs = subset.rungs.iter().enumerate().map(|(place, rung)| {
        json!({
            "within": -rung.level,
            "probability": subset.reached(place + 1),
            "moves_made": subset.teams.made.get(place),
        })
    });
    json!({
        "known": known_json(subset.known),
        "flights": subset.asked,
        "levels": rungs.collect::<Vec<_>>(),
        "teams": subset.teams.estimates(subset.teams.shares.len()),
        "flights_of_a_level": subset.teams.count,
    })
}

fn importance_json(importance: &Importance) -> Value {
    json!({
        "known": known_json(importance.known),
        "flights": importance.asked,
        "levels": importance.levels.iter().map(|level| -level).collect::<Vec<_>>(),
        "failures": importance.failing,
        "effective_failures": importance.effective,
        "largest_share": importance.largest_share,
        "means": importance.aim.means,
        "standard_deviations": importance.aim.deviations,
    })
}

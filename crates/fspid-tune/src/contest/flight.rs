//! What a flight of the contest leaves behind.

use fspid_campaign::engine::FlightResult;
use fspid_campaign::rows;
use fspid_scenario::measure::Measure;
use fspid_scenario::requirement::{AskedIn, Conditions, Origin, Requirement};
use fspid_scenario::tuning::Objective;
use fspid_scenario::units::degrees;
use fspid_sim::Doubt;
use fspid_study::judgement::{Judgement, NotEvaluated};
use fspid_study::metrics::{Absent, Verdict};
use serde::{Deserialize, Serialize};

use crate::bits;
use crate::score::FlightScore;

/// Measures that are told of every flight: name, unit.
pub const MEASURES: [(&str, &str); 7] = [
    ("iae_deg_s", "deg s"),
    ("itae_deg_s2", "deg s²"),
    ("elevator_travel_deg", "deg"),
    ("overshoot_pct", "%"),
    ("settling_time_s", "s"),
    ("largest_error_deg", "deg"),
    ("rms_error_deg", "deg"),
];

/// Places of some measures in [`MEASURES`].
pub(crate) const IAE: usize = 0;
pub(crate) const TRAVEL: usize = 2;
pub(crate) const OVERSHOOT: usize = 3;
const SETTLING: usize = 4;

/// Largest error beyond which a flight is lost, deg. A loop with limits oscillates instead of diverging; beyond a
/// right angle there is no pitch hold left whose error could be compared.
const LOST_DEG: f64 = 90.0;
/// Reason of a failure: the same.
pub(crate) const FAR: &str = "an error beyond 90 deg";
/// Reasons of a failure.
const UNSTABLE: &str = "the loop is unstable at rest";
/// As [`UNSTABLE`], where nobody can tell: it counts as that.
const UNDECIDED: &str = "stability of the loop at rest is undecided";
/// Which flights are lost, wherever that is said.
pub(crate) const LOST: &str =
    "diverges, hits the ground, has an error beyond 90 deg, or cannot be flown";
/// Which flights fail, wherever that is said.
pub(crate) const FAILED: &str = "is lost, leaves the range of its aircraft's data where its scenario does not allow that, breaks a requirement, or is of a loop that is unstable at rest";

/// A flight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Flight {
    /// The measures of [`MEASURES`]; none where the flight does not have one.
    #[serde(with = "bits")]
    pub measures: [Option<f64>; MEASURES.len()],
    /// What counts in means: infinite for a lost flight, the length of its window for a step that did not
    /// settle; none where nothing was asked, as of overshoot without a step.
    #[serde(with = "bits")]
    pub(crate) counted: [Option<f64>; MEASURES.len()],
    /// What the objectives of the tuning cost; none without objectives, or where one has no value.
    #[serde(with = "bits")]
    pub cost: Option<f64>,
    /// The verdict in words.
    pub verdict: String,
    /// True for a flight that is lost.
    pub lost: bool,
    /// True for a loop that is unstable at rest, with the gains that it has there. It is judged by its error as it
    /// flew, and counts as failed: a calm window proves nothing.
    pub unstable: bool,
    /// True for a flight that has failed.
    pub failed: bool,
    /// True for a loop that does not remove a constant load at the servo within the flight, with the gains that it has at
    /// rest. It is told, and fails nothing: a controller may have no integral by design.
    pub load_left: bool,
    /// True where that stays for good: there is no integral at rest.
    pub load_stays: bool,
    /// The gains at rest beside the nominal ones, in words; none for fixed gains.
    pub gains: Option<String>,
    /// Why it is lost, and which requirements are broken.
    pub reasons: Vec<String>,
}

impl Flight {
    /// True for a flight with the same measures to the last bit; of what is lost nobody knows.
    pub(crate) fn has_measures_of(&self, other: &Self) -> bool {
        let bits = |flight: &Self| flight.measures.map(|value| value.map(f64::to_bits));
        let is_flown = !self.lost && self.measures.iter().any(Option::is_some);
        is_flown && !other.lost && bits(self) == bits(other)
    }

    /// The same of one of which as much is required.
    pub(crate) fn is_alike(&self, other: &Self) -> bool {
        self.has_measures_of(other) && self.failed == other.failed
    }

    pub(crate) fn refused(reason: String) -> Self {
        Self {
            measures: [None; MEASURES.len()],
            counted: [Some(f64::INFINITY); MEASURES.len()],
            cost: None,
            verdict: rows::REFUSED.to_owned(),
            lost: true,
            unstable: false,
            load_left: false,
            load_stays: false,
            gains: None,
            failed: true,
            reasons: vec![reason],
        }
    }

    /// Of a flight whose judgements end with those of [`measured`].
    pub(crate) fn of(flight: &FlightResult, objectives: &[Objective], duration_s: f64) -> Self {
        let judged = flight.judgements.split_last().map_or(&[][..], |(_stability, rest)| rest);
        let (asked, costs) = judged.split_at(judged.len().saturating_sub(objectives.len()));
        let score = FlightScore::of(flight, (asked, costs), duration_s);
        let measures = MEASURES.map(|(name, _)| rows::measured(flight, name));
        let is_far = !(degrees(flight.largest_error_rad) <= LOST_DEG);
        let is_lost = flight.metrics.verdict.is_failure() || measures[IAE].is_none() || is_far;
        let mut measures = if is_lost { [None; MEASURES.len()] } else { measures };
        let mut counted = measures;
        for (index, value) in counted.iter_mut().enumerate() {
            *value = value.or_else(|| stand_in(flight, index, is_lost));
        }
        if is_unstable(flight) {
            // A loop that is unstable at rest settles nothing; in means these count as they flew.
            (measures[OVERSHOOT], measures[SETTLING]) = (None, None);
        }
        let unmet = asked.iter().any(|judgement| !judgement.met);
        let costs = score.values.iter().zip(objectives);
        let cost = costs.map(|(value, objective)| objective.weight * value).sum::<f64>();
        let has_cost = !objectives.is_empty() && !is_lost && !score.values.is_empty();
        Self {
            measures,
            counted,
            cost: has_cost.then_some(cost).filter(|cost| cost.is_finite()),
            verdict: verdict_of(flight, is_far),
            lost: is_lost,
            unstable: is_unstable(flight),
            gains: flight.at_rest.gains_in_words(),
            load_left: flight.at_rest.load.is_some_and(|load| !load.is_removed()),
            load_stays: flight.at_rest.load.is_some_and(|load| load.stays()),
            failed: is_lost
                || unmet
                || is_unstable(flight)
                || !flight.ending().failures().is_empty(),
            reasons: is_far
                .then(|| FAR.to_owned())
                .into_iter()
                .chain(is_unstable(flight).then(|| why_unstable(flight)))
                .chain(score.reasons)
                .collect(),
        }
    }
}

/// The verdict of a flight as the contest has it.
fn verdict_of(flight: &FlightResult, is_far: bool) -> String {
    let verdict = flight.metrics.verdict;
    match (verdict.is_failure(), flight.at_rest.unstable) {
        (false, _) if is_far => format!("lost: an error beyond {LOST_DEG} deg"),
        (false, Some(unstable)) => Verdict::Unstable {
            spectral_radius: unstable.spectral_radius,
            doubling_s: unstable.doubling_s,
        }
        .to_string(),
        _ => verdict.to_string(),
    }
}

/// What is measured of each flight of a contest beside its requirements: what the objectives cost, and last whether
/// the loop is stable at rest, which everybody is asked whatever the requirements of the case are.
pub(crate) fn measured(objectives: &[Objective]) -> Vec<Requirement> {
    let stable = Requirement {
        id: "stability at rest".to_owned(),
        controller: None,
        measure: Measure::Stable,
        least: Some(1.0),
        most: None,
        conditions: Conditions::default(),
        origin: Origin::default(),
        cases: AskedIn::default(),
    };
    objectives.iter().map(|it| it.requirement.clone()).chain([stable]).collect()
}

/// Of fixed gains the engine knows; of gains that move, the linear loop at the gains at rest says it. Where there is no
/// linear loop, there is nothing but the flight.
fn is_unstable(flight: &FlightResult) -> bool {
    let of_loop = |judgement: &Judgement| match &judgement.found {
        // Where rounding hides it, nobody may call it stable either.
        Err(
            NotEvaluated::Unstable { .. }
            | NotEvaluated::Absent(Absent::Undecided(Doubt::Rounding { .. })),
        ) => true,
        Ok(case) => judgement.requirement.measure == Measure::Stable && !(case.value >= 1.0),
        Err(_) => false,
    };
    flight.at_rest.unstable.is_some() || flight.judgements.iter().any(of_loop)
}

/// The reason that a loop gives which is not stable.
fn why_unstable(flight: &FlightResult) -> String {
    match (flight.at_rest.unstable, flight.at_rest.undecided) {
        (None, Some(_)) => UNDECIDED.to_owned(),
        _ => UNSTABLE.to_owned(),
    }
}

/// What stands for a measure that a flight does not have.
fn stand_in(flight: &FlightResult, measure: usize, is_lost: bool) -> Option<f64> {
    if is_lost {
        return Some(f64::INFINITY);
    }
    let step = flight.metrics.first_step();
    let why = match measure {
        OVERSHOOT => step.overshoot_pct.err()?,
        SETTLING => step.settling_time_s.err()?,
        _ => return Some(f64::INFINITY),
    };
    match why {
        Absent::NoStep => None,
        Absent::NotSettled { window_s } if measure == SETTLING => Some(window_s),
        _ => Some(f64::INFINITY),
    }
}

//! What a flight of the contest leaves behind.

use fspid_campaign::engine::FlightResult;
use fspid_campaign::rows;
use fspid_scenario::measure::Measure;
use fspid_scenario::requirement::{AskedIn, Conditions, Origin, Requirement};
use fspid_scenario::tuning::Objective;
use fspid_scenario::units::degrees;
use fspid_sim::Doubt;
use fspid_study::judgement::{Judgement, NotEvaluated};
use fspid_study::metrics::{Absent, Measured, Verdict};
use serde::{Deserialize, Serialize};

use crate::bits;
use crate::score::FlightScore;

/// Measures that are told of every flight: not all, and in an order of their own, which the columns of a contest's file and
/// the keys of its answer keep.
pub const MEASURES: [Measure; 7] = [
    Measure::ErrorIntegral,
    Measure::TimedErrorIntegral,
    Measure::ElevatorTravel,
    Measure::Overshoot,
    Measure::SettlingTime,
    Measure::LargestError,
    Measure::RmsError,
];

/// Places of some measures in [`MEASURES`].
pub(crate) const IAE: usize = place(Measure::ErrorIntegral);
pub(crate) const TRAVEL: usize = place(Measure::ElevatorTravel);
pub(crate) const OVERSHOOT: usize = place(Measure::Overshoot);
const SETTLING: usize = place(Measure::SettlingTime);
const RMS: usize = place(Measure::RmsError);

/// Place of a measure in [`MEASURES`]; one that is missing there does not compile.
const fn place(measure: Measure) -> usize {
    let mut place = 0;
    while MEASURES[place] as usize != measure as usize {
        place += 1;
    }
    place
}

/// Measures that differ by no more than this share of their size are those of one flight: more than what a ninth digit of a
/// number makes of it, and less than anything that is to count as another case.
const ALIKE: f64 = 1e-6;

fn are_alike(one: Option<f64>, other: Option<f64>) -> bool {
    match (one, other) {
        (Some(one), Some(other)) => {
            (one - other).abs() <= ALIKE * one.abs().max(other.abs()).max(ALIKE)
        }
        (one, other) => one.is_none() && other.is_none(),
    }
}

/// Measures of a linear loop that grow with its command: errors, their integrals and the way of the elevator. All others stay.
const GROWS: [Measure; 4] = [
    Measure::ErrorIntegral,
    Measure::TimedErrorIntegral,
    Measure::ElevatorTravel,
    Measure::LargestError,
];

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
    /// True where nobody can tell whether the loop is stable, at rest or where its flight leads. It fails nothing by itself, and
    /// who has one does not win.
    pub undecided: bool,
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
    /// True for a flight whose measures are alike; of what is lost nobody knows.
    ///
    /// The RMS error is left out, for it is over the whole flight: of one that only goes on longer it is another.
    pub(crate) fn has_measures_of(&self, other: &Self) -> bool {
        let is_flown = !self.lost && self.measures.iter().any(Option::is_some);
        let are_alike =
            |place: usize| place == RMS || are_alike(self.measures[place], other.measures[place]);
        is_flown && !other.lost && (0..MEASURES.len()).all(are_alike)
    }

    /// How many times as large as another flight's the errors of this one are.
    pub(super) fn size_beside(&self, other: &Self) -> Option<f64> {
        let [mine, theirs] = [self, other].map(|it| it.measures[IAE]);
        Some(mine? / theirs?).filter(|size| size.is_finite() && *size > 0.0)
    }

    /// True for a flight that is the other in another size: so many times as large in all that grows with a command, and alike
    /// in all else, as of a loop that is linear in both. It shows nothing that the other does not.
    pub(super) fn is_copy_in_size(&self, other: &Self, size: f64) -> bool {
        let grown = |place: usize| {
            let times = if GROWS.contains(&MEASURES[place]) { size } else { 1.0 };
            other.measures[place].map(|it| times * it)
        };
        let theirs = Self { measures: std::array::from_fn(grown), ..other.clone() };
        self.failed == other.failed && self.has_measures_of(&theirs)
    }

    /// True for a flight that shows nothing that the other does not: lost as it is, or with measures that are alike.
    pub(super) fn is_copy_of(&self, other: &Self) -> bool {
        let is_lost_alike = || {
            self.lost
                && other.lost
                && (&self.verdict, &self.reasons) == (&other.verdict, &other.reasons)
        };
        self.failed == other.failed && (is_lost_alike() || self.has_measures_of(other))
    }

    pub(crate) fn refused(reason: String) -> Self {
        Self {
            measures: [None; MEASURES.len()],
            counted: [Some(f64::INFINITY); MEASURES.len()],
            cost: None,
            verdict: rows::REFUSED.to_owned(),
            lost: true,
            unstable: false,
            undecided: false,
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
        let found = MEASURES.map(|measure| flight.metrics.measured(measure));
        let is_far = !(degrees(flight.metrics.largest_error_rad) <= LOST_DEG);
        let is_lost = flight.metrics.verdict.is_failure() || found[IAE].is_err() || is_far;
        let mut measures = found.map(|value| value.ok().filter(|_| !is_lost));
        let counted = found.map(|value| if is_lost { Some(f64::INFINITY) } else { counted(value) });
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
            undecided: flight.at_rest.undecided.is_some() && !is_unstable(flight),
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

/// What counts of a measure in means: of a step that did not settle its window, none where nothing was asked.
fn counted(found: Measured) -> Option<f64> {
    match found {
        Ok(value) => Some(value),
        Err(Absent::NoStep) => None,
        Err(Absent::NotSettled { window_s, .. }) => Some(window_s),
        Err(_) => Some(f64::INFINITY),
    }
}

#[cfg(test)]
mod tests {
    use fspid_study::metrics::Metric;

    use super::*;

    #[test]
    fn every_measure_of_a_contest_is_one_that_flights_have() {
        for measure in MEASURES {
            assert!(Metric::asked_as(measure).is_some(), "{}", measure.name());
        }
    }
}

//! The parts of a summary, as plain data.

use serde::Serialize;

pub use crate::rows::Bad;
use crate::sample::Sampling;
use crate::statistics::quantile::Interval;
use crate::statistics::rank::Correlation;
use crate::statistics::share::Share;
use crate::statistics::{Histogram, Moments};
use crate::table::{Digest, Kind};

/// What can be chosen about a summary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SummarySettings {
    /// Confidence of intervals and bounds, above 0 and below 1.
    pub confidence: f64,
    /// Most rows whose values are sorted; of more, quantiles come from sketches.
    pub exact_rows: u64,
    /// True where parts may be missing: what is said is then of those that are there, and says so.
    pub incomplete: bool,
}

impl Default for SummarySettings {
    /// 95 %, [`EXACT_ROWS`](super::EXACT_ROWS), and all parts.
    fn default() -> Self {
        Self { confidence: 0.95, exact_rows: super::EXACT_ROWS, incomplete: false }
    }
}

/// What a campaign says.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Which campaign.
    pub head: Head,
    /// What each controller did, in the order of the scenario.
    pub controllers: Vec<ControllerSummary>,
    /// What must be known to read the numbers.
    pub notes: Vec<Note>,
}

/// Which campaign it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Head {
    /// What names the campaign: 64 hexadecimal digits.
    pub campaign: String,
    /// Program and version that flew it.
    pub program: String,
    /// Name of the scenario; `None` where it has none.
    pub scenario: Option<String>,
    /// Text of the scenario.
    pub scenario_text: String,
    /// Digest of the scenario with its changes and everything it refers to.
    pub scenario_digest: String,
    /// Changes `path=value` to the scenario, for all runs.
    pub changes: Vec<String>,
    /// How many runs: those that everything here is counted of.
    pub runs: u64,
    /// How many runs were planned: as many, unless parts are missing.
    pub planned_runs: u64,
    /// From how many shards, where the parts were read and not the merged file.
    pub shards: Option<Shards>,
    /// How many rows: runs times controllers.
    pub rows: u64,
    /// Seed of everything that was drawn.
    pub seed: u64,
    /// How points were chosen.
    pub sampling: Sampling,
    /// Digest of the rows; they were read and have it. `None` where parts were read one by one: each has its own.
    pub digest: Option<Digest>,
    /// Names of the controllers.
    pub controllers: Vec<String>,
    /// What differed from run to run.
    pub parameters: Vec<Parameter>,
    /// Confidence of all intervals but those of rank correlations, which have 95 %.
    pub confidence: f64,
}

/// Shards that were read, of those that were planned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Shards {
    /// How many are there as a whole.
    pub found: u64,
    /// How many were planned.
    pub of: u64,
}

/// Something that differed from run to run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Parameter {
    /// Its name, without `parameter.`.
    pub name: String,
    /// Numbers, whole numbers or texts.
    pub kind: Kind,
    /// Unit; empty where there is none.
    pub unit: String,
    /// What it is and how it was drawn.
    pub meaning: String,
}

/// What one controller did.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ControllerSummary {
    /// Name of the controller.
    pub name: String,
    /// How many flights came to which verdict: those that occurred, from good to bad; their sum is all runs.
    pub verdicts: Vec<VerdictCount>,
    /// Flights that failed for any reason, refused runs among them.
    pub failed: Probability,
    /// Runs whose numbers make no scenario, so that nothing flew; they are among the failed.
    pub refused: Probability,
    /// Flights of a loop of which nobody can tell whether it is stable at rest; they count as failed only for what else
    /// they do.
    pub undecided: u64,
    /// Requirements, in the order of the scenario.
    pub requirements: Vec<RequirementSummary>,
    /// Measures in the order of the columns, then values that requirements judge.
    pub measures: Vec<MeasureSummary>,
    /// The first failed runs, the worst first: at most [`FAILED_RUNS`](super::FAILED_RUNS).
    pub failed_runs: Vec<FailedRun>,
    /// What failing and each measure depend on: failing first, then measures in their order.
    pub sensitivities: Vec<Sensitivity>,
}

/// How many flights came to a verdict.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct VerdictCount {
    /// The verdict in a word: settled, flown, not settled, refused, unstable, hit the ground, diverged.
    pub verdict: String,
    /// How many flights.
    pub flights: u64,
}

/// How probable something is that was seen in some of many runs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Probability {
    /// Runs in which it was seen.
    pub count: u64,
    /// All runs that were asked.
    pub of: u64,
    /// Their quotient; `None` where no run was asked.
    pub estimate: Option<f64>,
    /// Lower end of the two-sided interval of Clopper and Pearson at the confidence of the summary.
    pub lower: f64,
    /// Its upper end.
    pub upper: f64,
    /// One-sided bound at the confidence, where it was never seen: at most this.
    pub at_most: Option<f64>,
    /// One-sided bound at the confidence, where it was always seen: at least this.
    pub at_least: Option<f64>,
}

/// A requirement over all flights of a controller.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RequirementSummary {
    /// Its id.
    pub id: String,
    /// What is measured, in words; empty where the file does not say.
    pub measure: String,
    /// Unit of the value.
    pub unit: String,
    /// What is required, in words: "at most 35 %".
    pub required: String,
    /// The same in numbers.
    #[serde(flatten)]
    pub limits: Limits,
    /// Flights that do not meet it, of those that were judged.
    pub not_met: Probability,
    /// Flights that were judged without a value, because there was nothing to measure; they are among those judged.
    pub without_value: u64,
    /// Runs that were not judged: refused ones, and all where it does not concern this controller.
    pub not_judged: u64,
    /// The value farthest outside the limits, or nearest to them where all are inside, with its run; the first such run.
    pub worst: Option<Extreme>,
}

/// Limits of a requirement in its unit; both `None` where they are no numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Limits {
    /// Least value that is allowed.
    pub least: Option<f64>,
    /// Greatest value that is allowed.
    pub most: Option<f64>,
}

/// A column of numbers over the flights of a controller that have one.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasureSummary {
    /// Name of the column, with its unit: `overshoot_pct`, `requirement.<id>.value`.
    pub name: String,
    /// Unit for people; may be empty.
    pub unit: String,
    /// What it means.
    pub meaning: String,
    /// How many flights have a finite value; everything below is of those.
    pub count: u64,
    /// How many have none: it does not exist for them, as for flights that diverged.
    pub missing: u64,
    /// How many have infinity or NaN.
    pub not_finite: u64,
    /// Mean and spread; `None` without values, and where squares overflow.
    pub moments: Option<Moments>,
    /// One for each of [`QUANTILES`](super::QUANTILES); empty without values.
    pub quantiles: Vec<QuantileSummary>,
    /// How often which values occur; beyond five times the distance of the quartiles from the quartiles, values are
    /// counted as below or above.
    pub histogram: Option<Histogram>,
    /// The lowest values, lowest first; equal ones by run: at most [`EXTREMES`](super::EXTREMES).
    pub lowest: Vec<Extreme>,
    /// The highest values, highest first; equal ones by run.
    pub highest: Vec<Extreme>,
    /// Which side is bad, where that is known.
    pub bad: Option<Bad>,
    /// True for times of what is not to happen (`diverged_at_s`, `left_validity_at_s`): a missing value is good.
    pub is_event: bool,
}

/// A value and the run that it is from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Extreme {
    /// Number of the run.
    pub run: u64,
    /// The value.
    pub value: f64,
}

/// A quantile and how sure it is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct QuantileSummary {
    /// Share of the flights below.
    pub share: f64,
    /// The quantile of the flights that have a value.
    pub value: f64,
    /// Where the quantile of all such flights lies, at the confidence of the summary; an end that is `None` is
    /// beyond what so few flights can bound. Of one or two flights, the interval of an outer quantile may lie
    /// beside the value.
    #[serde(flatten)]
    pub interval: Interval,
    /// How far the value may be off, where it is from a sketch; the interval is widened by that already.
    #[serde(flatten)]
    pub sketch: Option<Sketched>,
}

/// How far a quantile from a sketch may be off: from that of the flights, which is in no doubt but for this.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Sketched {
    /// Most that the share of the flights below the value differs from the share that was asked for; 0 where it is exact.
    pub rank_error: f64,
    /// The quantile of the flights is at least this.
    pub at_least: f64,
    /// It is at most this.
    pub at_most: f64,
}

/// A failed run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FailedRun {
    /// Number of the run.
    pub run: u64,
    /// How bad it is.
    pub severity: Severity,
    /// When the flight diverged, s.
    pub diverged_at_s: Option<f64>,
    /// Why it failed, in words.
    pub reasons: String,
}

/// How a run failed, the worst first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The flight diverged; the earliest first.
    Diverged,
    /// The aircraft hit the ground.
    HitGround,
    /// The external controller gave no answer.
    ControllerLost,
    /// The simulator that flies the aircraft gave no answer.
    PlantLost,
    /// The loop is unstable at rest, which did not show in the flight.
    Unstable,
    /// Its autopilot waited in vain for a mode to begin.
    ModeNeverBegan,
    /// It left the range of its aircraft's data, which its scenario does not allow.
    LeftRange,
    /// Its numbers make no scenario.
    Refused,
    /// Requirements are not met.
    RequirementsNotMet,
    /// Nothing is required, and a step was not settled.
    NotSettled,
}

/// What something depends on.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sensitivity {
    /// What depends.
    #[serde(flatten)]
    pub of: SensitivityTarget,
    /// How many flights had a finite value of it among the runs that were looked at.
    pub used: u64,
    /// How many runs were looked at, the first of the campaign.
    pub runs_used: u64,
    /// How many runs there are.
    pub runs: u64,
    /// What each parameter does, in the order of [`Head::parameters`].
    #[serde(rename = "parameters")]
    pub influences: Vec<Influence>,
}

/// What depends on parameters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SensitivityTarget {
    /// Whether a flight fails: 1 if it does, 0 if not.
    Failure,
    /// The measure with this name.
    Measure(String),
}

/// What a parameter does.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Influence {
    /// Name of the parameter, without `parameter.`.
    pub parameter: String,
    /// Rank correlation with its interval of 95 %; `None` for texts, and where nothing varies.
    #[serde(rename = "rank_correlation")]
    pub correlation: Option<Correlation>,
    /// Share of the variance that the parameter explains alone; `None` where nothing varies, for fewer than 16
    /// flights, and for texts with more different ones than the root of the number of flights.
    #[serde(rename = "variance_share")]
    pub share: Option<Share>,
    /// The chance that a parameter without any influence would have such a share, by ranks; `None` where there is none.
    pub p: Option<f64>,
}

/// A measure and in how many flights something is so of it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct MeasureCount {
    /// Name of the measure.
    pub name: String,
    /// How many flights.
    pub flights: u64,
}

/// What must be known to read the numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Note {
    /// Parts are missing: nothing here is said of the whole campaign.
    Incomplete {
        /// Shards that are there.
        shards: Shards,
        /// Runs that are there.
        runs: u64,
        /// Runs that were planned.
        planned_runs: u64,
    },
    /// Quantiles and histograms are from sketches, because there are more rows than are sorted.
    FromSketches {
        /// How many rows.
        rows: u64,
        /// Most that a quantile is off, as a part of its value.
        relative_width: f64,
    },
    /// Intervals assume independent runs, which these are not: usually the intervals are too wide for means and
    /// probabilities, which is not proven.
    RunsNotIndependent {
        /// How the points were chosen.
        sampling: Sampling,
    },
    /// Nothing is required of a controller: its flights fail where they diverge or do not settle, and
    /// nobody asked whether a self-tuning loop is stable at rest.
    NothingRequired {
        /// Name of the controller.
        controller: String,
    },
    /// On a Sobol' sequence the correction of shares takes off too much where nothing else than parameters differs:
    /// the truth lies between [`Share::fraction`] and [`Share::uncorrected`].
    SharesOvercorrected,
    /// Sensitivities are of the first runs alone.
    FirstRunsOnly {
        /// How many.
        runs_used: u64,
        /// How many there are.
        runs: u64,
    },
    /// Measures that not all flights of a controller have: what is said of them is said of the others.
    Missing {
        /// Name of the controller.
        controller: String,
        /// The measures and how many flights do not have them. Events (`MeasureSummary::is_event`) and
        /// requirements that do not concern the controller are not among them.
        measures: Vec<MeasureCount>,
    },
    /// Measures with values that are no finite numbers, which are left out.
    NotFinite {
        /// Name of the controller.
        controller: String,
        /// The measures and in how many flights.
        measures: Vec<MeasureCount>,
    },
}

//! How a scenario is tuned, and on what tuned controllers are compared.

use crate::count;
use crate::file::overrides;
use crate::keyed::document::Item;
use crate::keyed::word::words;
use crate::keyed::{
    Key, KeyRow, Range, Section, TEXT, Table, defaulted, name_in, number, optional, own, plain,
    required, tables, whole, word,
};
use crate::measure::Measure;
use crate::requirement::keys::{CONDITIONS, LIMITS};

/// Names of the optimisers.
const OPTIMISERS: [&str; 9] =
    ["cma-es", "de", "l-shade", "pso", "ga", "nelder-mead", "bfgs", "sqp", "nsga-ii"];
/// The name of the one that looks for a front.
pub(crate) const FRONT: &str = "nsga-ii";

const MOST_SEED: i64 = i64::MAX;
pub(crate) const RUNS: Key<i64> = defaulted(
    "runs",
    whole(0, 100_000),
    0,
    "Draws of the scenario's dispersions in each case, the same for every candidate; 0 flies the scenario as it is written.",
);
pub(crate) const RUN_SEED: Key<i64> =
    defaulted("run_seed", whole(0, MOST_SEED), 1, "Seed of these draws.");

words! {
    /// How the costs of many flights become one.
    OverWord { Mean = "mean", Worst = "worst", Tail = "tail" }
}

words! {
    /// What is asked of a constant load.
    ConstantLoadWord { Removed = "removed", Ignored = "ignored" }
}

pub(crate) const OPTIMISER: Key<str> = defaulted(
    "optimiser",
    name_in(&OPTIMISERS),
    "cma-es",
    "How it searches; `--optimiser` comes first.",
);
pub(crate) const BUDGET: Key<i64> = defaulted(
    "budget",
    whole(count::BUDGET.least as i64, count::BUDGET.most as i64),
    1000,
    "Candidates that are flown; `--budget` comes first.",
);
pub(crate) const SEED: Key<i64> =
    defaulted("seed", whole(0, MOST_SEED), 1, "Seed of the search; `--seed` comes first.");
pub(crate) const CONTROLLER: Key<str> = optional(
    "controller",
    TEXT,
    "Whose marks are tuned; needed only where several controllers have some.",
);
pub(crate) const OVER: Key<OverWord> = defaulted(
    "over",
    word(),
    OverWord::Mean,
    "What of the costs of all flights counts: their mean, the worst, or the mean of the worst `share`.",
);
pub(crate) const SHARE: Key<f64> = optional(
    "share",
    number("", Range::PositiveUpTo(1.0)),
    "Share of the flights that counts where `over` is \"tail\"; 0.2 if left out.",
);
pub(crate) const CONSTANT_LOAD: Key<ConstantLoadWord> = defaulted(
    "constant_load",
    word(),
    ConstantLoadWord::Removed,
    "Whether a candidate must take off a constant load at the servo with the gains that it has at rest: at most half of its largest effect may be left at the end of the flight, and nothing for good. Asked of controllers with an integral.",
);
pub(crate) const CASE: Key<[Section]> = optional(
    "case",
    tables(&CASE_TABLE, 0, 1000),
    "Changes of the scenario on which candidates fly; the scenario itself if there are none.",
);
pub(crate) const OBJECTIVE: Key<[Section]> = required(
    "objective",
    tables(&OBJECTIVE_TABLE, 1, 20),
    "What is to become small. The scenario's requirements are limits that come before.",
);
pub(crate) const LIMIT: Key<[Section]> = optional(
    "limit",
    tables(&LIMIT_TABLE, 0, 20),
    "Limits of the mean over all flights, such as the effort that everybody may spend; a requirement limits each flight.",
);

/// How a scenario is tuned.
pub(super) static TUNING_TABLE: Table = plain(
    "How `fspid tune` chooses the numbers that are marked `{ tune = [lower, upper] }`.",
    &[
        &[&OPTIMISER, &BUDGET, &SEED, &CONTROLLER, &OVER, &SHARE, &RUNS, &RUN_SEED],
        &[&CONSTANT_LOAD, &CASE, &OBJECTIVE, &LIMIT],
    ],
);

static CASE_TABLE: Table = plain("The scenario with changes.", &[CASE_KEYS]);

pub(crate) const MIRROR_OF: Key<str> = optional(
    "mirror_of",
    TEXT,
    "Name of the case that this one is the mirror image of, such as the step downwards of a step upwards; the answer says how alike both are flown.",
);

static CONTEST_CASE_TABLE: Table = plain("The scenario with changes.", &[CASE_KEYS, &[&MIRROR_OF]]);

pub(crate) const NAME: Key<str> = required("name", TEXT, "What it is called; each only once.");
pub(crate) const GROUP: Key<str> =
    optional("group", TEXT, "What kind of case it is: plants, commands, gusts.");
pub(crate) const SET: Key<Item> = required(
    "set",
    own(overrides::listed_in_words, overrides::listed_schema),
    "The changes, as `--set` takes them.",
);
pub(crate) const CASE_WEIGHT: Key<f64> =
    defaulted("weight", number("", Range::Positive), 1.0, "How much it counts in the mean.");

const CASE_KEYS: &[KeyRow] = &[&NAME, &GROUP, &SET, &CASE_WEIGHT];

pub(crate) const OBJECTIVE_MEASURE: Key<Measure> = required(
    "measure",
    word(),
    "The measure, as in requirements; the worst step, plant or frozen gain counts.",
);
pub(crate) const OBJECTIVE_WEIGHT: Key<f64> = defaulted(
    "weight",
    number("", Range::Finite),
    1.0,
    "Cost of a unit of the measure; negative for one that is to become large.",
);
pub(crate) const REFERENCE: Key<f64> = optional(
    "reference",
    number("", Range::Finite),
    "A bad value, from which the volume of a Pareto front is counted; the worst of the first generation if left out.",
);

static OBJECTIVE_TABLE: Table = plain(
    "A measure that is to become small.",
    &[&[&OBJECTIVE_MEASURE, &OBJECTIVE_WEIGHT, &REFERENCE], CONDITIONS],
);

pub(crate) const LIMIT_MEASURE: Key<Measure> =
    required("measure", word(), "The measure, as in requirements.");

static LIMIT_TABLE: Table = plain(
    "A limit of the mean of a measure over all flights, weighted by case.",
    &[&[&LIMIT_MEASURE], LIMITS, CONDITIONS],
);

pub(crate) const SEEDS: Key<i64> = defaulted(
    "seeds",
    whole(count::SEEDS.least as i64, count::SEEDS.most as i64),
    5,
    "How many times each controller is tuned, with seeds from that of the tuning on.",
);
pub(crate) const AGAINST: Key<str> = optional(
    "against",
    TEXT,
    "The controller that the others are compared with; the first one if left out.",
);
pub(crate) const CONTEST_CASE: Key<[Section]> =
    required("case", tables(&CONTEST_CASE_TABLE, 1, 1000), "What is flown, none of it tuned on.");

/// On what tuned controllers are compared.
pub(super) static CONTEST_TABLE: Table = plain(
    "Where `fspid contest` compares the controllers, each tuned alike before.",
    &[&[&SEEDS, &AGAINST, &RUNS, &RUN_SEED, &CONTEST_CASE]],
);

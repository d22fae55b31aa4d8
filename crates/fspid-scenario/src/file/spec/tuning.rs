//! How a scenario is tuned, and on what tuned controllers are compared.

use super::requirement::{CONDITIONS, LIMITS, MEASURE};
use super::word::{Word, words};
use super::{Default, Key, Kind, Range, Table, defaulted, optional, plain, required};
use crate::file::overrides;

/// Names of the optimisers.
const OPTIMISERS: [&str; 7] = ["cma-es", "de", "l-shade", "pso", "ga", "nelder-mead", "nsga-ii"];
/// The name of the one that looks for a front.
pub(crate) const FRONT: &str = "nsga-ii";

const MOST_SEED: i64 = i64::MAX;
const RUNS: Key = defaulted(
    "runs",
    Kind::Integer { least: 0, most: 100_000 },
    Default::Integer(0),
    "Draws of the scenario's dispersions in each case, the same for every candidate; 0 flies the scenario as it is written.",
);
const RUN_SEED: Key = defaulted(
    "run_seed",
    Kind::Integer { least: 0, most: MOST_SEED },
    Default::Integer(1),
    "Seed of these draws.",
);

words! {
    /// How the costs of many flights become one.
    OverWord { Mean = "mean", Worst = "worst", Tail = "tail" }
}

words! {
    /// What is asked of a constant load.
    ConstantLoadWord { Removed = "removed", Ignored = "ignored" }
}

/// How a scenario is tuned.
pub(super) static TUNING: Table = plain(
    "How `fspid tune` chooses the numbers that are marked `{ tune = [lower, upper] }`.",
    &[&[
        defaulted(
            "optimiser",
            Kind::Word(&OPTIMISERS),
            Default::Word("cma-es"),
            "How it searches; `--optimiser` comes first.",
        ),
        defaulted(
            "budget",
            Kind::Integer { least: 1, most: 100_000_000 },
            Default::Integer(1000),
            "Candidates that are flown; `--budget` comes first.",
        ),
        defaulted(
            "seed",
            Kind::Integer { least: 0, most: MOST_SEED },
            Default::Integer(1),
            "Seed of the search; `--seed` comes first.",
        ),
        optional(
            "controller",
            Kind::Text,
            "Whose marks are tuned; needed only where several controllers have some.",
        ),
        defaulted(
            "over",
            Kind::Word(OverWord::WORDS),
            Default::Word("mean"),
            "What of the costs of all flights counts: their mean, the worst, or the mean of the worst `share`.",
        ),
        optional(
            "share",
            Kind::Number { unit: "", range: Range::PositiveUpTo(1.0) },
            "Share of the flights that counts where `over` is \"tail\"; 0.2 if left out.",
        ),
        RUNS,
        RUN_SEED,
        defaulted(
            "constant_load",
            Kind::Word(ConstantLoadWord::WORDS),
            Default::Word("removed"),
            "Whether a candidate must take off a constant load at the servo with the gains that it has at rest: at most half of its largest effect may be left at the end of the flight, and nothing for good. Asked of controllers with an integral.",
        ),
        optional(
            "case",
            Kind::Tables { table: &CASE, least: 0, most: 1000 },
            "Changes of the scenario on which candidates fly; the scenario itself if there are none.",
        ),
        required(
            "objective",
            Kind::Tables { table: &OBJECTIVE, least: 1, most: 20 },
            "What is to become small. The scenario's requirements are limits that come before.",
        ),
        optional(
            "limit",
            Kind::Tables { table: &LIMIT, least: 0, most: 20 },
            "Limits of the mean over all flights, such as the effort that everybody may spend; a requirement limits each flight.",
        ),
    ]],
);

static CASE: Table = plain("The scenario with changes.", &[CASE_KEYS]);

static CONTEST_CASE: Table = plain(
    "The scenario with changes.",
    &[
        CASE_KEYS,
        &[optional(
            "mirror_of",
            Kind::Text,
            "Name of the case that this one is the mirror image of, such as the step downwards of a step upwards; the answer says how alike both are flown.",
        )],
    ],
);

const CASE_KEYS: &[Key] = &[
    required("name", Kind::Text, "What it is called; each only once."),
    optional("group", Kind::Text, "What kind of case it is: plants, commands, gusts."),
    required(
        "set",
        Kind::Own { allowed: overrides::listed_in_words, schema: overrides::listed_schema },
        "The changes, as `--set` takes them.",
    ),
    defaulted(
        "weight",
        Kind::Number { unit: "", range: Range::Positive },
        Default::Number(1.0),
        "How much it counts in the mean.",
    ),
];

static OBJECTIVE: Table = plain(
    "A measure that is to become small.",
    &[
        &[
            required(
                "measure",
                MEASURE,
                "The measure, as in requirements; the worst step, plant or frozen gain counts.",
            ),
            defaulted(
                "weight",
                Kind::Number { unit: "", range: Range::Finite },
                Default::Number(1.0),
                "Cost of a unit of the measure; negative for one that is to become large.",
            ),
            optional(
                "reference",
                Kind::Number { unit: "", range: Range::Finite },
                "A bad value, from which the volume of a Pareto front is counted; the worst of the first generation if left out.",
            ),
        ],
        CONDITIONS,
    ],
);

static LIMIT: Table = plain(
    "A limit of the mean of a measure over all flights, weighted by case.",
    &[&[required("measure", MEASURE, "The measure, as in requirements.")], LIMITS, CONDITIONS],
);

/// On what tuned controllers are compared.
pub(super) static CONTEST: Table = plain(
    "Where `fspid contest` compares the controllers, each tuned alike before.",
    &[&[
        defaulted(
            "seeds",
            Kind::Integer { least: 1, most: 1000 },
            Default::Integer(5),
            "How many times each controller is tuned, with seeds from that of the tuning on.",
        ),
        optional(
            "against",
            Kind::Text,
            "The controller that the others are compared with; the first one if left out.",
        ),
        RUNS,
        RUN_SEED,
        required(
            "case",
            Kind::Tables { table: &CONTEST_CASE, least: 1, most: 1000 },
            "What is flown, none of it tuned on.",
        ),
    ]],
);

//! What differs from run to run of a campaign.

use crate::keyed::document::Item;
use crate::keyed::word::words;
use crate::keyed::{
    BOOLEAN, Key, KeyName, KindOf, Range, TEXT, Table, defaulted, number, numbers, optional, own,
    plain, required, word,
};

const ANY: KindOf<f64> = number("", Range::Finite);

const fn some(range: Range) -> KindOf<[f64]> {
    numbers("", range, (1, 64))
}

pub(crate) const PATH: Key<str> = optional(
    "path",
    TEXT,
    "The place, as `--set` names it: controller.FSPID.nominal.kp, plant.preset.numerator[0].",
);
pub(crate) const PATHS: Key<Item> = optional(
    "paths",
    own(paths_in_words, paths_schema),
    "Several places in place of `path`: all get the same draw; of correlated numbers each gets its own.",
);
pub(crate) const NAME: Key<str> = optional(
    "name",
    TEXT,
    "What it is called in results; the first path if left out. Not for correlated numbers.",
);
pub(crate) const DISTRIBUTION: Key<DistributionWord> = required(
    "distribution",
    word(),
    "How it is distributed; what else must be given depends on it.",
);
pub(crate) const RELATIVE: Key<bool> = defaulted(
    "relative",
    BOOLEAN,
    false,
    "Draws are factors of the number that stands in the scenario.",
);
pub(crate) const MEAN: Key<f64> = optional("mean", ANY, "normal: the mean, before limits cut it.");
pub(crate) const STANDARD_DEVIATION: Key<f64> = optional(
    "standard_deviation",
    number("", Range::Positive),
    "normal: the standard deviation, before limits cut it.",
);
pub(crate) const LOWER: Key<f64> = optional(
    "lower",
    ANY,
    "uniform and log-uniform: the lower end. normal: nothing below is drawn.",
);
pub(crate) const UPPER: Key<f64> = optional("upper", ANY, "As lower, above.");
pub(crate) const VALUES: Key<Item> = optional(
    "values",
    own(values_in_words, values_schema),
    "choice: numbers, texts or booleans of which one is drawn.",
);
pub(crate) const WEIGHTS: Key<[f64]> = optional(
    "weights",
    some(Range::NotNegative),
    "choice: how often each value is drawn, in proportion; equally often if left out.",
);
pub(crate) const MEANS: Key<[f64]> =
    optional("means", some(Range::Finite), "correlated: the mean of each.");
pub(crate) const STANDARD_DEVIATIONS: Key<[f64]> = optional(
    "standard_deviations",
    some(Range::Positive),
    "correlated: the standard deviation of each.",
);
pub(crate) const CORRELATION: Key<Item> = optional(
    "correlation",
    own(matrix_in_words, matrix_schema),
    "correlated: the matrix of correlation coefficients, row by row.",
);
pub(crate) const LOWERS: Key<[f64]> =
    optional("lowers", some(Range::Finite), "correlated: nothing below is drawn, for each.");
pub(crate) const UPPERS: Key<[f64]> =
    optional("uppers", some(Range::Finite), "correlated: nothing above is drawn, for each.");

/// A dispersion of a scenario.
pub(super) static DISPERSION_TABLE: Table = plain(
    "What differs from run to run of `fspid campaign`: numbers of the scenario that are drawn.",
    &[
        &[&PATH, &PATHS, &NAME, &DISTRIBUTION, &RELATIVE, &MEAN, &STANDARD_DEVIATION],
        &[&LOWER, &UPPER, &VALUES, &WEIGHTS, &MEANS, &STANDARD_DEVIATIONS],
        &[&CORRELATION, &LOWERS, &UPPERS],
    ],
);

words! {
    /// How something is distributed.
    DistributionWord {
        Normal = "normal",
        Uniform = "uniform",
        LogUniform = "log-uniform",
        Choice = "choice",
        Seed = "seed",
        Correlated = "correlated",
    }
}

/// Keys of each distribution: those that must be there, and those that may.
pub(crate) fn keys_of(distribution: DistributionWord) -> [&'static [KeyName]; 2] {
    match distribution {
        DistributionWord::Normal => {
            [&[MEAN.name, STANDARD_DEVIATION.name], &[LOWER.name, UPPER.name]]
        }
        DistributionWord::Uniform | DistributionWord::LogUniform => {
            [&[LOWER.name, UPPER.name], &[]]
        }
        DistributionWord::Choice => [&[VALUES.name], &[WEIGHTS.name]],
        DistributionWord::Seed => [&[], &[]],
        DistributionWord::Correlated => [
            &[PATHS.name, MEANS.name, STANDARD_DEVIATIONS.name, CORRELATION.name],
            &[LOWERS.name, UPPERS.name],
        ],
    }
}

/// All keys that belong to some distributions only.
pub(crate) const OWN_KEYS: [KeyName; 11] = [
    MEAN.name,
    STANDARD_DEVIATION.name,
    LOWER.name,
    UPPER.name,
    VALUES.name,
    WEIGHTS.name,
    MEANS.name,
    STANDARD_DEVIATIONS.name,
    CORRELATION.name,
    LOWERS.name,
    UPPERS.name,
];

pub(crate) fn paths_in_words() -> String {
    "a list of texts, each a path as `--set` names it".to_owned()
}

fn paths_schema() -> serde_json::Value {
    serde_json::json!({ "type": "array", "items": { "type": "string" }, "minItems": 1 })
}

pub(crate) fn values_in_words() -> String {
    "a list of 1 to 1000 numbers, texts or booleans".to_owned()
}

fn values_schema() -> serde_json::Value {
    serde_json::json!({
        "type": "array",
        "items": { "anyOf": [{ "type": "number" }, { "type": "string" }, { "type": "boolean" }] },
        "minItems": 1,
        "maxItems": 1000,
    })
}

pub(crate) fn matrix_in_words() -> String {
    "a list of as many lists of as many numbers as there are paths, such as [[1.0, 0.5], [0.5, 1.0]]"
        .to_owned()
}

fn matrix_schema() -> serde_json::Value {
    // What is in the rows is checked by the reader: square, symmetric, and a correlation.
    serde_json::json!({ "type": "array", "items": { "type": "array" } })
}

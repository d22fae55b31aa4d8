//! What differs from run to run of a campaign.

use super::word::{Word, words};
use super::{Default, Kind, Range, Table, defaulted, optional, plain, required};

const ANY: Kind = Kind::Number { unit: "", range: Range::Finite };

const fn numbers(range: Range) -> Kind {
    Kind::Numbers { unit: "", range, least: 1, most: 64 }
}

/// A dispersion of a scenario.
pub(super) static DISPERSION: Table = plain(
    "What differs from run to run of `fspid campaign`: numbers of the scenario that are drawn.",
    &[&[
        optional(
            "path",
            Kind::Text,
            "The place, as `--set` names it: controller.FSPID.nominal.kp, plant.preset.numerator[0].",
        ),
        optional(
            "paths",
            Kind::Own { allowed: paths_in_words, schema: paths_schema },
            "Several places in place of `path`: all get the same draw; of correlated numbers each gets its own.",
        ),
        optional(
            "name",
            Kind::Text,
            "What it is called in results; the first path if left out. Not for correlated numbers.",
        ),
        required(
            "distribution",
            Kind::Word(DistributionWord::WORDS),
            "How it is distributed; what else must be given depends on it.",
        ),
        defaulted(
            "relative",
            Kind::Boolean,
            Default::Boolean(false),
            "Draws are factors of the number that stands in the scenario.",
        ),
        optional("mean", ANY, "normal: the mean, before limits cut it."),
        optional(
            "standard_deviation",
            Kind::Number { unit: "", range: Range::Positive },
            "normal: the standard deviation, before limits cut it.",
        ),
        optional(
            "lower",
            ANY,
            "uniform and log-uniform: the lower end. normal: nothing below is drawn.",
        ),
        optional("upper", ANY, "As lower, above."),
        optional(
            "values",
            Kind::Own { allowed: values_in_words, schema: values_schema },
            "choice: numbers, texts or booleans of which one is drawn.",
        ),
        optional(
            "weights",
            numbers(Range::NotNegative),
            "choice: how often each value is drawn, in proportion; equally often if left out.",
        ),
        optional("means", numbers(Range::Finite), "correlated: the mean of each."),
        optional(
            "standard_deviations",
            numbers(Range::Positive),
            "correlated: the standard deviation of each.",
        ),
        optional(
            "correlation",
            Kind::Own { allowed: matrix_in_words, schema: matrix_schema },
            "correlated: the matrix of correlation coefficients, row by row.",
        ),
        optional("lowers", numbers(Range::Finite), "correlated: nothing below is drawn, for each."),
        optional("uppers", numbers(Range::Finite), "correlated: nothing above is drawn, for each."),
    ]],
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
pub(crate) fn keys_of(distribution: DistributionWord) -> [&'static [&'static str]; 2] {
    match distribution {
        DistributionWord::Normal => [&["mean", "standard_deviation"], &["lower", "upper"]],
        DistributionWord::Uniform | DistributionWord::LogUniform => [&["lower", "upper"], &[]],
        DistributionWord::Choice => [&["values"], &["weights"]],
        DistributionWord::Seed => [&[], &[]],
        DistributionWord::Correlated => {
            [&["paths", "means", "standard_deviations", "correlation"], &["lowers", "uppers"]]
        }
    }
}

/// All keys that belong to some distributions only.
pub(crate) const OWN_KEYS: [&str; 11] = [
    "mean",
    "standard_deviation",
    "lower",
    "upper",
    "values",
    "weights",
    "means",
    "standard_deviations",
    "correlation",
    "lowers",
    "uppers",
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

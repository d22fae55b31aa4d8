//! Defuzzifiers.

use fspid_fuzzy::system::{Defuzzifier, Sampling, SetReading};

/// A defuzzifier, its fuzzylite class, and its words in FCL; the first is the one that is written.
pub(crate) struct MethodWords {
    pub(crate) class: &'static str,
    pub(crate) words: &'static [&'static str],
    /// The method with exact integrals.
    pub(crate) method: Defuzzifier,
}

const fn row(
    class: &'static str,
    words: &'static [&'static str],
    method: Defuzzifier,
) -> MethodWords {
    MethodWords { class, words, method }
}

const EXACT: Sampling = Sampling::Exact;

/// Every defuzzifier.
pub(crate) const METHODS: &[MethodWords] = &[
    row("Centroid", &["COG", "COGF"], Defuzzifier::Centroid(EXACT)),
    row("Bisector", &["COA"], Defuzzifier::Bisector(EXACT)),
    row("SmallestOfMaximum", &["LM", "SOM"], Defuzzifier::SmallestOfMaximum(EXACT)),
    row("MeanOfMaximum", &["MM", "MOM"], Defuzzifier::MeanOfMaximum(EXACT)),
    row("LargestOfMaximum", &["RM", "LOM"], Defuzzifier::LargestOfMaximum(EXACT)),
    row("WeightedAverage", &["COGS"], Defuzzifier::WeightedAverage(SetReading::Tsukamoto)),
    row("WeightedSum", &["COGSS"], Defuzzifier::WeightedSum(SetReading::Tsukamoto)),
];

/// Methods of the standard, by their words.
pub(crate) const STANDARD: [&str; 5] = ["COG", "COGS", "COA", "LM", "RM"];

/// The row of a fuzzylite class, in any case.
pub(crate) fn of_class(class: &str) -> Option<&'static MethodWords> {
    METHODS.iter().find(|row| row.class.eq_ignore_ascii_case(class))
}

/// The row of a word of FCL or a fuzzylite class, in any case.
pub(crate) fn of_word(word: &str) -> Option<&'static MethodWords> {
    let named = |row: &&MethodWords| row.words.iter().any(|known| known.eq_ignore_ascii_case(word));
    METHODS.iter().find(named).or_else(|| of_class(word))
}

/// The row of a method.
pub(crate) fn row_of(method: Defuzzifier) -> Option<&'static MethodWords> {
    METHODS.iter().find(|row| row.method.name() == method.name())
}

impl MethodWords {
    /// The word that is written in FCL.
    pub(crate) fn word(&self) -> &'static str {
        self.words.first().copied().unwrap_or(self.class)
    }
}

/// Words for a message.
pub(crate) fn words() -> impl Iterator<Item = &'static str> + Clone {
    METHODS.iter().map(MethodWords::word)
}

/// Classes for a message.
pub(crate) fn classes() -> impl Iterator<Item = &'static str> + Clone {
    METHODS.iter().map(|row| row.class)
}

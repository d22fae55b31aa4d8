//! The FuzzyLite Language, `.fll`.
//!
//! | fuzzylite | here |
//! | --- | --- |
//! | resolution of a defuzzifier, 1000 if not given | [`Sampling::Midpoint`](fspid_fuzzy::system::Sampling::Midpoint) of as many cells |
//! | `WeightedAverage TakagiSugeno` over fuzzy sets | [`SetReading::InverseTsukamoto`](fspid_fuzzy::system::SetReading::InverseTsukamoto) |
//! | `Automatic` | Tsukamoto if every set rises or falls throughout, else as above |
//! | `lock-range` | an input is moved into its range, an output's answer too |
//! | `lock-previous`, `default` | first and second choice where no rule fires |
//! | a range without ends | no universe |
//! | a hedge in a conclusion | one of the conclusions behind it in the rule too |
//!
//! # Source
//! The language as documented by fuzzylite; numbers and names only, no program text.

mod activation;
mod lines;
mod output;
mod read;
mod sections;
mod term;
mod write;

pub(crate) use output::is_monotone;
pub use read::read;
pub use write::write;

/// Cells of an integral if a file does not say.
const RESOLUTION: u32 = 1000;

/// A name that rules can use.
fn readable(name: &str) -> bool {
    let fits = |c: char| !c.is_whitespace() && !c.is_control() && !"(),#".contains(c);
    let reserved = crate::rule::RESERVED.iter().any(|word| word.eq_ignore_ascii_case(name));
    !name.is_empty() && name.chars().all(fits) && !reserved
}

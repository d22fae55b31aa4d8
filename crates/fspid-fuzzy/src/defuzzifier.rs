//! How a fuzzy output becomes a number, by name.

use core::fmt;
use core::str::FromStr;

use crate::error::FuzzyError;

/// Most samples a sampled centroid may take; more only costs time.
pub const MAX_SAMPLES: u32 = 1_000_000;

/// How an integral over an output's universe is computed: the centre of gravity, or what other tools
/// compute in its place.
///
/// Only [`Exact`](Self::Exact) is the integral: in closed form where all sets are piecewise linear,
/// else with a certified error bound. On the paper's rule base the others differ from it by up to
/// 1.7 % of the half range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Defuzzifier {
    /// The integral itself, without samples.
    #[default]
    Exact,
    /// Sum over N equally spaced samples, both ends included and fully counted (MATLAB: 101).
    Endpoints(u32),
    /// Sum over the midpoints of N equal cells (fuzzylite: 100 or 1000).
    Midpoint(u32),
    /// Trapezoidal rule over N equally spaced samples, both ends included.
    Trapezoid(u32),
    /// Sum over the left ends of N equal cells (jFuzzyLogic: 1000).
    LeftEnd(u32),
    /// Trapezoidal rule over N equally spaced samples and the points where each set is cut, but
    /// not those where two sets cross (scikit-fuzzy).
    Vertices(u32),
}

/// The equally spaced samples that a rule takes of a universe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SampleGrid {
    /// How many.
    pub(crate) count: u32,
    /// Cells between the ends of the universe.
    pub(crate) cells: u32,
    /// Where in its cell a sample lies.
    pub(crate) offset: f64,
    /// How much a sample at either end counts.
    pub(crate) end_weight: f64,
}

#[cfg(feature = "alloc")]
impl SampleGrid {
    /// Place and weight of a sample of the universe from `lower` to `upper`.
    pub(crate) fn at(&self, n: u32, [lower, upper]: [f64; 2]) -> (f64, f64) {
        let is_end = n == 0 || n == self.count - 1;
        let cell = (upper - lower) / f64::from(self.cells);
        let x = lower + (f64::from(n) + self.offset) * cell;
        (x, if is_end { self.end_weight } else { 1.0 })
    }
}

impl Defuzzifier {
    /// The samples of the rule; nothing where it takes none. Those of [`Vertices`](Self::Vertices)
    /// are its equally spaced ones.
    pub(crate) fn samples(self) -> Option<SampleGrid> {
        let grid = |count, cells, offset, end_weight| {
            Some(SampleGrid { count, cells, offset, end_weight })
        };
        match self {
            Self::Exact => None,
            Self::Endpoints(n) | Self::Vertices(n) => grid(n, n - 1, 0.0, 1.0),
            Self::Trapezoid(n) => grid(n, n - 1, 0.0, 0.5),
            Self::Midpoint(n) => grid(n, n, 0.5, 1.0),
            Self::LeftEnd(n) => grid(n, n, 0.0, 1.0),
        }
    }

    /// What can be written for a defuzzifier.
    pub const NAMES: &'static str =
        "exact, endpoints:N, midpoint:N, trapezoid:N, left-end:N, vertices:N";

    /// The rule itself if its number of samples is usable.
    ///
    /// # Errors
    /// [`FuzzyError::SampleCount`] below 2 (below 1 for midpoints and left ends) or above [`MAX_SAMPLES`].
    pub fn checked(self) -> Result<Self, FuzzyError> {
        let (found, least) = match self {
            Self::Exact => return Ok(self),
            Self::Endpoints(n) | Self::Trapezoid(n) | Self::Vertices(n) => (n, 2),
            Self::Midpoint(n) | Self::LeftEnd(n) => (n, 1),
        };
        if (least..=MAX_SAMPLES).contains(&found) {
            Ok(self)
        } else {
            Err(FuzzyError::SampleCount { found, least, most: MAX_SAMPLES })
        }
    }
}

impl fmt::Display for Defuzzifier {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exact => f.write_str("exact"),
            Self::Endpoints(n) => write!(f, "endpoints:{n}"),
            Self::Midpoint(n) => write!(f, "midpoint:{n}"),
            Self::Trapezoid(n) => write!(f, "trapezoid:{n}"),
            Self::LeftEnd(n) => write!(f, "left-end:{n}"),
            Self::Vertices(n) => write!(f, "vertices:{n}"),
        }
    }
}

impl FromStr for Defuzzifier {
    type Err = FuzzyError;

    fn from_str(text: &str) -> Result<Self, FuzzyError> {
        if text == "exact" {
            return Ok(Self::Exact);
        }
        let (kind, samples) = text.split_once(':').ok_or(FuzzyError::UnknownDefuzzifier)?;
        let samples: u32 = samples.parse().map_err(|_| FuzzyError::UnknownDefuzzifier)?;
        match kind {
            "endpoints" => Self::Endpoints(samples),
            "midpoint" => Self::Midpoint(samples),
            "trapezoid" => Self::Trapezoid(samples),
            "left-end" => Self::LeftEnd(samples),
            "vertices" => Self::Vertices(samples),
            _ => return Err(FuzzyError::UnknownDefuzzifier),
        }
        .checked()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::string::ToString;

    #[test]
    fn every_name_reads_back_as_written() {
        for name in
            ["exact", "endpoints:101", "midpoint:1000", "trapezoid:2", "left-end:1", "vertices:26"]
        {
            let parsed: Result<Defuzzifier, _> = name.parse();
            assert_eq!(parsed.map(|d| d.to_string()), Ok(name.to_string()));
        }
    }

    #[test]
    fn a_sampled_rule_without_a_usable_number_of_samples_is_refused() {
        for name in
            ["endpoints:1", "midpoint:0", "trapezoid:4000000000", "endpoints", "midpoint:-5", "cog"]
        {
            assert!(name.parse::<Defuzzifier>().is_err(), "{name}");
        }
    }
}

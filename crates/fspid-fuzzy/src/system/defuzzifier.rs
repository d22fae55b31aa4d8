//! How the joined conclusions of a general system become a number, by name.

use core::fmt;
use core::str::FromStr;

use crate::defuzzifier::{self, MAX_SAMPLES};
use crate::error::FuzzyError;

/// How an integral over an output's universe is computed.
///
/// Only [`Exact`](Self::Exact) is the integral: in closed form where all sets are piecewise linear,
/// else with a certified error bound. The others are what tools compute in its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Sampling {
    /// The integral itself.
    #[default]
    Exact,
    /// Sum over N equally spaced samples, both ends included and fully counted (MATLAB: 101).
    Endpoints(u32),
    /// Sum over the midpoints of N equal cells (fuzzylite: 1000, formerly 100).
    Midpoint(u32),
    /// Trapezoidal rule over N equally spaced samples, both ends included.
    Trapezoid(u32),
    /// Sum over the left ends of N equal cells (jFuzzyLogic: 1000).
    LeftEnd(u32),
    /// Trapezoidal rule over N equally spaced samples and the points where each set is cut, but not
    /// those where two sets cross (scikit-fuzzy).
    Vertices(u32),
}

impl Sampling {
    /// The names, as written in files and options.
    pub const NAMES: &'static str =
        "exact, endpoints:N, midpoint:N, trapezoid:N, left-end:N, vertices:N";

    /// The number of samples and the fewest allowed.
    fn samples(self) -> Option<(u32, u32)> {
        match self {
            Self::Exact => None,
            Self::Midpoint(n) | Self::LeftEnd(n) => Some((n, 1)),
            Self::Endpoints(n) | Self::Trapezoid(n) | Self::Vertices(n) => Some((n, 2)),
        }
    }

    /// The same if its number of samples is allowed.
    ///
    /// # Errors
    /// [`FuzzyError::SampleCount`].
    pub fn checked(self) -> Result<Self, FuzzyError> {
        match self.samples() {
            Some((found, least)) if !(least..=MAX_SAMPLES).contains(&found) => {
                Err(FuzzyError::SampleCount { found, least, most: MAX_SAMPLES })
            }
            _ => Ok(self),
        }
    }

    /// The rule of the fixed-size supervisor that computes the same.
    #[must_use]
    pub fn fixed_size(self) -> defuzzifier::Defuzzifier {
        match self {
            Self::Exact => defuzzifier::Defuzzifier::Exact,
            Self::Endpoints(n) => defuzzifier::Defuzzifier::Endpoints(n),
            Self::Midpoint(n) => defuzzifier::Defuzzifier::Midpoint(n),
            Self::Trapezoid(n) => defuzzifier::Defuzzifier::Trapezoid(n),
            Self::LeftEnd(n) => defuzzifier::Defuzzifier::LeftEnd(n),
            Self::Vertices(n) => defuzzifier::Defuzzifier::Vertices(n),
        }
    }
}

impl fmt::Display for Sampling {
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

impl FromStr for Sampling {
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

/// How the joined conclusions of an output become a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Defuzzifier {
    /// Centre of gravity.
    Centroid(Sampling),
    /// The point that halves the area; of [`Endpoints`](Sampling::Endpoints) the first sample at
    /// which the sum of grades reaches half.
    Bisector(Sampling),
    /// The smallest of the points of highest grade; of [`Endpoints`](Sampling::Endpoints) the one
    /// nearest to 0 (MATLAB).
    SmallestOfMaximum(Sampling),
    /// The mean of the points of highest grade: by length, or by number where there are only single
    /// points; of samples their mean.
    MeanOfMaximum(Sampling),
    /// The largest of the points of highest grade; of [`Endpoints`](Sampling::Endpoints) the one
    /// farthest from 0 (MATLAB).
    LargestOfMaximum(Sampling),
    /// $\sum w_i z_i / \sum w_i$ over the conclusions $z_i$ of the rules (Takagi–Sugeno, Tsukamoto).
    WeightedAverage(SetReading),
    /// $\sum w_i z_i$.
    WeightedSum(SetReading),
}

/// Which number a weighted defuzzifier takes for a fuzzy set; numbers and formulas stand for
/// themselves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum SetReading {
    /// The $x$ at which the monotone set has the rule's strength as its grade.
    #[default]
    Tsukamoto,
    /// The grade of the set at the rule's strength.
    InverseTsukamoto,
}

impl Default for Defuzzifier {
    fn default() -> Self {
        Self::Centroid(Sampling::Exact)
    }
}

impl Defuzzifier {
    /// The names, as written in files and options; a rule of [`Sampling`] may follow the first five
    /// after a blank.
    pub const NAMES: [&'static str; 7] = [
        "centroid",
        "bisector",
        "smallest-of-maximum",
        "mean-of-maximum",
        "largest-of-maximum",
        "weighted-average",
        "weighted-sum",
    ];

    /// How integrals are computed; `None` where nothing is integrated.
    #[must_use]
    pub fn sampling(self) -> Option<Sampling> {
        match self {
            Self::Centroid(s)
            | Self::Bisector(s)
            | Self::SmallestOfMaximum(s)
            | Self::MeanOfMaximum(s)
            | Self::LargestOfMaximum(s) => Some(s),
            Self::WeightedAverage(_) | Self::WeightedSum(_) => None,
        }
    }

    /// The same method with another way to compute integrals; methods without integrals stay.
    #[must_use]
    pub fn with_sampling(self, sampling: Sampling) -> Self {
        match self {
            Self::Centroid(_) => Self::Centroid(sampling),
            Self::Bisector(_) => Self::Bisector(sampling),
            Self::SmallestOfMaximum(_) => Self::SmallestOfMaximum(sampling),
            Self::MeanOfMaximum(_) => Self::MeanOfMaximum(sampling),
            Self::LargestOfMaximum(_) => Self::LargestOfMaximum(sampling),
            Self::WeightedAverage(_) | Self::WeightedSum(_) => self,
        }
    }

    /// Name without the way to compute integrals.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Centroid(_) => "centroid",
            Self::Bisector(_) => "bisector",
            Self::SmallestOfMaximum(_) => "smallest-of-maximum",
            Self::MeanOfMaximum(_) => "mean-of-maximum",
            Self::LargestOfMaximum(_) => "largest-of-maximum",
            Self::WeightedAverage(_) => "weighted-average",
            Self::WeightedSum(_) => "weighted-sum",
        }
    }

    /// The method of that name, with exact integrals.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let exact = Sampling::Exact;
        let all = [
            Self::Centroid(exact),
            Self::Bisector(exact),
            Self::SmallestOfMaximum(exact),
            Self::MeanOfMaximum(exact),
            Self::LargestOfMaximum(exact),
            Self::WeightedAverage(SetReading::Tsukamoto),
            Self::WeightedSum(SetReading::Tsukamoto),
        ];
        all.into_iter().find(|method| method.name() == name)
    }
}

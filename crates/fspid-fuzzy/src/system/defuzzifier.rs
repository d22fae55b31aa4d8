//! How the joined conclusions of a general system become a number, by name.

/// How an integral over an output's universe is computed: the rules of the fixed-size supervisor,
/// for every method that integrates.
pub use crate::defuzzifier::Defuzzifier as Sampling;

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

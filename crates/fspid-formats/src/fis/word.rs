//! The words of the format: one row each.

use fspid_fuzzy::system::{Defuzzifier, Sampling, SetReading};
use fspid_fuzzy::{SNormKind, TNormKind};

use crate::cursor::Cursor;
use crate::report::{one_of, wrong};
use fspid_diagnostics::Problem;

/// A word and what it stands for.
#[derive(Debug)]
pub(super) struct Word<T: 'static> {
    /// As files write it; capitals do not matter.
    pub(super) name: &'static str,
    /// What it means.
    pub(super) means: T,
    /// Whether MATLAB itself knows it.
    pub(super) matlab: bool,
}

const fn matlab<T>(name: &'static str, means: T) -> Word<T> {
    Word { name, means, matlab: true }
}

const fn foreign<T>(name: &'static str, means: T) -> Word<T> {
    Word { name, means, matlab: false }
}

/// `AndMethod` and `ImpMethod`.
pub(super) const T_NORMS: &[Word<TNormKind>] = &[
    matlab("min", TNormKind::Minimum),
    matlab("prod", TNormKind::AlgebraicProduct),
    foreign("algebraic_product", TNormKind::AlgebraicProduct),
    foreign("bounded_difference", TNormKind::BoundedDifference),
    foreign("drastic_product", TNormKind::DrasticProduct),
    foreign("einstein_product", TNormKind::EinsteinProduct),
    foreign("hamacher_product", TNormKind::HamacherProduct),
    foreign("nilpotent_minimum", TNormKind::NilpotentMinimum),
];

/// `OrMethod` and `AggMethod`.
pub(super) const S_NORMS: &[Word<SNormKind>] = &[
    matlab("max", SNormKind::Maximum),
    matlab("probor", SNormKind::AlgebraicSum),
    matlab("sum", SNormKind::UnboundedSum),
    foreign("algebraic_sum", SNormKind::AlgebraicSum),
    foreign("bounded_sum", SNormKind::BoundedSum),
    foreign("drastic_sum", SNormKind::DrasticSum),
    foreign("einstein_sum", SNormKind::EinsteinSum),
    foreign("hamacher_sum", SNormKind::HamacherSum),
    foreign("nilpotent_maximum", SNormKind::NilpotentMaximum),
    foreign("normalized_sum", SNormKind::NormalizedSum),
];

/// How MATLAB integrates.
pub(super) const MATLAB: Sampling = Sampling::Endpoints(101);

/// `DefuzzMethod`.
pub(super) const DEFUZZIFIERS: &[Word<Defuzzifier>] = &[
    matlab("centroid", Defuzzifier::Centroid(MATLAB)),
    matlab("bisector", Defuzzifier::Bisector(MATLAB)),
    matlab("mom", Defuzzifier::MeanOfMaximum(MATLAB)),
    matlab("lom", Defuzzifier::LargestOfMaximum(MATLAB)),
    matlab("som", Defuzzifier::SmallestOfMaximum(MATLAB)),
    matlab("wtaver", Defuzzifier::WeightedAverage(SetReading::Tsukamoto)),
    matlab("wtsum", Defuzzifier::WeightedSum(SetReading::Tsukamoto)),
    foreign("centroid_integral", Defuzzifier::Centroid(Sampling::Trapezoid(101))),
];

/// What `Type` says about the conclusions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Engine {
    /// Fuzzy sets, joined and integrated.
    Mamdani,
    /// Numbers and linear functions, weighted.
    Sugeno,
    /// Either, by the defuzzifier (fuzzylite's finer words).
    Open,
}

/// `Type`.
pub(super) const ENGINES: &[Word<Engine>] = &[
    matlab("mamdani", Engine::Mamdani),
    matlab("sugeno", Engine::Sugeno),
    foreign("larsen", Engine::Mamdani),
    foreign("takagi-sugeno", Engine::Sugeno),
    foreign("takagisugeno", Engine::Sugeno),
    foreign("tsukamoto", Engine::Open),
    foreign("hybrid", Engine::Open),
    foreign("unknown", Engine::Open),
];

/// `TypeRedMethod` of the type-2 toolbox: iterations that all end at the same two points.
pub(super) const REDUCERS: &[Word<()>] = &[
    foreign("Karnik-Mendel", ()),
    foreign("KM", ()),
    foreign("EKM", ()),
    foreign("IASC", ()),
    foreign("EIASC", ()),
    foreign("EODS", ()),
];

/// The meaning of a word in one of the tables.
pub(super) fn find<T>(table: &'static [Word<T>], name: &str) -> Option<&'static Word<T>> {
    table.iter().find(|word| word.name.eq_ignore_ascii_case(name))
}

/// The word that MATLAB has for a meaning.
pub(super) fn matlab_word<T: PartialEq>(table: &[Word<T>], means: &T) -> Option<&'static str> {
    table.iter().find(|word| word.matlab && word.means == *means).map(|word| word.name)
}

/// The meaning of a word, or the words that are known.
pub(super) fn look_up<T>(
    table: &'static [Word<T>],
    at: Cursor,
    name: &str,
    message: &str,
) -> Result<&'static Word<T>, Problem> {
    let known = table.iter().map(|word| word.name);
    find(table, name).ok_or_else(|| wrong(at.place(), name, message, one_of(known, name)))
}

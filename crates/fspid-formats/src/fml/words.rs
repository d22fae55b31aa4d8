//! The words of the language: one row each.

use fspid_fuzzy::system::{Defuzzifier, Sampling};
use fspid_fuzzy::{Hedge, SNormKind, TNormKind};

/// `andMethod` and `activationMethod`.
pub(super) const T_NORMS: &[(&str, TNormKind)] = &[
    ("MIN", TNormKind::Minimum),
    ("PROD", TNormKind::AlgebraicProduct),
    ("BDIF", TNormKind::BoundedDifference),
    ("DRP", TNormKind::DrasticProduct),
    ("EPROD", TNormKind::EinsteinProduct),
    ("HPROD", TNormKind::HamacherProduct),
    ("NILMIN", TNormKind::NilpotentMinimum),
];

/// `orMethod` and `accumulation`.
pub(super) const S_NORMS: &[(&str, SNormKind)] = &[
    ("MAX", SNormKind::Maximum),
    ("PROBOR", SNormKind::AlgebraicSum),
    ("BSUM", SNormKind::BoundedSum),
    ("DRS", SNormKind::DrasticSum),
    ("ESUM", SNormKind::EinsteinSum),
    ("HSUM", SNormKind::HamacherSum),
    ("NILMAX", SNormKind::NilpotentMaximum),
];

const EXACT: Sampling = Sampling::Exact;

/// `defuzzifier`.
pub(super) const DEFUZZIFIERS: &[(&str, Defuzzifier)] = &[
    ("COG", Defuzzifier::Centroid(EXACT)),
    ("COA", Defuzzifier::Bisector(EXACT)),
    ("MOM", Defuzzifier::MeanOfMaximum(EXACT)),
    ("LM", Defuzzifier::SmallestOfMaximum(EXACT)),
    ("RM", Defuzzifier::LargestOfMaximum(EXACT)),
];

/// `modifier`, and whether tools agree about it.
pub(super) const MODIFIERS: &[(&str, (Hedge, bool))] = &[
    ("not", (Hedge::Not, true)),
    ("very", (Hedge::Very, true)),
    ("any", (Hedge::Any, true)),
    ("somewhat", (Hedge::Somewhat, false)),
    ("seldom", (Hedge::Seldom, false)),
    ("intensify", (Hedge::Extremely, false)),
    ("extremely", (Hedge::Power(3.0), false)),
    ("plus", (Hedge::Power(1.25), false)),
    ("more_or_less", (Hedge::Power(0.5), false)),
];

/// Modifiers of a whole set, which no grade alone has.
pub(super) const OF_SETS: [&str; 5] = ["above", "below", "norm", "slightly", "minus"];

/// What a disputed modifier is read as.
pub(super) fn meaning(hedge: Hedge) -> &'static str {
    match hedge {
        Hedge::Somewhat => "the square root of the grade",
        Hedge::Seldom => "the inverse of `intensify`",
        Hedge::Extremely => "2a² up to a half, then 1 - 2(1 - a)²",
        Hedge::Power(power) if power > 2.0 => "the third power of the grade",
        Hedge::Power(power) if power > 1.0 => "the grade to the power 1.25",
        Hedge::Power(_) => "the square root of the grade",
        Hedge::Not => "one minus the grade",
        Hedge::Very => "the square of the grade",
        Hedge::Any => "1",
    }
}

/// The word for a meaning.
pub(super) fn word_of<T: PartialEq>(
    table: &[(&'static str, T)],
    means: &T,
) -> Option<&'static str> {
    table.iter().find(|row| row.1 == *means).map(|row| row.0)
}

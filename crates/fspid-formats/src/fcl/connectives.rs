//! The norms that jFuzzyLogic knows.

use fspid_fuzzy::system::{Antecedent, Rule, SNorm, TNorm};
use fspid_fuzzy::{SNormKind, TNormKind};

/// Which of `AND` and `OR` a statement names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Connective {
    And,
    Or,
}

/// *And* with its *or*, and the words for them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Pair {
    pub(super) and: TNormKind,
    pub(super) or: SNormKind,
    pub(super) and_word: &'static str,
    pub(super) or_word: &'static str,
}

const fn pair(
    and: TNormKind,
    or: SNormKind,
    and_word: &'static str,
    or_word: &'static str,
) -> Pair {
    Pair { and, or, and_word, or_word }
}

/// A rule block of jFuzzyLogic has one of these pairs: the last statement of `AND` and `OR` sets both.
///
/// # Source
/// Asked of jFuzzyLogic 3.3 itself: the strength of a rule at grades of 0.3 and 0.6 by each word for *and* and for *or*.
/// Its Hamacher product stands beside the Einstein sum, which are no pair by De Morgan.
const PAIRS: [Pair; 6] = [
    pair(TNormKind::Minimum, SNormKind::Maximum, "MIN", "MAX"),
    pair(TNormKind::AlgebraicProduct, SNormKind::AlgebraicSum, "PROD", "ASUM"),
    pair(TNormKind::BoundedDifference, SNormKind::BoundedSum, "BDIF", "BSUM"),
    pair(TNormKind::HamacherProduct, SNormKind::EinsteinSum, "HAMACHER", "EINSTEIN"),
    pair(TNormKind::NilpotentMinimum, SNormKind::NilpotentMaximum, "NIPMIN", "NIPMAX"),
    pair(TNormKind::DrasticProduct, SNormKind::DrasticSum, "DMIN", "DMAX"),
];

impl Default for Pair {
    /// That of a block without `AND` and `OR`.
    fn default() -> Self {
        let [usual, ..] = PAIRS;
        usual
    }
}

/// Words for accumulations; jFuzzyLogic refuses others.
///
/// # Source
/// Asked of jFuzzyLogic 3.3 itself: what conclusions at 0.3 and 0.6 count as, and at 0.9 and 0.9.
const ACCUMULATIONS: [(SNormKind, &str); 5] = [
    (SNormKind::Maximum, "MAX"),
    (SNormKind::BoundedSum, "BSUM"),
    (SNormKind::NormalizedSum, "NSUM"),
    (SNormKind::AlgebraicSum, "PROBOR"),
    (SNormKind::UnboundedSum, "SUM"),
];

/// The word for an accumulation.
pub(super) fn accumulation_word(norm: &SNorm) -> Option<&'static str> {
    ACCUMULATIONS.into_iter().find(|(kind, _)| norm.is(*kind)).map(|(_, word)| word)
}

/// The pair of an *and*.
pub(super) fn pair_of_and(and: &TNorm) -> Option<Pair> {
    PAIRS.into_iter().find(|pair| and.is(pair.and))
}

/// The pair of an *or*.
pub(super) fn pair_of_or(or: &SNorm) -> Option<Pair> {
    PAIRS.into_iter().find(|pair| or.is(pair.or))
}

/// The words of all pairs, for a message.
pub(super) fn words() -> String {
    let pairs = PAIRS.map(|pair| format!("{} with {}", pair.and_word, pair.or_word));
    format!("one of {}", pairs.join(", "))
}

/// Which connectives the conditions of rules need.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Uses {
    pub(super) and: bool,
    pub(super) or: bool,
}

impl Uses {
    pub(super) fn of(rules: &[Rule]) -> Self {
        let mut uses = Self::default();
        rules.iter().for_each(|rule| uses.add(&rule.antecedent));
        uses
    }

    fn add(&mut self, condition: &Antecedent) {
        match condition {
            Antecedent::Always | Antecedent::Is(_) => {}
            Antecedent::Not(part) => self.add(part),
            Antecedent::All(parts) => {
                self.and |= parts.len() > 1;
                parts.iter().for_each(|part| self.add(part));
            }
            Antecedent::Any(parts) => {
                self.or |= parts.len() > 1;
                parts.iter().for_each(|part| self.add(part));
            }
        }
    }
}

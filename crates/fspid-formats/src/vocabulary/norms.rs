//! Norms.

use fspid_fuzzy::{SNormKind, TNormKind};

/// A norm, its fuzzylite class, and its words in FCL; the first is the one that is written.
pub(crate) struct NormWords<K: 'static> {
    pub(crate) kind: K,
    pub(crate) class: &'static str,
    words: &'static [&'static str],
}

const fn row<K>(kind: K, class: &'static str, words: &'static [&'static str]) -> NormWords<K> {
    NormWords { kind, class, words }
}

/// *And* and implications (`AND`, `ACT`; `conjunction`, `implication`).
pub(crate) const T_NORMS: &[NormWords<TNormKind>] = &[
    row(TNormKind::Minimum, "Minimum", &["MIN"]),
    row(TNormKind::AlgebraicProduct, "AlgebraicProduct", &["PROD"]),
    row(TNormKind::BoundedDifference, "BoundedDifference", &["BDIF"]),
    row(TNormKind::DrasticProduct, "DrasticProduct", &["DPROD", "DMIN", "DRASTIC"]),
    row(TNormKind::EinsteinProduct, "EinsteinProduct", &["EPROD", "EINSTEIN"]),
    row(TNormKind::HamacherProduct, "HamacherProduct", &["HPROD", "HAMACHER"]),
    row(TNormKind::NilpotentMinimum, "NilpotentMinimum", &["NMIN", "NILMIN", "NIPMIN"]),
];

/// *Or* (`OR`; `disjunction`) and aggregations (`ACCU`; `aggregation`).
pub(crate) const S_NORMS: &[NormWords<SNormKind>] = &[
    row(SNormKind::Maximum, "Maximum", &["MAX"]),
    row(SNormKind::AlgebraicSum, "AlgebraicSum", &["ASUM", "PROBOR"]),
    row(SNormKind::BoundedSum, "BoundedSum", &["BSUM"]),
    row(SNormKind::DrasticSum, "DrasticSum", &["DSUM", "DMAX", "DRASTIC"]),
    row(SNormKind::EinsteinSum, "EinsteinSum", &["ESUM", "EINSTEIN"]),
    row(SNormKind::HamacherSum, "HamacherSum", &["HSUM", "HAMACHER"]),
    row(SNormKind::NilpotentMaximum, "NilpotentMaximum", &["NMAX", "NILMAX", "NIPMAX"]),
    row(SNormKind::NormalizedSum, "NormalizedSum", &["NSUM"]),
    row(SNormKind::UnboundedSum, "UnboundedSum", &["USUM", "SUM"]),
];

/// Connectives *and* that the standard knows.
pub(crate) const STANDARD_AND: [TNormKind; 3] =
    [TNormKind::Minimum, TNormKind::AlgebraicProduct, TNormKind::BoundedDifference];
/// Accumulations that the standard knows.
pub(crate) const STANDARD_ACCU: [SNormKind; 3] =
    [SNormKind::Maximum, SNormKind::BoundedSum, SNormKind::NormalizedSum];
/// Connectives *or* that the standard knows.
pub(crate) const STANDARD_OR: [SNormKind; 3] =
    [SNormKind::Maximum, SNormKind::AlgebraicSum, SNormKind::BoundedSum];
/// Activations that the standard knows.
pub(crate) const STANDARD_ACT: [TNormKind; 2] = [TNormKind::Minimum, TNormKind::AlgebraicProduct];

/// The norm of a fuzzylite class, in any case.
pub(crate) fn of_class<K: Copy>(rows: &[NormWords<K>], class: &str) -> Option<K> {
    rows.iter().find(|row| row.class.eq_ignore_ascii_case(class)).map(|row| row.kind)
}

/// The norm of a word of FCL or a fuzzylite class, in any case.
pub(crate) fn of_word<K: Copy>(rows: &[NormWords<K>], word: &str) -> Option<K> {
    let named =
        |row: &&NormWords<K>| row.words.iter().any(|known| known.eq_ignore_ascii_case(word));
    rows.iter().find(named).map(|row| row.kind).or_else(|| of_class(rows, word))
}

/// The row of a norm.
pub(crate) fn row_of<K: PartialEq>(
    rows: &'static [NormWords<K>],
    kind: &K,
) -> Option<&'static NormWords<K>> {
    rows.iter().find(|row| row.kind == *kind)
}

impl<K> NormWords<K> {
    /// The word that is written in FCL.
    pub(crate) fn word(&self) -> &'static str {
        self.words.first().copied().unwrap_or(self.class)
    }
}

/// Words for a message.
pub(crate) fn words<K>(
    rows: &'static [NormWords<K>],
) -> impl Iterator<Item = &'static str> + Clone {
    rows.iter().map(|row| row.words.first().copied().unwrap_or_default())
}

/// Classes for a message.
pub(crate) fn classes<K>(
    rows: &'static [NormWords<K>],
) -> impl Iterator<Item = &'static str> + Clone {
    rows.iter().map(|row| row.class)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_norm_has_one_row_and_is_found_by_each_of_its_words() {
        assert_eq!(T_NORMS.len(), TNormKind::ALL.len());
        assert_eq!(S_NORMS.len(), SNormKind::ALL.len());
        for row in T_NORMS {
            assert_eq!(of_class(T_NORMS, &row.class.to_lowercase()), Some(row.kind));
            assert!(row.words.iter().all(|word| of_word(T_NORMS, word) == Some(row.kind)));
        }
        for row in S_NORMS {
            assert_eq!(of_word(S_NORMS, row.class), Some(row.kind));
            assert!(row.words.iter().all(|word| of_word(S_NORMS, word) == Some(row.kind)));
        }
    }
}

//! Words of norms.

use fspid_fuzzy::system::{SNorm, TNorm};
use fspid_fuzzy::{SNormKind, TNormKind};

use super::text::Writer;
use crate::vocabulary::norms::{self, NormWords, S_NORMS, T_NORMS};

impl Writer<'_> {
    /// The word of a norm; beside fuzzylite's dialect only those of the standard.
    pub(super) fn t_norm(&mut self, name: &str, norm: &TNorm, standard: &[TNormKind]) -> String {
        let row = match norm {
            TNorm::Kind(kind) => norms::row_of(T_NORMS, kind),
            TNorm::Formula(_) => None,
        };
        let fits = |row: &&NormWords<TNormKind>| self.extended() || standard.contains(&row.kind);
        let word = row.filter(fits).map(NormWords::word);
        self.word(name, word)
    }

    pub(super) fn s_norm(&mut self, name: &str, norm: &SNorm, standard: &[SNormKind]) -> String {
        let known = self.extended() || standard.iter().any(|&kind| norm.is(kind));
        self.word(name, s_norm_word(norm).filter(|_| known))
    }

    pub(super) fn word(&mut self, name: &str, word: Option<&'static str>) -> String {
        if word.is_none() {
            let message = "a norm has no word in this dialect";
            self.loss.cannot(name, message, "fuzzylite's dialect, or a norm of the standard");
        }
        word.unwrap_or_default().into()
    }
}

/// The word of an s-norm where all have one.
pub(super) fn s_norm_word(norm: &SNorm) -> Option<&'static str> {
    match norm {
        SNorm::Kind(kind) => norms::row_of(S_NORMS, kind).map(NormWords::word),
        SNorm::Formula(_) => None,
    }
}

//! Which tool a text was written for.

use fspid_fuzzy::SNormKind;
use fspid_fuzzy::system::Sampling;

use crate::lexer::Comments;
use fspid_diagnostics::Place;

/// A dialect of FCL.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Dialect {
    /// IEC 61131-7.
    #[default]
    Iec,
    /// fuzzylite.
    Fuzzylite,
    /// jFuzzyLogic.
    JFuzzyLogic,
}

impl Dialect {
    /// Name in messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Iec => "IEC 61131-7",
            Self::Fuzzylite => "fuzzylite",
            Self::JFuzzyLogic => "jFuzzyLogic",
        }
    }

    /// How its tool computes integrals.
    #[must_use]
    pub const fn sampling(self) -> Sampling {
        match self {
            Self::Iec => Sampling::Exact,
            Self::Fuzzylite => Sampling::Midpoint(1000),
            Self::JFuzzyLogic => Sampling::LeftEnd(1000),
        }
    }
}

impl Dialect {
    /// What joins the conclusions about an output where no `ACCU` is given.
    ///
    /// # Source
    /// IEC 1131-7 CD 1.0; jFuzzyLogic 3.3 itself: conclusions at 0.3 and 0.6 count as 0.9 without `ACCU`.
    pub(super) const fn accumulation(self) -> SNormKind {
        match self {
            Self::Iec | Self::Fuzzylite => SNormKind::Maximum,
            Self::JFuzzyLogic => SNormKind::UnboundedSum,
        }
    }
}

/// The first thing in a text that only a tool's own dialect has.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Evidence {
    fuzzylite: Option<(Place, &'static str)>,
    jfuzzylogic: Option<(Place, &'static str)>,
}

impl Evidence {
    pub(super) fn fuzzylite(&mut self, place: Place, what: &'static str) {
        self.fuzzylite.get_or_insert((place, what));
    }

    pub(super) fn jfuzzylogic(&mut self, place: Place, what: &'static str) {
        self.jfuzzylogic.get_or_insert((place, what));
    }

    /// Comments with `#` are fuzzylite's, `/* */` jFuzzyLogic's; `//` have both, but more files of
    /// the latter.
    pub(super) fn comments(&mut self, comments: Comments) {
        if let Some(place) = comments.hash {
            self.fuzzylite(place, "a comment with `#`");
        }
        if let Some(place) = comments.stars {
            self.jfuzzylogic(place, "a comment with `/*`");
        }
        if let (Some(place), None) = (comments.slashes, self.fuzzylite) {
            self.jfuzzylogic(place, "a comment with `//`");
        }
    }

    /// The dialect, and how that is known.
    pub(super) fn judge(self) -> (Dialect, String) {
        let sure = |dialect: Dialect, (place, what): (Place, &str)| {
            (dialect, format!("read as {}'s dialect, for {what} at {place}", dialect.name()))
        };
        match (self.fuzzylite, self.jfuzzylogic) {
            (Some(found), None) => sure(Dialect::Fuzzylite, found),
            (None, Some(found)) => sure(Dialect::JFuzzyLogic, found),
            (None, None) => (Dialect::Iec, "read as the dialect of IEC 61131-7".into()),
            (Some((place, what)), Some((other, that))) => {
                let both =
                    format!("{what} at {place} is fuzzylite's, {that} at {other} jFuzzyLogic's");
                (
                    Dialect::Iec,
                    format!("read as the dialect of IEC 61131-7, for dialects are mixed: {both}"),
                )
            }
        }
    }
}

//! The seven words of the rule base.

use core::fmt;

/// How many words each variable has.
pub const LABEL_COUNT: usize = 7;

/// A linguistic label, from negative big to positive big.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Label {
    /// Negative big.
    NB,
    /// Negative medium.
    NM,
    /// Negative small.
    NS,
    /// Zero.
    ZO,
    /// Positive small.
    PS,
    /// Positive medium.
    PM,
    /// Positive big.
    PB,
}

impl Label {
    /// All labels in ascending order.
    pub const ALL: [Self; LABEL_COUNT] =
        [Self::NB, Self::NM, Self::NS, Self::ZO, Self::PS, Self::PM, Self::PB];

    /// Position from 0 (`NB`) to 6 (`PB`).
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The two letters.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::NB => "NB",
            Self::NM => "NM",
            Self::NS => "NS",
            Self::ZO => "ZO",
            Self::PS => "PS",
            Self::PM => "PM",
            Self::PB => "PB",
        }
    }

    /// The label with that name, upper case as in the paper.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|label| label.name() == name)
    }

    /// The mirror image: `NB` for `PB`, `ZO` for itself.
    #[must_use]
    pub const fn mirrored(self) -> Self {
        Self::ALL[LABEL_COUNT - 1 - self.index()]
    }
}

impl fmt::Display for Label {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

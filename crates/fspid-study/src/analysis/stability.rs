//! One verdict on the stability of a loop, with the same three words in every answer.

use fspid_sim::Stand;

use super::answer::Margins;
use crate::metrics::Absent;

/// Whether a loop is stable.
///
/// Where it is not known to be, [`Absent`] is the reason, and its sentence the same everywhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stability {
    /// Every mode decays.
    Stable,
    /// Something grows.
    Unstable,
    /// Nobody can tell.
    Undecided,
}

impl Stability {
    /// What margins, or the reason that there are none, say of it.
    #[must_use]
    pub fn of(margins: &Result<Margins, Absent>) -> Self {
        match margins {
            // Its poles tell; only how far it is from unstable is not proved, or of no age that lasts.
            Ok(_)
            | Err(
                Absent::NotProved { .. } | Absent::OldestAge { .. } | Absent::AgesAsTheyCome { .. },
            ) => Self::Stable,
            Err(Absent::Unstable { .. }) => Self::Unstable,
            Err(_) => Self::Undecided,
        }
    }

    /// Of several loops that all have to hold.
    #[must_use]
    pub fn of_all(loops: impl IntoIterator<Item = Self>) -> Self {
        loops.into_iter().fold(Self::Stable, |worst, it| match (worst, it) {
            (Self::Unstable, _) | (_, Self::Unstable) => Self::Unstable,
            (Self::Undecided, _) | (_, Self::Undecided) => Self::Undecided,
            (Self::Stable, Self::Stable) => Self::Stable,
        })
    }

    /// The word for it in every answer.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Unstable => "unstable",
            Self::Undecided => "undecided",
        }
    }

    /// The same for programs: nothing where nobody can tell.
    #[must_use]
    pub const fn known(self) -> Option<bool> {
        match self {
            Self::Stable => Some(true),
            Self::Unstable => Some(false),
            Self::Undecided => None,
        }
    }
}

/// What the verdict on a rest says of margins.
pub(super) fn of_stand(stand: Stand) -> Result<(), Absent> {
    match stand {
        Stand::Holds => Ok(()),
        Stand::Grows { spectral_radius } => Err(Absent::Unstable { spectral_radius }),
        Stand::Undecided(doubt) => Err(Absent::Undecided(doubt)),
    }
}

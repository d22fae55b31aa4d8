//! The points at which the loop can be opened for margins.

/// Where a loop is broken. At each point the signal there is replaced by another, and what comes back
/// to the point, with its sign changed, is the open loop L: closed again, it is $1 + L = 0$.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BreakPoint {
    /// At the controller's command: every loop passes through here, as at the actuator.
    #[default]
    Command,
    /// At the pitch angle that the controller sees; a rate loop stays closed.
    Pitch,
    /// At the pitch rate that the controller sees; the pitch loop stays closed.
    Rate,
}

impl BreakPoint {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Command, Self::Pitch, Self::Rate];

    /// Name in options and answers.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Command => "command",
            Self::Pitch => "pitch",
            Self::Rate => "rate",
        }
    }

    /// The point with that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|point| point.name() == name)
    }
}

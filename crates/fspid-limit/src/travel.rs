//! Control effort: the total travel of elevator or command.

/// Whose way counts as travel: the sum of the sizes of its changes from sample to sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Travel {
    /// The elevator's, with what disturbs it: the measure `elevator_travel_deg` of campaigns, tunings and contests.
    Elevator,
    /// The command's, as reports print its variation: the jump at the first sample does not count.
    Command,
    /// The command's from zero on: the jump at the first sample counts.
    CommandFromRest,
}

impl Travel {
    /// Every way to count.
    pub const ALL: [Self; 3] = [Self::Elevator, Self::Command, Self::CommandFromRest];

    /// Name in arguments and answers.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Elevator => "elevator",
            Self::Command => "command",
            Self::CommandFromRest => "command-from-rest",
        }
    }

    /// In a sentence.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Elevator => "elevator travel",
            Self::Command => "command travel without the first jump",
            Self::CommandFromRest => "command travel from zero",
        }
    }

    /// Of a flight's commands and elevator, rad.
    #[must_use]
    pub fn of(self, commands_rad: &[f64], elevator_rad: &[f64]) -> f64 {
        let way =
            |values: &[f64]| values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum::<f64>();
        match self {
            Self::Elevator => way(elevator_rad),
            Self::Command => way(commands_rad),
            Self::CommandFromRest => {
                way(commands_rad) + commands_rad.first().map_or(0.0, |first| first.abs())
            }
        }
    }
}

//! What is put in the place of a supervisor's gains.

/// What flies in the place of the self-tuner as it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Treatment {
    /// The controller that it is compared with.
    Against,
    /// The nominal gains: no supervisor.
    Nominal,
    /// The mean gains of all flights, frozen.
    ClassMean,
    /// At each moment the mean of the gains that the same flight has on other plants.
    OtherPlants,
    /// The supervisor.
    AsItIs,
    /// The mean gains of all flights of the same plant, frozen.
    PlantMean,
    /// The mean gains of the flight itself, frozen.
    FlightMean,
    /// The gains of the flight, begun elsewhere: they move as they did, at other moments.
    Turned,
    /// The gains of the flight in another order, sample by sample.
    Shuffled,
    /// The supervisor sees the inputs of the flight in another order, and concludes for itself.
    InputsShuffled,
    /// The frozen gains that are best for the very plant.
    PlantTuned,
}

/// How many there are.
pub(super) const COUNT: usize = 11;

impl Treatment {
    /// All of them; those up to [`AsItIs`](Self::AsItIs) make the steps of the win, in this order.
    pub const ALL: [Self; COUNT] = [
        Self::Against,
        Self::Nominal,
        Self::ClassMean,
        Self::OtherPlants,
        Self::AsItIs,
        Self::PlantMean,
        Self::FlightMean,
        Self::Turned,
        Self::Shuffled,
        Self::InputsShuffled,
        Self::PlantTuned,
    ];

    /// Those whose differences add up to the whole win.
    pub(super) const CHAIN: [Self; 5] =
        [Self::Against, Self::Nominal, Self::ClassMean, Self::OtherPlants, Self::AsItIs];

    /// Those that depend on other plants than that of the flight.
    pub(super) const OF_OTHERS: [Self; 2] = [Self::ClassMean, Self::OtherPlants];

    /// Those that depend on a seed.
    pub(super) const DRAWN: [Self; 3] = [Self::Turned, Self::Shuffled, Self::InputsShuffled];

    /// Name in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Against => "against",
            Self::Nominal => "nominal",
            Self::ClassMean => "mean-of-all",
            Self::OtherPlants => "other-plants",
            Self::AsItIs => "as-it-is",
            Self::PlantMean => "mean-of-plant",
            Self::FlightMean => "mean-of-flight",
            Self::Turned => "gains-turned",
            Self::Shuffled => "gains-shuffled",
            Self::InputsShuffled => "inputs-shuffled",
            Self::PlantTuned => "tuned-for-plant",
        }
    }

    /// In words, as a table has it.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Against => "compared with",
            Self::Nominal => "nominal gains, no supervisor",
            Self::ClassMean => "mean gains of all flights",
            Self::OtherPlants => "gains of the other plants",
            Self::AsItIs => "as it is",
            Self::PlantMean => "mean gains of the plant",
            Self::FlightMean => "mean gains of the flight",
            Self::Turned => "its gains at other moments",
            Self::Shuffled => "its gains shuffled in time",
            Self::InputsShuffled => "its inputs shuffled in time",
            Self::PlantTuned => "gains tuned for the plant",
        }
    }

    /// What comes in with it where it is put in behind the one before in the chain: a name, and words.
    #[must_use]
    pub const fn step(self) -> Option<(&'static str, &'static str)> {
        match self {
            Self::Nominal => Some(("fixed-numbers", "other fixed numbers")),
            Self::ClassMean => Some(("average", "better average gains")),
            Self::OtherPlants => Some(("moment", "answers to the moment")),
            Self::AsItIs => Some(("plant", "adaptation to the plant")),
            _ => None,
        }
    }

    /// The same of the last step where no other plant flies the same: what the own gains do at each moment.
    pub(super) const UNKNOWN: (&'static str, &'static str) =
        ("moment-or-plant", "its gains of each moment");

    pub(super) const fn place(self) -> usize {
        self as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_treatment_stands_in_its_place_and_has_a_name_of_its_own() {
        for (place, treatment) in Treatment::ALL.into_iter().enumerate() {
            assert_eq!(treatment.place(), place);
            assert_eq!(Treatment::ALL.iter().filter(|it| it.name() == treatment.name()).count(), 1);
        }
    }
}

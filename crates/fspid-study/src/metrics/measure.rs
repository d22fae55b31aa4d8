//! Measures of a step by name, for requirements and claims.

use super::{FlightMetrics, Measured, StepMetrics};

/// A measure of a step response that can be asked for by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// 10 % to 90 %, s.
    RiseTime,
    /// Within 2 %, s.
    SettlingTime,
    /// Beyond the new set-point, %.
    Overshoot,
    /// Left at the end of the window, %.
    FinalError,
}

impl Measure {
    /// All of them.
    pub const ALL: [Self; 4] =
        [Self::Overshoot, Self::RiseTime, Self::SettlingTime, Self::FinalError];

    /// Name in files and answers, with its unit.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::RiseTime => "rise_time_s",
            Self::SettlingTime => "settling_time_s",
            Self::Overshoot => "overshoot_pct",
            Self::FinalError => "final_error_pct",
        }
    }

    /// The measure with that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|measure| measure.name() == name)
    }

    /// Its value for one step, or why there is none.
    ///
    /// # Errors
    /// The reason in the metrics.
    pub fn of(self, step: &StepMetrics) -> Measured {
        match self {
            Self::RiseTime => step.rise_time_s,
            Self::SettlingTime => step.settling_time_s,
            Self::Overshoot => step.overshoot_pct,
            Self::FinalError => step.final_error_pct,
        }
    }

    /// The value farthest from zero over all steps of a flight; absent if it is for any of them.
    ///
    /// # Errors
    /// The reason of the first step without a value.
    pub fn worst(self, flight: &FlightMetrics) -> Measured {
        let mut worst = self.of(&flight.first_step())?;
        for edge in &flight.edges {
            let value = self.of(&edge.step)?;
            if value.abs() > worst.abs() {
                worst = value;
            }
        }
        Ok(worst)
    }
}

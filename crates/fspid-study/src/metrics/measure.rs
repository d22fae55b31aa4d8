//! Measures of a flight by name, for requirements and claims.

use super::{Absent, FlightMetrics, Measured, StepMetrics};
use crate::units::degrees;

/// A measure of a flight that can be asked for by name.
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
    /// Root mean square of the error over the whole flight, deg: for flights in moving air.
    RmsError,
}

impl Measure {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Overshoot, Self::RiseTime, Self::SettlingTime, Self::FinalError, Self::RmsError];

    /// Name in files and answers, with its unit.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::RiseTime => "rise_time_s",
            Self::SettlingTime => "settling_time_s",
            Self::Overshoot => "overshoot_pct",
            Self::FinalError => "final_error_pct",
            Self::RmsError => "rms_error_deg",
        }
    }

    /// The measure with that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|measure| measure.name() == name)
    }

    /// Its value for one step, or why there is none; [`RmsError`](Self::RmsError) has none for a step.
    ///
    /// # Errors
    /// The reason in the metrics.
    pub fn of(self, step: &StepMetrics) -> Measured {
        match self {
            Self::RiseTime => step.rise_time_s,
            Self::SettlingTime => step.settling_time_s,
            Self::Overshoot => step.overshoot_pct,
            Self::FinalError => step.final_error_pct,
            Self::RmsError => Err(Absent::NoStep),
        }
    }

    /// The value farthest from zero over all steps of a flight; absent if it is for any of them.
    ///
    /// # Errors
    /// The reason of the first step without a value.
    pub fn worst(self, flight: &FlightMetrics) -> Measured {
        if self == Self::RmsError {
            return flight.rms_error_rad.map(degrees);
        }
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

//! Why a requirement could not be evaluated.

use std::fmt;

use fspid_aircraft::qualities;
use fspid_sim::SimError;

use super::case::CasePlace;
use crate::metrics::Absent;
use fspid_diagnostics::digits::to_digits;
use fspid_scenario::requirement::Air;

/// Why a requirement could not be evaluated; it is not met then.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum NotEvaluated {
    /// The flight or the loop has no such measure.
    Absent(Absent),
    /// No step of the command has the size that is asked for.
    NoStepOf {
        /// The size, deg.
        asked_deg: f64,
        /// Sizes of the steps there are, deg.
        found_deg: Vec<f64>,
    },
    /// The error left the band again, or never came into it.
    NotRecovered {
        /// The band, deg.
        within_deg: f64,
        /// How long there was time, s.
        window_s: f64,
        /// The step that it was asked of.
        place: Box<CasePlace>,
    },
    /// The time that counts is not part of the flight.
    NotFlown {
        /// Start of that time, s.
        from_s: f64,
        /// Its end, s.
        to_s: f64,
        /// End of the flight, s.
        end_s: f64,
    },
    /// The flight is in another air.
    OtherAir {
        /// The air that is asked for.
        asked: Air,
        /// What there is.
        found: &'static str,
    },
    /// The loop is unstable, so that it has no margins and a flight of it proves nothing.
    Unstable {
        /// Which loop.
        place: Box<CasePlace>,
        /// Spectral radius of the sampled loop.
        spectral_radius: f64,
    },
    /// The gains go beyond what a map of frozen gains shows.
    BeyondMap {
        /// Why.
        why: &'static str,
    },
    /// No mode of the loop has a frequency that counts.
    NoMode,
    /// The gain of the loop is 1 at no frequency.
    NoCrossover,
    /// The linear loop could not be computed.
    Linear(SimError),
    /// The aircraft alone could not be looked at.
    Aircraft(fspid_aircraft::AircraftError),
    /// The aircraft has no such quality.
    Quality(qualities::Absent),
    /// Nobody said how fast the aircraft flies.
    SpeedUnknown,
}

impl NotEvaluated {
    /// Where it was found out, if there is a choice.
    #[must_use]
    pub fn place(&self) -> CasePlace {
        match self {
            Self::Unstable { place, .. } | Self::NotRecovered { place, .. } => **place,
            _ => CasePlace::default(),
        }
    }
}

impl From<Absent> for NotEvaluated {
    fn from(reason: Absent) -> Self {
        Self::Absent(reason)
    }
}

impl From<SimError> for NotEvaluated {
    fn from(error: SimError) -> Self {
        Self::Linear(error)
    }
}

impl From<qualities::Absent> for NotEvaluated {
    fn from(reason: qualities::Absent) -> Self {
        Self::Quality(reason)
    }
}

impl fmt::Display for NotEvaluated {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Absent(reason) => reason.fmt(f),
            Self::NoStepOf { asked_deg, found_deg } => {
                write!(f, "the command has no step of {} deg", to_digits(*asked_deg, 6))?;
                match sizes(found_deg) {
                    sizes if sizes.is_empty() => f.write_str(", and no other"),
                    sizes => write!(f, "; its steps are of {sizes} deg"),
                }
            }
            Self::NotRecovered { within_deg, window_s, .. } => write!(
                f,
                "not back within {} deg for good in {} s",
                to_digits(*within_deg, 6),
                to_digits(*window_s, 6)
            ),
            Self::NotFlown { from_s, to_s, end_s } => write!(
                f,
                "nothing was flown from {} s to {} s: the flight ends at {} s",
                to_digits(*from_s, 6),
                to_digits(*to_s, 6),
                to_digits(*end_s, 6)
            ),
            Self::OtherAir { asked, found } => {
                write!(f, "asked for {} air, but the flight has {found}", asked.name())
            }
            Self::Unstable { spectral_radius, .. } => {
                Absent::Unstable { spectral_radius: *spectral_radius }.fmt(f)
            }
            Self::BeyondMap { why } => f.write_str(why),
            Self::NoMode => f.write_str("no mode of the loop has a frequency that counts"),
            Self::NoCrossover => f.write_str("the gain of the loop is 1 at no frequency"),
            Self::Linear(error) => error.fmt(f),
            Self::Aircraft(error) => error.fmt(f),
            Self::Quality(reason) => reason.fmt(f),
            Self::SpeedUnknown => f.write_str(
                "nobody says how fast the aircraft flies: a plant file with `speed_m_s` in its condition does, or an `aircraft` whose file has a flight condition",
            ),
        }
    }
}

impl std::error::Error for NotEvaluated {}

/// Sizes, each once, at most five of them.
fn sizes(found_deg: &[f64]) -> String {
    let mut sizes: Vec<String> = Vec::new();
    for size in found_deg.iter().map(|size| to_digits(size.abs(), 6)) {
        if !sizes.contains(&size) {
            sizes.push(size);
        }
    }
    if sizes.len() > 5 {
        sizes.truncate(5);
        sizes.push("…".to_owned());
    }
    sizes.join(", ")
}

//! Why a requirement could not be evaluated.

use fspid_aircraft::qualities;
use fspid_sim::SimError;

use super::case::CasePlace;
use crate::metrics::Absent;
use fspid_diagnostics::digits::to_digits;
use fspid_scenario::requirement::Air;

/// Why a requirement could not be evaluated; it is not met then.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NotEvaluated {
    /// The flight or the loop has no such measure.
    #[error(transparent)]
    Absent(#[from] Absent),
    /// No step of the command has the size that is asked for.
    #[error("the command has no step of {} deg{}", to_digits(*asked_deg, 6), others(found_deg))]
    NoStepOf {
        /// The size, deg.
        asked_deg: f64,
        /// Sizes of the steps there are, deg.
        found_deg: Vec<f64>,
    },
    /// The error left the band again, or never came into it.
    #[error(
        "not back within {} deg for good in {} s",
        to_digits(*within_deg, 6),
        to_digits(*window_s, 6)
    )]
    NotRecovered {
        /// The band, deg.
        within_deg: f64,
        /// How long there was time, s.
        window_s: f64,
        /// The step that it was asked of.
        place: Box<CasePlace>,
    },
    /// It settled just before the end.
    #[error(
        "settled only {} s before the end of the {} s that are flown after it: fly on, to see that it stays",
        to_digits(*window_s - *settled_s, 3),
        to_digits(*window_s, 6)
    )]
    TooShort {
        /// When it settled, s.
        settled_s: f64,
        /// How long there was time, s.
        window_s: f64,
        /// The step that it was asked of.
        place: Box<CasePlace>,
    },
    /// The flight, or the time of a step, ends while the response still goes on.
    #[error(
        "the response still goes on at the end of the {} s that are flown after the step: fly on, to see how far beyond it goes",
        to_digits(*window_s, 6)
    )]
    StillRising {
        /// How long there was time, s.
        window_s: f64,
        /// The step that it was asked of.
        place: Box<CasePlace>,
    },
    /// An error that is small at the last sample and was larger just before.
    #[error(
        "it is as little at the last sample, but up to {} {unit} over the last tenth of the {} s that are flown: fly on, to see that it stays",
        to_digits(*largest, 4),
        to_digits(*window_s, 6)
    )]
    NotLeft {
        /// The largest of the last tenth.
        largest: f64,
        /// Its unit.
        unit: &'static str,
        /// How long there was time, s.
        window_s: f64,
        /// What it was asked of.
        place: Box<CasePlace>,
    },
    /// The time that counts is not part of the flight.
    #[error(
        "nothing was flown from {} s to {} s: the flight ends at {} s",
        to_digits(*from_s, 6),
        to_digits(*to_s, 6),
        to_digits(*end_s, 6)
    )]
    NotFlown {
        /// Start of that time, s.
        from_s: f64,
        /// Its end, s.
        to_s: f64,
        /// End of the flight, s.
        end_s: f64,
    },
    /// The time that counts begins just before the end of the flight.
    #[error(
        "from {} s on only {} s were flown: at least a tenth of that time shows that it stays, or give the end with to_s",
        to_digits(*from_s, 6),
        to_digits(*end_s - *from_s, 3)
    )]
    LittleFlown {
        /// Start of that time, s.
        from_s: f64,
        /// End of the flight, s.
        end_s: f64,
    },
    /// The flight is in another air.
    #[error("asked for {} air, but the flight has {found}", asked.name())]
    OtherAir {
        /// The air that is asked for.
        asked: Air,
        /// What there is.
        found: &'static str,
    },
    /// The loop is unstable, so that it has no margins and a flight of it proves nothing.
    #[error("{}", Absent::Unstable { spectral_radius: *spectral_radius })]
    Unstable {
        /// Which loop.
        place: Box<CasePlace>,
        /// Spectral radius of the sampled loop.
        spectral_radius: f64,
    },
    /// The gains go beyond what a map of frozen gains shows.
    #[error("{why}")]
    BeyondMap {
        /// Why.
        why: &'static str,
    },
    /// No proof can speak of the loop.
    #[error("no proof speaks of this loop: {why}")]
    NotProvable {
        /// Why.
        why: String,
    },
    /// A loop that has no equations.
    #[error(
        "an external controller has no equations here, so that its loop cannot be asked; its flights can"
    )]
    External,
    /// What only the controller knows, and might say wrongly.
    #[error(
        "an external controller's limits are not known here, and its own word of what they cut is no measure; its elevator and its command are measured"
    )]
    OwnWord,
    /// No mode of the loop has a frequency that counts.
    #[error("no mode of the loop has a frequency that counts")]
    NoMode,
    /// A sampled loop says nothing of the frequencies that count.
    #[error(
        "nothing from {} Hz on can be asked of a loop that is sampled {} times a second: its margins end at {} Hz, half of that. Sample faster, or show by other means what faster motions do",
        to_digits(*from_hz, 6),
        to_digits(2.0 * *ends_hz, 6),
        to_digits(*ends_hz, 6)
    )]
    BeyondSampling {
        /// Where the band starts, Hz.
        from_hz: f64,
        /// Half the sample rate, Hz.
        ends_hz: f64,
    },
    /// The gain of the loop is 1 at no frequency.
    #[error("the gain of the loop is 1 at no frequency")]
    NoCrossover,
    /// The linear loop could not be computed.
    #[error(transparent)]
    Linear(#[from] SimError),
    /// The aircraft alone could not be looked at.
    #[error(transparent)]
    Aircraft(fspid_aircraft::AircraftError),
    /// The aircraft has no such quality.
    #[error("{0}")]
    Quality(qualities::Absent),
    /// A linear plant has no loads, no way and no airspeed.
    #[error(
        "a linear plant has no {measure}: it is measured on a nonlinear aircraft, an `[aircraft]` that is not flown as its linear model"
    )]
    NoAircraft {
        /// Name of what was asked for.
        measure: &'static str,
    },
    /// Nobody said which altitude is aimed at.
    #[error("nobody says which altitude is aimed at: target_ft or target_m does")]
    NoTarget,
    /// The flight starts where it aims at.
    #[error("the flight starts at the target of {} ft, so that nothing can be overshot", to_digits(*target_ft, 6))]
    AtTarget {
        /// The target, ft.
        target_ft: f64,
    },
    /// The flight did not get to the altitude that it aims at.
    #[error(
        "the target of {} ft was not reached: {} ft were left",
        to_digits(*target_ft, 6),
        to_digits(*left_ft, 4)
    )]
    TargetNotReached {
        /// The target, ft.
        target_ft: f64,
        /// The nearest that the flight came, ft.
        left_ft: f64,
    },
    /// The flight ends while it still goes away from the altitude that it aims at.
    #[error(
        "the flight still goes away from the target of {} ft at its last sample that counts: fly on, to see how far",
        to_digits(*target_ft, 6)
    )]
    StillGoing {
        /// The target, ft.
        target_ft: f64,
    },
    /// The aircraft's data do not say how far the angle of attack may go.
    #[error(
        "the aircraft's data name no largest angle of attack: `alpha_deg` of its [validity] does"
    )]
    NoAlphaLimit,
    /// Nobody said how fast the aircraft flies.
    #[error(
        "nobody says how fast the aircraft flies: a plant file with `speed_m_s` in its condition does, or an `aircraft` whose file has a flight condition"
    )]
    SpeedUnknown,
}

impl NotEvaluated {
    /// Where it was found out, if there is a choice.
    #[must_use]
    pub fn place(&self) -> CasePlace {
        match self {
            Self::Unstable { place, .. }
            | Self::NotRecovered { place, .. }
            | Self::StillRising { place, .. }
            | Self::NotLeft { place, .. }
            | Self::TooShort { place, .. } => **place,
            _ => CasePlace::default(),
        }
    }
}

impl From<qualities::Absent> for NotEvaluated {
    fn from(reason: qualities::Absent) -> Self {
        Self::Quality(reason)
    }
}

/// Which steps there are in place of the one that is asked for.
fn others(found_deg: &[f64]) -> String {
    match sizes(found_deg) {
        sizes if sizes.is_empty() => ", and no other".to_owned(),
        sizes => format!("; its steps are of {sizes} deg"),
    }
}

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

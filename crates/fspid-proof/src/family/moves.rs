//! Additional uncertainty of a part's loops when parameters vary within a sample.

use fspid_numeric::scalar::Interval;

use super::{Pace, Parameter, Part};
use crate::check::{NotProved, PlantSet};
use crate::description::LoopDescription;

/// What the plants of all parts are off, and what they have of pitch rate: numbers leave a part within a sample.
#[derive(Clone, Debug)]
pub(super) struct Off {
    /// Entries of the sampled plant, in magnitude, row by row over states and command.
    pub(super) entries: Vec<f64>,
    /// Row from states to pitch rate, of all plants.
    pub(super) pitch_rate: Vec<Interval>,
}

impl Off {
    /// At a pace, of parts that together hold all that is between.
    pub(super) fn of(
        pace: &Pace,
        (parameters, parts): (&[Parameter], &[Part]),
        description: &LoopDescription,
    ) -> Result<Self, NotProved> {
        let plants: Vec<&PlantSet> = parts.iter().map(|part| &part.plants).collect();
        let dt_s = description.controller.config().dt_s;
        let entries = PlantSet::off_by_moving(&plants, &pace.of_plant(parameters, dt_s), dt_s)?;
        let states = plants.first().map_or(0, |it| it.pitch_rate.len());
        let hull = |at: usize| {
            let all = plants.iter().map(|it| it.pitch_rate[at]);
            all.reduce(Interval::hull).unwrap_or(Interval::ENTIRE)
        };
        Ok(Self { entries, pitch_rate: (0..states).map(hull).collect() })
    }

    /// True if another is nowhere further off.
    pub(super) fn encloses(&self, other: &Self) -> bool {
        let all = self.entries.iter().zip(&other.entries).all(|(own, other)| own >= other);
        let rates = self.pitch_rate.iter().zip(&other.pitch_rate);
        all && rates.into_iter().all(|(own, other)| own.encloses(*other))
    }
}

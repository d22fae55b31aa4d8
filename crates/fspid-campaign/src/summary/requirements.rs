//! Requirements over all flights.

use super::SummaryError;
use super::data::{Extreme, Limits, Probability, RequirementSummary};
use super::flights::booleans;
use super::source::{Asked, Source};

/// What came of a requirement with one controller.
#[derive(Clone, Default)]
struct Tally {
    judged: u64,
    not_met: u64,
    without_value: u64,
    not_judged: u64,
    worst: Option<Extreme>,
}

/// The requirements of each controller.
pub(super) fn read(source: &Source) -> Result<Vec<Vec<RequirementSummary>>, SummaryError> {
    let mut requirements = vec![Vec::new(); source.controllers()];
    for asked in source.requirements() {
        for (mine, tally) in requirements.iter_mut().zip(tallies(source, &asked)?) {
            mine.push(tally.summary(&asked, source.head.confidence)?);
        }
    }
    Ok(requirements)
}

/// Reads the two columns of a requirement.
fn tallies(source: &Source, asked: &Asked) -> Result<Vec<Tally>, SummaryError> {
    let of_run = source.controllers();
    let mut tallies = vec![Tally::default(); of_run];
    let (met, value) = (asked.met(), asked.value());
    let mut row = 0;
    for table in source.reader.columns(&[&met, &value])? {
        let table = table?;
        for (met, value) in booleans(&table, &met)?.iter().zip(table.floats(&value)?) {
            if let Some(tally) = tallies.get_mut(row % of_run) {
                tally.add(*met, *value);
                let run = (row / of_run) as u64;
                tally.keep(asked, value.map(|value| Extreme { run, value }));
            }
            row += 1;
        }
    }
    Ok(tallies)
}

impl Tally {
    fn add(&mut self, met: Option<bool>, value: Option<f64>) {
        let Some(met) = met else {
            self.not_judged += 1;
            return;
        };
        self.judged += 1;
        self.not_met += u64::from(!met);
        self.without_value += u64::from(value.is_none());
    }

    /// Keeps a value if it is worse than those so far.
    fn keep(&mut self, asked: &Asked, found: Option<Extreme>) {
        let Some(found) = found else {
            return;
        };
        let Some(outside) = asked.outside(found.value) else {
            return;
        };
        let before = self.worst.and_then(|worst| asked.outside(worst.value));
        if before.is_none_or(|before| outside > before) {
            self.worst = Some(found);
        }
    }

    fn summary(self, asked: &Asked, confidence: f64) -> Result<RequirementSummary, SummaryError> {
        Ok(RequirementSummary {
            id: asked.id.clone(),
            measure: asked.measure.clone(),
            unit: asked.unit.clone(),
            required: asked.required.clone(),
            limits: asked.limits,
            not_met: Probability::of(self.not_met, self.judged, confidence)?,
            without_value: self.without_value,
            not_judged: self.not_judged,
            worst: self.worst,
        })
    }
}

impl Limits {
    /// How far a value is outside, in its unit, below 0 inside; `None` for NaN and without limits.
    #[must_use]
    pub fn outside(&self, value: f64) -> Option<f64> {
        let below = self.least.map(|least| least - value);
        let above = self.most.map(|most| value - most);
        let worse = match (below, above) {
            (Some(below), Some(above)) => {
                if below > above {
                    below
                } else {
                    above
                }
            }
            (one, other) => one.or(other)?,
        };
        (!worse.is_nan()).then_some(worse)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_as_far_outside_as_the_nearer_limit_says() {
        let both = Limits { least: Some(1.0), most: Some(3.0) };
        assert_eq!(both.outside(0.0), Some(1.0));
        assert_eq!(both.outside(1.5), Some(-0.5));
        assert_eq!(both.outside(5.0), Some(2.0));
        assert_eq!(both.outside(f64::NAN), None);
        let least = Limits { least: Some(30.0), most: None };
        assert_eq!(least.outside(f64::INFINITY), Some(f64::NEG_INFINITY));
        assert_eq!(Limits::default().outside(1.0), None);
    }
}

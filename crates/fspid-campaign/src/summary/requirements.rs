//! Requirements over all flights.

use super::SummaryError;
use super::data::{Extreme, Limits, Probability, RequirementSummary};
use super::flights::booleans;
use super::source::{Asked, Source};

/// What came of a requirement with one controller.
#[derive(Clone, Default)]
pub(super) struct Tally {
    judged: u64,
    not_met: u64,
    without_value: u64,
    not_judged: u64,
    /// With how far outside the limits it is.
    worst: Option<(f64, Extreme)>,
}

/// The requirements of each controller, from what came of each.
pub(super) fn summaries(
    source: &Source,
    tallies: Vec<Vec<Tally>>,
) -> Result<Vec<Vec<RequirementSummary>>, SummaryError> {
    let mut requirements = vec![Vec::new(); source.controllers()];
    for (asked, tallies) in source.requirements().iter().zip(tallies) {
        for (mine, tally) in requirements.iter_mut().zip(tallies) {
            mine.push(tally.summary(asked, source.head.confidence)?);
        }
    }
    Ok(requirements)
}

/// Reads the two columns of a requirement.
pub(super) fn tallies(source: &Source, asked: &Asked) -> Result<Vec<Tally>, SummaryError> {
    let of_run = source.controllers();
    let mut tallies = vec![Tally::default(); of_run];
    let (met, value) = (asked.met(), asked.value());
    let mut row = 0;
    for table in source.files.columns(&[&met, &value])? {
        let table = table?;
        for (met, value) in booleans(&table, &met)?.iter().zip(table.floats(&value)?) {
            if let Some(tally) = tallies.get_mut(row % of_run) {
                tally.add(*met, *value);
                let run = source.run(row);
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
        if let Some(found) = found
            && let Some(outside) = asked.outside(found.value)
        {
            self.keep_worse((outside, found));
        }
    }

    fn keep_worse(&mut self, found: (f64, Extreme)) {
        if self.worst.is_none_or(|(before, _)| found.0 > before) {
            self.worst = Some(found);
        }
    }

    /// With what later rows say.
    pub(super) fn merge(&mut self, later: Self) {
        self.judged += later.judged;
        self.not_met += later.not_met;
        self.without_value += later.without_value;
        self.not_judged += later.not_judged;
        later.worst.into_iter().for_each(|found| self.keep_worse(found));
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
            worst: self.worst.map(|(_, worst)| worst),
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

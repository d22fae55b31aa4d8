//! The measures that every flight has, one row each. Whoever lists or tells them walks these rows: columns of campaigns, the
//! answer of `simulate` as JSON, tables of reports; whoever is asked for one by its [`Measure`], as requirements, tunings
//! and contests are, takes it from here.
//!
//! Not of the family is what needs a condition or another witness than the metrics: the recovery time, the error in
//! degrees that a step leaves, a part of the flight, an aircraft, a loop.

use fspid_scenario::measure::Measure;
use fspid_scenario::units::degrees;
use serde::Serialize;

use super::{CommandEffort, ErrorIntegrals, FlightMetrics, Measured, StepMetrics};

/// Which values of a measure are bad.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Bad {
    /// High ones, as of overshoot.
    High,
    /// Low ones, as of a margin.
    Low,
}

/// A measure that every flight has, or a reason for having none.
#[derive(Debug)]
pub struct Metric {
    /// Its name, with its unit.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// As what it can be asked for.
    asked: Option<Measure>,
    /// Which values are bad, whatever is asked; none where both sides are, or neither.
    pub bad: Option<Bad>,
    /// What it is, of a flight.
    pub meaning: &'static str,
    value: Value,
    /// Its name in the answer of `simulate` as JSON, which has names of its own for some measures of a whole flight and
    /// does not tell the others: its first version stays. Those of a step are all told, by their names.
    pub(crate) key: Option<&'static str>,
    /// Its heading in a report's tables, and decimals there; none where it is not shown.
    pub(crate) shown: Option<(&'static str, usize)>,
}

/// What it is taken out of.
#[derive(Debug)]
enum Value {
    /// The metrics of a step, of a flight those of the first.
    Step(fn(&StepMetrics) -> Measured),
    /// The metrics of a whole flight.
    Flight(fn(&FlightMetrics) -> Measured),
}

const HIGH: Option<Bad> = Some(Bad::High);

/// A measure that can be asked for has its name and unit there.
const fn row(measure: Measure, bad: Option<Bad>, value: Value, meaning: &'static str) -> Metric {
    let named = (measure.name(), measure.unit());
    Metric { asked: Some(measure), ..own(named, bad, value, meaning) }
}

/// One that cannot be asked for.
const fn own(
    (name, unit): (&'static str, &'static str),
    bad: Option<Bad>,
    value: Value,
    meaning: &'static str,
) -> Metric {
    Metric { name, unit, asked: None, bad, meaning, value, key: None, shown: None }
}

fn integral(flight: &FlightMetrics, value: fn(ErrorIntegrals) -> f64) -> Measured {
    flight.integrals.map(value)
}

fn command(flight: &FlightMetrics, value: fn(CommandEffort) -> f64) -> Measured {
    flight.effort.map(|effort| degrees(value(effort)))
}

fn elevator(flight: &FlightMetrics, value: fn(CommandEffort) -> f64) -> Measured {
    flight.elevator.map(|effort| degrees(value(effort)))
}

/// One row a measure. Names, units, meanings and order are those of the columns of a campaign's file, and change with its
/// format only.
#[rustfmt::skip] // a table: one row a measure
pub static METRICS: [Metric; 21] = {
    use Measure as M;
    use Value::{Flight, Step};
    [
        row(M::RiseTime, HIGH, Step(|s| s.rise_time_s), "10 % to 90 % of the first step of the command").shown("rise time", 3),
        row(M::SettlingTime, HIGH, Step(|s| s.settling_time_s), "until the response to the first step stays within 2 % of it").shown("settling time", 3),
        own(("transient_time_s", "s"), HIGH, Step(|s| s.transient_time_s), "until the response to the first step stays within 2 % of its largest error"),
        row(M::Overshoot, HIGH, Step(|s| s.overshoot_pct), "beyond the set-point after the first step, of the step").shown("overshoot", 2),
        own(("undershoot_pct", "%"), HIGH, Step(|s| s.undershoot_pct), "first the wrong way after the first step, of the step").shown("undershoot", 2),
        row(M::FinalError, None, Step(|s| s.final_error_pct), "left at the end of the first step's window, of the step; positive below the set-point").shown("final error", 2),
        own(("peak_deg", "deg"), None, Step(|s| s.peak.map(degrees)), "largest distance from where the first step began").shown("peak", 3),
        own(("peak_time_s", "s"), None, Step(|s| s.peak_time_s), "time of the peak after the first step").shown("time of peak", 2),
        row(M::ErrorIntegral, HIGH, Flight(|f| integral(f, |i| degrees(i.iae_rad_s))), "integral of the size of the error over the flight").told("iae").shown("IAE", 4),
        row(M::TimedErrorIntegral, HIGH, Flight(|f| integral(f, |i| degrees(i.itae_rad_s2))), "the same, weighted with the time since the last step").told("itae").shown("ITAE", 4),
        own(("ise_deg2_s", "deg² s"), HIGH, Flight(|f| integral(f, |i| degrees(degrees(i.ise_rad2_s)))), "integral of the squared error over the flight").told("ise").shown("ISE", 4),
        own(("itse_deg2_s2", "deg² s²"), HIGH, Flight(|f| integral(f, |i| degrees(degrees(i.itse_rad2_s2)))), "the same, weighted with the time since the last step").told("itse").shown("ITSE", 4),
        row(M::RmsError, HIGH, Flight(|f| f.rms_error_rad.map(degrees)), "root mean square of the error over the flight"),
        row(M::LargestError, HIGH, Flight(|f| f.effort.map(|_| degrees(f.largest_error_rad))), "largest size of the error"),
        row(M::CommandVariation, HIGH, Flight(|f| command(f, |e| e.variation_rad)), "way of the command: sum of the sizes of its changes").told("command_variation").shown("command variation", 3),
        row(M::LargestCommand, HIGH, Flight(|f| command(f, |e| e.largest_rad)), "largest size of the command").told("command_max_deg").shown("largest command", 3),
        row(M::CommandRate, HIGH, Flight(|f| command(f, |e| e.fastest_rad_s)), "fastest change of the command from sample to sample").shown("fastest command", 2),
        row(M::ElevatorTravel, HIGH, Flight(|f| elevator(f, |e| e.variation_rad)), "way of the elevator: sum of the sizes of its changes"),
        own(("largest_elevator_deg", "deg"), HIGH, Flight(|f| elevator(f, |e| e.largest_rad)), "largest size of the elevator deflection"),
        row(M::ElevatorRate, HIGH, Flight(|f| elevator(f, |e| e.fastest_rad_s)), "fastest change of the elevator from sample to sample"),
        row(M::Saturated, HIGH, Flight(|f| f.saturated_share.map(|share| 100.0 * share)), "samples whose command was cut by the controller's own limits"),
    ]
};

impl Metric {
    const fn told(self, key: &'static str) -> Self {
        Self { key: Some(key), ..self }
    }

    const fn shown(self, heading: &'static str, decimals: usize) -> Self {
        Self { shown: Some((heading, decimals)), ..self }
    }

    /// The one that is asked for as this; none for a measure that is none of the family.
    #[must_use]
    pub fn asked_as(measure: Measure) -> Option<&'static Self> {
        METRICS.iter().find(|metric| metric.asked == Some(measure))
    }

    /// The one with this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<&'static Self> {
        METRICS.iter().find(|metric| metric.name == name)
    }

    /// Its value in a flight, of one of a step in the first.
    ///
    /// # Errors
    /// The reason in the metrics.
    pub fn of_flight(&self, flight: &FlightMetrics) -> Measured {
        match self.value {
            Value::Step(value) => value(&flight.first_step()),
            Value::Flight(value) => value(flight),
        }
    }

    /// Its value in a step; none for one of a whole flight.
    #[must_use]
    pub fn of_step(&self, step: &StepMetrics) -> Option<Measured> {
        match self.value {
            Value::Step(value) => Some(value(step)),
            Value::Flight(_) => None,
        }
    }

    /// True for one with a sign whose size is what is asked for: both of its sides are bad.
    #[must_use]
    pub fn is_of_size(&self) -> bool {
        self.bad.is_none() && self.asked.is_some_and(|measure| !measure.is_signed())
    }

    /// True for one of a step.
    pub(crate) const fn is_of_step(&self) -> bool {
        matches!(self.value, Value::Step(_))
    }
}

#[cfg(test)]
mod tests {
    use fspid_scenario::measure::{Family, label};

    use super::*;

    #[test]
    fn every_measure_of_steps_and_flights_that_needs_no_condition_is_of_the_family() {
        // The error that is left in degrees is asked without a step too, at the end of the flight.
        let others = [Measure::RecoveryTime, Measure::FinalErrorAngle];
        for measure in Measure::ALL.into_iter().filter(|measure| !others.contains(measure)) {
            let metric = Metric::asked_as(measure).map(Metric::is_of_step);
            let expected = match measure.family() {
                Family::Step => Some(true),
                Family::Flight => Some(false),
                _ => None,
            };
            assert_eq!(metric, expected, "{}", measure.name());
        }
    }

    #[test]
    fn every_name_is_its_own_and_ends_with_its_unit() {
        for metric in &METRICS {
            let found = Metric::from_name(metric.name).expect("it stands there");
            assert!(std::ptr::eq(found, metric), "{} stands there twice", metric.name);
            let words = label(metric.name, metric.unit);
            assert!(words.len() < metric.name.len(), "{words} in {}", metric.unit);
            // A measure that can be asked for is called so wherever it is told.
            let measure = Measure::from_name(metric.name);
            assert_eq!(metric.asked, measure, "{}", metric.name);
        }
    }
}

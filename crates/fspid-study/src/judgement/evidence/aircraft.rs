//! What the flight of a nonlinear aircraft shows beyond pitch.

use std::ops::RangeInclusive;

use fspid_aircraft::ForceModel;
use fspid_sim::{AircraftPlant, Trace};

use crate::judgement::{Case, CasePlace, NotEvaluated};
use fspid_scenario::file::Study;
use fspid_scenario::measure::Measure;
use fspid_scenario::requirement::Requirement;
use fspid_scenario::units::{FOOT_M, KNOT_M_S, degrees};

/// Two altitudes this close are one: nothing is overshot between them, m.
const SAME_ALTITUDE_M: f64 = 1e-3;
/// Who moves away by less than this, a foot, in the last tenth of a flight has come to rest for an overshoot: a choice of this project.
const CREEPS_M: f64 = FOOT_M;

/// The case of a measure over some samples of a flight that was flown to its end.
pub(super) fn case(
    study: &Study,
    trace: &Trace,
    requirement: &Requirement,
    time: RangeInclusive<usize>,
) -> Result<Case, NotEvaluated> {
    let measure = requirement.measure;
    let none = || NotEvaluated::NoAircraft { measure: measure.name() };
    // Of an aircraft that another simulator flies, what it shows is in the trace.
    let plant = study.scenario.plant.aircraft();
    if plant.is_none() && trace.column("airspeed_m_s").is_none() {
        return Err(none());
    }
    let seen = Seen { plant, trace, time, target_m: requirement.conditions.target_altitude_m() };
    match measure {
        Measure::LargestLoadFactor => seen.largest("load_factor", |value| value),
        Measure::LeastLoadFactor => seen.least("load_factor", |value| value),
        Measure::AltitudeLoss => {
            let from_m = seen.reference_m()?;
            seen.largest("altitude_m", |altitude_m| ((from_m - altitude_m) / FOOT_M).max(0.0))
        }
        Measure::AltitudeOvershoot => seen.overshoot(),
        Measure::AltitudeDeviation => {
            let from_m = seen.reference_m()?;
            seen.largest("altitude_m", |altitude_m| (altitude_m - from_m).abs() / FOOT_M)
        }
        Measure::LargestAirspeed => seen.largest("airspeed_m_s", |value| value / KNOT_M_S),
        Measure::LeastAirspeed => seen.least("airspeed_m_s", |value| value / KNOT_M_S),
        Measure::AirspeedDeviation => {
            let trim_m_s = seen.trim_m_s()?;
            seen.largest("airspeed_m_s", |value| (value - trim_m_s).abs() / KNOT_M_S)
        }
        Measure::LargestAlpha => seen.largest("alpha_rad", degrees),
        Measure::AlphaMargin => seen.alpha_margin(),
        Measure::LargestBank => seen.largest("bank_rad", |bank_rad| degrees(bank_rad.abs())),
        Measure::LargestPitch => seen.largest("attitude_rad", degrees),
        Measure::LeastPitch => seen.least("attitude_rad", degrees),
        Measure::LargestSink => seen.largest("climb_m_s", |climb| sink_ft_min(climb).max(0.0)),
        Measure::FinalSink => seen.at_end("climb_m_s", sink_ft_min),
        // Of another family; a test asks all of this one.
        _ => Err(none()),
    }
}

fn sink_ft_min(climb_m_s: f64) -> f64 {
    // Plus zero, so that level flight sinks by 0 and not by -0.
    -climb_m_s / FOOT_M * 60.0 + 0.0
}

/// A part of a flight.
struct Seen<'a> {
    /// Of our own.
    plant: Option<&'a AircraftPlant>,
    trace: &'a Trace,
    time: RangeInclusive<usize>,
    target_m: Option<f64>,
}

impl Seen<'_> {
    /// The values of a column in the time that counts.
    fn column(&self, name: &'static str) -> Result<&[f64], NotEvaluated> {
        let values = self.trace.column(name).and_then(|column| column.get(self.time.clone()));
        values
            .filter(|values| !values.is_empty())
            .ok_or(NotEvaluated::Absent(crate::metrics::Absent::NotFinite))
    }

    /// The altitude that others are compared with, m: the target, or that of the start.
    fn reference_m(&self) -> Result<f64, NotEvaluated> {
        match self.target_m {
            Some(target_m) => Ok(target_m),
            None => self.start_m(),
        }
    }

    fn start_m(&self) -> Result<f64, NotEvaluated> {
        self.first("altitude_m")
    }

    /// The airspeed of the trim, m/s; a flight of another simulator begins with it.
    fn trim_m_s(&self) -> Result<f64, NotEvaluated> {
        let trim_m_s = self.plant.map(|plant| plant.trim().target.airspeed_m_s);
        trim_m_s.map_or_else(|| self.first("airspeed_m_s"), Ok)
    }

    fn first(&self, name: &str) -> Result<f64, NotEvaluated> {
        let first = self.trace.column(name).and_then(|column| column.first());
        first.copied().ok_or(NotEvaluated::Absent(crate::metrics::Absent::NotFinite))
    }

    /// A value at the place where it is the worst; NaN is worse than anything.
    fn worst(
        &self,
        name: &'static str,
        of: impl Fn(f64) -> f64,
        is_worse: fn(f64, f64) -> bool,
    ) -> Result<Case, NotEvaluated> {
        let values = (*self.time.start()..).zip(self.column(name)?.iter().map(|value| of(*value)));
        let worst = values.reduce(|worst, next| {
            let taken = !worst.1.is_nan() && (next.1.is_nan() || is_worse(next.1, worst.1));
            if taken { next } else { worst }
        });
        let (sample, value) =
            worst.ok_or(NotEvaluated::Absent(crate::metrics::Absent::NotFinite))?;
        Ok(Case { value, place: self.place(sample) })
    }

    fn largest(&self, name: &'static str, of: impl Fn(f64) -> f64) -> Result<Case, NotEvaluated> {
        self.worst(name, of, |next, worst| next > worst)
    }

    fn least(&self, name: &'static str, of: impl Fn(f64) -> f64) -> Result<Case, NotEvaluated> {
        self.worst(name, of, |next, worst| next < worst)
    }

    fn at_end(&self, name: &'static str, of: fn(f64) -> f64) -> Result<Case, NotEvaluated> {
        let last = self.column(name)?.last().copied().unwrap_or(f64::NAN);
        Ok(Case { value: of(last), place: self.place(*self.time.end()) })
    }

    fn place(&self, sample: usize) -> CasePlace {
        CasePlace { at_s: self.trace.time_s.get(sample).copied(), ..CasePlace::default() }
    }

    /// Beyond the target, on the side where the flight does not start, or beyond the start on the other side, whichever is
    /// more: a change of level leaves neither. A flight that does not get there overshoots nothing, and is not praised for it.
    fn overshoot(&self) -> Result<Case, NotEvaluated> {
        let target_m = self.target_m.ok_or(NotEvaluated::NoTarget)?;
        let start_m = self.start_m()?;
        let way_m = target_m - start_m;
        if !(way_m.abs() > SAME_ALTITUDE_M) {
            return Err(NotEvaluated::AtTarget { target_ft: target_m / FOOT_M });
        }
        let beyond_m = |altitude_m: f64| (altitude_m - target_m) * way_m.signum();
        let found = self.largest("altitude_m", |altitude_m| beyond_m(altitude_m) / FOOT_M)?;
        if found.value < 0.0 {
            let left_ft = -found.value;
            return Err(NotEvaluated::TargetNotReached { target_ft: target_m / FOOT_M, left_ft });
        }
        let left_m = self.left_in_the_last_tenth_m().unwrap_or(0.0) * way_m.signum();
        if found.value > 0.0 && left_m > CREEPS_M {
            return Err(NotEvaluated::StillGoing { target_ft: target_m / FOOT_M });
        }
        let behind_m = |altitude_m: f64| (start_m - altitude_m) * way_m.signum();
        let behind = self.largest("altitude_m", |altitude_m| behind_m(altitude_m) / FOOT_M)?;
        Ok(if behind.value > found.value { behind } else { found })
    }

    /// How far the altitude rose in the last tenth of the flight, m; none where the time that counts ends before it.
    fn left_in_the_last_tenth_m(&self) -> Option<f64> {
        let altitudes_m = self.trace.column("altitude_m")?;
        let last = altitudes_m.len().checked_sub(1).filter(|last| last == self.time.end())?;
        let before = last.checked_sub((altitudes_m.len() / 10).max(1))?;
        Some(altitudes_m[last] - altitudes_m[before])
    }

    fn alpha_margin(&self) -> Result<Case, NotEvaluated> {
        // Another simulator does not say how far its data are trusted.
        let validity = self.plant.map(|plant| plant.aircraft().model().validity());
        let most_rad = validity.map_or(f64::INFINITY, |validity| validity.alpha_rad.max);
        if !most_rad.is_finite() {
            return Err(NotEvaluated::NoAlphaLimit);
        }
        self.least("alpha_rad", |alpha_rad| degrees(most_rad - alpha_rad))
    }
}

#[cfg(test)]
mod tests {
    use fspid_core::Faults;
    use fspid_sim::{Column, Outcome};

    use super::*;

    /// What another simulator shows, one value a second.
    fn trace(name: &'static str, values: &[f64]) -> Trace {
        let none = || vec![0.0; values.len()];
        Trace {
            time_s: (0..values.len()).map(|k| k as f64).collect(),
            setpoint_rad: none(),
            theta_rad: none(),
            q_rad_s: none(),
            command_rad: none(),
            elevator_rad: none(),
            gains: Vec::new(),
            autopilot_limited: Vec::new(),
            columns: vec![Column { name, values: values.to_vec() }],
            exit: None,
            outcome: Outcome::Completed,
            saturated_samples: 0,
            faults: Faults::NONE,
        }
    }

    fn seen(trace: &Trace, target_ft: Option<f64>) -> Seen<'_> {
        let time = 0..=trace.time_s.len() - 1;
        Seen { plant: None, trace, time, target_m: target_ft.map(|target_ft| target_ft * FOOT_M) }
    }

    fn overshoot(altitudes_ft: &[f64], target_ft: f64) -> Result<(f64, f64), String> {
        let altitudes_m: Vec<f64> = altitudes_ft.iter().map(|it| it * FOOT_M).collect();
        let found = seen(&trace("altitude_m", &altitudes_m), Some(target_ft)).overshoot();
        let found = found.map_err(|why| why.to_string())?;
        // To a billionth of a foot: metres there and back.
        Ok(((found.value * 1e9).round() / 1e9, found.place.at_s.expect("a time")))
    }

    #[test]
    fn beyond_the_target_is_on_the_side_that_the_flight_does_not_come_from() {
        assert_eq!(overshoot(&[1000.0, 1100.0, 1230.0, 1190.0], 1200.0), Ok((30.0, 2.0)));
        assert_eq!(overshoot(&[1000.0, 900.0, 850.0, 790.0, 795.0], 800.0), Ok((10.0, 3.0)));
        // It creeps, as every capture does in the end.
        assert_eq!(overshoot(&[1000.0, 1190.0, 1200.5, 1200.75], 1200.0), Ok((0.75, 3.0)));
        let going = overshoot(&[1000.0, 900.0, 850.0, 790.0], 800.0).expect_err("it goes on");
        assert!(going.contains("still goes away"), "{going}");
        // Just there is there.
        assert_eq!(overshoot(&[0.0, 500.0, 400.0], 500.0), Ok((0.0, 1.0)));
        let short = overshoot(&[1000.0, 1100.0, 1150.0, 1120.0], 1200.0).expect_err("not there");
        assert!(short.contains("1200 ft was not reached: 50 ft were left"), "{short}");
        let there = overshoot(&[800.0, 850.0], 800.0).expect_err("nothing to climb");
        assert!(there.contains("800 ft"), "{there}");
    }

    /// From 1000 to 1100 ft by way of 798 ft: the change of level was that of a flight that goes 10 ft too far.
    #[test]
    fn beyond_the_old_level_counts_as_beyond_the_new_one_does() {
        assert_eq!(overshoot(&[1000.0, 798.0, 1110.0, 1100.0], 1100.0), Ok((202.0, 1.0)));
        assert_eq!(overshoot(&[1000.0, 1030.0, 890.0, 900.0], 900.0), Ok((30.0, 1.0)));
        assert_eq!(overshoot(&[1000.0, 995.0, 1110.0, 1100.0], 1100.0), Ok((10.0, 2.0)));
    }

    #[test]
    fn of_equal_values_the_first_is_told_and_none_that_is_no_number_is_passed_over() {
        let flat = trace("climb_m_s", &[2.0, 1.0, 2.0, 1.0]);
        let of = |case: Result<Case, NotEvaluated>| {
            let case = case.expect("a value");
            (case.value, case.place.at_s.expect("a time"))
        };
        assert_eq!(of(seen(&flat, None).largest("climb_m_s", |it| it)), (2.0, 0.0));
        assert_eq!(of(seen(&flat, None).least("climb_m_s", |it| it)), (1.0, 1.0));
        let broken = trace("climb_m_s", &[2.0, f64::NAN, 3.0]);
        let (value, at_s) = of(seen(&broken, None).largest("climb_m_s", |it| it));
        assert!(value.is_nan() && at_s == 1.0, "{value} {at_s}");
        assert!(seen(&flat, None).largest("bank_rad", |it| it).is_err());
    }

    #[test]
    fn of_a_plant_without_equations_of_ours_what_its_trace_shows_is_judged() {
        let text = r#"
schema = 1
name = "x"
[plant]
preset = "navion-paper"
[loop]
sample_period_s = 1.0
duration_s = 2.0
[setpoint]
kind = "step"
amplitude_deg = 1.0
[[controller]]
name = "P"
kind = "pid"
kp = 0.1
[[requirement]]
measure = "largest_error_deg"
most = 9.0
"#;
        let study = fspid_scenario::file::parse(text, "x.toml", None, &[]).expect("it reads");
        let measure = Measure::LargestAirspeed;
        let requirement = Requirement { measure, ..study.requirements[0].clone() };
        let shown = trace("airspeed_m_s", &[100.0 * KNOT_M_S, 120.0 * KNOT_M_S, 90.0 * KNOT_M_S]);
        let found = case(&study, &shown, &requirement, 0..=2).expect("an airspeed");
        assert_eq!((found.value, found.place.at_s), (120.0, Some(1.0)));
        let other = trace("bank_rad", &[0.0; 3]);
        let refused = case(&study, &other, &requirement, 0..=2);
        assert_eq!(refused, Err(NotEvaluated::NoAircraft { measure: measure.name() }));
    }

    #[test]
    fn level_flight_sinks_by_zero_and_not_by_less() {
        assert!(sink_ft_min(0.0).is_sign_positive());
        assert_eq!(sink_ft_min(-FOOT_M), 60.0);
    }
}
